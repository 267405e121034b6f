//! `belvedere survey-plan`.

use crate::arguments::{Global, SurveyPlanArguments};
use crate::inputs::camera_places::candidates_on_path;
use crate::inputs::line_pairs::pairs;
use crate::inputs::observers::{ObserverUse, standing_rows};
use crate::outputs::formats::{check_outputs, extension, warn_of_geojson};
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Error;
use belvedere::apps::ask::{
    Ask, Candidates, GridCells, Places, PlannedStation, Scene, SunPlace, Suns, SurveyPlanQuestion, SurveyPlanResults,
};
use belvedere::io::{Spot, TableCells, write_places, write_table};
use belvedere::report::rounded;
use serde_json::{Map, Value};
use std::path::Path;

pub(crate) fn run(arguments: &SurveyPlanArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["geojson", "gpkg", "csv"])?;
    let mut question = question(arguments);
    question.check()?;
    let mut run = CommandContext::new(global);
    let scene = pipeline::scene(&arguments.scene, KeepPoints::Keep, &mut run)?;
    let frame = scene.cloud.frame.clone();
    warn_of_geojson(&arguments.output, &frame.crs, &mut run.summary);
    let scene = scene.into_question_scene(Some(&arguments.ground), None, &run)?;
    let (cell, height, ground) = (arguments.cell, arguments.heights.target_height, question.ground);
    let cells = GridCells { cell, height, ground, ..GridCells::default() };
    let places = match &arguments.observers {
        None if question.suns.is_some() => Places::Cells(cells),
        None => Places::Pairs(pairs(&arguments.lines, &scene, &run)?.0),
        Some(path) => {
            question.observers.extend(standing_rows(path, &frame, &mut run)?);
            Places::Cells(cells)
        }
    };
    if let Some(path) = &arguments.stations.file {
        let given = candidates_on_path(path, arguments.step, ObserverUse::Places, &frame, &mut run)?;
        if arguments.whole_lines && given.iter().all(|one| one.line.is_none()) {
            let what =
                "it has no lines, which --whole-lines needs; give GeoJSON with lines, or leave out --whole-lines";
            return Err(Error::malformed(path, what).into());
        }
        question.candidates = Candidates::Given(given);
    }
    let answers = run.ask(&scene, &question, &places)?;
    for output in &arguments.output {
        run.stage("writing", 0, |_| write(output, &answers.found, &scene))?;
    }
    run.summary.add_paths("written", &arguments.output);
    Ok(run.finish())
}

/// The question, before files are read.
fn question(arguments: &SurveyPlanArguments) -> SurveyPlanQuestion {
    let usual = SurveyPlanQuestion::default();
    let directions: Vec<[f64; 2]> = arguments.suns.iter().map(|direction| direction.0).collect();
    SurveyPlanQuestion {
        suns: (!directions.is_empty()).then_some(Suns::Directions(directions)),
        place: SunPlace { north: arguments.north.choice(), ..SunPlace::default() },
        whole_lines: arguments.whole_lines,
        count: arguments.count,
        candidates: match (arguments.stations.on_roofs, arguments.stations.on_ground) {
            (Some(cell), _) => Candidates::Roofs(cell),
            (None, Some(cell)) => Candidates::Ground(cell),
            (None, None) => usual.candidates,
        },
        station_height: arguments.station_height,
        max_distance: arguments.max_distance,
        angle_step_deg: arguments.angle_step_deg,
        observer_height: arguments.heights.observer_height,
        target_height: arguments.heights.target_height,
        ground: arguments.ground.points(),
        ..usual
    }
}

/// A row or a point for each candidate that can be used.
fn write(output: &Path, found: &SurveyPlanResults, scene: &Scene) -> Result<()> {
    let (stations, frame) = (found.stations(), scene.frame());
    if ["geojson", "gpkg"].contains(&&*extension(output)) {
        let spot = |station: &PlannedStation| {
            let place = std::array::from_fn(|i| station.eye[i] + frame.origin[i]);
            Spot { place, properties: properties(station, found) }
        };
        let spots: Vec<Spot> = stations.iter().map(spot).collect();
        write_places(output, &spots, &[], &frame.crs)?;
        return Ok(());
    }
    let places: Vec<[f64; 3]> = stations.iter().map(|station| frame.file_from_local(station.eye)).collect();
    let axis = |axis: usize| places.iter().map(|place| place[axis]).collect::<Vec<f64>>();
    let [x, y, z] = [0, 1, 2].map(axis);
    let whole = |value: &dyn Fn(&PlannedStation) -> Option<usize>| -> Vec<Option<u64>> {
        stations.iter().map(|station| value(station).map(|value| value as u64)).collect()
    };
    let real = |value: &dyn Fn(&PlannedStation) -> Option<f64>| -> Vec<f64> {
        stations.iter().map(|station| value(station).unwrap_or(f64::NAN)).collect()
    };
    let cells = [
        ("station", TableCells::Whole(&whole(&|station| station.order))),
        ("x", TableCells::Real(&x, 3)),
        ("y", TableCells::Real(&y, 3)),
        ("z", TableCells::Real(&z, 3)),
        ("settles_alone", TableCells::Whole(&whole(&|station| Some(station.alone.settled)))),
        ("settles_alone_percent", TableCells::Real(&real(&|station| Some(found.share(station.alone))), 2)),
        ("expected_alone", TableCells::Real(&real(&|station| Some(station.alone.expected)), 1)),
        ("proves_alone_m", TableCells::Real(&real(&|station| Some(station.alone.proven)), 1)),
        ("settled", TableCells::Whole(&whole(&|station| Some(station.together?.settled)))),
        ("expected", TableCells::Real(&real(&|station| Some(station.together?.expected)), 1)),
        ("settled_percent", TableCells::Real(&real(&|station| Some(found.share(station.together?))), 2)),
    ];
    Ok(write_table(output, &cells)?)
}

fn properties(station: &PlannedStation, found: &SurveyPlanResults) -> Map<String, Value> {
    let mut properties = Map::new();
    let mut add = |name: &str, value: Value| properties.insert(name.to_owned(), value);
    add("station", station.order.into());
    add("settles_alone", station.alone.settled.into());
    add("settles_alone_percent", found.share(station.alone).into());
    add("expected_alone", rounded(station.alone.expected, 1).into());
    add("proves_alone_m", rounded(station.alone.proven, 1).into());
    if let Some(together) = station.together {
        add("settled", together.settled.into());
        add("expected", rounded(together.expected, 1).into());
        add("settled_percent", found.share(together).into());
    }
    properties
}
