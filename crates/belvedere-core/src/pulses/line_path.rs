//! The path of a scanner along a flight line, from estimates for its parts.

use super::scanner_report::FoundBy;
use nalgebra::{Matrix3, Matrix6, Vector6};

/// Where the scanner was along a flight line, and when that is known.
#[derive(Clone, Debug)]
pub struct LinePath {
    /// Flight line; 0 where the cloud names none.
    pub source_id: u16,
    /// What it was found by.
    pub means: FoundBy,
    /// The times at which it is known, increasing.
    pub stretches: Vec<Stretch>,
    knots: Vec<Knot>,
}

/// A stretch of time over which the scanner's path is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// First and last, seconds.
    pub times: [f64; 2],
    /// Standard deviation of the positions, metres.
    pub position_sd: [f64; 3],
    /// Median angle between the pulses and the directions to the path, radians; NaN where no pulse of this stretch tells.
    pub median_angle: f64,
}

impl LinePath {
    /// The path through `knots`, which increase in time, over `stretches`.
    pub(super) fn new(source_id: u16, means: FoundBy, stretches: Vec<Stretch>, knots: Vec<Knot>) -> Self {
        Self { source_id, means, stretches, knots }
    }

    /// The stretch that `time` lies in.
    #[must_use]
    pub fn stretch_at(&self, time: f64) -> Option<&Stretch> {
        let after = self.stretches.partition_point(|stretch| stretch.times[0] <= time);
        self.stretches.get(after.checked_sub(1)?).filter(|stretch| time <= stretch.times[1])
    }

    /// Local position of the scanner at `time`, metres; `None` outside the stretches over which it is known.
    #[must_use]
    pub fn position_at(&self, time: f64) -> Option<[f64; 3]> {
        self.stretch_at(time)?;
        position_at(&self.knots, time)
    }
}

/// The path among `paths`, which are in order of their lines, that knows the scanner of `line` at `time`, the first of several,
/// and its local position, metres.
pub(super) fn position_on(paths: &[LinePath], line: u16, time: f64) -> Option<(&LinePath, [f64; 3])> {
    let start = paths.partition_point(|path| path.source_id < line);
    let of_line = paths.get(start..)?.iter().take_while(|path| path.source_id == line);
    of_line.filter_map(|path| Some((path, path.position_at(time)?))).next()
}

/// Parts farther apart than this are smoothed apart, seconds: aircraft do not hold their course for longer.
const LONGEST_BRIDGE_S: f64 = 30.0;

/// What is known of the scanner at a time: position then velocity, and their covariance.
#[derive(Clone, Debug)]
pub(super) struct Knot {
    /// Seconds.
    pub(super) time: f64,
    /// Local metres, metres per second.
    pub(super) state: Vector6<f64>,
    pub(super) covariance: Matrix6<f64>,
}

/// The estimates for the parts of a line at increasing `times`, made to agree: each with what the others say of it, as far as
/// accelerations of the deviation `acceleration_sd` (metres per second squared, white over a second) leave it. `None` where
/// no estimate is near in time.
///
/// # Source
/// Rauch, Tung & Striebel 1965: the smoother of fixed interval, for a constant velocity disturbed by white acceleration.
pub(super) fn smoothed(times: &[f64], estimates: &[Option<Knot>], acceleration_sd: f64) -> Vec<Option<Knot>> {
    let mut result = vec![None; times.len()];
    let known: Vec<usize> = (0..estimates.len().min(times.len())).filter(|&i| estimates[i].is_some()).collect();
    for chain in known.chunk_by(|&a, &b| times[b] - times[a] <= LONGEST_BRIDGE_S) {
        let (Some(&first), Some(&last)) = (chain.first(), chain.last()) else { continue };
        let near =
            |i: &usize| times[first] - times[*i] <= LONGEST_BRIDGE_S && times[*i] - times[last] <= LONGEST_BRIDGE_S;
        for (i, knot) in smooth_chain(times, estimates, first..=last, acceleration_sd) {
            result[i] = Some(knot);
        }
        let (start, end) = (result[first].clone(), result[last].clone());
        for i in (0..first).filter(near) {
            result[i] = nearer(result[i].take(), start.as_ref(), times[i], acceleration_sd);
        }
        for i in (last + 1..times.len()).filter(near) {
            result[i] = nearer(result[i].take(), end.as_ref(), times[i], acceleration_sd);
        }
    }
    result
}

/// What `from` says of `time`, unless something surer is there.
fn nearer(there: Option<Knot>, from: Option<&Knot>, time: f64, acceleration_sd: f64) -> Option<Knot> {
    let predicted = from.map(|knot| knot.predicted(time, acceleration_sd));
    let is_surer = |a: &Knot, b: &Knot| a.position_sd().iter().sum::<f64>() <= b.position_sd().iter().sum::<f64>();
    match (there, predicted) {
        (Some(a), Some(b)) => Some(if is_surer(&a, &b) { a } else { b }),
        (a, b) => a.or(b),
    }
}

/// The knots of the parts `range`, of which the first and the last have an estimate.
fn smooth_chain(
    times: &[f64],
    estimates: &[Option<Knot>],
    range: std::ops::RangeInclusive<usize>,
    acceleration_sd: f64,
) -> Vec<(usize, Knot)> {
    let mut filtered: Vec<(usize, Knot)> = Vec::new();
    for i in range {
        let predicted = filtered.last().map(|(_, knot)| knot.predicted(times[i], acceleration_sd));
        let knot = match (predicted, &estimates[i]) {
            (Some(predicted), Some(estimate)) => Some(predicted.joined_with(estimate)),
            (predicted, estimate) => predicted.or_else(|| estimate.clone()),
        };
        let Some(knot) = knot else { continue };
        filtered.push((i, knot));
    }
    for i in (1..filtered.len()).rev() {
        let later = filtered[i].1.clone();
        let knot = &filtered[i - 1].1;
        let step = transition(later.time - knot.time);
        let predicted = knot.predicted(later.time, acceleration_sd);
        let Some(inverse) = predicted.covariance.try_inverse() else { continue };
        let gain = knot.covariance * step.transpose() * inverse;
        let covariance = knot.covariance + gain * (later.covariance - predicted.covariance) * gain.transpose();
        let state = knot.state + gain * (later.state - predicted.state);
        filtered[i - 1].1 = Knot { time: knot.time, state, covariance: symmetric(&covariance) };
    }
    filtered
}

fn symmetric(matrix: &Matrix6<f64>) -> Matrix6<f64> {
    (matrix + matrix.transpose()) * 0.5
}

/// What a state becomes after `seconds` at constant velocity.
fn transition(seconds: f64) -> Matrix6<f64> {
    let mut matrix = Matrix6::identity();
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&(Matrix3::identity() * seconds));
    matrix
}

impl Knot {
    /// Standard deviation of the position, metres.
    pub(super) fn position_sd(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.covariance[(i, i)].max(0.0).sqrt())
    }

    /// The same at `time`, before or after.
    fn predicted(&self, time: f64, acceleration_sd: f64) -> Self {
        let seconds = time - self.time;
        let step = transition(seconds);
        let (size, power) = (seconds.abs(), acceleration_sd.powi(2));
        let mut noise = Matrix6::zeros();
        for i in 0..3 {
            noise[(i, i)] = power * size.powi(3) / 3.0;
            noise[(i + 3, i + 3)] = power * size;
            noise[(i, i + 3)] = power * seconds * size / 2.0;
            noise[(i + 3, i)] = noise[(i, i + 3)];
        }
        let covariance = symmetric(&(step * self.covariance * step.transpose() + noise));
        Self { time, state: step * self.state, covariance }
    }

    /// This, and an `estimate` of the same time that knows nothing of it.
    fn joined_with(self, estimate: &Self) -> Self {
        let Some(inverse) = (self.covariance + estimate.covariance).try_inverse() else { return estimate.clone() };
        let gain = self.covariance * inverse;
        let state = self.state + gain * (estimate.state - self.state);
        let covariance = symmetric(&(gain * estimate.covariance));
        Self { time: self.time, state, covariance }
    }
}

/// Local position at `time` on the path through `knots`, which increase in time; `None` without any. Between knots a cubic with
/// their velocities; beyond them, and where the next is half a minute away, straight on from the nearer.
fn position_at(knots: &[Knot], time: f64) -> Option<[f64; 3]> {
    let after = knots.partition_point(|knot| knot.time <= time);
    let before = after.checked_sub(1).and_then(|i| knots.get(i));
    let straight_on = |knot: &Knot| std::array::from_fn(|i| knot.state[i] + knot.state[i + 3] * (time - knot.time));
    let (Some(a), Some(b)) = (before, knots.get(after)) else {
        return before.or_else(|| knots.get(after)).map(straight_on);
    };
    let span = b.time - a.time;
    if span > LONGEST_BRIDGE_S {
        return Some(straight_on(if time - a.time < b.time - time { a } else { b }));
    }
    let s = (time - a.time) / span;
    let (s2, s3) = (s * s, s * s * s);
    Some(std::array::from_fn(|i| {
        let (from, to) = (a.state[i + 3] * span, b.state[i + 3] * span);
        a.state[i] + (3.0 * s2 - 2.0 * s3) * (b.state[i] - a.state[i]) + (s3 - 2.0 * s2 + s) * from + (s3 - s2) * to
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knot(time: f64, x: f64, sd: f64) -> Knot {
        let state = Vector6::new(x, 0.0, 500.0, 60.0, 0.0, 0.0);
        Knot { time, state, covariance: Matrix6::identity() * sd * sd }
    }

    #[test]
    fn estimates_that_agree_keep_their_place_and_grow_surer() {
        let times = [0.0, 1.0, 2.0];
        let given = times.map(|t| Some(knot(t, 60.0 * t, 1.0)));
        for (found, time) in smoothed(&times, &given, 1.0).into_iter().zip(times) {
            let found = found.unwrap();
            assert!((found.state[0] - 60.0 * time).abs() < 1e-9, "{found:?}");
            assert!(found.position_sd()[0] < 1.0, "{found:?}");
        }
    }

    #[test]
    fn parts_without_an_estimate_follow_their_neighbours_and_are_less_sure() {
        let times = [0.0, 5.0, 10.0, 15.0, 100.0];
        let given = [Some(knot(0.0, 0.0, 1.0)), None, Some(knot(10.0, 600.0, 1.0)), None, None];
        let found = smoothed(&times, &given, 1.0);
        assert!((found[1].as_ref().unwrap().state[0] - 300.0).abs() < 1e-6);
        assert!((found[3].as_ref().unwrap().state[0] - 900.0).abs() < 1e-6);
        let sd = |i: usize| found[i].as_ref().unwrap().position_sd()[0];
        assert!(sd(1) > sd(0) && sd(3) > sd(2));
        assert!(found[4].is_none(), "nobody knows where it was a minute and a half later");
    }

    #[test]
    fn the_path_runs_through_its_knots_and_straight_on_beyond() {
        let knots = [knot(0.0, 0.0, 1.0), knot(2.0, 120.0, 1.0)];
        for time in [-1.0, 0.0, 0.7, 2.0, 3.0] {
            let [x, y, z] = position_at(&knots, time).unwrap();
            assert!((x - 60.0 * time).abs() < 1e-9 && y.abs() < 1e-9 && (z - 500.0).abs() < 1e-9, "{time}: {x}");
        }
        assert_eq!(position_at(&[], 0.0), None);
    }
}
