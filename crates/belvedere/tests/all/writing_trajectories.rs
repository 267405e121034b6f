//! Trajectories come back as they were written, and move and point as they say.

use belvedere::crs::Crs;
use belvedere::io::{VehicleHeading, read_trajectory, write_trajectory};
use belvedere::trajectory::{Trajectory, WEEK_S};
use belvedere::{Error, GpsTimeKind};
use belvedere_scenes::{AirborneParams, TownParams, scan_airborne, town};

const SPEED: f64 = 60.0;
const HEADING: f64 = 0.7;

/// Ten seconds to the north-east at 20 Hz, climbing half a metre a second, from `start` (metres).
fn climb(start: [f64; 3], start_time: f64) -> Trajectory {
    let records = (0..200).map(|i| {
        let t = f64::from(i) * 0.05;
        let along = SPEED * t;
        let position = [start[0] + along * HEADING.sin(), start[1] + along * HEADING.cos(), start[2] + 0.5 * t];
        (start_time + t, position)
    });
    Trajectory::from_records(records.collect()).0
}

/// Greatest difference between positions at the same row, metres.
fn greatest_difference(a: &Trajectory, b: &Trajectory) -> f64 {
    assert_eq!(a.positions.len(), b.positions.len());
    let rows = a.positions.iter().zip(&b.positions);
    rows.flat_map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).abs()))
        .inspect(|difference| assert!(!difference.is_nan()))
        .fold(0.0, f64::max)
}

fn sbet_records(path: &std::path::Path) -> Vec<[f64; 17]> {
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(bytes.len() % 136, 0);
    bytes
        .chunks_exact(136)
        .map(|r| std::array::from_fn(|i| f64::from_le_bytes(r[8 * i..8 * i + 8].try_into().unwrap())))
        .collect()
}

#[test]
fn the_path_of_a_simulated_survey_comes_back_from_both_formats() {
    let scan = scan_airborne(
        &town(&TownParams::default()),
        &AirborneParams { pulses_per_m2: 0.05, ..AirborneParams::default() },
    );
    let path = &scan.sensor_path;
    let trajectory = Trajectory { times: path.times.clone(), positions: path.positions.clone() };
    let crs = Crs::parse("EPSG:7415").unwrap();
    let folder = tempfile::tempdir().unwrap();
    // Half of the last digit of the table; a micrometre and the rounding of radians in the SBET.
    for (name, tolerance) in [("t.csv", 0.000_051), ("t.txt", 0.000_051), ("t.sbet", 1e-5), ("t.out", 1e-5)] {
        let file = folder.path().join(name);
        let headings = VehicleHeading::Given(&path.headings);
        write_trajectory(&file, &trajectory, GpsTimeKind::AdjustedStandard, &crs, headings).unwrap();
        let (read, report) = read_trajectory(&file, &crs).unwrap();
        assert_eq!(report.duplicate_count, 0);
        assert!(greatest_difference(&trajectory, &read) < tolerance, "{name}");
        // The clock of the file is found, and at each time of the cloud the position is that of the simulation.
        let clock = read.clock_offset_for(&scan.gps_time, GpsTimeKind::AdjustedStandard);
        assert_eq!((clock.known_count, clock.leap_seconds), (scan.len(), 0.0), "{name}");
        for (time, position) in path.times.iter().zip(&path.positions).step_by(17) {
            let found = read.position_at(clock.trajectory_time(*time)).unwrap();
            // Microseconds at 60 m/s, and the interpolation between records next to the one meant.
            assert!((0..3).all(|i| (found[i] - position[i]).abs() < 2e-4), "{name} {time}: {found:?} {position:?}");
        }
    }
}

#[test]
fn sbet_velocities_and_headings_are_those_flown() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("t.sbet");
    let flight = climb([250_000.0, 590_000.0, 300.0], 1000.0);
    let crs = Crs::from_epsg(28_992).unwrap();
    let headings = vec![HEADING + 0.1; flight.times.len()];
    write_trajectory(&file, &flight, GpsTimeKind::SecondsOfWeek, &crs, VehicleHeading::Given(&headings)).unwrap();
    let drifting = sbet_records(&file);
    write_trajectory(&file, &flight, GpsTimeKind::SecondsOfWeek, &crs, VehicleHeading::Course).unwrap();
    // Grid north against true north, 95 km or 1.43 degrees of longitude east of the central meridian of the Dutch grid:
    // times the sine of the latitude, 53.3 degrees.
    let convergence = (1.43_f64).to_radians() * 53.3_f64.to_radians().sin();
    for (i, (record, drifting)) in sbet_records(&file).iter().zip(&drifting).enumerate() {
        assert_eq!(record[0], flight.times[i], "seconds of the week stay");
        let [x_velocity, y_velocity, z_velocity] = [record[4], record[5], record[6]];
        // The grid is up to 1e-4 too large or small, and curved far less than that in 600 m.
        assert!((x_velocity.hypot(y_velocity) - SPEED).abs() < 0.02, "{x_velocity} {y_velocity}");
        assert!((z_velocity - 0.5).abs() < 1e-6);
        // x north, y west
        let course = (-y_velocity).atan2(x_velocity);
        assert!((course - HEADING - convergence).abs() < 1e-3, "{course}");
        assert!((record[9] - course).abs() < 1e-12);
        // The direction of north is measured over 100 m, that of the flight over 6: rounding leaves 1e-6.
        assert!((drifting[9] - course - 0.1).abs() < 2e-5, "{} {course}", drifting[9]);
        assert!([7, 8].iter().chain(&[10, 11, 12, 13, 14, 15, 16]).all(|&field| record[field] == 0.0));
    }
}

#[test]
fn adjusted_times_become_seconds_of_the_week_and_run_on_beyond_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("t.out");
    let crs = Crs::from_epsg(28_992).unwrap();
    // week 2200 ends during the flight
    let flight = climb([155_000.0, 463_000.0, 300.0], 2201.0 * WEEK_S - 1e9 - 5.0);
    write_trajectory(&file, &flight, GpsTimeKind::AdjustedStandard, &crs, VehicleHeading::Course).unwrap();
    let records = sbet_records(&file);
    assert!((records[0][0] - (WEEK_S - 5.0)).abs() < 1e-6);
    assert!((records[199][0] - (WEEK_S + 4.95)).abs() < 1e-6);
}

#[test]
fn tables_of_systems_in_feet_are_in_feet() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("t.csv");
    let feet = Crs { metres_per_unit: 0.3048, vertical_metres_per_unit: 0.3048, ..Crs::default() };
    let flight = climb([304.8, 609.6, 30.48], 0.0);
    write_trajectory(&file, &flight, GpsTimeKind::SecondsOfWeek, &feet, VehicleHeading::Course).unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(text.starts_with("time,x,y,z\n0.000000,1000.0000,2000.0000,100.0000\n"), "{text}");
    assert!(greatest_difference(&flight, &read_trajectory(&file, &feet).unwrap().0) < 2e-5);
}

#[test]
fn what_cannot_be_written_is_refused_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let flight = climb([155_000.0, 463_000.0, 300.0], 0.0);
    let write = |name: &str, crs: &Crs, heading: VehicleHeading<'_>| {
        write_trajectory(&folder.path().join(name), &flight, GpsTimeKind::SecondsOfWeek, crs, heading)
    };
    let dutch = Crs::from_epsg(28_992).unwrap();
    assert!(matches!(write("t.las", &dutch, VehicleHeading::Course), Err(Error::UnknownFormat { .. })));
    assert!(matches!(write("t.sbet", &Crs::default(), VehicleHeading::Course), Err(Error::UnusableCrs { .. })));
    assert!(matches!(write("t.sbet", &dutch, VehicleHeading::Given(&[0.0])), Err(Error::LengthMismatch { .. })));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
