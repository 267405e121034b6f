//! A scene surveyed from the air, as a cloud with the place of the scanner at each point; tests and examples share it.

use belvedere::cloud::{centre_rounded, to_local};
use belvedere::trajectory::Trajectory;
use belvedere::{Attributes, Frame, GpsTimeKind, PointCloud, Result};
use belvedere_scenes::{AirborneParams, Scan, TriangleScene, scan_airborne};

/// The cloud of a survey, and where the scanner was at each of its points, (N, 3) local metres.
pub(crate) fn flown(scene: &TriangleScene, params: &AirborneParams) -> Result<(PointCloud, Vec<[f32; 3]>)> {
    surveyed(&scan_airborne(scene, params))
}

/// The same for any scan.
pub(crate) fn surveyed(scan: &Scan) -> Result<(PointCloud, Vec<[f32; 3]>)> {
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
