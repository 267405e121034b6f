//! Rounding of the numbers of reports for a reader.

/// `value` with `digits` decimals; a value that is not finite stays as it is. Zero has no sign.
#[must_use]
pub fn rounded(value: f64, digits: i32) -> f64 {
    let scale = 10f64.powi(digits);
    let rounded = (value * scale).round() / scale + 0.0;
    if rounded.is_finite() { rounded } else { value }
}

/// `part` as a percentage of `whole` with two decimals; 0 where the whole is 0.
#[must_use]
pub fn percent(part: usize, whole: usize) -> f64 {
    rounded(100.0 * part as f64 / whole.max(1) as f64, 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_half_away_from_zero_and_zero_has_no_sign() {
        assert_eq!([rounded(2.345, 1), rounded(-0.04, 1), rounded(12.5, 0)], [2.3, 0.0, 13.0]);
        assert!(rounded(-0.04, 1).is_sign_positive() && rounded(f64::NAN, 2).is_nan());
        assert_eq!([percent(1, 3), percent(0, 0), percent(7, 7)], [33.33, 0.0, 100.0]);
    }
}
