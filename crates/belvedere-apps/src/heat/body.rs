//! Bodies and instruments that absorb radiation from all directions.

use super::humidity::ZERO_CELSIUS;
use belvedere_data::vector::dot;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Radiation of a black body, W/(m² K⁴).
pub const STEFAN_BOLTZMANN: f64 = 5.67e-8;
/// Share of shortwave radiation that a clothed body absorbs.
const ABSORBED_SHORTWAVE: f64 = 0.7;
/// Share of longwave radiation that a clothed body absorbs and emits.
const ABSORBED_LONGWAVE: f64 = 0.97;
/// Share of a standing body's surface that faces up, or down, and each of four sides.
const FACES_UP: f64 = 0.06;
const FACES_SIDE: f64 = 0.22;

/// Shape of the body that absorbs radiation.
///
/// # Source
/// Höppe 1992, Ein neues Verfahren zur Bestimmung der mittleren Strahlungstemperatur im Freien; VDI 3787 part 2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Body {
    /// A standing person as six faces: 0.06 of its surface up and down each, 0.22 to each of four sides, as it is
    /// measured from six directions. Default.
    #[default]
    Standing,
    /// A sitting person as six equal faces.
    Sitting,
    /// A body of rotation, alike from all sides: a sphere for diffuse radiation, with the projected area of a standing
    /// person towards the sun.
    Round,
}

/// Surface that takes up radiation: all of a body, or the sensor of an instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Receiver {
    /// A body.
    Body(Body),
    /// A level or tilted sensor of shortwave radiation, with its unit normal.
    Pyranometer([f64; 3]),
    /// The same of longwave radiation.
    Pyrgeometer([f64; 3]),
}

impl Receiver {
    /// Share of the shortwave and of the longwave radiation that it absorbs, 0 to 1.
    #[must_use]
    pub fn absorbed_shares(self) -> [f64; 2] {
        match self {
            Self::Body(_) => [ABSORBED_SHORTWAVE, ABSORBED_LONGWAVE],
            Self::Pyranometer(_) => [1.0, 0.0],
            Self::Pyrgeometer(_) => [0.0, 1.0],
        }
    }

    /// Returns the area that receives radiation from the unit vector `direction`, as a share of its surface.
    #[must_use]
    pub fn projected(self, direction: [f64; 3]) -> f64 {
        match self {
            Self::Pyranometer(normal) | Self::Pyrgeometer(normal) => dot(normal, direction).max(0.0),
            // a sphere has four times the surface of its circle
            Self::Body(Body::Round) => 0.25,
            Self::Body(body) => {
                let [up, side] = if body == Body::Sitting { [1.0 / 6.0; 2] } else { [FACES_UP, FACES_SIDE] };
                let [x, y, z] = direction.map(f64::abs);
                side * (x + y) + up * z
            }
        }
    }

    /// The same towards the sun.
    ///
    /// # Source
    /// Fanger 1970, for the standing body of rotation, in the form of Jendritzky et al. 1990.
    #[must_use]
    pub fn projected_to_sun(self, to_sun: [f64; 3]) -> f64 {
        match self {
            Self::Body(Body::Round) => {
                let elevation_deg = to_sun[2].clamp(0.0, 1.0).asin().to_degrees();
                0.308 * (elevation_deg * (0.998 - elevation_deg * elevation_deg / 50_000.0)).to_radians().cos()
            }
            _ => self.projected(to_sun),
        }
    }
}

impl Body {
    /// Returns the mean radiant temperature, °C, of a body that absorbs this much, W/m² of its surface.
    #[must_use]
    pub fn mean_radiant_temperature(absorbed: f64) -> f64 {
        (absorbed / (ABSORBED_LONGWAVE * STEFAN_BOLTZMANN)).powf(0.25) - ZERO_CELSIUS
    }
}

/// Exitance of a black body at a temperature, °C, W/m².
pub(super) fn black_body(temperature: f64) -> f64 {
    STEFAN_BOLTZMANN * (temperature + ZERO_CELSIUS).powi(4)
}

/// Radiance of a surface that radiates alike to all sides, W/(m² sr), from its exitance.
pub(super) fn radiance(exitance: f64) -> f64 {
    exitance / PI
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::body_directions;

    #[test]
    fn bodies_in_even_radiation_absorb_all_that_falls_on_their_surface() {
        let directions = body_directions().unwrap();
        for body in [Body::Standing, Body::Sitting, Body::Round] {
            let receiver = Receiver::Body(body);
            // radiance 1 from everywhere gives π on any plane
            let sum: f64 = directions.iter().map(|(d, angle)| receiver.projected(*d) * angle).sum();
            assert!((sum - PI).abs() < 0.01, "{body:?} {sum}");
        }
    }

    #[test]
    fn a_black_room_has_its_own_temperature() {
        let found = Body::mean_radiant_temperature(ABSORBED_LONGWAVE * black_body(21.5));
        assert!((found - 21.5).abs() < 1e-9);
    }

    #[test]
    fn the_projected_area_of_a_standing_person_is_that_of_vdi() {
        let towards = |elevation_deg: f64| {
            let (sin, cos) = elevation_deg.to_radians().sin_cos();
            Receiver::Body(Body::Round).projected_to_sun([cos, 0.0, sin])
        };
        // 0.308 at the horizon, 0.240 at 40 degrees by either published form
        assert!((towards(0.0) - 0.308).abs() < 1e-9 && (towards(40.0) - 0.240).abs() < 1e-3);
    }
}
