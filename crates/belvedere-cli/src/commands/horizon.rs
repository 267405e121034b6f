//! `belvedere horizon`.

use crate::arguments::{BelowChoice, Global, HorizonArguments, refuse};
use crate::outputs::formats::{check_outputs, extension};
use crate::outputs::text::write_lines;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, BelowLevel, HorizonResults, Places};
use belvedere::figures::{horizon_picture, write_png};
use std::path::Path;

pub(crate) fn run(arguments: &HorizonArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["csv", "txt", "hor", "png"])?;
    let question = ask::HorizonQuestion {
        observer_height: arguments.eyes.height,
        ground: arguments.eyes.ground.points(),
        angle_step_deg: arguments.step,
        earth: arguments.earth.params()?,
        north: arguments.north.choice(),
        below: if arguments.below == BelowChoice::Zero { BelowLevel::Zero } else { BelowLevel::Keep },
        interval: arguments.interval.interval,
    };
    question.check()?;
    check_formats(arguments, arguments.eyes.min_count()?)?;
    let mut run = CommandContext::new(global);
    let scene = arguments.eyes.scene(&arguments.scene, None, Some(&arguments.far), &mut run)?;
    let standing = arguments.eyes.standing((scene.frame(), &scene.model().bounds()), &mut run)?;
    check_formats(arguments, standing.len())?;
    let answers = run.ask(&scene, &question, &Places::Eyes(standing))?;
    let HorizonResults { elevations_deg: elevations, intervals_deg: intervals, .. } = &answers.found;
    let ends = intervals.as_ref().and_then(|intervals| intervals.first()).map(Vec::as_slice);
    let title = match ends {
        Some(_) => "Horizon elevation, degrees; light grey: where the sky begins in nine of ten cases",
        None => "Horizon elevation, degrees",
    };
    for output in &arguments.output {
        run.stage("writing", 0, |_| match (extension(output).as_str(), elevations.first()) {
            ("png", Some(one)) => write_png(output, &horizon_picture(one, ends, title)),
            ("txt", Some(one)) => write_lines(output, one.iter().map(|v| format!("{v:.2}"))),
            ("hor", Some(one)) => write_lines(output, rows_from_south(one)),
            _ => write_columns(output, &answers.found),
        })?;
    }
    run.summary.add_paths("written", &arguments.output);
    Ok(run.finish())
}

/// Refuses formats that hold one observer where there are more, or no interval where it is wanted.
fn check_formats(arguments: &HorizonArguments, count: usize) -> Result<()> {
    let has_no_interval =
        |output: &&std::path::PathBuf| arguments.interval.interval && ["txt", "hor"].contains(&&*extension(output));
    if let Some(output) = arguments.output.iter().find(has_no_interval) {
        return refuse(format!(
            "{}: the format has no columns of an interval; use .csv, or leave out --interval",
            output.display()
        ));
    }
    match arguments.output.iter().find(|output| count > 1 && extension(output) != "csv") {
        Some(output) => {
            let output = output.display();
            refuse(format!("{output}: the format holds a single observer, but there are {count}; use .csv"))
        }
        None => Ok(()),
    }
}

/// Rows of azimuth and elevation in degrees as PV*SOL reads them: from −180 (north) through 0 (south) to below 180,
/// west positive.
///
/// # Source
/// Valentin Software, help of PV*SOL, "Shading", section on the format `.hor`.
fn rows_from_south(elevations: &[f64]) -> impl Iterator<Item = String> {
    let count = elevations.len() as f64;
    let azimuth = move |index: usize| 360.0 * index as f64 / count - 180.0;
    elevations.iter().enumerate().map(move |(index, elevation)| format!("{} {elevation:.2}", azimuth(index)))
}

/// Azimuths, and for each eye a column of elevations, and two of the ends of intervals where they are known.
fn write_columns(output: &Path, found: &HorizonResults) -> belvedere::Result<()> {
    let HorizonResults { azimuth_count: count, elevations_deg: elevations, intervals_deg: intervals, .. } = found;
    let names: &[&str] = if intervals.is_some() { &["elevation", "low", "high"] } else { &["elevation"] };
    let header = (1..=elevations.len()).fold("azimuth".to_owned(), |header, eye| {
        let end = if elevations.len() == 1 { String::new() } else { format!("_{eye}") };
        names.iter().fold(header, |header, name| format!("{header},{name}{end}"))
    });
    let row = |i: usize| {
        // six decimals for steps that are no whole numbers, without the zeros of those that are
        let azimuth = format!("{:.6}", 360.0 * i as f64 / *count as f64);
        let azimuth = azimuth.trim_end_matches('0').trim_end_matches('.').to_owned();
        // a skipped observer has empty cells
        let cell = |value: Option<f64>| value.map(|elevation| format!("{elevation:.4}")).unwrap_or_default();
        elevations.iter().enumerate().fold(azimuth, |row, (eye, of_eye)| {
            let ends = intervals.as_ref().map(|all| all.get(eye).and_then(|ends| ends.get(i)).copied());
            let ends = ends.map(|ends| [0, 1].map(|end| cell(ends.map(|ends| ends[end]))));
            let row = format!("{row},{}", cell(of_eye.get(i).copied()));
            ends.map_or(row.clone(), |[low, high]| format!("{row},{low},{high}"))
        })
    };
    write_lines(output, std::iter::once(header).chain((0..*count).map(row)))
}
