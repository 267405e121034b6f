//! `belvedere window-views`.

mod results;

use super::sights::proving_blockers;
use super::sights::{leave_out_outside, report_edge};
use super::windows::{FaceChoice, Windows, windows};
use super::{check_output, extension, mesh_targets, warn_of_geojson};
use crate::arguments::{Global, UnprovenChoice, Usage, WindowViews};
use crate::pipeline::{self, Points, Scene};
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::{Result, bail};
use belvedere::PointCloud;
use belvedere::apps::window_views::{
    ClassMeanings, Kinds, Proving, Seen, VIEW_DIRECTIONS, VIEW_SPACING, are_made_from, balls_seen, leave_out_level,
    leave_out_walled_up, view_directions, view_measures, window_views,
};
use results::Found;

/// Share of the things in a view that are of no known kind that is warned of, percent.
const OTHER_WARNING_PERCENT: f64 = 50.0;

pub(crate) fn run(arguments: &WindowViews, global: &Global) -> Result<Summary> {
    check(arguments)?;
    let directions = view_directions(arguments.directions.unwrap_or(VIEW_DIRECTIONS));
    let directions = directions?;
    let mut run = Run::new(global);
    let mut scene = pipeline::scene(&arguments.scene, Points::Keep, &mut run)?;
    arguments.far.set(&mut scene, &mut run)?;
    warn_of_geojson(&arguments.output, &scene.cloud.frame.crs, &mut run.summary);
    let north = arguments.north.of_scene(&scene);
    north.report(&mut run.summary);
    let is_mesh = mesh_targets::is_mesh(&arguments.windows);
    let spacing = arguments.spacing.or(is_mesh.then_some(VIEW_SPACING));
    let choice = FaceChoice { spacing, objects: &arguments.object };
    let mut asked = windows(&arguments.windows, &choice, (&scene, north.of_grid), &mut run)?;
    let names = names(arguments, &asked)?;
    let mut section = Summary::default();
    section.add("windows", asked.windows.len()).add("targets", asked.targets.len());
    if is_mesh {
        section.add("targets_on_roofs_and_floors", leave_out_level(&mut asked.targets));
    }
    run.summary.add("windows", section);
    leave_out_outside(&mut asked.targets, &scene, &mut run.summary);
    let upper = &directions[..directions.len() / 2];
    report_edge(&asked.targets, &scene, upper, &mut run)?;

    let cloud = cloud_of_classes(arguments, &mut scene, &mut run)?;
    let meanings = arguments.classes.iter().fold(ClassMeanings::default(), |all, one| all.with(one.0, one.1));
    let classes = cloud.attributes.classification.as_deref();
    if classes.is_none() {
        let advice =
            if arguments.scene.input.clouds.len() == 1 && cloud.is_empty() { "; give --classes-of" } else { "" };
        run.summary.warn(
            "classes-unknown",
            format!("the classes of points are unknown: only vegetation is known, from pulses{advice}"),
        );
    }
    let kinds = balls_seen(scene.model.balls(), classes, scene.model.vegetation(), &meanings)?;
    let profile = scene.profile;
    let (blockers, _) = proving_blockers(&scene, profile, &arguments.giving_way, &mut run)?;
    let count = asked.targets.asked_count();
    let inside =
        run.stage("testing targets", 0, |control| leave_out_walled_up(&mut asked.targets, &blockers, control))?;
    if asked.targets.asked_count() == 0 {
        bail!(
            "{}: no window is left: all are outside the cloud, inside obstacles, or faces of roofs and floors. Are they in the coordinates of the cloud?",
            arguments.windows.display()
        );
    }
    run.summary.add("targets_inside_obstacle", inside);
    // walls between houses are faces of a mesh, and nothing to warn of
    if !is_mesh {
        run.summary.warn_of_share(
            "targets-inside-obstacle",
            (inside, count),
            "targets",
            "are inside an obstacle and have no view",
        );
    }
    let views = run.stage("testing views", asked.targets.len(), |control| {
        let kinds = Kinds { balls: &kinds, meshes: &[] };
        window_views(&blockers, &asked.targets, kinds, &directions, control)
    })?;
    let proving = if blockers.proof().is_some() { Proving::Asked } else { Proving::NotAsked };
    let measures = view_measures(&views, proving);
    let mut section = Summary::default();
    section.add("directions", directions.len() / 2);
    for measure in &measures {
        section.add(&measure.name, Summary::of(&measure.rounded_statistics()));
    }
    run.summary.add("views", section);
    warn_of_other(&views, &mut run.summary);
    let shown = arguments.map_of.unwrap_or(Seen::Vegetation);
    let title = arguments.far.titled(&format!("View from windows: {}", shown.name()));
    let found = Found { windows: &asked, views: &views, measures: &measures, names: &names };
    for output in &arguments.output {
        match extension(output).as_str() {
            "png" => found.write_map(output, &title, shown, (&scene, &cloud), &mut run)?,
            _ => {
                let report = run.stage("writing", 0, |_| found.write(output, &cloud))?;
                run.summary.add_writing(&report);
            }
        }
    }
    if let Some(output) = &arguments.buildings {
        run.stage("writing", 0, |_| found.write_buildings(output))?;
    }
    run.summary
        .headline("the view from <windows.windows> windows is on average <views.sky.mean> % sky, <views.vegetation.mean> % vegetation")
        .headline("buildings <views.building.mean> %, ground <views.ground.mean> %, water <views.water.mean> %")
        .headline("vegetation: from <views.vegetation.min> to <views.vegetation.max> %");
    let written = arguments.output.iter().chain(&arguments.buildings);
    run.summary.add("written", written.map(|path| path.display().to_string()).collect::<Vec<_>>());
    Ok(run.finish())
}

fn check(arguments: &WindowViews) -> Result<()> {
    for output in &arguments.output {
        check_output("-o", output, &["csv", "geojson", "laz", "las", "ply", "png"])?;
    }
    if let Some(output) = &arguments.buildings {
        check_output("--buildings", output, &["csv"])?;
    }
    if arguments.map_of.is_some() && !arguments.output.iter().any(|output| extension(output) == "png") {
        return Err(Usage("--map-of needs a map: -o FILE.png".to_owned()).into());
    }
    if matches!(arguments.giving_way.unproven, Some(UnprovenChoice::AsBlocked)) {
        let what = "--unproven as-blocked: a view has no targets that could be blocked; use report or as-visible";
        return Err(Usage(what.to_owned()).into());
    }
    Ok(())
}

/// The building of each window; empty where that is not known.
fn names(arguments: &WindowViews, asked: &Windows) -> Result<Vec<String>> {
    let columns = asked.given.columns(0..asked.given.row_count());
    let column = columns.iter().find(|(name, _)| name.eq_ignore_ascii_case("name"));
    match column {
        Some((_, cells)) => Ok(cells.iter().map(|&cell| cell.to_owned()).collect()),
        None if arguments.buildings.is_none() || !asked.names.is_empty() => Ok(asked.names.clone()),
        None => {
            let path = arguments.windows.display();
            bail!("--buildings: {path} does not name buildings; a table needs the column name, a mesh named objects")
        }
    }
}

/// The cloud whose rows the balls were made at, in the frame of the scene: its own, or the one that was named; empty for a ball file alone.
fn cloud_of_classes(arguments: &WindowViews, scene: &mut Scene, run: &mut Run) -> Result<PointCloud> {
    let Some(path) = &arguments.classes_of else {
        let frame = PointCloud::in_frame(scene.cloud.frame.clone());
        return Ok(std::mem::replace(&mut scene.cloud, frame));
    };
    if !scene.cloud.is_empty() {
        return Err(
            Usage("--classes-of is for ball files; the cloud of this scene has its own classes".to_owned()).into()
        );
    }
    let frame = &scene.cloud.frame;
    let cloud = run.aside(|run| super::query::points_of_file(path, None, frame, run)).0?;
    if !are_made_from(scene.model.balls(), &cloud.positions) {
        bail!("--classes-of {}: the balls were not built from this cloud", path.display());
    }
    Ok(cloud)
}

/// Warns where most things seen are of no known kind.
fn warn_of_other(views: &[belvedere::apps::window_views::WindowView], summary: &mut Summary) {
    let known = || views.iter().filter(|view| view.shares[0].is_finite());
    let of = |seen: Seen| known().map(|view| view.shares[seen as usize]).sum::<f64>();
    let things: f64 = Seen::ALL[1..6].iter().map(|&seen| of(seen)).sum();
    let other = 100.0 * of(Seen::Other) / things;
    if other >= OTHER_WARNING_PERCENT {
        let other = rounded(other, 1);
        summary.warn(
            "seen-things-of-no-kind",
            format!("{other} % of the things seen are other; see --class if the classes of the cloud differ"),
        );
    }
}
