//! Measurement of the reliability of answers on a survey.

use super::answers::Answers;
use super::context::Context;
use super::remark::Remark;
use crate::resampling::Interval;
use crate::survey_reliability::{ReliabilityParams, SurveyReliability, survey_reliability};
use belvedere_core::model::ModelParams;
use belvedere_data::control::Control;
use belvedere_data::{PointCloud, Result};

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
