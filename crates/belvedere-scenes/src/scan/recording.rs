//! Records of a scanner for a pulse: echoes with noise, or none for a lost pulse.

use crate::random::Random;
use crate::scan::beam::{Axis, BeamParams, Echo, pulse_echoes};
use crate::scan::{Return, Scan};
use crate::scene::TriangleScene;
use crate::truth::Truth;
use crate::vector::add_scaled;

/// Scanner in its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recorder<'a> {
    pub(crate) scene: &'a TriangleScene,
    pub(crate) truth: &'a Truth,
    pub(crate) beam: &'a BeamParams,
    /// Maximum range of a surface that gives an echo, metres.
    pub(crate) max_range: f64,
    /// Standard deviation of a range, metres.
    pub(crate) range_sd: f64,
    /// Standard deviation of the direction of a pulse about each axis across it, radians.
    pub(crate) pointing_sd: f64,
    /// Constant error of the direction, radians about the axes across a pulse.
    pub(crate) boresight: [f64; 2],
    /// Share of pulses lost, 0 to 1.
    pub(crate) dropout: f64,
    pub(crate) point_source_id: u16,
    /// Range at which echoes have their full brightness, metres; farther ones have less. `None` for a scanner that
    /// corrects for the range.
    pub(crate) intensity_range: Option<f64>,
}

/// Pulse to be sent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shot {
    pub(crate) axis: Axis,
    pub(crate) gps_time: f64,
    /// Angle of the pulse, radians.
    pub(crate) scan_angle: f64,
}

impl Recorder<'_> {
    /// Sends a pulse and appends its returns to `scan`.
    pub(crate) fn record(&self, shot: &Shot, random: &mut Random, scan: &mut Scan) {
        let axis = &shot.axis;
        scan.report.pulses += 1;
        let pulse = pulse_echoes(self.scene, self.truth, axis, self.beam, self.max_range, random);
        if pulse.echoes.is_empty() && pulse.dropped == 0 {
            scan.report.missed_pulses += 1;
            return;
        }
        if random.chance(self.dropout) {
            scan.report.dropped_pulses += 1;
            return;
        }
        scan.report.dropped_echoes += pulse.dropped as u64;
        let pointing = self.boresight.map(|constant| constant + self.pointing_sd * random.normal());
        let reported = axis.tilted(axis.direction, pointing);
        let return_count = u8::try_from(pulse.echoes.len()).unwrap_or(u8::MAX);
        for (return_number, echo) in (1..=return_count).zip(&pulse.echoes) {
            let range = echo.range + self.range_sd * random.normal();
            scan.push(Return {
                position: add_scaled(axis.origin, reported, range),
                gps_time: shot.gps_time,
                return_number,
                return_count,
                scan_angle_deg: degrees_f32(shot.scan_angle),
                point_source_id: self.point_source_id,
                classification: echo.material.asprs_class(),
                intensity: self.intensity(echo),
                triangle: echo.triangle,
                exact_position: add_scaled(axis.origin, echo.direction, echo.range),
            });
        }
    }

    /// Returns the intensity of an echo. An echo of a perfect white target at the range of full brightness has 50 000,
    /// which leaves room for brighter ones.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range of u16")]
    fn intensity(&self, echo: &Echo) -> u16 {
        let spreading = self.intensity_range.map_or(1.0, |full| (full / echo.range).powi(2));
        (50_000.0 * echo.brightness * spreading).round().clamp(0.0, f64::from(u16::MAX)) as u16
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a scan angle needs no more digits than f32 has")]
fn degrees_f32(angle: f64) -> f32 {
    angle.to_degrees() as f32
}
