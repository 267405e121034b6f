//! `belvedere irradiance`.

mod hours;
mod planes;

use crate::arguments::{Global, IrradianceArguments, SkyOutputs, SkyPlaces, refuse_given};
use crate::in_tiles::{TiledAnswers, TypedCells};
use crate::inputs::radiation;
use crate::outputs::formats::warn_of_geojson;
use crate::outputs::targets::TargetOutput;
use crate::pipeline::KeepPoints;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, Places, Roofs, SunPlace};
use belvedere::apps::irradiance::{CLEAR_SKY_YEAR, Grouping};
use belvedere::io::read_footprints;
use std::sync::Arc;

/// Refuses flags of cells and points where only roofs are wanted, which have cells of their own.
fn refuse_flags_of_places(arguments: &IrradianceArguments, outputs: &SkyOutputs) -> Result<()> {
    let SkyPlaces { places, cell, height, edge_mask, spacing, facing, .. } = &arguments.places;
    let given = [
        ("--measures", outputs.measures.is_some()),
        ("--by-area", outputs.by_area.by_area.is_some()),
        ("--edge-mask", edge_mask.is_some()),
        ("--surface", places.surface),
        ("--self", places.own),
        ("--targets", places.targets.is_some()),
        ("--cell", cell.is_some()),
        ("--target-height", height.is_some()),
        ("--spacing", spacing.is_some()),
        ("--facing", facing.is_some()),
    ];
    refuse_given(&given, "needs -o")
}

pub(crate) fn run(arguments: &IrradianceArguments, global: &Global) -> Result<Summary> {
    let outputs = arguments.outputs.of_places();
    arguments.places.check(&outputs)?;
    let wants_places = !outputs.output.is_empty()
        || !arguments.places.places.at.is_empty()
        || arguments.tiles.plan.is_some()
        || arguments.planes.is_empty() && outputs.by_area.by_area.is_some();
    if !wants_places {
        refuse_flags_of_places(arguments, &outputs)?;
    }
    planes::check(arguments)?;
    let mut run = CommandContext::new(global);
    let grouping = if arguments.months { Grouping::Months } else { Grouping::Whole };
    let params = radiation::params(&arguments.model).with_grouping(grouping);
    let IrradianceArguments { min_area, panel, min_cells, .. } = *arguments;
    let (system, ground) = (arguments.photovoltaics.system(), arguments.places.ground.points());
    let roofs = Roofs { min_area, panel, min_cells, system, footprints: None, ground };
    let (weather, clear_sky) = (arguments.radiation.weather.as_deref(), arguments.radiation.clear_sky);
    let year = arguments.year.unwrap_or(CLEAR_SKY_YEAR);
    let mut question = ask::IrradianceQuestion {
        // a mistyped weather file must not be found out after the balls were made
        radiation: radiation::of((weather, clear_sky), &arguments.model, year, &run)?,
        params,
        place: SunPlace { location: arguments.location.as_ref().map(|location| location.0), ..SunPlace::default() },
        trees: arguments.trees.choice()?,
        roofs: (!arguments.planes.is_empty()).then_some(roofs),
        interval: arguments.interval.interval,
    };
    question.check()?;
    let cells = TypedCells::of_sky(
        (&arguments.scene, &arguments.tiles),
        &arguments.places,
        question.trees,
        &outputs,
        &[("--shell", arguments.shell.shell.is_some())],
    );
    let write =
        |tiled: &TiledAnswers, run: &mut CommandContext| tiled.shown().write(&outputs, &tiled.answers.measures, run);
    if wants_places && cells.answered(question.clone(), write, &mut run)? {
        return Ok(run.finish());
    }
    let points = if question.roofs.is_some() { KeepPoints::Keep } else { arguments.places.needed_points() };
    let whole = |run: &mut CommandContext| arguments.places.scene(&arguments.scene, arguments.shell.shell, points, run);
    let of_places = cells.scene(question.clone(), whole, &mut run)?;
    let scene = of_places.scene();
    warn_of_geojson(&arguments.planes, &scene.frame().crs, &mut run.summary);
    if let (Some(roofs), Some(path)) = (&mut question.roofs, &arguments.photovoltaics.footprints) {
        let footprints = run.stage("reading footprints", 0, |_| read_footprints(path.as_path(), scene.frame()))?;
        roofs.footprints = Some(Arc::new(footprints));
    }
    let (places, source) = match wants_places {
        true => arguments.places.places(scene, &mut run).map(|(places, source)| (places, Some(source)))?,
        false => (Places::Scene, None),
    };
    let answers = run.ask(scene, &question, &places)?;
    of_places.finish(&run)?;
    if let (Some(on), Some(source)) = (&answers.found.on, source) {
        let shown = TargetOutput::new(on, source, scene);
        shown.write(&outputs, &answers.measures, &mut run)?;
        shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    }
    if let Some(roofs) = &answers.found.roofs {
        planes::write(arguments, roofs, &answers.found, scene, &mut run)?;
    }
    Ok(run.finish())
}
