//! Windows: from a user's input to the targets in front of them.

use super::context::Context;
use super::places::leave_out_outside;
use super::scene::Scene;
use super::shared::SharedObject;
use super::standing::Reach;
use crate::targets::{Targets, Window, objects_of_windows};
use belvedere_data::frame::Frame;
use belvedere_data::report::rounded;
use belvedere_data::{Error, Mesh, Parameter, Result};

/// Windows as they are given.
#[derive(Clone, Debug, PartialEq)]
pub enum GivenWindows {
    /// One by one.
    Each(Vec<GivenWindow>),
    /// The faces of a mesh in metres.
    Faces(SharedObject<Mesh>),
}

/// A window as it is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenWindow {
    /// Its middle, local metres.
    pub place: [f64; 3],
    /// Azimuth that it looks to, clockwise from the north of the question, degrees.
    pub azimuth_deg: f64,
    /// Angle between the direction that it looks to and the zenith, degrees, 0 (facing up) to 180; 90 is upright.
    pub tilt_deg: f64,
    /// Width and height, metres, 0 to 1000; `None` for its middle alone.
    pub size: Option<[f64; 2]>,
}

/// Windows with the targets in front of them.
pub struct WindowTargets {
    /// A group for each window.
    pub targets: Targets,
    /// Position and direction of each window.
    pub windows: Vec<Window>,
    /// Name of the object that each is a face of; empty where that is not known.
    pub names: Vec<String>,
}

impl Default for GivenWindows {
    fn default() -> Self {
        Self::Each(Vec::new())
    }
}

impl GivenWindows {
    /// Checks the values that do not depend on a scene.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for an azimuth beyond a full circle, and a tilt that is not 0 to 180 degrees.
    pub fn check(&self) -> Result<()> {
        let Self::Each(windows) = self else { return Ok(()) };
        let check = |(row, window): (usize, &GivenWindow)| window.check().map_err(|error| with_number((row, error)));
        windows.iter().enumerate().try_for_each(check)
    }

    /// The targets in a frame where grid north has the azimuth `grid_north`, radians. Faces are cut into pieces of
    /// `spacing` metres at most, with places drawn from `seed`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for windows without a place, direction or size that can be; those of
    /// [`Targets::of_window_faces`].
    pub fn targets(&self, frame: &Frame, grid_north: f64, (spacing, seed): (f64, u64)) -> Result<WindowTargets> {
        match self {
            Self::Each(given) => {
                let windows: Vec<Window> = given.iter().map(|window| window.in_grid(grid_north)).collect();
                let targets = Targets::of_windows(&windows, frame.clone()).map_err(with_number)?;
                Ok(WindowTargets { targets, windows, names: Vec::new() })
            }
            Self::Faces(mesh) => {
                let (targets, windows) = Targets::of_window_faces(mesh, frame, spacing, seed)?;
                let names = objects_of_windows(&windows, mesh);
                Ok(WindowTargets { targets, windows, names })
            }
        }
    }
}

impl GivenWindow {
    /// Checks the values that do not depend on a scene.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for an azimuth beyond a full circle, and a tilt that is not 0 to 180 degrees.
    pub(super) fn check(&self) -> Result<()> {
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::Window, value, expected));
        if self.azimuth_deg.abs() > 360.0 {
            let value = format!("with an azimuth of {} degrees", self.azimuth_deg);
            return invalid(value, "turned to an azimuth of -360 to 360 degrees, clockwise from north");
        }
        if !(0.0..=180.0).contains(&self.tilt_deg) {
            let value = format!("tilted by {} degrees", self.tilt_deg);
            return invalid(value, "tilted by 0 (facing up) to 180 degrees");
        }
        Ok(())
    }

    pub(super) fn in_grid(&self, grid_north: f64) -> Window {
        Window::new(self.place, self.azimuth_deg.to_radians() - grid_north, self.tilt_deg.to_radians(), self.size)
    }
}

/// The error of a window with its number, from 1.
pub(super) fn with_number((row, error): (usize, Error)) -> Error {
    match error {
        Error::InvalidParameter { parameter, value, expected } => {
            Error::invalid(parameter, format!("number {}, {value}", row + 1), expected)
        }
        other => other,
    }
}

impl WindowTargets {
    /// Leaves out targets outside the cloud, which is reported and warned of.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for windows all of which lie outside.
    pub(super) fn leave_out_outside(&mut self, scene: &Scene, context: &mut Context) -> Result<()> {
        let given = self.targets.target_count();
        leave_out_outside(&mut self.targets, Reach::Cloud, scene, context);
        if given == 0 || self.targets.target_count() > 0 {
            return Ok(());
        }
        let file = |corner: [f64; 3]| scene.frame().file_from_local(corner).map(|v| rounded(v, 1));
        let end = |pick: fn(f64, f64) -> f64, start: f64| {
            [0, 1, 2].map(|axis| self.windows.iter().map(|window| window.center[axis]).fold(start, pick))
        };
        let [from, to] = [end(f64::min, f64::INFINITY), end(f64::max, f64::NEG_INFINITY)].map(file);
        let (low, high) = scene.model().bounds().corners();
        let [low, high] = [low, high].map(file);
        let ranges = |low: [f64; 3], high: [f64; 3]| {
            let range = |(axis, name): (usize, &str)| format!("{name} {} to {}", low[axis], high[axis]);
            ["x", "y", "z"].into_iter().enumerate().map(range).collect::<Vec<_>>().join(", ")
        };
        let value =
            format!("all outside of the cloud: {}, while the cloud has {}", ranges(from, to), ranges(low, high));
        let expected = "in the coordinates of the cloud; z is a height of its system, not above the ground, and degrees must be converted";
        Err(Error::invalid(Parameter::Window, value, expected))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(place: [f64; 3], tilt_deg: f64) -> GivenWindow {
        GivenWindow { place, azimuth_deg: 180.0, tilt_deg, size: None }
    }

    #[test]
    fn errors_name_the_window_by_its_number() {
        let number_of = |error: Error| match error {
            Error::InvalidParameter { parameter: Parameter::Window, value, .. } => value,
            other => panic!("{other}"),
        };
        let tilted = GivenWindows::Each(vec![window([0.0; 3], 90.0), window([0.0; 3], 190.0)]);
        assert_eq!(number_of(tilted.check().unwrap_err()), "number 2, tilted by 190 degrees");
        let nowhere = GivenWindows::Each(vec![window([0.0; 3], 90.0), window([f64::NAN; 3], 90.0)]);
        let error = nowhere.targets(&Frame::default(), 0.0, (1.0, 1)).err().unwrap();
        assert!(number_of(error).starts_with("number 2, at "));
    }

    #[test]
    fn azimuths_count_from_the_north_of_the_question() {
        let given = GivenWindows::Each(vec![window([0.0; 3], 90.0)]);
        let found = given.targets(&Frame::default(), 0.1, (1.0, 1)).unwrap();
        assert!((found.windows[0].azimuth - (std::f64::consts::PI - 0.1)).abs() < 1e-12);
        assert_eq!((found.targets.len(), found.names.len()), (1, 0));
    }
}
