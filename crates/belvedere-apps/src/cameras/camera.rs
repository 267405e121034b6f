//! Area and resolution of a camera's picture.

use crate::viewshed::SightLimits;
use belvedere_data::report::rounded;
use belvedere_data::vector::{dot, length, sub};
use belvedere_data::{Error, Parameter, Result};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Shape of a usual picture, width over height.
const ASPECT: f64 = 16.0 / 9.0;

/// Purpose of a picture, by the pixels on a metre of a person.
///
/// # Source
/// EN 62676-4:2015, video surveillance systems for use in security applications, part 4: application guidelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The number, direction and speed of people.
    Monitor,
    /// Presence of a person.
    Detect,
    /// Details such as clothing.
    Observe,
    /// Recognition of a known person.
    Recognise,
    /// Identification beyond doubt.
    Identify,
}

impl Level {
    /// All levels with their names.
    pub const ALL: [(&'static str, Self); 5] = [
        ("monitor", Self::Monitor),
        ("detect", Self::Detect),
        ("observe", Self::Observe),
        ("recognise", Self::Recognise),
        ("identify", Self::Identify),
    ];

    /// Minimum pixels per metre.
    #[must_use]
    pub fn pixels_per_metre(self) -> f64 {
        match self {
            Self::Monitor => 12.5,
            Self::Detect => 25.0,
            Self::Observe => 62.5,
            Self::Recognise => 125.0,
            Self::Identify => 250.0,
        }
    }
}

/// Angles and pixels of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Lens {
    /// Horizontal field of view, radians, above 0 to 2π. Below π the picture is flat; from π on the lens is a fisheye,
    /// a panorama, or a person or mast, without a density. Default π/2.
    pub width: f64,
    /// Vertical field of view, radians, above 0 to π and below π for a flat picture. `None`, the default: of a picture
    /// of 16 : 9, and π where the width is π or more.
    pub height: Option<f64>,
    /// Pixels across the picture. Default 1920.
    pub pixels: f64,
}

belvedere_data::setters!(Lens {
    with_width(width: f64),
    with_height(height: Option<f64>),
    with_pixels(pixels: f64),
});

impl Default for Lens {
    fn default() -> Self {
        Self { width: FRAC_PI_2, height: None, pixels: 1920.0 }
    }
}

impl Lens {
    /// Checks the lens.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for angles and pixels outside their range.
    pub fn validate(&self) -> Result<()> {
        let invalid =
            |parameter, value: f64, expected| Err(Error::invalid(parameter, rounded(value, 6).to_string(), expected));
        if !(self.width > 0.0 && self.width <= TAU + 1e-9) {
            return invalid(Parameter::FieldOfView, self.width.to_degrees(), "above 0 to 360 degrees");
        }
        if let Some(height) = self.height
            && !(height > 0.0 && height <= PI + 1e-9 && (height < PI || !self.is_flat()))
        {
            let expected = "above 0 and below 180 degrees, 180 also where the horizontal one is 180 degrees or more";
            return invalid(Parameter::VerticalFieldOfView, height.to_degrees(), expected);
        }
        if !(self.pixels > 0.0 && self.pixels.is_finite()) {
            return invalid(Parameter::CameraPixels, self.pixels, "above zero");
        }
        Ok(())
    }

    /// Returns true if the picture is flat.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.width < PI
    }

    /// Vertical field of view, radians.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.height.unwrap_or(if self.is_flat() { 2.0 * ((self.width / 2.0).tan() / ASPECT).atan() } else { PI })
    }

    /// Pixels per metre of a surface at a range of one metre that faces the camera: W / (2 tan(width / 2)). `None`
    /// without a flat picture.
    #[must_use]
    pub fn density(&self) -> Option<f64> {
        self.is_flat().then(|| self.pixels / (2.0 * (self.width / 2.0).tan()))
    }

    /// Pixels per metre that are required: those given, or else those of [`Level::Detect`]; 0, for no requirement,
    /// without a flat picture.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a density below 0, and for one above 0 without a flat picture.
    pub fn required_density(&self, given: Option<f64>) -> Result<f64> {
        let invalid = |density: f64, expected| Err(Error::invalid(Parameter::PixelsPerMetre, density, expected));
        match given {
            None => Ok(if self.is_flat() { Level::Detect.pixels_per_metre() } else { 0.0 }),
            Some(density) if !(density >= 0.0 && density.is_finite()) => invalid(density, "0 or more"),
            Some(density) if density > 0.0 && !self.is_flat() => {
                invalid(density, "none where the field of view is 180 degrees or more; limit the distance instead")
            }
            Some(density) => Ok(density),
        }
    }
}

/// A camera in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position, local metres; NaN for a camera that cannot look.
    pub eye: [f64; 3],
    /// Distances that it is good for, and the directions that it sees, by turning or by its lens.
    pub limits: SightLimits,
    /// The flat picture of a camera that is not turned.
    pub picture: Option<PictureDirection>,
    /// Pixels per metre at a range of one metre; `None` where density is no question.
    pub density: Option<f64>,
}

/// Direction and size of a flat picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureDirection {
    /// Azimuth of its middle, radians clockwise from grid north.
    pub heading: f64,
    /// Angle of its middle below the horizon, radians.
    pub tilt: f64,
    /// Tangents of half its horizontal and half its vertical field of view.
    pub half: [f64; 2],
}

impl PictureDirection {
    /// Returns true if a direction, of any length, is in the picture.
    #[must_use]
    pub fn holds(&self, direction: [f64; 3]) -> bool {
        let (east, north) = (self.heading.sin(), self.heading.cos());
        let (down, level) = (self.tilt.sin(), self.tilt.cos());
        let depth = dot(direction, [east * level, north * level, -down]);
        let right = dot(direction, [north, -east, 0.0]);
        let up = dot(direction, [east * down, north * down, level]);
        depth > 0.0 && right.abs() <= self.half[0] * depth && up.abs() <= self.half[1] * depth
    }
}

impl Camera {
    /// A camera that keeps looking to `heading` and `tilt` below the horizon, radians, good for horizontal distances
    /// from and to these metres.
    #[must_use]
    pub fn fixed(eye: [f64; 3], heading: f64, tilt: f64, lens: &Lens, distance: [f64; 2]) -> Self {
        let limits = SightLimits { distance, ..SightLimits::default() };
        if lens.is_flat() {
            let picture =
                PictureDirection { heading, tilt, half: [(lens.width / 2.0).tan(), (lens.height() / 2.0).tan()] };
            return Self { eye, limits, picture: Some(picture), density: lens.density() };
        }
        let azimuth = (lens.width < TAU - 1e-9).then(|| [heading - lens.width / 2.0, heading + lens.width / 2.0]);
        let elevation = (lens.height() < PI - 1e-9)
            .then(|| [-1.0, 1.0].map(|side| (side * lens.height() / 2.0 - tilt).clamp(-FRAC_PI_2, FRAC_PI_2)));
        Self { eye, limits: SightLimits { azimuth, elevation, ..limits }, picture: None, density: None }
    }

    /// A camera that is turned and tilted to whatever lies within `limits`.
    #[must_use]
    pub fn turning(eye: [f64; 3], lens: &Lens, limits: SightLimits) -> Self {
        Self { eye, limits, picture: None, density: lens.density() }
    }

    /// Returns true if a target that nothing hides, local metres, is in the picture with at least `density` pixels per
    /// metre; 0 requires none. Pixels per metre are those at the range of the target, times the cosine of the angle at
    /// which its unit `normal` is seen, if it has one. A target seen from the back is not covered.
    #[must_use]
    pub fn covers(&self, target: [f64; 3], normal: Option<[f64; 3]>, density: f64) -> bool {
        if !self.limits.allow(self.eye, target) {
            return false;
        }
        let direction = sub(target, self.eye);
        if self.picture.is_some_and(|picture| !picture.holds(direction)) {
            return false;
        }
        let range = length(direction);
        let facing = normal.map_or(1.0, |normal| -dot(normal, direction) / range);
        range > 0.0 && facing > 0.0 && self.density.is_none_or(|at_metre| at_metre * facing >= density * range)
    }

    /// The horizontal distance beyond which it covers nothing at this density, metres; it may be infinite.
    #[must_use]
    pub fn reach(&self, density: f64) -> f64 {
        let by_density = self.density.filter(|_| density > 0.0).map_or(f64::INFINITY, |at_metre| at_metre / density);
        self.limits.distance[1].min(by_density)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_of_the_standard_is_met_as_far_as_its_formula_says() {
        // 1920 pixels over 90 degrees: W / (2 d tan 45°) is 25 at 38.4 m
        let camera = Camera::turning([0.0; 3], &Lens::default(), SightLimits::default());
        let distances = Level::ALL.map(|(_, level)| camera.reach(level.pixels_per_metre()));
        assert_eq!(distances.map(|d| (d * 100.0).round() / 100.0), [76.8, 38.4, 15.36, 7.68, 3.84]);
        let seen = |d: f64, normal| camera.covers([0.0, d, 0.0], normal, 25.0);
        assert!(seen(38.3, None) && !seen(38.5, None));
        // seen at 60 degrees a wall has half the pixels, and none from behind
        let oblique = |angle: f64| Some([angle.to_radians().sin(), -angle.to_radians().cos(), 0.0]);
        assert!(seen(19.1, oblique(60.0)) && !seen(19.3, oblique(60.0)) && !seen(1.0, oblique(120.0)));
    }

    #[test]
    fn a_flat_picture_is_a_rectangle_around_its_middle() {
        let lens = Lens::default().with_height(Some(60_f64.to_radians()));
        let camera = Camera::fixed([0.0, 0.0, 10.0], FRAC_PI_2, 20_f64.to_radians(), &lens, [0.0, f64::INFINITY]);
        // along the middle of the picture, 20 degrees down: from 10 down to 50 degrees below the horizon
        let down = |angle: f64| camera.covers([10.0, 0.0, 10.0 - 10.0 * angle.to_radians().tan()], None, 0.0);
        assert!(!down(-10.5) && down(-9.5) && down(49.5) && !down(50.5));
        // at the depth of 10 m, half the width is 10 m to either side
        let (depth, tilt) = (10.0, 20_f64.to_radians());
        let side = |right: f64| camera.covers([depth * tilt.cos(), -right, 10.0 - depth * tilt.sin()], None, 0.0);
        assert!(side(9.99) && side(-9.99) && !side(10.01) && !side(-10.01));
        assert!(!camera.covers([-10.0, 0.0, 10.0], None, 0.0), "behind it");
    }

    #[test]
    fn wide_lenses_see_azimuths_and_have_no_density() {
        let lens = Lens::default().with_width(PI);
        let camera = Camera::fixed([0.0; 3], 0.0, 0.0, &lens, [1.0, 100.0]);
        assert!(camera.covers([99.0, 1.0, 0.0], None, 250.0) && !camera.covers([9.0, -1.0, 0.0], None, 0.0));
        let all = Camera::fixed([0.0; 3], 0.0, 0.0, &lens.with_width(TAU), [0.0, 100.0]);
        assert!(all.covers([9.0, -1.0, 50.0], None, 0.0) && all.limits.azimuth.is_none());
        assert!((Lens::default().height().to_degrees() - 58.716).abs() < 1e-3);
    }

    #[test]
    fn lenses_that_no_camera_has_are_refused() {
        let usual = Lens::default();
        for wrong in [
            usual.with_width(0.0),
            usual.with_width(f64::NAN),
            usual.with_width(7.0),
            usual.with_height(Some(PI)),
            usual.with_height(Some(0.0)),
            usual.with_pixels(f64::INFINITY),
        ] {
            assert!(wrong.validate().is_err(), "{wrong:?}");
        }
        assert!(usual.with_width(TAU).with_height(Some(PI)).validate().is_ok() && usual.validate().is_ok());
    }
}
