//! The order of the points in a file says nothing: balls and answers stay the same, but where two neighbours are
//! equally near.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common::simulated::cloud_of;
use belvedere::PointCloud;
use belvedere::control::Control;
use belvedere::model::{ModelParams, SceneModel};
use belvedere::query::{Answer, UnprovenAs, Viewer, Visibility};
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
        let different = balls.iter().filter(|(point, balls)| other_balls.get(*point) != Some(*balls)).count();
        let share = different as f64 / balls.len() as f64;
        println!("{}: {share:.5} of {} balls differ", order.name(), balls.len());
        let changed = answers.iter().zip(&other_answers).filter(|(a, b)| a != b).count();
        println!("{}: {changed} of {} answers differ", order.name(), answers.len());
        // measured: none; neighbours of this cloud that are equally near are rarer than one in a thousand
        assert!(share < 0.001, "{}: {share}", order.name());
        assert!(changed < 3, "{}: {changed}", order.name());
    }
}
