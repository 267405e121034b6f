//! Horizons and isovists of observers.

use crate::arrays::{to_1d, to_2d};
use crate::observers::standing_observers;
use crate::remarks::remarks_of;
use crate::scene::PyScene;
use crate::sun::SiteKeywords;
use crate::targets::ground_points;
use crate::visibility::earth;
use crate::work::run;
use belvedere::apps::ask::{self, BelowLevel};
use belvedere::query::EarthParams;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Parameters of observers over cells.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct LookingKeywords {
    pub(crate) observer_height: Option<f64>,
    pub(crate) target_height: Option<f64>,
    pub(crate) cell: Option<f64>,
    pub(crate) ground: Option<String>,
    /// Degrees from the north that `SiteKeywords` says.
    pub(crate) azimuth_range: Option<[f64; 2]>,
    pub(crate) elevation_range: Option<[f64; 2]>,
    pub(crate) min_distance: Option<f64>,
    pub(crate) max_distance: Option<f64>,
    curvature: Option<String>,
    refraction: Option<f64>,
    /// The one place is a target, and who looks stands in the cells.
    pub(crate) is_reverse: bool,
    /// Cells are those of the terrain beyond the cloud.
    pub(crate) is_far: bool,
}

impl LookingKeywords {
    pub(crate) fn earth(&self) -> PyResult<EarthParams> {
        earth(self.curvature.as_deref(), self.refraction)
    }
}

/// Elevations, the number of azimuths, and remarks.
type Horizons<'py> = (Bound<'py, PyAny>, usize, Vec<Bound<'py, PyDict>>);
/// Columns of isovists, their panoramas, and remarks.
type Described<'py> = (Bound<'py, PyDict>, Vec<Bound<'py, PyAny>>, Vec<Bound<'py, PyDict>>);

#[pymethods]
impl PyScene {
    /// Returns elevations of the horizon, degrees, with a row for each observer and a column for each azimuth, NaN for
    /// skipped observers. Each is followed by the ends of its interval if these are wanted. Also returns the number of
    /// azimuths, and remarks.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn horizon<'py>(
        &self,
        py: Python<'py>,
        observers: PyReadonlyArray2<'py, f64>,
        angle_step: Option<f64>,
        looking: LookingKeywords,
        place: SiteKeywords,
        interval: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Horizons<'py>> {
        let question = ask::HorizonQuestion {
            observer_height: looking.observer_height,
            ground: ground_points(looking.ground.as_deref())?,
            angle_step_deg: angle_step,
            earth: looking.earth()?,
            north: place.north(),
            below: BelowLevel::Keep,
            interval,
        };
        let scene = Arc::clone(&self.0);
        let eyes = ask::Places::Eyes(standing_observers(&observers, &scene)?);
        let answers = run(py, progress, move |control| ask::ask(&scene, &question, &eyes, control))?;
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
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn isovist<'py>(
        &self,
        py: Python<'py>,
        observers: PyReadonlyArray2<'py, f64>,
        angle_step: Option<f64>,
        min_jump: Option<f64>,
        looking: LookingKeywords,
        place: SiteKeywords,
        interval: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Described<'py>> {
        let question = ask::IsovistsQuestion {
            observer_height: looking.observer_height,
            ground: ground_points(looking.ground.as_deref())?,
            north: place.north(),
            max_distance: looking.max_distance,
            angle_step_deg: angle_step,
            min_jump,
            interval,
        };
        let scene = Arc::clone(&self.0);
        let eyes = ask::Places::Eyes(standing_observers(&observers, &scene)?);
        let of_work = Arc::clone(&scene);
        let answers = run(py, progress, move |control| ask::ask(&of_work, &question, &eyes, control))?;
        let found = answers.found;
        let dict = PyDict::new(py);
        let of_file: Vec<[f64; 3]> = found.eyes.places.iter().map(|&eye| scene.frame().file_from_local(eye)).collect();
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
