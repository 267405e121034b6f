//! Statistics estimated once from a whole survey, so that parts of it that are built separately become one model.

use super::flight_days::FlightDays;
use crate::clean::{CleanParams, IsolatedPoints, IsolationRadius};
use crate::medial::RuleStatistics;
use crate::neighbors::FARTHEST_NEIGHBOR;
use crate::pulses::{LinePath, VerticalParams, positions_on_paths, vertical_pulses};
use crate::strips::{StripOffset, StripReport};
use belvedere_data::control::Control;
use belvedere_data::{PointCloud, Result};
use serde::{Deserialize, Serialize};

/// Statistics estimated once from a whole survey. Parts of the survey that are built with them
/// ([`statistics`](super::ModelParams::statistics)) have the same balls, bit by bit, wherever they overlap by
/// [`SurveyStatistics::buffer`]. The parts lie in one frame, whose origin is a corner of blocks of 64 m.
///
/// A model of a whole cloud estimates these statistics by itself, from all of its points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SurveyStatistics {
    /// Radius in which an isolated point has no neighbours, metres; `None` keeps isolated points.
    pub isolation_radius: Option<f64>,
    /// Paths of the scanner along flight lines, local metres; without any, pulses are assumed to fall straight down.
    pub paths: Vec<LinePath>,
    /// Horizontal metres for each metre of height up to which pulses are used; those that lean more are left out.
    #[serde(rename = "most_lean")]
    pub max_lean: f64,
    /// True if pulses carve.
    pub carves: bool,
    /// Highest point of the survey, local metres: pulses prove nothing far above it.
    pub top: f32,
    /// Maximum height of a point above the lowest one within a few hundred metres, metres.
    pub relief: f64,
    /// Noise of points along their normals, metres; `None` where they stay where they are.
    pub noise: Option<f32>,
    /// True if crowns of trees are measured: returns can be grouped into pulses.
    pub measures_crowns: bool,
    /// Statistics of the whole for the rules.
    pub whole: RuleStatistics,
    /// True if ground is detected, since no point has its class.
    #[serde(default)]
    pub finds_ground: bool,
    /// Heights of flight lines, where some of them differ.
    #[serde(default)]
    pub strips: Option<StripReport>,
    /// Days on which its points were measured, by a sample of them.
    #[serde(default)]
    pub flight_days: FlightDays,
}

impl SurveyStatistics {
    /// Returns true if pulses are assumed to fall straight down.
    #[must_use]
    pub fn are_pulses_assumed(&self) -> bool {
        self.paths.is_empty()
    }

    /// Returns true if crowns are known as a medium: pulses are known, and carve.
    #[must_use]
    pub fn know_crowns(&self) -> bool {
        self.carves && !self.are_pulses_assumed()
    }

    /// Returns the maximum distance of a neighbour, metres.
    #[must_use]
    pub fn farthest(&self) -> f32 {
        FARTHEST_NEIGHBOR
    }

    /// Returns the offsets of the flight lines that are moved.
    #[must_use]
    pub fn moved_strips(&self) -> &[StripOffset] {
        self.strips.as_ref().map_or(&[], |strips| &strips.moved)
    }

    /// The cleaning of a part that leaves out the same points as that of the whole.
    #[must_use]
    pub fn cleaning(&self, params: &CleanParams) -> CleanParams {
        let with_radius = |isolated: &IsolatedPoints| {
            let radius = IsolationRadius::Metres(self.isolation_radius?);
            Some(IsolatedPoints { radius, ..*isolated })
        };
        CleanParams { isolated: params.isolated.as_ref().and_then(with_radius), ..params.clone() }
    }

    /// Local position of the scanner for each point, NaN where it is not known.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn scanner(&self, cloud: &PointCloud, control: &Control<'_>) -> Result<Vec<[f32; 3]>> {
        if self.are_pulses_assumed() {
            return vertical_pulses(&cloud.positions, &VerticalParams::default(), control);
        }
        let mut positions = positions_on_paths(&self.paths, cloud);
        for (scanner, point) in positions.iter_mut().zip(&cloud.positions) {
            if lean((point, scanner)).is_none_or(|lean| lean > self.max_lean) {
                *scanner = [f32::NAN; 3];
            }
        }
        control.check()?;
        Ok(positions)
    }
}

/// Returns the lean of the pulse from a scanner to a point: horizontal metres for each metre of height. `None` if it is
/// not known or does not come from above.
pub(super) fn lean((point, scanner): (&[f32; 3], &[f32; 3])) -> Option<f64> {
    let [x, y, z] = std::array::from_fn(|i| f64::from(scanner[i]) - f64::from(point[i]));
    (z > 0.0).then(|| x.hypot(y) / z).filter(|lean| lean.is_finite())
}
