//! What gets through trees, as typed.

use crate::arguments::{LeavesChoice, ThroughTrees, ThroughTreesChoice, Usage};
use crate::pipeline::Scene;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::ask;
use belvedere::apps::tree_light::{Leaves, Transmissivity, TreeLight};
use belvedere::control::Control;
use belvedere::query::BlockRule;

impl ThroughTrees {
    /// What was typed.
    pub(crate) fn choice(&self) -> Result<ask::ThroughTrees> {
        if self.leaves.is_some() && self.through_trees != ThroughTreesChoice::Seasons {
            return Err(Usage("--leaves needs --through-trees seasons".to_owned()).into());
        }
        let leaves = match self.leaves {
            None | Some(LeavesChoice::Auto) => Leaves::ByDate,
            Some(LeavesChoice::On) => Leaves::On,
            Some(LeavesChoice::Off) => Leaves::Off,
        };
        Ok(match self.through_trees {
            ThroughTreesChoice::None => ask::ThroughTrees::Opaque,
            ThroughTreesChoice::Seasons => ask::ThroughTrees::Seasons(leaves),
            ThroughTreesChoice::Share(share) => ask::ThroughTrees::Share(share),
            ThroughTreesChoice::Pulses => ask::ThroughTrees::Pulses,
        })
    }

    /// What was typed, with what pulses `measured` where that is asked for; `None` where trees are opaque.
    pub(crate) fn chosen(
        &self,
        measured: impl FnOnce() -> Option<Transmissivity>,
    ) -> Result<Option<(Transmissivity, Leaves)>> {
        if self.leaves.is_some() && self.through_trees != ThroughTreesChoice::Seasons {
            return Err(Usage("--leaves needs --through-trees seasons".to_owned()).into());
        }
        let transmissivity = match self.through_trees {
            ThroughTreesChoice::None => return Ok(None),
            ThroughTreesChoice::Seasons => Transmissivity::default(),
            ThroughTreesChoice::Share(share) => Transmissivity::constant(share)?,
            ThroughTreesChoice::Pulses => {
                measured().ok_or_else(|| {
                    let what = "--through-trees pulses: the pulses in vegetation are unknown; use a cloud with return numbers, GPS times and preferably classes, or a ball file from such a cloud";
                    Usage(what.to_owned())
                })?
            }
        };
        let leaves = match self.leaves {
            None | Some(LeavesChoice::Auto) => Leaves::ByDate,
            Some(LeavesChoice::On) => Leaves::On,
            Some(LeavesChoice::Off) => Leaves::Off,
        };
        Ok(Some((transmissivity, leaves)))
    }

    /// What was typed, for balls that block as `params`; `None` where trees are opaque.
    pub(crate) fn of(&self, scene: &Scene, params: &BlockRule, summary: &mut Summary) -> Result<Option<TreeLight>> {
        let measured = || Transmissivity::measured(scene.model.balls(), scene.model.transmission());
        let Some((transmissivity, leaves)) = self.chosen(measured)? else { return Ok(None) };
        if !scene.model.vegetation().contains(&true) {
            let what = "--through-trees: no ball is known as vegetation; use a cloud with classes 3 to 5, or with return numbers and GPS times, or a ball file from such a cloud";
            return Err(Usage(what.to_owned()).into());
        }
        let trees = TreeLight::new(&scene.model, params, transmissivity, leaves, &Control::none())?;
        let mut section = Summary::default();
        section.add("vegetation_balls", scene.model.vegetation().iter().filter(|&&is| is).count());
        if transmissivity.in_leaf == transmissivity.bare {
            section.add("transmissivity", rounded(transmissivity.in_leaf, 4));
        } else {
            section
                .add("transmissivity_in_leaf", rounded(transmissivity.in_leaf, 4))
                .add("transmissivity_without_leaves", rounded(transmissivity.bare, 4));
        }
        summary.add("trees", section);
        Ok(Some(trees))
    }
}

impl ThroughTrees {
    /// Whether trees are more than opaque.
    pub(crate) fn is_given(&self) -> bool {
        self.through_trees != ThroughTreesChoice::None
    }
}
