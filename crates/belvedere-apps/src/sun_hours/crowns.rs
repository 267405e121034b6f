//! Hours of sun where crowns of trees let a share of it through.

use super::stretches::{DayStretch, Lit, runs_of};
use super::{CHUNK, ROUNDING, SunHours, SunHoursParams, sun_hours};
use crate::sun::SunSchedule;
use belvedere_core::query::VisibilityMatrix;
use belvedere_data::vector::dot;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// As [`sun_hours`], where only vegetation stands in the way of a sun an hour counting as much as crowns let through on
/// that day: `transmissivities`, 0 to 1, has one for each day of `schedule`. `all` is the matrix of all balls, `opaque`
/// that of those that are not vegetation, of the same targets and directions. Hours, share, the least day and the days
/// that suffice are those of the light that arrives; first, last and longest are of the sun that nothing stands before,
/// since light through leaves has no such hour.
///
/// # Errors
/// Those of [`sun_hours`], [`Error::LengthMismatch`] where the matrices differ or there is not a share for each day,
/// and [`Error::InvalidParameter`] for a share outside 0 to 1.
pub fn sun_hours_through_crowns(
    all: &VisibilityMatrix,
    opaque: &VisibilityMatrix,
    schedule: &SunSchedule,
    normals: Option<&[[f32; 3]]>,
    params: &SunHoursParams,
    transmissivities: &[f64],
) -> Result<SunHours> {
    let mut found = sun_hours(all, schedule, normals, params)?;
    let same = |what, expected, found| match expected == found {
        true => Ok(()),
        false => Err(Error::LengthMismatch { what, expected, found }),
    };
    same("targets without vegetation", all.target_count(), opaque.target_count())?;
    same("directions without vegetation", all.direction_count(), opaque.direction_count())?;
    same("transmissivities of days", schedule.days.len(), transmissivities.len())?;
    if let Some(bad) = transmissivities.iter().find(|share| !(0.0..=1.0).contains(*share)) {
        return Err(Error::InvalidParameter {
            parameter: Parameter::Transmissivity,
            value: bad.to_string(),
            expected: "0 (opaque) to 1",
        });
    }
    let days: Vec<(Vec<DayStretch>, f64)> =
        schedule.days.iter().map(runs_of).zip(transmissivities.iter().copied()).collect();
    let count = schedule.directions.len();
    let sums: Vec<CrownSum> = (0..all.target_count())
        .into_par_iter()
        .with_min_len(CHUNK)
        .map_init(
            || [Lit::new(count), Lit::new(count)],
            |[free, through], target| {
                let normal = normals.map(|normals| normals[target].map(f64::from));
                for (lit, matrix) in [(&mut *free, all), (&mut *through, opaque)] {
                    lit.set(|number| {
                        let faces = normal.is_none_or(|normal| dot(normal, schedule.directions[number]) > 0.0);
                        faces && matrix.is_free(target, params.first_direction + number)
                    });
                }
                CrownSum::over(&days, free, through, params.sufficient_hours - ROUNDING)
            },
        )
        .collect();
    let (day_count, possible) = (schedule.days.len().max(1) as f64, schedule.possible_hours());
    #[expect(clippy::cast_possible_truncation, reason = "hours of a day and shares of one")]
    let column = |of: &dyn Fn(&CrownSum) -> f64| sums.iter().map(|sum| of(sum) as f32).collect();
    found.hours = column(&|sum| sum.total / day_count);
    found.share = column(&|sum| if possible > 0.0 { (sum.total / possible).min(1.0) } else { f64::NAN });
    found.min = column(&|sum| sum.min);
    found.days = sums.iter().map(|sum| sum.days).collect();
    Ok(found)
}

/// What is summed up at one target.
struct CrownSum {
    total: f64,
    min: f64,
    days: u32,
}

impl CrownSum {
    fn over(days: &[(Vec<DayStretch>, f64)], free: &Lit, through: &Lit, sufficient: f64) -> Self {
        let mut sum = Self { total: 0.0, min: 24.0, days: 0 };
        for (runs, share) in days {
            let [free, through] = [free, through].map(|lit| runs.iter().map(|run| lit_hours(run, lit)).sum::<f64>());
            let hours = free + share * (through - free);
            sum.total += hours;
            sum.min = sum.min.min(hours);
            sum.days += u32::from(hours >= sufficient);
        }
        sum
    }
}

/// Hours of a run that are lit.
fn lit_hours(run: &DayStretch, lit: &Lit) -> f64 {
    let (mut hours, mut from) = (0.0, run.first);
    while from < run.end {
        let start = lit.next_lit(from).min(run.end);
        let end = lit.next_dark(start).min(run.end);
        hours += f64::from(run.hours) * f64::from(end - start);
        from = end;
    }
    hours
}
