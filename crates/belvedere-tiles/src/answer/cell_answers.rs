//! Answer to a question on the cells of a tile.

use crate::answer::ground_cells::{EDGE_CELLS, GroundSquares, ground_cells};
use crate::answer::how_sure::PartialEvidence;
use crate::answer::lines::AreaLines;
use crate::answer::obstacles::{ObstacleSearch, rule};
use crate::answer::parts::TileObstacles;
use crate::answer::proof::{Line, unproven};
use crate::build::cleared::{ClassedPoint, ClearedSurface, classed};
use crate::grid::TileId;
use crate::plan::Plan;
use crate::plan::question::{LightQuestion, PreparedQuestion, TileQuestion};
use crate::plan::record::{Stamp, TileOutcome, TileRecord};
use crate::plan::side_files::Others;
use crate::plan::stage::Stage;
use crate::plan::window;
use belvedere::apps::edge::near_edge;
use belvedere::apps::eyes::skip_unfit_eyes;
use belvedere::apps::irradiance::season_irradiation;
use belvedere::apps::rows::SkyObstacles;
use belvedere::apps::shadow::{Edges, half_or_more, scene_shadow};
use belvedere::apps::sky_view::scene_sky_view;
use belvedere::apps::sum_errors::Intervals;
use belvedere::apps::sun_hours::scene_sun_hours;
use belvedere::apps::targets::{Measure, TargetLayout, Targets};
use belvedere::apps::viewshed::{Masks, Observer, Viewshed, ViewshedParams, viewshed};
use belvedere::cast::{to_f32, to_f32s, to_row};
use belvedere::clean::clean;
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid, SurfaceParams, top_surface};
use belvedere::io::atomic;
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockingTriangles, Coverage, MedialScene};
use belvedere::raster::Raster;
use belvedere::results::{Pixels, ResultKind, ResultRaster, georeference};
use belvedere::vector::{dot, sub};
use belvedere::{PointCloud, Result};
use rayon::prelude::*;
use std::path::Path;

/// Number of targets that a thread takes at once.
const CHUNK: usize = 1024;

/// Question about tiles, with the data that its answer needs.
#[derive(Clone, Copy)]
pub(crate) struct TileTask<'a> {
    pub(crate) question: &'a TileQuestion,
    pub(crate) prepared: &'a PreparedQuestion,
    /// Obstacles other than balls.
    pub(crate) others: &'a Others,
    /// Maximum number of balls that are tested together.
    pub(crate) max_balls: usize,
}

/// Surfaces that answers share, for one tile and for neighbouring tiles.
#[derive(Default)]
pub(crate) struct SharedSurfaces {
    /// Surface of the last answer for the tile; the next answer may have the same cells.
    last: Option<TileSurface>,
    ground: GroundSquares,
}

impl SharedSurfaces {
    /// Removes the surface of the last tile.
    pub(crate) fn next_tile(&mut self) {
        self.last = None;
    }
}

/// Cells of a tile on the ground, or on top of present and planned objects.
pub(crate) struct TileSurface {
    /// Side of a cell, metres.
    cell: f64,
    /// Number of points read for the surface.
    points: usize,
    /// Number of cells on the ground under a cover, which are no targets.
    covered: usize,
    targets: Targets,
}

/// Returns the area of the points that the cells of a tile need.
fn area_of_cells(plan: &Plan, tile: TileId, cell: f64) -> crate::grid::MapArea {
    let farthest = f64::from(plan.statistics.farthest()) + plan.statistics.isolation_radius.unwrap_or(0.0);
    plan.grid().core(tile).widened(farthest + (EDGE_CELLS + 1) as f64 * cell)
}

/// Answers a question for the cells of a tile, and writes the answer; the caller writes the record next. It uses the
/// balls in the folder of the run. Answers that missing balls can change are unproven. `surfaces` keeps the surfaces of
/// earlier answers.
///
/// # Errors
/// Those of reading the files and the balls, and of writing.
pub(crate) fn answer(
    plan: &Plan,
    run: &Path,
    task: TileTask<'_>,
    tile: TileId,
    surfaces: &mut SharedSurfaces,
    control: &Control<'_>,
) -> Result<TileRecord> {
    let TileTask { question, prepared, others, max_balls } = task;
    let stage = Stage::Answer(question);
    atomic::make_folder(&stage.folder(plan, run))?;
    let core = plan.grid().core(tile);
    let nothing = |points: usize| Ok(TileRecord { points, ..TileRecord::default() });
    if AreaLines::of(prepared, core, 0.0).is_empty() {
        return nothing(0);
    }
    let cell = plan.cells.of(question);
    let surface = match surfaces.last.take().filter(|last| last.cell == cell) {
        Some(surface) => surface,
        None => TileSurface::new(plan, (tile, cell), &mut surfaces.ground, others, control)?,
    };
    let TileSurface { points, covered, targets, .. } = surfaces.last.insert(surface);
    let (points, covered) = (*points, *covered);
    let (cells, TargetLayout::Cells(ground)) = (targets.target_count(), &targets.layout) else {
        return nothing(points);
    };
    if cells == 0 {
        return nothing(points);
    }
    let known = targets.positions.iter().filter(|p| p[2].is_finite());
    let lowest = known.map(|p| f64::from(p[2])).fold(f64::INFINITY, f64::min);
    let lines = AreaLines::of(prepared, core, lowest);
    let size = [ground.grid.width, ground.grid.height];
    let parts = TileObstacles::around((plan, run, tile), &lines, others, max_balls, control)?;
    let (found, balls) = match prepared {
        PreparedQuestion::Viewshed { observers, is_reverse } => {
            let mut sight = PartialSight::new(observers, *is_reverse, &targets.positions);
            parts.each_scene(&lines, control, |scene, _| sight.look(scene, control))?;
            let planned = MedialScene::new(&MedialBalls::default(), &rule(plan))?.with_triangles(others.added.clone());
            sight.look(&planned, control)?;
            let mut balls = parts.into_found();
            let is_without_proof = match plan.proves {
                true => sight.without_proof((plan, run), targets, &mut balls, control)?,
                false => Vec::new(),
            };
            (sight.answered(&balls, &is_without_proof, size)?, balls)
        }
        PreparedQuestion::Light(light) => {
            let names = question.band_names(plan.kind_of(question));
            lit((plan, run), (light, &names), parts, targets, size, control)?
        }
        PreparedQuestion::Probability { of, certainty } => {
            let mut evidence = PartialEvidence::new(of, &targets.positions)?;
            evidence.gather(plan, (&parts, others), &lines, control)?;
            let mut balls = parts.into_found();
            let (mut bands, unproven_cells) = evidence.bands((plan, run), *certainty, &mut balls, control)?;
            bands.iter_mut().for_each(|band| targets.clear_unasked(band));
            let values = Pixels::numbers(bands, size)?;
            (CellAnswers { values, unproven_cells, skipped_observers: 0 }, balls)
        }
    };
    let near_edge_cells = match prepared {
        PreparedQuestion::Light(light) => Some(near_edge_count(plan, targets, light.directions(), control)?),
        PreparedQuestion::Viewshed { .. } | PreparedQuestion::Probability { .. } => None,
    };
    if found.values.are_nothing() && found.unproven_cells == 0 {
        return Ok(TileRecord { points, covered_cells: covered, damaged: balls.damaged, ..TileRecord::default() });
    }
    let place = georeference(&ground.grid, &targets.frame);
    let path = stage.result(plan, run, tile);
    let labels = question.band_labels(found.values.kind());
    let description = question.description().to_owned();
    let raster = ResultRaster { pixels: found.values, labels, tags: Vec::new(), description };
    raster.write(&path, Some(&place))?;
    Ok(TileRecord {
        outcome: TileOutcome::Done,
        result: Some(Stamp::of(&path)?),
        damaged: balls.damaged,
        points,
        balls: balls.ball_count,
        max_balls: balls.max_held,
        cells,
        covered_cells: covered,
        unproven_cells: found.unproven_cells,
        near_edge_cells,
        skipped_observers: found.skipped_observers,
        ..TileRecord::default()
    })
}

impl TileSurface {
    fn new(
        plan: &Plan,
        (tile, cell): (TileId, f64),
        ground: &mut GroundSquares,
        others: &Others,
        control: &Control<'_>,
    ) -> Result<Self> {
        if plan.is_on_ground() {
            let (targets, [covered, points]) =
                ground_cells(plan, (tile, cell), ground, others.added.as_ref(), control)?;
            return Ok(Self { cell, points, covered, targets });
        }
        let cloud = control.stage("reading", 0, || window::read(plan, &area_of_cells(plan, tile, cell), control))?;
        let added = others.added.as_ref();
        let targets =
            control.stage("computing top surface", 0, || cells(plan, (tile, cell), &cloud, added, control))?;
        Ok(Self { cell, points: cloud.len(), covered: 0, targets })
    }
}

/// Counts targets near the edge of the survey for light from `directions`.
fn near_edge_count(plan: &Plan, targets: &Targets, directions: &[[f64; 3]], control: &Control<'_>) -> Result<usize> {
    let Some(coverage) = Coverage::of(plan.bounds()) else { return Ok(0) };
    let flags = near_edge(&coverage, &targets.positions, directions, control)?;
    Ok(flags.iter().filter(|flag| **flag == Some(true)).count())
}

/// Answers for the cells of a tile.
struct CellAnswers {
    values: Pixels,
    unproven_cells: usize,
    skipped_observers: usize,
}

/// Returns the light that reaches targets, and the report on the balls.
fn lit(
    (plan, run): (&Plan, &Path),
    (light, names): (&LightQuestion, &[String]),
    parts: TileObstacles<'_>,
    targets: &Targets,
    size: [usize; 2],
    control: &Control<'_>,
) -> Result<(CellAnswers, ObstacleSearch)> {
    let around = SkyObstacles::InParts(&parts);
    let bands = match light {
        LightQuestion::Shadow(sun) => scene_shadow(around, targets, &[*sun], Edges::Hard, control)?,
        LightQuestion::SunRule { plan, site } => {
            let sums = scene_sun_hours(around, targets, plan, Some(site), Intervals::Without, control)?;
            // The rule comes after the measures of its days.
            sums.into_measures(plan, targets).pop().map(|measure| measure.values).into_iter().collect()
        }
        LightQuestion::Sky(sky, intervals) => {
            wanted(scene_sky_view(around, targets, sky, *intervals, control)?.into_measures(), names)
        }
        LightQuestion::SunHours { plan, site, intervals } => {
            let sums = scene_sun_hours(around, targets, plan, Some(site), *intervals, control)?;
            wanted(sums.into_measures(plan, targets), names)
        }
        LightQuestion::Irradiance { seasons, intervals, .. } => {
            wanted(season_irradiation(around, targets, seasons, *intervals, control)?.into_measures(), names)
        }
    };
    let is_yes_or_no = match light {
        LightQuestion::Shadow(_) => !around.crowns().is_some_and(|crowns| crowns.gives_shares()),
        LightQuestion::SunRule { .. } => true,
        LightQuestion::Sky(..) | LightQuestion::SunHours { .. } | LightQuestion::Irradiance { .. } => false,
    };
    let mut balls = parts.into_found();
    let is_missing = unknown_towards(&balls, targets, light.directions());
    if !is_yes_or_no {
        return Ok((measured(bands, &is_missing, size)?, balls));
    }
    let mut numbers = bands.into_iter().next().unwrap_or_default();
    numbers.iter_mut().for_each(|share| *share = half_or_more(*share));
    let is_without_proof = match light {
        LightQuestion::Shadow(sun) if plan.proves => {
            let lit = numbers.iter().zip(&is_missing).map(|(&lit, &is_missing)| lit > 0.0 && !is_missing);
            let line = |target: [f64; 3]| Line { target, towards: sun.to_sun, range: f64::INFINITY };
            without_proof((plan, run), lit, targets, line, &mut balls, control)?
        }
        _ => Vec::new(),
    };
    Ok((yes_or_no(&numbers, &is_missing, &is_without_proof, size)?, balls))
}

/// Flags the targets with a free line of sight that no pulse proves. `are_free` flags the free lines.
fn without_proof(
    of_run: (&Plan, &Path),
    are_free: impl Iterator<Item = bool>,
    targets: &Targets,
    line: impl Fn([f64; 3]) -> Line,
    balls: &mut ObstacleSearch,
    control: &Control<'_>,
) -> Result<Vec<bool>> {
    let rows: Vec<usize> = are_free.enumerate().filter(|(_, is_free)| *is_free).map(|(row, _)| row).collect();
    let place = |&row: &usize| targets.positions.get(row).map(|position| line(position.map(f64::from)));
    let lines: Vec<Line> = rows.iter().filter_map(place).collect();
    let found = control.stage("testing pulses", 0, || unproven(of_run, &lines, balls, control))?;
    let mut is_without = vec![false; targets.len()];
    for (row, is_unproven) in rows.into_iter().zip(found) {
        is_without[row] = is_unproven;
    }
    Ok(is_without)
}

/// Returns the numbers of targets, one band each, without those that missing balls may change.
fn measured(mut bands: Vec<Vec<f32>>, is_unknown: &[bool], size: [usize; 2]) -> Result<CellAnswers> {
    let values = bands.first().into_iter().flatten().zip(is_unknown);
    let unproven_cells = values.filter(|(value, is_unknown)| value.is_finite() && **is_unknown).count();
    for band in &mut bands {
        band.iter_mut().zip(is_unknown).filter(|(_, unknown)| **unknown).for_each(|(value, _)| *value = f32::NAN);
    }
    Ok(CellAnswers { values: Pixels::numbers(bands, size)?, unproven_cells, skipped_observers: 0 })
}

/// Returns the values of the measures with these names of bands.
fn wanted(measures: Vec<Measure>, names: &[String]) -> Vec<Vec<f32>> {
    let is_wanted = |measure: &Measure| names.contains(&measure.name);
    measures.into_iter().filter(is_wanted).map(|measure| measure.values).collect()
}

/// Returns the answers for targets that are lit or not. A lit target is unproven if missing balls may block it, or if
/// no pulse proves it.
fn yes_or_no(lit: &[f32], is_missing: &[bool], is_without_proof: &[bool], size: [usize; 2]) -> Result<CellAnswers> {
    let answer = |row: usize| (!lit[row].is_nan()).then_some(lit[row] > 0.0);
    let is_unproven = |row: usize| is_missing[row] || is_without_proof.get(row) == Some(&true);
    let rows = || 0..lit.len();
    let answers = rows().map(|row| ResultKind::answer(answer(row))).collect();
    let unproven = rows().map(|row| ResultKind::answer(answer(row).map(|is_lit| is_lit && is_unproven(row)))).collect();
    let unproven_cells = rows().filter(|&row| is_missing[row] && answer(row) == Some(true)).count();
    Ok(CellAnswers { values: Pixels::answers([answers, unproven], size)?, unproven_cells, skipped_observers: 0 })
}

/// Flags the targets that missing balls may block in any of `directions`.
fn unknown_towards(balls: &ObstacleSearch, targets: &Targets, directions: &[[f64; 3]]) -> Vec<bool> {
    let is_unknown = |position: &[f32; 3]| {
        let position = position.map(f64::from);
        !balls.missing.is_empty()
            && position.iter().all(|v| v.is_finite())
            && directions.iter().any(|&direction| balls.is_unknown(position, direction, f64::INFINITY))
    };
    targets.positions.par_iter().with_min_len(CHUNK).map(is_unknown).collect()
}

/// Visibility of targets from observers, past one part of the obstacles after the other.
struct PartialSight<'a> {
    /// Observers. The eye of an observer inside an obstacle is not finite, except in a reverse viewshed.
    observers: Vec<Observer>,
    is_reverse: bool,
    targets: &'a [[f32; 3]],
    /// Visibility past all parts so far; `None` before the first part.
    seen: Option<Viewshed>,
}

impl<'a> PartialSight<'a> {
    fn new(observers: &[Observer], is_reverse: bool, targets: &'a [[f32; 3]]) -> Self {
        Self { observers: observers.to_vec(), is_reverse, targets, seen: None }
    }

    /// Removes the targets that `scene` blocks.
    fn look(&mut self, scene: &MedialScene, control: &Control<'_>) -> Result<()> {
        if !self.is_reverse {
            let mut eyes: Vec<[f64; 3]> = self.observers.iter().map(|observer| observer.eye).collect();
            skip_unfit_eyes(scene, None, &mut eyes, control)?;
            self.observers.iter_mut().zip(eyes).for_each(|(observer, eye)| observer.eye = eye);
        }
        let params = ViewshedParams::default().with_masks(Masks::Kept);
        let look = || viewshed(scene, &self.observers, self.targets, &params, control);
        let mut seen = control.stage("testing lines of sight", self.observers.len(), look)?;
        if let Some(before) = &self.seen {
            for (bits, before) in seen.masks.iter_mut().flatten().zip(before.masks.iter().flatten()) {
                *bits &= before;
            }
        }
        self.seen = Some(seen);
        Ok(())
    }

    /// Flags for each observer the visible targets that no pulse proves.
    fn without_proof(
        &self,
        of_run: (&Plan, &Path),
        targets: &Targets,
        balls: &mut ObstacleSearch,
        control: &Control<'_>,
    ) -> Result<Vec<Vec<bool>>> {
        let Some(seen) = &self.seen else { return Ok(Vec::new()) };
        let of_observer = |(number, observer): (usize, &Observer)| {
            let are_seen = (0..self.targets.len()).map(|row| sees(&seen.masks, row, number));
            let line = |target: [f64; 3]| {
                let way = sub(observer.eye, target);
                let range = dot(way, way).sqrt();
                Line { target, towards: way.map(|v| v / range), range }
            };
            without_proof(of_run, are_seen, targets, line, balls, control)
        };
        self.observers.iter().enumerate().map(of_observer).collect()
    }

    /// Returns the visibility past all parts. It is unproven where missing `balls` may block it, or where
    /// `is_without_proof` has a flag for the observer.
    fn answered(self, balls: &ObstacleSearch, is_without_proof: &[Vec<bool>], size: [usize; 2]) -> Result<CellAnswers> {
        let Self { observers, targets, seen, .. } = self;
        let (answers, masks) = seen.map(|seen| (seen.answers, seen.masks)).unwrap_or_default();
        let is_unknown = |target: [f32; 3], eye: [f64; 3]| {
            let target = target.map(f64::from);
            !balls.missing.is_empty() && balls.is_unknown(target, sub(eye, target), 1.0)
        };
        // Number of observers that see a target, of these the unproven ones, and of these the ones with missing balls.
        let counts = |row: usize| {
            let seen_by = || observers.iter().enumerate().filter(|(number, _)| sees(&masks, row, *number));
            let is_missing = |observer: &Observer| is_unknown(targets[row], observer.eye);
            let is_bare = |number: usize| is_without_proof.get(number).is_some_and(|rows| rows.get(row) == Some(&true));
            let missing = seen_by().filter(|(_, observer)| is_missing(observer)).count();
            let unproven = seen_by().filter(|(number, observer)| is_bare(*number) || is_missing(observer)).count();
            [seen_by().count(), unproven, missing]
        };
        let counts: Vec<[usize; 3]> = (0..targets.len()).into_par_iter().with_min_len(CHUNK).map(counts).collect();
        let is_target = |answer: Answer| !matches!(answer, Answer::OutsideView | Answer::OutsideCloud);
        let cells = || answers.iter().zip(&counts).map(|(&answer, &counts)| is_target(answer).then_some(counts));
        let values = match observers.len() {
            1 => {
                let band = |i: usize| cells().map(|counts| ResultKind::answer(counts.map(|c| c[i] > 0))).collect();
                Pixels::answers([band(0), band(1)], size)?
            }
            _ => {
                let band = |i: usize| cells().map(|counts| ResultKind::count(counts.map(|c| to_row(c[i])))).collect();
                Pixels::counts([band(0), band(1)], size)?
            }
        };
        Ok(CellAnswers {
            values,
            unproven_cells: counts.iter().filter(|[_, _, missing]| *missing > 0).count(),
            skipped_observers: observers.iter().filter(|observer| !observer.eye.iter().all(|v| v.is_finite())).count(),
        })
    }
}

/// True if observer `number` sees the target in row `row`.
fn sees(masks: &[Vec<u32>], row: usize, number: usize) -> bool {
    masks.get(number / 32).and_then(|band| band.get(row)).is_some_and(|bits| bits >> (number % 32) & 1 == 1)
}

/// Returns the cells of a tile, with sides in metres, as targets on top of present and planned objects.
fn cells(
    plan: &Plan,
    (tile, cell): (TileId, f64),
    cloud: &PointCloud,
    added: Option<&BlockingTriangles>,
    control: &Control<'_>,
) -> Result<Targets> {
    let (kept, _) = clean(cloud, &plan.statistics.cleaning(&plan.model().clean), control)?;
    let core = plan.grid().core(tile);
    let grid = plan.cells_of_tile(tile, cell);
    let count = grid.width;
    let places = (0..count).flat_map(|row| (0..count).map(move |column| (column, row)));
    let middles: Vec<[f64; 2]> = places.clone().map(|(column, row)| grid.center(column, row)).collect();
    let points = classed(cloud, kept.iter().map(|&row| row as usize));
    let areas = (&area_of_cells(plan, tile, cell), &core);
    let cleared = ClearedSurface::new(plan, areas, &points, &middles, control)?;
    let stays = |(point, is_cleared): (&ClassedPoint, &bool)| (!is_cleared).then_some(point.0);
    let positions: Vec<[f32; 3]> = points.iter().zip(&cleared.is_cleared).filter_map(stays).collect();
    let edge = EDGE_CELLS as f64 * cell;
    let wide = MapGrid {
        corner: [core.low[0] - edge, core.high[1] + edge],
        cell,
        width: count + 2 * EDGE_CELLS,
        height: count + 2 * EDGE_CELLS,
    };
    let unknown = Raster::filled(wide.width, wide.height, f32::NAN);
    let flat = Ground { grid: wide, heights: unknown.clone(), gaps: unknown };
    let params = SurfaceParams { farthest: plan.statistics.farthest(), ..SurfaceParams::default() };
    let heights = top_surface(&positions, &flat, &params, control)?;
    let of_cell =
        |(column, row): (usize, usize)| heights.get(column + EDGE_CELLS, row + EDGE_CELLS).unwrap_or(f32::NAN);
    let mut heights = Raster::from_values(count, count, places.clone().map(of_cell).collect())?;
    for (place, height) in cleared.ground {
        if let Some(value) = heights.values_mut().get_mut(place).filter(|value| value.is_nan()) {
            *value = to_f32(height);
        }
    }
    if let Some(added) = added {
        added.raise(&mut heights, &grid);
    }
    let position = |(column, row): (usize, usize)| {
        let [x, y] = grid.center(column, row);
        let z = f64::from(heights.get(column, row).unwrap_or(f32::NAN)) + plan.targets.height;
        if z.is_finite() { to_f32s([x, y, z]) } else { [f32::NAN; 3] }
    };
    let positions = places.map(position).collect();
    let gaps = Raster::filled(count, count, f32::NAN);
    let layout = TargetLayout::Cells(Box::new(Ground { grid, heights, gaps }));
    Ok(Targets::at(cloud.frame.clone(), positions, None, layout))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::MapArea;
    use belvedere::apps::viewshed::SightLimits;
    use belvedere::blocking::BlockRule;

    #[test]
    fn views_that_missing_tiles_may_block_are_unproven() {
        // A ball of 2 m in the east, and an unknown area in the north.
        let mut east = MedialBalls::default();
        east.push(0, [10.0, 0.0, 2.0], 2.0, 0);
        let scene = MedialScene::new(&east, &BlockRule::carved()).unwrap();
        let nothing = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap();
        let missing = vec![(MapArea { low: [-5.0, 10.0], high: [5.0, 20.0] }, 30.0)];
        let balls = ObstacleSearch { missing, ..ObstacleSearch::default() };
        let positions = vec![
            [-20.0, 0.0, 2.0],  // visible
            [20.0, 0.0, 2.0],   // behind the ball
            [0.0, 40.0, 2.0],   // behind the unknown area
            [0.0, 5.0, 2.0],    // in front of it
            [0.0, 40.0, 200.0], // high above it
            [-90.0, 0.0, 2.0],  // too far away
            [f32::NAN; 3],
        ];
        // The parts of the obstacles in any order.
        let see = |observers: &[Observer], parts: [&MedialScene; 2]| {
            let mut sight = PartialSight::new(observers, false, &positions);
            parts.into_iter().for_each(|scene| sight.look(scene, &Control::none()).unwrap());
            sight.answered(&balls, &[], [7, 1]).unwrap()
        };
        let limits = SightLimits { distance: [0.0, 50.0], ..SightLimits::default() };
        let low = Observer { eye: [0.0, 0.0, 2.0], limits };
        let several = [low, Observer { eye: [0.0, 0.0, 80.0], limits }, Observer { eye: [10.0, 0.0, 2.0], limits }];
        for parts in [[&scene, &nothing], [&nothing, &scene]] {
            let found = see(&[low], parts);
            let Pixels::Answers(bands) = &found.values else { panic!("answers of one observer") };
            assert_eq!(bands[0].values(), [1, 0, 1, 1, 1, 255, 255]);
            assert_eq!(bands[1].values(), [0, 0, 1, 0, 0, 255, 255]);
            assert_eq!((found.unproven_cells, found.skipped_observers), (1, 0));
            // Two more observers: one high above, and one inside the ball, which sees nothing.
            let found = see(&several, parts);
            let Pixels::Counts(bands) = &found.values else { panic!("counts of several observers") };
            assert_eq!(bands[0].values(), [2, 1, 2, 2, 2, 65_535, 65_535]);
            assert_eq!(bands[1].values(), [0, 0, 1, 0, 0, 65_535, 65_535]);
            assert_eq!((found.unproven_cells, found.skipped_observers), (1, 1));
        }
    }
}
