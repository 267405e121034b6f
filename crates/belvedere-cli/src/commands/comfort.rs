//! `belvedere comfort`.

mod places;

use super::check_output;
use super::sights::{Proving, blockers};
use super::sights::{leave_out_outside, report_edge};
use super::windows::{FaceChoice, windows};
use crate::arguments::{Comfort, Global, PatchesChoice, Usage};
use crate::pipeline::{self, Points};
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::exposure::{Exposure, ShadeAtEachSun, scene_exposure};
use belvedere::apps::sky_view::{SKY_DIRECTIONS, SkyDirections};
use belvedere::apps::sun::{Binning, SunSchedule, sun_days};
use belvedere::apps::targets::Measure;
use belvedere::io::{Cells, with_columns_read, write_table};
use places::{Places, routes};
use std::path::Path;

pub(crate) fn run(arguments: &Comfort, global: &Global) -> Result<Summary> {
    for (flag, output) in [
        ("-o", Some(&arguments.output)),
        ("--routes", arguments.routes.as_ref()),
        ("--times", arguments.times.as_ref()),
    ] {
        if let Some(output) = output {
            check_output(flag, output, &["csv"])?;
        }
    }
    if !arguments.when.is_given() {
        return Err(Usage("a period is missing: give --date DAY, or --from and --to".to_owned()).into());
    }
    let sky = match arguments.patches {
        Some(PatchesChoice::Tregenza) => SkyDirections::patches(1)?,
        Some(PatchesChoice::Reinhart) => SkyDirections::patches(2)?,
        None => SkyDirections::even(arguments.directions.unwrap_or(SKY_DIRECTIONS))?,
    };
    let mut run = Run::new(global);
    let points = if arguments.places.route.is_some() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    let site = arguments.place.site(&scene, &mut run.summary)?;
    let zone = arguments.place.zone(&site, &arguments.when.times())?;
    let params = arguments.when.params(&arguments.place)?;
    let Some(period) = arguments.when.period(&arguments.place, &site, &zone)? else {
        return Err(Usage("a period is missing: give --date DAY, or --from and --to".to_owned()).into());
    };
    let days = sun_days(&site, &zone, &period, &params)?;
    // each row of --times is about a sun of its own
    let binning = if arguments.times.is_some() { Binning::Exact } else { Binning::Auto };
    let schedule = SunSchedule::new(&days, binning)?;
    let mut section = Summary::default();
    section
        .add("days", schedule.days.len())
        .add("time_zone", zone.name())
        .add("suns", schedule.days.iter().map(|day| day.steps.len()).sum::<usize>())
        .add("directions", schedule.directions.len())
        .add("possible_hours_per_day", rounded(schedule.possible_hours() / schedule.days.len().max(1) as f64, 3));
    run.summary.add("period", section);
    let north = arguments.north.of_scene(&scene);
    if arguments.places.windows.is_some() || arguments.times.is_some() {
        north.report(&mut run.summary);
    }
    let mut places = match (&arguments.places.route, &arguments.places.windows) {
        (Some(route), _) => routes(arguments, route, &mut scene, &mut run)?,
        (None, Some(path)) => {
            let choice = FaceChoice { spacing: arguments.spacing, objects: &[] };
            windows(path, &choice, (&scene, north.of_grid), &mut run)?.into()
        }
        (None, None) => return Err(Usage("targets are missing: give --route or --windows".to_owned()).into()),
    };
    leave_out_outside(&mut places.targets, &scene, &mut run.summary);
    let directions = [sky.directions.as_slice(), &schedule.directions].concat();
    report_edge(&places.targets, &scene, &directions, &mut run)?;
    let mut section = Summary::default();
    let profile = scene.profile;
    let (blockers, _) =
        blockers(&scene, profile, &arguments.shell.giving_way(), Proving::Never, &mut run, &mut section)?;
    section.add("sky_directions", sky.directions.len());
    run.summary.add("lines_of_sight", section);
    let targets = &places.targets;
    let shade = if arguments.times.is_some() { ShadeAtEachSun::Kept } else { ShadeAtEachSun::NotKept };
    let found = run.stage("testing sky and sun", 2 * targets.len(), |control| {
        scene_exposure(&blockers, targets, &sky, &schedule, shade, control)
    })?;
    write_rows(&arguments.output, &places, &found)?;
    let mut section = Summary::default();
    section.add(places.kind, targets.groups.len()).add("targets", targets.len());
    for (measure, mean) in found.means(targets) {
        section.add(&format!("mean_{}", measure.name), rounded(mean, digits(measure)));
    }
    run.summary.add("exposure", section);
    if let Some(output) = &arguments.routes {
        write_groups(output, &places, &found)?;
    }
    if let Some(output) = &arguments.times {
        write_times(output, &found, &schedule, north.of_grid)?;
    }
    let written = [Some(&arguments.output), arguments.routes.as_ref(), arguments.times.as_ref()];
    let written: Vec<String> = written.into_iter().flatten().map(|path| path.display().to_string()).collect();
    run.summary
        .headline("routes: <exposure.routes>, with <exposure.targets> places")
        .headline("windows: <exposure.windows>, with <exposure.targets> places")
        .headline("sun: <exposure.mean_sun_hours> h a day on average, <exposure.mean_longest> h without a break")
        .headline("sky view factor: <exposure.mean_sky_view_factor> on average");
    run.summary.add("written", written);
    Ok(run.finish())
}

fn digits(measure: &Measure) -> i32 {
    i32::try_from(measure.decimals).unwrap_or(3)
}

/// A row for each place of routes, or for each window.
fn write_rows(output: &Path, places: &Places, found: &Exposure) -> Result<()> {
    if places.targets.normals.is_some() {
        return write_groups(output, places, found);
    }
    let columns: Vec<(&str, Vec<f64>, usize)> = found
        .measures
        .iter()
        .map(|(m, _)| (m.name.as_str(), m.values.iter().map(|&v| f64::from(v)).collect(), m.decimals))
        .collect();
    let numbered = places.targets.groups.iter().zip(1_u64..);
    let groups: Vec<Option<u64>> =
        numbered.flat_map(|(group, number)| group.clone().map(move |_| Some(number))).collect();
    let mut cells = vec![("route", Cells::Whole(&groups))];
    cells.extend(places.place_columns.iter().map(|(name, values, d)| (*name, Cells::Real(values, *d))));
    cells.extend(columns.iter().map(|(name, values, d)| (*name, Cells::Real(values, *d))));
    Ok(write_table(output, &cells)?)
}

/// A row for each route or window.
fn write_groups(output: &Path, places: &Places, found: &Exposure) -> Result<()> {
    let of_measure = |(number, (m, _)): (usize, &(Measure, _))| {
        (m.name.clone(), found.of_groups(number, &places.targets), m.decimals)
    };
    let columns: Vec<(String, Vec<f64>, usize)> = found.measures.iter().enumerate().map(of_measure).collect();
    let numbers: Vec<Option<u64>> = (1..).take(places.targets.groups.len()).map(Some).collect();
    let names: Vec<&str> = places.names.iter().map(String::as_str).collect();
    let mut cells = vec![(places.row_name, Cells::Whole(&numbers))];
    if !names.is_empty() {
        cells.push(("name", Cells::Words(&names)));
    }
    cells.extend(places.group_columns.iter().map(|(name, values, d)| (*name, Cells::Real(values, *d))));
    cells.extend(columns.iter().map(|(name, values, d)| (name.as_str(), Cells::Real(values, *d))));
    let read = places.given.columns(0..places.given.row_count());
    Ok(write_table(output, &with_columns_read(&read, &["x", "y", "z", "azimuth", "tilt"], &cells))?)
}

/// A row for each route and sun.
fn write_times(output: &Path, found: &Exposure, schedule: &SunSchedule, grid_north: f64) -> Result<()> {
    let (mut numbers, mut dates) = (Vec::new(), Vec::new());
    let mut columns: [Vec<f64>; 4] = std::array::from_fn(|_| Vec::new());
    for (shares, number) in found.shaded_shares.iter().zip(1_u64..) {
        for day in &schedule.days {
            for step in &day.steps {
                let row = step.direction as usize;
                let [azimuth, elevation] = schedule.grid_azimuth_and_elevation(row);
                numbers.push(Some(number));
                dates.push(day.date.to_string());
                let azimuth = (azimuth + grid_north).to_degrees().rem_euclid(360.0);
                let values = [step.middle(), azimuth, elevation.to_degrees(), shares[row]];
                columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
            }
        }
    }
    let dates: Vec<&str> = dates.iter().map(String::as_str).collect();
    let [hours, azimuths, elevations, shares] = &columns;
    Ok(write_table(
        output,
        &[
            ("route", Cells::Whole(&numbers)),
            ("date", Cells::Words(&dates)),
            ("hour", Cells::Real(hours, 4)),
            ("azimuth_deg", Cells::Real(azimuths, 3)),
            ("elevation_deg", Cells::Real(elevations, 3)),
            ("shaded_share", Cells::Real(shares, 4)),
        ],
    )?)
}
