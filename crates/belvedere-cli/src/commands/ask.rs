//! `belvedere ask`: questions in JSON, and those of rasters.

use crate::arguments::{AreaOutputs, AskArguments, CloudInput, Global, SkyOutputs, refuse};
use crate::in_tiles::{TiledAnswers, TypedCells};
use crate::inputs::typed_places::on_map;
use crate::outputs::formats::{check_outputs, extension};
use crate::outputs::targets::{TargetOutput, TargetSource};
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Context, Result};
use belvedere::apps::ask::{
    Answers, Found, GivenPlaces, GridCells, PlacedQuestion, Question, Scene, end_on_map, position_on_map,
};
use belvedere::apps::isovist::IsovistParams;
use belvedere::apps::result_columns::{ResultColumn, ResultValues};
use belvedere::io::read_weather;
use belvedere::report::rounded;
use belvedere::results::{question_of_raster, read_question};
use serde_json::{Map, Value, json};
use std::path::Path;
use std::sync::Arc;

pub(crate) fn run(arguments: &AskArguments, global: &Global) -> Result<Summary> {
    let mut run = CommandContext::new(global);
    let placed = question(&arguments.question, &run)?;
    check(&placed, arguments)?;
    let places = places_in_file_coordinates(&placed.places, &arguments.scene.input)?;
    let cells = typed_cells(&placed, arguments);
    let write = |tiled: &TiledAnswers, run: &mut CommandContext| {
        tiled.shown().write(&outputs(arguments), &tiled.answers.measures, run)
    };
    let is_of_cells = matches!(placed.places, GivenPlaces::Cells(_));
    if is_of_cells && cells.answered(placed.question.clone(), write, &mut run)? {
        return Ok(run.finish());
    }
    let part = reach(&placed, arguments).filter(|_| !places.is_empty()).map(|distance| (&places[..], distance));
    let whole = |run: &mut CommandContext| {
        let mut scene = pipeline::scene_in_reach(&arguments.scene, part, KeepPoints::Keep, run)?;
        arguments.far.set(&mut scene, run)?;
        scene.into_question_scene(None, arguments.shell.shell, run)
    };
    let of_places = cells.scene(placed.question.clone(), whole, &mut run)?;
    let scene = of_places.scene();
    let answers = placed.ask(scene, &run.control())?;
    of_places.finish(&run)?;
    run.name_question(&placed.question, &placed.places.of_scene(scene)?, answers.time_zone());
    run.answered(&answers);
    add_values(&placed, &answers, scene, &mut run.summary);
    if let Some(on) = answers.found.on_targets().filter(|_| !arguments.output.is_empty()) {
        let source = match placed.places {
            GivenPlaces::Cells(_) => TargetSource::Cells,
            _ => TargetSource::Single,
        };
        TargetOutput::new(on, source, scene).write(&outputs(arguments), &answers.measures, &mut run)?;
    }
    Ok(run.finish())
}

/// The question of a file, of standard input or of a raster, with its weather.
fn question(path: &Path, run: &CommandContext) -> Result<PlacedQuestion> {
    let is_raster = ["tif", "tiff"].contains(&extension(path).as_str());
    let mut placed = if is_raster {
        question_of_raster(path)?
    } else {
        match path == Path::new("-") {
            true => {
                let text = std::io::read_to_string(std::io::stdin().lock()).context("standard input")?;
                read_question(&text, Path::new("standard input"))?
            }
            false => read_question(&std::fs::read_to_string(path).map_err(belvedere::Error::io(path))?, path)?,
        }
    };
    let (name, command) = (path.display(), placed.question.command());
    if let Some(what) = placed.question.beyond_json() {
        return refuse(format!("{name}: JSON holds no {what}: use `belvedere {command}`"));
    }
    let is_of_observers = matches!(placed.question, Question::Viewshed(_));
    if is_raster && is_of_observers {
        return refuse(format!("{name}: the raster does not say who looks: use `belvedere {command}`, or write JSON"));
    }
    if let Some((file, weather)) = placed.question.weather_mut() {
        if is_raster {
            let what = format!("of the weather {file} the raster has the name alone");
            return refuse(format!("{name}: {what}: use `belvedere {command}`, or write JSON with its path"));
        }
        if file.is_empty() {
            return refuse(format!("{name}: the question lacks the file of its weather: give its path as file"));
        }
        *weather = Some(Arc::new(run.stage("reading weather", 0, |_| read_weather(Path::new(file)))?));
    }
    Ok(placed)
}

/// Refuses what cannot be, before hours of work go into a scene.
fn check(placed: &PlacedQuestion, arguments: &AskArguments) -> Result<()> {
    placed.check()?;
    let Some(output) = arguments.output.first() else { return Ok(()) };
    let (output, command) = (output.display(), placed.question.command());
    if !placed.question.has_values_of_targets() {
        let what = "ask writes values of targets, and this question has none";
        return refuse(format!("-o {output}: {what}: `belvedere {command}` writes its results; --json prints them"));
    }
    let known: &[&str] = match placed.places {
        GivenPlaces::Cells(_) => &["tif", "tiff", "png", "laz", "las", "ply", "csv"],
        GivenPlaces::At(_) | GivenPlaces::Points(_) => &["laz", "las", "ply", "csv"],
        _ => return refuse(format!("-o {output}: the question has no targets: give cells, places or points")),
    };
    check_outputs("-o", &arguments.output, known)
}

/// Returns the places that are given one by one, as far as headers tell in coordinates of the file.
fn places_in_file_coordinates(places: &GivenPlaces, input: &CloudInput) -> Result<Vec<[f64; 2]>> {
    let given = places.on_map();
    let map = if given.is_empty() { None } else { on_map(input)? };
    let position = |place: [f64; 2]| match &map {
        Some((crs, bounds)) if matches!(places, GivenPlaces::At(_)) => position_on_map(place, crs, *bounds),
        Some((crs, bounds)) => end_on_map(place, crs, *bounds),
        None => Ok(place),
    };
    given.into_iter().map(|place| Ok(position(place)?)).collect()
}

/// Returns the distance from its places within which the question needs the scene, metres; `None` for any distance.
fn reach(placed: &PlacedQuestion, arguments: &AskArguments) -> Option<f64> {
    let distance = match &placed.question {
        Question::LineOfSight(_) => Some(0.0),
        Question::Isovist(question) => Some(question.max_distance.unwrap_or(IsovistParams::default().max_range)),
        Question::Viewshed(question) => question.limits.max_distance,
        _ => None,
    };
    distance.filter(|_| arguments.far.terrain.is_none())
}

/// Collects what tiles need of a question.
fn typed_cells<'a>(placed: &PlacedQuestion, arguments: &'a AskArguments) -> TypedCells<'a> {
    let trees = match &placed.question {
        Question::Shadow(question) => Some(question.trees),
        Question::SunHours(question) => Some(question.trees),
        Question::SkyView(question) => Some(question.trees),
        Question::Irradiance(question) => Some(question.trees),
        _ => None,
    };
    let (cells, has_area) = match &placed.places {
        GivenPlaces::Cells(places) => (places.without_area(), !places.within.is_empty()),
        _ => (GridCells::default(), false),
    };
    let are_places = matches!(placed.places, GivenPlaces::At(_) | GivenPlaces::Points(_));
    TypedCells {
        scene: &arguments.scene,
        tiles: &arguments.tiles,
        cells,
        far: Some(&arguments.far),
        trees,
        output: &arguments.output,
        others: vec![
            ("--shell", arguments.shell.shell.is_some()),
            ("within", has_area),
            ("a question of observers", trees.is_none()),
        ],
        of_points: vec![("places", are_places)],
    }
}

fn outputs(arguments: &AskArguments) -> SkyOutputs {
    let by_area = AreaOutputs { areas: None, by_area: None };
    SkyOutputs { output: arguments.output.clone(), measures: None, by_area }
}

/// Adds the values of single places and points to the statistics of measures, and the table of other results.
fn add_values(placed: &PlacedQuestion, answers: &Answers<Found>, scene: &Scene, summary: &mut Summary) {
    if matches!(placed.places, GivenPlaces::At(_) | GivenPlaces::Points(_)) && !answers.measures.is_empty() {
        let mut section = Summary::of(&answers.report.measures).into_entries();
        for measure in &answers.measures {
            let values = section.entry(measure.name.clone()).or_insert(Value::Null);
            let mut entries = values.as_object().cloned().unwrap_or_default();
            entries.insert("description".to_owned(), measure.description.into());
            entries.insert("unit".to_owned(), measure.unit.into());
            if !measure.subject.is_empty() {
                entries.insert("subject".to_owned(), measure.subject.clone().into());
            }
            entries.insert("values".to_owned(), in_json(&measure.to_column()));
            *values = entries.into();
        }
        summary.add("measures", section);
    }
    let columns = answers.found.columns(scene);
    if !columns.is_empty() {
        let columns = columns.iter().map(|column| (column.name.clone(), in_json(column)));
        summary.add("columns", columns.collect::<Map<String, Value>>());
    }
}

/// The values of a column, null where there is none.
fn in_json(column: &ResultColumn) -> Value {
    let digits = |decimals: usize| i32::try_from(decimals).unwrap_or(i32::MAX);
    let number = |value: f64, decimals| value.is_finite().then(|| rounded(value, digits(decimals)));
    match &column.values {
        ResultValues::Real(values, decimals) => values.iter().map(|&value| number(value, *decimals)).collect(),
        ResultValues::Clock(values) => values.iter().map(|&value| number(value, 4)).collect(),
        ResultValues::Whole(values) => json!(values),
        ResultValues::Words(words) => json!(words),
    }
}
