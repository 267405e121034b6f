//! `belvedere calibrate`.

use crate::arguments::{CalibrateArguments, CloudInput, Global, MethodChoice, refuse};
use crate::outputs::balls::with_program;
use crate::outputs::formats::{check_outputs, extension};
use crate::outputs::text::write_text;
use crate::pipeline::{self, is_file, params};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Error;
use belvedere::apps::ask;
use belvedere::apps::survey_reliability::{ReliabilityParams, SurveyReliability};
use belvedere::io::{is_ball_file, write_balls};
use std::borrow::Cow;
use std::path::Path;

pub(crate) fn run(arguments: &CalibrateArguments, global: &Global) -> Result<Summary> {
    let CalibrateArguments { share, output, input, .. } = arguments;
    check_outputs("-o", output, &["json", "npz"])?;
    let reliability = ReliabilityParams { share: *share, seed: global.seed };
    reliability.check()?;
    refuse_balls(input)?;
    let parameters = arguments.balls.parameters()?;
    let balls = parameters.balls(MethodChoice::Carved)?;
    let mut run = CommandContext::new(global);
    let cloud = pipeline::read(input, &mut run)?;
    let model = params::model(&parameters, balls, &cloud.frame.crs, &mut run)?;
    let answers =
        ask::calibrate(&cloud, &model, &reliability, &run.control()).map_err(|error| name_clouds(input, error))?;
    run.answered(&answers);
    let (scenes, reports): (Vec<&Path>, Vec<&Path>) =
        output.iter().map(AsRef::as_ref).partition(|output| extension(output) == "npz");
    run.stage("writing", 0, |_| reports.iter().try_for_each(|output| write_report(output, &answers.found)))?;
    if !scenes.is_empty() {
        // what answers come from has all pulses
        let (built, _) = run.aside(|run| pipeline::model_of(Cow::Owned(cloud), &model, input, run));
        let parts = with_program(ask::with_reliability(built?.into_parts(), &answers.found), input);
        run.stage("writing balls", 0, |_| scenes.iter().try_for_each(|output| write_balls(*output, &parts)))?;
    }
    run.summary.add_paths("written", output);
    Ok(run.finish())
}

/// Refuses ball files, whose pulses are part of the scene.
fn refuse_balls(input: &CloudInput) -> Result<()> {
    match input.clouds.iter().find(|path| is_file(path) && is_ball_file(*path).unwrap_or(false)) {
        Some(path) => {
            let path = path.display();
            refuse(format!("{path} is a ball file, which has no points: give the cloud that it was made from"))
        }
        None => Ok(()),
    }
}

/// The error with the names of the clouds where they lack something, and the flags that help.
fn name_clouds(input: &CloudInput, error: Error) -> anyhow::Error {
    match error {
        Error::MissingAttribute { .. } => {
            let what = format!("{}: {error} (--orient trajectory=FILE or scanner=X,Y,Z)", input.names().join(", "));
            anyhow::Error::from(error).context(what)
        }
        other => pipeline::advised(input, other),
    }
}

fn write_report(output: &Path, found: &SurveyReliability) -> belvedere::Result<()> {
    let report = serde_json::Value::from(Summary::of(found));
    write_text(output, &format!("{report:#}\n"))
}
