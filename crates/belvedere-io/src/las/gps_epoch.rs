//! Epoch of the GPS times of a file: by its header, by the times themselves, and by the day of the flight.

use belvedere_data::GpsTimeKind;
use belvedere_data::cast::to_i64;
use belvedere_data::cloud::{ADJUSTED_GPS_EPOCH, Attributes};
use belvedere_data::contradiction::{FLIGHT_DAY, FoundContradiction, GPS_TIME_EPOCH};
use belvedere_data::trajectory::{LONGEST_WEEK_S, WEEK_S};
use belvedere_data::weather::{CalendarDay, date_of_unix_day, unix_day};

/// Difference of GPS time and adjusted standard GPS time, seconds.
///
/// # Source
/// ASPRS 2019, LAS Specification 1.4 R15, global encoding.
const ADJUSTMENT: f64 = 1e9;
/// First day of GPS time, 6 January 1980, a Sunday: days since 1970.
const FIRST_DAY: i64 = 3657;
/// Seconds of a day.
const DAY: f64 = 86_400.0;

/// Epoch of the GPS times of a file. The first time that is not zero decides for all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GpsEpoch {
    /// Epoch that the header states.
    stated: GpsTimeKind,
    /// Day of the flight, where a user gives it.
    flown: Option<CalendarDay>,
    /// First time of the file, with its epoch.
    first: Option<(f64, Epoch)>,
}

/// Origin of times.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Epoch {
    /// A Sunday that is not known.
    Week,
    /// The Sunday before a given day.
    WeekOf(CalendarDay),
    /// 14 September 2011, the origin of adjusted standard GPS time.
    Adjusted,
    /// 6 January 1980.
    Standard,
}

impl GpsEpoch {
    /// Returns the epoch of times that have not been seen.
    pub(crate) fn new(stated: GpsTimeKind, flown: Option<CalendarDay>) -> Self {
        Self { stated, flown, first: None }
    }

    /// Brings times to adjusted standard GPS time where their day is known.
    pub(crate) fn apply(&mut self, attributes: &mut Attributes) {
        let Some(times) = &mut attributes.gps_time else { return };
        let is_time = |time: &f64| time.is_finite() && *time != 0.0;
        if self.first.is_none() {
            self.first = times.iter().find(|time| is_time(time)).map(|&time| (time, self.epoch_of(time)));
        }
        let Some((_, epoch)) = self.first else {
            attributes.gps_time_kind = self.stated;
            return;
        };
        let shift = match epoch {
            Epoch::Week => {
                attributes.gps_time_kind = GpsTimeKind::SecondsOfWeek;
                return;
            }
            Epoch::WeekOf(day) => (unix_day(day) - FIRST_DAY).div_euclid(7) as f64 * WEEK_S - ADJUSTMENT,
            Epoch::Adjusted => 0.0,
            Epoch::Standard => -ADJUSTMENT,
        };
        attributes.gps_time_kind = GpsTimeKind::AdjustedStandard;
        if shift != 0.0 {
            times.iter_mut().filter(|time| is_time(time)).for_each(|time| *time += shift);
        }
    }

    fn epoch_of(&self, time: f64) -> Epoch {
        let may_be_of_week = (0.0..=LONGEST_WEEK_S).contains(&time);
        match (self.stated, self.flown) {
            (_, Some(day)) if may_be_of_week => Epoch::WeekOf(day),
            (GpsTimeKind::SecondsOfWeek, _) if may_be_of_week => Epoch::Week,
            (GpsTimeKind::SecondsOfWeek, _) if time >= ADJUSTMENT => Epoch::Standard,
            _ => Epoch::Adjusted,
        }
    }

    /// Returns the contradictions of the times with the header and with the day of the flight.
    pub(crate) fn contradictions(&self) -> impl Iterator<Item = FoundContradiction> + use<> {
        let Self { stated, flown, first } = *self;
        let day_of = |(time, epoch): (f64, Epoch)| {
            let shift = match epoch {
                Epoch::Adjusted => 0.0,
                Epoch::Standard => -ADJUSTMENT,
                Epoch::Week | Epoch::WeekOf(_) => return None,
            };
            Some(to_i64(((time + shift + ADJUSTED_GPS_EPOCH) / DAY).floor()))
        };
        let day = first.and_then(day_of);
        let date = day.and_then(date_of_unix_day);
        let epoch = date.filter(|_| stated == GpsTimeKind::SecondsOfWeek).map(|date| {
            GPS_TIME_EPOCH.found(format!(
                "the header says that GPS times are seconds of a week, but they are those of {date}: the day is used"
            ))
        });
        let apart = day.zip(flown).map(|(day, flown)| (unix_day(flown) - day) as f64);
        let flight = apart.zip(date).zip(flown).filter(|((apart, _), _)| FLIGHT_DAY.is_exceeded_by(*apart));
        let flight = flight.map(|((apart, date), flown)| {
            let text = format!("the flight was on {date} by the GPS times, not on {flown}: the times are used");
            FLIGHT_DAY.found(text).with("days", apart)
        });
        epoch.into_iter().chain(flight)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WEEK: GpsTimeKind = GpsTimeKind::SecondsOfWeek;
    const ADJUSTED: GpsTimeKind = GpsTimeKind::AdjustedStandard;

    fn read(times: [f64; 2], stated: GpsTimeKind, flown: Option<CalendarDay>) -> (Vec<f64>, GpsTimeKind, Vec<String>) {
        let mut epoch = GpsEpoch::new(stated, flown);
        let mut attributes =
            Attributes { gps_time: Some(times.into()), gps_time_kind: stated, ..Attributes::default() };
        epoch.apply(&mut attributes);
        let keys = epoch.contradictions().map(|found| found.row.key.to_owned()).collect();
        (attributes.gps_time.unwrap(), attributes.gps_time_kind, keys)
    }

    #[test]
    fn times_beyond_a_week_name_their_day() {
        // 0 is no time; 297,417,271 s of a LiDAR HD tile are 15 February 2021
        assert_eq!(
            read([0.0, 297_417_271.5], WEEK, None),
            (vec![0.0, 297_417_271.5], ADJUSTED, vec!["gps-time-epoch".to_owned()])
        );
        assert_eq!(read([0.0, 297_417_271.5], ADJUSTED, None), (vec![0.0, 297_417_271.5], ADJUSTED, vec![]));
        let standard = read([1_297_417_271.5, 0.0], WEEK, None);
        assert_eq!(standard, (vec![297_417_271.5, 0.0], ADJUSTED, vec!["gps-time-epoch".to_owned()]));
        // before 14 September 2011
        assert_eq!(read([-5.0e7, -5.0e7], WEEK, None).1, ADJUSTED);
        assert_eq!(read([528_532.5, 0.0], WEEK, None), (vec![528_532.5, 0.0], WEEK, vec![]));
    }

    #[test]
    fn a_given_day_names_the_week() {
        // 15 February 2021 is a Monday, after midnight of which 34,871 s passed: GPS week 2145 began on the 14th
        let seconds = 86_400.0 + 34_871.5;
        let flown = CalendarDay::new(2021, 2, 16);
        let (times, kind, keys) = read([seconds, 0.0], WEEK, flown);
        assert_eq!((times, kind, keys.len()), (vec![297_417_271.5, 0.0], ADJUSTED, 0));
        assert_eq!(read([seconds, 0.0], ADJUSTED, flown).0, [297_417_271.5, 0.0]);
        // times that know better
        assert_eq!(read([297_417_271.5, 0.0], ADJUSTED, flown).2, Vec::<String>::new());
        let other = read([297_417_271.5, 0.0], ADJUSTED, CalendarDay::new(2020, 7, 1));
        assert_eq!((other.0, other.2), (vec![297_417_271.5, 0.0], vec!["flight-day".to_owned()]));
    }
}
