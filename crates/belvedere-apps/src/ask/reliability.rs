//! Reliability of answers on a survey, in words, and in the scene that keeps it.

use super::remark::Remark;
use crate::resampling::Interval;
use crate::survey_reliability::{PlacesReliability, SurveyReliability};
use belvedere_data::model::ModelParts;

/// Prefix of the names of [`kept_reliability`] in a scene.
const KEPT_UNDER: &str = "reliability_";

impl PlacesReliability {
    pub(super) fn answered_count(&self) -> usize {
        self.answers.visible + self.answers.unproven + self.answers.blocked
    }
}

/// The numbers that a scene keeps, by name.
fn kept_numbers(found: &SurveyReliability) -> Vec<(&'static str, f64)> {
    let [blocked, visible] = [&found.free_paths, &found.hidden_places];
    let certain = found.probabilities.as_ref().and_then(|probabilities| probabilities.certain_wrong_percent);
    let counts = [blocked, visible].map(|places| Some(places.answered_count() as f64));
    let low = |percent: Option<Interval>| percent.map(|percent| percent.low);
    let high = |percent: Option<Interval>| percent.map(|percent| percent.high);
    let value = |percent: Option<Interval>| percent.map(|percent| percent.value);
    let numbers = [
        value(blocked.wrong_percent),
        low(blocked.wrong_percent),
        high(blocked.wrong_percent),
        value(visible.wrong_percent),
        low(visible.wrong_percent),
        high(visible.wrong_percent),
        value(certain),
        counts[0],
        counts[1],
    ];
    NUMBERS.into_iter().zip(numbers).filter_map(|(name, number)| Some((name, number?))).collect()
}

/// Names of the numbers that a scene keeps.
const NUMBERS: [&str; 9] = [
    "false_blocked_percent",
    "false_blocked_low_percent",
    "false_blocked_high_percent",
    "false_visible_percent",
    "false_visible_low_percent",
    "false_visible_high_percent",
    "certain_wrong_percent",
    "free_paths",
    "hidden_places",
];

/// The parts of a scene with the reliability measured on its survey: ball files keep it, and questions to such a scene
/// have a remark with it.
#[must_use]
pub fn with_reliability(parts: ModelParts, found: &SurveyReliability) -> ModelParts {
    let keep = |parts: ModelParts, (name, number): (&str, f64)| {
        parts.with_provenance(&format!("{KEPT_UNDER}{name}"), number.to_string())
    };
    kept_numbers(found).into_iter().fold(parts, keep)
}

/// Returns a remark on the reliability measured on the survey of a scene, if the scene keeps it.
pub(super) fn remark_on_reliability(parts: &ModelParts) -> Option<Remark> {
    let number = |name: &str| parts.provenance.get(&format!("{KEPT_UNDER}{name}"))?.parse::<f64>().ok();
    let (blocked, visible) = (number(NUMBERS[0])?, number(NUMBERS[3])?);
    let certain =
        number(NUMBERS[6]).map(|wrong| format!("; {wrong} % of the answers that are at least 90 % certain are wrong"));
    let text = format!(
        "measured on this survey, with pulses kept out: {blocked} % of free paths are called blocked, {visible} % of \
         hidden places visible or unproven{}",
        certain.unwrap_or_default()
    );
    let numbers = NUMBERS.into_iter().filter_map(|name| Some((name, number(name)?))).collect();
    Some(Remark { numbers, ..Remark::note("reliability-measured", text) })
}
