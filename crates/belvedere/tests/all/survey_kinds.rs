//! Names, carving and advice for surveys, for clouds whose origin is known.

use crate::common::data;
use crate::common::simulated::cloud_of;
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::model::{ModelParams, SceneModel};
use belvedere::pulses::{LocateParams, Means, locate};
use belvedere::random::uniform;
use belvedere::summary::{CloudSummary, SurveyKind};
use belvedere::trajectory::Trajectory;
use belvedere::{Attributes, PointCloud};
use belvedere_scenes::{
    AirborneParams, MobileParams, Preset, Scan, Stations, TerrestrialParams, scan_airborne, scan_mobile,
    scan_terrestrial, town,
};

fn judged(cloud: &PointCloud, means: &Means<'_>) -> SurveyKind {
    let counted = CloudSummary::of(cloud, &Control::none()).unwrap();
    let (scanner, report) = locate(cloud, means, &LocateParams::default(), &Control::none()).unwrap();
    SurveyKind::of(cloud, &counted, &scanner, &report)
}

/// Fails unless the three parts contain these words, and the model of the cloud is carved as they say.
#[track_caller]
fn assert_kind(cloud: &PointCloud, [kind, carved_by, advice]: [&str; 3]) {
    let found = judged(cloud, &Means::Automatic);
    let says = |text: &str, words: &str| assert!(text.contains(words), "{found} does not say {words:?}");
    says(&found.kind, kind);
    says(&found.carved_by, carved_by);
    says(&found.advice, advice);
    assert!(!found.to_string().contains('\n'));
    let (_, report) = SceneModel::build(cloud, &ModelParams::default(), &Control::none()).unwrap();
    let is_carved = report.pulses.unwrap().remark.is_none();
    assert_eq!(is_carved, found.carved_by.starts_with("carved"), "{found}");
}

#[test]
fn airborne_surveys_are_named_with_and_without_separable_pulses() {
    let params = Preset::Town.params(60.0, 4);
    let scene = town(&params);
    let flown = cloud_of(&scan_airborne(&scene, &AirborneParams::covering(&scene, 8.0)));
    assert_kind(
        &flown,
        ["from the air, 2 flight lines", "known from pulses with several returns", "nothing is missing"],
    );
    let merged = PointCloud {
        attributes: Attributes {
            classification: flown.attributes.classification.clone(),
            return_number: flown.attributes.return_number.clone(),
            return_count: flown.attributes.return_count.clone(),
            ..Attributes::default()
        },
        ..flown.clone()
    };
    assert_kind(&merged, ["from the air without pulses", "assumed to be vertical", "GPS times"]);
    let first = flown.attributes.return_number.as_ref().unwrap().iter().map(|&number| number == 1);
    let rows: Vec<u32> = (0..).zip(first).filter(|&(_, is_first)| is_first).map(|(row, _)| row).collect();
    let mut from_photographs = flown.select(&rows);
    let count = from_photographs.len();
    from_photographs.attributes = Attributes { color: Some(vec![[9, 9, 9]; count]), ..Attributes::default() };
    assert_kind(&from_photographs, ["as from photographs", "assumed to be vertical", "laser survey"]);
}

#[test]
fn scans_from_the_ground_are_named_with_and_without_their_positions() {
    let params = Preset::Town.params(60.0, 4);
    let scene = town(&params);
    let tripods = TerrestrialParams {
        stations: Stations::Chosen(3),
        angular_step: 1_f64.to_radians(),
        ..TerrestrialParams::default()
    };
    let scan = scan_terrestrial(&scene, &tripods);
    let mut cloud = cloud_of(&scan);
    // as most programs export them
    cloud.attributes.gps_time = None;
    assert_kind(&cloud, ["from the ground, 3 scanner positions", "stations found in the data", ""]);
    // a fifth of the points, by chance, shows no grid of pulses
    let rows: Vec<u32> = (0_u32..).take(cloud.len()).filter(|&row| uniform(1, row.into()) < 0.2).collect();
    assert_kind(&cloud.select(&rows), ["scanner on the ground", "", "with poses"]);
    let stations: Vec<(u16, [f64; 3])> = (1..).zip(scan.stations.iter().copied()).collect();
    let given = judged(&cloud, &Means::Stations(&stations));
    assert!(given.kind.contains("from the ground") && given.carved_by.contains("the stations given"), "{given}");
    let index = cloud.attributes.point_source_id.as_ref().unwrap().iter().map(|number| number - 1).collect();
    cloud.attributes.scanner_index = Some(index);
    let origin = cloud.frame.origin;
    cloud.scanner_positions = scan.stations.iter().map(|&p| belvedere::cloud::to_local(p, origin)).collect();
    assert_kind(&cloud, ["from the ground, 3 scanner positions", "poses in the file", "nothing is missing"]);
}

#[test]
fn a_scan_from_a_car_needs_its_trajectory() {
    let params = Preset::Town.params(100.0, 4);
    let scene = town(&params);
    let usual = MobileParams::default();
    let scan: Scan =
        scan_mobile(&scene, &MobileParams { runs: params.lanes(), pulses_per_line: 200, line_rate: 20.0, ..usual });
    let cloud = cloud_of(&scan);
    assert_kind(&cloud, ["scanner on the ground", "", "trajectory of the scanner"]);
    let path = scan.sensor_path.times.iter().copied().zip(scan.sensor_path.positions.iter().copied());
    let trajectory = Trajectory::from_records(path.collect()).0;
    let given = judged(&cloud, &Means::Trajectory(&trajectory));
    assert!(given.kind.starts_with("laser scan from the ground") && given.advice == "nothing is missing", "{given}");
}

#[test]
fn real_clouds_are_named_for_what_they_are() {
    let read = |file: &str| {
        let path = data("real_clouds_are_named_for_what_they_are", &format!("data/{file}"))?;
        Some(read_cloud(&[path], &ReadOptions::default(), &Control::none()).unwrap().0)
    };
    let known = "known from pulses with several returns";
    for (file, words) in [
        ("amsterdam_ahn3/ahn_2386_9702.laz", ["from the air", known, "2 % of the points"]),
        ("bresse_lidarhd/870000_6618000.subset.50mx100m.las", ["from the air", known, "classes of vegetation"]),
        ("tls_e57/pumpAVisualReferenceImage.e57", ["from the ground", "poses", "nothing"]),
        ("autzen/autzen_stadium_340x320m.laz", ["from the air without pulses", "assumed", "GPS times"]),
        ("tudelft_ahn4_small/small.laz", ["from the air without pulses", "assumed", "GPS times"]),
    ] {
        let Some(cloud) = read(file) else { continue };
        assert_kind(&cloud, words);
    }
}
