//! Horizon profiles: above which elevation the sky is free around a place, as photovoltaic tools read it.

use belvedere_core::query::{EarthParams, MedialScene, SkylinePoint};
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use belvedere_data::crs::evidence::{CONTRADICTION_DISTANCE, distance_in_words};
use belvedere_data::crs::{Crs, GeographicProjection};
use belvedere_data::view::to_sun;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// First step from a skyline to where the sky is certainly free or hidden, radians: an eighth of a degree.
const FIRST_STEP: f64 = PI / 1440.0;
/// Halvings after steps that double: a sixteenth of the last step is not separated.
const HALVINGS: usize = 4;
/// Probabilities of nearly certain and of nearly impossible answers.
const LIKELY: f32 = 0.95;
const UNLIKELY: f32 = 0.05;

/// Parameters of horizons.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HorizonParams {
    /// Number of azimuths, equally far apart, 1 to 1 000 000. Default 360: one a degree.
    pub azimuth_count: usize,
    /// Angle that is added to azimuths from grid north to make those that come out, radians: 0, the default, for grid
    /// north, [`convergence`] for true north.
    pub turn: f64,
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
}

belvedere_data::setters!(HorizonParams {
    with_azimuth_count(azimuth_count: usize),
    with_turn(turn: f64),
    with_earth(earth: EarthParams),
});

impl Default for HorizonParams {
    fn default() -> Self {
        Self { azimuth_count: 360, turn: 0.0, earth: EarthParams::default() }
    }
}

/// The skyline around each of `eyes`, (N) local metres, at azimuths of equal steps clockwise from north. See
/// [`MedialScene::skyline`]; elevations are exact for the balls. An eye that is not finite
/// ([`crate::eyes::skip_unfit_eyes`]) has no points. Progress counts eyes.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters outside their range, and [`Error::Cancelled`].
pub fn horizons(
    scene: &MedialScene,
    eyes: &[[f64; 3]],
    params: &HorizonParams,
    control: &Control<'_>,
) -> Result<Vec<Vec<SkylinePoint>>> {
    params.earth.validate()?;
    if !(1..=1_000_000).contains(&params.azimuth_count) {
        return Err(Error::invalid(Parameter::DirectionCount, params.azimuth_count, "1 to 1000000"));
    }
    if !params.turn.is_finite() {
        return Err(Error::invalid(Parameter::North, params.turn, "finite"));
    }
    eyes.iter()
        .map(|&eye| {
            let skyline = scene.skyline_from(eye, params.azimuth_count, -params.turn, &params.earth, control)?;
            control.advance(1);
            Ok(skyline)
        })
        .collect()
}

/// Between which elevations, radians, the sky begins at each azimuth of `skylines`, of those around `eyes`: nine times
/// in ten. The probability that the sky is free rises with the elevation; where it passes 5 % and 95 % the truth is
/// likely to lie between. Where no pulse is known both are those of the skyline. Progress counts eyes.
///
/// # Errors
/// [`Error::Cancelled`].
pub fn horizon_intervals(
    scene: &MedialScene,
    eyes: &[[f64; 3]],
    skylines: &[Vec<SkylinePoint>],
    params: &HorizonParams,
    control: &Control<'_>,
) -> Result<Vec<Vec<[f64; 2]>>> {
    let of_eye = |(&eye, skyline): (&[f64; 3], &Vec<SkylinePoint>)| {
        let interval = |(number, point): (usize, &SkylinePoint)| {
            control.check()?;
            let azimuth = TAU * number as f64 / skyline.len() as f64 - params.turn;
            let likely_free = |elevation: f64| {
                let evidence = scene.evidence(eye, to_sun(azimuth, elevation), f64::INFINITY);
                evidence.map(|evidence| evidence.probability())
            };
            let is_free = |elevation| likely_free(elevation).is_none_or(|probability| probability >= LIKELY);
            let is_hidden = |elevation| likely_free(elevation).is_none_or(|probability| probability <= UNLIKELY);
            let low = first_certain(point.elevation, FIRST_STEP, -FRAC_PI_2, is_hidden);
            Ok([low, first_certain(point.elevation, FIRST_STEP, FRAC_PI_2, is_free)])
        };
        let found = skyline.par_iter().enumerate().map(interval).collect();
        control.advance(1);
        found
    };
    eyes.iter().zip(skylines).map(of_eye).collect()
}

/// Returns the first elevation from `from` towards `limit`, which ends the search, that `is_certain`. The search
/// doubles steps from `step`, above 0, and then bisects the last of them.
fn first_certain(from: f64, step: f64, limit: f64, is_certain: impl Fn(f64) -> bool) -> f64 {
    if is_certain(from) {
        return from;
    }
    let all = (limit - from).abs();
    let at = |away: f64| from + away.copysign(limit - from);
    let (mut open, mut away) = (0.0, step);
    while away < all && !is_certain(at(away)) {
        open = away;
        away *= 2.0;
    }
    let mut certain = away.min(all);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(open, certain);
        *(if is_certain(at(middle)) { &mut certain } else { &mut open }) = middle;
    }
    at(certain)
}

/// Number of azimuths for a step, radians, above 0: steps of a full circle are made equal.
///
/// # Errors
/// [`Error::InvalidParameter`] for a step that is not above zero, is more than a full circle, or does not part it
/// evenly (to a millionth).
pub fn azimuth_count(step: f64) -> Result<usize> {
    let count = TAU / step;
    if !(1.0 - 1e-9..=1e6).contains(&count) || (count - count.round()).abs() > 1e-6 * count {
        let expected = "a divisor of 360 degrees, such as 1, 2.5 or 7.5";
        return Err(Error::invalid(Parameter::AngleStep, format!("{}", step.to_degrees()), expected));
    }
    Ok(to_index(count.round()))
}

/// Meridian convergence at `position`, (x, y) metres in the system `crs`: the azimuth of grid north, clockwise from
/// true north, radians. An azimuth from true north is that from grid north plus this. Where the place on earth is not
/// known it follows from the parameters of the projection.
///
/// # Errors
/// Those of [`Crs::grid_projection`], and where the place has no latitude or lies far outside of the area of use.
pub fn convergence(crs: &Crs, position: [f64; 2]) -> Result<f64> {
    if let Some(value) = far_outside(crs, position) {
        return Err(Error::invalid(Parameter::ReferenceSystem, value, "one whose area of use holds the scene"));
    }
    let by_place = crs.geographic_projection().and_then(|projection| convergence_of(&projection, position));
    by_place.or_else(|error| match crs.grid_projection() {
        Ok(projection) => convergence_of(&projection, position),
        Err(_) => Err(error),
    })
}

/// In words, where `position`, metres, lies too far outside of the area of use of a system to be meant; `None` where it
/// does not.
pub(crate) fn far_outside(crs: &Crs, position: [f64; 2]) -> Option<String> {
    let distance = crs.distance_to_area_of_use(position.map(|v| v / crs.metres_per_unit))?;
    (distance > CONTRADICTION_DISTANCE).then(|| match distance.is_finite() {
        true => format!("{}, from whose area of use the scene is {} away", crs.describe(), distance_in_words(distance)),
        false => format!("{}, in which the coordinates of the scene are no place", crs.describe()),
    })
}

fn convergence_of(projection: &GeographicProjection, position: [f64; 2]) -> Result<f64> {
    let [latitude, longitude] = projection.unproject(position)?;
    // 1 km to the north along the meridian: short against its curvature, long against rounding
    let [x, y] = projection.project(latitude + 1000.0 / belvedere_core::query::earth::EARTH_RADIUS, longitude)?;
    let true_north = (x - position[0]).atan2(y - position[1]);
    Ok((-true_north + PI).rem_euclid(TAU) - PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_certain_elevation_is_found_to_a_sixteenth_of_the_last_step() {
        for bound in [0.0, 0.3, 1.0, 5.5, 40.0] {
            let up = first_certain(0.0, 0.25, 90.0, |at| at >= bound);
            assert!(up >= bound && up - bound <= bound.max(0.25) / 16.0, "{bound} {up}");
            let down = first_certain(0.0, 0.25, -90.0, |at| at <= -bound);
            assert_eq!(down, -up);
        }
        assert_eq!(first_certain(3.0, 0.25, 10.0, |_| false), 10.0);
        assert_eq!(first_certain(10.0, 0.25, 10.0, |_| false), 10.0);
    }

    #[test]
    fn steps_part_the_circle() {
        assert_eq!(azimuth_count(1f64.to_radians()).unwrap(), 360);
        assert_eq!(azimuth_count(7.5f64.to_radians()).unwrap(), 48);
        for step in [0.0, -1.0, f64::NAN, 7.0f64.to_radians(), 400f64.to_radians(), 1e-9] {
            assert!(azimuth_count(step).is_err(), "{step}");
        }
    }

    #[test]
    fn convergence_of_utm_is_that_of_the_formula() {
        // UTM 32 (central meridian 9° E) at 48° N 10° E: atan(tan 1° sin 48°), a sphere being near enough for 0.005°
        let crs = Crs::from_epsg(25_832).unwrap();
        let place = crs.geographic_projection().unwrap().project(48f64.to_radians(), 10f64.to_radians()).unwrap();
        let expected = (1f64.to_radians().tan() * 48f64.to_radians().sin()).atan();
        let found = convergence(&crs, place).unwrap();
        assert!((found - expected).to_degrees().abs() < 0.005, "{} {}", found.to_degrees(), expected.to_degrees());
        // and none on the central meridian
        let middle = crs.geographic_projection().unwrap().project(48f64.to_radians(), 9f64.to_radians()).unwrap();
        assert!(convergence(&crs, middle).unwrap().abs() < 1e-6);
        assert!(convergence(&Crs::default(), place).is_err());
    }
}
