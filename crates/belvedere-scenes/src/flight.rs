//! Parallel flight strips over a scene.

use std::f64::consts::TAU;

use crate::airborne::AirborneParams;
use crate::random::Random;
use crate::scan::SensorPath;
use crate::scene::Scene;
use crate::vector::add_scaled;

/// Time flown straight before the first and after the last pulse of a strip, seconds: interpolation in the path needs
/// neighbours on both sides.
const RUN_UP: f64 = 1.0;
/// Distance between positions of the path, seconds: 20 Hz, so that a straight line between two of them stays within a
/// millimetre of the wandering path.
const PATH_STEP: f64 = 0.05;
/// Ground flown over beyond the scene at both ends, metres.
const OVERSHOOT: f64 = 5.0;
/// Periods of the wander, seconds: an aircraft held by an autopilot.
const WANDER_PERIODS: [f64; 2] = [9.0, 5.5];

/// One pass over a scene.
#[derive(Clone, Debug)]
pub(crate) struct Strip {
    /// Counted from 0.
    pub(crate) number: u16,
    /// Unit vectors of the flight, level.
    pub(crate) forward: [f64; 3],
    pub(crate) right: [f64; 3],
    /// GPS time of the first pulse.
    pub(crate) start_time: f64,
    /// Seconds from the first pulse to the last.
    pub(crate) duration: f64,
    /// Constant error of the mounting of the scanner, radians about the axes across a pulse.
    pub(crate) boresight: [f64; 2],
    start: [f64; 3],
    speed: f64,
    wander: f64,
    /// Phases of the sideways and the vertical wander.
    phases: [f64; 2],
}

impl Strip {
    /// Position of the scanner `seconds` after the first pulse, absolute, metres.
    pub(crate) fn position(&self, seconds: f64) -> [f64; 3] {
        let wave = |i: usize| (TAU * seconds / WANDER_PERIODS[i] + self.phases[i]).sin();
        let on_line = add_scaled(self.start, self.forward, self.speed * seconds);
        let aside = add_scaled(on_line, self.right, self.wander * wave(0));
        [aside[0], aside[1], aside[2] + 0.5 * self.wander * wave(1)]
    }

    /// The path flown, run-up included.
    pub(crate) fn path(&self) -> SensorPath {
        let mut path = SensorPath::default();
        let mut step = 0_u32;
        loop {
            let seconds = f64::from(step) * PATH_STEP - RUN_UP;
            path.times.push(self.start_time + seconds);
            path.positions.push(self.position(seconds));
            if seconds > self.duration + RUN_UP {
                return path;
            }
            step += 1;
        }
    }
}

/// Strips side by side over the middle of `scene`, flown to and fro. None over an empty scene.
pub(crate) fn strips(scene: &Scene, params: &AirborneParams) -> Vec<Strip> {
    let Some((low, high)) = scene.bounds() else { return Vec::new() };
    let height = scene.mean_ground_height() + params.flying_height;
    let centre = [low[0] / 2.0 + high[0] / 2.0, low[1] / 2.0 + high[1] / 2.0, height];
    let (sin, cos) = params.heading.sin_cos();
    let half_length = (sin.abs() * (high[0] - low[0]) + cos.abs() * (high[1] - low[1])) / 2.0 + OVERSHOOT;
    let duration = 2.0 * half_length / params.speed;
    let mut start_time = params.start_time + RUN_UP;
    (0..params.strip_count)
        .map(|number| {
            let offset = (f64::from(number) - (f64::from(params.strip_count) - 1.0) / 2.0) * params.strip_spacing;
            let sense = if number % 2 == 0 { 1.0 } else { -1.0 };
            let forward = [sense * sin, sense * cos, 0.0];
            let right = [sense * cos, -sense * sin, 0.0];
            let start = add_scaled(add_scaled(centre, right, sense * offset), forward, -half_length);
            let mut random = Random::new(params.seed, u64::MAX - u64::from(number));
            let strip = Strip {
                number,
                forward,
                right,
                start_time,
                duration,
                boresight: [0, 1].map(|_| params.boresight_sd * random.normal()),
                start,
                speed: params.speed,
                wander: params.wander,
                phases: [0, 1].map(|_| random.between(0.0, TAU)),
            };
            // A turn lasts at least as long as the run-ups, or else times would run backwards.
            start_time += duration + params.turn_time.max(4.0 * RUN_UP);
            strip
        })
        .collect()
}
