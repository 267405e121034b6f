//! Airborne laser scanner over parallel flight strips.

use rayon::prelude::*;

use crate::random::Random;
use crate::scan::Scan;
use crate::scan::beam::BeamParams;
use crate::scan::flight::{FlightStrip, mean_coverage, strips, width_across};
use crate::scan::recording::{Recorder, Shot};
use crate::scan::scan_pattern::{PulseSweep, ScanPattern};
use crate::scene::TriangleScene;
use crate::truth::Truth;

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

    fn leaves_something_to_fly(&self) -> bool {
        let angle = self.greatest_angle();
        let sizes = [self.flying_height, self.speed, self.pulses_per_m2, angle];
        sizes.iter().all(|v| v.is_finite() && *v > 0.0) && angle < std::f64::consts::FRAC_PI_2
    }
}

/// Maximum number of strips that [`AirborneParams::spread_over`] chooses without a count.
const MAX_STRIPS: u32 = 1000;

/// Flies over `scene` and returns the recorded scan.
///
/// Each pulse draws its noise from its own stream, so the scan has the same bits for any number of threads. The cost is
/// that of seven rays for each pulse that meets the scene. [`AirborneParams::pattern`] sets the directions of the
/// pulses. The aircraft does not roll, pitch or yaw.
///
/// The scan angle is the component of the angle from nadir across the flight, as in files of conical scanners. For a
/// cone of 20° it runs from -20° to 20° and is 0 straight ahead and behind, although every pulse is 20° from nadir.
#[must_use]
pub fn scan_airborne(scene: &TriangleScene, params: &AirborneParams) -> Scan {
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

/// Returns the scan of one line of a strip.
fn scan_line(scene: &TriangleScene, truth: &Truth, params: &AirborneParams, strip: &FlightStrip, line: u32) -> Scan {
    let mut scan = Scan::default();
    let recorder = Recorder {
        scene,
        truth,
        beam: &params.beam,
        max_range: f64::INFINITY,
        range_sd: params.range_sd,
        pointing_sd: params.pointing_sd,
        boresight: strip.boresight,
        dropout: params.dropout,
        point_source_id: strip.number + 1,
        intensity_range: Some(params.flying_height),
    };
    let sweep = params.sweep();
    let rate = params.pulse_rate();
    for step in 0..sweep.pulses_per_line {
        let number = u64::from(line) * u64::from(sweep.pulses_per_line) + u64::from(step);
        let seconds = number as f64 / rate;
        let (axis, scan_angle) = sweep.pulse(strip.position(seconds), &strip.course, line, step);
        let mut random = Random::new(params.seed, (u64::from(strip.number) << 48) | number);
        let shot = Shot { axis, gps_time: strip.start_time + seconds, scan_angle };
        recorder.record(&shot, &mut random, &mut scan);
    }
    scan
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
pub(crate) fn saturating_count(count: f64) -> u32 {
    count.ceil() as u32
}
