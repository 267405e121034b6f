//! Surfaces: how much they reflect, emit, and warm in the sun.

use crate::window_views::SeenKind;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Cover of the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum GroundCover {
    /// Cobble and concrete. Default.
    #[default]
    Paved,
    /// Dark asphalt.
    Asphalt,
    /// Grass.
    Grass,
    /// Bare soil.
    Soil,
}

/// Material of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Material {
    /// The ground.
    Ground(GroundCover),
    /// Walls, roofs, and whatever else stands.
    Built,
    /// Crowns of trees and other plants.
    Leaves,
    /// Water.
    Water,
}

/// Warming of a sunlit surface above the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warming {
    /// Greatest excess of a day for each degree of the sun's greatest elevation, K.
    pub per_degree: f64,
    /// The same for a sun at the horizon, K.
    pub at_horizon: f64,
    /// Hour of the greatest excess, mean solar time.
    pub hour: f64,
}

impl Material {
    /// Share of shortwave radiation that it reflects, 0 to 1.
    ///
    /// # Source
    /// Lindberg, Onomura & Grimmond 2016, Influence of ground surface characteristics on the mean radiant temperature
    /// in urban areas, table 1; walls: Lindberg, Holmer & Thorsson 2008.
    #[must_use]
    pub fn albedo(self) -> f64 {
        match self {
            Self::Ground(GroundCover::Asphalt) => 0.18,
            Self::Ground(GroundCover::Grass) | Self::Leaves => 0.16,
            Self::Ground(GroundCover::Soil) => 0.25,
            Self::Ground(GroundCover::Paved) | Self::Built => 0.2,
            Self::Water => 0.05,
        }
    }

    /// Share of a black body's longwave radiation that it emits, 0 to 1.
    ///
    /// # Source
    /// As [`Material::albedo`].
    #[must_use]
    pub fn emissivity(self) -> f64 {
        match self {
            Self::Ground(GroundCover::Grass | GroundCover::Soil) | Self::Leaves => 0.94,
            Self::Ground(GroundCover::Paved | GroundCover::Asphalt) => 0.95,
            Self::Built => 0.9,
            Self::Water => 0.98,
        }
    }

    /// Its warming in the sun; `None` for a surface that stays as warm as the air.
    ///
    /// # Source
    /// As [`Material::albedo`]: fitted to measured surface temperatures.
    #[must_use]
    pub fn warming(self) -> Option<Warming> {
        let warming = |per_degree, at_horizon, hour| Some(Warming { per_degree, at_horizon, hour });
        match self {
            Self::Ground(GroundCover::Paved) | Self::Built => warming(0.37, -3.41, 15.0),
            Self::Ground(GroundCover::Asphalt) => warming(0.58, -9.78, 15.0),
            Self::Ground(GroundCover::Grass) => warming(0.21, -3.38, 14.0),
            Self::Ground(GroundCover::Soil) => warming(0.33, -3.01, 14.0),
            Self::Leaves | Self::Water => None,
        }
    }

    /// Materials whose warming differs, each with a number of its own.
    pub(super) const WARMED: usize = 2;

    /// Number of its warming among those of one question: the ground, then what is built.
    pub(super) fn warmed(self) -> Option<usize> {
        match self {
            Self::Ground(_) => Some(0),
            Self::Built => Some(1),
            Self::Leaves | Self::Water => None,
        }
    }

    /// The material of what is seen. Surfaces of no known kind are ground where they are level, and built elsewhere.
    #[must_use]
    pub fn of(kind: SeenKind, normal: [f64; 3], cover: GroundCover) -> Self {
        /// Height of the normal of a slope of 45°.
        const LEVEL: f64 = std::f64::consts::FRAC_1_SQRT_2;
        match kind {
            SeenKind::Vegetation => Self::Leaves,
            SeenKind::Water => Self::Water,
            SeenKind::Building => Self::Built,
            SeenKind::Ground | SeenKind::Beyond | SeenKind::Sky => Self::Ground(cover),
            SeenKind::Other if normal[2] > LEVEL => Self::Ground(cover),
            SeenKind::Other => Self::Built,
        }
    }
}

/// Surfaces of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct SurfaceParams {
    /// Cover of the ground.
    pub ground: GroundCover,
    /// Share of the warming that measurements of single surfaces gave, 0 to 2. Default 0.5: 1 is too warm for lit
    /// squares among buildings.
    pub warming: f64,
}

impl Default for SurfaceParams {
    fn default() -> Self {
        Self { ground: GroundCover::default(), warming: 0.5 }
    }
}

impl SurfaceParams {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a share of warming outside its range.
    pub fn validate(&self) -> Result<()> {
        if (0.0..=2.0).contains(&self.warming) {
            return Ok(());
        }
        Err(Error::invalid(Parameter::GroundWarming, self.warming, "0 to 2"))
    }
}
