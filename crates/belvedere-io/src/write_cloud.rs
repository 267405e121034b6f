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
    /// Attributes of the cloud that the format has no place for.
    pub left_out: Vec<&'static str>,
    /// Values that did not fit their field and were cut to its range, such as a 16th return.
    pub clamped_count: usize,
}

/// The report of writing `cloud` to `output`, with its attributes and the `extra` columns, in a format that follows
/// from the extension (.las .laz .ply .csv .xyz .txt .npy). Coordinates are those of the reference system and unit of
/// the cloud's file.
///
/// LAS and LAZ files hold every attribute but normals, which go in as extra columns `NormalX`, `NormalY` and `NormalZ`
/// where wanted. PLY files and tables hold scan angles in degrees (`scan_angle_deg`) and colours in 8 bits; tables have
/// a header row. NPY files hold (N, 3) f64 coordinates and nothing else.
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
        "ply" => write_ply::write(output, cloud, &columns, &[]),
        "csv" => write_table::write(output, cloud, &columns, ','),
        "xyz" | "txt" => write_table::write(output, cloud, &columns, ' '),
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
