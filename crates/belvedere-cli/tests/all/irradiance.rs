//! `belvedere irradiance` on a house, whose sunny and shaded sides are known.

use crate::common::{EAST, NORTH, Workplace, numbers, remarks};

/// The house's flags: its normals are given and no pulses are known.
const HOUSE: &str =
    "house.laz --scene-config ../tau.json --orient given --ground found --sun-cell-deg 4 --patch-division 1";

#[test]
fn the_ground_north_of_a_house_gets_less() {
    let place = Workplace::with_house();
    let outputs = "-o energy.tif -o energy.png -o energy.csv --measures measures";
    let summary = place.summary(&format!("irradiance {HOUSE} --clear-sky ineichen --cell 1 --months {outputs}"));
    assert_eq!(summary["location"]["source"], "reference system");
    // a clear year at 52° N has about 1630 kWh/m² on a level plane (pvlib: 1631 at a turbidity of 3)
    let global = summary["radiation"]["global_kwh_m2"].as_f64().unwrap();
    assert!((1600.0..1660.0).contains(&global), "{global}");
    let text = place.text("energy.csv");
    let (x, y, energy) = (numbers(&text, "x"), numbers(&text, "y"), numbers(&text, "kwh_m2"));
    let at = |east: f64, north: f64| {
        let square = |i: usize| (x[i] - EAST - east).powi(2) + (y[i] - NORTH - north).powi(2);
        energy[(0..x.len()).min_by(|&a, &b| square(a).total_cmp(&square(b))).unwrap()]
    };
    let (north, south, far) = (at(0.5, 6.5), at(0.5, -6.5), at(0.5, -13.5));
    assert!(north < 0.6 * south && south < far && far < global + 1.0, "{north} {south} {far} {global}");
    let loss = numbers(&text, "loss");
    assert!(loss.iter().all(|loss| (0.0..=1.0).contains(loss)));
    let months: f64 = (1..=12).map(|month| numbers(&text, &format!("kwh_m2_{month:02}"))[0]).sum();
    assert!((months - energy[0]).abs() < 0.1, "{months} {}", energy[0]);
    assert!(place.bytes("energy.png").starts_with(b"\x89PNG"));
    assert!(place.path("measures/beam_kwh_m2.tif").is_file() && place.path("energy.tif").is_file());
}

#[test]
fn roofs_are_planes_with_bounds_of_their_loss() {
    let place = Workplace::with_house();
    let flags = "--planes roofs.csv --planes roofs.geojson --horizons horizons";
    let summary = place.summary(&format!("irradiance {HOUSE} --clear-sky haurwitz {flags}"));
    assert_eq!(summary["roofs"]["planes"], 2, "{summary}");
    let text = place.text("roofs.csv");
    let (tilt, azimuth) = (numbers(&text, "tilt_deg"), numbers(&text, "azimuth_deg"));
    // eaves 4 m out and 6 m up, ridge 9 m up: 3 in 4
    assert!(tilt.iter().all(|tilt| (tilt - 0.75f64.atan().to_degrees()).abs() < 1.0), "{tilt:?}");
    let south = azimuth.iter().position(|azimuth| (azimuth - 180.0).abs() < 5.0).unwrap();
    let energy = numbers(&text, "kwh_m2");
    assert!(energy[south] > 1.3 * energy[1 - south], "{energy:?}");
    for (min, max) in numbers(&text, "min_loss").iter().zip(numbers(&text, "max_loss")) {
        // nothing stands before these roofs but their own roughness
        assert!((0.0..=max).contains(min) && *min < 0.1, "{min} {max}");
    }
    let area = numbers(&text, "area_m2");
    assert!(area.iter().all(|area| (area - 50.0).abs() < 8.0), "10 m by 5 m each: {area:?}");
    let features: serde_json::Value = serde_json::from_str(&place.text("roofs.geojson")).unwrap();
    let features = features["features"].as_array().unwrap();
    let kinds: Vec<&str> = features.iter().map(|feature| feature["properties"]["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["roof", "panels", "roof", "panels"]);
    assert!(features.iter().all(|feature| feature["properties"]["max_loss"].is_number()));
    assert_eq!((&summary["roofs"]["small_planes"], &summary["horizons_inside_obstacles"]), (&0.into(), &0.into()));
    // planes of 10 m by 5 m have at most 50 cells
    let few = place.summary(&format!("irradiance {HOUSE} --clear-sky haurwitz --planes few.csv --min-cells 60"));
    assert_eq!((&few["roofs"]["planes"], &few["roofs"]["small_planes"]), (&0.into(), &2.into()));
    assert!(remarks(&few).iter().any(|remark| remark.contains("2 planes") && remark.contains("60 cells")), "{few}");
    for plane in ["plane_1.txt", "plane_2.txt"] {
        let horizon = place.text(&format!("horizons/{plane}"));
        assert_eq!(horizon.lines().filter(|line| line.parse::<f64>().is_ok()).count(), 48);
    }
}

#[test]
fn roofs_yield_electricity_between_both_ends() {
    let place = Workplace::with_house();
    let outline = |name: &str, west: f64, east: f64| {
        let corners = [[west, -8.0], [east, -8.0], [east, 8.0], [west, 8.0], [west, -8.0]]
            .map(|[x, y]| format!("[{},{}]", EAST + x, NORTH + y));
        let polygon = format!(r#"{{"type":"Polygon","coordinates":[[{}]]}}"#, corners.join(","));
        format!(r#"{{"type":"Feature","properties":{{"name":"{name}"}},"geometry":{polygon}}}"#)
    };
    let features = [outline("barn", 40.0, 60.0), outline("house", -8.0, 8.0)].join(",");
    place.write("footprints.geojson", format!(r#"{{"type":"FeatureCollection","features":[{features}]}}"#));
    let flags = "--months --planes roofs.csv --planes roofs.geojson --buildings sums.csv --hourly hours";
    let summary = place.summary(&format!("irradiance {HOUSE} --clear-sky haurwitz {flags}"));
    let (roofs, sums) = (place.text("roofs.csv"), place.text("sums.csv"));
    // both slopes of a roof are one building
    assert_eq!((numbers(&roofs, "building"), numbers(&sums, "planes")), (vec![1.0, 1.0], vec![2.0]));
    assert!(roofs.contains(",clear sky of Haurwitz; 2026,"), "{roofs}");
    let area = numbers(&roofs, "panel_area_m2");
    for (peak, area) in numbers(&roofs, "kwp").iter().zip(&area) {
        assert!((peak - 0.2 * area).abs() < 0.006, "{peak} {area}");
    }
    let [ac, strings, dc, ratio] =
        ["ac_kwh", "string_ac_kwh", "dc_kwh", "performance_ratio"].map(|name| numbers(&roofs, name));
    for plane in 0..2 {
        assert!(0.0 < strings[plane] && strings[plane] <= ac[plane] && ac[plane] < dc[plane], "{roofs}");
        assert!((0.7..0.9).contains(&ratio[plane]), "{ratio:?}");
        let months: f64 = (1..=12).map(|month| numbers(&roofs, &format!("ac_kwh_{month:02}"))[plane]).sum();
        assert!((months - ac[plane]).abs() < 1.2, "{months} {}", ac[plane]);
        let hours = place.text(&format!("hours/plane_{}.csv", plane + 1));
        assert_eq!(hours.lines().count(), 8761);
        let watts: f64 = numbers(&hours, "ac_w").iter().sum();
        assert!((watts / 1000.0 - ac[plane]).abs() < 1.0, "{watts} {}", ac[plane]);
        // the hour before noon at 4 degrees east, by the clock of UTC
        assert!(hours.contains("2026-06-21,11:00,+00:00,"), "{hours:.400}");
        let losses = place.text(&format!("hours/plane_{}_beam_loss.csv", plane + 1));
        let percents: Vec<f64> = losses.lines().skip(1).map(|line| line.parse().unwrap()).collect();
        assert!(percents.len() == 8760 && percents.iter().all(|loss| (0.0..=100.0).contains(loss)));
    }
    let total = summary["planes"]["ac_mwh"].as_f64().unwrap();
    assert!((1000.0 * total - ac.iter().sum::<f64>()).abs() < 11.0, "{summary}");
    assert!((numbers(&sums, "ac_kwh")[0] - ac.iter().sum::<f64>()).abs() < 1.5, "{sums}");
    assert_eq!(summary["photovoltaics"]["system_losses"], 0.1142);
    assert!(summary["headline"].as_array().unwrap().iter().any(|line| line.to_string().contains("kWp give")));
    assert!(remarks(&summary).iter().any(|remark| remark.contains("20 °C is assumed")), "{summary}");
    let features: serde_json::Value = serde_json::from_str(&place.text("roofs.geojson")).unwrap();
    let first = &features["features"][0]["properties"];
    assert_eq!((&first["building"], &first["radiation"]), (&1.into(), &"clear sky of Haurwitz; 2026".into()));

    // outlines name the house, and a system of twice the efficiency has twice the power
    let flags = "--planes named.csv --footprints footprints.geojson --module-efficiency 0.4";
    place.summary(&format!("irradiance {HOUSE} --clear-sky haurwitz {flags}"));
    let named = place.text("named.csv");
    assert_eq!(numbers(&named, "building"), [2.0, 2.0]);
    assert!(named.lines().nth(1).unwrap().contains(",house,"), "{named}");
    assert!((numbers(&named, "ac_kwh")[0] - 2.0 * ac[0]).abs() < 2.0, "{named}");
}

/// A year of noons in the format of PVGIS, and where they are.
fn weather(latitude: f64, offset: f64) -> String {
    let mut text = format!(
        "Latitude (decimal degrees): {latitude}\nLongitude (decimal degrees): 4.4\nElevation (m): 0.0\n\
         Irradiance Time Offset (h): {offset}\nmonth,year\n1,2015\ntime(UTC),T2m,RH,G(h),Gb(n),Gd(h)\n"
    );
    for month in 1..=12 {
        text += &format!("2015{month:02}15:1200,10.0,80.0,300.0,200.0,150.0\n");
    }
    text
}

#[test]
fn weather_comes_from_files() {
    let place = Workplace::with_house();
    place.write("weather.csv", weather(52.0, 0.0));
    let summary =
        place.summary(&format!("irradiance {HOUSE} --weather weather.csv --cell 4 --sky-model perez -o out.csv"));
    assert_eq!(summary["radiation"]["source"], "PVGIS, typical year");
    assert_eq!(
        (&summary["radiation"]["weather_rows"], summary["radiation"]["global_kwh_m2"].as_f64()),
        (&12.into(), Some(3.6))
    );
    let is_far = |remark: &String| remark.contains("km away");
    assert!(!remarks(&summary).iter().any(is_far));
    place.write("elsewhere.csv", weather(40.0, 0.0));
    let summary = place.summary(&format!("irradiance {HOUSE} --weather elsewhere.csv --cell 4 -o out.csv"));
    assert!(remarks(&summary).iter().any(is_far), "{summary}");
}

#[test]
fn what_cannot_be_is_refused_with_advice() {
    let place = Workplace::with_house();
    let house = |flags: &str| format!("irradiance {HOUSE} {flags}");
    place.refusal(2, &house("-o out.csv"), &["--weather", "--clear-sky"]);
    place.refusal(2, &house("--clear-sky bird"), &["--output"]);
    place.refusal(2, &house("--clear-sky ineichen --linke 99 -o out.csv"), &["--linke", "turbidity"]);
    place.refusal(2, &house("--clear-sky bird --linke 3 -o out.csv"), &["--linke", "ineichen"]);
    place.refusal(2, &house("--clear-sky bird --albedo 2 -o out.csv"), &["--albedo"]);
    place.refusal(2, &house("--clear-sky bird --year 9999 -o out.csv"), &["--year"]);
    place.refusal(2, &house("--clear-sky bird --location 99,0 -o out.csv"), &["--location", "latitude"]);
    place.refusal(2, &house("--clear-sky bird --planes roofs.txt"), &["--planes", ".csv"]);
    for (flag, value) in [
        ("--module-efficiency", "20"),
        ("--temperature-coefficient", "0.4"),
        ("--system-losses", "14"),
        ("--inverter-efficiency", "96"),
        ("--dc-ac-ratio", "0"),
    ] {
        place.refusal(2, &house(&format!("--clear-sky bird --planes roofs.csv {flag} {value}")), &[flag, value]);
    }
    place.refusal(2, &house("--clear-sky bird -o out.csv --hourly hours"), &["--planes"]);
    place.refusal(2, &house("--clear-sky bird --planes a.csv -o a.csv"), &["two results"]);
    place.refusal(1, &house("--weather nowhere.epw -o out.csv"), &["nowhere.epw"]);
    place.write(
        "broken.epw",
        "LOCATION,a,b,c,d,e,52.0,4.0,1.0,0.0\n\n\n\n\n\n\nDATA PERIODS,1,1\n1999,6,21,13,60,?,10\n",
    );
    place.refusal(1, &house("--weather broken.epw -o out.csv"), &["broken.epw", "line 9", "cell 14"]);
    // a cloud that does not say where it lies
    let mut adrift = crate::common::house();
    adrift.frame.crs = belvedere::crs::Crs::default();
    place.write_cloud("adrift.ply", &adrift);
    let flags = "--scene-config ../tau.json --orient given --ground found --sun-cell-deg 4 --clear-sky bird --cell 4 -o out.csv";
    place.refusal(2, &format!("irradiance adrift.ply {flags}"), &["--location", "latitude", "reference system"]);
    let summary = place.summary(&format!("irradiance adrift.ply {flags} --location 52,4.4"));
    assert_eq!(summary["location"]["source"], "location given");
}
