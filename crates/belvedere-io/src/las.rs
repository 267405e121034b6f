//! LAS 1.0 to 1.4 and LAZ (also COPC, whose points are read in file order), all point formats.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use ::las::point::Format;
use ::las::{PointData, PointDataBuilder, Transform, Vector};

use super::las_columns::Columns;
use super::las_extra::{ExtraField, find_columns, find_extra_normals};
use super::las_header::{LasHeader, read_header};
use super::laz::{ExtraBytes, LazReader, is_chunked};
use super::part::{Part, guarded, open};
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::{Error, Result};

/// Raw records of about this many points lie in memory beside the decoded columns.
const BATCH: u64 = 1_000_000;

/// Scales this fine are used for degrees, not for metres.
const DEGREE_SCALE: f64 = 1.000_001e-6;

/// A LAS or LAZ file whose header has been checked.
pub(super) struct LasFile<'a> {
    path: &'a Path,
    file: BufReader<File>,
    size: u64,
    pub(super) header: LasHeader,
    format: Format,
}

impl<'a> LasFile<'a> {
    pub(super) fn open(path: &'a Path) -> Result<Self> {
        let (mut file, size) = open(path)?;
        let header = read_header(path, &mut file, size)?;
        let format = point_format(path, &header)?;
        Ok(Self { path, file, size, header, format })
    }

    /// The extra columns of these names, `None` for those the file lacks.
    pub(super) fn columns<const N: usize>(&self, names: [&str; N]) -> [Option<ExtraField>; N] {
        find_columns(&self.header, &self.format, names)
    }

    /// Points that the file really holds of those its header announces; a LAZ file is checked when it is decompressed.
    pub(super) fn points_in_file(&self) -> u64 {
        if self.header.compressed {
            return self.header.points;
        }
        let room = self.size.saturating_sub(self.header.points_start) / u64::from(self.header.record_length).max(1);
        self.header.points.min(room)
    }

    /// Decodes the points in file order and hands them to `take`, many at a time.
    pub(super) fn for_each_batch(self, extra: ExtraBytes, mut take: impl FnMut(&PointData)) -> Result<()> {
        let points = self.points_in_file();
        let Self { path, mut file, size, header, format } = self;
        let transform = |i: usize| Transform { scale: header.scale[i], offset: header.offset[i] };
        let transforms = Vector { x: transform(0), y: transform(1), z: transform(2) };
        let mut batch = PointDataBuilder::new().with_format(format).with_transforms(transforms).build();
        // Without points there need be no chunk table either.
        if header.compressed && points > 0 {
            let mut reader = LazReader::new(path, file, &header, size, extra)?;
            while reader.next_batch(BATCH, |points| batch.resize_for(points))? > 0 {
                take(&batch);
            }
        } else if !header.compressed {
            file.seek(SeekFrom::Start(header.points_start)).map_err(Error::io(path))?;
            let mut left = points;
            while left > 0 {
                let points = left.min(BATCH);
                let room = batch.resize_for(usize::try_from(points).unwrap_or(0));
                file.read_exact(room).map_err(Error::io(path))?;
                take(&batch);
                left -= points;
            }
        }
        Ok(())
    }
}

/// The points of the file at `path`; `forced` stands in for the system the file names.
pub(super) fn read(path: &Path, forced: Option<&Crs>) -> Result<Part> {
    let mut source = LasFile::open(path)?;
    let header = &source.header;
    let mut part = Part::new(path, describe(path, header));
    if header.counts_differ {
        part.note(format!("the two point counts of the header differ; {} is used", header.points));
    }
    if header.broken_records > 0 {
        part.note("a variable-length record is cut off; it and those after it are passed over");
    }
    if forced.is_none() {
        find_crs(&mut part, header);
    }
    let crs = forced.unwrap_or(&part.crs);
    let somewhere = header.first_point(path, &mut source.file)?;
    if let Some(what) = crs.refusal(somewhere).or_else(|| unnamed_degrees(crs, header, somewhere)) {
        return Err(Error::UnusableCrs { path: path.to_owned(), what });
    }

    let normals = find_extra_normals(&mut part, header, &source.format);
    let extra = if normals.is_some() { ExtraBytes::Decompress } else { ExtraBytes::Skip };
    let (announced, present) = (header.points, source.points_in_file());
    if announced > present {
        part.note(format!("the header announces {announced} points, but the file holds only {present}"));
        let missing = usize::try_from(announced - present).unwrap_or(usize::MAX);
        part.leave_out(missing, "announced by the header but not in the file");
    }
    // No more is reserved than the size of the file makes likely; columns grow where that is too little.
    let capacity = usize::try_from(announced.min(source.size)).unwrap_or(0);
    let mut columns = Columns::new(&source.format, header, normals, capacity);
    source.for_each_batch(extra, |batch| columns.append(batch))?;
    (part.coordinates, part.attributes) = columns.finish();
    Ok(part)
}

fn describe(path: &Path, header: &LasHeader) -> String {
    let (major, minor) = header.version;
    let copc = header.record("copc", 1).is_some();
    let kind = match (header.compressed, copc) {
        (true, true) => ", LAZ (COPC)",
        (true, false) => ", LAZ",
        _ if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("laz")) => ", not compressed",
        _ => "",
    };
    format!("LAS {major}.{minor}, point format {}{kind}", header.format)
}

fn point_format(path: &Path, header: &LasHeader) -> Result<Format> {
    let mut format = Format::new(header.format)
        .map_err(|_| Error::malformed(path, format!("has point format {}, which is not known", header.format)))?;
    let extra = header.record_length.checked_sub(format.len()).ok_or_else(|| {
        let what = format!(
            "has records of {} bytes, but point format {} needs {}",
            header.record_length,
            header.format,
            format.len()
        );
        Error::malformed(path, what)
    })?;
    format.extra_bytes = extra;
    if header.compressed && !header.record("laszip encoded", 22204).is_none_or(is_chunked) {
        return Err(Error::malformed(
            path,
            "is compressed as one single chunk, as only the first LAZ writers did; rewrite it, for example with: \
             pdal translate IN.laz OUT.laz",
        ));
    }
    Ok(format)
}

/// Takes the system from a WKT record, or else from GeoTIFF keys.
fn find_crs(part: &mut Part, header: &LasHeader) {
    const USER: &str = "LASF_Projection";
    let mut unread = false;
    for (user, source) in [(USER, "WKT record"), ("liblas", "WKT record of libLAS")] {
        for record in header.records(user, 2112) {
            let text = String::from_utf8_lossy(record);
            let text = text.trim_matches(|c: char| c == '\0' || c.is_whitespace());
            // The text is the file's; parsing it must not bring the reader down.
            match guarded(&part.report.path, || Crs::parse(text)) {
                Ok(crs) => return part.set_crs(crs, source),
                Err(_) => unread |= !text.is_empty(),
            }
        }
        if let Some(crs) = header.record(USER, 34735).and_then(Crs::from_geotiff_keys) {
            return part.set_crs(crs, "GeoTIFF keys");
        }
    }
    part.note(if unread {
        "its WKT record is not understood: coordinates are taken as metres"
    } else {
        "it names no reference system: coordinates are taken as metres"
    });
}

/// A file without a system whose scale and offset speak of degrees.
fn unnamed_degrees(crs: &Crs, header: &LasHeader, somewhere: [f64; 3]) -> Option<String> {
    let [x, y, _] = somewhere;
    let fine = header.scale[0].abs() <= DEGREE_SCALE && header.scale[1].abs() <= DEGREE_SCALE;
    // A metric scan that begins at its own origin is small too; degrees of a real place are hardly within 1 of (0, 0).
    let in_range = x.abs() <= 180.0 && y.abs() <= 90.0 && (x.abs() >= 1.0 || y.abs() >= 1.0);
    let coarser_height = header.scale[2].abs() >= 100.0 * header.scale[0].abs();
    if crs.kind != CrsKind::Unknown || !fine || !in_range || !coarser_height {
        return None;
    }
    Crs { kind: CrsKind::Geographic, ..Crs::default() }.refusal(somewhere).map(|what| {
        format!("names no reference system, but its scale of {} and its values say that {what}", header.scale[0])
    })
}

impl LasHeader {
    /// The first point where it can be seen without decompressing (which is also where every LAZ chunk begins).
    fn first_point(&self, path: &Path, file: &mut (impl Read + Seek)) -> Result<[f64; 3]> {
        let skip = if self.compressed { 8 } else { 0 };
        file.seek(SeekFrom::Start(self.points_start + skip)).map_err(Error::io(path))?;
        let mut raw = [0_u8; 12];
        if file.read_exact(&mut raw).is_err() {
            return Ok(self.offset);
        }
        let values = raw.as_chunks::<4>().0;
        Ok(std::array::from_fn(|i| f64::from(i32::from_le_bytes(values[i])) * self.scale[i] + self.offset[i]))
    }
}
