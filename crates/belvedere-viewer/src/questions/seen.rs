//! Visibility from an eye: an answer for each point of the cloud, and its probability.

use super::certainty::{byte_of, how_sure};
use super::context::RequestContext;
use super::places::local;
use crate::replies::{QuestionReply, Refusal};
use crate::scene::PointChoice;
use belvedere::apps::ask::remark_from_ground;
use belvedere::apps::viewshed::{Observer, SightLimits, ViewshedParams, seen_probabilities, viewshed_among};
use belvedere::query::{Answer, AnswerCounts, UnprovenAs};
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SeenRequest {
    /// The eye, in the coordinates of the file.
    place: [f64; 3],
    #[serde(default)]
    points: PointChoice,
    /// True to give the probability that a point is visible too.
    #[serde(default)]
    probability: bool,
}

pub(super) fn answer(question: &SeenRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let (scene, control) = (context.scene, context.control);
    let eye = local(context, question.place)?;
    let points = scene.points(question.points, control)?;
    let blockers = scene.blockers(UnprovenAs::Reported, control)?;
    let ground = scene.ground(control)?;
    scene.check_eye(&blockers, &ground.ground, eye)?;
    let observer = Observer { eye, limits: SightLimits::default() };
    let params = ViewshedParams::default();
    let seen = viewshed_among(&blockers, &[observer], &points.targets.positions, &points.tree, &params, control)?;
    let counts = AnswerCounts::of(&seen.answers);
    let how_sure = how_sure(question.probability);
    let probabilities = how_sure
        .is_wanted()
        .then(|| seen_probabilities(&blockers, &[observer], &points.targets.positions, None, control))
        .transpose()?
        .map(|found| found.expected);
    let is_unproven = |row: usize| seen.answers[row] == Answer::Unproven;
    let head = json!({
        "points": points.targets.len(),
        "visible": counts.visible,
        "blocked": counts.blocked,
        "unproven": counts.unproven,
        "tells_unproven": blockers.proof().is_some(),
        "certainty": probabilities.as_deref().map(|values| how_sure.section(values, is_unproven)).transpose()?,
        "remarks": how_sure.is_wanted().then(|| remark_from_ground(&blockers)).flatten().as_slice(),
        "command": context.text.seen_points(&question.place, how_sure),
    });
    let mut body = points.in_order(|row| seen.answers[row] as u8);
    body.extend(probabilities.map(|values| points.in_order(|row| byte_of(values[row]))).unwrap_or_default());
    Ok(QuestionReply { head, body })
}
