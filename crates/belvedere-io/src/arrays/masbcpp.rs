//! The folder of NumPy arrays that masbcpp, the reference program of the shrinking ball, reads and writes.

use std::fs;
use std::path::{Path, PathBuf};

use crate::arrays::npy;
use crate::arrays::write_npy::write_array;
use crate::files::atomic;
use crate::files::output::Output;
use crate::files::source::Source;
use crate::points::file_part::FilePart;
use belvedere_data::vector::to_f32;
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

/// Contents of the folder; each array that is present becomes a file named like its field, `.npy`.
///
/// Coordinates are f32 as in the `coords.npy` that belongs to the folder. Every array has one row per point.
#[derive(Clone, Copy, Debug, Default)]
pub struct MasbcppFolder<'a> {
    /// Points, (N, 3).
    pub coords: Option<&'a [[f32; 3]]>,
    /// Unit normals, (N, 3).
    pub normals: Option<&'a [[f32; 3]]>,
    /// Centres of the interior balls, (N, 3).
    pub ma_coords_in: Option<&'a [[f32; 3]]>,
    /// Index of the second point of each interior ball, (N); −1 for a ball that never shrank.
    pub ma_qidx_in: Option<&'a [i32]>,
    /// Centres of the exterior balls, (N, 3).
    pub ma_coords_out: Option<&'a [[f32; 3]]>,
    /// Index of the second point of each exterior ball, (N); −1 for a ball that never shrank.
    pub ma_qidx_out: Option<&'a [i32]>,
    /// Local feature size, (N).
    pub lfs: Option<&'a [f32]>,
    /// Mask of the points that a decimation keeps, (N), 0 or 1.
    pub decimate_lfs: Option<&'a [u8]>,
}

impl MasbcppFolder<'_> {
    fn lengths(&self) -> [(&'static str, Option<usize>); 8] {
        [
            ("coords", self.coords.map(<[_]>::len)),
            ("normals", self.normals.map(<[_]>::len)),
            ("ma_coords_in", self.ma_coords_in.map(<[_]>::len)),
            ("ma_qidx_in", self.ma_qidx_in.map(<[_]>::len)),
            ("ma_coords_out", self.ma_coords_out.map(<[_]>::len)),
            ("ma_qidx_out", self.ma_qidx_out.map(<[_]>::len)),
            ("lfs", self.lfs.map(<[_]>::len)),
            ("decimate_lfs", self.decimate_lfs.map(<[_]>::len)),
        ]
    }
}

/// Writes the arrays of `folder` into the folder at `path`, which is made if only it is missing. Each file appears only
/// when it is complete; files of other names stay. Where writing fails, new files are removed again.
///
/// # Errors
/// [`Error::LengthMismatch`] when the arrays differ in length, before anything is written, and [`Error::Io`].
pub fn write_masbcpp(path: &Path, folder: &MasbcppFolder<'_>) -> Result<()> {
    let mut expected = None;
    for (what, found) in folder.lengths() {
        let Some(found) = found else { continue };
        if *expected.get_or_insert(found) != found {
            return Err(Error::LengthMismatch { what, expected: expected.unwrap_or(0), found });
        }
    }
    let names = folder.lengths().map(|(name, _)| path.join(format!("{name}.npy")));
    let new: Vec<&PathBuf> = names.iter().filter(|name| !name.exists()).collect();
    let is_new = !path.exists();
    atomic::make_folder(path)?;
    write_arrays(path, folder).inspect_err(|_| {
        // the error that led here is the one to report
        new.iter().for_each(|name| drop(fs::remove_file(name)));
        if is_new {
            let _ = fs::remove_dir(path);
        }
    })
}

fn write_arrays(path: &Path, folder: &MasbcppFolder<'_>) -> Result<()> {
    let triples = [
        ("coords.npy", folder.coords),
        ("normals.npy", folder.normals),
        ("ma_coords_in.npy", folder.ma_coords_in),
        ("ma_coords_out.npy", folder.ma_coords_out),
    ];
    for (name, values) in triples {
        if let Some(values) = values {
            write_array(Output::path(path.join(name)), &[values.len(), 3], values.iter().flatten().copied())?;
        }
    }
    for (name, values) in [("ma_qidx_in.npy", folder.ma_qidx_in), ("ma_qidx_out.npy", folder.ma_qidx_out)] {
        if let Some(values) = values {
            write_array(Output::path(path.join(name)), &[values.len()], values.iter().copied())?;
        }
    }
    if let Some(values) = folder.lfs {
        write_array(Output::path(path.join("lfs.npy")), &[values.len()], values.iter().copied())?;
    }
    if let Some(values) = folder.decimate_lfs {
        write_array(Output::path(path.join("decimate_lfs.npy")), &[values.len()], values.iter().map(|&v| v != 0))?;
    }
    Ok(())
}
