//! `belvedere landmark`.

mod results;
mod what;

use super::sights::{self, Proving, blockers, ground_cloud, local, on_map};
use super::{check_distinct, check_output, extension};
use crate::arguments::{Global, Landmark, Usage};
use crate::pipeline::{self, Points, Scene, flagged};
use crate::progress::Stages;
use crate::summary::{Summary, percent, rounded};
use anyhow::{Result, bail};
use belvedere::PointCloud;
use belvedere::apps::landmark::{LandmarkParams, LandmarkView, landmark_views, observer_cell_for};
use belvedere::apps::viewshed::{OBSERVER_HEIGHT, cell_targets};
use belvedere::ground::{Ground, MapGrid};
use belvedere::io::{RowsAre, read_observers};
use belvedere::query::{BackFaces, MedialScene, MeshTargetParams};

pub(crate) fn run(arguments: &Landmark, global: &Global) -> Result<Summary> {
    check_outputs(arguments)?;
    let earth = arguments.earth.params()?;
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let mut scene = pipeline::scene(&arguments.scene, Points::Keep, &mut stages, &mut summary)?;
    let (surface, middle) = what::surface(arguments, &scene, global.seed, &mut stages, &mut summary)?;

    let grid = grid(arguments, &scene)?;
    let rows = rows(arguments, &scene.cloud)?;
    let (cloud, points) = ground_cloud(&arguments.ground, &mut scene, &mut stages)?;
    let ground = sights::ground(&cloud, points, grid, &mut stages, &mut summary)?;
    let mut section = Summary::default();
    let (blockers, unproven) = blockers(
        &scene,
        arguments.scene.profile.into(),
        &arguments.giving_way,
        Proving::IfItDecides,
        &mut stages,
        &mut section,
    )?;
    summary.add("lines_of_sight", section);

    let height = arguments.observer_height.unwrap_or(OBSERVER_HEIGHT);
    let mut eyes = match &rows {
        Some(rows) => standing(rows, height, &ground, &cloud)?,
        None => cell_targets(&ground, height).iter().map(|eye| eye.map(f64::from)).collect(),
    };
    let enclosed = stages.run("testing observers", 0, |_| shut_out(&mut eyes, rows.is_none(), &blockers));
    let usual = LandmarkParams::default().faces;
    let params = LandmarkParams {
        faces: MeshTargetParams { back_faces: arguments.back_faces.map_or(usual.back_faces, BackFaces::from), ..usual },
        unproven,
        earth,
        max_range: arguments.max_distance.unwrap_or(f64::INFINITY),
    };
    let views = stages
        .run("testing landmark", eyes.len(), |progress| landmark_views(&blockers, &surface, &eyes, &params, progress));
    let views = flagged("--max-distance", views)?;
    summary.add("observers", told(&views, &eyes, enclosed));
    for output in &arguments.output {
        stages.run("writing", 0, |_| match extension(output).as_str() {
            "csv" => results::write_rows(output, &views, &eyes, &cloud),
            "png" => results::write_map(output, &views, &ground, &cloud, middle),
            _ => results::write_share(output, &views, &ground, &cloud),
        })?;
    }
    let mut written: Vec<String> = arguments.output.iter().map(|path| path.display().to_string()).collect();
    if let Some(folder) = &arguments.measures {
        written.extend(stages.run("writing", 0, |_| results::write_measures(folder, &views, &ground, &cloud))?);
    }
    summary.add("written", written);
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

fn check_outputs(arguments: &Landmark) -> Result<()> {
    for output in &arguments.output {
        check_output("-o", output, &["csv", "tif", "tiff", "png"])?;
        if arguments.observers.is_some() && extension(output) != "csv" {
            let output = output.display();
            return Err(Usage(format!(
                "{output}: rasters and maps need a grid of observers; with --observers use .csv"
            ))
            .into());
        }
    }
    check_distinct(&arguments.output)
}

/// The cells that observers stand in, or that the ground below those of a file is asked on.
fn grid(arguments: &Landmark, scene: &Scene) -> Result<MapGrid> {
    let [low, high] = on_map(scene.model.bounds());
    let cell = match &arguments.observers {
        Some(_) => belvedere::apps::viewshed::cell_for(low, high),
        None => arguments.cell.unwrap_or_else(|| observer_cell_for(low, high)),
    };
    let origin = [scene.cloud.frame.origin[0], scene.cloud.frame.origin[1]];
    flagged("--cell", MapGrid::covering(low, high, cell, origin))
}

/// Place of an observer, whose height may be NaN, and its height above the ground where a file tells it.
type Row = ([f64; 3], Option<f64>);

/// Observers of a file, if one was named.
fn rows(arguments: &Landmark, cloud: &PointCloud) -> Result<Option<Vec<Row>>> {
    let Some(path) = &arguments.observers else { return Ok(None) };
    let mut rows = Vec::new();
    for row in read_observers(path, &cloud.frame.crs, RowsAre::Places)? {
        let place = |corner: &[f64; 3]| std::array::from_fn(|i| corner[i] - cloud.frame.origin[i]);
        rows.extend(row.corners.iter().map(|corner| (place(corner), row.height)));
    }
    Ok(Some(rows))
}

fn standing(rows: &[Row], height: f64, ground: &Ground, cloud: &PointCloud) -> Result<Vec<[f64; 3]>> {
    let mut eyes = Vec::with_capacity(rows.len());
    for (number, &(mut eye, own)) in rows.iter().enumerate() {
        if eye[2].is_nan() {
            let Some(level) = ground.height_at([eye[0], eye[1]]) else {
                let [x, y, _] = sights::file(cloud, eye);
                bail!(
                    "observer {} at {x:.3},{y:.3}: the ground below is unknown; is the position in the coordinates of the cloud? If so, add a column z",
                    number + 1
                );
            };
            eye[2] = level + own.unwrap_or(height);
        }
        eyes.push(eye);
    }
    Ok(eyes)
}

/// Counts eyes inside what the cloud takes for solid; those of a grid are made NaN, which sees nothing.
fn shut_out(eyes: &mut [[f64; 3]], is_grid: bool, blockers: &MedialScene) -> usize {
    let mut count = 0;
    for eye in eyes.iter_mut().filter(|eye| eye[2].is_finite()) {
        if blockers.enclosure(*eye).ball_count > 0 {
            count += 1;
            if is_grid {
                *eye = [f64::NAN; 3];
            }
        }
    }
    count
}

fn told(views: &[LandmarkView], eyes: &[[f64; 3]], enclosed: usize) -> Summary {
    let standing = eyes.iter().filter(|eye| eye[2].is_finite()).count();
    let seeing = views.iter().filter(|view| view.visible_area > 0.0).count();
    let mut section = Summary::default();
    section
        .add("count", standing)
        .add("observers_inside_obstacles", enclosed)
        .add("observers_with_view", seeing)
        .add("observers_with_view_percent", percent(seeing, standing));
    let best = views.iter().enumerate().filter(|(_, view)| view.visible_area > 0.0);
    if let Some((row, view)) = best.max_by(|a, b| a.1.visible_share().total_cmp(&b.1.visible_share())) {
        section
            .add("max_visible_share", rounded(view.visible_share(), 4))
            .add("max_visible_share_observer", row + 1)
            .add("max_visible_share_solid_angle_sr", rounded(view.solid_angle, 5));
    }
    section
}

/// Local place on the map of file coordinates.
fn on_map_of(cloud: &PointCloud, [x, y]: [f64; 2]) -> [f64; 2] {
    let [x, y, _] = local(cloud, [x, y, 0.0]);
    [x, y]
}
