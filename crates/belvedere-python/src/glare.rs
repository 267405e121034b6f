//! Glare.

use crate::observers::standing_observers;
use crate::remarks::remarks_of;
use crate::result_columns::{NamedColumns, to_python};
use crate::scene::PyScene;
use crate::sky::DaysKeywords;
use crate::sun::SiteKeywords;
use crate::targets::ground_points;
use crate::windows::{WindowRow, given};
use crate::work::run;
use belvedere::apps::ask::{self, GivenWindows};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Reflectors, and who looks.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct GlareKeywords {
    reflectors: Vec<WindowRow>,
    names: Vec<String>,
    observer_height: Option<f64>,
    ground: Option<String>,
    scatter_deg: Option<f64>,
    from_sun_deg: Option<f64>,
}

/// Columns of pairs, those by hour, and remarks.
type GlareReply<'py> = (NamedColumns<'py>, NamedColumns<'py>, Vec<Bound<'py, PyDict>>);

#[pymethods]
impl PyScene {
    fn glare<'py>(
        &self,
        py: Python<'py>,
        keywords: GlareKeywords,
        observers: PyReadonlyArray2<'py, f64>,
        days: DaysKeywords,
        place: SiteKeywords,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<GlareReply<'py>> {
        let scene = Arc::clone(&self.0);
        let reflectors = match given(&keywords.reflectors, scene.frame()) {
            GivenWindows::Each(reflectors) => reflectors,
            GivenWindows::Faces(_) => Vec::new(),
        };
        let question = ask::GlareQuestion {
            reflectors,
            observer_height: keywords.observer_height,
            ground: ground_points(keywords.ground.as_deref())?,
            days: days.chosen(),
            place: place.chosen()?,
            scatter_deg: keywords.scatter_deg,
            from_sun_deg: keywords.from_sun_deg,
        };
        let eyes = ask::Places::Eyes(standing_observers(&observers, &scene)?);
        let answers = run(py, progress, move |control| ask::ask(&scene, &question, &eyes, control))?;
        let found = &answers.found;
        let columns = to_python(py, found.columns(&keywords.names))?;
        Ok((columns, to_python(py, found.columns_by_hour())?, remarks_of(py, &answers.remarks)?))
    }
}
