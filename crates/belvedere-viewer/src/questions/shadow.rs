//! Shadow at this time: for each point of the cloud whether the sun reaches it. First from a depth map, while the time is moved, then exact.

use super::Asked;
use super::places::{command, rounded};
use crate::replies::{Answer, Refusal};
use belvedere::apps::shadow::{Edges, ShadowSun, scene_shadow};
use belvedere::apps::sun::{Refraction, Zone, parse_instant, sun_position_with};
use belvedere::apps::tree_light::Season;
use belvedere::depth::{ItemBuffer, depth_map};
use belvedere::query::points::query_points;
use belvedere::query::{Answer as Sight, UnprovenAs};
use belvedere::view::{View, default_pixel_size};
use serde::Deserialize;
use serde_json::json;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Question {
    /// Date and time on the clocks of the zone, such as 2026-06-21T15:00.
    time: String,
    /// Name of a zone, or hours from UTC.
    zone: String,
    /// Whether each line to the sun is tested; a depth map answers sooner.
    #[serde(default = "super::yes")]
    exact: bool,
}

/// Most pixels of a depth map along the longest side of the scene: more take longer than a tenth of a second.
const PIXELS: f64 = 1200.0;

/// Value of a point in shadow, and of one that is lit, and of one without an answer.
const CODES: [u8; 3] = [0, 1, 255];

pub(super) fn answer(question: &Question, asked: &Asked<'_>) -> Result<Answer, Refusal> {
    let (scene, control) = (asked.scene, asked.control);
    scene.cloud()?;
    let site = scene.site()?;
    let zone = Zone::parse(&question.zone)?;
    let instant = parse_instant(&question.time, Some(&zone))?;
    let position = sun_position_with(&site, instant, Refraction::default())?;
    let head = json!({
        "azimuth_deg": rounded(position.azimuth.to_degrees(), 4),
        "elevation_deg": rounded(position.elevation.to_degrees(), 4),
        "to_sun": position.to_sun(&site),
        "time": zone.display(instant),
        "command": command_of(asked, &question.time, zone.name()),
    });
    if !question.exact {
        let lit = by_depth_map(asked, position.to_sun(&site))?;
        let code = |row: usize| match lit.get(row) {
            Some(Sight::Visible) => CODES[1],
            Some(Sight::Blocked) => CODES[0],
            _ => CODES[2],
        };
        return Ok(Answer { head, body: scene.shown.chunks.in_order(code) });
    }
    let sun = ShadowSun {
        to_sun: position.to_sun(&site),
        season: zone.date_at(instant).ok().map(|date| Season::on(date, &site)),
    };
    let blockers = scene.blockers(UnprovenAs::Visible, control)?;
    let lit = scene_shadow(&*blockers, scene.points(), &[sun], Edges::Hard, control)?.pop().unwrap_or_default();
    let code = |row: usize| match lit.get(row) {
        Some(share) if *share > 0.0 => CODES[1],
        Some(0.0) => CODES[0],
        _ => CODES[2],
    };
    Ok(Answer { head, body: scene.shown.chunks.in_order(code) })
}

/// The command for the points of the cloud, which a ball file has beside it.
fn command_of(asked: &Asked<'_>, time: &str, zone: &str) -> String {
    let points = asked.text.cloud_beside.as_ref().map_or("--self".to_owned(), |cloud| format!("--targets {cloud}"));
    command(asked, "shadow", &format!("--time {time} --zone {zone} {points} -o shadow.laz"))
}

/// What a depth map from the sun says of the points of the cloud: right but for edges and slopes.
fn by_depth_map(asked: &Asked<'_>, to_sun: [f64; 3]) -> belvedere::Result<Vec<Sight>> {
    let scene = asked.scene;
    let (low, high) = scene.model.bounds().corners();
    let side = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    let pixel = default_pixel_size(low, high).max(side / PIXELS);
    let view = View::parallel(to_sun.map(|v| -v), low, high, pixel)?;
    let profile = scene.model.rule().profile;
    let map = depth_map(scene.model.balls(), &view, profile, ItemBuffer::Without, asked.control)?;
    Ok(query_points(&map, &scene.shown.cloud.positions, map.default_depth_bias()))
}
