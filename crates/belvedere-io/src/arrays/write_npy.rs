//! NumPy arrays.

use npyz::{AutoSerialize, WriterBuilder};

use crate::files::output::Output;
use crate::points::columns::WriteReport;
use belvedere_data::raster::Raster;
use belvedere_data::{Error, PointCloud, Result};

/// Writes `values` as an array of `shape` in C order; the product of the shape must be their number.
pub(crate) fn write_array<T: AutoSerialize>(
    output: Output<'_>,
    shape: &[usize],
    values: impl Iterator<Item = T>,
) -> Result<()> {
    let shape: Vec<u64> = shape.iter().map(|&n| n as u64).collect();
    output.write(|path, output| {
        let options = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(output);
        let mut array = options.begin_nd().map_err(Error::io(path))?;
        array.extend(values).map_err(Error::io(path))?;
        array.finish().map_err(Error::io(path))
    })
}

/// Writes file coordinates, (N, 3) f64.
pub(crate) fn write_coordinates(output: Output<'_>, cloud: &PointCloud) -> Result<WriteReport> {
    let coordinates = cloud.positions.iter().flat_map(|&p| cloud.frame.to_file_coordinates(p));
    write_array(output, &[cloud.len(), 3], coordinates)?;
    let left_out = cloud.attributes.columns().into_iter().map(|(name, _)| name.to_owned()).collect();
    Ok(WriteReport { point_count: cloud.len(), left_out, clamped_count: 0 })
}

/// Writes (N) u8, such as answers.
///
/// # Errors
/// [`Error::Io`].
pub fn write_npy_u8<'a>(output: impl Into<Output<'a>>, values: &[u8]) -> Result<()> {
    write_array(output.into(), &[values.len()], values.iter().copied())
}

/// Writes (N) f32.
///
/// # Errors
/// [`Error::Io`].
pub fn write_npy_f32<'a>(output: impl Into<Output<'a>>, values: &[f32]) -> Result<()> {
    write_array(output.into(), &[values.len()], values.iter().copied())
}

/// Writes a raster as (height, width) f32, row 0 at the top; values that are not finite stay unchanged.
///
/// # Errors
/// [`Error::Io`].
pub fn write_npy_f32_2d<'a>(output: impl Into<Output<'a>>, raster: &Raster<f32>) -> Result<()> {
    write_array(output.into(), &[raster.height(), raster.width()], raster.values().iter().copied())
}

/// Writes a raster as (height, width) u32, row 0 at the top.
///
/// # Errors
/// [`Error::Io`].
pub fn write_npy_u32_2d<'a>(output: impl Into<Output<'a>>, raster: &Raster<u32>) -> Result<()> {
    write_array(output.into(), &[raster.height(), raster.width()], raster.values().iter().copied())
}

/// Writes `bands`, (B) of (height · width) values each, as (B, height, width) u32, row 0 at the top.
///
/// # Errors
/// [`Error::LengthMismatch`] for a band of another size, [`Error::Io`].
pub fn write_npy_u32_bands<'a>(
    output: impl Into<Output<'a>>,
    bands: &[Vec<u32>],
    width: usize,
    height: usize,
) -> Result<()> {
    let expected = width * height;
    if let Some(band) = bands.iter().find(|band| band.len() != expected) {
        return Err(Error::LengthMismatch { what: "band", expected, found: band.len() });
    }
    write_array(output.into(), &[bands.len(), height, width], bands.iter().flatten().copied())
}
