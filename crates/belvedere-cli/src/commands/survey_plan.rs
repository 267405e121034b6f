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
use belvedere::apps::result_columns::ResultColumn;
use belvedere::io::{Spot, row_properties, write_places, write_table};
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
    let mut columns = gains(found, &stations);
    if ["geojson", "gpkg"].contains(&&*extension(output)) {
        let spot = |(row, station): (usize, &PlannedStation)| {
            let place = std::array::from_fn(|i| station.eye[i] + frame.origin[i]);
            let mut properties = row_properties(&columns, row);
            properties.retain(|name, value| name == "station" || !value.is_null());
            Spot { place, properties }
        };
        let spots: Vec<Spot> = stations.iter().enumerate().map(spot).collect();
        write_places(output, &spots, &[], &frame.crs)?;
        return Ok(());
    }
    let places: Vec<[f64; 3]> = stations.iter().map(|station| station.eye).collect();
    columns.splice(1..1, ResultColumn::coordinates(frame, &places));
    Ok(write_table(output, &columns)?)
}

/// Gains of stations; none together with others where a station was not chosen.
fn gains(found: &SurveyPlanResults, stations: &[PlannedStation]) -> Vec<ResultColumn> {
    let whole = |name: &str, value: &dyn Fn(&PlannedStation) -> Option<usize>| {
        ResultColumn::whole(name, stations.iter().map(value))
    };
    let real = |name: &str, value: &dyn Fn(&PlannedStation) -> Option<f64>, decimals| {
        ResultColumn::real(name, stations.iter().map(|station| value(station).unwrap_or(f64::NAN)), decimals)
    };
    vec![
        whole("station", &|station| station.order),
        whole("settles_alone", &|station| Some(station.alone.settled)),
        real("settles_alone_percent", &|station| Some(found.share(station.alone)), 2),
        real("expected_alone", &|station| Some(station.alone.expected), 1),
        real("proves_alone_m", &|station| Some(station.alone.proven), 1),
        whole("settled", &|station| Some(station.together?.settled)),
        real("expected", &|station| Some(station.together?.expected), 1),
        real("settled_percent", &|station| Some(found.share(station.together?)), 2),
    ]
}
