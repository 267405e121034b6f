//! Visible metres of towers.

use crate::errors::exception;
use crate::question::Data;
use crate::remarks::remarks_of;
use crate::scene::PyScene;
use crate::targets::{RequestedTargets, TargetResults, grid_at, measure_columns};
use belvedere::apps::ask::{self, GivenTower, Reach, Standing};
use belvedere::results::{terrain_georeference, write_wirelines};
use pyo3::prelude::*;
use std::path::PathBuf;

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
        question: Data<ask::TowersQuestion>,
        towers: Vec<TowerKeywords>,
        wirelines: Option<PathBuf>,
        targets: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<TargetResults<'py>> {
        let scene = &self.0;
        let tower = |row: TowerKeywords| {
            let standing = Standing::on_map(row.place, row.base, scene.frame(), &scene.model().bounds())?;
            Ok(GivenTower { foot: standing.place, hub: row.hub, tip: row.tip, name: row.name, scheme: row.scheme })
        };
        let towers: belvedere::Result<Vec<GivenTower>> = towers.into_iter().map(tower).collect();
        let towers = towers.map_err(exception)?;
        let question = ask::TowersQuestion { towers, wirelines: wirelines.is_some(), ..question.0 };
        let chosen = targets.chosen_within(Reach::FarTerrain, py, scene)?;
        let answers = self.ask(py, progress, question, chosen.places.clone())?;
        if let (Some(folder), Some(found)) = (&wirelines, &answers.found.wirelines) {
            write_wirelines(folder, found, scene.frame()).map_err(exception)?;
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
