//! Scenario: the scene with the drawn plan, for the questions that follow.

use super::context::RequestContext;
use crate::plans::DrawnPlan;
use crate::replies::{QuestionReply, Refusal};
use belvedere::apps::ask::remark_on_cleared;
use belvedere::cloud::to_local;
use serde_json::{Value, json};

pub(super) fn answer(plan: DrawnPlan, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let is_clearing = plan.is_clearing();
    let planned = context.plans.make(plan, context.scene, context.text, context.control)?;
    let files: Vec<Value> = planned.files.iter().map(|(name, text)| json!({ "name": name, "content": text })).collect();
    let origin = context.scene.model().frame().origin;
    let corners = planned
        .added
        .iter()
        .flat_map(|mesh| (0..mesh.triangles.len()).filter_map(|index| mesh.corners(index)).flatten());
    let triangles: Vec<u8> = corners.flat_map(|corner| to_local(corner, origin)).flat_map(f32::to_le_bytes).collect();
    let head = json!({
        "plan": planned.number,
        "points_cleared": planned.report.points_cleared,
        "remarks": is_clearing.then(|| remark_on_cleared(planned.report.points_cleared)).flatten().as_slice(),
        "triangle_bytes": triangles.len(),
        "files": files,
        "command": planned.text.input,
    });
    // the triangles, and for each point sent 1 if it is cleared
    Ok(QuestionReply { head, body: [triangles, planned.scene.cleared_in_order()].concat() })
}
