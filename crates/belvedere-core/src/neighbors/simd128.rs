//! Eight lanes in WebAssembly: the same arithmetic as [`super::lanes::NeighborScalar`], in the same order.

use super::lanes::{LANES, LaneBlock, Lanes, WideNode};
use super::tangent::Tangent;
use crate::f32x8::Eight;

pub(super) struct NeighborSimd128;

#[inline(always)]
fn passing(values: Eight, bound: f32, out: &mut [f32; LANES]) -> u32 {
    *out = values.into_array();
    values.at_most(Eight::all(bound))
}

impl Lanes for NeighborSimd128 {
    #[inline(always)]
    fn boxes(node: &WideNode, query: [f32; 3], bound: f32, out: &mut [f32; LANES]) -> u32 {
        let gap = |low: &[f32; LANES], high: &[f32; LANES], q: f32| {
            let q = Eight::all(q);
            let gap = (Eight::of(low) - q).max(q - Eight::of(high)).max(Eight::all(0.0));
            gap * gap
        };
        let x = gap(&node.low.x, &node.high.x, query[0]);
        let y = gap(&node.low.y, &node.high.y, query[1]);
        let z = gap(&node.low.z, &node.high.z, query[2]);
        passing(x + y + z, bound, out)
    }

    #[inline(always)]
    fn points(block: &LaneBlock, query: [f32; 3], bound: f32, out: &mut [f32; LANES]) -> u32 {
        let square = |lanes: &[f32; LANES], q: f32| {
            let d = Eight::of(lanes) - Eight::all(q);
            d * d
        };
        passing(square(&block.x, query[0]) + square(&block.y, query[1]) + square(&block.z, query[2]), bound, out)
    }

    #[inline(always)]
    fn tangent_radii(block: &LaneBlock, tangent: &Tangent, bound: f32, out: &mut [f32; LANES]) -> u32 {
        let Tangent { point, inward, margin } = *tangent;
        let along =
            |lanes: &[f32; LANES], i: usize| Eight::of(lanes) - Eight::all(point[i]) - Eight::all(margin * inward[i]);
        let (x, y, z) = (along(&block.x, 0), along(&block.y, 1), along(&block.z, 2));
        let depth = x * Eight::all(inward[0]) + y * Eight::all(inward[1]) + z * Eight::all(inward[2]);
        let radii = (x * x + y * y + z * z) / (depth + depth);
        passing(radii, bound, out) & Eight::all(0.0).less_than(depth)
    }
}
