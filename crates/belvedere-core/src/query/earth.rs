//! The curved earth below long lines of sight.

use belvedere_data::cast::to_u32;
use belvedere_data::vector::{length, sub};
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Mean radius of the earth, metres.
///
/// # Source
/// Moritz 2000, Geodetic Reference System 1980: R1.
pub const EARTH_RADIUS: f64 = 6_371_008.8;
/// Length from which [`Curvature::Auto`] follows the earth, metres: the line then sags by 7 cm in its middle.
pub const CURVED_FROM: f64 = 2000.0;
/// Horizontal length of a chord, metres: with the usual refraction it lies 4 mm off the curve at most.
const CHORD: f64 = 500.0;
/// Maximum number of chords of one line.
const MAX_CHORDS: f64 = 10_000.0;

/// Lines of sight that follow the curvature of the earth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Curvature {
    /// Lines longer than [`CURVED_FROM`].
    #[default]
    Auto,
    /// All.
    On,
    /// None: the earth is a plane.
    Off,
}

/// Parameters of lines of sight over the curved earth.
///
/// In a map with heights above the sea a straight line of sight is a parabola. It sags below the straight line between
/// its ends by (1 − k) · s · (S − s) / 2R at the horizontal distance s of S. k is the refraction and R the radius.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct EarthParams {
    /// Lines that are curved. Default: lines of more than 2 km.
    pub curvature: Curvature,
    /// Coefficient of refraction, 0 (none) to below 1: the share of the curvature that light follows. Default 1/7, as
    /// in GDAL and GRASS.
    pub refraction: f64,
    /// Radius of the earth, metres, above 0. Default 6 371 008.8.
    pub radius: f64,
}

impl Default for EarthParams {
    fn default() -> Self {
        Self { curvature: Curvature::Auto, refraction: 1.0 / 7.0, radius: EARTH_RADIUS }
    }
}

impl EarthParams {
    /// Lines of sight over a plane.
    #[must_use]
    pub fn flat() -> Self {
        Self { curvature: Curvature::Off, ..Self::default() }
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for one outside its range.
    pub fn validate(&self) -> Result<()> {
        if !(0.0..1.0).contains(&self.refraction) {
            return Err(Error::invalid(Parameter::Refraction, self.refraction, "from 0 to below 1 (usually 0.143)"));
        }
        if !(self.radius.is_finite() && self.radius > 0.0) {
            return Err(Error::invalid(Parameter::EarthRadius, self.radius, "above zero metres"));
        }
        Ok(())
    }

    /// Returns true if the line between two points is curved.
    #[must_use]
    pub fn bends(&self, from: [f64; 3], to: [f64; 3]) -> bool {
        match self.curvature {
            Curvature::Off => false,
            Curvature::On => true,
            Curvature::Auto => length(sub(to, from)) > CURVED_FROM,
        }
    }

    /// Returns the depth below the level plane of an observer of a place `span` metres away on the map, metres.
    #[must_use]
    pub(super) fn fall(&self, span: f64) -> f64 {
        (1.0 - self.refraction) * span * span / (2.0 * self.radius)
    }

    /// Returns the fall of places for each square metre of their squared distance in plan, 1/m: 0 over a plane.
    #[must_use]
    pub(super) fn fall_rate(&self) -> f64 {
        if self.curvature == Curvature::Off { 0.0 } else { self.fall(1.0) }
    }

    /// Returns the tangent of the apparent elevation of a place that lies `rise` metres higher on the map and `span`
    /// metres away. It is the slope of the line of sight at its start.
    pub(super) fn apparent_tangent(&self, rise: f64, span: f64) -> f64 {
        rise / span - self.fall_rate() * span
    }

    /// Returns the apparent elevation of `place` from `eye`, both metres, radians: that of the line of sight at the
    /// eye.
    #[must_use]
    pub fn apparent_elevation(&self, eye: [f64; 3], place: [f64; 3]) -> f64 {
        let span = (place[0] - eye[0]).hypot(place[1] - eye[1]);
        self.apparent_tangent(place[2] - eye[2], span).atan()
    }

    /// Returns the rise on the map, metres, of a line of sight that starts with this tangent, after `span` metres.
    pub(super) fn height_along(&self, tangent: f64, span: f64) -> f64 {
        (tangent + self.fall_rate() * span) * span
    }

    /// Returns the depth of the line below the straight one between its ends, metres, at the share `share` of the
    /// horizontal length `span`, metres.
    #[must_use]
    pub fn sag(&self, span: f64, share: f64) -> f64 {
        (1.0 - self.refraction) * span * span * share * (1.0 - share) / (2.0 * self.radius)
    }

    /// The corners of the chords that represent the line of sight between two points, both included: two where it is
    /// straight.
    #[must_use]
    pub fn corners(&self, from: [f64; 3], to: [f64; 3]) -> Vec<[f64; 3]> {
        let span = (to[0] - from[0]).hypot(to[1] - from[1]);
        if !self.bends(from, to) || !span.is_finite() {
            return vec![from, to];
        }
        let count = (span / CHORD).ceil().clamp(1.0, MAX_CHORDS);
        let last = to_u32(count);
        let corner = |i: u32| -> [f64; 3] {
            match i {
                0 => from,
                _ if i == last => to,
                _ => {
                    let share = f64::from(i) / count;
                    let mut corner = std::array::from_fn(|k| from[k] + share * (to[k] - from[k]));
                    corner[2] -= self.sag(span, share);
                    corner
                }
            }
        };
        (0..=last).map(corner).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refraction_takes_a_seventh_of_the_sag() {
        // 10 km over a sphere without air: S²/8R = 1.962 m in the middle
        let bare = EarthParams { refraction: 0.0, ..EarthParams::default() };
        assert!((bare.sag(10_000.0, 0.5) - 1.962).abs() < 5e-4);
        assert!((EarthParams::default().sag(10_000.0, 0.5) / bare.sag(10_000.0, 0.5) - 6.0 / 7.0).abs() < 1e-12);
    }

    #[test]
    fn chords_lie_within_five_millimetres_of_the_curve() {
        let earth = EarthParams::default();
        let (from, to) = ([0.0, 0.0, 100.0], [9000.0, 12_000.0, 40.0]);
        let corners = earth.corners(from, to);
        assert_eq!((corners[0], corners[corners.len() - 1]), (from, to));
        let mut worst = 0.0_f64;
        for pair in corners.windows(2) {
            let middle: [f64; 3] = std::array::from_fn(|i| (pair[0][i] + pair[1][i]) / 2.0);
            let share = middle[0] / 9000.0;
            let curve = 100.0 - 60.0 * share - earth.sag(15_000.0, share);
            worst = worst.max((middle[2] - curve).abs());
        }
        assert!(worst > 0.0 && worst < 0.005, "{worst}");
    }

    #[test]
    fn short_lines_and_a_plane_earth_are_straight() {
        let (from, near, far) = ([0.0; 3], [1999.0, 0.0, 0.0], [3000.0, 0.0, 0.0]);
        assert_eq!(EarthParams::default().corners(from, near).len(), 2);
        assert!(EarthParams::default().corners(from, far).len() > 2);
        assert_eq!(EarthParams::flat().corners(from, far).len(), 2);
    }

    #[test]
    fn refraction_of_one_or_nan_is_refused() {
        for refraction in [1.0, -0.1, f64::NAN] {
            let error = EarthParams { refraction, ..EarthParams::default() }.validate().unwrap_err().to_string();
            assert!(error.contains("refraction"), "{error}");
        }
    }
}
