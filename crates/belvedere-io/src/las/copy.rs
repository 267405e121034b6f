//! The records of the LAS files that a cloud comes from, copied with columns of results: fields that a cloud has no
//! place for stay unchanged.

use std::path::Path;

use ::las::point::Format;
use ::las::{Builder, PointData, PointDataBuilder, Transform, Vector, Vlr};
use rayon::prelude::*;

use crate::files::source::Source;
use crate::las::columns::LasColumns;
use crate::las::extra::{ExtraDescription, descriptions};
use crate::las::header::{LasHeader, RecordSize, VariableRecord};
use crate::las::laz::LazFields;
use crate::las::records;
use crate::las::results::result_columns;
use crate::las::system::find_crs;
use crate::las::{Batches, LasFile};
use crate::points::columns::Column;
use crate::points::coordinates::Coordinates;
use crate::points::file_part::FilePart;
use belvedere_data::cast::to_i32;
use belvedere_data::cloud::{Attributes, to_local};
use belvedere_data::{Error, FileRows, PointCloud, Result};

/// Maximum distance between a record and its point, in steps of an f32 at the place of the point and steps of the file.
const ROUNDING_STEPS: f64 = 4.0;
/// Bytes of the fields that all points of formats 0 to 5, and of formats 6 to 10, have.
const SHORT_FIELDS: usize = 20;
const LONG_FIELDS: usize = 30;

/// Conversion of the records of some files into records of one.
pub(crate) struct RecordCopy<'a> {
    cloud: &'a PointCloud,
    files: Vec<CopiedFile<'a>>,
    /// Format of the copies, with the extra bytes that are kept, and those of results.
    format: Format,
    transforms: Vector<Transform>,
    /// Extra bytes that are kept, with their place in a copy.
    extra: Vec<ExtraDescription>,
    /// Fields of the files that the copies lack, in words.
    lost: Vec<String>,
    /// True if all files have times of one kind.
    keeps_times: bool,
}

/// A file whose records are copied.
struct CopiedFile<'a> {
    path: &'a Path,
    /// Number of its points.
    row_count: u64,
    header: LasHeader,
    format: Format,
    /// Position of the extra bytes that are kept, in the order of [`RecordCopy::extra`].
    extra_at: Vec<usize>,
}

impl<'a> RecordCopy<'a> {
    /// Creates the copy of the records that the points of `cloud` come from, with room for `columns`. `None` if these
    /// are no LAS files, are gone, or if the rows of the points are not known.
    pub(crate) fn of(cloud: &'a PointCloud, columns: &[Column<'_>]) -> Option<Self> {
        let rows_are_known = match &cloud.files.rows {
            FileRows::All => cloud.files.files.iter().map(|file| file.row_count).sum::<u64>() == cloud.len() as u64,
            FileRows::Of(rows) => rows.len() == cloud.len() && rows.windows(2).all(|pair| pair[0] < pair[1]),
            FileRows::Unknown => false,
        };
        if !rows_are_known || cloud.files.files.is_empty() {
            return None;
        }
        let open = |path: &'a Path| {
            let source = Source::path(path);
            let is_las = matches!(source.extension().as_str(), "las" | "laz");
            is_las.then(|| LasFile::open_with(source.open().ok()?, RecordSize::Any).ok()).flatten()
        };
        let mut files = Vec::new();
        for of_cloud in &cloud.files.files {
            let (path, row_count) = (of_cloud.path.as_path(), of_cloud.row_count);
            let file = open(path).filter(|file| file.points_in_file() == row_count)?;
            let (header, format) = file.into_header();
            files.push(CopiedFile { path, row_count, header, format, extra_at: Vec::new() });
        }
        let first = files.first()?;
        let transforms = transforms_of(&first.header);
        let format = first.format;
        let mut copy =
            Self { cloud, files, format, transforms, extra: Vec::new(), lost: Vec::new(), keeps_times: true };
        copy.choose_format();
        copy.choose_transforms();
        copy.choose_extra(columns);
        Some(copy)
    }

    /// Fields that all files have.
    fn choose_format(&mut self) {
        let formats: Vec<Format> = self.files.iter().map(|file| file.format).collect();
        let all = |has: &dyn Fn(&Format) -> bool| formats.iter().all(has);
        let any = |has: &dyn Fn(&Format) -> bool| formats.iter().any(has);
        let same_times =
            self.files.windows(2).all(|pair| pair[0].header.adjusted_gps_time == pair[1].header.adjusted_gps_time);
        let has_times = all(&|format| format.has_gps_time) && same_times;
        let has_color = all(&|format| format.has_color);
        let has_nir = all(&|format| format.has_nir);
        let losses = [
            ("GPS times", any(&|format| format.has_gps_time) && !has_times),
            ("colours", any(&|format| format.has_color) && !has_color),
            ("near infrared", any(&|format| format.has_nir) && !has_nir),
            ("waveforms", any(&|format| format.has_waveform)),
        ];
        self.lost.extend(losses.into_iter().filter(|(_, is_lost)| *is_lost).map(|(name, _)| name.to_owned()));
        let is_extended = any(&|format| format.is_extended);
        self.keeps_times = has_times;
        self.format.is_extended = is_extended;
        // points of formats 6 and up always have a field for the time
        self.format.has_gps_time = has_times || is_extended;
        self.format.has_color = has_color;
        self.format.has_nir = has_nir;
        self.format.has_waveform = false;
    }

    /// The finest steps of all files, as far as coordinates in them fit 32 bits.
    fn choose_transforms(&mut self) {
        let all: Vec<Vector<Transform>> = self.files.iter().map(|file| transforms_of(&file.header)).collect();
        if all.windows(2).all(|pair| pair[0] == pair[1]) {
            return;
        }
        let chosen = |axis: usize| {
            let of = |transforms: &Vector<Transform>| [transforms.x, transforms.y, transforms.z][axis];
            let offset = all.first().map_or(0.0, |first| of(first).offset);
            let finest = all.iter().map(|transforms| of(transforms).scale.abs()).fold(f64::INFINITY, f64::min);
            let bounds = self.files.iter().flat_map(|file| file.header.bounds[axis]);
            let reach = bounds.map(|bound| (bound - offset).abs()).fold(0.0, f64::max);
            let mut scale = finest;
            while reach / scale > f64::from(i32::MAX) {
                scale *= 10.0;
            }
            (Transform { scale, offset }, scale > finest)
        };
        let [(x, coarse_x), (y, coarse_y), (z, coarse_z)] = [0, 1, 2].map(chosen);
        self.transforms = Vector { x, y, z };
        if coarse_x || coarse_y || coarse_z {
            self.lost.push("the finest steps of coordinates".to_owned());
        }
    }

    /// Extra bytes that all files describe in the same way, except those whose name one of `columns` has.
    fn choose_extra(&mut self, columns: &[Column<'_>]) {
        let described: Vec<Vec<ExtraDescription>> =
            self.files.iter().map(|file| describe_extra_bytes(&file.header, &file.format)).collect();
        let Some(of_first) = described.first() else { return };
        let is_one = described.len() == 1;
        let mut at = base_length(&self.format);
        let mut kept_names = Vec::new();
        for own in of_first {
            let name = own.name();
            let is_replaced = columns.iter().any(|column| column.name.eq_ignore_ascii_case(&name));
            let places: Option<Vec<usize>> =
                described.iter().map(|others| others.iter().find(|other| is_same(own, other)).map(|o| o.at)).collect();
            let Some(places) = places.filter(|_| !is_replaced) else { continue };
            self.files.iter_mut().zip(places).for_each(|(file, at)| file.extra_at.push(at));
            let mut bytes = own.bytes;
            if !is_one {
                // lowest and highest values are those of one file
                bytes[3] &= if bytes[2] == 0 { !0 } else { !0b110 };
                bytes[64..112].fill(0);
            }
            self.extra.push(ExtraDescription { bytes, at, size: own.size });
            at += own.size;
            kept_names.push(name);
        }
        let mut names: Vec<String> = described.iter().flatten().map(ExtraDescription::name).collect();
        names.sort();
        names.dedup();
        for name in names.into_iter().filter(|name| !kept_names.contains(name)) {
            let is_replaced = columns.iter().any(|column| column.name.eq_ignore_ascii_case(&name));
            self.lost.push(if is_replaced { format!("the earlier values of {name}") } else { name });
        }
    }

    /// Bytes of a copy before the columns of results.
    pub(crate) fn length(&self) -> usize {
        base_length(&self.format) + self.extra.iter().map(|extra| extra.size).sum::<usize>()
    }

    /// Returns the fields of the files that the copies lack, in words.
    pub(crate) fn lost_fields(self) -> Vec<String> {
        self.lost
    }

    /// A header like those of the files, with the records that all of them have, and the names of results among the
    /// columns of files that Belvedere wrote.
    pub(crate) fn builder(&mut self) -> Result<(Builder, Vec<String>)> {
        let Some(first) = self.files.first() else {
            return Err(Error::NoPoints { what: "there is no file to copy records from".to_owned() });
        };
        let header = &first.header;
        let raw = ::las::raw::Header {
            file_source_id: header.file_source,
            guid: header.identifier,
            ..::las::raw::Header::default()
        };
        let mut builder =
            Builder::new(raw).map_err(|e| Error::malformed(first.path, format!("cannot be copied: {e}")))?;
        builder.version = (1, 4).into();
        builder.system_identifier = String::from_utf8_lossy(&header.system)
            .trim_end_matches(['\0', ' '])
            .chars()
            .map(|c| if c.is_ascii() && c != '\0' { c } else { '?' })
            .collect();
        builder.has_synthetic_return_numbers = header.has_synthetic_returns;
        builder.point_format = self.format;
        builder.point_format.extra_bytes = 0;
        builder.transforms = self.transforms;
        let mut lost = Vec::new();
        let is_in_all = |record: &&VariableRecord| self.files.iter().all(|file| file.header.records.contains(record));
        for file in &self.files {
            let of_file = records::kept_records(&file.header).filter(|record| !is_in_all(record));
            lost.extend(of_file.map(records::in_words));
        }
        for record in records::kept_records(header).filter(is_in_all) {
            let records = if record.is_extended { &mut builder.evlrs } else { &mut builder.vlrs };
            records.push(records::to_vlr(record));
        }
        let has_copc = self.files.iter().any(|file| file.header.record("copc", 1).is_some());
        lost.extend(has_copc.then(|| "the index of COPC".to_owned()));
        lost.sort();
        lost.dedup();
        self.add_projection(&mut builder);
        let results = self.results();
        self.lost.extend(lost);
        Ok((builder, results))
    }

    /// Copies the records about the reference system from the first file that has that of the cloud.
    fn add_projection(&self, builder: &mut Builder) {
        for CopiedFile { path, header, .. } in &self.files {
            let mut part = FilePart::new(path, "");
            find_crs(&mut part, header, None, header.middle());
            if part.crs != self.cloud.frame.crs {
                continue;
            }
            let records = header.records.iter().filter(|record| records::is_projection(record));
            for record in records {
                let records = if record.is_extended { &mut builder.evlrs } else { &mut builder.vlrs };
                records.push(records::to_vlr(record));
            }
            builder.has_wkt_crs = header.has_wkt;
            return;
        }
    }

    /// Columns of results among the extra bytes that are kept.
    fn results(&self) -> Vec<String> {
        let of_first = self.files.first().map(|first| result_columns(&first.header, &first.format)).unwrap_or_default();
        let is_result = |name: &String| of_first.iter().any(|(result, _)| result == name);
        self.extra.iter().map(ExtraDescription::name).filter(is_result).collect()
    }

    /// Descriptions of the extra bytes that are kept.
    pub(crate) fn extra_descriptions(&self) -> impl Iterator<Item = [u8; 192]> {
        self.extra.iter().map(|extra| extra.bytes)
    }

    /// The copies of the points, in their order.
    pub(crate) fn records<'c>(&'c self, columns: &'c [Column<'c>]) -> CopiedRecords<'c, 'a> {
        CopiedRecords { copy: self, columns, file: 0, open: None, next: 0, file_start: 0, batch_start: 0 }
    }
}

/// The copies as they are made, many at a time.
pub(crate) struct CopiedRecords<'c, 'a> {
    copy: &'c RecordCopy<'a>,
    columns: &'c [Column<'c>],
    /// Number of the file that is read, and its points.
    file: usize,
    open: Option<Batches<'a>>,
    /// First point of the cloud that is not copied yet.
    next: usize,
    /// Row, counted over all files, of the first point of the file and of the next batch.
    file_start: u64,
    batch_start: u64,
}

impl CopiedRecords<'_, '_> {
    /// The next records of the format and the steps of `header`, or `None` at the end.
    ///
    /// # Errors
    /// [`Error::Malformed`] where a record is not that of its point.
    pub(crate) fn next(&mut self, header: &::las::Header) -> Result<Option<PointData>> {
        while let Some(file) = self.copy.files.get(self.file) {
            let batches = match &mut self.open {
                Some(batches) => batches,
                none => {
                    let opened = LasFile::open(Source::path(file.path).open()?)?;
                    none.insert(opened.batches(LazFields::All)?)
                }
            };
            let Some(batch) = batches.next()? else {
                self.open = None;
                self.file += 1;
                self.file_start += file.row_count;
                self.batch_start = self.file_start;
                continue;
            };
            let rows = self.batch_start..self.batch_start + batch.len() as u64;
            let first = self.next;
            let count = match &self.copy.cloud.files.rows {
                FileRows::Of(all) => all.get(first..).unwrap_or_default().partition_point(|&row| row < rows.end),
                _ => batch.len(),
            };
            let chosen: Vec<usize> = (first..first + count)
                .map(|point| match &self.copy.cloud.files.rows {
                    FileRows::Of(all) => all.get(point).map_or(0, |row| row - rows.start),
                    _ => (point - first) as u64,
                })
                .map(|row| usize::try_from(row).unwrap_or(usize::MAX))
                .collect();
            self.copy.check(file, batch, &chosen, first)?;
            let mut slab = PointDataBuilder::new().for_header(header).build();
            let length = slab.record_len();
            let records = batch.raw_bytes();
            let own_length = batch.record_len();
            slab.resize_for(count).par_chunks_mut(length.max(1)).zip(&chosen).enumerate().for_each(
                |(i, (out, &row))| {
                    let record = records.get(row * own_length..(row + 1) * own_length).unwrap_or_default();
                    self.copy.encode(file, (record, first + i), out);
                    let mut at = self.copy.length();
                    for column in self.columns {
                        column.values.put(first + i, &mut out[at..]);
                        at += column.values.width();
                    }
                },
            );
            self.batch_start = rows.end;
            self.next += count;
            if count > 0 {
                return Ok(Some(slab));
            }
        }
        Ok(None)
    }
}

impl RecordCopy<'_> {
    /// Compares the `chosen` records of a batch with the points of the cloud from `first` on.
    fn check(&self, file: &CopiedFile<'_>, batch: &PointData, chosen: &[usize], first: usize) -> Result<()> {
        let changed = || Error::malformed(file.path, "has other points than when it was read");
        let header = &file.header;
        let mut columns = LasColumns::new(&file.format, header.scale, header.offset, None, 0);
        columns.append(batch);
        let (coordinates, attributes, _) = columns.finish();
        let indices: Option<Vec<u32>> = chosen.iter().map(|&row| u32::try_from(row).ok()).collect();
        let indices = indices.filter(|_| chosen.iter().all(|&row| row < batch.len())).ok_or_else(changed)?;
        let points = first..first + chosen.len();
        let same_places = self.are_at(header.scale, &coordinates.select(&indices), points.clone());
        let same_attributes = is_equal(&attributes.select(&indices), &self.cloud.attributes, points);
        if same_places && same_attributes { Ok(()) } else { Err(changed()) }
    }

    fn are_at(&self, scale: [f64; 3], coordinates: &Coordinates, points: std::ops::Range<usize>) -> bool {
        let (frame, units) = (&self.cloud.frame, self.cloud.frame.crs.metres_per_unit_xyz());
        let positions = self.cloud.positions.get(points).unwrap_or_default();
        coordinates.positions().zip(positions).all(|(place, position)| {
            let local = to_local([0, 1, 2].map(|i| place[i] * units[i]), frame.origin);
            (0..3).all(|i| {
                let room = f64::from(position[i].abs()) * f64::from(f32::EPSILON) + (scale[i] * units[i]).abs();
                f64::from((local[i] - position[i]).abs()) <= ROUNDING_STEPS * room
            })
        })
    }

    /// Fills a copy with all of a record, that of a point of the cloud, but the columns of results. The GPS time is
    /// that of the cloud, whose epoch the header states.
    fn encode(&self, file: &CopiedFile<'_>, (record, point): (&[u8], usize), out: &mut [u8]) {
        let from = file.format;
        self.encode_place(file, record, out);
        let fields = if from.is_extended { LONG_FIELDS } else { SHORT_FIELDS };
        let (Some(head), true) = (record.get(..fields), out.len() >= self.length()) else { return };
        let mut time_at = LONG_FIELDS - 8;
        if from.is_extended == self.format.is_extended {
            out[12..fields].copy_from_slice(&head[12..]);
        } else {
            widen(head, out);
        }
        if !self.format.is_extended {
            time_at = SHORT_FIELDS;
        }
        let own_time_at = if from.is_extended { LONG_FIELDS - 8 } else { SHORT_FIELDS };
        if self.format.has_gps_time {
            let known = self.cloud.attributes.gps_time.as_ref().and_then(|times| times.get(point));
            let own = || record.get(own_time_at..)?.first_chunk::<8>().copied();
            let time = known.map(|time| time.to_le_bytes()).or_else(own).filter(|_| self.keeps_times);
            out[time_at..time_at + 8].copy_from_slice(&time.unwrap_or_default());
        }
        let mut copy = |from: usize, to: usize, length: usize| {
            if let Some(bytes) = record.get(from..from + length) {
                out[to..to + length].copy_from_slice(bytes);
            }
        };
        if self.format.has_color {
            copy(color_at(&from), color_at(&self.format), 6);
        }
        if self.format.has_nir {
            copy(color_at(&from) + 6, color_at(&self.format) + 6, 2);
        }
        for (extra, &at) in self.extra.iter().zip(&file.extra_at) {
            copy(at, extra.at, extra.size);
        }
    }

    /// Fills the coordinates of a copy, which are those of the file where its steps are.
    fn encode_place(&self, file: &CopiedFile<'_>, record: &[u8], out: &mut [u8]) {
        let own = transforms_of(&file.header);
        let of = |transforms: &Vector<Transform>, axis: usize| [transforms.x, transforms.y, transforms.z][axis];
        for axis in 0..3 {
            let Some(&bytes) = record.get(axis * 4..).and_then(|rest| rest.first_chunk::<4>()) else { return };
            let (from, to) = (of(&own, axis), of(&self.transforms, axis));
            let value = if from == to {
                bytes
            } else {
                let place = f64::from(i32::from_le_bytes(bytes)) * from.scale + from.offset;
                to_i32(((place - to.offset) / to.scale).round()).to_le_bytes()
            };
            out[axis * 4..axis * 4 + 4].copy_from_slice(&value);
        }
    }
}

/// Returns true if GPS times are the same, or are those of a reader that brought them to another epoch. All that are
/// not zero then differ by one number of whole seconds.
fn are_same_times(own: &[f64], of_cloud: &[f64]) -> bool {
    let pairs = || own.iter().zip(of_cloud);
    let is_same = |(a, b): &(&f64, &f64)| a.to_bits() == b.to_bits();
    let shift = pairs().find(|pair| !is_same(pair)).map_or(0.0, |(a, b)| (b - a).round());
    own.len() == of_cloud.len()
        && pairs().all(|(a, b)| is_same(&(a, b)) && (shift == 0.0 || *a == 0.0) || (a + shift).to_bits() == b.to_bits())
}

/// Returns true if the attributes that both have are the same: `own` those of records, `of_cloud` those of its
/// `points`.
fn is_equal(own: &Attributes, of_cloud: &Attributes, points: std::ops::Range<usize>) -> bool {
    fn same<T: PartialEq>(own: Option<&Vec<T>>, all: Option<&Vec<T>>, points: &std::ops::Range<usize>) -> bool {
        match (own, all) {
            (Some(own), Some(all)) => all.get(points.clone()).is_some_and(|all| all == own.as_slice()),
            _ => true,
        }
    }
    let same_times = match (&own.gps_time, &of_cloud.gps_time) {
        (Some(own), Some(all)) => all.get(points.clone()).is_some_and(|all| are_same_times(own, all)),
        _ => true,
    };
    // readers widen 8-bit colours
    let same_color = match (&own.color, &of_cloud.color) {
        (Some(own), Some(all)) => all.get(points.clone()).is_some_and(|all| {
            let pairs = || all.as_flattened().iter().zip(own.as_flattened());
            pairs().all(|(a, b)| a == b) || pairs().all(|(&a, &b)| a == b.saturating_mul(257))
        }),
        _ => true,
    };
    same_color
        && same_times
        && same(own.classification.as_ref(), of_cloud.classification.as_ref(), &points)
        && same(own.return_number.as_ref(), of_cloud.return_number.as_ref(), &points)
        && same(own.return_count.as_ref(), of_cloud.return_count.as_ref(), &points)
        && same(own.scan_angle.as_ref(), of_cloud.scan_angle.as_ref(), &points)
        && same(own.point_source_id.as_ref(), of_cloud.point_source_id.as_ref(), &points)
        && same(own.scanner_channel.as_ref(), of_cloud.scanner_channel.as_ref(), &points)
        && same(own.flags.as_ref(), of_cloud.flags.as_ref(), &points)
        && same(own.intensity.as_ref(), of_cloud.intensity.as_ref(), &points)
}

/// The fields of a record of formats 0 to 5, from the intensity on, as those of formats 6 to 10.
fn widen(record: &[u8], out: &mut [u8]) {
    let (returns, class) = (record[14], record[15]);
    out[12..14].copy_from_slice(&record[12..14]);
    out[14] = returns & 7 | (returns >> 3 & 7) << 4;
    // class 12 is what the later formats have a flag for
    let overlap = u8::from(class & 0x1f == 12) << 3;
    out[15] = class >> 5 | overlap | returns & 0b1100_0000;
    out[16] = class & 0x1f;
    out[17] = record[17];
    let degrees = f64::from(i8::from_le_bytes([record[16]]));
    out[18..20].copy_from_slice(&scan_steps(degrees).to_le_bytes());
    out[20..22].copy_from_slice(&record[18..20]);
}

/// Bytes of the fields of a point without waveforms and extra bytes.
fn base_length(format: &Format) -> usize {
    color_at(format) + if format.has_color { 6 } else { 0 } + if format.has_nir { 2 } else { 0 }
}

/// Returns the byte at which the colour of a point begins, or would.
fn color_at(format: &Format) -> usize {
    match (format.is_extended, format.has_gps_time) {
        (true, _) => LONG_FIELDS,
        (false, true) => SHORT_FIELDS + 8,
        (false, false) => SHORT_FIELDS,
    }
}

fn transforms_of(header: &LasHeader) -> Vector<Transform> {
    let transform = |i: usize| Transform { scale: header.scale[i], offset: header.offset[i] };
    Vector { x: transform(0), y: transform(1), z: transform(2) }
}

/// The extra bytes of a file, those without a description among them; none where the descriptions do not fit.
fn describe_extra_bytes(header: &LasHeader, format: &Format) -> Vec<ExtraDescription> {
    let mut found = descriptions(header, format);
    let room = usize::from(format.extra_bytes);
    let mut used: usize = found.iter().map(|extra| extra.size).sum();
    if used > room {
        return Vec::new();
    }
    let start = usize::from(format.len()) - room;
    while used < room {
        let size = (room - used).min(usize::from(u8::MAX));
        let mut bytes = [0; 192];
        bytes[3] = u8::try_from(size).unwrap_or(u8::MAX);
        let name = format!("undescribed_{used}");
        bytes[4..4 + name.len()].copy_from_slice(name.as_bytes());
        found.push(ExtraDescription { bytes, at: start + used, size });
        used += size;
    }
    found
}

/// Returns true if two files describe extra bytes in the same way: type, name, and scaling of values.
fn is_same(a: &ExtraDescription, b: &ExtraDescription) -> bool {
    // options of lowest and highest values differ from file to file
    let options = |extra: &ExtraDescription| extra.bytes[3] & if extra.bytes[2] == 0 { !0 } else { !0b110 };
    a.bytes[2] == b.bytes[2]
        && options(a) == options(b)
        && a.name() == b.name()
        && a.bytes[112..160] == b.bytes[112..160]
}

/// The record that names columns of results.
pub(crate) fn results_record(names: &[String]) -> Vlr {
    let (user, record_id) = records::RESULTS;
    let description = "columns of results".to_owned();
    Vlr { user_id: user.to_owned(), record_id, description, data: names.join("\n").into_bytes() }
}

/// Degrees per step of the scan angle of point formats 6 and up (LAS 1.4 R15, table 17).
const DEGREES_PER_SCAN_STEP: f64 = 0.006;

/// Returns the steps of a scan angle, degrees, of point formats 6 and up.
#[expect(clippy::cast_possible_truncation, reason = "clamped to the range of i16")]
pub(crate) fn scan_steps(angle: f64) -> i16 {
    (angle / DEGREES_PER_SCAN_STEP).round().clamp(-30000.0, 30000.0) as i16
}
