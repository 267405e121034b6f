//! PCD (point cloud library) files: ascii, binary and binary_compressed.

use belvedere_data::vector::to_f32;
use std::io::{BufRead, Read};
use std::path::Path;

use crate::files::source::Input;
use crate::points::file_part::FilePart;
use crate::points::read_options::Reading;
use crate::points::rows::{Role, Row, Rows, contradict_twice, roles_of};
use belvedere_data::{Error, Result};

/// Lines of a header; a file without DATA among these is none.
const MAX_HEADER_LINES: usize = 100;

/// A header line longer than this is none.
const MAX_LINE: u64 = 1 << 16;

/// LZF packs at most 264 bytes into three.
const MAX_LZF_RATIO: u64 = 88;

#[derive(Debug, Default)]
struct PcdHeader {
    fields: Vec<PcdField>,
    points: u64,
    data: String,
    /// Bytes of the header itself.
    length: u64,
}

#[derive(Clone, Debug)]
struct PcdField {
    name: String,
    size: usize,
    kind: char,
    count: usize,
    /// Meaning of a single value.
    role: Option<Role>,
}

/// The points of the source.
pub(crate) fn read(input: Input<'_>, reading: &Reading<'_>) -> Result<FilePart> {
    let Input { name, reader: mut file, size } = input;
    let path = name.as_path();
    let mut part = FilePart::new(path, "PCD");
    let header = read_header(path, &mut file, &mut part)?;
    part.report.format = format!("PCD, {}", header.data);
    let body = size.saturating_sub(header.length);
    let stride: u64 = header.fields.iter().map(|field| (field.size * field.count) as u64).sum();
    // In ascii a value takes a digit and a blank.
    let min = if header.data == "ascii" { 2 * header.fields.len() as u64 } else { stride };
    let packed = header.data == "binary_compressed";
    let holds = if packed { body.saturating_mul(MAX_LZF_RATIO) } else { body + 1 };
    if header.points.saturating_mul(min) > holds {
        let what = format!("announces {} points, more than its {body} bytes can hold", header.points);
        return Err(Error::malformed(path, what));
    }
    let roles: Vec<Role> = header.fields.iter().flat_map(PcdField::roles).collect();
    let mut rows = Rows::new(roles).with_numbers(reading.options.row_numbers);
    if !rows.has_position() {
        return Err(Error::malformed(path, "has no fields x, y and z"));
    }
    let dropped: Vec<&str> = header
        .fields
        .iter()
        .filter(|field| field.roles().is_empty() && field.name != "_")
        .map(|field| field.name.as_str())
        .collect();
    if !dropped.is_empty() {
        part.note(format!("fields dropped: {}", dropped.join(", ")));
        part.other_attributes.extend(dropped.into_iter().map(str::to_owned));
    }
    part.single_precision = header.fields.iter().any(|f| f.kind == 'F' && f.size == 4 && f.roles() == [Role::X]);
    match header.data.as_str() {
        "ascii" => read_ascii(path, &mut file, &header, &mut rows, &mut part, reading)?,
        "binary" => read_binary(path, &mut file, &header, &mut rows, reading)?,
        "binary_compressed" => read_compressed(path, &mut file, &header, body, &mut rows, reading)?,
        other => return Err(Error::malformed(path, format!("has data of the unknown type {other}"))),
    }
    rows.finish(&mut part);
    Ok(part)
}

fn read_header(path: &Path, file: &mut impl BufRead, part: &mut FilePart) -> Result<PcdHeader> {
    let mut header = PcdHeader::default();
    let (mut names, mut sizes, mut kinds, mut counts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut width, mut height) = (0_u64, 1_u64);
    for _ in 0..MAX_HEADER_LINES {
        let mut bytes = Vec::new();
        let read = file.take(MAX_LINE).read_until(b'\n', &mut bytes).map_err(Error::io(path))?;
        header.length += read as u64;
        let line = String::from_utf8_lossy(&bytes).into_owned();
        let mut words = line.split_ascii_whitespace().map(str::to_owned);
        let number = |word: Option<String>| word.and_then(|w| w.parse::<u64>().ok());
        match words.next().as_deref() {
            Some("FIELDS" | "COLUMNS") => names = words.collect(),
            Some("SIZE") => sizes = words.collect(),
            Some("TYPE") => kinds = words.collect(),
            Some("COUNT") => counts = words.collect(),
            Some("WIDTH") => width = number(words.next()).unwrap_or(0),
            Some("HEIGHT") => height = number(words.next()).unwrap_or(1),
            Some("POINTS") => header.points = number(words.next()).unwrap_or(0),
            Some("VIEWPOINT") => {
                let identity = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
                let pose: Vec<f64> = words.filter_map(|w| w.parse().ok()).collect();
                if pose != identity {
                    part.note(format!("VIEWPOINT {pose:?} is not applied"));
                }
            }
            Some("DATA") => {
                header.data = words.next().unwrap_or_default();
                if header.points == 0 {
                    header.points = width.saturating_mul(height);
                }
                header.fields = fields((path, part), &names, &sizes, &kinds, &counts)?;
                return Ok(header);
            }
            None if read == 0 => break,
            _ => {}
        }
    }
    Err(Error::malformed(path, "is not a PCD file: its header has no DATA line"))
}

fn fields(
    (path, part): (&Path, &mut FilePart),
    names: &[String],
    sizes: &[String],
    kinds: &[String],
    counts: &[String],
) -> Result<Vec<PcdField>> {
    let damaged = |i: usize| Error::malformed(path, format!("has a PCD header that does not describe field {}", i + 1));
    let mut fields = Vec::new();
    for (i, name) in names.iter().enumerate() {
        let kind = kinds.get(i).and_then(|k| k.chars().next()).ok_or_else(|| damaged(i))?;
        let size = sizes.get(i).and_then(|s| s.parse().ok()).ok_or_else(|| damaged(i))?;
        let count =
            counts.get(i).map_or(Some(1), |c| c.parse().ok()).filter(|&c| c <= 4096).ok_or_else(|| damaged(i))?;
        if !matches!((kind, size), ('F', 4 | 8) | ('I' | 'U', 1 | 2 | 4 | 8)) {
            return Err(damaged(i));
        }
        fields.push(PcdField { name: name.clone(), size, kind, count, role: None });
    }
    let (roles, twice) = roles_of(names.iter().map(String::as_str));
    for (field, role) in fields.iter_mut().zip(roles) {
        field.role = role.filter(|_| field.count == 1);
    }
    contradict_twice(part, &twice);
    Ok(fields)
}

impl PcdField {
    fn is_packed_color(&self) -> bool {
        (self.name == "rgb" || self.name == "rgba") && self.size == 4
    }

    fn roles(&self) -> Vec<Role> {
        if self.is_packed_color() { vec![Role::Red, Role::Green, Role::Blue] } else { self.role.into_iter().collect() }
    }

    /// Puts the value in `bytes` into `row`; `None` where there are too few.
    fn put(&self, bytes: &[u8], row: &mut Row) -> Option<()> {
        if self.is_packed_color() {
            let [blue, green, red, _] = *bytes.first_chunk()?;
            put_color(row, [red, green, blue]);
            return Some(());
        }
        let Some(role) = self.role else { return Some(()) };
        let value = match (self.kind, self.size) {
            ('F', 4) => f64::from(f32::from_le_bytes(*bytes.first_chunk()?)),
            ('F', _) => f64::from_le_bytes(*bytes.first_chunk()?),
            ('I', 1) => f64::from(i8::from_le_bytes(*bytes.first_chunk()?)),
            ('I', 2) => f64::from(i16::from_le_bytes(*bytes.first_chunk()?)),
            ('I', 4) => f64::from(i32::from_le_bytes(*bytes.first_chunk()?)),
            ('I', _) => i64::from_le_bytes(*bytes.first_chunk()?) as f64,
            (_, 1) => f64::from(*bytes.first()?),
            (_, 2) => f64::from(u16::from_le_bytes(*bytes.first_chunk()?)),
            (_, 4) => f64::from(u32::from_le_bytes(*bytes.first_chunk()?)),
            _ => u64::from_le_bytes(*bytes.first_chunk()?) as f64,
        };
        row.set(role, value);
        Some(())
    }
}

fn put_color(row: &mut Row, [red, green, blue]: [u8; 3]) {
    row.set(Role::Red, f64::from(red));
    row.set(Role::Green, f64::from(green));
    row.set(Role::Blue, f64::from(blue));
}

fn read_ascii(
    path: &Path,
    file: &mut impl BufRead,
    header: &PcdHeader,
    rows: &mut Rows,
    part: &mut FilePart,
    reading: &Reading<'_>,
) -> Result<()> {
    let (mut bad, mut good) = (0_usize, 0_usize);
    let mut bytes = Vec::new();
    while (good + bad) as u64 != header.points {
        reading.check(rows.count())?;
        bytes.clear();
        if file.take(MAX_LINE).read_until(b'\n', &mut bytes).map_err(Error::io(path))? == 0 {
            break;
        }
        let line = String::from_utf8_lossy(&bytes);
        if line.trim().is_empty() {
            continue;
        }
        match ascii_row(&line, header) {
            Some(row) => {
                rows.push(&row);
                good += 1;
            }
            None => {
                rows.pass_over();
                bad += 1;
            }
        }
    }
    if bad > good || (good == 0 && header.points > 0) {
        return Err(Error::malformed(path, format!("{bad} of {} lines are not points", bad + good)));
    }
    part.leave_out(bad, "unreadable lines");
    part.leave_out_missing(header.points - (good + bad) as u64);
    Ok(())
}

fn ascii_row(line: &str, header: &PcdHeader) -> Option<Row> {
    let mut row = Row::default();
    let mut words = line.split_ascii_whitespace();
    for field in &header.fields {
        for _ in 0..field.count {
            let value: f64 = words.next()?.parse().ok()?;
            if field.is_packed_color() {
                let bits = if field.kind == 'F' { to_f32(value).to_bits() } else { to_bits(value) };
                let [blue, green, red, _] = bits.to_le_bytes();
                put_color(&mut row, [red, green, blue]);
            } else if let (Some(role), 1) = (field.role, field.count) {
                row.set(role, value);
            }
        }
    }
    Some(row)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "float casts saturate")]
fn to_bits(value: f64) -> u32 {
    value as u32
}

fn read_binary(
    path: &Path,
    file: &mut impl Read,
    header: &PcdHeader,
    rows: &mut Rows,
    reading: &Reading<'_>,
) -> Result<()> {
    let stride = header.fields.iter().map(|field| field.size * field.count).sum();
    let mut record = vec![0_u8; stride];
    let cut = |index: u64| Error::malformed(path, format!("ends after {index} of {} points", header.points));
    for index in 0..header.points {
        reading.check(index)?;
        file.read_exact(&mut record).map_err(|_| cut(index))?;
        let mut row = Row::default();
        let mut rest = record.as_slice();
        for field in &header.fields {
            let (value, after) = rest.split_at_checked(field.size * field.count).ok_or_else(|| cut(index))?;
            field.put(value, &mut row).ok_or_else(|| cut(index))?;
            rest = after;
        }
        rows.push(&row);
    }
    Ok(())
}

fn read_compressed(
    path: &Path,
    file: &mut impl Read,
    header: &PcdHeader,
    body: u64,
    rows: &mut Rows,
    reading: &Reading<'_>,
) -> Result<()> {
    let damaged = || Error::malformed(path, "has compressed data that cannot be unpacked; it is cut off or damaged");
    let mut sizes = [0_u8; 8];
    file.read_exact(&mut sizes).map_err(|_| damaged())?;
    let [packed, unpacked] = [&sizes[..4], &sizes[4..]].map(|s| s.first_chunk().map_or(0, |&b| u32::from_le_bytes(b)));
    let stride: u64 = header.fields.iter().map(|field| (field.size * field.count) as u64).sum();
    let expected = header.points.saturating_mul(stride);
    if u64::from(packed) > body || u64::from(unpacked) != expected {
        let what = format!("has {unpacked} bytes of data for {} points of {stride} bytes", header.points);
        return Err(Error::malformed(path, what));
    }
    let mut bytes = Vec::new();
    file.take(u64::from(packed)).read_to_end(&mut bytes).map_err(Error::io(path))?;
    let data = unpack_lzf(&bytes, usize::try_from(unpacked).unwrap_or(0)).ok_or_else(damaged)?;
    // Unpacked data are field after field, each with the values of all points.
    let points = usize::try_from(header.points).map_err(|_| damaged())?;
    let mut rest = data.as_slice();
    let mut columns = Vec::new();
    for field in &header.fields {
        let (column, after) = rest.split_at_checked(field.size * field.count * points).ok_or_else(damaged)?;
        columns.push((field, column));
        rest = after;
    }
    for i in 0..points {
        reading.check(i as u64)?;
        let mut row = Row::default();
        for (field, column) in &columns {
            let value = column.get(i * field.size * field.count..).ok_or_else(damaged)?;
            field.put(value, &mut row).ok_or_else(damaged)?;
        }
        rows.push(&row);
    }
    Ok(())
}

/// Unpacks LZF data of `length` bytes; `None` where they do not unpack to just that.
///
/// # Source
/// Marc Lehmann, LibLZF. A control byte below 32 is followed by so many literal bytes and one more. Above, its upper
/// three bits are a length and its lower five the high bits of the distance back to copy from.
fn unpack_lzf(packed: &[u8], length: usize) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(length);
    let mut bytes = packed.iter().copied();
    while let Some(control) = bytes.next() {
        let control = usize::from(control);
        if control < 32 {
            let start = out.len();
            out.extend(bytes.by_ref().take(control + 1));
            if out.len() != start + control + 1 {
                return None;
            }
        } else {
            let mut run = control >> 5;
            if run == 7 {
                run += usize::from(bytes.next()?);
            }
            let back = ((control & 31) << 8) + usize::from(bytes.next()?) + 1;
            let start = out.len().checked_sub(back)?;
            for i in start..start + run + 2 {
                out.push(*out.get(i)?);
            }
        }
        if out.len() > length {
            return None;
        }
    }
    (out.len() == length).then_some(out)
}
