//! The steps of the run of a tile, and where their results lie.

use crate::grid::TileId;
use crate::plan::Plan;
use crate::question::TileQuestion;
use std::path::{Path, PathBuf};

/// A step of the run of a tile.
#[derive(Clone, Copy, Debug)]
pub enum Stage<'a> {
    /// Its balls.
    Balls,
    /// The answer to a question.
    Answer(&'a TileQuestion),
}

impl Stage<'_> {
    /// The name of its folder in a run.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Balls => "balls",
            Self::Answer(question) => question.name(),
        }
    }

    /// Where its results lie: in the folder of the run, but for balls that several plans share.
    pub(crate) fn folder(&self, plan: &Plan, run: &Path) -> PathBuf {
        let own = match self {
            Self::Balls => plan.shared_balls.as_deref().unwrap_or(run),
            Self::Answer(_) => run,
        };
        own.join(self.name())
    }

    /// Where the result of a tile lies.
    pub(crate) fn result(&self, plan: &Plan, run: &Path, tile: TileId) -> PathBuf {
        let extension = if matches!(self, Self::Balls) { "npz" } else { "tif" };
        self.folder(plan, run).join(format!("{}.{extension}", tile.name()))
    }

    /// Where the pulses lie that end in a tile.
    pub(crate) fn pulses(&self, plan: &Plan, run: &Path, tile: TileId) -> PathBuf {
        self.folder(plan, run).join(format!("{}.pulses.npz", tile.name()))
    }

    /// Where the crowns of a tile lie.
    pub(crate) fn crowns(&self, plan: &Plan, run: &Path, tile: TileId) -> PathBuf {
        self.folder(plan, run).join(format!("{}.crowns.npz", tile.name()))
    }

    pub(crate) fn record(&self, plan: &Plan, run: &Path, tile: TileId) -> PathBuf {
        self.folder(plan, run).join(format!("{}.json", tile.name()))
    }
}
