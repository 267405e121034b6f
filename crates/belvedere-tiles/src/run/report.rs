//! Page about a run: results, times, and missing parts.

use crate::plan::Plan;
use crate::run::status::status;
use belvedere::io::atomic;
use belvedere::{Error, Result};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

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
        let _ = writeln!(text, "Cells of `{}`: {} m.", question.name(), plan.cells.of(question));
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
