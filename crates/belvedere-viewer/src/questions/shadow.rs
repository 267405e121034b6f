//! Shadow at this time: for each point of the cloud whether the sun reaches it.

use super::Asked;
use super::places::rounded;
use crate::replies::{Answer, Refusal};
use crate::scene::Points;
use belvedere::apps::shadow::{Edges, ShadowSun, scene_shadow};
use belvedere::apps::sun::{Refraction, Zone, parse_instant, sun_position_with};
use belvedere::apps::tree_light::Season;
use belvedere::query::UnprovenAs;
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Question {
    /// Date and time on the clocks of the zone, such as 2026-06-21T15:00.
    time: String,
    /// Name of a zone, or hours from UTC.
    zone: String,
    #[serde(default)]
    points: Points,
}

/// Value of a point in shadow, and of one that is lit, and of one without an answer.
const CODES: [u8; 3] = [0, 1, 255];

pub(super) fn answer(question: &Question, asked: &Asked<'_>) -> Result<Answer, Refusal> {
    let (scene, control) = (asked.scene, asked.control);
    let points = scene.points(question.points, control)?;
    let site = scene.site()?;
    let zone = Zone::parse(&question.zone)?;
    let instant = parse_instant(&question.time, Some(&zone))?;
    let position = sun_position_with(&site, instant, Refraction::default())?;
    let sun = ShadowSun {
        to_sun: position.to_sun(&site),
        season: zone.date_at(instant).ok().map(|date| Season::on(date, &site)),
    };
    let blockers = scene.blockers(UnprovenAs::Visible, control)?;
    let lit = scene_shadow(&*blockers, &points.targets, &[sun], Edges::Hard, control)?.pop().unwrap_or_default();
    let lit_count = lit.iter().filter(|&&share| share > 0.0).count();
    let head = json!({
        "points": points.targets.len(),
        "lit": lit_count,
        "azimuth_deg": rounded(position.azimuth.to_degrees(), 4),
        "elevation_deg": rounded(position.elevation.to_degrees(), 4),
        "to_sun": position.to_sun(&site),
        "time": zone.display(instant),
        "command": asked.text.shadow(&question.time, zone.name()),
    });
    let code = |row: usize| match lit.get(row) {
        Some(share) if *share > 0.0 => CODES[1],
        Some(0.0) => CODES[0],
        _ => CODES[2],
    };
    Ok(Answer { head, body: points.in_order(code) })
}
