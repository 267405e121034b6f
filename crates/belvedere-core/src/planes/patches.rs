//! Triangles of surfaces in a block: convex polygons, and upright sheets.

use super::block::{BLOCK, Block};
use super::line::{PlanLine, SLIVER, area, clip};
use belvedere_data::patches::{PatchKind, PatchTriangle};
use belvedere_data::vector::to_f32;

/// A triangle of a surface, local metres, and the kind of the surface.
pub(super) type Patch = (PatchTriangle, PatchKind);

/// Returns a convex polygon, counter-clockwise seen from outside, as triangles about its first corner.
pub(super) fn fan(block: &Block, corners: &[[f64; 3]], kind: PatchKind) -> Vec<Patch> {
    let local = |p: [f64; 3]| block.local(p).map(to_f32);
    let Some((&first, rest)) = corners.split_first() else { return Vec::new() };
    rest.windows(2).map(|pair| ([local(first), local(pair[0]), local(pair[1])], kind)).collect()
}

/// An upright rectangle on a line.
pub(super) struct Sheet<'a> {
    pub(super) line: &'a PlanLine,
    pub(super) ranges: [f64; 2],
    pub(super) heights: [f64; 2],
    pub(super) kind: PatchKind,
}

impl Sheet<'_> {
    /// Returns it as far as it lies below and above two heights, linear in plan, and in the block.
    pub(super) fn patches(
        &self,
        block: &Block,
        below: impl Fn([f64; 2]) -> f64,
        above: impl Fn([f64; 2]) -> f64,
    ) -> Vec<Patch> {
        let ([t0, t1], [z0, z1], line) = (self.ranges, self.heights, self.line);
        if !(t0 < t1 && z0 < z1) {
            return Vec::new();
        }
        let mut polygon = vec![[t0, z0], [t1, z0], [t1, z1], [t0, z1]];
        polygon = clip(&polygon, |[t, z]| z - below(line.at(t, 0.0)));
        polygon = clip(&polygon, |[t, z]| above(line.at(t, 0.0)) - z);
        for axis in 0..2 {
            polygon = clip(&polygon, |[t, _]| -line.at(t, 0.0)[axis]);
            polygon = clip(&polygon, |[t, _]| line.at(t, 0.0)[axis] - BLOCK);
        }
        if area(&polygon) < SLIVER {
            return Vec::new();
        }
        let corner = |&[t, z]: &[f64; 2]| {
            let [x, y] = line.at(t, 0.0);
            [x, y, z]
        };
        let corners: Vec<[f64; 3]> = polygon.iter().map(corner).collect();
        fan(block, &corners, self.kind)
    }
}
