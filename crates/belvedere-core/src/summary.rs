//! Summary of a cloud in numbers, for people who need to know its uses.

mod facades;
mod room;
mod survey;
mod unit;
mod up_axis;

use belvedere_data::Bounds;
use belvedere_data::Result;
use belvedere_data::cast::to_cell;
use belvedere_data::cloud::PointCloud;
use belvedere_data::control::Control;
use std::collections::BTreeMap;

pub use facades::{FacadeSummary, Walls};
pub use survey::SurveyKind;
pub use unit::unit_contradiction_of;
pub use up_axis::{cloud_looks_y_up, looks_y_up};

/// Counts and ranges of a cloud.
#[derive(Clone, Debug, Default)]
pub struct CloudSummary {
    /// Lowest and highest corner in file coordinates; `None` without points.
    pub bounds: Option<([f64; 3], [f64; 3])>,
    /// Square metres of ground with a point above or below, counted in cells of [`CloudSummary::cell_size`].
    pub occupied_area: f64,
    /// Side of those cells, metres.
    pub cell_size: f64,
    /// Points per square metre of occupied ground.
    pub density: f64,
    /// Points per class.
    pub classes: BTreeMap<u8, usize>,
    /// Points per flight line (point source id).
    pub flight_lines: BTreeMap<u16, usize>,
    /// Share of the points whose pulse had more than one return.
    pub multi_return_share: Option<f64>,
    /// Pulses that the points come from, and how many of them had more than one return.
    pub pulses: Option<PulseCounts>,
    /// First and last GPS time, and how many different ones there are.
    pub gps_time: Option<GpsTimes>,
    /// Minimum and maximum scan angle in degrees.
    pub scan_angle_deg: Option<[f32; 2]>,
    /// Points that share their position with an earlier one.
    pub duplicate_count: usize,
}

/// Pulses of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseCounts {
    /// Each point counts as the part of a pulse that it is, 1 / its return count: a pulse cut at the edge of a tile
    /// counts in part.
    pub count: f64,
    /// Number of pulses with several returns.
    pub multi_return_count: f64,
}

impl PulseCounts {
    /// Pulses of points with these return counts, (N); `None` without points. A count of 0 means 1.
    fn of(return_counts: &[u8]) -> Option<Self> {
        let mut points = [0_usize; 256];
        return_counts.iter().for_each(|&count| points[usize::from(count)] += 1);
        let pulses = |counts: std::ops::RangeInclusive<u8>| {
            counts.map(|count| points[usize::from(count)] as f64 / f64::from(count.max(1))).sum::<f64>()
        };
        let (single, several) = (pulses(0..=1), pulses(2..=255));
        (!return_counts.is_empty()).then_some(Self { count: single + several, multi_return_count: several })
    }

    /// Share of the pulses that had several returns.
    #[must_use]
    pub fn multi_return_share(&self) -> f64 {
        self.multi_return_count / self.count
    }
}

/// GPS times of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GpsTimes {
    /// First time, seconds.
    pub first: f64,
    /// Last time, seconds.
    pub last: f64,
    /// Number of different times.
    pub distinct_count: usize,
    /// Points whose time is 0 or not finite.
    pub missing_count: usize,
}

impl GpsTimes {
    /// Returns true if times can separate pulses: a time shared by more than twenty points is no time of one pulse.
    #[must_use]
    pub fn can_separate_pulses(&self, point_count: usize) -> bool {
        self.distinct_count * 20 > point_count - self.missing_count.min(point_count)
    }
}

impl CloudSummary {
    /// Counts `cloud`.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn of(cloud: &PointCloud, control: &Control<'_>) -> Result<Self> {
        let attributes = &cloud.attributes;
        let count_by = |classes: &Option<Vec<u8>>| {
            let mut counts = [0usize; 256];
            classes.iter().flatten().for_each(|&class| counts[usize::from(class)] += 1);
            (0u8..=255).zip(counts).filter(|&(_, count)| count > 0).collect()
        };
        let mut flight_lines = BTreeMap::new();
        for &line in attributes.point_source_id.iter().flatten() {
            *flight_lines.entry(line).or_default() += 1;
        }
        let multi_return_share = attributes
            .return_count
            .as_ref()
            .filter(|counts| !counts.is_empty())
            .map(|counts| counts.iter().filter(|&&count| count > 1).count() as f64 / counts.len() as f64);
        let angles = attributes.scan_angle.as_ref().filter(|angles| !angles.is_empty());
        let scan_angle_deg = angles.map(|angles| {
            let (min, max) =
                angles.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &a| (low.min(a), high.max(a)));
            [min.to_degrees(), max.to_degrees()]
        });
        let cell_size = cell_size_for(cloud);
        let occupied_area = occupied_cell_count(cloud, cell_size) as f64 * cell_size * cell_size;
        control.check()?;
        let gps_time = attributes.gps_time.as_deref().and_then(gps_times);
        control.check()?;
        Ok(Self {
            bounds: cloud.bounds().map(|Bounds { low, high }| {
                (cloud.frame.to_file_coordinates(low), cloud.frame.to_file_coordinates(high))
            }),
            occupied_area,
            cell_size,
            density: if occupied_area > 0.0 { cloud.len() as f64 / occupied_area } else { 0.0 },
            classes: count_by(&attributes.classification),
            flight_lines,
            multi_return_share,
            pulses: attributes.return_count.as_deref().and_then(PulseCounts::of),
            gps_time,
            scan_angle_deg,
            duplicate_count: duplicate_count(cloud),
        })
    }
}

/// Returns three times the spacing that the points would have if they filled their bounding rectangle, metres. That is
/// nine to a cell, so that cells between sparse points count too, and gaps of lakes and missing tiles do not.
fn cell_size_for(cloud: &PointCloud) -> f64 {
    let area =
        cloud.bounds().map_or(0.0, |Bounds { low, high }| f64::from(high[0] - low[0]) * f64::from(high[1] - low[1]));
    if area > 0.0 { 3.0 * (area / cloud.len() as f64).sqrt() } else { 1.0 }
}

fn occupied_cell_count(cloud: &PointCloud, cell_size: f64) -> usize {
    let cell = |v: f32| to_cell(f64::from(v) / cell_size);
    let mut cells: Vec<[i32; 2]> = cloud.positions.iter().map(|p| [cell(p[0]), cell(p[1])]).collect();
    cells.sort_unstable();
    cells.dedup();
    cells.len()
}

fn duplicate_count(cloud: &PointCloud) -> usize {
    // adding zero turns −0 into +0, which is the same place
    let mut positions: Vec<[u32; 3]> = cloud.positions.iter().map(|p| p.map(|v| (v + 0.0).to_bits())).collect();
    positions.sort_unstable();
    positions.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

fn gps_times(times: &[f64]) -> Option<GpsTimes> {
    let mut known: Vec<f64> = times.iter().copied().filter(|t| t.is_finite() && *t != 0.0).collect();
    known.sort_unstable_by(f64::total_cmp);
    let missing_count = times.len() - known.len();
    known.dedup();
    Some(GpsTimes { first: *known.first()?, last: *known.last()?, distinct_count: known.len(), missing_count })
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::cloud::Attributes;

    #[test]
    fn counts_of_a_small_cloud_are_those_counted_by_hand() {
        let cloud = PointCloud {
            positions: vec![[0.2, 0.2, 0.0], [0.7, 0.2, 5.0], [100.5, 0.0, 0.0], [0.2, 0.2, 0.0]],
            attributes: Attributes {
                classification: Some(vec![2, 6, 2, 2]),
                gps_time: Some(vec![5.0, 5.0, 7.0, 0.0]),
                return_count: Some(vec![2, 2, 1, 1]),
                point_source_id: Some(vec![1, 1, 9, 9]),
                scan_angle: Some(vec![0.5, -0.25, 0.0, 0.0]),
                ..Attributes::default()
            },
            ..PointCloud::default()
        };
        let summary = CloudSummary::of(&cloud, &Control::none()).unwrap();
        assert_eq!(summary.classes, BTreeMap::from([(2, 3), (6, 1)]));
        assert_eq!(summary.flight_lines, BTreeMap::from([(1, 2), (9, 2)]));
        assert_eq!(summary.multi_return_share, Some(0.5));
        // one pulse of two returns, and two of one
        let pulses = summary.pulses.unwrap();
        assert_eq!((pulses.count, pulses.multi_return_count), (3.0, 1.0));
        assert!((pulses.multi_return_share() - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(summary.gps_time, Some(GpsTimes { first: 5.0, last: 7.0, distinct_count: 2, missing_count: 1 }));
        assert_eq!(summary.duplicate_count, 1);
        // the rectangle of 100.3 x 0.2 m holds four points: cells of 6.718 m, two of which are occupied
        assert!((summary.cell_size - 6.718).abs() < 1e-3 && (summary.occupied_area - 2.0 * 45.13).abs() < 0.1);
        assert!((summary.density - 4.0 / 90.27).abs() < 1e-3);
        let [min, max] = summary.scan_angle_deg.unwrap();
        assert!((min + 14.32).abs() < 0.01 && (max - 28.65).abs() < 0.01);
    }

    #[test]
    fn an_empty_cloud_has_an_empty_summary() {
        let summary = CloudSummary::of(&PointCloud::default(), &Control::none()).unwrap();
        assert!(summary.bounds.is_none() && summary.density == 0.0 && summary.gps_time.is_none());
    }
}
