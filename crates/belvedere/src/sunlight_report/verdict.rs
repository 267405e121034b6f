//! Verdicts on daylight rules.

use crate::apps::ask::SunCalendarResults;
use crate::apps::sun::Date;
use crate::apps::sun_calendar::{CalendarDay, sun_of_any};
use crate::apps::sun_hours::{Counted, NeededDays};

/// Tolerance of the required hours, hours: the rounding of f32 in a sum of steps.
const ROUNDING: f64 = 1e-4;

/// A rule at a window or in a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RuleFinding {
    /// Critical day: that with the least sun, or with the most where one day is enough.
    pub(super) date: Date,
    /// Row of that day among those of the rule.
    pub(super) row: usize,
    /// Hours that count on it.
    pub(super) hours: f64,
    /// Hours on the critical day without trees, which may be another day; `None` where trees are not known.
    pub(super) without_trees: Option<f64>,
    /// Interval of the hours that holds the truth in nine of ten cases; `None` if it is not known.
    pub(super) interval: Option<[f64; 2]>,
    /// Hours that the rule requires.
    pub(super) required: f64,
    /// Number of days with enough sun, and of all days.
    pub(super) days: [usize; 2],
}

/// Verdict on a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It is met.
    Met,
    /// It is not met.
    NotMet,
    /// The hours suffice, but those of its interval do not all.
    MetUncertain,
    /// The hours do not suffice, but some of its interval do.
    NotMetUncertain,
}

impl RuleFinding {
    /// Finds the critical day of the rule of a calendar at a window; `None` without a rule or a position.
    pub(super) fn of(found: &SunCalendarResults, window: usize) -> Option<Self> {
        let without = found.without_trees.as_ref().map(|all| &all[window][..]);
        Self::of_days(found, &found.days[window], without).filter(|_| found.targets.is_target(window))
    }

    /// Finds the critical day of a room with several `windows`, whose sun adds up where it is not in both.
    pub(super) fn of_room(found: &SunCalendarResults, windows: &[usize]) -> Option<Self> {
        let joined = |all: &[Vec<CalendarDay>]| -> Vec<CalendarDay> {
            let rows = 0..found.schedule.days.len();
            rows.map(|row| sun_of_any(windows.iter().map(|&window| &all[window][row]))).collect()
        };
        let without = found.without_trees.as_ref().map(|all| joined(all));
        Self::of_days(found, &joined(&found.days), without.as_deref())
            .filter(|_| windows.iter().any(|&window| found.targets.is_target(window)))
    }

    fn of_days(found: &SunCalendarResults, days: &[CalendarDay], without: Option<&[CalendarDay]>) -> Option<Self> {
        let rule = found.rule.as_ref()?;
        let counted = |day: &CalendarDay| match rule.counted {
            Counted::All => day.sun_hours(),
            Counted::LongestPiece => day.longest(),
        };
        let critical = |days: &[CalendarDay]| {
            let hours = days.iter().map(counted).enumerate();
            match rule.needed {
                NeededDays::All => hours.min_by(|a, b| a.1.total_cmp(&b.1)),
                // the first of the best
                NeededDays::Any => hours.collect::<Vec<_>>().into_iter().rev().max_by(|a, b| a.1.total_cmp(&b.1)),
            }
        };
        let (row, of_day) = critical(days)?;
        let without = without.and_then(critical);
        let hours: Vec<f64> = days.iter().map(counted).collect();
        let enough = hours.iter().filter(|&&hours| hours >= rule.hours - ROUNDING).count();
        Some(Self {
            date: found.schedule.days.get(row)?.date,
            row,
            hours: of_day,
            without_trees: without.map(|(_, hours)| hours),
            interval: None,
            required: rule.hours,
            days: [enough, hours.len()],
        })
    }

    /// Sets the interval to the hours with the differences of its ends.
    pub(super) fn widen(&mut self, ends: Option<[f64; 2]>) {
        self.interval = ends.map(|[low, high]| [(self.hours + low).max(0.0), self.hours + high]);
    }

    /// Returns the hours to print: those that miss the rule by seconds are not rounded up to what it requires.
    pub(super) fn printed_hours(&self) -> f64 {
        let minutes = |hours: f64| (hours * 60.0).round();
        let is_short = self.hours < self.required - ROUNDING;
        match is_short && minutes(self.hours) >= minutes(self.required) {
            true => self.required - 1.0 / 60.0,
            false => self.hours,
        }
    }

    /// Returns true if the hours suffice without trees; `None` where trees are not known.
    pub(super) fn is_met_without_trees(&self) -> Option<bool> {
        self.without_trees.map(|hours| hours >= self.required - ROUNDING)
    }

    /// The verdict.
    pub(super) fn verdict(&self) -> Verdict {
        let suffices = |hours: f64| hours >= self.required - ROUNDING;
        let [low, high] = self.interval.unwrap_or([self.hours; 2]);
        match (suffices(self.hours), suffices(low), suffices(high)) {
            (true, true, _) => Verdict::Met,
            (true, false, _) => Verdict::MetUncertain,
            (false, _, true) => Verdict::NotMetUncertain,
            (false, _, false) => Verdict::NotMet,
        }
    }
}

impl Verdict {
    /// Returns true if the hours suffice.
    pub(super) fn is_met(self) -> bool {
        matches!(self, Self::Met | Self::MetUncertain)
    }

    /// Returns true if the interval holds hours that would change it.
    pub(super) fn is_uncertain(self) -> bool {
        matches!(self, Self::MetUncertain | Self::NotMetUncertain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_are_uncertain_where_the_interval_crosses_the_hours() {
        let date = Date::new(2026, 3, 21).unwrap();
        let of = |hours: f64, ends: Option<[f64; 2]>| {
            let mut found =
                RuleFinding { date, row: 0, hours, without_trees: None, interval: None, required: 2.0, days: [0, 1] };
            found.widen(ends);
            found.verdict()
        };
        assert_eq!(of(2.0, None), Verdict::Met);
        assert_eq!(of(1.99, None), Verdict::NotMet);
        assert_eq!(of(2.5, Some([-0.4, 0.4])), Verdict::Met);
        assert_eq!(of(2.5, Some([-0.6, 0.4])), Verdict::MetUncertain);
        assert_eq!(of(1.5, Some([-0.4, 0.6])), Verdict::NotMetUncertain);
        assert_eq!(of(1.5, Some([-0.4, 0.4])), Verdict::NotMet);
        let printed = |hours: f64| {
            let days = [0, 1];
            RuleFinding { date, row: 0, hours, without_trees: None, interval: None, required: 2.0, days }
                .printed_hours()
        };
        assert_eq!(printed(1.999), 2.0 - 1.0 / 60.0);
        assert_eq!([1.5, 2.0, 2.001].map(printed), [1.5, 2.0, 2.001]);
        assert!(Verdict::MetUncertain.is_met() && Verdict::NotMetUncertain.is_uncertain());
    }
}
