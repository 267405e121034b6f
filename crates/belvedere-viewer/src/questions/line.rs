//! Is B seen from A: the answer, the place that blocks, and the profile.

use super::Asked;
use super::places::{local, number, rounded, shown};
use crate::replies::{Answer, Refusal};
use crate::scene_text::typed;
use belvedere::apps::profile::sight_profile;
use belvedere::query::{Answer as Sight, EarthParams, UnprovenAs};
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Question {
    observer: [f64; 3],
    target: [f64; 3],
}

pub(super) fn answer(question: &Question, asked: &Asked<'_>) -> Result<Answer, Refusal> {
    let (scene, control) = (asked.scene, asked.control);
    let [observer, target] = [local(asked, question.observer)?, local(asked, question.target)?];
    let blockers = scene.blockers(UnprovenAs::Reported, control)?;
    let earth = EarthParams::default();
    let Some(sight) = blockers.line_of_sight(observer, target, &earth) else {
        return Err(Refusal("A and B are the same place: click two different ones.".to_owned()));
    };
    let name = match sight.answer {
        Sight::Visible => "visible",
        Sight::Blocked => "blocked",
        Sight::Unproven => "unproven",
        _ => "outside the cloud",
    };
    let block = sight.first_block.map(
        |block| json!({ "range_m": rounded(block.range, 3), "place": shown(asked, block.place), "ball": block.blocker.ball() }),
    );
    let ends = format!("--observer {} --target {}", typed(&question.observer), typed(&question.target));
    let length = observer.iter().zip(target).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let head = json!({
        "answer": name,
        "length_m": rounded(length, 3),
        "first_block": block,
        "unproven_m": if scene.model().pulses().is_some() { number(sight.unproven_length, 3) } else { Value::Null },
        "profile": profile(asked, [observer, target], &earth),
        "command": asked.text.command_on_ground("line-of-sight", &format!("{ends} -o line.csv --profile-out profile.png")),
    });
    Ok(Answer::of(head))
}

/// Distances, the ground, the line and what is solid, in heights of the file; null for a vertical line.
fn profile(asked: &Asked<'_>, pair: [[f64; 3]; 2], earth: &EarthParams) -> Value {
    let scene = asked.scene;
    let made = scene.blockers(UnprovenAs::Reported, asked.control).and_then(|blockers| {
        let ground = if scene.cloud().is_err() { None } else { Some(scene.ground(asked.control)?) };
        sight_profile(&blockers, ground.as_deref().map(|known| &known.ground), pair, earth, None, asked.control)
    });
    let Ok(profile) = made else { return Value::Null };
    let frame = scene.model().frame();
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
