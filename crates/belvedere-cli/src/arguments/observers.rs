//! Flags of lines of sight and viewsheds.

use super::{Numbers, SceneInput, UnprovenChoice, above_zero, length, target_count};
use belvedere::ground::GroundPoints;
use belvedere::query::Curvature;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

#[derive(Args)]
pub(crate) struct LineOfSight {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) lines: Lines,
    #[command(flatten)]
    pub(crate) earth: Earth,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    /// With --from and --to: what the line passes, as a table (.csv) or a diagram (.png)
    #[arg(long, value_name = "OUT", requires = "from", help_heading = "Result")]
    pub(crate) profile_out: Option<PathBuf>,
    /// Metres between the rows of the profile [default: a thousandth of the line, 0.1 at least]
    #[arg(long, value_name = "M", requires = "profile_out", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Result")]
    pub(crate) profile_step: Option<f64>,
    /// Where the ground of the profile comes from
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Result")]
    pub(crate) ground: GroundChoice,
    /// Table (.csv), a row per pair in their order: ax,ay,az,bx,by,bz, answer (0 blocked, 1 visible, 2 unproven, 3 no line),
    /// first_block_range_m from A, unproven_m (not with --unproven as-visible, which is quicker), block_x, block_y, block_z, and
    /// block_ball and block_source, the rows of the ball that blocks first and of the point it touches
    #[arg(short, long, value_name = "OUT", required_unless_present = "from", help_heading = "Result")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Args)]
#[command(next_help_heading = "Lines of sight (one of)")]
#[group(id = "lines", required = true, multiple = true)]
pub(crate) struct Lines {
    /// Table with the columns ax,ay,az,bx,by,bz in the coordinates of the scene's file: observer A, target B
    #[arg(long, value_name = "CSV", conflicts_with_all = ["from", "to", "random"])]
    pub(crate) pairs: Option<PathBuf>,
    /// Pairs spread evenly at random over the bounding box of the cloud; other --seed, other pairs
    #[arg(long, value_name = "N", value_parser = target_count, conflicts_with_all = ["from", "to"])]
    pub(crate) random: Option<usize>,
    /// Observer of a single line, in the coordinates of the scene's file
    #[arg(long, value_name = "X,Y,Z", requires = "to", allow_hyphen_values = true)]
    pub(crate) from: Option<Numbers<3>>,
    /// Target of a single line
    #[arg(long, value_name = "X,Y,Z", requires = "from", allow_hyphen_values = true)]
    pub(crate) to: Option<Numbers<3>>,
}

#[derive(Args)]
#[command(next_help_heading = "Lines of sight")]
pub(crate) struct Earth {
    /// Curvature of the earth and refraction: auto follows them on lines of more than 2 km
    #[arg(long, value_enum, default_value_t = CurvatureChoice::Auto)]
    pub(crate) curvature: CurvatureChoice,
    /// Coefficient of refraction, 0 to below 1 [default: 1/7, as in GDAL and GRASS]
    #[arg(long, value_name = "K", allow_negative_numbers = true)]
    pub(crate) refraction: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Lines of sight")]
pub(crate) struct GivingWay {
    /// Metres that carved balls give way to targets near their surface, since balls bulge between the points of walls and roofs
    /// [default: 0.2]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = length)]
    pub(crate) shell: Option<f32>,
    /// What to make of targets that nothing blocks, but of whose line of sight more than half a metre runs through space that no
    /// pulse came near to; needs carved balls with their pulses (from a cloud, or from an .npz) [default: report]
    #[arg(long, value_enum)]
    pub(crate) unproven: Option<UnprovenChoice>,
}

/// How balls give way where nothing is asked of pulses.
#[derive(Args)]
#[command(next_help_heading = "Lines of sight")]
pub(crate) struct Shell {
    /// Metres that carved balls give way to targets near their surface, since balls bulge between the points of walls and roofs
    /// [default: 0.2]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = length)]
    pub(crate) shell: Option<f32>,
}

impl Shell {
    /// The same as flags that know of pulses, none of which is asked.
    pub(crate) fn giving_way(&self) -> GivingWay {
        GivingWay { shell: self.shell, unproven: None }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum CurvatureChoice {
    /// On lines of more than 2 km
    Auto,
    /// On all
    On,
    /// The earth is a plane
    Off,
}

impl From<CurvatureChoice> for Curvature {
    fn from(choice: CurvatureChoice) -> Self {
        match choice {
            CurvatureChoice::Auto => Self::Auto,
            CurvatureChoice::On => Self::On,
            CurvatureChoice::Off => Self::Off,
        }
    }
}

#[derive(Args)]
pub(crate) struct Viewshed {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) who: Who,
    #[command(flatten)]
    pub(crate) looking: Looking,
    #[command(flatten)]
    pub(crate) earth: Earth,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    /// Where the ground comes from: auto (class 2 where there is one, else found), classed, found, or cloud=FILE, which a ball file
    /// needs
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Cells")]
    pub(crate) ground: GroundChoice,
    /// Side of a cell in metres [default: 0.5, doubled until there are at most 4 million cells]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Cells")]
    pub(crate) cell: Option<f64>,
    /// What is seen. On a grid: .tif (255 visible, 128 unproven, 0 invisible, 254 nodata; with several observers their
    /// number, 65535 nodata), .png (map with a legend), .geojson (areas seen, in WGS 84). On the points of the cloud:
    /// .laz .las .ply .csv (column answer: 0 blocked, 1 visible, 2 unproven, 3 not looked at; with several observers also
    /// observers, their number). May be given several times
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write how high above the ground a thing must reach in each cell to be seen, in metres (.tif: nodata -9999, also where
    /// nothing up to --ceiling is seen; .npy: infinity there, NaN without ground)
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) heights: Option<PathBuf>,
    /// Greatest height that --heights looks at, in metres
    #[arg(long, value_name = "M", default_value_t = 100.0, requires = "heights", value_parser = above_zero::<f64>,
        allow_negative_numbers = true, help_heading = "Result")]
    pub(crate) ceiling: f64,
    /// Also write which observers see each cell: .npy (bands, rows, columns) u32, bit i of band b for observer 32 b + i; or .tif, up to 32
    /// observers
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) masks: Option<PathBuf>,
}

#[derive(Args)]
#[command(next_help_heading = "Who looks (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct Who {
    /// An observer in the coordinates of the scene's file; without Z the eye is --observer-height above the ground. May be given
    /// several times
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true)]
    pub(crate) observer: Vec<Place>,
    /// Observers from a table with columns x and y (.csv) or from GeoJSON, whose lines are paths. Columns, or properties,
    /// z, height, min_distance, max_distance, azimuth_from, azimuth_to, elevation_from and elevation_to go before the flags
    #[arg(long, value_name = "FILE")]
    pub(crate) observers: Option<PathBuf>,
    /// The reverse: from which cells this place, --target-height above the ground unless it has a Z, is seen by eyes --observer-height
    /// above the ground
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true)]
    pub(crate) target: Option<Place>,
}

#[derive(Args)]
#[command(next_help_heading = "Looking")]
pub(crate) struct Looking {
    /// Metres between the observers on a path; a table is then the corners of one [default for lines of GeoJSON: 5]
    #[arg(long, value_name = "M", requires = "observers", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) step: Option<f64>,
    /// Height of eyes above the ground in metres [default: 1.7]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) observer_height: Option<f64>,
    /// Height of targets above the ground in metres [default: 0]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) target_height: Option<f64>,
    /// Greatest distance on the map in metres
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) max_distance: Option<f64>,
    /// Least distance on the map in metres
    #[arg(long, value_name = "M", value_parser = length, allow_negative_numbers = true)]
    pub(crate) min_distance: Option<f32>,
    /// Directions looked at, clockwise from grid north in degrees: 300,60 looks north
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true)]
    pub(crate) azimuth: Option<Numbers<2>>,
    /// Angles above the horizon looked at, in degrees, -90 to 90
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true)]
    pub(crate) elevation: Option<Numbers<2>>,
}

/// A place on the map, with a height or without.
#[derive(Clone, Copy)]
pub(crate) struct Place(pub(crate) [f64; 2], pub(crate) Option<f64>);

impl FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.matches(',').count() == 2 {
            let [x, y, z] = text.parse::<Numbers<3>>()?.0;
            return Ok(Self([x, y], Some(z)));
        }
        let place = text.parse::<Numbers<2>>().map_err(|why| format!("{why}, or three"))?;
        Ok(Self(place.0, None))
    }
}

#[derive(Clone)]
pub(crate) enum GroundChoice {
    OfScene(GroundPoints),
    Cloud(PathBuf),
}

impl FromStr for GroundChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match (text, text.split_once('=')) {
            ("auto", _) => Ok(Self::OfScene(GroundPoints::Auto)),
            ("classed", _) => Ok(Self::OfScene(GroundPoints::Classed)),
            ("found", _) => Ok(Self::OfScene(GroundPoints::Found)),
            (_, Some(("cloud", file))) => Ok(Self::Cloud(file.into())),
            _ => Err("use auto, classed, found or cloud=FILE".to_owned()),
        }
    }
}
