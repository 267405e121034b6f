//! `belvedere landmark`.

mod results;

use crate::arguments::{Global, LandmarkArguments, refuse};
use crate::inputs::landmark_shape;
use crate::inputs::observers::{rows_as_given, standing_rows};
use crate::outputs::formats::{check_output, extension};
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{self, LandmarkShape, Places};
use belvedere::control::Control;
use belvedere::query::{BackFaces, UnprovenAs};

pub(crate) fn run(arguments: &LandmarkArguments, global: &Global) -> Result<Summary> {
    check_formats(arguments)?;
    // refused before a scene is read
    arguments.earth.params()?;
    let mut run = CommandContext::new(global);
    let scene = pipeline::scene(&arguments.scene, KeepPoints::Keep, &mut run)?;
    let scene = scene.into_question_scene(Some(&arguments.ground), arguments.giving_way.shell, &run)?;
    let shape = landmark_shape::shape(&arguments.shape, scene.frame(), &mut run)?;
    let question = question(arguments, shape, scene.frame(), &mut run)?;
    let answers = run.ask(&scene, &question, &Places::Scene)?;
    let found = &answers.found;
    let (views, ground, cloud) = (&found.views[..], &found.ground.ground, scene.ground_cloud()?);
    let given = rows_as_given(arguments.observers.as_deref())?;
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "csv" => results::write_rows(output, views, &found.places, &given, cloud),
            "png" => results::write_map(output, views, ground, cloud, found.middle),
            _ => results::write_share(output, views, ground, cloud, &run.tags),
        })?;
    }
    let mut written: Vec<String> = arguments.output.iter().map(|path| path.display().to_string()).collect();
    if let Some(folder) = &arguments.measures {
        let of_measures = |_: &Control<'_>| results::write_measures(folder, views, ground, cloud, &run.tags);
        written.extend(run.stage("writing", 0, of_measures)?);
    }
    run.summary.add("written", written);
    Ok(run.finish())
}

fn question(
    arguments: &LandmarkArguments,
    shape: LandmarkShape,
    frame: &Frame,
    run: &mut CommandContext,
) -> Result<ask::LandmarkQuestion> {
    Ok(ask::LandmarkQuestion {
        shape,
        observers: arguments.observers.as_ref().map(|path| standing_rows(path, frame, run)).transpose()?,
        observer_height: arguments.observer_height,
        cell: arguments.cell,
        ground: arguments.ground.points(),
        max_distance: arguments.max_distance,
        back_faces: arguments.back_faces.map_or_else(BackFaces::default, BackFaces::from),
        earth: arguments.earth.params()?,
        unproven: arguments.giving_way.unproven.map(UnprovenAs::from),
        probability: arguments.probability,
    })
}

fn check_formats(arguments: &LandmarkArguments) -> Result<()> {
    for output in &arguments.output {
        check_output("-o", output, &["csv", "tif", "tiff", "png"])?;
        if arguments.observers.is_some() && extension(output) != "csv" {
            let output = output.display();
            return refuse(format!("{output}: rasters and maps need a grid of observers; with --observers use .csv"));
        }
    }
    Ok(())
}
