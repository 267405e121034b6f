//! The header of a LAS or LAZ file and its variable-length records, checked against the size of the file.
//!
//! The las crate allocates the length that the header claims; here every length is compared with the size of the file
//! first.

use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use belvedere_data::{Error, GpsTimeKind, Result};

/// Part of the header that is needed to read the points.
pub(crate) struct LasHeader {
    pub(crate) version: (u8, u8),
    /// Point format without the compression bits.
    pub(crate) format: u8,
    pub(crate) compressed: bool,
    pub(crate) record_length: u16,
    pub(crate) points_start: u64,
    /// Byte behind the points: the first of the next record, or the end of the file.
    pub(crate) points_end: u64,
    /// Points the header promises.
    pub(crate) points: u64,
    pub(crate) scale: [f64; 3],
    pub(crate) offset: [f64; 3],
    /// Minimum and maximum x, y and z that the header gives.
    pub(crate) bounds: [[f64; 2]; 3],
    /// Global encoding bit 0.
    pub(crate) adjusted_gps_time: bool,
    /// Global encoding bit 3.
    pub(crate) has_synthetic_returns: bool,
    /// Global encoding bit 4.
    pub(crate) has_wkt: bool,
    /// True if the system is that of the WKT record, by its bit and as required for point formats from 6 on.
    pub(crate) wkt_decides: bool,
    pub(crate) file_source: u16,
    pub(crate) identifier: [u8; 16],
    pub(crate) system: [u8; 32],
    /// True if the numbers of points in the old and the new field differ.
    pub(crate) counts_differ: bool,
    /// True if Belvedere wrote the file.
    pub(crate) is_of_belvedere: bool,
    pub(crate) records: Vec<VariableRecord>,
    /// Bytes of the file that hold the hierarchy of a COPC file.
    pub(crate) copc_pages: Option<Range<u64>>,
    /// Records that could not be read whole.
    pub(crate) broken_records: usize,
}

/// A variable-length record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct VariableRecord {
    pub(crate) user: String,
    pub(crate) id: u16,
    pub(crate) description: String,
    /// True if it stands behind the points.
    pub(crate) is_extended: bool,
    /// Empty where it is larger than is of interest.
    pub(crate) data: Vec<u8>,
    /// Bytes that it has in the file; of some records the data are not read.
    length: u64,
}

/// User of the records of COPC.
pub(crate) const COPC: &str = "copc";

/// Selection of records that are read with their data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RecordSize {
    /// Records as large as the definition of a reference system, at most a megabyte.
    OfReferenceSystems,
    /// All that the file holds.
    Any,
}

impl RecordSize {
    fn max_bytes(self) -> u64 {
        if self == Self::Any { u64::MAX } else { 1 << 20 }
    }
}

impl LasHeader {
    /// Epoch of GPS times that the header states.
    pub(crate) fn gps_time_kind(&self) -> GpsTimeKind {
        if self.adjusted_gps_time { GpsTimeKind::AdjustedStandard } else { GpsTimeKind::SecondsOfWeek }
    }

    /// The middle of the bounds on the map, in the unit of the file.
    pub(crate) fn middle(&self) -> [f64; 2] {
        [0, 1].map(|axis| f64::midpoint(self.bounds[axis][0], self.bounds[axis][1]))
    }

    /// Data of the first record with this user and number.
    pub(crate) fn record(&self, user: &str, id: u16) -> Option<&[u8]> {
        let is_wanted = |r: &&VariableRecord| r.id == id && r.user == user && !r.data.is_empty();
        self.records.iter().find(is_wanted).map(|record| record.data.as_slice())
    }

    /// Data of all records with this user and number.
    pub(crate) fn records<'a>(&'a self, user: &'a str, id: u16) -> impl Iterator<Item = &'a [u8]> {
        let is_wanted = move |r: &&VariableRecord| r.id == id && r.user == user && !r.data.is_empty();
        self.records.iter().filter(is_wanted).map(|r| r.data.as_slice())
    }
}

/// Reads the header of a file of `size` bytes, and its records up to a size.
pub(crate) fn read_header(
    path: &Path,
    file: &mut (impl Read + Seek),
    size: u64,
    size_of_records: RecordSize,
) -> Result<LasHeader> {
    let mut bytes = Vec::new();
    file.take(375).read_to_end(&mut bytes).map_err(Error::io(path))?;
    if bytes.get(..4) != Some(b"LASF") {
        return Err(Error::malformed(path, "is not a LAS file: it does not begin with LASF"));
    }
    let fields = HeaderFields { path, bytes: &bytes };
    let version = (fields.u8(24)?, fields.u8(25)?);
    if version.0 != 1 || version.1 > 4 {
        let what = format!("has LAS version {}.{}; 1.0 to 1.4 are read", version.0, version.1);
        return Err(Error::malformed(path, what));
    }
    let header_size = u64::from(fields.u16(94)?);
    let points_start = u64::from(fields.u32(96)?);
    let record_count = fields.u32(100)?;
    let legacy_points = u64::from(fields.u32(107)?);
    let long_points = if version.1 >= 4 && header_size >= 375 { fields.u64(247)? } else { 0 };
    let format = fields.u8(104)?;
    let encoding = if version.1 >= 2 { fields.u16(6)? } else { 0 };
    let waveforms = if version.1 >= 3 && header_size >= 235 { fields.u64(227)? } else { 0 };
    let extended = if version.1 >= 4 && header_size >= 375 && fields.u32(243)? > 0 { fields.u64(235)? } else { 0 };
    let behind = [waveforms, extended].into_iter().filter(|&byte| byte >= points_start);
    let mut header = LasHeader {
        points_end: behind.fold(size, u64::min),
        is_of_belvedere: bytes.get(58..90).is_some_and(|name| name.starts_with(b"belvedere\0")),
        version,
        format: format & 0x3f,
        compressed: format & 0xc0 != 0,
        record_length: fields.u16(105)?,
        points_start,
        points: if long_points == 0 { legacy_points } else { long_points },
        scale: [fields.f64(131)?, fields.f64(139)?, fields.f64(147)?],
        offset: [fields.f64(155)?, fields.f64(163)?, fields.f64(171)?],
        bounds: [
            [fields.f64(187)?, fields.f64(179)?],
            [fields.f64(203)?, fields.f64(195)?],
            [fields.f64(219)?, fields.f64(211)?],
        ],
        adjusted_gps_time: encoding & 1 != 0,
        has_synthetic_returns: encoding & 1 << 3 != 0,
        has_wkt: encoding & 1 << 4 != 0,
        wkt_decides: version.1 >= 4 && (encoding & 1 << 4 != 0 || format & 0x3f >= 6),
        file_source: if version.1 >= 1 { fields.u16(4)? } else { 0 },
        identifier: fields.array(8)?,
        system: fields.array(26)?,
        counts_differ: legacy_points != 0 && long_points != 0 && legacy_points != long_points,
        records: Vec::new(),
        copc_pages: None,
        broken_records: 0,
    };
    check(path, &header, header_size, size)?;
    let wanted = (Length::Short, size_of_records);
    read_records(path, file, &mut header, wanted, header_size..points_start, record_count)?;
    if version.1 >= 4 && header_size >= 375 {
        let (start, count) = (fields.u64(235)?, fields.u32(243)?);
        read_records(path, file, &mut header, (Length::Long, size_of_records), start..size, count)?;
    }
    Ok(header)
}

/// Refuses coordinates that cannot be computed, and points that do not lie behind the header of a file of `size` bytes.
fn check(path: &Path, header: &LasHeader, header_size: u64, size: u64) -> Result<()> {
    let points_start = header.points_start;
    if header.scale.iter().any(|s| !s.is_finite() || *s == 0.0) || header.offset.iter().any(|o| !o.is_finite()) {
        let what = format!("has unusable coordinate scales {:?} or offsets {:?}", header.scale, header.offset);
        return Err(Error::malformed(path, what));
    }
    if header_size < 227 || points_start < header_size || points_start > size {
        let what = format!("has its points at byte {points_start} of {size}; the file is cut off or damaged");
        return Err(Error::malformed(path, what));
    }
    Ok(())
}

/// Reads up to `count` records that lie in the bytes of `range`, until one is broken.
fn read_records(
    path: &Path,
    file: &mut (impl Read + Seek),
    header: &mut LasHeader,
    (length, size_of_records): (Length, RecordSize),
    range: Range<u64>,
    count: u32,
) -> Result<()> {
    let mut position = range.start;
    for _ in 0..count {
        let is_extended = length == Length::Long;
        if is_extended && (position < header.points_start || position >= range.end) {
            header.broken_records += 1;
            break;
        }
        file.seek(SeekFrom::Start(position)).map_err(Error::io(path))?;
        match read_record(file, length, range.end - position, size_of_records).map_err(Error::io(path))? {
            Some((record, length)) => {
                position += length;
                if is_extended && record.user == COPC && record.id == 1000 {
                    header.copc_pages = Some(position - record.length..position);
                }
                header.records.extend(Some(record).filter(|record| record.length == record.data.len() as u64));
            }
            None => {
                header.broken_records += 1;
                break;
            }
        }
    }
    Ok(())
}

#[derive(Clone, Copy, PartialEq)]
enum Length {
    Short,
    Long,
}

/// The next record, without its data where it is too large to be of interest, and its length; `None` where `room` bytes
/// do not hold it.
fn read_record(
    file: &mut impl Read,
    length: Length,
    room: u64,
    size_of_records: RecordSize,
) -> std::io::Result<Option<(VariableRecord, u64)>> {
    let head_length: u64 = if length == Length::Short { 54 } else { 60 };
    let mut head = Vec::new();
    file.take(head_length.min(room)).read_to_end(&mut head)?;
    let Some(mut record) = record_head(&head, length) else { return Ok(None) };
    let Some(total) = head_length.checked_add(record.length).filter(|&total| total <= room) else { return Ok(None) };
    // the hierarchy of a COPC file is read page by page where it is needed
    if record.length > size_of_records.max_bytes() || record.is_extended && record.user == COPC {
        return Ok(Some((record, total)));
    }
    file.take(record.length).read_to_end(&mut record.data)?;
    let is_whole = record.data.len() as u64 == record.length;
    Ok(is_whole.then_some((record, total)))
}

/// A record without its data; `None` for a head that is cut off.
fn record_head(head: &[u8], length: Length) -> Option<VariableRecord> {
    // writers leave what was in their memory behind the end of a name
    let name = |bytes: &[u8]| bytes.split(|&byte| byte == 0).next().unwrap_or_default().to_vec();
    let text = |bytes: &[u8]| String::from_utf8_lossy(&name(bytes)).trim_end_matches(' ').to_owned();
    let user = text(head.get(2..18)?);
    let id = u16::from_le_bytes(*head.get(18..)?.first_chunk()?);
    let (length_of_data, description) = match length {
        Length::Short => (u64::from(u16::from_le_bytes(*head.get(20..)?.first_chunk()?)), head.get(22..54)),
        Length::Long => (u64::from_le_bytes(*head.get(20..)?.first_chunk()?), head.get(28..60)),
    };
    let description = text(description.unwrap_or_default());
    let is_extended = length == Length::Long;
    Some(VariableRecord { user, id, description, is_extended, data: Vec::new(), length: length_of_data })
}

/// Little-endian fields of the fixed part.
struct HeaderFields<'a> {
    path: &'a Path,
    bytes: &'a [u8],
}

impl HeaderFields<'_> {
    fn array<const N: usize>(&self, at: usize) -> Result<[u8; N]> {
        self.bytes
            .get(at..)
            .and_then(|rest| rest.first_chunk())
            .copied()
            .ok_or_else(|| Error::malformed(self.path, "ends within the LAS header"))
    }

    fn u8(&self, at: usize) -> Result<u8> {
        Ok(self.array::<1>(at)?[0])
    }

    fn u16(&self, at: usize) -> Result<u16> {
        Ok(u16::from_le_bytes(self.array(at)?))
    }

    fn u32(&self, at: usize) -> Result<u32> {
        Ok(u32::from_le_bytes(self.array(at)?))
    }

    fn u64(&self, at: usize) -> Result<u64> {
        Ok(u64::from_le_bytes(self.array(at)?))
    }

    fn f64(&self, at: usize) -> Result<f64> {
        Ok(f64::from_le_bytes(self.array(at)?))
    }
}
