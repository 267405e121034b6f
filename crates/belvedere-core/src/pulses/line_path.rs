//! The path of a scanner along a flight line, from estimates for its parts.

use belvedere_data::PointCloud;
use belvedere_data::cloud::to_local;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Source of the scanner position of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FoundBy {
    /// A pose in the file.
    Pose,
    /// A position that was given.
    Position,
    /// Stations that were given.
    Station,
    /// A trajectory that was given.
    Trajectory,
    /// Pulses with several returns.
    Returns,
    /// Scan angles.
    ScanAngle,
    /// A search for the stations of tripods in the points.
    StationSearch,
    /// Assumption that pulses fall straight down.
    Assumed,
}

impl FoundBy {
    /// The means in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pose => "poses in the file",
            Self::Position => "the position given",
            Self::Station => "the stations given",
            Self::Trajectory => "trajectory",
            Self::Returns => "pulses with several returns",
            Self::ScanAngle => "scan angles",
            Self::StationSearch => "stations found in the data",
            Self::Assumed => "nothing: pulses are assumed to be vertical",
        }
    }

    /// Key of the percentage of points whose scanner it found.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Pose => "poses_in_the_file_percent",
            Self::Position => "position_given_percent",
            Self::Station => "stations_given_percent",
            Self::Trajectory => "trajectory_percent",
            Self::Returns => "pulses_with_several_returns_percent",
            Self::ScanAngle => "scan_angles_percent",
            Self::StationSearch => "stations_found_percent",
            Self::Assumed => "assumed_percent",
        }
    }
}

/// Path of the scanner along a flight line, with the times at which it is known.
///
/// Saved, it keeps where the scanner was, and not how well that is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinePath {
    /// Flight line; 0 where the cloud names none.
    pub source_id: u16,
    /// Source of the path.
    pub means: FoundBy,
    /// The times at which it is known, increasing.
    pub stretches: Vec<Stretch>,
    knots: Vec<Knot>,
}

/// A stretch of time over which the scanner's path is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stretch {
    /// First and last, seconds.
    pub times: [f64; 2],
    /// Standard deviation of the positions, metres.
    #[serde(skip)]
    pub position_sd: [f64; 3],
    /// Median angle between the pulses and the directions to the path, radians; NaN where no pulse of this stretch
    /// tells.
    #[serde(skip)]
    pub median_angle: f64,
}

impl LinePath {
    /// The path through `knots`, which increase in time, over `stretches`.
    #[cfg(feature = "scanner-estimate")]
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

/// The path among `paths`, which are in order of their lines, that knows the scanner of `line` at `time`, the first of
/// several, and its local position, metres.
pub(super) fn position_on(paths: &[LinePath], line: u16, time: f64) -> Option<(&LinePath, [f64; 3])> {
    let start = paths.partition_point(|path| path.source_id < line);
    let of_line = paths.get(start..)?.iter().take_while(|path| path.source_id == line);
    of_line.filter_map(|path| Some((path, path.position_at(time)?))).next()
}

/// Local position of the scanner for each point of `cloud`, (N, 3) metres, by `paths`, which are in order of their
/// lines; NaN where none knows it.
pub(crate) fn positions_on_paths(paths: &[LinePath], cloud: &PointCloud) -> Vec<[f32; 3]> {
    let unknown = [f32::NAN; 3];
    let Some(times) = &cloud.attributes.gps_time else { return vec![unknown; cloud.len()] };
    let lines = cloud.attributes.point_source_id.as_deref().unwrap_or_default();
    let position = |(row, &time): (usize, &f64)| {
        let line = lines.get(row).copied().unwrap_or(0);
        position_on(paths, line, time).map_or(unknown, |(_, place)| to_local(place, [0.0; 3]))
    };
    times.par_iter().enumerate().map(position).collect()
}

/// Parts farther apart than this are smoothed apart, seconds: aircraft do not hold their course for longer.
pub(super) const LONGEST_BRIDGE_S: f64 = 30.0;

/// Position and velocity of the scanner at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Knot {
    /// Seconds.
    pub(super) time: f64,
    /// Local metres.
    pub(super) position: [f64; 3],
    /// Metres per second.
    pub(super) velocity: [f64; 3],
}

/// Local position at `time` on the path through `knots`, which increase in time; `None` without any. Between knots a
/// cubic with their velocities; beyond them, and where the next is half a minute away, straight on from the nearer.
fn position_at(knots: &[Knot], time: f64) -> Option<[f64; 3]> {
    let after = knots.partition_point(|knot| knot.time <= time);
    let before = after.checked_sub(1).and_then(|i| knots.get(i));
    let straight_on = |knot: &Knot| std::array::from_fn(|i| knot.position[i] + knot.velocity[i] * (time - knot.time));
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
        let (from, to) = (a.velocity[i] * span, b.velocity[i] * span);
        a.position[i]
            + (3.0 * s2 - 2.0 * s3) * (b.position[i] - a.position[i])
            + (s3 - 2.0 * s2 + s) * from
            + (s3 - s2) * to
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_path_runs_through_its_knots_and_straight_on_beyond() {
        let knot = |time, x| Knot { time, position: [x, 0.0, 500.0], velocity: [60.0, 0.0, 0.0] };
        let knots = [knot(0.0, 0.0), knot(2.0, 120.0)];
        for time in [-1.0, 0.0, 0.7, 2.0, 3.0] {
            let [x, y, z] = position_at(&knots, time).unwrap();
            assert!((x - 60.0 * time).abs() < 1e-9 && y.abs() < 1e-9 && (z - 500.0).abs() < 1e-9, "{time}: {x}");
        }
        assert_eq!(position_at(&[], 0.0), None);
    }
}
