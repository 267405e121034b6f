//! Steps: upright sheets between roofs that lie close above each other.

use super::block::Block;
use super::edges::{EdgeLine, Outline};
use super::line::PlanLine;
use super::patches::{Patch, Sheet};
use super::roof_planes::Roofs;
use belvedere_data::patches::PatchKind;

/// Parameters of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StepParams {
    /// Minimum and maximum height of a step between roofs, metres. Default 0.25 to 1.8: balconies lie farther below
    /// each other.
    pub(super) heights: [f64; 2],
    /// Maximum height of an object on a roof with steps all round, metres. Default 3.5.
    pub(super) max_object_height: f64,
    /// Minimum share of the pulses that pass an edge which end on the roof below, and of the edges of an object which
    /// stand on it. Default 0.6.
    pub(super) min_share: f64,
    /// Minimum number of those pulses. Default 3.
    pub(super) min_pulses: usize,
    /// Maximum distance of the pulses beyond an edge, spacings. Default 2.5.
    pub(super) reach_spacings: f64,
}

impl Default for StepParams {
    fn default() -> Self {
        Self { heights: [0.25, 1.8], max_object_height: 3.5, min_share: 0.6, min_pulses: 3, reach_spacings: 2.5 }
    }
}

/// The plane that most pulses end on which pass an edge close to it.
fn find_lower_roof(
    roofs: &Roofs,
    plane: usize,
    outline: &Outline,
    line: &PlanLine,
    params: &StepParams,
) -> Option<usize> {
    let reach = params.reach_spacings * roofs.planes[plane].spacing;
    let mut on: Vec<Option<u32>> = Vec::new();
    for passed in &outline.samples.passed {
        let [t, d] = line.of(passed.p);
        if (line.ends[0]..=line.ends[1]).contains(&t) && (-0.1..=reach).contains(&d) {
            on.push(passed.on);
        }
    }
    on.sort_unstable();
    let counts = on.chunk_by(|a, b| a == b).filter_map(|same| Some((same.len(), same[0]?)));
    let (count, lower) = counts.max()?;
    let is_enough = count >= params.min_pulses && count as f64 >= params.min_share * on.len() as f64;
    is_enough.then_some(lower as usize)
}

/// Returns sheets from the edges of a roof down to roofs close below them, and down to the roof that it stands on.
pub(super) fn patches(
    block: &Block,
    roofs: &Roofs,
    plane: usize,
    outline: &Outline,
    params: &StepParams,
) -> Vec<Patch> {
    let [min_height, max_height] = params.heights;
    let steps: Vec<(&EdgeLine, usize)> = outline
        .sure_edges()
        .filter(|edge| (min_height..=params.max_object_height).contains(&edge.drop))
        .filter_map(|edge| Some((edge, find_lower_roof(roofs, plane, outline, &edge.line, params)?)))
        .collect();
    let all: f64 = outline.sure_edges().map(|edge| edge.line.length()).sum();
    let is_step = |(edge, lower): &&(&EdgeLine, usize)| {
        let onto: f64 = steps.iter().filter(|step| step.1 == *lower).map(|step| step.0.line.length()).sum();
        edge.drop <= max_height || onto >= params.min_share * all
    };
    let sheet = |&(edge, lower): &(&EdgeLine, usize)| {
        let (line, roof, below) = (&edge.line, &roofs.planes[plane].plane, &roofs.planes[lower].plane);
        let ends = line.end_points().map(|p| [below.height(p), roof.height(p)]);
        let heights = [ends[0][0].min(ends[1][0]), ends[0][1].max(ends[1][1])];
        let sheet = Sheet { line, ranges: line.ends, heights, kind: PatchKind::Step };
        sheet.patches(block, |p| roof.height(p), |p| below.height(p))
    };
    steps.iter().filter(is_step).flat_map(sheet).collect()
}
