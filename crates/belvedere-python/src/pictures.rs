//! Depth maps.

use crate::errors::exception;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::PyScene;
use belvedere::apps::ask::{self, North, Places, ViewFrom};
use belvedere::raster::Raster;
use belvedere::view::{CAMERA_FOV, CAMERA_SIZE, PANORAMA_WIDTH, View, default_pixel_size, to_sun};
use numpy::PyArray2;
use numpy::ndarray::Array2;
use pyo3::prelude::*;

/// Position and projection of a picture.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct PictureCamera {
    sun: Option<[f64; 2]>,
    direction: Option<[f64; 3]>,
    eye: Option<[f64; 3]>,
    look_at: Option<[f64; 3]>,
    /// Metres.
    pixel: Option<f64>,
    /// Degrees.
    fov: Option<f64>,
    /// Width and height.
    size: Option<[usize; 2]>,
    /// Width of a panorama.
    width: Option<usize>,
}

/// A raster as an array.
fn to_array<T: numpy::Element + Copy>(py: Python<'_>, raster: Raster<T>) -> PyResult<Bound<'_, PyAny>> {
    let array = Array2::from_shape_vec((raster.height(), raster.width()), raster.values().to_vec());
    let array = array.map_err(|error| pyo3::exceptions::PyRuntimeError::new_err(error.to_string()))?;
    Ok(PyArray2::from_owned_array(py, array).into_any())
}

impl PictureCamera {
    /// Returns the position and projection of the picture; azimuths are from `north`.
    fn from(&self, scene: &ask::Scene, north: North) -> belvedere::Result<ViewFrom> {
        let (low, high) = scene.model().bounds().corners();
        let pixel = self.pixel.unwrap_or_else(|| default_pixel_size(low, high));
        let local = |place| scene.frame().local_from_file(place);
        let view = match (self.sun, self.direction, self.eye, self.look_at) {
            (Some([azimuth, elevation]), ..) => {
                ask::check_sun([azimuth, elevation], ask::SunRange::NotBelowHorizon)?;
                let north = north.of_scene(scene).of_grid;
                let sun = to_sun(azimuth.to_radians() - north, elevation.to_radians());
                View::parallel(sun.map(|v| -v), low, high, pixel)?
            }
            (_, Some(direction), ..) => View::parallel(direction, low, high, pixel)?,
            (.., Some(eye), Some(look_at)) => {
                let fov = self.fov.map_or(CAMERA_FOV, f64::to_radians);
                let size = self.size.unwrap_or(CAMERA_SIZE);
                View::perspective(local(eye), local(look_at), fov, size, 0.0, f64::INFINITY)?
            }
            (.., eye, None) => {
                let width = self.width.unwrap_or(PANORAMA_WIDTH);
                return Ok(ViewFrom::Panorama { eye: local(eye.unwrap_or_default()), width });
            }
            _ => {
                return Err(belvedere::Error::InvalidParameter {
                    parameter: belvedere::Parameter::View,
                    value: "nothing".to_owned(),
                    expected: "sun, direction, eye with look_at, or eye for a panorama",
                });
            }
        };
        Ok(ViewFrom::View(view))
    }
}

/// Depths in metres, the rows of the balls that are seen, and remarks.
type Depths<'py> = (Bound<'py, PyAny>, Option<Bound<'py, PyAny>>, Remarks<'py>);

#[pymethods]
impl PyScene {
    /// Depths in metres, the rows of the balls that are seen, and remarks.
    fn depth_map<'py>(
        &self,
        py: Python<'py>,
        camera: PictureCamera,
        north: Data<North>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Depths<'py>> {
        let scene = &self.0;
        let from = camera.from(scene, north.0).map_err(exception)?;
        let site = ask::SunPlace::default().site_of(scene.frame(), &scene.model().bounds(), None).ok();
        let of_sun = camera.sun.and_then(|sun| ask::remark_on_sun(site.map(|(site, _)| site), sun));
        let question = ask::DepthMapQuestion { from: Some(from), ball_ids: true };
        let answers = self.ask(py, progress, question, Places::Scene)?;
        let remarks = remarks_of(py, of_sun.iter().chain(&answers.remarks))?;
        let balls = answers.found.balls.map(|balls| to_array(py, balls)).transpose()?;
        Ok((to_array(py, answers.found.depth)?, balls, remarks))
    }
}
