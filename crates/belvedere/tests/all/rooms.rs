//! A room scanned from inside: walls block although nothing was seen behind them, and what the room holds is free.

use belvedere::apps::isovist::{IsovistParams, isovist};
use belvedere::control::Control;
use belvedere::model::{BallsReport, ModelParams, SceneModel};
use belvedere::query::{Answer, UnprovenAs, Viewer, Visibility};
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
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some hundred steps")]
            let [columns, rows] = [u, v].map(|axis| (ROOM[axis] / spacing) as u64);
            for i in 0..columns * rows {
                let at = |k: u64| uniform(positions.len() as u64, k);
                let mut p = [0.0; 3];
                p[u] = ((i % columns) as f64 + at(0)) * spacing;
                p[v] = ((i / columns) as f64 + at(1)) * spacing;
                p[axis] = side + NOISE * (2.0 * at(2) - 1.0);
                #[expect(clippy::cast_possible_truncation, reason = "a room in f32")]
                positions.push(p.map(|v| v as f32));
            }
        }
    }
    let scanner_index = positions.iter().map(|p| u16::from(p[0] > 5.0)).collect();
    let attributes = Attributes { scanner_index: Some(scanner_index), ..Attributes::default() };
    PointCloud { positions, attributes, scanner_positions: STATIONS.to_vec(), ..PointCloud::default() }
}

#[test]
fn walls_of_a_scanned_room_block_and_the_room_is_as_large_as_it_is() {
    for spacing in [0.1, 0.04] {
        let cloud = scanned(spacing);
        let (model, report) = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap();
        let Some(BallsReport::Shrunk(balls)) = report.interior_balls else { panic!("{report:?}") };
        // nothing lies behind any wall: hardly a ball meets a point, and every one is used
        assert_eq!(balls.never_shrunk, 0);
        assert_eq!(model.balls().len(), balls.shrunk + balls.limited);
        let scene = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
        for eye in [[2.5, 3.0, 1.5], [5.0, 3.0, 1.0], [8.5, 4.5, 2.0]] {
            let seen = isovist(&scene, eye, &IsovistParams::default(), &Control::none()).unwrap();
            let expected = ROOM[0] * ROOM[1] * ROOM[2];
            assert!((seen.volume / expected - 1.0).abs() < 0.02, "{spacing}: {} of {expected} m³", seen.volume);
            assert!((seen.plan.area / 60.0 - 1.0).abs() < 0.02, "{spacing}: {} m²", seen.plan.area);
        }
        // its own points are seen from where they were scanned, and nothing outside is
        let answers = scene.visible(Viewer::Eye(STATIONS[0].map(f64::from)), &cloud.positions).unwrap();
        let seen = answers.iter().filter(|answer| **answer == Answer::Visible).count();
        assert!(seen as f64 > 0.99 * cloud.len() as f64, "{spacing}: {seen} of {}", cloud.len());
        let outside: Vec<[f32; 3]> = (0..500).map(|i| [-3.0 - (i % 7) as f32, 0.01 * i as f32, 1.5]).collect();
        let answers = scene.visible(Viewer::Eye([5.0, 3.0, 1.5]), &outside).unwrap();
        let leaks = answers.iter().filter(|answer| matches!(answer, Answer::Visible | Answer::Unproven)).count();
        assert_eq!(leaks, 0, "{spacing}");
    }
}
