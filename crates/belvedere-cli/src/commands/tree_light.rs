//! What gets through trees, as typed.

use crate::arguments::{LeavesChoice, ThroughTrees, ThroughTreesChoice, Usage};
use crate::pipeline::Scene;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::sun::Date;
use belvedere::apps::tree_light::{Foliage, Transmissivity};
use belvedere::control::Control;
use belvedere::query::{BlockRule, MedialScene};

/// A scene without its vegetation, and what share of the light vegetation lets through.
pub(crate) struct TreeLight {
    /// The balls that are not vegetation.
    pub(crate) opaque: MedialScene,
    transmissivity: Transmissivity,
    leaves: LeavesChoice,
}

impl ThroughTrees {
    /// What was typed, for balls that block as `params`; `None` where trees are opaque.
    pub(crate) fn of(&self, scene: &Scene, params: &BlockRule, summary: &mut Summary) -> Result<Option<TreeLight>> {
        if self.leaves.is_some() && self.through_trees != ThroughTreesChoice::Seasons {
            return Err(Usage("--leaves belongs to --through-trees seasons".to_owned()).into());
        }
        let transmissivity = match self.through_trees {
            ThroughTreesChoice::None => return Ok(None),
            ThroughTreesChoice::Seasons => Transmissivity::default(),
            ThroughTreesChoice::Share(share) => Transmissivity::constant(share)?,
            ThroughTreesChoice::Pulses => {
                Transmissivity::measured(scene.model.balls(), scene.model.transmission()).ok_or_else(|| {
                    let what = "--through-trees pulses: nothing is known of pulses that met vegetation; that takes a cloud with return \
                                numbers, GPS times and, best, classes, or a ball file made of one";
                    Usage(what.to_owned())
                })?
            }
        };
        if !scene.model.vegetation().contains(&true) {
            let what = "--through-trees: no ball is known to be vegetation; that takes a cloud with its classes (3 to 5), or with return \
                        numbers and GPS times, or a ball file made of one";
            return Err(Usage(what.to_owned()).into());
        }
        let opaque = scene.model.scene_without_vegetation(params, &Control::none())?;
        let mut section = Summary::default();
        section.add("balls_of_vegetation", scene.model.vegetation().iter().filter(|&&is| is).count());
        if transmissivity.in_leaf == transmissivity.bare {
            section.add("transmissivity", rounded(transmissivity.in_leaf, 4));
        } else {
            section
                .add("transmissivity_in_leaf", rounded(transmissivity.in_leaf, 4))
                .add("transmissivity_bare", rounded(transmissivity.bare, 4));
        }
        summary.add("trees", section);
        let leaves = self.leaves.unwrap_or(LeavesChoice::Auto);
        Ok(Some(TreeLight { opaque, transmissivity, leaves }))
    }
}

impl ThroughTrees {
    /// Whether trees are more than opaque.
    pub(crate) fn is_given(&self) -> bool {
        self.through_trees != ThroughTreesChoice::None
    }
}

/// Day of the year, from 1.
pub(crate) fn day_of_year(date: Date) -> u32 {
    let january = Date::new(date.year(), 1, 1).map_or(0.0, |first| first.noon_utc());
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 365 days")]
    let days = ((date.noon_utc() - january) / 86_400.0).round().max(0.0) as u32;
    days + 1
}

impl TreeLight {
    /// Share of the light on a day of the year at a latitude (radians), both `None` where a question has no date: trees are in leaf
    /// then.
    pub(crate) fn share(&self, date: Option<(u32, f64)>) -> f64 {
        let foliage = match (self.leaves, date) {
            (LeavesChoice::Off, _) => Foliage::Bare,
            (LeavesChoice::Auto, Some((day, latitude))) => Foliage::on_day(day, latitude),
            (LeavesChoice::On, _) | (LeavesChoice::Auto, None) => Foliage::InLeaf,
        };
        self.transmissivity.of(foliage)
    }
}
