//! `belvedere depth-map`.

use crate::arguments::{DepthMapArguments, Global, refuse};
use crate::outputs::formats::{check_outputs, extension};
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{self, Places, ViewFrom};
use belvedere::depth::{NO_BALL, Profile};
use belvedere::figures::{Picture, camera_picture, depth_picture, panorama_picture, write_png};
use belvedere::io::{Georeference, write_npy_f32_2d, write_npy_u32_2d, write_tif_f32, write_tif_u32};
use belvedere::raster::Raster;
use belvedere::view::View;

/// Nodata value of rasters of heights or depths in GIS programs.
const NOTHING_HIT: f32 = -9999.0;

pub(crate) fn run(arguments: &DepthMapArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["tif", "tiff", "npy", "png"])?;
    check_outputs("--ball-ids", &arguments.balls_id, &["tif", "tiff", "npy"])?;
    if !arguments.scene.plan.add.is_empty() {
        return refuse("--add: depth maps show only balls; use `belvedere query`");
    }
    arguments.view.check()?;
    let mut run = CommandContext::new(global);
    let mut scene = pipeline::scene(&arguments.scene, KeepPoints::LetGo, &mut run)?;
    scene.profile = arguments.shape.profile.map_or(scene.profile, Profile::from);
    let scene = scene.into_question_scene(None, None, &run)?;
    let from = arguments.view.view_from(&scene, &mut run.summary)?;
    let question = ask::DepthMapQuestion { from: Some(from), ball_ids: arguments.balls_id.is_some() };
    let answers = run.ask(&scene, &question, &Places::Scene)?;
    let map = &answers.found;
    let place = match &from {
        ViewFrom::View(view) => georeference(scene.frame(), view),
        ViewFrom::Panorama { .. } => None,
    };
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "npy" => write_npy_f32_2d(output, &map.depth),
            "png" => write_png(output, &picture(&from, &map.depth)),
            _ => write_tif_f32(output, &map.depth, place.as_ref(), Some(NOTHING_HIT), Some(description(&from))),
        })?;
    }
    run.summary.add_paths("written", &arguments.output);
    if let (Some(path), Some(balls)) = (&arguments.balls_id, &map.balls) {
        run.stage("writing", 0, |_| match extension(path).as_str() {
            "npy" => write_npy_u32_2d(path, balls),
            _ => write_tif_u32(path, balls, place.as_ref(), Some(NO_BALL), Some("row of the ball seen")),
        })?;
        run.summary.add("balls_written", path.display().to_string());
    }
    Ok(run.finish())
}

fn description(from: &ViewFrom) -> &'static str {
    match from {
        ViewFrom::View(view) if view.is_central() => "depth in metres along the axis of the camera",
        ViewFrom::View(_) => "depth in metres along the line of sight",
        ViewFrom::Panorama { .. } => "range in metres from the camera",
    }
}

fn picture(from: &ViewFrom, depth: &Raster<f32>) -> Picture {
    match from {
        ViewFrom::View(view) if view.is_central() => camera_picture(view, depth, "depth in metres"),
        ViewFrom::View(_) => depth_picture(depth, "depth in metres"),
        ViewFrom::Panorama { .. } => panorama_picture(depth, "range in metres"),
    }
}

/// Returns the position of the picture in plan, if it looks straight down or up.
fn georeference(frame: &Frame, view: &View) -> Option<Georeference> {
    let [corner, column_step, row_step] = view.ground_grid()?;
    let crs = frame.crs.clone();
    let plane = |metres: [f64; 2]| metres.map(|v| v / crs.metres_per_unit);
    let upper_left = plane([corner[0] + frame.origin[0], corner[1] + frame.origin[1]]);
    let (column_step, row_step) = (plane(column_step), plane(row_step));
    Some(Georeference { upper_left, column_step, row_step, crs })
}
