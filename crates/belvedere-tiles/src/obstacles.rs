//! What can block lines of sight from a tile: the balls of all tiles that are high and near enough.

use crate::grid::{Area, CELL, TileId, block_area};
use crate::lines::{Lines, MOST_BALL, passes, tiles};
use crate::make_balls::{make_balls, square_of};
use crate::plan::Plan;
use crate::planned::LightTrees;
use crate::record::{Outcome, Record, Stage};
use belvedere::apps::rows;
use belvedere::apps::tree_light::TreeLight;
use belvedere::blocking::BlockRule;
use belvedere::control::Control;
use belvedere::io::{Source, read_balls};
use belvedere::medial::{MedialBalls, vegetation_of_transmission};
use belvedere::model::ModelParts;
use belvedere::query::{AddedMeshes, MedialScene};
use belvedere::{Error, Result};
use std::path::Path;

/// What blocks lines of sight from a tile.
pub(crate) struct Obstacles {
    pub(crate) scene: MedialScene,
    /// Where trees let light through, the rest of it.
    pub(crate) trees: Option<TreeLight>,
    pub(crate) ball_count: usize,
    /// Where balls are missing: what may stand there, and how high.
    pub(crate) missing: Vec<(Area, f64)>,
    /// Balls that were found damaged, and were made again.
    pub(crate) damaged: Vec<String>,
}

impl Obstacles {
    /// Gathers the balls of the tiles that may matter for `lines`, as far as they are there, and what is `added`. Damaged ones are made again.
    ///
    /// # Errors
    /// Those of [`MedialScene::new`] and of writing records, and [`Error::Cancelled`].
    pub(crate) fn gather(
        plan: &Plan,
        run: &Path,
        lines: &Lines<'_>,
        added: Option<&AddedMeshes>,
        control: &Control<'_>,
    ) -> Result<Self> {
        let mut balls = MedialBalls::default();
        // those that are no vegetation, where trees let light through
        let mut opaque = plan.trees.map(|_| MedialBalls::default());
        let mut missing = Vec::new();
        let mut damaged = Vec::new();
        for tile in tiles(plan, lines) {
            control.check()?;
            let Some(record) = Record::read(plan, run, Stage::Balls, tile) else {
                missing.extend(unknown(plan, tile));
                continue;
            };
            let may_meet = |&(block, top): &([i32; 2], f32)| lines.may_meet(&block_area(block), top.into());
            match record.outcome {
                Outcome::Done if record.tops.iter().any(may_meet) => {
                    match sound(plan, run, tile, &record, &mut damaged, control)? {
                        Some(found) => {
                            add(&mut balls, &found, lines, |_| true);
                            if let Some(opaque) = &mut opaque {
                                let vegetation = vegetation_of_transmission(&found.transmission);
                                add(opaque, &found, lines, |row| vegetation.get(row) != Some(&true));
                            }
                        }
                        None => missing.extend(unknown(plan, tile)),
                    }
                }
                Outcome::Done | Outcome::Nothing => {}
                Outcome::Failed(_) => missing.extend(unknown(plan, tile)),
            }
        }
        let rule = if plan.facts.carves { BlockRule::carved() } else { BlockRule::uncarved() };
        let ball_count = balls.len();
        let scene = |balls: &MedialBalls| {
            let scene = control.stage("indexing balls", balls.len(), || MedialScene::new(balls, &rule))?;
            Ok(scene.with_added(added.cloned()))
        };
        let trees = match (plan.trees, opaque) {
            (Some(LightTrees { transmissivity, leaves }), Some(opaque)) => {
                Some(TreeLight { opaque: scene(&opaque)?, transmissivity, leaves })
            }
            _ => None,
        };
        Ok(Self { scene: scene(&balls)?, trees, ball_count, missing, damaged })
    }

    /// What light meets on its way.
    pub(crate) fn of_light(&self) -> rows::Obstacles<'_> {
        rows::Obstacles { scene: &self.scene, trees: self.trees.as_ref() }
    }

    /// Whether a line of sight from a target, local metres, may meet what is missing: along `way`, to an end after `length` times that or without
    /// end.
    pub(crate) fn is_unknown(&self, target: [f64; 3], way: [f64; 3], length: f64) -> bool {
        self.missing.iter().any(|(area, top)| passes(target, way, length, area, *top))
    }
}

/// The balls of a tile. Those that are not what was written are named and made again; `None` where that fails.
fn sound(
    plan: &Plan,
    run: &Path,
    tile: TileId,
    record: &Record,
    damaged: &mut Vec<String>,
    control: &Control<'_>,
) -> Result<Option<ModelParts>> {
    let path = Stage::Balls.result(run, tile);
    let read = |record: &Record| read_balls(Source::bytes(&path, &record.read_result(&path)?));
    match read(record) {
        Ok(balls) => return Ok(Some(balls)),
        Err(Error::Cancelled) => return Err(Error::Cancelled),
        Err(error) => damaged.push(error.to_string()),
    }
    match make_balls(plan, run, tile, control).and_then(|record| read(&record)) {
        Ok(balls) => Ok(Some(balls)),
        Err(Error::Cancelled) => Err(Error::Cancelled),
        Err(error) => {
            let record = Record { outcome: Outcome::Failed(error.to_string()), ..Record::default() };
            record.write(plan, run, Stage::Balls, tile)?;
            Ok(None)
        }
    }
}

/// Adds those of `more` that may block one of `lines`, and whose row `is_meant`.
fn add(balls: &mut MedialBalls, more: &ModelParts, lines: &Lines<'_>, is_meant: impl Fn(usize) -> bool) {
    let more = &more.balls;
    for (row, (&center, &radius)) in more.centers.iter().zip(&more.radii).enumerate() {
        if is_meant(row) && lines.may_meet(&square_of(center, radius), f64::from(center[2]) + f64::from(radius)) {
            let touch = more.touch.get(row).copied().unwrap_or(belvedere::medial::PULSE_TOUCH);
            balls.push(0, center, radius, touch);
        }
    }
}

/// What may stand on a tile of which nothing is known but how high its points are.
fn unknown(plan: &Plan, tile: TileId) -> Vec<(Area, f64)> {
    let core = plan.grid().core(tile);
    let part = |block: &crate::survey::Block| {
        let own = block_area(block.at);
        let low = [0, 1].map(|axis| own.low[axis].max(core.low[axis]));
        let high = [0, 1].map(|axis| (own.low[axis] + CELL).min(core.high[axis]));
        (Area { low, high }.widened(MOST_BALL), f64::from(block.heights[1]) + MOST_BALL)
    };
    plan.blocks_in(&core).map(part).collect()
}
