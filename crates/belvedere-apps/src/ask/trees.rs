//! What gets through trees, as a user chooses it.

use super::Context;
use super::scene::Scene;
use super::sections::TreesSection;
use crate::tree_light::{CrownLight, Leaves, Transmissivity, TreeLight};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// The light that gets through crowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThroughTrees {
    /// What pulses measured, where they did; none where they did not.
    Measured,
    /// What pulses measured; refused where they did not.
    Pulses,
    /// None: crowns are solid balls. Default: a survey of the winter, whose day is not known, would let the sun of the
    /// summer through.
    #[default]
    Opaque,
    /// What pulses measured in leaf, and a fifth of that optical depth without leaves; 0.03 and 0.5 of the light
    /// ([`Transmissivity::default`]) where nothing was measured.
    Seasons(Leaves),
    /// This share, 0 to 1, through any crown.
    Share(f64),
}

impl ThroughTrees {
    /// Whether answers are shares of light because of trees. What pulses measured is a yes or no, and a share beside
    /// it.
    #[must_use]
    pub fn is_light(&self) -> bool {
        matches!(self, Self::Seasons(_) | Self::Share(_))
    }

    /// What crowns let through, where pulses measured that or not; `None` where trees are opaque.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a share out of range, and for pulses that measured nothing.
    pub fn crowns(&self, are_measured: bool) -> Result<Option<CrownLight>> {
        let share = |transmissivity, leaves| CrownLight::Share { transmissivity, leaves };
        Ok(match (self, are_measured) {
            (Self::Opaque, _) | (Self::Measured, false) => None,
            (Self::Measured | Self::Pulses, true) => Some(CrownLight::Measured { leaves: None }),
            (Self::Pulses, false) => {
                return refused(
                    "pulses",
                    "another choice: the pulses in vegetation are unknown; use a cloud with return numbers, GPS times and preferably classes, and balls made with --trees measured, or a ball file of such a scene",
                );
            }
            (Self::Seasons(leaves), true) => Some(CrownLight::Measured { leaves: Some(*leaves) }),
            (Self::Seasons(leaves), false) => Some(share(Transmissivity::default(), *leaves)),
            (Self::Share(constant), _) => Some(share(Transmissivity::constant(*constant)?, Leaves::ByDate)),
        })
    }

    /// The light through the trees of a scene; `None` where they are opaque.
    ///
    /// # Errors
    /// Those of [`ThroughTrees::crowns`], [`Error::InvalidParameter`] for a scene that knows no vegetation, and those
    /// of building what blocks beside it.
    pub(super) fn of(&self, scene: &Scene, context: &mut Context, control: &Control<'_>) -> Result<Option<TreeLight>> {
        let model = scene.model();
        let measured = model.medium();
        let Some(crowns) = self.crowns(measured.is_some())? else { return Ok(None) };
        if !model.vegetation().contains(&true) {
            return refused(
                "given",
                "left out: no ball is known as vegetation; use a cloud with classes 3 to 5, or with return numbers and GPS times, or a ball file from such a cloud",
            );
        }
        context.report.trees = Some(TreesSection::of(&crowns, model.vegetation(), model.parts().medium.as_ref()));
        let medium = measured.filter(|_| matches!(crowns, CrownLight::Measured { .. }));
        Ok(Some(TreeLight { opaque: scene.without_vegetation(control)?, crowns, medium }))
    }
}

fn refused<T>(value: &str, expected: &'static str) -> Result<T> {
    Err(Error::InvalidParameter { parameter: Parameter::ThroughTrees, value: value.to_owned(), expected })
}
