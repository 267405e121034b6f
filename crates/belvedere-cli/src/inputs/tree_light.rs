//! Typed light through trees.

use crate::arguments::{LeavesChoice, ThroughTreesArguments, ThroughTreesChoice, refuse};
use anyhow::Result;
use belvedere::apps::ask;
use belvedere::apps::tree_light::Leaves;

impl ThroughTreesArguments {
    /// Returns the typed light through trees.
    pub(crate) fn choice(&self) -> Result<ask::ThroughTrees> {
        let follows_leaves = !matches!(self.through_trees, ThroughTreesChoice::None | ThroughTreesChoice::Share(_));
        if self.leaves.is_some() && !follows_leaves {
            return refuse("--leaves needs --through-trees measured, seasons or pulses");
        }
        let leaves = match self.leaves {
            None | Some(LeavesChoice::Auto) => Leaves::ByDate,
            Some(LeavesChoice::On) => Leaves::On,
            Some(LeavesChoice::Off) => Leaves::Off,
        };
        Ok(match self.through_trees {
            ThroughTreesChoice::Measured => ask::ThroughTrees::Measured(leaves),
            ThroughTreesChoice::None => ask::ThroughTrees::Opaque,
            ThroughTreesChoice::Seasons => ask::ThroughTrees::Seasons(leaves),
            ThroughTreesChoice::Share(share) => ask::ThroughTrees::Share(share),
            ThroughTreesChoice::Pulses => ask::ThroughTrees::Pulses(leaves),
        })
    }
}
