//! Shadow.

use crate::errors::wrong;
use crate::scene::Scene;
use crate::sun::{Place, SunChoice};
use crate::targets::{Results, Wanted};
use crate::trees::Through;
use crate::work::run;
use belvedere::apps::rows::Obstacles;
use belvedere::apps::shadow::{Edges, LIT, scene_shadow};
use belvedere::apps::targets::{Measure, ResultKind};
use belvedere::query::UnprovenAs;
use pyo3::prelude::*;
use std::sync::Arc;

#[pymethods]
impl Scene {
    /// The share of each sun that reaches each target.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn shadow<'py>(
        &self,
        py: Python<'py>,
        suns: SunChoice,
        place: Place,
        targets: Wanted<'py>,
        edges: &str,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<Results<'py>>> {
        let edges = match edges {
            "hard" => Edges::Hard,
            "soft" => Edges::Soft,
            _ => return Err(wrong("edges", &format!("'{edges}'"), "use 'hard' or 'soft'")),
        };
        let inner = Arc::clone(&self.0);
        let asked = targets.owned(py, &inner)?;
        let suns = suns.suns(&inner, &place)?;
        let (lit, found, kind) = run(py, progress, move |control| {
            let found = asked.targets(&inner, control)?;
            let targets = &found.targets;
            let scene = inner.blockers(UnprovenAs::Visible, control)?;
            let trees = trees.of(&inner, control)?;
            let obstacles = Obstacles { scene: &scene, trees: trees.as_ref() };
            let looks = targets.len() * obstacles.matrix_count();
            let lit =
                control.stage("testing sun", looks, || scene_shadow(obstacles, targets, &suns, edges, control))?;
            let is_answer = edges == Edges::Hard && trees.is_none();
            let kind = if is_answer { ResultKind::Answer } else { ResultKind::Number };
            Ok((lit, found, kind))
        })?;
        lit.into_iter()
            .map(|values| found.results(py, vec![Measure::new("lit", values).with_description(LIT).with_kind(kind)]))
            .collect()
    }
}
