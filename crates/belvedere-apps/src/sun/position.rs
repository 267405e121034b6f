//! Position of the sun by the algorithm of NREL, from the crate `solar-positioning`.

use super::Site;
use belvedere_data::view::to_sun;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use solar_positioning::time::JulianDate;
use solar_positioning::{Horizon, Location, RefractionCorrection, SolarEvents, SolarPositions, delta_t};

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
        return Err(Error::InvalidParameter {
            parameter: Parameter::Period,
            value: format!("{from} to {to} s"),
            expected: "forward, at most 400 days",
        });
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
        let value = format!("of {temperature} degrees");
        return Err(Error::InvalidParameter {
            parameter: Parameter::Air,
            value,
            expected: "of -90 to 60 degrees Celsius",
        });
    }
    RefractionCorrection::new(pressure, temperature).map(Some).map_err(|_| Error::InvalidParameter {
        parameter: Parameter::Air,
        value: format!("of {pressure} hPa"),
        expected: "of a pressure above 0, up to 2000 hPa",
    })
}

fn julian(unix_s: f64) -> Result<JulianDate> {
    let year = 1970.0 + unix_s / (DAY * YEAR);
    if !YEARS.contains(&year) {
        return Err(Error::InvalidParameter {
            parameter: Parameter::Instant,
            value: format!("{unix_s} s from 1970, in the year {:.0}", year.floor()),
            expected: "in the years 1000 to 3000",
        });
    }
    delta_t::estimate(year)
        .and_then(|delta_t| JulianDate::new(UNIX_EPOCH + unix_s / DAY, delta_t))
        .map_err(|e| invalid_time(unix_s, &e))
}

fn invalid_time(unix_s: f64, why: &solar_positioning::Error) -> Error {
    Error::InvalidParameter {
        parameter: Parameter::Instant,
        value: format!("{unix_s} s from 1970 ({why})"),
        expected: "in the years 1000 to 3000",
    }
}
