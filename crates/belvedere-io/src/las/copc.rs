//! Chunks of a COPC file that hold the points of a box, found in the hierarchy of the file.
//!
//! COPC is LAZ whose chunks are the nodes of an octree. The hierarchy names for each node where its chunk lies; it
//! comes in pages, and of a large one only pages of nodes that meet the box are read. The claims of the hierarchy are
//! compared with the chunk table before it is used, and the chunks are decompressed by the same reader as those of any
//! LAZ file. Programs that rewrite a file may leave the records of an older order of its points; then these are
//! ignored.
//!
//! # Source
//! COPC specification 1.0: info record, section 3.1; hierarchy, section 3.2 (Bell, Belcher & Manning 2021).

use std::collections::HashSet;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use crate::files::source::{SourceReader, web_address};
use crate::las::header::{COPC, LasHeader};
use crate::las::laz::{self, ChunkPlace};
use crate::las::octree::OctreeCube;
use crate::points::read_options::FileBox;
use belvedere_data::{Error, Result};

/// Bytes of an entry of the hierarchy.
const ENTRY_BYTES: u64 = 32;
/// Hierarchies of up to this many bytes, for 8000 nodes, are read whole: a millisecond, and nothing can be hidden.
const SMALL_HIERARCHY: u64 = 1 << 18;
/// Maximum distance of points outside the cell of their node, in steps of the coordinates: the rounding of writers.
const ROOM_STEPS: f64 = 10.0;

/// The octree of a file.
struct CopcOctree {
    cube: OctreeCube,
    /// First byte and bytes of the root page.
    root: (u64, u64),
}

/// Nodes of a file, as stated there.
pub(crate) enum CopcNodes {
    /// The file is no COPC.
    None,
    /// Chunks of the nodes that are wanted, in the order of the file.
    Chunks(Vec<ChunkPlace>),
    /// The hierarchy is not that of the points, and why: a program rewrote the points and kept the records.
    Unfit(String),
}

impl CopcNodes {
    /// Returns a note on a hierarchy that is ignored.
    pub(crate) fn note(&self) -> Option<String> {
        let Self::Unfit(what) = self else { return None };
        Some(format!("its COPC hierarchy is not that of its points ({what}); they are read in the order of the file"))
    }
}

/// The chunks of nodes that meet `wanted`, of all nodes without a box. `size` is that of the file in bytes.
///
/// A small hierarchy on this machine is read whole and must name all points; of others only pages of nodes that meet
/// the box are read. Every chunk must be one of the chunk table.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for a damaged chunk table.
pub(crate) fn nodes_within(
    path: &Path,
    file: &mut SourceReader<'_>,
    header: &LasHeader,
    size: u64,
    wanted: Option<&FileBox>,
) -> Result<CopcNodes> {
    let Some(info) = header.record(COPC, 1) else { return Ok(CopcNodes::None) };
    let walked = walk(path, file, header, info, wanted).and_then(|chunks| {
        let table = laz::chunk_table(path, file, header, size)?;
        let table = table.ok_or_else(|| Misfit::of("the chunks of the file all have one size"))?;
        match chunks.iter().find(|chunk| table.binary_search(chunk).is_err()) {
            Some(chunk) => Err(Misfit::of(format!("it names a chunk at byte {}, where none is", chunk.start))),
            None => Ok(chunks),
        }
    });
    match walked {
        Ok(chunks) => Ok(CopcNodes::Chunks(chunks)),
        Err(Misfit::Hierarchy(what)) => Ok(CopcNodes::Unfit(what)),
        Err(Misfit::File(error)) => Err(error),
    }
}

/// Why a hierarchy gives no chunks.
enum Misfit {
    Hierarchy(String),
    File(Error),
}

impl Misfit {
    fn of(what: impl Into<String>) -> Self {
        Self::Hierarchy(what.into())
    }
}

impl From<Error> for Misfit {
    fn from(error: Error) -> Self {
        Self::File(error)
    }
}

/// The chunks that the hierarchy names.
fn walk(
    path: &Path,
    file: &mut SourceReader<'_>,
    header: &LasHeader,
    info: &[u8],
    wanted: Option<&FileBox>,
) -> std::result::Result<Vec<ChunkPlace>, Misfit> {
    let octree = CopcOctree::of_info(info).ok_or_else(|| Misfit::of("its root is not usable"))?;
    let room = header.scale.map(|scale| ROOM_STEPS * scale.abs());
    let record = header.copc_pages.clone().ok_or_else(|| Misfit::of("it is missing"))?;
    let is_near = web_address(path).is_none();
    let is_read_whole = wanted.is_none() || is_near && record.end - record.start <= SMALL_HIERARCHY;
    let mut pages = vec![octree.root];
    let (mut seen, mut chunks, mut points) = (HashSet::from([octree.root.0]), Vec::new(), 0_u64);
    let (mut page_bytes, mut bytes) = (0_u64, Vec::new());
    while let Some((start, length)) = pages.pop() {
        page_bytes = page_bytes.saturating_add(length);
        let is_within = start >= record.start && start.checked_add(length).is_some_and(|end| end <= record.end);
        // pages do not overlap, so that all of them together are smaller than the record
        if !is_within || length == 0 || page_bytes > record.end - record.start || length % ENTRY_BYTES != 0 {
            return Err(Misfit::of(format!("a page of {length} bytes at byte {start}")));
        }
        bytes.clear();
        file.seek(SeekFrom::Start(start)).map_err(Error::io(path))?;
        file.take(length).read_to_end(&mut bytes).map_err(Error::io(path))?;
        for entry in bytes.as_chunks::<32>().0.iter().map(HierarchyEntry::of) {
            let is_wanted = octree.cube.node_meets(entry.key, room, wanted);
            let is_wanted = is_wanted.ok_or_else(|| Misfit::of(format!("node {:?}", entry.key)))?;
            match (entry.points, u64::try_from(entry.bytes)) {
                (0, _) => {}
                (-1, Ok(length)) => {
                    if !seen.insert(entry.start) {
                        return Err(Misfit::of(format!("the page at byte {} is named twice", entry.start)));
                    }
                    if is_wanted || is_read_whole {
                        pages.push((entry.start, length));
                    }
                }
                (count @ 1.., Ok(length)) => {
                    let count = u64::from(count.unsigned_abs());
                    points = points.saturating_add(count);
                    if is_wanted {
                        chunks.push(ChunkPlace { start: entry.start, bytes: length, points: count });
                    }
                }
                _ => return Err(Misfit::of(format!("{} points in {} bytes", entry.points, entry.bytes))),
            }
        }
    }
    if is_read_whole && points != header.points {
        return Err(Misfit::of(format!("it names {points} of {} points", header.points)));
    }
    chunks.sort_unstable();
    match chunks.windows(2).find(|pair| pair[0].start == pair[1].start) {
        Some(pair) => Err(Misfit::of(format!("the chunk at byte {} is named twice", pair[0].start))),
        None => Ok(chunks),
    }
}

/// An entry of the hierarchy.
struct HierarchyEntry {
    /// Level, and number of the node along x, y and z.
    key: [i32; 4],
    start: u64,
    bytes: i32,
    /// Number of points; −1 where the entry names a page.
    points: i32,
}

impl HierarchyEntry {
    fn of(bytes: &[u8; 32]) -> Self {
        let [a, b, c, d, low, high, size, points] =
            std::array::from_fn(|i| std::array::from_fn(|byte| bytes[4 * i + byte])).map(u32::from_le_bytes);
        let signed = |v: u32| i32::from_le_bytes(v.to_le_bytes());
        Self {
            key: [a, b, c, d].map(signed),
            start: u64::from(low) | u64::from(high) << 32,
            bytes: signed(size),
            points: signed(points),
        }
    }
}

impl CopcOctree {
    fn of_info(info: &[u8]) -> Option<Self> {
        let number = |at: usize| info.get(8 * at..).and_then(|rest| rest.first_chunk::<8>()).copied();
        let real = |at: usize| number(at).map(f64::from_le_bytes);
        let (center, half) = ([real(0)?, real(1)?, real(2)?], real(3)?);
        let is_sound = half > 0.0 && half.is_finite() && center.iter().all(|v| v.is_finite());
        let root = (number(5).map(u64::from_le_bytes)?, number(6).map(u64::from_le_bytes)?);
        is_sound.then(|| Self { cube: OctreeCube { low: center.map(|v| v - half), side: 2.0 * half }, root })
    }
}
