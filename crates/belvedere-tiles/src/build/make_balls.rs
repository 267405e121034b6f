//! Balls of a tile.

use crate::build::cleared::{ClassedPoint, classed, clear_balls, left_crowns};
use crate::build::patches;
use crate::build::tile_pulses;
use crate::grid::{MapArea, TOP_SIDE, TileId, square_at};
use crate::plan::Plan;
use crate::plan::record::{Stamp, TileOutcome, TileRecord};
use crate::plan::stage::Stage;
use crate::plan::window;
use belvedere::cast::{to_f32, to_f32s};
use belvedere::control::Control;
use belvedere::io::{atomic, write_balls};
use belvedere::medial::{LIMIT_TOUCH, MedialBalls};
use belvedere::medium::VOXEL_SIDE;
use belvedere::model::{ModelParts, SceneModel};
use belvedere::planes::BuildingOutlines;
use belvedere::pulses::FreeSegmentColumns;
use belvedere::{ExtinctionVoxels, PointCloud, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// Makes the balls of a tile and writes them and their record into the folder of the run. The same plan and tile give
/// the same balls.
///
/// # Errors
/// Those of reading the files and of [`SceneModel::build`]. [`belvedere::Error::Malformed`] for a count of points that
/// differs from the plan.
pub fn make_balls(plan: &Plan, run: &Path, tile: TileId, control: &Control<'_>) -> Result<TileRecord> {
    atomic::make_folder(&Stage::Balls.folder(plan, run))?;
    let cloud = control.stage("reading", 0, || window::read_as_stored(plan, &plan.window(tile), control))?;
    window::check_counts(plan, &cloud, &plan.grid().core(tile).in_blocks())?;
    let record = made(plan, run, tile, cloud, control)?;
    record.write(plan, run, Stage::Balls, tile)?;
    Ok(record)
}

/// Makes the balls of a tile unless a step made or tried them before.
///
/// # Errors
/// Those of [`make_balls`] and of writing the record.
pub(crate) fn make_missing(plan: &Plan, run: &Path, tile: TileId, control: &Control<'_>) -> Result<()> {
    if TileRecord::read(plan, run, Stage::Balls, tile).is_none() {
        make_balls(plan, run, tile, control)?;
    }
    Ok(())
}

fn made(plan: &Plan, run: &Path, tile: TileId, cloud: PointCloud, control: &Control<'_>) -> Result<TileRecord> {
    let points = cloud.len();
    let nothing = TileRecord { points, ..TileRecord::default() };
    let core = plan.grid().core(tile);
    let is_in = |p: &[f32; 3]| core.holds([p[0].into(), p[1].into()]);
    let all = classed(&cloud, 0..points);
    // Objects of other tiles may be cleared within this tile.
    let mut parts = ModelParts { frame: plan.frame()?, ..ModelParts::default() };
    // A pulse begins a hand's breadth from its return, which may lie beside the tile.
    let near = if plan.proves { core.widened(1.0) } else { core };
    if all.iter().any(|point| near.holds([point.0[0].into(), point.0[1].into()])) {
        parts = match SceneModel::build_owned(cloud, &plan.model(), control) {
            Ok((model, _)) => model.into_parts(),
            Err(error) if window::is_nothing(&error) => parts,
            Err(error) => return Err(error),
        };
    }
    let of_ball = |row: usize| parts.balls.source.get(row).and_then(|&source| all.get(source as usize)).copied();
    let is_own = |row: &usize| of_ball(*row).is_some_and(|point| is_in(&point.0));
    let own: Vec<usize> = (0..parts.balls.len()).filter(is_own).collect();
    // rows of the points of the tile, by rows of the points that were read
    let own_rows = all.iter().scan(0, |next: &mut u32, point| {
        let row = is_in(&point.0).then_some(*next);
        *next += u32::from(row.is_some());
        Some(row)
    });
    let own_rows: Vec<Option<u32>> = own_rows.collect();
    let own_points: Vec<ClassedPoint> = own.iter().filter_map(|&row| of_ball(row)).collect();
    let mut transmission = own.iter().filter_map(|&row| parts.transmission.get(row).copied()).collect();
    let mut balls = parts.balls.select(&own);
    let row_of = |row: u32| own_rows.get(row as usize).copied().flatten();
    for (source, touch) in balls.source.iter_mut().zip(&mut balls.touch) {
        *source = row_of(*source).unwrap_or_default();
        if *touch < LIMIT_TOUCH {
            // a point of another tile has no row here
            *touch = row_of(*touch).unwrap_or(LIMIT_TOUCH);
        }
    }
    let medium = parts.medium.as_ref().map(|voxels| left_crowns(plan, &core, voxels, &all, control)).transpose()?;
    drop(all);
    clear_balls(plan, &core, &mut balls, &mut transmission, &own_points, control)?;
    let patches = patches::of_tile(&parts.patches, &core, &plan.cleared);
    let own_pulses = |pulses: &FreeSegmentColumns| tile_pulses::of_tile(pulses, &core);
    let pulses = parts.pulses.as_ref().filter(|_| plan.proves).map(own_pulses);
    // Outlines in the margin belong to other tiles.
    let outlines = BuildingOutlines::default();
    let parts = ModelParts { balls, transmission, patches, outlines, medium, pulses, ..parts };
    written(plan, run, tile, parts, nothing, control)
}

/// Writes the obstacles of a tile, and completes its `record`.
fn written(
    plan: &Plan,
    run: &Path,
    tile: TileId,
    parts: ModelParts,
    record: TileRecord,
    control: &Control<'_>,
) -> Result<TileRecord> {
    let pulses = parts.pulses.filter(|pulses| !pulses.starts.is_empty());
    let medium = parts.medium.filter(|voxels| !voxels.is_empty());
    let parts = ModelParts { bounds: plan.bounds(), pulses: None, medium: None, ..parts };
    let beside = |alone: ModelParts, path: &Path| {
        let alone = ModelParts { frame: parts.frame.clone(), ..alone }.with_provenance("tile", tile.name());
        control.stage("writing", 0, || write_balls(path, &alone))?;
        Stamp::of(path)
    };
    let mut record = record;
    if let Some(pulses) = pulses {
        let alone = ModelParts { pulses: Some(pulses), ..ModelParts::default() };
        record.pulses = Some(beside(alone, &Stage::Balls.pulses(plan, run, tile))?);
    }
    let mut tops = patches::raise(tops(&parts.balls), &parts.patches);
    let has_crowns = medium.is_some();
    if let Some(medium) = medium {
        tops = raised_to_crowns(tops, &medium, parts.frame.origin);
        let alone = ModelParts { medium: Some(medium), ..ModelParts::default() };
        record.crowns = Some(beside(alone, &Stage::Balls.crowns(plan, run, tile))?);
    }
    if parts.balls.is_empty() && parts.patches.is_empty() && !has_crowns {
        return Ok(record);
    }
    let count = parts.balls.len();
    let path = Stage::Balls.result(plan, run, tile);
    control.stage("writing", 0, || write_balls(&path, &parts.with_provenance("tile", tile.name())))?;
    let result = Some(Stamp::of(&path)?);
    Ok(TileRecord { outcome: TileOutcome::Done, result, balls: count, tops, ..record })
}

/// Returns the highest top of balls over each square of 16 m that any ball reaches into.
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

/// Returns the tops over squares of 16 m, raised to the voxels of crowns. Voxels take light up to half a voxel beyond.
fn raised_to_crowns(tops: Vec<([i32; 2], f32)>, voxels: &ExtinctionVoxels, origin: [f64; 3]) -> Vec<([i32; 2], f32)> {
    let mut tops: BTreeMap<[i32; 2], f32> = tops.into_iter().collect();
    for &voxel in &voxels.voxels {
        let (area, top) = crown_box(voxel, origin);
        let [first, last] = [area.low, area.high].map(|corner| square_at(to_f32s(corner), TOP_SIDE));
        for square in (first[1]..=last[1]).flat_map(|north| (first[0]..=last[0]).map(move |east| [east, north])) {
            let highest = tops.entry(square).or_insert(f32::NEG_INFINITY);
            *highest = highest.max(to_f32(top));
        }
    }
    tops.into_iter().collect()
}

/// Returns the square on the map over which a voxel of a crown takes light, and the top of that space, local metres.
pub(crate) fn crown_box(voxel: [i32; 3], origin: [f64; 3]) -> (MapArea, f64) {
    let [low, high] = ExtinctionVoxels::square_of(voxel, origin);
    let reach = VOXEL_SIDE;
    (MapArea { low, high }.widened(reach), ExtinctionVoxels::top_of(voxel, origin) + reach)
}

/// Returns the square on the map that a ball covers.
pub(crate) fn square_of([x, y, _]: [f32; 3], radius: f32) -> MapArea {
    let (middle, radius) = ([x, y].map(f64::from), f64::from(radius));
    MapArea { low: middle.map(|v| v - radius), high: middle.map(|v| v + radius) }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::cast_possible_truncation, reason = "the numbers are small")]

    use super::*;
    use crate::{PlanParams, RunParams, Shard, Steps, TileQuestion, UnfinishedRun, merge, run};
    use belvedere::apps::ask::{ShadowQuestion, Standing, StandingObserver, Suns, ViewLimits, ViewshedQuestion};
    use belvedere::io::{read_balls, read_tif, write_cloud};
    use belvedere::{Frame, PatchKind, SurfacePatches};

    /// Returns level ground of 150 m, and patches of a long building across it, over which no point lies.
    fn survey() -> (PointCloud, SurfacePatches) {
        let positions = (0..150 * 150).map(|i| [(i % 150) as f32 + 0.5, (i / 150) as f32 + 0.5, 2.0]).collect();
        let frame = Frame { origin: [154_624.0, 462_848.0, 0.0], ..Frame::default() };
        let mut patches = SurfacePatches::default();
        let [a, b] = [[10.0, 40.0], [140.0, 110.0]];
        let beside = |[x, y]: [f32; 2]| [x - 5.0, y + 9.0];
        let at = |[x, y]: [f32; 2], z: f32| [x, y, z];
        let mut face = |corners: [[f32; 3]; 4], kind| {
            patches.push([corners[0], corners[1], corners[2]], kind);
            patches.push([corners[0], corners[2], corners[3]], kind);
        };
        face([at(a, 14.0), at(b, 14.0), at(beside(b), 17.0), at(beside(a), 17.0)], PatchKind::Roof);
        face([at(a, 2.0), at(b, 2.0), at(b, 14.0), at(a, 14.0)], PatchKind::Wall);
        (PointCloud { frame, positions, ..PointCloud::default() }, patches)
    }

    /// Returns the answers of a run in tiles of side `side` whose model has the patches.
    fn answers(folder: &Path, side: f64, patches: &SurfacePatches) -> [BTreeMap<[i64; 2], u32>; 2] {
        let control = Control::none();
        let [cloud, run_folder] = ["ground.laz", &format!("tiles_{side}")].map(|name| folder.join(name));
        let suns = Suns::Directions(vec![[2.5_f64.to_degrees(), 0.5_f64.to_degrees()]]);
        let sun = ShadowQuestion { suns, ..ShadowQuestion::of_times(Vec::new()) };
        let sun = TileQuestion::new("sun", sun.into()).unwrap();
        let params = PlanParams { clouds: vec![cloud], tile_size: side, ..PlanParams::default() };
        let plan = Plan::make(&params, &control).unwrap();
        // Relative to the origin of the plan, which may have any value.
        let origin = plan.frame().unwrap().origin;
        let by: [f64; 3] = std::array::from_fn(|i| [154_624.0, 462_848.0, 0.0][i] - origin[i]);
        let eyes =
            [[75.0, 20.0, 4.0], [30.0, 120.0, 30.0]].map(|eye: [f64; 3]| std::array::from_fn(|i| eye[i] + by[i]));
        let observer = |place: [f64; 3]| {
            let standing = Standing { place, height: None };
            StandingObserver { standing, limits: ViewLimits::default() }
        };
        let observers = eyes.map(observer).to_vec();
        let view = ViewshedQuestion { observers, ..ViewshedQuestion::default() };
        let view = TileQuestion::new("view", view.into()).unwrap();
        plan.with_questions(vec![sun.clone(), view.clone()], &control).unwrap().write(&run_folder).unwrap();
        let plan = Plan::read(&run_folder).unwrap();
        let moved = |corner: [f32; 3]| std::array::from_fn(|i| (f64::from(corner[i]) + by[i]) as f32);
        let triangles = patches.triangles.iter().map(|triangle| triangle.map(moved)).collect();
        let all = SurfacePatches { triangles, kinds: patches.kinds.clone() };
        let params = |steps| RunParams { shard: Shard::default(), steps, max_balls: Some(3000), seconds: &|| 0.0 };
        run(&plan, &run_folder, &params(Steps::Balls), &control).unwrap();
        let mut kept = 0;
        for &tile in &plan.tiles {
            // A tile without points has no balls.
            let (path, frame) = (Stage::Balls.result(&plan, &run_folder, tile), plan.frame().unwrap());
            let nothing = ModelParts { frame, ..ModelParts::default() };
            let parts = if path.exists() { read_balls(&path).unwrap() } else { nothing };
            let parts = ModelParts { patches: patches::of_tile(&all, &plan.grid().core(tile), &[]), ..parts };
            kept += parts.patches.len();
            let record = written(&plan, &run_folder, tile, parts, TileRecord::default(), &control).unwrap();
            record.write(&plan, &run_folder, Stage::Balls, tile).unwrap();
        }
        assert!(kept >= patches.len());
        let report = run(&plan, &run_folder, &params(Steps::All), &control).unwrap();
        assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
        let of = |question: &TileQuestion, name: &str| {
            let path = run_folder.join(name);
            merge(&plan, &run_folder, question, &path, UnfinishedRun::Refused, &control).unwrap();
            path
        };
        [of(&sun, "sun.tif"), of(&view, "view.tif")].map(|path| cells(&path))
    }

    /// Returns the values of cells of 1 m by their place.
    fn cells(path: &Path) -> BTreeMap<[i64; 2], u32> {
        let raster = read_tif(path).unwrap();
        let (corner, width) = (raster.place.unwrap().upper_left.map(|v| v.round() as i64), raster.values.width());
        let cell = |(number, value): (usize, &f32)| {
            let place = [corner[0] + (number % width) as i64, corner[1] - (number / width) as i64];
            value.is_finite().then_some((place, value.to_bits()))
        };
        raster.values.values().iter().enumerate().filter_map(cell).collect()
    }

    #[test]
    fn patches_of_tiles_block_as_those_of_the_whole() {
        let folder = tempfile::tempdir().unwrap();
        let (cloud, patches) = survey();
        write_cloud(&folder.path().join("ground.laz"), &cloud, &[]).unwrap();
        let bare = answers(folder.path(), 1024.0, &SurfacePatches::default());
        let whole = answers(folder.path(), 512.0, &patches);
        for (bare, whole) in bare.iter().zip(&whole) {
            let hidden = bare.iter().filter(|(place, value)| whole.get(*place) != Some(value)).count();
            assert!(bare.len() > 20_000 && bare.len() == whole.len() && hidden > 1000, "{hidden} of {}", bare.len());
        }
        for side in [64.0, 100.0] {
            let tiles = answers(folder.path(), side, &patches);
            assert!(tiles == whole, "{side}");
        }
    }
}
