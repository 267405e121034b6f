//! Cells that observers see, or from which a target is visible.

use crate::arrays::to_1d;
use crate::errors::{exception, wrong};
use crate::observers::standing_observers;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::PyScene;
use crate::targets::{Grid, grid_at, grid_of};
use crate::work::run;
use belvedere::apps::ask::{self, Places, StandingObserver, ViewLimits, ViewshedTargets};
use belvedere::raster::Raster;
use belvedere::results::{Pixels, ResultRaster, terrain_georeference};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::Arc;

/// The bands of cells with their nodata value, their names, their description, their grid, and remarks.
type ViewshedReply<'py> = (Vec<(Bound<'py, PyAny>, f64)>, Vec<String>, String, Grid, Remarks<'py>);

/// Observers of a viewshed.
#[derive(FromPyObject)]
enum Observers<'py> {
    /// Number of observers spread over the map.
    #[pyo3(transparent)]
    Spread(usize),
    /// Their places.
    #[pyo3(transparent)]
    Places(PyReadonlyArray2<'py, f64>),
}

#[pymethods]
impl PyScene {
    /// The bands of cells with their nodata value, their names, their description, their grid, and remarks.
    fn viewshed<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::ViewshedQuestion>,
        observers: Observers<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<ViewshedReply<'py>> {
        let mut question = question.0;
        let mut spread = None;
        match observers {
            Observers::Spread(count) => spread = Some(count),
            Observers::Places(places) => {
                let standing = standing_observers(&places, &self.0)?.into_iter();
                let observer = |standing| StandingObserver { standing, limits: ViewLimits::default() };
                question.observers = standing.map(observer).collect();
            }
        }
        if question.targets.contains(&ViewshedTargets::FarTerrain) && self.0.model().far_terrain().grid().is_none() {
            return Err(wrong(
                "far",
                "True",
                "give the scene terrain first: scene.with_terrain('dtm.tif').viewshed(...)",
            ));
        }
        let scene = Arc::clone(&self.0);
        let answers = run(py, progress, move |control| {
            if let Some(count) = spread {
                question.observers = question.spread_observers(&scene, count, control)?;
            }
            ask::ask(&scene, &question, &Places::Scene, control)
        })?;
        let (found, frame) = (answers.found, self.0.frame());
        let is_far = found.far.is_some();
        let (seen, grid) = match (found.far, found.cells) {
            (Some(far), _) => {
                let heights = far.terrain.heights();
                let size = [heights.width(), heights.height()];
                (far.seen, grid_at(size, &terrain_georeference(&far.terrain, frame)))
            }
            (None, Some(seen)) => (seen, grid_of(&found.ground.ground.grid, frame)),
            (None, None) => return Err(PyRuntimeError::new_err("there are no cells")),
        };
        let remarks = remarks_of(py, &answers.remarks)?;
        let raster = ResultRaster::of_measures(&seen.to_measures(), [grid.0, grid.1]).map_err(exception)?;
        let no_data = raster.pixels.kind().in_gdal().1;
        let arrays = match &raster.pixels {
            Pixels::Answers(bands) => arrays_of(py, bands),
            Pixels::Counts(bands) => arrays_of(py, bands),
            Pixels::Numbers(bands) => arrays_of(py, bands),
        };
        let mut bands: Vec<(Bound<'py, PyAny>, f64)> = arrays.into_iter().map(|band| (band, no_data)).collect();
        let mut names: Vec<String> = raster.labels.into_iter().map(|label| label.name).collect();
        if !is_far {
            for measure in found.cells_sure {
                bands.push((to_1d(py, measure.values).into_any(), f64::NAN));
                names.push(measure.name);
            }
        }
        Ok((bands, names, raster.description, grid, remarks))
    }
}

fn arrays_of<'py, T: numpy::Element + Copy>(py: Python<'py>, bands: &[Raster<T>]) -> Vec<Bound<'py, PyAny>> {
    bands.iter().map(|band| to_1d(py, band.values().to_vec()).into_any()).collect()
}
