//! `belvedere window-views`.

mod results;

use crate::arguments::{Global, WindowViewsArguments, refuse};
use crate::inputs::points::points_of_file;
use crate::inputs::windows::{FaceChoice, WindowFile};
use crate::outputs::formats::{check_outputs, extension, warn_of_geojson};
use crate::pipeline::{self, KeepPoints, LoadedScene};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::Error;
use belvedere::apps::ask::{self, Ask, Places};
use belvedere::apps::window_views::{SeenKind, are_made_from};
use belvedere::io::ReadOptions;
use belvedere::query::UnprovenAs;
use results::WindowOutput;
use std::sync::Arc;

pub(crate) fn run(arguments: &WindowViewsArguments, global: &Global) -> Result<Summary> {
    check(arguments)?;
    let usual = ask::WindowViewsQuestion::default();
    let mut question = ask::WindowViewsQuestion {
        north: arguments.north.choice(),
        spacing: arguments.spacing.unwrap_or(usual.spacing),
        seed: global.seed,
        directions: arguments.directions.unwrap_or(usual.directions),
        classes: arguments.classes.iter().map(|meaning| (meaning.0, meaning.1)).collect(),
        unproven: arguments.giving_way.unproven.map(UnprovenAs::from),
        ..usual
    };
    question.check()?;
    let mut run = CommandContext::new(global);
    let mut scene = pipeline::scene(&arguments.scene, KeepPoints::Keep, &mut run)?;
    arguments.far.set(&mut scene, &mut run)?;
    take_classes(arguments, &mut scene, &mut run)?;
    if scene.cloud.is_empty() && arguments.output.iter().any(|output| extension(output) == "png") {
        bail!("a map (.png) needs points, and a ball file has none; give --classes-of");
    }
    warn_of_geojson(&arguments.output, &scene.cloud.frame.crs, &mut run.summary);
    let choice = FaceChoice { spacing: arguments.spacing, objects: &arguments.object };
    let file = WindowFile::read(&arguments.windows, &choice, &scene.cloud.frame, &mut run)?;
    if arguments.buildings.is_some() && !file.names_buildings() {
        let path = arguments.windows.display();
        bail!("--buildings: {path} does not name buildings; a table needs the column name, a mesh named objects");
    }
    question.windows = file.given.clone();
    let scene = scene.into_question_scene(None, arguments.giving_way.shell, &run)?;
    let answers = ask::ask(&scene, &question, &Places::Scene, &run.control()).map_err(|error| match error {
        Error::NoObserver { .. } => anyhow::Error::from(error).context(arguments.windows.display().to_string()),
        other => other.into(),
    })?;
    run.answered(&answers);
    let shown = WindowOutput {
        scene: &scene,
        columns: file.columns(&answers.found.windows, scene.frame(), answers.found.grid_north),
        names: file.buildings(&answers.found.names),
        found: &answers.found,
        measures: &answers.measures,
        rows: &file.rows,
    };
    for output in &arguments.output {
        if extension(output) == "png" {
            let seen = arguments.map_of.unwrap_or(SeenKind::Vegetation);
            let title = arguments.far.titled(&format!("View from windows: {}", seen.name()));
            shown.write_map(output, &title, seen, &mut run)?;
        } else {
            let report = run.stage("writing", 0, |_| shown.write(output))?;
            run.summary.add_writing(output, &report);
        }
    }
    if let Some(output) = &arguments.buildings {
        run.stage("writing", 0, |_| shown.write_buildings(output))?;
    }
    run.summary.add_paths("written", arguments.output.iter().chain(&arguments.buildings));
    Ok(run.finish())
}

fn check(arguments: &WindowViewsArguments) -> Result<()> {
    check_outputs("-o", &arguments.output, &["csv", "geojson", "gpkg", "laz", "las", "ply", "png"])?;
    check_outputs("--buildings", &arguments.buildings, &["csv"])?;
    if arguments.map_of.is_some() && !arguments.output.iter().any(|output| extension(output) == "png") {
        return refuse("--map-of needs a map: -o FILE.png");
    }
    Ok(())
}

/// Gives the scene of a ball file the cloud that its balls were built from.
fn take_classes(arguments: &WindowViewsArguments, scene: &mut LoadedScene, run: &mut CommandContext) -> Result<()> {
    let Some(path) = &arguments.classes_of else { return Ok(()) };
    if !scene.cloud.is_empty() {
        return refuse("--classes-of is for ball files; the cloud of this scene has its own classes");
    }
    let frame = &scene.cloud.frame;
    let cloud = run.aside(|run| points_of_file(path, &ReadOptions::new(), frame, run)).0?;
    if !are_made_from(scene.model.balls(), &cloud.positions) {
        bail!("--classes-of {}: the balls were not built from this cloud", path.display());
    }
    scene.cloud = Arc::new(cloud);
    Ok(())
}
