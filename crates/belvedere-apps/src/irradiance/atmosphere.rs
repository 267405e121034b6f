//! Radiation before the atmosphere, and how much air it passes.

use belvedere_data::weather::day_of_year;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Radiation at the mean distance of the sun, W/m²: ASTM E490, which pvlib takes too.
pub const SOLAR_CONSTANT: f64 = 1366.1;
/// Pressure at sea level, Pa.
const SEA_LEVEL_PRESSURE: f64 = 101_325.0;

/// Returns the radiation on a plane that faces the sun above the atmosphere, W/m², at `unix_s` seconds since 1970-01-01
/// UTC. NaN for an instant outside the years 1 to 9999.
///
/// # Source
/// Spencer 1971, Fourier series representation of the position of the sun.
#[must_use]
pub fn extraterrestrial(unix_s: f64) -> f64 {
    let Some(day) = day_of_year(unix_s) else { return f64::NAN };
    let angle = TAU * (f64::from(day) - 1.0) / 365.0;
    let (sin, cos) = angle.sin_cos();
    let (sin_twice, cos_twice) = (2.0 * angle).sin_cos();
    SOLAR_CONSTANT * (1.000_11 + 0.034_221 * cos + 0.001_28 * sin + 0.000_719 * cos_twice + 0.000_077 * sin_twice)
}

/// Air that the radiation of a sun at `zenith`, radians (apparent), passes, relative to that of a sun at the zenith;
/// `None` for a sun below the horizon.
///
/// # Source
/// Kasten & Young 1989, Revised optical air mass tables and approximation formula.
#[must_use]
pub fn air_mass(zenith: f64) -> Option<f64> {
    let elevation_deg = (FRAC_PI_2 - zenith).to_degrees();
    // rounding of a right angle must not make a night of it
    (elevation_deg >= -1e-9).then(|| {
        let elevation_deg = elevation_deg.max(0.0);
        1.0 / (zenith.cos().max(0.0) + 0.505_72 * (6.079_95 + elevation_deg).powf(-1.6364))
    })
}

/// Pressure of the air at a height above the sea, metres, in Pa.
///
/// # Source
/// Standard atmosphere in the form of the Portland State Aerospace Society 2004, A quick derivation relating altitude
/// to air pressure.
#[must_use]
pub fn pressure(height: f64) -> f64 {
    100.0 * ((44_331.514 - height).max(0.0) / 11_880.516).powf(1.0 / 0.190_263_2)
}

/// [`air_mass`] scaled by the pressure at a height above the sea, metres.
#[must_use]
pub fn absolute_air_mass(zenith: f64, height: f64) -> Option<f64> {
    air_mass(zenith).map(|air_mass| air_mass * pressure(height) / SEA_LEVEL_PRESSURE)
}
