//! The space that all lines of sight of a box of targets run through.

use super::blockers::IndexNode;
use super::lanes::ConvexSpace;
use crate::query::target_tree::TargetNode;
use belvedere_data::vector::{cross, dot, sub, to_f32};

/// Origin of beams.
#[derive(Clone, Copy)]
pub(super) enum Apex {
    /// Local metres.
    Eye([f64; 3]),
    /// Unit vector.
    Direction([f64; 3]),
}

/// Size of a node, in widths of the beam, above which it is opened. With less, balls that only a part of the beam meets
/// are tested for all of it. With more, parts of the beam open the same nodes again. For targets on the ground of a
/// town 2 and 3.2 take 5 % longer.
const OPENED_SHARE: f32 = 2.5;

/// All lines of sight of a box of targets lie between these planes.
pub(super) struct Beam {
    /// Two on either side, one behind the targets and one behind the eye; widened by the rounding of f32.
    pub(super) space: ConvexSpace,
    /// Width of the beam as a linear function of the position: at the local origin, and how it grows.
    width: f32,
    growth: [f32; 3],
}

impl Beam {
    /// The beam from `apex` over the targets of a node, whose outline has these `corners`, widened by `room` metres.
    pub(super) fn new(apex: Apex, room: f64, corners: &[[f64; 3]], target: &TargetNode) -> Self {
        let width = (0..3).map(|i| f64::from(target.high[i]) - f64::from(target.low[i])).fold(0.0, f64::max);
        let middle =
            std::array::from_fn(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / corners.len() as f64);
        let forward = match apex {
            Apex::Eye(eye) => belvedere_data::vector::unit(sub(middle, eye)),
            Apex::Direction(direction) => Some(direction),
        };
        let mut beam = Self { space: ConvexSpace::all(), width: 0.0, growth: [0.0; 3] };
        let mut bound = |plane: usize, normal: [f64; 3], offset: f64| {
            beam.space.set(plane, normal.map(to_f32), to_f32(offset + room));
        };
        let range = |value: &dyn Fn(&[f64; 3]) -> f64| {
            let values = corners.iter().map(value);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
        };
        let mut growth = [0.0; 3];
        let mut start_width = width;
        if let Some(forward) = forward {
            let up = if forward[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
            let right = belvedere_data::vector::unit(cross(forward, up)).unwrap_or([1.0, 0.0, 0.0]);
            let sides = [right, cross(right, forward)];
            let [near, far] = range(&|corner| dot(*corner, forward));
            match apex {
                Apex::Direction(_) => {
                    for (number, side) in sides.into_iter().enumerate() {
                        let [low, high] = range(&|corner| dot(*corner, side));
                        bound(2 * number, side, high);
                        bound(2 * number + 1, side.map(|v| -v), -low);
                    }
                    bound(4, forward.map(|v| -v), -near);
                }
                Apex::Eye(eye) => {
                    bound(4, forward, far);
                    let start = dot(eye, forward);
                    let slopes = |side: [f64; 3]| {
                        range(&|corner| dot(sub(*corner, eye), side) / (dot(*corner, forward) - start))
                    };
                    // an eye between the targets, or almost, sees them all around
                    if near - start > 10.0 * room {
                        for (number, side) in sides.into_iter().enumerate() {
                            let [low, high] = slopes(side);
                            let edge = |slope: f64| -> [f64; 3] {
                                let normal: [f64; 3] = std::array::from_fn(|i| side[i] - slope * forward[i]);
                                let length = belvedere_data::vector::length(normal);
                                normal.map(|v| v / length)
                            };
                            let [left, right] = [edge(low).map(|v| -v), edge(high)];
                            bound(2 * number, right, dot(right, eye));
                            bound(2 * number + 1, left, dot(left, eye));
                        }
                        bound(5, forward.map(|v| -v), -start);
                        growth = forward.map(|v| v * width / (far - start));
                        start_width = -start * width / (far - start);
                    } else {
                        bound(4, [0.0; 3], f64::from(f32::MAX));
                    }
                }
            }
        }
        {
            beam.width = to_f32(start_width);
            beam.growth = growth.map(to_f32);
        }
        beam
    }

    /// Returns true if a node is large against the beam there.
    #[inline(always)]
    pub(super) fn is_narrower_than(&self, IndexNode { sides: [x, y, z], .. }: &IndexNode) -> bool {
        let size = (x[1] - x[0]).max(y[1] - y[0]).max(z[1] - z[0]);
        let center = [0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.5 * (z[0] + z[1])];
        size > OPENED_SHARE * (self.width + dot(self.growth, center))
    }
}
