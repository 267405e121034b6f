//! `belvedere isovist`.

use crate::arguments::{Global, IsovistArguments, refuse};
use crate::inputs::observers::rows_as_given;
use crate::outputs::formats::{check_outputs, extension};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, IsovistsResults, Places, Scene};
use belvedere::apps::isovist::IsovistParams;
use belvedere::apps::result_columns::ResultColumn;
use belvedere::figures::{panorama_picture, write_png};
use belvedere::io::{TextRows, atomic, with_columns_read, write_table};
use serde_json::{Map, Value, json};
use std::io::Write;
use std::path::Path;

pub(crate) fn run(arguments: &IsovistArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["csv", "json", "png"])?;
    let question = ask::IsovistsQuestion {
        observer_height: arguments.eyes.height,
        ground: arguments.eyes.ground.points(),
        north: arguments.north.choice(),
        max_distance: arguments.max_distance,
        angle_step_deg: arguments.step,
        min_jump: arguments.jump,
        interval: arguments.interval.interval,
    };
    question.check()?;
    check_pictures(arguments, arguments.eyes.min_count()?)?;
    let mut run = CommandContext::new(global);
    let usual = IsovistParams::default().max_range;
    let is_typed = arguments.eyes.eyes.is_none();
    let distance = is_typed.then(|| arguments.max_distance.unwrap_or(usual));
    let places: Vec<[f64; 2]> = arguments.eyes.eye.iter().map(|place| place.0).collect();
    let part = distance.map(|distance| (&places[..], distance));
    let scene = arguments.eyes.scene(&arguments.scene, part, None, &mut run)?;
    let standing = arguments.eyes.standing((scene.frame(), &scene.model().bounds()), &mut run)?;
    check_pictures(arguments, standing.len())?;
    let answers = run.ask(&scene, &question, &Places::Eyes(standing))?;
    let found = &answers.found;
    let columns = columns(found, &scene);
    let given = rows_as_given(arguments.eyes.eyes.as_deref())?;
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "json" => write_json(output, &columns, found),
            "png" => {
                let Some(Some(isovist)) = found.isovists.first() else { return Ok(()) };
                write_png(output, &panorama_picture(&isovist.panorama, "Ranges around the observer"))
            }
            _ => write_rows(output, &columns, &given),
        })?;
    }
    run.summary.add_paths("written", &arguments.output);
    Ok(run.finish())
}

/// Refuses pictures of several observers.
fn check_pictures(arguments: &IsovistArguments, count: usize) -> Result<()> {
    match arguments.output.iter().find(|output| count > 1 && extension(output) == "png") {
        Some(output) => {
            let output = output.display();
            refuse(format!("{output}: a picture shows a single observer, but there are {count}"))
        }
        None => Ok(()),
    }
}

/// Returns the columns of isovists: the position of each eye, in the coordinates of the file, and the measures.
fn columns(found: &IsovistsResults, scene: &Scene) -> Vec<ResultColumn> {
    ResultColumn::coordinates(scene.frame(), &found.eyes.places).into_iter().chain(found.columns()).collect()
}

/// A row for each observer, with what a table said of it.
fn write_rows(output: &Path, columns: &[ResultColumn], given: &TextRows) -> belvedere::Result<()> {
    let read = given.columns(0..given.row_count());
    write_table(output, &with_columns_read(&read, &["x", "y", "z"], columns.to_vec()))
}

fn write_json(output: &Path, columns: &[ResultColumn], found: &IsovistsResults) -> belvedere::Result<()> {
    let object = |(row, isovist): (usize, &Option<belvedere::apps::isovist::Isovist>)| {
        let value = |column: &ResultColumn| (column.name.clone(), json!(column.numbers().get(row)));
        let mut object: Map<String, Value> = columns.iter().map(value).collect();
        let corners = isovist.iter().flat_map(|isovist| &isovist.plan.corners);
        let corners: Vec<Value> = corners
            .map(|[azimuth, range]| json!([(azimuth + found.grid_north).to_degrees().rem_euclid(360.0), range]))
            .collect();
        object.insert("plan_corners_azimuth_deg_range_m".to_owned(), corners.into());
        Value::Object(object)
    };
    let all: Vec<Value> = found.isovists.iter().enumerate().map(object).collect();
    atomic::write(output, |file| writeln!(file, "{}", json!({ "isovists": all })).map_err(belvedere::Error::io(output)))
}
