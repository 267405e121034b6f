//! Limits of a scanner.

use belvedere_data::{Error, Parameter, Result};
use std::f64::consts::FRAC_PI_2;

/// Height of a scanner on a tripod above the ground, metres.
pub const STATION_HEIGHT: f64 = 1.8;

/// Limits of a scanner.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ScannerParams {
    /// Maximum range at which a surface returns pulses, metres, above 0. Default 100: medium-range scanners on tripods
    /// reach 100 to 130 m on most surfaces.
    pub max_range: f64,
    /// Angle between neighbouring pulses, radians, above 0. Default 0.1°: a coarse scan, of a minute or two.
    pub angular_step: f64,
}

belvedere_data::setters!(ScannerParams {
    with_max_range(max_range: f64),
    with_angular_step(angular_step: f64),
});

impl Default for ScannerParams {
    fn default() -> Self {
        Self { max_range: 100.0, angular_step: 0.1_f64.to_radians() }
    }
}

impl ScannerParams {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for one outside its range.
    pub fn validate(&self) -> Result<()> {
        if !(self.max_range.is_finite() && self.max_range > 0.0) {
            return Err(Error::invalid(Parameter::MaxDistance, self.max_range, "finite and above zero metres"));
        }
        if !(self.angular_step > 0.0 && self.angular_step <= FRAC_PI_2) {
            return Err(Error::invalid(
                Parameter::AngleStep,
                self.angular_step.to_degrees(),
                "above 0, and at most 90",
            ));
        }
        Ok(())
    }
}
