//! What is seen from here: an answer for each point of the cloud.

use super::RequestContext;
use super::places::local;
use crate::replies::{QuestionReply, Refusal};
use crate::scene::PointChoice;
use belvedere::apps::viewshed::{Observer, SightLimits, ViewshedParams, viewshed_among};
use belvedere::query::{AnswerCounts, UnprovenAs};
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SeenRequest {
    /// The eye, in the coordinates of the file.
    place: [f64; 3],
    #[serde(default)]
    points: PointChoice,
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
    let head = json!({
        "points": points.targets.len(),
        "visible": counts.visible,
        "blocked": counts.blocked,
        "unproven": counts.unproven,
        "tells_unproven": blockers.proof().is_some(),
        "command": context.text.seen(&question.place),
    });
    Ok(QuestionReply { head, body: points.in_order(|row| seen.answers[row] as u8) })
}
