//! Questions and answers of any kind.

use super::context::Context;
use super::mesh_levels::remarks_on_model;
use super::places::Places;
use super::reliability::remark_on_reliability;
use super::remark::Remark;
use super::report::Report;
use super::scene::Scene;
use super::sentences::sentences;
use super::survey::remarks_on_survey;
use crate::targets::Measure;
use belvedere_data::Result;
use belvedere_data::control::Control;

/// The answers to a question.
#[derive(Clone, Debug)]
pub struct Answers<F> {
    /// Results beside measures.
    pub found: F,
    /// A value for each target, of each thing that was measured.
    pub measures: Vec<Measure>,
    /// The answer in a few lines: the quantity computed, and its main figures.
    pub headline: Vec<String>,
    /// Warnings and notes.
    pub remarks: Vec<Remark>,
    /// All figures.
    pub report: Report,
}

/// Answers to a question of a type.
pub type Answered<Q> = Result<Answers<<Q as Ask>::Found>>;

/// A question.
pub trait Ask {
    /// Type of the results beside measures.
    type Found;

    /// Checks all that does not depend on a scene: hours of work may go into one.
    ///
    /// # Errors
    /// [`InvalidParameter`](belvedere_data::Error::InvalidParameter) for values that are not possible.
    fn check(&self) -> Result<()>;

    /// Finds the answers; remarks and further results go into `context`. Call [`ask`].
    ///
    /// # Errors
    /// Those of the question.
    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self>;
}

/// Puts a question about places to a scene.
///
/// # Errors
/// Those of the question: [`InvalidParameter`](belvedere_data::Error::InvalidParameter) for values that are not
/// possible, and [`Cancelled`](belvedere_data::Error::Cancelled).
pub fn ask<Q: Ask>(scene: &Scene, question: &Q, places: &Places, control: &Control<'_>) -> Answered<Q> {
    question.check()?;
    let mut context = Context::default();
    scene.whereabouts().remark(&mut context);
    context.add(scene.remark_on_terrain());
    context.add(scene.remark_on_ground_cloud());
    let of_survey = remarks_on_survey(&scene.model().findings(), scene.frame());
    remarks_on_model(scene.model()).into_iter().chain(of_survey).for_each(|remark| context.add(Some(remark)));
    context.add(remark_on_reliability(scene.model().parts()));
    let answers = question.answer(scene, places, &mut context, control)?;
    sentences(&context.report.at, &answers.measures).into_iter().for_each(|sentence| context.headline(sentence));
    Ok(answers.with(context))
}

impl<F> Answers<F> {
    /// Returns the zone of the clock that times and days were read by; `None` where there was none.
    #[must_use]
    pub fn time_zone(&self) -> Option<&str> {
        let of_suns = self.report.sun.as_ref().and_then(|sun| sun.time_zone.as_deref());
        of_suns.or_else(|| self.report.period.as_ref().map(|period| period.time_zone.as_str()))
    }

    /// Creates answers without the contents of a [`Context`].
    pub(super) fn new(found: F, measures: Vec<Measure>) -> Self {
        Self { found, measures, headline: Vec::new(), remarks: Vec::new(), report: Report::default() }
    }

    /// This with other results beside measures.
    pub(super) fn map<G>(self, results: impl FnOnce(F) -> G) -> Answers<G> {
        let Self { found, measures, headline, remarks, report } = self;
        Answers { found: results(found), measures, headline, remarks, report }
    }

    /// This with the contents of `context`.
    #[must_use]
    pub fn with(self, context: Context) -> Self {
        let Context { report, headline, remarks } = context;
        Self { report, headline, remarks, ..self }
    }
}

impl Context {
    /// Converts the report, headline and remarks into answers without anything else.
    #[must_use]
    pub fn into_answers(self) -> Answers<()> {
        Answers::new((), Vec::new()).with(self)
    }
}
