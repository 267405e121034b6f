//! Cleaning of real clouds.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use belvedere::control::Control;
use std::path::Path;

use belvedere::PointCloud;
use belvedere::clean::{CleanParams, clean};

fn coordinates(path: &Path) -> Vec<[f64; 3]> {
    let mut reader = las::Reader::from_path(path).unwrap();
    let points = reader.read_all().unwrap();
    points.x().zip(points.y()).zip(points.z()).map(|((x, y), z)| [x, y, z]).collect()
}

#[test]
fn the_point_a_degree_away_goes() {
    let Some(path) = crate::common::data("the_point_a_degree_away_goes", "data/io_cases/spurious.las") else { return };
    // degrees; made metres well enough for the question of who is alone
    let metres: Vec<[f64; 3]> = coordinates(&path)
        .iter()
        .map(|&[x, y, z]| [x * 111_320.0 * 44.05_f64.to_radians().cos(), y * 111_320.0, z])
        .collect();
    let (cloud, _) = PointCloud::from_coordinates(&metres);
    let (kept, report) = clean(&cloud, &CleanParams::default(), &Control::none()).unwrap();
    println!("spurious: {report:?}");
    let west = metres.iter().enumerate().min_by(|a, b| a.1[0].total_cmp(&b.1[0])).unwrap().0;
    assert!(!kept.contains(&u32::try_from(west).unwrap()));
    assert_eq!(report.isolated_count, 1, "{report:?}");
}

#[test]
fn a_town_keeps_its_facades_and_wires() {
    let Some(path) = crate::common::data("a_town_keeps_its_facades_and_wires", "data/delft_ahn3/ahn3_cropped_2.laz")
    else {
        return;
    };
    let (cloud, _) = PointCloud::from_coordinates(&coordinates(&path));
    let start = std::time::Instant::now();
    let (_, report) = clean(&cloud, &CleanParams::default(), &Control::none()).unwrap();
    println!("delft 2: {report:?} in {:?}", start.elapsed());
    assert!(report.isolated_count < cloud.len() / 2000, "{report:?}");
}
