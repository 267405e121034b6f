//! Glare.

use crate::observers::standing_observers;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::result_columns::{NamedColumns, to_python};
use crate::scene::PyScene;
use crate::windows::{WindowRow, given};
use belvedere::apps::ask;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

#[pymethods]
impl PyScene {
    /// Columns of pairs, those by hour, and remarks.
    fn glare<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::GlareQuestion>,
        reflectors: Vec<WindowRow>,
        names: Vec<String>,
        observers: PyReadonlyArray2<'py, f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(NamedColumns<'py>, NamedColumns<'py>, Remarks<'py>)> {
        let question = ask::GlareQuestion { reflectors: given(&reflectors, self.0.frame()), ..question.0 };
        let eyes = ask::Places::Eyes(standing_observers(&observers, &self.0)?);
        let answers = self.ask(py, progress, question, eyes)?;
        let found = &answers.found;
        let columns = to_python(py, found.columns(&names))?;
        Ok((columns, to_python(py, found.columns_by_hour())?, remarks_of(py, &answers.remarks)?))
    }
}
