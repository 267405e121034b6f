//! Result of a simulated scan: returns as columns, and the path of the scanner.

pub(crate) mod airborne;
pub(crate) mod beam;
pub(crate) mod flight;
pub(crate) mod mobile;
pub(crate) mod order;
pub(crate) mod recording;
pub(crate) mod regimes;
pub(crate) mod scan_grid;
pub(crate) mod scan_pattern;
pub(crate) mod stations;
pub(crate) mod terrestrial;

use std::fmt::Write as _;

use rayon::prelude::*;

use crate::scene::TriangleScene;
use crate::truth::Truth;
use crate::vector::{add_scaled, cross, sub, unit};

/// Simulated laser scan. Columns have one value per return, ordered by strip, time and return number, unless
/// [`Scan::in_order`] changed the order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scan {
    /// East, metres, absolute, with noise.
    pub x: Vec<f64>,
    /// North, metres, absolute, with noise.
    pub y: Vec<f64>,
    /// Height, metres, with noise.
    pub z: Vec<f64>,
    /// Adjusted standard GPS time, seconds (GPS seconds minus 1e9). Each pulse has its own time, which all its returns
    /// share.
    pub gps_time: Vec<f64>,
    /// Number of the return within its pulse, from 1, by increasing range.
    pub return_number: Vec<u8>,
    /// Number of returns of the pulse.
    pub return_count: Vec<u8>,
    /// Angle of the pulse from nadir, degrees (LAS 1.4). For an airborne scanner: across the flight, negative to its
    /// left. On a tripod: 0 to 180, with 90 level. On a car: −180 to 180 about the axis of the mirror.
    pub scan_angle_deg: Vec<f32>,
    /// Number of the strip, tripod position or run of a car, from 1.
    pub point_source_id: Vec<u16>,
    /// ASPRS class of the surface, see [`crate::Material::asprs_class`].
    pub classification: Vec<u8>,
    /// Strength of the echo, arbitrary unit. It grows with reflectance, share of the beam and steepness of incidence.
    pub intensity: Vec<u16>,
    /// Truth: index of the triangle of the scene that reflected the echo. For a return from inside a crown (only with
    /// [`crate::BeamParams::foliage_depth`]) it is the triangle of the crown's hull through which the ray entered.
    pub triangle: Vec<u32>,
    /// Truth: place of reflection, (N, 3), metres, absolute. It is on that triangle, or behind it on the ray if leaves
    /// inside the crown stopped the ray.
    ///
    /// A return lies elsewhere for two reasons. First, this place may be up to half a beam beside the axis of the beam,
    /// but the scanner reports its range along the axis. Returns of an edge therefore lie on both sides of it. Second,
    /// noise moves the return along the axis and, by pointing errors, across. Class, triangle and light are those of
    /// this place.
    pub exact_positions: Vec<[f64; 3]>,
    /// Path of the scanner over all strips, or its position on each tripod during the scan there.
    pub sensor_path: SensorPath,
    /// Centre of the scanner at each tripod position, (S, 3), metres, absolute; empty for an airborne scan.
    pub stations: Vec<[f64; 3]>,
    /// Counts of pulses and echoes.
    pub report: ScanReport,
}

/// Distance outside its surface from which the light of a point is tested, metres. It is larger than the unevenness of
/// a mesh with millimetres, and too small to change the light.
const STAND_OFF: f64 = 0.03;

/// Counts of a scan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScanReport {
    /// Number of pulses sent.
    pub pulses: u64,
    /// Number of pulses that met the scene but were lost as drop-outs.
    pub dropped_pulses: u64,
    /// Number of pulses without an echo because they passed beyond the edge of the scene.
    pub missed_pulses: u64,
    /// Number of echoes left out because they were too weak or came after the last one that the scanner records.
    pub dropped_echoes: u64,
}

/// Positions of a scanner at increasing times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorPath {
    /// Adjusted standard GPS time of each position, seconds, strictly increasing.
    pub times: Vec<f64>,
    /// Positions, (M, 3), metres, absolute, without noise.
    pub positions: Vec<[f64; 3]>,
    /// Direction of the nose of the aircraft at each time, radians clockwise from grid north, 0 to 2π, (M); 0 on a
    /// tripod.
    pub headings: Vec<f64>,
}

impl SensorPath {
    /// Returns CSV text: the header `time,x,y,z`, then a line per position with microseconds and millimetres.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = String::from("time,x,y,z\n");
        for (time, [x, y, z]) in self.times.iter().zip(&self.positions) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{time:.6},{x:.3},{y:.3},{z:.3}");
        }
        text
    }
}

/// One return, the row of a [`Scan`].
pub(crate) struct Return {
    pub(crate) position: [f64; 3],
    pub(crate) gps_time: f64,
    pub(crate) return_number: u8,
    pub(crate) return_count: u8,
    pub(crate) scan_angle_deg: f32,
    pub(crate) point_source_id: u16,
    pub(crate) classification: u8,
    pub(crate) intensity: u16,
    pub(crate) triangle: u32,
    pub(crate) exact_position: [f64; 3],
}

impl Scan {
    /// Returns the number of returns.
    #[must_use]
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Returns true if the scan has no return.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Returns CSV text of the tripod positions: the header `station,x,y,z`, then a line per station. A line has the
    /// number of the station (the point source id of its returns) and coordinates with millimetres.
    #[must_use]
    pub fn stations_to_csv(&self) -> String {
        let mut text = String::from("station,x,y,z\n");
        for (number, [x, y, z]) in (1_u32..).zip(&self.stations) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{number},{x:.3},{y:.3},{z:.3}");
        }
        text
    }

    /// Flags the returns, (N), that light from `direction`, such as that of the sun, reaches. The light is tested 3 cm
    /// outside the exact position, along the normal of the triangle. `truth` must be made of `scene`, and `scene` must
    /// be the scanned one.
    ///
    /// Crowns block as opaque solids do, so that a return from inside a crown is in shadow.
    #[must_use]
    pub fn lit_from(&self, scene: &TriangleScene, truth: &Truth, direction: [f64; 3]) -> Vec<bool> {
        self.exact_positions
            .par_iter()
            .zip(&self.triangle)
            .map(|(&position, &triangle)| {
                let corners = scene.corners(triangle as usize);
                let normal = corners.and_then(|[a, b, c]| unit(cross(sub(b, a), sub(c, a)))).unwrap_or_default();
                !truth.occluded_towards(add_scaled(position, normal, STAND_OFF), direction)
            })
            .collect()
    }

    pub(crate) fn push(&mut self, r: Return) {
        self.x.push(r.position[0]);
        self.y.push(r.position[1]);
        self.z.push(r.position[2]);
        self.gps_time.push(r.gps_time);
        self.return_number.push(r.return_number);
        self.return_count.push(r.return_count);
        self.scan_angle_deg.push(r.scan_angle_deg);
        self.point_source_id.push(r.point_source_id);
        self.classification.push(r.classification);
        self.intensity.push(r.intensity);
        self.triangle.push(r.triangle);
        self.exact_positions.push(r.exact_position);
    }

    /// Appends returns, path and counts of `later`.
    pub(crate) fn append(&mut self, mut later: Self) {
        self.x.append(&mut later.x);
        self.y.append(&mut later.y);
        self.z.append(&mut later.z);
        self.gps_time.append(&mut later.gps_time);
        self.return_number.append(&mut later.return_number);
        self.return_count.append(&mut later.return_count);
        self.scan_angle_deg.append(&mut later.scan_angle_deg);
        self.point_source_id.append(&mut later.point_source_id);
        self.classification.append(&mut later.classification);
        self.intensity.append(&mut later.intensity);
        self.triangle.append(&mut later.triangle);
        self.exact_positions.append(&mut later.exact_positions);
        self.sensor_path.times.append(&mut later.sensor_path.times);
        self.sensor_path.positions.append(&mut later.sensor_path.positions);
        self.sensor_path.headings.append(&mut later.sensor_path.headings);
        self.stations.append(&mut later.stations);
        self.report.pulses += later.report.pulses;
        self.report.dropped_pulses += later.report.dropped_pulses;
        self.report.missed_pulses += later.report.missed_pulses;
        self.report.dropped_echoes += later.report.dropped_echoes;
    }
}
