//! Isovists: the space that an eye sees, measured.

mod figures;
mod intervals;
mod leaks;
mod params;
mod plan;
mod ranges;

pub use figures::IsovistFigure;
pub use intervals::isovist_intervals;
pub use params::IsovistParams;
pub use plan::PlanIsovist;
pub use ranges::RadialStatistics;

use belvedere_core::query::MedialScene;
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::vector::to_f32;
use belvedere_data::view::to_sun;
use belvedere_data::{Error, Parameter, Result};
use leaks::{ClosedRoomParams, ClosedSurface, RangeGrid};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Rays between two looks at whether the work was cancelled: a few milliseconds.
const CHECKED: usize = 1024;

/// Space visible from an eye.
#[derive(Clone, Debug, PartialEq)]
pub struct Isovist {
    /// Ranges in metres, +∞ if nothing blocks within the maximum range. A column is an azimuth: clockwise from south at
    /// the left edge over west, north in the middle and east to south again. A row is an elevation, from the zenith
    /// down to the nadir.
    pub panorama: Raster<f32>,
    /// Volume seen, m³. Directions in which nothing blocks reach to the greatest range; in a closed room those that
    /// leave it between its points reach to its surface.
    pub volume: f64,
    /// Share of all directions that leave a closed room between its points, 0 to 1: they are neither blocked nor open.
    pub unbounded: f64,
    /// Volume seen in the directions in which something blocks, m³.
    pub blocked_volume: f64,
    /// Ranges in all directions, each counting by its solid angle, open ones as the greatest range.
    pub ranges: RadialStatistics,
    /// Share of all directions in which nothing blocks within the greatest range, 0 to 1.
    pub openness: f64,
    /// The same share of the directions above the horizon: the sky.
    pub sky_openness: f64,
    /// Vector from the eye to the middle of the visible volume, local metres.
    pub drift: [f64; 3],
    /// Visible area in the level plane through the eye.
    pub plan: PlanIsovist,
    /// Intervals of its figures; `None` if not requested, and without pulses.
    pub intervals: Option<IsovistIntervals>,
}

/// Between which sizes an isovist lies nine times in ten.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IsovistIntervals {
    /// Area seen in the level plane, m².
    pub plan_area: [f64; 2],
    /// Volume seen, m³.
    pub volume: [f64; 2],
}

/// Computes the isovist of an eye at `eye`, local metres, in `scene`. Balls that hold the eye are left out
/// ([`MedialScene::enclosure`] returns them).
///
/// # Errors
/// [`Error::InvalidParameter`] for an eye that is not finite and for parameters outside their range, and
/// [`Error::Cancelled`].
pub fn isovist(scene: &MedialScene, eye: [f64; 3], params: &IsovistParams, control: &Control<'_>) -> Result<Isovist> {
    if !eye.iter().all(|v| v.is_finite()) {
        return Err(Error::invalid(Parameter::Eye, format!("{eye:?}"), "finite"));
    }
    let range = |direction: [f64; 3]| scene.seen_along(eye, direction, params.max_range).map(|(_, range)| range);
    isovist_of(&range, params, control)
}

/// The isovist by the function `range`, which returns the distance to the first obstacle along a unit vector, metres,
/// and `None` without one. It is evaluated on a regular grid of azimuths and elevations, where each ray represents its
/// cell, and along the horizon.
///
/// Volumes are sums of r³ / 3 over solid angles: exact where ranges are equal, otherwise right to the order of the
/// square of the step.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters outside their range, and [`Error::Cancelled`].
///
/// # Source
/// Benedikt 1979 (To take hold of space: isovists and isovist fields); in three dimensions Fisher-Gewirtzman & Wagner
/// 2003 (visible volume). Drift: Conroy Dalton 2001. Openness and occlusivity: Benedikt 1979; Dalton & Dalton 2001.
pub fn isovist_of(
    range: &(impl Fn([f64; 3]) -> Option<f64> + Sync),
    params: &IsovistParams,
    control: &Control<'_>,
) -> Result<Isovist> {
    params.validate()?;
    let reach = params.max_range;
    let width = to_index((TAU / params.step).round()).next_multiple_of(4);
    let height = width / 2;
    let step = TAU / width as f64;
    let within = |direction: [f64; 3]| range(direction).filter(|range| *range < reach);
    let ranges: Vec<Option<f64>> = (0..width * height)
        .into_par_iter()
        .with_min_len(256)
        .map(|at| {
            if at.is_multiple_of(CHECKED) {
                control.check()?;
            }
            Ok(within(direction(at % width, at / width, step)))
        })
        .collect::<Result<_>>()?;
    let weight = |row: usize| {
        let top = FRAC_PI_2 - row as f64 * step;
        step * (top.sin() - (top - step).sin())
    };
    let weights: Vec<f64> = (0..height).map(weight).collect();
    let panorama: Vec<f32> = in_f32(&ranges);
    let blocked: f64 = (ranges.iter().enumerate())
        .map(|(at, range)| range.map_or(0.0, |range| weight(at / width) * range.powi(3) / 3.0))
        .sum();
    let grid = RangeGrid { ranges: &ranges, width, weights: &weights, reach };
    let surface = ClosedSurface::of(&grid, &ClosedRoomParams::default());
    let (ranges, unbounded) = match &surface {
        Some(surface) => (surface.ranges.clone(), surface.gap_share),
        None => (ranges, 0.0),
    };
    let within = |direction: [f64; 3]| within(direction).or_else(|| surface.as_ref()?.range_at(direction));
    let weighted: Vec<(f64, f64)> =
        ranges.iter().enumerate().map(|(at, range)| (range.unwrap_or(reach), weight(at / width))).collect();
    let total: f64 = weighted.iter().map(|(_, weight)| weight).sum();
    let open = |from: usize, to: usize| {
        let rows = || weighted.iter().zip(&ranges).skip(from * width).take((to - from) * width);
        // the sum of nothing is -0
        (rows().filter(|(_, range)| range.is_none()).map(|(w, _)| w.1).sum::<f64>() + 0.0)
            / rows().map(|(w, _)| w.1).sum::<f64>()
    };
    let cone = |(range, weight): &(f64, f64)| weight * range.powi(3) / 3.0;
    let volume: f64 = weighted.iter().map(cone).sum();
    let mut drift = [0.0; 3];
    for (at, (range, weight)) in weighted.iter().enumerate() {
        // the middle of a cone lies at three quarters of its height
        let share = weight * range.powi(4) / 4.0;
        let direction = direction(at % width, at / width, step);
        drift = std::array::from_fn(|i| drift[i] + share * direction[i]);
    }
    debug_assert!((total / (2.0 * TAU) - 1.0).abs() < 1e-9);
    Ok(Isovist {
        panorama: Raster::from_values(width, height, panorama)?,
        volume,
        unbounded,
        blocked_volume: blocked,
        ranges: RadialStatistics::of(&weighted),
        openness: open(0, height),
        sky_openness: open(0, height / 2),
        drift: drift.map(|v| if volume > 0.0 { v / volume } else { 0.0 }),
        plan: plan::plan(&within, width, params),
        intervals: None,
    })
}

fn in_f32(ranges: &[Option<f64>]) -> Vec<f32> {
    ranges.iter().map(|range| range.map_or(f32::INFINITY, to_f32)).collect()
}

/// Unit vector through the middle of a cell of the panorama.
fn direction(column: usize, row: usize, step: f64) -> [f64; 3] {
    to_sun((column as f64 + 0.5) * step - PI, FRAC_PI_2 - (row as f64 + 0.5) * step)
}
