//! Directions that represent the suns of many days: the cost grows with the directions, not with the instants.

use super::{Date, SunDay, declination};
use belvedere_data::cast::{to_row, to_u32};
use belvedere_data::vector::{dot, to_f32, unit};
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Maximum number of steps with a direction each, by default of [`SunSchedule::new`].
const MAX_EXACT: usize = 2000;
/// Angle within which a direction represents others where it is left to [`SunSchedule::new`]: 1°, two diameters of the
/// sun.
const USUAL_ANGLE: f64 = 0.017_453_292_519_943_295;

/// Rule by which suns that stand close together share a direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Binning {
    /// Each step its own direction up to 2000 steps, which is about a month at 10 minutes; beyond, as within 1°.
    #[default]
    Auto,
    /// Each step its own direction.
    Exact,
    /// Suns of different days at the same hour angle share a direction that is nowhere farther from them than this
    /// angle, radians, above 0 to 5°.
    Within(f64),
}

/// A step of a day, and the direction that represents its sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightStep {
    /// Hours on the clocks of the zone at its beginning, from the beginning of the date.
    pub start: f32,
    /// Hours that it lasts.
    pub hours: f32,
    /// Row of the direction.
    pub direction: u32,
    /// True if it begins where the step before it ended.
    pub continues: bool,
}

impl LightStep {
    /// Hours on the clocks halfway, where the sun of the step stands.
    #[must_use]
    pub fn middle(&self) -> f64 {
        f64::from(self.start) + f64::from(self.hours) / 2.0
    }
}

/// The light of a day.
#[derive(Clone, Debug, PartialEq)]
pub struct DayOfLight {
    /// Its date.
    pub date: Date,
    /// Its steps in the order of time.
    pub steps: Vec<LightStep>,
    /// Hours that they last together.
    pub possible_hours: f64,
}

/// Days of light, and the directions that represent their suns.
#[derive(Clone, Debug, PartialEq)]
pub struct SunSchedule {
    /// The days, in the order given.
    pub days: Vec<DayOfLight>,
    /// Unit vectors to the sun in the axes of the grid, (D, 3).
    pub directions: Vec<[f64; 3]>,
    /// Maximum angle between a sun and the direction that represents it, radians; 0 where each has its own.
    pub greatest_error: f64,
    /// Root of the mean squared angle, each step counting by its length, radians.
    pub rms_error: f64,
}

/// A sun among those that may share a direction.
struct Member {
    day: usize,
    step: usize,
    direction: [f64; 3],
    hours: f64,
}

impl SunSchedule {
    /// The schedule of `days`, whose steps must have been cut alike (with the same step) for suns to be shared.
    ///
    /// Directions are shared by rows of declination, which the sun passes twice a year, at the same step from noon,
    /// hence the same hour angle. In a row no wider than twice the angle the mean of the suns is within the angle of
    /// them all, except for steps that the horizon shortens. Suns farther away get a direction of their own.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for an angle outside its range, and where there is no day.
    pub fn new(days: &[SunDay], binning: Binning) -> Result<Self> {
        if days.is_empty() {
            let expected = "at least one day, and the last day not before the first";
            return Err(Error::invalid(Parameter::Period, "0", expected));
        }
        let step_count: usize = days.iter().map(|day| day.steps.len()).sum();
        let angle = match binning {
            Binning::Exact => None,
            Binning::Auto => (step_count > MAX_EXACT).then_some(USUAL_ANGLE),
            Binning::Within(angle) => Some(checked(angle)?),
        };
        let mut schedule = Self {
            days: days.iter().map(of_day).collect(),
            directions: Vec::new(),
            greatest_error: 0.0,
            rms_error: 0.0,
        };
        match angle {
            None => {
                for (day, light) in days.iter().zip(&mut schedule.days) {
                    for (step, light) in day.steps.iter().zip(&mut light.steps) {
                        light.direction = to_row(schedule.directions.len());
                        schedule.directions.push(step.direction);
                    }
                }
            }
            Some(angle) => schedule.share(days, angle)?,
        }
        Ok(schedule)
    }

    /// Azimuth clockwise from grid north, 0 to 2π, and elevation of a direction, radians; NaN for one that is not
    /// there.
    #[must_use]
    pub fn grid_azimuth_and_elevation(&self, direction: usize) -> [f64; 2] {
        let Some(&[east, north, up]) = self.directions.get(direction) else { return [f64::NAN; 2] };
        [east.atan2(north).rem_euclid(TAU), up.clamp(-1.0, 1.0).asin()]
    }

    /// Hours that the suns of each direction last together, (D).
    #[must_use]
    pub fn hours_of_directions(&self) -> Vec<f64> {
        let mut hours = vec![0.0; self.directions.len()];
        for step in self.days.iter().flat_map(|day| &day.steps) {
            if let Some(sum) = hours.get_mut(step.direction as usize) {
                *sum += f64::from(step.hours);
            }
        }
        hours
    }

    /// Hours during which the sun is up, over all days.
    #[must_use]
    pub fn possible_hours(&self) -> f64 {
        self.days.iter().map(|day| day.possible_hours).sum()
    }

    /// For each direction the hours that it represents.
    #[must_use]
    pub fn hours(&self) -> Vec<f64> {
        let mut hours = vec![0.0; self.directions.len()];
        for step in self.days.iter().flat_map(|day| &day.steps) {
            hours[step.direction as usize] += f64::from(step.hours);
        }
        hours
    }

    fn share(&mut self, days: &[SunDay], angle: f64) -> Result<()> {
        let declinations: Vec<f64> = days.iter().map(|day| declination(day.noon)).collect::<Result<_>>()?;
        let [low, high] = [f64::min, f64::max].map(|pick| declinations.iter().copied().reduce(pick).unwrap_or(0.0));
        let row_count = ((high - low) / (2.0 * angle)).ceil().max(1.0);
        let mut members: Vec<((u32, u32), Member)> = Vec::new();
        for (day, (light, declination)) in days.iter().zip(&declinations).enumerate() {
            let share = if high > low { (declination - low) / (high - low) } else { 0.0 };
            let strip = to_u32((share * row_count).min(row_count - 1.0));
            members.extend(light.steps.iter().enumerate().map(|(step, sun)| {
                let hours = (sun.end - sun.start) / 3600.0;
                ((strip, sun.number), Member { day, step, direction: sun.direction, hours })
            }));
        }
        members.sort_by_key(|(key, member)| (*key, member.day, member.step));
        let [mut squares, mut weights] = [0.0, 0.0];
        // by row, by how many directions the step has already, by step: so most steps of a day have directions in one
        // run
        let mut places: Vec<(u32, u32, u32)> = Vec::new();
        for shared in members.chunk_by(|a, b| a.0 == b.0) {
            let mut left: Vec<&Member> = shared.iter().map(|(_, member)| member).collect();
            let mut turn = 0;
            while let Some(first) = left.first() {
                let sum = left.iter().fold([0.0; 3], |sum, m| [0, 1, 2].map(|i| sum[i] + m.hours * m.direction[i]));
                let mut direction = unit(sum).unwrap_or(first.direction);
                if !left.iter().any(|member| angle_between(member.direction, direction) <= angle) {
                    direction = first.direction;
                }
                let number = to_row(self.directions.len());
                self.directions.push(direction);
                let (strip, step) = shared[0].0;
                places.push((strip, turn, step));
                turn += 1;
                left.retain(|member| {
                    let error = angle_between(member.direction, direction);
                    if error <= angle {
                        self.days[member.day].steps[member.step].direction = number;
                        self.greatest_error = self.greatest_error.max(error);
                        squares += member.hours * error * error;
                        weights += member.hours;
                    }
                    error > angle
                });
            }
        }
        if weights > 0.0 {
            self.rms_error = f64::sqrt(squares / weights);
        }
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_by_key(|&number| places[number]);
        self.directions = order.iter().map(|&number| self.directions[number]).collect();
        let mut renumbered = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            renumbered[old] = to_row(new);
        }
        for step in self.days.iter_mut().flat_map(|day| &mut day.steps) {
            step.direction = renumbered[step.direction as usize];
        }
        Ok(())
    }
}

fn of_day(day: &SunDay) -> DayOfLight {
    let steps = day
        .steps
        .iter()
        .enumerate()
        .map(|(i, step)| LightStep {
            start: to_f32(day.clock_hours(step.start)),
            hours: to_f32((step.end - step.start) / 3600.0),
            direction: 0,
            continues: i > 0 && step.start - day.steps[i - 1].end < 1.0,
        })
        .collect();
    DayOfLight { date: day.date, steps, possible_hours: day.possible_hours() }
}

fn checked(angle: f64) -> Result<f64> {
    if angle > 0.0 && angle <= 5f64.to_radians() {
        return Ok(angle);
    }
    Err(Error::invalid(Parameter::SunTolerance, angle.to_degrees().to_string(), "above 0 to 5 degrees"))
}

/// Angle between unit vectors, exact for small ones, radians.
fn angle_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    let apart = belvedere_data::vector::sub(a, b);
    2.0 * (0.5 * dot(apart, apart).sqrt()).min(1.0).asin()
}
