//! Light through the crowns of trees: their transmission as measured by pulses, or the same for all crowns.
//!
//! Where pulses measured crowns, these are a medium: the share that gets along a line follows from its optical depth,
//! and the balls that are no vegetation block beside it. Otherwise crowns are balls. One matrix has the lines that all
//! balls leave free, a second those that balls other than vegetation leave free; lines free in the second only get a
//! constant share.

use crate::sun::{Date, Site};
use belvedere_core::medium::Medium;
use belvedere_core::model::{FlightDays, SceneModel};
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
            return Err(Error::invalid(Parameter::Transmissivity, share, "0 (opaque) to 1"));
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Leaves {
    /// Foliage of the date, by [`Foliage::on_day`]. Without a date measured crowns are as they were then, and others in
    /// leaf. Default.
    #[default]
    ByDate,
    /// In leaf, whatever the date.
    On,
    /// Bare, whatever the date.
    Off,
}

impl Leaves {
    /// The leaves in a season; `None` where neither says what they are.
    #[must_use]
    pub fn foliage(self, season: Option<Season>) -> Option<Foliage> {
        match self {
            Self::Off => Some(Foliage::Bare),
            Self::On => Some(Foliage::InLeaf),
            Self::ByDate => season.map(|Season { day_of_year, latitude }| Foliage::on_day(day_of_year, latitude)),
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
        /// Choice of the foliage.
        leaves: Leaves,
        /// Density of crowns when they were measured ([`measured_density`]); `None` if it is not known: crowns stay as
        /// they were, whatever the date.
        density: Option<f64>,
        /// Kind of the shadows behind them.
        shadows: CrownShadows,
    },
}

/// Kind of the shadows behind measured crowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CrownShadows {
    /// A yes or no: lit where half or more of the light arrives.
    Answers,
    /// The share of the light that arrives.
    Shares,
}

impl CrownLight {
    /// Returns true if shadows are shares of light rather than a yes or no.
    #[must_use]
    pub fn gives_shares(&self) -> bool {
        !matches!(self, Self::Measured { shadows: CrownShadows::Answers, .. })
    }

    /// Returns the share of the light that passes crowns in a season, or the factor of their optical depth if it was
    /// measured. A season is `None` for a question without a date.
    #[must_use]
    pub fn factor(&self, season: Option<Season>) -> f64 {
        match self {
            Self::Share { transmissivity, leaves } => {
                transmissivity.of(leaves.foliage(season).unwrap_or(Foliage::InLeaf))
            }
            Self::Measured { leaves, density, .. } => match (leaves.foliage(season), density) {
                (Some(foliage), Some(density)) => crown_density(foliage) / density,
                _ => 1.0,
            },
        }
    }
}

impl CrownLight {
    /// The factors of seasons, without those of which neither a date nor a choice says what leaves are.
    pub fn known_factors(self, seasons: impl IntoIterator<Item = Option<Season>>) -> impl Iterator<Item = f64> {
        let (Self::Share { leaves, .. } | Self::Measured { leaves, .. }) = self;
        let is_known = move |season: &Option<Season>| leaves.foliage(*season).is_some();
        seasons.into_iter().filter(is_known).map(move |season| self.factor(season))
    }
}

/// Extinction of crowns of deciduous trees, and with it their optical depth, as a share of that in leaf: 1 in leaf, and
/// bare that of the shares of light in [`Transmissivity::default`], 0.2.
#[must_use]
pub fn crown_density(foliage: Foliage) -> f64 {
    let Transmissivity { in_leaf, bare } = Transmissivity::default();
    match foliage {
        Foliage::InLeaf => 1.0,
        Foliage::Bare => bare.ln() / in_leaf.ln(),
    }
}

/// Returns the density of crowns on the days of measurement at a latitude, radians: the mean [`crown_density`] of the
/// points; `None` if no day is known.
#[must_use]
pub fn measured_density(days: &FlightDays, latitude: f64) -> Option<f64> {
    let dated = days.iter().filter_map(|(date, points)| Some((Date::parse(date).ok()?.day_of_year(), points as f64)));
    let (mut sum, mut count) = (0.0, 0.0);
    for (day, points) in dated {
        sum += points * crown_density(Foliage::on_day(day, latitude));
        count += points;
    }
    (count > 0.0).then(|| sum / count)
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
