//! `belvedere horizon`.

use super::sights::{Proving, blockers};
use super::surroundings::{check_eyes, eyes, least_count, needs_ground};
use super::{check_output, extension};
use crate::arguments::{BelowChoice, GivingWay, Global, Horizon, Usage};
use crate::pipeline::{self, Points};
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::edge::horizon_share_near_edge;
use belvedere::apps::horizon::{HorizonParams, azimuth_count, horizons};
use belvedere::figures::{horizon_picture, write_png};
use belvedere::io::atomic;
use belvedere::query::SkylinePoint;
use std::io::Write;
use std::path::Path;

pub(crate) fn run(arguments: &Horizon, global: &Global) -> Result<Summary> {
    for output in &arguments.output {
        check_output("-o", output, &["csv", "txt", "png"])?;
    }
    let earth = arguments.earth.params()?;
    let usual = HorizonParams::default();
    let azimuth_count = match arguments.step {
        Some(step) => azimuth_count(step.to_radians())?,
        None => usual.azimuth_count,
    };
    check_formats(arguments, least_count(arguments.eyes.eye.len(), arguments.eyes.eyes.as_deref())?)?;
    let mut run = Run::new(global);
    let points = if needs_ground(&arguments.eyes) { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    arguments.far.set(&mut scene, &mut run)?;
    let mut places = eyes(&arguments.eyes, &mut scene, &mut run)?;
    check_formats(arguments, places.len())?;
    let north = match places.first() {
        Some(eye) => arguments.north.at(&scene, [eye[0], eye[1]]),
        None => arguments.north.of_scene(&scene),
    };
    north.report(&mut run.summary);
    let mut section = Summary::default();
    let giving_way = GivingWay { shell: None, unproven: None };
    let (blockers, _) = blockers(&scene, scene.profile, &giving_way, Proving::Never, &mut run, &mut section)?;
    run.summary.add("lines_of_sight", section);
    check_eyes(&blockers, &scene.cloud.frame, &mut places, &mut run)?;
    let params = HorizonParams::default().with_azimuth_count(azimuth_count).with_turn(north.of_grid).with_earth(earth);
    let found =
        run.stage("computing ranges", places.len(), |control| horizons(&blockers, &places, &params, control))?;
    let least = if arguments.below == BelowChoice::Zero { 0.0 } else { -90.0 };
    let elevations: Vec<Vec<f64>> = found
        .iter()
        .map(|skyline| skyline.iter().map(|point| point.elevation.to_degrees().max(least)).collect())
        .collect();
    let mut section = told(&elevations);
    if let Some(coverage) = scene.model.coverage() {
        let known = || places.iter().zip(&found).filter(|(eye, _)| eye[0].is_finite());
        let share = |(eye, skyline): (&[f64; 3], &Vec<SkylinePoint>)| {
            horizon_share_near_edge(&coverage, *eye, skyline, -north.of_grid)
        };
        let mean = known().map(share).sum::<f64>() / known().count().max(1) as f64;
        section.add("azimuths_near_edge_percent", rounded(100.0 * mean, 2));
    }
    run.summary.add("horizons", section);
    for output in &arguments.output {
        run.stage("writing", 0, |_| match (extension(output).as_str(), elevations.first()) {
            ("png", Some(one)) => write_png(output, &horizon_picture(one, "Horizon elevation, degrees")),
            ("txt", Some(one)) => write_lines(output, one.iter().map(|v| format!("{v:.2}"))),
            _ => write_columns(output, &elevations, azimuth_count),
        })?;
    }
    run.summary
        .headline("mean elevation of the horizon: <horizons.mean_elevation_deg> degrees, highest <horizons.max_elevation_deg>")
        .headline("<horizons.azimuths> azimuths[, <horizons.azimuths_near_edge_percent> % of them near the edge of the cloud]");
    run.summary.add("written", arguments.output.iter().map(|path| path.display().to_string()).collect::<Vec<_>>());
    Ok(run.finish())
}

/// Refuses formats that hold one observer where there are more.
fn check_formats(arguments: &Horizon, count: usize) -> Result<()> {
    match arguments.output.iter().find(|output| count > 1 && extension(output) != "csv") {
        Some(output) => {
            let output = output.display();
            let what = format!("{output}: the format holds a single observer, but there are {count}; use .csv");
            Err(Usage(what).into())
        }
        None => Ok(()),
    }
}

fn told(elevations: &[Vec<f64>]) -> Summary {
    let mut section = Summary::default();
    let all = || elevations.iter().flatten().copied();
    let count = elevations.iter().map(Vec::len).sum::<usize>().max(1);
    section
        .add("azimuths", elevations.iter().map(Vec::len).max().unwrap_or(0))
        .add("mean_elevation_deg", rounded(all().sum::<f64>() / count as f64, 3))
        .add("max_elevation_deg", rounded(all().fold(-90.0, f64::max), 3));
    section
}

/// Azimuths, and a column of elevations for each eye.
fn write_columns(output: &Path, elevations: &[Vec<f64>], count: usize) -> belvedere::Result<()> {
    let header = match elevations.len() {
        1 => "azimuth,elevation".to_owned(),
        eyes => (1..=eyes).fold("azimuth".to_owned(), |header, eye| format!("{header},elevation_{eye}")),
    };
    let row = |i: usize| {
        // six decimals for steps that are no whole numbers, without the zeros of those that are
        let azimuth = format!("{:.6}", 360.0 * i as f64 / count as f64);
        let azimuth = azimuth.trim_end_matches('0').trim_end_matches('.').to_owned();
        // a skipped observer has empty cells
        let cell = |eye: &Vec<f64>| eye.get(i).map(|elevation| format!("{elevation:.4}")).unwrap_or_default();
        elevations.iter().fold(azimuth, |row, eye| format!("{row},{}", cell(eye)))
    };
    write_lines(output, std::iter::once(header).chain((0..count).map(row)))
}

pub(super) fn write_lines(output: &Path, lines: impl Iterator<Item = String>) -> belvedere::Result<()> {
    let text: String = lines.map(|line| line + "\n").collect();
    atomic::write(output, |file| file.write_all(text.as_bytes()).map_err(belvedere::Error::io(output)))
}
