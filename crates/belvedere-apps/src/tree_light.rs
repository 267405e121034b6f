//! Light through the crowns of trees: what share of it gets through, by season or as pulses measured it.
//!
//! Balls are opaque. Two matrices tell what all of them leave free and what those leave free that are not vegetation;
//! every measure that is a sum over directions lies between its two values, by the share of the light that crowns let
//! through.

use crate::sun::{Date, Site};
use belvedere_core::medial::MedialBalls;
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

/// Whether trees carry leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foliage {
    /// In leaf.
    InLeaf,
    /// Without leaves.
    Bare,
}

impl Foliage {
    /// That of deciduous trees on a day of the year, 1 to 366, at a latitude in radians: in leaf from day 97 to day 300
    /// north of the tropics, half a year later south of them, and always between them, where no winter strips trees.
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

/// What share of the light gets through a crown, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Transmissivity {
    /// In leaf. Default 0.03: that of SOLWEIG, within the 0.01 to 0.05 measured on single trees in full leaf.
    pub in_leaf: f64,
    /// Without leaves. Default 0.5: that of SOLWEIG, within the 0.40 to 0.52 measured on single trees.
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

    /// What the pulses measured: the mean of `transmission`, (B), as [`belvedere_core::medial::CarvedBalls`] has it,
    /// over the balls of crowns by the area they cover; of the season that the survey was flown in, which is taken for
    /// both. `None` where no crown was measured.
    ///
    /// A beam is as wide as a hand and returns from below a crown where part of it gets through, so that this is more
    /// than the share of the light that does.
    #[must_use]
    pub fn measured(balls: &MedialBalls, transmission: &[f32]) -> Option<Self> {
        let (mut through, mut covered) = (0.0, 0.0);
        for (&share, &radius) in transmission.iter().zip(&balls.radii).filter(|(share, _)| !share.is_nan()) {
            let area = f64::from(radius) * f64::from(radius);
            through += area * f64::from(share);
            covered += area;
        }
        let share = through / covered;
        (covered > 0.0 && share.is_finite())
            .then(|| share.clamp(0.0, 1.0))
            .map(|share| Self { in_leaf: share, bare: share })
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

/// Whether trees carry leaves on a date.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Leaves {
    /// By the date, as [`Foliage::on_day`] has it; in leaf where a question has no date. Default.
    #[default]
    ByDate,
    /// In leaf, whatever the date.
    On,
    /// Bare, whatever the date.
    Off,
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
    /// That of a date at a site.
    #[must_use]
    pub fn on(date: Date, site: &Site) -> Self {
        Self { day_of_year: date.day_of_year(), latitude: site.latitude }
    }
}

/// What crowns let through, and when.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrownLight {
    /// What share of the light gets through a crown.
    pub transmissivity: Transmissivity,
    /// Whether trees carry leaves.
    pub leaves: Leaves,
}

impl CrownLight {
    /// Share of the light that gets through crowns in a season; `None` where a question has no date.
    #[must_use]
    pub fn share(&self, season: Option<Season>) -> f64 {
        let foliage = match (self.leaves, season) {
            (Leaves::Off, _) => Foliage::Bare,
            (Leaves::ByDate, Some(Season { day_of_year, latitude })) => Foliage::on_day(day_of_year, latitude),
            (Leaves::On, _) | (Leaves::ByDate, None) => Foliage::InLeaf,
        };
        self.transmissivity.of(foliage)
    }
}

/// A scene without its vegetation, and what share of the light its vegetation lets through.
pub struct TreeLight {
    /// The balls that are not vegetation.
    pub opaque: Arc<MedialScene>,
    /// What the vegetation lets through.
    pub crowns: CrownLight,
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
        Ok(Self { opaque, crowns: CrownLight { transmissivity, leaves } })
    }
}

/// Measures that are sums over directions, (M), with trees that let a share of the light through: `all` are their
/// values where nothing does, `opaque` those without vegetation. Sky view factors, openness, hours of sun and
/// irradiance are such sums.
///
/// # Errors
/// [`Error::LengthMismatch`] where the two differ in length, [`Error::InvalidParameter`] for a share outside 0 to 1.
pub fn through_crowns(all: &[f32], opaque: &[f32], transmissivity: f64) -> Result<Vec<f32>> {
    let share = Transmissivity::constant(transmissivity)?.in_leaf;
    let (expected, found) = (all.len(), opaque.len());
    if expected != found {
        return Err(Error::LengthMismatch { what: "values without vegetation", expected, found });
    }
    let between = |(&all, &opaque): (&f32, &f32)| {
        #[expect(clippy::cast_possible_truncation, reason = "between two numbers of f32")]
        let value = (f64::from(all) + share * (f64::from(opaque) - f64::from(all))) as f32;
        value
    };
    Ok(all.iter().zip(opaque).map(between).collect())
}
