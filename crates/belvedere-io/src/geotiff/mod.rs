//! GeoTIFF rasters.

pub(crate) mod read;
pub(crate) mod terrain;
pub(crate) mod terrain_in_degrees;
pub(crate) mod write_cog;

use std::slice::from_ref;
use tiff::encoder::colortype::{ColorType, Gray8, Gray16, Gray32, Gray32Float};
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, TiffKind, TiffValue};
use tiff::tags::{ExtraSamples, Tag};

use crate::files::output::Output;
use belvedere_data::crs::{Crs, text};
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Parameter, Result};

/// Raw size from which files use 64-bit offsets (BigTIFF); tags and incompressible strips need some room below 4 GiB.
const BIG_FILE_BYTES: usize = 3_900_000_000;

/// The program that a file names as its writer, before its version.
pub(crate) const SOFTWARE: &str = "belvedere";
/// [`SOFTWARE`] with its version.
pub(crate) const SOFTWARE_VERSION: &str = concat!("belvedere ", env!("CARGO_PKG_VERSION"));

/// The tag in which GDAL keeps names and units of bands, and all else.
pub(crate) const GDAL_METADATA: u16 = 42112;

/// The bands of a raster, on the same cells and of one type, each with the value for no data.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum BandValues<'a> {
    /// Codes. On a coarser level a pixel has the most frequent of its four.
    U8(&'a [Raster<u8>], u8),
    /// Counts. On a coarser level likewise.
    U16(&'a [Raster<u16>], u16),
    /// Bits. On a coarser level likewise.
    U32(&'a [Raster<u32>], u32),
    /// Numbers. On a coarser level a pixel has the mean of those of its four that have a value.
    F32(&'a [Raster<f32>], f32),
}

/// A name and a text of the metadata of GDAL, such as `TIME` and `2026-06-21T15:00:00+02:00`.
pub type MetadataTag = (String, String);

/// Name and unit of a band.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BandLabel {
    /// Name.
    pub name: String,
    /// Unit of the values, such as `h`; `1` for values without a unit. Readers may take an empty one for the unit of
    /// heights.
    pub unit: String,
    /// Further metadata of the band.
    pub tags: Vec<MetadataTag>,
}

impl BandLabel {
    /// Creates a label without further metadata.
    #[must_use]
    pub fn new(name: &str, unit: &str) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), tags: Vec::new() }
    }

    /// Creates the labels of codes or counts without names.
    fn of_codes() -> [Self; 1] {
        [Self::new("", "1")]
    }
}

/// The bands of a raster, with their metadata.
#[derive(Clone, Copy, Debug)]
pub struct Bands<'a> {
    /// The values, at least one band.
    pub values: BandValues<'a>,
    /// Labels of the bands, in their order; further bands have none.
    pub labels: &'a [BandLabel],
    /// Metadata of the whole.
    pub tags: &'a [MetadataTag],
    /// Description of the values.
    pub description: Option<&'a str>,
}

/// Position of a raster.
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
/// space. With a `nodata` value, values that are not finite are written as that value and marked so for GIS programs;
/// without, infinities and NaN stay.
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
    let marks = Marks { georeference, nodata: nodata.map(|v| v.to_string()), description, labels: &[], tags: &[] };
    match nodata {
        Some(nodata) if raster.values().iter().any(|v| !v.is_finite()) => {
            let values = raster.values().iter().map(|&v| if v.is_finite() { v } else { nodata }).collect();
            let finite = Raster::from_values(raster.width(), raster.height(), values)?;
            write::<Gray32Float>(output.into(), from_ref(&finite), &marks)
        }
        _ => write::<Gray32Float>(output.into(), from_ref(raster), &marks),
    }
}

/// Writes `raster` as unsigned 32-bit integers, compressed without loss; `nodata` marks the value that means "no data",
/// such as `u32::MAX` in an item buffer.
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
    let labels = &BandLabel::of_codes();
    let marks = Marks { georeference, nodata: nodata.map(|v| v.to_string()), description, labels, tags: &[] };
    write::<Gray32>(output.into(), from_ref(raster), &marks)
}

/// Writes `raster` as bytes, compressed without loss; `nodata` marks the value that means "no data".
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
    let labels = &BandLabel::of_codes();
    let marks = Marks { georeference, nodata: nodata.map(|v| v.to_string()), description, labels, tags: &[] };
    write::<Gray8>(output.into(), from_ref(raster), &marks)
}

/// Writes `raster` as unsigned 16-bit integers, compressed without loss; `nodata` marks the value that means "no data".
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
    let labels = &BandLabel::of_codes();
    let marks = Marks { georeference, nodata: nodata.map(|v| v.to_string()), description, labels, tags: &[] };
    write::<Gray16>(output.into(), from_ref(raster), &marks)
}

/// Writes the bands of a raster, compressed without loss, with metadata as GDAL reads it. Numbers that are not
/// finite are written as the value for no data.
///
/// # Errors
/// As [`write_f32`], [`Error::LengthMismatch`] for bands of several sizes.
pub fn write_bands<'a>(
    output: impl Into<Output<'a>>,
    bands: &Bands<'_>,
    georeference: Option<&Georeference>,
) -> Result<()> {
    let Bands { labels, tags, description, .. } = *bands;
    let marks = |nodata: String| Marks { georeference, nodata: Some(nodata), description, labels, tags };
    match bands.values {
        BandValues::U8(rasters, nodata) => write::<Gray8>(output.into(), rasters, &marks(nodata.to_string())),
        BandValues::U16(rasters, nodata) => write::<Gray16>(output.into(), rasters, &marks(nodata.to_string())),
        BandValues::U32(rasters, nodata) => write::<Gray32>(output.into(), rasters, &marks(nodata.to_string())),
        BandValues::F32(rasters, nodata) => {
            let mut finite = rasters.to_vec();
            for value in finite.iter_mut().flat_map(Raster::values_mut).filter(|value| !value.is_finite()) {
                *value = nodata;
            }
            write::<Gray32Float>(output.into(), &finite, &marks(nodata.to_string()))
        }
    }
}

struct Marks<'a> {
    georeference: Option<&'a Georeference>,
    nodata: Option<String>,
    description: Option<&'a str>,
    labels: &'a [BandLabel],
    tags: &'a [MetadataTag],
}

/// Labels and tags as GDAL keeps them; `None` without any.
///
/// # Source
/// GDAL, documentation of the driver GTiff: tag 42112, and roles of items.
pub(crate) fn metadata_in_xml(labels: &[BandLabel], tags: &[MetadataTag]) -> Option<String> {
    let item = |attributes: &str, text: &str| match text.is_empty() {
        true => String::new(),
        false => format!("  <Item {attributes}>{}</Item>\n", in_xml(text)),
    };
    let of_band = |(band, label): (usize, &BandLabel)| {
        let name = item(&format!("name=\"DESCRIPTION\" sample=\"{band}\" role=\"description\""), &label.name);
        let unit = item(&format!("name=\"UNITTYPE\" sample=\"{band}\" role=\"unittype\""), &label.unit);
        let tag = |(name, text): &MetadataTag| item(&format!("name=\"{}\" sample=\"{band}\"", in_xml(name)), text);
        [name, unit].into_iter().chain(label.tags.iter().map(tag)).collect::<String>()
    };
    let of_whole = tags.iter().map(|(name, text)| item(&format!("name=\"{}\"", in_xml(name)), text));
    let items: String = of_whole.chain(labels.iter().enumerate().map(of_band)).collect();
    (!items.is_empty()).then(|| format!("<GDALMetadata>\n{items}</GDALMetadata>\n"))
}

/// Text in XML, in ASCII as TIFF has it.
fn in_xml(text: &str) -> String {
    let of_character = |c: char| match c {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '>' => "&gt;".to_owned(),
        '"' => "&quot;".to_owned(),
        c if c.is_ascii() && !c.is_ascii_control() => c.to_string(),
        // XML has no other control characters
        '\n' | '\t' | '\r' => format!("&#{};", u32::from(c)),
        c if c.is_ascii() => "?".to_owned(),
        c => format!("&#{};", u32::from(c)),
    };
    text.chars().map(of_character).collect()
}

/// Width and height of bands.
///
/// # Errors
/// [`Error::InvalidParameter`] for bands without pixels, [`Error::LengthMismatch`] for bands of several sizes.
pub(crate) fn size_of_bands<T: Copy>(rasters: &[Raster<T>]) -> Result<[u32; 2]> {
    let size = |raster: &Raster<T>| [raster.width(), raster.height()];
    let [width, height] = rasters.first().map_or([0; 2], size);
    if let Some(other) = rasters.iter().find(|raster| size(raster) != [width, height]) {
        let (expected, found) = (width * height, other.values().len());
        return Err(Error::LengthMismatch { what: "bands of a raster", expected, found });
    }
    match [width, height].map(u32::try_from) {
        [Ok(columns), Ok(rows)] if columns > 0 && rows > 0 => Ok([columns, rows]),
        _ => Err(invalid_size(width, height)),
    }
}

/// Values pixel by pixel, those of all bands of a pixel after each other.
fn interleaved<T: Copy>(rasters: &[Raster<T>]) -> Vec<T> {
    let count = rasters.first().map_or(0, |raster| raster.values().len());
    (0..count).flat_map(|pixel| rasters.iter().filter_map(move |raster| raster.values().get(pixel).copied())).collect()
}

fn write<C: ColorType>(output: Output<'_>, rasters: &[Raster<C::Inner>], marks: &Marks<'_>) -> Result<()>
where
    C::Inner: Copy,
    [C::Inner]: TiffValue,
{
    let size = size_of_bands(rasters)?;
    let together;
    let values = match rasters {
        [one] => one.values(),
        _ => {
            together = interleaved(rasters);
            &together
        }
    };
    output.write(|path, output| {
        let result = if size_of_val(values) < BIG_FILE_BYTES {
            TiffEncoder::new(output).and_then(|e| encode::<C, _, _>(e, size, values, marks))
        } else {
            TiffEncoder::new_big(output).and_then(|e| encode::<C, _, _>(e, size, values, marks))
        };
        result.map_err(|e| match e {
            tiff::TiffError::IoError(source) => Error::io(path)(source),
            other => Error::malformed(path, format!("cannot be written: {other}")),
        })
    })
}

pub(crate) fn invalid_size(width: usize, height: usize) -> Error {
    Error::invalid(Parameter::Raster, format!("{width} x {height}"), "1 to 4294967295 pixels wide and high")
}

fn encode<C: ColorType, W: std::io::Write + std::io::Seek, K: TiffKind>(
    encoder: TiffEncoder<W, K>,
    [width, height]: [u32; 2],
    values: &[C::Inner],
    marks: &Marks<'_>,
) -> tiff::TiffResult<()>
where
    [C::Inner]: TiffValue,
{
    let mut encoder = encoder.with_compression(Compression::Deflate(DeflateLevel::Balanced));
    let mut image = encoder.new_image::<C>(width, height)?;
    let band_count = values.len() / (width as usize * height as usize);
    if band_count > 1 {
        image.extra_samples(&vec![ExtraSamples::Unspecified; band_count - 1])?;
    }
    let tags = image.encoder();
    if let Some(metadata) = metadata_in_xml(marks.labels, marks.tags) {
        tags.write_tag(Tag::Unknown(GDAL_METADATA), metadata.as_str())?;
    }
    tags.write_tag(Tag::Software, SOFTWARE_VERSION)?;
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

/// Returns the keys of the system of a raster; without a system they still mark pixels as areas.
pub(crate) fn geo_keys(place: &Georeference) -> text::GeoKeys {
    text::geo_keys(&place.crs, text::KeyUse::PixelAreas)
        .unwrap_or_else(|| text::GeoKeys { directory: vec![1, 1, 0, 1, 1025, 0, 1, 1], text: String::new() })
}

/// TIFF text is ASCII and ends with a zero byte.
pub(crate) fn ascii(text: &str) -> String {
    let plain = text.replace('°', "deg ").replace('²', "2").replace('³', "3");
    plain.chars().map(|c| if c.is_ascii() && c != '\0' { c } else { '?' }).collect()
}
