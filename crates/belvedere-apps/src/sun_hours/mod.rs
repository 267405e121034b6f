//! Hours of sun at a place: hours and share of a day or of many days, first and last light, longest stretch, rules.

mod crowns;
mod plan;
mod rules;
mod stretches;

pub use crowns::sun_hours_through_crowns;
pub use plan::{PlannedRule, SunPlan, SunSums, scene_sun_hours};
pub use rules::{Counted, NeededDays, RuleDays, RuleWindow, SunRule, WindowClock};

use crate::rows::check_normals;
use crate::sun::SunSchedule;
use belvedere_core::query::VisibilityMatrix;
use belvedere_data::vector::{dot, to_f32};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use stretches::{DayStretch, Lit, runs_of};

/// Descriptions of rasters of hours of sun, and of fulfilled rules.
pub const SUN_HOURS: &str = "hours of sun a day";
/// See [`SUN_HOURS`].
pub const RULE_IS_MET: &str = "rule is met";

/// Measures that are hours on the clock, each with the name of the column that has them as HH:MM in tables.
pub const CLOCK_MEASURES: [(&str, &str); 2] = [("first_light", "first_light_time"), ("last_light", "last_light_time")];

/// Targets handed to a thread at once.
const CHUNK: usize = 64;
/// Tolerance of the required hours of a day, hours: the rounding of f32 in a sum of steps.
const ROUNDING: f64 = 1e-4;

/// The sun at each of many targets over the days of a [`SunSchedule`]; each array has a value for each target, (M).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SunHours {
    /// Hours of sun a day, the mean over the days.
    pub hours: Vec<f32>,
    /// Share of the hours of sun above a flat horizon, 0 to 1; NaN where the sun does not rise on any day.
    pub share: Vec<f32>,
    /// First time of sun, hours on the clocks of the zone: the earliest of the days; NaN if there is none. Accurate to
    /// within a step.
    pub first: Vec<f32>,
    /// Last time of sun: the latest of the days; NaN if there is none.
    pub last: Vec<f32>,
    /// Longest stretch without a break on any day, hours.
    pub longest: Vec<f32>,
    /// Hours on the day with the least.
    pub min: Vec<f32>,
    /// Number of days on which the hours suffice.
    pub days: Vec<u32>,
}

impl SunHours {
    /// Adds the targets of `other` after these.
    pub fn append(&mut self, other: Self) {
        self.hours.extend(other.hours);
        self.share.extend(other.share);
        self.first.extend(other.first);
        self.last.extend(other.last);
        self.longest.extend(other.longest);
        self.min.extend(other.min);
        self.days.extend(other.days);
    }
}

/// Parameters of the statistics of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SunHoursParams {
    /// Column of the matrix that holds the first direction of the schedule. Default 0.
    pub first_direction: usize,
    /// Hours of sun that a day must have to count in [`SunHours::days`], 0 to 24. Default 0: each day counts.
    pub sufficient_hours: f64,
    /// Hours of a day that must suffice. Default: all together.
    pub counted: Counted,
}

belvedere_data::setters!(SunHoursParams {
    with_first_direction(first_direction: usize),
    with_sufficient_hours(sufficient_hours: f64),
    with_counted(counted: Counted),
});

impl Default for SunHoursParams {
    fn default() -> Self {
        Self { first_direction: 0, sufficient_hours: 0.0, counted: Counted::All }
    }
}

/// Sums up when the suns of `schedule` reach each target of `matrix`, whose columns from `first_direction` on are the
/// directions of the schedule. `normals`, (M, 3) unit vectors, are given for surfaces, which a sun behind them does not
/// light; with `None` a target is lit from all sides.
///
/// # Errors
/// [`Error::LengthMismatch`] where matrix, schedule and normals differ, [`Error::InvalidParameter`] for hours outside
/// their range.
pub fn sun_hours(
    matrix: &VisibilityMatrix,
    schedule: &SunSchedule,
    normals: Option<&[[f32; 3]]>,
    params: &SunHoursParams,
) -> Result<SunHours> {
    let columns = params.first_direction..params.first_direction.saturating_add(schedule.directions.len());
    if columns.end > matrix.direction_count() {
        let (expected, found) = (columns.end, matrix.direction_count());
        return Err(Error::LengthMismatch { what: "directions of the matrix", expected, found });
    }
    check_normals(normals, matrix.target_count())?;
    if !(0.0..=24.0).contains(&params.sufficient_hours) {
        return Err(Error::invalid(Parameter::SufficientHours, params.sufficient_hours, "0 to 24"));
    }
    let sufficient = (params.sufficient_hours - ROUNDING, params.counted);
    let day_count = schedule.days.len().max(1) as f64;
    let possible = schedule.possible_hours();
    let days: Vec<Vec<DayStretch>> = schedule.days.iter().map(runs_of).collect();
    let sums: Vec<TargetSum> = (0..matrix.target_count())
        .into_par_iter()
        .with_min_len(CHUNK)
        .map_init(
            || Lit::new(schedule.directions.len()),
            |lit, target| {
                let normal = normals.map(|normals| normals[target].map(f64::from));
                lit.set(|number| {
                    let faces = normal.is_none_or(|normal| dot(normal, schedule.directions[number]) > 0.0);
                    faces && matrix.is_free(target, columns.start + number)
                });
                TargetSum::over(&days, lit, sufficient)
            },
        )
        .collect();
    let column = |of: &dyn Fn(&TargetSum) -> f64| sums.iter().map(|sum| to_f32(of(sum))).collect();
    let if_lit = |sum: &TargetSum, value: f64| if sum.total > 0.0 { value } else { f64::NAN };
    Ok(SunHours {
        hours: column(&|sum| sum.total / day_count),
        share: column(&|sum| if possible > 0.0 { (sum.total / possible).min(1.0) } else { f64::NAN }),
        first: column(&|sum| if_lit(sum, f64::from(sum.first))),
        last: column(&|sum| if_lit(sum, f64::from(sum.last))),
        longest: column(&|sum| f64::from(sum.longest)),
        min: column(&|sum| sum.min),
        days: sums.iter().map(|sum| sum.days).collect(),
    })
}

/// Sums at one target.
struct TargetSum {
    total: f64,
    min: f64,
    first: f32,
    last: f32,
    longest: f32,
    days: u32,
}

impl TargetSum {
    fn over(days: &[Vec<DayStretch>], lit: &Lit, (sufficient, counted): (f64, Counted)) -> Self {
        let mut sum =
            Self { total: 0.0, min: 24.0, first: f32::INFINITY, last: f32::NEG_INFINITY, longest: 0.0, days: 0 };
        for runs in days {
            let [mut hours, mut stretch, mut longest] = [0.0_f32; 3];
            for run in runs {
                stretch = if run.continues { stretch } else { 0.0 };
                // where the run is lit: from one stretch to the next
                let mut from = run.first;
                while from < run.end {
                    let start = lit.next_lit(from).min(run.end);
                    let end = lit.next_dark(start).min(run.end);
                    stretch = if start > from { 0.0 } else { stretch };
                    if end > start {
                        let lasts = run.hours * (end - start) as f32;
                        hours += lasts;
                        stretch += lasts;
                        longest = longest.max(stretch);
                        sum.first = sum.first.min(run.start + run.hours * (start - run.first) as f32);
                        sum.last = sum.last.max(run.start + run.hours * (end - run.first) as f32);
                    }
                    stretch = if end < run.end { 0.0 } else { stretch };
                    from = end;
                }
            }
            sum.longest = sum.longest.max(longest);
            let counting = f64::from(if counted == Counted::All { hours } else { longest });
            let hours = f64::from(hours);
            sum.total += hours;
            sum.min = sum.min.min(hours);
            sum.days += u32::from(counting >= sufficient);
        }
        sum
    }
}
