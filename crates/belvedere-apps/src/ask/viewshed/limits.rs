//! Observers and their limits.

use crate::ask::standing::Standing;
use crate::viewshed::SightLimits;
use belvedere_data::Result;
use serde::{Deserialize, Serialize};

/// Someone who looks around, or a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingObserver {
    /// Position.
    pub standing: Standing,
    /// Limits. Values of `None` follow from the question.
    pub limits: ViewLimits,
}

/// Limits of direction and distance; targets outside have no answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct ViewLimits {
    /// Azimuths from and to, clockwise from the north of the question, degrees; 300 to 60 runs through north. `None`
    /// for all.
    pub azimuth_range_deg: Option<[f64; 2]>,
    /// Minimum and maximum angle above the horizon, degrees, -90 to 90. `None` for all.
    pub elevation_range_deg: Option<[f64; 2]>,
    /// Minimum distance on the map, metres; `None` for 0.
    pub min_distance: Option<f64>,
    /// Maximum distance on the map, metres; `None` for no limit.
    pub max_distance: Option<f64>,
}

impl ViewLimits {
    /// Checks the limits.
    ///
    /// # Errors
    /// Those of [`SightLimits::validate`].
    pub fn check(&self) -> Result<()> {
        self.sight_limits(0.0).map(|_| ())
    }

    /// Returns the limits of `self`, completed by those of `usual`.
    #[must_use]
    pub fn or(&self, usual: &Self) -> Self {
        Self {
            azimuth_range_deg: self.azimuth_range_deg.or(usual.azimuth_range_deg),
            elevation_range_deg: self.elevation_range_deg.or(usual.elevation_range_deg),
            min_distance: self.min_distance.or(usual.min_distance),
            max_distance: self.max_distance.or(usual.max_distance),
        }
    }

    /// In radians from grid north, which has the azimuth `grid_north`, radians.
    pub(super) fn sight_limits(&self, grid_north: f64) -> Result<SightLimits> {
        let usual = SightLimits::default();
        let limits = SightLimits {
            azimuth: self.azimuth_range_deg.map(|range| range.map(|azimuth| azimuth.to_radians() - grid_north)),
            elevation: self.elevation_range_deg.map(|range| range.map(f64::to_radians)),
            distance: [self.min_distance.unwrap_or(usual.distance[0]), self.max_distance.unwrap_or(usual.distance[1])],
        };
        limits.validate()?;
        Ok(limits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_of_an_observer_override_those_of_the_question_one_by_one() {
        let usual =
            ViewLimits { azimuth_range_deg: Some([300.0, 60.0]), max_distance: Some(500.0), ..ViewLimits::default() };
        let own = ViewLimits { max_distance: Some(50.0), ..ViewLimits::default() }.or(&usual);
        let limits = own.sight_limits(0.5).unwrap();
        assert_eq!(limits.azimuth, Some([300f64.to_radians() - 0.5, 60f64.to_radians() - 0.5]));
        assert_eq!(limits.distance, [0.0, 50.0]);
    }
}
