//! `belvedere sky-view`.

use crate::arguments::{Global, PatchesChoice, SkyViewArguments};
use crate::in_tiles::TypedCells;
use crate::inputs::targets::TargetOutput;
use crate::pipeline;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, SkyParts};

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
    let scene = pipeline::scene_of_places(&arguments.scene, &arguments.places, arguments.shell.shell, &mut run)?;
    let (places, source) = arguments.places.places(&scene, &mut run)?;
    let answers = run.ask(&scene, &question, &places)?;
    let shown = TargetOutput::new(&answers.found, source, &scene);
    shown.write(&arguments.outputs, &answers.measures, &mut run)?;
    shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    Ok(run.finish())
}

/// Returns the division of the sky.
pub(crate) fn sky_parts(patches: Option<PatchesChoice>, directions: Option<usize>) -> SkyParts {
    match patches {
        Some(PatchesChoice::Tregenza) => SkyParts::Tregenza,
        Some(PatchesChoice::Reinhart) => SkyParts::Reinhart,
        None => directions.map_or_else(SkyParts::default, SkyParts::Even),
    }
}
