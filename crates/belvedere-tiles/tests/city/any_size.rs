//! Kept surveys: cells on the ground, proof by pulses, and balls that all questions share.

use crate::common::{MIDDLE, SMALL, WIDE, write_town};
use belvedere::apps::ask::{
    Answers, Days, GridCells, HowSure, Places, Question, Remark, Report, SOLAR, Scene, ShadowQuestion, SkyParts,
    SkyViewQuestion, SunHoursQuestion, SunPlace, Suns, ThroughTrees, ask,
};
use belvedere::apps::shadow::Edges;
use belvedere::apps::targets::Measure;
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud, write_cloud};
use belvedere::model::{ModelParams, SceneModel};
use belvedere_tiles::{Plan, PlanParams, SurveyCells, SurveyQuestion, TooLarge};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Maximum share of cells whose proof differs from one model: tiles measure unproven lengths block by block.
const MAX_DIFFERENCE: f64 = 0.0005;

fn params(clouds: &[PathBuf], tile_size: f64) -> PlanParams {
    PlanParams { clouds: clouds.to_vec(), tile_size, ..PlanParams::default() }
}

/// Returns the shadow of a sun, azimuth and elevation in degrees, on cells of 1 m on the ground, of the survey kept in
/// `folder`. The number of tiles whose balls were made comes last.
fn shadow(folder: &Path, params: &PlanParams, sun: [f64; 2]) -> (Plan, Answers<SurveyCells>, usize) {
    shadow_of(folder, params, sun, &cells())
}

fn shadow_of(
    folder: &Path,
    params: &PlanParams,
    sun: [f64; 2],
    cells: &GridCells,
) -> (Plan, Answers<SurveyCells>, usize) {
    let control = Control::none();
    let plan = Plan::kept_in(folder, params, &control).unwrap().with_grid_cells(cells).unwrap();
    let survey =
        SurveyQuestion::new(plan.clone(), folder, Question::Shadow(question(sun)), u64::MAX, &control).unwrap();
    let report = survey.run(&|| 0.0, &control).unwrap();
    assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
    (plan, survey.answers(&report, &control).unwrap(), report.balls_made)
}

fn question(sun: [f64; 2]) -> ShadowQuestion {
    ShadowQuestion {
        suns: Suns::Directions(vec![sun]),
        place: SunPlace::default(),
        edges: Edges::Hard,
        trees: ThroughTrees::Opaque,
        unproven: None,
        how_sure: HowSure::default(),
        casters: false,
    }
}

fn cells() -> GridCells {
    GridCells { cell: Some(1.0), height: Some(1.5), ..GridCells::default() }
}

/// Returns all values as bits.
fn bits(answers: &Answers<SurveyCells>) -> Vec<Vec<u32>> {
    let of_measure = |measure: &Measure| measure.values.iter().map(|value| value.to_bits()).collect();
    answers.measures.iter().map(of_measure).collect()
}

#[test]
fn cells_on_the_ground_and_proof_are_those_of_any_tiles_and_of_one_model() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &write_town(place.path(), 150.0, 1.0);
    let sun = [140.0, 25.0];
    let (_, whole, _) = shadow(&place.path().join("whole"), &params(clouds, 512.0), sun);
    for tile_size in [64.0, 100.0] {
        let (_, tiled, _) = shadow(&place.path().join(tile_size.to_string()), &params(clouds, tile_size), sun);
        assert!(bits(&tiled) == bits(&whole), "{tile_size}");
    }
    let control = Control::none();
    let (cloud, _) = read_cloud(clouds, &ReadOptions::new(), &control).unwrap();
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control).unwrap();
    let scene = Scene::new(model, Arc::new(cloud));
    let answers = ask(&scene, &question(sun), &Places::Cells(cells()), &control).unwrap();
    assert_eq!(answers.measures.len(), 2);
    for (measure, tiled) in answers.measures.iter().zip(&whole.measures) {
        assert_eq!((&measure.name, measure.values.len()), (&tiled.name, tiled.values.len()));
        let is_other = |(a, b): &(&f32, &f32)| a.is_nan() != b.is_nan() || !a.is_nan() && a.to_bits() != b.to_bits();
        let others = measure.values.iter().zip(&tiled.values).filter(is_other).count() as f64;
        let share = others / tiled.values.len() as f64;
        let allowed = if measure.name == "unproven" { MAX_DIFFERENCE } else { 0.0 };
        assert!(share <= allowed, "{}: {share}", measure.name);
        let known = measure.values.iter().filter(|value| **value > 0.0).count();
        // Values all of one kind would compare nothing.
        assert!(known > tiled.values.len() / 50, "{}: {known}", measure.name);
    }
    // The same words, with different figures.
    let without_digits = |lines: &[String]| lines.concat().replace(|c: char| c.is_ascii_digit() || c == '.', "");
    assert_eq!(without_digits(&answers.headline), without_digits(&whole.headline));
    assert_eq!(answers.found.on.title, whole.found.title);
    let keys = |remarks: &[Remark]| remarks.iter().map(|remark| remark.key).collect::<Vec<_>>();
    assert_eq!(keys(&answers.remarks), keys(&whole.remarks));
    let covered = |report: &Report| report.places.cells_under_cover_left_out.unwrap() as f64;
    assert!(covered(&whole.report) > 100.0);
    assert_eq!(covered(&answers.report), covered(&whole.report));
}

#[test]
fn one_model_in_the_frame_and_with_the_statistics_of_a_plan_answers_as_its_tiles_do() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &SMALL.clouds;
    let control = Control::none();
    let folder = place.path().join("kept");
    let plan = Plan::kept_in(&folder, &params(clouds, 64.0), &control).unwrap().with_grid_cells(&cells()).unwrap();
    let options = ReadOptions::new().with_frame(plan.frame().unwrap());
    let (cloud, _) = read_cloud(clouds, &options, &control).unwrap();
    let (model, _) = SceneModel::build(&cloud, &plan.model(), &control).unwrap();
    let scene = Scene::new(model, Arc::new(cloud));
    let solar = SunPlace { zone: Some(SOLAR.to_owned()), ..SunPlace::default() };
    let dates = vec!["2026-04-10".to_owned()];
    let days = Days { dates, time_step_min: Some(60.0), ..Days::default() };
    let suns = Suns::Directions(vec![[140.0, 12.0], [200.0, 35.0]]);
    let soft = ShadowQuestion { edges: Edges::Soft, suns, ..question([0.0, 0.0]) };
    let hours = SunHoursQuestion { days, place: solar, ..SunHoursQuestion::default() };
    let sky = SkyViewQuestion { sky: SkyParts::Even(49), ..SkyViewQuestion::default() };
    let of_tiles = |question: Question| {
        let survey = SurveyQuestion::new(plan.clone(), &folder, question, u64::MAX, &control).unwrap();
        let report = survey.run(&|| 0.0, &control).unwrap();
        survey.answers(&report, &control).unwrap().measures
    };
    let cells = Places::Cells(cells());
    for (number, (of_model, of_tiles)) in [
        (
            ask(&scene, &question([140.0, 25.0]), &cells, &control).unwrap().measures,
            of_tiles(question([140.0, 25.0]).into()),
        ),
        (ask(&scene, &soft, &cells, &control).unwrap().measures, of_tiles(soft.into())),
        (ask(&scene, &hours, &cells, &control).unwrap().measures, of_tiles(hours.into())),
        (ask(&scene, &sky, &cells, &control).unwrap().measures, of_tiles(sky.into())),
    ]
    .into_iter()
    .enumerate()
    {
        assert_eq!(of_model.len(), of_tiles.len());
        for (expected, found) in of_model.iter().zip(&of_tiles) {
            let differ = |(a, b): &(&f32, &f32)| a.is_nan() != b.is_nan() || !a.is_nan() && a.to_bits() != b.to_bits();
            let count = expected.values.iter().zip(&found.values).filter(differ).count();
            let known = found.values.iter().filter(|value| value.is_finite()).count();
            assert!(known > 1000, "{known}");
            assert_eq!(expected.without_values(), found.without_values());
            assert_eq!(count, 0, "{number}, {}: of {known}", found.name);
        }
    }
}

#[test]
fn cells_of_flight_lines_that_are_fitted_to_each_other_are_those_of_one_model() {
    let place = tempfile::tempdir().unwrap();
    let control = Control::none();
    let (mut cloud, _) = read_cloud(&MIDDLE.clouds, &ReadOptions::new(), &control).unwrap();
    let lines = cloud.attributes.point_source_id.clone().unwrap();
    let first = *lines.iter().min().unwrap();
    for (p, line) in cloud.positions.iter_mut().zip(&lines) {
        p[2] += if *line == first { 0.0 } else { 0.4 };
    }
    let path = place.path().join("risen.laz");
    write_cloud(&path, &cloud, &[]).unwrap();
    let clouds = &[path];
    let (_, tiled, _) = shadow(&place.path().join("kept"), &params(clouds, 64.0), [140.0, 25.0]);
    let (cloud, _) = read_cloud(clouds, &ReadOptions::new(), &control).unwrap();
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control).unwrap();
    assert!(!model.findings().moved_strips().is_empty());
    let scene = Scene::new(model, Arc::new(cloud));
    let answers = ask(&scene, &question([140.0, 25.0]), &Places::Cells(cells()), &control).unwrap();
    let values = |measures: &[Measure]| measures[0].values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert!(values(&answers.measures) == values(&tiled.measures));
}

#[test]
fn a_kept_survey_is_looked_at_once_and_its_balls_serve_all_questions() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &MIDDLE.clouds;
    let folder = place.path().join("kept");
    let (plan, first, made) = shadow(&folder, &params(clouds, 64.0), [140.0, 25.0]);
    assert_eq!(made, plan.tiles.len());
    // The same question has its answer already; another question has its balls.
    let (_, again, made) = shadow(&folder, &params(clouds, 64.0), [140.0, 25.0]);
    assert!(bits(&again) == bits(&first) && made == 0, "{made}");
    let (_, other, made) = shadow(&folder, &params(clouds, 64.0), [220.0, 40.0]);
    assert!(bits(&other) != bits(&first) && made == 0, "{made}");
    // It found the ground of its cells, too.
    let (_, anew, _) = shadow(&place.path().join("anew"), &params(clouds, 64.0), [220.0, 40.0]);
    assert!(bits(&other) == bits(&anew));
    // Also for targets of another height.
    let low = GridCells { height: Some(0.1), ..cells() };
    let (_, lower, _) = shadow_of(&folder, &params(clouds, 64.0), [220.0, 40.0], &low);
    let (_, anew, _) = shadow_of(&place.path().join("low"), &params(clouds, 64.0), [220.0, 40.0], &low);
    assert!(bits(&lower) == bits(&anew) && bits(&lower) != bits(&other));
    let files = |what: &str| walk(&folder).into_iter().filter(|path| path.to_string_lossy().contains(what)).collect();
    let (pulses, ground): (Vec<PathBuf>, Vec<PathBuf>) = (files(".pulses."), files("ground"));
    assert!(!pulses.is_empty() && !ground.is_empty());
    // Damaged files are made again.
    for path in pulses.into_iter().chain(ground) {
        let mut bytes = std::fs::read(&path).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 4;
        std::fs::write(&path, bytes).unwrap();
    }
    let (_, mended, made) = shadow(&folder, &params(clouds, 64.0), [60.0, 15.0]);
    let (_, expected, _) = shadow(&place.path().join("anew"), &params(clouds, 64.0), [60.0, 15.0]);
    assert!(bits(&mended) == bits(&expected) && made == plan.tiles.len(), "{made}");
}

#[test]
fn less_memory_has_smaller_tiles_of_the_survey_that_is_kept() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &WIDE.clouds;
    let folder = place.path().join("kept");
    let kept = || Plan::kept_in(&folder, &params(clouds, 512.0), &Control::none()).unwrap();
    let first = kept();
    let less = kept().fitting(first.estimate().memory_bytes - 1_000_000).unwrap();
    assert!(less.tile_size < first.tile_size && less.tiles.len() > first.tiles.len(), "{}", less.tile_size);
    assert_eq!(kept(), first);
    // A tile is a whole number of cells.
    let wide = kept().with_grid_cells(&GridCells { cell: Some(5.0), ..GridCells::default() }).unwrap();
    assert_eq!(wide.fitting(u64::MAX).unwrap().tile_size, 320.0);
    let odd = kept().with_grid_cells(&GridCells { cell: Some(0.3), ..GridCells::default() }).unwrap_err().to_string();
    assert!(odd.contains("0.3 m") && odd.contains("such as 0.25, 0.5"), "{odd}");
    // Another survey in the same folder is another plan.
    let one = Plan::kept_in(&folder, &params(&clouds[..1], 512.0), &Control::none()).unwrap();
    assert!(one.inputs.len() == 1 && first.inputs.len() == 2);
}

/// Returns all files below a folder.
fn walk(folder: &Path) -> Vec<PathBuf> {
    let paths = folder.read_dir().unwrap().map(|entry| entry.unwrap().path());
    paths.flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] }).collect()
}

#[test]
fn suns_below_the_horizon_light_nothing_and_results_that_are_too_large_together_are_refused() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &SMALL.clouds;
    let folder = place.path().join("kept");
    let control = Control::none();
    let plan = Plan::kept_in(&folder, &params(clouds, 512.0), &control).unwrap().with_grid_cells(&cells()).unwrap();
    let suns = Suns::Directions(vec![[140.0, -5.0], [140.0, 40.0]]);
    let both = Question::Shadow(ShadowQuestion { suns, ..question([0.0, 0.0]) });
    let new = |limit: u64| SurveyQuestion::new(plan.clone(), &folder, both.clone(), limit, &control);
    let error = new(1000).err().unwrap().to_string();
    assert!(error.contains("0 MB") && error.contains("larger cells"), "{error}");
    let survey = new(u64::MAX).unwrap();
    let report = survey.run(&|| 0.0, &control).unwrap();
    let answers = survey.answers(&report, &control).unwrap();
    let lit = |number: usize| answers.measures[number].values.iter().filter(|value| **value > 0.0).count();
    let known = |number: usize| answers.measures[number].values.iter().filter(|value| value.is_finite()).count();
    assert_eq!((answers.measures.len(), lit(0), known(0)), (2, 0, known(1)));
    assert!(lit(1) > known(1) / 4, "{} of {}", lit(1), known(1));
    assert!(answers.remarks.iter().any(|remark| remark.key == "suns-below-horizon"));
    let casters = Question::Shadow(ShadowQuestion { casters: true, ..question([140.0, 40.0]) });
    assert_eq!(casters.needs_whole(), Some("what casts shadows"));
    let error = SurveyQuestion::new(plan, &folder, casters, u64::MAX, &control).err().unwrap().to_string();
    assert!(error.contains("all of a survey in memory"), "{error}");
}

#[test]
fn memory_of_one_model_follows_the_points_and_tables_have_none() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &MIDDLE.clouds;
    let [one, both] = [&clouds[..1], &clouds[..]].map(|clouds| TooLarge::of(clouds, 1_000_000).unwrap());
    assert!(both.whole > one.whole && one.whole > 100_000_000, "{one:?} {both:?}");
    assert_eq!(TooLarge::of(clouds, both.whole), None);
    let table = place.path().join("points.xyz");
    std::fs::write(&table, "1 2 3\n").unwrap();
    assert_eq!(TooLarge::of(&[table], 0), None);
    assert_eq!(TooLarge::of(&[place.path().join("gone.laz")], 0), None);
}
