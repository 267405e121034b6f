//! Points that come one by one with named numbers, as in text, PLY, PCD and E57 files.

use crate::points::coordinates::Coordinates;
use crate::points::file_part::FilePart;
use crate::points::read_options::RowNumbers;
use belvedere_data::cloud::{Attributes, GpsTimeKind};
use belvedere_data::contradiction::COLUMN_TWICE;
use belvedere_data::trajectory::LONGEST_WEEK_S;
use belvedere_data::vector::to_f32;

/// Meaning of a number of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    X,
    Y,
    Z,
    NormalX,
    NormalY,
    NormalZ,
    Red,
    Green,
    Blue,
    Intensity,
    Classification,
    GpsTime,
    ReturnNumber,
    ReturnCount,
    ScanAngle,
    SourceId,
    ScannerChannel,
    Flags,
}

const ROLES: usize = Role::Flags as usize + 1;

/// The numbers of one point, by role.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row([f64; ROLES]);

impl Default for Row {
    fn default() -> Self {
        Self([0.0; ROLES])
    }
}

impl Row {
    pub(crate) fn set(&mut self, role: Role, value: f64) {
        self.0[role as usize] = value;
    }

    fn get(&self, role: Role) -> f64 {
        self.0[role as usize]
    }

    pub(crate) fn three(&self, roles: [Role; 3]) -> [f64; 3] {
        roles.map(|role| self.get(role))
    }
}

pub(crate) const POSITION: [Role; 3] = [Role::X, Role::Y, Role::Z];
pub(crate) const NORMAL: [Role; 3] = [Role::NormalX, Role::NormalY, Role::NormalZ];
const COLOR: [Role; 3] = [Role::Red, Role::Green, Role::Blue];

/// The role of a column by its name in any of the formats, or `None` where the name says nothing.
pub(crate) fn role_of(name: &str) -> Option<Role> {
    // Called for every number of a PLY file, hence no allocation.
    let mut buffer = [0_u8; 24];
    let mut length = 0;
    for byte in name.bytes().filter(u8::is_ascii_alphanumeric) {
        *buffer.get_mut(length)? = byte.to_ascii_lowercase();
        length += 1;
    }
    let plain = std::str::from_utf8(buffer.get(..length)?).ok()?;
    let plain = plain.strip_prefix("scalar").unwrap_or(plain);
    Some(match plain {
        "x" | "easting" | "east" | "e" | "xcoord" | "coordx" => Role::X,
        "y" | "northing" | "north" | "n" | "ycoord" | "coordy" => Role::Y,
        "z" | "height" | "elevation" | "altitude" | "h" | "zcoord" | "coordz" => Role::Z,
        "nx" | "normalx" | "xnormal" => Role::NormalX,
        "ny" | "normaly" | "ynormal" => Role::NormalY,
        "nz" | "normalz" | "znormal" => Role::NormalZ,
        "r" | "red" | "diffusered" => Role::Red,
        "g" | "green" | "diffusegreen" => Role::Green,
        "b" | "blue" | "diffuseblue" => Role::Blue,
        "i" | "intensity" | "reflectance" => Role::Intensity,
        "c" | "class" | "classification" | "label" => Role::Classification,
        "t" | "time" | "gpstime" | "timestamp" => Role::GpsTime,
        "returnnumber" | "rn" => Role::ReturnNumber,
        "numberofreturns" | "returncount" | "nr" => Role::ReturnCount,
        "scanangle" | "scanangledeg" | "scananglerank" => Role::ScanAngle,
        "pointsourceid" | "sourceid" => Role::SourceId,
        "scannerchannel" => Role::ScannerChannel,
        "flags" => Role::Flags,
        _ => return None,
    })
}

/// Returns the meaning of each of some columns, by their names. Also returns names that occur twice with one meaning,
/// of which the first column counts.
///
/// Of several names of one meaning the plain one counts, wherever it stands: of "z" and "height" that is "z".
pub(crate) fn roles_of<'a>(names: impl Iterator<Item = &'a str> + Clone) -> (Vec<Option<Role>>, Vec<String>) {
    let all: Vec<Option<Role>> = names.clone().map(role_of).collect();
    let rank = |name: &str| usize::from(!is_plain_name(name));
    let mut chosen: [Option<(usize, usize)>; ROLES] = [None; ROLES];
    let mut twice = Vec::new();
    for (index, name) in names.enumerate() {
        let Some(role) = all.get(index).copied().flatten() else { continue };
        let best = &mut chosen[role as usize];
        match *best {
            Some((own, _)) if own == rank(name) => twice.push(name.trim().to_owned()),
            Some((own, _)) if own < rank(name) => {}
            _ => *best = Some((rank(name), index)),
        }
    }
    let is_chosen = |index: usize, role: Role| chosen[role as usize].is_some_and(|(_, own)| own == index);
    let roles = all.iter().enumerate().map(|(index, role)| role.filter(|&role| is_chosen(index, role))).collect();
    (roles, twice)
}

/// Returns true if a name precedes others of the same meaning.
pub(crate) fn is_plain_name(name: &str) -> bool {
    PLAIN_NAMES.iter().any(|plain| name.trim().eq_ignore_ascii_case(plain))
}

/// Names that stand above others of the same meaning.
const PLAIN_NAMES: [&str; 17] = [
    "x",
    "y",
    "z",
    "nx",
    "ny",
    "nz",
    "red",
    "green",
    "blue",
    "intensity",
    "classification",
    "gps_time",
    "return_number",
    "number_of_returns",
    "scan_angle",
    "point_source_id",
    "gpstime",
];

/// Warns of columns that occur twice.
pub(crate) fn contradict_twice(part: &mut FilePart, twice: &[String]) {
    if twice.is_empty() {
        return;
    }
    let text = format!("columns that occur twice: {}; the first of each was read", twice.join(", "));
    part.contradict(COLUMN_TWICE.found(text).with("columns", twice.len() as f64));
}

/// Points as they are read row by row.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    has: [bool; ROLES],
    wanted_numbers: RowNumbers,
    /// Row of each point, from the first one that was passed over on, where they are wanted.
    numbers: Option<Vec<u64>>,
    passed_over: u64,
    coordinates: Vec<[f64; 3]>,
    colors: Vec<[f32; 3]>,
    intensities: Vec<f32>,
    /// All attributes but colours and intensities, whose range is known at the end.
    attributes: Attributes,
}

impl Rows {
    /// For points that have the numbers of `roles`; a normal or colour counts only with all three parts.
    pub(crate) fn new(roles: impl IntoIterator<Item = Role>) -> Self {
        let mut rows = Self::default();
        for role in roles {
            rows.has[role as usize] = true;
        }
        rows.attributes = Attributes {
            normals: rows.column(&NORMAL),
            classification: rows.column(&[Role::Classification]),
            gps_time: rows.column(&[Role::GpsTime]),
            return_number: rows.column(&[Role::ReturnNumber]),
            return_count: rows.column(&[Role::ReturnCount]),
            scan_angle: rows.column(&[Role::ScanAngle]),
            point_source_id: rows.column(&[Role::SourceId]),
            scanner_channel: rows.column(&[Role::ScannerChannel]),
            flags: rows.column(&[Role::Flags]),
            ..Attributes::default()
        };
        rows
    }

    /// Returns an empty column if all of `roles` are there.
    fn column<T>(&self, roles: &[Role]) -> Option<Vec<T>> {
        self.has(roles).then(Vec::new)
    }

    /// The same, which remembers the rows of points.
    pub(crate) fn with_numbers(mut self, wanted: RowNumbers) -> Self {
        self.wanted_numbers = wanted;
        self
    }

    /// Number of rows that were read or passed over.
    pub(crate) fn count(&self) -> u64 {
        self.coordinates.len() as u64 + self.passed_over
    }

    /// A row that gives no point.
    pub(crate) fn pass_over(&mut self) {
        if self.wanted_numbers == RowNumbers::Kept && self.numbers.is_none() {
            self.numbers = Some((0..self.count()).collect());
        }
        self.passed_over += 1;
    }

    fn has(&self, roles: &[Role]) -> bool {
        roles.iter().all(|&role| self.has[role as usize])
    }

    /// Returns true if x, y and z are among the numbers.
    pub(crate) fn has_position(&self) -> bool {
        self.has(&POSITION)
    }

    pub(crate) fn push(&mut self, row: &Row) {
        let number = self.count();
        if let Some(numbers) = &mut self.numbers {
            numbers.push(number);
        }
        self.coordinates.push(row.three(POSITION));
        if self.has(&COLOR) {
            self.colors.push(row.three(COLOR).map(to_f32));
        }
        if self.has(&[Role::Intensity]) {
            self.intensities.push(to_f32(row.get(Role::Intensity)));
        }
        let own = &mut self.attributes;
        push_to(&mut own.normals, row.three(NORMAL).map(to_f32));
        push_to(&mut own.gps_time, row.get(Role::GpsTime));
        push_to(&mut own.scan_angle, to_f32(row.get(Role::ScanAngle).to_radians()));
        push_to(&mut own.point_source_id, to_u16(row.get(Role::SourceId)));
        push_to(&mut own.classification, to_u8(row.get(Role::Classification)));
        push_to(&mut own.return_number, to_u8(row.get(Role::ReturnNumber)));
        push_to(&mut own.return_count, to_u8(row.get(Role::ReturnCount)));
        push_to(&mut own.scanner_channel, to_u8(row.get(Role::ScannerChannel)));
        push_to(&mut own.flags, to_u8(row.get(Role::Flags)));
    }

    /// Moves the points into `part`. Intensities and colours from 0 to 1 become 0 to 65535.
    pub(crate) fn finish(self, part: &mut FilePart) {
        let color = self.has(&COLOR).then(|| {
            let values = to_16_bit(part, "colours", self.colors.as_flattened());
            values.as_chunks::<3>().0.to_vec()
        });
        let intensity = self.has(&[Role::Intensity]).then(|| to_16_bit(part, "intensities", &self.intensities));
        // Only LAS files say what their times count from; a time that no week has can only be the other kind.
        let in_a_week = |time: &f64| !time.is_finite() || (0.0..=LONGEST_WEEK_S).contains(time);
        let gps_time_kind = if self.attributes.gps_time.iter().flatten().all(in_a_week) {
            GpsTimeKind::SecondsOfWeek
        } else {
            GpsTimeKind::AdjustedStandard
        };
        part.attributes = Attributes { gps_time_kind, intensity, color, ..self.attributes };
        part.coordinates = Coordinates::Real(self.coordinates);
        part.rows = self.numbers;
    }
}

fn push_to<T>(column: &mut Option<Vec<T>>, value: T) {
    if let Some(column) = column {
        column.push(value);
    }
}

/// Converts numbers to u16. Fractions from 0 to 1 are scaled to the whole range, other numbers clamped; a note says so.
fn to_16_bit(part: &mut FilePart, what: &str, values: &[f32]) -> Vec<u16> {
    let highest = values.iter().copied().fold(0.0_f32, f32::max);
    let fractions = highest <= 1.0 && values.iter().any(|v| v.fract() != 0.0);
    let scale = if fractions { 65535.0 } else { 1.0 };
    let outside = values.iter().filter(|&&v| !(0.0..=65535.0).contains(&v)).count();
    if fractions {
        part.note(format!("{what} from 0 to 1 were scaled to 0 to 65535"));
    }
    if outside > 0 {
        part.note(format!("{outside} {what} lie outside 0 to 65535 and were clamped"));
    }
    values.iter().map(|&v| to_u16(f64::from(v) * scale)).collect()
}

/// Rounds a number of a file, and clamps it to the range; zero for NaN.
fn to_u8(value: f64) -> u8 {
    belvedere_data::cast::to_u8(value.round())
}

/// Rounds a number of a file, and clamps it to the range; zero for NaN.
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
pub(crate) fn to_u16(value: f64) -> u16 {
    value.round() as u16
}
