//! Results at points: the extra bytes of LAS and LAZ files that Belvedere wrote.

use ::las::point::Format;
use belvedere_data::vector::to_f32;

use crate::files::source::Source;
use crate::las::LasFile;
use crate::las::extra::{ExtraField, described};
use crate::las::header::LasHeader;
use crate::las::laz::LazFields;
use crate::las::records;
use belvedere_data::{Error, Result};

/// Points with the columns of results that a command wrote.
#[derive(Clone, Debug, PartialEq)]
pub struct PointResults {
    /// Coordinates of the file, (N, 3).
    pub places: Vec<[f64; 3]>,
    /// Names of the columns, and a value for each point.
    pub columns: Vec<(String, Vec<f32>)>,
}

/// Returns true if a LAS or LAZ file was written by Belvedere and has columns of results.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for other files.
pub fn has_point_results<'a>(source: impl Into<Source<'a>>) -> Result<bool> {
    let file = LasFile::open(source.into().open()?)?;
    Ok(!result_columns(&file.header, &file.format).is_empty())
}

/// Reads the points of a LAS or LAZ file and its columns of results.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for files that are of another kind, damaged, or without columns of results.
pub fn read_point_results<'a>(source: impl Into<Source<'a>>) -> Result<PointResults> {
    let input = source.into().open()?;
    let name = input.name.clone();
    let file = LasFile::open(input)?;
    let fields = result_columns(&file.header, &file.format);
    if fields.is_empty() {
        return Err(Error::malformed(
            &name,
            "has no columns of results that Belvedere wrote, such as answer or sun_hours",
        ));
    }
    let (mut places, mut values) = (Vec::new(), vec![Vec::new(); fields.len()]);
    let mut batches = file.batches(LazFields::AttributesAndExtraBytes)?;
    while let Some(batch) = batches.next()? {
        places.extend(batch.x().zip(batch.y()).zip(batch.z()).map(|((x, y), z)| [x, y, z]));
        for record in batch.raw_bytes().chunks_exact(batch.record_len().max(1)) {
            for ((_, field), values) in fields.iter().zip(&mut values) {
                values.push(field.value(record).map_or(f32::NAN, to_f32));
            }
        }
    }
    let names = fields.into_iter().map(|(name, _)| name);
    Ok(PointResults { places, columns: names.zip(values).collect() })
}

/// The columns of numbers that are results of Belvedere: those that a file names, in its order, or in older files all
/// but normals.
pub(crate) fn result_columns(header: &LasHeader, format: &Format) -> Vec<(String, ExtraField)> {
    if !header.is_of_belvedere {
        return Vec::new();
    }
    let (user, id) = records::RESULTS;
    let columns = described(header, format).into_iter().filter(|(_, field)| field.is_number());
    let mut columns: Vec<(String, ExtraField)> = columns.filter(|(name, _)| !name.starts_with("Normal")).collect();
    if let Some(names) = header.record(user, id).map(String::from_utf8_lossy) {
        let place = |name: &str| names.split('\n').position(|result| result == name);
        columns.retain(|(name, _)| place(name).is_some());
        columns.sort_by_key(|(name, _)| place(name));
    }
    columns
}
