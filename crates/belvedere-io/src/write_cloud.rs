//! Point clouds with columns of results.

use std::borrow::Cow;

use crate::columns::{Column, ColumnValues, check_lengths};
use crate::output::Output;
use crate::source::unusable;
#[cfg(feature = "las")]
use crate::write_las;
#[cfg(feature = "npy")]
use crate::write_npy;
use crate::{write_ply, write_table};
use belvedere_data::{Error, Parameter, PointCloud, Result};

/// Extensions a cloud can be written to.
pub(crate) const SUPPORTED: &str = ".las .laz .ply .csv .xyz .txt .npy";

/// A column of results beside the attributes of a cloud.
#[derive(Clone, Copy, Debug)]
pub struct ExtraColumn<'a> {
    /// Name, such as `visible`; at most 31 bytes are kept in LAS files.
    pub name: &'a str,
    /// What the values mean, with their unit; at most 31 bytes are kept in LAS files.
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
}

/// What became of a cloud that was written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WriteReport {
    /// Number of points written.
    pub point_count: usize,
    /// What the cloud, or the files that its points come from, have and the output has not, in words.
    pub left_out: Vec<String>,
    /// Values that did not fit their field and were cut to its range, such as a 16th return.
    pub clamped_count: usize,
}

/// The report of writing `cloud` to `output`, with its attributes and the `extra` columns, in a format that follows
/// from the extension (.las .laz .ply .csv .xyz .txt .npy). Coordinates are those of the reference system and unit of
/// the cloud's file.
///
/// LAS and LAZ files hold every attribute. Where the points come from LAS and LAZ files
/// ([`belvedere_data::CloudFiles`]), their records are copied: extra bytes, further fields, records of the header,
/// point format, and steps of coordinates stay; of several files what all of them have. What is lost is reported. PLY
/// files and tables hold scan angles in degrees (`scan_angle_deg`) and colours in 8 bits; tables have a header row. NPY
/// files hold (N, 3) f64 coordinates and nothing else.
///
/// # Errors
/// [`Error::UnknownFormat`] for other extensions, [`Error::LengthMismatch`] when a column does not have one value per
/// point, [`Error::InvalidParameter`] when the format has no place for extra columns or a column's name is unusable,
/// [`Error::MissingFeature`] and [`Error::Io`]. An existing file is replaced only by a complete one.
pub fn write_cloud<'a>(
    output: impl Into<Output<'a>>,
    cloud: &PointCloud,
    extra: &[ExtraColumn<'_>],
) -> Result<WriteReport> {
    let output = output.into();
    cloud.validate()?;
    let columns: Vec<Column<'_>> = extra.iter().map(to_column).collect();
    check_lengths(&columns, cloud.len())?;
    check_names(&columns)?;
    match output.extension().as_str() {
        #[cfg(feature = "las")]
        "las" | "laz" => write_las::write(output, cloud, &columns, &[]),
        "ply" => write_ply::write(output, cloud, &columns, &[]).map(|report| of_attributes(report, cloud)),
        "csv" => write_table::write(output, cloud, &columns, ',').map(|report| of_attributes(report, cloud)),
        "xyz" | "txt" => write_table::write(output, cloud, &columns, ' ').map(|report| of_attributes(report, cloud)),
        "npy" if !columns.is_empty() => Err(Error::InvalidParameter {
            parameter: Parameter::ResultColumns,
            value: "written as .npy".to_owned(),
            expected: "written as one of .las .laz .ply .csv .xyz .txt",
        }),
        #[cfg(feature = "npy")]
        "npy" => write_npy::write_coordinates(output, cloud),
        _ => Err(unusable(output.name(), "point cloud output", SUPPORTED)),
    }
}

/// The report with what only the files of the cloud have.
fn of_attributes(mut report: WriteReport, cloud: &PointCloud) -> WriteReport {
    report.left_out.extend(not_in_cloud(cloud));
    report
}

/// What the points of the files of a cloud have and the cloud has not.
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
    };
    Column { name: extra.name.into(), description: extra.description.into(), values }
}

/// Names go into text headers of several formats: a blank or a comma in one would shift all later columns.
fn check_names(columns: &[Column<'_>]) -> Result<()> {
    let usable = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
    match columns.iter().find(|c| !usable(&c.name)) {
        Some(c) => Err(Error::InvalidParameter {
            parameter: Parameter::ResultColumns,
            value: format!("named {:?}", c.name),
            expected: "named by ASCII letters, digits, '_', '-' and '.'",
        }),
        None => Ok(()),
    }
}
