//! Progress of a run, and the page about it: results, times, and missing parts.

use crate::plan::Plan;
use crate::plan::record::{TileOutcome, TileRecord};
use crate::plan::stage::Stage;
use belvedere::io::atomic;
use belvedere::{Error, Result};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// Progress of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Status {
    /// Number of tiles of the plan.
    pub tiles: usize,
    /// Progress of balls, and of each question.
    pub stages: Vec<StageStatus>,
}

/// Progress of one stage of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StageStatus {
    /// Name of the stage and of its folder.
    pub name: String,
    /// Number of tiles with a result.
    pub done: usize,
    /// Number of empty tiles.
    pub empty: usize,
    /// Number of tiles that are left, including tiles with a damaged or missing result.
    pub left: usize,
    /// Number of points read for the tiles.
    pub points_read: usize,
    /// Number of cells with an unproven answer because balls are missing.
    pub unproven_cells: usize,
    /// Time for the tiles, seconds.
    pub seconds: f64,
    /// Failed tiles, with the reasons.
    pub failed: Vec<String>,
}

impl Status {
    /// Returns true if no tile is left and none failed.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.stages.iter().all(|stage| stage.left == 0 && stage.failed.is_empty())
    }
}

/// Returns the progress of the run in `folder`.
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

/// Writes `report.md` into the folder of a run.
///
/// # Errors
/// [`Error::Io`].
pub(crate) fn write_report(plan: &Plan, folder: &Path) -> Result<()> {
    let found = status(plan, folder);
    let mut text = String::from("# Run\n\n");
    let points: u64 = plan.inputs.iter().map(|file| file.points).sum();
    let _ = writeln!(
        text,
        "{} files with {points} points, {} tiles of {} m, points read up to {} m around a tile.",
        plan.inputs.len(),
        found.tiles,
        plan.tile_size,
        plan.buffer
    );
    for question in &plan.questions {
        let _ = writeln!(text, "Cells of `{}`: {} m.", question.name, plan.cells.of(question));
    }
    let _ = writeln!(text, "Made with {}.\n", if plan.program.is_empty() { "belvedere" } else { &plan.program });
    text.push_str("| step | tiles done | empty | left | failed | cells unproven | points read | hours |\n|---|---|---|---|---|---|---|---|\n");
    for stage in &found.stages {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {:.3} |",
            stage.name,
            stage.done,
            stage.empty,
            stage.left,
            stage.failed.len(),
            stage.unproven_cells,
            stage.points_read,
            stage.seconds / 3600.0
        );
    }
    let failed = || found.stages.iter().flat_map(|stage| stage.failed.iter().map(move |why| (&stage.name, why)));
    if failed().next().is_some() {
        text.push_str("\n## Failed\n\n");
        for (stage, why) in failed() {
            let _ = writeln!(text, "- {stage}, {why}");
        }
    }
    let path = folder.join("report.md");
    atomic::write(&path, |file| file.write_all(text.as_bytes()).map_err(Error::io(&path)))
}
