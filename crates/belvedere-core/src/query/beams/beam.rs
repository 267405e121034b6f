//! The space that all lines of sight of a box of targets run through.

use super::blockers::{LANES, Node};
use super::{Apex, OPENED_SHARE, Sweep};
use crate::query::target_tree::TargetNode;
use crate::ray_index::{PARTS, Parts};
use belvedere_data::vector::{cross, dot, sub};

/// All lines of sight of a box of targets lie between these planes.
pub(super) struct Beam {
    /// Outward unit normals, and how far out the planes lie along them, local metres; widened by what f32 rounds.
    normals: [[f32; 3]; PLANES],
    offsets: [f32; PLANES],
    /// Width of the beam as a linear function of the position: at the local origin, and how it grows.
    width: f32,
    growth: [f32; 3],
}

/// Two on either side, one behind the targets and one behind the eye.
const PLANES: usize = 6;

/// What a beam has to do with some balls.
pub(super) struct Met {
    /// It may meet the ball.
    pub(super) is_hit: [bool; LANES],
    /// The ball reaches about as far on all sides as the beam: worth the exact question whether it hides all of it.
    pub(super) may_be_covered: [bool; LANES],
}

impl Beam {
    pub(super) fn new(sweep: &Sweep<'_>, target: &TargetNode) -> Self {
        let corners = target.corners(0.0);
        let width = (0..3).map(|i| f64::from(target.high[i]) - f64::from(target.low[i])).fold(0.0, f64::max);
        let middle = std::array::from_fn(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 8.0);
        let forward = match sweep.apex {
            Apex::Eye(eye) => belvedere_data::vector::unit(sub(middle, eye)),
            Apex::Direction(direction) => Some(direction),
        };
        let mut beam = Self { normals: [[0.0; 3]; PLANES], offsets: [f32::MAX; PLANES], width: 0.0, growth: [0.0; 3] };
        #[expect(clippy::cast_possible_truncation, reason = "widened by more than what is rounded")]
        let mut bound = |plane: usize, normal: [f64; 3], offset: f64| {
            beam.normals[plane] = normal.map(|v| v as f32);
            beam.offsets[plane] = (offset + sweep.room) as f32;
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
            match sweep.apex {
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
                    if near - start > 10.0 * sweep.room {
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
        #[expect(clippy::cast_possible_truncation, reason = "only decides which nodes are opened")]
        {
            beam.width = start_width as f32;
            beam.growth = growth.map(|v| v as f32);
        }
        beam
    }

    /// What the beam has to do with balls given by their centres and radii.
    #[inline(always)]
    pub(super) fn meets(&self, [x, y, z, radius]: [[f32; LANES]; 4]) -> Met {
        let mut depths = [[0.0; LANES]; PLANES];
        for ((depths, normal), offset) in depths.iter_mut().zip(&self.normals).zip(self.offsets) {
            for lane in 0..LANES {
                depths[lane] = offset - (normal[0] * x[lane] + normal[1] * y[lane] + normal[2] * z[lane]);
            }
        }
        let mut met = Met { is_hit: [false; LANES], may_be_covered: [false; LANES] };
        for lane in 0..LANES {
            let mut least = radius[lane];
            for depths in &depths {
                least = if depths[lane] < least { depths[lane] } else { least };
            }
            let larger = |a: f32, b: f32| if a > b { a } else { b };
            let [across, along] = [[0, 1], [2, 3]].map(|[a, b]| larger(depths[a][lane], depths[b][lane]));
            met.is_hit[lane] = -least <= radius[lane];
            met.may_be_covered[lane] = across * across + along * along <= radius[lane] * radius[lane];
        }
        met
    }

    /// Which parts of a node the beam may meet.
    #[inline(always)]
    pub(super) fn meets_boxes(&self, parts: &Parts) -> [bool; PARTS] {
        let Parts { centers, half_sizes: halves, .. } = parts;
        let mut most = [f32::NEG_INFINITY; PARTS];
        for (normal, offset) in self.normals.iter().zip(self.offsets) {
            for lane in 0..PARTS {
                let center = normal[0] * centers[0][lane] + normal[1] * centers[1][lane] + normal[2] * centers[2][lane];
                let half = normal[0].abs() * halves[0][lane]
                    + normal[1].abs() * halves[1][lane]
                    + normal[2].abs() * halves[2][lane];
                let beyond = center - half - offset;
                most[lane] = if beyond > most[lane] { beyond } else { most[lane] };
            }
        }
        most.map(|most| most <= 0.0)
    }

    pub(super) fn meets_box(&self, node: &Node) -> bool {
        self.normals
            .iter()
            .zip(self.offsets)
            .all(|(&normal, offset)| dot(normal, node.center) - dot(normal.map(f32::abs), node.half) <= offset)
    }

    /// Whether something of this size is large against the beam at `center`.
    #[inline]
    pub(super) fn is_narrower_than(&self, size: f32, center: [f32; 3]) -> bool {
        size > OPENED_SHARE * (self.width + dot(self.growth, center))
    }
}
