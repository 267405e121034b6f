//! Points that represent no real surface: flagged, repeated, or alone in the air.

mod duplicates;
mod grid;
mod outliers;

pub(crate) use duplicates::drop_near;
pub use outliers::{IsolatedPoints, IsolationRadius};

use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use outliers::check_length;
use rayon::prelude::*;
use serde::{Serialize, Serializer};

/// LAS flag of a point that its producer withdrew.
const WITHHELD_FLAG: u8 = 4;

/// Treatment of points of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// Leave them out.
    Drop,
    /// Keep them.
    Keep,
}

/// Selection of points to leave out.
#[derive(Clone, Debug, PartialEq)]
pub struct CleanParams {
    /// Points flagged as withheld. Default: dropped, as the LAS specification recommends.
    pub withheld: Treatment,
    /// ASPRS classes left out; empty for none. Default: 7 and 18, low and high noise (LAS 1.4 R15, table 17).
    pub dropped_classes: Vec<u8>,
    /// Points at exactly the same local position as an earlier one. Default: dropped; a medial ball cannot be shrunk
    /// between two points in one place.
    pub exact_duplicates: Treatment,
    /// Distance in metres, above 0 and at most 1000, within which a point repeats an earlier one that was kept; `None`
    /// keeps them. Default: 0.001, below the resolution of LAS files in centimetres or millimetres.
    pub near_duplicate_distance: Option<f64>,
    /// Points with hardly another around them; `None` keeps them.
    pub isolated: Option<IsolatedPoints>,
}

impl Default for CleanParams {
    fn default() -> Self {
        Self {
            withheld: Treatment::Drop,
            dropped_classes: vec![7, 18],
            exact_duplicates: Treatment::Drop,
            near_duplicate_distance: Some(0.001),
            isolated: Some(IsolatedPoints::default()),
        }
    }
}

impl CleanParams {
    /// Leaves out nothing but positions that are not finite.
    #[must_use]
    pub fn nothing() -> Self {
        Self {
            withheld: Treatment::Keep,
            dropped_classes: Vec::new(),
            exact_duplicates: Treatment::Keep,
            near_duplicate_distance: None,
            isolated: None,
        }
    }

    /// These parameters, which keep points of noise classes and those flagged as withheld.
    #[must_use]
    pub fn keeping_noise(self) -> Self {
        Self { withheld: Treatment::Keep, dropped_classes: Vec::new(), ..self }
    }

    /// These parameters, which keep points that repeat others.
    #[must_use]
    pub fn keeping_duplicates(self) -> Self {
        Self { exact_duplicates: Treatment::Keep, near_duplicate_distance: None, ..self }
    }

    /// These parameters, which keep points with hardly any other around them.
    #[must_use]
    pub fn keeping_isolated(self) -> Self {
        Self { isolated: None, ..self }
    }
}

/// Number of points that each step left out, in the order of the steps. The counts add up to the points of the cloud.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CleanReport {
    /// Points before.
    #[serde(rename = "points")]
    pub point_count: usize,
    /// Points after.
    #[serde(rename = "points_kept")]
    pub kept_count: usize,
    /// Positions that are not finite; always left out.
    #[serde(rename = "points_not_finite")]
    pub not_finite_count: usize,
    /// Withheld points.
    #[serde(rename = "points_withheld")]
    pub withheld_count: usize,
    /// Points of the classes left out, unless withheld too.
    #[serde(rename = "points_of_noise_classes")]
    pub class_count: usize,
    /// Points at the position of an earlier one.
    #[serde(rename = "exact_duplicates")]
    pub exact_duplicate_count: usize,
    /// Points close to an earlier one.
    #[serde(rename = "near_duplicates")]
    pub near_duplicate_count: usize,
    /// Points alone.
    #[serde(rename = "points_isolated")]
    pub isolated_count: usize,
    /// Radius in metres within which neighbours were counted, where they were.
    #[serde(rename = "isolation_radius_m", skip_serializing_if = "Option::is_none", serialize_with = "in_centimetres")]
    pub isolation_radius: Option<f64>,
}

/// A radius in metres, to the centimetre.
fn in_centimetres<S: Serializer>(radius: &Option<f64>, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    radius.map(|radius| rounded(radius, 2)).serialize(serializer)
}

/// Indices of the points worth keeping, ascending, and how many each step left out.
///
/// Steps run in the order of the fields of [`CleanParams`], each on the points that the previous ones kept. Of points
/// in one place the first in the file stays. Flags and classes are used where the cloud has them. An empty cloud gives
/// no index. The result is the same for any number of threads.
///
/// # Errors
/// - [`Error::LengthMismatch`] if an attribute has another length than the cloud.
/// - [`Error::InvalidParameter`] for a distance, radius or multiple that is not positive and finite or that is too
///   large, and for more points than u32 counts.
/// - [`Error::Cancelled`].
pub fn clean(cloud: &PointCloud, params: &CleanParams, control: &Control<'_>) -> Result<(Vec<u32>, CleanReport)> {
    let expected = cloud.len();
    if let Some((what, found)) = cloud.attributes.columns().into_iter().find(|&(_, length)| length != expected) {
        return Err(Error::LengthMismatch { what, expected, found });
    }
    let count = u32::try_from(expected).map_err(|_| {
        Error::invalid(Parameter::PointCount, expected, "at most 4294967295; split the cloud into tiles")
    })?;
    if let Some(distance) = params.near_duplicate_distance {
        check_length(Parameter::DuplicateDistance, distance)?;
    }
    if let Some(isolated) = &params.isolated {
        isolated.check()?;
    }
    let positions = cloud.positions.as_slice();
    let mut report = CleanReport { point_count: expected, ..CleanReport::default() };
    let mut kept: Vec<u32> = (0..count).collect();
    report.not_finite_count = keep(&mut kept, |i| positions[i].iter().all(|v| v.is_finite()));
    if let (Treatment::Drop, Some(flags)) = (params.withheld, &cloud.attributes.flags) {
        report.withheld_count = keep(&mut kept, |i| flags[i] & WITHHELD_FLAG == 0);
    }
    if let Some(classes) = &cloud.attributes.classification {
        report.class_count = keep(&mut kept, |i| !params.dropped_classes.contains(&classes[i]));
    }
    if params.exact_duplicates == Treatment::Drop {
        report.exact_duplicate_count = duplicates::drop_exact(positions, &mut kept);
        control.check()?;
    }
    if let Some(distance) = params.near_duplicate_distance {
        report.near_duplicate_count = drop_near(positions, &mut kept, distance, control)?;
    }
    if let Some(isolated) = &params.isolated {
        let radius = isolated.radius_for(positions, &kept, control)?;
        report.isolation_radius = radius;
        if let Some(radius) = radius {
            let min_neighbors = isolated.min_neighbors;
            report.isolated_count = outliers::drop_isolated(positions, &mut kept, radius, min_neighbors, control)?;
        }
    }
    report.kept_count = kept.len();
    Ok((kept, report))
}

/// Keeps the indices that `wanted` wants, in order; returns how many went.
fn keep(kept: &mut Vec<u32>, wanted: impl Fn(usize) -> bool + Sync) -> usize {
    let before = kept.len();
    *kept = kept.par_iter().copied().filter(|&i| wanted(i as usize)).collect();
    before - kept.len()
}

#[cfg(test)]
mod tests;
