//! Sky view and isovist here: how open a place is.

use super::context::RequestContext;
use super::places::{command_at, local, number};
use super::sun::target_at;
use crate::replies::{QuestionReply, Refusal};
use crate::scene_text::typed;
use belvedere::apps::ask::{self, IsovistsQuestion, Places, Remark, SkyViewQuestion, Standing};
use belvedere::cast::to_u8;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::sync::Arc;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AroundRequest {
    place: [f64; 3],
}

/// Range that is shown as the farthest, metres.
const FARTHEST: f32 = 200.0;

pub(super) fn answer(question: &AroundRequest, context: &RequestContext<'_>) -> Result<QuestionReply, Refusal> {
    let (scene, control) = (&context.scene.inner, context.control);
    let place = local(context, question.place)?;
    let eyes = Places::Eyes(vec![Standing { place, height: None }]);
    let isovists = ask::ask(scene, &IsovistsQuestion::default(), &eyes, control)?;
    let sky =
        ask::ask(scene, &SkyViewQuestion::default(), &Places::Targets(Arc::new(target_at(context, place))), control)?;
    let Some(isovist) = isovists.found.isovists.first().and_then(Option::as_ref) else {
        return Err(Refusal::Unanswerable("Nobody can look from this place.".to_owned()));
    };
    let figures: Map<String, Value> = isovist
        .figures(isovists.found.grid_north)
        .map(|figure| (figure.name.to_owned(), number(figure.value, i32::try_from(figure.decimals).unwrap_or(4))))
        .collect();
    let corners: Vec<Value> = isovist
        .plan
        .corners
        .iter()
        .map(|[azimuth, range]| json!([number(azimuth.to_degrees(), 3), number(*range, 2)]))
        .collect();
    let first = |name: &str| {
        let measure = sky.measures.iter().find(|measure| measure.name == name);
        measure.and_then(|measure| measure.values.first()).map_or(Value::Null, |&v| number(f64::from(v), 4))
    };
    let remarks: Vec<&Remark> = isovists.remarks.iter().chain(&sky.remarks).collect();
    let panorama = &isovist.panorama;
    let head = json!({
        "sky_view_factor": first("sky_view_factor"),
        "sky_openness": first("sky_openness"),
        "isovist": figures,
        "plan": corners,
        "panorama": { "width": panorama.width(), "height": panorama.height(), "farthest_m": FARTHEST },
        "remarks": remarks,
        "command": format!(
            "{}\n{}",
            command_at(context, question.place, "sky-view", "-o sky.csv"),
            context.text.command("isovist", &format!("--observer {} -o isovist.json", typed(&question.place))),
        ),
    });
    Ok(QuestionReply { head, body: panorama.values().iter().map(|&range| brightness(range)).collect() })
}

/// 0 for the sky, 1 for near things, 255 for far ones.
fn brightness(range: f32) -> u8 {
    if !range.is_finite() {
        return 0;
    }
    to_u8(f64::from((1.0 + 254.0 * (range.max(0.0) / FARTHEST).min(1.0).sqrt()).round()))
}
