//! Sections on the targets of one view.

use serde::Serialize;

/// Number of points for each answer, and the way they were found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TargetsSection {
    pub(in crate::ask) targets: usize,
    pub(in crate::ask) visible: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) unproven: Option<usize>,
    pub(in crate::ask) blocked: usize,
    /// Unproven answers among the blocked ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) unproven_within: Option<usize>,
    pub(in crate::ask) outside_view: usize,
    pub(in crate::ask) outside_cloud: usize,
    pub(in crate::ask) inside_obstacle: usize,
    pub(in crate::ask) visible_percent: f64,
    #[serde(flatten)]
    pub(in crate::ask) by: AnsweredBy,
}

/// Way in which answers were found.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(in crate::ask) enum AnsweredBy {
    DepthMap {
        method: &'static str,
        depth_bias_m: f64,
    },
    LinesOfSight {
        depth_bias_m: f64,
        shell_m: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        balls_around_eye: Option<usize>,
        #[serde(skip_serializing_if = "Option::is_none")]
        proof_distance_m: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        max_unproven_length_m: Option<f64>,
        method: &'static str,
        #[serde(skip_serializing_if = "Option::is_none")]
        decided_by_map_percent: Option<f64>,
    },
}

/// Visible area of the faces of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FacesSection {
    pub(in crate::ask) count: usize,
    pub(in crate::ask) spacing_m: f64,
    pub(in crate::ask) sample_points: usize,
    pub(in crate::ask) area_m2: f64,
    pub(in crate::ask) visible_m2: f64,
    pub(in crate::ask) standard_error_m2: f64,
    pub(in crate::ask) visible_percent: f64,
    pub(in crate::ask) unproven_m2: f64,
}
