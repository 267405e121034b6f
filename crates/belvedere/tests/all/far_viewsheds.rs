//! Viewsheds of terrain beyond a cloud, against closed forms and against lines of sight that are followed step by step
//! over the same surface.

use crate::common::data;
use crate::mountains::{grid, mountains};
use belvedere::apps::viewshed::{Observer, SightLimits, Viewshed, ViewshedParams, far_viewshed, terrain_within_reach};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockRule, Coverage, Curvature, EarthParams, FarTerrain, MedialScene};
use belvedere::random::uniform;
use belvedere::{Bounds, ElevationGrid};
use std::f64::consts::TAU;

pub(crate) type MapBox = ([f64; 2], [f64; 2]);

/// A scene over `cloud` on the map with one ball, before `terrain`.
pub(crate) fn scene(terrain: ElevationGrid, (low, high): MapBox, center: [f64; 3], radius: f64) -> MedialScene {
    let mut balls = MedialBalls::default();
    balls.push(0, center.map(|v| v as f32), radius as f32, 0);
    let corner = |[x, y]: [f64; 2], z: f32| [x as f32, y as f32, z];
    let bounds = Bounds { low: corner(low, -5000.0), high: corner(high, 5000.0) };
    MedialScene::new(&balls, &BlockRule::default())
        .unwrap()
        .with_coverage(Coverage::of(bounds))
        .with_far_terrain(FarTerrain::default().with_grid(terrain, Some((low, high))))
}

/// The same with a ball that is in nobody's way.
pub(crate) fn open_scene(terrain: ElevationGrid, cloud: MapBox) -> MedialScene {
    scene(terrain, cloud, [cloud.0[0], cloud.0[1], -4000.0], 1.0)
}

pub(crate) fn around([x, y, _]: [f64; 3], half: f64) -> MapBox {
    ([x - half, y - half], [x + half, y + half])
}

pub(crate) fn observer(eye: [f64; 3]) -> Observer {
    Observer { eye, limits: SightLimits::default() }
}

fn seen(scene: &MedialScene, observers: &[Observer], height: f64, earth: EarthParams) -> Viewshed {
    let terrain = scene.far_terrain().grid().unwrap();
    let params = ViewshedParams::default().with_earth(earth);
    far_viewshed(scene, observers, terrain, height, &params, &Control::none()).unwrap()
}

/// The nodes beyond the cloud with what is seen of them.
fn nodes<'a>(scene: &'a MedialScene, seen: &'a Viewshed) -> impl Iterator<Item = ([f64; 3], Answer)> + 'a {
    let terrain = scene.far_terrain().grid().unwrap();
    let width = terrain.heights().width();
    let all = seen.answers.iter().enumerate().filter(|(_, answer)| **answer != Answer::OutsideCloud);
    all.map(move |(i, &answer)| (terrain.node(i % width, i / width).unwrap(), answer))
}

/// Returns the depth of a line of sight below the straight one between its ends: (1 - k) s (S - s) / 2R.
pub(crate) fn sag(earth: &EarthParams, s: f64, span: f64) -> f64 {
    if earth.curvature == Curvature::Off {
        0.0
    } else {
        (1.0 - earth.refraction) * s * (span - s) / (2.0 * earth.radius)
    }
}

#[test]
fn the_sea_is_seen_up_to_the_distance_of_the_horizon() {
    let eye = [50_000.0, -50_000.0, 50.0];
    let scene = open_scene(grid(101, 1000.0, |_, _| 0.0), around(eye, 300.0));
    for (height, refraction) in [(0.0, 1.0 / 7.0), (12.0, 1.0 / 7.0), (0.0, 0.0)] {
        let earth = EarthParams { refraction, ..EarthParams::default() };
        // √(2 R' h) from the eye to where the sea begins to hide, and as far again from there for what stands in it
        let radius = earth.radius / (1.0 - refraction);
        let reach = (2.0 * radius * eye[2]).sqrt() + (2.0 * radius * height).sqrt();
        let found = seen(&scene, &[observer(eye)], height, earth);
        let mut counts = [0; 2];
        for (node, answer) in nodes(&scene, &found) {
            let span = (node[0] - eye[0]).hypot(node[1] - eye[1]);
            let expected = if span <= reach { Answer::Visible } else { Answer::Blocked };
            assert_eq!(answer, expected, "{span} of {reach}");
            counts[usize::from(answer == Answer::Visible)] += 1;
        }
        assert!(counts.iter().all(|&count| count > 1000) && found.seen_counts == [counts[1]], "{counts:?}");
    }
    // a plane earth hides nothing of a plane
    let flat = seen(&scene, &[observer(eye)], 0.0, EarthParams::flat());
    assert!(nodes(&scene, &flat).all(|(_, answer)| answer == Answer::Visible));
}

#[test]
fn a_ridge_hides_what_lies_below_the_line_over_its_crest() {
    let (eye, cell, top) = ([2000.0, -4000.0, 250.0], 20.0, 90.0);
    let ridge = |x: f64, _: f64| if x == 5000.0 { top } else { 0.0 };
    let scene = open_scene(grid(501, cell, ridge), around(eye, 400.0));
    for (earth, height) in [(EarthParams::default(), 0.0), (EarthParams::flat(), 0.0), (EarthParams::default(), 35.0)] {
        let found = seen(&scene, &[observer(eye)], height, earth);
        let mut counts = [0; 2];
        for (node, answer) in nodes(&scene, &found).filter(|(node, _)| (node[0] - 5000.0).abs() != cell) {
            let span = (node[0] - eye[0]).hypot(node[1] - eye[1]);
            let share = 3000.0 / (node[0] - eye[0]);
            let rise = node[2] + height - eye[2];
            let over = eye[2] + rise * share - sag(&earth, share * span, span) - top;
            assert!(over.abs() > 1e-6 || node[0] <= 5000.0, "a node on the edge decides nothing");
            let is_seen = node[0] <= 5000.0 || over > 0.0;
            assert_eq!(answer == Answer::Visible, is_seen, "{node:?} {over}");
            counts[usize::from(is_seen && node[0] > 5000.0)] += usize::from(node[0] > 5000.0);
        }
        assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
    }
}

/// Returns the minimum height of a line of sight above the terrain beyond `cloud` and a cell around it, by steps of a
/// 32nd of each patch: no maxima, no closed form.
fn clearance(grid: &ElevationGrid, cloud: MapBox, eye: [f64; 3], target: [f64; 3], earth: &EarthParams) -> f64 {
    // NaN is never the smaller one
    heights_above(grid, cloud, eye, target, earth).into_iter().map(|[_, above]| above).fold(f64::INFINITY, f64::min)
}

/// Returns the heights of a line of sight above the terrain in these steps, with the horizontal distance of each from
/// the eye; NaN where the terrain is not known.
pub(crate) fn heights_above(
    grid: &ElevationGrid,
    cloud: MapBox,
    eye: [f64; 3],
    target: [f64; 3],
    earth: &EarthParams,
) -> Vec<[f64; 2]> {
    let (heights, cell, [west, north]) = (grid.heights(), grid.cell(), grid.north_west());
    let across = [target[0] - eye[0], target[1] - eye[1]];
    let span = across[0].hypot(across[1]);
    let from = [(eye[0] - west) / cell[0], (north - eye[1]) / cell[1]];
    let slope = [across[0] / cell[0], -across[1] / cell[1]];
    // shares of the way at which the line crosses from patch to patch
    let mut shares = vec![0.0, 1.0];
    for axis in 0..2 {
        let [low, high] = [from[axis].min(from[axis] + slope[axis]), from[axis].max(from[axis] + slope[axis])];
        let lines = low.ceil() as usize..=high.floor() as usize;
        shares.extend(lines.map(|i| (i as f64 - from[axis]) / slope[axis]).filter(|v| (0.0..=1.0).contains(v)));
    }
    shares.sort_by(f64::total_cmp);
    let room = cell[0].max(cell[1]);
    let mut found = Vec::new();
    for pair in shares.windows(2) {
        let middle = f64::midpoint(pair[0], pair[1]);
        let [column, row] = [0, 1].map(|axis| (from[axis] + slope[axis] * middle).floor().max(0.0) as usize);
        for part in 0..=32 {
            let share = pair[0] + (pair[1] - pair[0]) * (f64::from(part) / 32.0);
            let place = [eye[0] + across[0] * share, eye[1] + across[1] * share];
            if (0..2).all(|i| cloud.0[i] - room <= place[i] && place[i] <= cloud.1[i] + room) {
                continue;
            }
            let [u, v] = [from[0] + slope[0] * share - column as f64, from[1] + slope[1] * share - row as f64];
            let at = |c: usize, r: usize| heights.get(column + c, row + r).map_or(f64::NAN, f64::from);
            let ground = (1.0 - v) * ((1.0 - u) * at(0, 0) + u * at(1, 0)) + v * ((1.0 - u) * at(0, 1) + u * at(1, 1));
            let line = eye[2] + (target[2] - eye[2]) * share - sag(earth, share * span, span);
            found.push([share * span, line - ground]);
        }
    }
    found
}

/// Compares a viewshed with lines followed step by step for each `step`th node. Returns the numbers of blocked and
/// visible nodes, and of those that differ because terrain rises above the line between two steps only. There it comes
/// within `margin` of the line.
fn compared(scene: &MedialScene, cloud: MapBox, eye: [f64; 3], height: f64, step: usize, margin: f64) -> [usize; 3] {
    let (earth, terrain) = (EarthParams::default(), scene.far_terrain().grid().unwrap());
    let found = seen(scene, &[observer(eye)], height, earth);
    let mut counts = [0; 3];
    for (node, answer) in nodes(scene, &found).step_by(step) {
        let target = [node[0], node[1], node[2] + height];
        let min = clearance(terrain, cloud, eye, target, &earth);
        match answer {
            // steps find nothing that is not there, but for what is rounded over kilometres
            Answer::Visible => assert!(min > -1e-4, "{node:?}: {min}"),
            _ => assert!(min < margin, "{node:?}: {min}"),
        }
        counts[usize::from(answer == Answer::Visible)] += 1;
        counts[2] += usize::from(answer != Answer::Visible && min > 0.0);
    }
    counts
}

#[test]
fn mountains_are_seen_as_lines_followed_step_by_step_see_them() {
    let holes = {
        let mut heights = mountains(200, 60.0, 2000.0).heights().clone();
        (0..4000).for_each(|i| heights.values_mut()[(uniform(3, i) * 40_000.0) as usize] = f32::NAN);
        ElevationGrid::new(heights, [0.0, 0.0], [60.0; 2]).unwrap()
    };
    for (terrain, step) in [(mountains(301, 60.0, 2000.0), 53), (holes, 31)] {
        let (low, high) = terrain.on_map();
        let middle = [0, 1].map(|i| low[i] + (high[i] - low[i]) * 0.4).map(|v| (v / 60.0).round() * 60.0 + 7.0);
        let ground = terrain.height_range(around([middle[0], middle[1], 0.0], 90.0)).unwrap()[1];
        for above in [2.0, 400.0] {
            let eye = [middle[0], middle[1], f64::from(ground) + above];
            let cloud = around(eye, 250.0);
            let counts = compared(&open_scene(terrain.clone(), cloud), cloud, eye, 0.0, step, 0.5);
            assert!(counts[0] > 100 && counts[1] > 20, "{counts:?}");
            assert!(1000 * counts[2] <= counts[0] + counts[1], "{counts:?}");
        }
    }
}

#[test]
fn real_terrain_is_seen_as_lines_followed_step_by_step_see_it() {
    let test = "real_terrain_is_seen_as_lines_followed_step_by_step_see_it";
    let Some(path) = data(test, "data/terrain/Topography.laz") else { return };
    let (cloud, _) = read_cloud([&path], &ReadOptions::default(), &Control::none()).unwrap();
    let bounds = Bounds::around(cloud.positions.iter().copied()).unwrap();
    let (low, high) = bounds.on_map();
    let cells = MapGrid::covering(low, high, 1.0, [0.0; 2]).unwrap();
    let (ground, _) = Ground::of_cloud(&cloud, cells, &GroundParams::default(), &Control::none()).unwrap();
    let terrain = ElevationGrid::new(ground.heights, cells.center(0, 0), [1.0; 2]).unwrap();
    let middle = [0, 1].map(|i| f64::midpoint(low[i], high[i]));
    let ground = terrain.height_range(around([middle[0], middle[1], 0.0], 1.5)).unwrap()[1];
    for (above, height) in [(1.7, 0.0), (15.0, 0.0), (15.0, 1.7)] {
        let eye = [middle[0], middle[1], f64::from(ground) + above];
        let cloud = around(eye, 12.0);
        let counts = compared(&open_scene(terrain.clone(), cloud), cloud, eye, height, 37, 0.01);
        assert!(counts[0] > 100 && counts[1] > 100, "{counts:?}");
        assert!(500 * counts[2] <= counts[0] + counts[1], "{counts:?}");
    }
}

#[test]
fn a_ball_near_the_eye_hides_the_cone_behind_it_and_nothing_counts_twice() {
    // a mast of terrain stands in the cloud, where balls say what stands
    let eye = [5000.0, -5000.0, 40.0];
    let tower = |x: f64, y: f64| if (x, y) == (5200.0, -5000.0) { 900.0 } else { 0.0 };
    let (center, radius) = ([5150.0, -4900.0, 30.0], 25.0);
    let scene = scene(grid(401, 25.0, tower), around(eye, 300.0), center, radius);
    let found = seen(&scene, &[observer(eye)], 0.0, EarthParams::flat());
    let mut counts = [0; 2];
    for (node, answer) in nodes(&scene, &found) {
        let to: [f64; 3] = std::array::from_fn(|i| node[i] - eye[i]);
        let ball: [f64; 3] = std::array::from_fn(|i| center[i] - eye[i]);
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let beside = (dot(ball, ball) - dot(ball, to).powi(2) / dot(to, to)).sqrt();
        let is_hidden = dot(ball, to) > 0.0 && beside < radius;
        if (beside - radius).abs() > 1e-3 {
            assert_eq!(answer == Answer::Blocked, is_hidden, "{node:?} {beside}");
        }
        counts[usize::from(is_hidden)] += 1;
    }
    assert!(counts[1] > 1000 && counts[0] > 50_000, "{counts:?}");
}

#[test]
fn sight_is_mutual_and_what_stands_above_the_horizon_is_seen() {
    let terrain = mountains(301, 60.0, 1500.0);
    let cloud = ([8000.0, -9000.0], [8600.0, -8400.0]);
    let scene = open_scene(terrain.clone(), cloud);
    let earth = EarthParams::default();
    let place = |i: u64| {
        let node = terrain.node((uniform(7, 3 * i) * 300.0) as usize, (uniform(7, 3 * i + 1) * 300.0) as usize);
        node.map(|[x, y, z]| [x, y, z + 2.0 + 300.0 * uniform(7, 3 * i + 2)]).unwrap()
    };
    let pairs = (0..3000).map(|i| [place(2 * i), place(2 * i + 1)]);
    let answers: Vec<Answer> = pairs
        .map(|[a, b]| {
            let answer = scene.far_sight_answer(a, b, &earth);
            assert_eq!(answer, scene.far_sight_answer(b, a, &earth), "{a:?} {b:?}");
            answer
        })
        .collect();
    let visible = answers.iter().filter(|answer| **answer == Answer::Visible).count();
    assert!((300..2700).contains(&visible), "{visible}");
    // the horizon of the eye, at the azimuths of nodes
    let eye = [8300.0, -8700.0, f64::from(terrain.height_range(cloud).unwrap()[1]) + 20.0];
    let found = seen(&scene, &[observer(eye)], 0.0, earth);
    let mut above = 0;
    for (node, answer) in nodes(&scene, &found).step_by(11) {
        let azimuth = (node[0] - eye[0]).atan2(node[1] - eye[1]);
        let span = (node[0] - eye[0]).hypot(node[1] - eye[1]);
        let tangent = (node[2] - eye[2] - (1.0 - earth.refraction) * span * span / (2.0 * earth.radius)) / span;
        let horizon = scene.far_terrain().elevations(eye, [azimuth, TAU], 1, &earth)[0].tan();
        // a straight azimuth passes a node by what is rounded
        let is_horizon = tangent > horizon - 1e-12;
        assert!(!is_horizon || answer == Answer::Visible, "{node:?}");
        above += usize::from(is_horizon);
    }
    assert!(above > 0);
}

#[test]
fn observers_add_up_limits_cut_and_threads_change_nothing() {
    let terrain = mountains(161, 60.0, 1500.0);
    let cloud = ([4500.0, -5100.0], [5100.0, -4500.0]);
    let top = f64::from(terrain.height_range(cloud).unwrap()[1]);
    let scene = open_scene(terrain, cloud);
    let earth = EarthParams::default();
    let east = SightLimits { azimuth: Some([0.5, 2.0]), distance: [500.0, 3000.0], ..SightLimits::default() };
    let observers = [
        observer([4800.0, -4800.0, top + 30.0]),
        Observer { eye: [4600.0, -5000.0, top + 300.0], limits: east },
        observer([f64::NAN; 3]),
    ];
    let all = seen(&scene, &observers, 1.7, earth);
    let each: Vec<Viewshed> = observers.iter().map(|one| seen(&scene, &[*one], 1.7, earth)).collect();
    for (i, (&count, answer)) in all.counts.iter().zip(&all.answers).enumerate() {
        assert_eq!(count, each.iter().map(|one| one.counts[i]).sum::<u32>());
        let best = [Answer::Visible, Answer::Unproven, Answer::Blocked, Answer::OutsideView, Answer::OutsideCloud];
        assert_eq!(Some(answer), best.iter().find(|answer| each.iter().any(|one| one.answers[i] == **answer)));
    }
    let counts: Vec<usize> = each.iter().flat_map(|one| one.seen_counts.clone()).collect();
    assert!(all.seen_counts == counts && counts[1] > 100 && counts[2] == 0, "{counts:?}");
    for (node, answer) in nodes(&scene, &each[1]) {
        assert_eq!(answer != Answer::OutsideView, east.allow(observers[1].eye, [node[0], node[1], node[2] + 1.7]));
    }
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(one.install(|| seen(&scene, &observers, 1.7, earth)), all);
    // what is within reach has the answers of the whole
    let part = terrain_within_reach(scene.far_terrain().grid().unwrap(), &observers[1..]).unwrap();
    assert!((80..=102).contains(&part.heights().width()), "{}", part.heights().width());
    let params = ViewshedParams::default();
    let cut = far_viewshed(&scene, &observers[1..2], &part, 1.7, &params, &Control::none()).unwrap();
    assert_eq!(cut.seen_counts, each[1].seen_counts);
    let near = SightLimits { distance: [0.0, 20.0], ..SightLimits::default() };
    let near = [Observer { eye: [4777.0, -4777.0, 0.0], limits: near }];
    let error = terrain_within_reach(scene.far_terrain().grid().unwrap(), &near).unwrap_err().to_string();
    assert!(error.contains("maximum distance"), "{error}");
}
