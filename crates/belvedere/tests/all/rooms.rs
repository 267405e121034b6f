//! A room scanned from inside: walls block although nothing was seen behind them, and what the room holds is free.

use crate::common::data;
use belvedere::apps::isovist::{IsovistParams, isovist};
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::medial::ShrinkParams;
use belvedere::model::{BallParams, BallsReport, ModelParams, SceneModel};
use belvedere::query::{Answer, MedialScene, UnprovenAs, Viewer, Visibility};
use belvedere::random::uniform;
use belvedere::{Attributes, PointCloud};

/// Length, width and height, metres.
const ROOM: [f64; 3] = [10.0, 6.0, 3.0];
/// Noise of terrestrial scans, metres, evenly spread to both sides.
const NOISE: f64 = 0.003;
const STATIONS: [[f32; 3]; 2] = [[2.5, 3.0, 1.5], [7.5, 2.0, 1.6]];

/// The six faces of the room, `spacing` metres from point to point, each point seen from the nearer station.
fn scanned(spacing: f64) -> PointCloud {
    let mut positions = Vec::new();
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        for side in [0.0, ROOM[axis]] {
            let [columns, rows] = [u, v].map(|axis| (ROOM[axis] / spacing) as u64);
            for i in 0..columns * rows {
                let at = |k: u64| uniform(positions.len() as u64, k);
                let mut p = [0.0; 3];
                p[u] = ((i % columns) as f64 + at(0)) * spacing;
                p[v] = ((i / columns) as f64 + at(1)) * spacing;
                p[axis] = side + NOISE * (2.0 * at(2) - 1.0);
                positions.push(p.map(|v| v as f32));
            }
        }
    }
    let scanner_index = positions.iter().map(|p| u16::from(p[0] > 5.0)).collect();
    let attributes = Attributes { scanner_index: Some(scanner_index), ..Attributes::default() };
    PointCloud { positions, attributes, scanner_positions: STATIONS.to_vec(), ..PointCloud::default() }
}

/// The same room as two tripods with steps of half a degree and ranges up to `noise` metres wrong see it. Neither looks
/// lower than 20° from straight down.
fn scanned_by_tripods(noise: f64) -> PointCloud {
    let (mut positions, mut scanner_index) = (Vec::new(), Vec::new());
    for (number, station) in (0_u16..).zip(STATIONS) {
        let eye = station.map(f64::from);
        for (azimuth, elevation) in (0..720).flat_map(|a| (-140..180).map(move |e| (a, e))) {
            let [azimuth, elevation] = [azimuth, elevation].map(|steps| f64::from(steps).to_radians() / 2.0);
            let ahead = [elevation.cos() * azimuth.sin(), elevation.cos() * azimuth.cos(), elevation.sin()];
            let to_face = |axis: usize| {
                let face = if ahead[axis] > 0.0 { ROOM[axis] } else { 0.0 };
                if ahead[axis] == 0.0 { f64::INFINITY } else { (face - eye[axis]) / ahead[axis] }
            };
            let error = noise * (2.0 * uniform(positions.len() as u64, 0) - 1.0);
            let range = (0..3).map(to_face).fold(f64::INFINITY, f64::min) + error;
            positions.push(std::array::from_fn(|axis| (eye[axis] + range * ahead[axis]) as f32));
            scanner_index.push(number);
        }
    }
    let attributes = Attributes { scanner_index: Some(scanner_index), ..Attributes::default() };
    PointCloud { positions, attributes, scanner_positions: STATIONS.to_vec(), ..PointCloud::default() }
}

#[test]
fn floors_below_tripods_and_ceilings_above_them_are_closed() {
    let cloud = scanned_by_tripods(NOISE);
    let (model, report) = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap();
    let Some(BallsReport::Carved(balls)) = report.interior_balls else { panic!("{report:?}") };
    // two discs of 0.62 and 0.66 m, a place every 0.075 m
    assert!((400..500).contains(&balls.count("balls_below_tripods")), "{balls:?}");
    let scene = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
    let expected = ROOM[0] * ROOM[1] * ROOM[2];
    for eye in [[2.5, 3.0, 1.5], [7.5, 2.0, 1.0], [5.0, 3.0, 2.0]] {
        let seen = isovist(&scene, eye, &IsovistParams::default(), &Control::none()).unwrap();
        assert!((seen.volume / expected - 1.0).abs() < 0.02, "{} of {expected} m³", seen.volume);
    }
}

/// The share of `places` that nothing blocks from `eye`.
fn free_share(scene: &MedialScene, eye: [f64; 3], places: &[[f32; 3]]) -> f64 {
    let answers = scene.visible(Viewer::Eye(eye), places).unwrap();
    answers.iter().filter(|answer| **answer != Answer::Blocked).count() as f64 / places.len() as f64
}

#[test]
fn ceilings_above_tripods_are_as_smooth_as_their_noise_lets_them_be() {
    // a millimetre from point to point, and a standard deviation of 5 mm
    let cloud = scanned_by_tripods(0.009);
    let (model, report) = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap();
    let noise = f64::from(report.smoothing.unwrap().noise);
    // a quartile, of ranges that stray evenly
    assert!((0.7..1.05).contains(&(noise / (0.009 / 3f64.sqrt()))), "{noise}");
    let scene = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
    let [x, y, _] = STATIONS[0];
    let above = |p: &&[f32; 3]| (p[0] - x).hypot(p[1] - y) < 0.5 && p[2] > 2.5;
    let above: Vec<[f32; 3]> = cloud.positions.iter().filter(above).copied().collect();
    assert!(above.len() > 20_000, "{}", above.len());
    for eye in [[2.5, 3.0, 1.5], [4.0, 4.5, 1.7], [8.0, 1.0, 1.2]] {
        let free = free_share(&scene, eye, &above);
        assert!(free > 0.99, "from {eye:?}: {free}");
    }
}

#[test]
fn a_scan_from_one_place_sees_its_own_points() {
    let both = scanned_by_tripods(0.009);
    let index = both.attributes.scanner_index.as_deref().unwrap();
    let rows: Vec<u32> = (0..).zip(index).filter(|(_, station)| **station == 0).map(|(row, _)| row).collect();
    let mut clouds = vec![both.select(&rows)];
    if let Some(path) = data("a_scan_from_one_place_sees_its_own_points", "data/tls_e57/pumpAVisualReferenceImage.e57")
    {
        clouds.push(read_cloud(&[path], &ReadOptions::default(), &Control::none()).unwrap().0);
    }
    for cloud in clouds {
        let (model, report) = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap();
        assert_eq!(report.pulses.unwrap().blocked.unwrap().count, 0);
        let scene = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
        let free = free_share(&scene, cloud.scanner_positions[0].map(f64::from), &cloud.positions);
        assert!(free > 0.995, "{free}");
    }
}

#[test]
fn walls_of_a_scanned_room_block_and_the_room_is_as_large_as_it_is() {
    let carved = ModelParams::default();
    let from_points = ModelParams::default().with_balls(BallParams::Shrunk(ShrinkParams::tau_by_spacing()));
    for (spacing, params) in [(0.06, &carved), (0.1, &from_points), (0.05, &from_points)] {
        let cloud = scanned(spacing);
        let (model, report) = SceneModel::build(&cloud, params, &Control::none()).unwrap();
        if let Some(BallsReport::Shrunk(balls)) = &report.interior_balls {
            // nothing lies behind any wall: hardly a ball meets a point, and every one is used
            assert_eq!(balls.never_shrunk, 0);
            assert_eq!(model.balls().len(), balls.shrunk + balls.limited);
        } else {
            assert!(model.is_carved(), "{report:?}");
            assert!(report.pulses.unwrap().blocked.unwrap().percent < 0.1);
        }
        let scene = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
        for eye in [[2.5, 3.0, 1.5], [5.0, 3.0, 1.0], [8.5, 4.5, 2.0]] {
            let seen = isovist(&scene, eye, &IsovistParams::default(), &Control::none()).unwrap();
            let expected = ROOM[0] * ROOM[1] * ROOM[2];
            assert!((seen.volume / expected - 1.0).abs() < 0.02, "{spacing}: {} of {expected} m³", seen.volume);
            assert!((seen.plan.area / 60.0 - 1.0).abs() < 0.02, "{spacing}: {} m²", seen.plan.area);
        }
        // nothing blocks its own points from where half of them were scanned, and nothing outside is seen
        let answers = scene.visible(Viewer::Eye(STATIONS[0].map(f64::from)), &cloud.positions).unwrap();
        let free = answers.iter().filter(|answer| **answer != Answer::Blocked).count();
        assert!(free as f64 > 0.99 * cloud.len() as f64, "{spacing}: {free} of {}", cloud.len());
        let outside: Vec<[f32; 3]> = (0..500).map(|i| [-3.0 - (i % 7) as f32, 0.01 * i as f32, 1.5]).collect();
        let answers = scene.visible(Viewer::Eye([5.0, 3.0, 1.5]), &outside).unwrap();
        let leaks = answers.iter().filter(|answer| matches!(answer, Answer::Visible | Answer::Unproven)).count();
        assert_eq!(leaks, 0, "{spacing}");
    }
}
