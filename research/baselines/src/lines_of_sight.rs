//! What all methods that trace one ray per target have in common.

use belvedere::cast::to_f32;
use belvedere::query::{Answer, Sight, Viewer};
use belvedere::ray_index::Ray;
use belvedere::{Error, Parameter, Result};
use rayon::prelude::*;

/// Least targets handed to a thread at once: enough to make handing over cheap, few enough to share slow ones out.
const CHUNK: usize = 256;

/// Answers targets by one ray each, from `clearance` metres before the target to the viewer; `blocks` says whether
/// anything lies within the ranges of a ray, which count from the target.
///
/// A target that is not finite, or is the eye itself, gets [`Answer::OutsideView`]. One nearer to its eye than the
/// clearance is visible.
///
/// # Errors
/// [`Error::InvalidParameter`] for a viewer that is not finite.
pub(crate) fn sight<'a>(
    viewer: Viewer<'a>,
    clearance: f64,
    blocks: impl Fn(&Ray) -> bool + Sync + 'a,
) -> Result<Sight<'a>> {
    viewer.validate()?;
    Ok(Box::new(move |targets| {
        viewer.validate_count(targets)?;
        let answer = |(index, &target): (usize, &[f32; 3])| {
            let line = viewer.line_of_sight(index, target);
            let ray = line.and_then(|(unit, range)| Ray::new(target.map(f64::from), unit, [clearance, range]));
            match ray {
                None => Answer::OutsideView,
                Some(ray) if ray.ranges[0] < ray.ranges[1] && blocks(&ray) => Answer::Blocked,
                Some(_) => Answer::Visible,
            }
        };
        Ok(targets.par_iter().enumerate().with_min_len(CHUNK).map(answer).collect())
    }))
}

/// Checks that a parameter is finite and at least `min`.
pub(crate) fn check_min(name: &'static str, value: f64, min: f64, expected: &'static str) -> Result<()> {
    if value.is_finite() && value >= min {
        return Ok(());
    }
    Err(Error::InvalidParameter {
        parameter: Parameter::MethodSetting,
        value: format!("{value} for the {name}"),
        expected,
    })
}

/// Checks that a parameter is finite and above zero.
pub(crate) fn check_positive(name: &'static str, value: f64) -> Result<()> {
    check_min(name, value, f64::MIN_POSITIVE, "finite and above zero")
}

/// Checks that a clearance is finite and not negative.
pub(crate) fn check_clearance(value: f64) -> Result<()> {
    check_min("clearance", value, 0.0, "finite and not negative, metres")
}

/// A corner of a box in f32, rounded away from the inside: `outward` is −1 for the lowest corner and 1 for the highest.
pub(crate) fn box_corner(corner: [f64; 3], outward: f64) -> [f32; 3] {
    corner.map(|v| if outward < 0.0 { to_f32(v).next_down() } else { to_f32(v).next_up() })
}
