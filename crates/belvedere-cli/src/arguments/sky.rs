//! Flags of what is asked about the sun and the sky.

use super::{GroundChoice, SceneInput, Shell, ThroughTrees, above_zero, at_least_one, finite};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Where the sun and the sky are asked about, and what results are written to.
#[derive(Args)]
pub(crate) struct SkyPlaces {
    #[command(flatten)]
    pub(crate) places: SkyPlacesChoice,
    /// Side of a cell in metres [default: 0.5, doubled until there are at most 4 million cells]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Places")]
    pub(crate) cell: Option<f64>,
    /// Height of cells above the ground, or above --surface, in metres [default: 0.1; a person's head is 1.5 up]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = finite, help_heading = "Places")]
    pub(crate) height: Option<f32>,
    /// Where the ground comes from: auto (class 2 where there is one, else found), classed, found, or cloud=FILE, which a ball file
    /// needs
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Places")]
    pub(crate) ground: GroundChoice,
    /// Longest side of the pieces that faces of a mesh are cut into, each asked at a place drawn on it, in metres [default: 0.5]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Places")]
    pub(crate) spacing: Option<f64>,
    /// What surfaces are turned to: level, or their normals; grids are level [default: normals for a mesh, level otherwise]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Places")]
    pub(crate) facing: Option<FacingChoice>,
}

#[derive(Args)]
#[command(next_help_heading = "Places (one of) [default: cells on the ground]")]
#[group(multiple = false)]
pub(crate) struct SkyPlacesChoice {
    /// Cells on top of what stands on the ground: roofs and the ground between at the middle of each cell, crowns at their highest point. Without it cells are on the ground, but for those
    /// that nothing was measured on within a metre and that something of more than 2 m stands on: not under buildings
    #[arg(long)]
    pub(crate) surface: bool,
    /// The points of the cloud themselves, all of them and in their order
    #[arg(long = "self")]
    pub(crate) own: bool,
    /// Points from a file of any cloud format, or a mesh (.obj .json .ply with faces), in the coordinates of the scene's file
    #[arg(long, value_name = "FILE")]
    pub(crate) targets: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FacingChoice {
    /// To the zenith
    Level,
    /// Square to the surface
    Normals,
}

#[derive(Args)]
pub(crate) struct SkyOutputs {
    /// Results on a grid as raster of the first measure (.tif, nodata -9999), or a map with a legend (.png); on cells and points all
    /// measures as columns (.laz .las .ply .csv); on a mesh a table with a row for each object and face (.csv), or the mesh coloured by
    /// the first measure (.ply). May be given several times
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write a raster for each measure of a grid into this folder, made if it is not there
    #[arg(long, value_name = "DIR", help_heading = "Result")]
    pub(crate) measures: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct SkyView {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Directions spread evenly over the sky, 1 to 100000. Root mean square error of either measure in street canyons: 0.012 with
    /// 145, 0.004 with 577, 0.0015 with 2305 [default: 577]
    #[arg(long, value_name = "N", value_parser = at_least_one, conflicts_with = "patches", help_heading = "Sky",
        allow_negative_numbers = true)]
    pub(crate) directions: Option<usize>,
    /// The middles of sky patches instead: tregenza (145) or reinhart (577)
    #[arg(long, value_enum, value_name = "NAME", help_heading = "Sky")]
    pub(crate) patches: Option<PatchesChoice>,
    #[command(flatten)]
    pub(crate) trees: ThroughTrees,
    #[command(flatten)]
    pub(crate) outputs: SkyOutputs,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum PatchesChoice {
    /// 145 patches
    Tregenza,
    /// 577 patches
    Reinhart,
}
