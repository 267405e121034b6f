//! The order of the points in a file says nothing: balls and answers stay the same, bit by bit, also where neighbours
//! are equally near.

use crate::common::simulated::cloud_of;
use belvedere::PointCloud;
use belvedere::apps::roof_planes::{RoofPlaneParams, roof_planes};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, GroundPoints, MapGrid, SurfaceParams, top_surface};
use belvedere::model::{ModelParams, SceneModel};
use belvedere::query::{Answer, UnprovenAs, Viewer, Visibility};
use belvedere::random::uniform;
use belvedere::view::to_sun;
use belvedere_scenes::{PointOrder, Preset, QuerySet, QuerySite, Regime, TriangleScene, Truth};
use std::collections::HashMap;

/// Bits of position and time of a point: the same in any order of the points.
type PointKey = ([u32; 3], u64);

fn key(cloud: &PointCloud, row: usize) -> PointKey {
    (cloud.positions[row].map(f32::to_bits), cloud.attributes.gps_time.as_ref().unwrap()[row].to_bits())
}

/// The balls by the point that each was made of, as side and bits of centre and radius, and the answers at `targets`.
fn balls_and_answers(cloud: &PointCloud, targets: &[[f32; 3]]) -> (HashMap<PointKey, Vec<[u32; 4]>>, Vec<Answer>) {
    let (model, _) = SceneModel::build(cloud, &ModelParams::default(), &Control::none()).unwrap();
    let balls = model.balls();
    let mut by_point: HashMap<PointKey, Vec<[u32; 4]>> = HashMap::new();
    for (i, &source) in balls.source.iter().enumerate() {
        let [x, y, z] = balls.centers[i];
        by_point.entry(key(cloud, source as usize)).or_default().push([x, y, z, balls.radii[i]].map(f32::to_bits));
    }
    by_point.values_mut().for_each(|balls| balls.sort_unstable());
    let medial = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
    let sun = to_sun(235_f64.to_radians(), 30_f64.to_radians());
    (by_point, medial.visible(Viewer::Direction(sun), targets).unwrap())
}

fn pedestrians(scene: &TriangleScene, cloud: &PointCloud) -> Vec<[f32; 3]> {
    let truth = Truth::new(scene);
    let (low, high) = scene.bounds().unwrap();
    let site = QuerySite { scene, truth: &truth, bounds: [low, high] };
    let targets = site.targets(QuerySet::Pedestrians, 3000, 1).positions;
    targets.iter().map(|&p| belvedere::cloud::to_local(p, cloud.frame.origin)).collect()
}

#[test]
fn balls_and_answers_do_not_depend_on_the_order_of_the_points() {
    let params = Preset::Town.params(80.0, 6);
    let scene = Regime::Air.scene(&params);
    let scan = Regime::Air.scan(&scene, &params, 6.0);
    let flown = cloud_of(&scan);
    let targets = pedestrians(&scene, &flown);
    let (balls, answers) = balls_and_answers(&flown, &targets);
    assert!(balls.len() > 20_000 && answers.contains(&Answer::Blocked) && answers.contains(&Answer::Visible));
    for order in [PointOrder::Shuffled, PointOrder::Squares] {
        let cloud = cloud_of(&scan.clone().in_order(order, 1));
        assert_ne!(cloud.positions, flown.positions);
        let (other_balls, other_answers) = balls_and_answers(&cloud, &targets);
        assert!(other_balls == balls, "{}: balls differ", order.name());
        assert_eq!(other_answers, answers, "{}", order.name());
    }
}

/// A cloud on a grid, where most neighbours are equally near, with points that repeat others in another class.
fn on_a_grid(cloud: &PointCloud) -> PointCloud {
    let mut rows: Vec<u32> = (0..cloud.len() as u32).collect();
    rows.extend((0..cloud.len() as u32).step_by(50));
    let mut gridded = cloud.select(&rows);
    let steps = [0.25, 0.25, 0.1];
    for p in &mut gridded.positions {
        *p = std::array::from_fn(|i| (p[i] / steps[i]).round() * steps[i]);
    }
    let class = |p: &[f32; 3]| if f64::from(p[2]) + cloud.frame.origin[2] < 0.3 { 2 } else { 6 };
    let mut classes: Vec<u8> = gridded.positions.iter().map(class).collect();
    classes[cloud.len()..].fill(1);
    gridded.attributes.classification = Some(classes);
    gridded
}

/// Bits of all that a scene of a cloud, its ground, its top surface and its roofs are.
fn bits_of_scene(cloud: &PointCloud) -> [Vec<u32>; 4] {
    let control = Control::none();
    let (model, _) = SceneModel::build(cloud, &ModelParams::default(), &control).unwrap();
    let balls = model.balls();
    let rows = balls.source.iter().flat_map(|&row| cloud.positions[row as usize]);
    let balls = balls.centers.as_flattened().iter().chain(&balls.radii).copied().chain(rows);
    let patches = model.parts().patches.triangles.as_flattened().as_flattened().to_vec();
    let bounds = cloud.bounds().unwrap();
    let (low, high) = bounds.on_map();
    let grid = MapGrid::covering(low, high, 0.4, [0.0; 2]).unwrap();
    let (ground, _) = Ground::of_cloud(cloud, grid, &GroundParams::default(), &control).unwrap();
    let (found, _) = Ground::of_cloud(cloud, grid, &of_all_points(), &control).unwrap();
    let surface = top_surface(&cloud.positions, &ground, &SurfaceParams::default(), &control).unwrap();
    let high: Vec<[f32; 3]> =
        cloud.positions.iter().copied().filter(|p| f64::from(p[2]) + cloud.frame.origin[2] > 2.5).collect();
    let roofs = roof_planes(&high, &RoofPlaneParams::default(), &control).unwrap();
    let roofs = roofs.iter().flat_map(|plane| plane.normal.into_iter().chain(plane.middle).chain([plane.area]));
    let heights = ground.heights.values().iter().chain(found.heights.values()).chain(surface.values()).copied();
    let roofs: Vec<u32> = roofs.flat_map(|v| [v.to_bits() as u32, (v.to_bits() >> 32) as u32]).collect();
    let bits = |values: Vec<f32>| values.into_iter().map(f32::to_bits).collect::<Vec<u32>>();
    [bits(balls.collect()), bits(patches), bits(heights.collect()), roofs]
}

fn of_all_points() -> GroundParams {
    GroundParams { points: GroundPoints::Found, ..GroundParams::default() }
}

#[test]
fn points_on_a_grid_give_the_same_bits_in_any_order() {
    let params = Preset::Town.params(60.0, 3);
    let scene = Regime::Air.scene(&params);
    let cloud = on_a_grid(&cloud_of(&Regime::Air.scan(&scene, &params, 8.0)));
    let expected = bits_of_scene(&cloud);
    assert!(expected.iter().all(|bits| bits.len() > 30), "{:?}", expected.each_ref().map(Vec::len));
    for seed in 0..3_u64 {
        let mut rows: Vec<u32> = (0..cloud.len() as u32).collect();
        match seed {
            0 => rows.reverse(),
            seed => rows.sort_by_key(|&row| (uniform(seed, u64::from(row)) * 1e9) as u64),
        }
        let found = bits_of_scene(&cloud.select(&rows));
        for (what, (found, expected)) in
            ["balls", "patches", "heights", "roofs"].iter().zip(found.iter().zip(&expected))
        {
            let differing = found.iter().zip(expected).filter(|(a, b)| a != b).count();
            assert!(found.len() == expected.len() && differing == 0, "{seed}: {differing} numbers of {what} differ");
        }
    }
}
