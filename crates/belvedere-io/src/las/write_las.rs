//! LAS 1.4 and LAZ point clouds.

use std::io::{self, BufWriter, Cursor, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use las::{Builder, GpsTimeType, PointData, PointDataBuilder, Transform, Vector, Vlr};
use rayon::prelude::*;

use crate::files::atomic;
use crate::files::output::{Output, WriteSeek};
use crate::files::source;
use crate::las::copy::{RecordCopy, results_record, scan_steps};
use crate::points::columns::{Column, ColumnValues};
use crate::points::columns::{WriteReport, not_in_cloud};
use belvedere_data::Bounds;
use belvedere_data::cast::to_i32;
use belvedere_data::cloud::GpsTimeKind;
use belvedere_data::crs::text;
use belvedere_data::{CloudFile, Error, Parameter, PointCloud, Result};

/// Points encoded at a time: many LAZ chunks of 50 000, so that all threads compress, yet little memory.
const POINTS_PER_SLAB: usize = 1 << 20;
/// Names of the columns that readers look for normals in.
const NORMALS: [&str; 3] = ["NormalX", "NormalY", "NormalZ"];
/// Maximum number of letters of the name of a column.
const MAX_NAME: usize = 31;
/// Coarsest step between coordinates, metres.
const MAX_STEP: f64 = 0.001;

/// Writes `cloud` with its attributes, `extra` columns as extra bytes, and `records` as further variable length
/// records; compressed where the extension is `laz`.
///
/// If the points come from LAS files, their records are copied with the columns as further extra bytes. Otherwise
/// attributes beyond the standard fields (normals, scanner index) become extra bytes. If the cloud has no return
/// numbers, each point is the only return of its pulse and the file marks these numbers as synthetic.
pub(crate) fn write(
    output: Output<'_>,
    cloud: &PointCloud,
    extra: &[Column<'_>],
    records: &[Vlr],
) -> Result<WriteReport> {
    let name = output.name().to_owned();
    let Some(mut copy) = RecordCopy::of(cloud, extra) else { return write_anew(output, cloud, extra, records) };
    let (mut builder, earlier_results) = copy.builder()?;
    builder.gps_time_type = gps_time_type(cloud);
    builder.vlrs.extend_from_slice(records);
    if builder.point_format.is_extended && !builder.vlrs.iter().chain(&builder.evlrs).any(|r| r.record_id == 2112) {
        builder.vlrs.extend(crs_records(cloud));
    }
    let kept: Vec<[u8; 192]> = copy.extra_descriptions().collect();
    // the newest first: programs show the first
    let results = extra.iter().map(|column| column.name.chars().take(MAX_NAME).collect()).chain(earlier_results);
    let results: Vec<String> = results.collect();
    let length = copy.length();
    let header = finished(&name, builder, (&output.extension(), length), &kept, extra, &results)?;
    let mut copied = copy.records(extra);
    let mut has_changed = false;
    let mut next = |header: &las::Header| {
        let next = copied.next(header);
        has_changed |= next.is_err();
        next
    };
    match put(&output, header, &mut next) {
        Ok(bytes) => {
            hand_over(output, bytes)?;
            Ok(WriteReport { point_count: cloud.len(), left_out: copy.lost_fields(), clamped_count: 0 })
        }
        // the files are not those any more that were read: what is known of their points is written
        Err(_) if has_changed => write_anew(output, cloud, extra, records),
        Err(error) => Err(error),
    }
}

/// Writes the points and columns of `cloud`.
fn write_anew(output: Output<'_>, cloud: &PointCloud, extra: &[Column<'_>], records: &[Vlr]) -> Result<WriteReport> {
    let name = output.name().to_owned();
    let mut columns = extra.to_vec();
    if let Some(index) = &cloud.attributes.scanner_index {
        columns.push(Column {
            name: "scanner_index".into(),
            description: "scanner set-up, 65535 unknown".into(),
            values: ColumnValues::U16(index.into()),
        });
    }
    let has_normals = |column: &Column<'_>| column.name.eq_ignore_ascii_case(NORMALS[0]);
    if let Some(normals) = cloud.attributes.normals.as_ref().filter(|_| !extra.iter().any(has_normals)) {
        columns.extend(NORMALS.into_iter().enumerate().map(|(axis, name)| Column {
            name: name.into(),
            description: "unit normal".into(),
            values: ColumnValues::F32(normals.iter().map(|n| n[axis]).collect()),
        }));
    }
    let mut builder = Builder::from((1, 4));
    builder.point_format = las::point::Format::new(if cloud.attributes.color.is_some() { 7 } else { 6 })
        .map_err(|e| Error::malformed(&name, format!("cannot be written: {e}")))?;
    builder.system_identifier = "OTHER".to_owned();
    builder.gps_time_type = gps_time_type(cloud);
    builder.has_synthetic_return_numbers = cloud.attributes.return_number.is_none();
    builder.transforms = transforms(cloud);
    builder.vlrs.extend(crs_records(cloud));
    builder.vlrs.extend_from_slice(records);
    let length = usize::from(builder.point_format.len());
    let results: Vec<String> = extra.iter().map(|column| column.name.chars().take(MAX_NAME).collect()).collect();
    let header = finished(&name, builder, (&output.extension(), length), &[], &columns, &results)?;
    let mut encoder = Encoder { cloud, columns: &columns, transforms: *header.transforms(), next: 0, clamped_count: 0 };
    let mut next = |header: &las::Header| Ok(encoder.next(header));
    let bytes = put(&output, header, &mut next)?;
    hand_over(output, bytes)?;
    let of_las = |file: &CloudFile| matches!(source::extension(&file.path).as_str(), "las" | "laz");
    let mut left_out = not_in_cloud(cloud);
    if cloud.files.files.iter().any(of_las) {
        left_out.extend(cloud.files.files.iter().flat_map(|file| file.records.iter().cloned()));
        left_out.push("steps of coordinates and point format of the input".to_owned());
    }
    Ok(WriteReport { point_count: cloud.len(), left_out, clamped_count: encoder.clamped_count })
}

/// The header of a file whose points have `length` bytes before `columns`, with the descriptions of the extra bytes
/// among these and of the columns.
fn finished(
    name: &Path,
    mut builder: Builder,
    (extension, length): (&str, usize),
    kept: &[[u8; 192]],
    columns: &[Column<'_>],
    results: &[String],
) -> Result<las::Header> {
    builder.generating_software = "belvedere".to_owned();
    builder.point_format.is_compressed = extension == "laz";
    builder.point_format.extra_bytes = 0;
    let fields = usize::from(builder.point_format.len());
    let extra_bytes: usize = length.saturating_sub(fields) + columns.iter().map(|c| c.values.width()).sum::<usize>();
    builder.point_format.extra_bytes = u16::try_from(extra_bytes).unwrap_or(u16::MAX);
    // a record has its fields too
    if extra_bytes + fields > usize::from(u16::MAX) {
        let value = format!("{} in number", columns.len());
        return Err(Error::invalid(Parameter::ResultColumns, value, "few enough for 65535 bytes per point"));
    }
    if extra_bytes > 0 {
        builder.vlrs.push(Vlr {
            user_id: "LASF_Spec".to_owned(),
            record_id: 4,
            description: "extra bytes".to_owned(),
            data: kept.iter().copied().chain(columns.iter().map(descriptor)).flatten().collect(),
        });
    }
    if !results.is_empty() {
        builder.vlrs.push(results_record(results));
    }
    builder.into_header().map_err(|e| Error::malformed(name, format!("cannot be written: {e}")))
}

fn gps_time_type(cloud: &PointCloud) -> GpsTimeType {
    match cloud.attributes.gps_time_kind {
        GpsTimeKind::SecondsOfWeek => GpsTimeType::Week,
        GpsTimeKind::AdjustedStandard => GpsTimeType::Standard,
    }
}

/// The next points of a file with that header; `None` at the end.
type NextPoints<'n> = dyn FnMut(&las::Header) -> Result<Option<PointData>> + 'n;

/// Writes the file at a path. For another output, returns its bytes: the LAS writer wants to own what it writes to.
fn put(output: &Output<'_>, header: las::Header, next: &mut NextPoints<'_>) -> Result<Option<Vec<u8>>> {
    let name = output.name();
    if !output.is_path() {
        return encode(name, Cursor::new(Vec::new()), header, next).map(|bytes| Some(bytes.into_inner()));
    }
    atomic::write(name, |file| {
        let file = file.get_ref().try_clone().map_err(Error::io(name))?;
        encode(name, file, header, next).map(|_| None)
    })
}

/// Writes the bytes of [`put`].
fn hand_over(output: Output<'_>, bytes: Option<Vec<u8>>) -> Result<()> {
    let Some(bytes) = bytes else { return Ok(()) };
    output.write(|name, output| output.write_all(&bytes).map_err(Error::io(name)))
}

/// Writes header and points to `output`, and gives it back.
fn encode<W: WriteSeek + Send + Sync + 'static>(
    name: &Path,
    output: W,
    header: las::Header,
    next: &mut NextPoints<'_>,
) -> Result<W> {
    let las_error = |e: las::Error| Error::malformed(name, format!("cannot be written: {e}"));
    let failure = Arc::new(Mutex::new(None));
    let latched = Latched { inner: BufWriter::with_capacity(1 << 18, output), failure: Arc::clone(&failure) };
    let mut writer = las::Writer::new(latched, header).map_err(las_error)?;
    while let Some(points) = next(writer.header())? {
        writer.write_points(&points).map_err(las_error)?;
    }
    writer.close().map_err(las_error)?;
    let mut latched = writer.into_inner().map_err(las_error)?;
    latched.flush().map_err(Error::io(name))?;
    if let Some(error) = failure.lock().unwrap_or_else(PoisonError::into_inner).take() {
        return Err(Error::io(name)(error));
    }
    latched.inner.into_inner().map_err(|e| Error::io(name)(e.into_error()))
}

/// Writer that keeps its first error and ignores all further data. The LAS writer closes itself when it is dropped and
/// panics when that fails, as it would on a full disk.
struct Latched<W: Write> {
    inner: BufWriter<W>,
    failure: Arc<Mutex<Option<io::Error>>>,
}

impl<W: WriteSeek> Latched<W> {
    fn attempt<T>(&mut self, otherwise: T, action: impl FnOnce(&mut BufWriter<W>) -> io::Result<T>) -> T {
        let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        if failure.is_some() {
            return otherwise;
        }
        match action(&mut self.inner) {
            Ok(value) => value,
            Err(error) => {
                *failure = Some(error);
                otherwise
            }
        }
    }
}

impl<W: WriteSeek> Write for Latched<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(self.attempt(bytes.len(), |w| w.write_all(bytes).map(|()| bytes.len())))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.attempt((), BufWriter::flush);
        Ok(())
    }
}

impl<W: WriteSeek> Seek for Latched<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let otherwise = if let SeekFrom::Start(position) = to { position } else { 0 };
        Ok(self.attempt(otherwise, |w| w.seek(to)))
    }
}

/// Returns steps and offsets in the unit of the file. The step is a power of ten of at most a millimetre and at most a
/// millionth of the extent, so that small objects keep their detail. It is coarse enough for 32-bit integers.
fn transforms(cloud: &PointCloud) -> Vector<Transform> {
    let Bounds { low, high } = cloud.bounds().unwrap_or_default();
    let extent = (0..3).map(|i| f64::from(high[i]) - f64::from(low[i])).fold(0.0, f64::max);
    let reach = (0..3).map(|i| f64::from(high[i].abs().max(low[i].abs()))).fold(1e-6, f64::max);
    let units = cloud.frame.crs.metres_per_unit_xyz();
    let origin = cloud.frame.to_file_coordinates([0.0; 3]);
    let transform = |axis: usize| {
        let wanted = if extent > 0.0 { MAX_STEP.min(extent * 1e-6) } else { MAX_STEP } / units[axis];
        // half the range of i32, as the offset is rounded
        let needed = reach / units[axis] / f64::from(i32::MAX / 2);
        let exponent = (-12..=9).rev().find(|&e| power_of_ten(e) <= wanted * (1.0 + 1e-9)).unwrap_or(-12);
        let scale = (exponent..=12).map(power_of_ten).find(|&s| s >= needed).unwrap_or(1e12);
        Transform { scale, offset: origin[axis].round() }
    };
    Vector { x: transform(0), y: transform(1), z: transform(2) }
}

/// The double next to 10^`exponent`, which repeated multiplication would miss.
fn power_of_ten(exponent: i32) -> f64 {
    if exponent < 0 { 1.0 / 10.0_f64.powi(-exponent) } else { 10.0_f64.powi(exponent) }
}

fn crs_records(cloud: &PointCloud) -> Vec<Vlr> {
    let record = |record_id, description: &str, data| Vlr {
        user_id: "LASF_Projection".to_owned(),
        record_id,
        description: description.to_owned(),
        data,
    };
    if let Some(wkt) = text::wkt_line(&cloud.frame.crs) {
        let mut data = wkt.into_bytes();
        data.push(0);
        return vec![record(2112, "OGC coordinate system WKT", data)];
    }
    let Some(keys) = text::geo_keys(&cloud.frame.crs, text::KeyUse::Points) else { return Vec::new() };
    vec![record(34735, "GeoTIFF keys", keys.directory.iter().flat_map(|v| v.to_le_bytes()).collect())]
}

/// The 192 bytes that describe an extra column (LAS 1.4 R15, table 24).
fn descriptor(column: &Column<'_>) -> [u8; 192] {
    let mut bytes = [0; 192];
    bytes[2] = match column.values {
        ColumnValues::U8(_) => 1,
        ColumnValues::U16(_) => 3,
        ColumnValues::U32(_) => 5,
        ColumnValues::I32(_) => 6,
        ColumnValues::F32(_) | ColumnValues::Clock(_) => 9,
        ColumnValues::F64(_) => 10,
    };
    put_text(&mut bytes[4..36], &column.name);
    put_text(&mut bytes[160..192], &column.description);
    bytes
}

/// Text cut to the field so that a zero byte still ends it.
fn put_text(field: &mut [u8], text: &str) {
    let longest = field.len() - 1;
    for (slot, byte) in field[..longest].iter_mut().zip(text.bytes()) {
        *slot = if byte.is_ascii() { byte } else { b'?' };
    }
}

struct Encoder<'a> {
    cloud: &'a PointCloud,
    columns: &'a [Column<'a>],
    transforms: Vector<Transform>,
    /// First point that is not encoded yet.
    next: usize,
    /// Values that were cut to their field.
    clamped_count: usize,
}

impl Encoder<'_> {
    /// The next points for a file with that header; `None` at the end.
    fn next(&mut self, header: &las::Header) -> Option<PointData> {
        let (start, left) = (self.next, self.cloud.len() - self.next);
        if left == 0 {
            return None;
        }
        let mut slab = PointDataBuilder::new().for_header(header).build();
        let record_bytes = slab.record_len();
        let clamped = AtomicUsize::new(0);
        let this = &*self;
        slab.resize_for(POINTS_PER_SLAB.min(left)).par_chunks_mut(record_bytes).enumerate().for_each(|(i, record)| {
            let count = this.encode(record, start + i);
            if count > 0 {
                clamped.fetch_add(count, Ordering::Relaxed);
            }
        });
        self.next += slab.len();
        self.clamped_count += clamped.into_inner();
        Some(slab)
    }

    /// Fills a record of point format 6 or 7 with point `index`; returns how many values were cut to their field.
    fn encode(&self, record: &mut [u8], index: usize) -> usize {
        let a = &self.cloud.attributes;
        let mut clamped = 0;
        let mut cut = |value: u8, max: u8| {
            clamped += usize::from(value > max);
            value.min(max)
        };
        let xyz = self.cloud.frame.to_file_coordinates(self.cloud.positions[index]);
        let transforms = [self.transforms.x, self.transforms.y, self.transforms.z];
        for (axis, (value, transform)) in xyz.into_iter().zip(transforms).enumerate() {
            let steps = ((value - transform.offset) / transform.scale).round();
            record[axis * 4..axis * 4 + 4].copy_from_slice(&to_i32(steps).to_le_bytes());
        }
        let of = |column: &Option<Vec<u8>>, default: u8| column.as_ref().map_or(default, |v| v[index]);
        let intensity = a.intensity.as_ref().map_or(0, |v| v[index]);
        record[12..14].copy_from_slice(&intensity.to_le_bytes());
        let number = cut(of(&a.return_number, 1), 15);
        let count = cut(of(&a.return_count, number), 15);
        record[14] = number | count << 4;
        record[15] = cut(of(&a.flags, 0), 15) | cut(of(&a.scanner_channel, 0), 3) << 4;
        record[16] = of(&a.classification, 0);
        let angle = a.scan_angle.as_ref().map_or(0.0, |v| f64::from(v[index]).to_degrees());
        record[18..20].copy_from_slice(&scan_steps(angle).to_le_bytes());
        let source = a.point_source_id.as_ref().map_or(0, |v| v[index]);
        record[20..22].copy_from_slice(&source.to_le_bytes());
        let time = a.gps_time.as_ref().map_or(0.0, |v| v[index]);
        record[22..30].copy_from_slice(&time.to_le_bytes());
        let mut at = 30;
        if let Some(colors) = &a.color {
            for channel in colors[index] {
                record[at..at + 2].copy_from_slice(&channel.to_le_bytes());
                at += 2;
            }
        }
        for column in self.columns {
            column.values.put(index, &mut record[at..]);
            at += column.values.width();
        }
        clamped
    }
}
