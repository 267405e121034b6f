//! `belvedere sun-hours`.

use super::in_tiles::TypedCells;
use super::targets::TargetOutput;
use crate::arguments::{Global, SunHoursArguments};
use crate::pipeline;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask};

pub(crate) fn run(arguments: &SunHoursArguments, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let question = ask::SunHoursQuestion {
        days: arguments.when.days(),
        rules: arguments.rule.clone(),
        place: arguments.sun.place_from_true_north()?,
        sun_tolerance_deg: arguments.within,
        trees: arguments.trees.choice()?,
        interval: arguments.interval.interval,
    };
    question.check()?;
    let mut run = CommandContext::new(global);
    let cells = TypedCells::of_sky(
        (&arguments.scene, &arguments.memory),
        &arguments.places,
        &arguments.trees,
        &arguments.outputs,
        &[("--shell", arguments.shell.shell.is_some())],
    );
    if cells.answered(ask::Question::SunHours(question.clone()), None, &mut run)?.is_some() {
        return Ok(run.finish());
    }
    let scene = pipeline::scene_of_places(&arguments.scene, &arguments.places, arguments.shell.shell, &mut run)?;
    let (places, source) = arguments.places.places(&scene, &mut run)?;
    let answers = run.ask(&scene, &question, &places)?;
    let shown = TargetOutput::new(&answers.found, source, &scene);
    shown.write(&arguments.outputs, &answers.measures, &mut run)?;
    shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    Ok(run.finish())
}
