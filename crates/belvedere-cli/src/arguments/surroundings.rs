//! Flags of mesh targets, landmarks, protected views, isovists and horizons.

use super::{
    Earth, FarTerrainArguments, GivingWay, GroundChoice, IntervalArgument, MapPosition, NorthArguments, SceneInput,
    above_zero, height,
};
use belvedere::query::BackFaces;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Flags of targets that are meshes.
#[derive(Args)]
#[command(next_help_heading = "Mesh targets")]
pub(crate) struct MeshTargets {
    /// Maximum side of the triangles that a mesh is cut into, in metres [default: 0.5]
    ///
    /// Each triangle has one sample point.
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) spacing: Option<f64>,
    /// How faces that are turned away from the observer are counted [default: not-visible]
    #[arg(long, value_enum)]
    pub(crate) back_faces: Option<BackFacesChoice>,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum BackFacesChoice {
    /// As not visible
    NotVisible,
    /// Not at all
    LeftOut,
    /// As other faces: for open surfaces and meshes without a consistent outside
    BothSides,
}

impl From<BackFacesChoice> for BackFaces {
    fn from(choice: BackFacesChoice) -> Self {
        match choice {
            BackFacesChoice::NotVisible => Self::NotVisible,
            BackFacesChoice::LeftOut => Self::LeftOut,
            BackFacesChoice::BothSides => Self::BothSides,
        }
    }
}

#[derive(Args)]
pub(crate) struct LandmarkArguments {
    #[command(flatten)]
    pub(crate) shape: LandmarkShapeArguments,
    /// How faces that are turned away from the observer are counted [default: not-visible]
    ///
    /// With the default, shares refer to the whole surface of the landmark.
    #[arg(long, value_enum, requires = "target", conflicts_with_all = ["target_class", "target_polygon"],
        help_heading = "Landmark (one of)")]
    pub(crate) back_faces: Option<BackFacesChoice>,
    /// Observers from a table (.csv) or points (.geojson .gpkg .shp) [default: a grid]
    ///
    /// Columns or properties: x and y, optionally z and height.
    /// The default is one observer in the middle of each cell of a grid over the scene.
    #[arg(long, value_name = "FILE", help_heading = "Observers")]
    pub(crate) observers: Option<PathBuf>,
    /// Side of the cells that contain the observers, in metres [default: 2, doubled until there are at most 40000]
    #[arg(long, value_name = "M", conflicts_with = "observers", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Observers")]
    pub(crate) cell: Option<f64>,
    /// Height of observers above the ground in metres [default: 1.7]
    #[arg(long, value_name = "M", value_parser = height::<f64>, allow_negative_numbers = true, help_heading = "Observers")]
    pub(crate) observer_height: Option<f64>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Observers")]
    pub(crate) ground: GroundChoice,
    /// Maximum distance to the landmark in metres [default: no limit]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Observers")]
    pub(crate) max_distance: Option<f64>,
    #[command(flatten)]
    pub(crate) earth: Earth,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    /// Table of all measures for each observer (.csv), or visible share on a grid (.tif .png); repeatable
    ///
    /// The visible share of the landmark's surface is 0 to 1; nodata is -9999. .png is a map with a legend.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also give the visible share that is expected, by how likely each part is visible
    ///
    /// docs/methods/confidence.md says where probabilities come from. Needs pulses, as --unproven does.
    #[arg(long, help_heading = "Result")]
    pub(crate) probability: bool,
    /// Also write a raster of each measure of a grid into this folder; created if it does not exist
    #[arg(long, value_name = "DIR", conflicts_with = "observers", help_heading = "Result")]
    pub(crate) measures: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

/// The landmark, and how a mesh of it is cut into pieces.
#[derive(Args)]
pub(crate) struct LandmarkShapeArguments {
    #[command(flatten)]
    pub(crate) what: What,
    /// Name of an object of the mesh that is the landmark; repeatable [default: all]
    #[arg(long, value_name = "NAME", requires = "target", conflicts_with_all = ["target_class", "target_polygon"],
        help_heading = "Landmark (one of)")]
    pub(crate) object: Vec<String>,
    /// Maximum side of the triangles that the mesh is cut into, in metres
    /// [default: for about 1000 triangles, at least 0.25]
    #[arg(long, value_name = "M", requires = "target", conflicts_with_all = ["target_class", "target_polygon"],
        value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Landmark (one of)")]
    pub(crate) spacing: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Landmark (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct What {
    /// Landmark as a mesh (.obj .ply .json .city.json) in the coordinates of the scene
    #[arg(long = "targets", value_name = "MESH")]
    pub(crate) target: Option<PathBuf>,
    /// Landmark as the points of this ASPRS class
    #[arg(long, value_name = "N")]
    pub(crate) target_class: Option<u8>,
    /// Landmark as the points above a polygon that are not ground (.geojson .gpkg .shp, or .csv with columns x and y)
    #[arg(long, value_name = "FILE")]
    pub(crate) target_polygon: Option<PathBuf>,
}

#[derive(Args)]
#[command(next_help_heading = "Observers")]
pub(crate) struct EyesArguments {
    /// An observer in file coordinates or as LAT,LON; without Z --observer-height above the ground; repeatable
    #[arg(
        long = "observer",
        visible_alias = "at",
        value_name = "X,Y[,Z]",
        allow_hyphen_values = true,
        required_unless_present = "eyes"
    )]
    pub(crate) eye: Vec<MapPosition>,
    /// Observers from a table with columns x and y (.csv) or from points (.geojson .gpkg .shp)
    ///
    /// Columns or properties z and height override the flags, also as observ_hgt of QGIS, and OFFSETA and SPOT of
    /// ArcGIS.
    #[arg(long = "observers", value_name = "FILE", conflicts_with = "eye")]
    pub(crate) eyes: Option<PathBuf>,
    /// Height of observers above the ground in metres [default: 1.7]
    #[arg(long = "observer-height", value_name = "M", value_parser = height::<f64>, allow_negative_numbers = true)]
    pub(crate) height: Option<f64>,
    /// Source of the ground heights for observers without Z: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub(crate) ground: GroundChoice,
}

#[derive(Args)]
pub(crate) struct ProtectedViewArguments {
    #[command(flatten)]
    pub(crate) shape: LandmarkShapeArguments,
    #[command(flatten)]
    pub(crate) eyes: EyesArguments,
    /// Maximum distance from an observer to the landmark in metres [default: no limit]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Observers")]
    pub(crate) max_distance: Option<f64>,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    /// Side of a cell in metres [default: 0.5, doubled until there are at most 4 million cells]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Result")]
    pub(crate) cell: Option<f64>,
    /// Maximum height of a building above the ground in metres (.tif .npy), or a map of it (.png); repeatable
    ///
    /// Cells that no protected view crosses, and cells without ground: nodata -9999 in .tif, NaN in .npy.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write the maximum height in the vertical system of the cloud (.tif .npy)
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) tops: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
pub(crate) struct IsovistArguments {
    #[command(flatten)]
    pub(crate) eyes: EyesArguments,
    #[command(flatten)]
    pub(crate) north: NorthArguments,
    /// Maximum distance of sight in metres [default: 100]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Rays")]
    pub(crate) max_distance: Option<f64>,
    /// Angle between two rays in degrees [default: 1]
    #[arg(long = "angle-step-deg", value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Rays")]
    pub(crate) step: Option<f64>,
    /// Minimum jump in range that counts as an occluding edge, in metres [default: 0.25]
    #[arg(long = "min-jump", value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Rays")]
    pub(crate) jump: Option<f64>,
    /// Measures of each observer (.csv .json), or the ranges around one observer as a picture (.png); repeatable
    ///
    /// .json also has the corners of the plan.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) interval: IntervalArgument,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
pub(crate) struct HorizonArguments {
    #[command(flatten)]
    pub(crate) eyes: EyesArguments,
    #[command(flatten)]
    pub(crate) earth: Earth,
    /// Angle between two azimuths in degrees; it must divide 360 [default: 1]
    #[arg(long = "angle-step-deg", value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Result")]
    pub(crate) step: Option<f64>,
    #[command(flatten)]
    pub(crate) far: FarTerrainArguments,
    #[command(flatten)]
    pub(crate) north: NorthArguments,
    /// Elevations below the horizontal plane through the observer
    #[arg(long, value_enum, default_value_t = BelowChoice::Zero, help_heading = "Result")]
    pub(crate) below: BelowChoice,
    /// Horizon elevations (.csv), in the format of PVGIS (.txt) or PV*SOL (.hor), or a diagram (.png); repeatable
    ///
    /// .csv: azimuth and elevation in degrees, with one elevation column for each observer. .txt: the elevations of one
    /// observer, one on each line, clockwise from north. .hor: azimuth (0 south, 90 west) and elevation of one
    /// observer. .png: one observer.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) interval: IntervalArgument,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum BelowChoice {
    /// Written as zero, as PVGIS expects
    Zero,
    /// Kept; -90 where nothing blocks
    Keep,
}
