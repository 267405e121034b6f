//! The largest ball tangent at a point that no other point enters: nearest neighbours in a pencil of balls.

use super::NeighborIndex;
use super::lanes::{LANES, Lanes};
use super::search::{Pending, set_lanes};

/// A pencil of balls: all that touch, at one point, the plane across one direction.
#[derive(Clone, Copy, Debug)]
pub struct Tangent {
    /// A point of the surface, local metres.
    pub point: [f32; 3],
    /// Unit vector from there to the centres.
    pub inward: [f32; 3],
    /// Distance inward of `point` at which the balls touch, metres; the point itself and its noise stay outside them.
    pub margin: f32,
}

impl Tangent {
    /// Centre of the ball of `radius`.
    #[inline(always)]
    #[must_use]
    pub fn center(&self, radius: f32) -> [f32; 3] {
        std::array::from_fn(|i| self.point[i] + self.inward[i] * (radius + self.margin))
    }
}

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
pub(super) fn search<L: Lanes>(index: &NeighborIndex, tangent: &Tangent, max_radius: f32) -> Option<(f32, u32)> {
    if index.is_empty() || !(max_radius > 0.0) {
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
                let node = &index.nodes[node];
                let mask = L::boxes(node, center, bound, &mut values);
                pending.push(mask, &values, &node.children);
            }
            Err(blocks) => {
                let before = radius;
                for block in blocks {
                    let mask = L::tangent_radii(&index.blocks[block], tangent, radius, &mut values);
                    for lane in set_lanes(mask) {
                        let found = index.order[block * LANES + lane];
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
