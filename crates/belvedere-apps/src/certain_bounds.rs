//! Ends of intervals along a way on which what is seen becomes what is not: an elevation along an azimuth, a range
//! along a ray.
//!
//! The probability that a place is visible falls along such a way. Where it passes 95 % and 5 %, the truth is likely to
//! lie between.

/// Probabilities of what is nearly certain, and of what nearly cannot be.
pub(crate) const LIKELY: f32 = 0.95;
pub(crate) const UNLIKELY: f32 = 0.05;
/// Halvings after steps that double: a sixteenth of the last step is not separated.
const HALVINGS: usize = 4;

/// The first place from `from` on that `is_certain`, on the way to `limit`, which ends it: in steps that begin with
/// `step`, above 0, and double, and then by halving the last of them.
pub(crate) fn first_certain(from: f64, step: f64, limit: f64, is_certain: impl Fn(f64) -> bool) -> f64 {
    if is_certain(from) {
        return from;
    }
    let all = (limit - from).abs();
    let at = |away: f64| from + away.copysign(limit - from);
    let (mut open, mut away) = (0.0, step);
    while away < all && !is_certain(at(away)) {
        open = away;
        away *= 2.0;
    }
    let mut certain = away.min(all);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(open, certain);
        *(if is_certain(at(middle)) { &mut certain } else { &mut open }) = middle;
    }
    at(certain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_certain_place_is_found_to_a_sixteenth_of_the_last_step() {
        for bound in [0.0, 0.3, 1.0, 5.5, 40.0] {
            let up = first_certain(0.0, 0.25, 90.0, |at| at >= bound);
            assert!(up >= bound && up - bound <= bound.max(0.25) / 16.0, "{bound} {up}");
            let down = first_certain(0.0, 0.25, -90.0, |at| at <= -bound);
            assert_eq!(down, -up);
        }
        assert_eq!(first_certain(3.0, 0.25, 10.0, |_| false), 10.0);
        assert_eq!(first_certain(10.0, 0.25, 10.0, |_| false), 10.0);
    }
}
