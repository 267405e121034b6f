//! Cloud-optimised GeoTIFF: tiles, coarser levels, and directories before the data, so that programs read only the part
//! they show.
//!
//! # Source
//! TIFF 6.0 (Adobe 1992), OGC GeoTIFF 1.1 (19-008r4), OGC Cloud Optimized GeoTIFF 1.0 (21-026).

use crate::files::output::Output;
use crate::geotiff::{
    BandValues, Bands, GDAL_METADATA, Georeference, SOFTWARE_VERSION, ascii, geo_keys, metadata_in_xml, size_of_bands,
};
use belvedere_data::cast::to_row;
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Parameter, Result};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use std::io::Write;
use std::path::Path;

/// Side of a tile, pixels, as GDAL has it. Levels end where one tile holds the whole.
const TILE: usize = 512;
/// Compression of the tiles, by its number in TIFF: Deflate.
const DEFLATE: u16 = 8;

/// Writes the bands of a raster whose columns run east and whose rows run south as a cloud-optimised GeoTIFF,
/// compressed without loss.
///
/// # Errors
/// [`Error::InvalidParameter`] for a raster without pixels, a turned one, and one of more than 4 GB compressed;
/// [`Error::LengthMismatch`] for bands of several sizes; [`Error::Io`].
pub fn write_cog<'a>(output: impl Into<Output<'a>>, bands: &Bands<'_>, place: &Georeference) -> Result<()> {
    let ([east, tilt], [turn, south]) = (place.column_step, place.row_step);
    if tilt != 0.0 || turn != 0.0 || !(east > 0.0 && south < 0.0) {
        let value = format!("steps {:?} and {:?}", place.column_step, place.row_step);
        return Err(Error::invalid(Parameter::Raster, value, "columns to the east and rows to the south"));
    }
    let (levels, nodata) = match bands.values {
        BandValues::U8(rasters, nodata) => (levels(rasters, nodata, majority), nodata.to_string()),
        BandValues::U16(rasters, nodata) => (levels(rasters, nodata, majority), nodata.to_string()),
        BandValues::U32(rasters, nodata) => (levels(rasters, nodata, majority), nodata.to_string()),
        BandValues::F32(rasters, nodata) => (levels(rasters, nodata, mean), nodata.to_string()),
    };
    let levels = levels?;
    let bytes = file(&levels, &nodata, place, bands)?;
    output.into().write(|path, file| bytes.iter().try_for_each(|part| file.write_all(part)).map_err(Error::io(path)))
}

/// A pixel, as it is stored.
trait PixelType: Copy + PartialEq + Send + Sync {
    /// Bits of a sample, and the kind of its number in TIFF.
    const KIND: [u16; 2];
    fn put(self, bytes: &mut Vec<u8>);
}

impl PixelType for u8 {
    const KIND: [u16; 2] = [8, 1];
    fn put(self, bytes: &mut Vec<u8>) {
        bytes.push(self);
    }
}

impl PixelType for u16 {
    const KIND: [u16; 2] = [16, 1];
    fn put(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl PixelType for u32 {
    const KIND: [u16; 2] = [32, 1];
    fn put(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl PixelType for f32 {
    const KIND: [u16; 2] = [32, 3];
    fn put(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

/// A raster and the coarser ones of it, the finest first.
struct RasterLevel {
    width: u32,
    height: u32,
    kind: [u16; 2],
    band_count: usize,
    /// Compressed, row by row from the north-west.
    tiles: Vec<Vec<u8>>,
}

fn levels<T: PixelType>(
    bands: &[Raster<T>],
    nodata: T,
    pick: impl Fn([T; 4], T) -> T + Sync,
) -> Result<Vec<RasterLevel>> {
    let mut levels = vec![level(bands, nodata)?];
    let mut coarser;
    let mut last = bands;
    while last.iter().any(|band| band.width().max(band.height()) > TILE) {
        coarser = last.iter().map(|band| halved(band, nodata, &pick)).collect::<Result<Vec<_>>>()?;
        levels.push(level(&coarser, nodata)?);
        last = &coarser;
    }
    Ok(levels)
}

/// A raster of half the size, of each four pixels one.
fn halved<T: PixelType>(raster: &Raster<T>, nodata: T, pick: &(impl Fn([T; 4], T) -> T + Sync)) -> Result<Raster<T>> {
    let (width, height) = (raster.width().div_ceil(2), raster.height().div_ceil(2));
    let pixel = |number: usize| {
        let [column, row] = [2 * (number % width), 2 * (number / width)];
        let four = [[0, 0], [1, 0], [0, 1], [1, 1]];
        pick(four.map(|[right, down]| raster.get(column + right, row + down).unwrap_or(nodata)), nodata)
    };
    Raster::from_values(width, height, (0..width * height).into_par_iter().map(pixel).collect())
}

/// The value that most of four pixels with a value have, the first of them where several are as frequent.
fn majority<T: PixelType>(four: [T; 4], nodata: T) -> T {
    let count = |value: T| four.iter().filter(|&&other| other == value).count();
    let known = four.into_iter().filter(|&value| value != nodata);
    known.fold(nodata, |best, value| if best == nodata || count(value) > count(best) { value } else { best })
}

fn mean(four: [f32; 4], nodata: f32) -> f32 {
    let known = || four.into_iter().filter(|&value| value.is_finite() && value != nodata);
    match known().count() {
        0 => nodata,
        count => known().sum::<f32>() / count as f32,
    }
}

fn level<T: PixelType>(bands: &[Raster<T>], nodata: T) -> Result<RasterLevel> {
    let [width, height] = size_of_bands(bands)?;
    let [across, down] = [width, height].map(|side| (side as usize).div_ceil(TILE));
    let tile = |number: usize| {
        let [left, top] = [number % across * TILE, number / across * TILE];
        let mut bytes = Vec::with_capacity(TILE * TILE * bands.len() * usize::from(T::KIND[0] / 8));
        for row in top..top + TILE {
            for column in left..left + TILE {
                bands.iter().for_each(|band| band.get(column, row).unwrap_or(nodata).put(&mut bytes));
            }
        }
        compressed(&bytes)
    };
    let tiles = (0..across * down).into_par_iter().map(tile).collect::<Result<_>>()?;
    Ok(RasterLevel { width, height, kind: T::KIND, band_count: bands.len(), tiles })
}

fn compressed(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).map_err(Error::io(Path::new("raster in memory")))
}

/// A tag of a directory: its number, and its values as bytes with their type and number.
struct Tag {
    number: u16,
    kind: u16,
    count: usize,
    bytes: Vec<u8>,
}

impl Tag {
    fn shorts(number: u16, values: &[u16]) -> Self {
        Self { number, kind: 3, count: values.len(), bytes: values.iter().flat_map(|v| v.to_le_bytes()).collect() }
    }

    fn longs(number: u16, values: &[u32]) -> Self {
        Self { number, kind: 4, count: values.len(), bytes: values.iter().flat_map(|v| v.to_le_bytes()).collect() }
    }

    fn doubles(number: u16, values: &[f64]) -> Self {
        Self { number, kind: 12, count: values.len(), bytes: values.iter().flat_map(|v| v.to_le_bytes()).collect() }
    }

    fn text(number: u16, text: &str) -> Self {
        let bytes = [ascii(text).as_bytes(), &[0]].concat();
        Self { number, kind: 2, count: bytes.len(), bytes }
    }

    /// Bytes beside the directory: those that do not fit into the entry, on even places.
    fn bytes_beside(&self) -> usize {
        if self.bytes.len() > 4 { self.bytes.len().next_multiple_of(2) } else { 0 }
    }
}

/// The parts of the file: directories from the finest level on, and the tiles, which begin with the coarsest level.
fn file<'a>(
    levels: &'a [RasterLevel],
    nodata: &str,
    place: &Georeference,
    bands: &Bands<'_>,
) -> Result<Vec<std::borrow::Cow<'a, [u8]>>> {
    let directory = |number: usize, offsets: &[u32]| {
        let mut tags = tags(&levels[number], offsets, nodata);
        if number == 0 {
            tags.extend(tags_of_whole(place, bands));
        } else {
            tags.push(Tag::longs(254, &[1]));
        }
        tags.sort_by_key(|tag| tag.number);
        tags
    };
    // how long directories are does not depend on where tiles lie
    let sizes: Vec<usize> = (0..levels.len())
        .map(|number| {
            let tags = directory(number, &vec![0; levels[number].tiles.len()]);
            2 + 12 * tags.len() + 4 + tags.iter().map(Tag::bytes_beside).sum::<usize>()
        })
        .collect();
    let mut next = 8 + sizes.iter().sum::<usize>();
    let mut offsets: Vec<Vec<u32>> = vec![Vec::new(); levels.len()];
    let too_large =
        |_| Error::invalid(Parameter::Raster, "more than 4 GB, compressed", "a smaller raster, or larger cells");
    for (level, offsets) in levels.iter().zip(&mut offsets).rev() {
        for tile in &level.tiles {
            offsets.push(u32::try_from(next).map_err(too_large)?);
            next += tile.len();
        }
    }
    u32::try_from(next).map_err(too_large)?;
    let mut head = b"II\x2a\x00\x08\x00\x00\x00".to_vec();
    for (number, offsets) in offsets.iter().enumerate() {
        let is_last = number + 1 == levels.len();
        write_directory(&mut head, &directory(number, offsets), sizes[number], is_last);
    }
    let tiles = levels.iter().rev().flat_map(|level| &level.tiles);
    Ok(std::iter::once(head.into()).chain(tiles.map(|tile| tile.as_slice().into())).collect())
}

/// The tags of each level.
fn tags(level: &RasterLevel, offsets: &[u32], nodata: &str) -> Vec<Tag> {
    let sizes: Vec<u32> = level.tiles.iter().map(|tile| to_row(tile.len())).collect();
    // one for each band
    let [bits, kind] = level.kind.map(|value| vec![value; level.band_count]);
    #[expect(clippy::cast_possible_truncation, reason = "512, and no more bands than measures")]
    let (side, band_count) = (TILE as u16, level.band_count as u16);
    let mut tags = vec![
        Tag::longs(256, &[level.width]),
        Tag::longs(257, &[level.height]),
        Tag::shorts(258, &bits),
        Tag::shorts(259, &[DEFLATE]),
        Tag::shorts(262, &[1]),
        Tag::shorts(277, &[band_count]),
        Tag::shorts(284, &[1]),
        Tag::shorts(322, &[side]),
        Tag::shorts(323, &[side]),
        Tag::longs(324, offsets),
        Tag::longs(325, &sizes),
        Tag::shorts(339, &kind),
        Tag::text(42113, nodata),
    ];
    if level.band_count > 1 {
        // samples beside the first that are no colours
        tags.push(Tag::shorts(338, &vec![0; level.band_count - 1]));
    }
    tags
}

/// Returns the tags of the finest level alone, which is the raster.
fn tags_of_whole(place: &Georeference, bands: &Bands<'_>) -> Vec<Tag> {
    let ([x, y], keys) = (place.upper_left, geo_keys(place));
    let mut tags = vec![
        Tag::longs(254, &[0]),
        Tag::text(305, SOFTWARE_VERSION),
        Tag::doubles(33550, &[place.column_step[0], -place.row_step[1], 0.0]),
        Tag::doubles(33922, &[0.0, 0.0, 0.0, x, y, 0.0]),
        Tag::shorts(34735, &keys.directory),
    ];
    tags.extend(bands.description.map(|description| Tag::text(270, description)));
    tags.extend(metadata_in_xml(bands.labels, bands.tags).map(|names| Tag::text(GDAL_METADATA, &names)));
    if !keys.text.is_empty() {
        tags.push(Tag::text(34737, &keys.text));
    }
    tags
}

#[expect(clippy::cast_possible_truncation, reason = "directories of a file of less than 4 GB")]
fn write_directory(head: &mut Vec<u8>, tags: &[Tag], size: usize, is_last: bool) {
    let start = head.len();
    let mut beside = start + 2 + 12 * tags.len() + 4;
    head.extend((tags.len() as u16).to_le_bytes());
    for tag in tags {
        head.extend(tag.number.to_le_bytes());
        head.extend(tag.kind.to_le_bytes());
        head.extend((tag.count as u32).to_le_bytes());
        let mut entry = [0; 4];
        match tag.bytes_beside() {
            0 => entry[..tag.bytes.len()].copy_from_slice(&tag.bytes),
            _ => entry = (beside as u32).to_le_bytes(),
        }
        head.extend(entry);
        beside += tag.bytes_beside();
    }
    let next = if is_last { 0 } else { start + size };
    head.extend((next as u32).to_le_bytes());
    for tag in tags.iter().filter(|tag| tag.bytes_beside() > 0) {
        head.extend(&tag.bytes);
        head.resize(head.len() + tag.bytes_beside() - tag.bytes.len(), 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geotiff::BandLabel;
    use crate::{ReadBands, Source, read_tif, read_tif_bands, read_tif_f32, read_tif_u8};
    use belvedere_data::crs::Crs;
    use std::io::Cursor;
    use std::slice::from_ref;
    use tiff::decoder::Decoder;
    use tiff::tags::Tag as TiffTag;

    fn place() -> Georeference {
        let crs = Crs::parse("EPSG:28992").unwrap();
        Georeference { upper_left: [155_000.0, 463_000.0], column_step: [2.0, 0.0], row_step: [0.0, -2.0], crs }
    }

    fn written(values: BandValues<'_>, labels: &[BandLabel]) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        let bands = Bands { values, labels, tags: &[], description: Some("height in metres") };
        write_cog(Output::writer("cog.tif", &mut file), &bands, &place()).unwrap();
        file.into_inner()
    }

    #[test]
    fn all_values_and_coarser_levels_are_read_back_by_the_crate_tiff() {
        let (width, height) = (1200_usize, 700_usize);
        let numbers: Vec<f32> = (0..width * height).map(|i| ((i * 7919) % 1013) as f32 / 8.0).collect();
        let mut numbers = Raster::from_values(width, height, numbers).unwrap();
        // a pixel without a value in a block of four
        numbers.values_mut()[1] = -9999.0;
        let file = written(BandValues::F32(from_ref(&numbers), -9999.0), &[]);
        assert_eq!(read_tif_f32(Source::bytes("cog.tif", &file)).unwrap(), numbers);
        let read = read_tif(Source::bytes("cog.tif", &file)).unwrap();
        assert_eq!(read.description.as_deref(), Some("height in metres"));
        let mut decoder = Decoder::new(Cursor::new(&file)).unwrap();
        let mut first_tiles = Vec::new();
        let mut sizes = Vec::new();
        loop {
            assert_eq!(decoder.chunk_dimensions(), (512, 512));
            sizes.push(decoder.dimensions().unwrap());
            first_tiles.push(decoder.get_tag_u64_vec(TiffTag::TileOffsets).unwrap()[0]);
            if sizes.len() == 2 {
                let tiff::decoder::DecodingResult::F32(values) = decoder.read_image().unwrap() else { panic!("kind") };
                let of = |column: usize, row: usize| numbers.get(column, row).unwrap();
                assert_eq!(values[0], (of(0, 0) + of(0, 1) + of(1, 1)) / 3.0);
                assert_eq!(values[601], (of(2, 2) + of(3, 2) + of(2, 3) + of(3, 3)) / 4.0);
            }
            if !decoder.more_images() {
                break;
            }
            decoder.next_image().unwrap();
        }
        assert_eq!(sizes, [(1200, 700), (600, 350), (300, 175)]);
        // the coarsest tiles come first, after all directories
        assert!(first_tiles.windows(2).all(|pair| pair[0] > pair[1]), "{first_tiles:?}");
    }

    #[test]
    fn codes_keep_their_meaning_on_coarser_levels() {
        assert_eq!(majority([1_u8, 0, 0, 255], 255), 0);
        assert_eq!(majority([255_u8, 255, 255, 2], 255), 2);
        assert_eq!(majority([255_u8; 4], 255), 255);
        assert_eq!(majority([1_u8, 0, 1, 0], 255), 1);
        let codes = Raster::from_values(3, 1, vec![0_u8, 1, 255]).unwrap();
        let file = written(BandValues::U8(from_ref(&codes), 255), &[]);
        assert_eq!(read_tif_u8(Source::bytes("cog.tif", &file)).unwrap(), codes);
        let turned = Georeference { row_step: [0.0, 2.0], ..place() };
        let mut file = Cursor::new(Vec::new());
        let bands = Bands { values: BandValues::U8(from_ref(&codes), 255), labels: &[], tags: &[], description: None };
        assert!(write_cog(Output::writer("cog.tif", &mut file), &bands, &turned).is_err());
    }

    #[test]
    fn bands_and_their_names_come_back_from_both_writers() {
        let (width, height) = (700_usize, 20_usize);
        let band = |shift: usize| {
            let value = |i: usize| u16::try_from((i * 31 + shift) % 1000).unwrap();
            Raster::from_values(width, height, (0..width * height).map(value).collect()).unwrap()
        };
        let rasters = vec![band(0), band(7), band(400)];
        let labels = ["observers", "un<proven>", "\"a&b\" in é"].map(|name| BandLabel::new(name, "m\u{b2}"));
        let values = BandValues::U16(&rasters, u16::MAX);
        let bands = Bands { values, labels: &labels, tags: &[], description: Some("counts") };
        let mut plain = Cursor::new(Vec::new());
        crate::write_tif_bands(Output::writer("plain.tif", &mut plain), &bands, Some(&place())).unwrap();
        for file in [plain.into_inner(), written(values, &labels)] {
            let ReadBands::U16(read) = read_tif_bands(Source::bytes("a.tif", &file)).unwrap() else { panic!("type") };
            assert_eq!(read, rasters);
            let placed = read_tif(Source::bytes("a.tif", &file)).unwrap();
            let further: Vec<&str> = placed.further_bands.iter().map(|band| band.name.as_str()).collect();
            assert_eq!(further, ["un<proven>", "\"a&b\" in é"]);
            assert_eq!((placed.name.as_str(), placed.unit.as_str()), ("observers", "m\u{b2}"));
            assert_eq!(placed.values.get(3, 2), Some(f32::from(rasters[0].get(3, 2).unwrap())));
            assert_eq!(placed.further_bands[1].values.get(3, 2), Some(f32::from(rasters[2].get(3, 2).unwrap())));
        }
        let small = Raster::filled(3, 3, 1_u16);
        let uneven = [rasters[0].clone(), small];
        let bands = Bands { values: BandValues::U16(&uneven, 0), labels: &[], tags: &[], description: None };
        assert!(crate::write_tif_bands(Output::writer("a.tif", &mut Cursor::new(Vec::new())), &bands, None).is_err());
        assert!(write_cog(Output::writer("a.tif", &mut Cursor::new(Vec::new())), &bands, &place()).is_err());
    }
}
