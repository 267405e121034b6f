//! `belvedere sky-view`.

use crate::arguments::{Global, SkyViewArguments};
use crate::in_tiles::{TiledAnswers, TypedCells};
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
        (&arguments.scene, &arguments.tiles),
        &arguments.places,
        question.trees,
        &arguments.outputs,
        &[("--shell", arguments.shell.shell.is_some())],
    );
    let write = |tiled: &TiledAnswers, run: &mut CommandContext| {
        tiled.shown().write(&arguments.outputs, &tiled.answers.measures, run)
    };
    if cells.answered(question.clone(), write, &mut run)? {
        return Ok(run.finish());
    }
    let places = (&arguments.places, arguments.shell.shell);
    let of_places = cells.scene_of_sky(question.clone(), places, &mut run)?;
    let scene = of_places.scene();
    let (places, source) = arguments.places.places(scene, &mut run)?;
    let answers = run.ask(scene, &question, &places)?;
    of_places.finish(&run)?;
    let shown = TargetOutput::new(&answers.found, source, scene);
    shown.write(&arguments.outputs, &answers.measures, &mut run)?;
    shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    Ok(run.finish())
}
