//! Reliability of answers on a survey: pulses kept out, against the same figures counted line by line.

use crate::common::simulated::cloud_of;
use belvedere::apps::ask::{calibrate, with_reliability};
use belvedere::apps::survey_reliability::{ReliabilityParams, survey_reliability};
use belvedere::control::Control;
use belvedere::model::{BallParams, ModelParams, OrientBy, SceneModel};
use belvedere::pulses::{LocateParams, Means, group, locate};
use belvedere::query::{Answer, UnprovenAs};
use belvedere::random::uniform;
use belvedere::trajectory::Trajectory;
use belvedere::vector::{length, sub, unit};
use belvedere::{Error, PointCloud};
use belvedere_scenes::{AirborneParams, TownParams, scan_airborne, town};
use std::collections::BTreeSet;

/// A small town, scanned from the air, and how its scene is made.
fn survey() -> (PointCloud, ModelParams) {
    let scene = town(&TownParams { extent: 60.0, ..TownParams::default() });
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 4.0, ..AirborneParams::default() });
    let path = &scan.sensor_path;
    let records = path.times.iter().copied().zip(path.positions.iter().copied()).collect();
    let (trajectory, _) = Trajectory::from_records(records);
    (cloud_of(&scan), ModelParams::default().with_orient(OrientBy::Trajectory(trajectory)))
}

/// A line of sight of which the truth is known, from a pulse kept out.
struct KnownLine {
    target: [f64; 3],
    towards: [f64; 3],
    range: f64,
    is_free: bool,
}

/// The lines of the pulses kept out, and the cloud without these.
fn lines(cloud: &PointCloud, model: &ModelParams, params: &ReliabilityParams) -> (PointCloud, Vec<KnownLine>) {
    let control = Control::none();
    let (kept, _) = belvedere::clean::clean(cloud, &model.clean, &control).unwrap();
    let cloud = cloud.select(&kept);
    let OrientBy::Trajectory(trajectory) = &model.orient else { panic!("no trajectory") };
    let (scanner, _) = locate(&cloud, &Means::Trajectory(trajectory), &LocateParams::default(), &control).unwrap();
    let (pulses, _) = group(&cloud, &control).unwrap();
    let classes = cloud.attributes.classification.as_ref().unwrap();
    let (mut lines, mut rows): (Vec<KnownLine>, BTreeSet<u32>) = (Vec::new(), (0..cloud.len() as u32).collect());
    for pulse in 0..pulses.len() {
        let returns = pulses.returns_of(pulse);
        if uniform(params.seed, pulse as u64) >= params.share {
            continue;
        }
        for row in returns {
            rows.remove(row);
        }
        let place = |row: u32| cloud.positions[row as usize].map(f64::from);
        let eye = scanner[returns[0] as usize].map(f64::from);
        let rounded = |from: [f64; 3], by: f64| {
            let towards = unit(sub(eye, from)).unwrap();
            std::array::from_fn(|i| f64::from((from[i] + by * towards[i]) as f32))
        };
        let line = |target: [f64; 3], eye: [f64; 3], is_free| {
            let sight = sub(eye, target);
            KnownLine { target, towards: unit(sight).unwrap(), range: length(sight), is_free }
        };
        if let Some(first) = pulses.first_return(pulse) {
            lines.push(line(rounded(place(first), 0.3), rounded(place(first), 30.0), true));
        }
        if let Some(last) = pulses.last_return(pulse).filter(|&row| matches!(classes[row as usize], 2 | 6 | 9)) {
            lines.push(line(rounded(place(last), -1.0), eye, false));
        }
    }
    (cloud.select(&rows.into_iter().collect::<Vec<_>>()), lines)
}

#[test]
fn figures_are_those_counted_line_by_line() {
    let (cloud, model) = survey();
    let params = ReliabilityParams { share: 0.2, seed: 3 };
    let found = survey_reliability(&cloud, &model, &params, &Control::none()).unwrap();
    let (kept, lines) = lines(&cloud, &model, &params);
    let (built, _) = SceneModel::build(&kept, &model, &Control::none()).unwrap();
    let scene = built.scene(&built.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
    let is_known = |line: &&KnownLine| !scene.is_outside_cloud(line.target);
    let known: Vec<&KnownLine> = lines.iter().filter(is_known).collect();
    for (places, is_free) in [(&found.free_paths, true), (&found.hidden_places, false)] {
        let answer = |line: &&KnownLine| scene.answer(line.target, line.towards, line.range);
        let of_kind = known.iter().filter(|line| line.is_free == is_free).copied();
        let answers: Vec<Answer> = of_kind.map(|line| answer(&line)).collect();
        let count = |wanted: Answer| answers.iter().filter(|&&answer| answer == wanted).count();
        let [visible, unproven, blocked] = [Answer::Visible, Answer::Unproven, Answer::Blocked].map(count);
        assert!(blocked > 0 && visible > 0, "{found:?}");
        let counted = (places.answers.visible, places.answers.unproven, places.answers.blocked);
        assert_eq!(counted, (visible, unproven, blocked), "{found:?}");
        let all = lines.iter().filter(|line| line.is_free == is_free).count();
        assert_eq!(places.answers.none, all - answers.len());
        let wrong = if is_free { blocked } else { visible + unproven };
        let percent = places.wrong_percent.unwrap();
        // two decimals
        assert!((percent.value - 100.0 * wrong as f64 / answers.len() as f64).abs() < 0.005 + 1e-9, "{found:?}");
        assert!(percent.low < percent.value && percent.value < percent.high, "{found:?}");
    }
    let is_inside = |line: &KnownLine| {
        let end = std::array::from_fn(|i| line.target[i] + line.range * line.towards[i]);
        scene.is_inside_obstacle(line.target) || scene.is_inside_obstacle(end)
    };
    let (inside, open): (Vec<&KnownLine>, Vec<&KnownLine>) = known.iter().copied().partition(|line| is_inside(line));
    for (lines, found) in [(open, &found.probabilities), (inside, &found.probabilities_inside_obstacles)] {
        let found = found.as_ref().unwrap();
        assert!(found.cases == lines.len() && lines.len() > 200, "{found:?}");
        let mut tenths = [(0_usize, 0.0, 0.0); 10];
        let (mut certain, mut certain_wrong) = (0, 0);
        for line in &lines {
            let probability = scene.evidence(line.target, line.towards, line.range).unwrap().probability();
            let tenth = &mut tenths[((10.0 * probability) as usize).min(9)];
            let visible = f64::from(u8::from(line.is_free));
            *tenth = (tenth.0 + 1, tenth.1 + f64::from(probability), tenth.2 + visible);
            let is_certain = probability.max(1.0 - probability) >= 0.9;
            certain += usize::from(is_certain);
            certain_wrong += usize::from(is_certain && (probability >= 0.5) != line.is_free);
        }
        for tenth in &found.tenths {
            let (count, expected, free) = tenths[(tenth.from_percent / 10.0).round() as usize];
            assert_eq!(tenth.cases, count);
            for (reported, sum) in [(tenth.expected_percent, expected), (tenth.found_percent, free)] {
                assert!((reported - 100.0 * sum / count as f64).abs() < 0.005 + 1e-9, "{tenth:?}");
            }
        }
        assert_eq!(found.tenths.iter().map(|tenth| tenth.cases).sum::<usize>(), lines.len());
        let share = |count: usize, of: usize| 100.0 * count as f64 / of as f64;
        let wrong = found.certain_wrong_percent.map(|percent| percent.value);
        assert_eq!(wrong.is_some(), certain > 0);
        assert!(wrong.is_none_or(|wrong| (wrong - share(certain_wrong, certain)).abs() < 0.005 + 1e-9), "{found:?}");
        assert!((found.certain_percent - share(certain, lines.len())).abs() < 0.005 + 1e-9, "{found:?}");
    }
}

#[test]
fn the_seed_chooses_the_pulses_and_the_number_of_threads_changes_nothing() {
    let (cloud, model) = survey();
    let measured = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let params = ReliabilityParams { seed, ..ReliabilityParams::default() };
        pool.install(|| survey_reliability(&cloud, &model, &params, &Control::none()).unwrap())
    };
    let one = measured(1, 1);
    assert_eq!(measured(3, 1), one);
    let other = measured(3, 2);
    assert!(other.seed == 2 && (other.free_paths != one.free_paths || other.pulses_kept_out != one.pulses_kept_out));
}

#[test]
fn clouds_that_cannot_be_measured_say_what_is_missing() {
    let (cloud, model) = survey();
    let attempt = |cloud: &PointCloud, model: &ModelParams, share| {
        survey_reliability(cloud, model, &ReliabilityParams { share, seed: 1 }, &Control::none())
    };
    for share in [0.0, 1.0, -0.1, f64::NAN] {
        assert!(matches!(attempt(&cloud, &model, share), Err(Error::InvalidParameter { .. })), "{share}");
    }
    let mut bare = cloud.clone();
    (bare.attributes.gps_time, bare.attributes.scan_angle) = (None, None);
    for (model, word) in [(ModelParams::default(), "scanner position"), (model, "GPS time")] {
        let error = attempt(&bare, &model, 0.1).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn balls_without_pulses_have_no_probabilities_and_a_calibrated_scene_keeps_its_figures() {
    let (cloud, model) = survey();
    // four tiles at most
    let is_near = |&row: &u32| cloud.positions[row as usize][..2].iter().all(|v| v.abs() < 24.0);
    let mut cloud = cloud.select(&(0..cloud.len() as u32).filter(is_near).collect::<Vec<_>>());
    cloud.attributes.classification = None;
    let shrunk = BallParams::Shrunk(belvedere::medial::ShrinkParams::tau());
    let params = ReliabilityParams::default();
    let answers = calibrate(&cloud, &model.with_balls(shrunk), &params, &Control::none()).unwrap();
    assert!(answers.found.probabilities.is_none() && answers.headline.len() == 1, "{answers:?}");
    let keys: Vec<&str> = answers.remarks.iter().map(|remark| remark.key).collect();
    for key in ["no-probabilities", "directions-of-the-scanner", "places-behind-trees", "few-tiles"] {
        assert!(keys.contains(&key), "{key}: {keys:?}");
    }
    let parts = with_reliability(belvedere::model::ModelParts::default(), &answers.found);
    let percent = answers.found.free_paths.wrong_percent.unwrap().value;
    assert_eq!(parts.provenance["reliability_false_blocked_percent"], percent.to_string());
    assert!(!parts.provenance.contains_key("reliability_certain_wrong_percent"));
}
