//! `belvedere cameras`.

mod places;
mod results;
mod what;

use super::sights::{ground, ground_cloud, proving_blockers};
use super::{check_output, warn_of_geojson};
use crate::arguments::{Cameras, Global, Usage};
use crate::pipeline::{self, Points, Scene};
use crate::run::Run;
use crate::summary::{Summary, percent, rounded};
use anyhow::{Result, bail};
use belvedere::apps::cameras::{
    CoverageParams, FREE_FRESNEL_SHARE, FresnelZone, Goal, Placement, PlacementParams, Pose, counted_weights, coverage,
    leave_out_private, place_cameras,
};
use belvedere::apps::landmark::observer_cell_for;
use belvedere::ground::MapGrid;
use results::Found;
use std::path::PathBuf;

pub(crate) fn run(arguments: &Cameras, global: &Global) -> Result<Summary> {
    check(arguments)?;
    let earth = arguments.earth.params()?;
    let share = arguments.fresnel_percent.map_or(FREE_FRESNEL_SHARE, |percent| percent / 100.0);
    let zone = arguments.radio.wave()?.map(|wave| FresnelZone::new(wave, share)).transpose()?;
    let lens = places::lens(&arguments.lens)?;
    let mounting = places::mounting(&arguments.lens, lens);
    let mut run = Run::new(global);
    let mut scene = pipeline::scene(&arguments.scene, Points::Keep, &mut run)?;
    let written: Vec<PathBuf> =
        arguments.output.iter().chain(&arguments.curve).chain(&arguments.footprints).cloned().collect();
    warn_of_geojson(&written, &scene.cloud.frame.crs, &mut run.summary);
    let north = arguments.north.of_scene(&scene);
    north.report(&mut run.summary);
    let bounds = scene.model.bounds().on_map();
    let cell = arguments.targets.cell.unwrap_or_else(|| observer_cell_for(bounds.0, bounds.1));
    let grid = map_grid(&scene, cell)?;
    let (cloud, ground_points) = ground_cloud(&arguments.targets.ground, &mut scene, &mut run)?;
    let ground = ground(&cloud, ground_points, grid, &mut run)?;
    let profile = scene.profile;
    let (blockers, unproven) = proving_blockers(&scene, profile, &arguments.giving_way, &mut run)?;
    let site = what::Site { scene: &scene, cloud: &cloud, ground: &ground };
    let targets = what::targets(&arguments.targets, &site, &mut run)?;

    let standing = places::Standing { site: &site, blockers: &blockers, mounting: &mounting, north: north.of_grid };
    let existing = match &arguments.existing {
        Some(path) => standing.existing(path, arguments.camera_height, &mut run)?,
        None => Vec::new(),
    };
    let mut candidates = standing.candidates(arguments, ground_points, &mut run)?;
    let given = candidates.len();
    if let Some(path) = &arguments.lens.private {
        let private = what::private(path, &arguments.targets, &site, &mut run.summary)?;
        run.stage("testing private places", given, |control| {
            leave_out_private(&blockers, &mut candidates, &private, &earth, control)
        })?;
    }
    let mut section = Summary::default();
    section.add("count", given).add("see_private_places", given - candidates.len()).add("existing", existing.len());
    run.summary.add("cameras_to_choose_from", section);
    if given == 0 {
        bail!("there is no place for a camera: all lie inside obstacles, below the ground or outside the cloud");
    }
    if candidates.is_empty() {
        bail!("all {given} cameras have a private place in their picture; give other --candidates, or more --headings");
    }

    let poses: Vec<Pose> = existing.iter().chain(&candidates).copied().collect();
    let cameras: Vec<_> = poses.iter().map(|pose| pose.camera).collect();
    let density = lens.required_density(arguments.lens.density.map(|density| density.0))?;
    let params =
        CoverageParams::default().with_density(density).with_earth(earth).with_unproven(unproven).with_zone(zone);
    let (table, report) = run.stage("testing lines of sight", cameras.len(), |control| {
        coverage(&blockers, &cameras, &targets, &params, control)
    })?;
    let mut section = Summary::default();
    section.add("pixels_per_m", rounded(density, 3)).add_report(&report).add("covered_pairs", table.pair_count());
    run.summary.add("pictures", section);

    let goal = match (arguments.goal.count, arguments.goal.coverage) {
        (_, Some(percent)) => Goal::Coverage(percent / 100.0),
        (count, None) => Goal::Count(count.unwrap_or(0)),
    };
    let params = PlacementParams::new(goal)
        .with_existing((0..existing.len()).collect())
        .with_required(u32::try_from(arguments.required)?)
        .with_search_limit(arguments.search_limit);
    let weights = counted_weights(&targets);
    let placed = run.stage("choosing cameras", 0, |control| place_cameras(&table, &weights, &params, control))?;
    add_placement(&mut run.summary, &placed, &weights, arguments.required);
    let found = Found::new(&poses, existing.len(), &table, &placed, &targets, north.of_grid);
    for output in &arguments.output {
        run.stage("writing", 0, |_| found.write(output, &cloud))?;
    }
    if let Some(output) = &arguments.curve {
        run.stage("writing", 0, |_| found.write_curve(output))?;
    }
    if let Some(output) = &arguments.footprints {
        run.stage("writing", 0, |_| found.write_footprints(output))?;
    }
    run.summary
        .headline("<coverage.new_cameras> new cameras cover <coverage.coverage_percent> % of the targets")
        .headline("best possible: <coverage.best_possible_percent> %, so at most <coverage.at_most_below_best_percent> % are missing")
        .headline("all <cameras_to_choose_from.count> candidates together: <coverage.all_candidates_percent> %");
    run.summary.add("written", written.iter().map(|path| path.display().to_string()).collect::<Vec<_>>());
    Ok(run.finish())
}

fn check(arguments: &Cameras) -> Result<()> {
    let are_cells = what::are_cells(&arguments.targets);
    for output in &arguments.output {
        check_output("-o", output, &["geojson", "tif", "tiff", "png", "csv"])?;
        let is_map = ["tif", "tiff", "png"].contains(&super::extension(output).as_str());
        if is_map && !are_cells {
            let output = output.display();
            return Err(Usage(format!("{output}: rasters and maps need cells as targets; use .csv or .geojson")).into());
        }
    }
    if let Some(output) = &arguments.curve {
        check_output("--curve", output, &["csv"])?;
    }
    if let Some(output) = &arguments.footprints {
        check_output("--footprints", output, &["geojson"])?;
        if !are_cells {
            return Err(Usage("--footprints needs cells as targets".to_owned()).into());
        }
    }
    if arguments.goal.coverage.is_some_and(|percent| percent > 100.0) {
        return Err(Usage("--coverage must be a percentage, above 0 to 100".to_owned()).into());
    }
    what::check(&arguments.targets, are_cells)
}

fn map_grid(scene: &Scene, cell: f64) -> belvedere::Result<MapGrid> {
    let (low, high) = scene.model.bounds().on_map();
    let [x, y, _] = scene.cloud.frame.origin;
    MapGrid::covering(low, high, cell, [x, y])
}

fn add_placement(summary: &mut Summary, placed: &Placement, weights: &[f64], required: usize) {
    let in_percent = |share: f64| rounded(100.0 * share, 3);
    let counting: Vec<u32> =
        weights.iter().zip(&placed.counts).filter(|(weight, _)| **weight > 0.0).map(|(_, count)| *count).collect();
    let with = |least: usize| counting.iter().filter(|count| **count as usize >= least).count();
    let mut section = Summary::default();
    section
        .add("new_cameras", placed.chosen.len())
        .add("coverage_percent", in_percent(placed.coverage()))
        .add("best_possible_percent", in_percent(placed.bound))
        .add("at_most_below_best_percent", in_percent(placed.gap()))
        .add("is_proven_optimum", placed.is_optimal())
        .add("all_candidates_percent", in_percent(placed.reachable))
        .add("existing_only_percent", in_percent(placed.curve.first().copied().unwrap_or(0.0)))
        .add("targets_covered_percent", percent(with(required), counting.len()))
        .add("targets_never_covered", counting.len() - with(1))
        .add("branches_searched", placed.branches);
    if let Some(least) = placed.least_count {
        section.add("least_possible_cameras", least);
    }
    summary.add("coverage", section);
}
