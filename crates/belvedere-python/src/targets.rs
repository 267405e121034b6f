//! What is asked about: cells of a grid, points, a cloud, or the faces of a mesh.

use crate::arrays::{Places, fixed_rows, to_1d};
use crate::cloud::Cloud;
use crate::errors::wrong;
use crate::mesh::{Faces, rows_of};
use crate::scene::Inner;
use belvedere::apps::targets::{CellLevel, CellParams, Measure, MeshParams, ResultKind, Targets};
use belvedere::apps::viewshed::cell_for;
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, GroundPoints, MapGrid};
use belvedere::io::Georeference;
use belvedere::results::{FaceRows, georeference};
use belvedere::{Error, Frame, Mesh, PointCloud};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// What Python asks about.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wanted<'py> {
    places: Option<Places<'py>>,
    cloud: Option<Py<Cloud>>,
    faces: Option<Faces>,
    normals: Option<PyReadonlyArray2<'py, f32>>,
    surface: bool,
    cell: Option<f64>,
    height: Option<f64>,
    ground: Option<String>,
}

/// The same in the frame of the scene, owned, so that it can be worked on without the interpreter.
pub(crate) enum Asked {
    Points { positions: Vec<[f32; 3]>, normals: Option<Vec<[f32; 3]>> },
    Cloud { cloud: Arc<PointCloud>, normals: Option<Vec<[f32; 3]>> },
    Faces { mesh: Arc<Mesh>, params: MeshParams },
    Cells(Cells),
}

/// Targets, and the mesh whose faces they are.
pub(crate) struct Found {
    pub(crate) targets: Targets,
    mesh: Option<Arc<Mesh>>,
}

/// Cells of a grid over the scene.
#[derive(Clone, Copy)]
pub(crate) struct Cells {
    pub(crate) side: Option<f64>,
    pub(crate) height: Option<f64>,
    pub(crate) level: CellLevel,
    pub(crate) ground: GroundPoints,
}

/// Which points are ground.
pub(crate) fn ground_points(text: Option<&str>) -> PyResult<GroundPoints> {
    match text {
        None | Some("auto") => Ok(GroundPoints::Auto),
        Some("class") => Ok(GroundPoints::Classed),
        Some("found") => Ok(GroundPoints::Found),
        Some(other) => Err(wrong("ground", &format!("'{other}'"), "use 'auto', 'class' or 'found'")),
    }
}

impl Wanted<'_> {
    pub(crate) fn cell(&self) -> Option<f64> {
        self.cell
    }

    pub(crate) fn height(&self) -> Option<f64> {
        self.height
    }

    pub(crate) fn ground(&self) -> Option<&str> {
        self.ground.as_deref()
    }

    pub(crate) fn owned(&self, py: Python<'_>, inner: &Inner) -> PyResult<Asked> {
        let normals: Option<Vec<[f32; 3]>> = self.normals.as_ref().map(|n| fixed_rows(n, "normals")).transpose()?;
        let check = |count: usize| match &normals {
            Some(normals) if normals.len() != count => {
                Err(wrong("normals", &format!("an array of {} rows", normals.len()), &format!("give {count} rows")))
            }
            _ => Ok(()),
        };
        if let Some(places) = &self.places {
            let positions = places.local("targets", inner.frame())?;
            check(positions.len())?;
            return Ok(Asked::Points { positions, normals });
        }
        if let Some(cloud) = &self.cloud {
            let cloud = Arc::clone(&cloud.borrow(py).0);
            check(cloud.len())?;
            return Ok(Asked::Cloud { cloud, normals });
        }
        if let Some(faces) = &self.faces {
            let (mesh, params) = faces.owned(inner)?;
            return Ok(Asked::Faces { mesh, params });
        }
        let level = if self.surface { CellLevel::Surface } else { CellLevel::Ground };
        let ground = ground_points(self.ground.as_deref())?;
        Ok(Asked::Cells(Cells { side: self.cell, height: self.height, level, ground }))
    }
}

impl Asked {
    /// The targets in the frame of the scene, without those outside its cloud.
    pub(crate) fn targets(self, inner: &Inner, control: &Control<'_>) -> belvedere::Result<Found> {
        let frame = inner.frame();
        let of = |positions, normals| {
            let cloud = PointCloud { positions, ..PointCloud::in_frame(frame.clone()) };
            Targets::of_points(&cloud, normals)
        };
        let mut mesh_of = None;
        let mut targets = match self {
            Self::Cells(cells) => return Ok(Found { targets: cells.targets(inner, control)?, mesh: None }),
            Self::Points { positions, normals } => of(positions, normals),
            Self::Cloud { cloud, normals } => of(moved(&cloud, frame)?, normals),
            Self::Faces { mesh, params } => {
                let targets = Targets::of_mesh(&mesh, frame, &params)?;
                mesh_of = Some(mesh);
                targets
            }
        };
        if let Some(coverage) = inner.model.coverage() {
            targets.leave_out_outside(&coverage);
        }
        Ok(Found { targets, mesh: mesh_of })
    }
}

/// Positions of a cloud in another frame.
pub(crate) fn moved(cloud: &PointCloud, frame: &Frame) -> belvedere::Result<Vec<[f32; 3]>> {
    if cloud.frame.crs.contradicts(&frame.crs) {
        return Err(Error::InvalidParameter {
            name: "reference system of the targets",
            value: cloud.frame.crs.describe(),
            expected: "that of the scene; convert one of them",
        });
    }
    if cloud.frame == *frame {
        return Ok(cloud.positions.clone());
    }
    let bare = PointCloud { positions: cloud.positions.clone(), ..PointCloud::in_frame(cloud.frame.clone()) };
    Ok(bare.moved_to(frame).positions)
}

/// The cloud of a scene, which must have points to show the ground.
pub(crate) fn ground_cloud(inner: &Inner) -> belvedere::Result<&PointCloud> {
    if inner.cloud.is_empty() {
        return Err(Error::MissingAttribute {
            attribute: "ground",
            needed_for: "a grid of cells",
            advice: "a ball file has no points: give its cloud with Scene.load(path, cloud=read(...)), or give targets",
        });
    }
    Ok(&inner.cloud)
}

impl Cells {
    /// The ground of the scene on a grid of these cells over the box from `low` to `high`.
    pub(crate) fn ground_within(
        &self,
        inner: &Inner,
        (low, high): ([f64; 2], [f64; 2]),
        control: &Control<'_>,
    ) -> belvedere::Result<Ground> {
        let cloud = ground_cloud(inner)?;
        let [x, y, _] = cloud.frame.origin;
        let grid = MapGrid::covering(low, high, self.side.unwrap_or_else(|| cell_for(low, high)), [x, y])?;
        let params = GroundParams { points: self.ground, ..GroundParams::default() };
        Ok(control.stage("computing ground", 0, || Ground::of_cloud(cloud, grid, &params, control))?.0)
    }

    fn targets(&self, inner: &Inner, control: &Control<'_>) -> belvedere::Result<Targets> {
        let ground = self.ground_within(inner, inner.model.bounds().on_map(), control)?;
        let mut params = CellParams::default().with_level(self.level);
        if let Some(height) = self.height {
            params = params.with_height(height);
        }
        let (mut targets, _) = Targets::of_cells(ground_cloud(inner)?, ground, &params, control)?;
        if let Some(added) = inner.model.added() {
            targets.set_on_added(added, &params);
        }
        Ok(targets)
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

/// Name, description and values of a measure, and whether it is an answer.
pub(crate) type MeasureColumn<'py> = (String, &'static str, Bound<'py, PyAny>, bool);
/// Name, description and values.
pub(crate) type Column<'py> = (String, &'static str, Bound<'py, PyAny>);
/// Columns of measures; then the grid where targets are cells; or, where they are the faces of a mesh, only their rows.
pub(crate) type Results<'py> = (Vec<MeasureColumn<'py>>, Option<Grid>, Option<Bound<'py, PyDict>>);

impl Found {
    /// Measures of the targets as Python takes them.
    pub(crate) fn results<'py>(&self, py: Python<'py>, measures: Vec<Measure>) -> PyResult<Results<'py>> {
        if let (Some(mesh), Some(surface)) = (&self.mesh, self.targets.surface()) {
            let rows = rows_of(py, FaceRows::of_measures(mesh, surface, &measures))?;
            return Ok((Vec::new(), None, Some(rows)));
        }
        let column = |measure: Measure| {
            let is_answer = measure.kind == ResultKind::Answer;
            (measure.name, measure.description, to_1d(py, measure.values).into_any(), is_answer)
        };
        let grid = self.targets.ground().map(|ground| grid_of(&ground.grid, &self.targets.frame));
        Ok((measures.into_iter().map(column).collect(), grid, None))
    }
}
