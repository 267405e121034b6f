//! The folder layout of masbcpp: `coords.npy`, and `normals.npy` if there are normals.

use belvedere_data::vector::to_f32;
use std::path::Path;

use crate::arrays::npy;
use crate::files::source::Source;
use crate::points::file_part::FilePart;
use belvedere_data::{Error, Result};

/// The file that makes a folder a masbcpp folder.
pub(crate) const COORDINATES: &str = "coords.npy";
const NORMALS: &str = "normals.npy";

/// The points, and normals if present, of the folder at `path`.
pub(crate) fn read(folder: &Path) -> Result<FilePart> {
    let mut part = npy::read(Source::path(folder.join(COORDINATES)).open()?)?;
    part.report.format = format!("masbcpp folder, {}", part.report.format);
    let path = folder.join(NORMALS);
    if path.is_file() {
        let (normals, _) = npy::read_rows(Source::path(&path).open()?)?;
        if normals.rows.len() != part.coordinates.len() {
            let what =
                format!("holds {} normals for {} points of {COORDINATES}", normals.rows.len(), part.coordinates.len());
            return Err(Error::malformed(&path, what));
        }
        part.attributes.normals = Some(normals.rows.into_iter().map(|n| n.map(to_f32)).collect());
    }
    Ok(part)
}
