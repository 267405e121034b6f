//! Balls around a target, as the parts of its sky that they cover.

use crate::query::MedialScene;
use crate::ray_index::{PARTS, Part, Ray};

/// How far to the sides of a target, and how far above it, balls are taken as near, metres: beyond, rays that rise have left the
/// surface that the target lies on.
pub(super) const NEAR: [f64; 2] = [3.0, 0.6];
/// By how much the cosine to the rim of a ball is taken too small: more than f32 errs.
const ROUNDING: f32 = 1e-5;
/// Covers tested at once.
const LANES: usize = 8;

/// Balls that may block a ray on its way out of the near space of a target.
#[derive(Default)]
pub(super) struct Nearby {
    /// Unit vectors to their centres, and the least cosine to those of rays that may meet them, in rows of 8.
    covers: Vec<[[f32; LANES]; 4]>,
    rows: Vec<u32>,
    nodes: Vec<u32>,
}

impl Nearby {
    /// Finds the balls near `target` that may block a ray which does not sink below the horizon.
    pub(super) fn gather(&mut self, scene: &MedialScene, target: [f64; 3]) {
        self.rows.clear();
        self.covers.clear();
        let low = [target[0] - NEAR[0], target[1] - NEAR[0], target[2]];
        let high = [target[0] + NEAR[0], target[1] + NEAR[0], target[2] + NEAR[1]];
        let index = &scene.index;
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
                    Part::Nothing => {}
                    Part::Node(node) => self.nodes.push(node),
                    Part::Rows { first, count } => {
                        for row in first..first + count {
                            self.take(scene, target, [low, high], row);
                        }
                    }
                }
            }
        }
    }

    fn take(&mut self, scene: &MedialScene, target: [f64; 3], [low, high]: [[f64; 3]; 2], row: u32) {
        let (center, radius) = scene.ball(row as usize);
        let (center, radius) = (center.map(f64::from), f64::from(radius));
        let mut beside = 0.0;
        for axis in 0..3 {
            let outside = (low[axis] - center[axis]).max(center[axis] - high[axis]).max(0.0);
            beside += outside * outside;
        }
        if beside > radius * radius {
            return;
        }
        let offset: [f64; 3] = std::array::from_fn(|i| center[i] - target[i]);
        let distance = offset.iter().map(|v| v * v).sum::<f64>().sqrt();
        let radius = scene.radius_for(radius, distance);
        let (cosine, towards) = if distance <= radius {
            (-2.0, [0.0, 0.0, 1.0])
        } else {
            let sine = radius / distance;
            let cosine = (1.0 - sine * sine).sqrt();
            // the highest part of its rim: sin(a + b) of its own elevation and its radius
            let up = offset[2] / distance;
            let highest = up * cosine + (1.0 - up * up).max(0.0).sqrt() * sine;
            if highest < -1e-6 && up < cosine {
                return;
            }
            (cosine, offset.map(|v| v / distance))
        };
        let lane = self.rows.len() % LANES;
        if lane == 0 {
            self.covers.push([[0.0; LANES], [0.0; LANES], [0.0; LANES], [2.0; LANES]]);
        }
        #[expect(clippy::cast_possible_truncation, reason = "the cosine allows for it")]
        if let Some(covers) = self.covers.last_mut() {
            for axis in 0..3 {
                covers[axis][lane] = towards[axis] as f32;
            }
            covers[3][lane] = cosine as f32 - ROUNDING;
        }
        self.rows.push(row);
    }

    /// The row of a ball near the target that blocks `ray`, if any does.
    #[inline]
    pub(super) fn block(&self, scene: &MedialScene, ray: &Ray) -> Option<u32> {
        #[expect(clippy::cast_possible_truncation, reason = "the cosine allows for it")]
        let [x, y, z] = ray.direction.map(|v| v as f32);
        for (group, [cx, cy, cz, cosine]) in self.covers.iter().enumerate() {
            let meets: [bool; LANES] =
                std::array::from_fn(|lane| cx[lane] * x + cy[lane] * y + cz[lane] * z >= cosine[lane]);
            if !meets.contains(&true) {
                continue;
            }
            for lane in (0..LANES).filter(|&lane| meets[lane]) {
                let row = self.rows.get(group * LANES + lane).copied();
                if let Some(row) = row.filter(|&row| scene.front(row as usize, ray).is_some()) {
                    return Some(row);
                }
            }
        }
        None
    }
}
