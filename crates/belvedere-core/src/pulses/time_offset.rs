//! Offset between the times of a trajectory and those of a cloud: pulses with several returns point to the position of
//! the scanner.

use super::Pulses;
use belvedere_data::PointCloud;
use belvedere_data::contradiction::{FoundContradiction, TRAJECTORY_TIME};
use belvedere_data::report::rounded;
use belvedere_data::trajectory::{ClockOffset, Trajectory};
use belvedere_data::vector::{cross, length, sub};

/// Minimum distance between first and last return for a pulse to give its direction, metres.
const MIN_LENGTH: f64 = 3.0;
/// Fewest such pulses, and the most that are looked at: the median angle of two thousand is known to some hundredths.
const MIN_PAIRS: usize = 100;
const MAX_PAIRS: usize = 2000;
/// Offsets that are tried, seconds: UTC is 13 to 18 s behind GPS time since 1999, and clocks were set by hand.
const FARTHEST: f64 = 30.0;
/// Steps of the search, seconds: each a tenth of the one before. An aircraft flies 60 m in one.
const STEPS: [f64; 3] = [1.0, 0.1, 0.01];
/// Share of the pulses whose place a shifted trajectory must know.
const MIN_KNOWN: f64 = 0.8;
/// Minimum factor by which the shift reduces the median angle between pulses and path, and minimum reduction, radians.
const MIN_GAIN: f64 = 3.0;
const MIN_ANGLE: f64 = 0.2 * std::f64::consts::PI / 180.0;
/// An offset this near to whole seconds is that of a clock, seconds, if pulses then point to within this angle of the
/// path, radians. Other offsets may be an error of the mounting, which another time only seems to mend.
const NEAR_WHOLE: f64 = 0.1;
const CERTAIN_ANGLE: f64 = 1.0 * std::f64::consts::PI / 180.0;

/// An offset of time that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeOffset {
    /// Seconds to be added to the times of the cloud, beside what [`ClockOffset`] adds.
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
    let place = |row: &u32| {
        let position = cloud.positions.get(*row as usize)?.map(f64::from);
        Some(std::array::from_fn(|i| position[i] + cloud.frame.origin[i]))
    };
    let pair = |pulse: usize| {
        let returns = pulses.returns_of(pulse);
        let (first, last): ([f64; 3], [f64; 3]) = (place(returns.first()?)?, place(returns.last()?)?);
        let along = sub(last, first);
        let time = clock.trajectory_time(*pulses.times.get(pulse)?);
        (length(along) >= MIN_LENGTH).then_some(PulsePair { time, first, along })
    };
    let all: Vec<PulsePair> = (0..pulses.len()).filter_map(pair).collect();
    if all.len() < MIN_PAIRS {
        return None;
    }
    let step = all.len().div_ceil(MAX_PAIRS);
    let pairs: Vec<&PulsePair> = all.iter().step_by(step).collect();
    let angle_at = |shift: f64| median_angle(&pairs, trajectory, shift);
    let before = angle_at(0.0)?;
    let (mut best, mut least) = (0.0, before);
    let mut width = FARTHEST;
    for step in STEPS {
        #[expect(clippy::cast_possible_truncation, reason = "some tens of steps")]
        let count = (width / step).round() as i32;
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
    let is_better = before > MIN_GAIN * least && before - least > MIN_ANGLE;
    if !(is_better && TRAJECTORY_TIME.is_exceeded_by(best)) {
        return None;
    }
    let whole = best.round();
    let of_clock = angle_at(whole).filter(|&angle| (best - whole).abs() <= NEAR_WHOLE && angle <= CERTAIN_ANGLE);
    Some(match of_clock {
        Some(angle) => TimeOffset { seconds: whole, is_applied: true, angles: [before, angle] },
        None => TimeOffset { seconds: best, is_applied: false, angles: [before, least] },
    })
}

/// Median angle between pulses and the directions to a path that is `shift` seconds later, radians; `None` where it is
/// not known for most of them.
fn median_angle(pairs: &[&PulsePair], trajectory: &Trajectory, shift: f64) -> Option<f64> {
    let angle = |pair: &&PulsePair| {
        let from_scanner = sub(pair.first, trajectory.position_at(pair.time + shift)?);
        let dot: f64 = (0..3).map(|i| from_scanner[i] * pair.along[i]).sum();
        Some(length(cross(from_scanner, pair.along)).atan2(dot))
    };
    let mut angles: Vec<f64> = pairs.iter().filter_map(angle).collect();
    if (angles.len() as f64) < MIN_KNOWN * pairs.len() as f64 {
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
                #[expect(clippy::cast_possible_truncation, reason = "positions are f32")]
                positions.push(std::array::from_fn(|k| (scanner[k] + part * way[k] - origin[k] + noise) as f32));
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
