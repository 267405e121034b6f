//! Flags of solar envelopes, routes and windows.

use super::{
    GroundChoice, NorthArguments, Numbers, PatchesChoice, SceneInput, Shell, SunPeriod, SunPlaceArguments, above_zero,
    at_least_one, height,
};
use belvedere::apps::sun::parse_hour;
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;

/// Corners of a shape, typed, or the file that has them.
#[derive(Clone)]
pub(crate) enum CornersArgument {
    /// As X,Y or X,Y,Z each, in the coordinates of the scene's file; a height that is not given is NaN.
    Typed(Vec<[f64; 3]>),
    File(PathBuf),
}

impl FromStr for CornersArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let looks_typed = words.len() > 1 && words.iter().all(|word| word.contains(','));
        if !looks_typed {
            return if text.is_empty() { Err("names no file".to_owned()) } else { Ok(Self::File(text.into())) };
        }
        let corner = |word: &&str| match word.parse::<Numbers<2>>() {
            Ok(Numbers([x, y])) => Ok([x, y, f64::NAN]),
            Err(_) => word.parse::<Numbers<3>>().map(|numbers| numbers.0),
        };
        words
            .iter()
            .map(corner)
            .collect::<Result<_, _>>()
            .map(Self::Typed)
            .map_err(|e: String| format!("{e}, or a file"))
    }
}

/// Hours of a day on clocks.
#[derive(Clone, Copy)]
pub(crate) struct Hours(pub(crate) [f64; 2]);

impl FromStr for Hours {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || "expected two times of day, such as 09:00,15:00".to_owned();
        let (first, last) = text.split_once(',').ok_or_else(expected)?;
        match (parse_hour(first.trim()), parse_hour(last.trim())) {
            (Some(first), Some(last)) if first <= last => Ok(Self([first, last])),
            _ => Err(expected()),
        }
    }
}

#[derive(Args)]
pub(crate) struct EnvelopeArguments {
    /// Parcel: polygons (GeoJSON, GeoPackage, Shapefile), corners x, y (.csv), or "X,Y X,Y X,Y ..."
    #[arg(long, value_name = "FILE|CORNERS", required = true, allow_hyphen_values = true, help_heading = "Land")]
    pub(crate) parcel: CornersArgument,
    /// Lines, outlines, points (GeoJSON, GeoPackage, Shapefile) or facades that stay free of shadows; repeatable
    ///
    /// Also a line from a table with columns x, y and optionally z (.csv) or as "X,Y X,Y ..."; or facades as a mesh
    /// (.obj .json .ply with faces).
    #[arg(long, value_name = "FILE|CORNERS", required = true, allow_hyphen_values = true, help_heading = "Land")]
    pub(crate) protect: Vec<CornersArgument>,
    /// Height of a fence on protected lines and points, in metres; shadows may reach its top [default: 0]
    #[arg(long = "fence-height", value_name = "M", allow_negative_numbers = true, value_parser = height::<f32>, help_heading = "Land")]
    pub(crate) fence: Option<f32>,
    /// Maximum height above the ground, in metres [default: no limit]
    #[arg(long = "max-height", value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Land")]
    pub(crate) ceiling: Option<f64>,
    /// Side of a column in metres [default: 0.5]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Land")]
    pub(crate) cell: Option<f64>,
    /// Maximum length of the parts that protected lines and facades are cut into, in metres [default: 0.5]
    ///
    /// Lines follow the ground from part to part. --credit-shade works for each part.
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Land")]
    pub(crate) spacing: Option<f64>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Land")]
    pub(crate) ground: GroundChoice,
    /// Ignore parts that are already in shadow of the scene, including buildings and trees on the parcel
    #[arg(long, help_heading = "Land")]
    pub(crate) credit_shade: bool,
    /// A sun direction: azimuth clockwise from true north and elevation, in degrees; repeatable
    ///
    /// See --grid-north.
    #[arg(long, value_name = "AZ,EL", allow_hyphen_values = true, conflicts_with_all = ["date", "from", "to", "between"],
        help_heading = "Period")]
    pub(crate) sun: Vec<Numbers<2>>,
    #[command(flatten, next_help_heading = "Period")]
    pub(crate) north: NorthArguments,
    /// Hours of each day in which sun is protected, on the clocks of --zone, both included [default: sunrise to sunset]
    #[arg(long, value_name = "HH:MM,HH:MM", help_heading = "Period")]
    pub(crate) between: Option<Hours>,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    #[command(flatten)]
    pub(crate) place: SunPlaceArguments,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Heights above ground (.tif .npy), a map (.png), or closed solids (.ply .obj); repeatable
    ///
    /// .tif: nodata -9999 outside the parcel and where no sun limits the height. .npy: NaN outside, infinity where
    /// nothing limits.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write the top of the envelope in the vertical system of the cloud (.tif .npy)
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) tops: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
pub(crate) struct ComfortArguments {
    #[command(flatten)]
    pub(crate) places: ComfortPlaces,
    #[command(flatten, next_help_heading = "Targets")]
    pub(crate) north: NorthArguments,
    /// Distance between targets along a route, in metres [default: 2]
    #[arg(long = "distance-step-m", value_name = "M", requires = "route", conflicts_with = "windows",
        value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Targets")]
    pub(crate) route_step: Option<f64>,
    /// Height of targets on a route above the ground, in metres [default: 1.1, as defined for PET and UTCI]
    #[arg(long = "target-height", value_name = "M", requires = "route", conflicts_with = "windows",
        allow_negative_numbers = true, value_parser = height::<f32>, help_heading = "Targets")]
    pub(crate) height: Option<f32>,
    /// Maximum side of the triangles that windows of a mesh are cut into, in metres [default: 0.5]
    #[arg(long, value_name = "M", requires = "windows", conflicts_with = "route",
        value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Targets")]
    pub(crate) spacing: Option<f64>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Targets")]
    pub(crate) ground: GroundChoice,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    #[command(flatten)]
    pub(crate) place: SunPlaceArguments,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Number of directions, evenly spread over the sky, 1 to 100000 [default: 577]
    #[arg(long, value_name = "N", value_parser = at_least_one, conflicts_with = "patches", help_heading = "Sky")]
    pub(crate) directions: Option<usize>,
    /// Use the centres of standard sky patches instead: tregenza (145) or reinhart (577)
    #[arg(long, value_enum, value_name = "NAME", help_heading = "Sky")]
    pub(crate) patches: Option<PatchesChoice>,
    /// Table with a row for each target of the routes, or for each window (.csv)
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    /// Also write a table with a row for each whole route (.csv)
    #[arg(long, value_name = "OUT", requires = "route", conflicts_with = "windows", help_heading = "Result")]
    pub(crate) routes: Option<PathBuf>,
    /// Also write a table with a row for each route and sun: time, sun direction, shaded share of the route (.csv)
    #[arg(long, value_name = "OUT", requires = "route", conflicts_with = "windows", help_heading = "Result")]
    pub(crate) times: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
#[command(next_help_heading = "Targets (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct ComfortPlaces {
    /// Walking routes: lines (GeoJSON, GeoPackage, Shapefile), a table (.csv), or "X,Y X,Y ..."
    ///
    /// A table has the columns x, y and optionally z.
    /// z is the height of the eye.
    #[arg(long, value_name = "FILE|CORNERS", allow_hyphen_values = true)]
    pub(crate) route: Option<CornersArgument>,
    /// Windows: a table (.csv), or the faces of a mesh (.obj .json .ply)
    ///
    /// The table has the columns x, y, z of the middle and azimuth in degrees from true north (see --grid-north). It
    /// may have tilt (90: vertical), width and height in metres.
    #[arg(long, value_name = "FILE")]
    pub(crate) windows: Option<PathBuf>,
}
