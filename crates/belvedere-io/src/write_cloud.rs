//! Point clouds with columns of results.

#[cfg(feature = "npy")]
use crate::arrays::write_npy;
use crate::files::output::Output;
use crate::files::source::unusable;
#[cfg(feature = "las")]
use crate::las::write_las;
use crate::ply::write_ply;
use crate::points::columns::{Column, ExtraColumn, WriteReport, check_lengths, not_in_cloud, to_column};
use crate::text::write_table;
use belvedere_data::{Error, Parameter, PointCloud, Result};

/// Extensions a cloud can be written to.
pub(crate) const SUPPORTED: &str = ".las .laz .ply .csv .xyz .txt .npy";

/// The report of writing `cloud` to `output`, with its attributes and the `extra` columns, in a format that follows
/// from the extension (.las .laz .ply .csv .xyz .txt .npy). Coordinates are those of the reference system and unit of
/// the cloud's file.
///
/// LAS and LAZ files hold every attribute. If the points come from LAS and LAZ files ([`belvedere_data::CloudFiles`]),
/// their records are copied. Extra bytes, further fields, records of the header, point format, and steps of coordinates
/// stay; of several files those that all of them have. Losses are reported. PLY files and tables hold scan angles in
/// degrees (`scan_angle_deg`) and colours in 8 bits; tables have a header row. NPY files hold (N, 3) f64 coordinates
/// and nothing else.
///
/// # Errors
/// - [`Error::UnknownFormat`] for other extensions.
/// - [`Error::LengthMismatch`] for a column that does not have one value per point.
/// - [`Error::InvalidParameter`] if the format has no place for extra columns or a column's name is unusable.
/// - [`Error::MissingFeature`] and [`Error::Io`]. An existing file is replaced only by a complete one.
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
        "ply" => write_ply::write(output, cloud, &columns, &[], &write_ply::PlyElement::default())
            .map(|report| of_attributes(report, cloud)),
        "csv" => write_table::write(output, cloud, &columns, ',').map(|report| of_attributes(report, cloud)),
        "xyz" | "txt" => write_table::write(output, cloud, &columns, ' ').map(|report| of_attributes(report, cloud)),
        "npy" if !columns.is_empty() => {
            let expected = "written as one of .las .laz .ply .csv .xyz .txt";
            Err(Error::invalid(Parameter::ResultColumns, "written as .npy", expected))
        }
        #[cfg(feature = "npy")]
        "npy" => write_npy::write_coordinates(output, cloud),
        _ => Err(unusable(output.name(), "point cloud output", SUPPORTED)),
    }
}

/// The report with the columns that only the files of the cloud have.
fn of_attributes(mut report: WriteReport, cloud: &PointCloud) -> WriteReport {
    report.left_out.extend(not_in_cloud(cloud));
    report
}

/// Names go into text headers of several formats: a blank or a comma in one would shift all later columns.
fn check_names(columns: &[Column<'_>]) -> Result<()> {
    let usable = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
    let expected = "named by ASCII letters, digits, '_', '-' and '.'";
    let refused = |c: &Column<'_>| Error::invalid(Parameter::ResultColumns, format!("named {:?}", c.name), expected);
    columns.iter().find(|c| !usable(&c.name)).map_or(Ok(()), |c| Err(refused(c)))
}
