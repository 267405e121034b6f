//! Depth maps.

use crate::scene::Scene;
use crate::sun::Place;
use crate::work::run;
use belvedere::depth::{ItemBuffer, Profile};
use belvedere::raster::Raster;
use belvedere::view::{CAMERA_FOV, CAMERA_SIZE, PANORAMA_WIDTH, View, default_pixel_size, to_sun};
use numpy::PyArray2;
use numpy::ndarray::Array2;
use pyo3::prelude::*;
use std::sync::Arc;

/// From where a picture is taken.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Camera {
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

#[pymethods]
impl Scene {
    /// Depths in metres, and the rows of the balls that are seen.
    fn depth_map<'py>(
        &self,
        py: Python<'py>,
        camera: Camera,
        place: Place,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, Option<Bound<'py, PyAny>>)> {
        let inner = Arc::clone(&self.0);
        let north = place.grid_north_of(&inner);
        let (depth, balls) = run(py, progress, move |control| {
            let model = inner.model();
            let (low, high) = model.bounds().corners();
            let pixel = camera.pixel.unwrap_or_else(|| default_pixel_size(low, high));
            let local = |place| inner.frame().local_from_file(place);
            let view = match (camera.sun, camera.direction, camera.eye, camera.look_at) {
                (Some([azimuth, elevation]), ..) => {
                    let sun = to_sun(azimuth.to_radians() - north, elevation.to_radians());
                    View::parallel(sun.map(|v| -v), low, high, pixel)?
                }
                (_, Some(direction), ..) => View::parallel(direction, low, high, pixel)?,
                (.., Some(eye), Some(look_at)) => {
                    let fov = camera.fov.map_or(CAMERA_FOV, f64::to_radians);
                    let size = camera.size.unwrap_or(CAMERA_SIZE);
                    View::perspective(local(eye), local(look_at), fov, size, 0.0, f64::INFINITY)?
                }
                (.., eye, None) => {
                    let eye = local(eye.unwrap_or_default());
                    let width = camera.width.unwrap_or(PANORAMA_WIDTH);
                    let found =
                        control.stage("drawing", 0, || model.panorama(eye, width, ItemBuffer::With, control))?;
                    return Ok((found.range, found.balls));
                }
                _ => {
                    return Err(belvedere::Error::InvalidParameter {
                        parameter: belvedere::Parameter::View,
                        value: "nothing".to_owned(),
                        expected: "sun, direction, eye with look_at, or eye for a panorama",
                    });
                }
            };
            let found =
                control.stage("drawing", 0, || model.depth_map(&view, Profile::Sphere, ItemBuffer::With, control))?;
            Ok((found.depth, found.balls))
        })?;
        Ok((to_array(py, depth)?, balls.map(|balls| to_array(py, balls)).transpose()?))
    }
}
