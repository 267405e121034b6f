//! How points scatter about the surface that they lie on, and that surface.
//!
//! A union of balls is an envelope: it lies as far outside a surface as the outermost of the points about each place, and the more points
//! there are, the farther out that is. Balls are therefore tangent to the planes that neighbourhoods lie on, where noise and not shape
//! is what moves points away from them.

use rayon::prelude::*;

/// Share of the points whose neighbourhoods are rougher by noise alone: in every cloud that this was tried on a quarter or more of the
/// points lie on ground or roofs.
const SMOOTH_SHARE: f64 = 0.25;
/// A neighbourhood counts as flat up to this many times the noise of the cloud. Among 17 points of a plane one in a thousand is rougher.
const MOST_NOISE: f32 = 2.0;

/// Where the plane through the neighbourhood of each point lies.
#[derive(Clone, Debug, Default)]
pub struct Scatter {
    /// From each point to the plane, (N, 3), metres.
    pub to_plane: Vec<[f32; 3]>,
    /// Root mean square distance of its neighbourhood from that plane, (N), metres; infinite where there is no plane.
    pub roughness: Vec<f32>,
}

impl Scatter {
    /// Noise of the cloud along its normals, metres: the lower quartile of the roughness. `None` where no point has a plane.
    #[must_use]
    pub fn noise(&self) -> Option<f32> {
        let mut finite: Vec<f32> = self.roughness.iter().copied().filter(|roughness| roughness.is_finite()).collect();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a length")]
        let place = (finite.len() as f64 * SMOOTH_SHARE) as usize;
        (!finite.is_empty()).then(|| *finite.select_nth_unstable_by(place, f32::total_cmp).1)
    }

    /// `positions`, (N, 3) local metres, each on its plane where the neighbourhood is flat within noise, and how many were moved. Points at
    /// edges, of twigs and of thin things stay where they are.
    #[must_use]
    pub fn smoothed(&self, positions: &[[f32; 3]]) -> (Vec<[f32; 3]>, usize) {
        self.smoothed_within(self.noise(), positions)
    }

    /// The same where the noise of the cloud is given: that of a larger one that it is a part of.
    #[must_use]
    pub fn smoothed_within(&self, noise: Option<f32>, positions: &[[f32; 3]]) -> (Vec<[f32; 3]>, usize) {
        let most = noise.map_or(0.0, |noise| MOST_NOISE * noise);
        let planes = self.roughness.par_iter().zip(&self.to_plane);
        let on_plane = |(&p, (&roughness, to_plane)): (&[f32; 3], (&f32, &[f32; 3]))| {
            if roughness <= most { std::array::from_fn(|i| p[i] + to_plane[i]) } else { p }
        };
        let moved = positions.par_iter().zip(planes).map(on_plane).collect();
        (moved, self.roughness.iter().filter(|&&roughness| roughness <= most).count())
    }
}

#[cfg(test)]
mod tests {
    use super::super::estimate::{Neighborhood, estimate_with_scatter};
    use crate::neighbors::NeighborIndex;
    use belvedere_data::control::Control;
    use belvedere_data::random::uniform;

    const NOISE: f64 = 0.02;

    /// A floor and a wall that meet at a right angle, 25 points a square metre, with noise along their normals.
    fn corner() -> Vec<[f32; 3]> {
        let mut drawn = 0;
        // the sum of twelve is nearly normal
        let mut noise = || {
            drawn += 12;
            NOISE * (drawn..drawn + 12).map(|number| uniform(3, number) - 0.5).sum::<f64>()
        };
        let mut points = Vec::new();
        for i in 0..60 {
            for j in 0..30 {
                let (u, v) = (f64::from(i) * 0.2, f64::from(j) * 0.2 + 0.1);
                let (a, b) = (noise(), noise());
                #[expect(clippy::cast_possible_truncation, reason = "a few metres")]
                points.extend([[u, v, a], [u, b, v]].map(|place| place.map(|v| v as f32)));
            }
        }
        points
    }

    #[test]
    fn points_come_to_lie_on_their_plane_and_keep_their_edge() {
        let points = corner();
        let index = NeighborIndex::new(&points, &Control::none()).unwrap();
        let (_, scatter) = estimate_with_scatter(&points, &index, Neighborhood::default(), &Control::none()).unwrap();
        let noise = f64::from(scatter.noise().unwrap());
        // a quartile of what 17 points about a plane of three parameters show: less than the noise itself
        assert!((0.7 * NOISE..NOISE).contains(&noise), "{noise}");
        let (moved, count) = scatter.smoothed(&points);
        assert!(count > points.len() * 9 / 10, "{count}");
        let inner = |p: &[f32; 3]| (1.0..11.0).contains(&p[0]) && p[1].max(p[2]) > 1.0 && p[1].max(p[2]) < 5.0;
        let square = |places: &[[f32; 3]]| {
            let off =
                places.iter().zip(&points).filter(|(_, p)| inner(p)).map(|(q, _)| f64::from(q[1].min(q[2])).powi(2));
            (off.sum::<f64>() / points.iter().filter(|p| inner(p)).count() as f64).sqrt()
        };
        // the mean of 17 points has a quarter of the noise; the tilt of the plane adds a little
        assert!(square(&moved) < 0.35 * square(&points), "{} {}", square(&moved), square(&points));
        // next to the edge neighbourhoods hold both sides, and points stay
        let at_edge = |p: &[f32; 3]| p[1].max(p[2]) < 0.25;
        let farthest =
            moved.iter().zip(&points).filter(|(_, p)| at_edge(p)).map(|(q, p)| (q[1] - p[1]).hypot(q[2] - p[2]));
        assert!(farthest.fold(0.0, f32::max) < 0.05);
    }
}
