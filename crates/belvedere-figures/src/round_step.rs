//! Round distances between the lines and ticks of diagrams.

/// The least of 1, 2 and 5 times a power of ten that is at least `min`.
pub(crate) fn round_step(min: f64) -> f64 {
    let power = 10.0_f64.powf(min.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|&step| step >= min * (1.0 - 1e-9)).unwrap_or(power)
}
