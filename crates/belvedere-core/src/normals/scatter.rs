//! Scatter of points around their surface, and that surface.
//!
//! A union of balls is an envelope. It lies as far outside a surface as the outermost point around each place, and the
//! more points there are, the farther out that is. Balls are therefore tangent to the planes of neighbourhoods, if
//! noise and not shape moves points away from them.

use belvedere_data::cast::to_index;
use belvedere_data::vector::{dot, sub};
use rayon::prelude::*;

/// Share of the points whose neighbourhoods are rougher by noise alone. In every cloud tested a quarter or more of the
/// points lie on ground or roofs.
const SMOOTH_SHARE: f64 = 0.25;
/// A neighbourhood counts as flat up to this many times the noise of the cloud. Among 17 points of a plane one in a
/// thousand is rougher.
const MAX_NOISE: f32 = 2.0;
/// Cosine of the angle between a pulse and the normal from which on the noise of ranges outweighs that of directions,
/// and is not divided by nearly nothing: 60°.
const STEEP: f32 = 0.5;

/// Plane through the neighbourhood of each point.
#[derive(Clone, Debug, Default)]
pub struct Scatter {
    /// Vector from each point to the plane, (N, 3), metres.
    pub to_plane: Vec<[f32; 3]>,
    /// Root mean square distance of its neighbourhood from that plane, (N), metres; infinite where there is no plane.
    pub roughness: Vec<f32>,
}

impl Scatter {
    /// Noise of the cloud along its normals, metres: the lower quartile of the roughness. `None` where no point has a
    /// plane.
    #[must_use]
    pub fn noise(&self) -> Option<f32> {
        lower_quartile(self.roughness.clone())
    }

    /// Noise of ranges, metres: the lower quartile of the roughness as ranges show it, for points at `positions` with
    /// `normals`, measured from `scanner`, all (N, 3), local metres. A range that is wrong by σ moves a point by σ cos
    /// i away from a surface that the pulse meets at the angle i to its normal. Among scanners on the ground most
    /// pulses are slanted, so that [`Scatter::noise`] is too small for those that are not. `None` where no point with a
    /// plane is met steeply enough.
    #[must_use]
    pub fn noise_of_ranges(&self, positions: &[[f32; 3]], normals: &[[f32; 3]], scanner: &[[f32; 3]]) -> Option<f32> {
        let rows = self.roughness.par_iter().zip(positions).zip(normals).zip(scanner);
        let of_range = |(((&roughness, &p), &normal), &s): (((&f32, _), &[f32; 3]), _)| {
            let sight = sub(s, p);
            let cosine = (dot(normal, sight) / dot(sight, sight).sqrt()).abs();
            (cosine >= STEEP).then(|| roughness / cosine)
        };
        lower_quartile(rows.filter_map(of_range).collect())
    }

    /// `positions`, (N, 3) local metres, each on its plane where the neighbourhood is flat within noise, and how many
    /// were moved. Points at edges, of twigs and of thin things stay where they are.
    #[must_use]
    pub fn smoothed(&self, positions: &[[f32; 3]]) -> (Vec<[f32; 3]>, usize) {
        self.smoothed_within(self.noise(), positions)
    }

    /// The positions of [`Scatter::smoothed`] where the noise is given: that of a larger cloud of which this one is a
    /// part.
    #[must_use]
    pub fn smoothed_within(&self, noise: Option<f32>, positions: &[[f32; 3]]) -> (Vec<[f32; 3]>, usize) {
        let max = noise.map_or(0.0, |noise| MAX_NOISE * noise);
        let planes = self.roughness.par_iter().zip(&self.to_plane);
        let on_plane = |(&p, (&roughness, to_plane)): (&[f32; 3], (&f32, &[f32; 3]))| {
            if roughness <= max { std::array::from_fn(|i| p[i] + to_plane[i]) } else { p }
        };
        let moved = positions.par_iter().zip(planes).map(on_plane).collect();
        (moved, self.roughness.iter().filter(|&&roughness| roughness <= max).count())
    }
}

/// The lower quartile of those that are finite.
fn lower_quartile(mut roughness: Vec<f32>) -> Option<f32> {
    roughness.retain(|roughness| roughness.is_finite());
    let place = to_index(roughness.len() as f64 * SMOOTH_SHARE);
    (!roughness.is_empty()).then(|| *roughness.select_nth_unstable_by(place, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::super::estimate::{Neighborhood, estimate_with_scatter};
    use crate::neighbors::NeighborIndex;
    use belvedere_data::control::Control;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;

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
                points.extend([[u, v, a], [u, b, v]].map(|place| place.map(to_f32)));
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

    #[test]
    fn noise_of_ranges_is_that_of_ranges_however_slanted_pulses_are() {
        // a wall 3 m off, met at angles up to 56°, and farther along at 70° and more
        for along in [-1.5, 4.0, 9.0] {
            let mut points = Vec::new();
            for i in 0..80 * 80_u64 {
                let (u, v) = (along + (i % 80) as f64 * 0.05, (i / 80) as f64 * 0.05 - 1.5);
                let sight = [u, 3.0, v];
                let range = sight.map(|v| v * v).iter().sum::<f64>().sqrt();
                let error = (12 * i..12 * i + 12).map(|number| uniform(5, number) - 0.5).sum::<f64>();
                points.push(sight.map(|v| to_f32(v * (1.0 + 0.005 * error / range))));
            }
            let index = NeighborIndex::new(&points, &Control::none()).unwrap();
            let (normals, scatter) =
                estimate_with_scatter(&points, &index, Neighborhood::default(), &Control::none()).unwrap();
            let noise = scatter.noise_of_ranges(&points, &normals.vectors, &vec![[0.0; 3]; points.len()]);
            if along > 5.0 {
                assert_eq!(noise, None, "no pulse is steep");
            } else {
                // a quartile of what 17 points about a plane of three parameters show
                let noise = f64::from(noise.unwrap()) / 0.005;
                assert!((0.7..1.0).contains(&noise), "{along}: {noise}");
            }
        }
    }
}
