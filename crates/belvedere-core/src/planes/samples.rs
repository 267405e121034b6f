//! Samples of where a plane ends: returns within it, and pulses that passed it.

use super::block::Block;
use super::ridges::{RidgeLine, convex};
use super::roof_planes::Roofs;
use belvedere_data::cast::to_index;
use belvedere_data::vector::box_around;

/// Parameters of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SampleParams {
    /// Minimum depth below the plane at which a pulse that passed it ends, metres. Default 0.15. With 0.3, pulses that
    /// meet the wall close below an edge are left out, and edges lie a centimetre too far out.
    pub(super) min_depth: f64,
    /// Maximum height above the plane of points of buildings that show that the building goes on, metres. Default 4.
    pub(super) max_height: f64,
    /// Maximum distance of samples from the returns of the plane, spacings. Default 4.5.
    pub(super) reach_spacings: f64,
}

impl Default for SampleParams {
    fn default() -> Self {
        Self { min_depth: 0.15, max_height: 4.0, reach_spacings: 4.5 }
    }
}

/// A place in plan where a pulse passed the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passed {
    pub(super) p: [f64; 2],
    /// Depth below the plane at which it ended, metres.
    pub(super) depth: f64,
    /// True if that is deep enough to show where the plane ends.
    pub(super) is_deep: bool,
    /// The plane it ended on, `None` for none.
    pub(super) on: Option<u32>,
}

/// A return of a building above a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    pub(super) p: [f64; 2],
    /// Height above the plane, metres.
    pub(super) above: f64,
    /// Height, metres.
    pub(super) height: f64,
    /// True if it lies on no plane of its own, or on one that is no larger than a box.
    pub(super) is_loose: bool,
}

/// Returns within a plane and pulses that passed it, in plan.
#[derive(Clone, Debug, Default)]
pub(super) struct Samples {
    /// Returns within: of the plane, and of objects on it.
    pub(super) inside: Vec<[f64; 2]>,
    /// Number of these, from the first, that belong to the plane itself.
    pub(super) own: usize,
    /// Returns of the plane whose pulse went on beside it. Where a beam is split the edge lies in its middle, wherever
    /// the return is: it is no more within than without.
    pub(super) split: Vec<[f64; 2]>,
    /// Pulses that passed near it.
    pub(super) passed: Vec<Passed>,
    /// Points that stand on the plane.
    pub(super) standing: Vec<Standing>,
}

/// A coarse picture in plan of where a plane has returns.
struct Near {
    low: [f64; 2],
    cell: f64,
    size: [usize; 2],
    holds: Vec<bool>,
}

impl Near {
    /// The cells within about `reach` of points.
    fn new(points: &[[f64; 2]], reach: f64) -> Self {
        let [low, high] = box_around(points.iter().copied());
        let [low, high] = [low.map(|v| v - reach), high.map(|v| v + reach)];
        let cell = reach / 2.0;
        let size = [0, 1].map(|axis| to_index((high[axis] - low[axis]) / cell) + 1);
        let mut near = Self { low, cell, size, holds: vec![false; size[0] * size[1]] };
        for p in points {
            let [column, row] = [0, 1].map(|axis| to_index((p[axis] - low[axis]) / cell));
            for row in row.saturating_sub(2)..=(row + 2).min(size[1] - 1) {
                for column in column.saturating_sub(2)..=(column + 2).min(size[0] - 1) {
                    near.holds[row * size[0] + column] = true;
                }
            }
        }
        near
    }

    fn high(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.low[axis] + self.size[axis] as f64 * self.cell)
    }

    fn holds(&self, p: [f64; 2]) -> bool {
        if (0..2).any(|axis| p[axis] < self.low[axis]) {
            return false;
        }
        let [column, row] = [0, 1].map(|axis| to_index((p[axis] - self.low[axis]) / self.cell));
        column < self.size[0] && row < self.size[1] && self.holds[row * self.size[0] + column]
    }
}

impl Samples {
    /// The pulses that passed and ended deep enough below the plane.
    pub(super) fn deep(&self) -> impl Iterator<Item = &Passed> {
        self.passed.iter().filter(|passed| passed.is_deep)
    }
}

/// Returns the samples of a plane.
pub(super) fn find(block: &Block, roofs: &Roofs, ridges: &[RidgeLine], plane: usize, params: &SampleParams) -> Samples {
    let roof = &roofs.planes[plane];
    let mut inside: Vec<[f64; 2]> = Vec::with_capacity(roof.rows.len() * 5 / 4);
    let mut split = Vec::new();
    for row in roofs.returns_of(roof) {
        let found = &block.returns[row];
        let [x, y, _] = found.p;
        // where the pulse meets the plane noise of the range does not matter
        let p = roof.plane.crossing(found.p, found.lean).unwrap_or([x, y]);
        if found.is_split { &mut split } else { &mut inside }.push(p);
    }
    let own = inside.len();
    let all: Vec<[f64; 2]> = inside.iter().chain(&split).copied().collect();
    let near = Near::new(&all, params.reach_spacings * roof.spacing);
    let beyond: Vec<usize> = convex(ridges, plane).map(|(_, other)| other).collect();
    let (mut passed, mut standing) = (Vec::new(), Vec::new());
    let (low, high) = (near.low, near.high());
    let corners = [[low[0], low[1]], [low[0], high[1]], [high[0], low[1]], [high[0], high[1]]];
    let top = corners.iter().map(|&p| roof.plane.height(p)).fold(f64::NEG_INFINITY, f64::max);
    let shift = block.max_shift(top);
    block.each_in([0, 1].map(|i| low[i] - shift), [0, 1].map(|i| high[i] + shift), |row, found| {
        let on = roofs.plane_of_return[row];
        let on_plane = on.map(|on| on as usize);
        if on_plane == Some(plane) {
            return;
        }
        let above = roof.plane.distance_above(found.p);
        let at = [found.p[0], found.p[1]];
        if above > 0.0 {
            if found.may_be_building() && above < params.max_height && above > 3.0 * roofs.noise && near.holds(at) {
                inside.push(at);
                let is_loose = on_plane.is_none_or(|on| roofs.planes[on].is_small);
                standing.push(Standing { p: at, above, height: found.p[2], is_loose });
            }
            return;
        }
        let is_beyond = on_plane.is_some_and(|on| beyond.contains(&on));
        if !found.is_first || above > -(4.0 * roofs.noise).max(0.1) || is_beyond {
            return;
        }
        if let Some(p) = roof.plane.crossing(found.p, found.lean).filter(|&p| near.holds(p)) {
            passed.push(Passed { p, depth: -above, is_deep: -above > params.min_depth, on });
        }
    });
    Samples { inside, own, split, passed, standing }
}
