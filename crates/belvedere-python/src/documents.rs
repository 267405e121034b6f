//! Sun calendars and sunlight reports.

use crate::arrays::to_1d;
use crate::errors::{exception, wrong};
use crate::planning::PyTable;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::{PyScene, local_ring};
use crate::targets::RequestedTargets;
use crate::windows::{WindowRow, given};
use crate::work::run;
use belvedere::apps::ask::{self, Days, GivenWindows, SunPlace};
use belvedere::apps::sun_calendar::SunStretch;
use belvedere::sunlight_report::{Language, ReportArea, ReportParams, ShadowStudy, sunlight_report};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// Content of a report.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct ReportKeywords {
    windows: Vec<WindowRow>,
    names: Vec<String>,
    rooms: Vec<String>,
    /// Names of areas, and their corners in the coordinates of the file.
    areas: Vec<(String, Vec<[f64; 2]>)>,
    planned: Option<Py<PyScene>>,
    rule: Option<String>,
    area_rule: Option<String>,
    study: Option<String>,
    title: String,
    notes: Vec<String>,
    language: String,
    today: String,
}

impl ReportKeywords {
    fn params(&self, scene: &ask::Scene, days: Days, place: SunPlace) -> PyResult<ReportParams> {
        let language = Language::ALL.iter().find(|(code, _)| *code == self.language);
        let Some(&(_, language)) = language else {
            return Err(wrong("language", &format!("'{}'", self.language), "use 'en', 'nl', 'de' or 'fr'"));
        };
        let study_of = |name: &str| {
            let known = ShadowStudy::ALL.into_iter().find(|study| study.name() == name);
            known.ok_or_else(|| wrong("study", &format!("'{name}'"), "use 'ceqr', 'san-francisco' or 'toronto'"))
        };
        let study = self.study.as_deref().map(study_of).transpose()?;
        let area = |(name, ring): &(String, Vec<[f64; 2]>)| ReportArea {
            name: name.clone(),
            rings: vec![local_ring(scene, ring)],
        };
        Ok(ReportParams {
            title: self.title.clone(),
            notes: self.notes.clone(),
            language,
            windows: given(&self.windows, scene.frame()),
            names: self.names.clone(),
            rooms: self.rooms.clone(),
            areas: self.areas.iter().map(area).collect(),
            rule: self.rule.clone(),
            area_rule: self.area_rule.clone(),
            study,
            days,
            place,
            date: self.today.clone(),
            ..ReportParams::default()
        })
    }
}

#[pymethods]
impl PyScene {
    /// Stretches of sun and shade, one in each row.
    fn sun_calendar<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::SunCalendarQuestion>,
        windows: Vec<WindowRow>,
        targets: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyTable<'py>> {
        let places = match &windows[..] {
            [] => targets.chosen(py, &self.0)?.places,
            _ => ask::Places::Scene,
        };
        let windows = GivenWindows::Each(given(&windows, self.0.frame()));
        let answers = self.ask(py, progress, ask::SunCalendarQuestion { windows, ..question.0 }, places)?;
        let found = &answers.found;
        let stretches = || found.stretches().map(|(.., stretch)| stretch);
        let object = |stretch: &SunStretch| found.mesh_name(stretch.obstacle).unwrap_or_default().to_owned();
        let dict = PyDict::new(py);
        dict.set_item("place", to_1d(py, found.stretches().map(|(place, ..)| place as u64).collect()))?;
        dict.set_item("date", found.stretches().map(|(_, date, _)| date.to_string()).collect::<Vec<_>>())?;
        dict.set_item("start", to_1d(py, stretches().map(|stretch| f64::from(stretch.start)).collect()))?;
        dict.set_item("end", to_1d(py, stretches().map(|stretch| f64::from(stretch.end)).collect()))?;
        dict.set_item("hours", to_1d(py, stretches().map(SunStretch::hours).collect()))?;
        dict.set_item("state", stretches().map(|stretch| stretch.obstacle.name()).collect::<Vec<_>>())?;
        dict.set_item("object", stretches().map(object).collect::<Vec<_>>())?;
        dict.set_item("unproven_hours", to_1d(py, stretches().map(|stretch| stretch.unproven).collect()))?;
        Ok((dict, remarks_of(py, &answers.remarks)?))
    }

    /// Writes a report; returns its sentences and remarks.
    fn sunlight_report<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        keywords: ReportKeywords,
        days: Data<Days>,
        place: Data<SunPlace>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<String>, Remarks<'py>)> {
        let scene = Arc::clone(&self.0);
        let planned = keywords.planned.as_ref().map(|planned| Arc::clone(&planned.get().0));
        let params = keywords.params(&scene, days.0, place.0)?;
        let report = run(py, progress, move |control| sunlight_report(&scene, planned.as_deref(), &params, control))?;
        report.write(&path).map_err(exception)?;
        Ok((report.headlines(), remarks_of(py, &report.remarks)?))
    }
}
