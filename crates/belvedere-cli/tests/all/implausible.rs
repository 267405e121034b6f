//! Inputs that cannot be right are refused, or their results carry a warning.

use crate::common::{EAST, NORTH, Workplace, house};
use belvedere::crs::Crs;
use std::fmt::Write;

const HOUSE: &str = "house.laz --scene-config ../tau.json --orient given";

#[test]
fn too_few_points_for_a_surface_are_refused_by_every_command() {
    let place = Workplace::new();
    let points = ["85000 446000 1", "85001 446000 1", "85000 446001 1.5"];
    let line: String = (0..50).map(|i| format!("{} 446000 {}\n", 85_000 + i, 2 * i)).collect();
    place.write("line.xyz", line);
    place.write("three.xyz", points.join("\n"));
    for command in
        ["balls -o a.npz", "shadow --sun 180,30 -o a.tif", "sky-view -o a.tif", "query --sun 9,9 --random 9 -o a.csv"]
    {
        for config in [r#"{"keep_isolated": true}"#, r#"{"keep_isolated": true, "method": "tau"}"#] {
            place.write("balls.json", config);
            let flags = format!("{command} --scene-config balls.json");
            place.refusal(1, &format!("{flags} three.xyz"), &["three.xyz: 3 points", "surface"]);
            place.refusal(1, &format!("{flags} line.xyz"), &["line.xyz: 50 points", "on one line"]);
        }
    }
    // the content of the file is still reported
    assert_eq!(place.summary("info three.xyz")["points"], 3);
}

#[test]
fn web_mercator_is_refused_with_a_system_to_convert_to() {
    let place = Workplace::new();
    let mut cloud = house();
    // Delft
    cloud.frame.crs = Crs::from_epsg(3857).unwrap();
    cloud.frame.origin = [485_000.0, 6_800_000.0, 0.0];
    place.write_cloud("web.laz", &cloud);
    let words = ["web.laz", "Web Mercator", "EPSG:32631", "reprojection"];
    place.refusal(1, "info web.laz", &words);
    place.write_cloud("house.laz", &house());
    place.refusal(2, "info house.laz --crs EPSG:3857", &["--crs", "EPSG:3857", "EPSG:28992"]);
    place.refusal(1, "info house.laz --crs EPSG:3857 --crs-override", &["Web Mercator"]);
}

#[test]
fn what_contradicts_the_file_is_refused_by_every_command_that_takes_it() {
    let place = Workplace::with_house();
    let words = ["--crs", "house.laz", "EPSG:2154", "EPSG:28992", "km apart", "override"];
    for command in [
        "info house.laz",
        "balls house.laz -o balls.npz",
        "shadow house.laz --sun 180,30 -o a.tif",
        "query house.laz --sun 180,30 --random 5 -o a.csv",
        "city plan house.laz --sky-view --cell 4 -o run",
    ] {
        place.refusal(2, &format!("{command} --crs EPSG:2154"), &words);
        place.refusal(2, &format!("{command} --crs-override"), &["--crs"]);
    }
    assert_eq!(place.summary("info house.laz --crs EPSG:2154 --crs-override")["crs"], "EPSG:2154");
    place.summary("city plan house.laz --sky-view --cell 4 -o run --crs EPSG:2154 --crs-override");
    // where the file names nothing, the area of use speaks
    let mut unnamed = house();
    unnamed.frame.crs = Crs::default();
    place.write_cloud("unnamed.ply", &unnamed);
    place.refusal(2, "info unnamed.ply --crs EPSG:2056", &["unnamed.ply", "EPSG:2056", "area of use"]);
}

#[test]
fn a_location_far_from_the_reference_system_is_refused_and_a_near_one_has_a_remark() {
    let place = Workplace::with_house();
    let shadow =
        |location: &str| format!("shadow {HOUSE} --time 2026-06-21T10:00Z --cell 4 --location {location} -o a.tif");
    place.refusal(2, &shadow("4.37,52"), &["--location", "swapped", "52.00° N 4.37° E"]);
    place.refusal(2, &shadow("-52,4.37"), &["--location", "km from where"]);
    let keys = |location: &str| place.summary(&shadow(location))["remarks"].to_string();
    let far = keys("52.37,4.9");
    assert!(far.contains("location-far-away") && far.contains("distance_km"), "{far}");
    assert!(!keys("52,4.37").contains("location-far-away"));
}

#[test]
fn trajectories_in_degrees_at_ground_level_or_beyond_the_earth_are_refused() {
    let place = Workplace::new();
    let mut cloud = house();
    let count = cloud.len();
    cloud.attributes.gps_time = Some((0..count).map(|i| 1000.0 + i as f64 * 1e-3).collect());
    place.write_cloud("house.laz", &cloud);
    let path = |name: &str, [x, y, z]: [f64; 3]| {
        let rows = (0..30).fold(String::new(), |mut rows, i| {
            let _ = writeln!(rows, "{},{},{y},{z}", 995 + i, x + f64::from(i) * x * 1e-6);
            rows
        });
        place.write(name, format!("time,x,y,z\n{rows}"));
    };
    path("flown.csv", [EAST, NORTH, 500.0]);
    path("degrees.csv", [4.36, 52.0, 500.0]);
    path("ground.csv", [EAST, NORTH, 0.0]);
    path("beyond.csv", [EAST, NORTH, 1e30]);
    path("beside.csv", [1e30, NORTH, 500.0]);
    for method in ["tau", "carved"] {
        let run = |name: &str| format!("balls house.laz --method {method} --orient trajectory={name} -o balls.npz");
        place.summary(&run("flown.csv"));
        place.refusal(1, &run("degrees.csv"), &["trajectory", "km away", "not degrees"]);
        place.refusal(1, &run("ground.csv"), &["trajectory", "of the scanner, not of the ground"]);
        place.refusal(1, &run("beside.csv"), &["trajectory"]);
        place.refusal(1, &run("beyond.csv"), &["trajectory"]);
    }
}

#[test]
fn headers_that_contradict_their_points_are_refused_or_reported() {
    let place = Workplace::new();
    place.write_cloud("house.las", &house());
    let bytes = place.bytes("house.las");
    let with = |at: usize, value: f64| {
        let mut bytes = bytes.clone();
        bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
        place.write("lie.las", bytes);
    };
    let offset = f64::from_le_bytes(bytes[155..163].try_into().unwrap());
    // a kilometre east, and ten times as wide
    with(155, offset + 1000.0);
    place.refusal(1, "info lie.las", &["lie.las", "outside the bounds of the header", "scale"]);
    let scale = f64::from_le_bytes(bytes[131..139].try_into().unwrap());
    with(131, 10.0 * scale);
    let run = place.run("--json info lie.las");
    assert!(run.status == 1 || run.stdout.contains("outside the bounds of the header"), "{run:?}");
    // the greatest x is too small by 5 m
    with(179, EAST + 10.0);
    let summary = place.summary("info lie.las");
    let notes = summary["reading"]["notes"].to_string();
    assert!(notes.contains("points are outside the bounds of the header") && notes.contains("85015.00"), "{notes}");
    assert!(!place.summary("info house.las")["reading"]["notes"].to_string().contains("bounds"));
}

#[test]
fn walls_are_not_estimated_from_a_few_points() {
    let place = Workplace::new();
    let mut cloud = house();
    // seventeen points of class 6 on a steep zigzag across the cloud, the rest is ground
    let mut classes = vec![2; cloud.len()];
    for i in 0..17_i16 {
        cloud.positions.push([f32::from(i) * 1.5 - 12.0, f32::from(i % 2) * 0.2, f32::from(i % 3) * 20.0]);
        classes.push(6);
    }
    cloud.attributes.normals = None;
    cloud.attributes.classification = Some(classes);
    place.write_cloud("few.laz", &cloud);
    let summary = place.summary("info few.laz");
    assert_eq!(summary["facades"]["building_points"], 17);
    assert!(summary["facades"].get("estimated_wall_area_m2").is_none(), "{summary}");
    assert!(summary["facades"]["walls"].as_str().unwrap().starts_with("not estimable"));
}

#[test]
fn decimal_commas_cells_without_end_and_angles_are_refused_in_the_words_of_the_user() {
    let place = Workplace::with_house();
    place.write("commas.csv", "x,y,z\n119849,791,487012,500,3,25\n119850,791,487012,500,3,25\n");
    place.refusal(1, "info commas.csv", &["commas.csv", "6 cells", "the header has 3", "decimal commas"]);
    for command in ["shadow --sun 180,30", "viewshed --observer 85010,446010"] {
        place.refusal(2, &format!("{command} {HOUSE} --ground found --cell 1e9 -o a.tif"), &["--cell", "at most"]);
    }
    let range = "--elevation-range=50,40";
    place.refusal(2, &format!("viewshed {HOUSE} --observer 85010,446010 {range} -o a.tif"), &["50 to 40", "degrees"]);
}
