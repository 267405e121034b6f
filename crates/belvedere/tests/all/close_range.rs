//! Scanners on the ground in a simulated street, against the exact town.

use crate::common::simulated::cloud_of;
use belvedere::control::Control;
use belvedere::medial::CarvedParams;
use belvedere::model::{BallParams, ModelParams, OrientBy, SceneModel};
use belvedere::pulses::{FoundBy, LocateParams, Means, locate};
use belvedere::query::{Answer, UnprovenAs, Viewer, Visibility};
use belvedere::trajectory::Trajectory;
use belvedere::{Bounds, Error, PointCloud};
use belvedere_scenes::{
    MobileParams, Preset, QuerySet, QuerySite, Scan, Stations, TerrestrialParams, TriangleScene, Truth, scan_mobile,
    scan_terrestrial, town,
};

/// Side of the town, metres.
const EXTENT: f64 = 100.0;
const SEED: u64 = 5;

/// The model of a scan whose stations are known, or whose trajectory is; and the cloud.
fn built(scan: &Scan) -> (PointCloud, SceneModel) {
    let cloud = cloud_of(scan);
    let path = scan.sensor_path.times.iter().copied().zip(scan.sensor_path.positions.iter().copied());
    let orient = if scan.stations.is_empty() {
        OrientBy::Trajectory(Trajectory::from_records(path.collect()).0)
    } else {
        OrientBy::Stations((1..).zip(scan.stations.iter().copied()).collect())
    };
    let carved = BallParams::Carved(CarvedParams::default());
    let params = ModelParams::default().with_orient(orient).with_balls(carved);
    let (model, report) = SceneModel::build(&cloud, &params, &Control::none()).unwrap();
    let pulses = report.pulses.unwrap();
    assert!(pulses.free_segments.used > cloud.len() / 2, "{pulses:?}");
    assert!(pulses.blocked.unwrap().percent < 0.1, "{pulses:?}");
    (cloud, model)
}

/// Shares of what people in streets truly see that is called blocked, and of what they truly do not see that is called
/// visible.
fn errors_in_streets(scene: &TriangleScene, cloud: &PointCloud, model: &SceneModel) -> [f64; 2] {
    let medial = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
    let truth = Truth::new(scene);
    let origin = cloud.frame.origin;
    let absolute = |p: [f32; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) + origin[i]) };
    let Bounds { low, high } = cloud.bounds().unwrap();
    let site = QuerySite { scene, truth: &truth, bounds: [absolute(low), absolute(high)] };
    let people = site.targets(QuerySet::Pedestrians, 800, SEED).positions;
    let people: Vec<[f32; 3]> = people.iter().map(|&p| belvedere::cloud::to_local(p, origin)).collect();
    let (mut wrong, mut count) = ([0, 0], [0, 0]);
    for eye in site.street_observers(20, SEED) {
        let local = std::array::from_fn(|i| eye[i] - origin[i]);
        let answers = medial.visible(Viewer::Eye(local), &people).unwrap();
        for (&place, answer) in people.iter().zip(answers) {
            let is_blocked = truth.occluded(absolute(place), eye);
            count[usize::from(is_blocked)] += 1;
            let error = if is_blocked { Answer::Visible } else { Answer::Blocked };
            wrong[usize::from(is_blocked)] += usize::from(answer == error);
        }
    }
    assert!(count.iter().all(|&count| count > 1000), "{count:?}");
    [0, 1].map(|i| 100.0 * wrong[i] as f64 / count[i] as f64)
}

#[test]
fn streets_scanned_from_a_car_are_seen_as_they_are() {
    let params = Preset::Town.params(EXTENT, SEED);
    let scene = town(&params);
    let runs = params.lanes();
    assert!(runs.len() >= 2);
    // a tenth of the pulses of such a scanner
    let scan = scan_mobile(
        &scene,
        &MobileParams { seed: SEED, runs, line_rate: 50.0, pulses_per_line: 400, ..MobileParams::default() },
    );
    let (cloud, model) = built(&scan);
    let [false_blocked, false_visible] = errors_in_streets(&scene, &cloud, &model);
    assert!(false_blocked < 3.0 && false_visible < 2.0, "{false_blocked} {false_visible}");
}

#[test]
fn stations_of_points_are_found_by_their_ids_and_missing_ones_are_reported() {
    let mut cloud = PointCloud {
        positions: (0..40_u16).map(|i| [f32::from(i % 7), f32::from(i / 7), 0.0]).collect(),
        ..PointCloud::default()
    };
    cloud.frame.origin = [100.0, 200.0, 0.0];
    let stations = [(3, [102.0, 203.0, 1.5]), (8, [95.0, 200.0, 1.6])];
    let found =
        |cloud: &PointCloud| locate(cloud, &Means::Stations(&stations), &LocateParams::default(), &Control::none());
    assert!(matches!(found(&cloud), Err(Error::MissingAttribute { .. })), "points without ids");
    cloud.attributes.point_source_id = Some((0..40).map(|i| [3, 8, 9][i % 3]).collect());
    let (positions, report) = found(&cloud).unwrap();
    assert_eq!(positions[..2], [[2.0, 3.0, 1.5], [-5.0, 0.0, 1.6]]);
    assert!(positions[2].iter().all(|v| v.is_nan()));
    assert_eq!((report.found[&FoundBy::Station], report.known_count()), (27, 27));
    assert!(report.remarks.iter().any(|remark| remark.contains("point source id 9")), "{:?}", report.remarks);
    cloud.attributes.point_source_id = Some(vec![9; 40]);
    assert!(found(&cloud).is_err(), "no point has a station");
}

#[test]
fn streets_scanned_from_tripods_are_seen_as_they_are() {
    let scene = town(&Preset::Town.params(EXTENT, SEED));
    let params = TerrestrialParams { seed: SEED, stations: Stations::Chosen(12), ..TerrestrialParams::default() };
    // a sixteenth of the pulses of such a scanner
    let scan = scan_terrestrial(&scene, &TerrestrialParams { angular_step: 4.0 * params.angular_step, ..params });
    let (cloud, model) = built(&scan);
    let [false_blocked, false_visible] = errors_in_streets(&scene, &cloud, &model);
    assert!(false_blocked < 4.0 && false_visible < 2.0, "{false_blocked} {false_visible}");
}
