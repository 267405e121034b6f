//! `belvedere comfort`.

use crate::arguments::{ComfortArguments, CornersArgument, Global, refuse};
use crate::inputs::map_shapes::{TypedAre, shapes, wrong_shape};
use crate::inputs::sun::sky_parts;
use crate::inputs::windows::{FaceChoice, WindowColumn, WindowFile, coordinates};
use crate::outputs::formats::check_output;
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{self, Ask, ComfortResults, Places, RoutesOrWindows};
use belvedere::apps::exposure::ShadeAtEachSun;
use belvedere::apps::sun_hours::CLOCK_MEASURES;
use belvedere::apps::targets::{Measure, Route};
use belvedere::io::{FeatureShape, TableCells, TextRows, with_columns_read, write_table};
use std::path::Path;

pub(crate) fn run(arguments: &ComfortArguments, global: &Global) -> Result<Summary> {
    let outputs = [
        ("-o", Some(&arguments.output)),
        ("--routes", arguments.routes.as_ref()),
        ("--times", arguments.times.as_ref()),
    ];
    for (flag, output) in outputs {
        output.map_or(Ok(()), |output| check_output(flag, output, &["csv"]))?;
    }
    if !arguments.when.is_given() {
        return refuse("a period is missing: give --date DAY, or --from and --to");
    }
    let mut question = question(arguments, global)?;
    question.check()?;
    let mut run = CommandContext::new(global);
    let route = arguments.places.route.as_ref();
    let points = if route.is_some() { KeepPoints::Keep } else { KeepPoints::LetGo };
    let scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    let scene = scene.into_question_scene(route.map(|_| &arguments.ground), arguments.shell.shell, &run)?;
    let source = match (route, &arguments.places.windows) {
        (Some(route), _) => {
            let named = routes(route, scene.frame())?;
            question.along = RoutesOrWindows::Routes(named.corners);
            PlaceSource::Routes(named.names)
        }
        (None, Some(path)) => {
            let choice = FaceChoice { spacing: arguments.spacing, objects: &[] };
            let file = WindowFile::read(path, &choice, scene.frame(), &mut run)?;
            question.along = RoutesOrWindows::Windows(file.given.clone());
            PlaceSource::Windows(file)
        }
        (None, None) => return refuse("targets are missing: give --route or --windows"),
    };
    let answers = run.ask(&scene, &question, &Places::Scene)?;
    let shown = ComfortOutput { found: &answers.found, source, frame: scene.frame() };
    shown.write_rows(&arguments.output)?;
    if let Some(output) = &arguments.routes {
        shown.write_groups(output)?;
    }
    if let Some(output) = &arguments.times {
        shown.write_times(output)?;
    }
    run.summary.add_paths("written", outputs.into_iter().filter_map(|(_, path)| path));
    Ok(run.finish())
}

fn question(arguments: &ComfortArguments, global: &Global) -> Result<ask::ComfortQuestion> {
    Ok(ask::ComfortQuestion {
        days: arguments.when.days(),
        place: arguments.place.place(&arguments.north)?,
        sky: sky_parts(arguments.patches, arguments.directions),
        distance_step_m: arguments.route_step,
        target_height: arguments.height.map(f64::from),
        spacing: arguments.spacing,
        seed: global.seed,
        shade: if arguments.times.is_some() { ShadeAtEachSun::Kept } else { ShadeAtEachSun::NotKept },
        ground: arguments.ground.points(),
        along: RoutesOrWindows::default(),
    })
}

/// Routes, and what each is called.
#[derive(Default)]
struct NamedRoutes {
    /// Local metres.
    corners: Vec<Vec<[f64; 3]>>,
    names: Vec<String>,
}

fn routes(route: &CornersArgument, frame: &Frame) -> Result<NamedRoutes> {
    let mut routes = NamedRoutes::default();
    for named in shapes("--route", route, TypedAre::Line, frame)? {
        let FeatureShape::Line(corners) = named.shape else {
            return wrong_shape("--route", route, "a route is a line, but this file has a point or a polygon");
        };
        if corners.len() < 2 {
            return wrong_shape("--route", route, "a route needs at least two corners");
        }
        routes.corners.push(corners);
        routes.names.push(named.name);
    }
    Ok(routes)
}

/// Source of places.
enum PlaceSource {
    /// Routes with these names.
    Routes(Vec<String>),
    Windows(WindowFile),
}

/// Results to write.
struct ComfortOutput<'a> {
    found: &'a ComfortResults,
    source: PlaceSource,
    frame: &'a Frame,
}

impl ComfortOutput<'_> {
    /// A row for each place of routes, or for each window.
    fn write_rows(&self, output: &Path) -> Result<()> {
        if matches!(self.source, PlaceSource::Windows(_)) {
            return self.write_groups(output);
        }
        let ComfortResults { targets, exposure, routes, .. } = self.found;
        let places: Vec<[f64; 3]> = routes.iter().flat_map(|route| route.places.iter().copied()).collect();
        let mut columns: Vec<WindowColumn> =
            vec![("distance_m", routes.iter().flat_map(Route::distances).collect(), 2)];
        columns.extend(coordinates(self.frame, &places));
        let of_measure =
            |(measure, _): &(Measure, _)| -> Vec<f64> { measure.values.iter().copied().map(f64::from).collect() };
        let values: Vec<Vec<f64>> = exposure.measures.iter().map(of_measure).collect();
        let numbered = targets.groups.iter().zip(1_u64..);
        let groups: Vec<Option<u64>> =
            numbered.flat_map(|(group, number)| group.clone().map(move |_| Some(number))).collect();
        let mut cells = vec![("route", TableCells::Whole(&groups))];
        cells.extend(columns.iter().map(|(name, values, decimals)| (*name, TableCells::Real(values, *decimals))));
        cells.extend(self.of_measures(&values));
        cells.extend(self.clocks(&values));
        Ok(write_table(output, &cells)?)
    }

    /// A row for each route or window.
    fn write_groups(&self, output: &Path) -> Result<()> {
        let ComfortResults { targets, exposure, routes, windows, grid_north, .. } = self.found;
        let no_rows = TextRows::default();
        let (name, names, given, columns) = match &self.source {
            PlaceSource::Routes(names) => {
                let lengths = routes.iter().map(Route::length).collect();
                ("route", names, &no_rows, vec![("length_m", lengths, 2)])
            }
            PlaceSource::Windows(file) => {
                ("window", &self.found.names, &file.rows, file.columns(windows, self.frame, *grid_north))
            }
        };
        let values: Vec<Vec<f64>> =
            (0..exposure.measures.len()).map(|number| exposure.of_groups(number, targets)).collect();
        let numbers: Vec<Option<u64>> = (1..).take(targets.groups.len()).map(Some).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let mut cells = vec![(name, TableCells::Whole(&numbers))];
        if !names.is_empty() {
            cells.push(("name", TableCells::Words(&names)));
        }
        cells.extend(columns.iter().map(|(name, values, decimals)| (*name, TableCells::Real(values, *decimals))));
        cells.extend(self.of_measures(&values));
        cells.extend(self.clocks(&values));
        let read = given.columns(0..given.row_count());
        Ok(write_table(output, &with_columns_read(&read, &["x", "y", "z", "azimuth", "tilt"], &cells))?)
    }

    /// Values of each measure as columns.
    fn of_measures<'a>(&'a self, values: &'a [Vec<f64>]) -> impl Iterator<Item = (&'a str, TableCells<'a>)> {
        let measures = self.found.exposure.measures.iter().zip(values);
        measures.map(|((measure, _), values)| (measure.name.as_str(), TableCells::Real(values, measure.decimals)))
    }

    /// Hours of the day as times of the clock.
    fn clocks<'a>(&'a self, values: &'a [Vec<f64>]) -> impl Iterator<Item = (&'a str, TableCells<'a>)> {
        let measures = self.found.exposure.measures.iter().zip(values);
        measures.filter_map(|((measure, _), hours)| {
            let (_, name) = CLOCK_MEASURES.into_iter().find(|(hours, _)| *hours == measure.name)?;
            Some((name, TableCells::Clock(hours)))
        })
    }

    /// A row for each route and sun.
    fn write_times(&self, output: &Path) -> Result<()> {
        let ComfortResults { exposure, schedule, grid_north, .. } = self.found;
        let (mut numbers, mut dates) = (Vec::new(), Vec::new());
        let mut columns: [Vec<f64>; 4] = std::array::from_fn(|_| Vec::new());
        for (shares, number) in exposure.shaded_shares.iter().zip(1_u64..) {
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
                ("route", TableCells::Whole(&numbers)),
                ("date", TableCells::Words(&dates)),
                ("hour", TableCells::Real(hours, 4)),
                ("azimuth_deg", TableCells::Real(azimuths, 3)),
                ("elevation_deg", TableCells::Real(elevations, 3)),
                ("shaded_share", TableCells::Real(shares, 4)),
            ],
        )?)
    }
}
