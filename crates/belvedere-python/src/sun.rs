//! Position of the sun.

use crate::errors::{exception, wrong};
use belvedere::apps::ask::{self, North, SunPositionQuestion, Suns};
use belvedere::apps::sun::Refraction;
use belvedere::control::Control;
use pyo3::prelude::*;

/// Location of a scene on earth, its clock, and the north of azimuths.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct SiteKeywords {
    /// Latitude and longitude, degrees.
    location: Option<[f64; 2]>,
    zone: Option<String>,
    grid_north: bool,
    /// True for the geometric sun, false for the sun refracted by the air.
    geometric: bool,
    /// Pressure, hPa, and temperature, degrees Celsius.
    air: Option<[f64; 2]>,
}

impl SiteKeywords {
    /// Converts the keywords for the layer of questions.
    pub(crate) fn chosen(&self) -> PyResult<ask::SunPlace> {
        Ok(ask::SunPlace {
            location: self.location,
            zone: self.zone.clone(),
            refraction: self.refraction()?,
            north: self.north(),
        })
    }

    pub(crate) fn north(&self) -> North {
        if self.grid_north { North::Grid } else { North::True }
    }

    fn refraction(&self) -> PyResult<Refraction> {
        match (self.geometric, self.air) {
            (true, Some(_)) => Err(wrong("air", "given", "leave it out where elevation='geometric'")),
            (true, None) => Ok(Refraction::Without),
            (false, None) => Ok(Refraction::Standard),
            (false, Some([pressure, temperature])) => Ok(Refraction::Air { pressure, temperature }),
        }
    }

    /// Azimuth of grid north at the middle of a scene, clockwise from the north that azimuths are counted from,
    /// radians.
    pub(crate) fn grid_north_of(&self, scene: &ask::Scene) -> f64 {
        self.north().of_scene(scene).of_grid
    }
}

/// Suns, by direction or by time.
#[derive(FromPyObject)]
pub(crate) enum SunChoice {
    /// Azimuth and elevation, degrees.
    #[pyo3(transparent)]
    Directions(Vec<[f64; 2]>),
    /// Times with their offset, ISO 8601.
    #[pyo3(transparent)]
    Times(Vec<String>),
}

impl From<SunChoice> for Suns {
    fn from(choice: SunChoice) -> Self {
        match choice {
            SunChoice::Directions(directions) => Self::Directions(directions),
            SunChoice::Times(times) => Self::Times(times),
        }
    }
}

#[pymethods]
impl crate::scene::PyScene {
    /// Azimuth and elevation of the sun, degrees, at each of some times.
    fn sun_positions(&self, times: Vec<String>, place: SiteKeywords) -> PyResult<Vec<(f64, f64)>> {
        let question = SunPositionQuestion { times, place: place.chosen()? };
        let answers = ask::ask(&self.0, &question, &ask::Places::Scene, &Control::none()).map_err(exception)?;
        Ok(answers.found.into_iter().map(|sun| (sun.azimuth_deg, sun.elevation_deg)).collect())
    }
}
