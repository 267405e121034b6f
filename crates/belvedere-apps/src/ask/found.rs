//! Results of any question as targets with values, or as the columns of a table.

use super::horizon::HorizonResults;
use super::question::{Found, Question};
use super::scene::Scene;
use super::sun_and_sky::OnTargets;
use super::sun_position::SunStands;
use belvedere_data::result_columns::ResultColumn;

impl Question {
    /// Returns true if the answer has a value for each target ([`Found::on_targets`]).
    #[must_use]
    pub fn has_values_of_targets(&self) -> bool {
        matches!(
            self,
            Self::Shadow(_)
                | Self::SunHours(_)
                | Self::SkyView(_)
                | Self::Irradiance(_)
                | Self::Heat(_)
                | Self::Towers(_)
        )
    }
}

impl Found {
    /// Returns the targets that the measures have values of; `None` if the answer is no value for each target.
    #[must_use]
    pub fn on_targets(&self) -> Option<&OnTargets> {
        match self {
            Self::Shadow(found) => Some(&found.on),
            Self::SunHours(on) | Self::SkyView(on) | Self::Heat(on) => Some(on),
            Self::Irradiance(found) => found.on.as_ref(),
            Self::Towers(found) => Some(&found.on_targets),
            _ => None,
        }
    }

    /// Returns the table of the results, where they are one: suns, lines of sight, horizons or isovists.
    #[must_use]
    pub fn columns(&self, scene: &Scene) -> Vec<ResultColumn> {
        match self {
            Self::SunPosition(suns) => sun_columns(suns),
            Self::LineOfSight(found) => found.table(scene),
            Self::Horizon(found) => horizon_columns(found),
            Self::Isovist(found) => {
                let eyes = ResultColumn::coordinates(scene.frame(), &found.eyes.places);
                eyes.into_iter().chain(found.columns()).collect()
            }
            _ => Vec::new(),
        }
    }
}

fn sun_columns(suns: &[SunStands]) -> Vec<ResultColumn> {
    vec![
        ResultColumn::words("time", suns.iter().map(|sun| &sun.time)),
        ResultColumn::real("azimuth_deg", suns.iter().map(|sun| sun.azimuth_deg), 4),
        ResultColumn::real("elevation_deg", suns.iter().map(|sun| sun.elevation_deg), 4),
    ]
}

/// The azimuths, and the elevations of each observer with the ends of their intervals; no values where nobody looks.
fn horizon_columns(found: &HorizonResults) -> Vec<ResultColumn> {
    let count = found.azimuth_count;
    let azimuths = (0..count).map(|i| 360.0 * i as f64 / count as f64);
    let mut columns = vec![ResultColumn::real("azimuth_deg", azimuths, 6)];
    let of_each = |eye: usize, name: &str, value: &dyn Fn(usize) -> Option<f64>| {
        let name = if found.elevations_deg.len() == 1 { name.to_owned() } else { format!("{name}_{}", eye + 1) };
        ResultColumn::real(name, (0..count).map(|i| value(i).unwrap_or(f64::NAN)), 4)
    };
    for (eye, elevations) in found.elevations_deg.iter().enumerate() {
        columns.push(of_each(eye, "elevation_deg", &|i| elevations.get(i).copied()));
        if let Some(ends) = found.intervals_deg.as_ref().and_then(|intervals| intervals.get(eye)) {
            columns.push(of_each(eye, "low_deg", &|i| ends.get(i).map(|ends| ends[0])));
            columns.push(of_each(eye, "high_deg", &|i| ends.get(i).map(|ends| ends[1])));
        }
    }
    columns
}
