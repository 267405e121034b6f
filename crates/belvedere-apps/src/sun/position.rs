//! Position of the sun by the algorithm of NREL, from the crate `solar-positioning`.

use super::Site;
use belvedere_data::cast::{to_index, to_u32};
use belvedere_data::view::to_sun;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use solar_positioning::time::JulianDate;
use solar_positioning::{Horizon, Location, RefractionCorrection, SolarEvents, SolarPositions, delta_t};
use std::f64::consts::TAU;

/// 1970-01-01T00:00:00Z in days of the Julian count.
const UNIX_EPOCH: f64 = 2_440_587.5;
const DAY: f64 = 86_400.0;
/// Days of a year of the Gregorian calendar.
const YEAR: f64 = 365.2425;
/// Accepted years: the difference between the clocks of earth and sky is known for them within minutes.
const YEARS: std::ops::RangeInclusive<f64> = 1000.0..=3000.0;
/// Pressure of the standard atmosphere at the sea, hPa.
const STANDARD_PRESSURE: f64 = 1013.25;
/// Temperature that published tables of the sun assume, °C.
const STANDARD_TEMPERATURE: f64 = 10.0;

/// Refraction of the sun by the air.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Refraction {
    /// 10 °C and the pressure of the standard atmosphere at the height of the site, 1013.25 hPa at the sea.
    #[default]
    Standard,
    /// Air as measured.
    Air {
        /// Pressure at the site, hPa, above 0 to 2000.
        pressure: f64,
        /// Temperature, °C, −90 to 60.
        temperature: f64,
    },
    /// No refraction: the apparent elevation is the geometric one.
    Without,
}

/// Steps of one in which components of a direction are rounded: 2 to the 32.
const DIRECTION_STEPS: f64 = 4_294_967_296.0;

/// Position of the sun: the centre of its disc, as seen from the site (topocentric).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Azimuth, clockwise from true north, radians, 0 to 2π.
    pub azimuth: f64,
    /// Elevation above the horizon as it appears, refraction included, radians. Below −0.83° nothing is refracted.
    pub elevation: f64,
    /// Elevation without refraction, radians.
    pub geometric_elevation: f64,
}

impl SunPosition {
    /// Returns the unit vector to the apparent sun in the axes of the grid of `site`: x east, y grid north, z up. It is
    /// rounded to a 4 294 967 296th, a hundredth of a millionth of a degree. Sines and cosines of other platforms,
    /// which differ in their last digit, then give the same shadows.
    #[must_use]
    pub fn to_sun(&self, site: &Site) -> [f64; 3] {
        to_sun(self.azimuth - site.convergence, self.elevation).map(|v| (v * DIRECTION_STEPS).round() / DIRECTION_STEPS)
    }
}

/// Returns the position of the sun at an instant, refracted by standard air.
///
/// # Errors
/// [`Error::InvalidParameter`] for a site out of range, and for instants before the year 1000 or after 3000.
///
/// # Source
/// Reda & Andreas 2004, Solar position algorithm for solar radiation applications: ±0.0003° for the years −2000 to
/// 6000.
pub fn sun_position(site: &Site, unix_s: f64) -> Result<SunPosition> {
    sun_position_with(site, unix_s, Refraction::Standard)
}

/// Position of the sun at an instant, with the given refraction.
///
/// # Errors
/// As [`sun_position`], and for air that is not of this earth.
pub fn sun_position_with(site: &Site, unix_s: f64, refraction: Refraction) -> Result<SunPosition> {
    let site = site.validate()?;
    let correction = correction(&site, refraction)?;
    let location = Location { latitude: site.latitude.to_degrees(), longitude: site.longitude.to_degrees() };
    let prepared = SolarPositions::new().for_time_from_julian(julian(unix_s)?).map_err(|e| invalid_time(unix_s, &e))?;
    let at = |correction| prepared.at(location, site.height, correction).map_err(|e| invalid_time(unix_s, &e));
    let geometric = at(None)?;
    let apparent = match correction {
        None => geometric,
        some => at(some)?,
    };
    Ok(SunPosition {
        azimuth: geometric.azimuth().to_radians(),
        elevation: apparent.elevation_angle().to_radians(),
        geometric_elevation: geometric.elevation_angle().to_radians(),
    })
}

/// Interval between the instants of a [`SunTrack`], seconds.
const TRACK_STEP: f64 = 1800.0;
/// Mean angular velocity of the hour angle, radians per second.
const HOUR_ANGLE_RATE: f64 = TAU / DAY;
/// Geometric elevation down to which the sun is refracted, degrees: its radius and the refraction at the horizon.
const LOWEST_REFRACTED: f64 = -(0.266_67 + 0.566_7);

/// Positions of the sun during a span of time, within 0.000 01° of [`sun_position_with`] and a hundred times as fast.
///
/// The algorithm runs at whole half hours of UTC. Between them declination and the difference from the mean hour angle
/// are interpolated linearly. An instant has the same position in every span.
pub(super) struct SunTrack {
    latitude_sin_cos: (f64, f64),
    correction: Option<RefractionCorrection>,
    /// Half hours since 1970 at which the track begins.
    first: f64,
    /// At the beginning and the end of each half hour: unit vectors to the meridian, west and pole, the second turned
    /// back by half an hour.
    ends: Vec<[[f64; 3]; 2]>,
}

impl SunTrack {
    /// The track from the instant `from` to the instant `to` at a site, seconds of UTC since 1970.
    ///
    /// # Errors
    /// As [`sun_position_with`].
    pub(super) fn new(site: &Site, [from, to]: [f64; 2], refraction: Refraction) -> Result<Self> {
        let site = site.validate()?;
        let latitude_sin_cos = site.latitude.sin_cos();
        let first = (from / TRACK_STEP).floor();
        let count = to_u32(((to / TRACK_STEP).ceil() - first).max(1.0));
        let at = |number| {
            let sun = sun_position_with(&site, (first + f64::from(number)) * TRACK_STEP, Refraction::Without)?;
            Ok(equatorial(to_sun(sun.azimuth, sun.elevation), latitude_sin_cos))
        };
        let vectors = (0..=count).map(at).collect::<Result<Vec<[f64; 3]>>>()?;
        let ends = vectors.windows(2).map(|pair| [pair[0], turned(pair[1], -HOUR_ANGLE_RATE * TRACK_STEP)]).collect();
        Ok(Self { latitude_sin_cos, correction: correction(&site, refraction)?, first, ends })
    }

    /// Position at an instant of the span.
    pub(super) fn at(&self, unix_s: f64) -> SunPosition {
        let half_hours = unix_s / TRACK_STEP - self.first;
        let number = to_index(half_hours).min(self.ends.len() - 1);
        let after = half_hours - number as f64;
        let [from, to] = self.ends[number];
        let mean = [0, 1, 2].map(|axis| from[axis] + after * (to[axis] - from[axis]));
        let now = turned(mean, HOUR_ANGLE_RATE * TRACK_STEP * after);
        let [east, north, up] = local(now, self.latitude_sin_cos);
        let geometric_elevation = up.atan2(east.hypot(north));
        let elevation = self.correction.map_or(geometric_elevation, |air| refracted(geometric_elevation, air));
        SunPosition { azimuth: east.atan2(north).rem_euclid(TAU), elevation, geometric_elevation }
    }
}

/// Components to meridian (on the equator), west and pole of a vector east, north, up.
fn equatorial([east, north, up]: [f64; 3], (sin, cos): (f64, f64)) -> [f64; 3] {
    [cos * up - sin * north, -east, sin * up + cos * north]
}

/// Components east, north, up: the inverse of [`equatorial`].
fn local([meridian, west, pole]: [f64; 3], (sin, cos): (f64, f64)) -> [f64; 3] {
    [-west, cos * pole - sin * meridian, sin * pole + cos * meridian]
}

/// The vector turned about the pole, as the hour angle grows.
fn turned([meridian, west, pole]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [cos * meridian - sin * west, sin * meridian + cos * west, pole]
}

/// Apparent elevation (Reda & Andreas 2004, equation 42), radians.
fn refracted(elevation: f64, air: RefractionCorrection) -> f64 {
    let degrees = elevation.to_degrees();
    if degrees <= LOWEST_REFRACTED {
        return elevation;
    }
    let density = air.pressure() / 1010.0 * 283.0 / (273.0 + air.temperature());
    let phase = (degrees + 10.3 / (degrees + 5.11)).to_radians();
    elevation + (density * 1.02 / (60.0 * phase.tan())).to_radians()
}

/// Declination of the sun at an instant as seen from the middle of the earth, radians.
///
/// # Errors
/// As [`sun_position`].
pub fn declination(unix_s: f64) -> Result<f64> {
    let prepared = SolarPositions::new().for_time_from_julian(julian(unix_s)?).map_err(|e| invalid_time(unix_s, &e))?;
    Ok(prepared.declination().to_radians())
}

/// Distance from the earth to the sun at an instant, astronomical units: 0.983 in January, 1.017 in July.
///
/// # Errors
/// As [`sun_position`].
pub fn sun_distance(unix_s: f64) -> Result<f64> {
    let prepared = SolarPositions::new().for_time_from_julian(julian(unix_s)?).map_err(|e| invalid_time(unix_s, &e))?;
    Ok(prepared.earth_radius_vector().unwrap_or(1.0))
}

/// Times of sunrise, culmination and sunset, seconds of UTC since 1970, each in ascending order; empty if there is
/// none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SunTimes {
    /// Its upper edge appears: the middle of the disc is 50′ below the horizon, 34′ of refraction and 16′ of radius, as
    /// almanacs have it.
    pub rises: Vec<f64>,
    /// It crosses the meridian.
    pub transits: Vec<f64>,
    /// Its upper edge disappears.
    pub sets: Vec<f64>,
}

/// Returns the times of sunrise, culmination and sunset from the instant `from` up to `to`, seen from sea level.
///
/// # Errors
/// As [`sun_position`], and [`Error::InvalidParameter`] for spans of time that end before they begin or last more than
/// 400 days.
pub fn sun_times(site: &Site, from: f64, to: f64) -> Result<SunTimes> {
    let site = site.validate()?;
    if !(to >= from && to - from <= 400.0 * DAY) {
        return Err(Error::invalid(Parameter::Period, format!("{from} to {to} s"), "forward, at most 400 days"));
    }
    let [start, end] = [julian(from)?, julian(to)?];
    let location = Location { latitude: site.latitude.to_degrees(), longitude: site.longitude.to_degrees() };
    let events = SolarEvents::new()
        .for_interval_from_julian(
            start.julian_date(),
            end.julian_date(),
            location,
            start.delta_t(),
            Horizon::SunriseSunset,
        )
        .map_err(|e| invalid_time(from, &e))?;
    let instants = |days: Vec<f64>| days.into_iter().map(|day| (day - UNIX_EPOCH) * DAY).collect();
    Ok(SunTimes { rises: instants(events.rises), transits: instants(events.transits), sets: instants(events.sets) })
}

/// Returns the time at which the sun crosses the meridian of a site next to its mean noon at `mean_noon`: within 17
/// minutes, the equation of time.
pub(super) fn transit(site: &Site, mean_noon: f64) -> Result<f64> {
    let julian = julian(mean_noon)?;
    let [start, end] = [-1.0, 1.0].map(|hours| julian.julian_date() + hours / 24.0);
    let found = SolarEvents::new()
        .next_transit_from_julian(start, end, site.longitude.to_degrees(), julian.delta_t())
        .map_err(|e| invalid_time(mean_noon, &e))?;
    // the crate finds one within the hour around; mean noon is what is left should it not
    Ok(found.map_or(mean_noon, |day| (day - UNIX_EPOCH) * DAY))
}

fn correction(site: &Site, refraction: Refraction) -> Result<Option<RefractionCorrection>> {
    let [pressure, temperature] = match refraction {
        Refraction::Without => return Ok(None),
        // the barometric formula of the International Standard Atmosphere
        Refraction::Standard => {
            [STANDARD_PRESSURE * (1.0 - 2.25577e-5 * site.height).powf(5.25588), STANDARD_TEMPERATURE]
        }
        Refraction::Air { pressure, temperature } => [pressure, temperature],
    };
    if !(-90.0..=60.0).contains(&temperature) {
        return Err(Error::invalid(
            Parameter::Air,
            format!("of {temperature} degrees"),
            "of -90 to 60 degrees Celsius",
        ));
    }
    RefractionCorrection::new(pressure, temperature).map(Some).map_err(|_| {
        Error::invalid(Parameter::Air, format!("of {pressure} hPa"), "of a pressure above 0, up to 2000 hPa")
    })
}

fn julian(unix_s: f64) -> Result<JulianDate> {
    let year = 1970.0 + unix_s / (DAY * YEAR);
    if !YEARS.contains(&year) {
        return Err(Error::invalid(
            Parameter::Instant,
            format!("{unix_s} s from 1970, in the year {:.0}", year.floor()),
            "in the years 1000 to 3000",
        ));
    }
    delta_t::estimate(year)
        .and_then(|delta_t| JulianDate::new(UNIX_EPOCH + unix_s / DAY, delta_t))
        .map_err(|e| invalid_time(unix_s, &e))
}

fn invalid_time(unix_s: f64, why: &solar_positioning::Error) -> Error {
    Error::invalid(Parameter::Instant, format!("{unix_s} s from 1970 ({why})"), "in the years 1000 to 3000")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_track_has_the_positions_of_the_algorithm_at_all_latitudes() {
        let directions =
            |sun: SunPosition| [to_sun(sun.azimuth, sun.elevation), to_sun(sun.azimuth, sun.geometric_elevation)];
        let mut greatest: f64 = 0.0;
        for latitude in [-90.0, -66.5, -33.9, 0.0, 23.4, 52.0, 78.2, 89.99_f64] {
            let longitude = 3.7 * latitude.abs() - 180.0;
            let site = Site {
                latitude: latitude.to_radians(),
                longitude: f64::to_radians(longitude),
                height: 0.0,
                convergence: 0.0,
            };
            for day in [0.0, 79.4, 172.0, 265.6, 355.9] {
                let from = 1_767_225_600.0 + day * DAY + 1234.5;
                let track = SunTrack::new(&site, [from, from + DAY], Refraction::Standard).unwrap();
                for step in 0..=600 {
                    let instant = from + DAY * f64::from(step) / 600.0;
                    let [found, exact] = [track.at(instant), sun_position(&site, instant).unwrap()].map(directions);
                    for (found, exact) in found.into_iter().zip(exact) {
                        let apart = [0, 1, 2].map(|axis| found[axis] - exact[axis]);
                        greatest = greatest.max(apart.iter().map(|d| d * d).sum::<f64>().sqrt().to_degrees());
                    }
                }
            }
        }
        // the sun's own uncertainty is 0.0003 degrees; refraction ends with a step at LOWEST_REFRACTED
        assert!(greatest < 1e-5, "{greatest} degrees");
    }
}
