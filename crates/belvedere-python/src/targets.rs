//! Targets of questions: cells of a grid, points, a cloud, or the faces of a mesh.

use crate::arrays::{PositionArray, fixed_rows, to_1d, to_2d};
use crate::cloud::Cloud;
use crate::errors::{exception, wrong};
use crate::mesh::{Faces, rows_of};
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use belvedere::apps::ask::{self, Reach, Remark};
use belvedere::apps::targets::{CellLevel, Measure, ResultKind, Targets};
use belvedere::ground::{GroundPoints, MapGrid};
use belvedere::io::Georeference;
use belvedere::results::{FaceRows, georeference};
use belvedere::{Frame, Mesh};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Targets in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct RequestedTargets<'py> {
    places: Option<PositionArray<'py>>,
    on_map: Option<Vec<[f64; 3]>>,
    cloud: Option<Py<Cloud>>,
    faces: Option<Faces>,
    normals: Option<PyReadonlyArray2<'py, f32>>,
    surface: bool,
    cell: Option<f64>,
    height: Option<f64>,
    pub(crate) ground: Data<GroundPoints>,
}

/// Places of a question, and the mesh whose faces they are.
pub(crate) struct Chosen {
    pub(crate) places: ask::Places,
    mesh: Option<Arc<Mesh>>,
}

impl RequestedTargets<'_> {
    pub(crate) fn chosen(&self, py: Python<'_>, scene: &ask::Scene) -> PyResult<Chosen> {
        self.chosen_within(Reach::Cloud, py, scene)
    }

    /// The places of lines of sight of this extent.
    pub(crate) fn chosen_within(&self, reach: Reach, py: Python<'_>, scene: &ask::Scene) -> PyResult<Chosen> {
        let normals: Option<Vec<[f32; 3]>> = self.normals.as_ref().map(|n| fixed_rows(n, "normals")).transpose()?;
        let check = |count: usize| match &normals {
            Some(normals) if normals.len() != count => {
                Err(wrong("normals", &format!("an array of {} rows", normals.len()), &format!("give {count} rows")))
            }
            _ => Ok(()),
        };
        let of = |places| Ok(Chosen { places, mesh: None });
        if let Some(places) = &self.places {
            let positions = places.local("targets", scene.frame())?;
            check(positions.len())?;
            return of(ask::Places::Points(positions, normals));
        }
        if let Some(places) = &self.on_map {
            let places = places.iter().map(|&[x, y, z]| ([x, y], Some(z).filter(|z| !z.is_nan())));
            let places = ask::standing_on_map(places, self.height, reach, scene).map_err(exception)?;
            return of(ask::Places::At(places, self.ground.0));
        }
        if let Some(cloud) = &self.cloud {
            let cloud = Arc::clone(&cloud.borrow(py).0);
            check(cloud.len())?;
            return of(ask::Places::Cloud(cloud, normals));
        }
        if let Some(faces) = &self.faces {
            let (mesh, params) = faces.owned(scene)?;
            return Ok(Chosen { places: ask::Places::Mesh(Arc::clone(&mesh), params), mesh: Some(mesh) });
        }
        of(ask::Places::Cells(ask::GridCells {
            cell: self.cell,
            level: if self.surface { CellLevel::Surface } else { CellLevel::Ground },
            height: self.height,
            ground: self.ground.0,
            ..ask::GridCells::default()
        }))
    }
}

/// Width and height of a grid in cells, and the six numbers of its affine transform in the unit of the file.
pub(crate) type Grid = (usize, usize, [f64; 6]);

pub(crate) fn grid_of(grid: &MapGrid, frame: &Frame) -> Grid {
    grid_at([grid.width, grid.height], &georeference(grid, frame))
}

/// The same for cells of this width and height in cells that lie there.
pub(crate) fn grid_at([width, height]: [usize; 2], place: &Georeference) -> Grid {
    let Georeference { upper_left, column_step, row_step, .. } = place;
    (width, height, [column_step[0], row_step[0], upper_left[0], column_step[1], row_step[1], upper_left[1]])
}

/// Name, description and values of a measure, whether it is an answer, its unit and further metadata.
pub(crate) type MeasureColumn<'py> =
    (String, &'static str, Bound<'py, PyAny>, bool, &'static str, BTreeMap<String, String>);
/// Name, description and values.
pub(crate) type PyColumn<'py> = (String, &'static str, Bound<'py, PyAny>);
/// Columns of measures; then the grid where targets are cells; or, where they are the faces of a mesh, only their rows;
/// then remarks; then the places of targets that were given on the map, (N, 3), in the coordinates of the file.
pub(crate) type TargetResults<'py> = (
    Vec<MeasureColumn<'py>>,
    Option<Grid>,
    Option<Bound<'py, PyDict>>,
    Remarks<'py>,
    Option<Bound<'py, PyArray2<f64>>>,
);

/// Measures as Python takes them.
pub(crate) fn measure_columns(py: Python<'_>, measures: Vec<Measure>) -> Vec<MeasureColumn<'_>> {
    let column = |measure: Measure| {
        let is_answer = measure.kind == ResultKind::Answer;
        let (values, tags) = (to_1d(py, measure.values).into_any(), measure.tags.into_iter().collect());
        (measure.name, measure.description, values, is_answer, measure.unit, tags)
    };
    measures.into_iter().map(column).collect()
}

impl Chosen {
    /// Measures of the targets as Python takes them.
    pub(crate) fn results<'py>(
        &self,
        py: Python<'py>,
        targets: &Targets,
        measures: Vec<Measure>,
        remarks: &[Remark],
    ) -> PyResult<TargetResults<'py>> {
        let remarks = remarks_of(py, remarks)?;
        if let (Some(mesh), Some(surface)) = (&self.mesh, targets.surface()) {
            let rows = rows_of(py, FaceRows::of_measures(mesh, surface, &measures))?;
            return Ok((Vec::new(), None, Some(rows), remarks, None));
        }
        let grid = targets.ground().map(|ground| grid_of(&ground.grid, &targets.frame));
        let in_file = |p: &[f32; 3]| targets.frame.file_from_local(p.map(f64::from));
        let places = match self.places {
            ask::Places::At(..) => Some(to_2d(py, &targets.positions.iter().map(in_file).collect::<Vec<_>>())?),
            _ => None,
        };
        Ok((measure_columns(py, measures), grid, None, remarks, places))
    }
}
