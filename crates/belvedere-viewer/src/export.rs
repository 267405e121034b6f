//! The page as one file that needs no server: its points, the shadows of the hours of a day, and the views from
//! viewpoints.

use crate::chunks::Chunks;
use crate::page;
use crate::scene::{PageScene, ShownCloud};
use crate::scene_text::{SceneText, typed};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use belvedere::apps::ask::{
    self, HowSure, Places, SOLAR, ShadowQuestion, SunPlace, ThroughTrees, UNPROVEN, remarks_on_model,
};
use belvedere::apps::eyes::fault_of;
use belvedere::apps::sun::{Date, Refraction, Zone, sun_position_with};
use belvedere::apps::targets::{Targets, set_on_ground};
use belvedere::apps::viewshed::{OBSERVER_HEIGHT, Observer, SightLimits, ViewshedParams, viewshed};
use belvedere::control::Control;
use belvedere::model::SceneModel;
use belvedere::query::{Answer, AnswerCounts, UnprovenAs};
use belvedere::report::rounded;
use belvedere::{Error, Parameter, PointCloud, Result};
use serde::Serialize;
use serde_json::{Value, json};
use std::sync::Arc;

/// Maximum number of points of a file: it then has 35 MB, which browsers open in a second.
const MAX_POINTS: usize = 3_000_000;

/// Content of a file.
#[derive(Clone, Debug)]
pub struct ExportParams {
    /// Title of the page.
    pub title: String,
    /// The scene in the command lines that the page shows.
    pub scene: SceneText,
    /// The day whose shadows are in the file, and how its clocks run; `None` for a file without shadows.
    pub day: Option<(Date, Zone)>,
    /// Eyes whose views are in the file, in the coordinates of the cloud's file; 1.7 m above the ground where z is NaN.
    pub viewpoints: Vec<[f64; 3]>,
    /// Remarks on the files and the scene, shown beside every answer.
    pub remarks: Vec<Value>,
}

/// Counts of the content of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ExportReport {
    /// Points in the file.
    pub points: usize,
    /// Points of the cloud that are not: more than 3 million would make the file too large to open.
    pub points_left_out: usize,
    /// Hours of the day whose shadows are in the file.
    pub suns: usize,
    /// Viewpoints whose views are in the file.
    pub viewpoints: usize,
}

/// The page of a cloud and its model as one file.
///
/// # Errors
/// [`Error::MissingAttribute`] for a day without a known location, [`Error::InvalidParameter`] for a viewpoint that
/// nobody can look from, and [`Error::Cancelled`].
pub fn export(
    cloud: &Arc<PointCloud>,
    model: SceneModel,
    params: &ExportParams,
    control: &Control<'_>,
) -> Result<(String, ExportReport)> {
    let chunks = Chunks::new(cloud).sample(MAX_POINTS);
    let mut remarks = params.remarks.clone();
    // remarks are maps of texts and numbers, which JSON holds
    remarks.extend(remarks_on_model(&model).iter().filter_map(|remark| serde_json::to_value(remark).ok()));
    let shown = Arc::new(ShownCloud::of(Arc::clone(cloud), chunks));
    let scene = PageScene::new(model, Arc::clone(&shown));
    let mut sent = PointCloud::in_frame(scene.model().frame().clone());
    sent.positions = scene.shown.chunks.positions(&scene.shown.cloud);
    let suns = match &params.day {
        Some((date, zone)) => suns(&scene, &sent, (*date, zone), &params.scene, control)?,
        None => Vec::new(),
    };
    let viewpoints = viewpoints(&scene, &sent, params, control)?;
    let numbers = 0..shown.chunks.chunks.len();
    let of_chunks = |bytes: &dyn Fn(usize) -> Option<Vec<u8>>| -> Vec<String> {
        numbers.clone().filter_map(bytes).map(|bytes| BASE64_STANDARD.encode(&bytes)).collect()
    };
    let points = shown.chunks.len();
    let report =
        ExportReport { points, points_left_out: cloud.len() - points, suns: suns.len(), viewpoints: viewpoints.len() };
    let mut description = shown.description.clone();
    description["point_count"] = points.into();
    let data = json!({
        "state": { "title": params.title, "stage": "", "total": 0, "done": 0, "failure": null, "remarks": remarks, "shown": description, "scene": scene.describe() },
        "date": params.day.as_ref().map(|(date, _)| date.to_string()),
        "zone": params.day.as_ref().map(|(_, zone)| zone.name()),
        "points": of_chunks(&|number| shown.chunks.points(number, cloud)),
        "colors": of_chunks(&|number| shown.chunks.colors(number, cloud)),
        "suns": suns,
        "viewpoints": viewpoints,
    });
    Ok((html(&data), report))
}

/// The suns of the whole hours of a day, and two bits for each point in the order in which points are sent. They are 0
/// in shadow, 1 lit, 2 lit but unproven, 3 without an answer.
fn suns(
    scene: &PageScene,
    sent: &PointCloud,
    (date, zone): (Date, &Zone),
    text: &SceneText,
    control: &Control<'_>,
) -> Result<Vec<Value>> {
    let site = scene.site()?;
    let typed_zone = if zone.is_mean_solar() { SOLAR } else { zone.name() };
    let targets = Places::Targets(Arc::new(Targets::of_points(sent, None)));
    let mut found = Vec::new();
    for hour in 0..24 {
        // an hour that clocks skip has no sun
        let Ok(instant) = zone.instant_of(date, f64::from(hour)) else { continue };
        let position = sun_position_with(&site, instant, Refraction::default())?;
        if position.elevation <= 0.0 {
            continue;
        }
        let time = zone.display(instant);
        let question = ShadowQuestion {
            place: SunPlace { zone: Some(typed_zone.to_owned()), ..SunPlace::default() },
            ..ShadowQuestion::of_times(vec![time.clone()])
        };
        let answers = ask::ask(&scene.inner, &question, &targets, control)?;
        let measure = |name: &str| answers.measures.iter().find(|measure| measure.name == name).map(|m| &m.values[..]);
        let (lit, unproven) = (measure("lit").unwrap_or_default(), measure(UNPROVEN));
        let is_unproven = |row: usize| unproven.and_then(|unproven| unproven.get(row)).is_some_and(|&is| is > 0.0);
        let code = |(row, &share): (usize, &f32)| match share {
            share if share > 0.0 => {
                if is_unproven(row) {
                    2
                } else {
                    1
                }
            }
            0.0 => 0,
            _ => 3,
        };
        let codes: Vec<u8> = lit.iter().enumerate().map(code).collect();
        let count = |wanted: &[u8]| codes.iter().filter(|code| wanted.contains(code)).count();
        let typed_time: String = time.chars().take("2026-06-21T15:00".len()).collect();
        found.push(json!({
            "minutes": 60 * hour,
            "time": zone.display(instant),
            "azimuth_deg": rounded(position.azimuth.to_degrees(), 4),
            "elevation_deg": rounded(position.elevation.to_degrees(), 4),
            "lit": count(&[1, 2]),
            "unproven": unproven.map(|_| count(&[2])),
            "tells_unproven": unproven.is_some(),
            "remarks": answers.remarks,
            "command": text.shadow(&typed_time, typed_zone, ThroughTrees::Opaque, HowSure::default()),
            "answers": BASE64_STANDARD.encode(packed(&codes, 2, |&code| code)),
        }));
    }
    Ok(found)
}

/// The viewpoints, and two bits for each point in the order in which points are sent: 0 blocked, 1 visible, 2 unproven,
/// 3 no answer.
fn viewpoints(
    scene: &PageScene,
    sent: &PointCloud,
    params: &ExportParams,
    control: &Control<'_>,
) -> Result<Vec<Value>> {
    if params.viewpoints.is_empty() {
        return Ok(Vec::new());
    }
    let frame = scene.model().frame();
    let mut eyes: Vec<[f64; 3]> = params.viewpoints.iter().map(|&place| frame.local_from_file(place)).collect();
    let known = scene.ground(control)?;
    let ground = &known.ground;
    set_on_ground(eyes.iter_mut().map(|eye| (eye, OBSERVER_HEIGHT)), ground);
    let blockers = scene.blockers(UnprovenAs::Reported, control)?;
    let of_eye = |(&eye, place): (&[f64; 3], &[f64; 3])| {
        // without z the height follows from the ground
        let place = if place[2].is_nan() { &place[..2] } else { &place[..] };
        if let Some(fault) = fault_of(&blockers, Some(ground), eye) {
            let value = format!("{} ({fault})", typed(place));
            let expected = "inside the cloud, above the ground and outside obstacles";
            return Err(Error::invalid(Parameter::Viewpoint, value, expected));
        }
        let observer = Observer { eye, limits: SightLimits::default() };
        let seen = viewshed(&blockers, &[observer], &sent.positions, &ViewshedParams::default(), control)?;
        let counts = AnswerCounts::of(&seen.answers);
        Ok(json!({
            "place": frame.file_from_local(eye).map(|v| rounded(v, 3)),
            "visible": counts.visible,
            "blocked": counts.blocked,
            "unproven": counts.unproven,
            "tells_unproven": blockers.proof().is_some(),
            "command": params.scene.seen_points(place, HowSure::default()),
            "answers": BASE64_STANDARD.encode(packed(&seen.answers, 2, |&answer| (answer as u8).min(Answer::OutsideView as u8))),
        }))
    };
    eyes.iter().zip(&params.viewpoints).map(of_eye).collect()
}

/// Packs values into `width` bits each, lowest bits first.
fn packed<T>(values: &[T], width: usize, code: impl Fn(&T) -> u8) -> Vec<u8> {
    let byte = |some: &[T]| (0..).step_by(width).zip(some).fold(0, |byte, (shift, value)| byte | code(value) << shift);
    values.chunks(8 / width).map(byte).collect()
}

/// The page with everything in it.
fn html(data: &Value) -> String {
    let text = |path| page::file(path).map(|(_, bytes)| String::from_utf8_lossy(bytes)).unwrap_or_default();
    let icon = format!("data:image/svg+xml;base64,{}", BASE64_STANDARD.encode(&*text("icon.svg")));
    // a text in the data must not end its element
    let data = data.to_string().replace("</", "<\\/");
    text("index.html")
        .replace("<link rel=\"stylesheet\" href=\"style.css\">", &format!("<style>\n{}</style>", text("style.css")))
        .replace("icon.svg", &icon)
        .replace(
            "<script src=\"page.js\"></script>",
            &format!(
                "<script type=\"application/json\" id=\"exported\">{data}</script>\n<script>{}</script>",
                text("page.js").replace("</script", "<\\/script")
            ),
        )
}

#[cfg(test)]
mod tests {
    use super::packed;

    #[test]
    fn values_have_their_bits() {
        assert_eq!(packed(&[1, 0, 0, 1, 0, 0, 0, 0, 1], 1, |&bit| bit), [0b1001, 1]);
        assert_eq!(packed(&[1, 0, 2, 3, 2], 2, |&code| code), [0b1110_0001, 2]);
    }
}
