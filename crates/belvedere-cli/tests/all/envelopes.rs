//! Solar envelopes, routes and windows on the command line.

use crate::common::{EAST, NORTH, Workplace, column, corners};

const HOUSE: &str = "house.laz --orient given --scene-config ../tau.json";

/// A column of a table by its name, NaN where a cell is empty.
#[test]
fn an_envelope_rises_from_the_fence_at_the_elevation_of_the_sun_and_its_solid_has_its_volume() {
    let place = Workplace::with_house();
    // flat ground lies around the house; 10 m by 8 m south of a long fence, with the sun in the south
    let parcel = corners(&[[-5.0, -18.0], [5.0, -18.0], [5.0, -10.0], [-5.0, -10.0]]);
    let fence = corners(&[[-19.0, -10.0], [19.0, -10.0]]);
    let with = ["--parcel", &parcel, "--protect", &fence];
    let summary = place.summary_with(
        "envelope house.laz --fence-height 2 --sun 180,45 --max-height 50 -o heights.npy -o solid.obj -o solid.ply -o map.png -o heights.tif --tops tops.npy",
        &with,
    );
    let read = |name: &str| -> Vec<f32> {
        npyz::NpyFile::new(&std::fs::read(place.path(name)).unwrap()[..]).unwrap().into_vec().unwrap()
    };
    let (heights, tops) = (read("heights.npy"), read("tops.npy"));
    let bounded: Vec<f32> = heights.iter().copied().filter(|h| h.is_finite()).collect();
    let volume: f64 = bounded.iter().map(|&h| f64::from(h) * 0.25).sum();
    // columns of half a metre: 2 m at the fence, half a metre more each step; the ground is flat to a few centimetres
    let expected = 80.0 * (2.0 + 3.75);
    assert!((volume / expected - 1.0).abs() < 0.03, "{volume} {expected}");
    assert!((summary["envelope"]["volume_m3"].as_f64().unwrap() - volume).abs() < 0.1 + 1e-4 * volume);
    assert_eq!(tops.iter().filter(|top| top.is_finite()).count(), bounded.len());
    // the solid as another reader has it, through the divergence theorem
    for name in ["solid.obj", "solid.ply"] {
        let (mesh, _) = belvedere::io::read_mesh(&place.path(name)).unwrap();
        let six_fold = |t: usize| {
            let [a, b, c] = mesh.corners(t).unwrap().map(|p| [p[0] - EAST, p[1] - NORTH, p[2]]);
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        let solid = (0..mesh.triangles.len()).map(six_fold).sum::<f64>() / 6.0;
        assert!((solid - volume).abs() < 0.01 * volume, "{name}: {solid} {volume}");
    }
    // days and hours by clocks: the suns at both ends are among them
    let summary = place.summary_with(
        "envelope house.laz --date 2026-12-21 --between 10:00,14:00 --time-step-min 60 --location 52,5 --zone +01:00 --max-height 40 -o day.tif",
        &with,
    );
    assert_eq!(summary["period"]["suns"].as_u64(), Some(5), "{summary}");
    assert!(summary["envelope"]["limiting_suns"][0].as_str().unwrap().starts_with("2026-12-21T1"), "{summary}");
}

#[test]
fn envelopes_refuse_what_is_no_parcel_and_suns_that_are_not_up() {
    let place = Workplace::with_house();
    let parcel = corners(&[[-5.0, -18.0], [5.0, -18.0], [5.0, -10.0]]);
    let crossing = corners(&[[-5.0, -18.0], [5.0, -10.0], [5.0, -18.0], [-5.0, -10.0]]);
    let far = corners(&[[5000.0, 0.0], [5010.0, 0.0], [5010.0, 10.0]]);
    let fence = corners(&[[-19.0, -10.0], [19.0, -10.0]]);
    let refuse = |status: i32, arguments: &str, parcel: &str, words: &[&str]| {
        place.refusal_with(status, arguments, &["--parcel", parcel, "--protect", &fence], words);
    };
    let sun = "envelope house.laz --sun 180,45 -o e.tif";
    refuse(2, sun, &crossing, &["crossing itself"]);
    refuse(1, sun, &far, &["ground below the parcel is unknown"]);
    refuse(2, "envelope house.laz -o e.tif", &parcel, &["--date"]);
    refuse(2, "envelope house.laz --sun 180,-5 -o e.tif", &parcel, &["above 0"]);
    refuse(2, "envelope house.laz --sun 180,45 --between 15:00,09:00 -o e.tif", &parcel, &["09:00,15:00"]);
    refuse(2, "envelope house.laz --sun 180,45 -o e.gif", &parcel, &["extension"]);
    // the sun is in the south and the parcel north of what is protected: nothing bounds it
    let north = corners(&[[-5.0, -9.0], [5.0, -9.0], [5.0, -8.0], [-5.0, -8.0]]);
    refuse(2, "envelope house.laz --sun 180,45 -o e.ply", &north, &["maximum height"]);
    assert!(!place.path("e.tif").exists() && !place.path("e.ply").exists());
}

#[test]
fn a_route_past_a_house_sees_less_sky_and_lies_in_its_shade_in_part() {
    let place = Workplace::with_house();
    let route = corners(&[[-15.0, 7.0], [15.0, 7.0]]);
    let command = format!(
        "comfort {HOUSE} --date 2026-03-21 --time-step-min 60 --location 52,5 -o places.csv --routes routes.csv --times times.csv"
    );
    let summary = place.summary_with(&command, &["--route", &route]);
    assert_eq!(summary["exposure"]["routes"].as_u64(), Some(1));
    let (sky, hours) = (column(&place, "places.csv", "sky_view_factor"), column(&place, "places.csv", "sun_hours"));
    assert_eq!(sky.len(), 16);
    // before the middle of the house and at the ends of the street
    assert!(sky[8] < sky[0] && sky[8] < sky[15] && sky[0] > 0.8, "{sky:?}");
    assert!(hours.iter().all(|h| (0.0..=12.3).contains(h)));
    let heights = column(&place, "places.csv", "z");
    assert!(heights.iter().all(|z| (z - heights[0]).abs() < 0.5));
    let lengths = column(&place, "routes.csv", "length_m");
    assert!((lengths[0] - 30.0).abs() < 0.01);
    let mean = column(&place, "routes.csv", "sky_view_factor")[0];
    // trapezoid rule over places 2 m apart
    let expected = (sky.iter().sum::<f64>() - (sky[0] + sky[15]) / 2.0) / 15.0;
    assert!((mean - expected).abs() < 2e-4, "{mean} {expected}");
    let shares = column(&place, "times.csv", "shaded_share");
    assert!(shares.len() >= 12 && shares.iter().all(|s| (0.0..=1.0).contains(s)));
    // share of the day in shade two ways: by place and by sun
    let by_place = column(&place, "routes.csv", "sun_share")[0];
    assert!((0.0..1.0).contains(&by_place));
}

#[test]
fn windows_before_nothing_have_the_vertical_sky_component_of_a_free_wall() {
    let place = Workplace::with_house();
    let row = |x: f64, y: f64, z: f64, rest: &str| format!("{},{},{z},{rest}\n", EAST + x, NORTH + y);
    // high above the house: a wall to the south, a skylight, a large window to the north
    let rows = [row(0.0, 0.0, 60.0, "180,,,"), row(0.0, 0.0, 60.0, "0,0,,"), row(0.0, 0.0, 60.0, "0,90,4,2")].concat();
    place.write("windows.csv", format!("x,y,z,azimuth,tilt,width,height\n{rows}"));
    let command =
        format!("comfort {HOUSE} --windows windows.csv --date 2026-12-21 --location 52,5 --zone +01:00 -o found.csv");
    place.summary(&command);
    let component = column(&place, "found.csv", "sky_component");
    let factor = column(&place, "found.csv", "sky_view_factor");
    // BRE 209: 39.6 %; 577 directions
    for (found, expected) in component.iter().zip([0.396, 1.0, 0.396]) {
        assert!((found - expected).abs() < 0.01, "{component:?}");
    }
    assert!((factor[0] - 0.5).abs() < 0.01 && (factor[1] - 1.0).abs() < 0.01);
    let hours = column(&place, "found.csv", "sun_hours");
    // in December the sun never comes round to the north; the south has it all day, 7.7 h at 52°
    assert!(hours[2] == 0.0 && (7.4..8.0).contains(&hours[0]), "{hours:?}");
    assert!(column(&place, "found.csv", "first_light")[2].is_nan());
    place.write("bad.csv", "x,y,z\n1,2,3\n");
    place.refusal(
        1,
        &format!("comfort {HOUSE} --windows bad.csv --date 2026-12-21 --location 52,5 -o b.csv"),
        &["azimuth"],
    );
    place.refusal(2, &format!("comfort {HOUSE} --windows windows.csv --location 52,5 -o b.csv"), &["--date"]);
}
