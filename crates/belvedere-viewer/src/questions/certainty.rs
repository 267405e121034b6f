//! How sure the answers for many points are: a probability with each, and how many are certain.

use super::places::rounded;
use belvedere::Result;
use belvedere::apps::ask::HowSure;
use belvedere::query::Certainty;
use serde_json::{Value, json};

/// What is at least this likely counts as certain.
const CERTAIN_FROM: f64 = 0.9;
/// Byte of a probability of 1.
const SURE: f32 = 200.0;
/// Byte of an answer without a probability.
const NO_PROBABILITY: u8 = 255;

/// Probabilities of all answers where they are wanted.
pub(super) fn how_sure(is_wanted: bool) -> HowSure {
    HowSure { probability: is_wanted, certain: is_wanted.then_some(CERTAIN_FROM) }
}

#[expect(clippy::cast_possible_truncation, reason = "a probability is from 0 to 1")]
pub(super) fn byte_of(probability: f32) -> u8 {
    if probability.is_nan() { NO_PROBABILITY } else { (probability * SURE).round() as u8 }
}

/// How many answers are certain, by their probabilities of being visible or lit; what is unproven is not.
pub(super) fn certainty(probabilities: &[f32], is_unproven: impl Fn(usize) -> bool) -> Result<Value> {
    let limit = Certainty::new(CERTAIN_FROM)?;
    let [mut free, mut blocked, mut uncertain] = [0_usize; 3];
    for (row, &probability) in probabilities.iter().enumerate().filter(|(_, probability)| !probability.is_nan()) {
        let count = match () {
            () if limit.is_missed_by(probability) || is_unproven(row) => &mut uncertain,
            () if probability > 0.5 => &mut free,
            () => &mut blocked,
        };
        *count += 1;
    }
    Ok(json!({
        "certain_from": rounded(CERTAIN_FROM, 2),
        "free": free,
        "blocked": blocked,
        "uncertain": uncertain,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_likely_and_proven_is_certain() {
        let probabilities = [1.0, 0.95, 0.95, 0.89, 0.5, 0.1, 0.0, f32::NAN];
        let counts = certainty(&probabilities, |row| row == 2).unwrap();
        assert_eq!(counts, json!({ "certain_from": 0.9, "free": 2, "blocked": 2, "uncertain": 3 }));
        assert_eq!([0.0, 0.504, 1.0, f32::NAN].map(byte_of), [0, 101, 200, 255]);
    }
}
