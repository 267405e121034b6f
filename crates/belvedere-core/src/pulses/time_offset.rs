//! Offset between the times of a trajectory and those of a cloud: pulses with several returns point to the position of
//! the scanner.

use super::Pulses;
use belvedere_data::PointCloud;
use belvedere_data::cast::to_i32;
use belvedere_data::contradiction::{FoundContradiction, TRAJECTORY_TIME};
use belvedere_data::report::rounded;
use belvedere_data::trajectory::{ClockOffset, Trajectory};
use belvedere_data::vector::{cross, length, sub};
use std::f64::consts::PI;

/// Parameters of the search for a time offset. Neighbouring values were not measured.
#[derive(Clone, Copy, Debug)]
struct TimeOffsetParams {
    /// Minimum distance between first and last return for a pulse to give its direction, metres. Default 3.
    min_length: f64,
    /// Minimum number of such pulses. Default 100.
    min_pairs: usize,
    /// Maximum number of such pulses that are tested. Default 2000: their median angle is accurate to some hundredths
    /// of a degree.
    max_pairs: usize,
    /// Maximum offset, seconds. Default 30: UTC is 13 to 18 s behind GPS time since 1999, and clocks were set by hand.
    max_offset: f64,
    /// Steps of the search, seconds. Default 1, 0.1 and 0.01: an aircraft flies 60 m in the first.
    steps: [f64; 3],
    /// Minimum share of the pulses whose position a shifted trajectory knows, 0 to 1. Default 0.8.
    min_known: f64,
    /// Minimum factor by which the shift reduces the median angle between pulses and path. Default 3.
    min_gain: f64,
    /// Minimum reduction of that angle, radians. Default 0.2 degrees.
    min_reduction: f64,
    /// Maximum difference of the offset of a clock from whole seconds, seconds. Default 0.1. Other offsets may be an
    /// error of the mounting, which another time only seems to correct.
    max_fraction: f64,
    /// Maximum median angle between pulses and path at the offset of a clock, radians. Default 1 degree.
    max_angle: f64,
}

impl Default for TimeOffsetParams {
    fn default() -> Self {
        Self {
            min_length: 3.0,
            min_pairs: 100,
            max_pairs: 2000,
            max_offset: 30.0,
            steps: [1.0, 0.1, 0.01],
            min_known: 0.8,
            min_gain: 3.0,
            min_reduction: 0.2 * PI / 180.0,
            max_fraction: 0.1,
            max_angle: 1.0 * PI / 180.0,
        }
    }
}

/// An offset of time that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeOffset {
    /// Seconds to be added to the times of the cloud, beside those of [`ClockOffset`].
    pub seconds: f64,
    /// True if it is the offset of another clock, and was used.
    pub is_applied: bool,
    /// Median angle between pulses and the directions to the path before and after, radians.
    pub angles: [f64; 2],
}

impl TimeOffset {
    /// Describes the contradiction between the trajectory and the pulses.
    #[must_use]
    pub fn contradiction(&self) -> FoundContradiction {
        let [before, after] = self.angles.map(|angle| rounded(angle.to_degrees(), 2));
        let seconds = rounded(self.seconds, 2);
        let (size, way) = (seconds.abs(), if seconds < 0.0 { "behind" } else { "ahead of" });
        let what = match self.is_applied {
            true => "they are of another clock (UTC is 18 s behind GPS time), and were brought to that of the cloud",
            false => "they were used as they are; correct the times of the trajectory",
        };
        let text = format!(
            "the times of the trajectory are {size} s {way} those of the cloud: pulses with several returns point {before} degrees past the path, and {after} with the offset; {what}"
        );
        TRAJECTORY_TIME.found(text).with("offset_s", seconds).with("angle_deg", before).with("angle_then_deg", after)
    }
}

/// A pulse with two returns: time, first return and the way from it to the last one, metres of the reference system.
struct PulsePair {
    time: f64,
    first: [f64; 3],
    along: [f64; 3],
}

/// Estimates the time offset of `trajectory`, on a clock of `clock`, for which the pulses point to it. `None` if it
/// needs none, and if too few pulses have returns far enough apart.
pub(super) fn time_offset(
    cloud: &PointCloud,
    pulses: &Pulses,
    trajectory: &Trajectory,
    clock: &ClockOffset,
) -> Option<TimeOffset> {
    let params = TimeOffsetParams::default();
    let place = |row: &u32| {
        let position = cloud.positions.get(*row as usize)?.map(f64::from);
        Some(std::array::from_fn(|i| position[i] + cloud.frame.origin[i]))
    };
    let pair = |pulse: usize| {
        let returns = pulses.returns_of(pulse);
        let (first, last): ([f64; 3], [f64; 3]) = (place(returns.first()?)?, place(returns.last()?)?);
        let along = sub(last, first);
        let time = clock.trajectory_time(*pulses.times.get(pulse)?);
        (length(along) >= params.min_length).then_some(PulsePair { time, first, along })
    };
    let all: Vec<PulsePair> = (0..pulses.len()).filter_map(pair).collect();
    if all.len() < params.min_pairs {
        return None;
    }
    let step = all.len().div_ceil(params.max_pairs);
    let pairs: Vec<&PulsePair> = all.iter().step_by(step).collect();
    let angle_at = |shift: f64| median_angle(&pairs, trajectory, shift, params.min_known);
    let before = angle_at(0.0)?;
    let (mut best, mut least) = (0.0, before);
    let mut width = params.max_offset;
    for step in params.steps {
        let count = to_i32((width / step).round());
        let around = best;
        // from the middle outwards, so that the nearest of equal ones is taken
        let near = (0..=count).flat_map(|i| [f64::from(i), -f64::from(i)]);
        for shift in near.map(|i| around + i * step) {
            if let Some(angle) = angle_at(shift).filter(|&angle| angle < least) {
                (best, least) = (shift, angle);
            }
        }
        width = step;
    }
    let is_better = before > params.min_gain * least && before - least > params.min_reduction;
    if !(is_better && TRAJECTORY_TIME.is_exceeded_by(best)) {
        return None;
    }
    let whole = best.round();
    let of_clock =
        angle_at(whole).filter(|&angle| (best - whole).abs() <= params.max_fraction && angle <= params.max_angle);
    Some(match of_clock {
        Some(angle) => TimeOffset { seconds: whole, is_applied: true, angles: [before, angle] },
        None => TimeOffset { seconds: best, is_applied: false, angles: [before, least] },
    })
}

/// Returns the median angle between pulses and the directions to a path that is `shift` seconds later, radians. `None`
/// if the path is known for less than the share `min_known` of them.
fn median_angle(pairs: &[&PulsePair], trajectory: &Trajectory, shift: f64, min_known: f64) -> Option<f64> {
    let angle = |pair: &&PulsePair| {
        let from_scanner = sub(pair.first, trajectory.position_at(pair.time + shift)?);
        let dot: f64 = (0..3).map(|i| from_scanner[i] * pair.along[i]).sum();
        Some(length(cross(from_scanner, pair.along)).atan2(dot))
    };
    let mut angles: Vec<f64> = pairs.iter().filter_map(angle).collect();
    if (angles.len() as f64) < min_known * pairs.len() as f64 {
        return None;
    }
    let middle = angles.len() / 2;
    Some(*angles.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pulses::group;
    use belvedere_data::control::Control;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;
    use belvedere_data::{Attributes, Frame};

    /// The path of a scanner: a slight curve at 1200 m, 60 m/s.
    fn place(time: f64) -> [f64; 3] {
        [80_000.0 + 60.0 * time, 440_000.0 + 0.3 * time * time, 1200.0 + 2.0 * (time / 9.0).sin()]
    }

    /// Pulses from the path to the ground through crowns, swung across the flight; and the path with its times changed.
    fn survey(ahead: f64) -> (PointCloud, Trajectory) {
        let origin = [82_000.0, 440_000.0, 0.0];
        let (mut positions, mut times, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..800_u32 {
            let time = 40.0 + 0.02 * f64::from(i) + 1e-4 * uniform(1, u64::from(i));
            let scanner = place(time);
            let swing = 0.35 * (f64::from(i) * 0.7).sin();
            let ground = [scanner[0] + 30.0 * uniform(2, u64::from(i)), scanner[1] + 1200.0 * swing.tan(), 5.0];
            let way = sub(ground, scanner);
            // the first return 12 m above the ground, the last one on it, both to a few centimetres
            for (number, part) in [(1_u8, 1.0 - 12.0 / 1195.0), (2, 1.0)] {
                let noise = 0.03 * (uniform(3, u64::from(number) * 1000 + u64::from(i)) - 0.5);
                positions.push(std::array::from_fn(|k| to_f32(scanner[k] + part * way[k] - origin[k] + noise)));
                times.push(time);
                numbers.push(number);
            }
        }
        let attributes = Attributes {
            gps_time: Some(times),
            return_count: Some(vec![2; numbers.len()]),
            return_number: Some(numbers),
            ..Attributes::default()
        };
        let cloud = PointCloud { positions, attributes, ..PointCloud::in_frame(Frame { origin, ..Frame::default() }) };
        let records = (0..220).map(|i| (0.5 * f64::from(i) + ahead, place(0.5 * f64::from(i))));
        (cloud, Trajectory::from_records(records.collect()).0)
    }

    fn found(ahead: f64) -> Option<TimeOffset> {
        let (cloud, trajectory) = survey(ahead);
        let times = cloud.attributes.gps_time.as_deref().unwrap();
        let clock = trajectory.clock_offset_for(times, cloud.attributes.gps_time_kind);
        assert_eq!((clock.leap_seconds, clock.known_count), (0.0, times.len()), "{ahead}");
        let (pulses, _) = group(&cloud, &Control::none()).unwrap();
        time_offset(&cloud, &pulses, &trajectory, &clock)
    }

    #[test]
    fn offsets_of_clocks_are_found_and_used() {
        assert_eq!(found(0.0), None);
        assert_eq!(found(0.1), None);
        for seconds in [-18.0, 18.0, -17.0, 13.0, -1.0, 5.0] {
            let offset = found(seconds).unwrap_or_else(|| panic!("{seconds}"));
            assert_eq!((offset.seconds, offset.is_applied), (seconds, true), "{offset:?}");
            assert!(offset.angles[0] > 3.0 * offset.angles[1], "{offset:?}");
        }
        let text = found(-18.0).unwrap().contradiction().text;
        assert!(text.contains("18 s behind") && text.contains("were brought to"), "{text}");
    }

    #[test]
    fn offsets_that_no_clock_has_are_said_and_not_used() {
        for seconds in [-2.4, 0.6, 7.35] {
            let offset = found(seconds).unwrap_or_else(|| panic!("{seconds}"));
            assert!(!offset.is_applied && (offset.seconds - seconds).abs() < 0.05, "{offset:?}");
        }
    }
}
