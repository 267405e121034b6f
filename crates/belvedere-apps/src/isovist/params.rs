//! Parameters of isovists.

use belvedere_data::{Error, Parameter, Result};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Parameters of isovists.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IsovistParams {
    /// Angle between rays of the panorama, and between the first rays of the plan, radians, a ten-thousandth to a
    /// quarter of a circle. Default 1°: 64 800 rays.
    pub step: f64,
    /// Range at which sight ends where nothing blocks, metres, above 0. Default 100: people do not
    /// perceive a longer street as one space.
    pub max_range: f64,
    /// Minimum jump in range that is an edge of the plan, metres, above 0. Default 0.25: balls bulge by centimetres.
    pub jump: f64,
}

belvedere_data::setters!(IsovistParams {
    with_step(step: f64),
    with_max_range(max_range: f64),
    with_jump(jump: f64),
});

impl Default for IsovistParams {
    fn default() -> Self {
        Self { step: 1f64.to_radians(), max_range: 100.0, jump: 0.25 }
    }
}

impl IsovistParams {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for one outside its range.
    pub fn validate(&self) -> Result<()> {
        if !(self.step >= 1e-4 * TAU && self.step <= FRAC_PI_2) {
            return Err(Error::invalid(Parameter::AngleStep, self.step.to_degrees(), "0.036 to 90"));
        }
        if !(self.max_range.is_finite() && self.max_range > 0.0) {
            return Err(Error::invalid(Parameter::MaxDistance, self.max_range, "finite and above zero metres"));
        }
        if !(self.jump.is_finite() && self.jump > 0.0) {
            return Err(Error::invalid(Parameter::MinJump, self.jump, "finite and above zero metres"));
        }
        Ok(())
    }
}
