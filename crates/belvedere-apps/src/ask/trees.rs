//! What gets through trees, as a user chooses it.

use super::Context;
use super::scene::Scene;
use super::sections::TreesSection;
use crate::tree_light::{CrownLight, Leaves, Transmissivity, TreeLight};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// The share of light that gets through crowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThroughTrees {
    /// None. Default.
    #[default]
    Opaque,
    /// 0.03 in leaf and 0.5 without leaves: [`Transmissivity::default`].
    Seasons(Leaves),
    /// This share, 0 to 1.
    Share(f64),
    /// The share of pulses that passed.
    Pulses,
}

impl ThroughTrees {
    /// Whether light gets through.
    #[must_use]
    pub fn is_light(&self) -> bool {
        *self != Self::Opaque
    }

    /// What crowns let through, where pulses `measured` that; `None` where trees are opaque.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a share out of range, and for pulses that measured nothing.
    pub fn crowns(&self, measured: impl FnOnce() -> Option<Transmissivity>) -> Result<Option<CrownLight>> {
        let (transmissivity, leaves) = match self {
            Self::Opaque => return Ok(None),
            Self::Seasons(leaves) => (Transmissivity::default(), *leaves),
            Self::Share(share) => (Transmissivity::constant(*share)?, Leaves::ByDate),
            Self::Pulses => match measured() {
                Some(transmissivity) => (transmissivity, Leaves::ByDate),
                None => {
                    return refused(
                        "pulses",
                        "another choice: the pulses in vegetation are unknown; use a cloud with return numbers, GPS times and preferably classes, or a ball file from such a cloud",
                    );
                }
            },
        };
        Ok(Some(CrownLight { transmissivity, leaves }))
    }

    /// The light through the trees of a scene; `None` where they are opaque.
    ///
    /// # Errors
    /// Those of [`ThroughTrees::crowns`], [`Error::InvalidParameter`] for a scene that knows no vegetation, and those
    /// of building what blocks beside it.
    pub(super) fn of(&self, scene: &Scene, context: &mut Context, control: &Control<'_>) -> Result<Option<TreeLight>> {
        let model = scene.model();
        let measured = || Transmissivity::measured(model.balls(), model.transmission());
        let Some(crowns) = self.crowns(measured)? else { return Ok(None) };
        if !model.vegetation().contains(&true) {
            return refused(
                "given",
                "left out: no ball is known as vegetation; use a cloud with classes 3 to 5, or with return numbers and GPS times, or a ball file from such a cloud",
            );
        }
        context.report.trees = Some(TreesSection::of(&crowns.transmissivity, model.vegetation()));
        Ok(Some(TreeLight { opaque: scene.without_vegetation(control)?, crowns }))
    }
}

fn refused<T>(value: &str, expected: &'static str) -> Result<T> {
    Err(Error::InvalidParameter { parameter: Parameter::ThroughTrees, value: value.to_owned(), expected })
}
