//! Views of a landmark, its visible part, and building heights before it.

use crate::arrays::{to_1d, to_2d};
use crate::errors::exception;
use crate::mesh::PyMesh;
use crate::observers::standing_observers;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::{PyScene, local_ring};
use crate::targets::{Grid, MeasureColumn, PyColumn, RequestedTargets, grid_of, measure_columns};
use crate::work::run;
use belvedere::apps::ask::{self, Ask, LandmarkShape, SharedObject};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use std::sync::Arc;

/// The object that is the landmark, unless it is a class of points.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct LandmarkObject {
    mesh: Option<Py<PyMesh>>,
    objects: Vec<String>,
    /// Rings of (x, y) in the coordinates of the file.
    polygon: Vec<Vec<[f64; 2]>>,
}

impl LandmarkObject {
    /// Fills a shape with the object.
    fn fill(&self, shape: &mut LandmarkShape, scene: &ask::Scene) -> belvedere::Result<()> {
        match (shape, &self.mesh) {
            (LandmarkShape::Mesh { mesh, .. }, Some(given)) => {
                *mesh = Some(Arc::new(given.get().objects_in_metres(&self.objects, scene)?));
            }
            (LandmarkShape::Inside { polygons }, _) => {
                *polygons = vec![self.polygon.iter().map(|ring| local_ring(scene, ring)).collect()];
            }
            _ => {}
        }
        Ok(())
    }
}

/// Columns, the grid of observers, remarks, and the places of observers in the coordinates of the file.
type LandmarkReply<'py> = (Vec<MeasureColumn<'py>>, Option<Grid>, Remarks<'py>, Bound<'py, PyArray2<f64>>);

#[pymethods]
impl PyScene {
    fn landmark<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::LandmarkQuestion>,
        object: LandmarkObject,
        observers: Option<PyReadonlyArray2<'py, f64>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<LandmarkReply<'py>> {
        let mut question = question.0;
        question.observers = observers.as_ref().map(|array| standing_observers(array, &self.0)).transpose()?;
        let is_grid = observers.is_none();
        object.fill(&mut question.shape, &self.0).map_err(exception)?;
        let answers = self.ask(py, progress, question, ask::Places::Scene)?;
        let grid = is_grid.then(|| grid_of(&answers.found.ground.ground.grid, self.0.frame()));
        let remarks = remarks_of(py, &answers.remarks)?;
        let in_file = |place: &[f64; 3]| self.0.frame().file_from_local(*place);
        let places = to_2d(py, &answers.found.places.iter().map(in_file).collect::<Vec<_>>())?;
        Ok((measure_columns(py, answers.measures), grid, remarks, places))
    }

    /// Returns the maximum heights above the ground and of the file, their grid, and remarks.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn protected_view<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::ProtectedViewQuestion>,
        shape: Data<LandmarkShape>,
        object: LandmarkObject,
        observers: PyReadonlyArray2<'py, f64>,
        cells: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<PyColumn<'py>>, Grid, Remarks<'py>)> {
        let (scene, mut question, mut shape) = (Arc::clone(&self.0), question.0, shape.0);
        question.observers = standing_observers(&observers, &scene)?;
        let cells = cells.chosen(py, &scene)?.places;
        let answers = run(py, progress, move |control| {
            question.check()?;
            object.fill(&mut shape, &scene)?;
            let (surface, _) = shape.surface(scene.cloud(), scene.frame().origin, control)?;
            question.landmark = Some(SharedObject::new(surface));
            ask::ask(&scene, &question, &cells, control)
        })?;
        let found = answers.found;
        let grid = grid_of(&found.ground.ground.grid, self.0.frame());
        let column = |name: &str, description, values: &[f32]| {
            (name.to_owned(), description, to_1d(py, values.to_vec()).into_any())
        };
        let columns = vec![
            column("height", "maximum height above the ground", found.heights.values()),
            column("top", "maximum height", found.tops.values()),
        ];
        let remarks = remarks_of(py, &answers.remarks)?;
        Ok((columns, grid, remarks))
    }
}
