//! Flags of towers.

use super::sky::SkyPlacesChoice;
use super::{Earth, FarTerrainArguments, GroundChoice, SceneInput, Shell, SkyOutputs, SkyPlaces, above_zero, length};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct TowersArguments {
    /// Towers: a table (.csv) with the columns x, y and tip, or points (.geojson .gpkg .shp) with tip
    ///
    /// They may have base, hub, name and scheme. tip and hub are metres above the base; base is a height of the file.
    /// Without it a tower stands on the ground of the cloud, or on --terrain. x and y may be latitude and longitude.
    #[arg(long, value_name = "FILE", required = true, help_heading = "Towers")]
    pub(crate) towers: PathBuf,
    /// Distance up to which towers count, in metres on the map [default: no limit]
    #[arg(long = "max-distance", value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Towers")]
    pub(crate) max_distance: Option<f64>,
    #[command(flatten)]
    places: SkyPlacesChoice,
    /// Height of eyes above the ground, above --surface, or of --at, in metres [default: 1.7]
    #[arg(long = "observer-height", value_name = "M", allow_negative_numbers = true, value_parser = length, help_heading = "Targets")]
    pub(crate) height: Option<f32>,
    /// Side of a cell in metres [default: 0.5, doubled until there are at most 4 million cells]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Targets")]
    cell: Option<f64>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Targets")]
    pub(crate) ground: GroundChoice,
    /// Terrain beyond the cloud: elevation raster (DTM) in the coordinate system of the cloud or in degrees (.tif)
    ///
    /// Towers may stand on it, and it hides them, with the curvature of the earth. Within the extent of the cloud, and
    /// one cell around it, the raster hides nothing. Cells without a value hide nothing.
    #[arg(long, value_name = "DTM", help_heading = "Far terrain")]
    terrain: Option<PathBuf>,
    /// The same for eyes on the cells of --terrain within --max-distance: raster (.tif) or map (.png); repeatable
    #[arg(long, value_name = "OUT", requires = "terrain", help_heading = "Far terrain")]
    pub(crate) far_output: Vec<PathBuf>,
    /// Folder for a picture of what each eye of --at or --targets sees of the towers, and wirelines.csv
    ///
    /// Up to 100 eyes, which may stand on --terrain. Frames of 53.5 degrees, as in the guidance for wind farms, hold
    /// all towers: terrain, the skyline of the cloud, and the visible parts of towers and of the discs that blades
    /// sweep.
    #[arg(long, value_name = "DIR", help_heading = "Result")]
    pub(crate) wirelines: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Lines of sight")]
    pub(crate) earth: Earth,
    #[command(flatten)]
    pub(crate) shell: Shell,
    #[command(flatten)]
    pub(crate) outputs: SkyOutputs,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

impl TowersArguments {
    /// The places of the eyes, as other commands have them.
    pub(crate) fn places(&self) -> SkyPlaces {
        SkyPlaces {
            places: self.places.clone(),
            cell: self.cell,
            // that of the question
            height: None,
            ground: self.ground.clone(),
            spacing: None,
            facing: None,
            far: FarTerrainArguments { terrain: self.terrain.clone(), horizon: None },
            edge_mask: None,
        }
    }
}
