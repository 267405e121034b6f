//! Where the sun stands.

use crate::errors::{exception, wrong};
use crate::scene::Inner;
use belvedere::apps::horizon::convergence;
use belvedere::apps::shadow::ShadowSun;
use belvedere::apps::sun::{Refraction, Site, Zone, parse_instant, sun_position_with, zone_of_instant};
use belvedere::apps::tree_light::Season;
use pyo3::prelude::*;

/// Where on earth a scene lies, how clocks run there, and how azimuths are counted.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Place {
    /// Latitude and longitude, degrees.
    location: Option<[f64; 2]>,
    zone: Option<String>,
    grid_north: bool,
    /// Whether the sun is where geometry has it, or lifted by the air.
    geometric: bool,
    /// Pressure, hPa, and temperature, degrees Celsius.
    air: Option<[f64; 2]>,
}

impl Place {
    pub(crate) fn site(&self, inner: &Inner) -> PyResult<Site> {
        let location = self.location.map(|place| place.map(f64::to_radians));
        let site =
            Site::of_scene(inner.frame(), &inner.model.bounds(), location, None).map_err(|error| match error {
                belvedere::Error::MissingAttribute { attribute, needed_for, .. } => {
                    exception(belvedere::Error::MissingAttribute {
                        attribute,
                        needed_for,
                        advice: "give location=(latitude, longitude), or crs='EPSG:CODE' when reading the cloud",
                    })
                }
                other => exception(other),
            })?;
        Ok(site.0)
    }

    /// How clocks run: as given, else as in the first of the `times` that says so, else by the sun.
    pub(crate) fn zone(&self, site: &Site, times: &[String]) -> PyResult<Zone> {
        match &self.zone {
            Some(zone) => Zone::parse(zone).map_err(exception),
            None => Ok(times.iter().find_map(|time| zone_of_instant(time)).unwrap_or_else(|| Zone::mean_solar(site))),
        }
    }

    pub(crate) fn refraction(&self) -> PyResult<Refraction> {
        match (self.geometric, self.air) {
            (true, Some(_)) => Err(wrong("air", "given", "leave it out where elevation='geometric'")),
            (true, None) => Ok(Refraction::Without),
            (false, None) => Ok(Refraction::Standard),
            (false, Some([pressure, temperature])) => Ok(Refraction::Air { pressure, temperature }),
        }
    }

    /// Azimuth of grid north at a local place, clockwise from the north that azimuths are counted from, radians. Grid north counts where
    /// true north is unknown.
    pub(crate) fn grid_north(&self, inner: &Inner, place: [f64; 2]) -> f64 {
        if self.grid_north {
            return 0.0;
        }
        let frame = inner.frame();
        convergence(&frame.crs, [0, 1].map(|i| frame.origin[i] + place[i])).unwrap_or(0.0)
    }

    /// The same at the middle of the scene.
    pub(crate) fn grid_north_of(&self, inner: &Inner) -> f64 {
        let (low, high) = inner.model.bounds().corners();
        self.grid_north(inner, [0, 1].map(|i| f64::midpoint(low[i], high[i])))
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

impl SunChoice {
    pub(crate) fn suns(&self, inner: &Inner, place: &Place) -> PyResult<Vec<ShadowSun>> {
        match self {
            Self::Directions(directions) => {
                let of_grid = place.grid_north_of(inner);
                let sun = |&[azimuth, elevation]: &[f64; 2]| {
                    if !(azimuth.is_finite() && (-90.0..=90.0).contains(&elevation)) {
                        let advice = "give azimuth and elevation in degrees, the elevation from -90 to 90";
                        return Err(wrong("sun", &format!("({azimuth}, {elevation})"), advice));
                    }
                    Ok(ShadowSun::at(azimuth.to_radians() - of_grid, elevation.to_radians()))
                };
                directions.iter().map(sun).collect()
            }
            Self::Times(times) => {
                let site = place.site(inner)?;
                let zone = place.zone(&site, times)?;
                let refraction = place.refraction()?;
                let sun = |time: &String| {
                    let instant = parse_instant(time, None)?;
                    let position = sun_position_with(&site, instant, refraction)?;
                    let season = zone.date_at(instant).ok().map(|date| Season::on(date, &site));
                    Ok(ShadowSun { to_sun: position.to_sun(&site), season })
                };
                times.iter().map(sun).collect::<belvedere::Result<_>>().map_err(exception)
            }
        }
    }
}

#[pymethods]
impl crate::scene::Scene {
    /// Azimuth and elevation of the sun, degrees, at each of some times.
    fn sun_positions(&self, times: Vec<String>, place: Place) -> PyResult<Vec<(f64, f64)>> {
        let site = place.site(&self.0)?;
        let refraction = place.refraction()?;
        let position = |time: &String| {
            let position = sun_position_with(&site, parse_instant(time, None)?, refraction)?;
            Ok((position.azimuth.to_degrees(), position.elevation.to_degrees()))
        };
        times.iter().map(position).collect::<belvedere::Result<_>>().map_err(exception)
    }
}
