//! Reliability of answers on a survey, in words, and in the scene that keeps it.

use super::{Answers, Context, Remark};
use crate::resampling::Interval;
use crate::survey_reliability::{PlacesReliability, ReliabilityParams, SurveyReliability, survey_reliability};
use belvedere_core::model::ModelParams;
use belvedere_data::control::Control;
use belvedere_data::model::ModelParts;
use belvedere_data::{PointCloud, Result};

/// Prefix of the names of [`kept_reliability`] in a scene.
const KEPT_UNDER: &str = "reliability_";
/// Fewer tiles than this give no interval worth its name.
const MIN_TILES: usize = 10;

/// Measures how reliable answers on a survey are, with a share of its pulses kept out: [`survey_reliability`] with
/// headline and remarks.
///
/// # Errors
/// Those of [`survey_reliability`].
pub fn calibrate(
    cloud: &PointCloud,
    model: &ModelParams,
    params: &ReliabilityParams,
    control: &Control<'_>,
) -> Result<Answers<SurveyReliability>> {
    let found = survey_reliability(cloud, model, params, control)?;
    let mut context = Context::default();
    let [free, hidden] = [&found.free_paths, &found.hidden_places].map(|places| places.answered_count());
    let has_classes = [found.hidden_places.wrong_percent_at.ground, found.hidden_places.wrong_percent_at.building];
    let has_classes = has_classes.iter().any(Option::is_some);
    let behind = if has_classes { "ground and buildings" } else { "last returns" };
    context.headline(format!(
        "of {free} free paths of pulses kept out {} are called blocked; of {hidden} hidden places 1 m behind {behind} {} \
         are called visible or unproven",
        in_words(found.free_paths.wrong_percent),
        in_words(found.hidden_places.wrong_percent)
    ));
    if let Some(probabilities) = &found.probabilities {
        context.headline(format!(
            "where these lines end in the open, answers with a certainty of {:.0} % and more are {} % of all, and {} of \
             them are wrong",
            100.0 * probabilities.certain_from,
            probabilities.certain_percent,
            in_words(probabilities.certain_wrong_percent)
        ));
    } else {
        let text = "probabilities were not measured: the scene has no pulses, because its balls are not carved";
        context.add(Some(Remark::note("no-probabilities", text)));
    }
    let text = "pulses kept out test directions from the scanner only, and their neighbours were used: places that the \
                scanner hardly saw are less reliable";
    context.add(Some(Remark::note("directions-of-the-scanner", text)));
    if !has_classes {
        let text = "points have no classes of ground and buildings: hidden places lie behind trees too, where a part of \
                    the light may pass";
        context.add(Some(Remark::note("places-behind-trees", text)));
    }
    let few = format!("intervals rest on only {} tiles of 25 m: they are too narrow", found.tiles);
    context.add((found.tiles < MIN_TILES).then(|| Remark::warning("few-tiles", few).with("count", found.tiles as f64)));
    context.report.reliability = Some(found.clone());
    Ok(Answers::new(found, Vec::new()).with(context))
}

/// A percentage with its interval, such as "9.2 % (8.6 to 9.8 %)".
fn in_words(percent: Option<Interval>) -> String {
    match percent {
        Some(Interval { value, low, high }) => format!("{value} % ({low} to {high} %)"),
        None => "none".to_owned(),
    }
}

impl PlacesReliability {
    fn answered_count(&self) -> usize {
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
