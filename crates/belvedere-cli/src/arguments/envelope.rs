//! Flags of solar envelopes, routes and windows.

use super::{
    GroundChoice, Numbers, PatchesChoice, SceneInput, Shell, SunPeriod, SunPlace, above_zero, at_least_one, finite,
};
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;

/// Corners of a shape, typed, or the file that has them.
#[derive(Clone)]
pub(crate) enum Corners {
    /// As X,Y or X,Y,Z each, in the coordinates of the scene's file; a height that is not given is NaN.
    Typed(Vec<[f64; 3]>),
    File(PathBuf),
}

impl FromStr for Corners {
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
        let hour = |word: &str| {
            let (hours, minutes) = word.trim().split_once(':').unwrap_or((word.trim(), "0"));
            let (hours, minutes) = (hours.parse::<u8>().ok()?, minutes.parse::<u8>().ok()?);
            let value = f64::from(hours) + f64::from(minutes) / 60.0;
            (minutes < 60 && value <= 24.0).then_some(value)
        };
        let (first, last) = text.split_once(',').ok_or_else(expected)?;
        match (hour(first), hour(last)) {
            (Some(first), Some(last)) if first <= last => Ok(Self([first, last])),
            _ => Err(expected()),
        }
    }
}

#[derive(Args)]
pub(crate) struct Envelope {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    /// The parcel: polygons from GeoJSON, a ring from a table with columns x and y (.csv), or its corners as "X,Y X,Y X,Y …"
    #[arg(long, value_name = "FILE|CORNERS", required = true, allow_hyphen_values = true, help_heading = "Land")]
    pub(crate) parcel: Corners,
    /// What shadows must stay off: lines, rims of polygons and points from GeoJSON, one line from a table with columns x, y and perhaps z
    /// (.csv) or its corners as "X,Y X,Y …", or facades as a mesh (.obj .json .ply with faces). May be given several times
    #[arg(long, value_name = "FILE|CORNERS", required = true, allow_hyphen_values = true, help_heading = "Land")]
    pub(crate) protect: Vec<Corners>,
    /// Height of a fence on protected lines and points, up to which shadows may reach, in metres [default: 0]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = finite, help_heading = "Land")]
    pub(crate) fence: Option<f32>,
    /// Greatest height above the ground, in metres [default: none]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Land")]
    pub(crate) ceiling: Option<f64>,
    /// Side of a column, in metres [default: 0.5]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Land")]
    pub(crate) cell: Option<f64>,
    /// Longest piece of lines and of faces: lines follow the ground by pieces, and shade is credited by pieces [default: 0.5]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Land")]
    pub(crate) spacing: Option<f64>,
    /// Where the ground comes from: auto (class 2 where there is one, else found), classed, found, or cloud=FILE, which a ball file
    /// needs
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Land")]
    pub(crate) ground: GroundChoice,
    /// What is in shade already bounds nothing: asks the balls of the scene, the parcel's own buildings and trees among them
    #[arg(long, help_heading = "Land")]
    pub(crate) credit_shade: bool,
    /// Suns as azimuth from grid north and elevation in degrees, in place of days. May be given several times
    #[arg(long, value_name = "AZ,EL", allow_hyphen_values = true, conflicts_with_all = ["date", "between"], help_heading = "When")]
    pub(crate) sun: Vec<Numbers<2>>,
    /// Hours of each day on the clocks of --zone between which the sun is kept, both included [default: from sunrise to sunset]
    #[arg(long, value_name = "HH:MM,HH:MM", help_heading = "When")]
    pub(crate) between: Option<Hours>,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    #[command(flatten)]
    pub(crate) place: SunPlace,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Heights above the ground (.tif, nodata -9999 beside the parcel and where nothing bounds; .npy, NaN and infinity), a map of them
    /// (.png), or the envelope as closed solids (.ply .obj). May be given several times
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write heights of the envelope in the heights of the cloud (.tif .npy)
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) tops: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct Comfort {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) places: ComfortPlaces,
    /// Metres between places along a route [default: 2]
    #[arg(long, value_name = "M", requires = "route", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Places")]
    pub(crate) route_step: Option<f64>,
    /// Height of places on a route above the ground, in metres [default: 1.1, for which PET and UTCI are defined]
    #[arg(long, value_name = "M", requires = "route", allow_negative_numbers = true, value_parser = finite, help_heading = "Places")]
    pub(crate) height: Option<f32>,
    /// Longest side of the pieces that windows of a mesh are cut into, in metres [default: 0.5]
    #[arg(long, value_name = "M", requires = "windows", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Places")]
    pub(crate) spacing: Option<f64>,
    /// Where the ground comes from: auto (class 2 where there is one, else found), classed, found, or cloud=FILE, which a ball file
    /// needs
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Places")]
    pub(crate) ground: GroundChoice,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    #[command(flatten)]
    pub(crate) place: SunPlace,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Directions spread evenly over the sky, 1 to 100000 [default: 577]
    #[arg(long, value_name = "N", value_parser = at_least_one, conflicts_with = "patches", help_heading = "Sky")]
    pub(crate) directions: Option<usize>,
    /// The middles of sky patches instead: tregenza (145) or reinhart (577)
    #[arg(long, value_enum, value_name = "NAME", help_heading = "Sky")]
    pub(crate) patches: Option<PatchesChoice>,
    /// Table with a row for each place of the routes, or for each window (.csv)
    #[arg(short, long, value_name = "CSV", help_heading = "Result")]
    pub(crate) output: PathBuf,
    /// Also write a row for each route as a whole (.csv)
    #[arg(long, value_name = "CSV", requires = "route", help_heading = "Result")]
    pub(crate) routes: Option<PathBuf>,
    /// Also write a row for each route and sun: time, direction of the sun, share of the route in shade (.csv)
    #[arg(long, value_name = "CSV", requires = "route", help_heading = "Result")]
    pub(crate) times: Option<PathBuf>,
}

#[derive(Args)]
#[command(next_help_heading = "Places (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct ComfortPlaces {
    /// Walking routes: lines from GeoJSON, one from a table with columns x, y and perhaps z, the height of the eye (.csv), or its corners
    /// as "X,Y X,Y …"
    #[arg(long, value_name = "FILE|CORNERS", allow_hyphen_values = true)]
    pub(crate) route: Option<Corners>,
    /// Windows: a table with columns x, y, z of the middle and azimuth in degrees from grid north, which may have tilt (90: upright), width
    /// and height in metres (.csv), or the faces of a mesh (.obj .json .ply)
    #[arg(long, value_name = "FILE")]
    pub(crate) windows: Option<PathBuf>,
}
