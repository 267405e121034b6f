//! Heights of cells as files.

use crate::outputs::formats::extension;
use anyhow::Result;
use belvedere::Frame;
use belvedere::ground::MapGrid;
use belvedere::io::{BandLabel, BandValues, Bands, MetadataTag, write_npy_f32_2d, write_tif_bands};
use belvedere::raster::Raster;
use belvedere::results::{ResultKind, georeference};
use std::path::Path;
use std::slice::from_ref;

/// Writes heights of the cells of `grid`, NaN where there is none, as .npy or GeoTIFF; `what` says what they are. A
/// GeoTIFF has `tags` as metadata.
pub(crate) fn write_heights(
    output: &Path,
    heights: &Raster<f32>,
    (grid, frame): (&MapGrid, &Frame),
    what: &str,
    tags: &[MetadataTag],
) -> Result<()> {
    if extension(output) == "npy" {
        return Ok(write_npy_f32_2d(output, heights)?);
    }
    let values = BandValues::F32(from_ref(heights), ResultKind::NO_NUMBER);
    let bands = Bands { values, labels: &[BandLabel::new("height", "m")], tags, description: Some(what) };
    Ok(write_tif_bands(output, &bands, Some(&georeference(grid, frame)))?)
}
