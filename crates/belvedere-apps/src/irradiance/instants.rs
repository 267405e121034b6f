//! The instants of a period: rows of weather, or a clear sky in steps, each with its sun.

use super::atmosphere::extraterrestrial;
use super::clear_sky::ClearSky;
use super::erbs::complete;
use super::period::Instant;
use crate::sun::{Site, SunPosition, Zone, sun_position};
use belvedere_data::cast::to_index;
use belvedere_data::weather::{Irradiance, Weather, WeatherStep};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Parts that rows of weather are cut into by default: of an hour 15 minutes, in which the sun moves 4 degrees.
pub const PARTS: usize = 4;
/// Seconds of an hour.
pub(super) const HOUR_S: f64 = 3600.0;
/// Rows of weather of this length are whole hours, which rounding may shorten, hours.
const WHOLE_HOUR: f64 = 0.999;
/// Maximum number of parts of a row: of an hour half a minute each.
const MAX_PARTS: usize = 120;
/// Instants of a clear sky beyond which something is mistyped: 20 years of minutes.
const MAX_INSTANTS: f64 = 1.1e7;

/// Returns the middle of the whole hour of a clock around an instant; the clock is so many hours ahead of UTC.
pub(super) fn hour_around(instant: f64, utc_offset: f64) -> f64 {
    let ahead = utc_offset * HOUR_S;
    (((instant + ahead) / HOUR_S).floor() + 0.5) * HOUR_S - ahead
}

/// Returns the row that a step of weather is a part of.
pub(super) fn row_of_step(weather: &Weather, step: &WeatherStep) -> f64 {
    if step.hours >= WHOLE_HOUR { step.instant } else { hour_around(step.instant, weather.utc_offset) }
}

/// The rows of `weather` under the sun of `site`, each cut into `parts` of equal length, 1 to 120.
///
/// Every part has the radiation of its row. In a row in which the sun rises or sets, the parts with the sun below the
/// horizon give their direct radiation to the others, so that the measured sum is kept. Values missing in the file come
/// from [`complete`] for the sun of the row's instant. With one part the sums are those of pvlib with the sun of each
/// row's instant.
///
/// # Errors
/// [`Error::InvalidParameter`] for a number of parts outside its range, and those of [`Weather::validate`] and
/// [`sun_position`].
pub fn weather_instants(weather: &Weather, site: &Site, parts: usize) -> Result<Vec<Instant>> {
    weather.validate()?;
    if !(1..=MAX_PARTS).contains(&parts) {
        return Err(Error::invalid(Parameter::WeatherParts, parts, "1 to 120"));
    }
    let of_steps: Vec<Vec<Instant>> = weather
        .steps
        .par_iter()
        .with_min_len(64)
        .map(|step| of_step(weather, step, site, parts))
        .collect::<Result<_>>()?;
    Ok(of_steps.into_iter().flatten().collect())
}

fn of_step(weather: &Weather, step: &WeatherStep, site: &Site, parts: usize) -> Result<Vec<Instant>> {
    let is_dark = |v: Option<f64>| v.unwrap_or(0.0) <= 0.0;
    if is_dark(step.ghi) && is_dark(step.dni) && is_dark(step.dhi) {
        return Ok(Vec::new());
    }
    let outside = extraterrestrial(step.instant);
    let zenith = zenith(&sun_position(site, step.instant)?);
    // on a level plane both parts together are global radiation
    let sum = || step.dni.unwrap_or(0.0) * zenith.cos().max(0.0) + step.dhi.unwrap_or(0.0);
    let whole = complete(step.ghi.unwrap_or_else(sum), step.dni, step.dhi, zenith, outside);
    let length = step.hours / parts as f64;
    let mut instants = Vec::with_capacity(parts);
    for part in 0..parts {
        let since_start = (part as f64 + 0.5) * length;
        let at = step.instant + (since_start - 0.5 * step.hours) * 3600.0;
        let row = row_of_step(weather, step);
        instants.push(Instant { row, ..instant(site, at, length, step.month, |_| whole)? });
    }
    let up_count = instants.iter().filter(|instant| instant.sun[2] > 0.0).count();
    if up_count > 0 {
        for instant in &mut instants {
            let is_up = instant.sun[2] > 0.0;
            instant.irradiance.dni *= if is_up { parts as f64 / up_count as f64 } else { 0.0 };
        }
    }
    Ok(instants)
}

/// A clear sky over `site` from `from` to `to`, seconds since 1970-01-01 UTC, in steps of `step` seconds, each under
/// the sun of its middle; months are those of `zone`. Steps at night are left out.
///
/// # Errors
/// [`Error::InvalidParameter`] for a period that is empty or longer than 11 million steps, and those of
/// [`ClearSky::validate`] and [`sun_position`].
pub fn clear_instants(
    clear_sky: &ClearSky,
    site: &Site,
    [from, to]: [f64; 2],
    step: f64,
    zone: &Zone,
) -> Result<Vec<Instant>> {
    clear_sky.validate()?;
    let count = ((to - from) / step).ceil();
    if !(step > 0.0 && (1.0..=MAX_INSTANTS).contains(&count)) {
        let expected = "1 to 11 million steps";
        return Err(Error::invalid(Parameter::Period, format!("{from} to {to} in steps of {step} s"), expected));
    }
    let count = to_index(count);
    let instants: Vec<Instant> = (0..count)
        .into_par_iter()
        .with_min_len(256)
        .map(|i| {
            let start = from + i as f64 * step;
            let length = step.min(to - start);
            let at = start + 0.5 * length;
            let sky = |zenith: f64| clear_sky.irradiance(zenith, site.height, extraterrestrial(at));
            let mut instant = instant(site, at, length / 3600.0, 1, sky)?;
            if instant.irradiance.ghi > 0.0 {
                instant.month = u8::try_from(zone.date_at(at)?.month()).unwrap_or(1);
            }
            Ok(instant)
        })
        .collect::<Result<_>>()?;
    Ok(instants.into_iter().filter(|instant| instant.irradiance.ghi > 0.0).collect())
}

fn instant(site: &Site, at: f64, hours: f64, month: u8, irradiance: impl Fn(f64) -> Irradiance) -> Result<Instant> {
    let position = sun_position(site, at)?;
    let zenith = zenith(&position);
    Ok(Instant {
        sun: position.to_sun(site),
        zenith,
        hours,
        month,
        row: hour_around(at, 0.0),
        irradiance: irradiance(zenith),
        extraterrestrial: extraterrestrial(at),
    })
}

fn zenith(position: &SunPosition) -> f64 {
    FRAC_PI_2 - position.elevation
}
