//! Scenes from which a building is cleared: against the exact scene that never had it.

use crate::common::simulated::cloud_of;
use belvedere::control::Control;
use belvedere::model::{ClearedArea, ModelParams, SceneModel};
use belvedere::query::{Answer, UnprovenAs, random_targets};
use belvedere::view::to_sun;
use belvedere::{Mesh, PatchKind, PointCloud, SurfacePatches};
use belvedere_scenes::{
    AirborneParams, Material, ObjectPart, PlanPlacement, TriangleScene, Truth, extruded, scan_airborne,
};

const FIRST: [f64; 2] = [24.0, 30.0];
const SECOND: [f64; 2] = [38.0, 30.0];

fn building(middle: [f64; 2], side: f64, height: f64) -> ObjectPart {
    extruded(&PlanPlacement { origin: middle, angle: 0.0 }.rectangle(side, side), 0.0, height)
}

/// Level ground with a building, and with another.
fn scene(both: bool) -> TriangleScene {
    let mut scene = TriangleScene::default();
    let ground = ObjectPart {
        vertices: vec![[0.0, 0.0, 0.0], [60.0, 0.0, 0.0], [60.0, 60.0, 0.0], [0.0, 60.0, 0.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        materials: vec![Material::Terrain; 2],
    };
    scene.add_object("ground", &[ground]);
    scene.add_object("second", &[building(SECOND, 8.0, 10.0)]);
    if both {
        scene.add_object("first", &[building(FIRST, 10.0, 8.0)]);
    }
    scene
}

fn surveyed() -> (SceneModel, PointCloud) {
    let scan = scan_airborne(&scene(true), &AirborneParams { pulses_per_m2: 6.0, ..AirborneParams::default() });
    let cloud = cloud_of(&scan);
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap();
    (model, cloud)
}

fn same_balls(a: &SceneModel, b: &SceneModel) -> bool {
    let (a, b) = (a.balls(), b.balls());
    (&a.centers, &a.radii, &a.source, &a.touch) == (&b.centers, &b.radii, &b.source, &b.touch)
}

fn square(cloud: &PointCloud, middle: [f64; 2], half: f64) -> ClearedArea {
    let corner = |x: f64, y: f64| [middle[0] + x - cloud.frame.origin[0], middle[1] + y - cloud.frame.origin[1]];
    ClearedArea::Polygon(vec![vec![corner(-half, -half), corner(half, -half), corner(half, half), corner(-half, half)]])
}

#[test]
fn a_cleared_building_is_gone_and_the_ground_below_it_closed() {
    let (model, cloud) = surveyed();
    let control = Control::none();
    let before = model.scene(&model.rule(), UnprovenAs::Reported, &control).unwrap();
    let (cleared, left, report) = model.clone().without(&square(&cloud, FIRST, 5.5), &cloud, &control).unwrap();
    assert_eq!(left.len() + report.points_cleared, cloud.len());
    assert!(report.points_cleared > 300 && report.balls_cleared > 100 && report.ground_balls_added > 300, "{report:?}");
    let after = cleared.scene(&cleared.rule(), UnprovenAs::Reported, &control).unwrap();
    let local = |place: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| place[i] - cloud.frame.origin[i]) };
    let truth = Truth::new(&scene(false));
    // people in the sun, on the ground beside what is left
    for (azimuth, elevation) in [(250.0_f64, 35.0_f64), (110.0, 25.0), (180.0, 60.0)] {
        let sun = to_sun(azimuth.to_radians(), elevation.to_radians());
        let (mut queried, mut wrong) = (0, 0);
        for place in random_targets([8.0, 8.0, 1.0], [52.0, 52.0, 1.0], 4000, 3) {
            let place = place.map(f64::from);
            if (0..2).all(|axis| (place[axis] - SECOND[axis]).abs() < 5.0) {
                continue;
            }
            queried += 1;
            let is_lit = !truth.occluded_towards(place, sun);
            let answer = after.answer(local(place), sun, f64::INFINITY);
            let in_area = (0..2).all(|axis| (place[axis] - FIRST[axis]).abs() < 5.0);
            assert!(!(in_area && is_lit) || answer == Answer::Visible, "{place:?} {answer:?}");
            wrong += usize::from((answer != Answer::Blocked) != is_lit);
        }
        assert!(wrong * 100 < queried * 2, "{wrong} of {queried}");
    }
    // straight through where it stood, which no pulse saw
    let through = [[FIRST[0], 22.0, 2.0], [FIRST[0], 38.0, 2.0]].map(local);
    let flat = belvedere::query::EarthParams::flat();
    assert_eq!(before.sight_answer(through[0], through[1], &flat), Answer::Blocked);
    let sight = after.line_of_sight(through[0], through[1], &flat).unwrap();
    assert_eq!((sight.answer, after.sight_answer(through[0], through[1], &flat)), (Answer::Visible, Answer::Visible));
    assert!(sight.unproven_length < 0.5);
    // the ground is closed
    for place in random_targets([20.0, 26.0, -1.0], [28.0, 34.0, -0.5], 500, 4) {
        let up = to_sun(1.0, 0.9);
        assert_eq!(after.answer(local(place.map(f64::from)), up, f64::INFINITY), Answer::Blocked, "{place:?}");
    }
    // rows are those of the points that are left
    let balls = cleared.balls();
    assert!(balls.source.iter().all(|&row| (row as usize) < left.len()));
}

#[test]
fn the_ground_stays_closed_when_what_was_near_is_cleared_next() {
    let (_, mut cloud) = surveyed();
    let control = Control::none();
    // in the building, where no pulse reached the ground, stands a hedge close to it; the survey has classes
    let is_low = |position: &[f32; 3]| f64::from(position[2]) + cloud.frame.origin[2] < 0.3;
    let classes = cloud.positions.iter().map(|position| if is_low(position) { 2 } else { 6 }).collect();
    cloud.attributes.classification = Some(classes);
    let mut rows: Vec<u32> = (0..cloud.len() as u32).collect();
    let hedge: Vec<[f32; 3]> = (0..16)
        .map(|i| [FIRST[0] - 4.0 + 0.5 * f64::from(i), FIRST[1], 0.4])
        .map(|place| std::array::from_fn(|i| (place[i] - cloud.frame.origin[i]) as f32))
        .collect();
    let count = rows.len();
    rows.extend(0..hedge.len() as u32);
    cloud = cloud.select(&rows);
    cloud.positions[count..].copy_from_slice(&hedge);
    cloud.attributes.classification.as_mut().unwrap()[count..].fill(5);
    let (mut model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control).unwrap();
    let mut left = cloud.clone();
    let mut closing = 0;
    for class in [6, 5] {
        let report;
        (model, left, report) = model.without(&ClearedArea::Class(class), &left, &control).unwrap();
        assert!(report.points_cleared >= hedge.len(), "{report:?}");
        closing += report.ground_balls_added;
    }
    assert!(closing > 300, "{closing}");
    let scene = model.scene(&model.rule(), UnprovenAs::Reported, &control).unwrap();
    let up = to_sun(1.0, 0.9);
    for place in random_targets([20.5, 26.5, -1.0], [27.5, 33.5, -0.5], 500, 4) {
        let place: [f64; 3] = std::array::from_fn(|i| f64::from(place[i]) - cloud.frame.origin[i]);
        assert_eq!(scene.answer(place, up, f64::INFINITY), Answer::Blocked, "{place:?}");
    }
}

#[test]
fn adding_a_building_and_clearing_it_restores_every_answer() {
    let (model, cloud) = surveyed();
    let control = Control::none();
    let site = [46.0, 14.0];
    let mut planned = TriangleScene::default();
    planned.add_object("planned", &[building(site, 6.0, 12.0)]);
    let mesh = Mesh { vertices: planned.vertices.clone(), triangles: planned.triangles.clone(), ..Mesh::default() };
    let added = model.clone().with_added(&mesh, "planned").unwrap();
    let (restored, left, report) = added.clone().without(&square(&cloud, site, 4.0), &cloud, &control).unwrap();
    assert!(restored.added().is_none() && left.positions == cloud.positions);
    assert_eq!(report, Default::default());
    assert!(same_balls(&restored, &model));
    let bounds = model.bounds();
    let targets = random_targets(bounds.low, bounds.high, 4000, 8);
    let directions: Vec<[f64; 3]> = (0..20).map(|i| to_sun(f64::from(i), 0.1 + 0.07 * f64::from(i))).collect();
    let scenes =
        [&model, &added, &restored].map(|model| model.scene(&model.rule(), UnprovenAs::Reported, &control).unwrap());
    let eye = targets[17].map(f64::from);
    let answers = |index: usize| -> Vec<Answer> {
        let scene = &scenes[index];
        let mut answers = scene.visible_from(belvedere::query::Viewer::Eye(eye), &targets, &control).unwrap();
        let lines = targets.iter().zip(directions.iter().cycle());
        answers.extend(lines.map(|(target, sun)| scene.answer(target.map(f64::from), *sun, f64::INFINITY)));
        answers
    };
    let (before, with, after) = (answers(0), answers(1), answers(2));
    assert!(before == after && before != with && before.contains(&Answer::Unproven));
    let [first, _, last] =
        scenes.each_ref().map(|scene| scene.visibility_matrix(&targets, &directions, &control).unwrap());
    assert!(first == last);
}

#[test]
fn areas_that_cannot_be_cleared_are_refused() {
    let (model, cloud) = surveyed();
    let refused = |area: ClearedArea, words: &[&str]| {
        let error = model.clone().without(&area, &cloud, &Control::none()).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    refused(square(&cloud, [900.0, 30.0], 5.0), &["area", "cloud"]);
    refused(ClearedArea::Class(2), &["class 2"]);
    refused(ClearedArea::Polygon(vec![vec![[0.0, 0.0], [1.0, 0.0]]]), &["three corners"]);
    // no point of this class: nothing changes
    let (same, left, report) = model.clone().without(&ClearedArea::Class(17), &cloud, &Control::none()).unwrap();
    assert!(same_balls(&same, &model) && left.len() == cloud.len() && report == Default::default());
    let nothing = PointCloud::in_frame(cloud.frame.clone());
    assert!(model.clone().without(&square(&cloud, FIRST, 5.0), &nothing, &Control::none()).is_err());
}

#[test]
fn patches_are_cut_at_the_edge_of_a_cleared_area_and_their_answers_are_those_without_them() {
    let (model, cloud) = surveyed();
    let control = Control::none();
    let origin = cloud.frame.origin;
    let local = |x: f64, y: f64, z: f64| [x - origin[0], y - origin[1], z - origin[2]].map(|v| v as f32);
    // a roof 12 m up over both buildings, 20 m by 10 m
    let mut patches = SurfacePatches::default();
    let [a, b, c, d] =
        [local(22.0, 25.0, 12.0), local(42.0, 25.0, 12.0), local(42.0, 35.0, 12.0), local(22.0, 35.0, 12.0)];
    patches.push([a, b, c], PatchKind::Roof);
    patches.push([a, c, d], PatchKind::Roof);
    let with = model.clone().with_patches(patches.clone()).unwrap();
    assert!(SceneModel::from_parts(with.parts().clone()).unwrap().triangles().is_some());
    // the area ends at x = 29.5
    let area = square(&cloud, FIRST, 5.5);
    let (cleared, _, report) = with.clone().without(&area, &cloud, &control).unwrap();
    assert!((report.patches_cleared_m2 - 75.0).abs() < 0.01, "{report:?}");
    assert!((cleared.patches().area_m2() - 125.0).abs() < 0.01);
    let (bare, ..) = model.without(&area, &cloud, &control).unwrap();
    let [cleared_scene, bare_scene] =
        [&cleared, &bare].map(|model| model.scene(&model.rule(), UnprovenAs::Visible, &control).unwrap());
    let up = [0.0, 0.0, 1.0];
    for place in random_targets([22.5, 25.5, 11.0], [41.5, 34.5, 11.5], 500, 9) {
        let place: [f64; 3] = std::array::from_fn(|i| f64::from(place[i]) - origin[i]);
        let is_below = place[0] + origin[0] > 29.5;
        let expected = if is_below { Answer::Blocked } else { bare_scene.answer(place, up, f64::INFINITY) };
        assert_eq!(cleared_scene.answer(place, up, f64::INFINITY), expected, "{place:?}");
    }
    // a class of other things leaves them, that of buildings takes them all
    let (left, _, report) = with.clone().without(&ClearedArea::Class(5), &cloud, &control).unwrap();
    assert!(left.patches() == &patches && report.patches_cleared_m2 == 0.0);
    let (left, _, report) = with.without(&ClearedArea::Class(6), &cloud, &control).unwrap();
    assert!(left.patches().is_empty() && (report.patches_cleared_m2 - 200.0).abs() < 0.01);
    assert!(left.triangles().is_none());
}
