//! What must hold of a LAS or LAZ file before it is decoded: the decoder allocates what the file promises.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use crate::{Error, Result};

/// Checks that the chunk table and the first extended record promise no more than the file can hold.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for a file that ends before its header or promises too much.
pub(crate) fn check_promises(path: &Path) -> Result<()> {
    let mut file = File::open(path).map_err(Error::io(path))?;
    let length = file.metadata().map_err(Error::io(path))?.len();
    let damaged = || Error::malformed(path, "is damaged or cut short: it promises more than the file holds");
    let mut header = [0; 375];
    let available = usize::try_from(length).unwrap_or(375).min(375);
    file.read_exact(&mut header[..available]).map_err(Error::io(path))?;
    if available < 227 {
        return Err(damaged());
    }
    let is_extended = header[24] == 1 && header[25] >= 4;
    let record_count = u32::from_le_bytes([header[243], header[244], header[245], header[246]]);
    if is_extended && record_count > 0 {
        let start = header[235..].first_chunk().map_or(0, |b| u64::from_le_bytes(*b));
        let promised = read_u64(&mut file, SeekFrom::Start(start.saturating_add(20))).ok_or_else(damaged)?;
        if promised > length {
            return Err(damaged());
        }
    }
    let is_compressed = header[104] & 0xc0 != 0;
    if is_compressed {
        let points = u64::from(u32::from_le_bytes([header[96], header[97], header[98], header[99]]));
        let mut table = read_u64(&mut file, SeekFrom::Start(points)).ok_or_else(damaged)?.cast_signed();
        if table <= points.cast_signed() {
            // a writer that could not go back puts the offset at the end
            table = read_u64(&mut file, SeekFrom::End(-8)).ok_or_else(damaged)?.cast_signed();
        }
        let Ok(table) = u64::try_from(table) else { return Err(damaged()) };
        let version_and_count = read_u64(&mut file, SeekFrom::Start(table)).ok_or_else(damaged)?;
        // each chunk begins with an uncompressed point of at least 20 bytes
        if version_and_count >> 32 > length / 20 {
            return Err(damaged());
        }
    }
    Ok(())
}

fn read_u64(file: &mut File, at: SeekFrom) -> Option<u64> {
    let mut bytes = [0; 8];
    file.seek(at).ok()?;
    file.read_exact(&mut bytes).ok()?;
    Some(u64::from_le_bytes(bytes))
}
