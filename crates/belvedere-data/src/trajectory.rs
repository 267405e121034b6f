//! The path of a scanner through time.

use rayon::prelude::*;

use crate::cloud::to_local;
use crate::vector::length;
use crate::{Error, GpsTimeKind, Parameter, PointCloud, Result};

/// Maximum gap between two positions that is interpolated over, seconds. Recorders write at 1 Hz or faster, and in two
/// seconds an aircraft in a turn leaves the chord by a few metres; beyond that the path is not known.
pub const MAX_GAP_S: f64 = 2.0;

/// Seconds in a GPS week.
pub const WEEK_S: f64 = 604_800.0;
/// Greatest time that is seconds of a week: flights that pass midnight on Saturday count on.
pub const LONGEST_WEEK_S: f64 = 2.0 * WEEK_S;

/// Difference between GPS time and adjusted standard GPS time, seconds.
pub const ADJUSTED_STANDARD_S: f64 = 1e9;

/// GPS minus UTC since 2017: trajectories are sometimes written in UTC of the week.
pub const LEAP_SECONDS_S: f64 = 18.0;

/// Positions of a scanner at increasing times.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// GPS time of each position, strictly increasing, seconds.
    pub times: Vec<f64>,
    /// Positions in the metres of the cloud's reference system (not local), (M, 3).
    pub positions: Vec<[f64; 3]>,
}

/// A position of a scanner that was found, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrajectorySample {
    /// GPS time on the clock of the cloud, seconds.
    pub time: f64,
    /// Metres in the cloud's reference system (not local).
    pub position: [f64; 3],
    /// Accuracy of the position.
    pub quality: TrajectoryQuality,
}

/// Accuracy of a position on a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrajectoryQuality {
    /// Standard deviations along x, y and z, metres.
    pub sd: [f64; 3],
    /// Median angle between pulses and the directions to the path, radians; NaN where no pulse tells.
    pub residual: f64,
    /// Flight line.
    pub line: u16,
}

/// Conversion of the times of a cloud to times of a trajectory, and the number of them at which the trajectory knows a
/// position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockOffset {
    /// Clock of the trajectory.
    pub clock: TrajectoryClock,
    /// Seconds added after the change of clock: 0, ±18 for a trajectory in UTC (or a cloud in UTC), or as fitted to
    /// pulses.
    pub leap_seconds: f64,
    /// Cloud times at which the trajectory knows a position.
    pub known_count: usize,
    /// Cloud times in all.
    pub time_count: usize,
}

/// Epoch of the times of a trajectory, relative to the times of a cloud.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrajectoryClock {
    /// The same as those of the cloud.
    Same,
    /// Seconds of the GPS week, where the cloud has adjusted standard GPS time.
    WeekFromAdjusted,
    /// Seconds since 1980, where the cloud has adjusted standard GPS time.
    GpsFromAdjusted,
}

impl ClockOffset {
    /// Time of the trajectory at a time of the cloud, seconds.
    #[must_use]
    pub fn trajectory_time(&self, cloud_time: f64) -> f64 {
        self.leap_seconds
            + match self.clock {
                TrajectoryClock::Same => cloud_time,
                TrajectoryClock::WeekFromAdjusted => (cloud_time + ADJUSTED_STANDARD_S).rem_euclid(WEEK_S),
                TrajectoryClock::GpsFromAdjusted => cloud_time + ADJUSTED_STANDARD_S,
            }
    }
}

impl Trajectory {
    /// A trajectory from times (seconds) and positions (metres) in any order, and how many records were left out
    /// because another had the same time. Of those the first is kept. Records that are not finite are left out and
    /// counted too.
    #[must_use]
    pub fn from_records(mut records: Vec<(f64, [f64; 3])>) -> (Self, usize) {
        let given = records.len();
        records.retain(|(time, p)| time.is_finite() && p.iter().all(|v| v.is_finite()));
        records.sort_by(|a, b| a.0.total_cmp(&b.0));
        records.dedup_by(|later, earlier| later.0 <= earlier.0);
        let (times, positions): (Vec<f64>, Vec<[f64; 3]>) = records.into_iter().unzip();
        let left_out = given - times.len();
        (Self { times, positions }, left_out)
    }

    /// Position at `time` (seconds, on the trajectory's clock), metres; `None` before the first record, after the last,
    /// and within gaps longer than [`MAX_GAP_S`].
    ///
    /// Between records the path is a cubic with the velocities that the neighbouring records give, or a straight line
    /// where one of these is missing or too far away.
    #[must_use]
    pub fn position_at(&self, time: f64) -> Option<[f64; 3]> {
        let after = self.times.partition_point(|&t| t <= time);
        let start = after.checked_sub(1)?;
        let (t0, p0) = (*self.times.get(start)?, *self.positions.get(start)?);
        if t0.total_cmp(&time).is_eq() {
            return Some(p0);
        }
        let (t1, p1) = (*self.times.get(after)?, *self.positions.get(after)?);
        let span = t1 - t0;
        if !(span > 0.0 && span <= MAX_GAP_S) {
            return None;
        }
        let s = (time - t0) / span;
        let before = start.checked_sub(1).and_then(|i| self.record_within(i, t0));
        let beyond = self.record_within(after + 1, t1);
        let (Some((t_before, p_before)), Some((t_beyond, p_beyond))) = (before, beyond) else {
            return Some(std::array::from_fn(|i| p0[i] + s * (p1[i] - p0[i])));
        };
        Some(std::array::from_fn(|i| {
            let m0 = (p1[i] - p_before[i]) / (t1 - t_before) * span;
            let m1 = (p_beyond[i] - p0[i]) / (t_beyond - t0) * span;
            let (s2, s3) = (s * s, s * s * s);
            // relative to p0, so that coordinates of a million metres lose nothing
            p0[i] + (3.0 * s2 - 2.0 * s3) * (p1[i] - p0[i]) + (s3 - 2.0 * s2 + s) * m0 + (s3 - s2) * m1
        }))
    }

    fn record_within(&self, index: usize, time: f64) -> Option<(f64, [f64; 3])> {
        let (t, p) = (*self.times.get(index)?, *self.positions.get(index)?);
        ((t - time).abs() <= MAX_GAP_S).then_some((t, p))
    }

    /// Finds the conversion of the times of a cloud, (N) seconds of `kind`, to times of this trajectory. It is the
    /// change of clock and leap seconds with the largest number of known positions, which is returned too.
    ///
    /// If several conversions know equally many, the simplest is chosen, without leap seconds if possible: a difference
    /// of 18 s can only be detected if the trajectory begins or ends within 18 s of the cloud. A header may have a
    /// wrong kind of time. All changes of clock are therefore tried whatever `kind` is; `kind` only breaks ties.
    #[must_use]
    pub fn clock_offset_for(&self, times: &[f64], kind: GpsTimeKind) -> ClockOffset {
        use TrajectoryClock::{GpsFromAdjusted, Same, WeekFromAdjusted};
        let clocks = match kind {
            GpsTimeKind::SecondsOfWeek => [Same, WeekFromAdjusted, GpsFromAdjusted],
            GpsTimeKind::AdjustedStandard => [WeekFromAdjusted, GpsFromAdjusted, Same],
        };
        let mut best: Option<ClockOffset> = None;
        for leap_seconds in [0.0, -LEAP_SECONDS_S, LEAP_SECONDS_S] {
            for clock in clocks {
                let mut offset = ClockOffset { clock, leap_seconds, known_count: 0, time_count: times.len() };
                offset.known_count = times.par_iter().filter(|&&t| self.knows(offset.trajectory_time(t))).count();
                if best.is_none_or(|best| offset.known_count > best.known_count) {
                    best = Some(offset);
                }
                if offset.known_count == times.len() {
                    return offset;
                }
            }
        }
        best.unwrap_or(ClockOffset { clock: Same, leap_seconds: 0.0, known_count: 0, time_count: times.len() })
    }

    /// Local position of the scanner for each point of `cloud`, (N, 3), metres, NaN where the trajectory knows none;
    /// and how the cloud's times became those of the trajectory.
    ///
    /// # Errors
    /// [`Error::MissingAttribute`] without GPS times. [`Error::InvalidParameter`] for a trajectory that knows a
    /// position at none of them, is more than 50 km away from all points, or above less than a tenth of them.
    pub fn scanner_positions(&self, cloud: &PointCloud) -> Result<(Vec<[f32; 3]>, ClockOffset)> {
        let times = cloud.attributes.gps_time.as_deref().ok_or(Error::MissingAttribute {
            attribute: "GPS time",
            needed_for: "a trajectory",
            advice: "use the cloud as delivered by the survey, or orient by up or by a mesh",
        })?;
        let (positions, offset) = self.scanner_positions_at(times, cloud)?;
        check_above(&positions, &cloud.positions)?;
        Ok((positions, offset))
    }

    /// Returns [`Trajectory::scanner_positions`] at `times`, (N), on the clock of `cloud`, in place of those of its
    /// points.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] where it knows a position at none of the times.
    pub fn scanner_positions_at(&self, times: &[f64], cloud: &PointCloud) -> Result<(Vec<[f32; 3]>, ClockOffset)> {
        let offset = self.clock_offset_for(times, cloud.attributes.gps_time_kind);
        if offset.known_count == 0 && !times.is_empty() {
            let span = |times: &[f64]| {
                let min = times.iter().copied().fold(f64::INFINITY, f64::min);
                format!("{min} to {} s", times.iter().copied().fold(f64::NEG_INFINITY, f64::max))
            };
            return Err(Error::invalid(
                Parameter::Trajectory,
                format!("from {}, the cloud from {}", span(&self.times), span(times)),
                "to cover the GPS times of the cloud",
            ));
        }
        Ok((self.positions_by(&offset, times, cloud), offset))
    }

    /// Local position of the scanner at `times`, (N), on the clock of `cloud`, (N, 3) metres, NaN where none is known.
    #[must_use]
    pub fn positions_by(&self, offset: &ClockOffset, times: &[f64], cloud: &PointCloud) -> Vec<[f32; 3]> {
        let position = |&time: &f64| match self.position_at(offset.trajectory_time(time)) {
            Some(position) => to_local(position, cloud.frame.origin),
            None => [f32::NAN; 3],
        };
        times.par_iter().map(position).collect()
    }

    fn knows(&self, time: f64) -> bool {
        let after = self.times.partition_point(|&t| t <= time);
        let Some(&before) = after.checked_sub(1).and_then(|i| self.times.get(i)) else { return false };
        before >= time || self.times.get(after).is_some_and(|next| next - before <= MAX_GAP_S)
    }
}

/// Maximum distance of a scanner from its points, metres: ten times the range of airborne scanners.
const MAX_DISTANCE: f64 = 50_000.0;
/// Minimum height of a scanner above a point that counts as below it, metres: more than the roughness of the ground.
const CLEARLY_BELOW: f32 = 0.5;
/// Minimum share of the points that are below their scanner: those of a vehicle measure the road, those of an aircraft
/// everything.
const MIN_BELOW: f64 = 0.1;

/// Refuses scanner positions that cannot be those of points: in degrees, in another system, or at the height of the
/// ground. Both (N, 3), local metres.
fn check_above(positions: &[[f32; 3]], points: &[[f32; 3]]) -> Result<()> {
    let invalid = |value, expected| Err(Error::invalid(Parameter::Trajectory, value, expected));
    let known: Vec<(&[f32; 3], &[f32; 3])> =
        positions.iter().zip(points).filter(|(p, _)| !p.iter().any(|v| v.is_nan())).collect();
    if known.is_empty() {
        return Ok(());
    }
    let distance = |(p, q): &(&[f32; 3], &[f32; 3])| length([0, 1, 2].map(|i| f64::from(p[i]) - f64::from(q[i])));
    let nearest = known.iter().map(distance).fold(f64::INFINITY, f64::min);
    if !(nearest <= MAX_DISTANCE) {
        let value = format!("at least {:.0} km away from the points", nearest / 1000.0);
        return invalid(value, "in the reference system of the cloud: easting, northing and height, not degrees");
    }
    let below = known.iter().filter(|(p, q)| p[2] - q[2] > CLEARLY_BELOW && p[2].is_finite()).count();
    if (below as f64) < MIN_BELOW * known.len() as f64 {
        let value = format!("above {} of {} points only", below, known.len());
        return invalid(value, "above the points: heights are those of the scanner, not of the ground");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight_flight(start: f64) -> Trajectory {
        let records = (0..60).map(|i| {
            let t = f64::from(i) * 0.5;
            (start + t, [85_000.0 + 60.0 * t, 447_000.0 - 5.0 * t, 1000.0 + 0.1 * t])
        });
        Trajectory::from_records(records.collect()).0
    }

    #[test]
    fn positions_on_a_straight_line_are_exact() {
        let flight = straight_flight(1000.0);
        for time in [1000.0, 1000.1, 1003.33, 1014.9, 1029.5] {
            let p = flight.position_at(time).unwrap();
            let t = time - 1000.0;
            let truth = [85_000.0 + 60.0 * t, 447_000.0 - 5.0 * t, 1000.0 + 0.1 * t];
            assert!((0..3).all(|i| (p[i] - truth[i]).abs() < 1e-8), "{time}: {p:?} {truth:?}");
        }
    }

    #[test]
    fn a_turn_is_followed_to_centimetres() {
        // 1 Hz, radius 1500 m, 60 m/s: the chord is off by 0.3 m
        let place = |t: f64| [1500.0 * (0.04 * t).cos(), 1500.0 * (0.04 * t).sin(), 800.0];
        let (turn, _) = Trajectory::from_records((0..30).map(|i| (f64::from(i), place(f64::from(i)))).collect());
        let (p, truth) = (turn.position_at(10.5).unwrap(), place(10.5));
        assert!((0..3).all(|i| (p[i] - truth[i]).abs() < 0.01));
    }

    #[test]
    fn outside_and_in_gaps_there_is_no_position() {
        let (path, left_out) = Trajectory::from_records(vec![
            (10.0, [10.0, 0.0, 0.0]),
            (0.0, [0.0; 3]),
            (1.0, [1.0, 0.0, 0.0]),
            (1.0, [9.0; 3]),
            (f64::NAN, [0.0; 3]),
            (11.0, [11.0, 0.0, 0.0]),
        ]);
        assert_eq!(left_out, 2);
        assert_eq!(path.position_at(0.5), Some([0.5, 0.0, 0.0]));
        assert_eq!(path.position_at(1.0), Some([1.0, 0.0, 0.0]));
        assert_eq!(path.position_at(11.0), Some([11.0, 0.0, 0.0]));
        for nowhere in [-0.1, 1.5, 9.9, 11.1, f64::NAN] {
            assert_eq!(path.position_at(nowhere), None, "{nowhere}");
        }
    }

    #[test]
    fn adjusted_times_find_their_week() {
        let flight = straight_flight(300_000.0);
        // week 2200
        let times: Vec<f64> = (1..29).map(|i| 2200.0 * WEEK_S + 300_000.0 + f64::from(i) - 1e9).collect();
        let offset = flight.clock_offset_for(&times, GpsTimeKind::AdjustedStandard);
        assert_eq!(offset.clock, TrajectoryClock::WeekFromAdjusted);
        assert_eq!((offset.leap_seconds, offset.known_count), (0.0, 28));
        assert!((offset.trajectory_time(times[0]) - 300_001.0).abs() < 1e-6);
    }

    #[test]
    fn utc_times_are_shifted_by_leap_seconds() {
        let flight = straight_flight(300_000.0);
        let times: Vec<f64> = (1..29).map(|i| 300_000.0 + f64::from(i) + 18.0).collect();
        let offset = flight.clock_offset_for(&times, GpsTimeKind::SecondsOfWeek);
        assert_eq!((offset.clock, offset.leap_seconds, offset.known_count), (TrajectoryClock::Same, -18.0, 28));
    }

    #[test]
    fn strange_times_are_not_on_any_trajectory() {
        let offset = straight_flight(300_000.0).clock_offset_for(&[f64::NAN, -1e300, 5.0], GpsTimeKind::SecondsOfWeek);
        assert_eq!((offset.known_count, offset.time_count), (0, 3));
        assert_eq!(Trajectory::default().position_at(0.0), None);
    }
}
