//! Flags of lines of sight and viewsheds.

use super::{NorthArguments, Numbers, SceneInput, TilesArguments, Usage, above_zero, at_most, height, length};
use belvedere::apps::ask::HowSure;
use belvedere::ground::GroundPoints;
use belvedere::query::{Curvature, MAX_RANDOM_PAIRS};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

#[derive(Args)]
pub(crate) struct LineOfSightArguments {
    #[command(flatten)]
    pub(crate) lines: LinesArguments,
    /// Places of a network, of which each pair is tested (.csv .geojson .gpkg .shp)
    ///
    /// Columns or properties: x, y, and z or height above the ground (--observer-height where neither is given), and
    /// name or id. Lines of sight are the same in both directions.
    #[arg(long, value_name = "FILE", group = "lines", conflicts_with_all = ["pairs", "random", "from", "to", "target_height"],
        help_heading = "Lines of sight (one of)")]
    pub(crate) among: Option<PathBuf>,
    /// With --among: horizontal distance up to which two places are a pair, in metres [default: no limit]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Lines of sight (one of)")]
    pub(crate) max_distance: Option<f64>,
    #[command(flatten)]
    pub(crate) heights: EndHeights,
    #[command(flatten)]
    pub(crate) earth: Earth,
    #[command(flatten)]
    pub(crate) radio: Radio,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    #[command(flatten)]
    pub(crate) how_sure: HowSureArguments,
    /// With --observer and --target: terrain and obstacles along the line (.csv .png)
    #[arg(long, value_name = "OUT", requires = "from", conflicts_with_all = ["pairs", "random", "among"],
        help_heading = "Result")]
    pub(crate) profile_out: Option<PathBuf>,
    /// Distance between rows of the profile in metres [default: 1/1000 of the line, at least 0.1]
    #[arg(long = "distance-step-m", value_name = "M", requires = "profile_out",
        conflicts_with_all = ["pairs", "random", "among"],
        value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Result")]
    pub(crate) profile_step: Option<f64>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// For the profile, and for ends without a height. auto: ground points (class 2) if the cloud has them, else found.
    /// classed: class 2 only. found: detected from the shape of the cloud. cloud=FILE: the ground of another cloud,
    /// which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Result")]
    pub(crate) ground: GroundChoice,
    /// Terrain beyond the cloud: elevation raster (DTM) in the coordinate system of the cloud or in degrees (.tif)
    ///
    /// Ends of lines may then lie on it, and the terrain blocks beyond the cloud. Its heights are bilinear between the
    /// middles of its cells. Within the extent of the cloud, and one cell around it, the raster blocks nothing. Cells
    /// without a value block nothing.
    #[arg(long, value_name = "DTM", help_heading = "Far terrain")]
    pub(crate) terrain: Option<PathBuf>,
    /// Table with a row for each pair (.csv), lines (.geojson .gpkg), or a network (.graphml); repeatable
    ///
    /// A network needs --among: places are its nodes, and visible and unproven pairs its edges. Columns: with --among a
    /// and b, the names of both places; ax,ay,az,bx,by,bz, answer (0 blocked, 1 visible, 2 unproven, 3 no line, 4
    /// outside the cloud, 5 an end inside an obstacle), first_block_range_m from A, unproven_m (not with --unproven
    /// as-visible, which is faster), fresnel_free_percent (with --frequency-ghz), block_x, block_y, block_z, and
    /// block_ball and block_source: the rows of the first blocking ball and of the point that it touches. Where the
    /// scene has patches of surfaces: block_surface, the kind of the patch that blocks first (roof, wall, parapet,
    /// inside). With --terrain: block_terrain, 1 where the terrain blocks first.
    #[arg(short, long = "output", value_name = "OUT", required_unless_present = "from", help_heading = "Result")]
    pub(crate) outputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
#[command(next_help_heading = "Lines of sight (one of)")]
#[group(id = "lines", required = true, multiple = true)]
pub(crate) struct LinesArguments {
    /// Table with columns ax,ay,az,bx,by,bz: observer A, target B (.csv), or lines (.geojson .gpkg .shp)
    ///
    /// Of a line the first corner is the observer, and the last the target. An end without a height is
    /// --observer-height or --target-height above the ground.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["from", "to", "random"])]
    pub(crate) pairs: Option<PathBuf>,
    /// N random pairs, at most 10 million, uniform in the bounding box of the cloud (see --seed)
    #[arg(long, value_name = "N", value_parser = at_most::<MAX_RANDOM_PAIRS>, conflicts_with_all = ["from", "to"])]
    pub(crate) random: Option<usize>,
    /// Observer of one line, in file coordinates or as LAT,LON; without Z --observer-height above the ground
    #[arg(long = "observer", value_name = "X,Y[,Z]", requires = "to", allow_hyphen_values = true)]
    pub(crate) from: Option<MapPosition>,
    /// Target of one line, in file coordinates or as LAT,LON; without Z --target-height above the ground
    #[arg(long = "target", value_name = "X,Y[,Z]", requires = "from", allow_hyphen_values = true)]
    pub(crate) to: Option<MapPosition>,
}

/// Heights of ends that have none of their own.
#[derive(Args)]
#[command(next_help_heading = "Lines of sight (one of)")]
pub(crate) struct EndHeights {
    /// Height of observers without Z above the ground in metres [default: 1.7]
    #[arg(long, value_name = "M", value_parser = height::<f64>, conflicts_with = "random", allow_negative_numbers = true)]
    pub(crate) observer_height: Option<f64>,
    /// Height of targets without Z above the ground in metres [default: 0.1]
    #[arg(long, value_name = "M", value_parser = height::<f64>, conflicts_with = "random", allow_negative_numbers = true)]
    pub(crate) target_height: Option<f64>,
}

/// Radio links.
#[derive(Args)]
#[command(next_help_heading = "Lines of sight")]
pub(crate) struct Radio {
    /// Frequency of a radio link in GHz, 0.001 to 1000, to test its first Fresnel zone
    ///
    /// The zone is the space around the line of sight that must be free too.
    #[arg(long = "frequency-ghz", value_name = "GHZ", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) frequency: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Lines of sight")]
pub(crate) struct Earth {
    /// Curvature of the earth and refraction; auto applies them to lines longer than 2 km
    #[arg(long, value_enum, default_value_t = CurvatureChoice::Auto)]
    pub(crate) curvature: CurvatureChoice,
    /// Coefficient of refraction, 0 to below 1 [default: 1/7, as in GDAL and GRASS]
    #[arg(long, value_name = "K", allow_negative_numbers = true)]
    pub(crate) refraction: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Lines of sight")]
pub(crate) struct GivingWay {
    /// Surface tolerance: how far carved balls are reduced near an end of a line, in metres [default: 0.2]
    ///
    /// Balls bulge between the points of walls and roofs. Use 0 for targets that do not lie on surfaces.
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = length)]
    pub(crate) shell: Option<f32>,
    /// How unproven targets are reported [default: report]
    ///
    /// Nothing blocks an unproven target, but more than 0.5 m of its line of sight runs through space that no pulse
    /// came near. This needs carved balls with their pulses: a cloud, or an .npz file.
    #[arg(long, value_enum)]
    pub(crate) unproven: Option<UnprovenChoice>,
}

#[derive(Args)]
#[command(next_help_heading = "Result")]
pub(crate) struct HowSureArguments {
    /// Also give the probability that a target is visible or lit, 0 to 1
    ///
    /// It follows from lines parallel to the line of sight, half a pulse spacing beside it, and from what pulses prove.
    /// docs/methods/confidence.md says how well it is calibrated. Needs pulses, as --unproven does.
    #[arg(long)]
    pub(crate) probability: bool,
    /// Also tell which answers are less certain than this probability, such as 0.9
    ///
    /// Unproven answers are uncertain too.
    #[arg(long, value_name = "P", allow_negative_numbers = true)]
    pub(crate) certain: Option<f64>,
}

impl HowSureArguments {
    pub(crate) fn choice(&self) -> HowSure {
        HowSure { probability: self.probability, certain: self.certain }
    }
}

#[derive(Args)]
#[command(next_help_heading = "Result")]
pub(crate) struct IntervalArgument {
    /// Also give the expected value, and an interval that holds the truth in 90 %
    ///
    /// They follow from the errors found in simulated towns: docs/methods/confidence.md. Only where trees are opaque.
    #[arg(long)]
    pub(crate) interval: bool,
}

/// The surface tolerance, for commands that do not report unproven targets.
#[derive(Args)]
#[command(next_help_heading = "Lines of sight")]
pub(crate) struct Shell {
    /// Surface tolerance: how far carved balls are reduced near an end of a line, in metres [default: 0.2]
    ///
    /// Balls bulge between the points of walls and roofs. Use 0 for targets that do not lie on surfaces.
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = length)]
    pub(crate) shell: Option<f32>,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum CurvatureChoice {
    /// For lines longer than 2 km
    Auto,
    /// For all lines
    On,
    /// The earth is flat
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
pub(crate) struct ViewshedArguments {
    #[command(flatten)]
    pub(crate) who: Who,
    #[command(flatten)]
    pub(crate) looking: LookingArguments,
    #[command(flatten)]
    pub(crate) earth: Earth,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    #[command(flatten)]
    pub(crate) how_sure: HowSureArguments,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Cells")]
    pub(crate) ground: GroundChoice,
    /// Side of a cell in metres [default: 0.5, doubled until there are at most 4 million cells]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Cells")]
    pub(crate) cell: Option<f64>,
    /// Raster (.tif), map (.png), visible areas (.geojson .gpkg) or points (.laz .las .ply .csv); repeatable
    ///
    /// On a grid: .tif has 1 visible, 0 blocked, 2 unproven, 255 nodata; with several observers it has their number,
    /// 65535 nodata. .png is a map with a legend. .geojson has the visible areas in WGS 84. Points of the cloud: column
    /// answer has 0 blocked, 1 visible, 2 unproven, 3 outside the view; with several observers also column observers,
    /// their number.
    #[arg(short, long, value_name = "OUT", required_unless_present = "far_output", help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Raster (.tif), map (.png) or visible areas (.geojson .gpkg) of the terrain beyond the cloud; repeatable
    ///
    /// Values are those of -o. Cells are those of --terrain within --max-distance; nodata within the extent of the
    /// cloud and where the terrain has no height. Targets are --target-height above the terrain.
    #[arg(long, value_name = "OUT", requires = "terrain", help_heading = "Far terrain")]
    pub(crate) far_output: Vec<PathBuf>,
    /// Terrain beyond the cloud: elevation raster (DTM) in the coordinate system of the cloud or in degrees (.tif)
    ///
    /// Observers, or the target, may then be on it. Its heights are bilinear between the middles of its cells. Within
    /// the extent of the cloud, and one cell around it, the raster blocks nothing. Cells without a value block nothing.
    #[arg(long, value_name = "DTM", help_heading = "Far terrain")]
    pub(crate) terrain: Option<PathBuf>,
    /// Also write the minimum visible height above ground of each cell, in metres (.tif .npy)
    ///
    /// How high an object in the cell must be to be seen. Cells where nothing up to --max-height is visible: nodata
    /// -9999 in .tif, infinity in .npy. Cells without ground: nodata in .tif, NaN in .npy.
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) heights: Option<PathBuf>,
    /// Maximum height above the ground for --heights, in metres
    #[arg(long = "max-height", value_name = "M", default_value_t = 100.0, requires = "heights", value_parser = above_zero::<f64>,
        allow_negative_numbers = true, help_heading = "Result")]
    pub(crate) ceiling: f64,
    /// Also write which observers see each cell (.npy .tif)
    ///
    /// .npy: (bands, rows, columns) u32; bit i of band b is observer 32 b + i. .tif: up to 32 observers.
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) masks: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) tiles: TilesArguments,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
#[command(next_help_heading = "Observers (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct Who {
    /// An observer in file coordinates or as LAT,LON; without Z --observer-height above the ground; repeatable
    #[arg(long, visible_alias = "at", value_name = "X,Y[,Z]", allow_hyphen_values = true)]
    pub(crate) observer: Vec<MapPosition>,
    /// Observers from a table with columns x and y (.csv), or points and lines (.geojson .gpkg .shp)
    ///
    /// Columns or properties z, height, min_distance, max_distance, azimuth_from, azimuth_to, elevation_from and
    /// elevation_to override the flags, also under their names in QGIS (observ_hgt, radius) and ArcGIS (OFFSETA,
    /// RADIUS2).
    #[arg(long, value_name = "FILE")]
    pub(crate) observers: Option<PathBuf>,
    /// Total viewshed: N observers spread evenly over the map, at most 65534
    ///
    /// The result counts for each cell how many of them see it. If --target-height equals --observer-height, this count
    /// divided by N is the share of the open ground that the cell sees. Observers stand outside buildings.
    #[arg(long, value_name = "N", value_parser = at_most::<65_534>)]
    pub(crate) spread: Option<usize>,
    /// Reverse viewshed: the cells from which this target is seen
    ///
    /// The target is --target-height above the ground if it has no Z. The observers are --observer-height above the
    /// ground of each cell.
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true)]
    pub(crate) target: Option<MapPosition>,
}

#[derive(Args)]
#[command(next_help_heading = "Limits of sight")]
pub(crate) struct LookingArguments {
    /// Distance between observers on a path, in metres; a table then has the corners of one path
    /// [default for GeoJSON: 5]
    #[arg(long = "distance-step-m", value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) step: Option<f64>,
    /// Height of observers above the ground in metres [default: 1.7]
    #[arg(long, value_name = "M", value_parser = height::<f64>, allow_negative_numbers = true)]
    pub(crate) observer_height: Option<f64>,
    /// Height of targets above the ground in metres [default: 0.1]
    #[arg(long, value_name = "M", value_parser = height::<f64>, allow_negative_numbers = true)]
    pub(crate) target_height: Option<f64>,
    /// Maximum horizontal distance in metres [default: no limit]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) max_distance: Option<f64>,
    /// Minimum horizontal distance in metres [default: 0]
    #[arg(long, value_name = "M", value_parser = length, allow_negative_numbers = true)]
    pub(crate) min_distance: Option<f32>,
    /// Range of azimuths that observers see, clockwise from true north, in degrees; 300,60 looks north
    ///
    /// See --grid-north.
    #[arg(long = "azimuth-range", value_name = "FROM,TO", allow_hyphen_values = true)]
    pub(crate) azimuth: Option<Numbers<2>>,
    /// Range of elevations that observers see, in degrees, -90 to 90
    #[arg(long = "elevation-range", value_name = "FROM,TO", allow_hyphen_values = true)]
    pub(crate) elevation: Option<Numbers<2>>,
    #[command(flatten)]
    pub(crate) north: NorthArguments,
}

/// A place on the map, with a height or without.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct MapPosition(pub(crate) [f64; 2], pub(crate) Option<f64>);

impl MapPosition {
    /// Refuses a place that `flag` gives twice: it would count twice.
    pub(crate) fn refuse_twice(flag: &str, places: &[Self]) -> Result<(), Usage> {
        let again = places.iter().enumerate().find(|(number, place)| places[..*number].contains(place));
        match again {
            Some((_, Self([x, y], z))) => {
                let z = z.map_or(String::new(), |z| format!(",{z}"));
                Err(Usage(format!("{flag} {x},{y}{z}: given twice")))
            }
            None => Ok(()),
        }
    }
}

impl FromStr for MapPosition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.matches(',').count() {
            1 => Ok(Self(text.parse::<Numbers<2>>()?.0, None)),
            2 => {
                let [x, y, z] = text.parse::<Numbers<3>>()?.0;
                Ok(Self([x, y], Some(z)))
            }
            _ => Err("expected 2 or 3 numbers separated by commas".to_owned()),
        }
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

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum UnprovenChoice {
    /// As a value of their own: 2
    Report,
    /// As visible: 1
    AsVisible,
    /// As blocked: 0
    AsBlocked,
}
