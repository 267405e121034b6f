//! Selection of the balls that are vegetation.

use belvedere_data::balls::MedialBalls;
use belvedere_data::{Error, Result};

/// Flags the balls that are vegetation, (B), as measured by carving: those whose `transmission`, (B), is a number.
#[must_use]
pub fn vegetation_of_transmission(transmission: &[f32]) -> Vec<bool> {
    transmission.iter().map(|share| !share.is_nan()).collect()
}

/// Flags the balls that are vegetation, (B), by the class of the points that they touch: low, medium and high
/// vegetation (3 to 5). `classification` has a row for each point that the balls were made from.
#[must_use]
pub fn vegetation_of_classes(balls: &MedialBalls, classification: &[u8]) -> Vec<bool> {
    let is_vegetation = |source: &u32| matches!(classification.get(*source as usize), Some(3..=5));
    balls.source.iter().map(is_vegetation).collect()
}

/// The balls that are not vegetation by `is_vegetation`, (B).
///
/// # Errors
/// [`Error::LengthMismatch`] where there is not a row for each ball.
pub fn without_vegetation(balls: &MedialBalls, is_vegetation: &[bool]) -> Result<MedialBalls> {
    let (expected, found) = (balls.len(), is_vegetation.len());
    if expected != found {
        return Err(Error::LengthMismatch { what: "balls of vegetation", expected, found });
    }
    let rows: Vec<usize> = (0..expected).filter(|&row| !is_vegetation[row]).collect();
    Ok(balls.select(&rows))
}
