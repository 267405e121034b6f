//! Eight lanes in WebAssembly: the same arithmetic as [`super::lanes::BeamScalar`], in the same order.

use super::blockers::LANES;
use super::lanes::{BeamScalar, ConvexSpace, HalfLine, Kernels, LaneBits, LaneColumns, PLANES};
use crate::blocking::Ball;
use crate::f32x8::Eight;
use crate::ray_index::PartSides;

pub(super) struct BeamSimd128;

/// Returns the depth of places behind a plane, metres.
#[inline(always)]
fn depth(space: &ConvexSpace, plane: usize, [x, y, z]: [Eight; 3]) -> Eight {
    let [a, b, c] = space.normals[plane].map(Eight::all);
    Eight::all(space.offsets[plane]) - a * x - b * y - c * z
}

#[inline(always)]
fn dot(a: [Eight; 3], b: [Eight; 3]) -> Eight {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Kernels for BeamSimd128 {
    #[inline(always)]
    fn meet_boxes(space: &ConvexSpace, sides: &PartSides) -> LaneBits {
        let mut min = Eight::all(f32::INFINITY);
        for plane in 0..PLANES {
            let [x, y, z] = space.inward[plane].map(|side| usize::from(side & 1));
            let corner = [Eight::of(&sides[0][x]), Eight::of(&sides[1][y]), Eight::of(&sides[2][z])];
            min = min.min(depth(space, plane, corner));
        }
        LaneBits(Eight::all(0.0).at_most(min))
    }

    #[inline(always)]
    fn meet_balls(space: &ConvexSpace, [x, y, z, radius]: &LaneColumns) -> LaneBits {
        let (center, radius) = ([Eight::of(x), Eight::of(y), Eight::of(z)], Eight::of(radius));
        let mut min = radius;
        for plane in 0..PLANES {
            min = min.min(depth(space, plane, center));
        }
        LaneBits((Eight::all(0.0) - radius).at_most(min))
    }

    #[inline(always)]
    fn may_cover(space: &ConvexSpace, [x, y, z, radius]: &LaneColumns) -> LaneBits {
        let (center, radius) = ([Eight::of(x), Eight::of(y), Eight::of(z)], Eight::of(radius));
        let across = depth(space, 0, center).max(depth(space, 1, center));
        let along = depth(space, 2, center).max(depth(space, 3, center));
        LaneBits((across * across + along * along).at_most(radius * radius))
    }

    #[inline(always)]
    fn near_line([x, y, z, radius]: &LaneColumns, line: &HalfLine) -> LaneBits {
        let (from, [dx, dy, dz]) = (line.origin.map(Eight::all), line.direction.map(Eight::all));
        let [mx, my, mz] = [Eight::of(x) - from[0], Eight::of(y) - from[1], Eight::of(z) - from[2]];
        let across = [my * dz - mz * dy, mz * dx - mx * dz, mx * dy - my * dx];
        let reach = Eight::of(radius) + Eight::all(line.room);
        let zero = Eight::all(0.0);
        let is_beside = dot(across, across).at_most(reach * reach);
        let is_ahead = (zero - reach).at_most(dot([mx, my, mz], [dx, dy, dz]));
        LaneBits(is_beside & is_ahead & zero.less_than(reach))
    }

    #[inline(always)]
    fn columns(balls: &[Ball; LANES]) -> LaneColumns {
        BeamScalar::<false>::columns(balls)
    }
}
