//! Which chunks of a COPC file hold the points of a box: a walk through the hierarchy of the file.
//!
//! COPC is LAZ whose chunks are the nodes of an octree. The hierarchy names for each node where its chunk lies; it
//! comes in pages, and only pages of nodes that meet the box are read. Everything the hierarchy claims is compared with
//! the size of the file before it is used, and the chunks are decompressed by the same reader as those of any LAZ file.
//!
//! # Source
//! COPC specification 1.0: info record, section 3.1; hierarchy, section 3.2 (Bell, Belcher & Manning 2021).

use std::collections::HashSet;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::las_header::LasHeader;
use super::read_options::FileBox;
use belvedere_data::{Error, Result};

/// Bytes of an entry of the hierarchy.
const ENTRY_BYTES: u64 = 32;
/// Deepest level of the octree that is believed: a kilometre in cells of a nanometre.
const DEEPEST: i32 = 40;
/// How far points may lie outside the cell of their node, in steps of the coordinates: what writers round them by.
const ROOM_STEPS: f64 = 10.0;

/// Where a chunk lies in its file, as the file says it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChunkPlace {
    pub(super) start: u64,
    pub(super) bytes: u64,
    pub(super) points: u64,
}

/// The octree of a file.
struct Octree {
    low: [f64; 3],
    side: f64,
    root: (u64, u64),
}

/// The chunks of nodes that meet `wanted`, in the order of the file, or `None` where the file is no COPC. `size` is
/// that of the file in bytes.
///
/// # Errors
/// [`Error::Malformed`] for a hierarchy that does not fit the file.
pub(super) fn chunks_within(
    path: &Path,
    file: &mut (impl Read + Seek),
    header: &LasHeader,
    size: u64,
    wanted: &FileBox,
) -> Result<Option<Vec<ChunkPlace>>> {
    let Some(info) = header.record("copc", 1) else { return Ok(None) };
    let damaged = |what: String| Error::malformed(path, format!("has a damaged COPC hierarchy: {what}"));
    let octree = Octree::of_info(info).ok_or_else(|| damaged("its root is not usable".to_owned()))?;
    let room = header.scale.map(|scale| ROOM_STEPS * scale.abs());
    let mut pages = vec![octree.root];
    let (mut seen, mut chunks) = (HashSet::from([octree.root.0]), Vec::new());
    let (mut page_bytes, mut bytes) = (0_u64, Vec::new());
    while let Some((start, length)) = pages.pop() {
        page_bytes = page_bytes.saturating_add(length);
        let ends_within = start.checked_add(length).is_some_and(|end| end <= size);
        // pages do not overlap, so that all of them together are smaller than the file
        if !ends_within || page_bytes > size || length % ENTRY_BYTES != 0 {
            return Err(damaged(format!("a page of {length} bytes at byte {start} of {size}")));
        }
        bytes.clear();
        file.seek(SeekFrom::Start(start)).map_err(Error::io(path))?;
        file.take(length).read_to_end(&mut bytes).map_err(Error::io(path))?;
        for entry in bytes.as_chunks::<32>().0.iter().map(HierarchyEntry::of) {
            if !octree.node_meets(&entry, room, wanted).ok_or_else(|| damaged(format!("node {:?}", entry.key)))? {
                continue;
            }
            match (entry.points, u64::try_from(entry.bytes)) {
                (0, _) => {}
                (-1, Ok(length)) => {
                    if !seen.insert(entry.start) {
                        return Err(damaged(format!("the page at byte {} is named twice", entry.start)));
                    }
                    pages.push((entry.start, length));
                }
                (points @ 1.., Ok(length)) => {
                    let points = u64::from(points.unsigned_abs());
                    chunks.push(ChunkPlace { start: entry.start, bytes: length, points });
                }
                _ => return Err(damaged(format!("{} points in {} bytes", entry.points, entry.bytes))),
            }
        }
    }
    chunks.sort_unstable_by_key(|chunk| chunk.start);
    let mut free = header.points_start;
    for chunk in &chunks {
        let end = chunk.start.saturating_add(chunk.bytes);
        if chunk.start < free || end > size {
            return Err(damaged(format!("a chunk at bytes {} to {end} of {size}", chunk.start)));
        }
        free = end;
    }
    Ok(Some(chunks))
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

impl Octree {
    fn of_info(info: &[u8]) -> Option<Self> {
        let number = |at: usize| info.get(8 * at..).and_then(|rest| rest.first_chunk::<8>()).copied();
        let real = |at: usize| number(at).map(f64::from_le_bytes);
        let (center, half) = ([real(0)?, real(1)?, real(2)?], real(3)?);
        let is_sound = half > 0.0 && half.is_finite() && center.iter().all(|v| v.is_finite());
        let root = (number(5).map(u64::from_le_bytes)?, number(6).map(u64::from_le_bytes)?);
        is_sound.then(|| Self { low: center.map(|v| v - half), side: 2.0 * half, root })
    }

    /// Whether the cell of the node of `entry`, widened by `room`, meets `wanted`; `None` for a node that cannot be.
    fn node_meets(&self, entry: &HierarchyEntry, room: [f64; 3], wanted: &FileBox) -> Option<bool> {
        let [level, place @ ..] = entry.key;
        if !(0..=DEEPEST).contains(&level) {
            return None;
        }
        let side = self.side / f64::from(level).exp2();
        if place.iter().any(|&v| v < 0 || f64::from(v) >= f64::from(level).exp2()) {
            return None;
        }
        let low: [f64; 3] = std::array::from_fn(|i| self.low[i] + f64::from(place[i]) * side - room[i]);
        let high: [f64; 3] = std::array::from_fn(|i| low[i] + side + 2.0 * room[i]);
        Some(wanted.meets(low, high))
    }
}
