//! Sections of a report about lines of sight and views.

use super::NamedValues;
use crate::eyes::EyesReport;
use crate::protected_view::ViewpointReport;
use crate::targets::MeasureStatistics;
use belvedere_core::query::{Answer, AnswerCounts, MedialScene, UnprovenAs};
use belvedere_data::report::{percent, rounded};
use serde::Serialize;

/// Obstacles to lines of sight.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinesSection {
    /// Answers of pairs.
    #[serde(flatten)]
    pub(in crate::ask) pairs: Option<PairsSection>,
    pub(in crate::ask) balls: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) patches: Option<usize>,
    pub(in crate::ask) depth_bias_m: f64,
    pub(in crate::ask) shell_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) proof_distance_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) max_unproven_length_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) directions: Option<usize>,
}

impl LinesSection {
    pub(in crate::ask) fn of(blockers: &MedialScene, directions: Option<usize>) -> Self {
        let (rule, proof) = (blockers.params(), blockers.proof());
        Self {
            pairs: None,
            balls: blockers.ball_count(),
            patches: Some(blockers.patch_count()).filter(|count| *count > 0),
            depth_bias_m: rounded(rule.bias, 4),
            shell_m: rounded(rule.shell, 4),
            proof_distance_m: proof.map(|proof| rounded(proof.nearness(), 3)),
            max_unproven_length_m: proof.map(|proof| rounded(proof.tolerance(), 3)),
            directions,
        }
    }

    pub(in crate::ask) fn with_pairs(self, pairs: PairsSection) -> Self {
        Self { pairs: Some(pairs), ..self }
    }
}

/// Number of pairs for each answer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(in crate::ask) struct PairsSection {
    pub(in crate::ask) pairs: usize,
    pub(in crate::ask) visible: usize,
    pub(in crate::ask) blocked: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) unproven: Option<usize>,
    pub(in crate::ask) no_line: usize,
    pub(in crate::ask) outside_cloud: usize,
    /// Lines with an end inside an obstacle, which are neither visible nor blocked.
    pub(in crate::ask) inside_obstacle: usize,
    pub(in crate::ask) visible_percent: f64,
    pub(in crate::ask) observers_inside_obstacle: usize,
    pub(in crate::ask) targets_inside_obstacle: usize,
}

impl PairsSection {
    pub(in crate::ask) fn of(answers: &[Answer], unproven: UnprovenAs, inside: [usize; 2]) -> Self {
        let [observers_inside_obstacle, targets_inside_obstacle] = inside;
        let counts = AnswerCounts::of(answers);
        Self {
            pairs: answers.len(),
            visible: counts.visible,
            blocked: counts.blocked,
            unproven: (unproven == UnprovenAs::Reported).then_some(counts.unproven),
            no_line: counts.outside_view,
            outside_cloud: counts.outside_cloud,
            inside_obstacle: counts.inside_obstacle,
            visible_percent: percent(counts.visible, answers.len()),
            observers_inside_obstacle,
            targets_inside_obstacle,
        }
    }

    /// The answer in two lines.
    pub(in crate::ask) fn headlines(&self) -> [String; 2] {
        let Self { pairs, visible, blocked, visible_percent, .. } = self;
        let unproven = self.unproven.map_or_else(String::new, |unproven| format!(", {unproven} unproven"));
        let rest = self.no_line + self.outside_cloud;
        let inside = match self.inside_obstacle {
            0 => String::new(),
            count => format!(", {count} with an end inside an obstacle"),
        };
        [
            format!("{visible} of {pairs} lines of sight ({visible_percent} %) are visible"),
            format!("{blocked} are blocked{unproven}{inside}, {rest} without an answer"),
        ]
    }
}

/// Certainty of answers, for reports.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CertaintySection {
    /// Number of answers.
    pub(in crate::ask) answers: usize,
    /// Mean probability of being visible or lit.
    pub(in crate::ask) mean_probability: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) certain_from: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) certainly_visible_percent: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) certainly_blocked_percent: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) uncertain_percent: Option<f64>,
}

/// A single line.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LineSection {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) answer: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) first_block_range_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) block_position: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) block_ball: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) block_source: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) block_mesh: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) block_surface: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) block_terrain: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) unproven_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) fresnel_free_percent: Option<f64>,
}

/// A network of lines of sight, for reports.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct NetworkSection {
    pub(in crate::ask) places: usize,
    /// Pairs that see each other.
    pub(in crate::ask) links: usize,
    /// Percentage of the tested pairs.
    pub(in crate::ask) links_percent: f64,
    /// Number of groups of places that see each other, directly or through other places.
    pub(in crate::ask) groups: usize,
    pub(in crate::ask) largest_group: usize,
    pub(in crate::ask) places_without_link: usize,
    /// The place with the maximum number of links, and that number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) max_links: Option<(String, usize)>,
    /// Mean length of the links, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) mean_link_m: Option<f64>,
}

/// Statistics of horizons.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HorizonsSection {
    pub(in crate::ask) azimuths: usize,
    pub(in crate::ask) mean_elevation_deg: f64,
    pub(in crate::ask) max_elevation_deg: f64,
    /// Mean width of the intervals.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) mean_interval_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) azimuths_near_edge_percent: Option<f64>,
}

/// Number of visible targets, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeenSection {
    pub(in crate::ask) targets: usize,
    pub(in crate::ask) visible: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) unproven: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) unproven_percent: Option<f64>,
    pub(in crate::ask) blocked: usize,
    /// Number of blocked targets that lie inside an obstacle themselves; `None` if not tested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) inside_obstacle: Option<usize>,
    pub(in crate::ask) outside_view: usize,
    pub(in crate::ask) outside_cloud: usize,
    pub(in crate::ask) visible_percent: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) visible_m2: Option<f64>,
}

/// A landmark, for reports.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LandmarkSection {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) triangles: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) spacing_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) points: Option<usize>,
    pub(in crate::ask) sample_points: usize,
    pub(in crate::ask) area_m2: f64,
}

/// Protected lines and their limits.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ProtectedViewSection {
    pub(in crate::ask) lines_protected: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) lines_unproven: Option<usize>,
    pub(in crate::ask) lines_blocked: usize,
    pub(in crate::ask) lines_not_tested: usize,
    pub(in crate::ask) cells_limited: usize,
    pub(in crate::ask) area_limited_m2: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) lowest_limit_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) mean_limit_m: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(in crate::ask) viewpoint: Vec<ViewpointReport>,
}

/// Views of towers, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TowersSection {
    /// Number of towers.
    pub(in crate::ask) towers: usize,
    /// Their heights together, metres.
    pub(in crate::ask) height_m: f64,
    /// Schemes, in the order of the bits of the band `schemes`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(in crate::ask) schemes: Vec<String>,
    /// Each tower.
    pub(in crate::ask) each: Vec<TowerSection>,
}

/// A tower, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(in crate::ask) struct TowerSection {
    pub(in crate::ask) name: String,
    /// Height of its foot, in the coordinates of the file.
    pub(in crate::ask) base: f64,
    /// Shares of the places that see a part of it, its tip, and its hub, percent.
    pub(in crate::ask) visible_percent: f64,
    pub(in crate::ask) tip_percent: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) hub_percent: Option<f64>,
    /// The same of the cells of far terrain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) far_visible_percent: Option<f64>,
}

/// Statistics of views from windows.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ViewsSection {
    pub(in crate::ask) directions: usize,
    #[serde(flatten)]
    pub(in crate::ask) measures: NamedValues<Option<MeasureStatistics>>,
}

/// Figures of a plan.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SurveyPlanSection {
    pub(in crate::ask) candidates: EyesReport,
    pub(in crate::ask) max_range_m: f64,
    pub(in crate::ask) angle_step_deg: f64,
    pub(in crate::ask) unproven_lines: usize,
    pub(in crate::ask) unproven_m: f64,
    pub(in crate::ask) stations: Vec<StationSection>,
    pub(in crate::ask) settled_percent: f64,
    pub(in crate::ask) all_candidates_settle_percent: f64,
    pub(in crate::ask) at_most_below_best_percent: f64,
}

/// A station that was chosen, with the sums of all up to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(in crate::ask) struct StationSection {
    pub(in crate::ask) position: [f64; 3],
    pub(in crate::ask) settled_alone: usize,
    pub(in crate::ask) settled_lines: usize,
    pub(in crate::ask) expected_lines: f64,
    pub(in crate::ask) settled_percent: f64,
    pub(in crate::ask) proven_m: f64,
}

/// A view, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ViewSection {
    pub(in crate::ask) width_px: usize,
    pub(in crate::ask) height_px: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) pixel_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) pixel_m_at_100_m: Option<f64>,
    pub(in crate::ask) view_direction: ViewDirection,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(in crate::ask) enum ViewDirection {
    Along(Vec<f64>),
    Around(&'static str),
}

/// A picture, for reports.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PictureSection {
    pub(in crate::ask) pixels_hit_percent: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) balls_around_eye_ignored: Option<usize>,
}
