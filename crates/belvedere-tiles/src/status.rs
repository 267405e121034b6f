//! How far a run has come.

use crate::plan::Plan;
use crate::record::{TileOutcome, TileRecord};
use crate::stage::Stage;
use serde::Serialize;
use std::path::Path;

/// How far a run has come.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Status {
    /// Tiles of the plan.
    pub tiles: usize,
    /// Balls, and each question.
    pub stages: Vec<StageStatus>,
}

/// How far one stage of a run has come.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StageStatus {
    /// Its name, which is that of its folder.
    pub name: String,
    /// Tiles that have a result.
    pub done: usize,
    /// Tiles on which nothing is.
    pub empty: usize,
    /// Tiles that are left, those whose result is damaged or gone among them.
    pub left: usize,
    /// Points that were read for them.
    pub points_read: usize,
    /// Cells whose answer is unproven because balls are missing.
    pub unproven_cells: usize,
    /// Seconds that they took.
    pub seconds: f64,
    /// Tiles that failed, and why.
    pub failed: Vec<String>,
}

impl Status {
    /// Whether nothing is left and nothing failed.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.stages.iter().all(|stage| stage.left == 0 && stage.failed.is_empty())
    }
}

/// How far the run in `folder` has come.
#[must_use]
pub fn status(plan: &Plan, folder: &Path) -> Status {
    let stages = std::iter::once(Stage::Balls).chain(plan.questions.iter().map(Stage::Answer));
    Status { tiles: plan.tiles.len(), stages: stages.map(|stage| of_stage(plan, folder, stage)).collect() }
}

fn of_stage(plan: &Plan, folder: &Path, stage: Stage<'_>) -> StageStatus {
    let mut status = StageStatus { name: stage.name().to_owned(), ..StageStatus::default() };
    let with_cells = match stage {
        Stage::Balls => None,
        Stage::Answer(question) => Some(plan.tiles_of(question)),
    };
    for &tile in with_cells.as_ref().unwrap_or(&plan.tiles) {
        let record = TileRecord::read(plan, folder, stage, tile);
        let Some(record) = record.filter(|record| record.damage(plan, folder, stage, tile).is_none()) else {
            status.left += 1;
            continue;
        };
        match &record.outcome {
            TileOutcome::Done => status.done += 1,
            TileOutcome::Nothing => status.empty += 1,
            TileOutcome::Failed(why) => status.failed.push(format!("tile {}: {why}", tile.name())),
        }
        status.points_read += record.points;
        status.unproven_cells += record.unproven_cells;
        status.seconds += record.seconds;
    }
    status
}
