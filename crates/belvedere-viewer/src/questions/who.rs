//! Who sees this: the cells from which a person would see the place.

use super::Asked;
use super::places::local;
use crate::replies::{Answer, Refusal};
use crate::scene::Inside;
use crate::scene_text::typed;
use belvedere::apps::targets::{CellParams, Targets};
use belvedere::apps::viewshed::{OBSERVER_HEIGHT, Observer, SightLimits, ViewshedParams, tested_height, viewshed};
use belvedere::query::{AnswerCounts, UnprovenAs};
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Question {
    place: [f64; 3],
}

pub(super) fn answer(question: &Question, asked: &Asked<'_>) -> Result<Answer, Refusal> {
    let (scene, control) = (asked.scene, asked.control);
    let place = local(asked, question.place)?;
    let cloud = scene.cloud()?;
    let known = scene.ground(control)?;
    let ground = &known.ground;
    let blockers = scene.blockers(UnprovenAs::Reported, control)?;
    scene.check_eye(&blockers, None, place, Inside::Allowed)?;
    let grid = ground.grid;
    let cells = CellParams::default().with_height(tested_height(OBSERVER_HEIGHT));
    let (mut targets, _) = Targets::of_cells(cloud, ground.clone(), &cells, control)?;
    if let Some(added) = blockers.added() {
        targets.set_on_added(added, &cells);
    }
    let target = Observer { eye: place, limits: SightLimits::default() };
    let seen = viewshed(&blockers, &[target], &targets.positions, &ViewshedParams::default(), control)?;
    let counts = AnswerCounts::of(&seen.answers);
    let low = grid.center(0, 0);
    let head = json!({
        "visible": counts.visible,
        "blocked": counts.blocked,
        "unproven": counts.unproven,
        "visible_m2": super::places::rounded(counts.visible as f64 * grid.cell * grid.cell, 1),
        "grid": { "first_center": low, "cell_m": grid.cell, "columns": grid.width, "rows": grid.height },
        "command": asked.text.command_on_ground("viewshed", &format!("--target {} -o who.tif", typed(&question.place))),
    });
    let heights = ground.heights.values().iter().flat_map(|height| height.to_le_bytes());
    let answers = seen.answers.iter().map(|&answer| answer as u8);
    Ok(Answer { head, body: heights.chain(answers).collect() })
}
