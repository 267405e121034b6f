//! Balls as LAS and LAZ point clouds with extra bytes.

use std::fs::File;
use std::io::BufReader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use las::{Header, LazParallelism, Reader, ReaderOptions, Vlr};

use super::{FileBall, as_cloud, fill, metadata};
use crate::io::balls::SavedBalls;
use crate::io::write_cloud::extension;
use crate::io::{las_guard, write_las};
use crate::{Error, Result};

/// Identity of the record that holds the metadata.
const RECORD_USER: &str = "belvedere";
const RECORD_ID: u16 = 1;
/// Bytes decoded at a time: headers may promise anything.
const BLOCK_BYTES: usize = 1 << 24;

pub(crate) fn write_las(path: &Path, balls: &SavedBalls) -> Result<()> {
    let (cloud, columns) = as_cloud(balls);
    let record = Vlr {
        user_id: RECORD_USER.to_owned(),
        record_id: RECORD_ID,
        description: "medial balls".to_owned(),
        data: metadata::to_json(balls, "file units, radians; origin in metres").into_bytes(),
    };
    let compression = if extension(path) == "laz" { write_las::Compression::Laz } else { write_las::Compression::None };
    write_las::write(path, &cloud, &columns, compression, &[record]).map(|_| ())
}

pub(crate) fn read_las(path: &Path) -> Result<SavedBalls> {
    las_guard::check_promises(path)?;
    let file = BufReader::new(File::open(path).map_err(Error::io(path))?);
    // the decompressor may panic on damaged input
    catch_unwind(AssertUnwindSafe(|| decode(path, file)))
        .unwrap_or_else(|_| Err(Error::malformed(path, "the compressed points are damaged")))
}

fn decode(path: &Path, file: BufReader<File>) -> Result<SavedBalls> {
    let malformed = |e: las::Error| Error::malformed(path, format!("not a readable LAS file: {e}"));
    // one thread reads straight on, whereas many trust the chunk table with allocations
    let options = ReaderOptions::default().with_laz_parallelism(LazParallelism::No);
    let mut reader = Reader::with_options(file, options).map_err(malformed)?;
    let Some(fields) = Fields::of(reader.header()) else {
        return Err(Error::malformed(path, "holds no balls; it needs the extra bytes radius and touch"));
    };
    let record = reader.header().all_vlrs().find(|v| v.user_id == RECORD_USER && v.record_id == RECORD_ID);
    let (balls, origin) = metadata::from_json(&record.map_or_else(String::new, |v| lossy(&v.data)));
    let total = reader.header().number_of_points();
    let mut rows = Vec::new();
    loop {
        let record_bytes = usize::from(reader.header().point_format().len()).max(1);
        let block = reader.read_points((BLOCK_BYTES / record_bytes).max(1) as u64).map_err(malformed)?;
        if block.is_empty() {
            break;
        }
        let records = block.raw_bytes().chunks_exact(block.record_len());
        for (((x, y), z), record) in block.x().zip(block.y()).zip(block.z()).zip(records) {
            rows.push(fields.ball([x, y, z], record));
        }
    }
    if rows.len() as u64 != total {
        return Err(Error::malformed(path, format!("ends after {} of {total} balls", rows.len())));
    }
    Ok(fill(balls, origin, &rows))
}

pub(crate) fn las_has_balls(path: &Path) -> bool {
    if las_guard::check_promises(path).is_err() {
        return false;
    }
    let Ok(file) = File::open(path) else { return false };
    catch_unwind(AssertUnwindSafe(|| Header::new(BufReader::new(file)).is_ok_and(|h| Fields::of(&h).is_some())))
        .unwrap_or(false)
}

fn lossy(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim_end_matches('\0').to_owned()
}

/// Type and place of an extra byte column within a record.
#[derive(Clone, Copy)]
struct Field {
    kind: u8,
    at: usize,
}

struct Fields {
    radius: Field,
    touch: Field,
    separation_angle: Option<Field>,
    source: Option<Field>,
}

impl Fields {
    /// The columns of a ball file, or `None` where radius or touch is missing.
    fn of(header: &Header) -> Option<Self> {
        let format = header.point_format();
        let mut at = usize::from(format.len().checked_sub(format.extra_bytes)?);
        let end = usize::from(format.len());
        let descriptors = header.all_vlrs().find(|v| v.user_id == "LASF_Spec" && v.record_id == 4)?;
        let mut fields = Vec::new();
        for descriptor in descriptors.data.as_chunks::<192>().0 {
            let kind = descriptor[2];
            let width = match kind {
                0 => usize::from(descriptor[3]),
                1 | 2 => 1,
                3 | 4 => 2,
                5 | 6 | 9 => 4,
                7 | 8 | 10 => 8,
                _ => return None,
            };
            if at + width <= end {
                let name = lossy(&descriptor[4..36]);
                fields.push((name.split('\0').next().unwrap_or_default().to_owned(), Field { kind, at }));
            }
            at += width;
        }
        let find = |name: &str| fields.iter().find(|(n, _)| n == name).map(|&(_, field)| field);
        Some(Self {
            radius: find("radius")?,
            touch: find("touch")?,
            separation_angle: find("separation_angle"),
            source: find("source"),
        })
    }

    #[expect(clippy::cast_possible_truncation, reason = "angles are f32 in memory")]
    fn ball(&self, center: [f64; 3], record: &[u8]) -> FileBall {
        FileBall {
            center,
            radius: number(record, self.radius),
            separation_angle: self.separation_angle.map_or(f32::NAN, |f| number(record, f) as f32),
            source: self.source.map_or(u32::MAX, |f| index(record, f)),
            touch: index(record, self.touch),
        }
    }
}

fn bytes<const N: usize>(record: &[u8], at: usize) -> [u8; N] {
    record.get(at..).and_then(<[u8]>::first_chunk).copied().unwrap_or([0; N])
}

/// NaN for types that hold no measurement.
fn number(record: &[u8], field: Field) -> f64 {
    match field.kind {
        9 => f64::from(f32::from_le_bytes(bytes(record, field.at))),
        10 => f64::from_le_bytes(bytes(record, field.at)),
        _ => f64::NAN,
    }
}

/// `u32::MAX`, no index, for types that hold none.
fn index(record: &[u8], field: Field) -> u32 {
    match field.kind {
        5 | 6 => u32::from_le_bytes(bytes(record, field.at)),
        _ => u32::MAX,
    }
}
