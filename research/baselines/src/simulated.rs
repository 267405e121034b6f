//! Simulated scans as clouds, with the position of the scanner at each point.

use belvedere::cloud::{centre_rounded, to_local};
use belvedere::trajectory::Trajectory;
use belvedere::{Attributes, Frame, GpsTimeKind, PointCloud, Result};
use belvedere_scenes::{AirborneParams, Scan, TriangleScene, scan_airborne};

/// The cloud of a survey from the air, and the position of the scanner at each of its points, (N, 3) local metres.
///
/// # Errors
///
/// See [`surveyed`].
pub fn flown(scene: &TriangleScene, params: &AirborneParams) -> Result<(PointCloud, Vec<[f32; 3]>)> {
    surveyed(&scan_airborne(scene, params))
}

/// The cloud of a scan, and the position of the scanner at each of its points, (N, 3) local metres.
///
/// # Errors
///
/// If the path of the scanner does not cover the times of the points.
pub fn surveyed(scan: &Scan) -> Result<(PointCloud, Vec<[f32; 3]>)> {
    let coordinates = || (0..scan.len()).map(|i| [scan.x[i], scan.y[i], scan.z[i]]);
    let origin = centre_rounded(coordinates());
    let cloud = PointCloud {
        frame: Frame { origin, ..Frame::default() },
        positions: coordinates().map(|c| to_local(c, origin)).collect(),
        attributes: Attributes {
            classification: Some(scan.classification.clone()),
            gps_time: Some(scan.gps_time.clone()),
            gps_time_kind: GpsTimeKind::AdjustedStandard,
            return_number: Some(scan.return_number.clone()),
            return_count: Some(scan.return_count.clone()),
            point_source_id: Some(scan.point_source_id.clone()),
            ..Attributes::default()
        },
        ..PointCloud::default()
    };
    let path = scan.sensor_path.times.iter().copied().zip(scan.sensor_path.positions.iter().copied());
    let (scanner, _) = Trajectory::from_records(path.collect()).0.scanner_positions(&cloud)?;
    Ok((cloud, scanner))
}

/// Canals run north: how far it is from one to the next and how wide each is, metres.
const CANALS_EACH: f32 = 36.0;
const CANAL_WIDTH: f32 = 12.0;

/// What a survey would be if the ground were water in canals: pulses that end there do not return.
pub fn without_returns_from_water(cloud: &PointCloud, scanner: &[[f32; 3]]) -> (PointCloud, Vec<[f32; 3]>) {
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    let is_water =
        |row: usize| classes.get(row) == Some(&2) && cloud.positions[row][0].rem_euclid(CANALS_EACH) < CANAL_WIDTH;
    let (rows, scanner): (Vec<u32>, Vec<_>) = (0..).zip(scanner).filter(|(row, _)| !is_water(*row as usize)).unzip();
    (cloud.select(&rows), scanner)
}
