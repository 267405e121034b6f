//! Sky view and isovist here: how open a place is.

use super::Asked;
use super::places::{command_at, local, number};
use super::sun::at;
use crate::replies::{Answer, Refusal};
use crate::scene::Inside;
use crate::scene_text::typed;
use belvedere::apps::isovist::{IsovistParams, isovist};
use belvedere::apps::sky_view::{SKY_DIRECTIONS, SkyDirections, scene_sky_view};
use belvedere::query::UnprovenAs;
use serde::Deserialize;
use serde_json::{Map, Value, json};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Question {
    place: [f64; 3],
}

/// Range that is shown as the farthest, metres.
const FARTHEST: f32 = 200.0;

pub(super) fn answer(question: &Question, asked: &Asked<'_>) -> Result<Answer, Refusal> {
    let (scene, control) = (asked.scene, asked.control);
    let place = local(asked, question.place)?;
    let blockers = scene.blockers(UnprovenAs::Visible, control)?;
    scene.check_eye(&blockers, None, place, Inside::Refused)?;
    let sky = scene_sky_view(&*blockers, &at(asked, place), &SkyDirections::even(SKY_DIRECTIONS)?, control)?;
    let isovist = isovist(&blockers, place, &IsovistParams::default(), control)?;
    let north = scene.grid_north(None);
    let figures: Map<String, Value> = isovist
        .figures(north)
        .map(|figure| (figure.name.to_owned(), number(figure.value, i32::try_from(figure.decimals).unwrap_or(4))))
        .collect();
    let corners: Vec<Value> = isovist
        .plan
        .corners
        .iter()
        .map(|[azimuth, range]| json!([number(azimuth.to_degrees(), 3), number(*range, 2)]))
        .collect();
    let first = |values: &[f32]| values.first().map_or(Value::Null, |&v| number(f64::from(v), 4));
    let panorama = &isovist.panorama;
    let head = json!({
        "sky_view_factor": first(&sky.factors),
        "sky_openness": first(&sky.openness),
        "isovist": figures,
        "plan": corners,
        "panorama": { "width": panorama.width(), "height": panorama.height(), "farthest_m": FARTHEST },
        "command": format!(
            "{}\n{}",
            command_at(asked, question.place, "sky-view", "-o sky.csv"),
            asked.text.command("isovist", &format!("--observer {} -o isovist.json", typed(&question.place))),
        ),
    });
    Ok(Answer { head, body: panorama.values().iter().map(|&range| brightness(range)).collect() })
}

/// 0 for the sky, 1 for what is near, 255 for what is far.
fn brightness(range: f32) -> u8 {
    if !range.is_finite() {
        return 0;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 255")]
    let code = (1.0 + 254.0 * (range.max(0.0) / FARTHEST).min(1.0).sqrt()).round() as u8;
    code
}
