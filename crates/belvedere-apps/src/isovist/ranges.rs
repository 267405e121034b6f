//! Statistics of ranges.

/// Statistics of ranges, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RadialStatistics {
    /// Minimum.
    pub min: f64,
    /// Mean.
    pub mean: f64,
    /// Maximum.
    pub greatest: f64,
    /// Mean square deviation from the mean, m².
    pub variance: f64,
    /// Mean cube of the deviation over that of the standard deviation, without unit; 0 where all are equal.
    pub skewness: f64,
}

impl RadialStatistics {
    /// Statistics of ranges, each with the weight beside it.
    pub(super) fn of(weighted: &[(f64, f64)]) -> Self {
        let total: f64 = weighted.iter().map(|(_, weight)| weight).sum();
        let moment =
            |f: &dyn Fn(f64) -> f64| weighted.iter().map(|&(range, weight)| weight * f(range)).sum::<f64>() / total;
        let mean = moment(&|range| range);
        let variance = moment(&|range| (range - mean).powi(2));
        let third = moment(&|range| (range - mean).powi(3));
        // rounding leaves about 1e-16 of the square of the mean where all ranges are equal
        let is_even = variance <= 1e-14 * mean * mean;
        Self {
            min: weighted.iter().map(|w| w.0).fold(f64::INFINITY, f64::min),
            mean,
            greatest: weighted.iter().map(|w| w.0).fold(0.0, f64::max),
            variance,
            skewness: if is_even { 0.0 } else { third / variance.powf(1.5) },
        }
    }
}
