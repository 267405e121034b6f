//! Obstacles of a tile part by part: memory does not grow with the area that its lines of sight cross.
//!
//! The lowest of many directions of the sky meets balls all over a city. But a line of sight is free only if no ball
//! blocks it. Balls may therefore be tested one part after the other, and the division into parts does not change the
//! answer. Parts are squares of tiles, the nearest first, because most lines end at the nearest. In a distant part only
//! balls high enough to block a line that is still free are tested. Lines of sight to observers are tested in parts as
//! well.

use crate::answer::lines::{AreaLines, MAX_BALL};
use crate::answer::obstacles::{BallTile, ObstacleSearch, ball_tiles, may_block, push, rule};
use crate::answer::strips::Strips;
use crate::answer::surroundings::TileSurroundings;
use crate::build::patches;
use crate::grid::{MapArea, TOP_SIDE, TileId, square_area};
use crate::plan::Plan;
use belvedere::apps::tree_light::CrownLight;
use belvedere::blocking::BlockRule;
use belvedere::control::Control;
use belvedere::medial::{MedialBalls, vegetation_of_transmission};
use belvedere::medium::Medium;
use belvedere::model::ModelParts;
use belvedere::query::{BlockingTriangles, FreeLines, MedialScene, VisibilityMatrix};
use belvedere::{ExtinctionVoxels, Result, SurfacePatches};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Distances from the cells that divide the balls of a tile into groups, tested from near to far, metres. After the
/// first group few lines of sight are left.
const BANDS: [f64; 4] = [64.0, 192.0, 448.0, f64::INFINITY];
/// Number of targets that a thread takes at once.
const CHUNK: usize = 256;
/// Number of collected balls that starts a test before more balls are looked up.
const MIN_TEST_BATCH: usize = 100_000;

/// Balls that may block lines from the cells of a tile; only one part is in memory at a time.
pub(crate) struct TileObstacles {
    pub(crate) tile: Arc<TileSurroundings>,
    /// Squares of tiles, the nearest first.
    squares: Vec<Vec<BallTile>>,
    /// Crowns as a medium, if they were measured and let light through.
    medium: Option<Medium>,
}

impl TileObstacles {
    /// Finds the balls that may block `lines` from the cells of a tile.
    ///
    /// # Errors
    /// [`belvedere::Error::Cancelled`].
    pub(crate) fn around(tile: &Arc<TileSurroundings>, lines: &AreaLines<'_>, control: &Control<'_>) -> Result<Self> {
        let TileSurroundings { plan, run, tile: number, max_balls, .. } = &**tile;
        let mut found = tile.found();
        let tiles = ball_tiles(plan, run, lines, &mut found, control)?;
        let medium = match plan.trees {
            Some(CrownLight::Measured { .. }) => {
                let mut voxels = Vec::new();
                for of_tile in &tiles {
                    control.check()?;
                    found.add_crowns((plan, run, of_tile.tile), lines, &mut voxels, control)?;
                }
                voxels.sort_unstable_by_key(|(voxel, _)| *voxel);
                let (voxels, extinction) = voxels.into_iter().unzip();
                Some(Medium::new(&ExtinctionVoxels { voxels, extinction }, plan.frame.origin))
            }
            _ => None,
        };
        let squares = squares(*number, tiles, *max_balls);
        Ok(Self { tile: Arc::clone(tile), squares, medium })
    }

    /// Passes to `look` scenes of at most `max_balls` balls that may block one of `lines`, until all were passed. For
    /// measured crowns each scene comes with a second one without vegetation. A line of sight is free if it is free in
    /// all scenes.
    ///
    /// # Errors
    /// Those of `look`, of writing records, and [`belvedere::Error::Cancelled`].
    pub(crate) fn each_scene(
        &self,
        lines: &AreaLines<'_>,
        control: &Control<'_>,
        mut look: impl FnMut(&MedialScene, Option<&MedialScene>) -> Result<()>,
    ) -> Result<()> {
        let TileSurroundings { plan, run, max_balls, .. } = &*self.tile;
        let mut found = self.tile.found();
        let mut part =
            SceneBatch { solid: self.medium.as_ref().map(|_| MedialBalls::default()), ..SceneBatch::default() };
        for of_tile in self.squares.iter().flatten() {
            control.check()?;
            let read = control.stage("reading balls", 0, || found.read(plan, run, of_tile.tile, control))?;
            let Some(ModelParts { balls, patches: of_tile, transmission, .. }) = read else { continue };
            let blocking = patches::select(&of_tile, |area, top| lines.may_meet(area, top));
            blocking.iter().for_each(|(corners, kind)| part.patches.push(*corners, kind));
            let vegetation = vegetation_of_transmission(&transmission);
            for row in may_block(&balls, lines) {
                if part.all.len() == *max_balls {
                    let (scene, solid) = part.taken(&rule(plan), &mut found, control)?;
                    look(&scene, solid.as_ref())?;
                }
                push(&mut part.all, &balls, row);
                if let Some(solid) = part.solid.as_mut().filter(|_| vegetation.get(row) != Some(&true)) {
                    push(solid, &balls, row);
                }
            }
        }
        let (scene, solid) = part.taken(&rule(plan), &mut found, control)?;
        look(&scene, solid.as_ref())
    }

    /// Removes the lines of `free` that a square of tiles blocks, part by part.
    fn hide(
        &self,
        free: &mut Free<'_>,
        square: &[BallTile],
        found: &mut ObstacleSearch,
        control: &Control<'_>,
    ) -> Result<()> {
        let TileSurroundings { plan, run, max_balls, cells, .. } = &*self.tile;
        let mut part = BallBatch::default();
        for BallTile { tile, tops, .. } in square {
            control.check()?;
            if free.strips.meeting(tops).is_empty() {
                continue;
            }
            let read = control.stage("reading balls", 0, || found.read(plan, run, *tile, control))?;
            let Some(ModelParts { balls, transmission, patches, .. }) = read else { continue };
            patches.iter().for_each(|(corners, kind)| part.patches.push(*corners, kind));
            let vegetation = plan.trees.map(|_| vegetation_of_transmission(&transmission)).unwrap_or_default();
            let distance = |center: &[f32; 3]| cells.distance(&MapArea::at(center.map(f64::from)));
            let distances: Vec<f64> = balls.centers.par_iter().map(distance).collect();
            let mut from = f64::NEG_INFINITY;
            for to in BANDS {
                // The distance to the far corner of a square that a ball reaches into.
                let reach = 1.5 * TOP_SIDE + MAX_BALL;
                let may_reach = |&&(number, _): &&([i32; 2], f32)| {
                    let distance = cells.distance(&square_area(number, TOP_SIDE));
                    distance + reach > from && distance <= to + reach
                };
                let tops: Vec<_> = tops.iter().filter(may_reach).copied().collect();
                let met = free.strips.meeting(&tops);
                part.columns.extend(&met);
                let min_tops = free.strips.min_tops(&met, &tops);
                let is_in = |row: &usize| distances[*row] > from && distances[*row] <= to;
                let may_block = |row: &usize| min_tops.may_block(balls.centers[*row], balls.radii[*row]);
                let rows: Vec<usize> =
                    (0..balls.len()).into_par_iter().filter(|row| is_in(row) && may_block(row)).collect();
                for row in rows {
                    let is_vegetation = vegetation.get(row) == Some(&true);
                    if is_vegetation && self.medium.is_some() {
                        continue;
                    }
                    if part.ball_count() == *max_balls {
                        part.hide(free, plan, found, control)?;
                    }
                    push(if is_vegetation { &mut part.vegetation } else { &mut part.opaque }, &balls, row);
                }
                from = to;
                if part.ball_count() >= MIN_TEST_BATCH {
                    part.hide(free, plan, found, control)?;
                    part.columns.clear();
                }
            }
        }
        part.hide(free, plan, found, control)
    }
}

impl TileObstacles {
    /// Returns the transmissivity of crowns; `None` if trees are opaque.
    pub(crate) fn crowns(&self) -> Option<CrownLight> {
        self.tile.plan.trees
    }

    /// Returns the medium of measured crowns.
    pub(crate) fn medium(&self) -> Option<&Medium> {
        self.medium.as_ref()
    }

    /// Computes which of `directions` each of `targets` sees, as
    /// [`ObstacleParts::look`](belvedere::apps::rows::ObstacleParts::look).
    ///
    /// # Errors
    /// Those of reading balls, and [`belvedere::Error::Cancelled`].
    pub(crate) fn look(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> Result<(VisibilityMatrix, Option<VisibilityMatrix>)> {
        let TileSurroundings { cells, others, .. } = &*self.tile;
        // nothing shines from below, so that any answer will do there
        let upward = |&direction: &[f64; 3]| if direction[2] > 0.0 { direction } else { [0.0, 0.0, 1.0] };
        let directions = &directions.iter().map(upward).collect::<Vec<_>>()[..];
        let without_trees = FreeLines::new(targets, directions)?;
        let all = matches!(self.crowns(), Some(CrownLight::Share { .. })).then(|| without_trees.clone());
        let mut strips = Strips::new(directions, cells);
        strips.look_up(&without_trees, &without_trees.free_columns());
        let mut free = Free { without_trees, all, target_count: targets.len(), strips };
        let mut found = self.tile.found();
        found.ball_count = 0;
        for square in &self.squares {
            control.check()?;
            self.hide(&mut free, square, &mut found, control)?;
        }
        let Free { mut without_trees, mut all, .. } = free;
        if let Some(added) = &others.added {
            without_trees.hide_behind_triangles(added, control)?;
        }
        without_trees.hide_behind_terrain(&others.far_terrain, control)?;
        if let Some(all) = &mut all {
            all.hide_what_is_hidden_in(&without_trees)?;
        }
        Ok(match all {
            Some(all) => (all.into_matrix(), Some(without_trees.into_matrix())),
            None => (without_trees.into_matrix(), None),
        })
    }

    /// Flags the `targets` that lie inside an obstacle.
    ///
    /// # Errors
    /// Those of reading balls, and [`belvedere::Error::Cancelled`].
    pub(crate) fn are_inside_obstacles(&self, targets: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<bool>> {
        let TileSurroundings { plan, run, cells, .. } = &*self.tile;
        let mut are_inside = vec![false; targets.len()];
        let mut found = self.tile.found();
        for BallTile { tile, tops, .. } in self.squares.iter().flatten() {
            control.check()?;
            if !tops.iter().any(|(number, _)| square_area(*number, TOP_SIDE).distance(cells) <= 0.0) {
                continue;
            }
            let read = control.stage("reading balls", 0, || found.read(plan, run, *tile, control))?;
            let Some(ModelParts { balls, .. }) = read else { continue };
            let mut near = MedialBalls::default();
            let places = balls.centers.iter().zip(&balls.radii).enumerate();
            let rows = places.filter(|(_, (center, radius))| {
                cells.distance(&MapArea::at(center.map(f64::from))) <= f64::from(**radius)
            });
            rows.for_each(|(row, _)| push(&mut near, &balls, row));
            let scene = MedialScene::new(&near, &rule(plan))?;
            are_inside.par_iter_mut().zip(targets).with_min_len(CHUNK).for_each(|(is_inside, target)| {
                *is_inside |= scene.is_inside_obstacle(target.map(f64::from));
            });
        }
        Ok(are_inside)
    }
}

/// Balls and patches of one scene.
#[derive(Default)]
struct SceneBatch {
    all: MedialBalls,
    /// Balls other than vegetation, for measured crowns.
    solid: Option<MedialBalls>,
    patches: SurfacePatches,
}

impl SceneBatch {
    /// Returns the scenes of all balls and of solid balls, and empties the batch.
    fn taken(
        &mut self,
        rule: &BlockRule,
        found: &mut ObstacleSearch,
        control: &Control<'_>,
    ) -> Result<(MedialScene, Option<MedialScene>)> {
        let triangles = BlockingTriangles::of_patches(&std::mem::take(&mut self.patches), None)?;
        let balls = std::mem::take(&mut self.all);
        found.ball_count += balls.len();
        found.max_held = found.max_held.max(balls.len());
        let indexed = |balls: MedialBalls| {
            let scene = control.stage("indexing balls", balls.len(), || MedialScene::new(&balls, rule))?;
            Ok(scene.with_triangles(triangles.clone()))
        };
        let solid = self.solid.as_mut().map(|solid| indexed(std::mem::take(solid))).transpose()?;
        Ok((indexed(balls)?, solid))
    }
}

/// Lines of sight without an obstacle so far.
struct Free<'a> {
    /// Lines free of all obstacles except vegetation; with opaque trees, of all obstacles.
    without_trees: FreeLines<'a>,
    /// Lines free of all obstacles, for trees that let light through.
    all: Option<FreeLines<'a>>,
    target_count: usize,
    /// Strips of the lines that balls may still block. Crowns block no other lines.
    strips: Strips,
}

/// Balls that are tested together.
#[derive(Default)]
struct BallBatch {
    opaque: MedialBalls,
    /// Vegetation, for trees that let light through.
    vegetation: MedialBalls,
    /// Patches, tested with the first of the balls.
    patches: SurfacePatches,
    /// Indices of the directions in which any of the balls may block a line.
    columns: BTreeSet<usize>,
}

impl BallBatch {
    fn ball_count(&self) -> usize {
        self.opaque.len() + self.vegetation.len()
    }

    /// Removes from `free` the lines that the balls block, and empties the batch.
    fn hide(
        &mut self,
        free: &mut Free<'_>,
        plan: &Plan,
        found: &mut ObstacleSearch,
        control: &Control<'_>,
    ) -> Result<()> {
        if let Some(triangles) = BlockingTriangles::of_patches(&std::mem::take(&mut self.patches), None)? {
            free.without_trees.hide_behind_triangles(&triangles, control)?;
        }
        if self.ball_count() == 0 {
            return Ok(());
        }
        found.ball_count += self.ball_count();
        found.max_held = found.max_held.max(self.ball_count());
        let columns: Vec<usize> = self.columns.iter().copied().collect();
        let hide = |lines: &mut FreeLines<'_>, balls: &mut MedialBalls| {
            let balls = std::mem::take(balls);
            if balls.is_empty() {
                return Ok(());
            }
            let scene = control.stage("indexing balls", balls.len(), || MedialScene::new(&balls, &rule(plan)))?;
            drop(balls);
            control.stage("testing lines of sight", free.target_count, || {
                lines.hide_behind_balls(&scene, &columns, control)
            })
        };
        hide(&mut free.without_trees, &mut self.opaque)?;
        if let Some(all) = &mut free.all {
            all.hide_what_is_hidden_in(&free.without_trees)?;
            hide(all, &mut self.vegetation)?;
        }
        free.strips.look_up(&free.without_trees, &columns);
        Ok(())
    }
}

/// Divides tiles into squares, the nearest first. All squares have the size of the largest one around `tile` with at
/// most `max_balls`.
fn squares(tile: TileId, ball_tiles: Vec<BallTile>, max_balls: usize) -> Vec<Vec<BallTile>> {
    let away = |other: &BallTile| [other.tile.east - tile.east, other.tile.north - tile.north];
    // The number of a square, if a square of `side` tiles has the tile in its middle.
    let number = |other: &BallTile, side: i64| away(other).map(|away| (away + (side - 1) / 2).div_euclid(side));
    let is_in_first = |other: &&BallTile, side: i64| number(other, side) == [0, 0];
    let balls_around =
        |side: i64| ball_tiles.iter().filter(|other| is_in_first(other, side)).map(|other| other.ball_count).sum();
    let farthest = ball_tiles.iter().flat_map(away).map(i64::abs).max().unwrap_or(0);
    let fits = |side: &i64| -> bool { max_balls >= balls_around(*side) };
    let side = (2..=2 * farthest + 1).take_while(fits).last().unwrap_or(1);
    let mut squares: BTreeMap<[i64; 3], Vec<BallTile>> = BTreeMap::new();
    for other in ball_tiles {
        let [east, north] = number(&other, side);
        squares.entry([east * east + north * north, east, north]).or_default().push(other);
    }
    squares.into_values().collect()
}
