//! How large an isovist may be in truth: from the ranges up to which sight certainly reaches, and beyond which it
//! certainly does not.
//!
//! Along each ray the probability that a place is visible falls with its range. Errors of rays beside each other come
//! from the same edges, so that they are added up within a sector; sectors are taken for independent of each other.

use super::{Isovist, IsovistParams, direction};
use crate::certain_bounds::{LIKELY, UNLIKELY, first_certain};
use belvedere_core::query::MedialScene;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::view::to_sun;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// First step from where a ray ends to where that is certain, metres: a few balls.
const FIRST_STEP: f64 = 0.25;
/// Rays of the plan.
const PLAN_RAYS: usize = 360;
/// Rays around the horizon; half as many from the zenith to the nadir.
const SPACE_RAYS: usize = 72;
/// Sectors of a circle within which errors are the same.
const SECTORS: usize = 24;

/// Between which sizes an isovist lies nine times in ten.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IsovistIntervals {
    /// Area seen in the level plane, m².
    pub plan_area: [f64; 2],
    /// Volume seen, m³.
    pub volume: [f64; 2],
}

/// How large `seen`, the isovist of `eye`, local metres, may be in truth; `None` without pulses.
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
    // where sight ends, and between which ranges it does
    let ranges = |direction: [f64; 3]| {
        control.check()?;
        let range = scene.seen_along(eye, direction, reach).map_or(reach, |(_, range)| range.min(reach));
        let backward = direction.map(|v| -v);
        let likely = |at: f64| {
            let target = std::array::from_fn(|axis| eye[axis] + at * direction[axis]);
            scene.evidence(target, backward, at).map_or(1.0, |evidence| evidence.probability())
        };
        let low = first_certain(range, FIRST_STEP, 0.0, |at| at <= 0.0 || likely(at) >= LIKELY);
        let high = first_certain(range, FIRST_STEP, reach, |at| at <= 0.0 || likely(at) <= UNLIKELY);
        Ok([range, low, high])
    };
    let step = TAU / PLAN_RAYS as f64;
    let plan = (0..PLAN_RAYS).into_par_iter().map(|ray| {
        let found = ranges(to_sun(ray as f64 * step, 0.0))?;
        Ok((ray * SECTORS / PLAN_RAYS, found.map(|range| step * range.powi(2) / 2.0)))
    });
    let plan: Vec<(usize, [f64; 3])> = plan.collect::<Result<_>>()?;
    let step = TAU / SPACE_RAYS as f64;
    let space = (0..SPACE_RAYS * SPACE_RAYS / 2).into_par_iter().map(|at| {
        let (column, row) = (at % SPACE_RAYS, at / SPACE_RAYS);
        let top = FRAC_PI_2 - row as f64 * step;
        let weight = step * (top.sin() - (top - step).sin());
        let sector = row * SECTORS / SPACE_RAYS * SECTORS + column * SECTORS / SPACE_RAYS;
        Ok((sector, ranges(direction(column, row, step))?.map(|range| weight * range.powi(3) / 3.0)))
    });
    let space: Vec<(usize, [f64; 3])> = space.collect::<Result<_>>()?;
    Ok(Some(IsovistIntervals { plan_area: around(seen.plan.area, &plan), volume: around(seen.volume, &space) }))
}

/// The interval around a sum, from the parts of it that rays see and the least and the most that they may see: each
/// with its sector.
fn around(sum: f64, parts: &[(usize, [f64; 3])]) -> [f64; 2] {
    let mut sectors = vec![[0.0; 2]; parts.iter().map(|(sector, _)| sector + 1).max().unwrap_or(0)];
    for (sector, [seen, low, high]) in parts {
        sectors[*sector][0] += seen - low;
        sectors[*sector][1] += high - seen;
    }
    let [less, more] =
        [0, 1].map(|end| sectors.iter().map(|sector: &[f64; 2]| sector[end].powi(2)).sum::<f64>().sqrt());
    [(sum - less).max(0.0), sum + more]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_a_sector_are_added_up_and_those_of_sectors_are_independent() {
        let parts = [(0, [10.0, 9.0, 11.0]), (0, [10.0, 8.0, 10.0]), (3, [20.0, 16.0, 20.5])];
        let [low, high] = around(40.0, &parts);
        assert!((low - 35.0).abs() < 1e-12 && (high - 40.0 - 1.25_f64.sqrt()).abs() < 1e-12, "{low} {high}");
    }
}
