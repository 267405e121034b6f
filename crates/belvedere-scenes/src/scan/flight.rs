//! Parameters of an airborne survey, and its parallel flight strips over a scene.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::random::Random;
use crate::scan::SensorPath;
use crate::scan::beam::BeamParams;
use crate::scan::scan_pattern::{FlightAxes, PulseSweep, ScanPattern};
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

/// Default number of pulses per m², usual in national surveys.
pub const DENSITY: f64 = 10.0;

/// Parameters of an airborne survey. A height, speed, density or angle that is not positive leaves nothing to fly, and
/// gives a scan without points.
#[derive(Clone, Debug, PartialEq)]
pub struct AirborneParams {
    /// Seed of noise and wander, any number. Default 1.
    pub seed: u64,
    /// Path of the pulses over the ground. Default rotating.
    pub pattern: ScanPattern,
    /// Height above the mean ground, metres, 50 to 5000. Default 450: usual for town surveys of ten points per m².
    pub flying_height: f64,
    /// Speed over ground, metres per second, 10 to 150. Default 60.
    pub speed: f64,
    /// Heading of the first strip, radians clockwise from north; every second strip is flown back. Default π/6: oblique
    /// to the streets, so that walls of all sides get points, about one per m² with the other defaults.
    pub heading: f64,
    /// Number of strips, 1 to 1000. Default 2.
    pub strip_count: u16,
    /// Distance between strips, metres. Default 260. With the default height and angle, strips of 420 m then overlap by
    /// 38 %. The default town lies in the overlap, seen under 9° to 23° from either side.
    pub strip_spacing: f64,
    /// Number of further strips at right angles to the others, with the same spacing, 0 to 1000. Default 0.
    pub cross_strip_count: u16,
    /// Maximum angle from nadir, radians, 0 to 1.2; a conical pattern has its own. Default 25°.
    pub half_angle: f64,
    /// Mean number of pulses per m² in a strip on level ground, 0.01 to 100. Default 5.5: two strips give about ten. It
    /// sets [`AirborneParams::line_rate`] and [`AirborneParams::pulse_rate`].
    pub pulses_per_m2: f64,
    /// Shape of the pulses.
    pub beam: BeamParams,
    /// Standard deviation of a range, metres, 0 to 0.1. Up to a tenth of the range resolution, returns of a pulse stay
    /// in order. Default 0.02, as in data sheets.
    pub range_sd: f64,
    /// Standard deviation of the direction of a pulse about each of two axes, radians, 0 to 0.001. Default 4e-5: 2 cm
    /// on the ground.
    pub pointing_sd: f64,
    /// Standard deviation of the constant error of the direction in a strip, radians, 0 to 0.001. Default 2e-5: strips
    /// fit to 1 or 2 cm, as after a good adjustment.
    pub boresight_sd: f64,
    /// Share of pulses lost, 0 to 1. Default 0.01.
    pub dropout: f64,
    /// Amplitude of the sideways deviation from the straight line, metres, 0 to 20; half of it up and down. Default 1.
    pub wander: f64,
    /// Adjusted standard GPS time at the start, seconds. Default 3e8, a day in March 2021.
    pub start_time: f64,
    /// Time between the last pulse of a strip and the first of the next, seconds, at least 4. Default 240.
    pub turn_time: f64,
}

impl Default for AirborneParams {
    fn default() -> Self {
        Self {
            seed: 1,
            pattern: ScanPattern::Rotating,
            flying_height: 450.0,
            speed: 60.0,
            heading: std::f64::consts::FRAC_PI_6,
            strip_count: 2,
            strip_spacing: 260.0,
            cross_strip_count: 0,
            half_angle: 25_f64.to_radians(),
            pulses_per_m2: 5.5,
            beam: BeamParams::default(),
            range_sd: 0.02,
            pointing_sd: 4e-5,
            boresight_sd: 2e-5,
            dropout: 0.01,
            wander: 1.0,
            start_time: 3e8,
            turn_time: 240.0,
        }
    }
}

impl AirborneParams {
    /// Returns the parameters of a survey of `scene`, for any size, with `pulses_per_m2` in total. Strips see every
    /// place from both sides, and pulses enter crowns ([`BeamParams::in_leaf`]). The other parameters are the defaults.
    #[must_use]
    pub fn covering(scene: &TriangleScene, pulses_per_m2: f64) -> Self {
        Self { beam: BeamParams::in_leaf(), ..Self::default() }.spread_over(scene, None, pulses_per_m2)
    }

    /// Returns this scanner with strips and pulses for `scene`. The outer strips lie over its edges, with `strip_count`
    /// strips in total. All strips together have a mean of `pulses_per_m2` over its ground.
    ///
    /// Without a count, strips are at most half their width apart, so that two strips see every place from either side.
    /// With the default height and angle, a town of 150 m gets two strips, and one of 300 m three.
    #[must_use]
    pub fn spread_over(mut self, scene: &TriangleScene, strip_count: Option<u16>, pulses_per_m2: f64) -> Self {
        if !self.leaves_something_to_fly() {
            return self;
        }
        let width = width_across(scene, self.heading);
        self.strip_count = strip_count.unwrap_or_else(|| {
            let count = saturating_count(width / (self.swath() / 2.0)).saturating_add(1).clamp(2, MAX_STRIPS);
            u16::try_from(count).unwrap_or(u16::MAX)
        });
        self.strip_spacing = width / f64::from(self.strip_count.max(2) - 1);
        let coverage = mean_coverage(scene, &self);
        self.pulses_per_m2 = if coverage > 0.0 { pulses_per_m2 / coverage } else { pulses_per_m2 };
        self
    }

    /// Returns the number of scan lines (sweeps of the mirror, turns of the cone) per second. Lines are as far apart as
    /// pulses within a line are on average. For a cone this holds below the aircraft, where two lines cross every
    /// place.
    #[must_use]
    pub fn line_rate(&self) -> f64 {
        match self.pattern {
            ScanPattern::Rotating | ScanPattern::Oscillating(_) => self.speed * self.pulses_per_m2.sqrt(),
            ScanPattern::Conical { .. } => self.speed * (self.pulses_per_m2 / std::f64::consts::PI).sqrt(),
        }
    }

    /// Returns the number of pulses per second. All of them fall within the scan angle; a real mirror wastes some.
    #[must_use]
    pub fn pulse_rate(&self) -> f64 {
        f64::from(self.pulses_per_line()) * self.line_rate()
    }

    /// Returns the width of the ground that a strip covers, metres.
    #[must_use]
    pub fn swath(&self) -> f64 {
        2.0 * self.flying_height * self.greatest_angle().tan()
    }

    /// Returns the maximum angle of a pulse from nadir, radians.
    #[must_use]
    pub fn greatest_angle(&self) -> f64 {
        if let ScanPattern::Conical { half_angle } = self.pattern { half_angle } else { self.half_angle }
    }

    pub(crate) fn sweep(&self) -> PulseSweep {
        PulseSweep { pattern: self.pattern, half_angle: self.greatest_angle(), pulses_per_line: self.pulses_per_line() }
    }

    fn pulses_per_line(&self) -> u32 {
        match self.pattern {
            ScanPattern::Rotating | ScanPattern::Oscillating(_) => {
                saturating_count(self.swath() * self.pulses_per_m2.sqrt())
            }
            // Around the circle, pulses are as far apart as the circles are.
            ScanPattern::Conical { .. } => {
                saturating_count(self.swath() * (std::f64::consts::PI * self.pulses_per_m2).sqrt())
            }
        }
    }

    pub(crate) fn leaves_something_to_fly(&self) -> bool {
        let angle = self.greatest_angle();
        let sizes = [self.flying_height, self.speed, self.pulses_per_m2, angle];
        sizes.iter().all(|v| v.is_finite() && *v > 0.0) && angle < FRAC_PI_2
    }
}

/// Maximum number of strips that [`AirborneParams::spread_over`] chooses without a count.
const MAX_STRIPS: u32 = 1000;

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

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
pub(crate) fn saturating_count(count: f64) -> u32 {
    count.ceil() as u32
}
