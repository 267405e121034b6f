//! Simulated scans as the rest of the program takes them.

use anyhow::Result;
use belvedere::Frame;
use belvedere::cloud::{Attributes, GpsTimeKind, PointCloud, centre_rounded, to_local};
use belvedere::crs::Crs;
use belvedere_scenes::Scan;

/// Code of the reference system that simulated towns lie in: the Dutch grid with heights above NAP.
pub(crate) const EPSG: u32 = 7415;

/// Suns that answers are given for, azimuth and elevation in degrees: morning, noon and afternoon, from low to high and
/// between.
pub(crate) const SUNS_DEG: [[f64; 2]; 3] = [[110.0, 20.0], [180.0, 65.0], [240.0, 35.0]];

/// Reference system that simulated towns lie in.
pub(crate) fn crs() -> Result<Crs> {
    Ok(Crs::parse(&format!("EPSG:{EPSG}"))?)
}

/// The scan as a cloud, as a LAZ file will hold it.
pub(crate) fn cloud_of(scan: &Scan) -> Result<PointCloud> {
    let coordinates = || scan.x.iter().zip(&scan.y).zip(&scan.z).map(|((&x, &y), &z)| [x, y, z]);
    let origin = centre_rounded(coordinates());
    Ok(PointCloud {
        frame: Frame { origin, crs: crs()? },
        positions: coordinates().map(|c| to_local(c, origin)).collect(),
        attributes: Attributes {
            classification: Some(scan.classification.clone()),
            gps_time: Some(scan.gps_time.clone()),
            gps_time_kind: GpsTimeKind::AdjustedStandard,
            return_number: Some(scan.return_number.clone()),
            return_count: Some(scan.return_count.clone()),
            scan_angle: Some(scan.scan_angle_deg.iter().map(|a| a.to_radians()).collect()),
            point_source_id: Some(scan.point_source_id.clone()),
            intensity: Some(scan.intensity.clone()),
            ..Attributes::default()
        },
        ..PointCloud::default()
    })
}
