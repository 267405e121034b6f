//! The steps of the run of a tile, and where their results lie.

use crate::grid::TileId;
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

    pub(crate) fn folder(&self, run: &Path) -> PathBuf {
        run.join(self.name())
    }

    /// Where the result of a tile lies.
    pub(crate) fn result(&self, run: &Path, tile: TileId) -> PathBuf {
        let extension = if matches!(self, Self::Balls) { "npz" } else { "tif" };
        self.folder(run).join(format!("{}.{extension}", tile.name()))
    }

    pub(crate) fn record(&self, run: &Path, tile: TileId) -> PathBuf {
        self.folder(run).join(format!("{}.json", tile.name()))
    }
}
