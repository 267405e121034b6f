//! Flags of plans of where to scan again.

use super::observers::{EndHeights, LinesArguments};
use super::{GroundChoice, NorthArguments, Numbers, SceneInput, above_zero, at_most, height};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct SurveyPlanArguments {
    #[command(flatten)]
    pub(crate) lines: LinesArguments,
    /// Observers of all cells on the ground: a table with x and y (.csv) or points (.geojson .gpkg .shp)
    #[arg(long, value_name = "FILE", group = "lines", conflicts_with_all = ["pairs", "random", "from", "to"],
        help_heading = "Lines of sight (one of)")]
    pub(crate) observers: Option<PathBuf>,
    /// Prove the light of a sun on the ground, in degrees; repeatable
    ///
    /// Its azimuth and elevation, for all cells of the ground.
    /// Azimuths are clockwise from true north, or from grid north with --grid-north. belvedere sun-position says where
    /// the sun stands.
    #[arg(long = "sun", value_name = "AZ,EL", group = "lines", allow_hyphen_values = true,
        conflicts_with_all = ["pairs", "random", "from", "to", "observers"], help_heading = "Lines of sight (one of)")]
    pub(crate) suns: Vec<Numbers<2>>,
    #[command(flatten)]
    pub(crate) north: NorthArguments,
    /// With --observers or --sun: side of a cell in metres [default: 2, doubled until there are at most 40000]
    #[arg(long, value_name = "M", conflicts_with_all = ["pairs", "random", "from"], value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Lines of sight (one of)")]
    pub(crate) cell: Option<f64>,
    #[command(flatten)]
    pub(crate) heights: EndHeights,
    #[command(flatten)]
    pub(crate) stations: StationPlaces,
    /// Distance between candidates on a line, in metres [default: 5]
    #[arg(long = "distance-step-m", value_name = "M", requires = "file", conflicts_with_all = ["on_ground", "on_roofs"],
        value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Candidates (one of)")]
    pub(crate) step: Option<f64>,
    /// Take each line of --candidates as one candidate: a flight line
    ///
    /// It is scanned from all of its places, and proves what these prove together.
    #[arg(long, requires = "file", conflicts_with_all = ["on_ground", "on_roofs"],
        help_heading = "Candidates (one of)")]
    pub(crate) whole_lines: bool,
    /// Height of the scanner for candidates without Z, in metres [default: 1.8]
    ///
    /// Above the ground or the roof.
    #[arg(long, value_name = "M", value_parser = height::<f64>, allow_negative_numbers = true, help_heading = "Candidates (one of)")]
    pub(crate) station_height: Option<f64>,
    /// Number of stations to choose
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = at_most::<100_000>, help_heading = "Scanner")]
    pub(crate) count: usize,
    /// Maximum range of the scanner in metres [default: 100]
    ///
    /// Medium-range scanners reach 100 m on most surfaces.
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Scanner")]
    pub(crate) max_distance: Option<f64>,
    /// Angle between pulses in degrees [default: 0.1, a coarse scan]
    #[arg(long, value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Scanner")]
    pub(crate) angle_step_deg: Option<f64>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Scanner")]
    pub(crate) ground: GroundChoice,
    /// Candidates with what is expected of them (.csv .geojson .gpkg); repeatable
    ///
    /// A table, or points in WGS 84.
    ///
    /// Chosen stations come first. station: its number, empty for a candidate that was not chosen. settles_alone and
    /// settles_alone_percent: unproven lines that become proven by it alone if nothing stands where no pulse was.
    /// expected_alone: how many are expected to. proves_alone_m: unproven length that it would prove. settled,
    /// settled_percent and expected: the same for it and the stations before it together.
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
#[command(next_help_heading = "Candidates (one of)")]
#[group(id = "station_places", required = true, multiple = false)]
pub(crate) struct StationPlaces {
    /// Places for the scanner from a table with columns x and y (.csv), or points and lines (.geojson .gpkg .shp)
    ///
    /// Column or property z is the height of the scanner, height its height above the ground. A flight line is a line
    /// with heights.
    #[arg(long = "candidates", value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// Places for the scanner above the ground, in the middle of each cell of this side in metres
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) on_ground: Option<f64>,
    /// Places for the scanner above roofs, in the middle of each cell of this side in metres
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) on_roofs: Option<f64>,
}
