//! Flags of `normals`, `surfaces` and `balls`, which are also the keys of `--scene-config`. Other commands have only a
//! few of them.

use super::scene::trees;
use super::{CloudInput, OrientChoice, SceneConfig, above_zero};
use belvedere::medial::{Rule, Trees};
use clap::{Args, ValueEnum};
use serde::{Deserialize, Deserializer};
use std::path::PathBuf;
use std::str::FromStr;

/// Points that are cleaned and get normals, for commands that make no balls.
#[derive(Args, Clone)]
pub(crate) struct OrientedPoints {
    #[command(flatten)]
    pub(crate) cleaning: Cleaning,
    #[command(flatten)]
    pub(crate) orienting: Orienting,
    #[command(flatten)]
    pub(crate) input: CloudInput,
    #[command(flatten)]
    pub(crate) config: SceneConfig,
}

#[derive(Args, Clone)]
pub(crate) struct NormalsArguments {
    /// Cloud with normals (.laz .las .ply .csv), or a folder for coords.npy and normals.npy
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) points: OrientedPoints,
}

#[derive(Args, Clone)]
pub(crate) struct SurfacesArguments {
    /// Roofs, edges, ridges, walls (.geojson .gpkg) or points on roofs and walls (.laz .las .ply .csv); repeatable
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) points: OrientedPoints,
}

#[derive(Args, Clone)]
pub(crate) struct BallsArguments {
    #[command(flatten)]
    pub(crate) cleaning: Cleaning,
    #[command(flatten)]
    pub(crate) orienting: Orienting,
    #[command(flatten)]
    pub(crate) shrinking: Shrinking,
    /// Side of the surface on which balls are built [default: interior]
    ///
    /// Interior balls block lines of sight. A folder always gets both sides.
    #[arg(long, value_enum, default_value_t = SideChoice::Interior, hide_default_value = true)]
    pub(crate) side: SideChoice,
    /// Ball file (.npz, or .ply .laz .las to look at), or a folder in the layout of masbcpp
    ///
    /// .npz keeps everything that later commands use, including the pulses. .ply, .laz and .las keep only the balls;
    /// the radius is an attribute. A folder gets ma_coords_*.npy and ma_qidx_*.npy with one row for each input point;
    /// no point is removed, and the default method is `angles`.
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    /// In a folder: write NaN as the centre of balls that never shrank
    #[arg(long, help_heading = "Result")]
    pub(crate) nan: bool,
    /// In a folder: also write the local feature size and a thinning of the points
    ///
    /// Writes lfs.npy, and decimate_lfs.npy, which marks the points that a thinning to this share of the local feature
    /// size keeps.
    #[arg(long, value_name = "EPSILON", help_heading = "Result", value_parser = above_zero::<f32>, allow_negative_numbers = true)]
    pub(crate) simplify: Option<f32>,
    /// Side of the cells in which --simplify counts points, in metres
    #[arg(long = "cell", value_name = "M", default_value_t = 0.5, requires = "simplify", help_heading = "Result",
        value_parser = above_zero::<f32>, allow_negative_numbers = true)]
    pub(crate) cell_size: f32,
    #[command(flatten)]
    pub(crate) input: CloudInput,
    #[command(flatten)]
    pub(crate) config: SceneConfig,
}

#[derive(Args, Clone, Default, Deserialize)]
#[command(next_help_heading = "Cleaning")]
#[serde(default)]
pub(crate) struct Cleaning {
    /// Keep noise points (classes 7 and 18) and withheld points
    #[arg(long)]
    pub(crate) keep_noise: bool,
    /// Keep points within a millimetre of another point
    #[arg(long)]
    pub(crate) keep_duplicates: bool,
    /// Keep isolated points
    #[arg(long)]
    pub(crate) keep_isolated: bool,
    /// Keep the heights of flight lines that differ by more than 5 cm, which are fitted to each other otherwise
    #[arg(long)]
    pub(crate) keep_strips: bool,
}

#[derive(Args, Clone, Default, Deserialize)]
#[command(next_help_heading = "Normals")]
#[serde(default)]
pub(crate) struct Orienting {
    /// Number of neighbours for a normal, 3 to 256, or `adaptive` [default: 16]
    ///
    /// The paper uses 6; masbcpp uses 10.
    #[arg(long, value_name = "K", allow_negative_numbers = true)]
    pub(crate) neighbors: Option<NeighborChoice>,
    /// Orientation: auto, given, up, scanner, scanner=X,Y,Z, stations=FILE, trajectory=FILE, pulses, mesh=FILE
    /// [default: auto]
    ///
    /// auto: the normals of the file if it has them, else the scanner positions of the file, else up; `normals` always
    /// estimates new ones. For carving, auto also searches for the scanner in the data: in pulses with several returns,
    /// in scan angles, and by the grid of pulses around each place where a tripod stood. given: the normals of the
    /// file. up: toward the sky. scanner: toward the scanner positions of the file. scanner=X,Y,Z: toward one position.
    /// stations=FILE: toward the station of each point, from a table with the columns station (the point source id), x,
    /// y and z (.csv .txt). trajectory=FILE: toward the scanner positions in a table or SBET file (.csv .txt .sbet).
    /// pulses: toward scanner positions estimated from pulses with several returns. mesh=FILE: as the nearest face of a
    /// mesh (.obj .ply .json).
    #[arg(long, value_name = "HOW")]
    pub(crate) orient: Option<OrientChoice>,
}

fn rule(name: &str) -> Result<Rule, String> {
    Rule::ALL
        .into_iter()
        .find(|rule| rule.name() == name)
        .ok_or_else(|| format!("unknown rule; the rules are {}", Rule::ALL.map(Rule::name).join(", ")))
}

/// The same in a file.
fn trees_of_file<'de, D: Deserializer<'de>>(value: D) -> Result<Option<Trees>, D::Error> {
    let name = String::deserialize(value)?;
    let known = || Trees::ALL.map(Trees::name).join(", ");
    let found = Trees::ALL.into_iter().find(|trees| trees.name() == name);
    found.map(Some).ok_or_else(|| serde::de::Error::custom(format!("{name:?} is none of {}", known())))
}

/// The same in a file: a list of names, or one text with commas.
fn rules_of_file<'de, D: Deserializer<'de>>(value: D) -> Result<Vec<Rule>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a list of names of rules")]
    enum Names {
        One(String),
        Several(Vec<String>),
    }
    let names = match Names::deserialize(value)? {
        Names::One(text) => text.split(',').map(str::to_owned).collect(),
        Names::Several(names) => names,
    };
    names.iter().map(|name| rule(name)).collect::<Result<_, _>>().map_err(serde::de::Error::custom)
}

#[derive(Args, Clone, Default, Deserialize)]
#[command(next_help_heading = "Balls")]
#[serde(default)]
pub(crate) struct Shrinking {
    /// Method that limits the balls [default: carved if pulses are known, else tau; angles for a folder]
    ///
    /// --side exterior uses tau.
    #[arg(long, value_enum)]
    pub(crate) method: Option<MethodChoice>,
    /// How carved balls represent the crowns of trees [default: measured]
    #[arg(long, value_name = "TREES", value_parser = trees())]
    #[serde(deserialize_with = "trees_of_file")]
    pub(crate) trees: Option<Trees>,
    /// Rules of carved balls to switch off, for research
    ///
    /// docs/methods/carving.md describes each rule.
    #[arg(long, value_name = "RULE,...", value_delimiter = ',', value_parser = rule)]
    #[serde(deserialize_with = "rules_of_file")]
    pub(crate) without: Vec<Rule>,
    /// Initial radius of balls in metres [default: 5 for carved, 30 for tau, 200 for angles]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) initial_radius: Option<f32>,
    /// Maximum radius of balls in metres [default: 0.5 for tau, else no limit]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) max_radius: Option<f32>,
    /// Maximum depth of a point or a pulse inside a ball, in metres [default: 0.02 for carved, 0.05 for tau]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) penetration: Option<f32>,
    /// Separation angle t_a of the paper, in degrees [default: 32]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) first_angle: Option<f64>,
    /// Separation angle t_b of the paper, in degrees [default: 20]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) next_angle: Option<f64>,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum SideChoice {
    /// Inside solid objects: these balls block lines of sight
    Interior,
    /// In free space
    Exterior,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum MethodChoice {
    /// Neither points nor pulses lie deeper than --penetration inside a ball
    Carved,
    /// No point lies deeper than --penetration inside a ball, and radii are limited to half a metre
    Tau,
    /// The separation angles of the paper, as in masbcpp
    Angles,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "serde_json::Value")]
pub(crate) enum NeighborChoice {
    Fixed(usize),
    Adaptive,
}

impl TryFrom<serde_json::Value> for NeighborChoice {
    type Error = String;

    fn try_from(value: serde_json::Value) -> Result<Self, String> {
        value.as_str().map_or_else(|| value.to_string(), str::to_owned).parse()
    }
}

impl FromStr for NeighborChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "adaptive" => Ok(Self::Adaptive),
            _ => text.parse().map(Self::Fixed).map_err(|_| "not a number of neighbours or `adaptive`".to_owned()),
        }
    }
}
