//! Water vapour of the air.

/// Coefficients of the powers -2 to 4 of the temperature, K, and of its logarithm.
const HARDY: [f64; 7] =
    [-2836.5744, -6028.076559, 19.54263612, -0.02737830188, 1.6261698e-5, 7.0229056e-10, -1.8680009e-13];
const HARDY_LOGARITHM: f64 = 2.7150305;
/// 0 °C, K.
pub(super) const ZERO_CELSIUS: f64 = 273.15;

/// Returns the pressure of vapour over water at saturation, hPa, at a temperature, °C.
///
/// # Source
/// Hardy 1998, ITS-90 formulations for vapor pressure, frostpoint temperature, dewpoint temperature, and enhancement
/// factors in the range -100 to +100 °C, equation 2.
#[must_use]
pub fn saturation_pressure(temperature: f64) -> f64 {
    let kelvin = temperature + ZERO_CELSIUS;
    let polynomial = HARDY.iter().rev().fold(0.0, |value, coefficient| value * kelvin + coefficient);
    (polynomial / (kelvin * kelvin) + HARDY_LOGARITHM * kelvin.ln()).exp() / 100.0
}
