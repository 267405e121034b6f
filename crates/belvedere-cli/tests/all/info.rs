//! Output of `info` about a file.
#![expect(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common::{Workplace, house};
use belvedere::Frame;
use belvedere::PointCloud;
use belvedere::crs::Crs;
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn scan() -> PointCloud {
    let mut cloud = house();
    let n = cloud.len();
    cloud.attributes.classification = Some((0..n).map(|i| if i < 100 { 2 } else { 6 }).collect());
    cloud.attributes.point_source_id = Some((0..n).map(|i| if i < 1000 { 11 } else { 12 }).collect());
    cloud.attributes.gps_time = Some((0..n).map(|i| 5000.0 + i as f64 * 1e-3).collect());
    cloud.attributes.return_number = Some(vec![1; n]);
    cloud.attributes.return_count = Some((0..n).map(|i| if i % 4 == 0 { 2 } else { 1 }).collect());
    cloud
}

#[test]
fn info_reports_counts_bounds_density_and_unit() {
    let place = Workplace::new();
    let cloud = scan();
    let n = cloud.len();
    place.write_cloud("scan.laz", &cloud);
    let info = place.summary("info scan.laz");
    assert_eq!(info["points"], n);
    assert_eq!(info["file"][0]["path"], "scan.laz");
    assert_eq!(info["file"][0]["points"], n);
    assert!(info["reading"]["reference_system"].as_str().unwrap().contains("EPSG:28992"));
    assert_eq!(info["metres_per_unit"], 1.0);
    assert_eq!(numbers(&info["min_corner"]), [84_985.0, 445_985.0, -0.08]);
    assert_eq!(numbers(&info["max_corner"]), [85_015.0, 446_015.0, 8.813]);
    // 30 m by 30 m; cells of a metre or two on the border count as a whole
    let area = info["covered_ground_m2"].as_f64().unwrap();
    assert!((900.0..1100.0).contains(&area), "{area}");
    let density = info["points_per_m2_of_covered_ground"].as_f64().unwrap();
    assert!((density - n as f64 / area).abs() < 0.01, "{density}");
    assert_eq!(info["attributes"]["point_source_id"]["line 11"], 1000);
    assert_eq!(info["attributes"]["point_source_id"]["line 12"], n - 1000);
    assert_eq!(info["attributes"]["classification"]["class 2"], 100);
    assert_eq!(info["duplicate_points"], 0);
    for command in ["normals", "balls", "depth-map", "query", "--orient trajectory=FILE", "--orient given"] {
        assert_eq!(info["usable_for"][command], "yes", "{command}");
    }
    assert!(info["usable_for"]["--orient scanner"].as_str().unwrap().starts_with("no: "));
}

#[test]
fn info_says_what_matters_in_twelve_lines_and_the_rest_when_it_is_wanted() {
    let place = Workplace::new();
    let cloud = scan();
    place.write_cloud("scan.laz", &cloud);
    let short = place.run("info scan.laz").stdout;
    assert!(short.lines().count() <= 12, "{short}");
    let density = format!("{} points", cloud.len());
    let grouped = short.replace(',', "");
    for words in [&density, "30 x 30 m on the map", "EPSG:28992", "per m²", "survey: ", "2: 2.2 %"] {
        assert!(grouped.contains(words), "{words} in {short}");
    }
    let whole = place.run("info scan.laz --verbose").stdout;
    assert!(
        whole.lines().count() > 30 && whole.contains("usable for") && whole.starts_with(short.lines().next().unwrap()),
        "{whole}"
    );
}

#[test]
fn what_info_calls_usable_can_be_used() {
    let place = Workplace::new();
    let mut bare = house();
    bare.attributes.normals = None;
    place.write_cloud("bare.laz", &bare);
    place.write_cloud("house.laz", &house());
    for (name, given) in [("bare.laz", false), ("house.laz", true)] {
        let info = place.summary(&format!("info {name}"));
        assert_eq!(info["usable_for"]["--orient given"] == "yes", given);
        let run = place.run(&format!("balls {name} --orient given -o out.npz"));
        assert_eq!(run.status == 0, given, "{run:?}");
        place.refusal(1, &format!("balls {name} --orient scanner -o out.npz"), &["scanner"]);
    }
    let missing = place.summary("info bare.laz")["missing"].to_string();
    assert!(missing.contains("GPS time") && missing.contains("flight lines"), "{missing}");
    // balls need a handful of points
    place.write("three.xyz", "0 0 0\n1 0 0\n0 1 0\n");
    assert!(place.summary("info three.xyz")["usable_for"]["balls"].as_str().unwrap().starts_with("no: "));
}

#[test]
fn feet_are_reported_and_bounds_stay_in_them() {
    let place = Workplace::new();
    let feet = PointCloud {
        frame: Frame { origin: [200_000.0, 300_000.0, 0.0], crs: Crs::from_epsg(2992).unwrap() },
        ..house()
    };
    place.write_cloud("feet.laz", &feet);
    let info = place.summary("info feet.laz");
    assert_eq!(info["metres_per_unit"], 0.3048);
    assert!(info["reading"]["reference_system"].as_str().unwrap().contains("international feet"));
    let low = numbers(&info["min_corner"]);
    // a thousandth of a foot is what is printed
    assert!((low[0] - 199_985.0 / 0.3048).abs() < 2e-3 && (low[1] - 299_985.0 / 0.3048).abs() < 2e-3, "{low:?}");
    // the ground is counted in square metres all the same
    let area = info["covered_ground_m2"].as_f64().unwrap();
    assert!((900.0..1100.0).contains(&area), "{area}");
}

#[test]
fn a_reference_system_can_be_given() {
    let place = Workplace::new();
    let cloud = house().with_crs(Crs::default());
    place.write_cloud("house.xyz", &cloud);
    let missing = |info: &Value| info["missing"].to_string().contains("reference system");
    assert!(missing(&place.summary("info house.xyz")));
    let info = place.summary("info house.xyz --crs EPSG:28992");
    assert!(!missing(&info) && info["reading"]["reference_system"].as_str().unwrap().contains("EPSG:28992"));
    place.refusal(1, "info house.xyz --crs EPSG:4326", &["house.xyz", "degrees"]);
    place.refusal(2, "info house.xyz --crs nonsense", &["--crs", "nonsense", "EPSG:28992"]);
}

#[test]
fn duplicates_and_left_out_points_are_counted() {
    let place = Workplace::new();
    place.write("points.xyz", "1 1 1\n2 2 2\n1 1 1\nnan 1 1\n3 3 oops\n4 4 4\n5 5 5\n");
    let info = place.summary("info points.xyz");
    assert_eq!((&info["points"], &info["duplicate_points"]), (&5.into(), &1.into()));
    let left_out = info["reading"]["left_out"].to_string();
    assert!(
        left_out.contains("1 unreadable: lines 5") && left_out.contains("1 coordinates are not finite"),
        "{left_out}"
    );
}

#[test]
fn info_of_a_ball_file_says_where_it_is_and_how_it_was_built() {
    let place = Workplace::with_house();
    let built = place.summary("balls house.laz --orient given --method tau -o balls.npz");
    let (info, cloud) = (place.summary("info balls.npz"), place.summary("info house.laz"));
    let counted = &built["interior_balls"];
    let count = counted["balls_shrunk"].as_u64().unwrap() + counted["balls_of_maximum_radius"].as_u64().unwrap();
    assert_eq!(info["balls"], count, "{built}");
    assert_eq!(info["pulses"], 0);
    assert!(cloud["crs"].as_str().unwrap().contains("28992"), "{cloud}");
    assert_eq!(info["crs"], cloud["crs"]);
    assert_eq!(info["made"]["input"], "house.laz");
    // isolated points are left out before balls are built
    for (of_balls, of_cloud) in ["min_corner", "max_corner"].map(|name| (numbers(&info[name]), numbers(&cloud[name]))) {
        assert!(of_balls.iter().zip(&of_cloud).all(|(a, b)| (a - b).abs() < 2.0), "{of_balls:?} {of_cloud:?}");
    }
}
