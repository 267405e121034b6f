//! Run of all tiles that are not done yet, one after the other.

pub(crate) mod any_size;
pub(crate) mod joined;
pub(crate) mod merge;
pub(crate) mod places;
pub(crate) mod status;

use crate::answer::cell_answers::{TileTask, answer};
use crate::answer::lines::{AreaLines, tiles};
use crate::answer::surface_cells::SharedSurfaces;
use crate::build::make_balls::make_balls;
use crate::grid::TileId;
use crate::plan::Plan;
use crate::plan::record::{TileOutcome, TileRecord};
use crate::plan::side_files::Others;
use crate::plan::stage::Stage;
use crate::run::merge::write_catalogue;
use crate::run::status::write_report;
use belvedere::apps::ask::{Remark, remark_on_edge};
use belvedere::control::Control;
use belvedere::{Error, Parameter, Result};
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;

/// Share of the tiles: every `of`-th tile from number `number` on, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of the share, from 1.
    pub number: usize,
    /// Number of shares.
    pub of: usize,
}

impl Default for Shard {
    fn default() -> Self {
        Self { number: 1, of: 1 }
    }
}

/// Steps of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Steps {
    /// Balls, and the answers to the questions.
    #[default]
    All,
    /// Balls only, so that later jobs with answers find the balls of all tiles.
    Balls,
}

/// Parameters of a run.
pub struct RunParams<'a> {
    /// Share of the tiles. Default: all.
    pub shard: Shard,
    /// Steps of the run.
    pub steps: Steps,
    /// Maximum number of balls held at a time for an answer; no answer depends on it. `None` for as many as take no
    /// more memory than making the balls of the largest tile.
    pub max_balls: Option<usize>,
    /// Seconds on a clock of the program, for records. The library has no clock.
    pub seconds: &'a dyn Fn() -> f64,
}

/// Result of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RunReport {
    /// Number of tiles whose balls were made.
    pub balls_made: usize,
    /// Number of answers to a question on a tile.
    pub answers_made: usize,
    /// Number of tiles and answers that existed already.
    pub already_done: usize,
    /// Number of cells without an answer because balls are missing.
    pub unproven_cells: usize,
    /// Number of cells of questions about light, counted once for each question.
    pub cells_of_light: usize,
    /// Number of these cells near the edge of the survey.
    pub cells_near_edge: usize,
    /// Number of cells on the ground under a cover, which have no answer to the first question; `None` for cells on the
    /// surface.
    #[serde(rename = "cells_under_cover_left_out", skip_serializing_if = "Option::is_none")]
    pub cells_under_cover: Option<usize>,
    /// Maximum number of balls held at a time for an answer.
    #[serde(rename = "most_balls")]
    pub max_balls: usize,
    /// Number of observers of viewsheds inside an obstacle, which see nothing.
    pub skipped_observers: usize,
    /// Number of blocked cells of viewsheds inside obstacles.
    #[serde(skip_serializing_if = "is_zero")]
    pub inside_cells: usize,
    /// Damaged or missing results that were made again.
    pub damaged: Vec<String>,
    /// Failed tiles and answers, with the reasons.
    pub failed: Vec<String>,
}

impl RunReport {
    /// Returns remarks on the answers.
    #[must_use]
    pub fn remarks(&self) -> Vec<Remark> {
        let damaged = self.damaged.iter().take(MAX_NAMED);
        let damaged =
            damaged.map(|damage| Remark::warning("result-damaged", format!("{damage}; it was computed again")));
        let unproven = (self.unproven_cells > 0).then(|| {
            let text =
                format!("{} cells have no answer because tiles that may block them are missing", self.unproven_cells);
            Remark::warning("cells-unproven", text).with("count", self.unproven_cells as f64)
        });
        let skipped = (self.skipped_observers > 0).then(|| {
            let text = format!("{} observers are inside obstacles and see nothing", self.skipped_observers);
            Remark::warning("observers-skipped", text).with("count", self.skipped_observers as f64)
        });
        let edge = remark_on_edge(self.cells_near_edge, self.cells_of_light);
        damaged.chain(unproven).chain(skipped).chain(edge).collect()
    }

    fn count(&mut self, record: &TileRecord, is_first: bool) {
        if let (Some(covered), true) = (&mut self.cells_under_cover, is_first) {
            *covered += record.covered_cells;
        }
        self.inside_cells += record.inside_cells;
        if let Some(near) = record.near_edge_cells {
            self.cells_near_edge += near;
            self.cells_of_light += record.cells;
        }
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde requires a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// Maximum number of damaged results in remarks.
const MAX_NAMED: usize = 10;

/// Makes the missing balls and answers of a run. Failed tiles are named and recorded, and the run continues. The next
/// run tries them again.
///
/// # Errors
/// [`Error::InvalidParameter`] for a share that does not exist, [`Error::Cancelled`], and those of writing records.
pub fn run(plan: &Plan, folder: &Path, params: &RunParams<'_>, control: &Control<'_>) -> Result<RunReport> {
    let Shard { number, of } = params.shard;
    if number == 0 || number > of {
        let value = format!("{number}/{of}");
        return Err(Error::invalid(Parameter::Shard, value, "1/N to N/N"));
    }
    let mut work = RunWork { plan, folder, params, control, report: RunReport::default() };
    work.report.cells_under_cover = plan.is_on_ground().then_some(0);
    let own = || plan.tiles.iter().copied().skip(number - 1).step_by(of);
    for tile in own() {
        work.balls(tile)?;
    }
    let questions = if params.steps == Steps::All { &plan.questions[..] } else { &[] };
    let max_balls = params.max_balls.unwrap_or_else(|| plan.balls_at_a_time());
    let others = if questions.is_empty() { Others::none() } else { plan.others()? };
    let (others, shared) = (Arc::new(others), Arc::new(plan.clone()));
    let mut ready = Vec::new();
    for question in questions {
        let prepared = plan.prepared(question, others.far_terrain.clone(), control)?;
        ready.push((plan.cells.of(question), question, prepared));
    }
    // Answers on cells of one size follow each other and share the surface of a tile.
    ready.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut surfaces = SharedSurfaces::default();
    for tile in own() {
        surfaces.next_tile();
        for (cell, question, prepared) in &ready {
            if !plan.has_cells(tile, *cell) {
                continue;
            }
            // Balls that were missing for an unproven answer may exist now.
            let record = work.settled(Stage::Answer(question), tile);
            if let Some(record) = record.filter(|record| record.unproven_cells == 0) {
                work.report.already_done += 1;
                work.report.count(&record, plan.questions.first() == Some(*question));
                continue;
            }
            // Other shares may not have reached these tiles yet.
            let core = plan.grid().core(tile);
            let lowest = plan.lowest_of_cells(tile, *cell);
            for other in tiles(plan, &AreaLines::of(&prepared.lines, core, lowest)) {
                work.missing_balls(other)?;
            }
            let (plan, others) = (Arc::clone(&shared), Arc::clone(&others));
            let task = TileTask { plan, question, prepared, others, max_balls };
            work.answer(&task, tile, &mut surfaces)?;
        }
    }
    for question in questions {
        write_catalogue(plan, folder, question, control)?;
    }
    write_report(plan, folder)?;
    Ok(work.report)
}

struct RunWork<'a> {
    plan: &'a Plan,
    folder: &'a Path,
    params: &'a RunParams<'a>,
    control: &'a Control<'a>,
    report: RunReport,
}

impl RunWork<'_> {
    /// Returns the record of a tile that is done and has an undamaged result. Damage is reported.
    fn settled(&mut self, stage: Stage<'_>, tile: TileId) -> Option<TileRecord> {
        let record = TileRecord::read(self.plan, self.folder, stage, tile).filter(TileRecord::is_settled)?;
        let Some(damage) = record.damage(self.plan, self.folder, stage, tile) else { return Some(record) };
        self.report.damaged.push(damage);
        None
    }

    /// Makes the balls of a tile unless they exist.
    fn balls(&mut self, tile: TileId) -> Result<()> {
        if self.settled(Stage::Balls, tile).is_some() {
            self.report.already_done += 1;
            return Ok(());
        }
        self.attempt(Stage::Balls, tile, || make_balls(self.plan, self.folder, tile, self.control))?;
        self.report.balls_made += 1;
        Ok(())
    }

    /// Makes the balls of a tile that an answer needs. A tile that failed before is not tried again.
    fn missing_balls(&mut self, tile: TileId) -> Result<()> {
        if TileRecord::read(self.plan, self.folder, Stage::Balls, tile).is_none() {
            self.attempt(Stage::Balls, tile, || make_balls(self.plan, self.folder, tile, self.control))?;
            self.report.balls_made += 1;
        }
        Ok(())
    }

    fn answer(&mut self, task: &TileTask<'_>, tile: TileId, surfaces: &mut SharedSurfaces) -> Result<()> {
        let stage = Stage::Answer(task.question);
        let record = self.attempt(stage, tile, || answer(self.folder, task, tile, surfaces, self.control))?;
        self.report.answers_made += 1;
        self.report.unproven_cells += record.unproven_cells;
        self.report.count(&record, self.plan.questions.first() == Some(task.question));
        self.report.damaged.extend(record.damaged);
        self.report.max_balls = self.report.max_balls.max(record.max_balls);
        self.report.skipped_observers = self.report.skipped_observers.max(record.skipped_observers);
        Ok(())
    }

    /// Does the work for a tile, and records its time or the reason of its failure.
    fn attempt(
        &mut self,
        stage: Stage<'_>,
        tile: TileId,
        work: impl FnOnce() -> Result<TileRecord>,
    ) -> Result<TileRecord> {
        let start = (self.params.seconds)();
        let mut record = match work() {
            Ok(record) => record,
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            Err(error) => {
                self.report.failed.push(format!("{} of tile {}: {error}", stage.name(), tile.name()));
                TileRecord { outcome: TileOutcome::Failed(error.to_string()), ..TileRecord::default() }
            }
        };
        record.seconds = (self.params.seconds)() - start;
        record.write(self.plan, self.folder, stage, tile)?;
        Ok(record)
    }
}
