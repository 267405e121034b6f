//! Parallel flight strips over a scene.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::random::Random;
use crate::scan::SensorPath;
use crate::scan::airborne::AirborneParams;
use crate::scan::scan_pattern::{FlightAxes, ScanPattern};
use crate::scene::TriangleScene;
use crate::vector::add_scaled;

/// Time of straight flight before the first and after the last pulse of a strip, seconds. Interpolation in the path
/// needs neighbours on both sides.
const RUN_UP: f64 = 1.0;
/// Time between positions of the path, seconds. At 20 Hz a straight line between two positions stays within a
/// millimetre of the wandering path.
const PATH_STEP: f64 = 0.05;
/// Length of the flight beyond the scene at both ends, metres.
const OVERSHOOT: f64 = 5.0;
/// Periods of the wander, seconds, for an aircraft with an autopilot.
const WANDER_PERIODS: [f64; 2] = [9.0, 5.5];

/// One pass over a scene.
#[derive(Clone, Debug)]
pub(crate) struct FlightStrip {
    /// Number of the strip, counted from 0.
    pub(crate) number: u16,
    pub(crate) course: FlightAxes,
    /// Direction of the flight, radians clockwise from north, 0 to 2π.
    heading: f64,
    /// GPS time of the first pulse, seconds.
    pub(crate) start_time: f64,
    /// Time from the first pulse to the last, seconds.
    pub(crate) duration: f64,
    /// Constant error of the mounting of the scanner, radians about the axes across a pulse.
    pub(crate) boresight: [f64; 2],
    start: [f64; 3],
    speed: f64,
    wander: f64,
    /// Phases of the sideways and the vertical wander.
    phases: [f64; 2],
}

impl FlightStrip {
    /// Returns the position of the scanner `seconds` after the first pulse, absolute, metres.
    pub(crate) fn position(&self, seconds: f64) -> [f64; 3] {
        let wave = |i: usize| (TAU * seconds / WANDER_PERIODS[i] + self.phases[i]).sin();
        let on_line = add_scaled(self.start, self.course.forward, self.speed * seconds);
        let aside = add_scaled(on_line, self.course.right, self.wander * wave(0));
        [aside[0], aside[1], aside[2] + 0.5 * self.wander * wave(1)]
    }

    /// Returns the path of the flight, run-up included.
    pub(crate) fn path(&self) -> SensorPath {
        let mut path = SensorPath::default();
        let mut step = 0_u32;
        loop {
            let seconds = f64::from(step) * PATH_STEP - RUN_UP;
            path.times.push(self.start_time + seconds);
            path.positions.push(self.position(seconds));
            path.headings.push(self.heading);
            if seconds > self.duration + RUN_UP {
                return path;
            }
            step += 1;
        }
    }
}

/// Returns strips side by side over the middle of `scene`, flown to and fro, then the strips across them. An empty
/// scene has no strips.
pub(crate) fn strips(scene: &TriangleScene, params: &AirborneParams) -> Vec<FlightStrip> {
    let along = strips_towards(scene, params, params.heading, 0..params.strip_count, params.start_time + RUN_UP);
    let start_time = along.last().map_or(params.start_time + RUN_UP, |last| next_start(last, params));
    let last_number = params.strip_count.saturating_add(params.cross_strip_count);
    let across = params.strip_count..last_number;
    let mut strips = along;
    strips.extend(strips_towards(scene, params, params.heading + FRAC_PI_2, across, start_time));
    strips
}

/// Returns the time of the first pulse of the strip after `strip`.
fn next_start(strip: &FlightStrip, params: &AirborneParams) -> f64 {
    // A turn lasts at least as long as the run-ups; otherwise times would run backwards.
    strip.start_time + (strip.duration + params.turn_time.max(4.0 * RUN_UP))
}

/// Returns the strips `numbers`, flown to and fro along `heading`, the first from `start_time` on.
fn strips_towards(
    scene: &TriangleScene,
    params: &AirborneParams,
    heading: f64,
    numbers: std::ops::Range<u16>,
    mut start_time: f64,
) -> Vec<FlightStrip> {
    let Some((low, high)) = scene.bounds() else { return Vec::new() };
    let height = scene.mean_ground_height() + params.flying_height;
    let centre = [low[0] / 2.0 + high[0] / 2.0, low[1] / 2.0 + high[1] / 2.0, height];
    let (sin, cos) = heading.sin_cos();
    // A cone looks ahead: the part of the circle behind the aircraft must pass the far edge, too.
    let look_ahead = match params.pattern {
        ScanPattern::Rotating | ScanPattern::Oscillating(_) => 0.0,
        ScanPattern::Conical { .. } => params.swath() / 2.0,
    };
    let extent = sin.abs() * (high[0] - low[0]) + cos.abs() * (high[1] - low[1]);
    let half_length = extent / 2.0 + OVERSHOOT + look_ahead;
    let duration = 2.0 * half_length / params.speed;
    let count = numbers.len() as f64;
    numbers
        .enumerate()
        .map(|(place, number)| {
            let offset = (place as f64 - (count - 1.0) / 2.0) * params.strip_spacing;
            let sense = if place % 2 == 0 { 1.0 } else { -1.0 };
            let forward = [sense * sin, sense * cos, 0.0];
            let right = [sense * cos, -sense * sin, 0.0];
            let start = add_scaled(add_scaled(centre, right, sense * offset), forward, -half_length);
            let mut random = Random::new(params.seed, u64::MAX - u64::from(number));
            let strip = FlightStrip {
                number,
                course: FlightAxes { forward, right },
                heading: forward[0].atan2(forward[1]).rem_euclid(TAU),
                start_time,
                duration,
                boresight: [0, 1].map(|_| params.boresight_sd * random.normal()),
                start,
                speed: params.speed,
                wander: params.wander,
                phases: [0, 1].map(|_| random.between(0.0, TAU)),
            };
            start_time = next_start(&strip, params);
            strip
        })
        .collect()
}

/// Returns the width of the ground of `scene` across a flight along `heading`, metres; 0 for an empty scene.
pub(crate) fn width_across(scene: &TriangleScene, heading: f64) -> f64 {
    let Some((low, high)) = scene.bounds() else { return 0.0 };
    let (sin, cos) = heading.sin_cos();
    cos.abs() * (high[0] - low[0]) + sin.abs() * (high[1] - low[1])
}

/// Number of places along each side of a scene at which coverage is computed.
const COVERAGE_STEPS: u32 = 60;

/// Returns the mean number of strips that see a place of `scene`. Each strip is weighted with the density of its pulses
/// at the place, divided by the mean of the strip.
pub(crate) fn mean_coverage(scene: &TriangleScene, params: &AirborneParams) -> f64 {
    let Some((low, high)) = scene.bounds() else { return 0.0 };
    let sweep = params.sweep();
    let place =
        |axis: usize, i: u32| (high[axis] - low[axis]) * ((f64::from(i) + 0.5) / f64::from(COVERAGE_STEPS) - 0.5);
    let sets = [(params.heading, params.strip_count), (params.heading + FRAC_PI_2, params.cross_strip_count)];
    let mut sum = 0.0;
    for (heading, count) in sets {
        let (sin, cos) = heading.sin_cos();
        for j in 0..COVERAGE_STEPS {
            for i in 0..COVERAGE_STEPS {
                let aside = place(0, i) * cos - place(1, j) * sin;
                for number in 0..count {
                    let offset = (f64::from(number) - (f64::from(count) - 1.0) / 2.0) * params.strip_spacing;
                    sum += sweep.relative_density(aside - offset, params.flying_height);
                }
            }
        }
    }
    sum / f64::from(COVERAGE_STEPS).powi(2)
}
