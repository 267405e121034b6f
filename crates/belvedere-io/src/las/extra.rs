//! Extra bytes of LAS records: columns requested by name, normals among them; the report lists the names of the others.

use ::las::point::Format;

use crate::las::header::LasHeader;
use crate::points::file_part::FilePart;
use belvedere_data::contradiction::COLUMN_TWICE;

/// Position and type of NormalX, NormalY and NormalZ in a record.
pub(crate) type ExtraNormals = [ExtraField; 3];

#[derive(Clone, Copy)]
pub(crate) struct ExtraField {
    at: usize,
    kind: u8,
    scale: f64,
    offset: f64,
}

impl ExtraField {
    /// Returns true if it is a number of a kind that is read.
    pub(crate) fn is_number(self) -> bool {
        matches!(self.kind, 1..=6 | 9 | 10)
    }

    pub(crate) fn value(self, record: &[u8]) -> Option<f64> {
        let rest = record.get(self.at..)?;
        let raw = match self.kind {
            1 => f64::from(*rest.first()?),
            2 => f64::from(i8::from_le_bytes(*rest.first_chunk()?)),
            3 => f64::from(u16::from_le_bytes(*rest.first_chunk()?)),
            4 => f64::from(i16::from_le_bytes(*rest.first_chunk()?)),
            5 => f64::from(u32::from_le_bytes(*rest.first_chunk()?)),
            6 => f64::from(i32::from_le_bytes(*rest.first_chunk()?)),
            9 => f64::from(f32::from_le_bytes(*rest.first_chunk()?)),
            10 => f64::from_le_bytes(*rest.first_chunk()?),
            _ => return None,
        };
        Some(raw * self.scale + self.offset)
    }
}

/// Bytes of each extra-bytes type, one to ten, and of the two and three element ones that follow.
fn extra_size(kind: u8, options: u8) -> usize {
    const SIZES: [usize; 10] = [1, 1, 2, 2, 4, 4, 8, 8, 4, 8];
    match kind {
        0 => usize::from(options),
        1..=30 => SIZES[usize::from((kind - 1) % 10)] * usize::from(1 + (kind - 1) / 10),
        _ => 0,
    }
}

/// A description of extra bytes, as the file has it, and where in the record they lie.
#[derive(Clone, Debug)]
pub(crate) struct ExtraDescription {
    pub(crate) bytes: [u8; 192],
    pub(crate) at: usize,
    pub(crate) size: usize,
}

impl ExtraDescription {
    pub(crate) fn name(&self) -> String {
        let name = self.bytes[4..36].split(|&byte| byte == 0).next().unwrap_or_default();
        String::from_utf8_lossy(name).into_owned()
    }
}

/// The extra bytes as the file describes them.
pub(crate) fn descriptions(header: &LasHeader, format: &Format) -> Vec<ExtraDescription> {
    let mut at = usize::from(format.len().saturating_sub(format.extra_bytes));
    let described = header.records("LASF_Spec", 4).flat_map(|record| record.as_chunks::<192>().0);
    let one = |&bytes: &[u8; 192]| {
        let size = extra_size(bytes[2], bytes[3]);
        at += size;
        ExtraDescription { bytes, at: at - size, size }
    };
    described.map(one).collect()
}

/// The names of the extra bytes as the file describes them, and how to read each.
pub(crate) fn described(header: &LasHeader, format: &Format) -> Vec<(String, ExtraField)> {
    let field = |described: ExtraDescription| {
        let ExtraDescription { bytes, at, .. } = &described;
        let (kind, options) = (bytes[2], bytes[3]);
        let f64_at = |i: usize| bytes[i..].first_chunk().map_or(0.0, |&bytes| f64::from_le_bytes(bytes));
        let scale = if options & 8 != 0 { f64_at(112) } else { 1.0 };
        let offset = if options & 16 != 0 { f64_at(136) } else { 0.0 };
        (described.name(), ExtraField { at: *at, kind, scale, offset })
    };
    descriptions(header, format).into_iter().map(field).collect()
}

/// The extra columns of these names, in whatever case the file writes them; `None` for those it lacks.
pub(crate) fn find_columns<const N: usize>(
    header: &LasHeader,
    format: &Format,
    names: [&str; N],
) -> [Option<ExtraField>; N] {
    let fields = described(header, format);
    // the last of several fields of one name counts
    names.map(|name| fields.iter().rev().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|&(_, field)| field))
}

/// Finds normals among the extra bytes; a note names the other extra bytes.
pub(crate) fn find_extra_normals(part: &mut FilePart, header: &LasHeader, format: &Format) -> Option<ExtraNormals> {
    const NAMES: [&str; 3] = ["NormalX", "NormalY", "NormalZ"];
    let normals = match find_columns(header, format, NAMES) {
        [Some(x), Some(y), Some(z)] => Some([x, y, z]),
        _ => None,
    };
    let is_normal = |name: &str| normals.is_some() && NAMES.iter().any(|normal| normal.eq_ignore_ascii_case(name));
    let names = described(header, format).into_iter().map(|(name, _)| name);
    let is_twice = |name: &&str| names.clone().filter(|other| other.eq_ignore_ascii_case(name)).count() > 1;
    let twice: Vec<&str> = NAMES.into_iter().filter(is_twice).collect();
    if normals.is_some() && !twice.is_empty() {
        let text = format!("extra bytes that occur twice: {}; the last of each was read", twice.join(", "));
        part.contradict(COLUMN_TWICE.found(text).with("columns", twice.len() as f64));
    }
    let others: Vec<String> = names.filter(|name| !is_normal(name)).collect();
    if let Some(note) = note_on_unused(&others, format.extra_bytes, normals.is_some()) {
        part.note(note);
    }
    normals
}

/// Returns a note on unused values of points with these names, in `size` bytes of a point; `None` if there are none.
fn note_on_unused(names: &[String], size: u16, has_normals: bool) -> Option<String> {
    let what = match names {
        [] if size == 0 || has_normals => return None,
        [] => format!("{size} bytes of each point that the file does not describe"),
        names => names.join(", "),
    };
    Some(format!(
        "values that are not used: {what} (\"extra bytes\"); no answer depends on them, and results that are written \
         as .las or .laz keep them"
    ))
}
