//! `belvedere viewshed`.

mod results;
mod viewshed_observers;

use crate::arguments::{Global, GroundChoice, ViewshedArguments};
use crate::in_tiles::{TiledAnswers, TypedCells};
use crate::inputs::far_terrain::set_terrain;
use crate::outputs::formats::{check_output, check_outputs, extension, warn_of_geojson};
use crate::outputs::heights::write_heights;
use crate::outputs::targets::HighestPoints;
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Answers, Ask, Places, Scene, UNCERTAIN, ViewshedResults, ViewshedTargets};
use belvedere::apps::viewshed::answers_of_bands;
use belvedere::cast::{to_index, to_row};
use belvedere::figures::Picture;
use belvedere::query::UnprovenAs;
use belvedere::results::UNPROVEN_BAND;
use belvedere_tiles::{Plan, SurveyCells};
use results::{CellSurface, SeenCells, SeenMap, on_points, write_masks};
use std::path::{Path, PathBuf};

/// Outputs that hold points rather than cells.
const OF_POINTS: [&str; 4] = ["laz", "las", "ply", "csv"];
/// Description of the raster of --heights.
const VISIBLE_HEIGHTS: &str = "minimum visible height above the ground in metres; -9999: none, or nodata";

pub(crate) fn run(arguments: &ViewshedArguments, global: &Global) -> Result<Summary> {
    check_formats(arguments)?;
    viewshed_observers::check(arguments)?;
    let mut question = question(arguments)?;
    question.check()?;
    let mut run = CommandContext::new(global);
    if in_tiles(arguments, &question, &mut run)? {
        return Ok(run.finish());
    }
    let places: Vec<[f64; 2]> =
        arguments.who.observer.iter().chain(&arguments.who.target).map(|place| place.0).collect();
    let part = reach(arguments).map(|distance| (&places[..], distance));
    let mut scene = pipeline::scene_in_reach(&arguments.scene, part, KeepPoints::Keep, &mut run)?;
    if let Some(path) = &arguments.terrain {
        set_terrain(path, &mut scene, &mut run)?;
    }
    let scene = scene.into_question_scene(Some(&arguments.ground), arguments.giving_way.shell, &run)?;
    let areas: Vec<PathBuf> = arguments.output.iter().chain(&arguments.far_output).cloned().collect();
    warn_of_geojson(&areas, &scene.frame().crs, &mut run.summary);
    question.observers = match arguments.who.spread {
        Some(count) => question.spread_observers(&scene, count, &run.control())?,
        None => viewshed_observers::observers(arguments, (scene.frame(), &scene.model().bounds()), &mut run)?,
    };
    let answers = run.ask(&scene, &question, &Places::Scene)?;
    write(arguments, &answers.found, &scene, &mut run)?;
    let written =
        arguments.output.iter().chain(&arguments.far_output).chain(&arguments.heights).chain(&arguments.masks);
    run.summary.add_paths("written", written);
    Ok(run.finish())
}

fn question(arguments: &ViewshedArguments) -> Result<ask::ViewshedQuestion> {
    let looking = &arguments.looking;
    let mut targets = Vec::new();
    if arguments.output.iter().any(|path| !is_of_points(path)) || arguments.tiles.plan.is_some() {
        targets.push(ViewshedTargets::Cells);
    }
    if arguments.output.iter().any(|path| is_of_points(path)) {
        targets.push(ViewshedTargets::Points);
    }
    if !arguments.far_output.is_empty() {
        targets.push(ViewshedTargets::FarTerrain);
    }
    Ok(ask::ViewshedQuestion {
        // they need the frame of the scene
        observers: Vec::new(),
        reverse: arguments.who.target.is_some(),
        observer_height: looking.observer_height,
        target_height: looking.target_height,
        limits: viewshed_observers::limits(arguments),
        north: looking.north.choice(),
        earth: arguments.earth.params()?,
        unproven: arguments.giving_way.unproven.map(UnprovenAs::from),
        how_sure: arguments.how_sure.choice(),
        cell: arguments.cell,
        ground: arguments.ground.points(),
        targets,
        masks: arguments.masks.is_some(),
        max_height: arguments.heights.as_ref().map(|_| arguments.ceiling),
    })
}

/// Returns the maximum range of typed observers; `None` without a limit, or if only the scene gives it.
fn reach(arguments: &ViewshedArguments) -> Option<f64> {
    let who = &arguments.who;
    let is_bounded = who.observers.is_none() && who.spread.is_none() && arguments.terrain.is_none();
    arguments.looking.max_distance.filter(|_| is_bounded)
}

/// Answers in tiles what one model has no memory for, unless a part of the survey is enough; `false` where it was not.
fn in_tiles(arguments: &ViewshedArguments, question: &ask::ViewshedQuestion, run: &mut CommandContext) -> Result<bool> {
    if reach(arguments).is_some() && arguments.tiles.plan.is_none() {
        return Ok(false);
    }
    let cells = TypedCells {
        scene: &arguments.scene,
        tiles: &arguments.tiles,
        cells: question.grid_cells(),
        far: None,
        trees: None,
        output: &arguments.output,
        others: vec![
            ("--spread", arguments.who.spread.is_some()),
            ("--terrain", arguments.terrain.is_some()),
            ("--ground cloud=FILE", matches!(arguments.ground, GroundChoice::Cloud(_))),
            ("--shell", arguments.giving_way.shell.is_some()),
        ],
        of_points: Vec::new(),
    };
    let complete = |plan: &Plan, run: &mut CommandContext| {
        let observers = viewshed_observers::observers(arguments, (&plan.frame()?, &plan.bounds()), run)?;
        Ok(ask::ViewshedQuestion { observers, ..question.clone() }.into())
    };
    let is_reverse = arguments.who.target.is_some();
    let write = |tiled: &TiledAnswers, run: &mut CommandContext| {
        let map = |relief: &HighestPoints| map_of_survey(&tiled.answers, relief, is_reverse);
        let written = tiled.shown().write_files(&arguments.output, &tiled.answers.measures, &map, run)?;
        run.summary.add("written", written);
        Ok(())
    };
    cells.completed(&question.clone().into(), complete, write, run)
}

/// A map of what is seen of the cells of a survey.
fn map_of_survey(
    answers: &Answers<SurveyCells>,
    relief: &HighestPoints,
    is_reverse: bool,
) -> belvedere::Result<Picture> {
    let SurveyCells { grid, eyes, .. } = &answers.found;
    let band = |name: &str| answers.measures.iter().find(|band| band.name == name).map(|band| &band.values[..]);
    let unproven = band(UNPROVEN_BAND).unwrap_or_default();
    let count = |(cell, &free): (usize, &f32)| to_row(to_index(f64::from(free - unproven.get(cell).unwrap_or(&0.0))));
    let counts: Vec<u32> = answers.measures[0].values.iter().enumerate().map(count).collect();
    let map = SeenMap {
        answers: &answers_of_bands(&answers.measures[..answers.measures.len().min(2)]),
        counts: &counts,
        uncertain: band(UNCERTAIN).filter(|_| eyes.len() == 1),
        eyes,
        is_of_one: eyes.len() == 1,
        is_reverse,
    };
    map.draw(relief.heights.clone(), grid, relief.place.clone())
}

fn is_of_points(path: &Path) -> bool {
    OF_POINTS.contains(&extension(path).as_str())
}

fn check_formats(arguments: &ViewshedArguments) -> Result<()> {
    check_outputs("-o", &arguments.output, &["tif", "tiff", "png", "geojson", "gpkg", "laz", "las", "ply", "csv"])?;
    for output in &arguments.far_output {
        check_output("--far-output", output, &["tif", "tiff", "png", "geojson", "gpkg"])?;
    }
    check_outputs("--heights", &arguments.heights, &["tif", "tiff", "npy"])?;
    if let Some(output) = &arguments.masks {
        check_output("--masks", output, &["tif", "tiff", "npy"])?;
    }
    Ok(())
}

fn write(
    arguments: &ViewshedArguments,
    found: &ViewshedResults,
    scene: &Scene,
    run: &mut CommandContext,
) -> Result<()> {
    let (ground, cloud, frame) = (&found.ground.ground, scene.ground_cloud()?, scene.frame());
    let (eyes, is_reverse) = (&found.eyes[..], found.reverse);
    if let Some(seen) = &found.cells {
        let sure = &found.cells_sure;
        let cells = SeenCells { seen, sure, eyes, frame, on: CellSurface::Ground(ground, cloud), is_reverse };
        for output in arguments.output.iter().filter(|path| !is_of_points(path)) {
            run.stage("writing", 0, |_| cells.write(output, &run.tags))?;
        }
        if let Some(output) = &arguments.masks {
            run.stage("writing", 0, |_| write_masks(output, seen, ground, cloud))?;
        }
    }
    if let Some(seen) = &found.points {
        for output in arguments.output.iter().filter(|path| is_of_points(path)) {
            let report = run.stage("writing", 0, |_| on_points(output, seen, &found.points_sure, cloud))?;
            run.summary.add_writing(output, &report);
        }
    }
    if let Some(far) = &found.far {
        let on = CellSurface::Terrain(&far.terrain);
        let cells = SeenCells { seen: &far.seen, sure: &[], eyes, frame, on, is_reverse };
        for output in &arguments.far_output {
            run.stage("writing", 0, |_| cells.write(output, &run.tags))?;
        }
    }
    if let (Some(output), Some(heights)) = (&arguments.heights, &found.heights) {
        run.stage("writing", 0, |_| write_heights(output, heights, (&ground.grid, frame), VISIBLE_HEIGHTS, &run.tags))?;
    }
    Ok(())
}
