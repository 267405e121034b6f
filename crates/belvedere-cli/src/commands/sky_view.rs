//! `belvedere sky-view`.

use super::sights::{Proving, blockers};
use crate::arguments::{Global, PatchesChoice, SkyView};
use crate::pipeline::{self, Points, flagged};
use crate::run::Run;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::rows::Obstacles;
use belvedere::apps::sky_view::{SKY_DIRECTIONS, SkyDirections, scene_sky_view};

pub(crate) fn run(arguments: &SkyView, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let sky = match arguments.patches {
        Some(PatchesChoice::Tregenza) => SkyDirections::patches(1)?,
        Some(PatchesChoice::Reinhart) => SkyDirections::patches(2)?,
        None => flagged("--directions", SkyDirections::even(arguments.directions.unwrap_or(SKY_DIRECTIONS)))?,
    };
    let mut run = Run::new(global);
    let points = if arguments.places.needs_points() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    arguments.places.far.set(&mut scene, &mut run)?;
    let asked = arguments.places.targets(&mut scene, &mut run)?;
    asked.report_edge(&arguments.places, &scene, &sky.directions, &mut run)?;
    let mut section = Summary::default();
    let profile = scene.profile;
    let (blockers, _) =
        blockers(&scene, profile, &arguments.shell.giving_way(), Proving::Never, &mut run, &mut section)?;
    section.add("directions", sky.directions.len());
    run.summary.add("lines_of_sight", section);
    let trees = arguments.trees.of(&scene, blockers.params(), &mut run.summary)?;
    let obstacles = Obstacles { scene: &blockers, trees: trees.as_ref() };
    let looks = asked.targets.len() * obstacles.matrix_count();
    let seen = run.stage("testing sky", looks, |control| scene_sky_view(obstacles, &asked.targets, &sky, control))?;
    let measures = seen.into_measures();
    run.summary.add("sky", asked.statistics(&measures));
    let title = arguments.places.far.titled("Sky view");
    asked.write(&arguments.outputs, &measures, &title, &mut run)?;
    Ok(run.finish())
}
