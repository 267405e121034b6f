//! Pictures with the content of Figures 4 to 7.

use crate::experiment::Look;
use crate::model::{NormalMethod, PaperModel, unlimited_tau, within_window};
use belvedere::Bounds;
use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, Profile, depth_map};
use belvedere::figures::{Canvas, Colors, Picture, depth_picture, ramp_colors, side_by_side, write_png};
use belvedere::medial::{MedialBalls, NO_TOUCH, ShrinkParams};
use belvedere::query::Answer;
use belvedere::raster::Raster;
use belvedere::view::{View, to_sun};
use belvedere::{PointCloud, Result};
use std::path::Path;

const PAPER: [u8; 3] = [255, 255, 255];
const SHADOW: [u8; 3] = [45, 55, 110];

/// Colours of the classes of the Dutch height model; its class 1 is mostly plants.
fn class_color(class: u8) -> [u8; 3] {
    match class {
        2 => [200, 170, 125],
        6 => [214, 98, 77],
        9 => [90, 150, 220],
        26 => [150, 140, 160],
        _ => [110, 170, 85],
    }
}

fn by_class(model: &PaperModel) -> Vec<[u8; 3]> {
    (0..).take(model.cloud.len()).map(|i| class_color(model.class(i))).collect()
}

fn by_height(points: &[[f32; 3]]) -> Vec<[u8; 3]> {
    ramp_colors(&points.iter().map(|p| p[2]).collect::<Vec<f32>>())
}

/// Colour of each ball: that of the point it was made for.
fn of_sources(model: &PaperModel, points: &[[u8; 3]]) -> Vec<[u8; 3]> {
    model.balls.source.iter().map(|&i| points[i as usize]).collect()
}

/// The same box seen with another number of pixels.
fn view_of(low: [f32; 3], high: [f32; 3], viewer: Option<[f64; 2]>, width_px: f64) -> Result<View> {
    let forward = viewer.map_or([0.0, 0.0, -1.0], |v| {
        let [azimuth, elevation] = v.map(f64::to_radians);
        to_sun(azimuth, elevation).map(|v| -v)
    });
    let (low, high) = (low.map(f64::from), high.map(f64::from));
    let coarse = View::parallel(forward, low, high, 1.0)?;
    View::parallel(forward, low, high, coarse.size_px[0] as f64 / width_px)
}

/// The picture with 32 steps a channel: shaded balls and scattered points take half the space, and nobody sees it.
fn save(folder: &Path, name: &str, mut picture: Picture) -> Result<()> {
    for channel in &mut picture.rgb {
        *channel = if *channel >= 248 { 255 } else { *channel & 0xf8 };
    }
    println!("{name}: {} x {} pixels", picture.width, picture.height);
    write_png(&folder.join(name), &picture)
}

fn points_picture(view: &View, points: &[[f32; 3]], colors: &[[u8; 3]], size_px: usize) -> Result<Picture> {
    let mut canvas = Canvas::new(view, PAPER);
    canvas.draw_points(points, Colors::Each(colors), size_px)?;
    Ok(canvas.into_picture())
}

/// A canvas with `balls`, one colour each.
fn canvas_with_balls(view: &View, balls: &MedialBalls, colors: &[[u8; 3]]) -> Result<Canvas> {
    let mut canvas = Canvas::new(view, PAPER);
    let map = depth_map(balls, view, Profile::Sphere, ItemBuffer::With, &Control::none())?;
    if let Some(items) = &map.balls {
        canvas.draw_seen_balls((&map.depth, items), (&balls.centers, &balls.radii), Colors::Each(colors))?;
    }
    Ok(canvas)
}

fn balls_picture(view: &View, model: &PaperModel, colors: &[[u8; 3]]) -> Result<Picture> {
    Ok(canvas_with_balls(view, &model.balls, &of_sources(model, colors))?.into_picture())
}

/// Targets with one answer, at most `max` of them.
fn with_answer(look: &Look, answer: Answer, max: usize) -> Vec<[f32; 3]> {
    look.targets.iter().zip(&look.answers).filter(|&(_, &a)| a == answer).map(|(&t, _)| t).take(max).collect()
}

/// Balls and blocked targets together.
fn shadow_picture(view: &View, model: &PaperModel, colors: &[[u8; 3]], look: &Look, max: usize) -> Result<Picture> {
    let mut canvas = canvas_with_balls(view, &model.balls, &of_sources(model, colors))?;
    canvas.draw_points(&with_answer(look, Answer::Blocked, max), Colors::One(SHADOW), 1)?;
    Ok(canvas.into_picture())
}

/// What the depth map shows, without the distance the picture plane was moved back by.
fn depth_of(look: &Look, title: &str) -> Result<Picture> {
    let min = look.map.depth.values().iter().copied().fold(f32::INFINITY, f32::min);
    let values = look.map.depth.values().iter().map(|d| d - min).collect();
    let depth = Raster::from_values(look.map.depth.width(), look.map.depth.height(), values)?;
    Ok(depth_picture(&depth, title))
}

/// Figure 4.
pub(crate) fn artificial(folder: &Path, model: &PaperModel, look: &Look) -> Result<()> {
    let top = view_of(model.low, model.high, None, 340.0)?;
    let points = points_picture(&top, &model.cloud.positions, &by_height(&model.cloud.positions), 4)?;
    let white = vec![[225, 215, 195]; model.cloud.len()];
    let shadow = shadow_picture(&top, model, &white, look, 150_000)?;
    let depth = depth_of(look, "(a) depth map of the viewport")?;
    let right = side_by_side(&[points, shadow], &["(b) points from above", "(c) balls and shadow"]);
    save(folder, "figure4.png", side_by_side(&[depth, right], &["", ""]))
}

/// Figures 5 and 6 for a housing block.
pub(crate) fn block(folder: &Path, model: &PaperModel, tau: &PaperModel, look: &Look) -> Result<()> {
    let colors = by_class(model);
    let top = view_of(model.low, model.high, None, 440.0)?;
    let a = points_picture(&top, &model.cloud.positions, &colors, 2)?;
    let b = shadow_picture(&top, model, &colors, look, 150_000)?;
    let viewport = view_of(model.low, model.high, Some(crate::VIEWER), 560.0)?;
    let c = points_picture(&viewport, &model.cloud.positions, &colors, 2)?;
    let d = balls_picture(&viewport, model, &colors)?;
    let d_tau = balls_picture(&viewport, tau, &by_class(tau))?;
    let above = side_by_side(&[a, b], &["(a) points from above", "(b) balls and blocked targets"]);
    let below = side_by_side(&[c, d], &["(c) points from the viewport", "(d) balls from the viewport"]);
    save(folder, "figure5_above.png", above)?;
    save(folder, "figure5_viewport.png", below)?;
    save(folder, "figure5_tau.png", side_by_side(&[d_tau], &["balls of bounded penetration"]))?;
    save(folder, "figure5_depth.png", depth_of(look, "(e) depth map of the viewport")?)?;
    figure6(folder, model, look)
}

/// Figure 6, from beside the viewport and coloured by height: from the viewport itself nothing blocked could be seen.
fn figure6(folder: &Path, model: &PaperModel, look: &Look) -> Result<()> {
    let side = view_of(model.low, model.high, Some([crate::VIEWER[0] - 50.0, 40.0]), 430.0)?;
    let picture = |answer| {
        let targets = with_answer(look, answer, usize::MAX);
        let mut canvas = Canvas::new(&side, PAPER);
        canvas.draw_points(&targets, Colors::Each(&by_height(&targets)), 2)?;
        Result::Ok(canvas.into_picture())
    };
    let pictures = [picture(Answer::Visible)?, picture(Answer::Blocked)?];
    save(folder, "figure6.png", side_by_side(&pictures, &["visible targets", "blocked targets"]))
}

/// Figure 5 for the whole tile.
pub(crate) fn tile(folder: &Path, model: &PaperModel, look: &Look) -> Result<()> {
    let colors = by_class(model);
    let top = view_of(model.low, model.high, None, 480.0)?;
    let a = points_picture(&top, &model.cloud.positions, &colors, 1)?;
    let b = balls_picture(&top, model, &colors)?;
    save(folder, "tile_above.png", side_by_side(&[a, b], &["points from above", "medial balls from above"]))?;
    save(folder, "tile_depth.png", depth_of(look, "depth map of the viewport")?)
}

/// Figure 7: a roof with few samples on one side, and trees; points above, balls below.
pub(crate) fn close_views(folder: &Path, cloud: &PointCloud, way: &NormalMethod<'_>) -> Result<()> {
    for (name, window, viewer) in
        [("figure7_roof.png", crate::ROOF, [235.0, 30.0]), ("figure7_trees.png", crate::TREES, [200.0, 15.0])]
    {
        // balls are made with the surroundings, as the edge of a cloud has too large ones
        let [west, south, east, north] = window;
        let around = within_window(cloud, [west - 30.0, south - 30.0, east + 30.0, north + 30.0]);
        let shown = within_window(cloud, window);
        let Some(Bounds { low, high }) = shown.bounds() else { continue };
        let view = view_of(low, high, Some(viewer), 440.0)?;
        let mut columns = Vec::new();
        for params in [ShrinkParams::angles(), unlimited_tau(), ShrinkParams::tau()] {
            let model = PaperModel::of_scan(&around, way, params)?;
            let inside = |p: [f32; 3]| (0..2).all(|i| p[i] >= low[i] && p[i] <= high[i]);
            let colors = by_class(&model);
            let mut balls = model.balls.clone();
            for (touch, &source) in balls.touch.iter_mut().zip(&balls.source) {
                if !inside(model.cloud.positions[source as usize]) {
                    *touch = NO_TOUCH;
                }
            }
            let balls = balls.shrunk();
            let ball_colors: Vec<[u8; 3]> = balls.source.iter().map(|&source| colors[source as usize]).collect();
            let points: Vec<u32> =
                (0..).zip(&model.cloud.positions).filter(|&(_, &p)| inside(p)).map(|(i, _)| i).collect();
            let point_colors: Vec<[u8; 3]> = points.iter().map(|&i| colors[i as usize]).collect();
            if columns.is_empty() {
                columns.push(points_picture(&view, &model.cloud.select(&points).positions, &point_colors, 3)?);
            }
            columns.push(canvas_with_balls(&view, &balls, &ball_colors)?.into_picture());
        }
        save(
            folder,
            name,
            side_by_side(&columns, &["points", "published balls", "bounded penetration", "... and 0.5 m at most"]),
        )?;
    }
    Ok(())
}
