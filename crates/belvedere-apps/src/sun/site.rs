//! Where on earth a scene lies.

use crate::horizon::convergence;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Heights above the sea that a site may have, metres.
const LOWEST: f64 = -500.0;
const HIGHEST: f64 = 10_000.0;

/// A place on earth, and how the grid of a scene lies there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Geographic latitude, radians, −π/2 to π/2, north positive.
    pub latitude: f64,
    /// Longitude, radians, −π to π, east positive; both ends are the same meridian.
    pub longitude: f64,
    /// Height above the sea, metres, −500 to 10 000: it thins the air that refracts, and little else.
    pub height: f64,
    /// Azimuth of grid north, clockwise from true north, radians; 0 where it is unknown.
    pub convergence: f64,
}

impl Site {
    /// The site at `position`, (x, y) metres in the system `crs`, with the convergence there, at a height in metres, of which no more than
    /// the range is taken: heights of a cloud may be wild, and matter little.
    ///
    /// # Errors
    /// [`Error::MissingAttribute`] for a cloud that does not say where on earth it lies, and those of
    /// [`Crs::geographic_projection`] and [`Site::validate`].
    pub fn of(crs: &Crs, position: [f64; 2], height: f64) -> Result<Self> {
        let projection = match crs.geographic_projection() {
            Err(Error::MissingAttribute { .. }) => {
                return Err(Error::MissingAttribute {
                    attribute: "reference system",
                    needed_for: "the position of the sun",
                    advice: "name its EPSG code, or give latitude and longitude",
                });
            }
            other => other?,
        };
        let [latitude, longitude] = projection.unproject(position)?;
        let height = height.clamp(LOWEST, HIGHEST);
        Self { latitude, longitude, height, convergence: convergence(crs, position)? }.validate()
    }

    /// The same site with its longitude within ±π.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for what is out of range or not finite; longitudes of up to one more turn are taken back.
    pub fn validate(self) -> Result<Self> {
        let invalid =
            |name, value: f64, expected| Err(Error::InvalidParameter { name, value: value.to_string(), expected });
        if !(self.latitude.abs() <= FRAC_PI_2) {
            return invalid("latitude", self.latitude.to_degrees(), "-90 to 90 degrees");
        }
        if !(self.longitude.abs() <= TAU) {
            return invalid("longitude", self.longitude.to_degrees(), "-180 to 180 degrees");
        }
        if !(LOWEST..=HIGHEST).contains(&self.height) {
            return invalid("height of the site", self.height, "-500 to 10000 m above the sea");
        }
        if !(self.convergence.abs() <= TAU) {
            return invalid("convergence", self.convergence.to_degrees(), "-180 to 180 degrees");
        }
        let turns = if self.longitude.abs() > PI { TAU.copysign(self.longitude) } else { 0.0 };
        Ok(Self { longitude: self.longitude - turns, ..self })
    }
}
