//! `belvedere sky-view`.

use crate::arguments::{Global, SkyViewArguments};
use crate::in_tiles::TypedCells;
use crate::inputs::sun::sky_parts;
use crate::outputs::targets::TargetOutput;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask};

pub(crate) fn run(arguments: &SkyViewArguments, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let sky = sky_parts(arguments.patches, arguments.directions);
    let question =
        ask::SkyViewQuestion { sky, trees: arguments.trees.choice()?, interval: arguments.interval.interval };
    question.check()?;
    let mut run = CommandContext::new(global);
    let cells = TypedCells::of_sky(
        (&arguments.scene, &arguments.memory),
        &arguments.places,
        &arguments.trees,
        &arguments.outputs,
        &[("--shell", arguments.shell.shell.is_some())],
    );
    if cells.answered(ask::Question::SkyView(question.clone()), None, &mut run)?.is_some() {
        return Ok(run.finish());
    }
    let points = arguments.places.needed_points();
    let scene = arguments.places.scene(&arguments.scene, arguments.shell.shell, points, &mut run)?;
    let (places, source) = arguments.places.places(&scene, &mut run)?;
    let answers = run.ask(&scene, &question, &places)?;
    let shown = TargetOutput::new(&answers.found, source, &scene);
    shown.write(&arguments.outputs, &answers.measures, &mut run)?;
    shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    Ok(run.finish())
}
