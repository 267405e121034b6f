//! What is seen from here: an answer for each point of the cloud.

use super::Asked;
use super::places::{command_on_ground, local, typed};
use crate::replies::{Answer, Refusal};
use crate::scene::Inside;
use belvedere::apps::viewshed::{Observer, SightLimits, ViewshedParams, viewshed_among};
use belvedere::query::{AnswerCounts, UnprovenAs};
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Question {
    /// The eye, in the coordinates of the file.
    place: [f64; 3],
    /// Whether pulses tell visible from unproven; without them the answer comes sooner.
    #[serde(default = "super::yes")]
    proven: bool,
}

pub(super) fn answer(question: &Question, asked: &Asked<'_>) -> Result<Answer, Refusal> {
    let (scene, control) = (asked.scene, asked.control);
    let eye = local(asked, question.place)?;
    let cloud = scene.cloud()?;
    let unproven = if question.proven { UnprovenAs::Reported } else { UnprovenAs::Visible };
    let blockers = scene.blockers(unproven, control)?;
    let ground = scene.ground(control)?;
    scene.check_eye(&blockers, Some(&ground), eye, Inside::Refused)?;
    let observer = Observer { eye, limits: SightLimits::default() };
    let params = ViewshedParams::default().with_unproven(unproven);
    let seen = viewshed_among(&blockers, &[observer], &cloud.positions, scene.tree(), &params, control)?;
    let counts = AnswerCounts::of(&seen.answers);
    let flags = if question.proven { "" } else { "--unproven as-visible " };
    let head = json!({
        "visible": counts.visible,
        "blocked": counts.blocked,
        "unproven": counts.unproven,
        "tells_unproven": question.proven && blockers.proof().is_some(),
        "command": command_on_ground(asked, "viewshed", &format!("--observer {} {flags}-o seen.laz", typed(&question.place))),
    });
    Ok(Answer { head, body: scene.shown.chunks.in_order(|row| seen.answers[row] as u8) })
}
