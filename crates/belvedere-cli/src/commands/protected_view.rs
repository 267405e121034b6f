//! `belvedere protected-view`.

use crate::arguments::{Global, ProtectedViewArguments};
use crate::inputs::landmark_shape;
use crate::outputs::formats::{check_outputs, extension};
use crate::outputs::heights::write_heights;
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, GridCells, Places, ProtectedViewResults, Scene, SharedObject};
use belvedere::figures::{MapLegend, MapMark, MapPicture, map_picture, ramp, write_png};
use belvedere::ground::highest_points;
use belvedere::query::UnprovenAs;
use belvedere::results::georeference;
use std::path::Path;

/// Colour of cells that no protected view crosses.
const NO_LIMIT_COLOR: [u8; 3] = [226; 3];

pub(crate) fn run(arguments: &ProtectedViewArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["tif", "tiff", "npy", "png"])?;
    check_outputs("--tops", &arguments.tops, &["tif", "tiff", "npy"])?;
    let usual = ask::ProtectedViewQuestion::default();
    let mut question = ask::ProtectedViewQuestion {
        observer_height: arguments.eyes.height.unwrap_or(usual.observer_height),
        max_distance: arguments.max_distance,
        unproven: arguments.giving_way.unproven.map(UnprovenAs::from),
        ..usual
    };
    question.check()?;
    let mut run = CommandContext::new(global);
    let scene = pipeline::scene(&arguments.scene, KeepPoints::Keep, &mut run)?;
    question.landmark = Some(SharedObject::new(landmark_shape::surface(&arguments.shape, &scene, &mut run)?.0));
    question.observers = arguments.eyes.standing((&scene.cloud.frame, &scene.model.bounds()), &mut run)?;
    let ground = &arguments.eyes.ground;
    let scene = scene.into_question_scene(Some(ground), arguments.giving_way.shell, &run)?;
    let places = Places::Cells(GridCells { cell: arguments.cell, ground: ground.points(), ..GridCells::default() });
    let answers = run.ask(&scene, &question, &places)?;
    let found = &answers.found;
    let place = (&found.ground.ground.grid, scene.frame());
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "png" => write_map(output, found, &scene),
            _ => write_heights(output, &found.heights, place, "maximum height above the ground", &run.tags),
        })?;
    }
    if let Some(output) = &arguments.tops {
        run.stage("writing", 0, |_| write_heights(output, &found.tops, place, "maximum height", &run.tags))?;
    }
    run.summary.add_paths("written", arguments.output.iter().chain(&arguments.tops));
    Ok(run.finish())
}

fn write_map(output: &Path, found: &ProtectedViewResults, scene: &Scene) -> Result<()> {
    let ground = &found.ground.ground;
    let relief = highest_points(&scene.ground_cloud()?.positions, ground);
    let heights = found.heights.values();
    let max = heights.iter().copied().filter(|v| v.is_finite()).fold(0.0, f32::max).max(1.0);
    // where no ground is known there is no answer; elsewhere a cell without a limit is one that no view crosses
    let color = |(&height, &ground): (&f32, &f32)| match height.is_finite() {
        true => Some(ramp(f64::from(height / max))),
        false => ground.is_finite().then_some(NO_LIMIT_COLOR),
    };
    let colors: Vec<Option<[u8; 3]>> = heights.iter().zip(ground.heights.values()).map(color).collect();
    let mark = |eye: &[f64; 3]| {
        let place = ground.grid.cell_position([eye[0], eye[1]])?;
        Some(MapMark { place, ..MapMark::default() })
    };
    let marks: Vec<MapMark> = found.eyes.eyes.iter().filter_map(mark).collect();
    let map = MapPicture {
        relief: &relief,
        cell: ground.grid.cell,
        place: Some(&georeference(&ground.grid, scene.frame())),
        colors: &colors,
        marks: &marks,
        mark_name: "observer",
        title: "Maximum height below the protected views",
        legend: MapLegend::Ramp("metres above the ground", [0.0, f64::from(max)], &[(NO_LIMIT_COLOR, "no limit")]),
    };
    Ok(write_png(output, &map_picture(&map)?)?)
}
