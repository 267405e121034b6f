//! The table of commands, a file or folder for each.

mod ask;
mod balls;
mod bench;
mod cache;
mod calibrate;
mod cameras;
mod city;
mod comfort;
mod demo;
mod depth_map;
mod describe;
mod difference;
mod envelope;
mod fetch;
mod glare;
mod heat;
mod horizon;
mod info;
mod irradiance;
mod isovist;
mod landmark;
mod line_of_sight;
mod normals;
mod protected_view;
mod query;
mod report;
mod shadow;
mod simulate;
mod sky_view;
mod sun_calendar;
mod sun_hours;
mod sun_position;
mod surfaces;
mod survey_plan;
mod towers;
mod trajectory;
#[cfg(feature = "view")]
mod view;
mod viewshed;
mod window_views;

use crate::arguments::{Cli, Command};
use crate::help;
use crate::inputs::typed_places;
use crate::summary::Summary;
use anyhow::{Context, Result};
use belvedere::apps::ask::question_schema;
use std::io::Write;

/// Runs the command that was typed.
pub(crate) fn run(cli: &mut Cli) -> Result<Summary> {
    crate::environment::apply(&cli.global)?;
    crate::device::choose(&cli.global)?;
    typed_places::in_file_coordinates(&mut cli.command)?;
    let mut summary = run_command(cli)?;
    crate::device::report(&mut summary);
    Ok(summary)
}

fn run_command(cli: &Cli) -> Result<Summary> {
    let global = &cli.global;
    match &cli.command {
        Command::Demo(arguments) => demo::run(arguments, global),
        Command::Simulate(arguments) => simulate::run(arguments, global),
        Command::Fetch(arguments) => fetch::run(arguments, global),
        Command::Info(arguments) => info::run(arguments, global),
        Command::Trajectory(arguments) => trajectory::run(arguments, global),
        Command::Normals(arguments) => normals::run(arguments, global),
        Command::Surfaces(arguments) => surfaces::run(arguments, global),
        Command::Balls(arguments) => balls::run(arguments, global),
        Command::Calibrate(arguments) => calibrate::run(arguments, global),
        Command::Cache(arguments) => cache::run(arguments, global),
        Command::Bench(arguments) => bench::run(arguments, global, run_command),
        Command::DepthMap(arguments) => depth_map::run(arguments, global),
        Command::Query(arguments) => query::run(arguments, global),
        Command::LineOfSight(arguments) => line_of_sight::run(arguments, global),
        Command::Viewshed(arguments) => viewshed::run(arguments, global),
        Command::Towers(arguments) => towers::run(arguments, global),
        Command::Landmark(arguments) => landmark::run(arguments, global),
        Command::ProtectedView(arguments) => protected_view::run(arguments, global),
        Command::Cameras(arguments) => cameras::run(arguments, global),
        Command::SurveyPlan(arguments) => survey_plan::run(arguments, global),
        Command::Isovist(arguments) => isovist::run(arguments, global),
        Command::Horizon(arguments) => horizon::run(arguments, global),
        Command::Shadow(arguments) => shadow::run(arguments, global),
        Command::SkyView(arguments) => sky_view::run(arguments, global),
        Command::Glare(arguments) => glare::run(arguments, global),
        Command::Heat(arguments) => heat::run(arguments, global),
        Command::Irradiance(arguments) => irradiance::run(arguments, global),
        Command::SunHours(arguments) => sun_hours::run(arguments, global),
        Command::SunCalendar(arguments) => sun_calendar::run(arguments, global),
        Command::Report(arguments) => report::run(arguments, global),
        Command::SunPosition(arguments) => sun_position::run(arguments, global),
        Command::Envelope(arguments) => envelope::run(arguments, global),
        Command::Comfort(arguments) => comfort::run(arguments, global),
        Command::WindowViews(arguments) => window_views::run(arguments, global),
        #[cfg(feature = "view")]
        Command::View(arguments) => view::run(arguments, global),
        Command::City(arguments) => city::run(arguments, global),
        Command::Ask(arguments) => ask::run(arguments, global),
        Command::Difference(arguments) => difference::run(arguments, global),
        Command::Describe(arguments) if arguments.json_schema => {
            print_raw(format!("{:#}\n", serde_json::to_value(question_schema())?).as_bytes())
        }
        Command::Describe(_) => Ok(describe::run()),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut help::command(), "belvedere", &mut script);
            print_raw(&script)
        }
        Command::Man => {
            let mut page = Vec::new();
            clap_mangen::Man::new(help::command()).render(&mut page)?;
            print_raw(&page)
        }
    }
}

fn print_raw(text: &[u8]) -> Result<Summary> {
    let mut output = std::io::stdout().lock();
    output.write_all(text).and_then(|()| output.flush()).context("standard output")?;
    Ok(Summary::default())
}
