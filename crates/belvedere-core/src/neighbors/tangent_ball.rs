//! The largest ball tangent at a point that no other point enters: nearest neighbours in a pencil of balls.

use super::lanes::{LANES, Lanes, PointTree};
use super::search::{Pending, set_lanes};
use super::tangent::Tangent;

/// Squared distance from the centre up to which a box may hold a point inside the ball of `radius`.
///
/// Rounding of f32 moves the centre by a few parts in ten million of its coordinates and the distance by as much of the
/// radius. A box dropped for that could hold a point that cuts a 200 m ball to a tenth, so boxes get four times that
/// room.
#[inline(always)]
fn box_bound(center: [f32; 3], radius: f32) -> f32 {
    let reach = radius * (1.0 + 1e-6) + 2.5e-7 * (center[0].abs() + center[1].abs() + center[2].abs());
    reach * reach
}

/// Branch and bound: the balls of a pencil are nested, so a ball that shrinks never meets a box again that it missed.
#[inline(always)]
pub(super) fn search<L: Lanes>(tree: &PointTree, tangent: &Tangent, max_radius: f32) -> Option<(f32, u32)> {
    if tree.is_empty() || !(max_radius > 0.0) {
        return None;
    }
    let mut radius = max_radius.next_down().min(1e18);
    let mut touch = u32::MAX;
    let mut center = tangent.center(radius);
    let mut bound = box_bound(center, radius);
    let mut values = [0.0; LANES];
    let mut pending = Pending::root();
    while let Some((_, child)) = pending.pop() {
        match child.open() {
            Ok(node) => {
                let node = &tree.nodes[node];
                let mask = L::boxes(node, center, bound, &mut values);
                pending.push(mask, &values, &node.children);
            }
            Err(blocks) => {
                let before = radius;
                for block in blocks {
                    let mask = L::tangent_radii(&tree.blocks[block], tangent, radius, &mut values);
                    for lane in set_lanes(mask) {
                        let found = tree.order[block * LANES + lane];
                        if values[lane] < radius || (values[lane] == radius && found < touch) {
                            radius = values[lane];
                            touch = found;
                        }
                    }
                }
                if radius < before {
                    center = tangent.center(radius);
                    bound = box_bound(center, radius);
                }
            }
        }
    }
    (touch != u32::MAX).then_some((radius, touch))
}
