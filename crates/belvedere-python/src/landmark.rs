//! From where a landmark is seen, how much of it, and how high one may build before it.

use crate::arrays::to_1d;
use crate::mesh::Mesh;
use crate::observers::{eyes, places, skip, skipped};
use crate::outlook::Looking;
use crate::scene::{Scene, unproven_as};
use crate::targets::{Cells, Column, Grid, grid_of, ground_cloud, ground_points, remark_of};
use crate::work::run;
use belvedere::apps::ask::{self, Shared, Standing};
use belvedere::apps::eyes::EyesReport;
use belvedere::apps::landmark::{
    LandmarkParams, LandmarkPoints, LandmarkView, MEASURES, landmark_points, landmark_views, observer_cell_for,
    spacing_for,
};
use belvedere::apps::targets::{CellLevel, CellParams, CoveredCells, Targets};
use belvedere::apps::viewshed::OBSERVER_HEIGHT;
use belvedere::query::{SurfacePieces, UnprovenAs};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// What the landmark is.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Landmark {
    mesh: Option<Py<Mesh>>,
    objects: Vec<String>,
    spacing: Option<f64>,
    seed: u64,
    class: Option<u8>,
    /// Rings of (x, y) in the coordinates of the file.
    polygon: Option<Vec<Vec<[f64; 2]>>>,
}

/// A ring in local metres.
pub(crate) fn local_ring(inner: &ask::Scene, ring: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let local = |&[x, y]: &[f64; 2]| {
        let [x, y, _] = inner.frame().local_from_file([x, y, 0.0]);
        [x, y]
    };
    ring.iter().map(local).collect()
}

impl Landmark {
    fn surface(&self, inner: &ask::Scene) -> belvedere::Result<SurfacePieces> {
        if let Some(mesh) = &self.mesh {
            let mesh = mesh.get().objects_in_metres(&self.objects, inner)?;
            let spacing = self.spacing.unwrap_or_else(|| spacing_for(mesh.area()));
            return SurfacePieces::of_mesh(&mesh, inner.frame().origin, spacing, self.seed);
        }
        let polygons: Vec<Vec<Vec<[f64; 2]>>>;
        let which = match (self.class, &self.polygon) {
            (Some(class), _) => LandmarkPoints::Class(class),
            (None, rings) => {
                polygons = vec![rings.iter().flatten().map(|ring| local_ring(inner, ring)).collect()];
                LandmarkPoints::Inside(&polygons)
            }
        };
        Ok(landmark_points(ground_cloud(inner)?, &which)?.1)
    }
}

/// Columns, the grid of observers, their places and what was skipped.
type Views<'py> = (Vec<Column<'py>>, Option<Grid>, Vec<String>);

#[pymethods]
impl Scene {
    fn landmark<'py>(
        &self,
        py: Python<'py>,
        landmark: Landmark,
        observers: Option<PyReadonlyArray2<'py, f64>>,
        looking: Looking,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Views<'py>> {
        let unproven = unproven_as(unproven)?;
        let earth = looking.earth()?;
        let points = ground_points(looking.ground.as_deref())?;
        let usual = LandmarkParams::default();
        let params = usual
            .with_unproven(unproven)
            .with_earth(earth)
            .with_max_range(looking.max_distance.unwrap_or(usual.max_range));
        let given = observers.as_ref().map(places).transpose()?;
        let inner = Arc::clone(&self.0);
        let of_work = Arc::clone(&inner);
        let (views, grid, report) = run(py, progress, move |control| {
            let inner = of_work;
            let surface = control.stage("sampling landmark", 0, || landmark.surface(&inner))?;
            let scene = inner.blockers(unproven, control)?;
            let (stand, grid, report): (Vec<[f64; 3]>, Option<Grid>, EyesReport) = match given {
                Some(places) => {
                    let mut stand = eyes(&inner, &places, looking.observer_height, points, control)?;
                    let report = skip(&scene, None, &mut stand, control)?;
                    (stand, None, report)
                }
                None => {
                    let (low, high) = inner.model().bounds().on_map();
                    let side = Some(looking.cell.unwrap_or_else(|| observer_cell_for(low, high)));
                    let cells = Cells { side, height: None, level: CellLevel::Ground, ground: points };
                    let ground = cells.ground_within(&inner, (low, high), control)?;
                    let grid = grid_of(&ground.grid, inner.frame());
                    let height = looking.observer_height.unwrap_or(OBSERVER_HEIGHT);
                    let cells = CellParams::default().with_height(height).with_covered(CoveredCells::Kept);
                    let (mut targets, _) = Targets::of_cells(inner.cloud(), ground, &cells, control)?;
                    targets.leave_out_enclosed(&scene, control)?;
                    let stand: Vec<[f64; 3]> = targets.positions.iter().map(|eye| eye.map(f64::from)).collect();
                    let count = stand.len();
                    (stand, Some(grid), EyesReport::none_skipped(count))
                }
            };
            let views = control.stage("testing landmark", stand.len(), || {
                landmark_views(&scene, &surface, &stand, &params, control)
            })?;
            Ok((views, grid, report))
        })?;
        let skipped = skipped(&inner, "observer", &report)?;
        #[expect(clippy::cast_possible_truncation, reason = "measures are f32")]
        let of = |value: &dyn Fn(&LandmarkView) -> f64| views.iter().map(|view| value(view) as f32).collect();
        let columns = MEASURES.iter().map(|measure| {
            let values = to_1d(py, of(&|view| measure.of(view))).into_any();
            (measure.name.to_owned(), measure.description, values)
        });
        Ok((columns.collect(), grid, skipped))
    }

    /// Greatest heights above the ground and of the file, their grid, and remarks.
    fn protected_view<'py>(
        &self,
        py: Python<'py>,
        landmark: Landmark,
        observers: PyReadonlyArray2<'py, f64>,
        looking: Looking,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<Column<'py>>, Grid, Vec<Bound<'py, PyDict>>)> {
        let unproven = Some(unproven_as(unproven)?).filter(|&choice| choice != UnprovenAs::Reported);
        let scene = Arc::clone(&self.0);
        let stand = |place: [f64; 3]| Standing { place: scene.frame().local_from_file(place), height: None };
        let usual = ask::ProtectedView::default();
        let mut question = ask::ProtectedView {
            observers: places(&observers)?.into_iter().map(stand).collect(),
            observer_height: looking.observer_height.unwrap_or(usual.observer_height),
            max_distance: looking.max_distance,
            unproven,
            ..usual
        };
        let ground = ground_points(looking.ground.as_deref())?;
        let cells = ask::Places::Cells(ask::Cells { cell: looking.cell, ground, ..ask::Cells::default() });
        let of_work = Arc::clone(&scene);
        let answers = run(py, progress, move |control| {
            ask::Ask::check(&question)?;
            let surface = control.stage("sampling landmark", 0, || landmark.surface(&of_work))?;
            question.landmark = Some(Shared::new(surface));
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
        let remarks = answers.remarks.iter().map(|remark| remark_of(py, remark)).collect::<PyResult<_>>()?;
        Ok((columns, grid, remarks))
    }
}
