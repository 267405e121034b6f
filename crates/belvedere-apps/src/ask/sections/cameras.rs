//! Figures of cameras.

use crate::cameras::{CoverageReport, Placement};
use crate::eyes::EyesReport;
use belvedere_data::report::{percent, rounded};
use serde::Serialize;

/// Report of a selection of cameras.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CamerasReport {
    pub(in crate::ask) targets: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) private_places: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) existing_camera_places: Option<EyesReport>,
    pub(in crate::ask) candidate_places: EyesReport,
    pub(in crate::ask) cameras_to_choose_from: ChoiceSection,
    pub(in crate::ask) pictures: PicturesSection,
    pub(in crate::ask) coverage: CoverageSection,
}

/// Cameras that could be chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(in crate::ask) struct ChoiceSection {
    pub(in crate::ask) count: usize,
    pub(in crate::ask) see_private_places: usize,
    pub(in crate::ask) existing: usize,
}

/// Targets in the pictures of cameras.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(in crate::ask) struct PicturesSection {
    pixels_per_m: f64,
    #[serde(flatten)]
    lines: CoverageReport,
    covered_pairs: usize,
}

/// Coverage of the selected cameras.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(in crate::ask) struct CoverageSection {
    new_cameras: usize,
    coverage_percent: f64,
    best_possible_percent: f64,
    at_most_below_best_percent: f64,
    is_proven_optimum: bool,
    all_candidates_percent: f64,
    existing_only_percent: f64,
    targets_covered_percent: f64,
    targets_never_covered: usize,
    branches_searched: usize,
    #[serde(rename = "least_possible_cameras", skip_serializing_if = "Option::is_none")]
    min_possible_cameras: Option<usize>,
}

impl PicturesSection {
    pub(in crate::ask) fn fill(&mut self, density: f64, lines: CoverageReport, covered_pairs: usize) {
        *self = Self { pixels_per_m: rounded(density, 3), lines, covered_pairs };
    }
}

impl CoverageSection {
    pub(in crate::ask) fn fill(&mut self, placed: &Placement, weights: &[f64], per_target: u32) {
        let in_percent = |share: f64| rounded(100.0 * share, 3);
        let counting: Vec<u32> =
            weights.iter().zip(&placed.counts).filter(|(weight, _)| **weight > 0.0).map(|(_, count)| *count).collect();
        let with = |min: u32| counting.iter().filter(|count| **count >= min).count();
        *self = Self {
            new_cameras: placed.chosen.len(),
            coverage_percent: in_percent(placed.coverage()),
            best_possible_percent: in_percent(placed.bound),
            at_most_below_best_percent: in_percent(placed.gap()),
            is_proven_optimum: placed.is_optimal(),
            all_candidates_percent: in_percent(placed.reachable),
            existing_only_percent: in_percent(placed.curve.first().copied().unwrap_or(0.0)),
            targets_covered_percent: percent(with(per_target), counting.len()),
            targets_never_covered: counting.len() - with(1),
            branches_searched: placed.branches,
            min_possible_cameras: placed.min_count,
        };
    }

    /// The answer in words.
    pub(in crate::ask) fn headlines(&self, existing: usize, weights: &[f64], certain: Option<f64>) -> Vec<String> {
        let counting = weights.iter().filter(|weight| **weight > 0.0).count();
        let and_existing = if existing > 0 { format!(" and {existing} existing ones") } else { String::new() };
        let certainty =
            certain.map_or(String::new(), |certain| format!(" with a certainty of {} %", rounded(100.0 * certain, 2)));
        let (new, covered, best) = (self.new_cameras, self.coverage_percent, self.best_possible_percent);
        let proof = match (self.is_proven_optimum, self.min_possible_cameras) {
            (true, _) => "no other choice is better".to_owned(),
            (false, Some(min)) => format!("no choice needs fewer than {min} new cameras"),
            (false, None) => format!("no choice of as many covers more than {best} %"),
        };
        vec![
            format!("{new} new cameras{and_existing} cover {covered} % of {counting} targets{certainty}"),
            format!("{proof}; all candidates together cover {} %", self.all_candidates_percent),
        ]
    }
}
