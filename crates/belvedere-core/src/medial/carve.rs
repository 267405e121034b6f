//! Cutting of balls by pulses.

use super::marks::RadiusCaps;
use crate::neighbors::Tangent;
use crate::normals::OrientedCloud;
use crate::pulses::{FreeSegments, GAP_M};
use belvedere_data::balls::{LIMIT_TOUCH, MedialBalls, NO_TOUCH, PULSE_TOUCH};
use belvedere_data::control::Control;
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use serde::Serialize;

/// Balls handed to a thread at once; their searches share the cache.
const CHUNK: usize = 512;

/// Counts of balls by outcome of [`carve`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CarveReport {
    /// Balls that a pulse made smaller.
    #[serde(rename = "balls_cut_by_pulses")]
    pub carved: usize,
    /// Balls that were cut to the largest radius for their point.
    #[serde(rename = "balls_limited")]
    pub limited: usize,
}

/// Cuts each of `balls` until no free segment of a pulse comes nearer than a millimetre, then brings its radius within
/// `caps`. Row i of `balls` must be the interior ball of point i of `oriented`, as [`super::shrink`] makes it; so must
/// row i of the caps.
///
/// A ball that had met no point but meets a pulse gets [`PULSE_TOUCH`]. One that meets neither gets [`LIMIT_TOUCH`] and
/// at most [`RadiusCaps::unbounded`]: its surface blocks all the same. The result depends on neither order nor number
/// of threads.
///
/// # Errors
/// [`Error::LengthMismatch`] where they differ in length, [`Error::Cancelled`].
///
/// # Source
/// This project's own; cutting free space by lines of sight has relatives in space carving (Kutulakos & Seitz 2000) and
/// cone carving (Shalom et al. 2010).
pub fn carve(
    balls: &mut MedialBalls,
    oriented: &OrientedCloud,
    free_segments: &FreeSegments,
    caps: &RadiusCaps,
    control: &Control<'_>,
) -> Result<CarveReport> {
    let expected = oriented.positions().len();
    for (what, found) in [("balls", balls.len()), ("largest radii", caps.radii.len())] {
        if found != expected {
            return Err(Error::LengthMismatch { what, expected, found });
        }
    }
    let (positions, normals) = (oriented.positions(), oriented.normals());
    let ball = |row: usize, radius: f32| {
        let tangent = Tangent { point: positions[row], inward: normals[row].map(|v| -v), margin: 0.0 };
        free_segments.smallest_tangent_ball(&tangent, radius)
    };
    let is_centred = |row: usize| caps.is_centred.get(row) == Some(&true);
    // what is larger than its limit is cut to that first: the search is shorter
    let mut carved: Vec<Option<f32>> = vec![None; expected];
    carved.par_chunks_mut(CHUNK).enumerate().try_for_each(|(chunk, carved)| {
        control.check()?;
        for (row, carved) in (chunk * CHUNK..).zip(carved.iter_mut()) {
            *carved = if is_centred(row) {
                Some(free_segments.clearance(positions[row], caps.radii[row]))
            } else {
                ball(row, balls.radii[row].min(caps.radii[row]))
            };
        }
        control.advance(carved.len());
        Ok(())
    })?;
    Ok(settle(balls, oriented, &carved, caps))
}

/// Gives each ball the radius that its pulses leave of it, which `carved` holds where a pulse comes near, within
/// `caps`.
fn settle(balls: &mut MedialBalls, oriented: &OrientedCloud, carved: &[Option<f32>], caps: &RadiusCaps) -> CarveReport {
    let (positions, normals) = (oriented.positions(), oriented.normals());
    let mut report = CarveReport::default();
    for (row, &carved) in carved.iter().enumerate() {
        if let Some(radius) = carved.filter(|_| caps.is_centred.get(row) == Some(&true)) {
            (balls.centers[row], balls.radii[row]) = (positions[row], radius);
            balls.separation_angles[row] = f32::NAN;
            // what the pulses leave nothing of blocks nothing
            balls.touch[row] = if radius > 0.0 { PULSE_TOUCH } else { NO_TOUCH };
            continue;
        }
        if !(balls.radii[row] > 0.0) {
            continue;
        }
        let mut radius = balls.radii[row];
        if let Some(carved) = carved {
            report.carved += 1;
            radius = carved;
        }
        let mut most = caps.radii[row];
        let is_unbounded = carved.is_none() && balls.touch[row] == NO_TOUCH;
        if is_unbounded && most.is_infinite() {
            most = caps.unbounded;
        }
        report.limited += usize::from(radius > most);
        radius = radius.min(most);
        if radius < balls.radii[row] || carved.is_some() {
            balls.radii[row] = radius;
            balls.centers[row] = std::array::from_fn(|i| positions[row][i] - normals[row][i] * radius);
            if carved.is_some() {
                balls.radii[row] = (radius - GAP_M).max(0.0);
                // what the pulses leave nothing of blocks nothing
                balls.touch[row] = if radius > GAP_M { PULSE_TOUCH } else { NO_TOUCH };
                balls.separation_angles[row] = f32::NAN;
            }
        }
        if is_unbounded {
            balls.touch[row] = LIMIT_TOUCH;
        }
    }
    report
}
