//! Numbers of reports as a reader wants them.

use crate::cast::to_i64;

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

/// Hours of the day as HH:MM, rounded to the minute; hours before it and after it are those of the days beside it.
#[must_use]
pub fn clock_time(hours: f64) -> String {
    let minutes = to_i64((hours * 60.0).round());
    format!("{:02}:{:02}", minutes.div_euclid(60).rem_euclid(24), minutes.rem_euclid(60))
}

/// A number of things in words, such as "1 tile" and "2 tiles". `thing` has its plural with an s.
#[must_use]
pub fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_go_round() {
        assert_eq!([9.5, 7.999, 24.2, -0.25].map(clock_time), ["09:30", "08:00", "00:12", "23:45"]);
    }

    #[test]
    fn numbers_are_rounded_half_away_from_zero_and_zero_has_no_sign() {
        assert_eq!([rounded(2.345, 1), rounded(-0.04, 1), rounded(12.5, 0)], [2.3, 0.0, 13.0]);
        assert!(rounded(-0.04, 1).is_sign_positive() && rounded(f64::NAN, 2).is_nan());
        assert_eq!([percent(1, 3), percent(0, 0), percent(7, 7)], [33.33, 0.0, 100.0]);
    }
}
