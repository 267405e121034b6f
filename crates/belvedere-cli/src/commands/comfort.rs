//! `belvedere comfort`.

mod places;

use super::check_output;
use super::sights::{Proving, blockers};
use crate::arguments::{Comfort, Global, PatchesChoice, Usage};
use crate::pipeline::{self, Points, flagged};
use crate::progress::Stages;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::exposure::{shaded_shares, sky_component};
use belvedere::apps::sky_view::{SKY_DIRECTIONS, SkyDirections, sky_view};
use belvedere::apps::sun::{Binning, SunSchedule, sun_days};
use belvedere::apps::sun_hours::{SunHoursParams, sun_hours};
use belvedere::io::{Cells, write_table};
use belvedere::query::{VisibilityMatrix, visibility_matrix};
use places::{Places, routes, windows};
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
        return Err(Usage("say when: --date DAY, or --from and --to".to_owned()).into());
    }
    let sky = match arguments.patches {
        Some(PatchesChoice::Tregenza) => SkyDirections::patches(1)?,
        Some(PatchesChoice::Reinhart) => SkyDirections::patches(2)?,
        None => flagged("--directions", SkyDirections::even(arguments.directions.unwrap_or(SKY_DIRECTIONS)))?,
    };
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let points = if arguments.places.route.is_some() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut stages, &mut summary)?;
    let site = arguments.place.site(&scene, &mut summary)?;
    let zone = arguments.place.zone(&site, &arguments.when.times())?;
    let params = arguments.when.params(&arguments.place)?;
    let Some(period) = arguments.when.period(&arguments.place, &site, &zone)? else {
        return Err(Usage("say when: --date DAY, or --from and --to".to_owned()).into());
    };
    let days = flagged("--time-step-min, --min-sun-elevation or --from", sun_days(&site, &zone, &period, &params))?;
    // each row of --times is about a sun of its own
    let binning = if arguments.times.is_some() { Binning::Exact } else { Binning::Auto };
    let schedule = SunSchedule::new(&days, binning)?;
    let mut section = Summary::default();
    section
        .add("days", schedule.days.len())
        .add("clocks", zone.name())
        .add("suns", schedule.days.iter().map(|day| day.steps.len()).sum::<usize>())
        .add("directions", schedule.directions.len())
        .add("possible_hours_a_day", rounded(schedule.possible_hours() / schedule.days.len().max(1) as f64, 3));
    summary.add("when", section);
    let north = arguments.north.of_scene(&scene);
    if arguments.places.windows.is_some() || arguments.times.is_some() {
        north.report(&mut summary);
    }
    let places = match (&arguments.places.route, &arguments.places.windows) {
        (Some(route), _) => routes(arguments, route, &mut scene, &mut stages, &mut summary)?,
        (None, Some(path)) => {
            windows(arguments, path, (&scene, north.of_grid), global.seed, &mut stages, &mut summary)?
        }
        (None, None) => return Err(Usage("say where: --route or --windows".to_owned()).into()),
    };
    let mut section = Summary::default();
    let profile = arguments.scene.profile.into();
    let (blockers, _) =
        blockers(&scene, profile, &arguments.shell.giving_way(), Proving::Never, &mut stages, &mut section)?;
    section.add("directions_of_the_sky", sky.directions.len());
    summary.add("lines_of_sight", section);
    let targets = &places.positions;
    let of_sky = stages.run("looking at the sky", targets.len(), |progress| {
        visibility_matrix(&blockers, targets, &sky.directions, progress)
    })?;
    let of_sun = stages.run("looking at the sun", targets.len(), |progress| {
        visibility_matrix(&blockers, targets, &schedule.directions, progress)
    })?;
    let found = stages.run("summing up", 0, |_| Found::new(&of_sky, &sky, &of_sun, &schedule, &places))?;
    write_rows(&arguments.output, &places, &found)?;
    let mut section = Summary::default();
    section.add(places.kind, places.groups.len()).add("places", targets.len());
    for (name, values, decimals) in found.of_groups(&places) {
        let known: Vec<(f64, f64)> = values
            .iter()
            .zip(places.group_weights())
            .filter(|(value, _)| value.is_finite())
            .map(|(value, weight)| (*value, weight))
            .collect();
        let whole: f64 = known.iter().map(|(_, weight)| weight).sum();
        if whole > 0.0 && !name.ends_with("_light") {
            let mean = known.iter().map(|(value, weight)| value * weight).sum::<f64>() / whole;
            section.add(&format!("mean_{name}"), rounded(mean, i32::try_from(decimals).unwrap_or(3)));
        }
    }
    summary.add("exposure", section);
    if let Some(output) = &arguments.routes {
        write_groups(output, &places, &found)?;
    }
    if let Some(output) = &arguments.times {
        write_times(output, &places, &of_sun, &schedule, north.of_grid)?;
    }
    let written = [Some(&arguments.output), arguments.routes.as_ref(), arguments.times.as_ref()];
    let written: Vec<String> = written.into_iter().flatten().map(|path| path.display().to_string()).collect();
    summary.add("written", written);
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

/// How a measure of a whole follows from those of its places.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Whole {
    Mean,
    Least,
    Most,
}

/// Measures of each place: name, values, decimals, and what a whole has of it.
struct Found(Vec<(&'static str, Vec<f32>, usize, Whole)>);

impl Found {
    fn new(
        of_sky: &VisibilityMatrix,
        sky: &SkyDirections,
        of_sun: &VisibilityMatrix,
        schedule: &SunSchedule,
        places: &Places,
    ) -> belvedere::Result<Self> {
        let normals = places.normals.as_deref();
        let seen = sky_view(of_sky, sky, normals)?;
        let sun = sun_hours(of_sun, schedule, normals, &SunHoursParams::default())?;
        let mut columns =
            vec![("sky_view_factor", seen.factors, 4, Whole::Mean), ("sky_openness", seen.openness, 4, Whole::Mean)];
        if let Some(normals) = normals {
            columns.push(("sky_component", sky_component(of_sky, sky, normals)?, 4, Whole::Mean));
        }
        columns.extend([
            ("sun_hours", sun.hours, 3, Whole::Mean),
            ("sun_share", sun.share, 4, Whole::Mean),
            ("first_light", sun.first, 3, Whole::Least),
            ("last_light", sun.last, 3, Whole::Most),
            ("longest", sun.longest, 3, Whole::Mean),
        ]);
        for (_, values, ..) in &mut columns {
            let unknown = places.positions.iter().map(|p| !p.iter().all(|v| v.is_finite()));
            values.iter_mut().zip(unknown).filter(|(_, unknown)| *unknown).for_each(|(value, _)| *value = f32::NAN);
        }
        Ok(Self(columns))
    }

    /// Each measure for the routes or windows as a whole: means weighted by what places stand for, the first and the last light of any.
    fn of_groups(&self, places: &Places) -> Vec<(&'static str, Vec<f64>, usize)> {
        let of_column = |(name, values, decimals, whole): &(&'static str, Vec<f32>, usize, Whole)| {
            let of_group = |group: &std::ops::Range<usize>| {
                let known =
                    || group.clone().map(|i| (f64::from(values[i]), places.weights[i])).filter(|(v, _)| v.is_finite());
                let pick = |pick: fn(f64, f64) -> f64| known().map(|(value, _)| value).reduce(pick).unwrap_or(f64::NAN);
                match whole {
                    Whole::Mean => known().map(|(v, w)| v * w).sum::<f64>() / known().map(|(_, w)| w).sum::<f64>(),
                    Whole::Least => pick(f64::min),
                    Whole::Most => pick(f64::max),
                }
            };
            (*name, places.groups.iter().map(of_group).collect(), *decimals)
        };
        self.0.iter().map(of_column).collect()
    }
}

/// A row for each place of routes, or for each window.
fn write_rows(output: &Path, places: &Places, found: &Found) -> Result<()> {
    if places.normals.is_some() {
        return write_groups(output, places, found);
    }
    let columns: Vec<(&'static str, Vec<f64>, usize)> = found
        .0
        .iter()
        .map(|(name, values, decimals, _)| (*name, values.iter().map(|&v| f64::from(v)).collect(), *decimals))
        .collect();
    let groups: Vec<Option<u64>> = places
        .groups
        .iter()
        .zip(1_u64..)
        .flat_map(|(group, number)| group.clone().map(move |_| Some(number)))
        .collect();
    let mut cells = vec![("route", Cells::Whole(&groups))];
    cells.extend(places.place_columns.iter().chain(&columns).map(|(name, values, d)| (*name, Cells::Real(values, *d))));
    Ok(write_table(output, &cells)?)
}

/// A row for each route or window.
fn write_groups(output: &Path, places: &Places, found: &Found) -> Result<()> {
    let columns = found.of_groups(places);
    let numbers: Vec<Option<u64>> = (1..).take(places.groups.len()).map(Some).collect();
    let names: Vec<&str> = places.names.iter().map(String::as_str).collect();
    let mut cells = vec![(places.row_name, Cells::Whole(&numbers))];
    if !names.is_empty() {
        cells.push(("name", Cells::Words(&names)));
    }
    cells.extend(places.group_columns.iter().chain(&columns).map(|(name, values, d)| (*name, Cells::Real(values, *d))));
    Ok(write_table(output, &cells)?)
}

/// A row for each route and sun.
fn write_times(
    output: &Path,
    places: &Places,
    of_sun: &VisibilityMatrix,
    schedule: &SunSchedule,
    grid_north: f64,
) -> Result<()> {
    let (mut numbers, mut dates) = (Vec::new(), Vec::new());
    let mut columns: [Vec<f64>; 4] = std::array::from_fn(|_| Vec::new());
    for (group, number) in places.groups.iter().zip(1_u64..) {
        let own = |(i, &weight): (usize, &f64)| if group.contains(&i) { weight } else { 0.0 };
        let weights: Vec<f64> = places.weights.iter().enumerate().map(own).collect();
        let shares = shaded_shares(of_sun, &weights)?;
        for day in &schedule.days {
            for step in &day.steps {
                let row = step.direction as usize;
                let [east, north, up] = schedule.directions[row];
                numbers.push(Some(number));
                dates.push(day.date.to_string());
                // the sun of a step is the one halfway
                let values = [
                    f64::from(step.start) + f64::from(step.hours) / 2.0,
                    (east.atan2(north) + grid_north).to_degrees().rem_euclid(360.0),
                    up.clamp(-1.0, 1.0).asin().to_degrees(),
                    shares[row],
                ];
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
