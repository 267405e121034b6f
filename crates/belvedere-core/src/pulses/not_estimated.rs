//! Takes the place of `estimate` in a build without the feature `scanner-estimate`: nothing is found.

use super::Pulses;
use super::flight_parts::{HeightOffset, ScanAngleParams, ScanAnglePart, SensorEstimateParams, SensorPart};
use super::line_path::LinePath;
use super::scanner_report::FoundStation;
use belvedere_data::control::Control;
use belvedere_data::{PointCloud, Result};

/// False: this build does not estimate scanner positions.
pub(super) const IS_BUILT: bool = false;

pub(super) fn paths_from_returns(
    _: &PointCloud,
    _: &Pulses,
    params: &SensorEstimateParams,
    control: &Control<'_>,
) -> Result<(Vec<LinePath>, Vec<SensorPart>)> {
    params.validate()?;
    control.check()?;
    Ok((Vec::new(), Vec::new()))
}

pub(super) fn paths_from_angles(
    _: &PointCloud,
    _: Option<&Pulses>,
    _: &ScanAngleParams,
    control: &Control<'_>,
) -> Result<(Vec<LinePath>, Vec<ScanAnglePart>)> {
    control.check()?;
    Ok((Vec::new(), Vec::new()))
}

pub(super) fn height_offset(_: &PointCloud, _: &Pulses, _: &[[f32; 3]]) -> Option<HeightOffset> {
    None
}

pub(super) fn stations_of_tripods(
    cloud: &PointCloud,
    control: &Control<'_>,
) -> Result<(Vec<[f32; 3]>, Vec<FoundStation>)> {
    control.check()?;
    Ok((vec![[f32::NAN; 3]; cloud.len()], Vec::new()))
}
