//! The answer to a question on the cells of a tile.

use crate::grid::TileId;
use crate::obstacles::{Lines, Obstacles};
use crate::plan::Plan;
use crate::question::Question;
use crate::record::{Outcome, Record, Stage};
use crate::window;
use belvedere::apps::shadow::{ShadowSun, shadow};
use belvedere::apps::sky_view::{SKY_TARGET_HEIGHT, SkyDirections, scene_sky_view};
use belvedere::apps::targets::{Layout, Targets};
use belvedere::clean::clean;
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid, SurfaceParams, top_surface};
use belvedere::io::{atomic, write_tif_f32, write_tif_u8};
use belvedere::raster::Raster;
use belvedere::results::georeference;
use belvedere::{PointCloud, Result};
use rayon::prelude::*;
use std::path::Path;

/// Cells around a tile that the surface of its cells is taken from.
const RIM: usize = 2;
/// Values of a map of shadow, beside 1 for lit and 0 for in shadow.
pub(crate) const UNPROVEN: u8 = 2;
pub(crate) const NO_DATA: u8 = 255;
/// Targets handed to a thread at once.
const CHUNK: usize = 1024;

/// Answers a question for the cells of a tile on top of what stands there, with the balls that are in the folder of the run, and writes the answer
/// and its record. Where balls that can matter are missing, answers are unproven.
///
/// # Errors
/// Those of reading the files and the balls, and of writing.
pub fn answer(plan: &Plan, run: &Path, question: &Question, tile: TileId, control: &Control<'_>) -> Result<Record> {
    let stage = Stage::Answer(question);
    atomic::make_folder(&stage.folder(run))?;
    let record = answered(plan, run, question, tile, control)?;
    record.write(plan, run, stage, tile)?;
    Ok(record)
}

/// The area of the points that the cells of a tile need.
fn area_of_cells(plan: &Plan, tile: TileId) -> crate::grid::Area {
    let farthest = f64::from(plan.facts.farthest()) + plan.facts.isolation_radius.unwrap_or(0.0);
    plan.grid().core(tile).widened(farthest + (RIM + 1) as f64 * plan.cell)
}

fn answered(plan: &Plan, run: &Path, question: &Question, tile: TileId, control: &Control<'_>) -> Result<Record> {
    let cloud = control.stage("reading", 0, || window::read(plan, &area_of_cells(plan, tile), control))?;
    let points = cloud.len();
    let targets = control.stage("computing top surface", 0, || cells(plan, tile, &cloud, control))?;
    let asked = targets.asked_count();
    let directions = question.directions()?;
    let known = targets.positions.iter().filter(|p| p[2].is_finite());
    let lowest = known.map(|p| f64::from(p[2])).fold(f64::INFINITY, f64::min);
    if asked == 0 {
        return Ok(Record { points, ..Record::default() });
    }
    let lines = Lines { targets: plan.grid().core(tile), lowest, directions: &directions };
    let obstacles = control.stage("reading balls", 0, || Obstacles::gather(plan, run, &lines, control))?;
    let path = Stage::Answer(question).result(run, tile);
    let Layout::Cells(ground) = &targets.layout else { return Ok(Record { points, ..Record::default() }) };
    let place = georeference(&ground.grid, &targets.frame);
    let (width, height) = (ground.grid.width, ground.grid.height);
    let is_unknown: Vec<bool> = control.stage("looking for missing tiles", asked, || {
        let is_unknown = |position: &[f32; 3]| {
            let position = position.map(f64::from);
            !obstacles.missing.is_empty()
                && position.iter().all(|v| v.is_finite())
                && directions.iter().any(|&direction| obstacles.is_unknown(position, direction))
        };
        Ok(targets.positions.par_iter().with_min_len(CHUNK).map(is_unknown).collect())
    })?;
    let mut unproven_cells = 0;
    match question {
        Question::Shadow { to_sun, .. } => {
            let sun = ShadowSun { to_sun: *to_sun, season: None };
            let lit = control.stage("testing sun", asked, || shadow(&obstacles.scene, &targets, sun, control))?;
            let value = |(&lit, &is_unknown): (&f32, &bool)| match lit {
                lit if lit.is_nan() => NO_DATA,
                lit if lit > 0.0 && is_unknown => UNPROVEN,
                lit => u8::from(lit > 0.0),
            };
            let values: Vec<u8> = lit.iter().zip(&is_unknown).map(value).collect();
            unproven_cells += values.iter().filter(|&&value| value == UNPROVEN).count();
            let raster = Raster::from_values(width, height, values)?;
            write_tif_u8(&path, &raster, Some(&place), Some(NO_DATA), None)?;
        }
        Question::SkyView { directions } => {
            let sky = SkyDirections::even(*directions)?;
            let scene = &obstacles.scene;
            let mut factors =
                control.stage("testing sky", asked, || scene_sky_view(scene, &targets, &sky, control))?.factors;
            for (factor, _) in factors.iter_mut().zip(&is_unknown).filter(|(_, is_unknown)| **is_unknown) {
                unproven_cells += usize::from(factor.is_finite());
                *factor = f32::NAN;
            }
            let raster = Raster::from_values(width, height, factors)?;
            write_tif_f32(&path, &raster, Some(&place), Some(-1.0), None)?;
        }
    }
    let balls = obstacles.ball_count;
    Ok(Record { outcome: Outcome::Done, points, balls, cells: asked, unproven_cells, ..Record::default() })
}

/// The cells of a tile as targets on top of what stands there.
fn cells(plan: &Plan, tile: TileId, cloud: &PointCloud, control: &Control<'_>) -> Result<Targets> {
    let (kept, _) = clean(cloud, &plan.facts.cleaning(&plan.model().clean), control)?;
    let positions: Vec<[f32; 3]> = kept.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
    let core = plan.grid().core(tile);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number of cells")]
    let count = (plan.tile_size / plan.cell).round() as usize;
    let rim = RIM as f64 * plan.cell;
    let wide = MapGrid {
        corner: [core.low[0] - rim, core.high[1] + rim],
        cell: plan.cell,
        width: count + 2 * RIM,
        height: count + 2 * RIM,
    };
    let unknown = Raster::filled(wide.width, wide.height, f32::NAN);
    let flat = Ground { grid: wide, heights: unknown.clone(), gaps: unknown };
    let params = SurfaceParams { farthest: plan.facts.farthest(), ..SurfaceParams::default() };
    let heights = top_surface(&positions, &flat, &params, control)?;
    let grid = MapGrid { corner: [core.low[0], core.high[1]], cell: plan.cell, width: count, height: count };
    let places = (0..count).flat_map(|row| (0..count).map(move |column| (column, row)));
    let of_cell = |(column, row): (usize, usize)| heights.get(column + RIM, row + RIM).unwrap_or(f32::NAN);
    let heights = Raster::from_values(count, count, places.clone().map(of_cell).collect())?;
    let position = |(column, row): (usize, usize)| {
        let [x, y] = grid.center(column, row);
        let z = f64::from(heights.get(column, row).unwrap_or(f32::NAN)) + SKY_TARGET_HEIGHT;
        #[expect(clippy::cast_possible_truncation, reason = "local positions are f32")]
        if z.is_finite() { [x as f32, y as f32, z as f32] } else { [f32::NAN; 3] }
    };
    let positions = places.map(position).collect();
    let gaps = Raster::filled(count, count, f32::NAN);
    let layout = Layout::Cells(Box::new(Ground { grid, heights, gaps }));
    let frame = cloud.frame.clone();
    Ok(Targets { frame, positions, normals: None, weights: Vec::new(), groups: Vec::new(), layout })
}
