//! Survey around the cells of a tile.

use crate::answer::obstacles::ObstacleSearch;
use crate::grid::{MapArea, TileId};
use crate::plan::Plan;
use crate::plan::side_files::Others;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Survey around the cells of a tile.
pub(crate) struct TileSurroundings {
    pub(crate) plan: Arc<Plan>,
    /// Folder of the run.
    pub(crate) run: PathBuf,
    pub(crate) tile: TileId,
    /// Area of the cells.
    pub(crate) cells: MapArea,
    /// Minimum height of the cells, local metres.
    pub(crate) lowest: f64,
    /// Obstacles other than balls.
    pub(crate) others: Arc<Others>,
    /// Maximum number of balls that are tested together.
    pub(crate) max_balls: usize,
    /// Report on the balls.
    pub(crate) search: Arc<Mutex<ObstacleSearch>>,
}

impl TileSurroundings {
    /// Returns the report on the balls.
    pub(crate) fn found(&self) -> MutexGuard<'_, ObstacleSearch> {
        self.search.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
