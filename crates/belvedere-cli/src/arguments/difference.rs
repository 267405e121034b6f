//! Flags of differences between two results.

use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct DifferenceArguments {
    /// Raster of the scene as it is (.tif), or table (.csv)
    #[arg(value_name = "BEFORE")]
    pub(crate) before: PathBuf,
    /// Raster of the scene as planned (.tif), with the same cells, or table of the same rows (.csv)
    #[arg(value_name = "AFTER")]
    pub(crate) after: PathBuf,
    /// Raster of the change (.tif), map with a legend of gains and losses (.png) or table (.csv); repeatable
    ///
    /// .tif: value after less value before, nodata -9999 where either has no value. Cells on top of what was added
    /// (--surface with --add) are other places than before, and are not compared. .csv: sums; of tables the rows with
    /// NAME_before, NAME_after and NAME_change of each column that changes.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Cloud, or raster of heights with the same cells (.tif), whose relief the map shows
    #[arg(long, value_name = "FILE")]
    pub(crate) relief: Option<PathBuf>,
    /// Title of the map [default: the names of the two files]
    #[arg(long, value_name = "TEXT", help_heading = "Result")]
    pub(crate) title: Option<String>,
}
