//! Scanner positions from each source that a cloud has: simulated flights with a known path, with one source after the
//! other removed, and real clouds.

use crate::common::simulated::cloud_of;
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud, read_trajectory, write_found_trajectory};
use belvedere::pulses::{
    AngleVerdict, FoundBy, LocateParams, Means, PartVerdict, ScannerReport, SensorEstimateParams, locate, path_samples,
};
use belvedere::trajectory::Trajectory;
use belvedere::vector::{cross, length, sub};
use belvedere::{Error, PointCloud};
use belvedere_scenes::{
    AirborneParams, MirrorMotion, Preset, Scan, ScanPattern, Stations, TerrestrialParams, TownParams, scan_airborne,
    scan_terrestrial, town,
};

fn flown(params: &AirborneParams) -> Scan {
    scan_airborne(&town(&TownParams::default()), params)
}

fn trajectory(scan: &Scan, raised: f64) -> Trajectory {
    let place = |p: &[f64; 3]| [p[0], p[1], p[2] + raised];
    let positions = scan.sensor_path.positions.iter().map(place);
    Trajectory::from_records(scan.sensor_path.times.iter().copied().zip(positions).collect()).0
}

/// The points of `cloud` whose pulse had no other return.
fn singles(cloud: &PointCloud) -> PointCloud {
    let counts = cloud.attributes.return_count.as_ref().unwrap();
    let rows: Vec<u32> = (0_u32..).zip(counts).filter(|(_, count)| **count == 1).map(|(row, _)| row).collect();
    cloud.select(&rows)
}

fn found(cloud: &PointCloud) -> (Vec<[f32; 3]>, ScannerReport) {
    locate(cloud, &Means::Automatic, &LocateParams::default(), &Control::none()).unwrap()
}

/// Median distance between two sets of positions in metres, and median angle between the directions to them in degrees,
/// where both are known.
fn apart(cloud: &PointCloud, found: &[[f32; 3]], truth: &[[f32; 3]]) -> [f64; 2] {
    let (mut distances, mut angles) = (Vec::new(), Vec::new());
    for ((place, found), truth) in cloud.positions.iter().zip(found).zip(truth) {
        if found[0].is_nan() || truth[0].is_nan() {
            continue;
        }
        let [place, found, truth] = [place, found, truth].map(|p| p.map(f64::from));
        let (a, b) = (sub(found, place), sub(truth, place));
        distances.push(length(sub(found, truth)));
        angles.push((length(cross(a, b)) / length(a) / length(b)).asin().to_degrees());
    }
    [distances, angles].map(|mut values| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    })
}

#[test]
fn scan_angles_give_the_path_of_scanners_that_look_across_the_flight() {
    for pattern in [
        ScanPattern::Rotating,
        ScanPattern::Oscillating(MirrorMotion::Sinusoidal),
        ScanPattern::Oscillating(MirrorMotion::Triangular),
    ] {
        let scan = flown(&AirborneParams { pattern, pulses_per_m2: 2.0, ..AirborneParams::default() });
        let mut cloud = singles(&cloud_of(&scan));
        let (truth, _) = trajectory(&scan, 0.0).scanner_positions(&cloud).unwrap();
        // as they are, and in whole degrees as LAS 1.2 keeps them
        for rounded in [false, true] {
            if rounded {
                let angles = cloud.attributes.scan_angle.as_mut().unwrap();
                angles.iter_mut().for_each(|angle| *angle = angle.to_degrees().round().to_radians());
            }
            let (positions, report) = found(&cloud);
            assert_eq!(report.found.get(&FoundBy::ScanAngle), Some(&cloud.len()), "{pattern:?}: {report:?}");
            let [metres, degrees] = apart(&cloud, &positions, &truth);
            // the path wanders by a metre about the straight line that is fitted; half a degree of rounding averages
            // out over thousands of points
            assert!(metres < 3.0 && degrees < 0.3, "{pattern:?} {rounded}: {metres} m, {degrees} deg");
        }
    }
}

#[test]
fn scan_angles_of_a_cone_are_refused() {
    let pattern = ScanPattern::CONICAL_20;
    let scan = flown(&AirborneParams { pattern, pulses_per_m2: 2.0, ..AirborneParams::default() });
    let cloud = singles(&cloud_of(&scan));
    // the whole town, and a tile so small that the scan seems to consist of two straight lines
    let within = |reach: f32| -> Vec<u32> {
        let is_near = |p: &[f32; 3]| p[0].abs() < reach && p[1].abs() < reach;
        (0_u32..).zip(&cloud.positions).filter(|(_, p)| is_near(p)).map(|(row, _)| row).collect()
    };
    for reach in [1000.0, 40.0, 20.0] {
        let cloud = cloud.select(&within(reach));
        let (_, report) = found(&cloud);
        assert!(report.is_assumed(), "{reach}: {report:?}");
        assert!(!report.angle_parts.is_empty());
        assert!(report.remarks.iter().any(|remark| remark.contains("cone")), "{:?}", report.remarks);
        let refused = locate(&cloud, &Means::Pulses, &LocateParams::default(), &Control::none());
        assert!(matches!(refused, Err(Error::MissingAttribute { .. })));
    }
}

#[test]
fn where_angles_say_nothing_pulses_with_several_returns_locate_the_scanner() {
    let scan = flown(&AirborneParams { pulses_per_m2: 4.0, ..AirborneParams::default() });
    let mut cloud = cloud_of(&scan);
    let (truth, _) = trajectory(&scan, 0.0).scanner_positions(&cloud).unwrap();
    let params = LocateParams {
        // they fix no position here, but they are there
        returns: SensorEstimateParams { min_pair_count: 100_000, ..SensorEstimateParams::default() },
        ..LocateParams::default()
    };
    let locate = |cloud: &PointCloud| locate(cloud, &Means::Automatic, &params, &Control::none()).unwrap();
    // a scanner that looks 4° ahead: every point lies 30 m farther along the flight for 450 m that it is below
    let mut late = cloud.clone();
    let (flight, times) = (trajectory(&scan, 0.0), cloud.attributes.gps_time.as_ref().unwrap());
    let shift = |(p, time): (&[f32; 3], &f64)| -> [f32; 3] {
        let [now, soon] = [*time, time + 0.1].map(|time| flight.position_at(time).unwrap());
        let below = now[2] - cloud.frame.origin[2] - f64::from(p[2]);
        // flown at 60 m/s: five times the way of a tenth of a second
        let ahead = |i: usize| (5.0 * (soon[i] - now[i]) * below / 450.0) as f32;
        [p[0] + ahead(0), p[1] + ahead(1), p[2]]
    };
    late.positions = cloud.positions.iter().zip(times).map(shift).collect();
    let (positions, report) = locate(&late);
    assert!(report.found.contains_key(&FoundBy::ScanAngle), "{report:?}");
    let [metres, degrees] = apart(&late, &positions, &truth);
    assert!(degrees < 0.5, "{metres} m, {degrees} deg");
    let [_, untold] = apart(&late, &locate_singles(&late), &truth);
    assert!(untold > 3.0, "without them the pitch stays: {untold}");
    // every point is said to lie 14° farther to the right than it does: nothing can put that right
    let angles = cloud.attributes.scan_angle.as_mut().unwrap();
    angles.iter_mut().for_each(|angle| *angle += 14_f32.to_radians());
    let (_, report) = locate(&cloud);
    assert!(report.is_assumed());
    assert!(report.angle_parts.iter().all(|part| part.verdict == AngleVerdict::Contradicted), "{report:?}");
}

/// Positions for all points, found from the angles of single returns.
fn locate_singles(cloud: &PointCloud) -> Vec<[f32; 3]> {
    let (_, report) = found(&singles(cloud));
    let attributes = &cloud.attributes;
    let place = |(line, time): (&u16, &f64)| {
        let of_line = report.paths.iter().filter(|path| path.source_id == *line);
        of_line.filter_map(|path| path.position_at(*time)).next().map_or([f32::NAN; 3], |p| p.map(|v| v as f32))
    };
    attributes.point_source_id.as_ref().unwrap().iter().zip(attributes.gps_time.as_ref().unwrap()).map(place).collect()
}

#[test]
fn the_height_of_a_trajectory_is_checked_by_pulses() {
    let scan = flown(&AirborneParams::default());
    let cloud = cloud_of(&scan);
    let (truth, _) = trajectory(&scan, 0.0).scanner_positions(&cloud).unwrap();
    for (raised, applied) in [(43.0, true), (0.0, false)] {
        let means = trajectory(&scan, raised);
        let (positions, report) =
            locate(&cloud, &Means::Trajectory(&means), &LocateParams::default(), &Control::none()).unwrap();
        let offset = report.height_offset.unwrap();
        assert!((offset.offset + raised).abs() < 2.0, "{offset:?}");
        assert_eq!(offset.is_applied, applied);
        let [metres, _] = apart(&cloud, &positions, &truth);
        assert!(metres < 2.0, "{metres}");
    }
    // without pulses of several returns nothing can be said, and that is said
    let singles = singles(&cloud);
    let means = trajectory(&scan, 43.0);
    let (_, report) = locate(&singles, &Means::Trajectory(&means), &LocateParams::default(), &Control::none()).unwrap();
    assert!(report.height_offset.is_none());
    assert!(report.remarks.iter().any(|remark| remark.contains("heights")), "{:?}", report.remarks);
}

#[test]
fn times_of_little_use_are_counted_and_lead_to_a_stated_assumption() {
    let scan = flown(&AirborneParams { pulses_per_m2: 2.0, ..AirborneParams::default() });
    let mut cloud = cloud_of(&scan);
    cloud.attributes.scan_angle = None;
    let times = cloud.attributes.gps_time.clone().unwrap();
    // points that a program added
    let virtual_rows = 0..500;
    let mut with_holes = cloud.clone();
    with_holes.attributes.gps_time.as_mut().unwrap()[virtual_rows.clone()].fill(0.0);
    let (positions, report) = found(&with_holes);
    assert_eq!(report.grouping.unwrap().without_time_count, 500);
    assert!(positions[virtual_rows].iter().all(|p| p[0].is_nan()));
    assert_eq!(report.found.get(&FoundBy::Returns), Some(&(cloud.len() - 500)), "{report:?}");
    assert!(report.remarks.iter().any(|remark| remark.starts_with("500 points have no time")), "{:?}", report.remarks);
    // every point twice: positions are those of the single ones
    let twice: Vec<u32> = (0..u32::try_from(cloud.len()).unwrap()).flat_map(|row| [row, row]).collect();
    let (positions, report) = found(&cloud.select(&twice));
    assert_eq!(report.grouping.unwrap().duplicate_count, cloud.len());
    assert!(positions.iter().all(|p| p[0].is_finite()));
    // seven times in all
    let (first, last) = times.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &t| (low.min(t), high.max(t)));
    let coarse = |t: &f64| first + ((t - first) / (last - first) * 6.0).round();
    cloud.attributes.gps_time = Some(times.iter().map(coarse).collect());
    let (positions, report) = found(&cloud);
    assert!(report.is_assumed());
    assert!(report.remarks.iter().any(|remark| remark.contains("separate pulses")), "{:?}", report.remarks);
    let located = positions.iter().filter(|p| p[0].is_finite()).count();
    assert_eq!(report.found.get(&FoundBy::Assumed), Some(&located));
    // walls and what lies under crowns are left out
    assert!(located > cloud.len() / 2 && located < cloud.len(), "{located} of {}", cloud.len());
}

#[test]
fn parts_without_pulses_of_several_returns_follow_from_their_neighbours() {
    let scan = flown(&AirborneParams { pulses_per_m2: 4.0, strip_count: 1, ..AirborneParams::default() });
    let mut cloud = cloud_of(&scan);
    cloud.attributes.scan_angle = None;
    let times = cloud.attributes.gps_time.clone().unwrap();
    let (first, last) = times.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &t| (low.min(t), high.max(t)));
    let counts = cloud.attributes.return_count.clone().unwrap();
    let is_bare = |row: usize| (0.3..0.7).contains(&((times[row] - first) / (last - first)));
    let rows: Vec<u32> =
        (0_u32..).zip(0..cloud.len()).filter(|(_, i)| !is_bare(*i) || counts[*i] == 1).map(|p| p.0).collect();
    let cloud = cloud.select(&rows);
    let (truth, _) = trajectory(&scan, 0.0).scanner_positions(&cloud).unwrap();
    let params = LocateParams {
        returns: SensorEstimateParams { part_s: 0.5, ..SensorEstimateParams::default() },
        ..LocateParams::default()
    };
    let (positions, report) = locate(&cloud, &Means::Automatic, &params, &Control::none()).unwrap();
    assert!(report.parts.iter().any(|part| part.verdict == PartVerdict::Bridged), "{:?}", report.parts);
    assert_eq!(report.found.get(&FoundBy::Returns), Some(&cloud.len()));
    let [_, degrees] = apart(&cloud, &positions, &truth);
    // as for the pulses themselves; see the simulator's echoes in `pulses.rs`
    assert!(degrees < 0.5, "{degrees}");
}

#[test]
fn a_found_path_is_read_back_as_a_trajectory() {
    let scan = flown(&AirborneParams { pulses_per_m2: 2.0, ..AirborneParams::default() });
    let cloud = cloud_of(&scan);
    let (positions, report) = found(&cloud);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("found.csv");
    let samples = path_samples(&report.paths, cloud.frame.origin, 0.5).unwrap();
    write_found_trajectory(&file, &samples, &cloud.frame.crs).unwrap();
    let (path, left_out) = read_trajectory(&file, &cloud.frame.crs).unwrap();
    assert_eq!((path.times.len(), left_out.duplicate_count), (samples.len(), 0));
    let (read, clock) = path.scanner_positions(&cloud).unwrap();
    // all but the pulses within half a microsecond of either end, which the file rounds off
    assert!(clock.known_count + 4 >= cloud.len(), "{clock:?}");
    let [metres, _] = apart(&cloud, &read, &positions);
    // millimetres in the file, and cubics between samples of a cubic
    assert!(metres < 0.05, "{metres}");
    assert!(samples.iter().all(|s| s.quality.sd.iter().all(|sd| sd.is_finite()) && s.quality.residual > 0.0));
    for step in [0.0, 3.0, f64::NAN] {
        assert!(matches!(path_samples(&report.paths, cloud.frame.origin, step), Err(Error::InvalidParameter { .. })));
    }
}

#[test]
fn order_of_points_changes_nothing() {
    let scan = flown(&AirborneParams { pulses_per_m2: 1.0, ..AirborneParams::default() });
    for cloud in [cloud_of(&scan), singles(&cloud_of(&scan))] {
        let reversed: Vec<u32> = (0..u32::try_from(cloud.len()).unwrap()).rev().collect();
        let (mut positions, _) = found(&cloud);
        positions.reverse();
        assert_eq!(found(&cloud.select(&reversed)).0, positions);
    }
}

#[test]
fn means_that_are_not_there_are_refused_with_advice() {
    let (bare, _) = PointCloud::from_coordinates(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 5.0]]);
    for means in [Means::Pulses, Means::Poses] {
        let error = locate(&bare, &means, &LocateParams::default(), &Control::none()).unwrap_err().to_string();
        assert!(error.contains("trajectory") || error.contains("GPS time"), "{error}");
    }
    let (positions, report) =
        locate(&bare, &Means::Position([0.0, 0.0, 9.0]), &LocateParams::default(), &Control::none()).unwrap();
    assert_eq!((positions, report.known_count()), (vec![[0.0, 0.0, 9.0]; 3], 3));
    assert!(found(&PointCloud::default()).0.is_empty());
}

#[test]
fn real_clouds_are_located_by_what_they_have() {
    let read = |file: &str| {
        let path = crate::common::data("real_clouds_are_located_by_what_they_have", file)?;
        Some(read_cloud(&[path], &ReadOptions::default(), &Control::none()).unwrap().0)
    };
    // scanners that look across the flight: angles alone put them where pulses with several returns do
    // (one block in Amsterdam is too narrow for two of its three lines)
    for (file, min_share) in
        [("data/delft_ahn3/ahn3_cropped_1.laz", 0.9), ("data/amsterdam_ahn3/ahn_2386_9702.laz", 0.2)]
    {
        let Some(cloud) = read(file) else { return };
        let (_, by_returns) = found(&cloud);
        let singles = singles(&cloud);
        let (by_angle, report) = found(&singles);
        let located = report.found.get(&FoundBy::ScanAngle).copied().unwrap_or(0);
        assert!(located as f64 > min_share * singles.len() as f64, "{file}: {report:?}");
        let line = |row: usize| singles.attributes.point_source_id.as_ref().unwrap()[row];
        let times = singles.attributes.gps_time.as_ref().unwrap();
        let truth: Vec<[f32; 3]> = (0..singles.len())
            .map(|row| {
                let of_line = by_returns.paths.iter().filter(|path| path.source_id == line(row));
                let place = of_line.filter_map(|path| path.position_at(times[row])).next();
                place.map_or([f32::NAN; 3], |p| p.map(|v| v as f32))
            })
            .collect();
        let [metres, degrees] = apart(&singles, &by_angle, &truth);
        // over Delft the scanner looked 4° ahead, which its angles do not tell
        assert!(degrees < 5.0, "{file}: {metres} m, {degrees} deg");
        assert!(report.remarks.iter().any(|remark| remark.contains("pitch")), "{:?}", report.remarks);
    }
    // cones, with and without pulses of several returns
    let Some(cloud) = read("data/bresse_lidarhd/870000_6618000.subset.50mx100m.las") else { return };
    let (_, report) = found(&cloud);
    assert_eq!(report.found.get(&FoundBy::Returns), Some(&cloud.len()));
    let (_, report) = found(&singles(&cloud));
    assert!(report.is_assumed(), "{report:?}");
    let Some(towns) = crate::common::data("real_clouds_are_located_by_what_they_have", "data/ign_decimated_towns")
    else {
        return;
    };
    for entry in std::fs::read_dir(towns).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "laz") {
            continue;
        }
        let (cloud, _) = read_cloud(&[path], &ReadOptions::default(), &Control::none()).unwrap();
        let (_, report) = found(&cloud);
        assert!(!report.found.contains_key(&FoundBy::ScanAngle), "{:?}", report.remarks);
    }
    let Some(rounded) = read("data/tudelft_ahn4_small/small.laz") else { return };
    let (_, report) = found(&rounded);
    assert!(report.is_assumed());
}

#[test]
fn tripods_in_a_town_are_found_in_their_points_alone_and_an_aircraft_is_no_tripod() {
    let scene = town(&Preset::Town.params(60.0, 2));
    let params = TerrestrialParams {
        stations: Stations::Chosen(2),
        angular_step: 0.6_f64.to_radians(),
        max_range: 60.0,
        ..TerrestrialParams::default()
    };
    let scan = scan_terrestrial(&scene, &params);
    let mut cloud = cloud_of(&scan);
    // as a program exports merged scans
    cloud.attributes.gps_time = None;
    cloud.attributes.scan_angle = None;
    cloud.attributes.point_source_id = None;
    let (positions, report) = found(&cloud);
    assert_eq!(report.stations.len(), scan.stations.len(), "{report:?}");
    for truth in &scan.stations {
        let off = |place: [f64; 3]| (0..3).map(|i| (place[i] - truth[i]).powi(2)).sum::<f64>().sqrt();
        let nearest = report.stations.iter().map(|station| off(station.position)).fold(f64::INFINITY, f64::min);
        // much less than the half metre of a coarser guess, and as good as such positions are measured
        assert!(nearest < 0.03, "{nearest} m: {:?}", report.stations);
    }
    assert_eq!(report.found.keys().collect::<Vec<_>>(), [&FoundBy::StationSearch]);
    assert!(report.known_count() as f64 > 0.7 * cloud.len() as f64);
    let known_count = positions.iter().filter(|place| place[0].is_finite()).count();
    assert_eq!(known_count, report.known_count());
    assert!(report.remarks.iter().any(|remark| remark.contains("stations=FILE")), "{:?}", report.remarks);

    let mut flown = cloud_of(&scan_airborne(&scene, &AirborneParams::covering(&scene, 20.0)));
    flown.attributes.gps_time = None;
    flown.attributes.scan_angle = None;
    let (_, report) = found(&flown);
    assert!(report.is_assumed() && report.stations.is_empty(), "{report:?}");
}
