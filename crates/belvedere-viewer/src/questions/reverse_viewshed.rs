//! Reverse viewshed: the cells from which a person would see the place.

use super::context::RequestContext;
use super::places::{local, rounded};
use crate::replies::{QuestionReply, Refusal};
use crate::scene_text::typed;
use belvedere::apps::ask::{self, Places, Standing, StandingObserver, ViewLimits, ViewshedQuestion, ViewshedTargets};
use belvedere::query::AnswerCounts;
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WhoSeesRequest {
    place: [f64; 3],
}

pub(super) fn answer(question: &WhoSeesRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let standing = Standing { place: local(context, question.place)?, height: None };
    let viewshed = ViewshedQuestion {
        observers: vec![StandingObserver { standing, limits: ViewLimits::default() }],
        reverse: true,
        targets: vec![ViewshedTargets::Cells],
        ..ViewshedQuestion::default()
    };
    let answers = ask::ask(&context.scene.inner, &viewshed, &Places::Scene, context.control)?;
    let (ground, seen) = (&answers.found.ground.ground, answers.found.cells.as_ref());
    let cells = seen.map_or(&[][..], |seen| &seen.answers);
    let (grid, counts) = (ground.grid, AnswerCounts::of(cells));
    let head = json!({
        "visible": counts.visible,
        "blocked": counts.blocked,
        "unproven": counts.unproven,
        "visible_m2": rounded(counts.visible as f64 * grid.cell * grid.cell, 1),
        "grid": { "first_center": grid.center(0, 0), "cell_m": grid.cell, "columns": grid.width, "rows": grid.height },
        "remarks": answers.remarks,
        "command": context.text.command_on_ground("viewshed", &format!("--target {} -o who.tif", typed(&question.place))),
    });
    let heights = ground.heights.values().iter().flat_map(|height| height.to_le_bytes());
    Ok(QuestionReply { head, body: heights.chain(cells.iter().map(|&answer| answer as u8)).collect() })
}
