//! Number of records in the binary section of an E57 scan, whatever its XML counts.
//!
//! # Source
//! ASTM E2807-11, sections 9.3 (compressed vector sections), 9.3.4 (data packets) and 7 (pages with checksums).

use std::io::{Read, Seek, SeekFrom};

/// Bytes of a page, of which the last four are a checksum.
const PAGE: u64 = 1024;
const PAYLOAD: u64 = PAGE - 4;
/// Kind of sections of points, and of packets of data.
const SECTION: u8 = 1;
const DATA: u8 = 1;
/// Packets of more than this are not looked at: 60 GB of full ones.
const MAX_PACKETS: usize = 1 << 20;
/// Bytes of the header of a section, and of a data packet before the lengths of its streams.
const SECTION_HEADER: usize = 32;
const PACKET_HEADER: usize = 6;

/// Returns a lower bound of the number of records in the section at a physical byte, counted in the stream with this
/// index. Each record has `bits` bits. `None` for a section that is damaged.
pub(crate) fn records_in_section(
    file: &mut (impl Read + Seek),
    physical: u64,
    stream: usize,
    bits: u64,
) -> Option<u64> {
    let mut pages = Pages(file);
    let start = logical(physical);
    let header = pages.read::<SECTION_HEADER>(start)?;
    let number = |at: usize| header.get(at..)?.first_chunk().copied().map(u64::from_le_bytes);
    let (length, data) = (number(8)?, number(16)?);
    let end = start.checked_add(length).filter(|_| header[0] == SECTION)?;
    let (mut at, mut records) = (logical(data), 0_u64);
    for _ in 0..MAX_PACKETS {
        if at >= end {
            return Some(records);
        }
        let packet = pages.read::<PACKET_HEADER>(at)?;
        let size = u64::from(u16::from_le_bytes([packet[2], packet[3]])) + 1;
        if packet[0] == DATA {
            let streams = usize::from(u16::from_le_bytes([packet[4], packet[5]]));
            let place = at + PACKET_HEADER as u64 + 2 * stream as u64;
            if stream >= streams {
                return None;
            }
            let bytes = u64::from(u16::from_le_bytes(pages.read::<2>(place)?));
            records = records.saturating_add(8 * bytes / bits);
        }
        at = at.checked_add(size)?;
    }
    None
}

/// Place of a byte without the checksums before it.
fn logical(physical: u64) -> u64 {
    physical / PAGE * PAYLOAD + (physical % PAGE).min(PAYLOAD)
}

/// A file without the checksums of its pages.
struct Pages<'a, R>(&'a mut R);

impl<R: Read + Seek> Pages<'_, R> {
    fn read<const N: usize>(&mut self, mut at: u64) -> Option<[u8; N]> {
        let mut bytes = [0; N];
        let mut rest = bytes.as_mut_slice();
        while !rest.is_empty() {
            let (page, within) = (at / PAYLOAD, at % PAYLOAD);
            let room = usize::try_from(PAYLOAD - within).ok()?.min(rest.len());
            let (now, after) = rest.split_at_mut(room);
            self.0.seek(SeekFrom::Start(page.checked_mul(PAGE)?.checked_add(within)?)).ok()?;
            self.0.read_exact(now).ok()?;
            at += room as u64;
            rest = after;
        }
        Some(bytes)
    }
}
