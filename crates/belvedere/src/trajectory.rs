//! The path of a scanner through time.

/// Positions of a scanner at increasing times.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// GPS time of each position, strictly increasing, seconds.
    pub times: Vec<f64>,
    /// Positions in the metres of the cloud's reference system (not local), (M, 3).
    pub positions: Vec<[f64; 3]>,
}
