//! A survey that is kept: cells on the ground, what pulses prove, and balls that all questions share.

use crate::common::{run_all, write_town};
use belvedere::apps::ask::scene::Whereabouts;
use belvedere::apps::ask::{
    Context, GridCells, HowSure, Places, Question, Scene, ShadowQuestion, SunPlace, Suns, ThroughTrees, ask,
};
use belvedere::apps::shadow::Edges;
use belvedere::apps::targets::CellLevel;
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::model::{ModelParams, SceneModel};
use belvedere::results::Pixels;
use belvedere_tiles::{CellSizes, Plan, PlanParams, TileQuestion, memory_of_whole};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most of the cells whose answer may differ from that of one model: a plan takes noise and scanner from samples.
const MAX_DIFFERENCE: f64 = 0.01;

fn params(clouds: &[PathBuf], tile_size: f64) -> PlanParams {
    PlanParams { clouds: clouds.to_vec(), tile_size, ..PlanParams::default() }
}

/// The shadow of suns, in degrees, on cells of 1 m on the ground, of the survey kept in a folder, and how many tiles
/// got their balls.
fn shadow(folder: &Path, params: &PlanParams, sun: [f64; 2]) -> (Plan, Pixels, usize) {
    let control = Control::none();
    let plan = Plan::kept_in(folder, params, &control).unwrap();
    let plan = plan.with_cells(CellSizes::all(1.0)).unwrap().with_cells_on(CellLevel::Ground, Some(1.5));
    let frame = plan.frame().unwrap();
    let whereabouts = Whereabouts { frame: &frame, bounds: plan.bounds(), has_far_terrain: false };
    let question = Question::Shadow(question(sun));
    let questions = TileQuestion::of(&question, &whereabouts, &mut Context::default()).unwrap();
    let (plan, run) = plan.with_questions(questions, &control).unwrap().ready_in(folder).unwrap();
    let report = run_all(&plan, &run);
    assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
    let pixels = plan.results_of(&run, &plan.questions[0], &control).unwrap();
    (plan, pixels, report.balls_made)
}

fn question(sun: [f64; 2]) -> ShadowQuestion {
    ShadowQuestion {
        suns: Suns::Directions(vec![sun]),
        place: SunPlace::default(),
        edges: Edges::Hard,
        trees: ThroughTrees::Opaque,
        unproven: None,
        how_sure: HowSure::default(),
    }
}

fn bands(pixels: &Pixels) -> Vec<Vec<f32>> {
    pixels.to_numbers().unwrap().iter().map(|band| band.values().to_vec()).collect()
}

#[test]
fn cells_on_the_ground_and_proof_are_those_of_any_tiles_and_of_one_model() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 150.0, 1.0);
    let sun = [140.0, 25.0];
    let (plan, whole, _) = shadow(&place.path().join("whole"), &params(&clouds, 512.0), sun);
    for tile_size in [64.0, 100.0] {
        let (_, tiled, _) = shadow(&place.path().join(tile_size.to_string()), &params(&clouds, tile_size), sun);
        assert!(tiled == whole, "{tile_size}");
    }
    let control = Control::none();
    let (cloud, _) = read_cloud(&clouds, &ReadOptions::new(), &control).unwrap();
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control).unwrap();
    let scene = Scene::new(model, Arc::new(cloud));
    let cells = GridCells { cell: Some(1.0), height: Some(1.5), ..GridCells::default() };
    let answers = ask(&scene, &question(sun), &Places::Cells(cells), &control).unwrap();
    let tiled = bands(&whole);
    assert_eq!(tiled[0].len(), answers.measures[0].values.len(), "{:?}", plan.cells_of(&plan.questions[0]));
    for (measure, tiled) in answers.measures.iter().zip(&tiled) {
        let is_other = |(a, b): &(&f32, &f32)| a.is_nan() != b.is_nan() || !a.is_nan() && a.to_bits() != b.to_bits();
        let others = measure.values.iter().zip(tiled).filter(is_other).count() as f64;
        let share = others / tiled.len() as f64;
        assert!(share < MAX_DIFFERENCE, "{}: {share}", measure.name);
        let known = measure.values.iter().filter(|value| **value > 0.0).count();
        // all of one kind would compare nothing
        assert!(known > tiled.len() / 50, "{}: {known}", measure.name);
    }
}

#[test]
fn a_kept_survey_is_looked_at_once_and_its_balls_serve_all_questions() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 100.0, 1.0);
    let folder = place.path().join("kept");
    let (plan, first, made) = shadow(&folder, &params(&clouds, 64.0), [140.0, 25.0]);
    assert_eq!(made, plan.tiles.len());
    // the same question is answered already; another has its balls
    let (_, again, made) = shadow(&folder, &params(&clouds, 64.0), [140.0, 25.0]);
    assert!(again == first && made == 0, "{made}");
    let (_, other, made) = shadow(&folder, &params(&clouds, 64.0), [220.0, 40.0]);
    assert!(other != first && made == 0, "{made}");
    // pulses that were damaged are made again
    let balls = walk(&folder).into_iter().filter(|path| path.to_string_lossy().contains(".pulses."));
    for path in balls {
        let mut bytes = std::fs::read(&path).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 4;
        std::fs::write(&path, bytes).unwrap();
    }
    let (_, mended, made) = shadow(&folder, &params(&clouds, 64.0), [60.0, 15.0]);
    let (_, expected, _) = shadow(&place.path().join("new"), &params(&clouds, 64.0), [60.0, 15.0]);
    assert!(mended == expected && made == plan.tiles.len(), "{made}");
}

#[test]
fn less_memory_has_smaller_tiles_of_the_survey_that_is_kept() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 200.0, 1.0);
    let folder = place.path().join("kept");
    let kept = |memory: Option<u64>| {
        Plan::kept_in(&folder, &PlanParams { memory, ..params(&clouds, 512.0) }, &Control::none()).unwrap()
    };
    let first = kept(None);
    let less = kept(Some(first.estimate().memory_bytes - 1_000_000));
    assert!(less.tile_size < first.tile_size && less.tiles.len() > first.tiles.len(), "{}", less.tile_size);
    assert_eq!(kept(None), first);
    // another survey in the same folder is another plan
    let one = Plan::kept_in(&folder, &params(&clouds[..1], 512.0), &Control::none()).unwrap();
    assert!(one.inputs.len() == 1 && first.inputs.len() == 2);
}

/// All files below a folder.
fn walk(folder: &Path) -> Vec<PathBuf> {
    let paths = folder.read_dir().unwrap().map(|entry| entry.unwrap().path());
    paths.flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] }).collect()
}

#[test]
fn memory_of_a_whole_survey_follows_its_points_and_tables_have_none() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 100.0, 1.0);
    let [one, both] = [&clouds[..1], &clouds[..]].map(|clouds| memory_of_whole(clouds).unwrap());
    assert!(both > one && one > 100_000_000, "{one} {both}");
    let table = place.path().join("points.xyz");
    std::fs::write(&table, "1 2 3\n").unwrap();
    assert_eq!(memory_of_whole(&[table]), None);
    assert_eq!(memory_of_whole(&[place.path().join("gone.laz")]), None);
}
