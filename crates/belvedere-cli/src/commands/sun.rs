//! Where on earth a scene lies, how clocks run there, and which days were typed.

use crate::arguments::{ElevationChoice, North, SunPeriod, SunPlace, Usage};
use crate::summary::{Summary, rounded};
use anyhow::{Result, anyhow};
use belvedere::apps::ask;
use belvedere::apps::sun::{
    Date, DayParams, Period, Refraction, Site, Zone, parse_instant, sun_position_with, zone_of_instant,
};
use belvedere::apps::sun_hours::RuleDays;
use belvedere::{Bounds, Error, Frame, Parameter};

impl SunPlace {
    /// What was typed, with the north of azimuths.
    pub(crate) fn place(&self, north: &North) -> Result<ask::SunPlace> {
        Ok(ask::SunPlace {
            location: self.location.as_ref().map(|location| location.0),
            zone: self.zone.clone(),
            refraction: self.refraction()?,
            north: north.choice(),
        })
    }

    /// What was typed, where no azimuth is.
    pub(crate) fn place_from_true_north(&self) -> Result<ask::SunPlace> {
        self.place(&North { grid_north: false })
    }

    /// Where the middle of what lies within `bounds` of a frame is on earth.
    pub(crate) fn site_of(&self, frame: &Frame, bounds: &Bounds, summary: &mut Summary) -> Result<Site> {
        let given = self.location.as_ref().map(|location| location.0.map(f64::to_radians));
        let found = Site::of_scene(frame, bounds, given, None);
        let (site, _) = match given {
            Some(_) => found?,
            None => found.map_err(|error| match error {
                Error::MissingAttribute { .. } => anyhow!(
                    "the position of the sun needs the location of the scene: give --location LAT,LON, or its reference system with --crs EPSG:CODE"
                ),
                other => other.into(),
            })?,
        };
        let mut section = Summary::default();
        section
            .add("latitude_deg", rounded(site.latitude.to_degrees(), 5))
            .add("longitude_deg", rounded(site.longitude.to_degrees(), 5))
            .add("meridian_convergence_deg", rounded(site.convergence.to_degrees(), 4));
        summary.add("location", section);
        Ok(site)
    }

    /// How clocks run: as told, else as in the first of the `times` that says so, else by the sun.
    pub(crate) fn zone(&self, site: &Site, times: &[&str]) -> Result<Zone> {
        match &self.zone {
            Some(zone) => Ok(Zone::parse(zone)?),
            None => Ok(times.iter().find_map(|time| zone_of_instant(time)).unwrap_or_else(|| Zone::mean_solar(site))),
        }
    }

    /// An instant that the flag `name` gave.
    pub(crate) fn instant(&self, flag: &str, text: &str) -> Result<f64> {
        let zone = self.zone.as_deref().map(Zone::parse).transpose()?;
        parse_instant(text, zone.as_ref()).map_err(|error| Usage(format!("{flag}: {error}")).into())
    }

    /// By how much air lifts the sun.
    pub(crate) fn refraction(&self) -> Result<Refraction> {
        match (self.elevation, &self.air) {
            (ElevationChoice::Geometric, Some(_)) => {
                Err(Usage("--air needs --sun-elevation apparent".to_owned()).into())
            }
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
            min_sun_elevation_deg: self.least_elevation,
        }
    }

    /// Refuses what cannot be anywhere on earth, before hours of work go into a scene.
    pub(crate) fn check(&self, place: &SunPlace) -> Result<()> {
        self.params(place)?.validate().map_err(|error| match (error, self.step) {
            (Error::InvalidParameter { parameter: Parameter::TimeStep, .. }, Some(step)) => {
                Usage(format!("--time-step-min: the step is {step} minutes, but must be 1/6 to 60 minutes")).into()
            }
            (error, _) => anyhow::Error::from(error),
        })?;
        let [latitude, longitude] = place.location.map_or([0.0; 2], |given| given.0.map(f64::to_radians));
        let anywhere = Site { latitude, longitude, height: 0.0, convergence: 0.0 };
        let anywhere = anywhere.validate()?;
        sun_position_with(&anywhere, 0.0, place.refraction()?)?;
        let zone = place.zone(&anywhere, &self.times())?;
        self.period(place, &anywhere, &zone).map(|_| ())
    }

    /// Whether any day was typed.
    pub(crate) fn is_given(&self) -> bool {
        !self.date.is_empty() || self.from.is_some()
    }

    /// The times typed.
    pub(crate) fn times(&self) -> Vec<&str> {
        self.from.iter().chain(&self.to).map(String::as_str).collect()
    }

    /// How days are parted.
    pub(crate) fn params(&self, place: &SunPlace) -> Result<DayParams> {
        let usual = DayParams::default();
        Ok(DayParams::default()
            .with_step(self.step.map_or(usual.step, |minutes| minutes * 60.0))
            .with_least_elevation(self.least_elevation.map_or(usual.least_elevation, f64::to_radians))
            .with_refraction(place.refraction()?))
    }

    /// The days typed; `None` where there are none.
    pub(crate) fn period(&self, place: &SunPlace, site: &Site, zone: &Zone) -> Result<Option<Period>> {
        if let (Some(from), Some(to)) = (&self.from, &self.to) {
            return Ok(Some(match (Date::parse(from), Date::parse(to)) {
                (Ok(first), Ok(last)) => Period::Days(days(first, last)?),
                (Err(_), Err(_)) => Period::Between([place.instant("--from", from)?, place.instant("--to", to)?]),
                _ => return Err(Usage("--from and --to: give two days, or two times".to_owned()).into()),
            }));
        }
        let mut dates = Vec::new();
        for text in &self.date {
            match RuleDays::parse(text) {
                Some(days) => dates.extend(days.dates(self.year, site, zone)?),
                None => dates.push(Date::parse(text)?),
            }
        }
        Ok((!dates.is_empty()).then_some(Period::Days(dates)))
    }
}

fn days(first: Date, last: Date) -> Result<Vec<Date>> {
    if last < first {
        return Err(Usage(format!("--to: last day is {last}, but must be the first day or a later one")).into());
    }
    Ok(first.to(last).collect())
}
