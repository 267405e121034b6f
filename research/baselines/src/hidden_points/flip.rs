//! Spherical flipping, and one view of a cloud made with it.

use belvedere::vector::length;
use rayon::prelude::*;

use super::hull::{Hull, HullWalk};

/// Targets handed to a thread at once.
const CHUNK: usize = 16_384;

/// The hull of a flipped cloud and one eye.
pub(crate) struct FlippedView {
    eye: [f64; 3],
    radius: f64,
    hull: Hull,
}

impl FlippedView {
    /// Flips `positions`, (N, 3) local metres, about `eye`; the radius is `10^exponent` times the range of the
    /// farthest.
    pub(crate) fn new(positions: &[[f32; 3]], eye: [f64; 3], exponent: f64) -> Self {
        let from_eye = |p: &[f32; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) - eye[i]) };
        let farthest = positions.iter().map(|p| length(from_eye(p))).fold(0.0, f64::max);
        let radius = 10_f64.powf(exponent) * farthest;
        let hull = Hull::new(positions.iter().map(|p| flip(from_eye(p), radius).unwrap_or([0.0; 3])).collect());
        Self { eye, radius, hull }
    }

    /// Which points of the cloud are corners of the hull. A point at the eye counts as one.
    pub(crate) fn corners(&self, positions: &[[f32; 3]]) -> Vec<bool> {
        positions
            .iter()
            .enumerate()
            .map(|(index, p)| self.hull.is_extreme(index) || p.map(f64::from) == self.eye)
            .collect()
    }

    /// For each of `targets`, (M, 3) finite local metres, whether its image lies outside the hull, or inside by no more
    /// than `tolerance` metres along the ray from the eye.
    pub(crate) fn outside(&self, targets: &[[f32; 3]], tolerance: Option<f64>) -> Vec<bool> {
        let images: Vec<Option<[f64; 3]>> = targets
            .par_iter()
            .map(|t| flip(std::array::from_fn(|i| f64::from(t[i]) - self.eye[i]), self.radius))
            .collect();
        // neighbours one after the other, so that each walk is short
        let order = self.hull.order_along_curve(&images);
        let found: Vec<bool> = order
            .par_chunks(CHUNK)
            .flat_map_iter(|rows| {
                let mut walk = HullWalk::default();
                let images = &images;
                rows.iter().map(move |&row| {
                    let Some(image) = images[row as usize] else { return true };
                    match self.hull.depth_below(image, &mut walk) {
                        None => true,
                        Some(depth) => tolerance.is_some_and(|tolerance| depth <= tolerance),
                    }
                })
            })
            .collect();
        let mut answers = vec![false; targets.len()];
        for (row, outside) in order.into_iter().zip(found) {
            answers[row as usize] = outside;
        }
        answers
    }
}

/// The image of `p`, relative to the eye: on the same ray, as far beyond the sphere of `radius` as `p` is before it.
/// `None` at the eye, which has no ray.
fn flip(p: [f64; 3], radius: f64) -> Option<[f64; 3]> {
    let range = length(p);
    (range > 0.0).then(|| p.map(|v| v * (2.0 * radius / range - 1.0)))
}
