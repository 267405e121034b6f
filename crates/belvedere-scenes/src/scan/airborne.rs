//! Airborne laser scanner over parallel flight strips.

use rayon::prelude::*;

use crate::random::Random;
use crate::scan::Scan;
use crate::scan::flight::{AirborneParams, FlightStrip, saturating_count, strips};
use crate::scan::recording::{Recorder, Shot};
use crate::scene::TriangleScene;
use crate::truth::Truth;

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
