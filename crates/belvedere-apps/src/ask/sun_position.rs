//! Position of the sun above a scene.

use super::answers::{Answered, Answers, Ask};
use super::context::Context;
use super::places::Places;
use super::scene::Scene;
use super::sun_place::SunPlace;
use crate::sun::sun_position_with;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use serde::{Deserialize, Serialize};

/// Position of the sun at some times.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct SunPositionQuestion {
    /// Instants, ISO 8601, with an offset unless the zone says how clocks run.
    pub times: Vec<String>,
    /// Location on earth, and clock.
    pub place: SunPlace,
}

/// The sun at one time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SunStands {
    /// The time by the clocks of the place.
    pub time: String,
    /// Azimuth, clockwise from true north, degrees.
    pub azimuth_deg: f64,
    /// Elevation above the horizon, degrees.
    pub elevation_deg: f64,
}

impl Ask for SunPositionQuestion {
    type Found = Vec<SunStands>;

    fn check(&self) -> Result<()> {
        let zone = self.place.any_zone(&self.place.check()?, &self.times)?;
        self.times.iter().try_for_each(|time| self.place.instant(time, &zone).map(|_| ()))
    }

    fn answer(&self, scene: &Scene, _places: &Places, context: &mut Context, _control: &Control<'_>) -> Answered<Self> {
        let site = self.place.site(scene, context, None)?;
        let zone = self.place.clock(&site, &self.times, context)?;
        let stands = |time: &String| {
            let instant = self.place.instant(time, &zone)?;
            let position = sun_position_with(&site, instant, self.place.refraction)?;
            let [azimuth_deg, elevation_deg] = [position.azimuth, position.elevation].map(f64::to_degrees);
            Ok(SunStands { time: zone.display(instant), azimuth_deg, elevation_deg })
        };
        let found = self.times.iter().map(stands).collect::<Result<Vec<_>>>()?;
        for SunStands { time, azimuth_deg, elevation_deg } in &found {
            let [azimuth, elevation] = [azimuth_deg, elevation_deg].map(|&angle| rounded(angle, 2));
            context.headline(format!("{time}: azimuth {azimuth}, elevation {elevation} degrees"));
        }
        Ok(Answers::new(found, Vec::new()))
    }
}
