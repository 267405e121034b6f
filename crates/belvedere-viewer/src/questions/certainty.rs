//! Certainty of the answers for many points: a probability for each.

use belvedere::apps::ask::HowSure;
use belvedere::cast::to_u8;

/// Minimum probability of a certain answer.
const CERTAIN_FROM: f64 = 0.9;
/// Byte of a probability of 1.
const SURE: f32 = 200.0;
/// Byte of an answer without a probability.
const NO_PROBABILITY: u8 = 255;

/// Probabilities of all answers where they are wanted.
pub(super) fn how_sure(is_wanted: bool) -> HowSure {
    HowSure { probability: is_wanted, certain: is_wanted.then_some(CERTAIN_FROM) }
}

pub(super) fn byte_of(probability: f32) -> u8 {
    if probability.is_nan() { NO_PROBABILITY } else { to_u8(f64::from((probability * SURE).round())) }
}

#[cfg(test)]
mod tests {
    use super::byte_of;

    #[test]
    fn probabilities_are_sent_in_steps_of_a_200th() {
        assert_eq!([0.0, 0.504, 1.0, f32::NAN].map(byte_of), [0, 101, 200, 255]);
    }
}
