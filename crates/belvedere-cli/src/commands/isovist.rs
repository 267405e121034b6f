//! `belvedere isovist`.

use super::sights::{Proving, blockers};
use super::surroundings::{check_eyes, eyes, least_count, needs_ground, rows_as_given};
use super::{check_output, extension};
use crate::arguments::{GivingWay, Global, Isovist, Usage};
use crate::pipeline::{self, Points};
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::isovist::{self, IsovistParams};
use belvedere::figures::{panorama_picture, write_png};
use belvedere::io::{Cells, TextRows, atomic, with_columns_read, write_table};
use serde_json::{Map, Value, json};
use std::io::Write;
use std::path::Path;

pub(crate) fn run(arguments: &Isovist, global: &Global) -> Result<Summary> {
    for output in &arguments.output {
        check_output("-o", output, &["csv", "json", "png"])?;
    }
    let mut run = Run::new(global);
    check_pictures(arguments, least_count(arguments.eyes.eye.len(), arguments.eyes.eyes.as_deref())?)?;
    let points = if needs_ground(&arguments.eyes) { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    let places = eyes(&arguments.eyes, &mut scene, &mut run)?;
    check_pictures(arguments, places.len())?;
    let north = arguments.north.of_scene(&scene);
    north.report(&mut run.summary);
    let mut section = Summary::default();
    let giving_way = GivingWay { shell: None, unproven: None };
    let (blockers, _) = blockers(&scene, scene.profile, &giving_way, Proving::Never, &mut run, &mut section)?;
    let usual = IsovistParams::default();
    let params = IsovistParams::default()
        .with_step(arguments.step.map_or(usual.step, f64::to_radians))
        .with_max_range(arguments.max_distance.unwrap_or(usual.max_range))
        .with_jump(arguments.jump.unwrap_or(usual.jump));
    let mut fit = places.clone();
    check_eyes(&blockers, &scene.cloud.frame, &mut fit, &mut run)?;
    let isovists = run.stage("computing ranges", places.len(), |progress| {
        let look = |&eye: &[f64; 3]| {
            let isovist = isovist::isovist(&blockers, eye, &params, progress);
            progress.advance(1);
            isovist
        };
        // a skipped eye has a row without measures
        fit.iter().map(|eye| eye[0].is_finite().then(|| look(eye)).transpose()).collect::<belvedere::Result<Vec<_>>>()
    })?;
    let rows = rows(&scene.cloud, &places, &isovists, north.of_grid);
    if let [row] = &rows[..] {
        let mut section = Summary::default();
        for &(name, value, decimals) in row {
            section.add(name, rounded(value, i32::try_from(decimals).unwrap_or(4)));
        }
        run.summary.add("isovist", section);
    }
    let given = rows_as_given(arguments.eyes.eyes.as_deref())?;
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "json" => write_json(output, &rows, &isovists, north.of_grid),
            "png" => {
                let Some(Some(isovist)) = isovists.first() else { return Ok(()) };
                write_png(output, &panorama_picture(&isovist.panorama, "Ranges around the observer"))
            }
            _ => write_rows(output, &rows, &given),
        })?;
    }
    run.summary
        .headline("visible space: <isovist.volume_m3> m3; on the map <isovist.plan_area_m2> m2")
        .headline("mean distance to what is seen: <isovist.range_mean_m> m, at most <isovist.range_max_m> m")
        .headline("open sky: share <isovist.sky_openness>");
    if places.len() > 1 {
        run.summary.headline("observers: <observers.count>, of which <observers.skipped> cannot stand where they are");
    }
    run.summary.add("written", arguments.output.iter().map(|path| path.display().to_string()).collect::<Vec<_>>());
    Ok(run.finish())
}

/// Refuses pictures of several observers.
fn check_pictures(arguments: &Isovist, count: usize) -> Result<()> {
    match arguments.output.iter().find(|output| count > 1 && extension(output) == "png") {
        Some(output) => {
            let output = output.display();
            Err(Usage(format!("{output}: a picture shows a single observer, but there are {count}")).into())
        }
        None => Ok(()),
    }
}

/// Name, value and decimals of every measure.
type Row = Vec<(&'static str, f64, usize)>;

/// A row for each eye; one that was skipped has its coordinates alone.
fn rows(cloud: &PointCloud, places: &[[f64; 3]], isovists: &[Option<isovist::Isovist>], grid_north: f64) -> Vec<Row> {
    let Some(known) = isovists.iter().flatten().next() else { return Vec::new() };
    let of_place = |(&place, isovist): (&[f64; 3], &Option<isovist::Isovist>)| match isovist {
        Some(isovist) => row(cloud, place, isovist, grid_north),
        None => {
            let mut row = row(cloud, place, known, grid_north);
            row.iter_mut().skip(3).for_each(|(_, value, _)| *value = f64::NAN);
            row
        }
    };
    places.iter().zip(isovists).map(of_place).collect()
}

fn row(cloud: &PointCloud, eye: [f64; 3], isovist: &isovist::Isovist, grid_north: f64) -> Row {
    let [x, y, z] = cloud.frame.file_from_local(eye);
    let mut row: Row = vec![("x", x, 3), ("y", y, 3), ("z", z, 3)];
    row.extend(isovist.figures(grid_north).map(|figure| (figure.name, figure.value, figure.decimals)));
    row
}

/// A row for each observer, with what a table said of it.
fn write_rows(output: &Path, rows: &[Row], given: &TextRows) -> belvedere::Result<()> {
    let Some(first) = rows.first() else { return Ok(()) };
    let columns: Vec<Vec<f64>> = (0..first.len()).map(|i| rows.iter().map(|row| row[i].1).collect()).collect();
    let named: Vec<(&'static str, Cells<'_>)> = first
        .iter()
        .zip(&columns)
        .map(|(&(name, _, decimals), values)| (name, Cells::Real(values, decimals)))
        .collect();
    let read = given.columns(0..given.row_count());
    write_table(output, &with_columns_read(&read, &["x", "y", "z"], &named))
}

fn write_json(
    output: &Path,
    rows: &[Row],
    isovists: &[Option<isovist::Isovist>],
    grid_north: f64,
) -> belvedere::Result<()> {
    let object = |(row, isovist): (&Row, &Option<isovist::Isovist>)| {
        let mut object: Map<String, Value> =
            row.iter().map(|&(name, value, _)| (name.to_owned(), json!(value))).collect();
        let corners = isovist.iter().flat_map(|isovist| &isovist.plan.corners);
        let corners: Vec<Value> = corners
            .map(|[azimuth, range]| json!([(azimuth + grid_north).to_degrees().rem_euclid(360.0), range]))
            .collect();
        object.insert("plan_corners_azimuth_deg_range_m".to_owned(), corners.into());
        Value::Object(object)
    };
    let all: Vec<Value> = rows.iter().zip(isovists).map(object).collect();
    atomic::write(output, |file| writeln!(file, "{}", json!({ "isovists": all })).map_err(belvedere::Error::io(output)))
}
