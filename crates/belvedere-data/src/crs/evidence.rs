//! Evidence against a reference system: other names of a system, and the location of the coordinates.

use super::{Crs, CrsKind, registry, unit_name, wkt};
use crate::{Error, Parameter, Result};
use std::path::Path;

/// Radius of the sphere for distances between places, metres.
const EARTH_RADIUS: f64 = 6_371_000.0;

/// Two systems whose places agree to this, metres, are one for all that is seen: ETRS89, NAD83 and WGS 84 differ by a
/// metre or two.
const SAME_PLACE: f64 = 5.0;

/// The same without the steps between datums, metres: these move places by a kilometre at most.
const SAME_ROUGH_PLACE: f64 = 5e3;

/// Minimum distance of a contradiction, metres: no survey, and no country's use of a neighbouring zone, extends so far.
pub const CONTRADICTION_DISTANCE: f64 = 300e3;

/// Comparison of two systems for the same coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Comparison {
    /// They say the same, or one of them says nothing of a place.
    Same,
    /// They say different things: which.
    Apart(String),
    /// One of them is not understood well enough to compare them.
    Unknown,
}

/// A place of a scene in words, latitude before longitude.
#[must_use]
pub fn place_in_words([latitude, longitude]: [f64; 2]) -> String {
    let side = |degrees: f64, [positive, negative]: [char; 2]| {
        format!("{:.2}° {}", degrees.abs(), if degrees < 0.0 { negative } else { positive })
    };
    format!("{} {}", side(latitude.to_degrees(), ['N', 'S']), side(longitude.to_degrees(), ['E', 'W']))
}

/// Distance between two places along the earth, metres; each is a latitude and longitude in radians.
#[must_use]
pub fn distance_on_earth(a: [f64; 2], b: [f64; 2]) -> f64 {
    let half = |x: f64| (x / 2.0).sin().powi(2);
    let chord = half(b[0] - a[0]) + a[0].cos() * b[0].cos() * half(b[1] - a[1]);
    2.0 * EARTH_RADIUS * chord.clamp(0.0, 1.0).sqrt().asin()
}

impl Crs {
    /// Latitude and longitude, radians, of coordinates in the unit of the file; `None` where the system says none.
    #[must_use]
    pub fn place_of(&self, coordinates: [f64; 2]) -> Option<[f64; 2]> {
        match self.kind {
            CrsKind::Projected => {
                let metres = coordinates.map(|v| v * self.metres_per_unit);
                self.geographic_projection().ok()?.unproject(metres).ok()
            }
            CrsKind::Geographic => Some([coordinates[1].to_radians(), coordinates[0].to_radians()]),
            CrsKind::Unknown | CrsKind::Geocentric | CrsKind::Local => None,
        }
    }

    /// Distance from coordinates in the unit of the file to the area of use of the system, metres: 0 inside. `None`
    /// where the area or the place is not known; infinite for coordinates that the system cannot have.
    #[must_use]
    pub fn distance_to_area_of_use(&self, coordinates: [f64; 2]) -> Option<f64> {
        if self.kind != CrsKind::Projected || !coordinates.iter().all(|v| v.is_finite()) {
            return None;
        }
        let of_code = self.horizontal_epsg().map(registry::area_of_use);
        // a system without a code is known by its parameters alone
        let by_parameters = || wkt::area_by_parameters(self.wkt.as_deref()?);
        let [west, south, east, north] = of_code.unwrap_or_else(by_parameters)?;
        // a projection that is not known says nothing, one that has no such coordinates says no
        let projection = self.geographic_projection().ok()?;
        let metres = coordinates.map(|v| v * self.metres_per_unit);
        let Ok(place) = projection.unproject(metres).or_else(|_| self.grid_projection()?.unproject(metres)) else {
            return Some(f64::INFINITY);
        };
        let [latitude, longitude] = place.map(f64::to_degrees);
        let width = if east > west { east - west } else { east - west + 360.0 };
        let beyond_west = (longitude - west).rem_euclid(360.0);
        let nearest = if beyond_west <= width {
            longitude
        } else if beyond_west - width < 360.0 - beyond_west {
            east
        } else {
            west
        };
        Some(distance_on_earth(place, [latitude.clamp(south, north), nearest].map(f64::to_radians)))
    }

    /// Returns true if the system defines heights.
    #[must_use]
    pub fn names_heights(&self) -> bool {
        let has_vertical_part = || self.wkt.as_deref().is_some_and(wkt::has_vertical_part);
        let is_compound = || self.epsg.is_some() && self.epsg != self.horizontal_epsg();
        self.vertical_epsg.is_some()
            || self.metres_per_unit.to_bits() != self.vertical_metres_per_unit.to_bits()
            || is_compound()
            || has_vertical_part()
    }

    /// This, with the heights of another system where it says nothing of heights itself.
    #[must_use]
    pub fn with_heights_of(mut self, other: &Self) -> Self {
        if !self.names_heights() && other.names_heights() {
            self.vertical_epsg = other.vertical_epsg;
            self.vertical_metres_per_unit = other.vertical_metres_per_unit;
            let by_code = || registry::wkt(&format!("EPSG:{}", self.horizontal_epsg()?));
            // a code for the heights says their unit; without one only the text can
            if self.wkt.is_some() || self.vertical_epsg.is_none() {
                let horizontal = self.wkt.clone().or_else(by_code);
                self.wkt = horizontal.map(|text| wkt::with_heights(&text, self.vertical_metres_per_unit));
            }
        }
        self
    }

    /// Compares the places that this system and `other` give to coordinates in the unit of their file.
    #[must_use]
    pub fn compare(&self, other: &Self, coordinates: [f64; 2]) -> Comparison {
        let names = |crs: &Self| !matches!(crs.kind, CrsKind::Unknown | CrsKind::Local);
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-7 * b.abs();
        let unit_is_known = |crs: &Self| crs.kind != CrsKind::Unknown || !close(crs.metres_per_unit, 1.0);
        if names(self) && names(other) && self.kind != other.kind {
            return Comparison::Apart("one is a plane, the other is not".to_owned());
        }
        if unit_is_known(self) && unit_is_known(other) && !close(self.metres_per_unit, other.metres_per_unit) {
            let [own, others] = [self, other].map(|crs| unit_name(crs.metres_per_unit));
            return Comparison::Apart(format!("one is in {own}, the other in {others}"));
        }
        let heights = [self.vertical_metres_per_unit, other.vertical_metres_per_unit];
        if self.names_heights() && other.names_heights() && !close(heights[0], heights[1]) {
            let [own, others] = heights.map(unit_name);
            return Comparison::Apart(format!("heights of one are in {own}, of the other in {others}"));
        }
        if !names(self) || !names(other) {
            return Comparison::Same;
        }
        if self.horizontal_epsg().is_some() && self.horizontal_epsg() == other.horizontal_epsg() {
            return Comparison::Same;
        }
        match (self.place_of(coordinates), other.place_of(coordinates)) {
            (Some(own), Some(others)) if distance_on_earth(own, others) <= SAME_PLACE => Comparison::Same,
            (Some(own), Some(others)) => Comparison::Apart(format!(
                "the same coordinates lie at {} in one and at {} in the other, {} apart",
                place_in_words(own),
                place_in_words(others),
                distance_in_words(distance_on_earth(own, others))
            )),
            _ if self.same_system(other) => Comparison::Same,
            _ => match (self.rough_place_of(coordinates), other.rough_place_of(coordinates)) {
                (Some(own), Some(others)) if distance_on_earth(own, others) > SAME_ROUGH_PLACE => {
                    let distance = distance_in_words(distance_on_earth(own, others));
                    Comparison::Apart(format!("the same coordinates lie about {distance} apart in them"))
                }
                _ => Comparison::Unknown,
            },
        }
    }

    /// [`Crs::place_of`], or where the step to WGS 84 is not known there, the place without it: at most a kilometre
    /// off.
    fn rough_place_of(&self, coordinates: [f64; 2]) -> Option<[f64; 2]> {
        let metres = coordinates.map(|v| v * self.metres_per_unit);
        self.place_of(coordinates).or_else(|| self.grid_projection().ok()?.unproject(metres).ok())
    }

    /// Refuses this system, which a user gives, for the file at `path`. It is refused if the file names another, and if
    /// the coordinates, in the unit of the file, are far from the area of use.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`].
    pub fn check_given(&self, of_file: &Self, coordinates: [f64; 2], path: &Path) -> Result<()> {
        let refused = |value| {
            let expected = "that of the file, or insisted on with the override of the reference system";
            Err(Error::invalid(Parameter::Crs, value, expected))
        };
        let (own, file) = (self.describe(), path.display());
        if let Comparison::Apart(how) = self.compare(of_file, coordinates) {
            return refused(format!("{own}, although {file} is in {} ({how})", of_file.describe()));
        }
        if let Some(distance) = self.distance_to_area_of_use(coordinates).filter(|&d| d > CONTRADICTION_DISTANCE) {
            let [x, y] = coordinates;
            let place = if distance.is_finite() {
                format!("lie {} outside of its area of use", distance_in_words(distance))
            } else {
                "are no place in it".to_owned()
            };
            return refused(format!("{own}, although the coordinates of {file}, such as {x:.0}, {y:.0}, {place}"));
        }
        Ok(())
    }

    /// This, with one more thing that speaks against it.
    #[must_use]
    pub fn doubted(mut self, what: String) -> Self {
        self.doubt = Some(match self.doubt.take() {
            Some(known) if known != what => format!("{known}; {what}"),
            _ => what,
        });
        self
    }
}

/// A distance in words: metres below 10 km.
#[must_use]
pub fn distance_in_words(metres: f64) -> String {
    if metres < 10e3 { format!("{metres:.0} m") } else { format!("{:.0} km", metres / 1000.0) }
}
