//! Position and velocity of a scanner from the lines that its pulses lie on.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Rounds of improvement and reweighting; from the linear first guess, which may lie at half the height, six settle.
const ROUNDS: usize = 8;
/// Misses beyond so many deviations count less (Huber): most of a clean set, two components together, lies within.
const HUBER_DEVIATIONS: f64 = 2.0;
/// Median length of a miss whose two components have deviation 1 (Rayleigh).
const RAYLEIGH_MEDIAN: f64 = 1.177_41;

/// First and last return of a pulse.
pub(super) struct ReturnPair {
    pub(super) first: Vector3<f64>,
    /// Vector from the first to the last.
    pub(super) along: Vector3<f64>,
    /// Seconds after the middle of the part.
    pub(super) since: f64,
}

/// Fitted state of the scanner over a part of a flight line.
pub(super) struct SensorFit {
    /// Position half-way in time, local metres, then velocity, metres per second.
    pub(super) state: Vector6<f64>,
    /// Covariance of the state, from the residuals.
    pub(super) covariance: Matrix6<f64>,
    /// Between the pulses and the directions to the path, radians.
    pub(super) median_angle: f64,
}

/// Position and velocity for which the last returns of `pairs` lie nearest to the lines from the scanner through the
/// first ones, or `None` where they fix none.
///
/// Fits the scanner state in two stages. The first guess minimises the distance of the lines from the scanner, which is
/// linear, and lies too near: a line with a wrong direction misses a far scanner by more. Rounds of Gauss-Newton then
/// minimise the distance at the last return, where the error is. It is measured across the direction from the scanner:
/// the error of the measured pulse would pull the scanner towards the ground.
pub(super) fn fit(pairs: &[ReturnPair], vertical_speed_sd: f64) -> Option<SensorFit> {
    let mut start = PathEquations::default();
    for pair in pairs {
        // across the measured pulse, weighted with the square of its length
        let weighted = Matrix3::identity() * pair.along.norm_squared() - pair.along * pair.along.transpose();
        start.add(&weighted, &(weighted * pair.first), pair.since);
    }
    let mut state = start.normal.cholesky()?.solve(&start.right);
    let mut covariance = Matrix6::zeros();
    for _ in 0..ROUNDS {
        let misses: Vec<Miss> = pairs.iter().map(|pair| pair.miss(&state)).collect();
        let trust = trust(&misses);
        let mut step = PathEquations::default();
        let level = (scale_of(&misses) / vertical_speed_sd).powi(2);
        step.normal[(5, 5)] = level;
        step.right[5] = -level * state[5];
        for ((pair, miss), trust) in pairs.iter().zip(&misses).zip(&trust) {
            step.add(&(miss.across * (trust * miss.slope.powi(2))), &(-miss.offset * (trust * miss.slope)), pair.since);
        }
        let factors = step.normal.cholesky()?;
        state += factors.solve(&step.right);
        let squares: f64 =
            pairs.iter().zip(&trust).map(|(pair, trust)| trust * pair.miss(&state).offset.norm_squared()).sum();
        covariance = factors.inverse() * (squares / (2.0 * pairs.len() as f64 - 6.0).max(1.0));
    }
    let angle = |pair: &ReturnPair| (pair.miss(&state).offset.norm() / pair.along.norm()).min(1.0).asin();
    let median_angle = median(pairs.iter().map(angle).collect());
    let is_finite = state.iter().chain(covariance.iter()).all(|v| v.is_finite());
    is_finite.then_some(SensorFit { state, covariance, median_angle })
}

/// Returns the Huber weight of each miss, 0 to 1: outliers count less.
pub(super) fn trust(misses: &[Miss]) -> Vec<f64> {
    let greatest = HUBER_DEVIATIONS * scale_of(misses);
    let trust = |miss: &Miss| {
        let length = miss.offset.norm();
        if length > greatest { greatest / length } else { 1.0 }
    };
    misses.iter().map(trust).collect()
}

/// Standard deviation of the components of `misses` as far as the middle ones tell, metres.
fn scale_of(misses: &[Miss]) -> f64 {
    median(misses.iter().map(|miss| miss.offset.norm()).collect()) / RAYLEIGH_MEDIAN
}

/// Residual of a pulse against a scanner position.
pub(super) struct Miss {
    /// Vector from the line through the scanner and the first return to the last return, metres.
    pub(super) offset: Vector3<f64>,
    /// Metres by which the offset changes with a metre of the scanner across the way.
    pub(super) slope: f64,
    /// Projects on the plane across the way.
    pub(super) across: Matrix3<f64>,
}

impl ReturnPair {
    /// The pulse with these returns, which are apart, sent `since` seconds after the middle of the part.
    pub(super) fn new(first: Vector3<f64>, last: Vector3<f64>, since: f64) -> Self {
        Self { first, along: last - first, since }
    }

    fn miss(&self, state: &Vector6<f64>) -> Miss {
        self.miss_from(&(state.fixed_rows::<3>(0) + state.fixed_rows::<3>(3) * self.since))
    }

    /// Returns the residual of the pulse for a scanner at `position`.
    pub(super) fn miss_from(&self, position: &Vector3<f64>) -> Miss {
        let way = self.first - position;
        let range = way.norm();
        let towards = way / range;
        let ahead = self.along.dot(&towards);
        let across = Matrix3::identity() - towards * towards.transpose();
        Miss { offset: self.along - towards * ahead, slope: ahead / range, across }
    }
}

/// Normal equations for position and velocity.
#[derive(Default)]
struct PathEquations {
    normal: Matrix6<f64>,
    right: Vector6<f64>,
}

impl PathEquations {
    /// Adds the equations `matrix` · position at `since` = `right`.
    fn add(&mut self, matrix: &Matrix3<f64>, right: &Vector3<f64>, since: f64) {
        for (row, row_factor) in [(0, 1.0), (3, since)] {
            for (column, column_factor) in [(0, 1.0), (3, since)] {
                let mut block = self.normal.fixed_view_mut::<3, 3>(row, column);
                block += matrix * (row_factor * column_factor);
            }
            let mut block = self.right.fixed_rows_mut::<3>(row);
            block += right * row_factor;
        }
    }
}

/// The upper of the two middle values, NaN for none.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return f64::NAN;
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
