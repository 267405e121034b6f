//! `belvedere viewshed`.

mod results;
mod who;

use super::far_terrain::set_terrain;
use super::heights::write_heights;
use super::sights::{OUTSIDE_CLOUD, enclosure_note, ground, ground_cloud, proving_blockers, skip_unfit_far};
use super::{check_output, warn_of_geojson};
use crate::arguments::{Global, Usage, Viewshed};
use crate::pipeline::{self, Points, flagged};
use crate::run::Run;
use crate::summary::{Summary, percent, rounded};
use anyhow::{Result, bail};
use belvedere::apps::eyes::{EyesReport, fault_of_target};
use belvedere::apps::targets::{CellParams, Targets};
use belvedere::apps::viewshed::{
    Masks, OBSERVER_HEIGHT, Observer, TARGET_HEIGHT, Viewshed as Seen, ViewshedParams, box_within_reach, cell_for,
    far_targets, far_viewshed, least_visible_heights, terrain_within_reach, tested_height, viewshed,
};
use belvedere::ground::{Ground, MapGrid};
use belvedere::query::{Answer, AnswerCounts, MedialScene, UnprovenAs};
use belvedere::{ElevationGrid, PointCloud};
use results::{Field, SeenCells, on_points, write_masks};
use std::path::{Path, PathBuf};

/// Outputs that hold points rather than cells.
const OF_POINTS: [&str; 4] = ["laz", "las", "ply", "csv"];
/// What --heights writes.
const LEAST_HEIGHTS: &str = "minimum visible height above the ground in metres; -9999: none, or nodata";
/// Most notes on observers that stand wrong.
const MOST_NOTES: usize = 5;

pub(crate) fn run(arguments: &Viewshed, global: &Global) -> Result<Summary> {
    check_outputs(arguments)?;
    who::check(arguments)?;
    let earth = arguments.earth.params()?;
    let mut run = Run::new(global);
    let mut scene = pipeline::scene(&arguments.scene, Points::Keep, &mut run)?;
    if let Some(path) = &arguments.terrain {
        set_terrain(path, &mut scene, &mut run)?;
    }
    let areas: Vec<PathBuf> = arguments.output.iter().chain(&arguments.far_output).cloned().collect();
    warn_of_geojson(&areas, &scene.cloud.frame.crs, &mut run.summary);
    let north = arguments.looking.north.of_scene(&scene);
    let rows = who::rows(arguments, &scene.cloud, north.of_grid)?;
    if rows.iter().any(|row| row.limits.azimuth.is_some()) {
        north.report(&mut run.summary);
    }
    let grid = grid(arguments, &scene, &rows)?;
    let (cloud, ground_points) = ground_cloud(&arguments.ground, &mut scene, &mut run)?;
    let ground = ground(&cloud, ground_points, grid, &mut run)?;
    let mut observers = who::observers(&rows, &ground, &scene.model);
    let is_reverse = arguments.who.target.is_some();
    let target_height = match is_reverse {
        true => arguments.looking.observer_height.unwrap_or(OBSERVER_HEIGHT),
        false => arguments.looking.target_height.unwrap_or(TARGET_HEIGHT),
    };
    let profile = arguments.scene.profile.into();
    let (blockers, unproven) = proving_blockers(&scene, profile, &arguments.giving_way, &mut run)?;
    let who = if is_reverse { "target" } else { "observer" };
    let report = skip_observers(&mut observers, &blockers, &ground, (who, &cloud), &mut run)?;
    if arguments.terrain.is_some() {
        check_far_observers(arguments, &blockers, &observers, who, &mut run.summary)?;
    }
    let terrain = far_cells(arguments, &blockers, &observers)?;
    let key = if is_reverse { "target" } else { "observers" };
    run.summary.add(key, told(&observers, report, &ground, &blockers, &cloud));

    let masks = if arguments.masks.is_some() { Masks::Kept } else { Masks::NotKept };
    let params = ViewshedParams::default().with_earth(earth).with_unproven(unproven).with_masks(masks);
    let is_of_points = |path: &Path| OF_POINTS.contains(&super::extension(path).as_str());
    let is_of_cells = arguments.masks.is_some() || arguments.output.iter().any(|path| !is_of_points(path));
    let targets = match is_of_cells || arguments.heights.is_some() {
        true => Some(open_cells(&scene, (&cloud, &ground), target_height, &mut run)?),
        false => None,
    };
    if let Some(targets) = targets.as_ref().filter(|_| is_of_cells) {
        let seen = run.stage("testing cells", observers.len(), |control| {
            viewshed(&blockers, &observers, &targets.positions, &params, control)
        })?;
        run.summary.add("cells", counted(&seen.answers, unproven, Some([grid.cell; 2])));
        warn_of_blind(&observers, &seen, who, &mut run.summary);
        let eyes: Vec<[f64; 3]> = observers.iter().map(|observer| observer.eye).collect();
        let cells =
            SeenCells { seen: &seen, eyes: &eyes, frame: &cloud.frame, on: Field::Ground(&ground, &cloud), is_reverse };
        for output in arguments.output.iter().filter(|path| !is_of_points(path)) {
            run.stage("writing", 0, |_| cells.write(output))?;
        }
        if let Some(output) = &arguments.masks {
            run.stage("writing", 0, |_| write_masks(output, &seen, &ground, &cloud))?;
        }
    }
    if arguments.output.iter().any(|path| is_of_points(path)) {
        let params = params.with_masks(Masks::NotKept);
        let seen = run.stage("testing points", observers.len(), |progress| {
            viewshed(&blockers, &observers, &cloud.positions, &params, progress)
        })?;
        run.summary.add("cloud_points", counted(&seen.answers, unproven, None));
        let outside = AnswerCounts::of(&seen.answers).outside_cloud;
        run.summary.warn_of_share(outside, seen.answers.len(), "points", OUTSIDE_CLOUD);
        for output in arguments.output.iter().filter(|path| is_of_points(path)) {
            let report = run.stage("writing", 0, |_| on_points(output, &seen, &cloud))?;
            run.summary.add_writing(&report);
        }
    }
    if let Some(terrain) = &terrain {
        let params = params.with_masks(Masks::NotKept);
        let seen = run.stage("testing terrain", terrain.heights().height(), |control| {
            far_viewshed(&blockers, &observers, terrain, target_height, &params, control)
        })?;
        let asked: Vec<Answer> = seen.answers.iter().copied().filter(|&a| a != Answer::OutsideCloud).collect();
        run.summary.add("far_cells", counted(&asked, unproven, Some(terrain.cell())));
        let eyes: Vec<[f64; 3]> = observers.iter().map(|observer| observer.eye).collect();
        let cells =
            SeenCells { seen: &seen, eyes: &eyes, frame: &cloud.frame, on: Field::Terrain(terrain), is_reverse };
        for output in &arguments.far_output {
            run.stage("writing", 0, |_| cells.write(output))?;
        }
    }
    let open_ground = targets.as_ref().and_then(Targets::open_ground);
    if let (Some(output), Some(ground)) = (&arguments.heights, &open_ground) {
        let heights = run.stage("computing visible heights", observers.len(), |progress| {
            least_visible_heights(&blockers, &observers, ground, arguments.ceiling, &earth, progress)
        })?;
        run.stage("writing", 0, |_| write_heights(output, &heights, (&ground.grid, &cloud.frame), LEAST_HEIGHTS))?;
    }
    let written =
        arguments.output.iter().chain(&arguments.far_output).chain(&arguments.heights).chain(&arguments.masks);
    run.summary.add("written", written.map(|path| path.display().to_string()).collect::<Vec<_>>());
    Ok(run.finish())
}

/// The cells on the ground that are targets: neither under a cover nor inside what was added.
fn open_cells(
    scene: &pipeline::Scene,
    (cloud, ground): (&PointCloud, &Ground),
    height: f64,
    run: &mut Run,
) -> Result<Targets> {
    let params = CellParams::default().with_height(tested_height(height));
    let (mut targets, mut report) =
        run.stage("finding hidden ground", 0, |control| Targets::of_cells(cloud, ground.clone(), &params, control))?;
    if let Some(added) = scene.model.added() {
        report.cells_below_objects_excluded += targets.set_on_added(added, &params);
    }
    run.summary.add_report(&report);
    Ok(targets)
}

fn check_outputs(arguments: &Viewshed) -> Result<()> {
    for output in &arguments.output {
        check_output("-o", output, &["tif", "tiff", "png", "geojson", "laz", "las", "ply", "csv"])?;
    }
    for output in &arguments.far_output {
        check_output("--far-output", output, &["tif", "tiff", "png", "geojson"])?;
    }
    if let Some(output) = &arguments.heights {
        check_output("--heights", output, &["tif", "tiff", "npy"])?;
    }
    if let Some(output) = &arguments.masks {
        check_output("--masks", output, &["tif", "tiff", "npy"])?;
    }
    Ok(())
}

/// The cells looked at: those of the cloud that are near enough to any observer.
fn grid(arguments: &Viewshed, scene: &pipeline::Scene, rows: &[who::Row]) -> Result<MapGrid> {
    let reaches = rows.iter().map(|row| ([row.place[0], row.place[1]], row.limits.distance[1]));
    let (low, high) = box_within_reach(scene.model.bounds().on_map(), reaches);
    let cell = arguments.cell.unwrap_or_else(|| cell_for(low, high));
    let origin = [scene.cloud.frame.origin[0], scene.cloud.frame.origin[1]];
    flagged("--cell", MapGrid::covering(low, high, cell, origin))
}

/// The cells of the terrain beyond the cloud that observers may see, if these are asked about.
fn far_cells(arguments: &Viewshed, blockers: &MedialScene, observers: &[Observer]) -> Result<Option<ElevationGrid>> {
    let (Some(path), Some(terrain)) = (&arguments.terrain, blockers.far_terrain().grid()) else { return Ok(None) };
    if arguments.far_output.is_empty() {
        return Ok(None);
    }
    let cells = flagged("--max-distance", terrain_within_reach(terrain, observers))?;
    if far_targets(blockers, &cells).next().is_none() {
        bail!("--terrain {}: has no heights beyond the cloud within --max-distance", path.display());
    }
    Ok(Some(cells))
}

/// Refuses what observers on far terrain cannot have, and warns where the terrain changes nothing.
fn check_far_observers(
    arguments: &Viewshed,
    blockers: &MedialScene,
    observers: &[Observer],
    who: &str,
    summary: &mut Summary,
) -> Result<()> {
    let far = observers.iter().position(|observer| blockers.is_on_far_terrain(observer.eye));
    if let (Some(row), Some(_)) = (far, &arguments.heights) {
        let what = format!(
            "--heights needs a place in the cloud, but {who} {} is on the terrain beyond it: use -o for what is visible from there",
            row + 1
        );
        return Err(Usage(what).into());
    }
    if far.is_none() && arguments.far_output.is_empty() {
        summary.warn(format!(
            "--terrain changes nothing: no {who} is on the terrain beyond the cloud, and there is no --far-output"
        ));
    }
    Ok(())
}

/// Makes the eyes of observers that cannot look NaN. What is seen of a target often is its inside: only the cloud's limits count for it.
fn skip_observers(
    observers: &mut [Observer],
    blockers: &MedialScene,
    ground: &Ground,
    (who, cloud): (&str, &PointCloud),
    run: &mut Run,
) -> Result<EyesReport> {
    let mut eyes: Vec<[f64; 3]> = observers.iter().map(|observer| observer.eye).collect();
    let report = match (who, &eyes[..]) {
        ("target", &[eye]) if fault_of_target(blockers, eye).is_none() => EyesReport::none_skipped(1),
        _ => skip_unfit_far(blockers, Some(ground), (who, &cloud.frame), &mut eyes, run)?,
    };
    observers.iter_mut().zip(eyes).for_each(|(observer, eye)| observer.eye = eye);
    Ok(report)
}

/// Warns of observers that see nothing.
fn warn_of_blind(observers: &[Observer], seen: &Seen, who: &str, summary: &mut Summary) {
    let seeing = seen.answers.iter().any(|answer| matches!(answer, Answer::Visible | Answer::Unproven));
    if observers.len() == 1 && !seeing {
        summary.warn(match who {
            "target" => "no cell sees the target: is it below or inside an obstacle?",
            _ => "the observer sees no cell: does it stand below a tree or between obstacles?",
        });
    }
    let blind = |(observer, count): &(&Observer, &usize)| **count == 0 && observer.eye[0].is_finite();
    let blind = observers.iter().zip(&seen.seen_counts).filter(blind).count();
    if observers.len() > 1 {
        summary.warn_of_share(blind, observers.len(), "observers", "see no cell");
    }
}

/// How many observers there are and which are inside the surface of an obstacle.
fn told(
    observers: &[Observer],
    report: EyesReport,
    ground: &Ground,
    blockers: &MedialScene,
    cloud: &PointCloud,
) -> Summary {
    let mut section = Summary::of(&report);
    let height_below = |observer: &Observer| {
        let place = [observer.eye[0], observer.eye[1]];
        let terrain = blockers.far_terrain().grid().filter(|_| blockers.is_on_far_terrain(observer.eye));
        terrain.map_or_else(|| ground.height_at(place), |terrain| terrain.height_at(place))
    };
    if let [one] = observers {
        section.add("eye", cloud.frame.file_from_local(one.eye).map(|v| rounded(v, 3)).to_vec());
        if let Some(height) = height_below(one) {
            section.add("above_ground_m", rounded(one.eye[2] - height, 3));
        }
    }
    let mut notes = Vec::new();
    for (number, observer) in observers.iter().enumerate().filter(|(_, observer)| observer.eye[0].is_finite()) {
        let who = format!("eye {}", number + 1);
        if let Some(height) = height_below(observer).filter(|height| observer.eye[2] < *height) {
            notes.push(format!("{who} is {:.2} m below the ground", height - observer.eye[2]));
        }
        notes.extend(enclosure_note(blockers, observer.eye, &who));
    }
    if notes.len() > MOST_NOTES {
        let more = format!("and {} more notes of this type", notes.len() - MOST_NOTES);
        notes.truncate(MOST_NOTES);
        notes.push(more);
    }
    section.add("notes", notes);
    section
}

fn counted(answers: &[Answer], unproven: UnprovenAs, cell: Option<[f64; 2]>) -> Summary {
    let counts = AnswerCounts::of(answers);
    let asked = answers.len() - counts.outside_view - counts.outside_cloud;
    let mut section = Summary::default();
    section.add("targets", asked).add("visible", counts.visible);
    if unproven == UnprovenAs::Reported {
        section.add("unproven", counts.unproven);
    }
    section
        .add("blocked", counts.blocked)
        .add("outside_view", counts.outside_view)
        .add("outside_cloud", counts.outside_cloud)
        .add("visible_percent", percent(counts.visible, asked));
    if let Some(cell) = cell {
        section.add("visible_m2", rounded(counts.visible as f64 * cell[0] * cell[1], 1));
    }
    section
}
