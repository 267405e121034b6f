//! The balls of a tile.

use crate::cleared::{ClassedPoint, classed, clear_balls};
use crate::grid::{MapArea, TOP_SIDE, TileId, square_at};
use crate::plan::Plan;
use crate::record::{Stamp, TileOutcome, TileRecord};
use crate::stage::Stage;
use crate::window;
use belvedere::control::Control;
use belvedere::io::{atomic, write_balls};
use belvedere::medial::MedialBalls;
use belvedere::model::{ModelParts, SceneModel};
use belvedere::{PointCloud, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// Makes the balls of a tile and writes them and their record into the folder of the run. The same plan and tile give
/// the same balls.
///
/// # Errors
/// Those of reading the files and of [`SceneModel::build`]; [`belvedere::Error::Malformed`] where points that the plan
/// counted are not found.
pub fn make_balls(plan: &Plan, run: &Path, tile: TileId, control: &Control<'_>) -> Result<TileRecord> {
    atomic::make_folder(&Stage::Balls.folder(run))?;
    let cloud = control.stage("reading", 0, || window::read(plan, &plan.window(tile), control))?;
    window::check_counts(plan, &cloud, &plan.grid().core(tile).in_blocks())?;
    let record = made(plan, run, tile, cloud, control)?;
    record.write(plan, run, Stage::Balls, tile)?;
    Ok(record)
}

fn made(plan: &Plan, run: &Path, tile: TileId, cloud: PointCloud, control: &Control<'_>) -> Result<TileRecord> {
    let points = cloud.len();
    let nothing = TileRecord { points, ..TileRecord::default() };
    let core = plan.grid().core(tile);
    let is_in = |p: &[f32; 3]| core.holds([p[0].into(), p[1].into()]);
    let all = classed(&cloud, 0..points);
    // those of other tiles may be cleared within this one
    let mut parts = ModelParts { frame: plan.frame()?, ..ModelParts::default() };
    if all.iter().any(|point| is_in(&point.0)) {
        parts = match SceneModel::build_owned(cloud, &plan.model(), control) {
            Ok((model, _)) => model.into_parts(),
            Err(error) if window::is_nothing(&error) => parts,
            Err(error) => return Err(error),
        };
    }
    let of_ball = |row: usize| parts.balls.source.get(row).and_then(|&source| all.get(source as usize)).copied();
    let is_own = |row: &usize| of_ball(*row).is_some_and(|point| is_in(&point.0));
    let own: Vec<usize> = (0..parts.balls.len()).filter(is_own).collect();
    let own_points: Vec<ClassedPoint> = own.iter().filter_map(|&row| of_ball(row)).collect();
    let mut transmission = own.iter().filter_map(|&row| parts.transmission.get(row).copied()).collect();
    let mut balls = parts.balls.select(&own);
    drop(all);
    clear_balls(plan, &core, &mut balls, &mut transmission, &own_points, control)?;
    if balls.is_empty() {
        return Ok(nothing);
    }
    let tops = tops(&balls);
    let count = balls.len();
    // lines of sight are proven by pulses of the whole; here they are not kept
    let parts = ModelParts { balls, transmission, bounds: plan.bounds(), pulses: None, ..parts };
    let path = Stage::Balls.result(run, tile);
    control.stage("writing", 0, || write_balls(&path, &parts.with_provenance("tile", tile.name())))?;
    let result = Some(Stamp::of(&path)?);
    Ok(TileRecord { outcome: TileOutcome::Done, result, points, balls: count, tops, ..TileRecord::default() })
}

/// The highest top of balls over each square of 16 m that any reaches into.
pub(crate) fn tops(balls: &MedialBalls) -> Vec<([i32; 2], f32)> {
    let mut tops: BTreeMap<[i32; 2], f32> = BTreeMap::new();
    for (&[x, y, z], &radius) in balls.centers.iter().zip(&balls.radii) {
        let [first, last] = [-radius, radius].map(|by| square_at([x + by, y + by], TOP_SIDE));
        for north in first[1]..=last[1] {
            for east in first[0]..=last[0] {
                let top = tops.entry([east, north]).or_insert(f32::NEG_INFINITY);
                *top = top.max(z + radius);
            }
        }
    }
    tops.into_iter().collect()
}

/// The square on the map that a ball covers.
pub(crate) fn square_of([x, y, _]: [f32; 3], radius: f32) -> MapArea {
    let (middle, radius) = ([x, y].map(f64::from), f64::from(radius));
    MapArea { low: middle.map(|v| v - radius), high: middle.map(|v| v + radius) }
}
