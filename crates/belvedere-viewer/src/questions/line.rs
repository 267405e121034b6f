//! Is B seen from A: the answer, the place that blocks, and the profile.

use super::context::RequestContext;
use super::places::{local, number, rounded, shown};
use crate::replies::{QuestionReply, Refusal};
use crate::scene_text::typed;
use belvedere::PatchKind;
use belvedere::apps::ask::{self, HowSure, LinesOfSightQuestion, Places, ProfileRows, Standing};
use belvedere::apps::profile::SightProfile;
use belvedere::query::Answer as Sight;
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LineRequest {
    observer: [f64; 3],
    target: [f64; 3],
}

pub(super) fn answer(question: &LineRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let ends = [local(context, question.observer)?, local(context, question.target)?];
    let [observer, target] = ends;
    if observer == target {
        return Err(Refusal::Unanswerable("A and B are the same place: click two different ones.".to_owned()));
    }
    let is_vertical = observer[..2] == target[..2];
    let how_sure = HowSure { probability: context.scene.model().pulses().is_some(), certain: None };
    let profile = (!is_vertical).then(ProfileRows::default);
    let line = LinesOfSightQuestion { profile, how_sure, ..LinesOfSightQuestion::default() };
    let pair = ends.map(|place| Standing { place, height: None });
    let answers = ask::ask(&context.scene.inner, &line, &Places::Pairs(vec![pair]), context.control)?;
    let (found, remarks) = (answers.found, answers.remarks);
    let sight = found.sights.first().and_then(Option::as_ref);
    let name = match found.answers.first() {
        Some(Sight::Visible) => "visible",
        Some(Sight::Blocked) => "blocked",
        Some(Sight::Unproven) => "unproven",
        Some(Sight::InsideObstacle) => "inside an obstacle",
        _ => "outside the cloud",
    };
    let block = sight.and_then(|sight| sight.first_block).map(|block| {
        json!({ "range_m": rounded(block.range, 3), "place": shown(context, block.place), "ball": block.blocker.ball(),
            "surface": block.blocker.patch().map(PatchKind::name) })
    });
    let unproven = sight.filter(|_| found.is_proof_tested).map(|sight| number(sight.unproven_length, 3));
    let probability = found.sure.first().and_then(|measure| measure.values.first()).filter(|value| value.is_finite());
    let probability = probability.map(|&value| number(f64::from(value), 3));
    let typed = format!("--observer {} --target {}", typed(&question.observer), typed(&question.target));
    let length = observer.iter().zip(target).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let head = json!({
        "answer": name,
        "length_m": rounded(length, 3),
        "first_block": block,
        "unproven_m": unproven,
        "probability": probability,
        "profile": found.profile.as_ref().map(|profile| drawn(profile, context)),
        "remarks": remarks,
        "command": context.text.command_on_ground("line-of-sight", &format!("{typed} -o line.csv --profile-out profile.png")),
    });
    Ok(QuestionReply::of(head))
}

/// Distances, the ground, the line and the obstacles, in heights of the file.
fn drawn(profile: &SightProfile, context: &RequestContext<'_>) -> Value {
    let frame = context.scene.model().frame();
    let height = |local: f64| (local + frame.origin[2]) / frame.crs.vertical_metres_per_unit;
    let heights = |values: &[f64]| values.iter().map(|&v| number(height(v), 2)).collect::<Vec<_>>();
    let solid: Vec<Value> = profile
        .solid
        .iter()
        .map(|pieces| {
            pieces.iter().map(|piece| piece.map(|v| rounded(height(v), 2)).to_vec()).collect::<Vec<_>>().into()
        })
        .collect();
    json!({
        "distance_m": profile.distances.iter().map(|&v| rounded(v, 3)).collect::<Vec<_>>(),
        "ground": heights(&profile.ground),
        "line": heights(&profile.line),
        "solid": solid,
        "blocked_at_m": profile.blocked_at.map(|v| rounded(v, 3)),
    })
}
