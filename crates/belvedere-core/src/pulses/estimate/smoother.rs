//! The parts of a flight line made to agree.

use nalgebra::{Matrix3, Matrix6, Vector6};

use crate::pulses::line_path::{Knot, LONGEST_BRIDGE_S};

/// State of the scanner at a time: position and velocity, with their covariance.
#[derive(Clone, Debug)]
pub(super) struct ScannerState {
    /// Seconds.
    pub(super) time: f64,
    /// Local metres, metres per second.
    pub(super) state: Vector6<f64>,
    pub(super) covariance: Matrix6<f64>,
}

/// Smooths the estimates for the parts of a line at increasing `times`. The scanner may depart from a constant velocity
/// by white accelerations of the standard deviation `acceleration_sd`, metres per second squared over a second. `None`
/// where no estimate is near in time.
///
/// # Source
/// Rauch, Tung & Striebel 1965: the smoother of fixed interval, for a constant velocity disturbed by white
/// acceleration.
pub(super) fn smoothed(
    times: &[f64],
    estimates: &[Option<ScannerState>],
    acceleration_sd: f64,
) -> Vec<Option<ScannerState>> {
    let mut result = vec![None; times.len()];
    let known: Vec<usize> = (0..estimates.len().min(times.len())).filter(|&i| estimates[i].is_some()).collect();
    for chain in known.chunk_by(|&a, &b| times[b] - times[a] <= LONGEST_BRIDGE_S) {
        let (Some(&first), Some(&last)) = (chain.first(), chain.last()) else { continue };
        let near =
            |i: &usize| times[first] - times[*i] <= LONGEST_BRIDGE_S && times[*i] - times[last] <= LONGEST_BRIDGE_S;
        for (i, known) in smooth_chain(times, estimates, first..=last, acceleration_sd) {
            result[i] = Some(known);
        }
        let (start, end) = (result[first].clone(), result[last].clone());
        for i in (0..first).filter(near) {
            result[i] = more_certain(result[i].take(), start.as_ref(), times[i], acceleration_sd);
        }
        for i in (last + 1..times.len()).filter(near) {
            result[i] = more_certain(result[i].take(), end.as_ref(), times[i], acceleration_sd);
        }
    }
    result
}

/// Returns the state with the smaller position uncertainty: `there`, or `from` predicted to `time`.
fn more_certain(
    there: Option<ScannerState>,
    from: Option<&ScannerState>,
    time: f64,
    acceleration_sd: f64,
) -> Option<ScannerState> {
    let predicted = from.map(|known| known.predicted(time, acceleration_sd));
    let is_surer =
        |a: &ScannerState, b: &ScannerState| a.position_sd().iter().sum::<f64>() <= b.position_sd().iter().sum::<f64>();
    match (there, predicted) {
        (Some(a), Some(b)) => Some(if is_surer(&a, &b) { a } else { b }),
        (a, b) => a.or(b),
    }
}

/// The states of the parts `range`, of which the first and the last have an estimate.
fn smooth_chain(
    times: &[f64],
    estimates: &[Option<ScannerState>],
    range: std::ops::RangeInclusive<usize>,
    acceleration_sd: f64,
) -> Vec<(usize, ScannerState)> {
    let mut filtered: Vec<(usize, ScannerState)> = Vec::new();
    for i in range {
        let predicted = filtered.last().map(|(_, known)| known.predicted(times[i], acceleration_sd));
        let known = match (predicted, &estimates[i]) {
            (Some(predicted), Some(estimate)) => Some(predicted.joined_with(estimate)),
            (predicted, estimate) => predicted.or_else(|| estimate.clone()),
        };
        let Some(known) = known else { continue };
        filtered.push((i, known));
    }
    for i in (1..filtered.len()).rev() {
        let later = filtered[i].1.clone();
        let known = &filtered[i - 1].1;
        let step = transition(later.time - known.time);
        let predicted = known.predicted(later.time, acceleration_sd);
        let Some(inverse) = predicted.covariance.try_inverse() else { continue };
        let gain = known.covariance * step.transpose() * inverse;
        let covariance = known.covariance + gain * (later.covariance - predicted.covariance) * gain.transpose();
        let state = known.state + gain * (later.state - predicted.state);
        filtered[i - 1].1 = ScannerState { time: known.time, state, covariance: symmetric(&covariance) };
    }
    filtered
}

fn symmetric(matrix: &Matrix6<f64>) -> Matrix6<f64> {
    (matrix + matrix.transpose()) * 0.5
}

/// Returns the transition matrix of a constant velocity over `seconds`.
fn transition(seconds: f64) -> Matrix6<f64> {
    let mut matrix = Matrix6::identity();
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&(Matrix3::identity() * seconds));
    matrix
}

impl ScannerState {
    pub(super) fn to_knot(&self) -> Knot {
        Knot { time: self.time, position: self.position(), velocity: self.velocity() }
    }

    /// Local metres.
    pub(super) fn position(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.state[i])
    }

    /// Metres per second.
    pub(super) fn velocity(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.state[i + 3])
    }

    /// Standard deviation of the position, metres.
    pub(super) fn position_sd(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.covariance[(i, i)].max(0.0).sqrt())
    }

    /// This state predicted for `time`, which may be earlier or later.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn state_at(time: f64, x: f64, sd: f64) -> ScannerState {
        let state = Vector6::new(x, 0.0, 500.0, 60.0, 0.0, 0.0);
        ScannerState { time, state, covariance: Matrix6::identity() * sd * sd }
    }

    #[test]
    fn estimates_that_agree_keep_their_place_and_grow_surer() {
        let times = [0.0, 1.0, 2.0];
        let given = times.map(|t| Some(state_at(t, 60.0 * t, 1.0)));
        for (found, time) in smoothed(&times, &given, 1.0).into_iter().zip(times) {
            let found = found.unwrap();
            assert!((found.state[0] - 60.0 * time).abs() < 1e-9, "{found:?}");
            assert!(found.position_sd()[0] < 1.0, "{found:?}");
        }
    }

    #[test]
    fn parts_without_an_estimate_follow_their_neighbours_and_are_less_sure() {
        let times = [0.0, 5.0, 10.0, 15.0, 100.0];
        let given = [Some(state_at(0.0, 0.0, 1.0)), None, Some(state_at(10.0, 600.0, 1.0)), None, None];
        let found = smoothed(&times, &given, 1.0);
        assert!((found[1].as_ref().unwrap().state[0] - 300.0).abs() < 1e-6);
        assert!((found[3].as_ref().unwrap().state[0] - 900.0).abs() < 1e-6);
        let sd = |i: usize| found[i].as_ref().unwrap().position_sd()[0];
        assert!(sd(1) > sd(0) && sd(3) > sd(2));
        assert!(found[4].is_none(), "nobody knows where it was a minute and a half later");
    }
}
