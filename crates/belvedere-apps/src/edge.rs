//! Dependence of a result on objects beyond the cloud, which are unknown and block nothing.
//!
//! A line to the sun or the sky leaves the box around the cloud at some height. Above the highest point of the cloud no
//! object like those in it could block it. Below, an object beyond the edge as high as that point could. A target is
//! near the edge if more than [`EDGE_SHARE`] of the light comes from directions that leave the cloud so low.
//!
//! A direction is weighted by the sine of its elevation, as its light on level ground is. Flat directions, which leave
//! every cloud low, therefore count little beside steep ones.

use belvedere_core::query::{Coverage, SkylinePoint};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::report::percent;
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::TAU;

/// Share of the tested directions, weighted by the sines of their elevations, that may leave the cloud below its
/// highest point before a target counts as near the edge. Under the whole sky this is a distance of 4.4 times the
/// relief in all azimuths.
pub const EDGE_SHARE: f64 = 0.05;
/// Targets handed to a thread at once.
const CHUNK: usize = 1024;

/// Number of targets near the edge of the cloud.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EdgeReport {
    /// Targets that are near the edge.
    pub targets_near_edge: usize,
    /// Their share of all targets that have a position, percent.
    pub targets_near_edge_percent: f64,
}

impl EdgeReport {
    /// Counts `flags` as [`near_edge`] gives them.
    #[must_use]
    pub fn of(flags: &[Option<bool>]) -> Self {
        let count = flags.iter().filter(|flag| **flag == Some(true)).count();
        Self::of_counts(count, flags.iter().flatten().count())
    }

    /// Creates the report of `near` targets near the edge among `count` with a position.
    #[must_use]
    pub fn of_counts(near: usize, count: usize) -> Self {
        Self { targets_near_edge: near, targets_near_edge_percent: percent(near, count) }
    }
}

/// Flags the `targets`, (M, 3) local metres, near the edge of the cloud for lines of sight along `directions`, (D, 3)
/// unit vectors; `None` for one that is not finite. Directions below the horizon do not count. Progress counts targets.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub fn near_edge(
    coverage: &Coverage,
    targets: &[[f32; 3]],
    directions: &[[f64; 3]],
    control: &Control<'_>,
) -> Result<Vec<Option<bool>>> {
    let slopes = Slopes::new(directions);
    let chunks = targets.par_chunks(CHUNK).map(|targets| {
        control.check()?;
        let flag = |target: &[f32; 3]| {
            let is_finite = target.iter().all(|v| v.is_finite());
            is_finite.then(|| slopes.is_near(coverage, target.map(f64::from)))
        };
        let flags: Vec<Option<bool>> = targets.iter().map(flag).collect();
        control.advance(targets.len());
        Ok(flags)
    });
    Ok(chunks.collect::<Result<Vec<_>>>()?.concat())
}

/// Returns the share of the azimuths of `skyline` at which an object beyond the edge could rise above the horizon found
/// around `eye`, local metres. The object is as high as the highest point of the cloud. The first azimuth is `first`
/// radians clockwise from grid north. 0 for an empty skyline.
#[must_use]
pub fn horizon_share_near_edge(coverage: &Coverage, eye: [f64; 3], skyline: &[SkylinePoint], first: f64) -> f64 {
    let relief = relief_above(coverage, eye);
    let is_near = |(number, point): &(usize, &SkylinePoint)| {
        let azimuth = first + *number as f64 * TAU / skyline.len() as f64;
        let distance = distance_to_edge(coverage, eye, [azimuth.sin(), azimuth.cos()]);
        relief.atan2(distance) > point.elevation
    };
    skyline.iter().enumerate().filter(is_near).count() as f64 / skyline.len().max(1) as f64
}

/// Returns the height of the highest point of the cloud above `place`, metres, 0 or more.
fn relief_above(coverage: &Coverage, place: [f64; 3]) -> f64 {
    (f64::from(coverage.bounds().high[2]) - place[2]).max(0.0)
}

/// Distance on the map from `place`, local metres, along the unit vector `along` to where the box around the cloud
/// ends, metres; 0 outside.
fn distance_to_edge(coverage: &Coverage, place: [f64; 3], along: [f64; 2]) -> f64 {
    let (low, high) = coverage.bounds().on_map();
    let to_side = |axis: usize| match along[axis] {
        slope if slope > 0.0 => (high[axis] - place[axis]) / slope,
        slope if slope < 0.0 => (low[axis] - place[axis]) / slope,
        _ => f64::INFINITY,
    };
    to_side(0).min(to_side(1)).max(0.0)
}

/// Directions above the horizon, the flattest first.
struct Slopes {
    /// Rise for each metre on the map, ascending.
    rises: Vec<f64>,
    /// Unit vectors on the map, in the same order.
    along: Vec<[f64; 2]>,
    /// Sine of the elevation of each, and their sums up to each.
    weights: Vec<f64>,
    sums: Vec<f64>,
    /// Light that may leave the cloud low for a target that is not near the edge.
    allowed: f64,
}

impl Slopes {
    fn new(directions: &[[f64; 3]]) -> Self {
        let slope = |&[x, y, z]: &[f64; 3]| {
            let span = x.hypot(y);
            if span > 0.0 { (z / span, [x / span, y / span], z) } else { (f64::INFINITY, [1.0, 0.0], z) }
        };
        let mut slopes: Vec<(f64, [f64; 2], f64)> = directions.iter().filter(|d| d[2] > 0.0).map(slope).collect();
        slopes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let weights: Vec<f64> = slopes.iter().map(|slope| slope.2).collect();
        let add = |sum: &mut f64, weight: &f64| {
            *sum += weight;
            Some(*sum)
        };
        let sums: Vec<f64> = weights.iter().scan(0.0, add).collect();
        let allowed = EDGE_SHARE * sums.last().copied().unwrap_or(0.0);
        let (rises, along) = slopes.into_iter().map(|(rise, along, _)| (rise, along)).unzip();
        Self { rises, along, weights, sums, allowed }
    }

    fn is_near(&self, coverage: &Coverage, place: [f64; 3]) -> bool {
        let relief = relief_above(coverage, place);
        let sides = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        let nearest =
            sides.map(|side| distance_to_edge(coverage, place, side)).into_iter().fold(f64::INFINITY, f64::min);
        // steeper ones leave high enough whatever their azimuth
        let low = self.rises.partition_point(|rise| rise * nearest < relief);
        if low == 0 || self.sums[low - 1] <= self.allowed {
            return false;
        }
        let leaves_low =
            |number: &usize| self.rises[*number] * distance_to_edge(coverage, place, self.along[*number]) < relief;
        let mut sum = 0.0;
        (0..low).filter(leaves_low).any(|number| {
            sum += self.weights[number];
            sum > self.allowed
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky_view::SkyDirections;
    use belvedere_data::Bounds;
    use belvedere_data::view::to_sun;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// A cloud of 100 by 100 m, its highest point 20 m above the ground.
    fn coverage() -> Coverage {
        Coverage::of(Bounds { low: [0.0; 3], high: [100.0, 100.0, 20.0] }).unwrap()
    }

    fn ground() -> Vec<[f32; 3]> {
        (0..10_000_u16).map(|i| [f32::from(i % 100) + 0.5, f32::from(i / 100) + 0.5, 0.0]).collect()
    }

    fn share(directions: &[[f64; 3]]) -> f64 {
        let flags = near_edge(&coverage(), &ground(), directions, &Control::none()).unwrap();
        EdgeReport::of(&flags).targets_near_edge_percent
    }

    #[test]
    fn under_one_sun_the_strip_as_wide_as_the_longest_shadow_is_near_the_edge() {
        // a shadow of 20 m is 20 / tan(elevation) long; the sun is in the south, and the strip along the south side
        assert_eq!(share(&[to_sun(PI, 45f64.to_radians())]), 20.0);
        assert_eq!(share(&[to_sun(PI, 0.5f64.atan())]), 40.0);
        // south-east: the strips along two sides, (20 / √2) m wide, of which 14 rows of cells have their middle within
        let two_sides = 100.0 - 86.0 * 86.0 / 100.0;
        assert!((share(&[to_sun(0.75 * PI, 45f64.to_radians())]) - two_sides).abs() < 1e-9);
        // a higher and a lower sun: the lower decides; one below the horizon does not count
        let suns = [to_sun(PI, 45f64.to_radians()), to_sun(PI, 0.5f64.atan()), to_sun(PI, -0.1)];
        assert_eq!(share(&suns), 40.0);
        assert_eq!(share(&[]), 0.0);
        // a target as high as all else, and one without a position
        let flags = near_edge(&coverage(), &[[1.0, 1.0, 20.0], [f32::NAN; 3]], &suns, &Control::none()).unwrap();
        assert_eq!(flags, [Some(false), None]);
    }

    #[test]
    fn under_the_whole_sky_a_target_is_near_where_the_band_below_the_relief_is_wide() {
        let sky = SkyDirections::even(5000).unwrap();
        // the middle sees 20 m at 50 m: the band up to atan(20 / d) sends the share (1/2π) ∫ sin²(atan(20 / d(φ))) dφ
        // of the light
        let steps = 3600;
        let band = |d: f64| (20.0 / d).atan().sin().powi(2);
        let of_azimuth = |i: i32| {
            let azimuth = f64::from(i) * TAU / f64::from(steps);
            band(50.0 / azimuth.sin().abs().max(azimuth.cos().abs()))
        };
        let exact = (0..steps).map(of_azimuth).sum::<f64>() / f64::from(steps);
        let middle = [50.0, 50.0, 0.0];
        let low = |z: f64| {
            let relief = 20.0 - z;
            let is_low = |d: &&[f64; 3]| {
                let span = d[0].hypot(d[1]);
                d[2] / span * distance_to_edge(&coverage(), middle, [d[0] / span, d[1] / span]) < relief
            };
            let sum = |own: f64, d: &[f64; 3]| own + d[2];
            sky.directions.iter().filter(is_low).fold(0.0, sum) / sky.directions.iter().fold(0.0, sum)
        };
        assert!((low(0.0) - exact).abs() < 0.01, "{} {exact}", low(0.0));
        // the flag is set where the band sends more than five hundredths of the light
        let flag = |z: f32| near_edge(&coverage(), &[[50.0, 50.0, z]], &sky.directions, &Control::none()).unwrap()[0];
        assert_eq!((flag(0.0), flag(19.0)), (Some(true), Some(false)));
        for z in [0.0_f32, 3.0, 5.0, 10.0, 12.0, 15.0] {
            assert_eq!(flag(z), Some(low(f64::from(z)) > EDGE_SHARE), "{z}");
        }
    }

    #[test]
    fn a_horizon_could_be_higher_where_the_relief_beyond_the_edge_would_stand_above_it() {
        let point = |elevation: f64| SkylinePoint { elevation, range: 1.0, blocker: None };
        // 20 m at 50 m, to the north, east, south and west: 21.8°
        let skyline = [point(0.1), point(0.37), point(0.39), point(FRAC_PI_2)];
        assert_eq!(horizon_share_near_edge(&coverage(), [50.0, 50.0, 0.0], &skyline, 0.0), 0.5);
        // ten metres before the north side 20 m would stand 63° high there, and 12.5° in the south
        let near = [point(1.1), point(0.5), point(0.22), point(0.5)];
        assert_eq!(horizon_share_near_edge(&coverage(), [50.0, 90.0, 0.0], &near, 0.0), 0.25);
        assert_eq!(horizon_share_near_edge(&coverage(), [50.0; 3], &[], 0.0), 0.0);
    }
}
