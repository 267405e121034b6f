//! Parapets along edges of roofs: rows of points at one height.

use super::block::Block;
use super::fit::Plane;
use super::line::PlanLine;
use super::patches::{Patch, Sheet};
use super::samples::Samples;
use belvedere_data::patches::PatchKind;
use std::cmp::Ordering;

/// Parameters of parapets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ParapetParams {
    /// Heights of the points of parapets above the roof, metres. Default 0.15 to 1.6.
    pub(super) heights: [f64; 2],
    /// Maximum distance of its points inside the edge, metres. Default 0.6.
    pub(super) max_inside: f64,
    /// Maximum distance of its points outside the edge, metres. Default 0.25.
    pub(super) max_outside: f64,
    /// Half the difference of their heights, metres. Default 0.06.
    pub(super) level: f64,
    /// Length of the pieces of an edge that they must be on, metres. Default 0.8.
    pub(super) piece: f64,
    /// Minimum share of these pieces. Default 0.55.
    pub(super) min_share: f64,
}

impl Default for ParapetParams {
    fn default() -> Self {
        Self { heights: [0.15, 1.6], max_inside: 0.6, max_outside: 0.25, level: 0.06, piece: 0.8, min_share: 0.55 }
    }
}

/// Parapet of one height along an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Parapet {
    /// Metres above the plane; 0 where nothing stands.
    pub(super) height: f64,
    /// Distance from the edge to its inner face, metres.
    pub(super) width: f64,
}

/// The points that stand along an edge at one height; none where there are too few.
pub(super) fn find(samples: &Samples, line: &PlanLine, params: &ParapetParams) -> Parapet {
    // height above the roof, range, distance from the edge
    let mut on: Vec<[f64; 3]> = Vec::new();
    for standing in &samples.standing {
        let [t, d] = line.of(standing.p);
        let is_beside =
            (-params.max_inside..=params.max_outside).contains(&d) && (line.ends[0]..=line.ends[1]).contains(&t);
        if is_beside && (params.heights[0]..=params.heights[1]).contains(&standing.above) {
            on.push([standing.above, t, d]);
        }
    }
    on.sort_unstable_by(|a, b| (0..3).fold(Ordering::Equal, |order, i| order.then(a[i].total_cmp(&b[i]))));
    let (mut best, mut last) = ((0, 0), 0);
    for first in 0..on.len() {
        while last < on.len() && on[last][0] <= on[first][0] + 2.0 * params.level {
            last += 1;
        }
        if last - first > best.1 - best.0 {
            best = (first, last);
        }
    }
    let on = &on[best.0..best.1];
    let pieces = line.pieces(params.piece);
    let mut holds = vec![false; pieces.count];
    for &[_, t, _] in on {
        holds[pieces.number(t)] = true;
    }
    let held = holds.iter().filter(|&&holds| holds).count();
    if held < 2 || (held as f64) < params.min_share * pieces.count as f64 {
        return Parapet::default();
    }
    // how far right of the edge, and whether it is on top
    let mut across: Vec<(f64, bool)> = on.iter().map(|p| (p[2], true)).collect();
    across.extend(samples.inside[..samples.own].iter().filter_map(|&p| {
        let [t, d] = line.of(p);
        let is_beside = (-params.max_inside..=0.0).contains(&d) && (line.ends[0]..=line.ends[1]).contains(&t);
        is_beside.then_some((d, false))
    }));
    Parapet { height: on[on.len() / 2][0], width: -inner_face(across, params.max_inside) }
}

/// Returns the position of the inner face of a parapet, metres to the right of its edge. It minimises the number of
/// points of its top to the left, and of the roof to the right. Without any it lies `max_inside` to the left.
fn inner_face(mut across: Vec<(f64, bool)>, max_inside: f64) -> f64 {
    across.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut wrong = across.iter().filter(|point| !point.1).count();
    let (mut least, mut face) = (wrong, -max_inside);
    for (number, &(d, is_on_top)) in across.iter().enumerate() {
        wrong = if is_on_top { wrong + 1 } else { wrong - 1 };
        if wrong < least {
            let next = across.get(number + 1).map_or(0.0, |point| point.0);
            (least, face) = (wrong, f64::midpoint(d, next));
        }
    }
    face.min(0.0)
}

/// Both faces of the parapet along a line.
pub(super) fn faces(block: &Block, roof: &Plane, line: &PlanLine, parapet: &Parapet) -> Vec<Patch> {
    let rise = parapet.height / roof.normal[2];
    let inner = line.moved(-parapet.width).turned();
    let face = |line: &PlanLine| {
        let ends = line.end_points().map(|p| roof.height(p));
        let heights = [ends[0].min(ends[1]), ends[0].max(ends[1]) + rise];
        let sheet = Sheet { line, ranges: line.ends, heights, kind: PatchKind::Parapet };
        sheet.patches(block, |p| roof.height(p) + rise, |p| roof.height(p))
    };
    [line, &inner].into_iter().flat_map(face).collect()
}
