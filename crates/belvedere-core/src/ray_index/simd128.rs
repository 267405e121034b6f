//! Eight boxes in WebAssembly: the same arithmetic as [`super::walk::RayScalar`], in the same order.

use super::walk::{LANES, Test, TreeRay};
use crate::f32x8::Eight;
use obvhs::cwbvh::node::CwBvhNode;

pub(super) struct RaySimd128;

/// The part of a ray, from and to, that also lies between the low and the high sides along an axis.
#[inline(always)]
fn cut(part: [Eight; 2], low: [u8; LANES], high: [u8; LANES], scale: [f32; 3]) -> [Eight; 2] {
    let [scale, start_low, start_high] = scale.map(Eight::all);
    let low = Eight::of_bytes(low) * scale + start_low;
    let high = Eight::of_bytes(high) * scale + start_high;
    [part[0].max(low.min(high)), part[1].min(low.max(high))]
}

impl Test for RaySimd128 {
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "eight bits")]
    fn met(node: &CwBvhNode, ray: &TreeRay) -> u8 {
        let [x, y, z] = ray.scale(node);
        let part = [Eight::all(0.0), Eight::all(ray.reach)];
        let part = cut(part, node.child_min_x, node.child_max_x, x);
        let part = cut(part, node.child_min_y, node.child_max_y, y);
        let [from, to] = cut(part, node.child_min_z, node.child_max_z, z);
        from.at_most(to) as u8
    }
}
