//! Two laser scanners on the roof of a car that drives through streets.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use rayon::prelude::*;

use crate::random::Random;
use crate::scan::beam::{Axis, BeamParams};
use crate::scan::flight::saturating_count;
use crate::scan::recording::{Recorder, Shot};
use crate::scan::{Scan, SensorPath};
use crate::scene::{Material, TriangleScene};
use crate::truth::Truth;
use crate::vector::cross;

/// Parameters of a scan from a car. A range, speed or rate that is not positive leaves nothing to scan, and gives a
/// scan without points.
#[derive(Clone, Debug, PartialEq)]
pub struct MobileParams {
    /// Seed of the noise, any number. Default 1.
    pub seed: u64,
    /// Both ends of each run, (R, 2, 2), metres, absolute; runs beyond 65 535 are left out. Default none.
    pub runs: Vec<[[f64; 2]; 2]>,
    /// Height of the scanners above the ground, metres, 0.5 to 10. Default 2.2.
    pub scanner_height: f64,
    /// Speed, metres per second, 0.1 to 40. Default 8.
    pub speed: f64,
    /// Turns of each mirror per second, 1 to 1000. Default 100: 8 cm from line to line.
    pub line_rate: f64,
    /// Number of pulses in a turn of a mirror, 10 to 100 000. Default 1000: 4 cm at 6 m.
    pub pulses_per_line: u32,
    /// Maximum range of a surface that gives an echo, metres, 1 to 5000. Default 100.
    pub max_range: f64,
    /// Shape of the pulses. Default 0.4 mrad wide, in crowns as [`BeamParams::in_leaf`].
    pub beam: BeamParams,
    /// Standard deviation of a range, metres, 0 to 0.1. Default 0.005.
    pub range_sd: f64,
    /// Standard deviation of the direction of a pulse about each of two axes, radians, 0 to 0.001. Default 2e-4: the
    /// remaining errors of a trajectory within one run.
    pub pointing_sd: f64,
    /// Share of pulses lost, 0 to 1. Default 0.01.
    pub dropout: f64,
    /// Adjusted standard GPS time at the start, seconds. Default 3e8, a day in March 2021.
    pub start_time: f64,
}

impl Default for MobileParams {
    fn default() -> Self {
        Self {
            seed: 1,
            runs: Vec::new(),
            scanner_height: 2.2,
            speed: 8.0,
            line_rate: 100.0,
            pulses_per_line: 1000,
            max_range: 100.0,
            beam: BeamParams { divergence: 4e-4, ..BeamParams::in_leaf() },
            range_sd: 0.005,
            pointing_sd: 2e-4,
            dropout: 0.01,
            start_time: 3e8,
        }
    }
}

/// Angles of the planes of the two mirrors, radians from across the car. Both sides of every corner are seen.
const PLANES: [f64; 2] = [FRAC_PI_4, -FRAC_PI_4];
/// Time between entries of the path, seconds.
const PATH_STEP: f64 = 0.05;
/// Time between two runs, seconds: longer than readers interpolate over.
const TURN_TIME: f64 = 30.0;
/// Time before the first and after the last line for which the path is recorded, seconds.
const SETTLED: f64 = 0.5;

/// Drives a car with two scanners along the runs and returns the recorded scan.
///
/// The mirrors turn about level axes, 45° to either side of the driving direction. Returns of a run have its number as
/// point source id. The scanners are channels of one instrument in the same place. Each pulse draws its noise from its
/// own stream, so the scan has the same bits for any number of threads.
#[must_use]
pub fn scan_mobile(scene: &TriangleScene, params: &MobileParams) -> Scan {
    let mut scan = Scan::default();
    let sizes = [params.speed, params.line_rate, params.max_range];
    if params.pulses_per_line == 0 || !sizes.iter().all(|v| v.is_finite() && *v > 0.0) {
        return scan;
    }
    let truth = Truth::new(scene);
    let mut start_time = params.start_time + SETTLED;
    for (number, &ends) in (1..=u16::MAX).zip(&params.runs) {
        let Some(run) = StraightDrive::new(scene, &truth, params, number, ends, start_time) else { continue };
        let lines = saturating_count(run.duration * params.line_rate);
        let scanned: Vec<Scan> =
            (0..lines).into_par_iter().map(|line| scan_line(scene, &truth, params, &run, line)).collect();
        for line in scanned {
            scan.append(line);
        }
        scan.append(Scan { sensor_path: run.path(), ..Scan::default() });
        start_time += run.duration + TURN_TIME;
    }
    scan
}

/// One straight drive.
struct StraightDrive {
    /// Number of the run, counted from 1.
    number: u16,
    from: [f64; 2],
    /// Unit vector along the run.
    ahead: [f64; 2],
    /// Height of the scanner every [`StraightDrive::STEP`] metres.
    heights: Vec<f64>,
    start_time: f64,
    duration: f64,
    speed: f64,
}

impl StraightDrive {
    /// Distance between sampled heights of the ground, metres: a car rides over shorter bumps.
    const STEP: f64 = 2.0;

    /// Creates a run; `None` for a run without length, or with a sampled place without ground.
    fn new(
        scene: &TriangleScene,
        truth: &Truth,
        params: &MobileParams,
        number: u16,
        [from, to]: [[f64; 2]; 2],
        start_time: f64,
    ) -> Option<Self> {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let ahead = [0, 1].map(|axis| (to[axis] - from[axis]) / length);
        let sky = scene.bounds()?.1[2] + 1.0;
        let ground = |along: f64| {
            let at = [from[0] + along * ahead[0], from[1] + along * ahead[1]];
            lowest_ground(scene, truth, at, sky)
        };
        let steps = saturating_count(length / Self::STEP) + 1;
        let heights: Option<Vec<f64>> = (0..=steps).map(|i| ground((f64::from(i) * Self::STEP).min(length))).collect();
        let heights = heights?.into_iter().map(|z| z + params.scanner_height).collect();
        let duration = length / params.speed;
        (length > 0.0).then_some(Self { number, from, ahead, heights, start_time, duration, speed: params.speed })
    }

    /// Returns the position of the scanners `seconds` after the start of the run, also before the start or after the
    /// end.
    fn position(&self, seconds: f64) -> [f64; 3] {
        let along = self.speed * seconds;
        let place = (along / Self::STEP).clamp(0.0, (self.heights.len() - 2) as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the places there are")]
        let step = place as usize;
        let share = place - step as f64;
        let z = self.heights[step] * (1.0 - share) + self.heights[step + 1] * share;
        [self.from[0] + along * self.ahead[0], self.from[1] + along * self.ahead[1], z]
    }

    fn path(&self) -> SensorPath {
        let steps = saturating_count((self.duration + 2.0 * SETTLED) / PATH_STEP);
        let seconds = || (0..=steps).map(|i| f64::from(i) * PATH_STEP - SETTLED);
        let heading = self.ahead[0].atan2(self.ahead[1]).rem_euclid(TAU);
        SensorPath {
            times: seconds().map(|s| self.start_time + s).collect(),
            positions: seconds().map(|s| self.position(s)).collect(),
            headings: seconds().map(|_| heading).collect(),
        }
    }
}

/// Returns the height of the ground or of a bridge at a place. Crowns and decks above it are ignored.
fn lowest_ground(scene: &TriangleScene, truth: &Truth, [x, y]: [f64; 2], sky: f64) -> Option<f64> {
    let mut top = sky;
    while let Some(hit) = truth.first_hit([x, y, top], [0.0, 0.0, -1.0], f64::INFINITY) {
        let z = top - hit.range;
        if matches!(scene.materials.get(hit.triangle as usize), Some(Material::Terrain | Material::Bridge)) {
            return Some(z);
        }
        top = z - 1e-3;
    }
    None
}

/// Returns the scan of both scanners during one turn of their mirrors.
fn scan_line(scene: &TriangleScene, truth: &Truth, params: &MobileParams, run: &StraightDrive, line: u32) -> Scan {
    let mut scan = Scan::default();
    let recorder = Recorder {
        scene,
        truth,
        beam: &params.beam,
        max_range: params.max_range,
        range_sd: params.range_sd,
        pointing_sd: params.pointing_sd,
        boresight: [0.0; 2],
        dropout: params.dropout,
        point_source_id: run.number,
        intensity_range: None,
    };
    let pulses = params.pulses_per_line;
    for pulse in 0..pulses {
        for (scanner, plane) in (0_u32..).zip(PLANES) {
            // The second mirror is half a pulse behind, so that no two pulses share a time.
            let turn = (f64::from(pulse) + 0.5 * f64::from(scanner)) / f64::from(pulses);
            let seconds = (f64::from(line) + turn) / params.line_rate;
            let number = (u64::from(line) * u64::from(pulses) + u64::from(pulse)) * 2 + u64::from(scanner);
            let angle = TAU * turn;
            let shot = Shot {
                axis: axis(run.position(seconds), run.ahead, plane, angle),
                gps_time: run.start_time + seconds,
                scan_angle: if angle > PI { angle - TAU } else { angle },
            };
            let mut random = Random::new(params.seed, (u64::from(run.number) << 48) | number);
            recorder.record(&shot, &mut random, &mut scan);
        }
    }
    scan
}

/// Returns the pulse of a mirror at `angle` from straight down. The plane of the mirror is turned by `plane` from
/// across the driving direction `ahead`.
fn axis(origin: [f64; 3], ahead: [f64; 2], plane: f64, angle: f64) -> Axis {
    let (sin, cos) = plane.sin_cos();
    let right = [ahead[1], -ahead[0]];
    let level = [0, 1].map(|axis| cos * right[axis] + sin * ahead[axis]);
    let (side, down) = angle.sin_cos();
    let direction = [side * level[0], side * level[1], -down];
    let turning = [-level[1], level[0], 0.0];
    Axis { origin, direction, across: [turning, cross(direction, turning)] }
}
