//! Flags of questions in JSON.

use super::{FarTerrainArguments, SceneInput, Shell, TilesArguments};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct AskArguments {
    /// Question: a file (.json), - for standard input, or a raster that answers it (.tif)
    #[arg(value_name = "QUESTION")]
    pub(crate) question: PathBuf,
    /// Values of targets: raster (.tif), map (.png), or points (.laz .las .ply .csv); repeatable
    ///
    /// For questions that have a value for each cell, place or point: shadow, sun-hours, sky-view, irradiance and heat.
    /// Other results are in the summary of --json, and in the files of their own commands.
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) shell: Shell,
    #[command(flatten)]
    pub(crate) far: FarTerrainArguments,
    #[command(flatten)]
    pub(crate) tiles: TilesArguments,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}
