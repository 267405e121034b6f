//! Longwave radiation of the sky.

use super::body::black_body;
use super::humidity::ZERO_CELSIUS;

/// Excess of Prata's formula over measurements in cities, W/m².
///
/// # Source
/// Jonsson, Eliasson, Holmer & Grimmond 2006, Longwave incoming radiation in the Tropics: results from field work in
/// three African cities. Measurements at squares in Gothenburg agree: docs/methods/heat.md.
const EXCESS_OF_PRATA: f64 = 25.0;

/// Returns the longwave radiation of a sky without clouds on a level plane, W/m², from the air near the ground: its
/// temperature, °C, and vapour pressure, hPa.
///
/// # Source
/// Prata 1996, A new long-wave formula for estimating downward clear-sky radiation at the surface, equation 9.
#[must_use]
pub fn clear_sky_longwave(temperature: f64, vapour_pressure: f64) -> f64 {
    let water = 46.5 * vapour_pressure / (temperature + ZERO_CELSIUS);
    let emissivity = 1.0 - (1.0 + water) * (-(1.2 + 3.0 * water).sqrt()).exp();
    emissivity * black_body(temperature) - EXCESS_OF_PRATA
}

/// Returns the longwave radiation of the sky on a level plane, W/m². `clouds`, 0 to 1, is the covered share.
///
/// # Source
/// Crawford & Duchon 1999, An improved parameterization for estimating effective atmospheric emissivity for use in
/// calculating daytime downwelling longwave radiation, equations 9 and 11.
#[must_use]
pub fn sky_longwave(temperature: f64, vapour_pressure: f64, clouds: f64) -> f64 {
    clear_sky_longwave(temperature, vapour_pressure) * (1.0 - clouds) + black_body(temperature) * clouds
}
