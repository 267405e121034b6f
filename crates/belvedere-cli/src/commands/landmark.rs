//! `belvedere landmark`.

mod results;
pub(super) mod what;

use super::sights::{self, ground_cloud, proving_blockers, skip_unfit};
use super::surroundings::rows_as_given;
use super::{check_output, extension};
use crate::arguments::{Global, Landmark, Usage};
use crate::pipeline::{self, Points, Scene, flagged};
use crate::run::Run;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::landmark::{LandmarkParams, LandmarkReport, landmark_views, observer_cell_for};
use belvedere::apps::targets::{CellParams, Targets, set_on_ground};
use belvedere::apps::viewshed::OBSERVER_HEIGHT;
use belvedere::ground::{Ground, MapGrid};
use belvedere::io::{RowsAre, read_observers};
use belvedere::query::{BackFaces, MeshTargetParams};

pub(crate) fn run(arguments: &Landmark, global: &Global) -> Result<Summary> {
    check_outputs(arguments)?;
    let earth = arguments.earth.params()?;
    let mut run = Run::new(global);
    let mut scene = pipeline::scene(&arguments.scene, Points::Keep, &mut run)?;
    let (surface, middle) = what::surface(&arguments.shape, &scene, &mut run)?;

    let grid = grid(arguments, &scene)?;
    let rows = rows(arguments, &scene.cloud)?;
    let (cloud, points) = ground_cloud(&arguments.ground, &mut scene, &mut run)?;
    let ground = sights::ground(&cloud, points, grid, &mut run)?;
    let profile = arguments.scene.profile.into();
    let (blockers, unproven) = proving_blockers(&scene, profile, &arguments.giving_way, &mut run)?;

    let height = arguments.observer_height.unwrap_or(OBSERVER_HEIGHT);
    let places: Vec<[f64; 3]>;
    let (eyes, inside) = match &rows {
        Some(rows) => {
            places = standing(rows, height, &ground);
            let mut eyes = places.clone();
            let who = ("observer", &cloud.frame);
            let report = skip_unfit(&blockers, Some(&ground), who, &mut eyes, &mut run)?;
            run.summary.add("observers_given", Summary::of(&report));
            (eyes, report.skipped_inside_obstacle)
        }
        None => {
            let (eyes, inside, left_out) = run.stage("testing observers", 0, |control| {
                let cells = CellParams::default().with_height(height);
                let (mut targets, mut left_out) = Targets::of_cells(&cloud, ground.clone(), &cells, control)?;
                if let Some(added) = scene.model.added() {
                    left_out.cells_below_objects_excluded += targets.set_on_added(added, &cells);
                }
                let inside = targets.leave_out_enclosed(&blockers, control)?;
                let eyes: Vec<[f64; 3]> = targets.positions.iter().map(|eye| eye.map(f64::from)).collect();
                Ok::<_, anyhow::Error>((eyes, inside, left_out))
            })?;
            run.summary.add_report(&left_out);
            places = eyes.clone();
            (eyes, inside)
        }
    };
    let usual = LandmarkParams::default().faces;
    let params = LandmarkParams::default()
        .with_faces(MeshTargetParams {
            back_faces: arguments.back_faces.map_or(usual.back_faces, BackFaces::from),
            ..usual
        })
        .with_unproven(unproven)
        .with_earth(earth)
        .with_max_range(arguments.max_distance.unwrap_or(f64::INFINITY));
    let views = run.stage("testing landmark", eyes.len(), |progress| {
        landmark_views(&blockers, &surface, &eyes, &params, progress)
    });
    let views = flagged("--max-distance", views)?;
    run.summary.add("observers", Summary::of(&LandmarkReport::new(&views, &eyes, inside)));
    let given = rows_as_given(arguments.observers.as_deref())?;
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "csv" => results::write_rows(output, &views, &places, &given, &cloud),
            "png" => results::write_map(output, &views, &ground, &cloud, middle),
            _ => results::write_share(output, &views, &ground, &cloud),
        })?;
    }
    let mut written: Vec<String> = arguments.output.iter().map(|path| path.display().to_string()).collect();
    if let Some(folder) = &arguments.measures {
        written.extend(run.stage("writing", 0, |_| results::write_measures(folder, &views, &ground, &cloud))?);
    }
    run.summary.add("written", written);
    Ok(run.finish())
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
    Ok(())
}

/// The cells that observers stand in, or that the ground below those of a file is asked on.
fn grid(arguments: &Landmark, scene: &Scene) -> Result<MapGrid> {
    let (low, high) = scene.model.bounds().on_map();
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

/// Where observers of a file stand; the height is NaN where no ground is known.
fn standing(rows: &[Row], height: f64, ground: &Ground) -> Vec<[f64; 3]> {
    let mut eyes: Vec<[f64; 3]> = rows.iter().map(|row| row.0).collect();
    let heights = rows.iter().map(|row| row.1.unwrap_or(height));
    set_on_ground(eyes.iter_mut().zip(heights), ground);
    eyes
}

/// Local place on the map of file coordinates.
fn on_map_of(cloud: &PointCloud, [x, y]: [f64; 2]) -> [f64; 2] {
    let [x, y, _] = cloud.frame.local_from_file([x, y, 0.0]);
    [x, y]
}
