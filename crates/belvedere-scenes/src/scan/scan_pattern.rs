//! Scan patterns of an airborne scanner: direction of each pulse, and density of the pulses on the ground.

use std::f64::consts::{PI, TAU};

use crate::scan::beam::Axis;
use crate::vector::{add_scaled, scale};

/// Path of the pulses over the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ScanPattern {
    /// Rotating polygon: parallel lines across the flight, equal steps of the angle.
    #[default]
    Rotating,
    /// Oscillating mirror: a zig-zag across the flight.
    Oscillating(MirrorMotion),
    /// Tilted mirror that spins about the vertical: a circle that moves along. Every place is seen from ahead and from
    /// behind, and so are walls across and along the flight.
    Conical {
        /// Angle of all pulses from nadir, radians, 0 to 1.2. 20° is usual.
        half_angle: f64,
    },
}

/// Motion of an oscillating mirror.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MirrorMotion {
    /// Motion of a spring, slow at the turning points: pulses crowd at both edges of the strip.
    #[default]
    Sinusoidal,
    /// Constant speed to and fro: equal steps of the angle.
    Triangular,
}

impl ScanPattern {
    /// Cone of 20°, as usual for conical scanners over towns.
    pub const CONICAL_20: Self = Self::Conical { half_angle: 20.0 * PI / 180.0 };
}

/// Directions of the aircraft, level unit vectors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlightAxes {
    pub(crate) forward: [f64; 3],
    pub(crate) right: [f64; 3],
}

/// Pulses of one line: a sweep of the mirror, or a turn of the cone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PulseSweep {
    pub(crate) pattern: ScanPattern,
    /// Maximum angle from nadir across the flight, radians.
    pub(crate) half_angle: f64,
    pub(crate) pulses_per_line: u32,
}

impl PulseSweep {
    /// Returns pulse `step` of `line`, sent from `origin`. The second value is its angle from nadir across the flight,
    /// radians, positive to the right.
    pub(crate) fn pulse(&self, origin: [f64; 3], course: &FlightAxes, line: u32, step: u32) -> (Axis, f64) {
        let count = f64::from(self.pulses_per_line);
        let share = (f64::from(step) + 0.5) / count;
        let turn = if line.is_multiple_of(2) { 1.0 } else { -1.0 };
        let angle = match self.pattern {
            ScanPattern::Rotating => self.half_angle * (2.0 * (f64::from(step) + 0.5) / count - 1.0),
            ScanPattern::Oscillating(MirrorMotion::Triangular) => turn * self.half_angle * (2.0 * share - 1.0),
            ScanPattern::Oscillating(MirrorMotion::Sinusoidal) => -turn * self.half_angle * (PI * share).cos(),
            ScanPattern::Conical { half_angle } => return conical_pulse(origin, course, half_angle, TAU * share),
        };
        let (sin, cos) = angle.sin_cos();
        let up = [0.0, 0.0, 1.0];
        let direction = add_scaled(scale(course.right, sin), up, -cos);
        let outwards = add_scaled(scale(course.right, cos), up, sin);
        (Axis { origin, direction, across: [course.forward, outwards] }, angle)
    }

    /// Returns the pulses per m² as a multiple of the mean over the strip. The place lies `offset` metres beside the
    /// path of an aircraft `height` metres up.
    pub(crate) fn relative_density(&self, offset: f64, height: f64) -> f64 {
        // A mirror that turns back has no speed there; beams of finite width keep the density finite.
        let slowest = 0.05;
        let angle = offset.atan2(height);
        let per_angle = self.half_angle.tan() * angle.cos().powi(2);
        if angle.abs() > self.half_angle {
            return 0.0;
        }
        let to_edge = |share: f64| (1.0 - share * share).max(0.0).sqrt().max(slowest);
        match self.pattern {
            ScanPattern::Rotating | ScanPattern::Oscillating(MirrorMotion::Triangular) => per_angle / self.half_angle,
            ScanPattern::Oscillating(MirrorMotion::Sinusoidal) => {
                2.0 * per_angle / (PI * self.half_angle * to_edge(angle / self.half_angle))
            }
            ScanPattern::Conical { .. } => 2.0 / (PI * to_edge(offset / (height * self.half_angle.tan()))),
        }
    }
}

/// Returns the pulse of a cone towards `azimuth`, radians clockwise from the flight direction, and its angle across the
/// flight.
fn conical_pulse(origin: [f64; 3], course: &FlightAxes, half_angle: f64, azimuth: f64) -> (Axis, f64) {
    let (sin, cos) = half_angle.sin_cos();
    let (right, ahead) = azimuth.sin_cos();
    let up = [0.0, 0.0, 1.0];
    let level = add_scaled(scale(course.forward, ahead), course.right, right);
    let along = add_scaled(scale(course.forward, -right), course.right, ahead);
    let direction = add_scaled(scale(level, sin), up, -cos);
    let outwards = add_scaled(scale(level, cos), up, sin);
    (Axis { origin, direction, across: [along, outwards] }, (sin * right).atan2(cos))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::dot;

    const COURSE: FlightAxes = FlightAxes { forward: [0.0, 1.0, 0.0], right: [1.0, 0.0, 0.0] };
    const PATTERNS: [ScanPattern; 4] = [
        ScanPattern::Rotating,
        ScanPattern::Oscillating(MirrorMotion::Sinusoidal),
        ScanPattern::Oscillating(MirrorMotion::Triangular),
        ScanPattern::CONICAL_20,
    ];

    fn sweep(pattern: ScanPattern) -> PulseSweep {
        PulseSweep { pattern, half_angle: 20_f64.to_radians(), pulses_per_line: 20_000 }
    }

    #[test]
    fn axes_are_orthonormal_and_angles_are_those_of_the_direction() {
        for pattern in PATTERNS {
            for (line, step) in [(0, 0), (0, 7_777), (1, 123), (1, 19_999)] {
                let (axis, angle) = sweep(pattern).pulse([0.0; 3], &COURSE, line, step);
                let vectors = [axis.direction, axis.across[0], axis.across[1]];
                for (i, a) in vectors.iter().enumerate() {
                    for (j, b) in vectors.iter().enumerate() {
                        assert!((dot(*a, *b) - f64::from(u8::from(i == j))).abs() < 1e-14);
                    }
                }
                assert!((angle - axis.direction[0].atan2(-axis.direction[2])).abs() < 1e-14);
                assert!(angle.abs() <= 20_f64.to_radians() + 1e-14);
            }
        }
    }

    #[test]
    fn an_oscillating_mirror_sweeps_back_and_a_cone_keeps_its_tilt() {
        for motion in [MirrorMotion::Sinusoidal, MirrorMotion::Triangular] {
            let sweep = sweep(ScanPattern::Oscillating(motion));
            let angle = |line, step| sweep.pulse([0.0; 3], &COURSE, line, step).1;
            assert!(angle(0, 0) < -0.349 && angle(0, 19_999) > 0.349);
            assert!(angle(1, 0) > 0.349 && angle(1, 19_999) < -0.349);
            assert!((angle(0, 5000) + angle(1, 5000)).abs() < 1e-14);
        }
        for step in [0, 5_000, 12_345] {
            let (axis, _) = sweep(ScanPattern::CONICAL_20).pulse([0.0; 3], &COURSE, 0, step);
            assert!((axis.direction[2] + 20_f64.to_radians().cos()).abs() < 1e-14);
        }
    }

    #[test]
    fn relative_density_is_that_of_counted_pulses() {
        let height = 400.0;
        let half_width = height * 20_f64.to_radians().tan();
        for pattern in PATTERNS {
            let sweep = sweep(pattern);
            let bins = 20_u32;
            let mut counts = vec![0.0; bins as usize];
            for step in 0..sweep.pulses_per_line {
                let offset = height * sweep.pulse([0.0; 3], &COURSE, 0, step).1.tan();
                let bin = ((offset / half_width + 1.0) / 2.0 * f64::from(bins)).floor();
                if let Some(count) = (0..bins).position(|b| f64::from(b) >= bin).and_then(|b| counts.get_mut(b)) {
                    *count += f64::from(bins) / f64::from(sweep.pulses_per_line);
                }
            }
            // The outer bins contain the turning points, where the density is cut off.
            for (bin, count) in counts.iter().enumerate().skip(1).take(bins as usize - 2) {
                let middle = ((bin as f64 + 0.5) / f64::from(bins) * 2.0 - 1.0) * half_width;
                let expected = sweep.relative_density(middle, height);
                // A bin is a twentieth of the strip, over which the density of turning mirrors varies by up to 5 %.
                assert!((count / expected - 1.0).abs() < 0.06, "{pattern:?} {bin}: {count} {expected}");
            }
            assert_eq!(sweep.relative_density(1.01 * half_width, height), 0.0);
        }
    }
}
