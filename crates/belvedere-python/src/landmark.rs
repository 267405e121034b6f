//! Views of a landmark, its visible part, and building heights before it.

use crate::arrays::{to_1d, to_2d};
use crate::mesh::PyMesh;
use crate::observers::standing_observers;
use crate::outlook::LookingKeywords;
use crate::remarks::remarks_of;
use crate::scene::{PyScene, local_ring, unproven_as, unproven_choice};
use crate::targets::{Grid, MeasureColumn, PyColumn, grid_of, ground_points, measure_columns};
use crate::work::run;
use belvedere::apps::ask::{self, LandmarkShape, SharedObject};
use belvedere::control::Control;
use belvedere::query::{BackFaces, SurfacePieces, UnprovenAs};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Choice of the landmark.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct LandmarkKeywords {
    mesh: Option<Py<PyMesh>>,
    objects: Vec<String>,
    spacing: Option<f64>,
    seed: u64,
    class: Option<u8>,
    /// Rings of (x, y) in the coordinates of the file.
    polygon: Option<Vec<Vec<[f64; 2]>>>,
}

impl LandmarkKeywords {
    fn shape(&self, scene: &ask::Scene) -> belvedere::Result<LandmarkShape> {
        if let Some(mesh) = &self.mesh {
            let mesh = Some(Arc::new(mesh.get().objects_in_metres(&self.objects, scene)?));
            return Ok(LandmarkShape::Mesh { mesh, spacing: self.spacing, seed: self.seed });
        }
        Ok(match (self.class, &self.polygon) {
            (Some(class), _) => LandmarkShape::Class(class),
            (None, rings) => {
                let rings = rings.iter().flatten().map(|ring| local_ring(scene, ring)).collect();
                LandmarkShape::Inside { polygons: vec![rings] }
            }
        })
    }

    fn surface(&self, scene: &ask::Scene, control: &Control<'_>) -> belvedere::Result<SurfacePieces> {
        Ok(self.shape(scene)?.surface(scene.cloud(), scene.frame().origin, control)?.0)
    }
}

/// Columns, the grid of observers, remarks, and the places of observers in the coordinates of the file.
type LandmarkReply<'py> = (Vec<MeasureColumn<'py>>, Option<Grid>, Vec<Bound<'py, PyDict>>, Bound<'py, PyArray2<f64>>);

#[pymethods]
impl PyScene {
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn landmark<'py>(
        &self,
        py: Python<'py>,
        landmark: LandmarkKeywords,
        observers: Option<PyReadonlyArray2<'py, f64>>,
        looking: LookingKeywords,
        unproven: &str,
        probability: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<LandmarkReply<'py>> {
        let (unproven, earth) = (unproven_choice(unproven)?, looking.earth()?);
        let ground = ground_points(looking.ground.as_deref())?;
        let observers = observers.as_ref().map(|array| standing_observers(array, &self.0)).transpose()?;
        let is_grid = observers.is_none();
        let scene = Arc::clone(&self.0);
        let answers = run(py, progress, move |control| {
            let question = ask::LandmarkQuestion {
                shape: landmark.shape(&scene)?,
                observers,
                observer_height: looking.observer_height,
                cell: looking.cell,
                ground,
                max_distance: looking.max_distance,
                back_faces: BackFaces::default(),
                earth,
                unproven,
                probability,
            };
            ask::ask(&scene, &question, &ask::Places::Scene, control)
        })?;
        let grid = is_grid.then(|| grid_of(&answers.found.ground.ground.grid, self.0.frame()));
        let remarks = remarks_of(py, &answers.remarks)?;
        let in_file = |place: &[f64; 3]| self.0.frame().file_from_local(*place);
        let places = to_2d(py, &answers.found.places.iter().map(in_file).collect::<Vec<_>>())?;
        Ok((measure_columns(py, answers.measures), grid, remarks, places))
    }

    /// Returns the maximum heights above the ground and of the file, their grid, and remarks.
    fn protected_view<'py>(
        &self,
        py: Python<'py>,
        landmark: LandmarkKeywords,
        observers: PyReadonlyArray2<'py, f64>,
        looking: LookingKeywords,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<PyColumn<'py>>, Grid, Vec<Bound<'py, PyDict>>)> {
        let unproven = Some(unproven_as(unproven)?).filter(|&choice| choice != UnprovenAs::Reported);
        let scene = Arc::clone(&self.0);
        let usual = ask::ProtectedViewQuestion::default();
        let mut question = ask::ProtectedViewQuestion {
            observers: standing_observers(&observers, &scene)?,
            observer_height: looking.observer_height.unwrap_or(usual.observer_height),
            max_distance: looking.max_distance,
            unproven,
            ..usual
        };
        let ground = ground_points(looking.ground.as_deref())?;
        let cells = ask::Places::Cells(ask::GridCells { cell: looking.cell, ground, ..ask::GridCells::default() });
        let of_work = Arc::clone(&scene);
        let answers = run(py, progress, move |control| {
            ask::Ask::check(&question)?;
            question.landmark = Some(SharedObject::new(landmark.surface(&of_work, control)?));
            ask::ask(&of_work, &question, &cells, control)
        })?;
        let found = answers.found;
        let grid = grid_of(&found.ground.ground.grid, scene.frame());
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
