//! The scene model: what each way of building decides, what is saved, and that every stage can be stopped.

use crate::common::simulated::cloud_of;
use belvedere::control::{Control, StageEnd, Watcher};
use belvedere::io::{read_balls, write_balls};
use belvedere::medial::{CarvedInput, CarvedParams, MedialBalls, ShrinkParams, Side, carved_balls, shrink};
use belvedere::model::{BallParams, BallsReport, BuildReport, ModelParams, OrientBy, SceneModel};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate, estimate_with_scatter};
use belvedere::normals::{Orientation, OrientedCloud, orient};
use belvedere::planes::{self, PlaneParams, SurveyPoints};
use belvedere::pulses::{FreeSegmentColumns, FreeSegmentParams, FreeSegments, LocateParams, Means, group, locate};
use belvedere::query::UnprovenAs;
use belvedere::trajectory::Trajectory;
use belvedere::{Error, Mesh, PointCloud};
use belvedere_scenes::{AirborneParams, Scan, TownParams, TriangleScene, scan_airborne, town};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A small town, flown with few pulses.
fn simulated() -> (TriangleScene, Scan, PointCloud) {
    let scene = town(&TownParams { extent: 60.0, ..TownParams::default() });
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 3.0, ..AirborneParams::default() });
    let cloud = cloud_of(&scan);
    (scene, scan, cloud)
}

fn trajectory(scan: &Scan) -> Trajectory {
    Trajectory { times: scan.sensor_path.times.clone(), positions: scan.sensor_path.positions.clone() }
}

fn built(cloud: &PointCloud, params: &ModelParams) -> (SceneModel, BuildReport) {
    SceneModel::build(cloud, params, &Control::none()).unwrap()
}

#[test]
fn a_model_is_what_the_stages_make_one_after_the_other() {
    let (_, _, cloud) = simulated();
    let none = Control::none();
    let (model, report) = built(&cloud, &ModelParams::default());
    let (kept, _) = belvedere::clean::clean(&cloud, &belvedere::clean::CleanParams::default(), &none).unwrap();
    let clean = cloud.select(&kept);
    let (scanner, _) = locate(&clean, &Means::Automatic, &LocateParams::default(), &none).unwrap();
    let (free_segments, _) = FreeSegments::of_cloud(&clean, &scanner, &FreeSegmentParams::default(), &none).unwrap();
    let index = NeighborIndex::new(&clean.positions, &none).unwrap();
    let (normals, scatter) = estimate_with_scatter(&clean.positions, &index, Neighborhood::default(), &none).unwrap();
    let (oriented, _) = orient(&clean, normals, &Orientation::Pulses(&scanner), &none).unwrap();
    let (smoothed, moved) = scatter.smoothed(oriented.positions());
    assert_eq!(report.smoothing.map(|found| found.moved), Some(moved));
    let index = index.moved_to(&smoothed).unwrap();
    let [quality, confidence] = [oriented.quality(), oriented.confidence()].map(<[f32]>::to_vec);
    let oriented = OrientedCloud::new(smoothed, oriented.normals().to_vec(), quality, confidence)
        .unwrap()
        .with_place(oriented.origin(), oriented.crs().clone());
    let (pulses, _) = group(&clean, &none).unwrap();
    let attributes = &clean.attributes;
    let input = CarvedInput {
        oriented: &oriented,
        measured: &clean.positions,
        index: &index,
        attributes,
        free_segments: &free_segments,
        pulses: Some(&pulses),
        statistics: None,
    };
    let mut balls = carved_balls(&input, &CarvedParams::default(), &none).unwrap().balls;
    let points =
        SurveyPoints { positions: &clean.positions, scanner: &scanner, attributes, origin: clean.frame.origin };
    let surfaces = planes::find(&points, &PlaneParams::default(), &none).unwrap();
    let capped = planes::cap(&mut balls, &clean.positions, &surfaces.regions, &none).unwrap();
    assert!(capped > 100 && report.surfaces.is_some_and(|found| found.balls_capped == capped), "{capped}");
    let balls = balls.shrunk();
    // two sheets close a slab instead of balls
    let is_left = |row: &usize| !surfaces.slab_rows.contains(&balls.source[*row]);
    let balls = balls.select(&(0..balls.len()).filter(is_left).collect::<Vec<_>>());
    // a model puts points into the order of space first: its rows are others, its balls and pulses the same
    let sources: Vec<u32> = balls.source.iter().map(|&row| kept[row as usize]).collect();
    assert!(sorted(model.balls(), &model.balls().source) == sorted(&balls, &sources));
    assert!(!model.patches().is_empty() && *model.patches() == surfaces.patches);
    let mut columns = free_segments.to_columns();
    columns.append(
        free_segments.between_returns(&clean, &pulses, &FreeSegmentParams::default(), &none).unwrap().to_columns(),
    );
    let starts = |columns: &FreeSegmentColumns| {
        let mut starts: Vec<_> = columns.starts.iter().map(|start| start.map(f32::to_bits)).collect();
        starts.sort_unstable();
        starts
    };
    assert!(starts(model.pulses().unwrap()) == starts(&columns));
    assert!(matches!(report.interior_balls, Some(BallsReport::Carved(_))));
    let normals = model.normals().unwrap();
    assert!(normals.len() == cloud.len() && normals[kept[7] as usize] == oriented.normals()[7]);
    // letting go of the cloud changes nothing else
    let (owned, _) = SceneModel::build_owned(cloud.clone(), &ModelParams::default(), &none).unwrap();
    assert!(owned.parts() == model.parts() || has_nan_only_differences(&owned, &model));
    assert!(owned.normals().is_none());
}

/// The bits of the balls of the rows of a cloud, in an order of their own.
fn sorted(balls: &MedialBalls, sources: &[u32]) -> Vec<([u32; 3], u32, u32)> {
    let row = |i: usize| (balls.centers[i].map(f32::to_bits), balls.radii[i].to_bits(), sources[i]);
    let mut rows: Vec<_> = (0..balls.len()).map(row).collect();
    rows.sort_unstable();
    rows
}

/// Returns true if two models are the same except for values that are not equal to themselves.
fn has_nan_only_differences(a: &SceneModel, b: &SceneModel) -> bool {
    let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    a.balls().centers == b.balls().centers
        && a.balls().source == b.balls().source
        && a.balls().touch == b.balls().touch
        && bits(&a.balls().separation_angles) == bits(&b.balls().separation_angles)
        && bits(a.transmission()) == bits(b.transmission())
        && a.pulses() == b.pulses()
        && a.parts().provenance == b.parts().provenance
}

#[test]
fn each_way_of_orienting_decides_what_it_is_meant_to() {
    let (scene, scan, cloud) = simulated();
    let flight = trajectory(&scan);
    let (positions, _) = flight.scanner_positions(&cloud).unwrap();
    let mesh = Mesh { vertices: scene.vertices.clone(), triangles: scene.triangles.clone(), ..Mesh::default() };
    let shrunk = BallParams::Shrunk(ShrinkParams::tau());
    let carved = BallParams::Carved(CarvedParams::default());
    let above = [0, 1, 2].map(|i| cloud.frame.origin[i] + if i == 2 { 900.0 } else { 0.0 });
    let by = |orient: OrientBy, balls: BallParams| {
        let (model, report) = built(&cloud, &ModelParams::default().with_orient(orient).with_balls(balls));
        let way = report.normals.oriented_by;
        (way.split(' ').next().unwrap(), report.scanner.is_some(), model.pulses().is_some())
    };
    // the way, whether the scanner was looked for, and whether pulses are kept
    assert_eq!(by(OrientBy::Auto, BallParams::default()), ("pulses", true, true));
    assert_eq!(by(OrientBy::Auto, shrunk), ("up", false, false));
    assert_eq!(by(OrientBy::Up, carved), ("up", true, true));
    assert_eq!(by(OrientBy::Pulses, shrunk), ("pulses", true, false));
    assert_eq!(by(OrientBy::Trajectory(flight.clone()), carved), ("pulses", true, true));
    assert_eq!(by(OrientBy::Trajectory(flight), shrunk), ("trajectory", false, false));
    assert_eq!(by(OrientBy::ScannerAt(above), shrunk), ("scanner", false, false));
    assert_eq!(by(OrientBy::ScannerAt(above), carved), ("scanner", true, true));
    assert_eq!(by(OrientBy::ScannerOfEachPoint(positions.clone()), carved), ("pulses", true, true));
    assert_eq!(by(OrientBy::ScannerOfEachPoint(positions), shrunk), ("pulses", true, false));
    assert_eq!(by(OrientBy::Mesh(mesh), shrunk), ("mesh", false, false));
    // what the cloud lacks is an error, and scanner positions for other points are
    let refused = |orient| {
        let params = ModelParams::default().with_orient(orient).with_balls(shrunk);
        SceneModel::build(&cloud, &params, &Control::none()).unwrap_err()
    };
    assert!(matches!(refused(OrientBy::Given), Error::MissingAttribute { .. }));
    assert!(matches!(refused(OrientBy::Scanner), Error::MissingAttribute { .. }));
    assert!(matches!(refused(OrientBy::ScannerOfEachPoint(vec![[0.0; 3]])), Error::LengthMismatch { .. }));
}

#[test]
fn normals_and_scanner_positions_of_the_cloud_come_before_up() {
    let (_, scan, mut cloud) = simulated();
    let shrunk = ModelParams::default().with_balls(BallParams::Shrunk(ShrinkParams::tau()));
    let (up, _) = built(&cloud, &shrunk);
    cloud.scanner_positions = vec![[0.0, 0.0, 800.0]];
    assert_eq!(built(&cloud, &shrunk).1.normals.oriented_by, "scanner position");
    cloud.attributes.normals = Some(up.normals().unwrap().to_vec());
    let (given, report) = built(&cloud, &shrunk);
    assert_eq!(report.normals.oriented_by, "normals of the file");
    assert_eq!(given.balls().radii, up.balls().radii);
    assert_eq!(scan.len(), cloud.len());
}

#[test]
fn pulses_that_cannot_carve_give_way_to_the_points_alone_and_say_so() {
    let (_, _, cloud) = simulated();
    // without times no scanner is found, and below a second layer nothing is hit by what falls straight down
    let mut covered = PointCloud { positions: cloud.positions.clone(), ..Default::default() };
    covered.positions.extend(cloud.positions.iter().map(|&[x, y, z]| [x, y, z + 30.0]));
    let cloud = covered;
    let params = ModelParams::default();
    let (model, report) = built(&cloud, &params);
    assert!(matches!(report.interior_balls, Some(BallsReport::Shrunk(_))) && model.pulses().is_none());
    assert!(report.pulses.unwrap().remark.unwrap().contains("only assumed"));
    assert_eq!(model.parts().provenance["method"], "tau");
    let (index, none) = (NeighborIndex::new(&cloud.positions, &Control::none()).unwrap(), Control::none());
    let normals = estimate(&cloud.positions, &index, Neighborhood::default(), &none).unwrap();
    let (oriented, _) = orient(&cloud, normals, &Orientation::Up, &none).unwrap();
    let (balls, _) = shrink(&oriented, &index, Side::Interior, &ShrinkParams::tau(), &none).unwrap();
    assert!(model.balls().len().abs_diff(balls.shrunk().len()) < cloud.len() / 100);
}

#[test]
fn crowns_that_cannot_be_measured_are_reported_with_the_reason() {
    let (_, scan, mut cloud) = simulated();
    let positions = trajectory(&scan).scanner_positions(&cloud).unwrap().0;
    let params = ModelParams::default().with_orient(OrientBy::ScannerOfEachPoint(positions));
    let (_, report) = built(&cloud, &params);
    assert_eq!(report.pulses.unwrap().crowns_not_measured, None);
    cloud.attributes.gps_time = None;
    let (model, report) = built(&cloud, &params);
    let json = serde_json::to_value(&report).unwrap();
    assert!(json["pulses"]["crowns_not_measured"].as_str().unwrap().contains("GPS time"), "{json}");
    // which balls are vegetation is known all the same
    assert!(model.is_carved() && model.transmission().iter().all(|share| share.is_nan() || *share == 0.0));
}

#[test]
fn a_saved_model_answers_as_the_one_it_was_saved_from() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.npz");
    let (_, _, cloud) = simulated();
    let (model, _) = built(&cloud, &ModelParams::default());
    let model = model.with_provenance("input", "a test");
    write_balls(&path, model.parts()).unwrap();
    let read = SceneModel::from_parts(read_balls(&path).unwrap()).unwrap();
    assert!(has_nan_only_differences(&read, &model) && read.parts().bounds == model.parts().bounds);
    assert_eq!(read.vegetation(), model.vegetation());
    let answers = |model: &SceneModel| {
        let scene = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
        let sun = belvedere::view::to_sun(3.9, 0.5);
        cloud
            .positions
            .iter()
            .step_by(50)
            .map(|p| scene.answer(p.map(f64::from), sun, f64::INFINITY))
            .collect::<Vec<_>>()
    };
    assert_eq!(answers(&model), answers(&read));
    let exterior = model.into_parts().with_provenance("side", "exterior");
    assert!(matches!(SceneModel::from_parts(exterior), Err(Error::InvalidParameter { .. })));
}

#[test]
fn reports_use_keys_with_units_and_rounded_numbers() {
    let (_, _, cloud) = simulated();
    let report = serde_json::to_value(built(&cloud, &ModelParams::default()).1).unwrap();
    let mut sections: Vec<&String> = report.as_object().unwrap().keys().collect();
    sections.sort();
    let expected = ["interior_balls", "normals", "pulses", "removed_by_cleaning", "scanner", "smoothing", "surfaces"];
    assert_eq!(sections, expected);
    let known = report["scanner"]["scanner_known_percent"].as_f64().unwrap();
    assert!(known > 99.0 && (known * 100.0).fract().abs() < 1e-6, "{known}");
    for (section, key) in [
        ("removed_by_cleaning", "points_kept"),
        ("pulses", "pulses_used"),
        ("normals", "towards_scanner_percent"),
        ("interior_balls", "balls_cut_by_pulses"),
        ("interior_balls", "points_on_thin_objects"),
        ("surfaces", "balls_capped"),
    ] {
        assert!(report[section][key].is_number(), "{section} {key}: {report}");
    }
}

/// Stops the work after so many checks for cancellation.
struct StopAfterChecks {
    checks: AtomicUsize,
    patience: usize,
    begun: Mutex<Vec<&'static str>>,
    ended: Mutex<Vec<(&'static str, usize)>>,
    total: AtomicUsize,
    done: AtomicUsize,
}

impl StopAfterChecks {
    fn new(patience: usize) -> Self {
        Self {
            checks: AtomicUsize::new(0),
            patience,
            begun: Mutex::default(),
            ended: Mutex::default(),
            total: AtomicUsize::new(0),
            done: AtomicUsize::new(0),
        }
    }
}

impl Watcher for StopAfterChecks {
    fn begin(&self, stage: &'static str, total: usize) {
        self.total.store(total, Ordering::Relaxed);
        self.done.store(0, Ordering::Relaxed);
        self.begun.lock().unwrap().push(stage);
    }
    fn advance(&self, count: usize) {
        self.done.fetch_add(count, Ordering::Relaxed);
    }
    fn end(&self, stage: &'static str, end: StageEnd) {
        let (total, done) = (self.total.load(Ordering::Relaxed), self.done.load(Ordering::Relaxed));
        assert!(total == 0 || done <= total, "{stage}: {done} of {total}");
        assert!(
            end == StageEnd::Finished || self.checks.load(Ordering::Relaxed) >= self.patience,
            "{stage} was stopped by nobody"
        );
        self.ended.lock().unwrap().push((stage, done));
    }
    fn is_cancelled(&self) -> bool {
        self.checks.fetch_add(1, Ordering::Relaxed) >= self.patience
    }
}

#[test]
fn building_can_be_stopped_at_every_stage_and_asks_often() {
    let (_, _, cloud) = simulated();
    let patient = StopAfterChecks::new(usize::MAX);
    SceneModel::build(&cloud, &ModelParams::default(), &Control::new(&patient)).unwrap();
    let stages = patient.begun.lock().unwrap().clone();
    let checks = patient.checks.load(Ordering::Relaxed);
    assert!(stages.len() >= 15, "{stages:?}");
    // 1 look for every 10 points at least, all stages together
    assert!(checks > cloud.len() / 10, "{checks} looks for {} points", cloud.len());
    let counted = ["estimating normals", "shrinking balls", "carving balls"];
    for (stage, done) in patient.ended.lock().unwrap().iter().filter(|(stage, _)| counted.contains(stage)) {
        assert!(*done > cloud.len() * 9 / 10, "{stage} counted {done} of {}", cloud.len());
    }
    let mut last = 0;
    for share in 0..20 {
        let impatient = StopAfterChecks::new(checks * share / 20);
        let stopped = SceneModel::build(&cloud, &ModelParams::default(), &Control::new(&impatient));
        assert!(matches!(stopped, Err(Error::Cancelled)), "after {share} of 20 looks");
        let begun = impatient.begun.lock().unwrap().len();
        assert!(begun >= last.min(begun) && begun <= stages.len());
        assert_eq!(begun, impatient.ended.lock().unwrap().len(), "stages that begin also end");
        last = begun;
        // once it is known that the work is to stop, no piece is begun: only those under way look again
        let after = impatient.checks.load(Ordering::Relaxed) - impatient.patience;
        assert!(after < 1000, "{after} more looks after the one that said stop, {share} of 20");
    }
}
