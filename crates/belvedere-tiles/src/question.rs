//! What is asked of a city.

use belvedere::apps::sky_view::SkyDirections;
use belvedere::{Error, Result};
use serde::{Deserialize, Serialize};

/// A question that has an answer for each cell on top of what stands there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Question {
    /// Which cells a sun lights: 1 lit, 0 in shadow, 2 unproven.
    Shadow {
        /// Name of the folder of its results.
        name: String,
        /// Unit vector from the scene to the sun: x east, y grid north, z up.
        to_sun: [f64; 3],
    },
    /// The sky view factor of cells.
    SkyView {
        /// Number of directions that stand for the sky.
        directions: usize,
    },
}

impl Question {
    /// Name of the folder of its results.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Shadow { name, .. } => name,
            Self::SkyView { .. } => "sky_view_factor",
        }
    }

    /// Directions that lines of sight are asked in.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a sun that is not above the horizon, and those of [`SkyDirections::even`].
    pub(crate) fn directions(&self) -> Result<Vec<[f64; 3]>> {
        match self {
            Self::Shadow { to_sun, .. } if to_sun[2] > 0.0 => Ok(vec![*to_sun]),
            Self::Shadow { to_sun, .. } => Err(Error::InvalidParameter {
                name: "elevation of the sun",
                value: format!("{:.3} degrees", to_sun[2].clamp(-1.0, 1.0).asin().to_degrees()),
                expected: "above the horizon",
            }),
            Self::SkyView { directions } => Ok(SkyDirections::even(*directions)?.directions),
        }
    }
}
