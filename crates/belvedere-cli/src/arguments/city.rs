//! Flags of runs over whole cities.

use super::scene::day;
use super::{
    AreaChoice, ClearSkyChoice, FarTerrainArguments, MapPosition, MemoryAmount, NorthArguments, Numbers,
    RadiationModel, SunPeriod, SunPlaceArguments, ThroughTreesArguments, above_zero, at_least_one, height, known_crs,
};
use belvedere::weather::CalendarDay;
use belvedere_tiles::{Plan, Topic};
use clap::{Args, Subcommand, ValueEnum};
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::str::FromStr;

#[derive(Args)]
#[command(disable_help_subcommand = true)]
pub(crate) struct City {
    #[command(subcommand)]
    pub(crate) step: CityStep,
}

#[derive(Subcommand)]
pub(crate) enum CityStep {
    /// Read a survey once, and plan its tiles
    Plan(Box<CityPlan>),
    /// Compute the tiles that are not done yet
    Run(CityRun),
    /// List the commands of a run, one a line, for the jobs of a cluster
    Tasks(CityTasks),
    /// Report which tiles are done, which are left, and which failed
    Status(CityStatus),
    /// Write the tiles of one result as one raster
    Merge(CityMerge),
}

#[derive(Args)]
pub(crate) struct CityPlan {
    /// Tiles of the survey (.las .laz .copc.laz), a catalogue of tiles (.vpc, ept.json), or a folder of tiles
    ///
    /// Tiles may lie on a web server (https://...): only the parts near each tile of the plan are transferred, after
    /// one look at the whole.
    #[arg(value_name = "CLOUD", required = true)]
    pub(crate) clouds: Vec<PathBuf>,
    /// Coordinate reference system of files that name none, as EPSG:CODE or WKT [default: that of the files]
    ///
    /// One that contradicts a file, or whose area of use is more than 300 km away, is refused: see --crs-override.
    #[arg(long, value_name = "CRS", value_parser = known_crs)]
    pub(crate) crs: Option<String>,
    /// Use --crs whatever the files and the coordinates say
    #[arg(long, requires = "crs", hide_short_help = true)]
    pub(crate) crs_override: bool,
    /// Day of the flight, such as 2014-02-03, for files whose GPS times are seconds of a week
    #[arg(long, value_name = "DATE", value_parser = day, hide_short_help = true)]
    pub(crate) flown: Option<CalendarDay>,
    /// A sun direction for a shadow map: azimuth clockwise from true north and elevation, in degrees; repeatable
    ///
    /// See --grid-north.
    #[arg(long = "sun", value_name = "AZ,EL", allow_hyphen_values = true, help_heading = "Questions")]
    pub(crate) suns: Vec<Numbers<2>>,
    /// An instant for a shadow map: 2026-06-21T15:00, or 2026-06-21T15:00+02:00; repeatable
    ///
    /// Without an offset it is on the clocks of the place, or of --zone.
    #[arg(long = "time", value_name = "TIME", help_heading = "Questions")]
    pub(crate) times: Vec<String>,
    /// Map the hours of sun a day, for --date, or --from and --to
    #[arg(long, help_heading = "Questions")]
    pub(crate) sun_hours: bool,
    /// Map where a daylight rule is met; repeatable
    ///
    /// By name, as in `belvedere help sun-hours`, or your own as HOURS@DAYS, such as 1.5@03-21, 3@equinoxes@7-17, and
    /// with a minimum sun elevation of 10 degrees 2@02-19..10-21>10.
    #[arg(long, value_name = "RULE", help_heading = "Questions")]
    pub(crate) rule: Vec<String>,
    /// Map the solar energy of a year in kWh for each square metre, with --weather or --clear-sky
    #[arg(long, help_heading = "Questions")]
    pub(crate) irradiance: bool,
    /// Map the sky view factor
    #[arg(long, help_heading = "Questions")]
    pub(crate) sky_view: bool,
    /// Map what an observer sees who stands at a place in file coordinates; repeatable
    ///
    /// Without Z, an observer is --observer-height above the ground. Of several observers, the map has the number that
    /// see each cell.
    #[arg(long = "observer", value_name = "X,Y[,Z]", allow_hyphen_values = true, help_heading = "Questions")]
    pub(crate) observers: Vec<MapPosition>,
    /// Height of observers above the ground in metres [default: 1.7]
    #[arg(long, value_name = "M", value_parser = height::<f64>, requires = "observers", allow_negative_numbers = true,
        help_heading = "Questions")]
    pub(crate) observer_height: Option<f64>,
    /// Maximum horizontal distance of what observers see, in metres [default: no limit]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, requires = "observers", allow_negative_numbers = true,
        help_heading = "Questions")]
    pub(crate) max_distance: Option<f64>,
    /// Number of sky directions
    #[arg(long = "directions", value_name = "N", default_value_t = 577, requires = "sky_view", help_heading = "Questions",
        value_parser = at_least_one)]
    pub(crate) direction_count: usize,
    /// Also map how likely each cell is lit or visible, for --sun, --time and --observer
    ///
    /// Further bands of their results. It needs pulses: docs/methods/confidence.md.
    #[arg(long, help_heading = "Questions")]
    pub(crate) probability: bool,
    /// Also map between which values sums lie nine times in ten: --sun-hours, --sky-view, --irradiance
    ///
    /// Further bands of their results. It needs pulses, and opaque trees.
    #[arg(long, help_heading = "Questions")]
    pub(crate) interval: bool,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    #[command(flatten)]
    pub(crate) sun: SunPlaceArguments,
    /// Weather file: EPW, TMY3, CSV of PVGIS (typical year, or series on a horizontal plane), or CSV of NSRDB
    #[arg(
        long,
        value_name = "FILE",
        requires = "irradiance",
        conflicts_with = "clear_sky",
        help_heading = "Radiation"
    )]
    pub(crate) weather: Option<PathBuf>,
    /// Model of a year without clouds, which is --year
    #[arg(
        long,
        value_enum,
        value_name = "MODEL",
        id = "clear_sky",
        requires = "irradiance",
        help_heading = "Radiation"
    )]
    pub(crate) clear_sky: Option<ClearSkyChoice>,
    #[command(flatten)]
    pub(crate) model: RadiationModel,
    #[command(flatten)]
    pub(crate) north: NorthArguments,
    #[command(flatten)]
    pub(crate) trees: ThroughTreesArguments,
    /// Add a mesh to the survey, such as a planned building (.obj .ply .json); repeatable
    ///
    /// Its triangles block exactly as they are, and cells lie on top of it. Coordinates are those of the survey.
    #[arg(long, value_name = "MESH", help_heading = "Plan")]
    pub(crate) add: Vec<PathBuf>,
    /// Clear what stands in an area: POLYGON.geojson, X0,Y0,X1,Y1 or class:N; repeatable
    ///
    /// Polygons, a box from the lowest to the highest x and y, or the points of a class, in the coordinates of the
    /// survey. What goes is as in other commands (belvedere shadow --help). It comes before --add, so that a building
    /// can replace another.
    #[arg(long, value_name = "AREA", help_heading = "Plan", allow_hyphen_values = true)]
    pub(crate) clear: Vec<AreaChoice>,
    #[command(flatten)]
    pub(crate) far_terrain: FarTerrainArguments,
    /// Side of the cells of results in metres: a whole number of sixty-fourths, such as 0.25, 0.5, 1 or 2
    #[arg(long, value_name = "M", default_value_t = 1.0, value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Tiles")]
    pub(crate) cell: f64,
    /// Side of the cells of one kind of result in metres, such as shadow=0.5, in place of --cell; repeatable
    ///
    /// Kinds: shadow (of --sun and --time), sun-hours, rule, irradiance, sky-view, viewshed (of --observer).
    #[arg(long, value_name = "KIND=M", help_heading = "Tiles")]
    pub(crate) cell_for: Vec<CellFor>,
    /// Side of a tile in metres, 16 to 8192; it does not change results
    ///
    /// Multiples of 64 read the fewest points.
    #[arg(long, value_name = "M", default_value_t = 512.0, value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Tiles")]
    pub(crate) tile_size: f64,
    /// Memory that a tile may use, such as 3G or 800M [default: no limit]
    ///
    /// If the largest tile is estimated to need more, all tiles are made smaller until it fits.
    #[arg(long, value_name = "SIZE", help_heading = "Tiles")]
    pub(crate) memory: Option<MemoryAmount>,
    /// Folder for the plan and the results; created if it does not exist
    #[arg(short, long, value_name = "DIR", help_heading = "Result")]
    pub(crate) output: PathBuf,
}

/// Returns the folder of a plan, which may be given by its file.
#[expect(clippy::unnecessary_wraps, reason = "a parser of values")]
fn folder_of_plan(text: &str) -> Result<PathBuf, Infallible> {
    let path = Path::new(text);
    let of_file = path.parent().filter(|folder| Plan::path(folder) == path && path.is_file());
    Ok(of_file.unwrap_or(path).to_owned())
}

#[derive(Args)]
pub(crate) struct CityRun {
    /// Folder of the plan
    #[arg(value_name = "DIR", value_parser = folder_of_plan)]
    pub(crate) run: PathBuf,
    /// Compute only a share of the tiles, such as 3/64, for the jobs of a cluster
    #[arg(long, value_name = "I/N")]
    pub(crate) shard: Option<TileShare>,
    /// Build only the balls, so that jobs that compute results later find those of all tiles
    #[arg(long)]
    pub(crate) balls_only: bool,
}

#[derive(Args)]
pub(crate) struct CityTasks {
    /// Folder of the plan
    #[arg(value_name = "DIR", value_parser = folder_of_plan)]
    pub(crate) run: PathBuf,
    /// Number of jobs of each step [default: one for each tile, 64 at most]
    #[arg(long, value_name = "N", value_parser = at_least_one, allow_negative_numbers = true)]
    pub(crate) count: Option<usize>,
    /// Step whose commands are listed [default: both, balls first]
    #[arg(long, value_enum, value_name = "STEP")]
    pub(crate) step: Option<CityTaskStep>,
}

/// Step of a run.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CityTaskStep {
    /// Balls of tiles
    Balls,
    /// Results, when all balls are done
    Results,
}

#[derive(Args)]
pub(crate) struct CityStatus {
    /// Folder of the plan
    #[arg(value_name = "DIR", value_parser = folder_of_plan)]
    pub(crate) run: PathBuf,
}

#[derive(Args)]
pub(crate) struct CityMerge {
    /// Folder of the plan
    #[arg(value_name = "DIR", value_parser = folder_of_plan)]
    pub(crate) run: PathBuf,
    /// Result to merge: the name of its folder [default: the only one]
    #[arg(long, value_name = "NAME")]
    pub(crate) result: Option<String>,
    /// Merge what is there of a run that is not finished; without it such a run is refused
    #[arg(long)]
    pub(crate) unfinished: bool,
    /// Raster of all tiles (.tif)
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
}

/// The side of the cells of one kind of result, metres.
#[derive(Clone, Copy)]
pub(crate) struct CellFor(pub(crate) Topic, pub(crate) f64);

impl FromStr for CellFor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (kind, side) = text.split_once('=').ok_or("must be a kind of result and metres, such as shadow=0.5")?;
        let topic = Topic::ALL.into_iter().find(|topic| topic.name() == kind).ok_or_else(|| {
            format!("{kind} is no kind of result: give one of {}", Topic::ALL.map(Topic::name).join(", "))
        })?;
        Ok(Self(topic, above_zero(side)?))
    }
}

/// A share of the tiles.
#[derive(Clone, Copy)]
pub(crate) struct TileShare {
    pub(crate) number: usize,
    pub(crate) of: usize,
}

impl FromStr for TileShare {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Self { number, of }),
            _ => Err("must be a share from 1/N to N/N".to_owned()),
        }
    }
}
