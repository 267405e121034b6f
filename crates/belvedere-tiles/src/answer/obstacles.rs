//! Obstacles for lines of sight from a tile: the balls of all tiles that are high and near enough.

use crate::answer::lines::{AreaLines, MAX_BALL, passes, tiles};
use crate::build::make_balls::{crown_box, make_balls, square_of};
use crate::grid::{CELL, MapArea, TOP_SIDE, TileId, block_area, square_area};
use crate::plan::Plan;
use crate::plan::record::{TileOutcome, TileRecord};
use crate::plan::stage::Stage;
use belvedere::blocking::BlockRule;
use belvedere::control::Control;
use belvedere::io::{Source, read_balls};
use belvedere::medial::{MedialBalls, PULSE_TOUCH};
use belvedere::model::{ModelParts, SurveyBlock};
use belvedere::pulses::FreeSegmentColumns;
use belvedere::{Error, Result};
use std::path::Path;

/// Balls of a tile according to its record.
pub(crate) struct BallTile {
    pub(crate) tile: TileId,
    pub(crate) ball_count: usize,
    /// Squares of 16 m that balls reach into, with the highest top of balls over each, local metres.
    pub(crate) tops: Vec<([i32; 2], f32)>,
}

/// Report on the balls that may change an answer.
#[derive(Debug, Default)]
pub(crate) struct ObstacleSearch {
    /// Number of balls that were tested.
    pub(crate) ball_count: usize,
    /// Maximum number of balls in memory at a time, for tests in parts.
    pub(crate) max_held: usize,
    /// Areas with missing balls, and the maximum height of obstacles there, local metres.
    pub(crate) missing: Vec<(MapArea, f64)>,
    /// Damaged balls that were made again.
    pub(crate) damaged: Vec<String>,
    /// Number of observers inside obstacles.
    pub(crate) skipped_observers: usize,
    /// Number of cells without an answer because balls are missing.
    pub(crate) unknown_cells: usize,
    /// Number of blocked cells inside obstacles.
    pub(crate) inside_cells: usize,
}

impl ObstacleSearch {
    /// Returns true if a line of sight from a target, local metres, may meet missing balls. The line ends after
    /// `length` times the vector `way`, or never.
    pub(crate) fn is_unknown(&self, target: [f64; 3], way: [f64; 3], length: f64) -> bool {
        self.missing.iter().any(|(area, top)| passes(target, way, length, area, *top))
    }

    /// Reads the balls of a tile, if they exist. Damaged balls are made again.
    ///
    /// # Errors
    /// Those of writing records, and [`Error::Cancelled`].
    pub(crate) fn read(
        &mut self,
        plan: &Plan,
        run: &Path,
        tile: TileId,
        control: &Control<'_>,
    ) -> Result<Option<ModelParts>> {
        let balls = match TileRecord::read(plan, run, Stage::Balls, tile) {
            Some(record) if record.outcome == TileOutcome::Done => {
                sound(plan, run, tile, &record, &mut self.damaged, control)?
            }
            _ => None,
        };
        if balls.is_none() {
            self.missing.extend(unknown(plan, tile));
        }
        Ok(balls)
    }

    /// Reads the pulses that end in a tile; `None` for a tile without known pulses. Missing or damaged pulses are made.
    ///
    /// # Errors
    /// Those of writing records, and [`Error::Cancelled`].
    pub(crate) fn pulses(
        &mut self,
        plan: &Plan,
        run: &Path,
        tile: TileId,
        control: &Control<'_>,
    ) -> Result<Option<FreeSegmentColumns>> {
        let path = Stage::Balls.pulses(plan, run, tile);
        let read = |record: TileRecord| match &record.pulses {
            Some(stamp) => Ok(read_balls(Source::bytes(&path, &stamp.read(&path)?))?.pulses),
            None => Ok(None),
        };
        if let Some(record) = TileRecord::read(plan, run, Stage::Balls, tile) {
            match read(record) {
                Ok(pulses) => return Ok(pulses),
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                Err(error) => self.damaged.push(error.to_string()),
            }
        }
        made_again((plan, run, tile), read, control).map(Option::flatten)
    }
}

impl ObstacleSearch {
    /// Adds the crowns of a tile that may take light from `lines` to `voxels`. Damaged crowns are made again.
    ///
    /// # Errors
    /// Those of [`ObstacleSearch::crowns`].
    pub(crate) fn add_crowns(
        &mut self,
        (plan, run, tile): (&Plan, &Path, TileId),
        lines: &AreaLines<'_>,
        voxels: &mut Vec<([i32; 3], f32)>,
        control: &Control<'_>,
    ) -> Result<()> {
        let origin = plan.frame.origin;
        let may_meet = |(voxel, _): &([i32; 3], f32)| {
            let (area, top) = crown_box(*voxel, origin);
            lines.may_meet(&area, top)
        };
        voxels.extend(self.crowns((plan, run, tile), control)?.into_iter().filter(may_meet));
        Ok(())
    }

    /// Returns the voxels of crowns of a tile. Damaged crowns are made again.
    ///
    /// # Errors
    /// Those of writing records, and [`Error::Cancelled`].
    pub(crate) fn crowns(
        &mut self,
        (plan, run, tile): (&Plan, &Path, TileId),
        control: &Control<'_>,
    ) -> Result<Vec<([i32; 3], f32)>> {
        let path = Stage::Balls.crowns(plan, run, tile);
        let read = |record: TileRecord| match &record.crowns {
            Some(stamp) => Ok(read_balls(Source::bytes(&path, &stamp.read(&path)?))?.medium),
            None => Ok(None),
        };
        let found = match TileRecord::read(plan, run, Stage::Balls, tile).map(read) {
            Some(Ok(found)) => found,
            Some(Err(Error::Cancelled)) => return Err(Error::Cancelled),
            Some(Err(error)) => {
                self.damaged.push(error.to_string());
                made_again((plan, run, tile), read, control)?.flatten()
            }
            // Missing balls of the tile are reported with its balls.
            None => None,
        };
        Ok(found.map(|found| found.voxels.into_iter().zip(found.extinction).collect()).unwrap_or_default())
    }
}

/// Returns the tiles with balls that may block `lines`. Missing tiles are added to `found`.
///
/// # Errors
/// [`Error::Cancelled`].
pub(crate) fn ball_tiles(
    plan: &Plan,
    run: &Path,
    lines: &AreaLines<'_>,
    found: &mut ObstacleSearch,
    control: &Control<'_>,
) -> Result<Vec<BallTile>> {
    let mut ball_tiles = Vec::new();
    let may_meet = |&(number, top): &([i32; 2], f32)| lines.may_meet(&square_area(number, TOP_SIDE), top.into());
    for tile in tiles(plan, lines) {
        control.check()?;
        match TileRecord::read(plan, run, Stage::Balls, tile) {
            Some(TileRecord { outcome: TileOutcome::Done, balls, tops, .. }) if tops.iter().any(may_meet) => {
                ball_tiles.push(BallTile { tile, ball_count: balls, tops });
            }
            Some(TileRecord { outcome: TileOutcome::Done | TileOutcome::Nothing, .. }) => {}
            Some(TileRecord { outcome: TileOutcome::Failed(_), .. }) | None => {
                found.missing.extend(unknown(plan, tile));
            }
        }
    }
    Ok(ball_tiles)
}

/// Returns the rule by which balls of tiles block.
pub(crate) fn rule(plan: &Plan) -> BlockRule {
    if plan.statistics.carves { BlockRule::carved() } else { BlockRule::uncarved() }
}

/// Returns the balls of a tile. Damaged balls are named and made again; `None` if that fails.
fn sound(
    plan: &Plan,
    run: &Path,
    tile: TileId,
    record: &TileRecord,
    damaged: &mut Vec<String>,
    control: &Control<'_>,
) -> Result<Option<ModelParts>> {
    let path = Stage::Balls.result(plan, run, tile);
    let read = |record: &TileRecord| read_balls(Source::bytes(&path, &record.read_result(&path)?));
    match read(record) {
        Ok(balls) => return Ok(Some(balls)),
        Err(Error::Cancelled) => return Err(Error::Cancelled),
        Err(_) => damaged.push(format!("{} is damaged", path.display())),
    }
    made_again((plan, run, tile), |record| read(&record), control)
}

/// Makes the balls of a tile and returns the result of `read`. On failure it returns `None` and writes a record with
/// the reason.
fn made_again<T>(
    (plan, run, tile): (&Plan, &Path, TileId),
    read: impl FnOnce(TileRecord) -> Result<T>,
    control: &Control<'_>,
) -> Result<Option<T>> {
    match make_balls(plan, run, tile, control).and_then(read) {
        Ok(found) => Ok(Some(found)),
        Err(Error::Cancelled) => Err(Error::Cancelled),
        Err(error) => {
            let record = TileRecord { outcome: TileOutcome::Failed(error.to_string()), ..TileRecord::default() };
            record.write(plan, run, Stage::Balls, tile)?;
            Ok(None)
        }
    }
}

/// Returns the rows of balls that may block one of `lines`.
pub(crate) fn may_block<'a>(balls: &'a MedialBalls, lines: &'a AreaLines<'_>) -> impl Iterator<Item = usize> + 'a {
    let rows = balls.centers.iter().zip(&balls.radii).enumerate();
    rows.filter(|(_, (center, radius))| {
        lines.may_meet(&square_of(**center, **radius), f64::from(center[2]) + f64::from(**radius))
    })
    .map(|(row, _)| row)
}

/// Adds a ball of `more`.
pub(crate) fn push(balls: &mut MedialBalls, more: &MedialBalls, row: usize) {
    if let (Some(&center), Some(&radius)) = (more.centers.get(row), more.radii.get(row)) {
        balls.push(0, center, radius, more.touch.get(row).copied().unwrap_or(PULSE_TOUCH));
    }
}

/// Returns the possible obstacles on a tile without balls, from the heights of its points.
fn unknown(plan: &Plan, tile: TileId) -> Vec<(MapArea, f64)> {
    let core = plan.grid().core(tile);
    let part = |block: &SurveyBlock| {
        let own = block_area(block.at);
        let low = [0, 1].map(|axis| own.low[axis].max(core.low[axis]));
        let high = [0, 1].map(|axis| (own.low[axis] + CELL).min(core.high[axis]));
        (MapArea { low, high }.widened(MAX_BALL), f64::from(block.heights[1]) + MAX_BALL)
    };
    plan.blocks_in(&core).map(part).collect()
}
