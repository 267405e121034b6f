//! Steps of the run of a tile, and the paths of their results.

use crate::grid::TileId;
use crate::plan::Plan;
use crate::plan::question::{BALLS, TileQuestion};
use std::path::{Path, PathBuf};

/// Step of the run of a tile.
#[derive(Clone, Copy, Debug)]
pub enum Stage<'a> {
    /// Balls of the tile.
    Balls,
    /// Answer to a question.
    Answer(&'a TileQuestion),
}

impl Stage<'_> {
    /// Returns the name of its folder in a run.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Balls => BALLS,
            Self::Answer(question) => &question.name,
        }
    }

    /// Returns the name of the plan in its records.
    pub(crate) fn plan_name<'p>(&self, plan: &'p Plan) -> &'p str {
        match self {
            Self::Balls => &plan.survey_name,
            Self::Answer(_) => &plan.name,
        }
    }

    /// Returns the folder of its results: in the folder of the run, except for balls that several plans share.
    pub(crate) fn folder(&self, plan: &Plan, run: &Path) -> PathBuf {
        let own = match self {
            Self::Balls => plan.shared_balls.as_deref().unwrap_or(run),
            Self::Answer(_) => run,
        };
        own.join(self.name())
    }

    /// Returns the path of the result of a tile.
    pub(crate) fn result(&self, plan: &Plan, run: &Path, tile: TileId) -> PathBuf {
        let extension = if matches!(self, Self::Balls) { "npz" } else { "tif" };
        self.folder(plan, run).join(format!("{}.{extension}", tile.name()))
    }

    /// Returns the path of the pulses that end in a tile.
    pub(crate) fn pulses(&self, plan: &Plan, run: &Path, tile: TileId) -> PathBuf {
        self.folder(plan, run).join(format!("{}.pulses.npz", tile.name()))
    }

    /// Returns the path of the crowns of a tile.
    pub(crate) fn crowns(&self, plan: &Plan, run: &Path, tile: TileId) -> PathBuf {
        self.folder(plan, run).join(format!("{}.crowns.npz", tile.name()))
    }

    pub(crate) fn record(&self, plan: &Plan, run: &Path, tile: TileId) -> PathBuf {
        self.folder(plan, run).join(format!("{}.json", tile.name()))
    }
}
