//! Trajectories as SBET and text tables.

use std::f64::consts::{PI, TAU};

use crate::files::output::Output;
use belvedere_data::crs::{Crs, GeographicProjection};
use belvedere_data::trajectory::{ADJUSTED_STANDARD_S, MAX_GAP_S, Trajectory, TrajectorySample, WEEK_S};
use belvedere_data::{Error, GpsTimeKind, Result};

/// Heading of the vehicle.
#[derive(Clone, Copy, Debug, Default)]
pub enum VehicleHeading<'a> {
    /// Direction of motion; north while it stands.
    #[default]
    Course,
    /// Heading at each position, radians clockwise from the north of the grid, (M).
    Given(&'a [f64]),
}

/// Writes `trajectory`, whose positions are metres in the system `crs`, in a format that follows from the extension.
///
/// `.csv` and `.txt` get the header `time,x,y,z` and a line per position, in the unit of the system with four decimals,
/// and microseconds of the same clock.
///
/// `.sbet` and `.out` get 17 little-endian f64 a record: time, latitude and longitude (radians, WGS 84), altitude,
/// velocities along x, y and z, roll, pitch, heading, wander angle, accelerations and angular rates. The wander angle
/// is 0, so that x points to true north, y west and z up.
///
/// Times count from the start of the GPS week of the first position, and on beyond the end of that week; times that
/// already do (`kind`) are unchanged. Altitudes are unchanged, above the vertical datum of the system instead of the
/// ellipsoid. Velocities are differences between neighbouring records (0 if none is near); headings are turned to true
/// north. Roll, pitch, accelerations and rates are not known here and 0. [`crate::read_trajectory`] reads times and
/// positions back.
///
/// # Errors
/// - [`Error::UnknownFormat`] for other extensions.
/// - [`Error::LengthMismatch`] if positions or headings are not as many as times.
/// - [`Error::UnusableCrs`] for SBET in a system that gives no latitude and longitude.
/// - [`Error::Io`]. An existing file is replaced only by a complete one.
///
/// # Source
/// Field order of SBET: PDAL, `io/SbetCommon.hpp`.
pub fn write_trajectory<'a>(
    output: impl Into<Output<'a>>,
    trajectory: &Trajectory,
    kind: GpsTimeKind,
    crs: &Crs,
    heading: VehicleHeading<'_>,
) -> Result<()> {
    let count = trajectory.times.len();
    let given = if let VehicleHeading::Given(headings) = heading { headings.len() } else { count };
    for (what, found) in [("trajectory positions", trajectory.positions.len()), ("headings", given)] {
        if found != count {
            return Err(Error::LengthMismatch { what, expected: count, found });
        }
    }
    let output = output.into();
    match output.extension().as_str() {
        "csv" | "txt" => write_table(output, trajectory, crs),
        "sbet" | "out" => write_sbet(output, trajectory, kind, crs, heading),
        _ => {
            let supported = ".csv, .txt, .sbet or .out";
            Err(Error::UnknownFormat { path: output.name().to_owned(), kind: "trajectory", supported })
        }
    }
}

fn write_table(output: Output<'_>, trajectory: &Trajectory, crs: &Crs) -> Result<()> {
    let scale = crs.metres_per_unit_xyz();
    output.write(|path, file| {
        writeln!(file, "time,x,y,z").map_err(Error::io(path))?;
        for (time, position) in trajectory.times.iter().zip(&trajectory.positions) {
            let [x, y, z]: [f64; 3] = std::array::from_fn(|i| position[i] / scale[i]);
            writeln!(file, "{time:.6},{x:.4},{y:.4},{z:.4}").map_err(Error::io(path))?;
        }
        Ok(())
    })
}

/// Writes estimated positions as a table for people and for [`crate::read_trajectory`]: `.csv` or `.txt` with the
/// columns time, x, y, z, sd_x, sd_y, sd_z, residual_deg and line. Positions and deviations are in the unit of the file
/// of the cloud in the system `crs`; unknown values are left empty.
///
/// # Errors
/// [`Error::UnknownFormat`] for other extensions, and [`Error::Io`]. An existing file is replaced only by a complete
/// one.
pub fn write_found_trajectory<'a>(
    output: impl Into<Output<'a>>,
    samples: &[TrajectorySample],
    crs: &Crs,
) -> Result<()> {
    let output = output.into();
    let extension = output.extension();
    if !["csv", "txt"].contains(&extension.as_str()) {
        let supported = ".csv or .txt";
        return Err(Error::UnknownFormat { path: output.name().to_owned(), kind: "found trajectory", supported });
    }
    let scale = crs.metres_per_unit_xyz();
    let in_unit = |values: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| values[i] / scale[i]) };
    let known = |value: f64, digits: usize| if value.is_finite() { format!("{value:.digits$}") } else { String::new() };
    output.write(|path, file| {
        writeln!(file, "time,x,y,z,sd_x,sd_y,sd_z,residual_deg,line").map_err(Error::io(path))?;
        for TrajectorySample { time, position, quality } in samples {
            let [x, y, z] = in_unit(*position);
            let sd = in_unit(quality.sd).map(|sd| known(sd, 2)).join(",");
            let residual = known(quality.residual.to_degrees(), 4);
            writeln!(file, "{time:.6},{x:.3},{y:.3},{z:.3},{sd},{residual},{}", quality.line)
                .map_err(Error::io(path))?;
        }
        Ok(())
    })
}

fn write_sbet(
    output: Output<'_>,
    trajectory: &Trajectory,
    kind: GpsTimeKind,
    crs: &Crs,
    heading: VehicleHeading<'_>,
) -> Result<()> {
    let name = output.name().to_owned();
    let unusable = |e: Error| Error::UnusableCrs {
        path: name.clone(),
        what: format!("positions cannot be converted to latitude and longitude: {e}"),
    };
    let projection = crs.geographic_projection().map_err(unusable)?;
    let places = trajectory
        .positions
        .iter()
        .map(|&position| GlobePosition::new(&projection, position))
        .collect::<Result<Vec<GlobePosition>>>()
        .map_err(unusable)?;
    let week_start = match (kind, trajectory.times.first()) {
        (GpsTimeKind::AdjustedStandard, Some(first)) => {
            ((first + ADJUSTED_STANDARD_S) / WEEK_S).floor() * WEEK_S - ADJUSTED_STANDARD_S
        }
        _ => 0.0,
    };
    output.write(|path, file| {
        for (i, (time, place)) in trajectory.times.iter().zip(&places).enumerate() {
            let [north, east, up] = velocity(&trajectory.times, &places, i);
            let pointing = match heading {
                VehicleHeading::Course if north == 0.0 && east == 0.0 => 0.0,
                VehicleHeading::Course => east.atan2(north),
                VehicleHeading::Given(headings) => headings.get(i).copied().unwrap_or(0.0) + place.grid_north,
            };
            let mut record = [0.0; 17];
            record[0] = time - week_start;
            record[1..4].copy_from_slice(&[place.latitude, place.longitude, place.altitude]);
            record[4..7].copy_from_slice(&[north, -east, up]);
            record[9] = (pointing + PI).rem_euclid(TAU) - PI;
            let bytes: Vec<u8> = record.iter().flat_map(|v| v.to_le_bytes()).collect();
            file.write_all(&bytes).map_err(Error::io(path))?;
        }
        Ok(())
    })
}

/// Semi-major axis of the ellipsoid of WGS 84, metres, and its squared eccentricity.
const WGS84: [f64; 2] = [6_378_137.0, 6.694_379_990_141_33e-3];
/// Distance over which the direction of grid north is measured, metres: short against its bending, long against
/// rounding.
const NORTHWARD: f64 = 100.0;

/// A position on the globe.
struct GlobePosition {
    latitude: f64,
    longitude: f64,
    altitude: f64,
    /// Metres per radian of latitude and of longitude here.
    metres_per_radian: [f64; 2],
    /// Direction of grid north, radians clockwise from true north.
    grid_north: f64,
}

impl GlobePosition {
    fn new(projection: &GeographicProjection, [x, y, altitude]: [f64; 3]) -> Result<Self> {
        let [latitude, longitude] = projection.unproject([x, y])?;
        let [semi_major, eccentricity_2] = WGS84;
        let flattened = 1.0 - eccentricity_2 * latitude.sin().powi(2);
        let metres_per_radian = [
            semi_major * (1.0 - eccentricity_2) / flattened.powf(1.5) + altitude,
            (semi_major / flattened.sqrt() + altitude) * latitude.cos(),
        ];
        let [north_latitude, north_longitude] = projection.unproject([x, y + NORTHWARD])?;
        let grid_north = ((north_longitude - longitude) * metres_per_radian[1])
            .atan2((north_latitude - latitude) * metres_per_radian[0]);
        Ok(Self { latitude, longitude, altitude, metres_per_radian, grid_north })
    }
}

/// Velocity to the north, to the east and up at record `index`, metres per second: between the records before and after
/// it, as far as they are near in time.
fn velocity(times: &[f64], places: &[GlobePosition], index: usize) -> [f64; 3] {
    let record = |i: usize| Some((*times.get(i)?, places.get(i)?));
    let Some(own) = record(index) else { return [0.0; 3] };
    let near = |other: Option<(f64, _)>| other.filter(|(time, _)| (time - own.0).abs() <= MAX_GAP_S).unwrap_or(own);
    let (before, after) = (near(index.checked_sub(1).and_then(record)), near(record(index + 1)));
    let seconds = after.0 - before.0;
    if seconds <= 0.0 {
        return [0.0; 3];
    }
    [
        (after.1.latitude - before.1.latitude) * own.1.metres_per_radian[0] / seconds,
        (after.1.longitude - before.1.longitude) * own.1.metres_per_radian[1] / seconds,
        (after.1.altitude - before.1.altitude) / seconds,
    ]
}
