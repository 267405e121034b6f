//! Horizons and isovists of observers.

use crate::arrays::{to_1d, to_2d};
use crate::observers::standing_observers;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::PyScene;
use belvedere::apps::ask;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Elevations, the number of azimuths, and remarks.
type Horizons<'py> = (Bound<'py, PyAny>, usize, Remarks<'py>);
/// Columns of isovists, their panoramas, and remarks.
type Described<'py> = (Bound<'py, PyDict>, Vec<Bound<'py, PyAny>>, Remarks<'py>);

#[pymethods]
impl PyScene {
    /// Returns elevations of the horizon, degrees, with a row for each observer and a column for each azimuth, NaN for
    /// skipped observers. Each is followed by the ends of its interval if these are wanted. Also returns the number of
    /// azimuths, and remarks.
    fn horizon<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::HorizonQuestion>,
        observers: PyReadonlyArray2<'py, f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Horizons<'py>> {
        let eyes = ask::Places::Eyes(standing_observers(&observers, &self.0)?);
        let answers = self.ask(py, progress, question.0, eyes)?;
        let found = answers.found;
        let count = found.azimuth_count;
        let mut all = Vec::new();
        for (eye, elevations) in found.elevations_deg.iter().enumerate() {
            let ends = found.intervals_deg.as_ref().map(|intervals| intervals.get(eye));
            for azimuth in 0..count {
                all.push(elevations.get(azimuth).copied().unwrap_or(f64::NAN));
                let ends = ends.map(|ends| ends.and_then(|ends| ends.get(azimuth)).copied());
                all.extend(ends.map(|ends| ends.unwrap_or([f64::NAN; 2])).into_iter().flatten());
            }
        }
        Ok((to_1d(py, all).into_any(), count, remarks_of(py, &answers.remarks)?))
    }

    /// Columns of numbers, the panorama of each observer, and remarks.
    fn isovist<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::IsovistsQuestion>,
        observers: PyReadonlyArray2<'py, f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Described<'py>> {
        let eyes = ask::Places::Eyes(standing_observers(&observers, &self.0)?);
        let answers = self.ask(py, progress, question.0, eyes)?;
        let found = answers.found;
        let dict = PyDict::new(py);
        let of_file: Vec<[f64; 3]> = found.eyes.places.iter().map(|&eye| self.0.frame().file_from_local(eye)).collect();
        dict.set_item("place", to_2d(py, &of_file)?)?;
        for column in found.columns() {
            dict.set_item(&column.name, to_1d(py, column.numbers().to_vec()))?;
        }
        let panoramas = found.isovists.iter().flatten().map(|isovist| {
            let raster = &isovist.panorama;
            let array =
                numpy::ndarray::Array2::from_shape_vec((raster.height(), raster.width()), raster.values().to_vec());
            array.map(|array| numpy::PyArray2::from_owned_array(py, array).into_any())
        });
        let panoramas: Result<Vec<_>, _> = panoramas.collect();
        let panoramas = panoramas.map_err(|error| pyo3::exceptions::PyRuntimeError::new_err(error.to_string()))?;
        Ok((dict, panoramas, remarks_of(py, &answers.remarks)?))
    }
}
