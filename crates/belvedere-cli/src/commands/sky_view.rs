//! `belvedere sky-view`.

use super::sights::{Proving, blockers};
use crate::arguments::{Global, PatchesChoice, SkyView};
use crate::pipeline::{self, Points, flagged};
use crate::progress::Stages;
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
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let points = if arguments.places.needs_points() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut stages, &mut summary)?;
    arguments.places.far.set(&mut scene, &mut stages, &mut summary)?;
    let asked = arguments.places.targets(&mut scene, global.seed, &mut stages, &mut summary)?;
    asked.report_edge(&arguments.places, &scene, &sky.directions, &mut stages, &mut summary)?;
    let mut section = Summary::default();
    let profile = arguments.scene.profile.into();
    let (blockers, _) =
        blockers(&scene, profile, &arguments.shell.giving_way(), Proving::Never, &mut stages, &mut section)?;
    section.add("directions", sky.directions.len());
    summary.add("lines_of_sight", section);
    let trees = arguments.trees.of(&scene, blockers.params(), &mut summary)?;
    let obstacles = Obstacles { scene: &blockers, trees: trees.as_ref() };
    let looks = asked.targets.len() * obstacles.matrix_count();
    let seen = stages.run("testing sky", looks, |control| scene_sky_view(obstacles, &asked.targets, &sky, control))?;
    let measures = seen.into_measures();
    summary.add("sky", asked.statistics(&measures));
    let title = arguments.places.far.titled("Sky view");
    asked.write(&arguments.outputs, &measures, &title, &mut stages, &mut summary)?;
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}
