//! What gets through trees, as a user chooses it.

use super::context::Context;
use super::remark::Remark;
use super::scene::{Scene, Whereabouts};
use super::sections::TreesSection;
use super::sun_place::SunPlace;
use crate::tree_light::{CrownLight, CrownShadows, Leaves, Transmissivity, TreeLight, measured_density};
use belvedere_core::model::FlightDays;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// The light that gets through crowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ThroughTrees {
    /// The transmission measured by pulses, with the leaves of the date of the question; none without measurements.
    Measured(Leaves),
    /// The measured transmission; an error without measurements.
    Pulses(Leaves),
    /// None: crowns are solid balls. Default.
    #[default]
    Opaque,
    /// The measured transmission, with shadows as shares of light; without measurements 0.03 and 0.5
    /// ([`Transmissivity::default`]). Crowns measured on an unknown day count as measured in leaf.
    Seasons(Leaves),
    /// This share, 0 to 1, through any crown.
    Share(f64),
}

impl ThroughTrees {
    /// Returns true if trees make answers shares of light. Measured crowns give a yes or no, and a share beside it.
    #[must_use]
    pub fn is_light(&self) -> bool {
        matches!(self, Self::Seasons(_) | Self::Share(_))
    }

    /// Returns the transmission of crowns, measured or assumed; `None` for opaque trees. `density` is that of the
    /// crowns at the time ([`density_at`]), where that is known.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a share out of range, and for pulses that measured nothing.
    pub fn crowns(&self, are_measured: bool, density: Option<f64>) -> Result<Option<CrownLight>> {
        let share = |transmissivity, leaves| CrownLight::Share { transmissivity, leaves };
        let measured =
            |leaves: &Leaves, density, shadows| Some(CrownLight::Measured { leaves: *leaves, density, shadows });
        Ok(match (self, are_measured) {
            (Self::Opaque, _) | (Self::Measured(_), false) => None,
            (Self::Measured(leaves) | Self::Pulses(leaves), true) => measured(leaves, density, CrownShadows::Answers),
            (Self::Pulses(_), false) => {
                return refused(
                    "pulses",
                    "another choice: the pulses in vegetation are unknown; use a cloud with return numbers, GPS times and preferably classes, and balls made with --trees measured, or a ball file of such a scene",
                );
            }
            (Self::Seasons(leaves), true) => measured(leaves, density.or(Some(1.0)), CrownShadows::Shares),
            (Self::Seasons(leaves), false) => Some(share(Transmissivity::default(), *leaves)),
            (Self::Share(constant), _) => Some(share(Transmissivity::constant(*constant)?, Leaves::ByDate)),
        })
    }

    /// The light through the trees of a scene, at a latitude, radians, where a question has one; `None` where they are
    /// opaque.
    ///
    /// # Errors
    /// Those of [`ThroughTrees::crowns`], [`Error::InvalidParameter`] for a scene that knows no vegetation, and those
    /// of building what blocks beside it.
    pub(super) fn of(
        &self,
        (scene, latitude): (&Scene, Option<f64>),
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Option<TreeLight>> {
        let model = scene.model();
        let measured = model.medium();
        let days = model.flight_days();
        let density = density_at(&days, latitude, &scene.whereabouts());
        let Some(crowns) = self.crowns(measured.is_some(), density)? else { return Ok(None) };
        if !model.vegetation().contains(&true) {
            return refused(
                "given",
                "left out: no ball is known as vegetation; use a cloud with classes 3 to 5, or with return numbers and GPS times, or a ball file from such a cloud",
            );
        }
        context.report.trees =
            Some(TreesSection::of(&crowns, model.vegetation(), (model.parts().medium.as_ref(), &days)));
        let medium = measured.filter(|_| matches!(crowns, CrownLight::Measured { .. }));
        Ok(Some(TreeLight { opaque: scene.without_vegetation(control)?, crowns, medium }))
    }
}

/// Returns the density of crowns on the days of a survey ([`measured_density`]), at a latitude, radians, or else at the
/// place of its reference system; `None` if the days or the place are not known.
#[must_use]
pub fn density_at(days: &FlightDays, latitude: Option<f64>, whereabouts: &Whereabouts<'_>) -> Option<f64> {
    let by_system = || {
        let (site, _) = SunPlace::default().site_of(whereabouts.frame, &whereabouts.bounds, None).ok()?;
        Some(site.latitude)
    };
    measured_density(days, latitude.or_else(by_system)?)
}

/// Returns a remark on the leaves of measured crowns in the seasons of a question
/// ([`CrownLight::known_factors`]).
pub fn remark_on_leaves(crowns: CrownLight, factors: impl IntoIterator<Item = f64>) -> Option<Remark> {
    let CrownLight::Measured { density, .. } = crowns else { return None };
    let mut factors = factors.into_iter();
    if density.is_none() {
        let text = "the days on which crowns were measured are not known: they hold back as much light as they did \
                    then, whatever the season; give the day of the flight with --flown";
        return factors.next().map(|_| Remark::note("leaves-not-known", text));
    }
    let other = factors.max_by(|a, b| a.ln().abs().total_cmp(&b.ln().abs())).filter(|factor| *factor != 1.0)?;
    let factor = rounded(other, 2);
    let [happened, shadows] = if other > 1.0 { ["come out", "dark"] } else { ["fallen", "light"] };
    let text = format!(
        "crowns are taken to be {factor} times as dense as they were measured, since leaves have {happened}; evergreen \
         trees are not separated, and their shadows are too {shadows}"
    );
    Some(Remark::note("leaves-unlike-measured", text).with("factor", factor))
}

fn refused<T>(value: &str, expected: &'static str) -> Result<T> {
    Err(Error::invalid(Parameter::ThroughTrees, value, expected))
}
