//! Balls around a target, as the parts of its sky that they cover.

use crate::blocking::{Ball, Cover};
use crate::query::ball_tree::BallTree;
use crate::ray_index::{NodePart, PARTS, Ray};
use belvedere_data::vector::to_f32;

/// Distance to the sides of a target, and above it, up to which balls count as near, metres. Beyond, rising rays have
/// left the surface of the target.
pub(super) const NEAR: [f64; 2] = [2.0, 0.6];
/// Reduction of the cosine to the outline of a ball: more than the error of f32.
const ROUNDING: f32 = 1e-5;
/// Covers tested at once.
const LANES: usize = 8;

/// Balls that may block a ray on its way out of the near space of a target.
#[derive(Default)]
pub(super) struct Nearby {
    /// Unit vectors to their centres, and the minimum cosine to those of rays that may meet them, 8 side by side. Also
    /// the maximum rise (sine of elevation) of any of these; sorted by it, descending.
    covers: Vec<([[f32; LANES]; 4], f32)>,
    rows: Vec<u32>,
    /// Balls that may block, not yet in order: as in covers, their greatest rise, and their row.
    taken: Vec<([f32; 4], f32, u32)>,
    /// Balls near any target of a group.
    around: Vec<u32>,
    nodes: Vec<u32>,
}

impl Nearby {
    /// Looks up the balls near any of `targets`.
    pub(super) fn gather(&mut self, tree: &BallTree, targets: &[[f32; 3]]) {
        self.around.clear();
        let bound = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
            targets.iter().map(|target| f64::from(target[axis])).fold(start, pick)
        };
        let low: [f64; 3] = std::array::from_fn(|i| bound(i, f64::min, f64::INFINITY) - [NEAR[0], NEAR[0], 0.0][i]);
        let high: [f64; 3] =
            std::array::from_fn(|i| bound(i, f64::max, f64::NEG_INFINITY) + [NEAR[0], NEAR[0], NEAR[1]][i]);
        let index = tree.index();
        self.nodes.clear();
        self.nodes.extend(index.root());
        while let Some(node) = self.nodes.pop() {
            let Some(parts) = index.parts(node) else { continue };
            for child in 0..PARTS {
                let meets = (0..3).all(|axis| {
                    let (middle, half) =
                        (f64::from(parts.centers[axis][child]), f64::from(parts.half_sizes[axis][child]));
                    // boxes are padded by a millimetre, which is more than they are rounded by
                    middle + half >= low[axis] && middle - half <= high[axis]
                });
                if !meets {
                    continue;
                }
                match parts.parts[child] {
                    NodePart::Nothing => {}
                    NodePart::Node(node) => self.nodes.push(node),
                    NodePart::Rows { first, count } => {
                        let meets = |row: &u32| reaches(tree.ball(*row as usize), [low, high]);
                        self.around.extend((first..first + count).filter(meets));
                    }
                }
            }
        }
    }

    /// Selects, from the balls looked up, those that may block a ray from `target` that does not sink below the horizon
    /// within the near space.
    pub(super) fn select(&mut self, tree: &BallTree, target: [f64; 3]) {
        self.rows.clear();
        self.covers.clear();
        self.taken.clear();
        let low = [target[0] - NEAR[0], target[1] - NEAR[0], target[2]];
        let high = [target[0] + NEAR[0], target[1] + NEAR[0], target[2] + NEAR[1]];
        for at in 0..self.around.len() {
            self.take(tree, target, [low, high], self.around[at]);
        }
        self.line_up();
    }

    fn take(&mut self, tree: &BallTree, target: [f64; 3], corners: [[f64; 3]; 2], row: u32) {
        let ball = tree.ball(row as usize);
        if !reaches(ball, corners) {
            return;
        }
        let Cover { towards, cosine, highest } = tree.rule().cover(ball, target);
        if highest > -f64::from(ROUNDING) {
            let [x, y, z, cosine, highest] =
                [towards[0], towards[1], towards[2], cosine - f64::from(ROUNDING), highest + f64::from(ROUNDING)]
                    .map(to_f32);
            self.taken.push(([x, y, z, cosine], highest, row));
        }
    }

    /// Puts those taken in order, the ones that reach highest first, 8 side by side.
    fn line_up(&mut self) {
        self.taken.sort_unstable_by(|a, b| b.1.total_cmp(&a.1).then(a.2.cmp(&b.2)));
        for taken in self.taken.chunks(LANES) {
            let mut cover = [[0.0; LANES], [0.0; LANES], [0.0; LANES], [2.0; LANES]];
            for (lane, (of_ball, ..)) in taken.iter().enumerate() {
                for (part, value) in cover.iter_mut().zip(of_ball) {
                    part[lane] = *value;
                }
            }
            self.covers.push((cover, taken[0].1));
        }
        self.rows.extend(self.taken.iter().map(|(.., row)| row));
    }

    /// Returns true if none of the selected balls can block anything.
    pub(super) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Returns true if a ball near the target blocks `ray`.
    #[inline]
    pub(super) fn blocks(&self, tree: &BallTree, ray: &Ray) -> bool {
        let [x, y, z] = ray.direction.map(to_f32);
        let reaching = self.covers.iter().take_while(|(_, highest)| *highest >= z);
        reaching.zip(self.rows.chunks(LANES)).any(|(([cx, cy, cz, cosine], _), rows)| {
            let meets: [bool; LANES] =
                std::array::from_fn(|lane| cx[lane] * x + cy[lane] * y + cz[lane] * z >= cosine[lane]);
            meets.contains(&true)
                && rows.iter().zip(meets).any(|(&row, meets)| meets && tree.front(row as usize, ray).is_some())
        })
    }
}

/// Returns true if a ball reaches a box.
fn reaches(ball: Ball, [low, high]: [[f64; 3]; 2]) -> bool {
    let (center, radius) = (ball.center.map(f64::from), f64::from(ball.radius));
    let square: f64 = (0..3).map(|i| (low[i] - center[i]).max(center[i] - high[i]).max(0.0).powi(2)).sum();
    square <= radius * radius
}
