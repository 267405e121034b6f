//! `belvedere glare`.

use crate::arguments::{GlareArguments, Global, refuse};
use crate::inputs::windows::{FaceChoice, WindowFile};
use crate::outputs::formats::{check_outputs, extension};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{self, Ask, Days, GivenWindow, GivenWindows, GlareResults, Places};
use belvedere::figures::{DayPiece, day_chart, write_png};
use belvedere::io::{is_mesh, write_table};
use std::path::Path;

/// Maximum number of days of a chart.
const MAX_DAYS: usize = 731;
/// Colours of glare, and of glare that may leave an after-image.
const WEAK: [u8; 3] = [86, 160, 211];
const STRONG: [u8; 3] = [217, 95, 2];
const MONTHS: [&str; 12] = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];

pub(crate) fn run(arguments: &GlareArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["csv", "png"])?;
    check_outputs("--by-hour", &arguments.by_hour, &["csv"])?;
    if is_mesh(&arguments.reflectors) {
        return refuse("--reflectors: give a table (.csv) of rectangles, not a mesh");
    }
    check_charts(arguments, arguments.eyes.min_count()?)?;
    let mut run = CommandContext::new(global);
    // wrong reflectors must not be found out after the balls were made
    let mut question = question(arguments, read(arguments, &Frame::default(), &mut run)?.0)?;
    question.check()?;
    let scene = arguments.eyes.scene(&arguments.scene, None, Some(&arguments.far), &mut run)?;
    let (reflectors, names) = read(arguments, scene.frame(), &mut run)?;
    question.reflectors = reflectors;
    let standing = arguments.eyes.standing((scene.frame(), &scene.model().bounds()), &mut run)?;
    check_charts(arguments, standing.len())?;
    let answers = run.ask(&scene, &question, &Places::Eyes(standing))?;
    let found = &answers.found;
    check_days(arguments, found.schedule.days.len())?;
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "png" => write_chart(output, found),
            _ => Ok(write_table(output, &found.columns(&names))?),
        })?;
    }
    if let Some(output) = &arguments.by_hour {
        run.stage("writing", 0, |_| write_table(output, &found.columns_by_hour()))?;
    }
    run.summary.add_paths("written", arguments.output.iter().chain(&arguments.by_hour));
    Ok(run.finish())
}

fn question(arguments: &GlareArguments, reflectors: Vec<GivenWindow>) -> Result<ask::GlareQuestion> {
    let days = arguments.when.days();
    let days = if arguments.when.is_given() { days } else { Days { year: Some(arguments.when.year), ..days } };
    Ok(ask::GlareQuestion {
        reflectors,
        observer_height: arguments.eyes.height,
        ground: arguments.eyes.ground.points(),
        days,
        place: arguments.sun.place(&arguments.north)?,
        scatter_deg: arguments.scatter,
        from_sun_deg: arguments.from_sun,
    })
}

/// The reflectors of the table in a frame, and their names.
fn read(
    arguments: &GlareArguments,
    frame: &Frame,
    run: &mut CommandContext,
) -> Result<(Vec<GivenWindow>, Vec<String>)> {
    let file = WindowFile::read(&arguments.reflectors, &FaceChoice::default(), frame, run)?;
    let names = file.buildings(&[]);
    match file.given {
        GivenWindows::Each(reflectors) => Ok((reflectors, names)),
        GivenWindows::Faces(_) => Ok((Vec::new(), names)),
    }
}

/// Refuses charts of several observers.
fn check_charts(arguments: &GlareArguments, count: usize) -> Result<()> {
    match arguments.output.iter().find(|output| count > 1 && extension(output) == "png") {
        Some(output) => {
            let output = output.display();
            refuse(format!("{output}: a chart is of a single observer, but there are {count}; use .csv"))
        }
        None => Ok(()),
    }
}

/// Refuses charts of more than two years.
fn check_days(arguments: &GlareArguments, count: usize) -> Result<()> {
    match arguments.output.iter().find(|output| count > MAX_DAYS && extension(output) == "png") {
        Some(output) => {
            refuse(format!("{}: a chart holds two years, but there are {count} days; use .csv", output.display()))
        }
        None => Ok(()),
    }
}

/// Draws the glare of the first observer.
fn write_chart(output: &Path, found: &GlareResults) -> Result<()> {
    let days = &found.schedule.days;
    let label = |(row, day): (usize, &belvedere::apps::sun::DayOfLight)| match (day.date.day(), row) {
        (1, _) => MONTHS
            .get(usize::from(day.date.month().unsigned_abs()).wrapping_sub(1))
            .copied()
            .unwrap_or_default()
            .to_owned(),
        (_, 0) => day.date.to_string(),
        _ => String::new(),
    };
    let labels: Vec<String> = days.iter().enumerate().map(label).collect();
    let light = days.iter().map(|day| match (day.steps.first(), day.steps.last()) {
        (Some(first), Some(last)) => [f64::from(first.start), f64::from(last.start + last.hours)],
        _ => [0.0; 2],
    });
    let light: Vec<[f64; 2]> = light.collect();
    let pieces = found.of_observers.first().into_iter().flat_map(|own| &own.of_any).map(|stretch| DayPiece {
        day: stretch.day,
        hours: [f64::from(stretch.start), f64::from(stretch.end)],
        color: if stretch.after_image > 0.0 { STRONG } else { WEAK },
    });
    let pieces: Vec<DayPiece> = pieces.collect();
    let title = match found.of_observer(0) {
        Some(own) => format!("Glare, {:.1} h on {} of {} days", own.hours, own.days, days.len()),
        None => "Glare: the observer cannot look".to_owned(),
    };
    let legend = [(STRONG, "after-images possible"), (WEAK, "weaker")];
    Ok(write_png(output, &day_chart(&labels, &light, &pieces, &legend, &title))?)
}
