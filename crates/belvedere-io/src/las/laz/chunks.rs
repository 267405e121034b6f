//! Chunks of LAZ points, decompressed side by side with the fields of the laz crate, except those that it decodes by
//! recursion.

use std::io::Cursor;

use rayon::prelude::*;

use ::laz::laszip::{ChunkTableEntry, LazItemType};
use ::laz::record::{LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor};
use ::laz::{DecompressionSelection, LazItem, LazVlr};

use super::gps_times::GpsTimeField;
use super::point14::Point14Field;

/// Decompresses the `chunks`, which follow each other in `compressed`, to `points`, which have the sizes that the
/// chunks claim.
///
/// # Errors
///
/// Of the first chunk that cannot be decompressed.
#[expect(clippy::cast_possible_truncation, reason = "the chunks and their points lie in memory")]
pub(super) fn decompress(
    mut compressed: &[u8],
    mut points: &mut [u8],
    vlr: &LazVlr,
    chunks: &[ChunkTableEntry],
    selection: DecompressionSelection,
) -> ::laz::Result<()> {
    let mut jobs = Vec::with_capacity(chunks.len());
    for chunk in chunks {
        let (bytes, rest) = compressed.split_at(chunk.byte_count as usize);
        let (records, rest_of_points) = points.split_at_mut((chunk.point_count * vlr.items_size()) as usize);
        jobs.push((bytes, records));
        (compressed, points) = (rest, rest_of_points);
    }
    let results: Vec<_> =
        jobs.into_par_iter().map(|(bytes, records)| decompress_chunk(bytes, records, vlr.items(), selection)).collect();
    results.into_iter().collect()
}

fn decompress_chunk(
    bytes: &[u8],
    points: &mut [u8],
    items: &[LazItem],
    selection: DecompressionSelection,
) -> ::laz::Result<()> {
    let bytes = Cursor::new(bytes);
    if items.first().is_some_and(|item| item.version() < 3) {
        let mut decompressor = SequentialPointRecordDecompressor::new(bytes);
        for item in items {
            match (item.item_type(), item.version()) {
                (LazItemType::GpsTime, 2) => decompressor.add_field_decompressor(GpsTimeField::new()),
                _ => decompressor.set_fields_from(&vec![*item])?,
            }
        }
        return Ok(decompressor.decompress_many(points)?);
    }
    let mut decompressor = LayeredPointRecordDecompressor::new(bytes);
    for item in items {
        match (item.item_type(), item.version()) {
            (LazItemType::Point14, version @ (3 | 4)) => {
                decompressor.add_field_decompressor(Point14Field::new(version));
            }
            _ => decompressor.set_fields_from(&vec![*item])?,
        }
    }
    decompressor.set_selection(selection);
    Ok(decompressor.decompress_many(points)?)
}

#[cfg(test)]
#[expect(clippy::cast_possible_truncation, reason = "small numbers, and any byte will do")]
mod tests {
    use super::*;

    use std::io;

    use ::laz::LazItemRecordBuilder as Items;
    use ::laz::LazVlrBuilder;
    use ::laz::encoders::ArithmeticEncoder;
    use ::laz::las::{Point0, Point1, Point3, Point4, Point6, Point7, Point8, Point9, Point10, v2};
    use ::laz::models::ArithmeticModelBuilder;
    use ::laz::record::{FieldCompressor, RecordCompressor, SequentialPointRecordCompressor};
    use belvedere_data::random::uniform;

    const POINTS: usize = 20_000;

    /// Random numbers of one sequence.
    struct ChunkRandom(u64);

    impl ChunkRandom {
        fn below(&mut self, end: u64) -> u64 {
            self.0 += 1;
            (uniform(7, self.0) * end as f64) as u64
        }
    }

    /// Times that stay, go on evenly, by multiples up to beyond those with symbols, back, and to other sequences.
    fn times(random: &mut ChunkRandom) -> Vec<i64> {
        let mut sequences = [2.5e5_f64, 2.6e5, 1.0e8, -3.0, 7.0e5].map(|time| time.to_bits() as i64);
        let mut at = 0;
        (0..POINTS)
            .map(|_| {
                if random.below(50) == 0 {
                    at = random.below(5) as usize;
                }
                let step = match random.below(12) {
                    0..4 => 0,
                    4..8 => 1000 + random.below(3) as i64,
                    8 => 1000 * random.below(20) as i64,
                    9 => 1000 * (random.below(700) as i64 - 100),
                    10 => -500_000,
                    _ => random.below(1 << 33) as i64,
                };
                sequences[at] = sequences[at].wrapping_add(step);
                sequences[at]
            })
            .collect()
    }

    /// Records of `length` bytes that look like points, with a time at `time_at` where a format has times.
    fn records(length: usize, time_at: Option<usize>) -> Vec<u8> {
        let mut random = ChunkRandom(0);
        let times = times(&mut random);
        let mut record: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
        let mut all = Vec::with_capacity(POINTS * length);
        for time in times {
            for axis in 0..3 {
                let coordinate = i32::from_le_bytes(record[axis * 4..axis * 4 + 4].try_into().unwrap());
                let step = if random.below(100) == 0 { 1 << 30 } else { random.below(300) as i32 - 100 };
                record[axis * 4..axis * 4 + 4].copy_from_slice(&coordinate.wrapping_add(step).to_le_bytes());
            }
            for value in &mut record[12..] {
                if random.below(4) == 0 {
                    *value = value.wrapping_add(random.below(256) as u8);
                }
            }
            if let Some(at) = time_at {
                record[at..at + 8].copy_from_slice(&time.to_le_bytes());
            }
            all.extend_from_slice(&record);
        }
        all
    }

    #[test]
    fn points_come_back_as_the_laz_crate_compressed_them() {
        let formats = [
            ("0", Items::version_2_of::<Point0>(0), None),
            ("1, version 1", Items::version_1_of::<Point1>(0), Some(20)),
            ("1", Items::version_2_of::<Point1>(3), Some(20)),
            ("3", Items::version_2_of::<Point3>(0), Some(20)),
            ("4", Items::version_2_of::<Point4>(0), Some(20)),
            ("6, version 3", Items::version_3_of::<Point6>(2), Some(22)),
            ("7, version 3", Items::version_3_of::<Point7>(0), Some(22)),
            ("9, version 3", Items::version_3_of::<Point9>(0), Some(22)),
            ("6, version 4", Items::version_4_of::<Point6>(0), Some(22)),
            ("7, version 4", Items::version_4_of::<Point7>(0), Some(22)),
            ("8, version 4", Items::version_4_of::<Point8>(1), Some(22)),
            ("10, version 4", Items::version_4_of::<Point10>(0), Some(22)),
        ];
        for (format, items, time_at) in formats {
            let length = items.iter().map(|item| usize::from(item.size())).sum();
            let vlr = LazVlrBuilder::new(items).with_fixed_chunk_size(POINTS as u32 / 4).build();
            let points = records(length, time_at);
            let mut compressed = Vec::new();
            let table = ::laz::laszip::parallel::par_compress(&mut compressed, &points, &vlr).unwrap();
            let chunks: Vec<_> = (&table).into_iter().copied().collect();
            for selection in [DecompressionSelection::all(), DecompressionSelection::base()] {
                let mut expected = vec![0; points.len()];
                ::laz::par_decompress_selective(&compressed, &mut expected, &vlr, &chunks, selection).unwrap();
                let mut found = vec![0; points.len()];
                decompress(&compressed, &mut found, &vlr, &chunks, selection).unwrap();
                let differs = found.chunks(length).zip(expected.chunks(length)).position(|(a, b)| a != b);
                assert_eq!(differs, None, "format {format}: the first point unlike that of the laz crate");
                if selection == DecompressionSelection::all() {
                    assert!(found == points, "format {format}");
                }
            }
        }
    }

    /// A stream of symbols that all switch to another sequence of times.
    fn switches(symbols: u32, encoder: &mut ArithmeticEncoder<impl io::Write>) -> io::Result<()> {
        let mut model = ArithmeticModelBuilder::new(symbols).with_compression(true).build();
        (0..1_000_000).try_for_each(|_| encoder.encode_symbol(&mut model, symbols - 1))
    }

    struct Switches;

    impl<W: io::Write> FieldCompressor<W> for Switches {
        fn size_of_field(&self) -> usize {
            8
        }

        fn compress_first(&mut self, dst: &mut W, buf: &[u8]) -> io::Result<()> {
            dst.write_all(buf)
        }

        fn compress_with(&mut self, encoder: &mut ArithmeticEncoder<W>, _buf: &[u8]) -> io::Result<()> {
            switches(6, encoder)
        }
    }

    #[test]
    fn times_that_switch_without_end_are_refused() {
        let mut compressor = SequentialPointRecordCompressor::new(Vec::new());
        compressor.add_field_compressor(v2::LasPoint0Compressor::default());
        compressor.add_field_compressor(Switches);
        compressor.compress_many(&[1; 2 * 28]).unwrap();
        compressor.done().unwrap();
        let sequential = compressor.into_inner();

        // two points with a channel, the second with a new time, whose layer, the last one, is replaced
        let items = Items::version_3_of::<Point6>(0);
        let mut points = [0; 2 * 30];
        points[30 + 22..].copy_from_slice(&1.5_f64.to_le_bytes());
        let vlr = LazVlrBuilder::new(items.clone()).with_fixed_chunk_size(2).build();
        let mut layered = Vec::new();
        ::laz::laszip::parallel::par_compress(&mut layered, &points, &vlr).unwrap();
        let mut encoder = ArithmeticEncoder::new(Vec::new());
        switches(5, &mut encoder).unwrap();
        encoder.done().unwrap();
        let layer = encoder.into_inner();
        let size = 30 + 4 + 8 * 4;
        let old = u32::from_le_bytes(layered[size..size + 4].try_into().unwrap()) as usize;
        layered.truncate(layered.len() - old);
        layered[size..size + 4].copy_from_slice(&(layer.len() as u32).to_le_bytes());
        layered.extend(layer);

        for (bytes, items) in [(sequential, Items::version_2_of::<Point1>(0)), (layered, items)] {
            assert!(bytes.len() < 400, "{}", bytes.len());
            let mut points = vec![0; 2 * items.iter().map(|item| usize::from(item.size())).sum::<usize>()];
            let error = decompress_chunk(&bytes, &mut points, &items, DecompressionSelection::all()).unwrap_err();
            assert!(error.to_string().contains("switch between sequences"), "{error}");
        }
    }
}
