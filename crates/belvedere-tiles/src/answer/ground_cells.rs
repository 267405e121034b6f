//! Cells on the ground. Ground is found in squares that are the same for all tiles, so that tiles make no difference. A
//! kept survey keeps the ground with its balls.

use crate::build::cleared::{ClearedSurface, classed};
use crate::grid::{CELL, MapArea, TileId, square_area, square_at};
use crate::inputs::hash;
use crate::plan::Plan;
use crate::plan::window;
use belvedere::PointCloud;
use belvedere::Result;
use belvedere::apps::targets::{TargetLayout, Targets};
use belvedere::apps::viewshed::cell_targets;
use belvedere::cast::to_f32s;
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::io::{atomic, read_kept_rasters, write_kept_rasters};
use belvedere::query::BlockingTriangles;
use belvedere::raster::Raster;
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

/// Number of cells around a tile that the surface of its cells depends on.
pub(crate) const EDGE_CELLS: usize = 2;

/// Side of a square, metres.
const SQUARE: f64 = 256.0;
/// Width of the margin around a square within which points show its ground, metres. It is 1.5 times the maximum
/// distance of interpolation, so that the triangles below large halls are complete.
const AROUND: f64 = 96.0;

/// Maximum number of cells of squares kept for the next tiles: about 80 MB.
const MAX_KEPT: usize = 4_000_000;

/// Ground of the last squares, which neighbouring tiles share.
#[derive(Default)]
pub(crate) struct GroundSquares(VecDeque<KeptSquare>);

/// Ground of a square.
struct KeptSquare {
    square: MapArea,
    /// Side of the cells, metres.
    cell: f64,
    /// Cells as targets; `None` for a square without known ground.
    found: Option<Arc<Targets>>,
    /// Number of points read for the square.
    points: usize,
}

impl KeptSquare {
    fn cell_count(&self) -> usize {
        self.found.as_ref().map_or(0, |found| found.len())
    }
}

impl GroundSquares {
    /// Returns the ground of a square for cells of side `cell`, metres, and the number of points that show it.
    fn of_square(
        &mut self,
        plan: &Plan,
        (square, cell): (&MapArea, f64),
        added: Option<&BlockingTriangles>,
        control: &Control<'_>,
    ) -> Result<(Option<Arc<Targets>>, usize)> {
        let is_it = |kept: &KeptSquare| kept.square == *square && kept.cell == cell;
        let kept = match self.0.iter().position(is_it).and_then(|at| self.0.remove(at)) {
            Some(kept) => kept,
            None => {
                let file = SquareFile::of(plan, (square, cell));
                let (found, points) = match file.as_ref().and_then(|file| file.read(plan)) {
                    Some(kept) => kept,
                    None => {
                        let cloud =
                            control.stage("reading", 0, || window::read(plan, &square.widened(AROUND), control))?;
                        let find = || of_square(plan, (square, cell), &cloud, added, control);
                        let found = control.stage("computing ground", 0, find)?;
                        file.iter().zip(&found).for_each(|(file, found)| file.write(found, cloud.len()));
                        (found, cloud.len())
                    }
                };
                KeptSquare { square: *square, cell, found: found.map(Arc::new), points }
            }
        };
        let found = (kept.found.clone(), kept.points);
        self.0.push_back(kept);
        while self.0.len() > 1 && self.0.iter().map(KeptSquare::cell_count).sum::<usize>() > MAX_KEPT {
            self.0.pop_front();
        }
        Ok(found)
    }
}

/// File with the ground of a square of a kept survey, for later questions.
struct SquareFile {
    path: PathBuf,
    grid: MapGrid,
}

impl SquareFile {
    /// Returns the file of a square; `None` for a survey that is not kept.
    fn of(plan: &Plan, (square, cell): (&MapArea, f64)) -> Option<Self> {
        let folder = plan.shared_balls.as_ref()?.join("ground");
        // Without meshes the ground is the same for targets of any height.
        let targets = if plan.meshes.is_empty() { plan.targets.with_height(0.0) } else { plan.targets };
        let what = (square.low, cell, targets, plan.ground, &plan.meshes);
        let name = hash(serde_json::to_string(&what).ok()?.as_bytes());
        Some(Self { path: folder.join(format!("{name}.npz")), grid: grid_of(plan, (square, cell)).ok()? })
    }

    /// Returns the cells and the number of points that showed them; `None` for a missing or damaged file.
    fn read(&self, plan: &Plan) -> Option<(Option<Targets>, usize)> {
        let (rasters, points) = read_kept_rasters(&self.path).ok()?;
        let [heights, levels]: [Raster<f32>; 2] = rasters.try_into().ok()?;
        let size = (self.grid.width, self.grid.height);
        let is_sound = [&heights, &levels].iter().all(|raster| (raster.width(), raster.height()) == size);
        let points = points.parse().ok().filter(|_| is_sound)?;
        let ground = Ground { grid: self.grid, heights, gaps: Raster::filled(size.0, size.1, f32::NAN) };
        let mut positions = cell_targets(&ground, plan.targets.height);
        for (position, level) in positions.iter_mut().zip(levels.values()) {
            if level.is_nan() {
                *position = [f32::NAN; 3];
            }
        }
        let layout = TargetLayout::Cells(Box::new(ground));
        Some((Some(Targets::at(plan.frame().ok()?, positions, None, layout)), points))
    }

    /// Writes the cells. Ground that cannot be written is computed again later.
    fn write(&self, found: &Targets, points: usize) {
        let TargetLayout::Cells(ground) = &found.layout else { return };
        let levels = found.positions.iter().map(|position| position[2]).collect();
        let levels = Raster::from_values(self.grid.width, self.grid.height, levels);
        if let (Ok(levels), Some(folder)) = (levels, self.path.parent())
            && atomic::make_folder(folder).is_ok()
        {
            drop(write_kept_rasters(&self.path, &[&ground.heights, &levels], &points.to_string()));
        }
    }
}

/// Returns the area whose points show the ground of the squares that `area` meets.
pub(crate) fn area_around(area: &MapArea) -> MapArea {
    let mut around = squares(area).map(|square| square.widened(AROUND));
    let first = around.next().unwrap_or(*area);
    around.fold(first, |all, square| all.joined(&square))
}

/// Returns the squares that meet an area.
fn squares(area: &MapArea) -> impl Iterator<Item = MapArea> + use<> {
    let number = |place: [f64; 2]| square_at(to_f32s(place), SQUARE);
    let (area, [east, north], [last_east, last_north]) = (*area, number(area.low), number(area.high));
    (north..=last_north)
        .flat_map(move |north| (east..=last_east).map(move |east| square_area([east, north], SQUARE)))
        .filter(move |square| square.meets(&area))
}

/// Returns the cells of a tile, with sides in metres, as targets on the ground. Cells under a cover or inside `added`
/// meshes are left out. Their number and the number of points read follow.
pub(crate) fn ground_cells(
    plan: &Plan,
    (tile, cell): (TileId, f64),
    known: &mut GroundSquares,
    added: Option<&BlockingTriangles>,
    control: &Control<'_>,
) -> Result<(Targets, [usize; 2])> {
    let core = plan.grid().core(tile);
    let grid = plan.cells_of_tile(tile, cell);
    let count = grid.width;
    let mut positions = vec![[f32::NAN; 3]; count * count];
    let mut heights = Raster::filled(count, count, f32::NAN);
    let (mut covered, mut points) = (0, 0);
    // A cell with a part inside the survey.
    let survey = plan.area().widened(cell / 2.0);
    for square in squares(&core) {
        control.check()?;
        let (found, read) = known.of_square(plan, (&square, cell), added, control)?;
        points += read;
        let Some(found) = found else { continue };
        let TargetLayout::Cells(ground) = &found.layout else { continue };
        for (at, &position) in found.positions.iter().enumerate() {
            let (column, row) = (at % ground.grid.width, at / ground.grid.width);
            let middle = ground.grid.center(column, row);
            let Some(own) = grid.cell_of(middle).filter(|_| square.holds(middle) && survey.holds(middle)) else {
                continue;
            };
            let own = own[1] * count + own[0];
            let height = ground.heights.get(column, row).unwrap_or(f32::NAN);
            covered += usize::from(height.is_finite() && position[2].is_nan());
            if let (Some(place), Some(value)) = (positions.get_mut(own), heights.values_mut().get_mut(own)) {
                (*place, *value) = (position, height);
            }
        }
    }
    let ground = Ground { grid, heights, gaps: Raster::filled(count, count, f32::NAN) };
    let layout = TargetLayout::Cells(Box::new(ground));
    Ok((Targets::at(plan.frame()?, positions, None, layout), [covered, points]))
}

/// Returns the grid of a square and of its edge.
fn grid_of(plan: &Plan, (square, cell): (&MapArea, f64)) -> Result<MapGrid> {
    let edge = square.widened(EDGE_CELLS as f64 * cell);
    let [x, y, _] = plan.frame.origin;
    MapGrid::covering(edge.low, edge.high, cell, [x, y])
}

/// Returns the cells of a square and of its edge; `None` for a square without known ground.
fn of_square(
    plan: &Plan,
    (square, cell): (&MapArea, f64),
    cloud: &PointCloud,
    added: Option<&BlockingTriangles>,
    control: &Control<'_>,
) -> Result<Option<Targets>> {
    let points = classed(cloud, 0..cloud.len());
    let cleared = ClearedSurface::new(plan, (&square.widened(AROUND), square), &points, &[], control)?;
    let rows = |goes: bool| -> Vec<u32> {
        (0..).zip(&cleared.is_cleared).filter(|(_, is_cleared)| **is_cleared == goes).map(|(row, _)| row).collect()
    };
    let gone = rows(true);
    let left;
    let cloud = if gone.is_empty() {
        cloud
    } else {
        let mut rest = cloud.select(&rows(false));
        let places = gone.iter().filter_map(|&row| cloud.positions.get(row as usize));
        rest.cleared_places.extend(places.map(|&[x, y, _]| [x, y]));
        left = rest;
        &left
    };
    let grid = grid_of(plan, (square, cell))?;
    let params = GroundParams { points: plan.ground, ..GroundParams::default() };
    let ground = match Ground::of_cloud(cloud, grid, &params, control) {
        Ok((ground, _)) => ground,
        Err(error) if window::is_nothing(&error) => return Ok(None),
        Err(error) => return Err(error),
    };
    let (mut targets, _) = Targets::of_cells(cloud, ground, &plan.targets, control)?;
    if let Some(added) = added {
        targets.set_on_added(added, &plan.targets);
    }
    Ok(Some(targets))
}

impl Plan {
    /// Returns a lower bound of the heights of cells of side `cell` on a tile, local metres.
    pub(crate) fn lowest_of_cells(&self, tile: TileId, cell: f64) -> f64 {
        let core = self.grid().core(tile);
        let around = core.widened(self.reach(cell));
        // Closed ground is interpolated between points of all blocks around.
        let around = if self.cleared.is_empty() { around } else { around.joined(&core.in_blocks().widened(CELL)) };
        let around = if self.is_on_ground() { around.joined(&area_around(&core)) } else { around };
        self.blocks_in(&around).map(|block| f64::from(block.heights[0])).fold(f64::INFINITY, f64::min)
    }
}
