//! Hours of sun where crowns of trees let a share of it through.

use super::stretches::{DayStretch, runs_of};
use super::{CHUNK, Counted, ROUNDING, SunHours, SunHoursParams, sun_hours};
use crate::rows::check_normals;
use crate::rows::{LineLight, RowBlock};
use crate::sun::SunSchedule;
use belvedere_core::query::VisibilityMatrix;
use belvedere_data::cast::to_row;
use belvedere_data::error::check_length;
use belvedere_data::vector::{dot, to_f32};
use belvedere_data::{Error, Result};
use rayon::prelude::*;

/// Bits in a word of a row of a matrix.
const WORD: usize = 64;

/// Returns the sums of [`sun_hours`], where an hour of a sun behind crowns is weighted by the light that these let
/// through on that day. `factors` has a [`factor`](crate::tree_light::CrownLight::factor) for each day of `schedule`.
/// Hours, share, the shortest day and the sufficient days are those of the light that arrives. First, last and longest
/// are of suns that count as free on their day ([`LineLight::is_free`]), since a share of light has no such hour.
///
/// # Errors
/// Those of [`sun_hours`], and [`Error::LengthMismatch`] where there is not a factor for
/// each day.
pub fn sun_hours_through_crowns(
    block: &RowBlock<'_>,
    schedule: &SunSchedule,
    normals: Option<&[[f32; 3]]>,
    params: &SunHoursParams,
    factors: &[f64],
) -> Result<SunHours> {
    check_length("factors of crowns of days", schedule.days.len(), factors.len())?;
    let (expected, found) = (params.first_direction + schedule.directions.len(), block.matrix.direction_count());
    if expected > found {
        return Err(Error::LengthMismatch { what: "directions of the matrix", expected, found });
    }
    check_normals(normals, block.matrix.target_count())?;
    let by_factor = DaysByFactor::new(schedule, factors);
    let (direction_count, column_count) = (schedule.directions.len(), by_factor.schedule.directions.len());
    let width = column_count.div_ceil(WORD);
    let days: Vec<(Vec<DayStretch>, f64)> = schedule.days.iter().map(runs_of).zip(factors.iter().copied()).collect();
    let (sums, words): (Vec<CrownSum>, Vec<Vec<u64>>) = (0..block.matrix.target_count())
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(|target| {
            let normal = normals.map(|normals| normals[target].map(f64::from));
            let line = |(number, direction): (usize, &[f64; 3])| match normal {
                Some(normal) if dot(normal, *direction) <= 0.0 => LineLight::Blocked,
                _ => block.line(target, params.first_direction + number),
            };
            let lines: Vec<LineLight> = schedule.directions.iter().enumerate().map(line).collect();
            let mut free = vec![0; width];
            for (kind, &factor) in by_factor.factors.iter().enumerate() {
                for (number, _) in lines.iter().enumerate().filter(|(_, line)| line.is_free(factor)) {
                    let column = kind * direction_count + number;
                    free[column / WORD] |= 1_u64 << (column % WORD);
                }
            }
            (CrownSum::over(&days, &lines, params.sufficient_hours - ROUNDING), free)
        })
        .unzip();
    let free = VisibilityMatrix::from_words(sums.len(), column_count, words.concat())?;
    let params = SunHoursParams { first_direction: 0, ..*params };
    let mut hours = sun_hours(&free, &by_factor.schedule, normals, &params)?;
    let (day_count, possible) = (schedule.days.len().max(1) as f64, schedule.possible_hours());
    let column = |of: &dyn Fn(&CrownSum) -> f64| sums.iter().map(|sum| to_f32(of(sum))).collect();
    hours.hours = column(&|sum| sum.total / day_count);
    hours.share = column(&|sum| if possible > 0.0 { (sum.total / possible).min(1.0) } else { f64::NAN });
    hours.min = column(&|sum| sum.min);
    // a piece without a break is one of suns that count as free
    if params.counted == Counted::All {
        hours.days = sums.iter().map(|sum| sum.days).collect();
    }
    Ok(hours)
}

/// Days of a schedule with a copy of the directions for each factor of a day: the same sun may be free on one day and
/// not on another.
struct DaysByFactor {
    /// Different factors.
    factors: Vec<f64>,
    /// Days with the directions of their factor.
    schedule: SunSchedule,
}

impl DaysByFactor {
    fn new(schedule: &SunSchedule, factors: &[f64]) -> Self {
        let mut kinds: Vec<f64> = Vec::new();
        let mut by_factor = schedule.clone();
        for (day, &factor) in by_factor.days.iter_mut().zip(factors) {
            let kind = kinds.iter().position(|own| *own == factor).unwrap_or(kinds.len());
            if kind == kinds.len() {
                kinds.push(factor);
            }
            let first = to_row(kind * schedule.directions.len());
            day.steps.iter_mut().for_each(|step| step.direction += first);
        }
        by_factor.directions = schedule.directions.repeat(kinds.len());
        Self { factors: kinds, schedule: by_factor }
    }
}

/// Sums at one target.
struct CrownSum {
    total: f64,
    min: f64,
    days: u32,
}

impl CrownSum {
    fn over(days: &[(Vec<DayStretch>, f64)], lines: &[LineLight], sufficient: f64) -> Self {
        let mut sum = Self { total: 0.0, min: 24.0, days: 0 };
        let mut light = LightBefore::default();
        for (runs, factor) in days {
            light.set(lines, *factor);
            let hours = runs.iter().map(|run| f64::from(run.hours) * light.sum_between(run.first, run.end)).sum();
            sum.total += hours;
            sum.min = sum.min.min(hours);
            sum.days += u32::from(hours >= sufficient);
        }
        sum
    }
}

/// The light of all directions before each, so that a stretch of them is one difference.
#[derive(Default)]
struct LightBefore {
    factor: Option<f64>,
    sums: Vec<f64>,
}

impl LightBefore {
    fn set(&mut self, lines: &[LineLight], factor: f64) {
        if self.factor == Some(factor) {
            return;
        }
        self.factor = Some(factor);
        self.sums.clear();
        let mut sum = 0.0;
        self.sums.push(sum);
        self.sums.extend(lines.iter().map(|line| {
            sum += line.share(factor);
            sum
        }));
    }

    fn sum_between(&self, first: u32, end: u32) -> f64 {
        let before = |number: u32| self.sums.get(number as usize).copied().unwrap_or_default();
        before(end) - before(first)
    }
}
