//! Position and velocity of a scanner from the lines that its pulses lie on.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Rounds of improvement and reweighting; position and weights settle after four.
const ROUNDS: usize = 6;
/// Misses beyond so many deviations count less (Huber): most of a clean set, two components together, lies within.
const HUBER_DEVIATIONS: f64 = 2.0;
/// Median length of a miss whose two components have deviation 1 (Rayleigh).
const RAYLEIGH_MEDIAN: f64 = 1.177_41;

/// Straight line through the first and last return of a pulse.
pub(super) struct Pair {
    pub(super) first: Vector3<f64>,
    /// Projects on the plane across the pulse.
    across: Matrix3<f64>,
    length: f64,
    /// Seconds after the middle of the part.
    since: f64,
}

/// What the pulses of a part of a flight line say of the scanner.
pub(super) struct Fit {
    /// Half-way in time, local metres.
    pub(super) position: Vector3<f64>,
    /// Metres per second.
    pub(super) velocity: Vector3<f64>,
    /// By the residuals, metres.
    pub(super) position_sd: [f64; 3],
    /// Between the pulses and the directions to the path, radians.
    pub(super) median_angle: f64,
}

/// Position and velocity for which the last returns of `pairs` lie nearest to the lines from the scanner through the first
/// ones, or `None` where they fix none.
///
/// The first guess minimises how far the lines miss the scanner, which is linear. It lies too near, because a line with a
/// wrong direction misses a far scanner by more, so the rounds that follow (Gauss and Newton) minimise the distance at the
/// last return, where the error is.
pub(super) fn fit(pairs: &[Pair], vertical_speed_sd: f64) -> Option<Fit> {
    let mut start = Equations::default();
    for pair in pairs {
        let weighted = pair.across * pair.length.powi(2);
        start.add(&weighted, &(weighted * pair.first), pair.since);
    }
    let mut state = start.normal.cholesky()?.solve(&start.right);
    let (mut misses, mut scale) = misses_of(pairs, &state);
    let mut result = None;
    for _ in 0..ROUNDS {
        let greatest = HUBER_DEVIATIONS * scale;
        let trust: Vec<f64> = misses.iter().map(|miss| if *miss > greatest { greatest / miss } else { 1.0 }).collect();
        let mut step = Equations::default();
        let level = (scale / vertical_speed_sd).powi(2);
        step.normal[(5, 5)] = level;
        step.right[5] = -level * state[5];
        for (pair, trust) in pairs.iter().zip(&trust) {
            let sight = pair.sight(&state);
            let range = sight.norm();
            let towards = sight / range;
            let slope = pair.across * (Matrix3::identity() - towards * towards.transpose()) * (pair.length / range);
            let weighted = slope.transpose() * *trust;
            step.add(&(weighted * slope), &(-weighted * pair.miss(&state)), pair.since);
        }
        let factors = step.normal.cholesky()?;
        state += factors.solve(&step.right);
        (misses, scale) = misses_of(pairs, &state);
        let squares: f64 = misses.iter().zip(&trust).map(|(miss, trust)| trust * miss * miss).sum();
        let variance = squares / (2.0 * pairs.len() as f64 - 6.0).max(1.0);
        let covariance = factors.inverse() * variance;
        let angle = |(pair, miss): (&Pair, &f64)| (miss / pair.length).min(1.0).asin();
        result = Some(Fit {
            position: state.fixed_rows::<3>(0).into_owned(),
            velocity: state.fixed_rows::<3>(3).into_owned(),
            position_sd: std::array::from_fn(|i| covariance[(i, i)].sqrt()),
            median_angle: median(pairs.iter().zip(&misses).map(angle).collect()),
        });
    }
    result.filter(|fit| fit.position.iter().chain(&fit.velocity).all(|v| v.is_finite()))
}

/// Lengths of the misses, metres, and the standard deviation of their components as far as the middle ones tell.
fn misses_of(pairs: &[Pair], state: &Vector6<f64>) -> (Vec<f64>, f64) {
    let misses: Vec<f64> = pairs.iter().map(|pair| pair.miss(state).norm()).collect();
    let scale = median(misses.clone()) / RAYLEIGH_MEDIAN;
    (misses, scale)
}

impl Pair {
    /// The line from `first` to `last`, which are apart, sent `since` seconds after the middle of the part.
    pub(super) fn new(first: Vector3<f64>, last: Vector3<f64>, since: f64) -> Self {
        let length = (last - first).norm();
        let along = (last - first) / length;
        Self { first, across: Matrix3::identity() - along * along.transpose(), length, since }
    }

    /// From the first return to the scanner of `state`, which is position then velocity.
    fn sight(&self, state: &Vector6<f64>) -> Vector3<f64> {
        state.fixed_rows::<3>(0) + state.fixed_rows::<3>(3) * self.since - self.first
    }

    /// How far the last return lies from the line through the scanner and the first, metres across the pulse.
    fn miss(&self, state: &Vector6<f64>) -> Vector3<f64> {
        let sight = self.sight(state);
        self.across * sight * (self.length / sight.norm())
    }
}

/// Normal equations for position and velocity.
#[derive(Default)]
struct Equations {
    normal: Matrix6<f64>,
    right: Vector6<f64>,
}

impl Equations {
    /// Adds what says that `matrix` times the position at `since` is `right`.
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
