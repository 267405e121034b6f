//! `belvedere sun-position`.

use crate::arguments::{Global, SunPositionArguments};
use crate::outputs::formats::check_outputs;
use crate::outputs::text::write_lines;
use crate::pipeline;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, Places};
use belvedere::model::{ModelParts, SceneModel};
use belvedere::{Bounds, PointCloud};
use std::sync::Arc;

pub(crate) fn run(arguments: &SunPositionArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["csv"])?;
    let place = arguments.sun.place_from_true_north()?;
    let question = ask::SunPositionQuestion { times: arguments.times.clone(), place };
    question.check()?;
    let mut run = CommandContext::new(global);
    let (cloud, bounds) = if arguments.input.clouds.is_empty() {
        (PointCloud::default(), Bounds { low: [0.0; 3], high: [1.0; 3] })
    } else {
        let cloud = pipeline::read(&arguments.input, &mut run)?;
        let bounds = pipeline::bounds_of(&cloud)?;
        (cloud, bounds)
    };
    let parts = ModelParts { frame: cloud.frame.clone(), bounds, ..ModelParts::default() };
    let scene = ask::Scene::new(SceneModel::from_parts(parts)?, Arc::new(cloud));
    let answers = run.ask(&scene, &question, &Places::Scene)?;
    if let Some(output) = &arguments.output {
        let rows =
            answers.found.iter().map(|sun| format!("{},{:.4},{:.4}", sun.time, sun.azimuth_deg, sun.elevation_deg));
        let lines = std::iter::once("time,azimuth_deg,elevation_deg".to_owned()).chain(rows);
        run.stage("writing", 0, |_| write_lines(output, lines))?;
        run.summary.add("written", output.display().to_string());
    }
    Ok(run.finish())
}
