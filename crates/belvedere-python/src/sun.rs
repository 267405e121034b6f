//! Position of the sun, hours of sun, and how much of the sky is seen.

use crate::arrays::to_1d;
use crate::cloud::PyInput;
use crate::errors::exception;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::PyScene;
use crate::targets::{Grid, RequestedTargets, TargetResults, grid_of};
use crate::work::run;
use belvedere::apps::ask::{self, HourlySun, Question, SunHoursQuestion, SunPositionQuestion};
use belvedere::control::Control;
use belvedere::io::read_weather;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// Name and values of each hour of each month, the grid of its cells, and remarks.
type HourBands<'py> = (Vec<(String, Bound<'py, PyArray1<u32>>)>, Option<Grid>, Remarks<'py>);

#[pymethods]
impl PyScene {
    /// Azimuth and elevation of the sun, degrees, at each of some times.
    fn sun_positions(&self, question: Data<SunPositionQuestion>) -> PyResult<Vec<(f64, f64)>> {
        let answers = ask::ask(&self.0, &question.0, &ask::Places::Scene, &Control::none()).map_err(exception)?;
        Ok(answers.found.into_iter().map(|sun| (sun.azimuth_deg, sun.elevation_deg)).collect())
    }

    /// Measures of a question about each target.
    fn on_targets<'py>(
        &self,
        py: Python<'py>,
        question: Data<Question>,
        weather: Option<PyInput>,
        targets: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<TargetResults<'py>> {
        let chosen = targets.chosen(py, &self.0)?;
        let places = chosen.places.clone();
        let answers = match question.0 {
            Question::SkyView(question) => self.ask(py, progress, question, places),
            Question::SunHours(question) => self.ask(py, progress, question, places),
            Question::Heat(mut question) => {
                let file = weather.ok_or_else(|| PyValueError::new_err("heat needs weather"))?;
                question.file = file.name().display().to_string();
                question.weather = Some(Arc::new(read_weather(file.source()).map_err(exception)?));
                self.ask(py, progress, question, places)
            }
            _ => Err(PyValueError::new_err("this is no question about each target")),
        }?;
        chosen.results(py, &answers.found.targets, answers.measures, &answers.remarks)
    }

    /// Name and values of each hour of each month at the cells of a grid, and the grid.
    fn hourly_sun<'py>(
        &self,
        py: Python<'py>,
        year: i16,
        question: Data<SunHoursQuestion>,
        targets: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<HourBands<'py>> {
        let scene = Arc::clone(&self.0);
        let places = targets.chosen(py, &scene)?.places;
        let (bands, grid, remarks) = run(py, progress, move |control| {
            let answers = question.0.hourly_sun(Some(year), &places, &scene, control)?;
            let sun = answers.found;
            let hours = (1..=12_i8).flat_map(|month| (0..HourlySun::HOURS).map(move |hour| (month, hour)));
            let bands = hours.map(|(month, hour)| (format!("{month:02}_{hour:02}"), sun.days(month, hour)));
            let grid = sun.targets.ground().map(|ground| grid_of(&ground.grid, &sun.targets.frame));
            Ok((bands.collect::<Vec<_>>(), grid, answers.remarks))
        })?;
        let bands = bands.into_iter().map(|(name, days)| (name, to_1d(py, days))).collect();
        Ok((bands, grid, remarks_of(py, &remarks)?))
    }
}
