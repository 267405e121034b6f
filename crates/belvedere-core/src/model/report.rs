//! Report of the stages from a cloud to a scene model.

use super::findings::SurveyFindings;
use crate::clean::CleanReport;
use crate::medial::{CarvedReport, ShrinkReport};
use crate::normals::{OrientReport, Orientation};
use crate::pulses::{FreeSegmentReport, ScannerReport};
use belvedere_data::report::rounded;
use serde::{Serialize, Serializer};

/// Report of the stages from a cloud to a scene model.
#[derive(Clone, Debug, Default, Serialize)]
#[non_exhaustive]
pub struct BuildReport {
    /// Points that cleaning left out.
    pub removed_by_cleaning: CleanReport,
    /// Report of the search for the scanner, if it was needed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scanner: Option<ScannerReport>,
    /// The pulses, where they were to carve.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pulses: Option<PulsesReport>,
    /// Report of the orientation of normals.
    pub normals: NormalsReport,
    /// Report of moving points onto their surface, if that was done.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<SmoothingReport>,
    /// The balls, where they were made.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interior_balls: Option<BallsReport>,
    /// The surfaces of buildings, where they were looked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surfaces: Option<SurfacesReport>,
    /// Findings about the survey beside these.
    #[serde(skip_serializing_if = "SurveyFindings::is_empty")]
    pub survey: SurveyFindings,
}

/// Counts of the surfaces of buildings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SurfacesReport {
    /// Planes of roofs, in each block of 64 m that they reach into.
    pub roof_planes: usize,
    /// Straight edges of roofs, in pieces that end at blocks.
    pub roof_edges: usize,
    /// Ridges, hips and valleys.
    pub ridges: usize,
    /// Walls below edges.
    pub walls: usize,
    /// Triangles that close all these.
    pub triangles: usize,
    /// Balls that are smaller because they reached out of a surface.
    pub balls_capped: usize,
    /// Slabs (decks, canopies, balconies, bridges), in each block of 64 m that they reach into.
    pub slabs: usize,
    /// Balls left out because two sheets close their slab.
    pub balls_of_slabs: usize,
}

/// Report of moving points onto the surface around which they scatter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SmoothingReport {
    /// Noise of the cloud along its normals, metres; for scanners on the ground noise of their ranges.
    #[serde(rename = "noise_m", serialize_with = "in_tenths_of_millimetres")]
    pub noise: f32,
    /// Points that were moved: those with flat surroundings.
    #[serde(rename = "points_moved_onto_surface")]
    pub moved: usize,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
fn in_tenths_of_millimetres<S: Serializer>(length: &f32, serializer: S) -> Result<S::Ok, S::Error> {
    rounded(f64::from(*length), 4).serialize(serializer)
}

/// Usable pulses of a cloud.
#[derive(Clone, Debug, Default, Serialize)]
#[non_exhaustive]
pub struct PulsesReport {
    /// Counts of pulses that prove space empty.
    #[serde(flatten)]
    pub free_segments: FreeSegmentReport,
    /// Ways between two returns of a pulse that prove space empty as well; they do not carve.
    #[serde(rename = "ways_between_returns")]
    pub between_returns: usize,
    /// Pulses of structured scans that returned nothing and see the sky, as many as it takes to prove its space empty;
    /// they do not carve. `None` where no scan has any.
    #[serde(rename = "pulses_into_the_sky", skip_serializing_if = "Option::is_none")]
    pub into_the_sky: Option<usize>,
    /// Points found to be ground, where no class says which are. Left out where classes do.
    #[serde(rename = "points_found_to_be_ground", skip_serializing_if = "is_zero")]
    pub found_ground: usize,
    /// Reason why the crowns of trees could not be measured, if so: the data missing to tell pulses apart.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crowns_not_measured: Option<String>,
    /// Pulses that the finished balls block, of those used: a check of the model against its measurements. Left out
    /// where none were used to carve.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub blocked: Option<BlockedPulses>,
    /// Why pulses do not carve, where they were to carve if possible.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remark: Option<String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// Pulses whose way is blocked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BlockedPulses {
    /// Number of blocked pulses.
    #[serde(rename = "pulses_blocked_by_balls")]
    pub count: usize,
    /// Their share of the pulses used, percent.
    #[serde(rename = "pulses_blocked_by_balls_percent")]
    pub percent: f64,
    /// Number of pulses that only surfaces of buildings block.
    #[serde(rename = "pulses_blocked_by_surfaces")]
    pub by_surfaces: usize,
    /// Their share of the pulses used, percent.
    #[serde(rename = "pulses_blocked_by_surfaces_percent")]
    pub by_surfaces_percent: f64,
}

/// Report of the orientation of normals.
#[derive(Clone, Debug, Default, Serialize)]
#[non_exhaustive]
pub struct NormalsReport {
    /// The way, in words.
    pub oriented_by: &'static str,
    /// Number of points that each rule decided.
    #[serde(flatten)]
    pub orientation: OrientReport,
}

impl NormalsReport {
    pub(super) fn new(by: &Orientation<'_>, orientation: OrientReport) -> Self {
        let oriented_by = match by {
            Orientation::Up => "up (facades are uncertain: give a trajectory, a scanner position or a mesh if you can)",
            Orientation::Given => "normals of the file",
            Orientation::Scanner | Orientation::ScannerAt(_) => "scanner position",
            Orientation::Trajectory(_) => "trajectory",
            Orientation::Pulses(_) => "pulses",
            Orientation::Mesh(_) => "mesh",
        };
        Self { oriented_by, orientation }
    }
}

/// Counts of balls by outcome.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum BallsReport {
    /// Made from the points alone.
    Shrunk(ShrinkReport),
    /// Made from points and pulses.
    Carved(CarvedReport),
}
