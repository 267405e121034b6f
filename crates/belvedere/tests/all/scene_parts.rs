//! Parts of a survey that are built on their own, with what is known of the whole, have the balls of the whole.

use crate::common::simulated::cloud_of;
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::model::{ModelParams, SceneModel, SurveyExtremes, SurveyStatistics};
use belvedere::{Frame, PointCloud};
use belvedere_scenes::{AirborneParams, TownParams, scan_airborne, town};
use std::path::Path;
use std::sync::Arc;

/// Blocks that pruning and thin surfaces work in, metres.
const BLOCK: f32 = 64.0;

/// A flown town of `extent` metres in a frame whose origin is a corner of blocks.
fn survey(extent: f64) -> PointCloud {
    let scene = town(&TownParams { extent, seed: 5, ..TownParams::default() });
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 1.0, ..AirborneParams::default() });
    let cloud = cloud_of(&scan);
    let origin = [0, 1, 2].map(|axis| (cloud.frame.origin[axis] / 1024.0).floor() * 1024.0);
    let positions = (0..scan.len()).map(|i| to_local([scan.x[i], scan.y[i], scan.z[i]], origin)).collect();
    PointCloud { frame: Frame { origin, ..cloud.frame.clone() }, positions, ..cloud }
}

fn statistics(cloud: &PointCloud) -> SurveyStatistics {
    let bounds = cloud.bounds().unwrap();
    let has = |classes: std::ops::RangeInclusive<u8>| {
        cloud.attributes.classification.iter().flatten().any(|class| classes.contains(class))
    };
    let extremes = SurveyExtremes {
        top: bounds.high[2],
        relief: f64::from(bounds.high[2] - bounds.low[2]),
        has_ground: has(2..=2),
        has_vegetation: has(3..=5),
    };
    SurveyStatistics::estimate(Path::new("scene"), cloud, cloud, &extremes, &ModelParams::default(), &Control::none())
        .unwrap()
}

fn model_of(cloud: &PointCloud, params: &ModelParams) -> SceneModel {
    SceneModel::build(cloud, params, &Control::none()).unwrap().0
}

/// Centres and radii of the balls of points in the rectangle, as bits, sorted.
fn balls_in(model: &SceneModel, cloud: &PointCloud, low: [f32; 2], high: [f32; 2]) -> Vec<[u32; 4]> {
    let balls = model.balls();
    let is_in = |row: &usize| {
        let p = cloud.positions[balls.source[*row] as usize];
        (0..2).all(|axis| low[axis] <= p[axis] && p[axis] < high[axis])
    };
    let bits = |row: usize| {
        let [x, y, z] = balls.centers[row];
        [x, y, z, balls.radii[row]].map(f32::to_bits)
    };
    let mut found: Vec<[u32; 4]> = (0..balls.len()).filter(is_in).map(bits).collect();
    found.sort_unstable();
    found
}

/// The triangles of surfaces whose middles lie in the rectangle, as bits, sorted.
fn triangles_in(model: &SceneModel, low: [f32; 2], high: [f32; 2]) -> Vec<[[u32; 3]; 3]> {
    let is_in = |triangle: &&[[f32; 3]; 3]| {
        (0..2).all(|axis| {
            let middle = triangle.iter().map(|corner| corner[axis]).sum::<f32>() / 3.0;
            low[axis] <= middle && middle < high[axis]
        })
    };
    let triangles = model.patches().triangles.iter().filter(is_in);
    let mut found: Vec<_> = triangles.map(|corners| corners.map(|corner| corner.map(f32::to_bits))).collect();
    found.sort_unstable();
    found
}

fn check(cloud: &PointCloud) {
    let statistics = statistics(cloud);
    // through text and back, as parts elsewhere get them
    let text = serde_json::to_string(&statistics).unwrap();
    let statistics: SurveyStatistics = serde_json::from_str(&text).unwrap();
    let params = ModelParams::default();
    let buffer = statistics.buffer(&params) as f32;
    // ground that is found without classes reaches 112 m further
    assert!((40.0..200.0).contains(&buffer), "{buffer}");
    let params = params.with_statistics(Some(Arc::new(statistics)));
    let whole = model_of(cloud, &params);
    let bounds = cloud.bounds().unwrap();
    let corner = |share: f32| [0, 1].map(|axis| bounds.low[axis] + share * (bounds.high[axis] - bounds.low[axis]));
    let mut parts = 0;
    for (low, size) in [(corner(0.0), 50.0), (corner(0.37), 64.0), (corner(0.55), 33.0)] {
        let high = low.map(|v| v + size);
        let from = low.map(|v| (v / BLOCK).floor() * BLOCK - buffer);
        let to = high.map(|v| (v / BLOCK).ceil() * BLOCK + buffer);
        let is_near = |p: &[f32; 3]| (0..2).all(|axis| from[axis] <= p[axis] && p[axis] <= to[axis]);
        let rows: Vec<u32> = (0..).zip(&cloud.positions).filter(|(_, p)| is_near(p)).map(|(row, _)| row).collect();
        parts += usize::from(rows.len() < cloud.len());
        let own = cloud.select(&rows);
        let part = model_of(&own, &params);
        assert!(triangles_in(&part, low, high) == triangles_in(&whole, low, high), "triangles of surfaces differ");
        let part = balls_in(&part, &own, low, high);
        let whole = balls_in(&whole, cloud, low, high);
        assert!(whole.len() > 500, "{}", whole.len());
        let different = whole.iter().filter(|ball| part.binary_search(ball).is_err()).count();
        assert!(whole == part, "{different} of {} balls differ, {} in the part", whole.len(), part.len());
    }
    // where a part reaches far, those in the middle are all of the survey
    assert!(parts > 0);
}

#[test]
fn a_part_of_a_survey_has_the_balls_and_surfaces_of_the_whole() {
    let cloud = survey(240.0);
    check(&cloud);
    let model = model_of(&cloud, &ModelParams::default());
    assert!(model.patches().len() > 500, "{}", model.patches().len());
}

#[test]
fn a_part_of_a_survey_without_classes_and_pulses_has_the_balls_of_the_whole() {
    let mut cloud = survey(240.0);
    cloud.attributes.classification = None;
    cloud.attributes.gps_time = None;
    check(&cloud);
}

#[test]
fn a_whole_that_is_built_as_its_own_part_is_nearly_what_it_is_without_statistics() {
    let cloud = survey(130.0);
    let with = ModelParams::default().with_statistics(Some(Arc::new(statistics(&cloud))));
    let far = [[-1e6; 2], [1e6; 2]];
    // positions on a path from the statistics are rounded differently from those that are estimated with the path
    let in_millimetres = |params: &ModelParams| {
        let balls = balls_in(&model_of(&cloud, params), &cloud, far[0], far[1]).into_iter();
        let mut balls: Vec<_> =
            balls.map(|ball| ball.map(|bits| (1e3 * f32::from_bits(bits)).round() as i32)).collect();
        balls.sort_unstable();
        balls
    };
    let (part, whole) = (in_millimetres(&with), in_millimetres(&ModelParams::default()));
    let same = whole.iter().filter(|ball| part.binary_search(ball).is_ok()).count();
    // blocks end surfaces and are those of points as measured
    assert!(same > whole.len() * 99 / 100, "{same} of {}", whole.len());
}
