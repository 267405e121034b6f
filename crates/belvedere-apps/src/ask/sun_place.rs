//! Location of a scene on earth, its clock and its air.

use super::context::Context;
use super::north::North;
use super::remark::Remark;
use super::scene::{Scene, Whereabouts};
use super::sections::LocationSection;
use crate::sun::{Refraction, Site, SiteFrom, Zone, ZoneOfPlace, parse_instant, sun_position_with, zone_of_instant};
use belvedere_data::contradiction::CLOCK_OF_ZONE;
use belvedere_data::crs::evidence::{CONTRADICTION_DISTANCE, distance_in_words, distance_on_earth, place_in_words};
use belvedere_data::frame::{Bounds, Frame};
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::fmt::{Display, Formatter};

/// A place on earth, its clocks and its air.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct SunPlace {
    /// Latitude and longitude, degrees, north and east positive; `None` for those of the reference system.
    pub location: Option<[f64; 2]>,
    /// Zone of times and days, such as Europe/Amsterdam or +02:00, or [`SOLAR`]; `None` for that of a given time, else
    /// that of the place, else mean solar time.
    pub zone: Option<String>,
    /// Refraction of the sun by the air.
    pub refraction: Refraction,
    /// North of azimuths.
    pub north: North,
}

/// Name of mean solar time where a zone is given.
pub const SOLAR: &str = "solar";
/// Locations this near, metres, are those of a scene: the sun stands 0.1° elsewhere.
const NEAR: f64 = 10e3;

/// A given location beside that of the reference system.
struct LocationBeside {
    /// Degrees.
    given: [f64; 2],
    /// Radians.
    by_crs: [f64; 2],
    /// Metres.
    distance: f64,
    is_swapped: bool,
}

impl Display for LocationBeside {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let ([latitude, longitude], distance) = (self.given, distance_in_words(self.distance));
        let by_crs = place_in_words(self.by_crs);
        write!(f, "{latitude},{longitude}, {distance} from where the reference system puts the scene ({by_crs})")?;
        if self.is_swapped {
            write!(f, ": latitude and longitude look swapped")?;
        }
        Ok(())
    }
}

/// Seconds of an hour, and of 15 degrees of longitude.
const HOUR: f64 = 3600.0;
/// An instant at which zones are compared with places, Unix seconds: summer time adds an hour, which the tolerance has
/// room for.
const COMPARED_AT: f64 = 1_767_225_600.0;

/// A warning that clocks are those of another part of the earth than `site`.
pub(super) fn remark_on_clock(zone: &Zone, site: &Site) -> Option<Remark> {
    let hours = zone.offset_at(COMPARED_AT) / HOUR;
    let by_sun = site.longitude.to_degrees() / 15.0;
    // clocks of a day later or earlier show the same sun
    let difference = (hours - by_sun + 12.0).rem_euclid(24.0) - 12.0;
    if hours == 0.0 || !CLOCK_OF_ZONE.is_exceeded_by(difference) {
        return None;
    }
    let text = format!(
        "clocks of {} are {hours:+} hours from UTC, and the sun of the place {:+.1}: they are of another part of the \
         earth, and the sun stands where it does at that time; give the zone of the place",
        zone.name(),
        by_sun
    );
    Remark::of_contradiction(CLOCK_OF_ZONE.found(text).with("hours", rounded(difference, 1)))
}

/// A warning of hours of the day that nobody's clocks show, between which something `happens`.
pub(super) fn remark_on_solar_hours(happens: &str, hours: Option<[f64; 2]>, zone: &Zone) -> Option<Remark> {
    let [from, to] = hours.filter(|_| zone.is_mean_solar())?;
    let text = format!(
        "{happens} from {from} to {to} hours of mean solar time, which clocks are up to two hours ahead of; give the \
         zone of the clocks, such as Europe/Amsterdam"
    );
    Some(Remark::warning("hours-in-solar-time", text).with("from_hour", from).with("to_hour", to))
}

impl SunPlace {
    /// Checks the values that do not depend on a scene.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a location, a zone or an air that cannot be.
    pub fn check(&self) -> Result<Site> {
        let [latitude, longitude] = self.location.map_or([0.0; 2], |given| given.map(f64::to_radians));
        let anywhere = Site { latitude, longitude, height: 0.0, convergence: 0.0 }.validate()?;
        sun_position_with(&anywhere, 0.0, self.refraction)?;
        self.given_zone(&anywhere)?;
        Ok(anywhere)
    }

    /// Returns the location of the middle of a scene on earth: as given, else by its reference system, else
    /// `elsewhere`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] without any location, for a given location that is far from that of the reference
    /// system, and those of [`Site::of_scene`].
    pub fn site_of(&self, frame: &Frame, bounds: &Bounds, elsewhere: Option<[f64; 2]>) -> Result<(Site, SiteFrom)> {
        let given = self.location.map(|location| location.map(f64::to_radians));
        let unknown = |value: String| {
            let expected =
                "given as latitude and longitude, or follow from a reference system of the scene (EPSG:CODE)";
            Err(Error::invalid(Parameter::Location, value, expected))
        };
        let found = Site::of_scene(frame, bounds, given, elsewhere).or_else(|error| match error {
            Error::MissingAttribute { .. } => unknown("unknown".to_owned()),
            Error::InvalidParameter { parameter: Parameter::ReferenceSystem, value, .. } => {
                unknown(format!("unknown ({value})"))
            }
            Error::InvalidParameter {
                parameter: Parameter::Position | Parameter::LatitudeLongitude, value, ..
            } if given.is_none() => unknown(format!("unknown ({} at {value})", frame.crs.describe())),
            other => Err(other),
        })?;
        match self.distance_from_crs(frame, bounds) {
            Some(beside) if beside.distance > CONTRADICTION_DISTANCE => {
                let expected = "near the scene, or left out; where the reference system is wrong, give the right one with its override";
                Err(Error::invalid(Parameter::Location, beside, expected))
            }
            _ => Ok(found),
        }
    }

    /// Returns the distance between the given location and that of the reference system.
    fn distance_from_crs(&self, frame: &Frame, bounds: &Bounds) -> Option<LocationBeside> {
        let given = self.location?;
        let (by_crs, _) = Site::of_scene(frame, bounds, None, None).ok()?;
        let by_crs = [by_crs.latitude, by_crs.longitude];
        let distance_of = |place: [f64; 2]| distance_on_earth(place.map(f64::to_radians), by_crs);
        let (distance, swapped) = (distance_of(given), distance_of([given[1], given[0]]));
        let is_swapped = distance > CONTRADICTION_DISTANCE && swapped < CONTRADICTION_DISTANCE;
        Some(LocationBeside { given, by_crs, distance, is_swapped })
    }

    pub(super) fn site(&self, scene: &Scene, context: &mut Context, elsewhere: Option<[f64; 2]>) -> Result<Site> {
        self.site_at(&scene.whereabouts(), context, elsewhere)
    }

    /// Returns the location of a scene on earth, and reports it.
    ///
    /// # Errors
    /// Those of [`SunPlace::site_of`].
    pub fn site_at(
        &self,
        whereabouts: &Whereabouts<'_>,
        context: &mut Context,
        elsewhere: Option<[f64; 2]>,
    ) -> Result<Site> {
        let found = self.site_of(whereabouts.frame, &whereabouts.bounds, elsewhere)?;
        let beside =
            self.distance_from_crs(whereabouts.frame, &whereabouts.bounds).filter(|beside| beside.distance > NEAR);
        context.add(beside.map(|beside| {
            let text = format!("the location is {beside}");
            Remark::warning("location-far-away", text).with("distance_km", rounded(beside.distance / 1000.0, 1))
        }));
        context.add(North::True.of(whereabouts.convergence_at(whereabouts.middle())).remark());
        context.report.location = Some(LocationSection::of(&found));
        context.add(self.given_zone(&found.0)?.and_then(|zone| remark_on_clock(&zone, &found.0)));
        Ok(found.0)
    }

    fn given_zone(&self, site: &Site) -> Result<Option<Zone>> {
        let parsed = |text: &str| match text.trim().eq_ignore_ascii_case(SOLAR) {
            true => Ok(Zone::mean_solar(site)),
            false => Zone::parse(text),
        };
        self.zone.as_deref().map(parsed).transpose()
    }

    /// Returns the time zone that is given, or else that of the first of the `times` that has one.
    fn typed_zone<'a>(&self, site: &Site, times: impl IntoIterator<Item = &'a String>) -> Result<Option<Zone>> {
        Ok(self.given_zone(site)?.or_else(|| times.into_iter().find_map(|time| zone_of_instant(time))))
    }

    /// Returns the time zone of a site: as given, else that of the first of the `times` that has one, else that of the
    /// place, else mean solar time.
    ///
    /// # Errors
    /// Those of [`Zone::parse`].
    pub fn zone_at<'a>(&self, site: &Site, times: impl IntoIterator<Item = &'a String>) -> Result<Zone> {
        let of_place = || ZoneOfPlace::of(site).map_or_else(|| Zone::mean_solar(site), |found| found.zone);
        Ok(self.typed_zone(site, times)?.unwrap_or_else(of_place))
    }

    /// [`SunPlace::zone_at`], with a warning where places nearby have other clocks.
    pub(super) fn clock<'a>(
        &self,
        site: &Site,
        times: impl IntoIterator<Item = &'a String> + Clone,
        context: &mut Context,
    ) -> Result<Zone> {
        context.add(self.remark_on_border(site, times.clone())?);
        self.zone_at(site, times)
    }

    /// Returns a zone for checks before the place is known.
    pub(super) fn any_zone<'a>(&self, anywhere: &Site, times: impl IntoIterator<Item = &'a String>) -> Result<Zone> {
        Ok(self.typed_zone(anywhere, times)?.unwrap_or_else(Zone::utc))
    }

    /// Returns a warning of another zone near the site whose clocks differ, where no zone is given.
    ///
    /// # Errors
    /// Those of [`Zone::parse`].
    pub fn remark_on_border<'a>(
        &self,
        site: &Site,
        times: impl IntoIterator<Item = &'a String>,
    ) -> Result<Option<Remark>> {
        if self.typed_zone(site, times)?.is_some() {
            return Ok(None);
        }
        let Some(ZoneOfPlace { zone, others }) = ZoneOfPlace::of(site).filter(|found| !found.others.is_empty()) else {
            return Ok(None);
        };
        let others = others.iter().map(Zone::name).collect::<Vec<_>>().join(" or ");
        let text = format!(
            "times are on the clocks of {}, and places nearby have those of {others}: give the zone of the place",
            zone.name()
        );
        Ok(Some(Remark::warning("zone-near-border", text)))
    }

    /// An instant, seconds of UTC since 1970. A time without an offset is on the clocks of `zone`; mean solar time must
    /// be given for that.
    ///
    /// # Errors
    /// Those of [`parse_instant`].
    pub fn instant(&self, text: &str, zone: &Zone) -> Result<f64> {
        let is_known = self.zone.is_some() || !zone.is_mean_solar();
        parse_instant(text, is_known.then_some(zone))
    }
}
