//! Models that are joined from tiles, against those of the same clouds made at once.

use crate::common::{MIDDLE, WIDE};
use belvedere::control::Control;
use belvedere::io::{ReadOptions, Within, read_cloud};
use belvedere::medial::{LIMIT_TOUCH, MedialBalls};
use belvedere::model::{ModelParams, ModelParts, SceneModel};
use belvedere::query::{Answer, EarthParams, UnprovenAs};
use belvedere::{PointCloud, SurfacePatches};
use belvedere_tiles::{JoinedSurvey, Plan, PlanParams};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn plan(folder: &Path, clouds: &[PathBuf], tile_size: f64) -> Plan {
    let params = PlanParams { clouds: clouds.to_vec(), tile_size, ..PlanParams::default() };
    Plan::kept_in(folder, &params, &Control::none()).unwrap()
}

/// Returns the points of a survey and the model of its tiles.
fn joined(survey: &JoinedSurvey, clouds: &[PathBuf]) -> (PointCloud, SceneModel) {
    let control = Control::none();
    survey.make_balls(&control).unwrap();
    let options = ReadOptions::new().with_frame(survey.frame.clone());
    let options = match survey.part {
        Some([[west, south], [east, north]]) => {
            options.with_points_within(Within::File { low: [west, south, -1e9], high: [east, north, 1e9] })
        }
        None => options,
    };
    let (cloud, _) = read_cloud(clouds, &options, &control).unwrap();
    let model = survey.model(&cloud, &control).unwrap();
    (cloud, model)
}

/// Returns the model of all points, made at once.
fn whole(clouds: &[PathBuf]) -> SceneModel {
    let control = Control::none();
    let (cloud, _) = read_cloud(clouds, &ReadOptions::new(), &control).unwrap();
    SceneModel::build(&cloud, &ModelParams::default(), &control).unwrap().0
}

/// Returns the points, centres, radii and transmissions of balls as bits.
fn rows(balls: &MedialBalls, transmission: &[f32]) -> Vec<[u32; 6]> {
    let row = |row: usize| {
        let ([x, y, z], radius) = (balls.centers[row], balls.radii[row]);
        [balls.source[row], x.to_bits(), y.to_bits(), z.to_bits(), radius.to_bits(), transmission[row].to_bits()]
    };
    (0..balls.len()).map(row).collect()
}

/// Returns triangles and their kinds as bits, in any order.
fn triangles(patches: &SurfacePatches) -> BTreeSet<([[u32; 3]; 3], u8)> {
    patches.iter().map(|(corners, kind)| (corners.map(|corner| corner.map(f32::to_bits)), kind.code())).collect()
}

#[test]
fn the_model_of_tiles_is_that_of_the_cloud() {
    let clouds = &MIDDLE.clouds;
    let model = whole(clouds);
    let expected = model.parts();
    assert!(expected.balls.len() > 10_000 && !expected.patches.is_empty() && expected.medium.is_some());
    for tile_size in [64.0, 100.0, 256.0] {
        let place = tempfile::tempdir().unwrap();
        let survey = JoinedSurvey::new(plan(place.path(), clouds, tile_size), place.path(), None, u64::MAX).unwrap();
        assert_eq!(survey.part, None);
        let (_, found) = joined(&survey, clouds);
        let ModelParts { frame, bounds, balls, transmission, patches, medium, pulses: rays, provenance, .. } =
            found.parts();
        assert_eq!((frame, bounds), (&expected.frame, &expected.bounds));
        assert_eq!(balls.len(), expected.balls.len());
        let [mut of_tiles, mut of_cloud] = [(balls, transmission), (&expected.balls, &expected.transmission)]
            .map(|(balls, shares)| rows(balls, shares));
        let same = of_tiles.iter().zip(&of_cloud).take_while(|(found, expected)| found == expected).count();
        // those that fill gaps come last, in another order
        assert!(same > balls.len() / 2, "{same} of {}", balls.len());
        of_tiles.sort_unstable();
        of_cloud.sort_unstable();
        assert!(of_tiles == of_cloud, "{tile_size}");
        let touches = || balls.touch[..same].iter().zip(&expected.balls.touch);
        let others = touches().filter(|(found, expected)| found != expected).count();
        assert!(touches().all(|(found, expected)| found == expected || *found == LIMIT_TOUCH));
        assert!(others < same / 20, "{others} of {same}");
        assert!(triangles(patches) == triangles(&expected.patches), "{tile_size}");
        assert_eq!(medium, &expected.medium, "{tile_size}");
        assert!(rays == &expected.pulses && rays.is_some(), "{tile_size}");
        assert_eq!(provenance, &expected.provenance);
    }
}

#[test]
fn lines_of_sight_through_a_part_are_those_through_the_whole() {
    let clouds = &WIDE.clouds;
    let control = Control::none();
    let model = whole(clouds);
    let (frame, bounds) = (model.frame(), model.bounds());
    let [x, y] = [0, 1].map(|axis| f64::from(bounds.low[axis]));
    let pair = |i: i32| {
        let (along, up) = (0.2 * f64::from(i), 0.15 * f64::from(i));
        [[x + 4.0, y + 5.0, 1.0 + up], [x + 4.0 + along, y + 35.0, 2.0 + up]]
    };
    let pairs: Vec<[[f64; 3]; 2]> = (0..200).map(pair).collect();
    let ends: Vec<[f64; 2]> = [pairs[0], pairs[199]]
        .as_flattened()
        .iter()
        .map(|end| [0, 1].map(|axis| end[axis] + frame.origin[axis]))
        .collect();
    let place = tempfile::tempdir().unwrap();
    let survey = JoinedSurvey::new(plan(place.path(), clouds, 64.0), place.path(), Some((&ends, 0.0)), u64::MAX);
    let (cloud, part) = joined(&survey.unwrap(), clouds);
    assert!(part.balls().len() < model.balls().len() / 2 && cloud.len() < model.balls().len() / 2);
    let answers = |model: &SceneModel| {
        let scene = model.scene(&model.rule(), UnprovenAs::Reported, &control).unwrap();
        let found = scene.lines_of_sight(&pairs, &EarthParams::default(), &control).unwrap();
        found
            .into_iter()
            .map(|sight| sight.unwrap())
            .map(|sight| (sight.answer, sight.first_block.map(|b| b.range)))
            .collect::<Vec<_>>()
    };
    let expected = answers(&model);
    assert_eq!(answers(&part), expected);
    for answer in [Answer::Visible, Answer::Blocked] {
        assert!(expected.iter().filter(|(found, _)| *found == answer).count() > 10, "{answer:?}");
    }
}

#[test]
fn a_scene_that_has_no_memory_even_in_tiles_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let plan = plan(place.path(), &MIDDLE.clouds, 64.0);
    // places beside the survey need all of it, however far they are
    let far = [[1e300, -1e300], [154_700.0, 462_900.0], [f64::MAX, f64::MIN]];
    for places in [&far[..1], &far[..2], &far] {
        let survey = JoinedSurvey::new(plan.clone(), place.path(), Some((places, 10.0)), u64::MAX).unwrap();
        assert!(survey.part.is_none_or(|[low, high]| low.iter().zip(&high).all(|(low, high)| high - low < 1000.0)));
    }
    let error = JoinedSurvey::new(plan, place.path(), None, 100_000_000).err().unwrap().to_string();
    assert!(error.contains("100 MB") && error.contains("allow more memory"), "{error}");
}
