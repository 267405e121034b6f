//! Certainty of answers: a probability for each, and the uncertain ones.

use super::context::Context;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::CertaintySection;
use super::trees::ThroughTrees;
use crate::targets::{Measure, ResultKind};
use crate::viewshed::SeenProbabilities;
use belvedere_core::query::{Certainty, MedialScene, Proof, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::report::percent;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Name of the measure that says how likely a target is visible or lit.
pub const PROBABILITY: &str = "probability";
/// Name of the measure that says which answers are uncertain.
pub const UNCERTAIN: &str = "uncertain";

/// Name of the measure of the expected number of observers.
pub const EXPECTED: &str = "expected";

/// Description of [`PROBABILITY`].
pub const BEING_FREE: &str = "probability of being free";
/// Description of [`EXPECTED`].
pub const EXPECTED_OBSERVERS: &str = "expected number of observers";

/// Request for the certainty of answers. Needs pulses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct HowSure {
    /// True to give the probability, 0 to 1, that a target is visible or lit. Default: false.
    pub probability: bool,
    /// Minimum probability, above 0.5 and at most 1, of the more likely answer, below which an answer is uncertain; so
    /// are unproven answers. `None` to leave that out.
    pub certain: Option<f64>,
}

impl HowSure {
    /// Returns true if probabilities are needed.
    #[must_use]
    pub fn is_wanted(&self) -> bool {
        self.probability || self.certain.is_some()
    }

    /// Refuses a least probability out of range.
    pub(super) fn check(&self) -> Result<()> {
        self.certainty().map(|_| ())
    }

    /// Refuses a scene without pulses, where probabilities are wanted.
    pub(super) fn check_scene(&self, scene: &Scene) -> Result<()> {
        if self.is_wanted() { scene.check_pulses(Parameter::Certainty) } else { Ok(()) }
    }

    /// Refuses answers without probabilities: `value`, the reason being `expected`.
    pub(super) fn check_without(&self, value: &str, expected: &'static str) -> Result<()> {
        if !self.is_wanted() {
            return Ok(());
        }
        Err(Error::invalid(Parameter::Certainty, value, expected))
    }

    /// The certainty below which answers are uncertain.
    pub(super) fn certainty(&self) -> Result<Option<Certainty>> {
        self.certain.map(Certainty::new).transpose()
    }

    /// Returns the obstacles, with the pulses that probabilities need; `None` if these are not wanted.
    pub(super) fn blockers(
        &self,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Option<Arc<MedialScene>>> {
        if !self.is_wanted() {
            return Ok(None);
        }
        self.check_scene(scene)?;
        let blockers = scene.blockers(UnprovenAs::Reported, control)?;
        context.add(remark_from_ground(&blockers));
        Ok(Some(blockers))
    }

    /// Flags the uncertain answers, by their probability and by whether they are unproven; NaN for a proven answer
    /// without a probability. `None` if that is not wanted.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a least probability out of range.
    pub fn uncertain(&self, probabilities: &[f32], is_unproven: impl Fn(usize) -> bool) -> Result<Option<Vec<f32>>> {
        let Some(certainty) = self.certainty()? else { return Ok(None) };
        let of_row = |(row, &probability): (usize, &f32)| match (is_unproven(row), probability.is_nan()) {
            (true, _) => 1.0,
            (false, true) => f32::NAN,
            (false, false) => f32::from(u8::from(certainty.is_missed_by(probability))),
        };
        Ok(Some(probabilities.iter().enumerate().map(of_row).collect()))
    }

    /// Measures of probabilities, and of which answers are `uncertain`; `suffix` ends their names.
    #[must_use]
    pub fn measures(&self, probabilities: Vec<f32>, uncertain: Option<Vec<f32>>, suffix: &str) -> Vec<Measure> {
        let named = |name: &str, values, text: &'static str| {
            Measure::new(&format!("{name}{suffix}"), values).with_description(text).with_range(Some([0.0, 1.0]))
        };
        let likely = self.probability.then(|| named(PROBABILITY, probabilities, BEING_FREE).with_decimals(3));
        let uncertain = uncertain.map(|uncertain| {
            named(UNCERTAIN, uncertain, "1: less certain than wanted").with_decimals(0).with_kind(ResultKind::Answer)
        });
        likely.into_iter().chain(uncertain).collect()
    }

    /// Returns the measures of the view of several observers.
    #[must_use]
    pub fn measures_of_many(&self, found: SeenProbabilities) -> Vec<Measure> {
        let likely = self
            .probability
            .then(|| Measure::new(EXPECTED, found.expected).with_description(EXPECTED_OBSERVERS).with_decimals(3));
        let uncertain = found.uncertain.map(|uncertain| {
            let (text, kind) = ("observers that are uncertain", ResultKind::Count);
            Measure::new(UNCERTAIN, uncertain).with_description(text).with_decimals(0).with_kind(kind)
        });
        likely.into_iter().chain(uncertain).collect()
    }

    /// Summarises the certainty of answers with these probabilities of being visible or lit, of which some are
    /// unproven.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a least probability out of range.
    pub fn section(&self, probabilities: &[f32], is_unproven: impl Fn(usize) -> bool) -> Result<CertaintySection> {
        let uncertain = self.uncertain(probabilities, is_unproven)?;
        Ok(self.section_of(probabilities, uncertain.as_deref()))
    }

    fn section_of(&self, probabilities: &[f32], uncertain: Option<&[f32]>) -> CertaintySection {
        let is_uncertain = |row: usize| uncertain.is_some_and(|uncertain| uncertain.get(row).is_some_and(|&v| v > 0.0));
        let is_answer = |(row, probability): &(usize, f32)| !probability.is_nan() || is_uncertain(*row);
        let answers: Vec<(usize, f32)> = probabilities.iter().copied().enumerate().filter(is_answer).collect();
        let count = answers.len();
        let section = CertaintySection {
            answers: count,
            mean_probability: belvedere_data::report::rounded(mean(probabilities), 4),
            ..CertaintySection::default()
        };
        if uncertain.is_none() {
            return section;
        }
        let certain = |is_high: bool| {
            answers.iter().filter(|(row, probability)| !is_uncertain(*row) && (*probability > 0.5) == is_high).count()
        };
        CertaintySection {
            certain_from: self.certain,
            certainly_visible_percent: Some(percent(certain(true), count)),
            certainly_blocked_percent: Some(percent(certain(false), count)),
            uncertain_percent: Some(percent(answers.iter().filter(|(row, _)| is_uncertain(*row)).count(), count)),
            ..section
        }
    }

    /// Says the same of measures of one viewer or sun, where some say it.
    pub(super) fn summarise_measures(&self, measures: &[Measure], words: [&str; 2], context: &mut Context) {
        let of_name = |name: &str| measures.iter().find(|measure| measure.name == name).map(|measure| &measure.values);
        let (probabilities, uncertain) = (of_name(PROBABILITY), of_name(UNCERTAIN));
        if let Some(probabilities) = probabilities {
            self.summarise(probabilities, uncertain.map(Vec::as_slice), words, context);
        }
    }

    /// Reports the certainty of the answers of one viewer or sun: `visible` names the outcome that a high probability
    /// makes likely.
    pub(super) fn summarise(
        &self,
        probabilities: &[f32],
        uncertain: Option<&[f32]>,
        [visible, blocked]: [&str; 2],
        context: &mut Context,
    ) {
        let section = self.section_of(probabilities, uncertain);
        let CertaintySection { certain_from, certainly_visible_percent: high, .. } = section;
        let (low, left) = (section.certainly_blocked_percent, section.uncertain_percent);
        context.headline(match (certain_from, high, low, left) {
            (Some(least), Some(high), Some(low), Some(left)) => format!(
                "with a certainty of {} % and more: {high} % {visible}, {low} % {blocked}; {left} % uncertain",
                belvedere_data::report::rounded(100.0 * least, 2)
            ),
            _ => format!("expected: {:.1} % {visible}", 100.0 * mean(probabilities)),
        });
        context.report.certainty = Some(section);
    }
}

/// Mean of the values that are not NaN, 0 where all are.
fn mean(probabilities: &[f32]) -> f64 {
    let known = probabilities.iter().filter(|probability| !probability.is_nan());
    let count = known.clone().count();
    known.map(|&probability| f64::from(probability)).sum::<f64>() / count.max(1) as f64
}

/// A warning of probabilities where scanners stood on the ground: much of such a scene was not seen at all.
#[must_use]
pub fn remark_from_ground(blockers: &MedialScene) -> Option<Remark> {
    let text = "the scanner stood on the ground and saw one side of things: probabilities are left out where nothing \
                blocks and no pulse came within 1 m";
    let is_from_ground = blockers.proof().is_some_and(Proof::is_from_ground);
    is_from_ground.then(|| Remark::warning("probability-from-the-ground", text))
}

/// Refuses intervals where light gets through trees: they are those of errors among opaque ones.
///
/// # Errors
/// [`Error::InvalidParameter`].
pub fn check_interval(is_wanted: bool, trees: &ThroughTrees) -> Result<()> {
    if !is_wanted || !trees.is_light() {
        return Ok(());
    }
    let expected = "left out: how far such light may be from the truth is not known";
    Err(Error::invalid(Parameter::Interval, "given with light through trees", expected))
}

/// Returns true if the error of sums of a scene is known: the scene has pulses from the air. Intervals follow from
/// errors of balls that such pulses carved. For scanners on the ground three truths in four would lie outside.
///
/// # Errors
/// Those of [`Scene::blockers`].
pub fn knows_intervals(scene: &Scene, control: &Control<'_>) -> Result<bool> {
    if let Some(parts) = scene.parts() {
        return Ok(parts.proves());
    }
    let has_pulses = scene.model().pulses().is_some();
    Ok(has_pulses && !scene.blockers(UnprovenAs::Reported, control)?.proof().is_some_and(Proof::is_from_ground))
}

/// Refuses intervals of scenes for which they are not known.
pub(super) fn check_interval_scene(is_wanted: bool, scene: &Scene, control: &Control<'_>) -> Result<()> {
    if !is_wanted {
        return Ok(());
    }
    scene.check_pulses(Parameter::Interval)?;
    if scene.parts().and_then(|parts| parts.crowns()).is_some_and(|crowns| crowns.gives_shares()) {
        return Err(Error::invalid(Parameter::Interval, "given", "left out where light gets through trees"));
    }
    if knows_intervals(scene, control)? {
        return Ok(());
    }
    let expected = "left out: only errors of surveys from the air are known";
    Err(Error::invalid(Parameter::Interval, "given for a scanner on the ground", expected))
}
