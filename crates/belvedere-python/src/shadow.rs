//! Shadow.

use crate::question::Data;
use crate::scene::PyScene;
use crate::targets::{RequestedTargets, TargetResults};
use belvedere::apps::ask;
use belvedere::apps::targets::Measure;
use pyo3::prelude::*;

#[pymethods]
impl PyScene {
    /// The share of each sun that reaches each target; of one sun with hard edges, also which light is unproven.
    fn shadow<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::ShadowQuestion>,
        targets: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<TargetResults<'py>>> {
        let chosen = targets.chosen(py, &self.0)?;
        let answers = self.ask(py, progress, question.0, chosen.places.clone())?;
        let (found, mut measures) = (answers.found, answers.measures);
        let further = measures.split_off(found.suns.len().min(measures.len()));
        let is_one = found.suns.len() == 1;
        let mut remarks = Some(answers.remarks);
        measures
            .into_iter()
            .zip(&found.suns)
            .map(|(mut lit, sun)| {
                lit.name = "lit".to_owned();
                // what is said of all suns is said once
                let remarks = remarks.take().unwrap_or_default();
                let suffix = if is_one { String::new() } else { format!("_{}", sun.column) };
                let of_sun = further.iter().filter_map(|measure| {
                    let name = measure.name.strip_suffix(&suffix)?.to_owned();
                    Some(Measure { name, ..measure.clone() })
                });
                let of_sun = std::iter::once(lit).chain(of_sun).collect();
                chosen.results(py, &found.on.targets, of_sun, &remarks)
            })
            .collect()
    }
}
