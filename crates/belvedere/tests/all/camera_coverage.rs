//! Coverage of cameras, against closed forms, single lines of sight, and the exact mesh of a town.

use crate::common::simulated::cloud_of;
use belvedere::apps::cameras::{Camera, CoverageParams, CoverageTable, Lens, Level, coverage, sees_private};
use belvedere::apps::eyes::fault_of;
use belvedere::apps::targets::{CellParams, Targets};
use belvedere::apps::viewshed::SightLimits;
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::medial::MedialBalls;
use belvedere::model::{ModelParams, SceneModel};
use belvedere::query::{Answer, BlockRule, EarthParams, MedialScene, UnprovenAs};
use belvedere::random::uniform;
use belvedere::{Frame, PointCloud};
use belvedere_scenes::{AirborneParams, TownParams, Truth, scan_airborne, town};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

fn scene(list: &[([f32; 3], f32)]) -> MedialScene {
    let balls = MedialBalls {
        centers: list.iter().map(|b| b.0).collect(),
        radii: list.iter().map(|b| b.1).collect(),
        source: (0..list.len() as u32).collect(),
        touch: (0..list.len() as u32).collect(),
        separation_angles: vec![1.0; list.len()],
    };
    MedialScene::new(&balls, &BlockRule::carved()).unwrap()
}

fn targets(positions: Vec<[f32; 3]>, normals: Option<Vec<[f32; 3]>>) -> Targets {
    let cloud = PointCloud { positions, ..PointCloud::in_frame(Frame::default()) };
    Targets::of_points(&cloud, normals)
}

fn covered(scene: &MedialScene, cameras: &[Camera], targets: &Targets, density: f64) -> CoverageTable {
    let params = CoverageParams::default().with_density(density);
    coverage(scene, cameras, targets, &params, &Control::none()).unwrap().0
}

#[test]
fn on_an_open_plain_a_camera_covers_a_sector_between_two_radii() {
    let nothing = scene(&[([0.0, 0.0, -900.0], 1.0)]);
    let (cell, height) = (0.2, 4.0);
    let steps = (100.0 / cell) as usize;
    let middle = |i: usize| ((i as f64 + 0.5) * cell - 50.0) as f32;
    let plain = targets((0..steps * steps).map(|i| [middle(i % steps), middle(i / steps), 0.0]).collect(), None);
    let area = |camera: Camera, density| {
        covered(&nothing, &[camera], &plain, density).covered_by(0).count() as f64 * cell * cell
    };
    let lens = Lens::default().with_height(Some(3.0));
    // 1920 pixels over 90 degrees have 25 on a metre at 38.4 m
    let far = 38.4_f64.powi(2) - height * height;
    // a side along a diagonal of the cells would take all of their middles or none
    for heading in [0.3, 1.0, 4.0] {
        let camera = Camera::fixed([0.0, 0.0, height], heading, 0.0, &lens, [5.0, f64::INFINITY]);
        let found = area(camera, Level::Detect.pixels_per_metre());
        let expected = FRAC_PI_4 * (far - 25.0);
        // an outline of 150 m cuts 0.2 m cells at random: some 4 m² at four deviations
        assert!((found - expected).abs() < 4.0, "{heading}: {found} {expected}");
    }
    let turning = Camera::turning([0.0, 0.0, height], &lens, SightLimits::default());
    let found = area(turning, Level::Detect.pixels_per_metre());
    assert!((found - 4.0 * FRAC_PI_4 * far).abs() < 5.0, "{found}");
    let all_around = Camera::fixed([0.0, 0.0, height], 0.0, 0.0, &lens.with_width(TAU).with_height(None), [0.0, 30.0]);
    assert!((area(all_around, 250.0) - 900.0 * 2.0 * FRAC_PI_2).abs() < 5.0);
    // a level picture of 40 degrees in height ends at h / tan 20° below it
    let narrow = Camera::fixed([0.0, 0.0, height], 0.3, 0.0, &lens.with_height(Some(40_f64.to_radians())), [0.0, 30.0]);
    let foot = height / 20_f64.to_radians().tan();
    // beyond a depth of d: the quarter of the disc without the triangle before it
    let expected = FRAC_PI_4 * 900.0 - foot * foot;
    assert!((area(narrow, 0.0) - expected).abs() < 4.0, "{} {expected}", area(narrow, 0.0));
}

fn random_balls(count: u64, size: f64) -> Vec<([f32; 3], f32)> {
    let at = |i: u64| (size * uniform(3, i)) as f32;
    (0..count).map(|i| ([at(3 * i), at(3 * i + 1), 0.2 * at(3 * i + 2)], 0.3 + 2.0 * uniform(4, i) as f32)).collect()
}

/// Six cameras at each of some places among random balls, and targets with normals of which some have no position.
fn crowded() -> (MedialScene, Vec<Camera>, Targets) {
    let random = |seed: u64, i: u64| uniform(seed, i);
    let positions = (0..3000).map(|i| match i % 97 {
        0 => [f32::NAN; 3],
        _ => [40.0 * random(7, 3 * i) as f32, 40.0 * random(7, 3 * i + 1) as f32, 6.0 * random(7, 3 * i + 2) as f32],
    });
    let turned = |i: u64| TAU * random(8, i);
    let normals = (0..3000).map(|i| [turned(i).sin() as f32, turned(i).cos() as f32, 0.0]).collect();
    let lens = Lens::default().with_pixels(1000.0);
    let mut cameras = Vec::new();
    for place in 0..12 {
        let eye = [40.0 * random(5, 3 * place), 40.0 * random(5, 3 * place + 1), 8.0 * random(5, 3 * place + 2)];
        cameras.extend((0..5).map(|i| Camera::fixed(eye, TAU / 5.0 * f64::from(i), 0.2, &lens, [1.0, 25.0])));
        cameras.push(Camera::turning(eye, &lens, SightLimits { distance: [0.0, 15.0], ..SightLimits::default() }));
    }
    cameras.push(Camera::turning([f64::NAN; 3], &lens, SightLimits::default()));
    (scene(&random_balls(150, 40.0)), cameras, targets(positions.collect(), Some(normals)))
}

#[test]
fn a_target_is_covered_if_it_is_in_the_picture_and_its_line_of_sight_is_free() {
    let (scene, cameras, targets) = crowded();
    let density = 30.0;
    let params = CoverageParams::default().with_density(density);
    let (table, report) = coverage(&scene, &cameras, &targets, &params, &Control::none()).unwrap();
    let normals = targets.normals.as_ref().unwrap();
    let (mut in_picture, mut free) = (0, 0);
    for (number, camera) in cameras.iter().enumerate() {
        let covered: Vec<usize> = table.covered_by(number).collect();
        let expected = |target: &usize| {
            let place = targets.positions[*target].map(f64::from);
            let is_in = camera.covers(place, Some(normals[*target].map(f64::from)), density);
            in_picture += usize::from(is_in);
            let is_free = is_in && scene.sight_answer(camera.eye, place, &EarthParams::default()) == Answer::Visible;
            free += usize::from(is_free);
            is_free
        };
        assert_eq!(covered, (0..targets.len()).filter(expected).collect::<Vec<_>>(), "{number}");
    }
    assert!(free > 500 && in_picture > free + 500, "{free} of {in_picture}");
    assert!(report.lines_of_sight < in_picture && report.visible > 300, "{report:?}: lines are shared at a place");
    assert!(table.covered_by(cameras.len() - 1).next().is_none(), "an eye that is no number covers nothing");
}

#[test]
fn threads_do_not_change_what_is_covered() {
    let (scene, cameras, targets) = crowded();
    let [one, four] = [1, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| covered(&scene, &cameras, &targets, 30.0))
    });
    assert_eq!(one, four);
}

#[test]
fn headings_that_see_a_private_place_are_those_that_have_it_in_their_picture() {
    // a ball hides the private place in the west, nothing that in the east
    let scene = scene(&[([-5.0, 0.0, 2.0], 1.0)]);
    let lens = Lens::default();
    let headings = [0.0, FRAC_PI_2, 3.0, 3.0 * FRAC_PI_2];
    // too far for any use, and too coarse
    let camera = |heading: f64| Camera::fixed([0.0, 0.0, 2.0], heading, 0.0, &lens, [0.0, 10.0]);
    let cameras = headings.map(camera);
    let private = targets(vec![[-200.0, 0.0, 2.0], [200.0, 0.0, 2.0]], Some(vec![[1.0, 0.0, 0.0]; 2]));
    let seen = sees_private(&scene, &cameras, &private, &EarthParams::default(), &Control::none()).unwrap();
    assert_eq!(seen, [false, true, false, false]);
    let none = sees_private(&scene, &cameras, &targets(vec![], None), &EarthParams::default(), &Control::none());
    assert_eq!(none.unwrap(), [false; 4]);
}

#[test]
fn in_a_scanned_town_coverage_agrees_with_the_exact_mesh() {
    let exact = town(&TownParams { extent: 60.0, ..TownParams::default() });
    let cloud = cloud_of(&scan_airborne(&exact, &AirborneParams { pulses_per_m2: 8.0, ..AirborneParams::default() }));
    let none = Control::none();
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &none).unwrap();
    let blockers = model.scene(&model.rule(), UnprovenAs::Reported, &none).unwrap();
    let (low, high) = model.bounds().on_map();
    let grid = MapGrid::covering(low, high, 1.0, [0.0; 2]).unwrap();
    let (ground, _) = Ground::of_cloud(&cloud, grid, &GroundParams::default(), &none).unwrap();
    let (targets, _) =
        Targets::of_cells(&cloud, ground.clone(), &CellParams::default().with_height(1.5), &none).unwrap();
    let place = |i: u64| {
        let [x, y] = [0, 1].map(|axis| low[axis] + (high[axis] - low[axis]) * uniform(9, 2 * i + axis as u64));
        ground.height_at([x, y]).map(|height| [x, y, height + 4.0])
    };
    let eyes = (0..40).filter_map(place).filter(|eye| fault_of(&blockers, Some(&ground), *eye).is_none());
    let lens = Lens::default();
    let cameras: Vec<Camera> = eyes
        .flat_map(|eye| (0..4).map(move |i| Camera::fixed(eye, FRAC_PI_2 * f64::from(i), 0.3, &lens, [0.0, 38.0])))
        .collect();
    let params = CoverageParams::default().with_density(25.0);
    let (table, report) = coverage(&blockers, &cameras, &targets, &params, &none).unwrap();
    // what is not proven covers only where it counts as visible
    let params = params.with_unproven(UnprovenAs::Visible);
    let (with_unproven, all_visible) = coverage(&blockers, &cameras, &targets, &params, &none).unwrap();
    assert_eq!((all_visible.visible, all_visible.unproven), (report.visible + report.unproven, 0));
    assert!(report.unproven > 100 && with_unproven.pair_count() > table.pair_count() + 100, "{report:?}");
    let truth = Truth::new(&exact);
    let file = |place: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| place[i] + cloud.frame.origin[i]) };
    let (mut right, mut missed, mut wrong) = (0, 0, 0);
    for (number, camera) in cameras.iter().enumerate() {
        let covered: std::collections::BTreeSet<usize> = table.covered_by(number).collect();
        for target in (0..targets.len()).filter(|&target| targets.is_target(target)) {
            let place = targets.positions[target].map(f64::from);
            if !camera.covers(place, None, 25.0) {
                assert!(!covered.contains(&target));
                continue;
            }
            match (!truth.occluded(file(camera.eye), file(place)), covered.contains(&target)) {
                (true, false) => missed += 1,
                (false, true) => wrong += 1,
                _ => right += 1,
            }
        }
    }
    let all = f64::from(right + missed + wrong);
    let [missed, wrong] = [missed, wrong].map(|count| 100.0 * f64::from(count) / all);
    assert!(cameras.len() >= 80 && all > 20_000.0, "{} cameras, {all} lines", cameras.len());
    // what is covered wrongly is the error that matters; what no pulse came near is missed on purpose
    assert!(wrong < 2.0 && missed < 8.0, "{missed} % missed, {wrong} % wrong of {all}");
}
