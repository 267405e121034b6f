//! Location of a scene on earth.

use crate::horizon::{convergence, far_outside};
use belvedere_core::query::earth::EARTH_RADIUS;
use belvedere_data::crs::Crs;
use belvedere_data::frame::{Bounds, Frame};
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Heights above the sea that a site may have, metres.
const LOWEST: f64 = -500.0;
const HIGHEST: f64 = 10_000.0;

/// A place on earth, and how the grid of a scene lies there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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

/// Source of a site.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SiteFrom {
    /// Latitude and longitude that were given.
    #[serde(rename = "location given")]
    Location,
    /// The reference system of the scene.
    #[serde(rename = "reference system")]
    ReferenceSystem,
    /// A place of which something else is known, such as the weather.
    #[serde(rename = "weather file")]
    Elsewhere,
}

impl Site {
    /// The site of a scene: the middle of its `bounds`.
    ///
    /// Returns the site of a scene. Its location is `location`, latitude and longitude in radians, if given. Otherwise
    /// it follows from the reference system of `frame`, or else from `elsewhere`, such as the place of a weather
    /// station. The height is that of the middle of the scene. The axes of its grid are those of its reference system
    /// in each case, and along the meridian if that is not known.
    ///
    /// A `location` far from that of the reference system is not refused here, but by
    /// [`SunPlace::site_of`](crate::ask::SunPlace::site_of).
    ///
    /// # Errors
    /// Those of [`Site::of`] where nothing says where the scene lies, and of [`Site::validate`].
    pub fn of_scene(
        frame: &Frame,
        bounds: &Bounds,
        location: Option<[f64; 2]>,
        elsewhere: Option<[f64; 2]>,
    ) -> Result<(Self, SiteFrom)> {
        let (low, high) = bounds.corners();
        let middle: [f64; 3] = std::array::from_fn(|i| frame.origin[i] + f64::midpoint(low[i], high[i]));
        let on_map = [middle[0], middle[1]];
        let by_crs = Self::of(&frame.crs, on_map, middle[2]);
        let (place, from) = match (location, elsewhere) {
            (Some(place), _) => (place, SiteFrom::Location),
            (None, Some(place)) if by_crs.is_err() => (place, SiteFrom::Elsewhere),
            _ => return Ok((by_crs?, SiteFrom::ReferenceSystem)),
        };
        let [latitude, longitude] = place;
        let convergence = convergence(&frame.crs, on_map).unwrap_or(0.0);
        let site = Self { latitude, longitude, height: middle[2].clamp(LOWEST, HIGHEST), convergence };
        Ok((site.validate()?, from))
    }

    /// Distance to a place at `latitude` and `longitude`, radians, metres; meant for places within a few degrees.
    #[must_use]
    pub fn distance_to(&self, [latitude, longitude]: [f64; 2]) -> f64 {
        let north = latitude - self.latitude;
        let east = (longitude - self.longitude).sin().abs() * self.latitude.cos();
        EARTH_RADIUS * north.hypot(east)
    }

    /// Returns the site at `position`, (x, y) metres in the system `crs`, with the convergence there. `height`, metres,
    /// is clamped to the valid range: heights of a cloud may be wild, and matter little.
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
        if let Some(value) = far_outside(crs, position) {
            return Err(Error::invalid(Parameter::ReferenceSystem, value, "one whose area of use holds the scene"));
        }
        let [latitude, longitude] = projection.unproject(position)?;
        let height = height.clamp(LOWEST, HIGHEST);
        Self { latitude, longitude, height, convergence: convergence(crs, position)? }.validate()
    }

    /// The same site with its longitude within ±π.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for values out of range or not finite; longitudes of up to one more turn are
    /// wrapped.
    pub fn validate(self) -> Result<Self> {
        if !(self.latitude.abs() <= FRAC_PI_2) {
            return Err(Error::invalid(Parameter::Latitude, self.latitude.to_degrees(), "-90 to 90 degrees"));
        }
        if !(self.longitude.abs() <= TAU) {
            return Err(Error::invalid(Parameter::Longitude, self.longitude.to_degrees(), "-180 to 180 degrees"));
        }
        if !(LOWEST..=HIGHEST).contains(&self.height) {
            return Err(Error::invalid(Parameter::SiteHeight, self.height, "-500 to 10000 m above the sea"));
        }
        if !(self.convergence.abs() <= TAU) {
            return Err(Error::invalid(Parameter::North, self.convergence.to_degrees(), "-180 to 180 degrees"));
        }
        let turns = if self.longitude.abs() > PI { TAU.copysign(self.longitude) } else { 0.0 };
        Ok(Self { longitude: self.longitude - turns, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_location_that_is_given_moves_the_site_and_leaves_height_and_grid_alone() {
        let frame = |text: &str, origin| Frame { origin, crs: Crs::parse(text).unwrap() };
        let bounds = Bounds { low: [-50.0, -50.0, 10.0], high: [50.0, 50.0, 30.0] };
        let delft = frame("EPSG:28992", [85_000.0, 447_500.0, 0.0]);
        let (by_crs, from) = Site::of_scene(&delft, &bounds, None, Some([0.1, 0.1])).unwrap();
        // the middle of Delft
        assert!(
            (by_crs.latitude.to_degrees() - 52.01).abs() < 0.01 && (by_crs.longitude.to_degrees() - 4.37).abs() < 0.02
        );
        assert_eq!((from, by_crs.height), (SiteFrom::ReferenceSystem, 20.0));
        let (given, from) = Site::of_scene(&delft, &bounds, Some([0.5, 0.25]), None).unwrap();
        assert_eq!(from, SiteFrom::Location);
        assert_eq!(given, Site { latitude: 0.5, longitude: 0.25, ..by_crs });
        // nothing is known of the grid: the height is that of the scene all the same
        let lost = Frame { origin: [0.0, 0.0, 100.0], crs: Crs::default() };
        let expected = Site { latitude: 0.5, longitude: 0.25, height: 120.0, convergence: 0.0 };
        assert_eq!(Site::of_scene(&lost, &bounds, Some([0.5, 0.25]), None).unwrap(), (expected, SiteFrom::Location));
        assert_eq!(Site::of_scene(&lost, &bounds, None, Some([0.5, 0.25])).unwrap(), (expected, SiteFrom::Elsewhere));
        assert!(matches!(Site::of_scene(&lost, &bounds, None, None), Err(Error::MissingAttribute { .. })));
        assert!(Site::of_scene(&delft, &bounds, Some([2.0, 0.0]), None).is_err());
    }

    #[test]
    fn a_degree_of_latitude_is_111_kilometres() {
        let site = Site { latitude: 60f64.to_radians(), longitude: 0.0, height: 0.0, convergence: 0.0 };
        let to = |latitude: f64, longitude: f64| site.distance_to([latitude.to_radians(), longitude.to_radians()]);
        assert!((to(61.0, 0.0) - 111_200.0).abs() < 300.0, "{}", to(61.0, 0.0));
        // half of that along the parallel of 60 degrees
        assert!((to(60.0, 1.0) - 55_600.0).abs() < 200.0, "{}", to(60.0, 1.0));
    }
}
