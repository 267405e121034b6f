//! The hours of a period: suns, sky, air, and how warm lit surfaces are.

use super::humidity::saturation_pressure;
use super::longwave::sky_longwave;
use super::materials::{Material, SurfaceParams, Warming};
use super::utci::Air;
use crate::irradiance::{ClearSky, complete, extraterrestrial};
use crate::sun::{Date, Period, Site, Zone, sun_position, sun_times};
use crate::tree_light::Season;
use belvedere_data::weather::{Irradiance, USUAL_WIND, Weather, WeatherStep};
use belvedere_data::{Error, Parameter, Result};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const HOUR: f64 = 3600.0;
const DAY: f64 = 86_400.0;
/// Sine of the lowest sun whose clearness is judged, 10°: lower ones are uncertain both in models and in measurements.
const MIN_CLEARNESS_SINE: f64 = 0.174;
/// Logarithmic decay of the warmth of a surface after the light changed, per second: a time constant of 43 minutes.
///
/// # Source
/// Lindberg & Grimmond 2011, SOLWEIG 2.
const DECAY: f64 = 33.27 / DAY;

/// A sun of a part of an hour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatSun {
    /// Unit vector to the sun, axes of the scene.
    pub to_sun: [f64; 3],
    /// Direct radiation on a plane that faces it, W/m².
    pub direct: f64,
    /// Season of crowns.
    pub season: Season,
}

/// A row of weather as a body and its surroundings meet it.
#[derive(Clone, Debug)]
pub struct HeatHour {
    /// Middle of the row, seconds since 1970-01-01 UTC.
    pub instant: f64,
    /// Duration, hours.
    pub hours: f64,
    /// The air.
    pub air: Air,
    /// Suns of equal parts of the row, in order; empty at night.
    pub suns: Vec<HeatSun>,
    /// Parts of the row, those without a sun among them.
    pub parts: usize,
    /// Diffuse radiation on a level plane, W/m², the same from all of the sky.
    pub diffuse: f64,
    /// Global radiation on a level plane, W/m².
    pub global: f64,
    /// Longwave radiation of the sky on a level plane, W/m².
    pub sky_longwave: f64,
    /// Excess of lit surfaces over the air, K: ground, and what is built.
    pub warming: [f64; Material::WARMED],
    /// Share of the excess of the row before that remains, 0 to 1; 0 for the first row of a day.
    pub memory: f64,
}

/// Rows of weather of one day in their order.
pub type HeatHours = Vec<HeatHour>;

/// Rows that a question is about.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct HeatRows<'a> {
    /// Days, or a period between instants.
    pub(crate) period: &'a Period,
    /// First and last hour of the clock; rows whose middle lies between them count.
    pub(crate) hours: [f64; 2],
    /// The clock.
    pub(crate) zone: &'a Zone,
}

/// Rows of each day, and what was assumed.
#[derive(Clone, Debug, Default)]
pub(crate) struct HeatDays {
    /// Rows from the beginning of a day to the last one wanted; the wanted ones are flagged.
    pub(crate) days: Vec<(HeatHours, Vec<bool>)>,
    /// Rows whose longwave radiation follows from air and clouds.
    pub(crate) modelled_longwave: usize,
    /// Rows without wind.
    pub(crate) without_wind: usize,
    /// Rows left out, since the weather has no temperature or humidity.
    pub(crate) without_air: usize,
}

impl HeatDays {
    /// The rows that count.
    pub(crate) fn wanted(&self) -> impl Iterator<Item = &HeatHour> {
        let of_days = self.days.iter().flat_map(|(hours, wanted)| hours.iter().zip(wanted));
        of_days.filter(|(_, wanted)| **wanted).map(|(hour, _)| hour)
    }
}

impl HeatRows<'_> {
    /// Rows of `weather` on the days of the period. A typical year has each day once, in whatever year.
    fn days<'w>(&self, weather: &'w Weather) -> Result<Vec<(Date, Vec<&'w WeatherStep>)>> {
        let mut dated = Vec::with_capacity(weather.steps.len());
        for step in &weather.steps {
            dated.push((self.zone.date_at(step.instant)?, step));
        }
        dated.sort_by(|a, b| a.1.instant.total_cmp(&b.1.instant));
        let of_day = |date: Date| {
            let is_same = |day: &&(Date, &WeatherStep)| day.0 == date;
            let is_alike = |day: &&(Date, &WeatherStep)| (day.0.month(), day.0.day()) == (date.month(), date.day());
            let same: Vec<&WeatherStep> = dated.iter().filter(is_same).map(|(_, step)| *step).collect();
            if !same.is_empty() {
                return Ok(same);
            }
            // in a typical year the hours of a day may come from two years, where a zone parts them otherwise
            let mut alike: Vec<&WeatherStep> = dated.iter().filter(is_alike).map(|(_, step)| *step).collect();
            alike.sort_by(|a, b| self.hour_of(a.instant).total_cmp(&self.hour_of(b.instant)));
            let is_repeated = |pair: &[&WeatherStep]| self.hour_of(pair[0].instant) == self.hour_of(pair[1].instant);
            match alike.is_empty() {
                true => missing(date, "a day of the weather"),
                false if alike.windows(2).any(is_repeated) => {
                    missing(date, "a day of the weather: it has that day in several years, none of them this")
                }
                false => Ok(alike),
            }
        };
        match self.period {
            Period::Days(dates) => dates.iter().map(|&date| Ok((date, of_day(date)?))).collect(),
            Period::Between([from, to]) => {
                let mut days: Vec<(Date, Vec<&WeatherStep>)> = Vec::new();
                for (date, step) in dated.iter().filter(|(_, step)| (*from..*to).contains(&step.instant)) {
                    match days.last_mut() {
                        Some((last, steps)) if last == date => steps.push(step),
                        _ => days.push((*date, vec![step])),
                    }
                }
                Ok(days)
            }
        }
    }

    /// Hour of the day on the clock.
    fn hour_of(&self, instant: f64) -> f64 {
        (instant + self.zone.offset_at(instant)).rem_euclid(DAY) / HOUR
    }

    fn is_wanted(&self, instant: f64) -> bool {
        (self.hours[0]..=self.hours[1]).contains(&self.hour_of(instant))
    }
}

fn missing<T>(date: Date, expected: &'static str) -> Result<T> {
    Err(Error::invalid(Parameter::Period, date, expected))
}

/// Returns the rows of `weather` that a question is about, day by day, each cut into `parts` under the sun of `site`.
///
/// # Errors
/// [`Error::InvalidParameter`] for days that the weather does not have, and those of [`sun_position`].
pub(crate) fn days_of_heat(
    weather: &Weather,
    rows: &HeatRows<'_>,
    site: &Site,
    (surfaces, parts): (&SurfaceParams, usize),
) -> Result<HeatDays> {
    let mut found = HeatDays::default();
    for (date, steps) in rows.days(weather)? {
        let wanted: Vec<bool> = steps.iter().map(|step| rows.is_wanted(step.instant)).collect();
        let Some(last) = wanted.iter().rposition(|&wanted| wanted) else { continue };
        let with_air: Vec<(&WeatherStep, bool)> = steps
            .into_iter()
            .zip(wanted)
            .take(last + 1)
            .filter(|(step, _)| step.air.temperature.is_some() && step.air.relative_humidity.is_some())
            .collect();
        found.without_air += last + 1 - with_air.len();
        let (steps, wanted): (Vec<&WeatherStep>, Vec<bool>) = with_air.into_iter().unzip();
        found.modelled_longwave += steps.iter().filter(|step| step.air.sky_longwave.is_none()).count();
        found.without_wind += steps.iter().filter(|step| step.air.wind_speed.is_none()).count();
        let season = Season::on(date, site);
        let hours = heat_hours(&steps, site, season, (surfaces, parts))?;
        // rows without air may have been all that were wanted
        if wanted.contains(&true) {
            found.days.push((hours, wanted));
        }
    }
    if found.days.is_empty() {
        let zone = rows.zone.name();
        let what =
            format!("the weather has no row with temperature and humidity at these days and hours (clock: {zone})");
        return Err(Error::NoPoints { what });
    }
    Ok(found)
}

/// Returns the rows `steps` of one day in their order, which have temperature and humidity, each cut into `parts` under
/// the sun of `site`.
///
/// # Errors
/// Those of [`sun_position`].
pub fn heat_hours(
    steps: &[&WeatherStep],
    site: &Site,
    season: Season,
    (surfaces, parts): (&SurfaceParams, usize),
) -> Result<HeatHours> {
    let Some(first) = steps.first() else { return Ok(Vec::new()) };
    let day = SolarDay::around(site, first.instant)?;
    let mut lights = Vec::with_capacity(steps.len());
    for step in steps {
        lights.push(RowLight::new(step, site, season, parts)?);
    }
    let clearness = fill(lights.iter().map(|light| light.clearness).collect());
    let mut hours: HeatHours = Vec::with_capacity(steps.len());
    for ((step, light), clearness) in steps.iter().zip(lights).zip(clearness) {
        let temperature = step.air.temperature.unwrap_or(f64::NAN);
        let vapour_pressure = saturation_pressure(temperature) * step.air.relative_humidity.unwrap_or(f64::NAN) / 100.0;
        let modelled = || sky_longwave(temperature, vapour_pressure, 1.0 - clearness);
        // hours of a day may come from two years
        let before = hours.last().map(|hour: &HeatHour| (step.instant - hour.instant).rem_euclid(DAY));
        hours.push(HeatHour {
            instant: step.instant,
            hours: step.hours,
            air: Air { temperature, vapour_pressure, wind: step.air.wind_speed.unwrap_or(USUAL_WIND) },
            suns: light.suns,
            parts,
            diffuse: light.irradiance.dhi,
            global: light.irradiance.ghi,
            sky_longwave: step.air.sky_longwave.unwrap_or_else(modelled),
            warming: [Material::Ground(surfaces.ground), Material::Built].map(|material| {
                let excess = |warming| day.excess(warming, step.instant);
                surfaces.warming * clearness * material.warming().map_or(0.0, excess)
            }),
            memory: before.map_or(0.0, |seconds| (-DECAY * seconds).exp()),
        });
    }
    Ok(hours)
}

/// Radiation of a row.
struct RowLight {
    irradiance: Irradiance,
    suns: Vec<HeatSun>,
    /// Global radiation as a share of that of a clear sky, 0 to 1; `None` for a low sun.
    clearness: Option<f64>,
}

impl RowLight {
    fn new(step: &WeatherStep, site: &Site, season: Season, parts: usize) -> Result<Self> {
        let outside = extraterrestrial(step.instant);
        let middle = sun_position(site, step.instant)?;
        let zenith = FRAC_PI_2 - middle.elevation;
        let sum = || step.dni.unwrap_or(0.0) * zenith.cos().max(0.0) + step.dhi.unwrap_or(0.0);
        let irradiance = complete(step.ghi.unwrap_or_else(sum), step.dni, step.dhi, zenith, outside);
        let length = step.hours * HOUR / parts as f64;
        let mut suns = Vec::with_capacity(parts);
        for part in 0..parts {
            let at = step.instant + (part as f64 + 0.5) * length - 0.5 * step.hours * HOUR;
            let to_sun = sun_position(site, at)?.to_sun(site);
            if to_sun[2] > 0.0 && irradiance.ghi > 0.0 {
                suns.push(HeatSun { to_sun, direct: irradiance.dni, season });
            }
        }
        // the measured sum is kept where the sun rises or sets
        let share = parts as f64 / suns.len().max(1) as f64;
        suns.iter_mut().for_each(|sun| sun.direct *= share);
        let clear = ClearSky::default().irradiance(zenith, site.height, outside).ghi;
        let clearness =
            (zenith.cos() >= MIN_CLEARNESS_SINE && clear > 0.0).then(|| (irradiance.ghi / clear).clamp(0.0, 1.0));
        Ok(Self { irradiance, suns, clearness })
    }
}

/// Values where they are missing: those before, or else the first known one; 1 where none is known.
fn fill(values: Vec<Option<f64>>) -> Vec<f64> {
    let mut last = values.iter().copied().flatten().next().unwrap_or(1.0);
    let known = |value: Option<f64>| {
        last = value.unwrap_or(last);
        last
    };
    values.into_iter().map(known).collect()
}

/// The sun of a day, for the warmth of surfaces.
struct SolarDay {
    /// Mean solar midnight, Unix seconds.
    midnight: f64,
    /// Sunrise, hours of mean solar time; `None` where the sun does not rise.
    rise: Option<f64>,
    /// Greatest elevation of the sun, degrees.
    highest_deg: f64,
}

impl SolarDay {
    fn around(site: &Site, instant: f64) -> Result<Self> {
        let east = site.longitude / TAU * DAY;
        let midnight = ((instant + east) / DAY).floor() * DAY - east;
        let times = sun_times(site, midnight, midnight + DAY)?;
        let noon = times.transits.first().copied().unwrap_or(midnight + DAY / 2.0);
        let highest = sun_position(site, noon)?.elevation;
        // where the sun never sets, the day begins at midnight
        let always = (highest > 0.0 && times.sets.is_empty()).then_some(0.0);
        let rise = times.rises.first().map(|rise| (rise - midnight) / HOUR).or(always);
        Ok(Self { midnight, rise, highest_deg: highest.to_degrees() })
    }

    /// Excess of a surface in the sun of a clear day, K.
    ///
    /// # Source
    /// Lindberg, Holmer & Thorsson 2008, equation 11: a sine from sunrise to the hour of the greatest excess.
    fn excess(&self, warming: Warming, instant: f64) -> f64 {
        let Some(rise) = self.rise else { return 0.0 };
        let hour = ((instant - self.midnight) / HOUR).rem_euclid(24.0);
        if hour <= rise {
            return 0.0;
        }
        let most = warming.per_degree * self.highest_deg + warming.at_horizon;
        let phase = (hour - rise) / (warming.hour - rise);
        (most * (phase * PI / 2.0).sin()).max(0.0)
    }
}
