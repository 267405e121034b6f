//! Per-point values of any width, as the writers of all formats share them.

use std::borrow::Cow;
use std::io::Write;

use belvedere_data::report::clock_time;
use belvedere_data::{Error, PointCloud, Result};

/// Values of one column.
#[derive(Clone, Debug)]
pub(crate) enum ColumnValues<'a> {
    U8(Cow<'a, [u8]>),
    U16(Cow<'a, [u16]>),
    U32(Cow<'a, [u32]>),
    I32(Cow<'a, [i32]>),
    F32(Cow<'a, [f32]>),
    F64(Cow<'a, [f64]>),
    /// Hours of the day: text is HH:MM.
    Clock(Cow<'a, [f32]>),
}

/// A named column.
#[derive(Clone, Debug)]
pub(crate) struct Column<'a> {
    pub(crate) name: Cow<'a, str>,
    #[cfg_attr(not(feature = "las"), expect(dead_code, reason = "only LAS files describe their columns"))]
    pub(crate) description: Cow<'a, str>,
    pub(crate) values: ColumnValues<'a>,
}

macro_rules! with_values {
    ($values:expr, $v:ident => $body:expr) => {
        match $values {
            ColumnValues::U8($v) => $body,
            ColumnValues::U16($v) => $body,
            ColumnValues::U32($v) => $body,
            ColumnValues::I32($v) => $body,
            ColumnValues::F32($v) => $body,
            ColumnValues::F64($v) => $body,
            ColumnValues::Clock($v) => $body,
        }
    };
}

impl ColumnValues<'_> {
    pub(crate) fn len(&self) -> usize {
        with_values!(self, v => v.len())
    }

    /// Bytes per value.
    pub(crate) fn width(&self) -> usize {
        match self {
            Self::U8(_) => 1,
            Self::U16(_) => 2,
            Self::U32(_) | Self::I32(_) | Self::F32(_) | Self::Clock(_) => 4,
            Self::F64(_) => 8,
        }
    }

    /// Puts value `index` at the start of `bytes`, little endian. The column must be that long.
    pub(crate) fn put(&self, index: usize, bytes: &mut [u8]) {
        with_values!(self, v => {
            let value = v[index].to_le_bytes();
            bytes[..value.len()].copy_from_slice(&value);
        });
    }

    /// Writes value `index` as text, with as many digits as bring back the same value; of hours to the minute, and
    /// nothing where there is none.
    pub(crate) fn print(&self, index: usize, text: &mut Vec<u8>) -> std::io::Result<()> {
        match self {
            Self::Clock(hours) if hours[index].is_nan() => Ok(()),
            Self::Clock(hours) => write!(text, "{}", clock_time(hours[index].into())),
            _ => with_values!(self, v => write!(text, "{}", v[index])),
        }
    }
}

/// Checks that every column has `expected` values.
pub(crate) fn check_lengths(columns: &[Column<'_>], expected: usize) -> Result<()> {
    match columns.iter().find(|c| c.values.len() != expected) {
        Some(c) => Err(Error::LengthMismatch { what: "result column", expected, found: c.values.len() }),
        None => Ok(()),
    }
}

fn column<'a>(name: &'a str, values: ColumnValues<'a>) -> Column<'a> {
    Column { name: name.into(), description: "".into(), values }
}

/// The attributes of a cloud as columns for formats without roles of their own: angles in degrees, colours in 8 bits.
pub(crate) fn attribute_columns(cloud: &PointCloud) -> Vec<Column<'_>> {
    let a = &cloud.attributes;
    let mut columns = Vec::new();
    if let Some(normals) = &a.normals {
        for (axis, name) in ["nx", "ny", "nz"].into_iter().enumerate() {
            columns.push(column(name, ColumnValues::F32(normals.iter().map(|n| n[axis]).collect())));
        }
    }
    if let Some(colors) = &a.color {
        // some files hold 8-bit values in their 16-bit fields
        let shift = if colors.iter().flatten().any(|&c| c > 255) { 8 } else { 0 };
        for (channel, name) in ["red", "green", "blue"].into_iter().enumerate() {
            let bytes = colors.iter().map(|c| u8::try_from(c[channel] >> shift).unwrap_or(u8::MAX)).collect();
            columns.push(column(name, ColumnValues::U8(bytes)));
        }
    }
    macro_rules! add {
        ($($field:ident as $name:literal $kind:ident),* $(,)?) => {$(
            if let Some(values) = &a.$field {
                columns.push(column($name, ColumnValues::$kind(Cow::Borrowed(values))));
            }
        )*};
    }
    add!(
        intensity as "intensity" U16,
        classification as "classification" U8,
        return_number as "return_number" U8,
        return_count as "number_of_returns" U8,
        gps_time as "gps_time" F64,
        point_source_id as "point_source_id" U16,
        scanner_channel as "scanner_channel" U8,
        flags as "flags" U8,
        scanner_index as "scanner_index" U16,
    );
    if let Some(angles) = &a.scan_angle {
        columns.push(column("scan_angle_deg", ColumnValues::F32(angles.iter().map(|v| v.to_degrees()).collect())));
    }
    columns
}

/// A column of results beside the attributes of a cloud.
#[derive(Clone, Copy, Debug)]
pub struct ExtraColumn<'a> {
    /// Name, such as `visible`; at most 31 bytes are kept in LAS files.
    pub name: &'a str,
    /// Meaning of the values, with their unit; at most 31 bytes are kept in LAS files.
    pub description: &'a str,
    /// One value per point.
    pub values: ExtraValues<'a>,
}

/// Values of an [`ExtraColumn`], (N).
#[derive(Clone, Copy, Debug)]
pub enum ExtraValues<'a> {
    /// Small numbers, such as classes of answers.
    U8(&'a [u8]),
    /// Counts and indices.
    U32(&'a [u32]),
    /// Measurements.
    F32(&'a [f32]),
    /// Hours of the day: HH:MM in text files, empty where NaN.
    Clock(&'a [f32]),
}

/// Report of writing a cloud.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WriteReport {
    /// Number of points written.
    pub point_count: usize,
    /// Attributes of the cloud, or of the files that its points come from, that the output lacks, in words.
    pub left_out: Vec<String>,
    /// Values that did not fit their field and were cut to its range, such as a 16th return.
    pub clamped_count: usize,
}

/// Returns the attributes of the files of a cloud that the cloud lacks.
pub(crate) fn not_in_cloud(cloud: &PointCloud) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in cloud.files.files.iter().flat_map(|file| &file.other_attributes) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

pub(crate) fn to_column<'a>(extra: &ExtraColumn<'a>) -> Column<'a> {
    let values = match extra.values {
        ExtraValues::U8(v) => ColumnValues::U8(Cow::Borrowed(v)),
        ExtraValues::U32(v) => ColumnValues::U32(Cow::Borrowed(v)),
        ExtraValues::F32(v) => ColumnValues::F32(Cow::Borrowed(v)),
        ExtraValues::Clock(v) => ColumnValues::Clock(Cow::Borrowed(v)),
    };
    Column { name: extra.name.into(), description: extra.description.into(), values }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_are_printed_to_the_minute_and_empty_without_an_answer() {
        let column = ColumnValues::Clock(Cow::Borrowed(&[9.694_777, f32::NAN]));
        let mut text = Vec::new();
        column.print(0, &mut text).unwrap();
        column.print(1, &mut text).unwrap();
        assert_eq!(text, b"09:42");
    }
}
