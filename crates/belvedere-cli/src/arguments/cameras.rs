//! Flags of camera placement.

use super::{
    Earth, GivingWay, GroundChoice, NorthArguments, Radio, SceneInput, above_zero, at_least_one, at_most, finite,
    height, length,
};
use belvedere::apps::cameras::Level;
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;

#[derive(Args)]
pub(crate) struct CamerasArguments {
    #[command(flatten)]
    pub(crate) candidates: CandidatesArguments,
    /// Distance between candidates on a line of GeoJSON, in metres [default: 5]
    #[arg(long = "distance-step-m", value_name = "M", requires = "file", conflicts_with_all = ["on_ground", "on_roofs"],
        value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Candidates (one of)")]
    pub(crate) step: Option<f64>,
    /// Height of cameras without Z above the ground or the roof, in metres [default: 4 above the ground, 1 above roofs]
    #[arg(long, value_name = "M", value_parser = height::<f64>, allow_negative_numbers = true, help_heading = "Candidates (one of)")]
    pub(crate) camera_height: Option<f64>,
    /// Cameras that exist and stay: a table (.csv) or points (.geojson .gpkg .shp); --count is without them
    ///
    /// The columns are those of --candidates. Each row needs heading and tilt, unless the cameras turn or see all
    /// around.
    #[arg(long, value_name = "FILE", help_heading = "Candidates (one of)")]
    pub(crate) existing: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) lens: CameraLensArguments,
    #[command(flatten)]
    pub(crate) goal: CameraGoalArguments,
    /// Number of cameras that each target needs
    ///
    /// A target with fewer cameras counts in proportion.
    #[arg(long = "per-target", value_name = "N", default_value_t = 1, value_parser = at_most::<1000>, help_heading = "Goal (one of)")]
    pub(crate) required: usize,
    /// Maximum number of branches in the search for the proven optimum; 0 for no search
    /// [default: for about half a minute]
    #[arg(long, value_name = "N", help_heading = "Goal (one of)")]
    pub(crate) search_limit: Option<usize>,
    #[command(flatten)]
    pub(crate) targets: CameraTargetsArguments,
    #[command(flatten)]
    pub(crate) earth: Earth,
    #[command(flatten)]
    pub(crate) radio: Radio,
    /// Percentage of the radius of the first Fresnel zone that must be free, above 0 to 100
    /// [default: 60, as ITU-R P.530]
    #[arg(long, value_name = "PERCENT", requires = "frequency", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Lines of sight")]
    pub(crate) fresnel_percent: Option<f64>,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    /// Cover only what is visible with at least this probability, such as 0.9
    ///
    /// docs/methods/confidence.md says how well probabilities are calibrated. Needs pulses, as --unproven does.
    #[arg(long, value_name = "P", allow_negative_numbers = true, help_heading = "Lines of sight")]
    pub(crate) certain: Option<f64>,
    #[command(flatten)]
    pub(crate) north: NorthArguments,
    /// Cameras (.geojson .gpkg), cameras per cell (.tif), map (.png) or a table of the targets (.csv); repeatable
    ///
    /// .geojson: a point in WGS 84 for each camera with its pose and what it adds; it can be used as --existing. .tif:
    /// the number of cameras that cover each cell, 0 for blind spots, nodata 65535. .csv: a row for each target with
    /// the number of cameras that cover it and their numbers.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write the cells that each camera covers as areas (.geojson .gpkg)
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) footprints: Option<PathBuf>,
    /// Also write the coverage after each camera (.csv)
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) curve: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
#[command(next_help_heading = "Candidates (one of)")]
#[group(id = "candidate_places", required = true, multiple = false)]
pub(crate) struct CandidatesArguments {
    /// Places: a table (.csv), or points and lines (.geojson .gpkg .shp)
    ///
    /// A table has the columns x and y. Columns or properties z, height, heading, tilt, fov, min_distance,
    /// max_distance, azimuth_from, azimuth_to, elevation_from and elevation_to override the flags. The last four are
    /// the range of a camera that turns.
    #[arg(long = "candidates", value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// Places for cameras above the ground, in the middle of each cell of this side in metres
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) on_ground: Option<f64>,
    /// Places for cameras above roofs, in the middle of each cell of this side in metres
    ///
    /// A roof is at least 2 m above the ground. In a cloud with buildings (class 6), only these are roofs.
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) on_roofs: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Cameras")]
pub(crate) struct CameraLensArguments {
    /// Horizontal field of view in degrees, above 0 to 360 [default: 90]
    ///
    /// Below 180 the picture is flat. From 180 on the camera has no pixel density: a fisheye lens, a person, a mast.
    #[arg(long, value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) fov: Option<f64>,
    /// Vertical field of view in degrees [default: of a 16:9 picture; 180 where --fov is 180 or more]
    #[arg(long, value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) vertical_fov: Option<f64>,
    /// Pixels across the picture [default: 1920]
    #[arg(long, value_name = "N", value_parser = at_least_one)]
    pub(crate) pixels: Option<usize>,
    /// Required pixels per metre: a number, a level such as identify, or none
    /// [default: detect; none where --fov is 180 or more]
    ///
    /// The levels of EN 62676-4 are monitor (12.5), detect (25), observe (62.5), recognise (125) and identify (250).
    #[arg(long, value_name = "LEVEL")]
    pub(crate) density: Option<PixelDensity>,
    /// Number of headings to choose from at each place, evenly spread, 1 to 360 [default: 8]
    #[arg(long, value_name = "N", value_parser = at_most::<360>)]
    pub(crate) headings: Option<usize>,
    /// Angle below the horizon that cameras look to, in degrees, -90 to 90; repeatable, to choose from [default: 15]
    #[arg(long, value_name = "DEG", value_parser = finite::<f64>, allow_negative_numbers = true)]
    pub(crate) tilt: Vec<f64>,
    /// Cameras turn and tilt to each target
    #[arg(long, conflicts_with_all = ["headings", "tilt"])]
    pub(crate) turning: bool,
    /// Maximum horizontal distance in metres [default: no limit]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) max_distance: Option<f64>,
    /// Minimum horizontal distance in metres [default: 0]
    #[arg(long, value_name = "M", value_parser = length, allow_negative_numbers = true)]
    pub(crate) min_distance: Option<f32>,
    /// Places that no camera may see: points (.csv) or polygons (.geojson .gpkg .shp)
    ///
    /// Cells of polygons and points without Z are --target-height above the ground. A heading is not used if any of
    /// these places could be in its picture, at any distance.
    #[arg(long, value_name = "FILE")]
    pub(crate) private: Option<PathBuf>,
}

#[derive(Args)]
#[command(next_help_heading = "Goal (one of)")]
#[group(id = "camera_goal", required = true, multiple = false)]
pub(crate) struct CameraGoalArguments {
    /// Cover as much as possible with this number of new cameras
    #[arg(long, value_name = "N", value_parser = at_most::<100_000>)]
    pub(crate) count: Option<usize>,
    /// Cover this percentage of the targets with as few new cameras as possible, above 0 to 100
    #[arg(long, value_name = "PERCENT", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) coverage: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Targets [default: cells on the ground]")]
pub(crate) struct CameraTargetsArguments {
    /// Polygons with cells (.geojson .gpkg .shp), points (.csv or a cloud), or a mesh (.obj .json .ply with faces)
    ///
    /// Column or property weight: how much each target counts; a cell in several polygons has the largest. Surfaces
    /// with normals (meshes, points of a cloud) count with the pixels per metre at the angle at which they are seen,
    /// and not from behind.
    #[arg(long, value_name = "FILE")]
    pub(crate) targets: Option<PathBuf>,
    /// Side of a cell in metres [default: 2, doubled until there are at most 40000]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) cell: Option<f64>,
    /// Height of cells and of points without Z above the ground in metres [default: 1.5]
    #[arg(long, value_name = "M", value_parser = height::<f64>, allow_negative_numbers = true)]
    pub(crate) target_height: Option<f64>,
    /// Maximum side of the triangles that a mesh is cut into, in metres [default: 0.5]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) spacing: Option<f64>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub(crate) ground: GroundChoice,
}

/// Pixels per metre; 0 for none.
#[derive(Clone, Copy)]
pub(crate) struct PixelDensity(pub(crate) f64);

impl FromStr for PixelDensity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self(0.0));
        }
        if let Some((_, level)) = Level::ALL.iter().find(|(name, _)| *name == text) {
            return Ok(Self(level.pixels_per_metre()));
        }
        above_zero(text).map(Self).map_err(|_| {
            "must be a number above zero, or monitor, detect, observe, recognise, identify or none".to_owned()
        })
    }
}
