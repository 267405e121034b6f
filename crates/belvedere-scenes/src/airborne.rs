//! An airborne laser scanner with a rotating mirror over parallel flight strips.

use rayon::prelude::*;

use crate::beam::{Axis, BeamParams, Echo, pulse_echoes};
use crate::flight::{Strip, strips};
use crate::random::Random;
use crate::scan::{Return, Scan};
use crate::scene::Scene;
use crate::truth::Truth;
use crate::vector::{add_scaled, scale};

/// How a scene is flown. Values outside their ranges that leave nothing to fly (a height, speed, density or angle that is not
/// positive) give a scan without points.
#[derive(Clone, Debug, PartialEq)]
pub struct AirborneParams {
    /// Any number; another one gives other noise and another wander. Default 1.
    pub seed: u64,
    /// Height above the mean ground, metres, 50 to 5000. Default 450: usual for town surveys of ten points per m².
    pub flying_height: f64,
    /// Speed over ground, metres per second, 10 to 150. Default 60.
    pub speed: f64,
    /// Heading of the first strip, radians clockwise from north; every second strip is flown back. Default π/6: oblique to
    /// the streets, so that walls of all sides get points, about one per m² with the other defaults.
    pub heading: f64,
    /// Strips, 1 to 1000. Default 2.
    pub strip_count: u16,
    /// Distance between strips, metres. Default 260: with the default height and angle, strips of 420 m overlap by 38 %, and
    /// the default town lies in the overlap, seen under 9° to 23° from either side.
    pub strip_spacing: f64,
    /// Greatest angle from nadir, radians, 0 to 1.2. Default 25°.
    pub half_angle: f64,
    /// Pulses per m² and strip on level ground, mean over the strip, 0.01 to 100. Default 5.5: two strips give about ten. It
    /// sets [`AirborneParams::line_rate`] and [`AirborneParams::pulse_rate`].
    pub pulses_per_m2: f64,
    /// Shape of the pulses.
    pub beam: BeamParams,
    /// Standard deviation of a range, metres, 0 to 0.1; at most a tenth of the range resolution keeps returns of a pulse in
    /// order. Default 0.02, as data sheets state.
    pub range_sd: f64,
    /// Standard deviation of the direction of a pulse about each of two axes, radians, 0 to 0.001. Default 4e-5: 2 cm on the
    /// ground.
    pub pointing_sd: f64,
    /// Standard deviation of the constant error of the direction in a strip, radians, 0 to 0.001. Default 2e-5: strips fit
    /// to 1 or 2 cm, as after a good adjustment.
    pub boresight_sd: f64,
    /// Share of pulses lost, 0 to 1. Default 0.01.
    pub dropout: f64,
    /// Amplitude of the sideways departure from the straight line, metres, 0 to 20; half of it up and down. Default 1.
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
            flying_height: 450.0,
            speed: 60.0,
            heading: std::f64::consts::FRAC_PI_6,
            strip_count: 2,
            strip_spacing: 260.0,
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
    /// Scan lines per second, chosen so that lines are as far apart as pulses within a line are on average.
    #[must_use]
    pub fn line_rate(&self) -> f64 {
        self.speed * self.pulses_per_m2.sqrt()
    }

    /// Pulses per second. All of them fall within the scan angle, whereas a real mirror wastes some.
    #[must_use]
    pub fn pulse_rate(&self) -> f64 {
        f64::from(self.pulses_per_line()) * self.line_rate()
    }

    /// Width of the ground that a strip covers, metres.
    #[must_use]
    pub fn swath(&self) -> f64 {
        2.0 * self.flying_height * self.half_angle.tan()
    }

    fn pulses_per_line(&self) -> u32 {
        saturating_count(self.swath() * self.pulses_per_m2.sqrt())
    }

    fn leaves_something_to_fly(&self) -> bool {
        let sizes = [self.flying_height, self.speed, self.pulses_per_m2, self.half_angle];
        sizes.iter().all(|v| v.is_finite() && *v > 0.0) && self.half_angle < std::f64::consts::FRAC_PI_2
    }
}

/// Flies over `scene` and returns what the scanner records.
///
/// Each pulse draws its noise from its own stream, so the scan has the same bits for any number of threads. The cost is that
/// of seven rays for each pulse that meets the scene. Pulses are sent along parallel lines across the flight direction, at
/// equal steps of the scan angle; the aircraft neither rolls, pitches nor yaws.
#[must_use]
pub fn scan_airborne(scene: &Scene, params: &AirborneParams) -> Scan {
    let mut scan = Scan::default();
    if !params.leaves_something_to_fly() {
        return scan;
    }
    let truth = Truth::new(scene);
    for strip in strips(scene, params) {
        let line_count = saturating_count(strip.duration * params.line_rate());
        let lines: Vec<Scan> =
            (0..line_count).into_par_iter().map(|line| scan_line(scene, &truth, params, &strip, line)).collect();
        for line in lines {
            scan.append(line);
        }
        scan.append(Scan { sensor_path: strip.path(), ..Scan::default() });
    }
    scan
}

/// Returns of one line of a strip.
fn scan_line(scene: &Scene, truth: &Truth, params: &AirborneParams, strip: &Strip, line: u32) -> Scan {
    let mut scan = Scan::default();
    let pulse_count = params.pulses_per_line();
    let rate = params.pulse_rate();
    for step in 0..pulse_count {
        let number = u64::from(line) * u64::from(pulse_count) + u64::from(step);
        let seconds = number as f64 / rate;
        let scan_angle = params.half_angle * (2.0 * (f64::from(step) + 0.5) / f64::from(pulse_count) - 1.0);
        let axis = pulse_axis(strip, seconds, scan_angle);
        let mut random = Random::new(params.seed, (u64::from(strip.number) << 48) | number);

        scan.report.pulses += 1;
        let pulse = pulse_echoes(scene, truth, &axis, &params.beam, &mut random);
        if pulse.echoes.is_empty() && pulse.dropped == 0 {
            scan.report.missed_pulses += 1;
            continue;
        }
        if random.chance(params.dropout) {
            scan.report.dropped_pulses += 1;
            continue;
        }
        scan.report.dropped_echoes += pulse.dropped as u64;
        let pointing = strip.boresight.map(|constant| constant + params.pointing_sd * random.normal());
        let return_count = u8::try_from(pulse.echoes.len()).unwrap_or(u8::MAX);
        for (return_number, echo) in (1..=return_count).zip(&pulse.echoes) {
            let range = echo.range + params.range_sd * random.normal();
            scan.push(Return {
                position: add_scaled(axis.origin, axis.tilted(echo.direction, pointing), range),
                gps_time: strip.start_time + seconds,
                return_number,
                return_count,
                scan_angle_deg: degrees_f32(scan_angle),
                point_source_id: strip.number + 1,
                classification: echo.material.asprs_class(),
                intensity: intensity(echo, params.flying_height),
                triangle: echo.triangle,
                exact_position: add_scaled(axis.origin, echo.direction, echo.range),
            });
        }
    }
    scan
}

/// The pulse sent `seconds` after the first of the strip, `scan_angle` radians to the right of nadir.
fn pulse_axis(strip: &Strip, seconds: f64, scan_angle: f64) -> Axis {
    let (sin, cos) = scan_angle.sin_cos();
    let up = [0.0, 0.0, 1.0];
    let direction = add_scaled(scale(strip.right, sin), up, -cos);
    let outwards = add_scaled(scale(strip.right, cos), up, sin);
    Axis { origin: strip.position(seconds), direction, across: [strip.forward, outwards] }
}

/// Intensity that leaves room above a perfect white target straight below: an echo at the flying height that sends
/// everything back has 50 000.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range of u16")]
fn intensity(echo: &Echo, flying_height: f64) -> u16 {
    let spreading = (flying_height / echo.range).powi(2);
    (50_000.0 * echo.brightness * spreading).round().clamp(0.0, f64::from(u16::MAX)) as u16
}

#[expect(clippy::cast_possible_truncation, reason = "a scan angle needs no more digits than f32 has")]
fn degrees_f32(angle: f64) -> f32 {
    angle.to_degrees() as f32
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
fn saturating_count(count: f64) -> u32 {
    count.ceil() as u32
}
