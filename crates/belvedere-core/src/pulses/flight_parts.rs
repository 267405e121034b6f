//! Estimates of the scanner position for parts of flight lines, and their acceptance.

use belvedere_data::{Error, Parameter, Result};
use std::fmt::Display;
use std::ops::RangeInclusive;

/// Parameters of [`SensorPositions::from_returns`](super::SensorPositions::from_returns).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorEstimateParams {
    /// Maximum duration of a part of a flight line that counts as straight and evenly flown, seconds, 0.5 to 60.
    /// Default 5: gusts move an aircraft by a metre in that time, and a tile cut from a line often holds no more.
    pub part_s: f64,
    /// Minimum distance between first and last return for a pulse to give its direction, metres, 0.5 to 50. Default 3:
    /// with 2 cm noise the direction is then good to half a degree.
    pub min_length: f64,
    /// Fewest such pulses in a part, 6 to 100 000. Default 30.
    pub min_pair_count: usize,
    /// Standard deviation of the vertical speed about zero, metres per second, 0.1 to 100. Default 2: surveys fly
    /// level, and a tile that took two seconds to pass hardly distinguishes climb from scale.
    pub vertical_speed_sd: f64,
    /// Standard deviation of the acceleration, white over a second, that the parts of a line are joined with, metres
    /// per second squared, 0.01 to 100. Default 1: an autopilot in gusts.
    pub acceleration_sd: f64,
    /// Maximum standard deviation of the position that is accepted, horizontal and vertical, metres. Default 20 and 50:
    /// seen from 450 m below, 20 m sideways tilt a pulse by 2.5°; upwards they tilt it less.
    pub greatest_sd: [f64; 2],
    /// Speeds that are accepted, metres per second. Default 15 to 120: helicopters to jets.
    pub speeds: [f64; 2],
    /// Minimum height above the middle of the returns that is accepted, metres. Default 30.
    pub min_height: f64,
}

impl Default for SensorEstimateParams {
    fn default() -> Self {
        Self {
            part_s: 5.0,
            min_length: 3.0,
            min_pair_count: 30,
            vertical_speed_sd: 2.0,
            acceleration_sd: 1.0,
            greatest_sd: [20.0, 50.0],
            speeds: [15.0, 120.0],
            min_height: 30.0,
        }
    }
}

/// Estimate for a part of a flight line.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorPart {
    /// Flight line.
    pub source_id: u16,
    /// Time of its first and last pulse, seconds.
    pub times: [f64; 2],
    /// Its pulses.
    pub pulse_count: usize,
    /// Pulses whose first and last return lie far enough apart.
    pub pair_count: usize,
    /// Position half-way between the two times, local metres, with its agreement with its neighbours; NaN where none
    /// could be computed.
    pub position: [f64; 3],
    /// Its standard deviation by the residuals, metres.
    pub position_sd: [f64; 3],
    /// Metres per second.
    pub velocity: [f64; 3],
    /// Height above the middle one of its first returns, metres; NaN where there is no position.
    pub height: f64,
    /// Median angle between the pulses and the directions to the estimated path, radians.
    pub median_angle: f64,
    /// Acceptance of the estimate.
    pub verdict: PartVerdict,
}

/// Acceptance of the estimate for a part of a flight line, with the reason for a refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartVerdict {
    /// Used.
    Accepted,
    /// Used, though its own pulses do not suffice: other parts of the line show where it must have been.
    Bridged,
    /// Too few pulses with returns far enough apart.
    TooFewPairs,
    /// The pulses do not fix a position, or not well enough: too parallel, or too few.
    Uncertain,
    /// No aircraft flies so slowly or so fast, or so low.
    Implausible,
}

impl PartVerdict {
    /// Returns true if the position of this part is used.
    #[must_use]
    pub fn is_used(self) -> bool {
        matches!(self, Self::Accepted | Self::Bridged)
    }
}

impl SensorEstimateParams {
    pub(super) fn validate(&self) -> Result<()> {
        check_range("part of a flight line", self.part_s, 0.5..=60.0, "0.5 to 60 s")?;
        check_range("minimum length of a pulse", self.min_length, 0.5..=50.0, "0.5 to 50 m")?;
        check_range("deviation of the vertical speed", self.vertical_speed_sd, 0.1..=100.0, "0.1 to 100 m/s")?;
        check_range("deviation of the acceleration", self.acceleration_sd, 0.01..=100.0, "0.01 to 100 m/s2")?;
        check_range("minimum number of pulses", self.min_pair_count as f64, 6.0..=1e5, "6 to 100000")
    }
}

/// Refuses a parameter `what` of the search for scanners that lies outside `range`.
pub(super) fn check_range<T: PartialOrd + Display>(
    what: &str,
    value: T,
    range: RangeInclusive<T>,
    expected: &'static str,
) -> Result<()> {
    let wrong = || Error::invalid(Parameter::ScannerEstimate, format!("{value} for the {what}"), expected);
    range.contains(&value).then_some(()).ok_or_else(wrong)
}

/// Acceptance thresholds for scan angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanAngleParams {
    /// Maximum duration of a part of a flight line that counts as straight and evenly flown, seconds, 0.5 to 60.
    /// Default 10.
    pub part_s: f64,
    /// Minimum standard deviation of the angles of a part, radians. Default 1°: a tile of 30 m below a scanner 450 m
    /// up.
    pub min_spread: f64,
    /// Maximum median angle between points and their expected place, across and along the flight, radians. Default 1°:
    /// half a degree of rounding, and a pitch that angles do not give.
    pub greatest_miss: f64,
    /// Maximum bend of straight scan lines, metres along the flight for each metre of height and square of the tangent
    /// of the angle. Default 0.35: a cone of 20° bends by 1.4, one of 45° by 0.5.
    pub greatest_bend: f64,
    /// Maximum tangent of the angle between scan lines and the perpendicular of the flight. Default 0.36 (20°):
    /// crabbing.
    pub greatest_crab: f64,
    /// Maximum median angle to the pulses with several returns, where there are any, radians. Default 3°.
    pub greatest_contradiction: f64,
    /// Speeds that are accepted, metres per second. Default 15 to 120: helicopters to jets.
    pub speeds: [f64; 2],
    /// Minimum height above the middle of the points that is accepted, metres. Default 30.
    pub min_height: f64,
}

impl Default for ScanAngleParams {
    fn default() -> Self {
        Self {
            part_s: 10.0,
            min_spread: 1_f64.to_radians(),
            greatest_miss: 1_f64.to_radians(),
            greatest_bend: 0.35,
            greatest_crab: 0.36,
            greatest_contradiction: 3_f64.to_radians(),
            speeds: [15.0, 120.0],
            min_height: 30.0,
        }
    }
}

/// Acceptance of the scan angles of a part of a flight line, with the reason for a refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleVerdict {
    /// Trusted.
    Accepted,
    /// Too few points with a time and an angle.
    TooFewPoints,
    /// The range of angles or times is too small to give height and flight.
    TooNarrow,
    /// Points do not lie where their angles, taken across the flight, put them: a cone, a tilted scanner, or rounded
    /// times.
    NotAcross,
    /// Scan lines are bent, as those of a cone are, or cannot be distinguished from bent ones.
    Bent,
    /// Pulses with several returns point elsewhere.
    Contradicted,
    /// No aircraft flies so slowly or so fast, or so low.
    Implausible,
}

/// Scanner position of a part of a flight line, from scan angles.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanAnglePart {
    /// Flight line.
    pub source_id: u16,
    /// First and last time, seconds.
    pub times: [f64; 2],
    /// Points.
    pub point_count: usize,
    /// Position half-way between the two times, local metres; NaN where nothing could be computed.
    pub position: [f64; 3],
    /// Metres per second.
    pub velocity: [f64; 3],
    /// Height above the middle of the points, metres.
    pub height: f64,
    /// Median angles by which points miss their place, across and along the flight, radians.
    pub misses: [f64; 2],
    /// Angle by which the scanner looks ahead, radians, as far as pulses with several returns show it; 0 where these
    /// are too few.
    pub pitch: f64,
    /// Median angle to the pulses with several returns, radians; NaN where these are too few.
    pub contradiction: f64,
    /// Acceptance of the scan angles.
    pub verdict: AngleVerdict,
}

/// A constant by which the heights of a trajectory differ from those of the cloud, such as that between ellipsoid and
/// sea.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightOffset {
    /// Metres to add to the heights of the trajectory.
    pub offset: f64,
    /// Its standard deviation, metres.
    pub sd: f64,
    /// Pulses with several returns from which it was estimated.
    pub pair_count: usize,
    /// Median angle between these pulses and the trajectory as it is used, radians.
    pub miss_angle: f64,
    /// True if the offset was added: it is significant, larger than beams can feign, and exceeds a metre.
    pub is_applied: bool,
}
