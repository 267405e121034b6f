//! `belvedere depth-map`.

use super::{check_output, extension};
use crate::arguments::{DepthMap, Global, Usage};
use crate::pipeline::{self, Points, Scene};
use crate::run::Run;
use crate::summary::{Summary, percent};
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, NO_BALL, Profile};
use belvedere::figures::{Picture, camera_picture, depth_picture, panorama_picture, write_png};
use belvedere::io::{Georeference, write_npy_f32_2d, write_npy_u32_2d, write_tif_f32, write_tif_u32};
use belvedere::raster::Raster;
use belvedere::view::View;

/// What GIS programs expect where a raster of heights or depths has no value.
const NOTHING_HIT: f32 = -9999.0;

pub(crate) fn run(arguments: &DepthMap, global: &Global) -> Result<Summary> {
    for output in &arguments.output {
        check_output("-o", output, &["tif", "tiff", "npy", "png"])?;
    }
    if let Some(path) = &arguments.balls_id {
        check_output("--ball-ids", path, &["tif", "tiff", "npy"])?;
    }
    if !arguments.scene.plan.add.is_empty() {
        return Err(Usage("--add: depth maps show only balls; use `belvedere query`".to_owned()).into());
    }
    arguments.view.check()?;
    let mut run = Run::new(global);
    let scene = pipeline::scene(&arguments.scene, Points::LetGo, &mut run)?;
    let views = arguments.view.views(&scene, &mut run.summary)?;
    let items = if arguments.balls_id.is_some() { ItemBuffer::With } else { ItemBuffer::Without };
    let map = run.stage("drawing depth map", 0, |control| draw(arguments, &scene, &views, items, control))?;
    let hit = map.depth.values().iter().filter(|d| d.is_finite()).count();
    run.summary.add("pixels_hit_percent", percent(hit, map.depth.values().len()));
    if views.iter().any(View::is_central) {
        run.summary.add("balls_around_eye_ignored", map.around_eye_count);
    }
    run.summary
        .headline("<view.width_px> x <view.height_px> pixels, <pixels_hit_percent> % of them show a surface")
        .headline("side of a pixel: <view.pixel_m> m")
        .headline("side of a pixel at a distance of 100 m: <view.pixel_m_at_100_m> m");
    let place = views.first().and_then(|view| georeference(&scene.cloud, view));
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "npy" => write_npy_f32_2d(output, &map.depth),
            "png" => write_png(output, &map.picture()),
            _ => write_tif_f32(output, &map.depth, place.as_ref(), Some(NOTHING_HIT), Some(map.description())),
        })?;
    }
    run.summary.add("written", arguments.output.iter().map(|path| path.display().to_string()).collect::<Vec<_>>());
    if let (Some(path), Some(balls)) = (&arguments.balls_id, &map.balls) {
        run.stage("writing", 0, |_| match extension(path).as_str() {
            "npy" => write_npy_u32_2d(path, balls),
            _ => write_tif_u32(path, balls, place.as_ref(), Some(NO_BALL), Some("row of the ball seen")),
        })?;
        run.summary.add("balls_written", path.display().to_string());
    }
    Ok(run.finish())
}

/// What was drawn.
struct Drawn {
    depth: Raster<f32>,
    balls: Option<Raster<u32>>,
    around_eye_count: usize,
    look: Look,
}

/// How it is to be shown.
#[derive(Clone, Copy)]
enum Look {
    Parallel,
    Camera(View),
    Panorama,
}

impl Drawn {
    fn description(&self) -> &'static str {
        match self.look {
            Look::Parallel => "depth in metres along the line of sight",
            Look::Camera(_) => "depth in metres along the axis of the camera",
            Look::Panorama => "range in metres from the camera",
        }
    }

    fn picture(&self) -> Picture {
        match self.look {
            Look::Parallel => depth_picture(&self.depth, "depth in metres"),
            Look::Camera(view) => camera_picture(&view, &self.depth, "depth in metres"),
            Look::Panorama => panorama_picture(&self.depth, "range in metres"),
        }
    }
}

fn draw(
    arguments: &DepthMap,
    scene: &Scene,
    views: &[View],
    items: ItemBuffer,
    control: &Control<'_>,
) -> Result<Drawn> {
    let profile = arguments.shape.profile.map_or(scene.profile, Profile::from);
    if let [view] = views {
        let look = if view.is_central() { Look::Camera(*view) } else { Look::Parallel };
        let map = scene.model.depth_map(view, profile, items, control)?;
        return Ok(Drawn { depth: map.depth, balls: map.balls, around_eye_count: map.around_eye_count, look });
    }
    if profile != Profile::Sphere {
        return Err(Usage("--ball-profile: the paper's cone is for parallel views only".to_owned()).into());
    }
    let eye = views.first().map_or([0.0; 3], |view| view.frame.eye);
    let map = scene.model.panorama(eye, arguments.view.panorama_width()?, items, control)?;
    Ok(Drawn { depth: map.range, balls: map.balls, around_eye_count: map.around_eye_count, look: Look::Panorama })
}

/// Where the picture lies on the map, if it looks straight down or up.
fn georeference(cloud: &PointCloud, view: &View) -> Option<Georeference> {
    let [corner, column_step, row_step] = view.ground_grid()?;
    let crs = cloud.frame.crs.clone();
    let plane = |metres: [f64; 2]| metres.map(|v| v / crs.metres_per_unit);
    let upper_left = plane([corner[0] + cloud.frame.origin[0], corner[1] + cloud.frame.origin[1]]);
    let (column_step, row_step) = (plane(column_step), plane(row_step));
    Some(Georeference { upper_left, column_step, row_step, crs })
}
