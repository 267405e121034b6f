//! Stretches of light: steps that follow each other are counted at once, so that a day costs as much as the sun comes
//! and goes.

use crate::sun::DayOfLight;

/// Maximum difference of equally long steps, hours: the rounding of f32 in differences of hours of a day.
const EQUAL: f32 = 1e-5;

/// Steps of a day that follow each other without gap, are equally long and have directions that follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DayStretch {
    /// Direction of the first step.
    pub(super) first: u32,
    /// One beyond the direction of the last.
    pub(super) end: u32,
    /// Hours on the clocks at its beginning.
    pub(super) start: f32,
    /// Hours of a step.
    pub(super) hours: f32,
    /// True if it begins where the run before it ended.
    pub(super) continues: bool,
}

/// The runs that make up a day.
pub(super) fn runs_of(day: &DayOfLight) -> Vec<DayStretch> {
    let mut runs: Vec<DayStretch> = Vec::new();
    for step in &day.steps {
        match runs.last_mut() {
            Some(run) if step.continues && step.direction == run.end && (step.hours - run.hours).abs() < EQUAL => {
                run.end += 1;
            }
            _ => runs.push(DayStretch {
                first: step.direction,
                end: step.direction + 1,
                start: step.start,
                hours: step.hours,
                continues: step.continues,
            }),
        }
    }
    runs
}

/// Bit masks of the directions that light a target, and the place of the next change.
pub(super) struct Lit {
    /// For each direction the next that is lit, itself included; the number of directions where there is none.
    lit: Vec<u32>,
    /// The same for the next that is dark.
    dark: Vec<u32>,
}

impl Lit {
    /// For so many directions, all dark.
    pub(super) fn new(count: usize) -> Self {
        Self { lit: vec![u32::MAX; count], dark: vec![0; count] }
    }

    /// Asks `is_lit` of each direction.
    pub(super) fn set(&mut self, is_lit: impl Fn(usize) -> bool) {
        let [mut lit, mut dark] = [u32::MAX; 2];
        let mut number = u32::try_from(self.lit.len()).unwrap_or(u32::MAX);
        for (place, (next_lit, next_dark)) in self.lit.iter_mut().zip(&mut self.dark).enumerate().rev() {
            number = number.saturating_sub(1);
            if is_lit(place) {
                lit = number;
            } else {
                dark = number;
            }
            (*next_lit, *next_dark) = (lit, dark);
        }
    }

    /// The next direction from `number` on that is lit; beyond all where there is none.
    pub(super) fn next_lit(&self, number: u32) -> u32 {
        self.lit.get(number as usize).copied().unwrap_or(u32::MAX)
    }

    /// The next direction from `number` on that is dark; beyond all where there is none.
    pub(super) fn next_dark(&self, number: u32) -> u32 {
        self.dark.get(number as usize).copied().unwrap_or(u32::MAX)
    }
}
