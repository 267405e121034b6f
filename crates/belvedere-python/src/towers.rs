//! Visible metres of towers.

use crate::outlook::LookingKeywords;
use crate::remarks::remarks_of;
use crate::scene::PyScene;
use crate::targets::{RequestedTargets, TargetResults, grid_at, ground_points, measure_columns, put_to_scene};
use belvedere::apps::ask::{self, GivenTower, Reach, Standing};
use belvedere::results::{terrain_georeference, write_wirelines};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A tower.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct TowerKeywords {
    place: [f64; 2],
    base: Option<f64>,
    hub: Option<f64>,
    tip: f64,
    name: String,
    scheme: String,
}

#[pymethods]
impl PyScene {
    fn towers<'py>(
        &self,
        py: Python<'py>,
        towers: Vec<TowerKeywords>,
        looking: LookingKeywords,
        targets: RequestedTargets<'py>,
        wirelines: Option<PathBuf>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<TargetResults<'py>> {
        let scene = Arc::clone(&self.0);
        let tower = |row: TowerKeywords| {
            let standing = Standing::on_map(row.place, row.base, scene.frame(), &scene.model().bounds())?;
            Ok(GivenTower { foot: standing.place, hub: row.hub, tip: row.tip, name: row.name, scheme: row.scheme })
        };
        let towers: belvedere::Result<Vec<GivenTower>> = towers.into_iter().map(tower).collect();
        let question = ask::TowersQuestion {
            towers: towers.map_err(crate::errors::exception)?,
            observer_height: looking.observer_height,
            max_distance: looking.max_distance,
            earth: looking.earth()?,
            ground: ground_points(looking.ground.as_deref())?,
            far: looking.is_far,
            wirelines: wirelines.is_some(),
        };
        let chosen = targets.chosen_within(Reach::FarTerrain, py, &scene)?;
        let places = chosen.places.clone();
        let answers = put_to_scene(py, progress, Arc::clone(&scene), question, places)?;
        if let (Some(folder), Some(found)) = (&wirelines, &answers.found.wirelines) {
            write_wirelines(folder, found, scene.frame()).map_err(crate::errors::exception)?;
        }
        if let Some(far) = answers.found.far {
            let heights = far.terrain.heights();
            let place = terrain_georeference(&far.terrain, scene.frame());
            let grid = grid_at([heights.width(), heights.height()], &place);
            return Ok((measure_columns(py, far.measures), Some(grid), None, remarks_of(py, &answers.remarks)?, None));
        }
        chosen.results(py, &answers.found.on_targets.targets, answers.measures, &answers.remarks)
    }
}
