//! Heights of cells as files.

use super::extension;
use anyhow::Result;
use belvedere::Frame;
use belvedere::ground::MapGrid;
use belvedere::io::{write_npy_f32_2d, write_tif_f32};
use belvedere::raster::Raster;
use belvedere::results::{ResultKind, georeference};
use std::path::Path;

/// Writes heights of the cells of `grid`, NaN where there is none, as .npy or GeoTIFF; `what` says what they are.
pub(super) fn write_heights(
    output: &Path,
    heights: &Raster<f32>,
    (grid, frame): (&MapGrid, &Frame),
    what: &str,
) -> Result<()> {
    if extension(output) == "npy" {
        return Ok(write_npy_f32_2d(output, heights)?);
    }
    let (place, nothing) = (georeference(grid, frame), Some(ResultKind::NO_NUMBER));
    Ok(write_tif_f32(output, heights, Some(&place), nothing, Some(what))?)
}
