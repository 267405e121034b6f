//! `belvedere depth-map`.

use super::extension;
use crate::arguments::{DepthMap, Global, Usage};
use crate::pipeline;
use crate::progress::Stages;
use crate::summary::{Summary, percent};
use anyhow::Result;
use belvedere::depth::{ItemBuffer, depth_map};
use belvedere::io::{
    DepthRange, depth_picture, write_npy_f32_2d, write_npy_u32_2d, write_png, write_tif_f32, write_tif_u32,
};
use std::path::Path;

pub(crate) fn run(arguments: &DepthMap, global: &Global) -> Result<Summary> {
    check(&arguments.output, &["tif", "tiff", "npy", "png"])?;
    if let Some(path) = &arguments.balls_id {
        check(path, &["tif", "tiff", "npy"])?;
    }
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let scene = pipeline::scene(&arguments.scene, &mut stages, &mut summary)?;
    let view = arguments.view.view(&scene, &mut summary)?;
    let items = if arguments.balls_id.is_some() { ItemBuffer::With } else { ItemBuffer::Without };
    let map = stages
        .run("drawing depth map", 0, |_| depth_map(&scene.balls, &view, arguments.scene.profile.into(), items))?;
    let hit = map.depth.values().iter().filter(|d| d.is_finite()).count();
    summary.add("pixels_hit_percent", percent(hit, map.depth.values().len()));
    let output = &arguments.output;
    stages.run("writing", 0, |_| match extension(output).as_str() {
        "npy" => write_npy_f32_2d(output, &map.depth),
        "png" => write_png(output, &depth_picture(&map.depth, DepthRange::Robust, "depth in metres")),
        _ => write_tif_f32(output, &map.depth, None, None, Some("depth in metres along the line of sight")),
    })?;
    summary.add("written", output.display().to_string());
    if let (Some(path), Some(balls)) = (&arguments.balls_id, &map.balls) {
        stages.run("writing", 0, |_| match extension(path).as_str() {
            "npy" => write_npy_u32_2d(path, balls),
            _ => write_tif_u32(path, balls, None, None, Some("row of the ball seen")),
        })?;
        summary.add("balls_written", path.display().to_string());
    }
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

fn check(path: &Path, known: &[&str]) -> Result<()> {
    if known.contains(&extension(path).as_str()) {
        return Ok(());
    }
    Err(Usage(format!("{}: write to one of .{}", path.display(), known.join(" ."))).into())
}
