//! E57: all scans of a file in its common coordinates, with the scanner position of each point.

pub(crate) mod counts;

use std::io::{Read, Seek};
use std::path::Path;

use ::e57::{E57Reader, PointCloud as Scan, Quaternion, Record, RecordDataType, RecordName, RecordValue};

use crate::e57::counts::records_in_section;
use crate::files::source::{Input, web_address};
use crate::points::file_part::{COARSE_STEP, FilePart, single_step};
use crate::points::read_options::Reading;
use crate::points::rows::{NORMAL, POSITION, Role, Row, Rows, role_of};
use crate::points::sky::ScanGrid;
use belvedere_data::cast::to_i64;
use belvedere_data::contradiction::POINTS_NOT_COUNTED;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// Quaternions this far from unit length are noted, and those this short have no direction.
const LENGTH_TOLERANCE: f64 = 1e-3;
const MIN_LENGTH: f64 = 1e-9;

/// The valid points of all scans of the source.
///
/// Poses are applied to points and normals. The pose gives the scanner. Without a pose it is at (0, 0, 0) if the scan
/// is a grid or spherical, and is unknown otherwise, as in clouds that only passed through E57.
pub(crate) fn read(input: Input<'_>, reading: &Reading<'_>) -> Result<FilePart> {
    let Input { name, reader: mut file, size } = input;
    let path = name.as_path();
    let is_near = web_address(path).is_none();
    let damaged = |e: ::e57::Error| Error::malformed(path, format!("is not a readable E57 file: {e}"));
    let mut reader = E57Reader::new(&mut file).map_err(damaged)?;
    let scans = reader.pointclouds();
    let mut part = FilePart::new(path, format!("E57, {} scan{}", scans.len(), if scans.len() == 1 { "" } else { "s" }));
    if let Some(text) = reader.coordinate_metadata().map(str::trim).filter(|text| !text.is_empty()) {
        match Crs::parse(text) {
            Ok(crs) => part.set_crs(crs, "coordinate metadata"),
            Err(_) => part.note("its coordinate metadata do not define a known reference system"),
        }
    }
    let plans: Vec<ScanLayout> = scans.iter().map(ScanLayout::new).collect();
    let common = common_roles(&mut part, &plans, &scans);
    let mut points = ScanPoints {
        rows: Rows::new(common).with_numbers(reading.options.row_numbers),
        scanner_index: Vec::new(),
        invalid: 0,
        farthest: 0.0,
    };
    for (i, (scan, plan)) in scans.iter().zip(&plans).enumerate() {
        if scan.records == 0 {
            part.note(format!("scan {} has no points", i + 1));
            continue;
        }
        plan.check(path, scan, i, size)?;
        if let Some(fault) = pose_fault(scan) {
            let what = format!("the pose of scan {}{} {fault}; export it again", i + 1, name_of(scan));
            return Err(Error::malformed(path, what));
        }
        if let Some(length) = scan.transform.as_ref().map(|pose| quaternion_length(&pose.rotation))
            && (length - 1.0).abs() > LENGTH_TOLERANCE
        {
            let what = format!("the rotation of scan {}{} has the length {length:.4}", i + 1, name_of(scan));
            part.note(format!("{what}; it is used as a rotation without scale"));
        }
        let index = plan.scanner.map_or(u16::MAX, |position| {
            part.scanners.push(position);
            u16::try_from(part.scanners.len() - 1).unwrap_or(u16::MAX)
        });
        let mut grid = plan.grid.and_then(|grid| ScanGrid::new(grid.size()));
        read_scan(path, &mut reader, scan, (plan, &mut grid), index, &mut points, reading)?;
        if let Some(mut grid) = grid {
            if plan.grid.is_some_and(|grid| grid.is_stated) {
                grid.add_all_cells();
            }
            part.skies.add(&grid, index, plan.pose.axes(), reading.options.up);
        }
        // poses are applied in double precision
        let step = single_step(std::mem::take(&mut points.farthest)) * part.crs.metres_per_unit;
        part.single_precision |= plan.single_precision && step > COARSE_STEP;
    }
    drop(reader);
    for (i, (scan, plan)) in scans.iter().zip(&plans).enumerate().filter(|_| is_near) {
        let held = plan.widest().and_then(|(at, bits)| records_in_section(&mut file, scan.file_offset, at, bits));
        let Some(beyond) = held.and_then(|held| held.checked_sub(scan.records)).filter(|&beyond| beyond > 0) else {
            continue;
        };
        let counted = scan.records;
        let text = format!(
            "scan {}{} counts {counted} points, but {beyond} more follow in the file: its writer was interrupted; export it again",
            i + 1,
            name_of(scan)
        );
        let found = POINTS_NOT_COUNTED.found(text).with("counted", counted as f64).with("beyond", beyond as f64);
        part.contradict(found);
    }
    points.rows.finish(&mut part);
    if !part.scanners.is_empty() {
        part.attributes.scanner_index = Some(points.scanner_index);
    }
    part.leave_out(points.invalid, "marked as invalid in the file");
    Ok(part)
}

/// The points of all scans as they are read.
struct ScanPoints {
    rows: Rows,
    scanner_index: Vec<u16>,
    invalid: usize,
    /// Maximum coordinate of the scan that is read, in its own axes.
    farthest: f64,
}

/// Layout of the records of one scan.
struct ScanLayout {
    columns: Vec<RecordColumn>,
    single_precision: bool,
    pose: ScanPose,
    scanner: Option<[f64; 3]>,
    grid: Option<GridBounds>,
}

#[derive(Clone, Copy, PartialEq)]
enum Meaning {
    /// The value, less the first number, times the second, has a role.
    Value(Role, f64, f64),
    Range,
    Azimuth,
    Elevation,
    /// A point with anything but zero here is left out.
    Invalid,
    Row,
    Column,
    Nothing,
}

struct RecordColumn {
    meaning: Meaning,
    kind: RecordDataType,
}

impl ScanLayout {
    fn new(scan: &Scan) -> Self {
        let has = |name: &RecordName| scan.prototype.iter().any(|record| record.name == *name);
        let cartesian = has(&RecordName::CartesianX);
        let columns = scan
            .prototype
            .iter()
            .map(|record| RecordColumn { meaning: meaning(record, scan, cartesian), kind: record.data_type.clone() })
            .collect();
        let pose = ScanPose::new(scan);
        let grid = has(&RecordName::RowIndex) || has(&RecordName::ColumnIndex) || has(&RecordName::SphericalRange);
        Self {
            columns,
            single_precision: scan.prototype.iter().any(|record| {
                record.name == RecordName::CartesianX && matches!(record.data_type, RecordDataType::Single { .. })
            }),
            scanner: (scan.transform.is_some() || grid).then_some(pose.translation),
            pose,
            grid: GridBounds::of(scan),
        }
    }

    /// Returns true if the points are given by angles and range.
    fn is_spherical(&self) -> bool {
        self.columns.iter().any(|column| column.meaning == Meaning::Range)
    }

    fn roles(&self) -> Vec<Role> {
        let mut roles: Vec<Role> = self
            .columns
            .iter()
            .filter_map(|column| match column.meaning {
                Meaning::Value(role, ..) => Some(role),
                _ => None,
            })
            .collect();
        if self.is_spherical() {
            roles.extend([Role::X, Role::Y, Role::Z]);
        }
        roles
    }

    /// The column with most bits, and their number: at least a byte, so that padding of its last byte is no record.
    fn widest(&self) -> Option<(usize, u64)> {
        let bits = self.columns.iter().map(|column| bits(&column.kind)).enumerate();
        bits.filter(|&(_, bits)| bits >= 8).max_by_key(|&(_, bits)| bits)
    }

    /// Holds the number of points against the size of the file.
    fn check(&self, path: &Path, scan: &Scan, index: usize, size: u64) -> Result<()> {
        let has = |meaning: Meaning| self.columns.iter().any(|column| column.meaning == meaning);
        let position = Rows::new(self.roles()).has_position();
        if !position || (self.is_spherical() && !(has(Meaning::Azimuth) && has(Meaning::Elevation))) {
            return Err(Error::malformed(path, format!("scan {} has no coordinates", index + 1)));
        }
        let bits: u64 = self.columns.iter().map(|column| bits(&column.kind)).sum();
        // Records of no bits at all would be unpacked from nothing without end.
        if bits == 0 || scan.records.saturating_mul(bits) / 8 > size {
            let what = format!("scan {} announces {} points, more than its {size} bytes hold", index + 1, scan.records);
            return Err(Error::malformed(path, what));
        }
        Ok(())
    }
}

fn bits(kind: &RecordDataType) -> u64 {
    match kind {
        RecordDataType::Single { .. } => 32,
        RecordDataType::Double { .. } => 64,
        RecordDataType::ScaledInteger { min, max, .. } | RecordDataType::Integer { min, max } => {
            u64::from((i128::from(*max) - i128::from(*min)).checked_ilog2().map_or(0, |bits| bits + 1))
        }
    }
}

fn meaning(record: &Record, scan: &Scan, cartesian: bool) -> Meaning {
    let plain = |role: Role| Meaning::Value(role, 0.0, 1.0);
    let scaled = |role: Role, ends: Option<[Option<RecordValue>; 2]>| {
        let [low, high] = ends.unwrap_or_default();
        let (kind_low, kind_high) = type_limits(&record.data_type);
        let number = |value: Option<RecordValue>| value.and_then(|v| v.to_f64(&record.data_type).ok());
        match number(low).or(kind_low).zip(number(high).or(kind_high)) {
            Some((low, high)) if high > low && (high - low).is_finite() => {
                Meaning::Value(role, low, 65535.0 / (high - low))
            }
            _ => plain(role),
        }
    };
    let colors = scan.color_limits.clone();
    let intensities = scan.intensity_limits.clone();
    match &record.name {
        RecordName::CartesianX if cartesian => plain(Role::X),
        RecordName::CartesianY if cartesian => plain(Role::Y),
        RecordName::CartesianZ if cartesian => plain(Role::Z),
        RecordName::CartesianInvalidState if cartesian => Meaning::Invalid,
        RecordName::SphericalRange if !cartesian => Meaning::Range,
        RecordName::SphericalAzimuth if !cartesian => Meaning::Azimuth,
        RecordName::SphericalElevation if !cartesian => Meaning::Elevation,
        RecordName::SphericalInvalidState if !cartesian => Meaning::Invalid,
        RecordName::RowIndex => Meaning::Row,
        RecordName::ColumnIndex => Meaning::Column,
        RecordName::Intensity => scaled(Role::Intensity, intensities.map(|l| [l.intensity_min, l.intensity_max])),
        RecordName::ColorRed => scaled(Role::Red, colors.map(|l| [l.red_min, l.red_max])),
        RecordName::ColorGreen => scaled(Role::Green, colors.map(|l| [l.green_min, l.green_max])),
        RecordName::ColorBlue => scaled(Role::Blue, colors.map(|l| [l.blue_min, l.blue_max])),
        RecordName::ReturnCount => plain(Role::ReturnCount),
        // E57 counts returns from zero.
        RecordName::ReturnIndex => Meaning::Value(Role::ReturnNumber, -1.0, 1.0),
        RecordName::Unknown { name, .. } => match role_of(name) {
            Some(role @ (Role::NormalX | Role::NormalY | Role::NormalZ | Role::Classification)) => plain(role),
            _ => Meaning::Nothing,
        },
        _ => Meaning::Nothing,
    }
}

fn type_limits(kind: &RecordDataType) -> (Option<f64>, Option<f64>) {
    match kind {
        RecordDataType::Single { min, max } => (min.map(f64::from), max.map(f64::from)),
        RecordDataType::Double { min, max } => (*min, *max),
        RecordDataType::ScaledInteger { min, max, scale, offset } => {
            (Some(*min as f64 * scale + offset), Some(*max as f64 * scale + offset))
        }
        RecordDataType::Integer { min, max } => (Some(*min as f64), Some(*max as f64)),
    }
}

/// Roles that all scans with points have; the others are noted.
fn common_roles(part: &mut FilePart, plans: &[ScanLayout], scans: &[Scan]) -> Vec<Role> {
    let all: Vec<Vec<Role>> =
        plans.iter().zip(scans).filter(|(_, scan)| scan.records > 0).map(|(plan, _)| plan.roles()).collect();
    let common: Vec<Role> =
        all.first().into_iter().flatten().copied().filter(|role| all.iter().all(|r| r.contains(role))).collect();
    if all.iter().any(|roles| roles.len() > common.len()) {
        part.note("attributes that only some of the scans have were dropped");
    }
    common
}

/// Reads one scan into `points`, all with the scanner `index`.
fn read_scan<R: Read + Seek>(
    path: &Path,
    reader: &mut E57Reader<R>,
    scan: &Scan,
    (plan, grid): (&ScanLayout, &mut Option<ScanGrid>),
    index: u16,
    points: &mut ScanPoints,
    reading: &Reading<'_>,
) -> Result<()> {
    let damaged = |e: ::e57::Error| Error::malformed(path, format!("has points that cannot be read: {e}"));
    let spherical = plan.is_spherical();
    for record in reader.pointcloud_raw(scan).map_err(damaged)? {
        let record = record.map_err(damaged)?;
        reading.check(points.rows.count())?;
        let mut row = Row::default();
        let mut valid = true;
        let [mut range, mut azimuth, mut elevation] = [0.0; 3];
        let mut cell = [0.0; 2];
        for (column, value) in plan.columns.iter().zip(&record) {
            let value = value.to_f64(&column.kind).map_err(damaged)?;
            match column.meaning {
                Meaning::Value(role, low, factor) => row.set(role, (value - low) * factor),
                Meaning::Range => range = value,
                Meaning::Azimuth => azimuth = value,
                Meaning::Elevation => elevation = value,
                Meaning::Invalid => valid &= value == 0.0,
                Meaning::Row => cell[0] = value,
                Meaning::Column => cell[1] = value,
                Meaning::Nothing => {}
            }
        }
        let cell = plan.grid.and_then(|bounds| bounds.cell(cell));
        if let (Some(grid), Some(cell)) = (&mut *grid, cell) {
            grid.add_cell(cell);
        }
        if !valid {
            points.invalid += 1;
            points.rows.pass_over();
            continue;
        }
        if spherical {
            let flat = range * elevation.cos();
            row.set(Role::X, flat * azimuth.cos());
            row.set(Role::Y, flat * azimuth.sin());
            row.set(Role::Z, range * elevation.sin());
        }
        if let (Some(grid), Some(cell)) = (&mut *grid, cell) {
            grid.add_return(cell, row.three(POSITION));
        }
        let own = row.three(POSITION).map(f64::abs);
        points.farthest = own.into_iter().filter(|v| v.is_finite()).fold(points.farthest, f64::max);
        plan.pose.apply(&mut row);
        points.rows.push(&row);
        points.scanner_index.push(index);
    }
    Ok(())
}

/// Lowest and highest row and column of a scan, where it is a grid.
#[derive(Clone, Copy)]
struct GridBounds {
    rows: [i64; 2],
    columns: [i64; 2],
    /// True if the file states them; otherwise they are those of the type of its numbers, which may hold more.
    is_stated: bool,
}

impl GridBounds {
    fn of(scan: &Scan) -> Option<Self> {
        let bounds = scan.index_bounds.as_ref();
        let limits = |name: RecordName, stated: Option<[Option<i64>; 2]>| {
            let record = scan.prototype.iter().find(|record| record.name == name)?;
            let [low, high] = stated.unwrap_or_default();
            let of_type = match record.data_type {
                RecordDataType::Integer { min, max } => [Some(min), Some(max)],
                _ => [None; 2],
            };
            Some([low.or(of_type[0])?, high.or(of_type[1])?])
        };
        let rows = limits(RecordName::RowIndex, bounds.map(|bounds| [bounds.row_min, bounds.row_max]))?;
        let columns = limits(RecordName::ColumnIndex, bounds.map(|bounds| [bounds.column_min, bounds.column_max]))?;
        let is_stated = bounds.is_some_and(|bounds| {
            [bounds.row_min, bounds.row_max, bounds.column_min, bounds.column_max].iter().all(Option::is_some)
        });
        Some(Self { rows, columns, is_stated })
    }

    /// Rows and columns.
    fn size(self) -> [u64; 2] {
        [self.rows, self.columns].map(|[low, high]| high.checked_sub(low).map_or(0, |last| last.unsigned_abs() + 1))
    }

    /// The cell of a row and a column, counted from the lowest.
    fn cell(self, [row, column]: [f64; 2]) -> Option<[u64; 2]> {
        let from = |value: f64, [low, high]: [i64; 2]| {
            let index = to_i64(value);
            (low..=high).contains(&index).then(|| index.abs_diff(low))
        };
        Some([from(row, self.rows)?, from(column, self.columns)?])
    }
}

/// Name of a scan for messages.
fn name_of(scan: &Scan) -> String {
    let name: String = scan.name.as_deref().unwrap_or_default().chars().take(40).collect();
    if name.is_empty() { String::new() } else { format!(" (\"{name}\")") }
}

/// Why a pose cannot be used. A quaternion is a rotation whatever its length, unless it has none.
fn pose_fault(scan: &Scan) -> Option<&'static str> {
    let pose = scan.transform.as_ref()?;
    let length = quaternion_length(&pose.rotation);
    let shift = [pose.translation.x, pose.translation.y, pose.translation.z];
    if !shift.iter().all(|v| v.is_finite()) || !length.is_finite() {
        return Some("has numbers that are not finite");
    }
    (length <= MIN_LENGTH).then_some("has a rotation of zeros")
}

fn quaternion_length(q: &Quaternion) -> f64 {
    (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z).sqrt()
}

/// A rigid motion from scan to file coordinates.
struct ScanPose {
    rotation: [[f64; 3]; 3],
    translation: [f64; 3],
}

impl ScanPose {
    fn new(scan: &Scan) -> Self {
        let Some(transform) = &scan.transform else {
            return Self { rotation: rotation(&Quaternion::default()), translation: [0.0; 3] };
        };
        let t = &transform.translation;
        Self { rotation: rotation(&transform.rotation), translation: [t.x, t.y, t.z] }
    }

    /// The axes of the scan in coordinates of the file.
    fn axes(&self) -> [[f64; 3]; 3] {
        std::array::from_fn(|axis| self.rotation.map(|row| row[axis]))
    }

    fn turn(&self, v: [f64; 3]) -> [f64; 3] {
        self.rotation.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    fn apply(&self, row: &mut Row) {
        let position = self.turn(row.three(POSITION));
        for (i, role) in POSITION.into_iter().enumerate() {
            row.set(role, position[i] + self.translation[i]);
        }
        let normal = self.turn(row.three(NORMAL));
        for (i, role) in NORMAL.into_iter().enumerate() {
            row.set(role, normal[i]);
        }
    }
}

/// The matrix of a quaternion of any length; the identity where it has none.
fn rotation(q: &Quaternion) -> [[f64; 3]; 3] {
    let length = quaternion_length(q);
    if !length.is_finite() || length == 0.0 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    }
    let (w, x, y, z) = (q.w / length, q.x / length, q.y / length, q.z / length);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}
