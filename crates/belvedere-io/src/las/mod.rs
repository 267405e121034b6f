//! LAS 1.0 to 1.4 and LAZ (also COPC), all point formats. Points come in the order of the file. Of a box only those
//! chunks of a COPC file are read that may hold points of it, and nothing of a file whose bounds do not meet it.

pub(crate) mod announced;
pub(crate) mod columns;
pub(crate) mod copc;
pub(crate) mod copy;
pub(crate) mod ept;
pub(crate) mod extra;
pub(crate) mod gps_epoch;
pub(crate) mod header;
pub(crate) mod laz;
pub(crate) mod octree;
pub(crate) mod records;
pub(crate) mod results;
pub(crate) mod system;
pub(crate) mod write_las;

use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::iter;
use std::ops::Range;
use std::path::{Path, PathBuf};

use ::las::point::Format;
use ::las::{PointData, PointDataBuilder, Transform, Vector};

use crate::files::source::{Input, Source, SourceReader, web_address};
use crate::las::announced::are_given;
use crate::las::columns::{LasColumns, UnreadFields};
use crate::las::copc::CopcNodes;
use crate::las::extra::{ExtraField, ExtraNormals, find_columns, find_extra_normals};
use crate::las::gps_epoch::GpsEpoch;
use crate::las::header::{COPC, LasHeader, RecordSize, read_header};
use crate::las::laz::{ChunkPlace, LazFields, LazReader, NeededChunks, is_chunked};
use crate::las::system::{find_crs, unnamed_degrees};
use crate::points::coordinates::Coordinates;
use crate::points::file_part::FilePart;
use crate::points::read_options::{FileBox, PassedOver, Reading, RowNumbers, Selection};
use belvedere_data::cloud::{Attributes, GpsTimeKind};
use belvedere_data::contradiction::{FoundContradiction, POINTS_NOT_COUNTED};
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// Points decoded at a time: some LAZ chunks of 50 000 for each of two dozen threads, and a tenth of a second of work.
const BATCH: u64 = 1_000_000;

/// Maximum distance of points outside the bounds of a header, in its unit: the rounding of programs.
const MIN_ROOM: f64 = 0.01;

/// A LAS or LAZ file whose header has been checked.
pub(crate) struct LasFile<'a> {
    name: PathBuf,
    reader: SourceReader<'a>,
    size: u64,
    pub(crate) header: LasHeader,
    pub(crate) format: Format,
}

impl<'a> LasFile<'a> {
    pub(crate) fn open(input: Input<'a>) -> Result<Self> {
        Self::open_with(input, RecordSize::OfReferenceSystems)
    }

    /// The same with all records of the header up to a size.
    pub(crate) fn open_with(input: Input<'a>, size_of_records: RecordSize) -> Result<Self> {
        let Input { name, mut reader, size } = input;
        let header = read_header(&name, &mut reader, size, size_of_records)?;
        let format = point_format(&name, &header)?;
        Ok(Self { name, reader, size, header, format })
    }

    /// Its header, and the format of its points.
    pub(crate) fn into_header(self) -> (LasHeader, Format) {
        (self.header, self.format)
    }

    /// The extra columns of these names, `None` for those the file lacks.
    pub(crate) fn columns<const N: usize>(&self, names: [&str; N]) -> [Option<ExtraField>; N] {
        find_columns(&self.header, &self.format, names)
    }

    /// Points that the file really holds of those its header announces; a LAZ file is checked when it is decompressed.
    pub(crate) fn points_in_file(&self) -> u64 {
        if self.header.compressed {
            return self.header.points;
        }
        let room = self.size.saturating_sub(self.header.points_start) / u64::from(self.header.record_length).max(1);
        self.header.points.min(room)
    }

    /// Points that the file holds beyond those that its header counts: a writer that was interrupted did not come to
    /// correct the count. Not looked for on web servers.
    fn uncounted(&mut self) -> Result<Option<FoundContradiction>> {
        if web_address(&self.name).is_some() {
            return Ok(None);
        }
        let Self { name, reader, size, header, .. } = self;
        let (counted, start, length) = (header.points, header.points_start, u64::from(header.record_length).max(1));
        let beyond = if header.compressed {
            laz::chunks_beyond(name, reader, header, *size).unwrap_or(0)
        } else {
            let room = header.points_end.saturating_sub(start) / length;
            let mut next = vec![0; usize::from(header.record_length)];
            let byte = start.saturating_add(counted.saturating_mul(length));
            let is_record = room > counted && {
                reader.seek(SeekFrom::Start(byte)).map_err(Error::io(name))?;
                // room that a writer reserved holds zeros
                reader.read_exact(&mut next).is_ok() && next.iter().any(|&v| v != 0)
            };
            if is_record { room - counted } else { 0 }
        };
        let things = if header.compressed { "chunks of points" } else { "points" };
        let text = || {
            format!(
                "the header counts {counted} points, but {beyond} more {things} follow in the file: its writer was interrupted; write the file again, for example with PDAL, or repair its header"
            )
        };
        let found = || POINTS_NOT_COUNTED.found(text()).with("counted", counted as f64).with("beyond", beyond as f64);
        Ok((beyond > 0).then(found))
    }

    /// All points in file order, many at a time.
    pub(crate) fn batches(self, extra: LazFields) -> Result<Batches<'a>> {
        let rows = iter::once(0..self.points_in_file());
        self.batches_of(extra, rows, None)
    }

    /// The chunks of COPC that may hold points of `wanted`, of all of its points without a box.
    fn copc_nodes(&mut self, wanted: Option<&FileBox>) -> Result<CopcNodes> {
        if !self.header.compressed || self.points_in_file() == 0 {
            return Ok(CopcNodes::None);
        }
        copc::nodes_within(&self.name, &mut self.reader, &self.header, self.size, wanted)
    }

    /// Notes a hierarchy that is not that of the points; on a web server that is not worth its transfer.
    fn check_hierarchy(&mut self, part: &mut FilePart) -> Result<()> {
        if web_address(&self.name).is_none()
            && let Some(note) = self.copc_nodes(None)?.note()
        {
            part.report.format = part.report.format.replace(" (COPC)", "");
            part.note(note);
        }
        Ok(())
    }

    /// Returns the points that may lie in `wanted`, many at a time in file order, the number skipped because they
    /// cannot, and a note. In COPC the hierarchy decides; in other files `rows`, if these are known.
    fn batches_within(
        mut self,
        extra: LazFields,
        wanted: &FileBox,
        rows: Option<Vec<Range<u64>>>,
    ) -> Result<(Batches<'a>, u64, Option<String>)> {
        let all = self.points_in_file();
        let bounds = self.header.bounds;
        let room = room(self.header.scale);
        let low = std::array::from_fn(|i| bounds[i][0] - room[i]);
        let high = std::array::from_fn(|i| bounds[i][1] + room[i]);
        if self.header.has_bounds() && !wanted.meets(low, high) {
            return Ok((self.batches_of(extra, iter::empty(), None)?, all, None));
        }
        let nodes = self.copc_nodes(Some(wanted))?;
        let note = nodes.note();
        let batches = match (nodes, rows) {
            (CopcNodes::Chunks(chunks), _) => {
                let within = chunks.iter().fold(0_u64, |sum, chunk| sum.saturating_add(chunk.points));
                self.batches_of(extra, iter::once(0..within), Some(chunks))?
            }
            (_, Some(rows)) => {
                self.batches_of(extra, rows.into_iter().map(|rows| rows.start..rows.end.min(all)), None)?
            }
            (_, None) => self.batches_of(extra, iter::once(0..all), None)?,
        };
        let left = batches.records.remaining();
        Ok((batches, all.saturating_sub(left), note))
    }

    /// The points of `rows`, ranges in their order; of LAZ whole chunks that hold such rows, or those at `places`.
    fn batches_of(
        self,
        extra: LazFields,
        rows: impl Iterator<Item = Range<u64>>,
        places: Option<Vec<ChunkPlace>>,
    ) -> Result<Batches<'a>> {
        let Self { name, reader, size, header, format } = self;
        let rows: VecDeque<Range<u64>> = rows.filter(|rows| !rows.is_empty()).collect();
        let transform = |i: usize| Transform { scale: header.scale[i], offset: header.offset[i] };
        let transforms = Vector { x: transform(0), y: transform(1), z: transform(2) };
        let batch = PointDataBuilder::new().with_format(format).with_transforms(transforms).build();
        // Without points there need be no chunk table either.
        let records = if header.compressed && !rows.is_empty() {
            let wanted = places.map_or_else(|| NeededChunks::Rows(rows.into()), NeededChunks::Places);
            Records::Laz(Box::new(LazReader::new(&name, reader, &header, size, extra, wanted)?))
        } else {
            let (start, length) = (header.points_start, u64::from(header.record_length));
            Records::Plain { reader, start, length, rows, next: None }
        };
        Ok(Batches { name, batch, records })
    }
}

/// The points of a file, decoded many at a time.
pub(crate) struct Batches<'a> {
    name: PathBuf,
    batch: PointData,
    records: Records<'a>,
}

enum Records<'a> {
    Plain {
        reader: SourceReader<'a>,
        /// Byte of the first point, and bytes of each.
        start: u64,
        length: u64,
        rows: VecDeque<Range<u64>>,
        /// Row that the reader stands at; `None` before the first.
        next: Option<u64>,
    },
    Laz(Box<LazReader<'a>>),
}

impl Records<'_> {
    /// Points that are still to come.
    fn remaining(&self) -> u64 {
        match self {
            Self::Plain { rows, .. } => rows.iter().fold(0, |sum, rows| sum.saturating_add(rows.end - rows.start)),
            Self::Laz(reader) => reader.remaining(),
        }
    }
}

impl Batches<'_> {
    /// The next points, or `None` after the last.
    pub(crate) fn next(&mut self) -> Result<Option<&PointData>> {
        let Self { name, batch, records } = self;
        match records {
            Records::Laz(reader) => {
                if reader.next_batch(name, BATCH, |points| batch.resize_for(points))? == 0 {
                    return Ok(None);
                }
            }
            Records::Plain { reader, start, length, rows, next } => {
                let Some(first) = rows.front_mut() else { return Ok(None) };
                let piece = first.start..first.end.min(first.start.saturating_add(BATCH));
                first.start = piece.end;
                if first.is_empty() {
                    rows.pop_front();
                }
                if *next != Some(piece.start) {
                    let byte = start.saturating_add(piece.start.saturating_mul(*length));
                    reader.seek(SeekFrom::Start(byte)).map_err(Error::io(name))?;
                }
                *next = Some(piece.end);
                let room = batch.resize_for(usize::try_from(piece.end - piece.start).unwrap_or(0));
                reader.read_exact(room).map_err(Error::io(name))?;
            }
        }
        Ok(Some(batch))
    }
}

/// The points of the source that `reading` requests.
pub(crate) fn read(source: Source<'_>, reading: &Reading<'_>) -> Result<FilePart> {
    let (mut part, mut points) = open(source, reading)?;
    // No more is reserved than the size of the file makes likely; columns grow where that is too little.
    let capacity = if points.selection.is_some() { 0 } else { usize::try_from(points.likely).unwrap_or(0) };
    let mut columns = points.columns(capacity);
    if points.selection.is_none() {
        while let Some(batch) = points.batches.next()? {
            columns.append(batch);
            reading.control.advance(batch.len());
            reading.control.check()?;
        }
        let unread;
        (part.coordinates, part.attributes, unread) = columns.finish();
        points.gps_epoch.apply(&mut part.attributes);
        points.gps_epoch.contradictions().for_each(|found| part.contradict(found));
        part.other_attributes.extend(unread.in_words());
        return check_bounds(part, points.bounds, points.scale);
    }
    (part.coordinates, part.attributes, _) = columns.finish();
    // of a box whole pieces of the file may be passed over, so that its rows are not counted
    part.rows = part.row_count.map(|_| Vec::new());
    while let Some(batch) = points.next(reading)? {
        let count = part.coordinates.len();
        let added = batch.coordinates.len();
        part.attributes.append(count, batch.attributes, added);
        part.coordinates.append(batch.coordinates);
        if let Some(rows) = &mut part.rows {
            rows.extend(batch.rows);
        }
    }
    points.gps_epoch.contradictions().for_each(|found| part.contradict(found));
    part.leave_out_passed(points.passed_over);
    part.other_attributes.extend(points.unread.in_words());
    check_bounds(part, points.bounds, points.scale)
}

/// Returns the maximum distance of points with coordinates in steps of `scale` outside the bounds of their header.
fn room(scale: [f64; 3]) -> [f64; 3] {
    scale.map(|scale| (10.0 * scale.abs()).max(MIN_ROOM))
}

/// Compares the points of a file with the bounds of its header, which follow from the same scale and offset. Notes
/// points outside, and refuses a file with all points outside.
fn check_bounds(mut part: FilePart, bounds: [[f64; 2]; 3], scale: [f64; 3]) -> Result<FilePart> {
    let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    let mut outside = 0_usize;
    let room = room(scale);
    for place in part.coordinates.positions() {
        for (own, &v) in found.iter_mut().zip(&place) {
            *own = [own[0].min(v), own[1].max(v)];
        }
        let is_in = |i: usize| (bounds[i][0] - room[i]..=bounds[i][1] + room[i]).contains(&place[i]);
        outside += usize::from(!(0..3).all(is_in));
    }
    let count = part.coordinates.len();
    if !are_given(&bounds) || count == 0 || outside == 0 {
        return Ok(part);
    }
    let ranges = |bounds: [[f64; 2]; 3]| bounds.map(|[low, high]| format!("{low:.2} to {high:.2}")).join(", ");
    let what = format!(
        "{outside} of {count} points are outside the bounds of the header ({}): they lie in {}",
        ranges(bounds),
        ranges(found)
    );
    if outside == count {
        return Err(Error::malformed(
            &part.report.path,
            format!("{what}; its scale, its offset or its bounds are wrong"),
        ));
    }
    part.note(what);
    Ok(part)
}

/// The points of a source, batch by batch, and the properties known of all of them.
pub(crate) fn open<'a>(mut source: Source<'a>, reading: &Reading<'_>) -> Result<(FilePart, LasPoints<'a>)> {
    let rows = source.likely_rows.take();
    let (beside, announced) = (source.system_beside(), source.announced.take());
    let mut source = LasFile::open(source.open()?)?;
    let path = source.name.clone();
    let uncounted = source.uncounted()?;
    let header = &source.header;
    let mut part = FilePart::new(&path, describe(&path, header));
    let found = announced.iter().flat_map(|announced| announced.contradictions(header)).chain(uncounted);
    found.for_each(|found| part.contradict(found));
    if header.counts_differ {
        part.note(format!("the two point counts of the header differ; {} is used", header.points));
    }
    if header.broken_records > 0 {
        part.note("a variable-length record is cut off; it and the following records are ignored");
    }
    let somewhere = header.first_point(&path, &mut source.reader)?;
    part.somewhere = (header.points > 0).then_some(somewhere);
    find_crs(&mut part, header, beside, [somewhere[0], somewhere[1]]);
    if header.points > 0 {
        reading.check_given(&part.crs, [somewhere[0], somewhere[1]], &path)?;
    }
    let crs = &reading.system(&part.crs);
    if let Some(what) = crs.refusal(somewhere).or_else(|| unnamed_degrees(crs, header, somewhere)) {
        return Err(Error::UnusableCrs { path, what });
    }
    let normals = find_extra_normals(&mut part, header, &source.format);
    let extra = if normals.is_some() { LazFields::AttributesAndExtraBytes } else { LazFields::Attributes };
    part.other_attributes.extend(records::other_attributes(header, &source.format));
    part.records.extend(records::kept_records(header).map(records::in_words));
    let (announced, present) = (header.points, source.points_in_file());
    if announced > present {
        part.note(format!("the header announces {announced} points, but the file holds only {present}"));
        part.leave_out_missing(announced - present);
    }
    // a window looks at the hierarchy itself
    if reading.options.within.is_none() {
        source.check_hierarchy(&mut part)?;
    }
    let header = &source.header;
    let selection = reading.selection(&part.crs);
    // rows are counted in whole files
    let wanted = selection.as_ref().filter(|_| reading.options.row_numbers == RowNumbers::Dropped);
    let wanted = wanted.and_then(Selection::file_box);
    let (likely, format, scale, offset) = (announced.min(source.size), source.format, header.scale, header.offset);
    let (bounds, gps_epoch) = (header.bounds, GpsEpoch::new(header.gps_time_kind(), reading.options.flown));
    let mut passed_over = PassedOver::default();
    let batches = match wanted {
        Some(wanted) => {
            let (batches, outside, note) = source.batches_within(extra, &wanted, rows)?;
            passed_over.count_outside(outside);
            part.report.notes.extend(note);
            batches
        }
        None => {
            part.row_count = Some(present);
            source.batches(extra)?
        }
    };
    let points = LasPoints {
        likely,
        format,
        scale,
        offset,
        bounds,
        gps_epoch,
        normals,
        selection,
        passed_over,
        unread: UnreadFields::default(),
        next_row: 0,
        batches,
    };
    Ok((part, points))
}

/// The points of one source, batch by batch.
pub(crate) struct LasPoints<'a> {
    batches: Batches<'a>,
    format: Format,
    scale: [f64; 3],
    offset: [f64; 3],
    bounds: [[f64; 2]; 3],
    gps_epoch: GpsEpoch,
    normals: Option<ExtraNormals>,
    selection: Option<Selection>,
    /// Number of points that the header and the size of the file make likely.
    likely: u64,
    passed_over: PassedOver,
    unread: UnreadFields,
    next_row: u64,
}

/// Some points of a source.
pub(crate) struct SomePoints {
    pub(crate) coordinates: Coordinates,
    pub(crate) attributes: Attributes,
    /// Row of each point in the file.
    pub(crate) rows: Vec<u64>,
}

impl LasPoints<'_> {
    fn columns(&self, capacity: usize) -> LasColumns {
        LasColumns::new(&self.format, self.scale, self.offset, self.normals, capacity)
    }

    /// The next points that `reading` requests, possibly none of a batch, or `None` at the end.
    pub(crate) fn next(&mut self, reading: &Reading<'_>) -> Result<Option<SomePoints>> {
        reading.control.check()?;
        let mut columns = self.columns(0);
        let Some(batch) = self.batches.next()? else { return Ok(None) };
        columns.append(batch);
        let count = batch.len();
        reading.control.advance(count);
        let first_row = self.next_row;
        self.next_row += count as u64;
        let (coordinates, mut attributes, unread) = columns.finish();
        self.gps_epoch.apply(&mut attributes);
        self.unread.add(unread);
        let Some(selection) = &self.selection else {
            return Ok(Some(SomePoints { coordinates, attributes, rows: (first_row..self.next_row).collect() }));
        };
        let kept = selection.select(&coordinates, &attributes, &mut self.passed_over)?;
        Ok(Some(SomePoints {
            coordinates: coordinates.select(&kept),
            attributes: attributes.select(&kept),
            rows: kept.iter().map(|&index| first_row + u64::from(index)).collect(),
        }))
    }
}

fn describe(path: &Path, header: &LasHeader) -> String {
    let (major, minor) = header.version;
    let copc = header.record(COPC, 1).is_some();
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
            "is compressed as a single chunk, an old variant of LAZ; rewrite it, for example with: pdal translate IN.laz OUT.laz",
        ));
    }
    Ok(format)
}

impl LasHeader {
    /// The first point where it can be seen without decompressing (which is also where every LAZ chunk begins).
    fn first_point(&self, path: &Path, file: &mut (impl Read + Seek)) -> Result<[f64; 3]> {
        let skip = if self.compressed { 8 } else { 0 };
        file.seek(SeekFrom::Start(self.points_start + skip)).map_err(Error::io(path))?;
        let mut raw = [0_u8; 12];
        match file.read_exact(&mut raw) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(self.offset),
            Err(error) => return Err(Error::io(path)(error)),
        }
        let values = raw.as_chunks::<4>().0;
        Ok(std::array::from_fn(|i| f64::from(i32::from_le_bytes(values[i])) * self.scale[i] + self.offset[i]))
    }
}

/// Description of the points in the header of a LAS or LAZ file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LasHead {
    /// Number of points.
    pub points: u64,
    /// Points that the header announces but the file lacks: it is cut off. Of a LAZ file this is known when its points
    /// are read.
    pub missing_points: u64,
    /// Size of the file, bytes.
    pub bytes: u64,
    /// Lowest and highest corner of the points, in the coordinates of the file.
    pub bounds: [[f64; 3]; 2],
    /// Reference system; of kind unknown where the file names none.
    pub crs: Crs,
    /// Epoch of GPS times by the header; `None` for points without them.
    pub gps_times: Option<GpsTimeKind>,
    /// True if points name the channel of their scanner: point formats 6 to 10.
    pub has_channels: bool,
    /// Oddities of the file.
    pub notes: Vec<String>,
    /// Contradictions in it, and with the announcements of other files.
    pub contradictions: Vec<FoundContradiction>,
}

/// Reads the header of a LAS, LAZ or COPC file, without its points, and checks the hierarchy of COPC against them.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for a damaged header and for one without usable bounds.
pub fn read_las_head<'a>(source: impl Into<Source<'a>>) -> Result<LasHead> {
    let mut source = source.into();
    let (beside, announced) = (source.system_beside(), source.announced.take());
    let mut file = LasFile::open(source.open()?)?;
    let note = file.copc_nodes(None)?.note();
    let uncounted = file.uncounted()?;
    let header = &file.header;
    let bounds = header.bounds;
    if header.points > 0 && (!header.has_bounds() || !bounds.as_flattened().iter().all(|v| v.is_finite())) {
        return Err(Error::malformed(&file.name, "has no bounds in its header; write it again, for example with PDAL"));
    }
    let mut part = FilePart::new(&file.name, "");
    find_crs(&mut part, header, beside, header.middle());
    let kind = header.gps_time_kind();
    Ok(LasHead {
        points: file.points_in_file(),
        missing_points: header.points - file.points_in_file(),
        bytes: file.size,
        bounds: [0, 1].map(|end| std::array::from_fn(|axis| bounds[axis][end])),
        crs: part.crs,
        gps_times: file.format.has_gps_time.then_some(kind),
        has_channels: file.format.is_extended,
        notes: note.into_iter().collect(),
        contradictions: announced.iter().flat_map(|own| own.contradictions(header)).chain(uncounted).collect(),
    })
}
