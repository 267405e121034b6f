//! Values of GeoTIFF rasters.

use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{TiffError, TiffFormatError, TiffResult};

use crate::files::source::{Input, Source, SourceReader};
use crate::geotiff::{GDAL_METADATA, Georeference, SOFTWARE};
use belvedere_data::cast::to_f32;
use belvedere_data::crs::Crs;
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Result};

/// Maximum number of bytes of values for each byte of a file: LZW comes to 1365, Deflate to 1032.
const MAX_PACKED: u64 = 1400;

/// All bands of a raster of one of the types that results have.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadBands {
    /// Bytes.
    U8(Vec<Raster<u8>>),
    /// Unsigned 16-bit integers.
    U16(Vec<Raster<u16>>),
    /// 32-bit floats.
    F32(Vec<Raster<f32>>),
}

/// The values of all bands of a raster, as they are stored.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for other files. More than 256 MB of values are refused, and more than the
/// file can hold.
pub fn read_bands<'a>(source: impl Into<Source<'a>>) -> Result<ReadBands> {
    Ok(named_bands(source.into())?.1)
}

/// The name of a source and its bands.
fn named_bands(source: Source<'_>) -> Result<(PathBuf, ReadBands)> {
    let Input { name, reader, size } = source.open()?;
    let values = decoder(reader, size).and_then(|mut decoder| size_and_values(&mut decoder));
    let (size, values) = values.map_err(|e| damaged(&name, e))?;
    let bands = match values {
        DecodingResult::U8(values) => ReadBands::U8(bands(size, values)?),
        DecodingResult::U16(values) => ReadBands::U16(bands(size, values)?),
        DecodingResult::F32(values) => ReadBands::F32(bands(size, values)?),
        _ => return Err(other_kind(&name)),
    };
    Ok((name, bands))
}

/// The values of the first band of a raster of bytes.
///
/// # Errors
/// Those of [`read_bands`].
pub fn read_u8<'a>(source: impl Into<Source<'a>>) -> Result<Raster<u8>> {
    first(source.into(), |bands| match bands {
        ReadBands::U8(bands) => Some(bands),
        _ => None,
    })
}

/// The values of the first band of a raster of unsigned 16-bit integers.
///
/// # Errors
/// Those of [`read_bands`].
pub fn read_u16<'a>(source: impl Into<Source<'a>>) -> Result<Raster<u16>> {
    first(source.into(), |bands| match bands {
        ReadBands::U16(bands) => Some(bands),
        _ => None,
    })
}

/// The values of the first band of a raster of 32-bit floats.
///
/// # Errors
/// Those of [`read_bands`].
pub fn read_f32<'a>(source: impl Into<Source<'a>>) -> Result<Raster<f32>> {
    first(source.into(), |bands| match bands {
        ReadBands::F32(bands) => Some(bands),
        _ => None,
    })
}

fn first<T>(source: Source<'_>, of_kind: impl Fn(ReadBands) -> Option<Vec<Raster<T>>>) -> Result<Raster<T>> {
    let (name, bands) = named_bands(source)?;
    of_kind(bands).and_then(|bands| bands.into_iter().next()).ok_or_else(|| other_kind(&name))
}

fn other_kind(name: &Path) -> Error {
    Error::malformed(name, "has values of another kind than expected")
}

/// Bands from values pixel by pixel, or of one band after the other band by band.
fn bands<T: Copy>([width, height]: [usize; 2], values: Vec<T>) -> Result<Vec<Raster<T>>> {
    let count = values.len().checked_div(width.saturating_mul(height)).unwrap_or(0);
    if count <= 1 {
        return Ok(vec![Raster::from_values(width, height, values)?]);
    }
    let band =
        |band: usize| Raster::from_values(width, height, values.iter().skip(band).step_by(count).copied().collect());
    (0..count).map(band).collect()
}

/// A raster with its place on the map.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedRaster {
    /// Values of the first band; NaN where the file says that there is none.
    pub values: Raster<f32>,
    /// Name of the first band; empty where the file says none.
    pub name: String,
    /// Unit of its values, such as `h`; empty where the file says none.
    pub unit: String,
    /// Position, if the file has one.
    pub place: Option<Georeference>,
    /// Description of its values, if Belvedere wrote the file with one.
    pub description: Option<String>,
    /// Bands beside the first, if Belvedere wrote the file.
    pub further_bands: Vec<NamedBand>,
}

/// A band of a raster beside the first.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedBand {
    /// Its name; empty where the file says none.
    pub name: String,
    /// Its values; NaN where the file says that there is none.
    pub values: Raster<f32>,
}

/// A raster of numbers of any kind, with its place on the map.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for files without a raster of one band, unless Belvedere wrote them.
pub fn read_placed<'a>(source: impl Into<Source<'a>>) -> Result<PlacedRaster> {
    let Input { name, reader, size } = source.into().open()?;
    let mut decoder = decoder(reader, size).map_err(|e| damaged(&name, e))?;
    let (size, values) = size_and_values(&mut decoder).map_err(|e| damaged(&name, e))?;
    let values: Vec<f32> = match values {
        DecodingResult::U8(values) => values.into_iter().map(f32::from).collect(),
        DecodingResult::I8(values) => values.into_iter().map(f32::from).collect(),
        DecodingResult::U16(values) => values.into_iter().map(f32::from).collect(),
        DecodingResult::I16(values) => values.into_iter().map(f32::from).collect(),
        DecodingResult::U32(values) => values.into_iter().map(|v| v as f32).collect(),
        DecodingResult::I32(values) => values.into_iter().map(|v| v as f32).collect(),
        DecodingResult::F32(values) => values,
        DecodingResult::F64(values) => values.into_iter().map(to_f32).collect(),
        _ => return Err(other_kind(&name)),
    };
    let nodata = decoder.get_tag_ascii_string(Tag::GdalNodata).ok();
    let nodata = nodata.and_then(|text| text.trim().parse::<f64>().ok()).map(to_f32);
    let values = values.into_iter().map(|v| if Some(v) == nodata || !v.is_finite() { f32::NAN } else { v }).collect();
    let of_belvedere = decoder.get_tag_ascii_string(Tag::Software).is_ok_and(|program| program.starts_with(SOFTWARE));
    let mut bands = bands(size, values)?;
    if bands.len() > 1 && !of_belvedere {
        return Err(Error::malformed(&name, "has more than one band; take one of them"));
    }
    let further = bands.split_off(1);
    let Some(values) = bands.pop() else { return Err(other_kind(&name)) };
    let names = decoder.get_tag_ascii_string(Tag::Unknown(GDAL_METADATA)).unwrap_or_default();
    let named = |(band, values)| NamedBand { name: name_of_band(&names, band), values };
    let further_bands = (1..).zip(further).map(named).collect();
    let name_of_first = name_of_band(&names, 0);
    let unit = item_of_band(&names, 0, ["UNITTYPE", "unittype"]);
    let keys = decoder.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap_or_default();
    // coordinates that count from the middles of pixels instead of their corners (GTRasterTypeGeoKey, PixelIsPoint)
    let of_middles = keys.as_chunks::<4>().0.iter().any(|&[key, _, _, value]| key == 1025 && value == 2);
    let keys: Vec<u8> = keys.into_iter().flat_map(u16::to_le_bytes).collect();
    let crs = Crs::from_geotiff_keys(&keys).unwrap_or_default();
    let description = decoder.get_tag_ascii_string(Tag::ImageDescription).ok().filter(|_| of_belvedere);
    let numbers = |decoder: &mut Decoder<_>, tag| decoder.get_tag_f64_vec(tag).unwrap_or_default();
    let [scale, tie, matrix] = [Tag::ModelPixelScaleTag, Tag::ModelTiepointTag, Tag::ModelTransformationTag]
        .map(|tag| numbers(&mut decoder, tag));
    let place = match (&scale[..], &tie[..], &matrix[..]) {
        (&[dx, dy, ..], &[column, row, _, x, y, ..], _) => Some(Georeference {
            upper_left: [x - column * dx, y + row * dy],
            column_step: [dx, 0.0],
            row_step: [0.0, -dy],
            crs,
        }),
        (_, _, &[cx, rx, _, x, cy, ry, _, y, ..]) => {
            Some(Georeference { upper_left: [x, y], column_step: [cx, cy], row_step: [rx, ry], crs })
        }
        _ => None,
    };
    let to_corner = |place: Georeference| {
        let half = |i: usize| (place.column_step[i] + place.row_step[i]) / 2.0;
        let upper_left = [place.upper_left[0] - half(0), place.upper_left[1] - half(1)];
        Georeference { upper_left, ..place }
    };
    let place = if of_middles { place.map(to_corner) } else { place };
    Ok(PlacedRaster { values, name: name_of_first, unit, place, description, further_bands })
}

/// The name of a band, by its number from 0, in the metadata of GDAL; empty where it has none.
fn name_of_band(metadata: &str, band: usize) -> String {
    item_of_band(metadata, band, ["DESCRIPTION", "description"])
}

/// The item of a band with a name and a role, as [`name_of_band`].
fn item_of_band(metadata: &str, band: usize, [name, role]: [&str; 2]) -> String {
    text_of_item(metadata, &format!("name=\"{name}\" sample=\"{band}\" role=\"{role}\"")).unwrap_or_default()
}

/// Returns the tags of these names in the metadata of a whole raster; `None` for those that it does not have.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for other files.
pub fn read_tags<'a, const N: usize>(source: impl Into<Source<'a>>, names: [&str; N]) -> Result<[Option<String>; N]> {
    let Input { name, reader, size } = source.into().open()?;
    let mut decoder = decoder(reader, size).map_err(|e| damaged(&name, e))?;
    let metadata = decoder.get_tag_ascii_string(Tag::Unknown(GDAL_METADATA)).unwrap_or_default();
    Ok(names.map(|tag| text_of_item(&metadata, &format!("name=\"{tag}\""))))
}

/// The text of the first item with exactly these attributes; `None` if there is no such item.
fn text_of_item(metadata: &str, attributes: &str) -> Option<String> {
    let item = format!("<Item {attributes}>");
    let text = metadata.split_once(&item).and_then(|(_, rest)| rest.split_once("</Item>")).map(|(text, _)| text);
    let mut parts = text?.split('&');
    let mut found = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (entity, rest) = part.split_once(';').unwrap_or(("amp", part));
        found.extend(match entity {
            "lt" => Some('<'),
            "gt" => Some('>'),
            "quot" => Some('"'),
            "amp" => Some('&'),
            number => number.strip_prefix('#').and_then(|code| char::from_u32(code.parse().ok()?)),
        });
        found.push_str(rest);
    }
    Some(found)
}

/// A decoder that allocates no more than a file of `size` bytes can hold.
fn decoder(mut reader: SourceReader<'_>, size: u64) -> TiffResult<Decoder<SourceReader<'_>>> {
    if longest_value(&mut reader).is_ok_and(|longest| longest > size) {
        return Err(TiffError::LimitsExceeded);
    }
    reader.rewind()?;
    let max = usize::try_from(size.saturating_mul(MAX_PACKED)).unwrap_or(usize::MAX);
    let mut limits = Limits::default();
    limits.decoding_buffer_size = limits.decoding_buffer_size.min(max);
    limits.intermediate_buffer_size = limits.intermediate_buffer_size.min(max);
    Ok(Decoder::new(reader)?.with_limits(limits))
}

/// Bytes that the longest entry of the first directory claims to have. The decoder reads this directory, and allocates
/// the claimed length, before it takes limits.
///
/// # Errors
/// Those of reading; files that are not TIFF are left to the decoder.
fn longest_value(reader: &mut SourceReader<'_>) -> io::Result<u64> {
    let mut start = [0; 4];
    reader.read_exact(&mut start)?;
    let is_large = start.contains(&43);
    let number = |reader: &mut SourceReader<'_>, length: usize| {
        let mut bytes = [0; 8];
        reader.read_exact(&mut bytes[..length])?;
        if start.starts_with(b"MM") {
            bytes[..length].reverse();
        }
        Ok::<u64, io::Error>(u64::from_le_bytes(bytes))
    };
    let (of_offset, of_count) = if is_large { (8, 8) } else { (4, 2) };
    if is_large {
        number(reader, 4)?;
    }
    let directory = number(reader, of_offset)?;
    reader.seek(SeekFrom::Start(directory))?;
    let mut longest = 0;
    for _ in 0..number(reader, of_count)? {
        let [_, kind] = [number(reader, 2)?, number(reader, 2)?];
        let [values, _] = [number(reader, of_offset)?, number(reader, of_offset)?];
        let of_value = match kind {
            3 | 8 => 2,
            4 | 9 | 11 | 13 => 4,
            5 | 10 | 12 | 16..=18 => 8,
            _ => 1,
        };
        longest = longest.max(values.saturating_mul(of_value));
    }
    Ok(longest)
}

/// Width and height, and the values.
fn size_and_values<R: Read + Seek>(decoder: &mut Decoder<R>) -> TiffResult<([usize; 2], DecodingResult)> {
    let (width, height) = decoder.dimensions()?;
    let size = [width, height].map(|count| usize::try_from(count).unwrap_or(usize::MAX));
    Ok((size, decoder.read_image()?))
}

fn damaged(name: &Path, error: TiffError) -> Error {
    match error {
        TiffError::IoError(source) => Error::io(name)(source),
        TiffError::LimitsExceeded => {
            let what = "has more than 256 MB of values, or claims more than its bytes can hold; make its cells larger or cut out a part, for example: gdalwarp -tr 20 20 -r average IN.tif OUT.tif";
            Error::malformed(name, what)
        }
        TiffError::FormatError(TiffFormatError::TiffSignatureNotFound | TiffFormatError::TiffSignatureInvalid) => {
            let what = "is no TIFF file; convert other rasters first: gdal_translate -co COMPRESS=DEFLATE IN OUT.tif";
            Error::malformed(name, what)
        }
        TiffError::UnsupportedError(what) => Error::malformed(
            name,
            format!(
                "is a TIFF file of a kind that cannot be read ({what}); write it again: gdal_translate -co COMPRESS=DEFLATE IN.tif OUT.tif"
            ),
        ),
        other => Error::malformed(name, format!("is no raster that can be read: {other}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number in so many bytes, the most significant first or last.
    fn number(value: u64, length: usize, is_big_endian: bool) -> Vec<u8> {
        if is_big_endian { value.to_be_bytes()[8 - length..].to_vec() } else { value.to_le_bytes()[..length].to_vec() }
    }

    #[test]
    fn the_longest_value_is_found_in_all_four_layouts() {
        for (is_big_endian, is_large) in [(false, false), (true, false), (false, true), (true, true)] {
            let number = |value, length| number(value, length, is_big_endian);
            let (of_offset, of_count) = if is_large { (8, 8) } else { (4, 2) };
            let mut bytes = if is_big_endian { b"MM".to_vec() } else { b"II".to_vec() };
            if is_large {
                bytes.extend([number(43, 2), number(8, 2), number(0, 2), number(16, 8)].concat());
            } else {
                bytes.extend([number(42, 2), number(8, 4)].concat());
            }
            bytes.extend(number(3, of_count));
            // bytes, shorts, doubles
            for (kind, values) in [(1, 7000), (3, 3000), (12, 1000)] {
                bytes.extend(
                    [number(256, 2), number(kind, 2), number(values, of_offset), number(0, of_offset)].concat(),
                );
            }
            let longest = |bytes| longest_value(&mut Source::bytes("raster.tif", bytes).open().unwrap().reader);
            assert_eq!(longest(&bytes[..]).unwrap(), 8000, "{is_big_endian} {is_large}");
            assert!(longest(&bytes[..bytes.len() - 1]).is_err());
        }
    }
}
