//! Values of GeoTIFF rasters that Belvedere wrote.

use tiff::decoder::{Decoder, DecodingResult};

use crate::source::Source;
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Result};

/// The values of a raster of bytes.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for what is no such raster. More than 256 MB of values are refused.
pub fn read_u8<'a>(source: impl Into<Source<'a>>) -> Result<Raster<u8>> {
    read(source.into(), |values| match values {
        DecodingResult::U8(values) => Some(values),
        _ => None,
    })
}

/// The values of a raster of unsigned 16-bit integers.
///
/// # Errors
/// Those of [`read_u8`].
pub fn read_u16<'a>(source: impl Into<Source<'a>>) -> Result<Raster<u16>> {
    read(source.into(), |values| match values {
        DecodingResult::U16(values) => Some(values),
        _ => None,
    })
}

/// The values of a raster of 32-bit floats.
///
/// # Errors
/// Those of [`read_u8`].
pub fn read_f32<'a>(source: impl Into<Source<'a>>) -> Result<Raster<f32>> {
    read(source.into(), |values| match values {
        DecodingResult::F32(values) => Some(values),
        _ => None,
    })
}

fn read<T: Copy>(source: Source<'_>, of_kind: impl Fn(DecodingResult) -> Option<Vec<T>>) -> Result<Raster<T>> {
    let input = source.open()?;
    let name = input.name;
    let damaged = |e: tiff::TiffError| match e {
        tiff::TiffError::IoError(source) => Error::io(&name)(source),
        other => Error::malformed(&name, format!("is no raster that can be read: {other}")),
    };
    let mut decoder = Decoder::new(input.reader).map_err(damaged)?;
    let (width, height) = decoder.dimensions().map_err(damaged)?;
    let values = of_kind(decoder.read_image().map_err(damaged)?);
    let values = values.ok_or_else(|| Error::malformed(&name, "has values of another kind than expected"))?;
    let side = |count: u32| usize::try_from(count).unwrap_or(usize::MAX);
    Raster::from_values(side(width), side(height), values)
}
