//! Location of a scene on earth, its clock, the typed days, and the division of the sky.

use crate::arguments::{ElevationChoice, NorthArguments, PatchesChoice, SunPeriod, SunPlaceArguments, refuse};
use anyhow::Result;
use belvedere::apps::ask::{self, SkyParts};
use belvedere::apps::sun::Refraction;

impl NorthArguments {
    /// Returns the typed north.
    pub(crate) fn choice(&self) -> ask::North {
        if self.grid_north { ask::North::Grid } else { ask::North::True }
    }
}

impl SunPlaceArguments {
    /// Returns the typed place, with the north of azimuths.
    pub(crate) fn place(&self, north: &NorthArguments) -> Result<ask::SunPlace> {
        Ok(ask::SunPlace {
            location: self.location.as_ref().map(|location| location.0),
            zone: self.zone.clone(),
            refraction: self.refraction()?,
            north: north.choice(),
        })
    }

    /// Returns the typed place, without azimuths.
    pub(crate) fn place_from_true_north(&self) -> Result<ask::SunPlace> {
        self.place(&NorthArguments { grid_north: false })
    }

    /// Returns the given latitude, radians.
    pub(crate) fn latitude(&self) -> Option<f64> {
        self.location.map(|location| location.0[0].to_radians())
    }

    /// Returns the refraction of the sun by the air.
    pub(crate) fn refraction(&self) -> Result<Refraction> {
        match (self.elevation, &self.air) {
            (ElevationChoice::Geometric, Some(_)) => refuse("--air needs --sun-elevation apparent"),
            (ElevationChoice::Geometric, None) => Ok(Refraction::Without),
            (ElevationChoice::Apparent, None) => Ok(Refraction::Standard),
            (ElevationChoice::Apparent, Some(air)) => {
                let [pressure, temperature] = air.0;
                Ok(Refraction::Air { pressure, temperature })
            }
        }
    }
}

impl SunPeriod {
    /// The days that were typed.
    pub(crate) fn days(&self) -> ask::Days {
        ask::Days {
            dates: self.date.clone(),
            between: self.from.clone().zip(self.to.clone()).map(|(from, to)| [from, to]),
            year: Some(self.year),
            time_step_min: self.step,
            min_sun_elevation_deg: self.min_elevation,
        }
    }

    /// Returns true if any day was typed.
    pub(crate) fn is_given(&self) -> bool {
        !self.date.is_empty() || self.from.is_some()
    }
}

/// Returns the division of the sky.
pub(crate) fn sky_parts(patches: Option<PatchesChoice>, directions: Option<usize>) -> SkyParts {
    match patches {
        Some(PatchesChoice::Tregenza) => SkyParts::Tregenza,
        Some(PatchesChoice::Reinhart) => SkyParts::Reinhart,
        None => directions.map_or_else(SkyParts::default, SkyParts::Even),
    }
}
