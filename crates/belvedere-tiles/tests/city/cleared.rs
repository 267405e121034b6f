//! Cleared areas, tile by tile: the same as in one tile over all, and as in one scene.

use crate::common::{MIDDLE, cells, plan, run_with, sky_view, suns};
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_balls, read_cloud, read_tif_f32, read_tif_u8};
use belvedere::medial::{LIMIT_TOUCH, MedialBalls};
use belvedere::model::{ClearedArea, ModelParams, SceneModel};
use belvedere_tiles::{Plan, TileQuestion, Topic, UnfinishedRun, merge, status};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Rectangle over corners of tiles of 64 and of 100 m, file coordinates: from x, y to x, y.
const LOW: [f64; 2] = [154_986.0, 462_960.0];
const HIGH: [f64; 2] = [155_030.0, 463_012.0];
/// ASPRS class of high vegetation.
const TREES: u8 = 5;

/// Returns the rectangle, a triangle that overlaps it, and all trees.
fn areas(plan: &Plan) -> Vec<ClearedArea> {
    let origin = plan.frame().unwrap().origin;
    let local = |[x, y]: [f64; 2]| [x - origin[0], y - origin[1]];
    let rectangle = [LOW, [HIGH[0], LOW[1]], HIGH, [LOW[0], HIGH[1]]].map(local);
    let triangle = [[155_020.0, 463_000.0], [155_050.0, 463_004.0], [155_031.0, 463_030.0]].map(local);
    vec![
        ClearedArea::Polygon(vec![rectangle.to_vec()]),
        ClearedArea::Polygon(vec![triangle.to_vec()]),
        ClearedArea::Class(TREES),
    ]
}

/// Returns the balls of all tiles.
fn balls(plan: &Plan, folder: &Path) -> MedialBalls {
    let mut all = MedialBalls::default();
    for tile in &plan.tiles {
        let path = folder.join("balls").join(format!("{}.npz", tile.name()));
        if path.exists() {
            let own = read_balls(&path).unwrap().balls;
            for row in 0..own.len() {
                all.push(0, own.centers[row], own.radii[row], own.touch[row]);
            }
        }
    }
    all
}

/// Returns centres and radii as bits.
fn bits(balls: &MedialBalls) -> BTreeSet<[u32; 4]> {
    let bits = |(c, r): (&[f32; 3], &f32)| [c[0], c[1], c[2], *r].map(f32::to_bits);
    balls.centers.iter().zip(&balls.radii).map(bits).collect()
}

/// Returns the heights of the balls that close the ground, by their place.
fn closing(balls: &MedialBalls, rows: std::ops::Range<usize>) -> BTreeMap<[u32; 2], f32> {
    let is_one = |row: &usize| balls.radii[*row] == 1.0 && balls.touch[*row] == LIMIT_TOUCH;
    // Middles of columns of 0.25 m.
    let is_middle = |v: f32| (f64::from(v) / 0.125).rem_euclid(2.0) == 1.0;
    let center = rows.filter(is_one).map(|row| balls.centers[row]);
    center.filter(|c| is_middle(c[0]) && is_middle(c[1])).map(|[x, y, z]| ([x.to_bits(), y.to_bits()], z)).collect()
}

fn values(plan: &Plan, folder: &Path, question: &TileQuestion) -> BTreeMap<[i64; 2], u32> {
    let path = folder.join("merged.tif");
    merge(plan, folder, question, &path, UnfinishedRun::Refused, &Control::none()).unwrap();
    if question.topic() == Topic::Shadow {
        let raster = read_tif_u8(&path).unwrap();
        let wide: Vec<u32> = raster.values().iter().map(|&v| v.into()).collect();
        return cells(&path, &wide, raster.width(), 255);
    }
    let raster = read_tif_f32(&path).unwrap();
    let bits: Vec<u32> = raster.values().iter().map(|v| v.to_bits()).collect();
    cells(&path, &bits, raster.width(), (-9999.0_f32).to_bits())
}

#[test]
fn cleared_areas_are_the_same_for_tiles_of_any_size_and_those_of_one_scene() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &MIDDLE.clouds;
    let questions = [suns()[1].clone(), sky_view(25)];
    let plain_folder = place.path().join("plain");
    let plain = plan(clouds, &plain_folder, 512.0, questions.to_vec());
    MIDDLE.run(&plain, &plain_folder, None);
    let [before, whole] = ["plain", "whole"].map(|name| place.path().join(name));
    let with_areas = |folder: &Path, size: f64| {
        let plan = plan(clouds, folder, size, questions.to_vec());
        let areas = areas(&plan);
        plan.with_cleared(areas).unwrap().write(folder).unwrap();
        let plan = Plan::read(folder).unwrap();
        let report = run_with(&plan, folder, (size < 100.0).then_some(900));
        assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
        assert!(status(&plan, folder).is_complete());
        plan
    };
    let one = with_areas(&whole, 512.0);
    assert_eq!(one.tiles.len(), 1);
    let expected_balls = balls(&one, &whole);
    let expected = bits(&expected_balls);
    for size in [64.0, 100.0] {
        let folder = place.path().join(format!("tiles_{size}"));
        let tiles = with_areas(&folder, size);
        assert!(tiles.tiles.len() >= 4);
        assert!(bits(&balls(&tiles, &folder)) == expected, "balls of tiles of {size} m differ");
        for question in &questions {
            let [found, expected] =
                [(&tiles, &folder), (&one, &whole)].map(|(plan, folder)| values(plan, folder, question));
            assert!(found == expected, "{} of tiles of {size} m differs", question.name);
        }
    }
    // Every cell still has a value, and no cleared cell lies in a shadow of a cleared object.
    let [shadow, sky] = [&questions[0], &questions[1]].map(|question| {
        let [was, is] = [(&plain, &before), (&one, &whole)].map(|(plan, folder)| values(plan, folder, question));
        assert!(was.keys().all(|cell| is.contains_key(cell)), "cells are gone");
        (was, is)
    });
    let in_rectangle = |cell: &[i64; 2]| {
        let [x, y] = [cell[0] as f64 + 0.5, cell[1] as f64 - 0.5];
        (LOW[0]..HIGH[0]).contains(&x) && (LOW[1]..HIGH[1]).contains(&y)
    };
    let sum = |values: &BTreeMap<[i64; 2], u32>| {
        let inside = values.iter().filter(|(cell, _)| in_rectangle(cell));
        inside.map(|(_, &bits)| f64::from(f32::from_bits(bits))).sum::<f64>()
    };
    // Roofs see much of the sky as well.
    let area = (HIGH[0] - LOW[0]) * (HIGH[1] - LOW[1]);
    assert!(sum(&sky.1) > 0.7 * area && sum(&sky.1) > sum(&sky.0), "{} {}", sum(&sky.1), sum(&sky.0));
    assert!(shadow.0 != shadow.1);
    as_in_one_scene(clouds, &plain, (&balls(&plain, &before), &expected_balls));
}

/// Compares the balls of tiles, before and after clearing, with those of one model of the whole cloud in the same
/// frame.
fn as_in_one_scene(clouds: &[std::path::PathBuf], plan: &Plan, (before, after): (&MedialBalls, &MedialBalls)) {
    let control = Control::none();
    let options = ReadOptions::new().with_frame(plan.frame().unwrap());
    let (mut cloud, _) = read_cloud(clouds.iter().map(|path| path.as_path()), &options, &control).unwrap();
    let (mut model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control).unwrap();
    let same = |tiles: &MedialBalls, model: &SceneModel| {
        let (tiles, model) = (bits(tiles), bits(model.balls()));
        tiles.intersection(&model).count() as f64 / model.len() as f64
    };
    let alike = same(before, &model);
    let (mut sum, mut added) = ([0; 3], BTreeMap::new());
    for area in areas(plan) {
        let report;
        (model, cloud, report) = model.without(&area, &cloud, &control).unwrap();
        sum = [sum[0] + report.balls_cleared, sum[1] + report.balls_cut, sum[2] + report.ground_balls_added];
        let count = model.balls().len();
        added.extend(closing(model.balls(), count - report.ground_balls_added..count));
    }
    assert!(sum[0] > 2000 && sum[1] > 20 && sum[2] > 1000, "{sum:?}");
    // No more balls differ than before. Differences come from neighbours farther than 16 m and from decks in one scene.
    assert!(alike > 0.9 && same(after, &model) > alike - 0.01, "{alike} {}", same(after, &model));
    let found = closing(after, 0..after.len());
    let near = |(place, height): (&[u32; 2], &f32)| found.get(place).is_some_and(|own| (own - height).abs() < 0.01);
    let missing = added.iter().filter(|entry| !near(*entry)).count();
    // Triangles of the ground that are larger than the part that a block sees.
    assert!(missing * 200 < added.len(), "{missing} of {}", added.len());
}

#[test]
fn areas_beside_the_survey_and_its_ground_are_refused_and_empty_ones_found() {
    let place = tempfile::tempdir().unwrap();
    let plan = plan(&MIDDLE.clouds, &place.path().join("run"), 512.0, suns());
    let beside = ClearedArea::Polygon(vec![vec![[9000.0, 0.0], [9001.0, 0.0], [9001.0, 1.0]]]);
    for (area, word) in [
        (beside, "on the cloud"),
        (ClearedArea::Polygon(vec![vec![[0.0; 2]; 2]]), "three corners"),
        (ClearedArea::Class(2), "stands on the ground"),
    ] {
        let error = plan.clone().with_cleared(vec![area]).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
    let clears = |area: ClearedArea| plan.clone().with_cleared(vec![area]).unwrap().clears_anything(&Control::none());
    assert!(clears(ClearedArea::Class(TREES)).unwrap() && !clears(ClearedArea::Class(77)).unwrap());
    assert!(areas(&plan).into_iter().all(|area| clears(area).unwrap()));
}
