//! GeoTIFF rasters.

use tiff::encoder::colortype::{ColorType, Gray8, Gray16, Gray32, Gray32Float};
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, TiffKind, TiffValue};
use tiff::tags::Tag;

use crate::output::Output;
use belvedere_data::crs::{Crs, text};
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Parameter, Result};

/// Raw size from which files use 64-bit offsets (BigTIFF); tags and incompressible strips need some room below 4 GiB.
const BIG_FILE_BYTES: usize = 3_900_000_000;

/// The program that a file names as its writer.
pub(crate) const SOFTWARE: &str = "belvedere";

/// Where a raster lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Georeference {
    /// File coordinates of the upper left corner of the upper left pixel.
    pub upper_left: [f64; 2],
    /// Step in file coordinates from a column to the next.
    pub column_step: [f64; 2],
    /// Step in file coordinates from a row to the next, downward in the picture.
    pub row_step: [f64; 2],
    /// Reference system of the file coordinates.
    pub crs: Crs,
}

/// Writes `raster` as 32-bit floats, compressed without loss.
///
/// Without a `georeference` the file carries no position and no system; `description` is for such rasters, in view
/// space. With a `nodata` value, what is not finite is written as that value and marked so for GIS programs; without,
/// infinities and NaN stay.
///
/// # Errors
/// [`Error::InvalidParameter`] for a raster without pixels or with a side of more than `u32` pixels, [`Error::Io`].
pub fn write_f32<'a>(
    output: impl Into<Output<'a>>,
    raster: &Raster<f32>,
    georeference: Option<&Georeference>,
    nodata: Option<f32>,
    description: Option<&str>,
) -> Result<()> {
    let marks = Marks { georeference, nodata: nodata.map(|v| v.to_string()), description };
    match nodata {
        Some(nodata) if raster.values().iter().any(|v| !v.is_finite()) => {
            let values = raster.values().iter().map(|&v| if v.is_finite() { v } else { nodata }).collect();
            let finite = Raster::from_values(raster.width(), raster.height(), values)?;
            write::<Gray32Float>(output.into(), &finite, &marks)
        }
        _ => write::<Gray32Float>(output.into(), raster, &marks),
    }
}

/// Writes `raster` as unsigned 32-bit integers, compressed without loss; `nodata` marks the value that stands for
/// nothing, such as `u32::MAX` in an item buffer.
///
/// # Errors
/// As [`write_f32`].
pub fn write_u32<'a>(
    output: impl Into<Output<'a>>,
    raster: &Raster<u32>,
    georeference: Option<&Georeference>,
    nodata: Option<u32>,
    description: Option<&str>,
) -> Result<()> {
    write::<Gray32>(output.into(), raster, &Marks { georeference, nodata: nodata.map(|v| v.to_string()), description })
}

/// Writes `raster` as bytes, compressed without loss; `nodata` marks the value that stands for nothing.
///
/// # Errors
/// As [`write_f32`].
pub fn write_u8<'a>(
    output: impl Into<Output<'a>>,
    raster: &Raster<u8>,
    georeference: Option<&Georeference>,
    nodata: Option<u8>,
    description: Option<&str>,
) -> Result<()> {
    write::<Gray8>(output.into(), raster, &Marks { georeference, nodata: nodata.map(|v| v.to_string()), description })
}

/// Writes `raster` as unsigned 16-bit integers, compressed without loss; `nodata` marks the value that stands for nothing.
///
/// # Errors
/// As [`write_f32`].
pub fn write_u16<'a>(
    output: impl Into<Output<'a>>,
    raster: &Raster<u16>,
    georeference: Option<&Georeference>,
    nodata: Option<u16>,
    description: Option<&str>,
) -> Result<()> {
    write::<Gray16>(output.into(), raster, &Marks { georeference, nodata: nodata.map(|v| v.to_string()), description })
}

struct Marks<'a> {
    georeference: Option<&'a Georeference>,
    nodata: Option<String>,
    description: Option<&'a str>,
}

fn write<C: ColorType>(output: Output<'_>, raster: &Raster<C::Inner>, marks: &Marks<'_>) -> Result<()>
where
    C::Inner: Copy,
    [C::Inner]: TiffValue,
{
    let (Ok(width), Ok(height)) = (u32::try_from(raster.width()), u32::try_from(raster.height())) else {
        return Err(invalid_size(raster.width(), raster.height()));
    };
    if width == 0 || height == 0 {
        return Err(invalid_size(raster.width(), raster.height()));
    }
    output.write(|path, output| {
        let result = if size_of_val(raster.values()) < BIG_FILE_BYTES {
            TiffEncoder::new(output).and_then(|e| encode::<C, _, _>(e, width, height, raster.values(), marks))
        } else {
            TiffEncoder::new_big(output).and_then(|e| encode::<C, _, _>(e, width, height, raster.values(), marks))
        };
        result.map_err(|e| match e {
            tiff::TiffError::IoError(source) => Error::io(path)(source),
            other => Error::malformed(path, format!("cannot be written: {other}")),
        })
    })
}

pub(crate) fn invalid_size(width: usize, height: usize) -> Error {
    Error::InvalidParameter {
        parameter: Parameter::Raster,
        value: format!("{width} x {height}"),
        expected: "1 to 4294967295 pixels wide and high",
    }
}

fn encode<C: ColorType, W: std::io::Write + std::io::Seek, K: TiffKind>(
    encoder: TiffEncoder<W, K>,
    width: u32,
    height: u32,
    values: &[C::Inner],
    marks: &Marks<'_>,
) -> tiff::TiffResult<()>
where
    [C::Inner]: TiffValue,
{
    let mut encoder = encoder.with_compression(Compression::Deflate(DeflateLevel::Balanced));
    let mut image = encoder.new_image::<C>(width, height)?;
    let tags = image.encoder();
    tags.write_tag(Tag::Software, SOFTWARE)?;
    if let Some(description) = marks.description {
        tags.write_tag(Tag::ImageDescription, ascii(description).as_str())?;
    }
    if let Some(nodata) = &marks.nodata {
        tags.write_tag(Tag::GdalNodata, nodata.as_str())?;
    }
    if let Some(place) = marks.georeference {
        let [x, y] = place.upper_left;
        let ([cx, cy], [rx, ry]) = (place.column_step, place.row_step);
        if cy == 0.0 && rx == 0.0 && cx > 0.0 && ry < 0.0 {
            tags.write_tag(Tag::ModelPixelScaleTag, &[cx, -ry, 0.0][..])?;
            tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, x, y, 0.0][..])?;
        } else {
            let matrix = [cx, rx, 0.0, x, cy, ry, 0.0, y, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
            tags.write_tag(Tag::ModelTransformationTag, &matrix[..])?;
        }
        let keys = geo_keys(place);
        tags.write_tag(Tag::GeoKeyDirectoryTag, &keys.directory[..])?;
        if !keys.text.is_empty() {
            tags.write_tag(Tag::GeoAsciiParamsTag, ascii(&keys.text).as_str())?;
        }
    }
    image.write_data(values)
}

/// What says in which system a raster lies; without a system the keys still say that pixels are areas.
pub(crate) fn geo_keys(place: &Georeference) -> text::GeoKeys {
    text::geo_keys(&place.crs, text::KeyUse::PixelAreas)
        .unwrap_or_else(|| text::GeoKeys { directory: vec![1, 1, 0, 1, 1025, 0, 1, 1], text: String::new() })
}

/// TIFF text is ASCII and ends with a zero byte.
pub(crate) fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii() && c != '\0' { c } else { '?' }).collect()
}
