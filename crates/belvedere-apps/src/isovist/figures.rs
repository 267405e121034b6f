//! Isovists as named numbers.

use super::{Isovist, IsovistIntervals, RadialStatistics};

/// A number that describes an isovist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IsovistFigure {
    /// Name of its column, with its unit.
    pub name: &'static str,
    /// The number.
    pub value: f64,
    /// Decimals in tables.
    pub decimals: usize,
}

/// Maximum drift that tables show as zero, metres: its direction would be that of the rounding of sines.
const NO_DRIFT: f64 = 5e-5;

impl Isovist {
    /// All numbers that describe it; NaN for those without a value. `grid_north` is the azimuth of grid north from the
    /// north that azimuths are counted from, radians.
    pub fn figures(&self, grid_north: f64) -> impl Iterator<Item = IsovistFigure> {
        let plan = &self.plan;
        let [east, north, up] = self.drift;
        let figure = |(name, value, decimals)| IsovistFigure { name, value, decimals };
        let space = [
            ("volume_m3", self.volume, 2),
            ("blocked_volume_m3", self.blocked_volume, 2),
            ("openness", self.openness, 5),
            ("sky_openness", self.sky_openness, 5),
        ];
        let names = ["range_min_m", "range_mean_m", "range_max_m", "range_variance_m2", "range_skewness"];
        let ranges = statistics(names, &self.ranges);
        let names = [
            "plan_range_min_m",
            "plan_range_mean_m",
            "plan_range_max_m",
            "plan_range_variance_m2",
            "plan_range_skewness",
        ];
        let plan_ranges = statistics(names, &plan.ranges);
        let others = [
            ("drift_east_m", east, 4),
            ("drift_north_m", north, 4),
            ("drift_up_m", up, 4),
            ("plan_area_m2", plan.area, 2),
            ("plan_perimeter_m", plan.perimeter, 2),
            ("plan_compactness", plan.compactness(), 5),
            ("plan_openness", plan.openness, 5),
            ("plan_occlusivity_m", plan.occlusivity, 2),
            ("plan_drift_m", plan.drift_length(), 4),
            ("plan_drift_azimuth_deg", drift_azimuth(plan.drift, grid_north), 2),
        ];
        let intervals = self.intervals.map(|IsovistIntervals { plan_area, volume }| {
            [
                ("plan_area_low_m2", plan_area[0], 2),
                ("plan_area_high_m2", plan_area[1], 2),
                ("volume_low_m3", volume[0], 2),
                ("volume_high_m3", volume[1], 2),
            ]
        });
        let of_all = space.into_iter().chain(ranges).chain(plan_ranges).chain(others);
        of_all.chain(intervals.into_iter().flatten()).map(figure)
    }
}

/// Azimuth of a horizontal drift in degrees, NaN where it is none.
fn drift_azimuth([east, north]: [f64; 2], grid_north: f64) -> f64 {
    if east.hypot(north) < NO_DRIFT {
        f64::NAN
    } else {
        (east.atan2(north) + grid_north).to_degrees().rem_euclid(360.0)
    }
}

fn statistics(names: [&'static str; 5], ranges: &RadialStatistics) -> [(&'static str, f64, usize); 5] {
    let values = [ranges.min, ranges.mean, ranges.greatest, ranges.variance, ranges.skewness];
    std::array::from_fn(|i| (names[i], values[i], 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_drift_has_a_direction() {
        // west, and what sines are rounded by
        assert_eq!(drift_azimuth([-0.5, 0.0], 0.0), 270.0);
        assert!(drift_azimuth([1e-16, -3e-16], 0.0).is_nan());
    }
}
