//! Targets to cover, and the part that a selection of cameras covers.

use super::table::{CoverageTable, ones};
use belvedere_data::error::check_length;
use belvedere_data::{Error, Parameter, Result};

/// Shares of all weight that differ by less are equal: sums of a million rounded terms are this exact.
pub(super) const TOLERANCE: f64 = 1e-9;

/// Targets with their weights, and how many cameras each needs.
pub(super) struct Problem<'a> {
    pub(super) table: &'a CoverageTable,
    /// Worth of one more camera on a target: its share of all weight over the number of cameras that it needs.
    pub(super) worth: Vec<f64>,
    /// The same for all targets that count, if it is.
    even: Option<f64>,
    /// The targets that count, a bit each.
    counted: Vec<u64>,
    pub(super) required: u32,
}

impl<'a> Problem<'a> {
    pub(super) fn new(table: &'a CoverageTable, weights: &[f64], required: u32) -> Result<Self> {
        check_length("weights of targets", table.target_count(), weights.len())?;
        if required == 0 {
            return Err(Error::invalid(Parameter::RequiredCameras, required, "1 or more"));
        }
        if let Some(bad) = weights.iter().find(|w| !(w.is_finite() && **w >= 0.0)) {
            return Err(Error::invalid(Parameter::TargetWeight, bad, "a finite number, 0 or more"));
        }
        let whole: f64 = weights.iter().sum();
        if !(whole > 0.0) {
            return Err(Error::invalid(Parameter::TargetWeight, whole, "at least one target with a weight above 0"));
        }
        let worth: Vec<f64> = weights.iter().map(|w| w / whole / f64::from(required)).collect();
        let mut counted = vec![0; worth.len().div_ceil(64)];
        for target in (0..worth.len()).filter(|&target| worth[target] > 0.0) {
            counted[target / 64] |= 1 << (target % 64);
        }
        let first = worth.iter().copied().find(|w| *w > 0.0);
        let even = first.filter(|first| worth.iter().all(|w| w == first || *w == 0.0));
        Ok(Self { table, worth, even, counted, required })
    }

    /// Worth of the targets that are in both rows of bits, of which the second has none that does not count.
    fn worth_of(&self, row: &[u64], mask: &[u64]) -> f64 {
        match self.even {
            Some(worth) => {
                row.iter().zip(mask).map(|(a, b)| u64::from((a & b).count_ones())).sum::<u64>() as f64 * worth
            }
            None => {
                let words = row.iter().zip(mask).enumerate().filter(|(_, (a, b))| **a & **b != 0);
                words.flat_map(|(word, (a, b))| ones(word, a & b)).map(|target| self.worth[target]).sum()
            }
        }
    }

    /// Returns the minimum difference of two values that are not equal.
    fn step(&self) -> f64 {
        self.even.unwrap_or(0.0)
    }

    /// Returns true if a selection of at most `bound` can be better than `best`.
    pub(super) fn is_better(&self, bound: f64, best: f64) -> bool {
        bound > best + (self.step() - TOLERANCE).max(TOLERANCE)
    }

    /// The largest value that is not above `bound`.
    pub(super) fn rounded_down(&self, bound: f64) -> f64 {
        match self.even {
            Some(step) if step > 4.0 * TOLERANCE => ((bound + TOLERANCE) / step).floor() * step,
            _ => bound,
        }
    }
}

/// Cameras, and how many of them cover each target.
#[derive(Clone)]
pub(super) struct CameraSelection<'a> {
    pub(super) problem: &'a Problem<'a>,
    pub(super) chosen: Vec<usize>,
    pub(super) counts: Vec<u32>,
    /// Targets that count and have too few cameras yet.
    open: Vec<u64>,
}

impl<'a> CameraSelection<'a> {
    pub(super) fn of(problem: &'a Problem<'a>, cameras: &[usize]) -> Self {
        let counts = vec![0; problem.worth.len()];
        let mut selection = Self { problem, chosen: Vec::new(), counts, open: problem.counted.clone() };
        cameras.iter().for_each(|&camera| selection.add(camera));
        selection
    }

    /// Share of all weight that is covered; a target with fewer cameras than it needs counts in proportion.
    pub(super) fn value(&self) -> f64 {
        let capped = |(count, worth): (&u32, &f64)| f64::from((*count).min(self.problem.required)) * worth;
        match self.problem.even {
            Some(even) => {
                let counted = self.counts.iter().zip(&self.problem.worth).filter(|(_, worth)| **worth > 0.0);
                counted.map(|(count, _)| u64::from((*count).min(self.problem.required))).sum::<u64>() as f64 * even
            }
            None => self.counts.iter().zip(&self.problem.worth).map(capped).sum(),
        }
    }

    /// Returns the worth that a camera adds.
    pub(super) fn gain(&self, camera: usize) -> f64 {
        self.problem.worth_of(self.problem.table.row(camera), &self.open)
    }

    pub(super) fn add(&mut self, camera: usize) {
        for target in self.problem.table.covered_by(camera) {
            self.counts[target] += 1;
            if self.counts[target] >= self.problem.required {
                self.open[target / 64] &= !(1 << (target % 64));
            }
        }
        self.chosen.push(camera);
    }

    /// Takes out the camera at a place of the list.
    pub(super) fn remove(&mut self, place: usize) {
        let camera = self.chosen.swap_remove(place);
        for target in self.problem.table.covered_by(camera) {
            self.counts[target] -= 1;
            if self.counts[target] < self.problem.required && self.problem.worth[target] > 0.0 {
                self.open[target / 64] |= 1 << (target % 64);
            }
        }
    }

    /// Returns the worth that is lost without a chosen camera.
    pub(super) fn loss(&self, camera: usize) -> Loss {
        let required = self.problem.required;
        let mut loss = Loss { worth: 0.0, tight_worth: 0.0, tight: Vec::new() };
        for target in self.problem.table.covered_by(camera).filter(|&target| self.problem.worth[target] > 0.0) {
            if self.counts[target] > required {
                continue;
            }
            loss.worth += self.problem.worth[target];
            if self.counts[target] == required {
                loss.tight_worth += self.problem.worth[target];
                let (word, bit) = (target / 64, 1 << (target % 64));
                match loss.tight.last_mut() {
                    Some((last, bits)) if *last == word => *bits |= bit,
                    _ => loss.tight.push((word, bit)),
                }
            }
        }
        loss
    }

    /// Returns the part of a loss that another camera saves.
    pub(super) fn saved(&self, camera: usize, loss: &Loss) -> f64 {
        let row = self.problem.table.row(camera);
        let common = loss.tight.iter().map(|&(word, bits)| (word, row[word] & bits)).filter(|(_, bits)| *bits != 0);
        match self.problem.even {
            Some(even) => common.map(|(_, bits)| u64::from(bits.count_ones())).sum::<u64>() as f64 * even,
            None => common.flat_map(|(word, bits)| ones(word, bits)).map(|target| self.problem.worth[target]).sum(),
        }
    }
}

/// Loss from removing a camera.
pub(super) struct Loss {
    pub(super) worth: f64,
    /// Worth of the targets that have just the cameras they need: another camera could save them.
    pub(super) tight_worth: f64,
    /// Words of their bits that are not empty, with their place.
    tight: Vec<(usize, u64)>,
}
