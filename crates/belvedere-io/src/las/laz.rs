//! LAZ chunks, checked before they are decompressed: the laz crate trusts sizes in the file and would allocate them.
//!
//! The checks and their reasons are listed in `docs/upstream.md`.

mod chunks;
mod gps_times;
mod point14;

use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use crate::files::source::{ReadSeek, SourceReader};

use ::laz::laszip::{ChunkTable, ChunkTableEntry, CompressorType, LazItemType};
use ::laz::{DecompressionSelection, LasZipError, LazVlr};

use crate::las::header::LasHeader;
use belvedere_data::{Error, Result};

/// Position of a chunk in its file, as stated there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ChunkPlace {
    pub(crate) start: u64,
    pub(crate) bytes: u64,
    pub(crate) points: u64,
}

/// A chunk that would decompress to more bytes than this is no chunk that any writer makes (50 000 points are usual).
const MAX_CHUNK_BYTES: u64 = 1 << 30;

/// Maximum compression ratio of a chunk that decompresses to more than [`FREE_CHUNK_BYTES`]. Useful points are
/// compressed 3 to 20 times, and the allocations of a reader must depend on the size of the file.
const MAX_RATIO: u64 = 256;
const FREE_CHUNK_BYTES: u64 = 1 << 26;

/// Selection of the fields of points, for files that have them in layers of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LazFields {
    /// Attributes of a cloud.
    Attributes,
    /// Extra bytes too.
    AttributesAndExtraBytes,
    /// All but waveforms.
    All,
}

/// Selection of chunks.
pub(crate) enum NeededChunks {
    /// Chunks that hold any of these rows, ranges in their order.
    Rows(Vec<Range<u64>>),
    /// Chunks of a COPC file at these places.
    Places(Vec<ChunkPlace>),
}

/// Decompresses the points of a file batch by batch.
pub(crate) struct LazReader<'a> {
    /// Unbuffered file: chunks are read whole, and bytes read ahead beyond one may never be needed.
    file: Box<dyn ReadSeek + 'a>,
    /// Position of the next read; `None` before the first chunk.
    place: Option<u64>,
    vlr: LazVlr,
    chunks: std::vec::IntoIter<LazChunk>,
    layers: Option<usize>,
    selection: DecompressionSelection,
    record_length: usize,
    compressed: Vec<u8>,
}

/// A chunk and the byte of the file that it begins at.
#[derive(Clone, Copy)]
struct LazChunk {
    start: u64,
    entry: ChunkTableEntry,
}

impl<'a> LazReader<'a> {
    /// A reader of the `wanted` chunks of those that `header` announces in a file of `size` bytes.
    pub(crate) fn new(
        path: &Path,
        mut file: SourceReader<'a>,
        header: &LasHeader,
        size: u64,
        fields: LazFields,
        wanted: NeededChunks,
    ) -> Result<Self> {
        let vlr = compression(path, header)?;
        let layers = layer_count(&vlr);
        let chunks = match wanted {
            NeededChunks::Places(places) => chunks_at(path, &places, header)?,
            NeededChunks::Rows(rows) => with_rows(all_chunks(path, &mut file, &vlr, header, size)?, &rows),
        };
        // user data are looked at, so that a user hears when an output has no place for them
        let all = DecompressionSelection::all().skip_wavepacket();
        let selection = match fields {
            LazFields::Attributes => all.skip_nir().skip_extra_bytes(),
            LazFields::AttributesAndExtraBytes => all.skip_nir(),
            LazFields::All => all,
        };
        Ok(Self {
            file: file.into_inner(),
            place: None,
            vlr,
            chunks: chunks.into_iter(),
            layers,
            selection,
            record_length: usize::from(header.record_length),
            compressed: Vec::new(),
        })
    }

    /// Points of the chunks that are still to come.
    pub(crate) fn remaining(&self) -> u64 {
        self.chunks.as_slice().iter().fold(0, |sum, chunk| sum.saturating_add(chunk.entry.point_count))
    }

    /// Decompresses whole chunks until `wanted` points are reached; `room` makes a slice for a number of points.
    /// Returns the number of points, zero at the end.
    pub(crate) fn next_batch<'b>(
        &mut self,
        path: &Path,
        wanted: u64,
        room: impl FnOnce(usize) -> &'b mut [u8],
    ) -> Result<usize> {
        let damaged = |what: &str| Error::malformed(path, what);
        let mut batch: Vec<ChunkTableEntry> = Vec::new();
        let mut points = 0;
        self.compressed.clear();
        while points < wanted {
            let Some(LazChunk { start, entry }) = self.chunks.next() else { break };
            if self.place != Some(start) {
                self.file.seek(SeekFrom::Start(start)).map_err(Error::io(path))?;
            }
            let before = self.compressed.len() as u64;
            (&mut self.file).take(entry.byte_count).read_to_end(&mut self.compressed).map_err(Error::io(path))?;
            if self.compressed.len() as u64 - before != entry.byte_count {
                return Err(damaged("ends within its points"));
            }
            self.place = Some(start.saturating_add(entry.byte_count));
            points += entry.point_count;
            batch.push(entry);
        }
        let points = usize::try_from(points).map_err(|_| damaged("has more points than memory can address"))?;
        if points == 0 {
            return Ok(0);
        }
        if !self.streams_are_sound(&batch) {
            return Err(damaged("has a LAZ chunk whose sizes or streams are damaged"));
        }
        let (compressed, vlr) = (&self.compressed, &self.vlr);
        chunks::decompress(compressed, room(points), vlr, &batch, self.selection)
            .map_err(|e| damaged(&format!("has points that cannot be decompressed: {e}")))?;
        Ok(points)
    }

    /// Returns true if the data before the compressed streams of each chunk fit the size of the chunk.
    fn streams_are_sound(&self, batch: &[ChunkTableEntry]) -> bool {
        let mut rest = self.compressed.as_slice();
        batch.iter().all(|chunk| {
            let length = usize::try_from(chunk.byte_count).unwrap_or(usize::MAX).min(rest.len());
            let (bytes, after) = rest.split_at(length);
            rest = after;
            chunk.point_count == 0 || self.chunk_is_sound(bytes)
        })
    }

    /// Returns true if the streams after the first point, which is not compressed, fit in the chunk and begin as
    /// required.
    fn chunk_is_sound(&self, chunk: &[u8]) -> bool {
        let Some((_, streams)) = chunk.split_at_checked(self.record_length) else { return false };
        let Some(layers) = self.layers else { return begins_soundly(streams) };
        // The number of points comes first, then the size of each layer, then the layers.
        let Some((sizes, mut content)) = streams.split_at_checked(4 + layers * 4) else { return false };
        for &size in sizes.as_chunks::<4>().0.iter().skip(1) {
            let size = usize::try_from(u32::from_le_bytes(size)).unwrap_or(usize::MAX);
            let Some((layer, after)) = content.split_at_checked(size) else { return false };
            if !begins_soundly(layer) {
                return false;
            }
            content = after;
        }
        true
    }
}

/// Returns true if an arithmetic-coded stream begins with a value below its interval. From 0xFFFFFFFF the decoder of
/// the laz crate (0.13) yields the same symbol forever without consuming a byte, or searches symbols that are not in
/// its tables.
fn begins_soundly(stream: &[u8]) -> bool {
    stream.first_chunk() != Some(&[0xff; 4])
}

/// The record that describes the compression, which must fit the points of the header.
fn compression(path: &Path, header: &LasHeader) -> Result<LazVlr> {
    let damaged = |what: String| Error::malformed(path, what);
    let record = header.record(LazVlr::USER_ID, LazVlr::RECORD_ID);
    let record = record.ok_or_else(|| damaged("lacks the LAZ record that describes its compression".to_owned()))?;
    let vlr = LazVlr::from_buffer(record).map_err(|e| damaged(format!("has an unreadable LAZ record: {e}")))?;
    let items_match = vlr.items().iter().all(|item| item.size() == nominal_size(item.item_type()));
    let item_bytes: u64 = vlr.items().iter().map(|item| u64::from(item.size())).sum();
    if !items_match || item_bytes != u64::from(header.record_length) {
        return Err(damaged(format!(
            "has a LAZ record for points of {item_bytes} bytes that does not fit the {} bytes of its header",
            header.record_length
        )));
    }
    Ok(vlr)
}

/// All chunks of a file of `size` bytes.
fn all_chunks(
    path: &Path,
    file: &mut SourceReader<'_>,
    vlr: &LazVlr,
    header: &LasHeader,
    size: u64,
) -> Result<Vec<LazChunk>> {
    file.seek(SeekFrom::Start(header.points_start)).map_err(Error::io(path))?;
    check_chunk_count(path, file, header, size)?;
    let table = ChunkTable::read_from(&mut *file, vlr).map_err(|error| match error {
        LasZipError::IoError(error) if error.kind() != ErrorKind::UnexpectedEof => Error::io(path)(error),
        error => Error::malformed(path, format!("has no readable LAZ chunk table: {error}")),
    })?;
    checked_chunks(path, &table, vlr, header, size)
}

/// Returns the positions of the chunks of a file, in its order. `None` if all have the same number of points, which
/// those of COPC do not.
pub(crate) fn chunk_table(
    path: &Path,
    file: &mut SourceReader<'_>,
    header: &LasHeader,
    size: u64,
) -> Result<Option<Vec<ChunkPlace>>> {
    let vlr = compression(path, header)?;
    if !vlr.uses_variable_size_chunks() {
        return Ok(None);
    }
    let chunks = all_chunks(path, file, &vlr, header, size)?;
    let place =
        |LazChunk { start, entry }: LazChunk| ChunkPlace { start, bytes: entry.byte_count, points: entry.point_count };
    Ok(Some(chunks.into_iter().map(place).collect()))
}

/// Chunks of the chunk table that hold points beyond those of the header.
pub(crate) fn chunks_beyond(path: &Path, file: &mut SourceReader<'_>, header: &LasHeader, size: u64) -> Result<u64> {
    let vlr = compression(path, header)?;
    check_chunk_count(path, file, header, size)?;
    let table = ChunkTable::read_from(&mut *file, &vlr)
        .map_err(|e| Error::malformed(path, format!("has no readable LAZ chunk table: {e}")))?;
    let (mut points, mut beyond) = (0_u64, 0);
    for chunk in &table {
        if points >= header.points && chunk.byte_count > 0 && chunk.point_count > 0 {
            beyond += 1;
        }
        points = points.saturating_add(chunk.point_count);
    }
    Ok(beyond)
}

/// Bytes of an item, which the file states again, as the decompressor knows them.
fn nominal_size(item: LazItemType) -> u16 {
    match item {
        LazItemType::Point10 => 20,
        LazItemType::GpsTime | LazItemType::RGBNIR14 => 8,
        LazItemType::RGB12 | LazItemType::RGB14 => 6,
        LazItemType::WavePacket13 | LazItemType::WavePacket14 => 29,
        LazItemType::Point14 => 30,
        LazItemType::Byte(count) | LazItemType::Byte14(count) => count,
    }
}

/// Number of layers of a chunk, or `None` for point formats 0 to 5, which have no layers.
fn layer_count(vlr: &LazVlr) -> Option<usize> {
    vlr.items()
        .iter()
        .map(|item| match item.item_type() {
            LazItemType::Point14 => Some(9),
            LazItemType::RGB14 | LazItemType::WavePacket14 => Some(1),
            LazItemType::RGBNIR14 => Some(2),
            LazItemType::Byte14(count) => Some(usize::from(count)),
            _ => None,
        })
        .sum()
}

/// Every chunk begins with an uncompressed point, so the file bounds the number of chunks.
fn check_chunk_count(path: &Path, file: &mut SourceReader<'_>, header: &LasHeader, size: u64) -> Result<()> {
    let broken = || Error::malformed(path, "has no LAZ chunk table: the file is cut off or was not finished");
    let mut bytes = [0; 8];
    let mut table_start = |file: &mut SourceReader<'_>, from: SeekFrom| -> Result<u64> {
        file.seek(from).and_then(|_| file.read_exact(&mut bytes)).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof | ErrorKind::InvalidInput => broken(),
            // what a server or a disk says is no fault of the file
            _ => Error::io(path)(error),
        })?;
        Ok(u64::from_le_bytes(bytes))
    };
    let valid = |at: u64| at > header.points_start && at.saturating_add(8) <= size;
    let mut at = table_start(file, SeekFrom::Start(header.points_start))?;
    if !valid(at) {
        // A writer that could not seek back leaves the offset at the very end.
        at = table_start(file, SeekFrom::End(-8))?;
    }
    if !valid(at) {
        return Err(broken());
    }
    let count = table_start(file, SeekFrom::Start(at))? >> 32;
    if count * u64::from(header.record_length) > size {
        return Err(Error::malformed(path, format!("claims {count} LAZ chunks, more than its {size} bytes can hold")));
    }
    let mut stream = [0; 4];
    if count > 0 && file.read_exact(&mut stream).is_ok() && !begins_soundly(&stream) {
        return Err(Error::malformed(path, "has a damaged LAZ chunk table"));
    }
    file.seek(SeekFrom::Start(header.points_start)).map_err(Error::io(path))?;
    Ok(())
}

/// The chunks that hold the points `header` announces, each checked against the size of the file.
fn checked_chunks(
    path: &Path,
    table: &ChunkTable,
    vlr: &LazVlr,
    header: &LasHeader,
    size: u64,
) -> Result<Vec<LazChunk>> {
    let mut chunks: Vec<LazChunk> = Vec::new();
    // the offset of the chunk table comes before the first chunk
    let mut start = header.points_start.saturating_add(8);
    let (mut points, mut bytes) = (0_u64, 0_u64);
    for entry in table {
        let mut chunk = *entry;
        let left = header.points - points;
        if left == 0 {
            break;
        }
        if !vlr.uses_variable_size_chunks() {
            chunk.point_count = chunk.point_count.min(left);
        }
        bytes = bytes.saturating_add(chunk.byte_count);
        if bytes > size || chunk.point_count > left {
            return Err(unfit(path, &chunk, header));
        }
        check_size(path, &chunk, header)?;
        points += chunk.point_count;
        chunks.push(LazChunk { start, entry: chunk });
        start = start.saturating_add(chunk.byte_count);
    }
    if points < header.points {
        let what = format!("announces {} points, but its LAZ chunks hold {points}; it is cut off", header.points);
        return Err(Error::malformed(path, what));
    }
    Ok(chunks)
}

/// Selects the chunks that hold any of `rows`.
fn with_rows(mut chunks: Vec<LazChunk>, rows: &[Range<u64>]) -> Vec<LazChunk> {
    let mut next = 0_u64;
    chunks.retain(|chunk| {
        let first = next;
        next = first.saturating_add(chunk.entry.point_count);
        let after = rows.partition_point(|rows| rows.end <= first);
        rows.get(after).is_some_and(|rows| rows.start < next)
    });
    chunks
}

/// The chunks at `places`, which lie in the file and do not overlap.
fn chunks_at(path: &Path, places: &[ChunkPlace], header: &LasHeader) -> Result<Vec<LazChunk>> {
    let mut left = header.points;
    let chunk = |place: &ChunkPlace| {
        let entry = ChunkTableEntry { point_count: place.points, byte_count: place.bytes };
        left = left.checked_sub(place.points).ok_or_else(|| unfit(path, &entry, header))?;
        check_size(path, &entry, header)?;
        Ok(LazChunk { start: place.start, entry })
    };
    places.iter().map(chunk).collect()
}

/// Refuses a chunk that would decompress to more than its bytes can be believed to hold.
fn check_size(path: &Path, chunk: &ChunkTableEntry, header: &LasHeader) -> Result<()> {
    let decompressed = chunk.point_count.saturating_mul(u64::from(header.record_length));
    let max = FREE_CHUNK_BYTES.max(chunk.byte_count.saturating_mul(MAX_RATIO)).min(MAX_CHUNK_BYTES);
    if decompressed > max { Err(unfit(path, chunk, header)) } else { Ok(()) }
}

fn unfit(path: &Path, chunk: &ChunkTableEntry, header: &LasHeader) -> Error {
    let what = format!(
        "has a LAZ chunk of {} points in {} bytes, which does not fit the {} points of its header",
        chunk.point_count, chunk.byte_count, header.points
    );
    Error::malformed(path, what)
}

/// Returns true if `vlr` is of a kind that can be read; old files of one single chunk cannot.
pub(crate) fn is_chunked(vlr: &[u8]) -> bool {
    let kind = vlr.first_chunk().map(|&kind| u16::from_le_bytes(kind));
    kind == Some(CompressorType::PointWiseChunked as u16) || kind == Some(CompressorType::LayeredChunked as u16)
}
