//! The page as one file that needs no server: its points, and the shadows of the hours of a day.

use crate::chunks::Chunks;
use crate::page;
use crate::scene::{Scene, Shown};
use crate::server::SceneText;
use belvedere::apps::shadow::{Edges, ShadowSun, scene_shadow};
use belvedere::apps::sun::{Date, Refraction, SunPosition, Zone, sun_position_with};
use belvedere::apps::targets::Targets;
use belvedere::apps::tree_light::Season;
use belvedere::control::Control;
use belvedere::model::SceneModel;
use belvedere::query::UnprovenAs;
use belvedere::report::rounded;
use belvedere::{PointCloud, Result};
use serde::Serialize;
use serde_json::{Value, json};
use std::sync::Arc;

/// Most points of a file: it then has 35 MB, which browsers open in a second.
const MOST_POINTS: usize = 3_000_000;
const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// What a file shows.
#[derive(Clone, Debug)]
pub struct ExportParams {
    /// What the page is called.
    pub title: String,
    /// The scene in the command lines that the page shows.
    pub scene: SceneText,
    /// The day whose shadows are in the file, and how its clocks run; `None` for a file without shadows.
    pub day: Option<(Date, Zone)>,
}

/// What is in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ExportReport {
    /// Points in the file.
    pub points: usize,
    /// Points of the cloud that are not: more than 3 million would make the file too large to open.
    pub points_left_out: usize,
    /// Hours of the day whose shadows are in the file.
    pub suns: usize,
}

/// The page of a cloud and its model as one file.
///
/// # Errors
/// [`belvedere::Error::MissingAttribute`] for a day without a known location, and [`belvedere::Error::Cancelled`].
pub fn export(
    cloud: &Arc<PointCloud>,
    model: SceneModel,
    params: &ExportParams,
    control: &Control<'_>,
) -> Result<(String, ExportReport)> {
    let chunks = Chunks::new(cloud).sample(MOST_POINTS);
    let shown = Arc::new(Shown::of(Arc::clone(cloud), chunks));
    let scene = Scene::new(model, Arc::clone(&shown));
    let suns = match &params.day {
        Some((date, zone)) => suns(&scene, *date, zone, &params.scene, control)?,
        None => Vec::new(),
    };
    let numbers = 0..shown.chunks.chunks.len();
    let of_chunks = |bytes: &dyn Fn(usize) -> Option<Vec<u8>>| -> Vec<String> {
        numbers.clone().filter_map(bytes).map(|bytes| base64(&bytes)).collect()
    };
    let points = shown.chunks.len();
    let report = ExportReport { points, points_left_out: cloud.len() - points, suns: suns.len() };
    let mut description = shown.description.clone();
    description["point_count"] = points.into();
    let data = json!({
        "state": { "title": params.title, "stage": "", "total": 0, "done": 0, "failure": null, "shown": description, "scene": scene.describe() },
        "date": params.day.as_ref().map(|(date, _)| date.to_string()),
        "zone": params.day.as_ref().map(|(_, zone)| zone.name()),
        "points": of_chunks(&|number| shown.chunks.points(number, cloud)),
        "colors": of_chunks(&|number| shown.chunks.colors(number, cloud)),
        "suns": suns,
    });
    Ok((html(&data), report))
}

/// The suns of the whole hours of a day, and a bit for each point in the order in which points are sent: 1 for lit.
fn suns(scene: &Scene, date: Date, zone: &Zone, text: &SceneText, control: &Control<'_>) -> Result<Vec<Value>> {
    let site = scene.site()?;
    let mut hours = Vec::new();
    for hour in 0..24 {
        // an hour that clocks skip has no sun
        let Ok(instant) = zone.instant_of(date, f64::from(hour)) else { continue };
        let position = sun_position_with(&site, instant, Refraction::default())?;
        if position.elevation > 0.0 {
            hours.push((hour, zone.display(instant), position));
        }
    }
    let season = Some(Season::on(date, &site));
    let kinds: Vec<ShadowSun> =
        hours.iter().map(|(_, _, position)| ShadowSun { to_sun: position.to_sun(&site), season }).collect();
    let mut sent = PointCloud::in_frame(scene.model.frame().clone());
    sent.positions = scene.shown.chunks.positions(&scene.shown.cloud);
    let blockers = scene.blockers(UnprovenAs::Visible, control)?;
    let targets = Targets::of_points(&sent, None);
    let lit = scene_shadow(&*blockers, &targets, &kinds, Edges::Hard, control)?;
    let points = text.cloud_beside.as_ref().map_or("--self".to_owned(), |cloud| format!("--targets {cloud}"));
    let of_hour = |((hour, time, position), lit): (&(i32, String, SunPosition), &Vec<f32>)| {
        json!({
            "minutes": 60 * hour,
            "time": time,
            "azimuth_deg": rounded(position.azimuth.to_degrees(), 4),
            "elevation_deg": rounded(position.elevation.to_degrees(), 4),
            "command": format!("belvedere shadow {} --time {date}T{hour:02}:00 --zone {} {points} -o shadow.laz", text.input, zone.name()),
            "bits": base64(&bits(lit)),
        })
    };
    Ok(hours.iter().zip(&lit).map(of_hour).collect())
}

/// A bit for each share, 1 where it is above 0, lowest bits first.
fn bits(shares: &[f32]) -> Vec<u8> {
    let byte = |eight: &[f32]| (0..).zip(eight).fold(0, |byte, (i, &share)| byte | u8::from(share > 0.0) << i);
    shares.chunks(8).map(byte).collect()
}

fn base64(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = (0..3).fold(0_u32, |word, i| word << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let digit = ALPHABET[(word >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= three.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

/// The page with everything in it.
fn html(data: &Value) -> String {
    let text = |path| page::file(path).map(|(_, bytes)| String::from_utf8_lossy(bytes)).unwrap_or_default();
    let icon = format!("data:image/svg+xml;base64,{}", base64(text("icon.svg").as_bytes()));
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
    use super::{base64, bits};

    #[test]
    fn bytes_become_text_as_rfc_4648_says() {
        let texts = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
        for (length, text) in texts.into_iter().enumerate() {
            assert_eq!(base64(&b"foobar"[..length]), text);
        }
        assert_eq!(base64(&[0xFB, 0xFF]), "+/8=");
    }

    #[test]
    fn lit_points_have_their_bit() {
        assert_eq!(bits(&[1.0, 0.0, f32::NAN, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0]), [0b1001, 1]);
    }
}
