//! Open surveys of a place.

use crate::cloud::{Cloud, json};
use crate::work::run;
use belvedere::control::Control;
use belvedere::io::open_surveys::{
    FoundSurvey, SurveyArea, best_covering, find_surveys, known_surveys, read_area, read_surveys, surveys_at,
};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// Choice of surveys and their area.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AreaKeywords {
    /// Latitude and longitude, degrees.
    at: [f64; 2],
    radius: f64,
    survey: Option<String>,
    /// Table of surveys instead of that of the library.
    surveys: Option<PathBuf>,
}

impl AreaKeywords {
    fn find(&self, control: &Control<'_>) -> belvedere::Result<(SurveyArea, Vec<FoundSurvey>)> {
        let area = SurveyArea::around(self.at, self.radius)?;
        let table = self.surveys.as_deref().map_or_else(known_surveys, read_surveys)?;
        let surveys = surveys_at(table, self.survey.as_deref(), &area)?;
        Ok((area, find_surveys(&surveys, &area, control)?))
    }
}

/// The surveys of an area with their tiles, as JSON.
#[pyfunction]
pub(crate) fn open_surveys(py: Python<'_>, area: AreaKeywords, progress: Option<Py<PyAny>>) -> PyResult<String> {
    let (_, found) = run(py, progress, move |control| area.find(control))?;
    json(&found)
}

/// The points of an area, the report on reading them and their survey, both as JSON, and warnings.
#[pyfunction]
pub(crate) fn fetch(
    py: Python<'_>,
    area: AreaKeywords,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Cloud, String, String, Vec<String>)> {
    let (cloud, report, chosen, warnings) = run(py, progress, move |control| {
        SurveyArea::around(area.at, area.radius)?.check_cloud()?;
        let (area, found) = area.find(control)?;
        let chosen = best_covering(&found)?;
        let (cloud, report) = read_area(chosen, &area, control)?;
        let warnings = found.iter().filter_map(FoundSurvey::failure_in_words).chain(chosen.part_in_words()).collect();
        Ok((cloud, report, chosen.clone(), warnings))
    })?;
    Ok((Cloud(Arc::new(cloud)), json(&report)?, json(&chosen)?, warnings))
}
