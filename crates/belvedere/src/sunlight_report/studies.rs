//! Shadow studies of cities: the days and hours in which the shade of a plan counts.

use crate::Result;
use crate::apps::sun::{Binning, Date, DayParams, Period, Site, SunSchedule, Zone, sun_days, sun_times};
use serde::{Deserialize, Serialize};

const HOUR: f64 = 3600.0;
const DAY: f64 = 24.0 * HOUR;
/// Time between two suns of a year, seconds.
const YEAR_STEP: f64 = 900.0;
/// Days between two days that represent a year, and their number from the longest day to the shortest.
const WEEK: usize = 7;
const WEEKS: usize = 27;
/// Days of a year.
const YEAR: f64 = 365.25;

/// A procedure by which a city judges the shade that a plan adds to parks and squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShadowStudy {
    /// New York: four days, from one hour and a half after sunrise to one hour and a half before sunset.
    Ceqr,
    /// San Francisco: the hours of the whole year from one hour after sunrise to one hour before sunset.
    SanFrancisco,
    /// Toronto: three days, from 9:18 to 18:18.
    Toronto,
}

/// Sun of an area and what a plan takes of it, in the hours of a year that count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct YearOfSun {
    /// Hours of the year that count.
    pub(super) hours: f64,
    /// Share of the sun over the area that reaches it now, 0 to 1.
    pub(super) lit: f64,
    /// Share of it that the plan takes, 0 to 1.
    pub(super) lost: f64,
    /// Day on which it takes most, and m² × hours of that day.
    pub(super) worst: Option<(Date, f64)>,
}

impl ShadowStudy {
    /// All studies.
    pub const ALL: [Self; 3] = [Self::Ceqr, Self::SanFrancisco, Self::Toronto];

    /// Its name in commands.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ceqr => "ceqr",
            Self::SanFrancisco => "san-francisco",
            Self::Toronto => "toronto",
        }
    }

    /// Its source.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Ceqr => {
                "New York City, CEQR Technical Manual (2021), chapter 8: from 1.5 hours after sunrise to 1.5 hours before sunset"
            }
            Self::SanFrancisco => {
                "San Francisco, Planning Code section 295: all year from 1 hour after sunrise to 1 hour before sunset"
            }
            Self::Toronto => "Toronto, terms of reference for sun and shadow studies: from 9:18 to 18:18",
        }
    }

    /// Days in detail of a year.
    pub(super) fn dates(self, year: i16) -> Vec<String> {
        let days: &[&str] = match self {
            Self::Ceqr => &["03-21", "05-06", "06-21", "12-21"],
            Self::SanFrancisco => &["03-21", "06-21", "12-21"],
            Self::Toronto => &["03-21", "06-21", "09-21"],
        };
        days.iter().map(|day| format!("{year}-{day}")).collect()
    }

    /// First and last hour on the clock that count on a day; without sunrise and sunset all hours do.
    pub(super) fn hours(self, (site, zone): (&Site, &Zone), date: Date) -> Result<[f64; 2]> {
        let margin = match self {
            Self::Toronto => return Ok([9.3, 18.3]),
            Self::Ceqr => 1.5,
            Self::SanFrancisco => 1.0,
        };
        let noon = date.noon_utc();
        let midnight = noon - 0.5 * DAY - zone.offset_at(noon);
        // from one midnight of the sun to the next, whatever the clock shows
        let solar_noon = noon - site.longitude / std::f64::consts::TAU * DAY;
        let times = sun_times(site, solar_noon - 0.5 * DAY, solar_noon + 0.5 * DAY)?;
        let clock = |instant: Option<&f64>| instant.map(|instant| (instant - midnight) / HOUR);
        let from = clock(times.rises.first()).map_or(f64::NEG_INFINITY, |rise| rise + margin);
        Ok([from, clock(times.sets.last()).map_or(f64::INFINITY, |set| set - margin)])
    }

    /// The suns of a year, if the study is of one: of every seventh day from the longest to the shortest. `params` are
    /// those of other days, but for the step.
    pub(super) fn year(
        self,
        (site, zone): (&Site, &Zone),
        year: i16,
        params: DayParams,
    ) -> Result<Option<SunSchedule>> {
        if self != Self::SanFrancisco {
            return Ok(None);
        }
        let dates = Date::new(year, 6, 21)?.to(Date::new(year, 12, 31)?).step_by(WEEK).take(WEEKS).collect();
        let params = params.with_step(YEAR_STEP);
        Ok(Some(SunSchedule::new(&sun_days(site, zone, &Period::Days(dates), &params)?, Binning::Exact)?))
    }
}

/// Hours of a step within hours of its day.
pub(super) fn hours_within([from, to]: [f64; 2], start: f32, hours: f32) -> [f64; 2] {
    let start = f64::from(start);
    [start.max(from), (start + f64::from(hours)).min(to)]
}

impl YearOfSun {
    /// Sums `schedule` over a year. `hours` are those that count on each of its days; `share_lit` and `share_lost` give
    /// the shares of the area that a direction lights, and of which the plan takes its sun; `area` is in m².
    pub(super) fn of(
        schedule: &SunSchedule,
        hours: &[[f64; 2]],
        area: f64,
        (share_lit, share_lost): (impl Fn(usize) -> f64, impl Fn(usize) -> f64),
    ) -> Self {
        let mut sums = [0.0; 3];
        let mut worst: Option<(Date, f64)> = None;
        for (day, &hours) in schedule.days.iter().zip(hours) {
            let mut lost_of_day = 0.0;
            for step in &day.steps {
                let [from, to] = hours_within(hours, step.start, step.hours);
                let length = (to - from).max(0.0);
                let direction = step.direction as usize;
                lost_of_day += length * share_lost(direction);
                sums = [sums[0] + length, sums[1] + length * share_lit(direction), sums[2]];
            }
            sums[2] += lost_of_day;
            if lost_of_day * area > worst.map_or(0.0, |(_, most)| most) {
                worst = Some((day.date, lost_of_day * area));
            }
        }
        let [hours, lit, lost] = sums;
        let days = schedule.days.len().max(1) as f64;
        let share = |part: f64| if hours > 0.0 { part / hours } else { 0.0 };
        Self { hours: hours / days * YEAR, lit: share(lit), lost: share(lost), worst }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn san_francisco() -> (Site, Zone) {
        let site = Site {
            latitude: 37.775_f64.to_radians(),
            longitude: -122.418_f64.to_radians(),
            height: 0.0,
            convergence: 0.0,
        };
        (site, Zone::parse("America/Los_Angeles").unwrap())
    }

    #[test]
    fn a_year_of_san_francisco_has_the_hours_that_the_city_counts() {
        let (site, zone) = san_francisco();
        let study = ShadowStudy::SanFrancisco;
        let schedule = study.year((&site, &zone), 2026, DayParams::default()).unwrap().unwrap();
        let hours: Vec<[f64; 2]> =
            schedule.days.iter().map(|day| study.hours((&site, &zone), day.date).unwrap()).collect();
        let found = YearOfSun::of(&schedule, &hours, 100.0, (|_| 0.75, |_| 0.01));
        // the city multiplies areas by 3721.4 hours
        assert!((found.hours - 3721.4).abs() < 5.0, "{found:?}");
        assert!((found.lit - 0.75).abs() < 1e-9 && (found.lost - 0.01).abs() < 1e-9, "{found:?}");
        // the longest day: 14.78 hours of sun less two
        let (day, lost) = found.worst.unwrap();
        assert!((day, (lost - 12.78).abs() < 0.05) == (Date::new(2026, 6, 21).unwrap(), true), "{day} {lost}");
    }

    #[test]
    fn hours_that_count_follow_sunrise_or_the_clock() {
        // almanac of New York, 21 December 2026: 07:17 to 16:32
        let site = Site {
            latitude: 40.713_f64.to_radians(),
            longitude: -74.006_f64.to_radians(),
            height: 0.0,
            convergence: 0.0,
        };
        let zone = Zone::parse("America/New_York").unwrap();
        let date = Date::new(2026, 12, 21).unwrap();
        let [from, to] = ShadowStudy::Ceqr.hours((&site, &zone), date).unwrap();
        assert!((from - (7.0 + 17.0 / 60.0 + 1.5)).abs() < 0.02, "{from}");
        assert!((to - (16.0 + 32.0 / 60.0 - 1.5)).abs() < 0.02, "{to}");
        // the same hours on a clock that shows sunset after midnight
        let utc = ShadowStudy::Ceqr.hours((&site, &Zone::utc()), Date::new(2026, 6, 21).unwrap()).unwrap();
        let own = ShadowStudy::Ceqr.hours((&site, &zone), Date::new(2026, 6, 21).unwrap()).unwrap();
        assert!((0..2).all(|end| (utc[end] - own[end] - 4.0).abs() < 1e-6) && utc[1] > 22.9, "{utc:?} {own:?}");
        assert_eq!(ShadowStudy::Toronto.hours((&site, &zone), date).unwrap(), [9.3, 18.3]);
        // half of a step before half past one
        assert_eq!(hours_within([12.0, 13.5], 13.25, 0.5), [13.25, 13.5]);
    }
}
