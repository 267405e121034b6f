//! Quality of probabilities of being visible: error, calibration, and errors among the most certain.

use belvedere_data::cast::to_index;

/// Probabilities are counted by tenths.
const TENTHS: usize = 10;
/// Share of the answers that are the most certain ones.
const COVERAGE: f64 = 0.9;

/// Probabilities with the truth, summed up.
#[derive(Clone, Debug, Default)]
pub struct Calibration {
    /// Probability that the target is visible, and whether it is.
    pairs: Vec<(f32, bool)>,
}

/// Cases of a tenth of probability.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tenth {
    /// Number of cases.
    pub count: usize,
    /// Mean probability.
    pub expected: f64,
    /// Share that is visible.
    pub found: f64,
}

impl Calibration {
    /// Counts a case; one without a probability (NaN) is left out.
    pub fn add(&mut self, probability: f32, is_visible: bool) {
        if !probability.is_nan() {
            self.pairs.push((probability, is_visible));
        }
    }

    /// Counts all cases of another.
    pub fn extend(&mut self, other: &Self) {
        self.pairs.extend_from_slice(&other.pairs);
    }

    /// Number of cases.
    #[must_use]
    pub fn count(&self) -> usize {
        self.pairs.len()
    }

    /// Mean square of the difference between probability and truth, 0 to 1; NaN without cases.
    ///
    /// # Source
    /// Brier 1950.
    #[must_use]
    pub fn brier(&self) -> f64 {
        let square = |&(probability, is_visible): &(f32, bool)| {
            (f64::from(probability) - f64::from(u8::from(is_visible))).powi(2)
        };
        self.pairs.iter().map(square).sum::<f64>() / self.pairs.len() as f64
    }

    /// Cases by tenths of probability.
    #[must_use]
    pub fn tenths(&self) -> [Tenth; TENTHS] {
        let mut sums = [(0_usize, 0.0, 0.0); TENTHS];
        for &(probability, is_visible) in &self.pairs {
            let tenth = to_index(f64::from(probability * TENTHS as f32)).min(TENTHS - 1);
            let (count, expected, found) = &mut sums[tenth];
            *count += 1;
            *expected += f64::from(probability);
            *found += f64::from(u8::from(is_visible));
        }
        sums.map(|(count, expected, found)| {
            let share = |sum: f64| sum / count as f64;
            Tenth { count, expected: share(expected), found: share(found) }
        })
    }

    /// Mean difference between the probability and the share that is visible, over tenths of probability by their
    /// number of cases, 0 to 1: the expected calibration error.
    ///
    /// # Source
    /// Naeini, Cooper & Hauskrecht 2015.
    #[must_use]
    pub fn expected_error(&self) -> f64 {
        let of_tenth = |tenth: &Tenth| tenth.count as f64 * (tenth.expected - tenth.found).abs();
        self.tenths().iter().filter(|tenth| tenth.count > 0).map(of_tenth).sum::<f64>() / self.pairs.len() as f64
    }

    /// Share of wrong answers among the nine tenths that are the most certain, where the more likely of visible and
    /// blocked is the answer, 0 to 1. Of equally certain cases at the limit the mean counts.
    #[must_use]
    pub fn error_of_most_certain(&self) -> f64 {
        let certainty = |probability: f32| probability.max(1.0 - probability);
        let mut cases: Vec<(f32, bool)> =
            self.pairs.iter().map(|&(p, is_visible)| (certainty(p), (p >= 0.5) != is_visible)).collect();
        cases.sort_by(|a, b| b.0.total_cmp(&a.0));
        let wanted = COVERAGE * cases.len() as f64;
        let (mut taken, mut wrong) = (0.0, 0.0);
        for equal in cases.chunk_by(|a, b| a.0 == b.0) {
            let wrong_here = equal.iter().filter(|(_, is_wrong)| *is_wrong).count() as f64;
            let share = ((wanted - taken) / equal.len() as f64).clamp(0.0, 1.0);
            taken += share * equal.len() as f64;
            wrong += share * wrong_here;
        }
        wrong / taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_ten_cases_are_those_computed_by_hand() {
        let mut found = Calibration::default();
        // eight of 0.9, of which seven are visible; two of 0.4, of which one is
        (0..8).for_each(|i| found.add(0.9, i > 0));
        (0..2).for_each(|i| found.add(0.4, i > 0));
        found.add(f32::NAN, true);
        assert_eq!(found.count(), 10);
        let brier = (7.0 * 0.01 + 0.81 + 0.36 + 0.16) / 10.0;
        assert!((found.brier() - brier).abs() < 1e-7, "{}", found.brier());
        let tenths = found.tenths();
        assert_eq!((tenths[9].count, tenths[4].count), (8, 2));
        assert!((tenths[9].found - 0.875).abs() < 1e-12 && (tenths[4].found - 0.5).abs() < 1e-12);
        assert!((found.expected_error() - (8.0 * 0.025 + 2.0 * 0.1) / 10.0).abs() < 1e-7);
        // nine are the eight and half of the two: one wrong, and half of one
        assert!((found.error_of_most_certain() - 1.5 / 9.0).abs() < 1e-12);
    }
}
