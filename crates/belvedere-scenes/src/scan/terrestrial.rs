//! Laser scanner on a tripod, set up at several places.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use rayon::prelude::*;

use crate::random::Random;
use crate::scan::beam::{Axis, BeamParams};
use crate::scan::flight::saturating_count;
use crate::scan::recording::{Recorder, Shot};
use crate::scan::stations::free_stations;
use crate::scan::{Scan, SensorPath};
use crate::scene::TriangleScene;
use crate::truth::Truth;

/// Positions of the tripod.
#[derive(Clone, Debug, PartialEq)]
pub enum Stations {
    /// Number of chosen places on open ground, in streets and squares, far from each other; fewer if there is less
    /// room.
    Chosen(u16),
    /// Given positions of the centre of the instrument, (S, 3), metres, absolute; positions beyond 65 535 are left out.
    At(Vec<[f64; 3]>),
}

/// Parameters of a scan from tripods. A range, step or rate that is not positive leaves nothing to scan, and gives a
/// scan without points.
#[derive(Clone, Debug, PartialEq)]
pub struct TerrestrialParams {
    /// Seed of the noise, any number. Default 1.
    pub seed: u64,
    /// Positions of the tripod. Default four chosen places.
    pub stations: Stations,
    /// Height of the instrument above ground at chosen places, metres, 0.5 to 10. Default 1.8.
    pub instrument_height: f64,
    /// Angle between neighbouring pulses, horizontal and vertical, radians, 1e-4 to 0.1. Default 0.25°: 4 cm at 10 m,
    /// half a million points a station. Surveys use a fifth of this angle and thin out afterwards.
    pub angular_step: f64,
    /// Elevation of the lowest pulse, radians from the horizon, -π/2 to π/2. Default -60°: the tripod hides the ground
    /// below itself.
    pub lowest_elevation: f64,
    /// Elevation of the highest pulse, radians from the horizon. Default π/2, the zenith.
    pub highest_elevation: f64,
    /// Maximum range of a surface that gives an echo, metres, 1 to 5000. Default 120, as for medium-range scanners.
    pub max_range: f64,
    /// Number of pulses per second, 1000 to 10 million. Default 100 000.
    pub pulse_rate: f64,
    /// Shape of the pulses. Default 0.3 mrad wide, in crowns as [`BeamParams::in_leaf`].
    pub beam: BeamParams,
    /// Standard deviation of a range, metres, 0 to 0.1. Default 0.005, as in data sheets.
    pub range_sd: f64,
    /// Standard deviation of the direction of a pulse about each of two axes, radians, 0 to 0.001. Default 4e-5.
    pub pointing_sd: f64,
    /// Share of pulses lost, 0 to 1. Default 0.01.
    pub dropout: f64,
    /// Adjusted standard GPS time at the start, seconds. Default 3e8, a day in March 2021.
    pub start_time: f64,
    /// Time between two stations, in which the tripod is carried, seconds, at least 4. Default 300.
    pub move_time: f64,
}

impl Default for TerrestrialParams {
    fn default() -> Self {
        Self {
            seed: 1,
            stations: Stations::Chosen(4),
            instrument_height: 1.8,
            angular_step: 0.25_f64.to_radians(),
            lowest_elevation: -PI / 3.0,
            highest_elevation: FRAC_PI_2,
            max_range: 120.0,
            pulse_rate: 1e5,
            beam: BeamParams { divergence: 3e-4, ..BeamParams::in_leaf() },
            range_sd: 0.005,
            pointing_sd: 4e-5,
            dropout: 0.01,
            start_time: 3e8,
            move_time: 300.0,
        }
    }
}

/// Time before the first and after the last pulse of a station for which the position is recorded, seconds.
const SETTLED: f64 = 1.0;
/// Time between entries of the path, seconds: readers interpolate over two seconds at most.
const PATH_STEP: f64 = 0.5;

impl TerrestrialParams {
    /// Returns the number of pulses sent from each place.
    #[must_use]
    pub fn pulses_per_station(&self) -> u64 {
        let [columns, rows] = self.grid();
        u64::from(columns) * u64::from(rows)
    }

    /// Returns the columns of pulses around, and the rows from below upwards.
    pub(crate) fn grid(&self) -> [u32; 2] {
        let height = self.highest_elevation.min(FRAC_PI_2) - self.lowest_elevation.max(-FRAC_PI_2);
        [TAU, height].map(|angle| saturating_count(angle / self.angular_step))
    }

    /// Returns the time that a station takes to turn once, seconds.
    fn duration(&self) -> f64 {
        let [columns, rows] = self.grid();
        f64::from(columns) * f64::from(rows) / self.pulse_rate
    }

    /// Returns the GPS time of the first pulse of a station, counted from 0.
    pub(crate) fn start_of(&self, station: usize) -> f64 {
        self.start_time + SETTLED + station as f64 * (self.duration() + self.move_time.max(4.0 * SETTLED))
    }

    fn leaves_something_to_scan(&self) -> bool {
        let sizes = [self.angular_step, self.max_range, self.pulse_rate];
        sizes.iter().all(|v| v.is_finite() && *v > 0.0) && self.lowest_elevation < self.highest_elevation
    }
}

/// Sets the tripod up in `scene` and returns the recorded scan of all places together.
///
/// Each station turns once, clockwise from north, while the pulses of each column run from below upwards. Returns of a
/// station have its number as point source id, and [`Scan::stations`] has its position. The path has the same positions
/// by time. Each pulse draws its noise from its own stream, so the scan has the same bits for any number of threads.
/// Intensities do not depend on the range, as if the scanner had corrected for it.
#[must_use]
pub fn scan_terrestrial(scene: &TriangleScene, params: &TerrestrialParams) -> Scan {
    let mut scan = Scan::default();
    if !params.leaves_something_to_scan() {
        return scan;
    }
    let truth = Truth::new(scene);
    let stations = match &params.stations {
        Stations::Chosen(count) => free_stations(scene, &truth, *count, params.instrument_height),
        Stations::At(positions) => positions.clone(),
    };
    let [columns, rows] = params.grid();
    for (number, &position) in (1..=u16::MAX).zip(&stations) {
        let start_time = params.start_of(usize::from(number) - 1);
        let station = Station { number, position, start_time };
        let turned: Vec<Scan> = (0..columns)
            .into_par_iter()
            .map(|column| scan_column(scene, &truth, params, &station, [column, columns], rows))
            .collect();
        for column in turned {
            scan.append(column);
        }
        scan.append(Scan { sensor_path: station.path(params.duration()), stations: vec![position], ..Scan::default() });
    }
    scan
}

/// One place of the tripod.
struct Station {
    /// Number of the station, counted from 1.
    number: u16,
    position: [f64; 3],
    /// GPS time of the first pulse, seconds.
    start_time: f64,
}

impl Station {
    fn path(&self, duration: f64) -> SensorPath {
        let steps = saturating_count((duration + 2.0 * SETTLED) / PATH_STEP);
        SensorPath {
            times: (0..=steps).map(|i| self.start_time - SETTLED + f64::from(i) * PATH_STEP).collect(),
            positions: (0..=steps).map(|_| self.position).collect(),
            headings: (0..=steps).map(|_| 0.0).collect(),
        }
    }
}

/// Returns the scan of one column of pulses.
fn scan_column(
    scene: &TriangleScene,
    truth: &Truth,
    params: &TerrestrialParams,
    station: &Station,
    [column, columns]: [u32; 2],
    rows: u32,
) -> Scan {
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
        point_source_id: station.number,
        intensity_range: None,
    };
    let azimuth = TAU * (f64::from(column) + 0.5) / f64::from(columns);
    let lowest = params.lowest_elevation.max(-FRAC_PI_2);
    for row in 0..rows {
        let elevation = (lowest + params.angular_step * (f64::from(row) + 0.5)).min(FRAC_PI_2);
        let number = u64::from(column) * u64::from(rows) + u64::from(row);
        let shot = Shot {
            axis: axis(station.position, azimuth, elevation),
            gps_time: station.start_time + number as f64 / params.pulse_rate,
            scan_angle: FRAC_PI_2 + elevation,
        };
        let mut random = Random::new(params.seed, (u64::from(station.number) << 48) | number);
        recorder.record(&shot, &mut random, &mut scan);
    }
    scan
}

/// Returns the pulse towards `azimuth`, clockwise from north, and `elevation`, both in radians.
fn axis(origin: [f64; 3], azimuth: f64, elevation: f64) -> Axis {
    let (east, north) = azimuth.sin_cos();
    let (up, level) = elevation.sin_cos();
    Axis {
        origin,
        direction: [east * level, north * level, up],
        across: [[north, -east, 0.0], [-east * up, -north * up, level]],
    }
}
