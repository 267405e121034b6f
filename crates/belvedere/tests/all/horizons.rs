//! Horizons against closed forms and against lines of sight tried one by one.

use belvedere::apps::horizon::{HorizonParams, horizons};
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockRule, Blocker, Curvature, EarthParams, MedialScene};
use belvedere::random::uniform;
use belvedere::view::to_sun;
use std::f64::consts::FRAC_PI_2;

fn scene(list: &[([f32; 3], f32)], params: &BlockRule) -> MedialScene {
    let balls = MedialBalls {
        centers: list.iter().map(|b| b.0).collect(),
        radii: list.iter().map(|b| b.1).collect(),
        source: vec![0; list.len()],
        touch: vec![0; list.len()],
        separation_angles: vec![1.0; list.len()],
    };
    MedialScene::new(&balls, params).unwrap()
}

#[test]
fn a_ball_stands_as_high_as_its_tangents() {
    // due east, its middle 30° high at a distance of 20 m, 3 m of radius
    let center = to_sun(FRAC_PI_2, 30f64.to_radians()).map(|v| (20.0 * v) as f32);
    let scene = scene(&[(center, 3.0)], &BlockRule::default());
    let skyline = scene.skyline([0.0; 3], 360, &EarthParams::flat(), &Control::none()).unwrap();
    let expected = 30f64.to_radians() + (3.0f64 / 20.0).asin();
    // centres are f32: 1e-7
    assert!((skyline[90].elevation - expected).abs() < 1e-6, "{:?}", skyline[90]);
    assert!(
        (skyline[90].range - (400.0f64 - 9.0).sqrt()).abs() < 1e-5 && skyline[90].blocker == Some(Blocker::Ball(0))
    );
    // the vertical planes that touch it: sin = r / horizontal distance
    let half = (3.0 / (20.0 * 30f64.to_radians().cos())).asin().to_degrees();
    for (azimuth, point) in skyline.iter().enumerate() {
        let is_met = (azimuth as f64 - 90.0).abs() < half;
        assert_eq!(point.blocker.is_some(), is_met, "{azimuth}");
        assert_eq!(point.elevation > -FRAC_PI_2, is_met);
    }
}

/// The highest of 7200 elevations at which a ray from the eye is blocked; lines of sight are those of any query.
fn tried(scene: &MedialScene, eye: [f64; 3], azimuth: f64) -> Option<f64> {
    let elevation = |i: i32| f64::from(i) * FRAC_PI_2 / 3600.0;
    (-3599..3600)
        .rev()
        .map(elevation)
        .find(|&elevation| scene.answer(eye, to_sun(azimuth, elevation), f64::INFINITY) == Answer::Blocked)
}

#[test]
fn skylines_are_what_lines_of_sight_tried_one_by_one_find() {
    let at = |i: u64| (60.0 * uniform(7, i) - 30.0) as f32;
    let list: Vec<([f32; 3], f32)> =
        (0..150).map(|i| ([at(3 * i), at(3 * i + 1), 0.3 * at(3 * i + 2)], 0.3 + 2.5 * uniform(8, i) as f32)).collect();
    for params in [BlockRule::default(), BlockRule::carved()] {
        let scene = scene(&list, &params);
        let mut compared = 0;
        for eye in 0..12 {
            let eye: [f64; 3] = std::array::from_fn(|axis| 20.0 * uniform(9, 3 * eye + axis as u64) - 10.0);
            if scene.enclosure(eye).ball_count > 0 {
                continue;
            }
            let skyline = scene.skyline(eye, 24, &EarthParams::flat(), &Control::none()).unwrap();
            for (i, point) in skyline.iter().enumerate() {
                compared += 1;
                let azimuth = f64::from(i as u32) * 15f64.to_radians();
                match tried(&scene, eye, azimuth) {
                    // nothing may block above; what blocks below must be within a step of 0.025°
                    Some(found) => {
                        assert!(point.elevation >= found - 1e-7, "{azimuth}: {} {found}", point.elevation);
                        assert!(point.elevation < found + 0.026f64.to_radians(), "{azimuth}: {}", point.elevation);
                    }
                    None => assert!(point.elevation < -89.9f64.to_radians(), "{azimuth}: {}", point.elevation),
                }
            }
        }
        assert!(compared > 100, "{compared}");
    }
}

#[test]
fn what_floats_above_a_gap_is_the_horizon_and_a_roof_overhead_hides_the_zenith() {
    let north = ([0.0, 20.0, 0.0], 1.0);
    let floating = ([0.0, 20.0, 15.0], 0.2);
    let scene_of = |list: &[_]| scene(list, &BlockRule::default());
    let low = scene_of(&[north]).skyline([0.0; 3], 4, &EarthParams::flat(), &Control::none()).unwrap()[0].elevation;
    let high =
        scene_of(&[north, floating]).skyline([0.0; 3], 4, &EarthParams::flat(), &Control::none()).unwrap()[0].elevation;
    assert!((low - 0.05f64.asin()).abs() < 1e-7);
    assert!((high - (0.75f64.atan() + (0.2f64 / 25.0).asin())).abs() < 1e-7);
    // above the eye, a little to the north: its edge reaches over the zenith into the south
    let roof =
        scene_of(&[([0.0, 1.0, 5.0], 3.0)]).skyline([0.0; 3], 4, &EarthParams::flat(), &Control::none()).unwrap();
    assert_eq!(roof.iter().map(|p| p.elevation == FRAC_PI_2).collect::<Vec<_>>(), [true; 4]);
    let beside =
        scene_of(&[([0.0, 4.0, 5.0], 3.0)]).skyline([0.0; 3], 4, &EarthParams::flat(), &Control::none()).unwrap();
    assert!(beside[0].elevation < FRAC_PI_2 && beside[2].blocker.is_none());
}

#[test]
fn far_balls_sink_with_the_earth() {
    let scene = scene(&[([0.0, 10_000.0, 50.0], 10.0)], &BlockRule::default());
    let height = |earth: &EarthParams| {
        scene.skyline([0.0; 3], 1, earth, &Control::none()).unwrap()[0].elevation.tan() * 10_000.0
    };
    let bare = EarthParams { curvature: Curvature::On, refraction: 0.0, ..EarthParams::default() };
    // S² / 2R = 7.848 m; tangents of a ball so far away differ from its top by r² / 2S = 5 mm
    assert!((height(&EarthParams::flat()) - height(&bare) - 7.848).abs() < 0.01);
    assert!((height(&EarthParams::flat()) - 60.0).abs() < 0.01);
}

#[test]
fn azimuths_may_count_from_true_north_and_any_number_of_threads_gives_the_same() {
    let list: Vec<([f32; 3], f32)> = (0..100_000)
        .map(|i| {
            let at = |j: u64, size: f64| (size * (uniform(5, 3 * i + j) - 0.5)) as f32;
            ([at(0, 400.0), at(1, 400.0), at(2, 20.0)], 0.5)
        })
        .collect();
    let scene = scene(&list, &BlockRule::default());
    let grid = HorizonParams::default().with_azimuth_count(720);
    let [all] = horizons(&scene, &[[0.0, 0.0, 12.0]], &grid, &Control::none()).unwrap().try_into().unwrap();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let [alone] =
        one.install(|| horizons(&scene, &[[0.0, 0.0, 12.0]], &grid, &Control::none())).unwrap().try_into().unwrap();
    assert_eq!(all, alone);
    // grid north points 1° east of true north: what is at 10° by the grid is at 11° by the globe
    let turned = grid.with_turn(1f64.to_radians());
    let [globe] = horizons(&scene, &[[0.0, 0.0, 12.0]], &turned, &Control::none()).unwrap().try_into().unwrap();
    for (i, point) in all.iter().enumerate() {
        assert!((globe[(i + 2) % 720].elevation - point.elevation).abs() < 1e-9, "{i}");
    }
    for params in [grid.with_azimuth_count(0), grid.with_azimuth_count(2_000_000), grid.with_turn(f64::NAN)] {
        assert!(horizons(&scene, &[[0.0; 3]], &params, &Control::none()).is_err());
    }
    // an eye that was skipped has none
    assert!(horizons(&scene, &[[f64::NAN; 3]], &grid, &Control::none()).unwrap()[0].is_empty());
}
