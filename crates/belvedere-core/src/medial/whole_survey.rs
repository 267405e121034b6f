//! What rules take from the whole of a survey, so that a part of it that is built on its own has the balls of the whole.

use serde::{Deserialize, Serialize};

/// Side of the blocks that surfaces are cut into where a survey is built in parts, metres: as those of [`super::prune`].
pub(super) const BLOCK: f32 = 64.0;

/// What rules take from the whole of a survey.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WholeSurvey {
    /// Whether any point has class 2, ground.
    pub has_ground: bool,
    /// Whether any point has a class of vegetation, 3 to 5.
    pub has_vegetation: bool,
    /// Share of all pulses that met a crown which got through it, 0 to 1.
    pub transmission: f64,
    /// Median spacing of later returns within crowns, metres; `None` where there are none.
    pub crown_spacing: Option<f32>,
}

/// A part of a survey that is built on its own.
#[derive(Clone, Copy)]
pub struct SurveyPart<'a> {
    /// What is known of the whole.
    pub whole: &'a WholeSurvey,
    /// Points before they were moved onto their surface, (N, 3) local metres: what decides which block a point belongs to. The origin of local
    /// metres must lie at a corner of blocks of 64 m.
    pub measured: &'a [[f32; 3]],
    /// How far away a point may lie and still be a neighbour, metres.
    pub farthest: f32,
}
