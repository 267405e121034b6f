//! Results with cells of different sizes in one plan.

use crate::common::{LARGE, shadow, sky_view, sun_hours};
use belvedere::apps::ask::Days;
use belvedere::control::Control;
use belvedere::io::read_tif;
use belvedere_tiles::{
    CellSizes, Plan, PlanParams, TileQuestion, Topic, UnfinishedRun, merge, status, write_catalogue,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn questions() -> Vec<TileQuestion> {
    let days = Days {
        dates: vec!["2026-04-10".to_owned()],
        time_step_min: Some(60.0),
        min_sun_elevation_deg: Some(8.0),
        ..Days::default()
    };
    vec![shadow("shadow", 2.2, 0.4), sun_hours(days), sky_view(25)]
}

/// Returns 0.5 m for a sun, 1 m for the hours of a day and 4 m for the sky.
fn sizes() -> CellSizes {
    CellSizes::all(1.0).with(Topic::Shadow, 0.5).with(Topic::SkyView, 4.0)
}

fn done(folder: &Path, tile_size: f64, cells: CellSizes, questions: Vec<TileQuestion>) -> Plan {
    let params = PlanParams { clouds: LARGE.clouds.clone(), tile_size, cells, ..PlanParams::default() };
    let plan = Plan::make(&params, &Control::none()).unwrap();
    plan.with_questions(questions, &Control::none()).unwrap().write(folder).unwrap();
    let plan = Plan::read(folder).unwrap();
    let report = LARGE.run(&plan, folder, None);
    assert!(report.failed.is_empty() && status(&plan, folder).is_complete(), "{report:?}");
    plan
}

/// Returns the merged raster of a result.
fn raster(plan: &Plan, folder: &Path, question: &TileQuestion) -> Vec<u8> {
    let path = folder.join("merged.tif");
    merge(plan, folder, question, &path, UnfinishedRun::Refused, &Control::none()).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn results_with_their_own_cells_are_those_of_plans_with_one_question_and_of_any_tiles() {
    let place = tempfile::tempdir().unwrap();
    let [folder, whole_folder] = ["tiles", "whole"].map(|name| place.path().join(name));
    let tiles = done(&folder, 64.0, sizes(), questions());
    let whole = done(&whole_folder, 512.0, sizes(), questions());
    assert!(tiles.tiles.len() >= 9 && whole.tiles.len() == 1);
    for (question, side) in questions().iter().zip([0.5, 1.0, 4.0]) {
        assert_eq!(tiles.cells.of(question), side);
        let name = &question.name;
        // The same tiles with one question.
        let alone = place.path().join(format!("alone_{name}"));
        let plan = done(&alone, 64.0, CellSizes::all(side), vec![question.clone()]);
        assert!(raster(&plan, &alone, question) == raster(&tiles, &folder, question), "{name}");
        let catalogues = [(&plan, &alone), (&tiles, &folder)].map(|(plan, folder)| {
            write_catalogue(plan, folder, question, &Control::none()).unwrap();
            std::fs::read_to_string(folder.join(format!("{name}.vrt"))).unwrap()
        });
        assert_eq!(catalogues[0], catalogues[1]);
        // One tile over all, compared cell by cell, because its raster is larger.
        let values = [(&tiles, &folder), (&whole, &whole_folder)].map(|(plan, folder)| {
            raster(plan, folder, question);
            let cells = read_tif(folder.join("merged.tif").as_path()).unwrap();
            let (corner, raster) = (cells.place.unwrap().upper_left, cells.values);
            let number = |v: f64| (v / side).round() as i64;
            let place = |at: usize| {
                let [column, row] = [at % raster.width(), at / raster.width()].map(|v| v as i64);
                [number(corner[0]) + column, number(corner[1]) - row]
            };
            let known = raster.values().iter().enumerate().filter(|(_, value)| value.is_finite());
            known.map(|(at, value)| (place(at), value.to_bits())).collect::<BTreeMap<_, _>>()
        });
        let min = 140.0 * 140.0 / (side * side) * 0.9;
        assert!(values[0].len() as f64 > min && values[0] == values[1], "{name}: {}", values[0].len());
    }
}

#[test]
fn sizes_of_cells_that_tiles_are_no_multiple_of_are_refused() {
    let params = PlanParams { clouds: vec![PathBuf::from("gone.laz")], tile_size: 100.0, ..PlanParams::default() };
    for (cells, word) in [
        (CellSizes::all(1.0).with(Topic::SkyView, 0.3), "sixty-fourths"),
        (CellSizes::all(1.0).with(Topic::SkyView, f64::NAN), "sixty-fourths"),
        (CellSizes::all(1.0).with(Topic::SkyView, 8.0), "whole number of cells"),
        (CellSizes::all(1.0).with(Topic::SkyView, 4.0), "gone.laz"),
    ] {
        let error = Plan::make(&PlanParams { cells, ..params.clone() }, &Control::none()).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
}
