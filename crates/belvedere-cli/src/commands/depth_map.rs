//! `belvedere depth-map`.

use super::{check_output, extension, is_same};
use crate::arguments::{DepthMap, Global, Usage};
use crate::pipeline::{self, Points};
use crate::progress::Stages;
use crate::summary::{Summary, percent};
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::depth::{ItemBuffer, NO_BALL, depth_map};
use belvedere::io::{
    Georeference, depth_picture, write_npy_f32_2d, write_npy_u32_2d, write_png, write_tif_f32, write_tif_u32,
};
use belvedere::view::View;

/// What GIS programs expect where a raster of heights or depths has no value.
const NOTHING_HIT: f32 = -9999.0;
const DESCRIPTION: &str = "depth in metres along the line of sight";

pub(crate) fn run(arguments: &DepthMap, global: &Global) -> Result<Summary> {
    check_output("-o", &arguments.output, &["tif", "tiff", "npy", "png"])?;
    if let Some(path) = &arguments.balls_id {
        check_output("--balls-id", path, &["tif", "tiff", "npy"])?;
        if is_same(path, &arguments.output) {
            return Err(Usage(format!("--balls-id {}: -o writes there too", path.display())).into());
        }
    }
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let scene = pipeline::scene(&arguments.scene, Points::LetGo, &mut stages, &mut summary)?;
    let view = arguments.view.view(&scene, &mut summary)?;
    let items = if arguments.balls_id.is_some() { ItemBuffer::With } else { ItemBuffer::Without };
    let map = stages
        .run("drawing depth map", 0, |_| depth_map(&scene.balls, &view, arguments.scene.profile.into(), items))?;
    let hit = map.depth.values().iter().filter(|d| d.is_finite()).count();
    summary.add("pixels_hit_percent", percent(hit, map.depth.values().len()));
    let output = &arguments.output;
    let place = georeference(&scene.cloud, &view);
    stages.run("writing", 0, |_| match extension(output).as_str() {
        "npy" => write_npy_f32_2d(output, &map.depth),
        "png" => write_png(output, &depth_picture(&map.depth, "depth in metres")),
        _ => write_tif_f32(output, &map.depth, place.as_ref(), Some(NOTHING_HIT), Some(DESCRIPTION)),
    })?;
    summary.add("written", output.display().to_string());
    if let (Some(path), Some(balls)) = (&arguments.balls_id, &map.balls) {
        stages.run("writing", 0, |_| match extension(path).as_str() {
            "npy" => write_npy_u32_2d(path, balls),
            _ => write_tif_u32(path, balls, place.as_ref(), Some(NO_BALL), Some("row of the ball seen")),
        })?;
        summary.add("balls_written", path.display().to_string());
    }
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

/// Where the picture lies on the map, if it looks straight down or up.
fn georeference(cloud: &PointCloud, view: &View) -> Option<Georeference> {
    let [corner, column_step, row_step] = view.ground_grid()?;
    let crs = cloud.crs.clone();
    let plane = |metres: [f64; 2]| metres.map(|v| v / crs.metres_per_unit);
    let upper_left = plane([corner[0] + cloud.origin[0], corner[1] + cloud.origin[1]]);
    let (column_step, row_step) = (plane(column_step), plane(row_step));
    Some(Georeference { upper_left, column_step, row_step, crs })
}
