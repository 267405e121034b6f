//! Survey plan: stations for another scan.

use crate::arrays::{to_1d, to_2d};
use crate::errors::wrong;
use crate::observers::standing;
use crate::remarks::remarks_of;
use crate::scene::PyScene;
use crate::targets::ground_points;
use crate::visibility::EndKeywords;
use crate::work::run;
use belvedere::apps::ask::{self, Candidates, GivenCamera, GridCells, PlannedStation, Suns, SurveyPlanQuestion};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Stations to choose from, and the limits of the scanner.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct StationKeywords {
    /// x, y and z in the coordinates of the file, z NaN where it follows from the ground; `None` for a grid.
    candidates: Option<Vec<[f64; 3]>>,
    /// The number of the line that each of them is a place on, where lines are candidates.
    lines: Option<Vec<usize>>,
    on_roofs: bool,
    spacing: f64,
    station_height: Option<f64>,
    count: usize,
    max_distance: Option<f64>,
    angle_step_deg: Option<f64>,
    /// Azimuths and elevations of suns whose light on cells of a side, metres, is to be proven; none for pairs.
    suns: Vec<[f64; 2]>,
    cell: Option<f64>,
}

#[pymethods]
impl PyScene {
    /// Columns of the candidates that can be used, and remarks.
    fn survey_plan<'py>(
        &self,
        py: Python<'py>,
        stations: StationKeywords,
        observers: PyReadonlyArray2<'py, f64>,
        targets: PyReadonlyArray2<'py, f64>,
        ends: EndKeywords,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Bound<'py, PyDict>, Vec<Bound<'py, PyDict>>)> {
        let scene = Arc::clone(&self.0);
        let line = |row: usize| stations.lines.as_ref().and_then(|lines| lines.get(row).copied());
        let given = |(row, &place): (usize, &[f64; 3])| GivenCamera {
            place: scene.frame().local_from_file(place),
            line: line(row),
            ..GivenCamera::default()
        };
        let question = SurveyPlanQuestion {
            count: stations.count,
            candidates: match &stations.candidates {
                Some(places) => Candidates::Given(places.iter().enumerate().map(given).collect()),
                None if stations.on_roofs => Candidates::Roofs(stations.spacing),
                None => Candidates::Ground(stations.spacing),
            },
            station_height: stations.station_height,
            max_distance: stations.max_distance,
            angle_step_deg: stations.angle_step_deg,
            observer_height: ends.observer_height,
            target_height: ends.target_height,
            ground: ground_points(ends.ground.as_deref())?,
            suns: (!stations.suns.is_empty()).then(|| Suns::Directions(stations.suns.clone())),
            whole_lines: stations.lines.is_some(),
            ..SurveyPlanQuestion::default()
        };
        let [observers, targets] = [standing(&observers, "observers", &scene)?, standing(&targets, "targets", &scene)?];
        if observers.len() != targets.len() {
            let value = format!("an array of {} rows", targets.len());
            return Err(wrong("targets", &value, &format!("give a row for each of the {} observers", observers.len())));
        }
        let pairs = match question.suns.is_some() {
            true => {
                let (cell, height, ground) = (stations.cell, ends.target_height, question.ground);
                ask::Places::Cells(GridCells { cell, height, ground, ..GridCells::default() })
            }
            false => ask::Places::Pairs(observers.into_iter().zip(targets).map(<[_; 2]>::from).collect()),
        };
        let answers = run(py, progress, move |control| ask::ask(&scene, &question, &pairs, control))?;
        let found = &answers.found;
        let rows = found.stations();
        let places: Vec<[f64; 3]> = rows.iter().map(|row| self.0.frame().file_from_local(row.eye)).collect();
        let column = |value: &dyn Fn(&PlannedStation) -> f64| to_1d(py, rows.iter().map(value).collect());
        let dict = PyDict::new(py);
        dict.set_item("place", to_2d(py, &places)?)?;
        dict.set_item("station", to_1d::<u64>(py, rows.iter().map(|row| row.order.unwrap_or(0) as u64).collect()))?;
        dict.set_item("settles_alone", to_1d::<u64>(py, rows.iter().map(|row| row.alone.settled as u64).collect()))?;
        dict.set_item("expected_alone", column(&|row| row.alone.expected))?;
        dict.set_item("proves_alone_m", column(&|row| row.alone.proven))?;
        let together = |row: &PlannedStation| row.together.map_or(f64::NAN, |gain| gain.settled as f64);
        dict.set_item("settled", column(&together))?;
        dict.set_item("expected", column(&|row| row.together.map_or(f64::NAN, |gain| gain.expected)))?;
        Ok((dict, remarks_of(py, &answers.remarks)?))
    }
}
