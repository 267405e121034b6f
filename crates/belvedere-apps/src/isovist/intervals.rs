//! Intervals of isovists, from the probabilities that places along each ray are visible.
//!
//! The probability that a place is visible falls with its range: it is that of sight along the ray reaching so far. The
//! expected area or volume of a ray and its variance follow. Errors of neighbouring rays come from the same edges.
//! Their deviations are added up within a sector, and sectors are treated as independent.

use super::{Isovist, IsovistIntervals, IsovistParams, direction};
use belvedere_core::query::MedialScene;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::view::to_sun;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Ranges at which the probability is looked at, as shares of the range at which the ray ends.
const LOOKED_AT: [f64; 14] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97, 1.03, 1.1, 1.3, 2.0];
/// Minimum probability of a visible place; less probable places count as hidden. A small remainder that never ends
/// would be most of an area that grows with the square of the range.
const UNLIKELY: f32 = 0.05;
/// Rays of the plan.
const PLAN_RAYS: usize = 360;
/// Rays around the horizon; half as many from the zenith to the nadir.
const SPACE_RAYS: usize = 72;
/// Sectors of a circle within which errors are the same.
const SECTORS: usize = 12;
/// Standard deviations from the mean to the end of an interval that holds 90 % of a normal distribution.
const DEVIATIONS: f64 = 1.645;

/// Returns the intervals of `seen`, the isovist of `eye`, local metres; `None` without pulses.
///
/// # Errors
/// [`belvedere_data::Error::Cancelled`].
pub fn isovist_intervals(
    scene: &MedialScene,
    eye: [f64; 3],
    seen: &Isovist,
    params: &IsovistParams,
    control: &Control<'_>,
) -> Result<Option<IsovistIntervals>> {
    if scene.proof().is_none() {
        return Ok(None);
    }
    let reach = params.max_range;
    let steps = |direction: [f64; 3]| {
        control.check()?;
        let range = scene.seen_along(eye, direction, reach).map_or(reach, |(_, range)| range.min(reach));
        let backward = direction.map(|v| -v);
        let likely = |at: f64| {
            let target = std::array::from_fn(|axis| eye[axis] + at * direction[axis]);
            let probability = scene.evidence(target, backward, at).map_or(1.0, |evidence| evidence.probability());
            if probability <= UNLIKELY { 0.0 } else { f64::from(probability) }
        };
        let ranges = LOOKED_AT.map(|share| (share * range).min(reach)).into_iter().filter(|at| *at > 0.0);
        Ok((range, ends_of_sight(ranges.map(|at| (at, likely(at))), reach)))
    };
    let step = TAU / PLAN_RAYS as f64;
    let plan = (0..PLAN_RAYS).into_par_iter().map(|ray| {
        let (range, ends) = steps(to_sun(ray as f64 * step, 0.0))?;
        Ok((ray * SECTORS / PLAN_RAYS, RayPart::new(range, &ends, |range| step * range.powi(2) / 2.0)))
    });
    let plan: Vec<(usize, RayPart)> = plan.collect::<Result<_>>()?;
    let step = TAU / SPACE_RAYS as f64;
    let space = (0..SPACE_RAYS * SPACE_RAYS / 2).into_par_iter().map(|at| {
        let (column, row) = (at % SPACE_RAYS, at / SPACE_RAYS);
        let top = FRAC_PI_2 - row as f64 * step;
        let weight = step * (top.sin() - (top - step).sin());
        let sector = row * SECTORS / SPACE_RAYS * SECTORS + column * SECTORS / SPACE_RAYS;
        let (range, ends) = steps(direction(column, row, step))?;
        Ok((sector, RayPart::new(range, &ends, |range| weight * range.powi(3) / 3.0)))
    });
    let space: Vec<(usize, RayPart)> = space.collect::<Result<_>>()?;
    Ok(Some(IsovistIntervals {
        plan_area: interval_of_sum(seen.plan.area, &plan),
        volume: interval_of_sum(seen.volume, &space),
    }))
}

/// Returns the ranges at which sight may end, with their probabilities, from the probabilities that places at rising
/// ranges are visible.
fn ends_of_sight(places: impl Iterator<Item = (f64, f64)>, reach: f64) -> Vec<(f64, f64)> {
    let (mut before, mut left) = (0.0, 1.0_f64);
    let mut ends = Vec::new();
    for (at, likely) in places {
        // what is hidden stays hidden farther away
        let likely = likely.min(left);
        ends.push((f64::midpoint(before, at), left - likely));
        (before, left) = (at, likely);
    }
    ends.push((f64::midpoint(before, reach), left));
    ends
}

/// Contribution of a ray to a sum.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RayPart {
    /// Expected value less the visible one.
    more: f64,
    /// Standard deviation.
    deviation: f64,
}

impl RayPart {
    /// Computes the part of a ray from the range of sight and its possible ends. It adds `size` to the sum if it ends
    /// at a range.
    fn new(range: f64, ends: &[(f64, f64)], size: impl Fn(f64) -> f64) -> Self {
        let moment = |of: &dyn Fn(f64) -> f64| ends.iter().map(|&(at, likely)| likely * of(size(at))).sum::<f64>();
        let mean = moment(&|size| size);
        let variance = moment(&|size| (size - mean).powi(2));
        Self { more: mean - size(range), deviation: variance.sqrt() }
    }
}

/// The interval around a sum, from the contributions of rays, each with its sector.
fn interval_of_sum(sum: f64, parts: &[(usize, RayPart)]) -> [f64; 2] {
    let mut sectors = vec![0.0; parts.iter().map(|(sector, _)| sector + 1).max().unwrap_or(0)];
    parts.iter().for_each(|(sector, part)| sectors[*sector] += part.deviation);
    let mean = sum + parts.iter().map(|(_, part)| part.more).sum::<f64>();
    let deviation = sectors.iter().map(|sector: &f64| sector * sector).sum::<f64>().sqrt();
    [(mean - DEVIATIONS * deviation).max(0.0), mean + DEVIATIONS * deviation]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_a_sector_are_added_up_and_those_of_sectors_are_independent() {
        let part = |more, deviation| RayPart { more, deviation };
        let parts = [(0, part(1.0, 2.0)), (0, part(-0.5, 1.0)), (3, part(0.5, 4.0))];
        let [low, high] = interval_of_sum(40.0, &parts);
        assert!((low - (41.0 - 5.0 * DEVIATIONS)).abs() < 1e-12 && (high - (41.0 + 5.0 * DEVIATIONS)).abs() < 1e-12);
    }

    #[test]
    fn sight_ends_where_the_probability_falls() {
        let ends = ends_of_sight([(4.0, 1.0), (6.0, 0.25), (8.0, 0.5), (9.0, 0.0)].into_iter(), 20.0);
        assert_eq!(ends, [(2.0, 0.0), (5.0, 0.75), (7.0, 0.0), (8.5, 0.25), (14.5, 0.0)]);
        let part = RayPart::new(5.0, &ends, |range| range);
        assert!((part.more - 0.875).abs() < 1e-12 && (part.deviation - 1.515_544_5).abs() < 1e-6, "{part:?}");
    }
}
