//! Light through the crowns of trees: their transmission as measured by pulses, or the same for all crowns.
//!
//! Where pulses measured crowns, these are a medium: the share that gets along a line follows from its optical depth,
//! and the balls that are no vegetation block beside it. Otherwise crowns are balls. One matrix has the lines that all
//! balls leave free, a second those that balls other than vegetation leave free; lines free in the second only get a
//! constant share.

use crate::sun::{Date, Site};
use belvedere_core::medium::Medium;
use belvedere_core::model::SceneModel;
use belvedere_core::query::{BlockRule, MedialScene};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// First and last day of the year that deciduous trees of the northern hemisphere are in leaf.
const IN_LEAF: [u32; 2] = [97, 300];
/// Days that the seasons of the southern hemisphere are shifted by.
const HALF_A_YEAR: u32 = 183;
/// Latitude of the tropics, radians.
const TROPIC: f64 = 0.409;

/// Foliage of trees: in leaf or bare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foliage {
    /// In leaf.
    InLeaf,
    /// Bare trees.
    Bare,
}

impl Foliage {
    /// Returns the foliage of deciduous trees on a day of the year, 1 to 366, at a latitude in radians. They are in
    /// leaf from day 97 to day 300 north of the tropics, half a year later south of them, and always between them,
    /// where no winter strips trees.
    ///
    /// # Source
    /// The days are the defaults of SOLWEIG (Lindberg & Grimmond 2011), for Gothenburg.
    #[must_use]
    pub fn on_day(day_of_year: u32, latitude: f64) -> Self {
        if latitude.abs() < TROPIC {
            return Self::InLeaf;
        }
        let northern = if latitude < 0.0 { (day_of_year + HALF_A_YEAR - 1) % 366 + 1 } else { day_of_year };
        if (IN_LEAF[0]..=IN_LEAF[1]).contains(&northern) { Self::InLeaf } else { Self::Bare }
    }
}

/// Share of the light that passes a crown, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Transmissivity {
    /// In leaf. Default 0.03: that of SOLWEIG, within the 0.01 to 0.05 measured on single trees in full leaf.
    pub in_leaf: f64,
    /// Share for bare trees. Default 0.5: that of SOLWEIG, within the 0.40 to 0.52 measured on single trees.
    pub bare: f64,
}

impl Default for Transmissivity {
    /// # Source
    /// Konarska, Lindberg, Larsson, Thorsson & Holmer 2014, "Transmissivity of solar radiation through crowns of single
    /// urban trees", Theoretical and Applied Climatology 117; SOLWEIG (Lindberg & Grimmond 2011).
    fn default() -> Self {
        Self { in_leaf: 0.03, bare: 0.5 }
    }
}

impl Transmissivity {
    /// The same whatever the season.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a share outside 0 to 1.
    pub fn constant(share: f64) -> Result<Self> {
        if !(0.0..=1.0).contains(&share) {
            return Err(Error::InvalidParameter {
                parameter: Parameter::Transmissivity,
                value: share.to_string(),
                expected: "0 (opaque) to 1",
            });
        }
        Ok(Self { in_leaf: share, bare: share })
    }

    /// The share in one state.
    #[must_use]
    pub fn of(&self, foliage: Foliage) -> f64 {
        match foliage {
            Foliage::InLeaf => self.in_leaf,
            Foliage::Bare => self.bare,
        }
    }
}

/// Choice of the foliage: by date, in leaf or bare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Leaves {
    /// Foliage of the date, by [`Foliage::on_day`]; in leaf for a question without a date. Default.
    #[default]
    ByDate,
    /// In leaf, whatever the date.
    On,
    /// Bare, whatever the date.
    Off,
}

impl Leaves {
    /// The leaves of a season; `None` where a question has no date.
    #[must_use]
    pub fn foliage(self, season: Option<Season>) -> Foliage {
        match (self, season) {
            (Self::Off, _) => Foliage::Bare,
            (Self::ByDate, Some(Season { day_of_year, latitude })) => Foliage::on_day(day_of_year, latitude),
            (Self::On, _) | (Self::ByDate, None) => Foliage::InLeaf,
        }
    }
}

/// A day at a place, as far as trees are concerned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Season {
    /// Day of the year, 1 to 366.
    pub day_of_year: u32,
    /// Latitude, radians.
    pub latitude: f64,
}

impl Season {
    /// Returns the season of a date at a site.
    #[must_use]
    pub fn on(date: Date, site: &Site) -> Self {
        Self { day_of_year: date.day_of_year(), latitude: site.latitude }
    }
}

/// Light through crowns, by season.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CrownLight {
    /// The same share for all crowns, whatever the way through them.
    Share {
        /// Share of the light that passes a crown.
        transmissivity: Transmissivity,
        /// Choice of the foliage.
        leaves: Leaves,
    },
    /// Extinction that pulses measured in each voxel ([`belvedere_core::medium`]).
    Measured {
        /// Choice of the foliage, for a survey flown in leaf; `None` for the foliage of the survey on all dates.
        leaves: Option<Leaves>,
    },
}

impl CrownLight {
    /// Returns true if shadows are shares of light. Unchanged measured crowns give a yes or no.
    #[must_use]
    pub fn gives_shares(&self) -> bool {
        *self != Self::Measured { leaves: None }
    }

    /// Returns the share of the light that passes crowns in a season, or the factor of their optical depth if it was
    /// measured. A season is `None` for a question without a date.
    #[must_use]
    pub fn factor(&self, season: Option<Season>) -> f64 {
        match self {
            Self::Share { transmissivity, leaves } => transmissivity.of(leaves.foliage(season)),
            Self::Measured { leaves: None } => 1.0,
            Self::Measured { leaves: Some(leaves) } => match leaves.foliage(season) {
                Foliage::InLeaf => 1.0,
                Foliage::Bare => bare_depth(),
            },
        }
    }
}

/// Optical depth of a bare crown as a share of that in leaf: that of the shares of light in
/// [`Transmissivity::default`],
/// 0.2.
#[must_use]
pub fn bare_depth() -> f64 {
    let Transmissivity { in_leaf, bare } = Transmissivity::default();
    bare.ln() / in_leaf.ln()
}

/// A scene without its vegetation, and the share of the light that its vegetation lets through.
pub struct TreeLight {
    /// The balls that are not vegetation.
    pub opaque: Arc<MedialScene>,
    /// Light through the vegetation.
    pub crowns: CrownLight,
    /// The crowns, where they were measured.
    pub medium: Option<Arc<Medium>>,
}

impl TreeLight {
    /// The trees of a model, whose other balls block as `rule` says.
    ///
    /// # Errors
    /// Those of [`SceneModel::scene_without_vegetation`].
    pub fn new(
        model: &SceneModel,
        rule: &BlockRule,
        transmissivity: Transmissivity,
        leaves: Leaves,
        control: &Control<'_>,
    ) -> Result<Self> {
        let opaque = Arc::new(model.scene_without_vegetation(rule, control)?);
        Ok(Self { opaque, crowns: CrownLight::Share { transmissivity, leaves }, medium: None })
    }
}
