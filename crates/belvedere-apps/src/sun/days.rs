//! The light of a day: a day from midnight to midnight of the sun, in steps, cut at the horizon.

use super::position::{SunTrack, transit};
use super::{Date, Refraction, Site, Zone};
use belvedere_data::cast::to_u32;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

const DAY: f64 = 86_400.0;
/// Maximum interval between two evaluations of the elevation, seconds: a sun that rises and sets between them rises
/// 0.02° at most.
const SAMPLING: f64 = 300.0;
/// Maximum number of days of a period: ten years.
const MAX_DAYS: usize = 3700;
/// Accuracy of the moment at which the sun passes the minimum elevation, seconds.
const MOMENT: f64 = 0.01;

/// Parameters of the division of days.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct DayParams {
    /// Length of a step, seconds, 10 to 3600; steps are made a little shorter where they do not fill the day. Default
    /// 600: shadows of edges come and go within half a step of the truth, ±5 minutes each.
    pub step: f64,
    /// Elevation above which the middle of the sun counts, radians, 0 to just below π/2, apparent unless `refraction`
    /// is left out. Default 0: the flat horizon. Some rules leave out low suns.
    #[serde(rename = "least_elevation")]
    pub min_elevation: f64,
    /// Refraction of the sun by the air. Default [`Refraction::Standard`].
    pub refraction: Refraction,
}

belvedere_data::setters!(DayParams {
    with_step(step: f64),
    with_min_elevation(min_elevation: f64),
    with_refraction(refraction: Refraction),
});

impl Default for DayParams {
    fn default() -> Self {
        Self { step: 600.0, min_elevation: 0.0, refraction: Refraction::Standard }
    }
}

/// A piece of time during which the sun is up: a step of the day, or its part above the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunStep {
    /// Number of the step, from the midnight before: the same number on another day has the same hour angle.
    pub number: u32,
    /// Seconds of UTC since 1970 at its beginning.
    pub start: f64,
    /// And at its end.
    pub end: f64,
    /// Unit vector to the sun halfway, in the axes of the grid.
    pub direction: [f64; 3],
}

/// A day of the sun at a site, from its midnight (half-way between two culminations) to the next. It holds the whole
/// light of the place whatever clocks show, and days follow each other without gap.
#[derive(Clone, Debug, PartialEq)]
pub struct SunDay {
    /// Date at noon in the calendar of the zone.
    pub date: Date,
    /// Instant at which clocks of the zone begin this date (as they run at its noon): the origin of times of day.
    pub clock_start: f64,
    /// Midnight of the sun with which it begins.
    pub start: f64,
    /// Midnight of the sun with which it ends.
    pub end: f64,
    /// Instant at which the sun is highest, to within a minute: it crosses the meridian.
    pub noon: f64,
    /// The light of the day in the order of time; none in polar night.
    pub steps: Vec<SunStep>,
}

impl SunDay {
    /// Hours during which the sun is up.
    #[must_use]
    pub fn possible_hours(&self) -> f64 {
        self.steps.iter().map(|step| step.end - step.start).sum::<f64>() / 3600.0
    }

    /// Time of day of an instant on the clocks of the zone, hours; below 0 or above 24 where the day of the sun reaches
    /// beyond the date.
    #[must_use]
    pub fn clock_hours(&self, unix_s: f64) -> f64 {
        (unix_s - self.clock_start) / 3600.0
    }
}

/// The day of the sun that a date names at a site. Of the true noons of the site it is the one whose mean noon comes
/// next to 12 o'clock in the `zone`. If `within` is given, only the time between its two instants counts.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters outside their range, and those of [`super::sun_position_with`].
pub fn sun_day(site: &Site, zone: &Zone, date: Date, within: Option<[f64; 2]>, params: &DayParams) -> Result<SunDay> {
    params.validate()?;
    let site = site.validate()?;
    let clock_ahead = zone.offset_at(date.noon_utc());
    let sun_ahead = site.longitude.to_degrees() * 240.0;
    let mean_noon = date.noon_utc() - sun_ahead + DAY * ((sun_ahead - clock_ahead) / DAY).round();
    let [before, noon, after] = [-DAY, 0.0, DAY].map(|offset| transit(&site, mean_noon + offset));
    let (before, noon, after) = (before?, noon?, after?);
    let [start, end] = [f64::midpoint(before, noon), f64::midpoint(noon, after)];
    let count = to_u32((DAY / params.step - 1e-9).ceil());
    let track = SunTrack::new(&site, [start, end], params.refraction)?;
    let edge = |number: u32| start + (end - start) * f64::from(number) / f64::from(count);
    let mut steps = Vec::new();
    for number in 0..count {
        let [from, to] = within.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let span = [edge(number).max(from), edge(number + 1).min(to)];
        if span[0] < span[1] {
            for [start, end] in light(&track, span, params.min_elevation) {
                let halfway = track.at(f64::midpoint(start, end));
                steps.push(SunStep { number, start, end, direction: halfway.to_sun(&site) });
            }
        }
    }
    let clock_start = date.noon_utc() - 0.5 * DAY - zone.offset_at(noon);
    Ok(SunDay { date, clock_start, start, end, noon, steps })
}

/// The requested days.
#[derive(Clone, Debug, PartialEq)]
pub enum Period {
    /// Whole days.
    Days(Vec<Date>),
    /// Time between two instants, seconds of UTC since 1970.
    Between([f64; 2]),
}

/// Returns the days of the sun of a period, at most 3700 (ten years), in the order given. Days at both ends of a span
/// between instants have steps within the span only.
///
/// # Errors
/// [`Error::InvalidParameter`] for a period without days or that ends before it begins, and those of [`sun_day`].
pub fn sun_days(site: &Site, zone: &Zone, period: &Period, params: &DayParams) -> Result<Vec<SunDay>> {
    let invalid = |value: String, expected| Err(Error::invalid(Parameter::Period, value, expected));
    let (dates, within) = match period {
        Period::Days(dates) => (dates.clone(), None),
        Period::Between([from, to]) if to > from && to - from <= DAY * MAX_DAYS as f64 => {
            // a day of the sun may begin a clock's day early or late
            let [first, last] = [zone.date_at(from - DAY)?, zone.date_at(to + DAY)?];
            (first.to(last).collect(), Some([*from, *to]))
        }
        Period::Between([from, to]) => {
            return invalid(format!("{} to {}", zone.display(*from), zone.display(*to)), "forward, at most ten years");
        }
    };
    if !(1..=MAX_DAYS).contains(&dates.len()) {
        return invalid(format!("{} days", dates.len()), "1 to 3700 days, and the last day not before the first");
    }
    let days: Result<Vec<SunDay>> =
        dates.into_par_iter().map(|date| sun_day(site, zone, date, within, params)).collect();
    let touches = |day: &SunDay| within.is_none_or(|[from, to]| day.start < to && day.end > from);
    Ok(days?.into_iter().filter(touches).collect())
}

impl DayParams {
    /// Checks that all parameters are in their ranges.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] where one is not.
    pub fn validate(&self) -> Result<()> {
        let invalid = |parameter, value: f64, expected| Err(Error::invalid(parameter, value, expected));
        if !(10.0..=3600.0).contains(&self.step) {
            return invalid(Parameter::TimeStep, self.step, "10 to 3600 seconds");
        }
        if !(0.0..1.57).contains(&self.min_elevation) {
            return invalid(Parameter::MinSunElevation, self.min_elevation.to_degrees(), "0 to below 90 degrees");
        }
        Ok(())
    }
}

/// The parts of a span of time during which the sun is up.
fn light(track: &SunTrack, [start, end]: [f64; 2], min_elevation: f64) -> Vec<[f64; 2]> {
    let above = |t: f64| track.at(t).elevation > min_elevation;
    let count = to_u32(((end - start) / SAMPLING - 1e-9).ceil().max(1.0));
    let mut parts: Vec<[f64; 2]> = Vec::new();
    let mut from = (start, above(start));
    for sample in 1..=count {
        let to = start + (end - start) * f64::from(sample) / f64::from(count);
        let to = (to, above(to));
        let part = match (from.1, to.1) {
            (false, false) => None,
            (true, true) => Some([from.0, to.0]),
            (was_up, _) => {
                let [mut known, mut other] = [from.0, to.0];
                while other - known > MOMENT {
                    let middle = f64::midpoint(known, other);
                    if above(middle) == was_up {
                        known = middle;
                    } else {
                        other = middle;
                    }
                }
                Some(if was_up { [from.0, known] } else { [other, to.0] })
            }
        };
        match (part, parts.last_mut()) {
            (Some(part), Some(last)) if last[1] == part[0] => last[1] = part[1],
            (Some(part), _) if part[0] < part[1] => parts.push(part),
            _ => {}
        }
        from = to;
    }
    parts
}
