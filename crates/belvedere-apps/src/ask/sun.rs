//! Suns and days that a user chooses.

use super::context::Context;
use super::remark::Remark;
use super::scene::Whereabouts;
use super::sections::{SunAt, SunSection};
use super::sun_place::{SunPlace, remark_on_clock};
use crate::shadow::ShadowSun;
use crate::sun::{Date, DayParams, Period, Site, SunDay, Zone, sun_days, sun_position_with};
use crate::sun_hours::RuleDays;
use crate::tree_light::Season;
use belvedere_data::cast::to_i32;
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Maximum number of suns whose positions are in the report.
pub const MAX_LISTED_SUNS: usize = 5;

/// Suns, one by one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Suns {
    /// Azimuths, clockwise from north, and elevations, degrees.
    Directions(Vec<[f64; 2]>),
    /// Instants, ISO 8601, with an offset unless the zone says how clocks run.
    Times(Vec<String>),
    /// Times of the clock at which the sun is up, such as each full hour.
    Days(Days),
}

/// Days of the sun.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Days {
    /// Days such as 2026-06-21, or longest-day, shortest-day and equinox of the year.
    pub dates: Vec<String>,
    /// First and last day, or two instants, in place of dates.
    pub between: Option<[String; 2]>,
    /// Year of days that are given without one.
    pub year: Option<i16>,
    /// Minutes between two suns, 1/6 to 60; `None` for 10.
    pub time_step_min: Option<f64>,
    /// Minimum elevation of a sun that counts, degrees; `None` for 0, or that of a rule.
    pub min_sun_elevation_deg: Option<f64>,
}

/// A sun with its names.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedSun {
    /// Position of the sun, and its time.
    pub sun: ShadowSun,
    /// Label that separates it from other suns in names, such as `20260621_1500`, or `235_30` for a direction.
    pub label: String,
    /// Name of its column, such as `lit_20260621_1500`.
    pub column: String,
    /// Its shadow in words.
    pub title: String,
    /// Metadata of its raster: time and zone where it has them, azimuth and elevation in degrees.
    pub tags: Vec<(String, String)>,
}

/// Permitted positions of a sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SunRange {
    /// Any elevation; a sun below the horizon lights nothing.
    AnyElevation,
    /// On the horizon or above it.
    NotBelowHorizon,
    /// Above the horizon.
    AboveHorizon,
}

/// Refuses a direction of the sun, azimuth and elevation in degrees, that cannot be. Azimuths run from 0 to 360, or
/// from -180 to 180.
///
/// # Errors
/// [`Error::InvalidParameter`].
pub fn check_sun([azimuth, elevation]: [f64; 2], range: SunRange) -> Result<()> {
    let is_azimuth = |angle: f64| (-180.0..=360.0).contains(&angle);
    let is_elevation = |angle: f64| match range {
        SunRange::AnyElevation => (-90.0..=90.0).contains(&angle),
        SunRange::NotBelowHorizon => (0.0..=90.0).contains(&angle),
        SunRange::AboveHorizon => angle > 0.0 && angle <= 90.0,
    };
    if is_azimuth(azimuth) && is_elevation(elevation) {
        return Ok(());
    }
    let expected = match range {
        _ if is_azimuth(elevation) && is_elevation(azimuth) && elevation > 90.0 => {
            "the azimuth first, then the elevation: the two look swapped"
        }
        SunRange::AnyElevation => "an azimuth of 0 to 360 degrees and an elevation of -90 to 90",
        SunRange::NotBelowHorizon => "an azimuth of 0 to 360 degrees and an elevation of 0 to 90",
        SunRange::AboveHorizon => "an azimuth of 0 to 360 degrees and an elevation above 0 and at most 90",
    };
    Err(Error::invalid(Parameter::SunDirection, format!("{azimuth},{elevation}"), expected))
}

/// Maximum declination of the sun, degrees, with additions for air, grids and rounded numbers.
const MAX_DECLINATION: f64 = 25.0;

/// Returns a remark on a sun, azimuth and elevation in degrees, that never stands there over `site`, if that is known.
/// It is a warning if the sun would stand there with both swapped.
#[must_use]
pub fn remark_on_sun(site: Option<Site>, [azimuth, elevation]: [f64; 2]) -> Option<Remark> {
    let site = site.filter(|_| elevation > 0.0)?;
    let is_possible = |azimuth: f64, elevation: f64| {
        let [azimuth, elevation] = [azimuth, elevation].map(f64::to_radians);
        let sine = site.latitude.sin() * elevation.sin() + site.latitude.cos() * elevation.cos() * azimuth.cos();
        sine.asin().to_degrees().abs() <= MAX_DECLINATION
    };
    if is_possible(azimuth, elevation) {
        return None;
    }
    let latitude = rounded(site.latitude.to_degrees(), 1);
    let text = format!("the sun never stands at azimuth {azimuth}, elevation {elevation} at a latitude of {latitude}");
    Some(match (0.0..=90.0).contains(&azimuth) && is_possible(elevation, azimuth) {
        true => Remark::warning("sun-never-there", format!("{text}: azimuth comes first, then elevation")),
        false => Remark::note("sun-never-there", text),
    })
}

/// Refuses a question without days.
pub(super) fn missing_days<T>() -> Result<T> {
    Err(Error::invalid(Parameter::Period, "missing", "given as days or as two times"))
}

impl Days {
    /// Returns true if there is no day.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.dates.is_empty() && self.between.is_none()
    }

    /// The times among them, which can say how clocks run.
    pub fn times(&self) -> impl Iterator<Item = &String> + Clone {
        self.between.iter().flatten()
    }

    /// Returns the parameters of the division of days.
    #[must_use]
    pub fn params(&self, place: &SunPlace) -> DayParams {
        let usual = DayParams::default();
        usual
            .with_step(self.time_step_min.map_or(usual.step, |minutes| minutes * 60.0))
            .with_min_elevation(self.min_sun_elevation_deg.map_or(usual.min_elevation, f64::to_radians))
            .with_refraction(place.refraction)
    }

    /// Checks the values that do not depend on a scene.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for days, times, steps and elevations that cannot be.
    pub fn check(&self, place: &SunPlace) -> Result<()> {
        let anywhere = place.check()?;
        if let Some(minutes) = self.time_step_min.filter(|minutes| !(1.0 / 6.0..=60.0).contains(minutes)) {
            return Err(Error::invalid(Parameter::TimeStep, format!("{minutes} minutes"), "1/6 to 60 minutes"));
        }
        self.params(place).validate()?;
        let zone = place.any_zone(&anywhere, self.times())?;
        self.period(place, &anywhere, &zone).map(|_| ())
    }

    /// Dates of days that a rule or a name says.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] without a year, and those of [`RuleDays::dates`].
    pub fn dates_of(&self, days: RuleDays, site: &Site, zone: &Zone) -> Result<Vec<Date>> {
        match self.year {
            Some(year) => days.dates(year, site, zone),
            None => Err(Error::invalid(Parameter::Year, "missing", "given for days that have none")),
        }
    }

    /// The period; `None` where there are no days.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for days and times that cannot be read, and a last day before the first.
    pub fn period(&self, place: &SunPlace, site: &Site, zone: &Zone) -> Result<Option<Period>> {
        if let Some([from, to]) = &self.between {
            return Ok(Some(match (Date::parse(from), Date::parse(to)) {
                (Ok(first), Ok(last)) if last < first => {
                    return Err(Error::invalid(Parameter::LastDay, last, "the first day or a later one"));
                }
                (Ok(first), Ok(last)) => Period::Days(first.to(last).collect()),
                (Err(_), Err(_)) => Period::Between([place.instant(from, zone)?, place.instant(to, zone)?]),
                _ => {
                    return Err(Error::invalid(Parameter::Period, format!("{from} to {to}"), "two days, or two times"));
                }
            }));
        }
        let mut dates = Vec::new();
        for text in &self.dates {
            match RuleDays::parse(text) {
                Some(days) => dates.extend(self.dates_of(days, site, zone)?),
                None => dates.push(Date::parse(text)?),
            }
        }
        Ok((!dates.is_empty()).then_some(Period::Days(dates)))
    }

    /// The times at which the sun is up, each a number of steps after the clock begins the day: 07:00, 07:30 and so on.
    fn instants(&self, place: &SunPlace, site: &Site, zone: &Zone) -> Result<Vec<f64>> {
        let Some(period) = self.period(place, site, zone)? else {
            return Err(Error::invalid(Parameter::Period, "missing", "given as days or as two times"));
        };
        let params = self.params(place);
        let days = sun_days_above(site, zone, &period, &params)?;
        let mut instants: Vec<f64> = days.iter().flat_map(|day| clock_steps(day, params.step)).collect();
        // a sun that is up at midnight ends one day and begins the next
        instants.dedup();
        if !instants.is_empty() {
            return Ok(instants);
        }
        if days.iter().any(|day| !day.steps.is_empty()) {
            let expected = "shorter: the sun is up at no such time of the clock in this period";
            return Err(Error::invalid(Parameter::TimeStep, format!("{} minutes", params.step / 60.0), expected));
        }
        Err(Error::invalid(Parameter::Period, "without sun", "other days: the sun does not rise there in this period"))
    }
}

/// The instants of a day at which the sun is up, multiples of `step` seconds after its clock begins it.
fn clock_steps(day: &SunDay, step: f64) -> impl Iterator<Item = f64> {
    let (start, steps) = (day.clock_start, &day.steps);
    let pieces = steps.iter().map(move |piece| [piece.start, piece.end].map(|end| (end - start) / step));
    let numbers = pieces.flat_map(|[from, to]| to_i32(from.ceil())..=to_i32(to.floor()));
    // neighbouring pieces share their ends
    let mut last = None;
    let numbers = numbers.filter(move |number| last.replace(*number) != Some(*number));
    numbers.map(move |number| start + f64::from(number) * step)
}

/// The days of a period with their sun, as [`sun_days`] gives them.
///
/// # Errors
/// Those of [`sun_days`], and [`Error::InvalidParameter`] for a least elevation that the sun does not reach in the
/// period, although it rises ([`SUN_TOO_LOW`](belvedere_data::contradiction::SUN_TOO_LOW)).
pub(super) fn sun_days_above(site: &Site, zone: &Zone, period: &Period, params: &DayParams) -> Result<Vec<SunDay>> {
    let days = sun_days(site, zone, period, params)?;
    let has_sun = |days: &[SunDay]| days.iter().any(|day| !day.steps.is_empty());
    if params.min_elevation > 0.0 && !has_sun(&days) {
        check_min_elevation(has_sun(&sun_days(site, zone, period, &params.with_min_elevation(0.0))?), params)?;
    }
    Ok(days)
}

/// Refuses a least elevation that leaves no sun, where the sun rises.
pub(super) fn check_min_elevation(rises: bool, params: &DayParams) -> Result<()> {
    if !rises {
        return Ok(());
    }
    let lowest = format!("{} degrees", params.min_elevation.to_degrees());
    Err(Error::invalid(Parameter::MinSunElevation, lowest, "lower: the sun stays below it there in this period"))
}

impl Suns {
    /// Checks the values that do not depend on a scene.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for directions, times and days that cannot be, and without any.
    pub fn check(&self, place: &SunPlace) -> Result<()> {
        let anywhere = place.check()?;
        match self {
            Self::Directions(directions) => {
                directions.iter().try_for_each(|&sun| check_sun(sun, SunRange::AnyElevation))
            }
            Self::Times(times) => {
                let zone = place.any_zone(&anywhere, times)?;
                times.iter().try_for_each(|time| place.instant(time, &zone).map(|_| ()))
            }
            Self::Days(days) => days.check(place),
        }
    }

    /// The suns over a scene, in their order.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for times and days that cannot be, and a scene that lies nowhere on earth.
    pub fn resolve(
        &self,
        place: &SunPlace,
        whereabouts: &Whereabouts<'_>,
        context: &mut Context,
    ) -> Result<Vec<NamedSun>> {
        let mut section = SunSection::default();
        let suns = match self {
            Self::Directions(directions) => directions_over(directions, place, whereabouts, context),
            Self::Times(_) | Self::Days(_) => self.instants_over(place, whereabouts, &mut section, context)?,
        };
        section.suns = suns.len();
        let below = suns.iter().filter(|named| named.sun.to_sun[2] <= 0.0).count();
        section.suns_below_horizon = (below > 0).then_some(below);
        context.report.sun = Some(section);
        context.add(Remark::of_share(
            "suns-below-horizon",
            below,
            suns.len(),
            "suns",
            "are below the horizon: nothing is lit",
        ));
        Ok(suns)
    }

    fn instants_over(
        &self,
        place: &SunPlace,
        whereabouts: &Whereabouts<'_>,
        section: &mut SunSection,
        context: &mut Context,
    ) -> Result<Vec<NamedSun>> {
        let site = place.site_at(whereabouts, context, None)?;
        let zone = place.clock(&site, self.times(), context)?;
        if place.zone.is_none() {
            context.add(remark_on_clock(&zone, &site));
        }
        let instants = match self {
            Self::Days(days) => days.instants(place, &site, &zone)?,
            _ => self.times().map(|time| place.instant(time, &zone)).collect::<Result<_>>()?,
        };
        let far = whereabouts.far_in_words();
        let mut suns = Vec::with_capacity(instants.len());
        for &instant in &instants {
            let position = sun_position_with(&site, instant, place.refraction)?;
            if instants.len() <= MAX_LISTED_SUNS {
                let [azimuth_deg, elevation_deg] =
                    [position.azimuth, position.elevation].map(|angle| rounded(angle.to_degrees(), 4));
                section.instants.0.push((zone.display(instant), SunAt { azimuth_deg, elevation_deg }));
            }
            let season = zone.date_at(instant).ok().map(|date| Season::on(date, &site));
            let label = moment(&zone, instant);
            suns.push(NamedSun {
                sun: ShadowSun { to_sun: position.to_sun(&site), season },
                column: if instants.len() == 1 { "lit".to_owned() } else { format!("lit_{label}") },
                label,
                title: format!("Shadow, {}{far}", zone.display(instant)),
                tags: sun_tags([position.azimuth, position.elevation].map(f64::to_degrees), Some((&zone, instant))),
            });
        }
        section.time_zone = Some(zone.name().to_owned());
        Ok(suns)
    }

    fn times(&self) -> impl Iterator<Item = &String> + Clone {
        let (times, days) = match self {
            Self::Directions(_) => (None, None),
            Self::Times(times) => (Some(times), None),
            Self::Days(days) => (None, Some(days)),
        };
        times.into_iter().flatten().chain(days.into_iter().flat_map(Days::times))
    }
}

fn directions_over(
    directions: &[[f64; 2]],
    place: &SunPlace,
    whereabouts: &Whereabouts<'_>,
    context: &mut Context,
) -> Vec<NamedSun> {
    let north = place.north.of(whereabouts.convergence_at(whereabouts.middle()));
    context.north(&north);
    let site = place.site_of(whereabouts.frame, &whereabouts.bounds, None).ok();
    directions.iter().for_each(|&sun| context.add(remark_on_sun(site.map(|(site, _)| site), sun)));
    let far = whereabouts.far_in_words();
    let named = |(number, &[azimuth, elevation]): (usize, &[f64; 2])| {
        let is_one = directions.len() == 1;
        NamedSun {
            sun: ShadowSun::at(azimuth.to_radians() - north.of_grid, elevation.to_radians()),
            label: format!("{azimuth}_{elevation}"),
            column: if is_one { "lit".to_owned() } else { format!("lit_{number}") },
            title: format!("Shadow, sun at azimuth {azimuth}, elevation {elevation} degrees{far}"),
            tags: sun_tags([azimuth, elevation], None),
        }
    };
    (1..).zip(directions).map(named).collect()
}

/// Metadata of a sun: azimuth and elevation in degrees, zone and instant.
fn sun_tags(angles: [f64; 2], instant: Option<(&Zone, f64)>) -> Vec<(String, String)> {
    let [azimuth, elevation] = angles.map(|degrees| rounded(degrees, 4).to_string());
    let of_time = instant
        .into_iter()
        .flat_map(|(zone, instant)| [("TIME", zone.display(instant)), ("TIME_ZONE", zone.name().to_owned())]);
    let of_place = [("SUN_AZIMUTH_DEG", azimuth), ("SUN_ELEVATION_DEG", elevation)];
    of_time.chain(of_place).map(|(name, text)| (name.to_owned(), text)).collect()
}

/// An instant in names: its date and time by the clocks of the zone, such as `20260621_1500`, with seconds where it has
/// some.
#[must_use]
pub fn moment(zone: &Zone, instant: f64) -> String {
    let text: String = zone.display(instant).chars().filter(|c| c.is_ascii_digit() || matches!(c, 'T' | ' ')).collect();
    let to_second: String = text.replace(['T', ' '], "_").chars().take(15).collect();
    to_second.strip_suffix("00").unwrap_or(&to_second).to_owned()
}
