//! Sections of a report about places.

use super::NamedValues;
use crate::edge::EdgeReport;
use crate::eyes::EyesReport;
use crate::sun::{Site, SiteFrom};
use crate::targets::{Measure, MeasureStatistics, Targets};
use belvedere_data::report::rounded;
use serde::Serialize;

/// Counts of the places of a question by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PlacesReport {
    /// Cells on the ground under a cover, which have no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells_under_cover_left_out: Option<usize>,
    /// Targets outside the cloud, which have no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub targets_outside_cloud: Option<usize>,
    /// Targets inside an obstacle, which have no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub targets_inside_obstacle: Option<usize>,
    /// Targets near its edge.
    #[serde(flatten)]
    pub edge: Option<EdgeReport>,
}

/// Location of a scene on earth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LocationSection {
    pub(in crate::ask) latitude_deg: f64,
    pub(in crate::ask) longitude_deg: f64,
    pub(in crate::ask) meridian_convergence_deg: f64,
    pub(in crate::ask) source: SiteFrom,
}

impl LocationSection {
    pub(in crate::ask) fn of((site, source): &(Site, SiteFrom)) -> Self {
        Self {
            latitude_deg: rounded(site.latitude.to_degrees(), 5),
            longitude_deg: rounded(site.longitude.to_degrees(), 5),
            meridian_convergence_deg: rounded(site.convergence.to_degrees(), 4),
            source: *source,
        }
    }
}

/// The ground on a grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroundSection {
    pub(in crate::ask) source: &'static str,
    pub(in crate::ask) points: usize,
    #[serde(skip_serializing_if = "is_zero")]
    pub(in crate::ask) points_not_believed: usize,
    pub(in crate::ask) grid_columns: usize,
    pub(in crate::ask) grid_rows: usize,
    pub(in crate::ask) cell_m: f64,
    pub(in crate::ask) cells_without_ground: usize,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// Statistics of measures over targets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasuresSection {
    /// Targets with an answer.
    pub targets: usize,
    /// The spread of each measure.
    #[serde(flatten)]
    pub spread: NamedValues<Option<MeasureStatistics>>,
}

impl MeasuresSection {
    pub(in crate::ask) fn of<'a>(targets: &Targets, measures: impl IntoIterator<Item = &'a Measure>) -> Self {
        Self::of_count(targets.target_count(), measures)
    }

    /// Creates the section for a number of targets.
    pub(in crate::ask) fn of_count<'a>(targets: usize, measures: impl IntoIterator<Item = &'a Measure>) -> Self {
        let spread = measures.into_iter().map(|measure| (measure.name.clone(), measure.rounded_statistics()));
        Self { targets, spread: NamedValues(spread.collect()) }
    }
}

/// A single place of a question.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlaceSection {
    /// Position in the coordinates of the file; the height is NaN where none is known.
    pub position: [f64; 3],
    /// Source of the height.
    pub height_from: HeightFrom,
}

/// Source of the height of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum HeightFrom {
    /// It was given.
    Given,
    /// The ground below.
    Ground,
    /// The roof, or another cover of the ground, below.
    Cover,
}

/// Observers that cannot look, for reports.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ObserversSection {
    /// Number that cannot look, with the reasons.
    #[serde(flatten)]
    pub eyes: EyesReport,
    /// Eye of a single observer, in the coordinates of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// Height of that eye above the ground, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub above_ground_m: Option<f64>,
}

/// The windows of a question.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct WindowsSection {
    pub(in crate::ask) windows: usize,
    pub(in crate::ask) targets: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) targets_on_roofs_and_floors: Option<usize>,
}

/// The north of a scene, for reports.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NorthReport {
    pub(in crate::ask) azimuths_from: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) meridian_convergence_deg: Option<f64>,
}
