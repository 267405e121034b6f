//! Flags of the scene that a command works on: clouds to build balls from, or a ball file.

use super::{Numbers, Rectangle, known_crs, rectangle};
use belvedere::cast::to_index;
use belvedere::io::{ReadOptions, Within};
use belvedere::medial::Trees;
use belvedere::weather::CalendarDay;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use serde::Deserialize;
use std::path::PathBuf;
use std::str::FromStr;

/// Farther than any height, in any unit.
const FAR: f64 = 1e9;

#[derive(Args, Clone)]
pub(crate) struct CloudInput {
    /// Point clouds (.las .laz .ply .e57 .xyz ...), a catalogue (.vpc, ept.json), or a folder
    ///
    /// Extensions are .las .laz .copc.laz .ply .xyz .txt .csv .pts .asc .pcd .e57 .ptx .npy. Several files, a folder,
    /// or the files of a catalogue of tiles (.vpc) are read as one cloud. A file may lie on a web server (https://...).
    /// A folder with coords.npy is read in the layout of masbcpp.
    #[arg(value_name = "CLOUD", required = true, help_heading = None::<&'static str>)]
    pub(crate) clouds: Vec<PathBuf>,
    /// Coordinate reference system of files that name none, as EPSG:CODE or WKT [default: that of the file]
    ///
    /// One that contradicts the file, or whose area of use is more than 300 km away, is refused: see --crs-override.
    /// Where it names no heights, their unit is that of the file.
    #[arg(long, value_name = "CRS", value_parser = known_crs, help_heading = "Scene")]
    pub(crate) crs: Option<String>,
    /// Use --crs whatever the files and the coordinates say
    #[arg(long, requires = "crs", help_heading = "Scene", hide_short_help = true)]
    pub(crate) crs_override: bool,
    /// Axis of the clouds that is up: z, or y as in computer graphics
    ///
    /// With y, coordinates x, y, z are read as x, -z, y. Results are in these coordinates, and so are observers and
    /// targets.
    #[arg(long, value_enum, value_name = "AXIS", default_value_t = UpChoice::Z, help_heading = "Scene", hide_short_help = true)]
    pub(crate) up: UpChoice,
    /// Leave out files whose points all lie more than 1000 km from those of the others, which is an error otherwise
    #[arg(long, help_heading = "Scene", hide_short_help = true)]
    pub(crate) skip_distant: bool,
    /// Read only the points of a rectangle: its west, south, east and north side, in file coordinates
    ///
    /// For a part of a large survey. What lies outside blocks nothing: leave room for all that may block.
    #[arg(long, value_name = "W,S,E,N", value_parser = rectangle, allow_hyphen_values = true, help_heading = "Scene",
        hide_short_help = true)]
    pub(crate) bounds: Option<Rectangle>,
    /// Read only the points of some flight lines: point source ids such as 1,2,17
    ///
    /// For folders with surveys of several years, or with a line that does not fit the others: what stood in one survey
    /// only would be carved away by the pulses of the other. `belvedere info -v` lists the lines.
    #[arg(
        long = "lines",
        value_name = "ID,...",
        value_delimiter = ',',
        help_heading = "Scene",
        hide_short_help = true
    )]
    pub(crate) flight_lines: Vec<u16>,
    /// Read only the points of some dates in UTC: 2021, 2021-04, 2021-04-29, or from one to another as 2021..2022-03
    ///
    /// Files must have GPS times that tell the day, not seconds of a week.
    #[arg(long, value_name = "DATES", value_parser = dates, help_heading = "Scene", hide_short_help = true)]
    pub(crate) dates: Option<Dates>,
    /// Day of the flight, such as 2014-02-03, for files whose GPS times are seconds of a week
    ///
    /// Crowns that pulses measured (--trees measured) are then as dense as the leaves of the question's day make them.
    #[arg(long, value_name = "DATE", value_parser = day, help_heading = "Scene", hide_short_help = true)]
    pub(crate) flown: Option<CalendarDay>,
    /// Read only the points of some ASPRS classes, such as 2,6
    #[arg(long, value_name = "CLASS,...", value_delimiter = ',', help_heading = "Scene", hide_short_help = true)]
    pub(crate) only_classes: Vec<u8>,
}

/// The first and the last day of those that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dates(pub(crate) [CalendarDay; 2]);

/// A date as it is typed.
pub(crate) fn day(text: &str) -> Result<CalendarDay, String> {
    CalendarDay::parse(text).ok_or_else(|| "give a date such as 2014-02-03".to_owned())
}

/// Dates as they are typed.
fn dates(text: &str) -> Result<Dates, String> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let (Some([first, _]), Some([_, last])) = (days_of(first), days_of(last)) else {
        return Err(
            "give a year, a month as 2021-04 or a day as 2021-04-29, or two of them as 2021..2022-03".to_owned()
        );
    };
    if first > last { Err("the first day is later than the last".to_owned()) } else { Ok(Dates([first, last])) }
}

/// The first and the last day of a year, a month or a day.
fn days_of(text: &str) -> Option<[CalendarDay; 2]> {
    let parts: Vec<&str> = text.trim().split('-').collect();
    let year = parts.first()?.parse().ok()?;
    let number = |part: &str| part.parse::<u8>().ok();
    let last_of = |month: u8| (28..=31).rev().find_map(|day| CalendarDay::new(year, month, day));
    match parts[1..] {
        [] => Some([CalendarDay::new(year, 1, 1)?, CalendarDay::new(year, 12, 31)?]),
        [month] => Some([CalendarDay::new(year, number(month)?, 1)?, last_of(number(month)?)?]),
        [month, day] => Some([CalendarDay::new(year, number(month)?, number(day)?)?; 2]),
        _ => None,
    }
}

impl CloudInput {
    /// The names of the clouds, as they were typed.
    pub(crate) fn names(&self) -> Vec<String> {
        self.clouds.iter().map(|path| path.display().to_string()).collect()
    }

    /// The flag that makes only a part of the points be read, if one does.
    pub(crate) fn part_flag(&self) -> Option<&'static str> {
        let flags = [
            ("--bounds", self.bounds.is_some()),
            ("--lines", !self.flight_lines.is_empty()),
            ("--dates", self.dates.is_some()),
            ("--only-classes", !self.only_classes.is_empty()),
        ];
        flags.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }

    /// The same for all points.
    pub(crate) fn whole(self) -> Self {
        Self { bounds: None, flight_lines: Vec::new(), dates: None, only_classes: Vec::new(), ..self }
    }

    /// Returns the options of reading the clouds.
    pub(crate) fn read_options(&self) -> ReadOptions {
        let mut options = ReadOptions::new().with_up(self.up.into());
        options.crs.clone_from(&self.crs);
        if self.crs_override {
            options = options.insisting_on_crs();
        }
        if let Some(Rectangle([[west, south], [east, north]])) = self.bounds {
            // of the axes that files have
            let (low, high) = match self.up {
                UpChoice::Z => ([west, south, -FAR], [east, north, FAR]),
                UpChoice::Y => ([west, -FAR, -north], [east, FAR, -south]),
            };
            options = options.with_points_within(Within::File { low, high });
        }
        if !self.flight_lines.is_empty() {
            options = options.with_lines(self.flight_lines.clone());
        }
        if let Some(Dates(dates)) = self.dates {
            options = options.with_dates(dates);
        }
        options.flown = self.flown;
        if !self.only_classes.is_empty() {
            options = options.with_classes(self.only_classes.clone());
        }
        if self.skip_distant { options.without_distant_files() } else { options }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum UpChoice {
    /// The third axis, as in surveys
    Z,
    /// The second axis
    Y,
}

/// Clouds to build balls from, or a ball file.
#[derive(Args, Clone)]
pub(crate) struct SceneInput {
    #[command(flatten)]
    pub(crate) input: CloudInput,
    #[command(flatten)]
    pub(crate) plan: PlanArguments,
    #[command(flatten)]
    pub(crate) balls: SceneBalls,
    #[command(flatten)]
    pub(crate) memory: MemoryArgument,
}

/// Construction of the balls of a scene, for every command that builds them. Further parameters are in a file.
#[derive(Args, Clone)]
#[command(next_help_heading = "Scene")]
pub(crate) struct SceneBalls {
    /// How the crowns of trees block [default: measured]
    #[arg(long, value_name = "TREES", value_parser = trees(), hide_short_help = true)]
    pub(crate) trees: Option<Trees>,
    /// Orientation of normals, and the scanner: trajectory=FILE, scanner=X,Y,Z, stations=FILE, pulses and others
    /// [default: auto]
    ///
    /// `belvedere balls --help` explains all values.
    #[arg(long, value_name = "HOW", hide_short_help = true)]
    pub(crate) orient: Option<OrientChoice>,
    #[command(flatten)]
    pub(crate) config: SceneConfig,
}

#[derive(Args, Clone)]
pub(crate) struct CalibrateArguments {
    /// Share of the pulses kept out, above 0 and below 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, help_heading = "Result", allow_negative_numbers = true)]
    pub(crate) share: f64,
    /// What was measured (.json), or a ball file of all points that keeps it (.npz); repeatable
    ///
    /// Commands that answer from the ball file quote what was measured, and `belvedere info` lists it.
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) balls: SceneBalls,
    #[command(flatten)]
    pub(crate) input: CloudInput,
}

/// The shape of balls, for the commands of the paper.
#[derive(Args, Clone)]
pub(crate) struct BallShape {
    /// Shape that represents a ball: the sphere, or the cone of the paper [default: sphere]
    #[arg(
        long = "ball-profile",
        id = "ball_profile",
        value_name = "SHAPE",
        value_enum,
        hide_short_help = true,
        help_heading = "Scene"
    )]
    pub(crate) profile: Option<ProfileChoice>,
}

/// Maximum memory of a survey.
#[derive(Args, Clone)]
pub(crate) struct MemoryArgument {
    /// Memory that may be used, such as 3G or 800M [default: half of what is free]
    ///
    /// Where one model of LAS or LAZ files needs more, its balls are made in tiles. Shadow, sun hours, sky view,
    /// irradiance and viewsheds on cells are answered in tiles as well. Other questions need three quarters of the
    /// memory of one model, and less where they reach only a distance from places. Tiles are kept (`belvedere cache`):
    /// a command that was stopped goes on, and the next question finds the balls.
    #[arg(long, value_name = "SIZE", help_heading = "Scene", hide_short_help = true)]
    pub(crate) memory: Option<MemoryAmount>,
}

/// Tiles of a question on cells.
#[derive(Args, Clone)]
pub(crate) struct TilesArguments {
    /// Plan tiles in this folder for many computers, instead of answering
    ///
    /// The steps of city compute the plan and join the tiles. None of them takes more memory than is allowed.
    #[arg(long, value_name = "DIR", help_heading = "Result", hide_short_help = true)]
    pub(crate) plan: Option<PathBuf>,
}

/// Plan: changes to the scene.
#[derive(Args, Clone)]
pub(crate) struct PlanArguments {
    /// Add a mesh to the scene, such as a planned building (.obj .ply .json); repeatable
    ///
    /// Its triangles block lines of sight exactly as they are, from both sides, whether they enclose a volume or not.
    /// Coordinates are those of the cloud. A target within 1 mm of the plane of a triangle is not blocked by that
    /// triangle. With --surface cells lie on top of the mesh, and cells on the ground inside it are left out. What
    /// pulses prove stays as it was.
    #[arg(long, value_name = "MESH", help_heading = "Plan")]
    pub(crate) add: Vec<PathBuf>,
    /// Clear what stands in an area: POLYGON.geojson, X0,Y0,X1,Y1 or class:N; repeatable
    ///
    /// Polygons, a box from the lowest to the highest x and y, or the points of a class. Points more than 0.3 m above
    /// the ground are gone, and what is lower beside them unless it is ground, with the balls at them; balls beside the
    /// area are cut to its edge, and the ground is closed at the height interpolated from the ground around. Lines of
    /// sight through the space that was freed count as proven. It comes before --add, so that a building can replace
    /// another. Ball files have no points: give the cloud.
    #[arg(long, value_name = "AREA", help_heading = "Plan", allow_hyphen_values = true)]
    pub(crate) clear: Vec<AreaChoice>,
}

/// An area to clear, as typed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum AreaChoice {
    /// Lowest and highest x and y, in the coordinates of the file.
    Box([f64; 4]),
    Class(u8),
    File(PathBuf),
}

impl FromStr for AreaChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(class) = text.strip_prefix("class:") {
            return class.parse().map(Self::Class).map_err(|_| format!("{class} is no class: 0 to 255"));
        }
        let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x0, y0, x1, y1]) if [x0, y0, x1, y1].iter().all(|v| v.is_finite()) && x0 < x1 && y0 < y1 => {
                Ok(Self::Box([x0, y0, x1, y1]))
            }
            Some(_) => Err("a box is X0,Y0,X1,Y1: lowest x and y, then highest".to_owned()),
            None => Ok(Self::File(text.into())),
        }
    }
}

/// The parameters of balls in a file.
#[derive(Args, Clone)]
pub(crate) struct SceneConfig {
    /// JSON file with the parameters of balls that `belvedere balls --help` lists
    ///
    /// Keys are the names of the flags with underscores, for example {"orient": "pulses", "max_radius": 2,
    /// "keep_noise": true}. A flag on the command line overrides the file. A ball file refuses them, because its balls
    /// are already built.
    #[arg(long, value_name = "FILE", help_heading = "Scene")]
    pub(crate) scene_config: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ProfileChoice {
    /// The sphere itself
    Sphere,
    /// The cone of the paper's Algorithm 1, unchanged
    PaperCone,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_years_months_days_and_what_lies_between() {
        let day = |year, month, day| CalendarDay { year, month, day };
        for (text, first, last) in [
            ("2021", day(2021, 1, 1), day(2021, 12, 31)),
            ("2024-02", day(2024, 2, 1), day(2024, 2, 29)),
            ("2021-04-29", day(2021, 4, 29), day(2021, 4, 29)),
            ("2021..2022-03", day(2021, 1, 1), day(2022, 3, 31)),
        ] {
            assert_eq!(dates(text), Ok(Dates([first, last])), "{text}");
        }
        for text in ["", "2021-13", "2021-02-30", "2022..2021", "2021-1-1-1", "spring"] {
            assert!(dates(text).is_err(), "{text}");
        }
    }
}

/// An amount of memory, bytes.
#[derive(Clone, Copy)]
pub(crate) struct MemoryAmount(pub(crate) u64);

impl FromStr for MemoryAmount {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || "must be a size such as 3G or 800M".to_owned();
        let unit = text.chars().next_back().map(|c| c.to_ascii_uppercase());
        let scale: f64 = match unit {
            Some('G') => 1e9,
            Some('M') => 1e6,
            _ => return Err(wrong()),
        };
        let number: f64 = text.get(..text.len() - 1).and_then(|number| number.parse().ok()).ok_or_else(wrong)?;
        let is_size = number > 0.0 && number.is_finite();
        if is_size { Ok(Self(to_index(number * scale) as u64)) } else { Err(wrong()) }
    }
}

/// The ways to represent crowns, by their names.
pub(super) fn trees() -> impl TypedValueParser<Value = Trees> {
    let possible = Trees::ALL.map(|trees| {
        PossibleValue::new(trees.name()).help(match trees {
            Trees::Opaque => "Solid from the highest to the lowest return, as in leaf",
            Trees::Porous => "Twigs with gaps between them, as in winter",
            Trees::Measured => "Each part by the share of pulses that passed through it",
        })
    });
    // the parser lets no other name through
    PossibleValuesParser::new(possible)
        .map(|name| Trees::ALL.into_iter().find(|trees| trees.name() == name).unwrap_or_default())
}

#[derive(Clone, Deserialize)]
#[serde(try_from = "String")]
pub(crate) enum OrientChoice {
    Auto,
    Given,
    Up,
    Scanner,
    ScannerAt([f64; 3]),
    Stations(PathBuf),
    Trajectory(PathBuf),
    Pulses,
    Mesh(PathBuf),
}

impl TryFrom<String> for OrientChoice {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl FromStr for OrientChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            None => match text {
                "auto" => Ok(Self::Auto),
                "given" => Ok(Self::Given),
                "up" => Ok(Self::Up),
                "scanner" => Ok(Self::Scanner),
                "pulses" => Ok(Self::Pulses),
                _ => Err(
                    "use auto, given, up, scanner, scanner=X,Y,Z, stations=FILE, trajectory=FILE, pulses or mesh=FILE"
                        .to_owned(),
                ),
            },
            Some(("scanner", position)) => Ok(Self::ScannerAt(position.parse::<Numbers<3>>()?.0)),
            Some(("stations", file)) => Ok(Self::Stations(file.into())),
            Some(("trajectory", file)) => Ok(Self::Trajectory(file.into())),
            Some(("mesh", file)) => Ok(Self::Mesh(file.into())),
            Some(_) => Err("use scanner=X,Y,Z, stations=FILE, trajectory=FILE or mesh=FILE".to_owned()),
        }
    }
}
