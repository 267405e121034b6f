//! A simulated scan as a cloud.

use belvedere::cloud::{centre_rounded, to_local};
use belvedere::crs::Crs;
use belvedere::{Attributes, Frame, GpsTimeKind, PointCloud};
use belvedere_scenes::Scan;

/// The scan in the reference system that simulated towns lie in.
pub(crate) fn cloud_of(scan: &Scan) -> PointCloud {
    let coordinates = || (0..scan.len()).map(|i| [scan.x[i], scan.y[i], scan.z[i]]);
    let origin = centre_rounded(coordinates());
    PointCloud {
        frame: Frame { origin, crs: Crs::parse("EPSG:7415").unwrap() },
        positions: coordinates().map(|c| to_local(c, origin)).collect(),
        attributes: Attributes {
            classification: Some(scan.classification.clone()),
            gps_time: Some(scan.gps_time.clone()),
            gps_time_kind: GpsTimeKind::AdjustedStandard,
            return_number: Some(scan.return_number.clone()),
            return_count: Some(scan.return_count.clone()),
            scan_angle: Some(scan.scan_angle_deg.iter().map(|a| a.to_radians()).collect()),
            point_source_id: Some(scan.point_source_id.clone()),
            ..Attributes::default()
        },
        ..PointCloud::default()
    }
}
