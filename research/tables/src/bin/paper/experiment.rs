//! The paper's experiment: a million random targets in the bounding box, one viewport, and what the profile changes.

use crate::Tables;
use crate::model::PaperModel;
use belvedere::Result;
use belvedere::control::Control;
use belvedere::depth::{DepthMap, ItemBuffer, Profile, depth_map};
use belvedere::query::{Answer, AnswerCounts, query_points, random_targets};
use belvedere::view::{View, to_sun};
use std::time::Instant;

/// As many targets as in the paper.
const TARGET_COUNT: usize = 1_000_000;
const SEED: u64 = 1;
/// How far the picture plane is moved back, metres: farther than the largest ball reaches in front of the scene, so
/// that both profiles see every ball whole.
const SET_BACK: f64 = 500.0;

/// A view of a model with the answers to the random targets.
pub(crate) struct Look {
    pub(crate) map: DepthMap,
    pub(crate) targets: Vec<[f32; 3]>,
    /// Sphere, bias 0.
    pub(crate) answers: Vec<Answer>,
}

/// Along `forward`, just holding the points of `model`.
pub(crate) fn parallel_to(model: &PaperModel, forward: [f64; 3], pixels_per_unit: f64) -> Result<View> {
    let mut view = View::parallel(forward, model.low.map(f64::from), model.high.map(f64::from), 1.0 / pixels_per_unit)?;
    for axis in 0..3 {
        view.frame.eye[axis] -= SET_BACK * view.frame.forward[axis];
    }
    Ok(view)
}

/// Straight down, north up.
pub(crate) fn top_down(model: &PaperModel, pixels_per_unit: f64) -> Result<View> {
    parallel_to(model, [0.0, 0.0, -1.0], pixels_per_unit)
}

/// From an azimuth and elevation, degrees.
pub(crate) fn oblique(model: &PaperModel, viewer: [f64; 2], pixels_per_unit: f64) -> Result<View> {
    let [azimuth, elevation] = viewer.map(f64::to_radians);
    parallel_to(model, to_sun(azimuth, elevation).map(|v| -v), pixels_per_unit)
}

/// Depth maps and answers by the cone and the sphere for each view, as a table.
pub(crate) fn compare_profiles(model: &PaperModel, views: &[(&str, View)], tables: &mut Tables) -> Result<Vec<Look>> {
    let targets = random_targets(model.low, model.high, TARGET_COUNT, SEED);
    for (name, view) in views {
        let Some(s) = view.pixels_per_metre() else { continue };
        let show = |v: [f64; 3]| format!("({:.2}, {:.2}, {:.2})", v[0], v[1], v[2]);
        let [width, height] = view.size_px.map(|v| v as f64 / s);
        tables.line(&format!(
            "{name}: p0 {}, vx {}, vy {}, s {s}, {} x {} pixels",
            show(model.cloud.frame.to_file_coordinates(view.frame.eye.map(|v| v as f32))),
            show(view.frame.right.map(|v| v * width)),
            show(view.frame.down.map(|v| v * height)),
            view.size_px[0],
            view.size_px[1]
        ));
    }
    tables.line(
        "\n| view | visible, cone | visible, sphere | visible, sphere with bias | changed | of blocked targets | \
         cone blocks, sphere does not | depth map cone / sphere | queries |",
    );
    tables.line("|---|---|---|---|---|---|---|---|---|");
    let mut looks = Vec::new();
    for (name, view) in views {
        let start = Instant::now();
        let cone = depth_map(&model.balls, view, Profile::PaperCone, ItemBuffer::Without, &Control::none())?;
        let cone_time = start.elapsed();
        let start = Instant::now();
        let sphere = depth_map(&model.balls, view, Profile::Sphere, ItemBuffer::Without, &Control::none())?;
        let sphere_time = start.elapsed();
        let start = Instant::now();
        let by_cone = query_points(&cone, &targets, 0.0);
        let query_time = start.elapsed();
        let by_sphere = query_points(&sphere, &targets, 0.0);
        let with_bias = query_points(&sphere, &targets, sphere.default_depth_bias());
        let differing = |a: Answer, b: Answer| {
            by_cone.iter().zip(&by_sphere).filter(|&(&cone, &sphere)| (cone, sphere) == (a, b)).count()
        };
        let (revealed, hidden) =
            (differing(Answer::Visible, Answer::Blocked), differing(Answer::Blocked, Answer::Visible));
        let percent = |count: usize| 100.0 * count as f64 / targets.len() as f64;
        tables.line(&format!(
            "| {name} | {:.1} % | {:.1} % | {:.1} % | {:.2} % | {:.1} % | {:.3} % | {:.3} / {:.3} s | {:.3} s |",
            percent(AnswerCounts::of(&by_cone).visible),
            percent(AnswerCounts::of(&by_sphere).visible),
            percent(AnswerCounts::of(&with_bias).visible),
            percent(revealed + hidden),
            100.0 * (revealed + hidden) as f64 / AnswerCounts::of(&by_sphere).blocked.max(1) as f64,
            percent(hidden),
            cone_time.as_secs_f64(),
            sphere_time.as_secs_f64(),
            query_time.as_secs_f64()
        ));
        looks.push(Look { map: sphere, targets: targets.clone(), answers: by_sphere });
    }
    Ok(looks)
}
