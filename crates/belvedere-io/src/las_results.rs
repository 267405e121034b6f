//! Results at points: the extra bytes of LAS and LAZ files that Belvedere wrote.

use super::las::LasFile;
use super::las_extra::ExtraField;
use super::laz::ExtraBytes;
use super::part::narrow;
use super::source::Source;
use belvedere_data::{Error, Result};

/// Points with the columns of results that a command wrote.
#[derive(Clone, Debug, PartialEq)]
pub struct PointResults {
    /// Coordinates of the file, (N, 3).
    pub places: Vec<[f64; 3]>,
    /// Names of the columns, and a value for each point.
    pub columns: Vec<(String, Vec<f32>)>,
}

/// Whether a LAS or LAZ file was written by Belvedere and has columns of results.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for what is no such file.
pub fn has_point_results<'a>(source: impl Into<Source<'a>>) -> Result<bool> {
    Ok(!results(&LasFile::open(source.into().open()?)?).is_empty())
}

/// Reads the points of a LAS or LAZ file and its columns of results.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for what is no such file, is damaged, or has no columns of results.
pub fn read_point_results<'a>(source: impl Into<Source<'a>>) -> Result<PointResults> {
    let input = source.into().open()?;
    let name = input.name.clone();
    let file = LasFile::open(input)?;
    let fields = results(&file);
    if fields.is_empty() {
        return Err(Error::malformed(
            &name,
            "has no columns of results that Belvedere wrote, such as answer or sun_hours",
        ));
    }
    let (mut places, mut values) = (Vec::new(), vec![Vec::new(); fields.len()]);
    let mut batches = file.batches(ExtraBytes::Decompress)?;
    while let Some(batch) = batches.next()? {
        places.extend(batch.x().zip(batch.y()).zip(batch.z()).map(|((x, y), z)| [x, y, z]));
        for record in batch.raw_bytes().chunks_exact(batch.record_len().max(1)) {
            for ((_, field), values) in fields.iter().zip(&mut values) {
                values.push(field.value(record).map_or(f32::NAN, narrow));
            }
        }
    }
    let names = fields.into_iter().map(|(name, _)| name);
    Ok(PointResults { places, columns: names.zip(values).collect() })
}

/// The columns of numbers that are results: all but normals.
fn results(file: &LasFile<'_>) -> Vec<(String, ExtraField)> {
    if !file.header.is_of_belvedere {
        return Vec::new();
    }
    file.all_columns().into_iter().filter(|(name, _)| !name.starts_with("Normal")).collect()
}
