//! The question of a viewshed.

use super::limits::{StandingObserver, ViewLimits};
use crate::ask::how_sure::HowSure;
use crate::ask::north::North;
use crate::targets::TARGET_LIFT;
use crate::viewshed::OBSERVER_HEIGHT;
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::{EarthParams, UnprovenAs};
use serde::{Deserialize, Serialize};

/// Places visible from observers, or from which a target is visible.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct ViewshedQuestion {
    /// Observers; for a reverse viewshed the one target.
    #[serde(skip)]
    pub observers: Vec<StandingObserver>,
    /// True for a reverse viewshed: observers stand in all cells, and look at one target. Default: false.
    pub reverse: bool,
    /// Height of observers above the ground, metres, 0 or more; `None` for 1.7.
    pub observer_height: Option<f64>,
    /// Height of targets above the ground, metres, 0 or more; `None` for 0.1.
    pub target_height: Option<f64>,
    /// Limits of observers without their own. Default: none.
    pub limits: ViewLimits,
    /// The north that azimuths count from.
    pub north: North,
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
    /// Treatment of unproven targets; `None` to report them if pulses are known.
    pub unproven: Option<UnprovenAs>,
    /// Request for the certainty of answers for cells and points.
    pub how_sure: HowSure,
    /// Side of a cell, metres, above 0; `None` for 0.5, doubled until there are at most 4 million cells.
    pub cell: Option<f64>,
    /// Source of ground points.
    pub ground: GroundPoints,
    /// Targets. Default: cells.
    pub targets: Vec<ViewshedTargets>,
    /// True to keep a mask of the cells of each observer. Default: counts only.
    pub masks: bool,
    /// Height above the ground up to which lowest visible heights are computed, metres, 0 or more; `None` for none.
    pub max_height: Option<f64>,
}

/// Targets of a viewshed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ViewshedTargets {
    /// Cells on the ground.
    Cells,
    /// The points that show the ground, which are those of the scene unless its ground comes from another cloud.
    Points,
    /// Cells of the terrain beyond the cloud.
    FarTerrain,
}

impl Default for ViewshedQuestion {
    fn default() -> Self {
        Self {
            observers: Vec::new(),
            reverse: false,
            observer_height: None,
            target_height: None,
            limits: ViewLimits::default(),
            north: North::default(),
            earth: EarthParams::default(),
            unproven: None,
            how_sure: HowSure::default(),
            cell: None,
            ground: GroundPoints::default(),
            targets: vec![ViewshedTargets::Cells],
            masks: false,
            max_height: None,
        }
    }
}

impl ViewshedQuestion {
    pub(super) fn who(&self) -> &'static str {
        if self.reverse { "target" } else { "observer" }
    }

    pub(super) fn who_is_blind(&self) -> &'static str {
        if self.reverse { "no cell sees the target" } else { "the observer sees no cell" }
    }

    /// Returns advice for a view in which nothing is visible.
    pub(super) fn way_to_see(&self) -> &'static str {
        match self.reverse {
            true => "give a greater height above its surface",
            false => "does it stand below a tree or between obstacles?",
        }
    }

    pub(super) fn wants(&self, targets: ViewshedTargets) -> bool {
        self.targets.contains(&targets)
    }

    pub(super) fn unproven(&self) -> UnprovenAs {
        self.unproven.unwrap_or(UnprovenAs::Reported)
    }

    /// Height above the ground of the given places, and of the targets in cells, metres.
    pub(super) fn heights(&self) -> [f64; 2] {
        let [observer, target] =
            [self.observer_height.unwrap_or(OBSERVER_HEIGHT), self.target_height.unwrap_or(TARGET_LIFT)];
        if self.reverse { [target, observer] } else { [observer, target] }
    }
}
