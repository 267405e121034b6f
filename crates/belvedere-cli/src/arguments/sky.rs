//! Flags of the targets of sun and sky commands, and of the sky view.

use super::{
    GroundChoice, IntervalArgument, MapPosition, SceneInput, Shell, ThroughTreesArguments, TilesArguments, above_zero,
    at_least_one, length,
};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The targets of sun and sky commands.
#[derive(Args)]
pub(crate) struct SkyPlaces {
    #[command(flatten)]
    pub(crate) places: SkyPlacesChoice,
    /// Side of a cell in metres [default: 0.5, doubled until there are at most 4 million cells]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Targets")]
    pub(crate) cell: Option<f64>,
    /// Height of cells and of places without Z above what is below, in metres [default: 0.1]
    ///
    /// Use 1.5 for the head of a person.
    #[arg(long = "target-height", value_name = "M", allow_negative_numbers = true, value_parser = length, help_heading = "Targets")]
    pub(crate) height: Option<f32>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Targets")]
    pub(crate) ground: GroundChoice,
    /// Maximum side of the triangles that a mesh is cut into, in metres [default: 0.5]
    ///
    /// Each triangle has one sample point. Along lines of a file of --targets: distance of places [2].
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Targets")]
    pub(crate) spacing: Option<f64>,
    /// Orientation of surfaces: level, or their normals [default: normals for a mesh, else level]
    ///
    /// Cells of a grid are always level.
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Targets")]
    pub(crate) facing: Option<FacingChoice>,
    #[command(flatten)]
    pub(crate) far: FarTerrainArguments,
    /// Also write a mask of the cells near the edge of the cloud (.tif): 1 near the edge, 0 not, nodata 255
    ///
    /// A cell is near the edge if more than 5 % of the light comes from directions that leave the cloud below its
    /// highest point: objects beyond the cloud, as high as that, could block them. Directions count by the sine of
    /// their elevation.
    #[arg(long = "edge-mask", value_name = "OUT", help_heading = "Targets")]
    pub(crate) edge_mask: Option<PathBuf>,
}

/// Terrain beyond the cloud.
#[derive(Args)]
pub(crate) struct FarTerrainArguments {
    /// Terrain beyond the cloud: elevation raster (DTM) in the coordinate system of the cloud or in degrees (.tif)
    ///
    /// Each place has its own horizon, exact for the cells of the raster, with the curvature of the earth and
    /// refraction. Within the extent of the cloud, and one cell around it, the raster blocks nothing. Cells without a
    /// value block nothing.
    #[arg(long, value_name = "DTM", help_heading = "Far terrain")]
    pub(crate) terrain: Option<PathBuf>,
    /// Horizon of far terrain: a file of PVGIS (.json .csv), or a table of azimuth and elevation in degrees (.csv)
    ///
    /// Directions below it are blocked for all targets. Azimuths of PVGIS count from south and those of other tables
    /// clockwise from true north; between rows the elevation is linear.
    #[arg(long, value_name = "FILE", help_heading = "Far terrain")]
    pub(crate) horizon: Option<PathBuf>,
}

#[derive(Args, Clone)]
#[command(next_help_heading = "Targets (one of) [default: cells on the ground]")]
#[group(multiple = false)]
pub(crate) struct SkyPlacesChoice {
    /// Query cells on the top surface: roofs, the ground between them, and tree crowns
    ///
    /// Roofs and ground use the height in the middle of each cell; crowns use their highest point. Without this flag
    /// the cells lie on the ground. Cells below buildings are then left out: those without a measured point within 1 m
    /// below an object higher than 2 m.
    #[arg(long)]
    pub(crate) surface: bool,
    /// Query all points of the cloud, in their order
    #[arg(long = "self")]
    pub(crate) own: bool,
    /// Query points of a file, or a mesh (.obj .json .ply with faces), in the coordinates of the scene
    ///
    /// Points of a table without z, and of .geojson .gpkg .shp, are --target-height above the ground, or above what
    /// covers it, unless a column height says how far. Lines, such as walks, have a place each --spacing.
    #[arg(long, value_name = "FILE")]
    pub(crate) targets: Option<PathBuf>,
    /// Query a single place: X,Y[,Z] in file coordinates, or LATITUDE,LONGITUDE in degrees; repeatable
    ///
    /// Without Z it is --target-height above the ground, or above the roof that covers it. The answer is printed, of
    /// sun hours with the interval that holds the truth in nine of ten cases; -o is not needed.
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true)]
    pub(crate) at: Vec<MapPosition>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FacingChoice {
    /// Horizontal, facing the zenith
    Level,
    /// Perpendicular to their normals
    Normals,
}

#[derive(Args)]
pub(crate) struct SkyOutputs {
    /// Raster (.tif), map (.png), points (.laz .las .ply .csv) or mesh table (.csv .ply); repeatable
    ///
    /// On a grid: .tif has all measures as bands with their names (nodata: 255 of yes or no, -9999 of numbers), and
    /// .png is a map of the first with a legend. Cells and points: all measures as columns. A mesh: a table with a row
    /// for each object and each face (.csv), or the mesh coloured by the first measure (.ply).
    #[arg(short, long, value_name = "OUT", required_unless_present_any = ["at", "by_area"], help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write a raster of each measure of a grid into this folder; created if it does not exist
    #[arg(long, value_name = "DIR", help_heading = "Result")]
    pub(crate) measures: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) by_area: AreaOutputs,
}

/// Results of cells, summed up over areas.
#[derive(Args, Clone)]
pub(crate) struct AreaOutputs {
    /// Areas such as parcels to sum up the cells of a grid over: polygons (.geojson .gpkg .shp)
    #[arg(long, value_name = "FILE", requires = "by_area", help_heading = "Targets")]
    pub(crate) areas: Option<PathBuf>,
    /// With --areas: each area with its attributes and the mean of each measure (.csv .geojson .gpkg)
    ///
    /// A cell belongs to the area that holds its middle; cells without a value do not count, and the column cells says
    /// how many did. The first measure has its least and greatest value too. The mean of answers, 0 or 1, is a share.
    #[arg(long = "by-area", value_name = "OUT", requires = "areas", help_heading = "Result")]
    pub(crate) by_area: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct SkyViewArguments {
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Number of directions, evenly spread over the sky, 1 to 100000 [default: 577]
    ///
    /// Root mean square error of either measure in street canyons: 0.012 with 145 directions, 0.004 with 577, 0.0015
    /// with 2305.
    #[arg(long, value_name = "N", value_parser = at_least_one, conflicts_with = "patches", help_heading = "Sky",
        allow_negative_numbers = true)]
    pub(crate) directions: Option<usize>,
    /// Use the centres of standard sky patches instead: tregenza (145) or reinhart (577)
    #[arg(long, value_enum, value_name = "NAME", help_heading = "Sky")]
    pub(crate) patches: Option<PatchesChoice>,
    #[command(flatten)]
    pub(crate) interval: IntervalArgument,
    #[command(flatten)]
    pub(crate) trees: ThroughTreesArguments,
    #[command(flatten)]
    pub(crate) outputs: SkyOutputs,
    #[command(flatten)]
    pub(crate) tiles: TilesArguments,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum PatchesChoice {
    /// 145 patches
    Tregenza,
    /// 577 patches
    Reinhart,
}
