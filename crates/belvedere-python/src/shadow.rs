//! Shadow.

use crate::errors::wrong;
use crate::scene::{HowSureKeywords, PyScene};
use crate::sun::{SiteKeywords, SunChoice};
use crate::targets::{RequestedTargets, TargetResults, put_to_scene};
use crate::trees::Through;
use belvedere::apps::ask;
use belvedere::apps::shadow::Edges;
use belvedere::apps::targets::Measure;
use pyo3::prelude::*;
use std::sync::Arc;

#[pymethods]
impl PyScene {
    /// The share of each sun that reaches each target; of one sun with hard edges, also which light is unproven.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn shadow<'py>(
        &self,
        py: Python<'py>,
        suns: SunChoice,
        place: SiteKeywords,
        targets: RequestedTargets<'py>,
        edges: &str,
        trees: Through,
        how_sure: HowSureKeywords,
        casters: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<TargetResults<'py>>> {
        let edges = match edges {
            "hard" => Edges::Hard,
            "soft" => Edges::Soft,
            _ => return Err(wrong("edges", &format!("'{edges}'"), "use 'hard' or 'soft'")),
        };
        let question = ask::ShadowQuestion {
            suns: suns.into(),
            place: place.chosen()?,
            edges,
            trees: trees.chosen()?,
            unproven: None,
            how_sure: how_sure.into(),
            casters,
        };
        let scene = Arc::clone(&self.0);
        let chosen = targets.chosen(py, &scene)?;
        let places = chosen.places.clone();
        let answers = put_to_scene(py, progress, scene, question, places)?;
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
