//! `belvedere cameras`.

mod camera_targets;
mod results;

use crate::arguments::{CamerasArguments, Global, refuse};
use crate::inputs::camera_places::{self, candidates_on_path};
use crate::inputs::observers::ObserverUse;
use crate::outputs::formats::{check_output, check_outputs, extension, warn_of_geojson};
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, CameraGoal, Candidates};
use belvedere::query::UnprovenAs;
use results::CameraOutput;
use std::path::PathBuf;

pub(crate) fn run(arguments: &CamerasArguments, global: &Global) -> Result<Summary> {
    check(arguments)?;
    let mut question = question(arguments)?;
    question.check()?;
    let mut run = CommandContext::new(global);
    let scene = pipeline::scene(&arguments.scene, KeepPoints::Keep, &mut run)?;
    let written: Vec<PathBuf> =
        arguments.output.iter().chain(&arguments.curve).chain(&arguments.footprints).cloned().collect();
    let frame = scene.cloud.frame.clone();
    warn_of_geojson(&written, &frame.crs, &mut run.summary);
    let scene = scene.into_question_scene(Some(&arguments.targets.ground), arguments.giving_way.shell, &run)?;
    let places = camera_targets::places(&arguments.targets, &frame, &mut question.targets, &mut run)?;
    if let Some(path) = &arguments.lens.private {
        question.targets.private = camera_targets::private(path, &frame, &mut run)?;
    }
    if let Some(path) = &arguments.existing {
        question.existing = candidates_on_path(path, Some(f64::INFINITY), ObserverUse::Limits, &frame, &mut run)?;
    }
    if let Some(path) = &arguments.candidates.file {
        let given = candidates_on_path(path, arguments.step, ObserverUse::Limits, &frame, &mut run)?;
        question.candidates = Candidates::Given(given);
    }
    let answers = run.ask(&scene, &question, &places)?;
    let shown = CameraOutput { found: &answers.found, scene: &scene };
    for output in &arguments.output {
        run.stage("writing", 0, |_| shown.write(output))?;
    }
    if let Some(output) = &arguments.curve {
        run.stage("writing", 0, |_| shown.write_curve(output))?;
    }
    if let Some(output) = &arguments.footprints {
        run.stage("writing", 0, |_| shown.write_footprints(output))?;
    }
    run.summary.add_paths("written", &written);
    Ok(run.finish())
}

/// The question, before files are read.
fn question(arguments: &CamerasArguments) -> Result<ask::CamerasQuestion> {
    let usual = ask::CamerasQuestion::default();
    let flags = &arguments.candidates;
    let candidates = match (flags.on_roofs, flags.on_ground) {
        (Some(cell), _) => Candidates::Roofs(cell),
        (None, Some(cell)) => Candidates::Ground(cell),
        (None, None) => Candidates::default(),
    };
    Ok(ask::CamerasQuestion {
        goal: match (arguments.goal.count, arguments.goal.coverage) {
            (_, Some(percent)) => CameraGoal::CoveragePercent(percent),
            (count, None) => CameraGoal::Count(count.unwrap_or(0)),
        },
        per_target: u32::try_from(arguments.required)?,
        search_limit: arguments.search_limit,
        candidates,
        camera_height: arguments.camera_height,
        lens: camera_places::lens(&arguments.lens),
        targets: ask::CameraTargets {
            height: arguments.targets.target_height.unwrap_or(usual.targets.height),
            ground: arguments.targets.ground.points(),
            ..usual.targets
        },
        north: arguments.north.choice(),
        earth: arguments.earth.params()?,
        frequency_ghz: arguments.radio.frequency,
        fresnel_percent: arguments.fresnel_percent,
        unproven: arguments.giving_way.unproven.map(UnprovenAs::from),
        certain: arguments.certain,
        ..usual
    })
}

fn check(arguments: &CamerasArguments) -> Result<()> {
    let are_cells = camera_targets::are_cells(&arguments.targets);
    for output in &arguments.output {
        check_output("-o", output, &["geojson", "gpkg", "tif", "tiff", "png", "csv"])?;
        let is_map = ["tif", "tiff", "png"].contains(&extension(output).as_str());
        if is_map && !are_cells {
            let output = output.display();
            return refuse(format!("{output}: rasters and maps need cells as targets; use .csv or .geojson"));
        }
    }
    check_outputs("--curve", &arguments.curve, &["csv"])?;
    if let Some(output) = &arguments.footprints {
        check_output("--footprints", output, &["geojson", "gpkg"])?;
        if !are_cells {
            return refuse("--footprints needs cells as targets");
        }
    }
    camera_targets::check(&arguments.targets, are_cells)
}
