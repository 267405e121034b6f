//! The profile along one line of sight: the ground, the obstacles on it, and the line.

use belvedere_core::ground::Ground;
use belvedere_core::query::{Curvature, EarthParams, MedialScene, merged_crossings};
use belvedere_data::cast::to_u32;
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Height above and below the line and the ground within which balls are searched, metres: more than any building.
const REACH: f64 = 500.0;
/// Rows between two looks at whether the work was cancelled: some milliseconds.
const CHECKED: u32 = 256;
/// Maximum number of rows of a profile.
const MAX_ROWS: f64 = 1e6;

/// Profile along a line of sight, one value for each of equally spaced places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SightProfile {
    /// Distance on the map from the observer, metres.
    pub distances: Vec<f64>,
    /// Height of the ground, local metres, on far terrain that of its raster; NaN where it is not known.
    pub ground: Vec<f64>,
    /// Height of the line, local metres: below the straight one where the earth is curved.
    pub line: Vec<f64>,
    /// The pieces of the vertical that lie in balls, (from, to), local metres, from below; none on far terrain.
    pub solid: Vec<Vec<[f64; 2]>>,
    /// True where the line lies in a ball, or below far terrain.
    pub blocked: Vec<bool>,
    /// Distance on the map at which the line is blocked, metres.
    pub blocked_at: Option<f64>,
}

/// The profile from `observer` to `target`, local metres, every `step` metres on the map; `None` for a thousandth of
/// the line, 0.1 m at least. A line over far terrain ([`MedialScene::is_on_far_terrain`]) follows the curvature of the
/// earth whatever its length.
///
/// # Errors
/// [`Error::InvalidParameter`] for ends that are not finite or stand above each other, and for a step that is not above
/// zero or makes more than a million rows; [`Error::Cancelled`].
pub fn sight_profile(
    scene: &MedialScene,
    ground: Option<&Ground>,
    [observer, target]: [[f64; 3]; 2],
    earth: &EarthParams,
    step: Option<f64>,
    control: &Control<'_>,
) -> Result<SightProfile> {
    let (span, step) = span_and_step([observer, target], step)?;
    let is_far = |place: [f64; 3]| scene.is_on_far_terrain(place);
    let is_over_terrain = is_far(observer) || is_far(target);
    let bends = earth.bends(observer, target) || (is_over_terrain && earth.curvature != Curvature::Off);
    let count = to_u32((span / step).ceil());
    let row = |i: u32| {
        if i.is_multiple_of(CHECKED) {
            control.check()?;
        }
        let share = if i == count { 1.0 } else { (f64::from(i) * step / span).min(1.0) };
        let place: [f64; 3] = std::array::from_fn(|k| observer[k] + share * (target[k] - observer[k]));
        let line = place[2] - if bends { earth.sag(span, share) } else { 0.0 };
        if is_over_terrain && is_far(place) {
            let terrain = scene.far_terrain().grid();
            let ground = terrain.and_then(|terrain| terrain.height_at([place[0], place[1]])).unwrap_or(f64::NAN);
            return Ok((share * span, ground, line, Vec::new(), ground > line));
        }
        let ground = ground.and_then(|ground| ground.height_at([place[0], place[1]])).unwrap_or(f64::NAN);
        let low = line.min(ground) - REACH;
        let high = line.max(ground) + REACH;
        let up = [[place[0], place[1], low], [place[0], place[1], high]];
        let pieces = merged_crossings(&scene.crossings(up[0], up[1], &EarthParams::flat()));
        let solid: Vec<[f64; 2]> = pieces.into_iter().map(|piece| piece.map(|range| low + range)).collect();
        let is_blocked = solid.iter().any(|[low, high]| *low < line && line < *high);
        Ok((share * span, ground, line, solid, is_blocked))
    };
    let rows: Vec<_> = (0..=count).into_par_iter().map(row).collect::<Result<_>>()?;
    let block = scene.line_of_sight(observer, target, earth).and_then(|sight| sight.first_block);
    let mut profile = SightProfile {
        blocked_at: block.map(|block| (block.place[0] - observer[0]).hypot(block.place[1] - observer[1])),
        ..SightProfile::default()
    };
    for (distance, ground, line, solid, is_blocked) in rows {
        profile.distances.push(distance);
        profile.ground.push(ground);
        profile.line.push(line);
        profile.solid.push(solid);
        profile.blocked.push(is_blocked);
    }
    Ok(profile)
}

/// The length of a line on the map and the distance between rows of its profile, both checked, metres.
fn span_and_step([observer, target]: [[f64; 3]; 2], step: Option<f64>) -> Result<(f64, f64)> {
    let span = (target[0] - observer[0]).hypot(target[1] - observer[1]);
    if !(span.is_finite() && span > 0.0 && observer[2].is_finite() && target[2].is_finite()) {
        let value = format!("{observer:?} to {target:?}");
        return Err(Error::invalid(Parameter::ProfileLine, value, "finite, and at different positions on the map"));
    }
    let step = step.unwrap_or((span / 1000.0).max(0.1));
    if !(step > 0.0 && span / step <= MAX_ROWS) {
        let value = format!("{step} m on {span} m");
        return Err(Error::invalid(Parameter::ProfileStep, value, "above zero, and large enough for a million rows"));
    }
    Ok((span, step))
}
