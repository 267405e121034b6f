//! Areas that a plan clears, and the distance up to which points give cells a height.

use crate::grid::MapArea;
use crate::plan::Plan;
use belvedere::Result;
use belvedere::apps::targets::CellLevel;
use belvedere::ground::{MAX_GAP_FROM_RETURNS, SurfaceParams};
use belvedere::model::{ClearedArea, Clearing};

impl Plan {
    /// Returns this plan without the present objects in some areas. Points, their balls, and parts of balls beside a
    /// polygon that reach into it are removed. The ground below is closed.
    ///
    /// # Errors
    /// [`belvedere::Error::InvalidParameter`] for an area beside the survey and for the class of the ground.
    pub fn with_cleared(mut self, areas: Vec<ClearedArea>) -> Result<Self> {
        let (bounds, origin) = (self.bounds(), self.frame()?.origin);
        areas.iter().try_for_each(|area| area.rectangle_on(&bounds, origin).map(|_| ()))?;
        self.cleared = areas;
        // Cleared objects ended pulses that would prove the space behind them.
        self.proves &= self.cleared.is_empty();
        self.tiles = self.tiles_with_cells();
        Ok(self)
    }

    /// Returns the cleared areas, with the rectangles around polygons on the survey.
    pub(crate) fn cleared_areas(&self) -> Result<Vec<(&ClearedArea, Option<MapArea>)>> {
        let (bounds, origin) = (self.bounds(), self.frame()?.origin);
        let mut areas = Vec::new();
        for cleared in &self.cleared {
            areas.push((cleared, cleared.rectangle_on(&bounds, origin)?.map(|(low, high)| MapArea { low, high })));
        }
        Ok(areas)
    }

    /// Returns true if all areas can be cleared from a survey in a frame with this origin.
    pub(crate) fn has_sound_areas(&self, origin: [f64; 3]) -> bool {
        self.cleared.iter().all(|area| area.rectangle_on(&self.bounds(), origin).is_ok())
    }

    /// Returns the maximum distance from a point at which a cell of side `cell` may get a height, metres. It includes
    /// closed ground.
    pub(crate) fn reach(&self, cell: f64) -> f64 {
        let reach = SurfaceParams::reach(cell);
        let reach = if self.is_on_ground() { reach.max(MAX_GAP_FROM_RETURNS) } else { reach };
        if self.cleared.is_empty() { reach } else { reach.max(Clearing::REACH + cell) }
    }

    /// Returns true if cells lie on the ground instead of on the surface.
    pub(crate) fn is_on_ground(&self) -> bool {
        self.targets.level == CellLevel::Ground
    }
}
