//! Shadow at this time: for each point of the cloud whether the sun reaches it, and how likely.

use super::certainty::{byte_of, how_sure};
use super::context::RequestContext;
use super::places::rounded;
use crate::replies::{QuestionReply, Refusal};
use crate::scene::PointChoice;
use belvedere::apps::ask::{self, PROBABILITY, Places, SunPlace, SunPositionQuestion, Suns, ThroughTrees, UNPROVEN};
use belvedere::apps::shadow::Edges;
use serde::Deserialize;
use serde_json::json;
use std::sync::Arc;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShadowRequest {
    /// Date and time on the clocks of the zone, such as 2026-06-21T15:00.
    time: String,
    /// Name of a zone, or hours from UTC.
    zone: String,
    #[serde(default)]
    points: PointChoice,
    /// Light through trees.
    #[serde(default)]
    trees: ThroughTrees,
    /// True to give the probability that a point is lit too.
    #[serde(default)]
    probability: bool,
}

/// Value of a point in shadow, of one that is lit, of one that is lit as far as the points show but unproven, and of
/// one without an answer.
const CODES: [u8; 4] = [0, 1, 2, 255];

pub(super) fn answer(question: &ShadowRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let (scene, control) = (context.scene, context.control);
    let points = scene.points(question.points, control)?;
    let place = SunPlace { zone: Some(question.zone.clone()), ..SunPlace::default() };
    let times = vec![question.time.clone()];
    let of_sun = SunPositionQuestion { times: times.clone(), place: place.clone() };
    let of_sun = ask::ask(&scene.inner, &of_sun, &Places::Scene, control)?.found;
    let how_sure = how_sure(question.probability);
    let shadow = ask::ShadowQuestion {
        suns: Suns::Times(times),
        place,
        edges: Edges::Hard,
        trees: question.trees,
        unproven: None,
        how_sure,
        casters: false,
    };
    let answers = ask::ask(&scene.inner, &shadow, &Places::Targets(Arc::clone(&points.targets)), control)?;
    let measure = |name: &str| answers.measures.iter().find(|measure| measure.name == name).map(|m| &m.values[..]);
    let (lit, unproven) = (measure("lit").unwrap_or_default(), measure(UNPROVEN));
    let probabilities = measure(PROBABILITY);
    let is_unproven = |row: usize| unproven.and_then(|unproven| unproven.get(row)).is_some_and(|&is| is > 0.0);
    let lit_count = lit.iter().filter(|&&share| share > 0.0).count();
    let unproven_count = unproven.map(|unproven| unproven.iter().filter(|&&is| is > 0.0).count());
    let (Some(sun), Some(stands)) = (answers.found.suns.first(), of_sun.first()) else {
        return Err(Refusal::Unanswerable("There is no sun at this time.".to_owned()));
    };
    let head = json!({
        "points": points.targets.len(),
        "lit": lit_count,
        "unproven": unproven_count,
        "tells_unproven": unproven.is_some(),
        "azimuth_deg": rounded(stands.azimuth_deg, 4),
        "elevation_deg": rounded(stands.elevation_deg, 4),
        "to_sun": sun.sun.to_sun,
        "time": stands.time,
        "certainty": answers.report.certainty,
        "remarks": answers.remarks,
        "command": context.text.shadow(&question.time, &question.zone, question.trees, how_sure),
    });
    let code = |row: usize| match lit.get(row) {
        Some(share) if *share > 0.0 => CODES[if is_unproven(row) { 2 } else { 1 }],
        Some(0.0) => CODES[0],
        _ => CODES[3],
    };
    let mut body = points.in_order(code);
    body.extend(probabilities.map(|values| points.in_order(|row| byte_of(values[row]))).unwrap_or_default());
    Ok(QuestionReply { head, body })
}
