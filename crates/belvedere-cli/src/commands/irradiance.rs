//! `belvedere irradiance`.

mod planes;
pub(super) mod radiation;

use super::sights::{Proving, blockers, scene_params};
use super::warn_of_geojson;
use crate::arguments::{Global, Irradiance, Usage};
use crate::pipeline::{self, Points};
use crate::run::Run;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::irradiance::{Grouping, irradiation_measures, look_count, season_irradiation};
use belvedere::apps::rows::Obstacles;

pub(crate) fn run(arguments: &Irradiance, global: &Global) -> Result<Summary> {
    let outputs = arguments.outputs.of_places();
    arguments.places.check(&outputs)?;
    let wants_places = !outputs.output.is_empty();
    if !wants_places && outputs.measures.is_some() {
        return Err(Usage("--measures needs -o".to_owned()).into());
    }
    planes::check(arguments)?;
    let grouping = if arguments.months { Grouping::Months } else { Grouping::Whole };
    let params = radiation::params(&arguments.model)?.with_grouping(grouping);
    let mut run = Run::new(global);
    // a mistyped weather file must not be told after the balls were made
    let weather = radiation::weather(arguments, &mut run)?;
    let needs_points = !arguments.planes.is_empty() || arguments.places.needs_points();
    let points = if needs_points { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    arguments.places.far.set(&mut scene, &mut run)?;
    warn_of_geojson(&arguments.planes, &scene.cloud.frame.crs, &mut run.summary);
    let site = radiation::site(arguments, &scene, weather.as_ref(), &mut run.summary)?;
    let profile = scene.profile;
    let blocking = scene_params(&scene, profile, &arguments.shell.giving_way());
    let trees = arguments.trees.of(&scene, &blocking, &mut run.summary)?;
    let crowns = trees.as_ref().map(|trees| trees.crowns);
    let seasons = radiation::gather(arguments, &params, &site, weather.as_ref(), crowns, &mut run)?;
    let roofs = planes::find(arguments, &mut scene, &mut run)?;
    let asked = match wants_places {
        true => Some(arguments.places.targets(&mut scene, &mut run)?),
        false => None,
    };
    let mut section = Summary::default();
    let (blockers, _) =
        blockers(&scene, profile, &arguments.shell.giving_way(), Proving::Never, &mut run, &mut section)?;
    let obstacles = Obstacles { scene: &blockers, trees: trees.as_ref() };
    section.add("directions", seasons.iter().map(|season| season.radiation.directions().len()).sum::<usize>());
    run.summary.add("lines_of_sight", section);
    if let Some(asked) = &asked {
        let directions: Vec<[f64; 3]> = seasons.iter().flat_map(|season| season.radiation.directions()).collect();
        asked.report_edge(&arguments.places, &scene, &directions, &mut run)?;
        let looks = asked.targets.len() * look_count(&obstacles, &seasons);
        let sums = run.stage("testing sun and sky", looks, |control| {
            season_irradiation(obstacles, &asked.targets, &seasons, control)
        })?;
        let group_count = seasons.first().map_or(1, |season| season.radiation.group_count());
        let measures = irradiation_measures(&sums, group_count);
        drop(sums);
        run.summary.add("irradiation", asked.statistics(&measures));
        let title = arguments.places.far.titled("Energy of sun and sky, kWh/m²");
        asked.write(&outputs, &measures, &title, &mut run)?;
    }
    if let Some(roofs) = &roofs {
        planes::measure(arguments, roofs, obstacles, &seasons, &site, &mut run)?;
    }
    Ok(run.finish())
}
