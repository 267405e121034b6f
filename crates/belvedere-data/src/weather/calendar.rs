//! Days of the proleptic Gregorian calendar, as weather files and formulas of the sun's distance count them.

use crate::cast::{to_i32, to_i64};

/// Seconds of a day.
pub(super) const DAY: f64 = 86_400.0;

/// A day of the calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct CalendarDay {
    /// Year.
    pub year: i32,
    /// Month, 1 to 12.
    pub month: u8,
    /// Day of the month, 1 to 31.
    pub day: u8,
}

impl CalendarDay {
    /// The date, or `None` where the calendar has no such day or the year is not 1 to 9999.
    #[must_use]
    pub fn new(year: i32, month: u8, day: u8) -> Option<Self> {
        let date = Self { year, month, day };
        ((1..=9999).contains(&year) && (1..=12).contains(&month) && (1..=date.days_of_month()).contains(&day))
            .then_some(date)
    }

    /// Reads a date such as 2021-04-29; `None` for other text.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let mut parts = text.trim().splitn(3, '-');
        let year = parts.next()?.parse().ok()?;
        let mut number = || parts.next()?.parse().ok();
        Self::new(year, number()?, number()?)
    }

    fn days_of_month(self) -> u8 {
        let is_leap = self.year % 4 == 0 && (self.year % 100 != 0 || self.year % 400 == 0);
        match self.month {
            2 => 28 + u8::from(is_leap),
            4 | 6 | 9 | 11 => 30,
            _ => 31,
        }
    }
}

impl std::fmt::Display for CalendarDay {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

/// Days from 1970-01-01 to a date, negative before.
///
/// # Source
/// The year is taken to begin in March, so that its months before the last have 153 days in five: Richards 1998,
/// Mapping Time.
#[must_use]
pub fn unix_day(date: CalendarDay) -> i64 {
    let (month, day) = (i64::from(date.month), i64::from(date.day));
    let march_year = i64::from(date.year) - i64::from(month < 3);
    let from_march = (month + 9) % 12;
    let day_of_year = (153 * from_march + 2) / 5 + day - 1;
    let leap_days = march_year.div_euclid(4) - march_year.div_euclid(100) + march_year.div_euclid(400);
    365 * march_year + leap_days + day_of_year - 719_468
}

/// The date so many days after 1970-01-01; `None` outside the years 1 to 9999.
///
/// # Source
/// As [`unix_day`], the other way round.
#[must_use]
pub fn date_of_unix_day(day: i64) -> Option<CalendarDay> {
    if !(-719_162..=2_932_896).contains(&day) {
        return None;
    }
    // days since 1 March of year 0, and within an era of 400 years
    let from_march = day + 719_468;
    let (era, of_era) = (from_march.div_euclid(146_097), from_march.rem_euclid(146_097));
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = 400 * era + year_of_era + i64::from(month < 3);
    CalendarDay::new(i32::try_from(year).ok()?, u8::try_from(month).ok()?, u8::try_from(day).ok()?)
}

/// Day of the year in UTC, from 1, with its fraction left out; `None` for an instant outside the years 1 to 9999.
#[must_use]
pub fn day_of_year(unix_s: f64) -> Option<u16> {
    let day = (unix_s / DAY).floor();
    if !(-719_162.0..=2_932_896.0).contains(&day) {
        return None;
    }
    let (day, guess) = (to_i64(day), to_i32((1970.0 + day / 365.2425).floor()));
    let first = |year: i32| CalendarDay::new(year, 1, 1).map(unix_day);
    // the guess is off by one at most, since leap days are at most two days off their mean
    let start = [guess + 1, guess, guess - 1].into_iter().filter_map(first).find(|&start| start <= day)?;
    u16::try_from(day - start + 1).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_count_as_the_calendar_does() {
        let date = |year, month, day| CalendarDay::new(year, month, day).unwrap();
        // known days: the epoch, a leap day of a year divisible by 400, the start of GPS time (315 964 800 s)
        assert_eq!(unix_day(date(1970, 1, 1)), 0);
        assert_eq!(unix_day(date(2000, 2, 29)), 11_016);
        assert_eq!(unix_day(date(1980, 1, 6)), 3657);
        assert_eq!(unix_day(date(1969, 12, 31)), -1);
        // one by one over four centuries
        let mut day = unix_day(date(1800, 1, 1));
        for year in 1800..2200 {
            let mut of_year = 0;
            for month in 1..=12 {
                for number in 1..=31 {
                    let Some(date) = CalendarDay::new(year, month, number) else { continue };
                    of_year += 1;
                    assert_eq!(unix_day(date), day, "{date:?}");
                    assert_eq!(date_of_unix_day(day), Some(date));
                    assert_eq!(day_of_year(day as f64 * DAY + 1.0), Some(of_year), "{date:?}");
                    day += 1;
                }
            }
            assert!(of_year == 365 || of_year == 366);
        }
    }

    #[test]
    fn days_that_are_not_are_none() {
        for (year, month, day) in [(2023, 2, 29), (1900, 2, 29), (2024, 13, 1), (2024, 0, 1), (2024, 4, 31), (0, 1, 1)]
        {
            assert_eq!(CalendarDay::new(year, month, day), None, "{year} {month} {day}");
        }
        assert_eq!(day_of_year(f64::NAN), None);
        assert_eq!(day_of_year(1e18), None);
    }
}
