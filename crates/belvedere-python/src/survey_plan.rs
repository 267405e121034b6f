//! Survey plan: stations for another scan.

use crate::arrays::{to_1d, to_2d};
use crate::observers::standing_pairs;
use crate::planning::PyTable;
use crate::question::Data;
use crate::remarks::remarks_of;
use crate::scene::PyScene;
use crate::targets::RequestedTargets;
use belvedere::apps::ask::{Candidates, GivenCamera, PlannedStation, SurveyPlanQuestion};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl PyScene {
    /// Columns of the candidates that can be used, and remarks. Candidates are x, y and z in the coordinates of the
    /// file, z NaN where it follows from the ground, with the number of the line that each is a place on; `None` for
    /// those of the question. Without targets, `cells` are what suns are to light.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn survey_plan<'py>(
        &self,
        py: Python<'py>,
        question: Data<SurveyPlanQuestion>,
        candidates: Option<Vec<([f64; 3], Option<usize>)>>,
        observers: PyReadonlyArray2<'py, f64>,
        targets: PyReadonlyArray2<'py, f64>,
        cells: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyTable<'py>> {
        let mut question = question.0;
        let given = |(place, line): ([f64; 3], Option<usize>)| GivenCamera {
            place: self.0.frame().local_from_file(place),
            line,
            ..GivenCamera::default()
        };
        if let Some(places) = candidates {
            question.candidates = Candidates::Given(places.into_iter().map(given).collect());
        }
        let pairs = standing_pairs(&observers, &targets, &self.0)?;
        let places = if question.suns.is_some() { cells.chosen(py, &self.0)?.places } else { pairs };
        let answers = self.ask(py, progress, question, places)?;
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
