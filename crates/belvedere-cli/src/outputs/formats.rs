//! Outputs of commands: formats by their extensions, and what is refused before hours of work go into it.

use crate::arguments::refuse;
use crate::summary::Summary;
use anyhow::{Context, Result, bail};
use belvedere::crs::Crs;
use belvedere::io::{CLOUD_EXTENSIONS, ExtraColumn, ExtraValues, Source, TextRows, atomic, read_text_rows};
use std::path::{Path, PathBuf};

/// The extension of a path in lower case, empty where it has none.
pub(crate) fn extension(path: &Path) -> String {
    Source::path(path).extension()
}

/// Normals as columns of their own, for formats that have no other place for them.
pub(crate) struct NormalColumns([Vec<f32>; 3]);

impl NormalColumns {
    pub(crate) fn new(normals: &[[f32; 3]]) -> Self {
        Self([0, 1, 2].map(|axis| normals.iter().map(|n| n[axis]).collect()))
    }

    /// The columns under the names that readers of the format at `path` look for.
    pub(crate) fn columns(&self, path: &Path) -> [ExtraColumn<'_>; 3] {
        let names = if is_las(path) { ["NormalX", "NormalY", "NormalZ"] } else { ["nx", "ny", "nz"] };
        let descriptions = ["outward unit normal, east", "outward unit normal, north", "outward unit normal, up"];
        std::array::from_fn(|axis| ExtraColumn {
            name: names[axis],
            description: descriptions[axis],
            values: ExtraValues::F32(&self.0[axis]),
        })
    }
}

fn is_las(path: &Path) -> bool {
    matches!(extension(path).as_str(), "las" | "laz")
}

/// Returns true if an output is a folder: it exists as one, or its name has no extension.
pub(crate) fn is_folder(path: &Path) -> bool {
    path.is_dir() || extension(path).is_empty()
}

/// Refuses an output of an unknown format or in a folder that is not there, before hours of work go into it.
pub(crate) fn check_output(flag: &str, path: &Path, known: &[&str]) -> Result<()> {
    if !known.contains(&extension(path).as_str()) {
        let known = known.join(" .");
        return refuse(format!("{flag} {}: the extension must be one of .{known}", path.display()));
    }
    check_parent(path)
}

/// Refuses outputs as [`check_output`] does.
pub(crate) fn check_outputs(
    flag: &str,
    paths: impl IntoIterator<Item = impl AsRef<Path>>,
    known: &[&str],
) -> Result<()> {
    paths.into_iter().try_for_each(|path| check_output(flag, path.as_ref(), known))
}

/// Warns of GeoJSON whose coordinates are not those that its standard promises.
pub(crate) fn warn_of_geojson(outputs: &[PathBuf], crs: &Crs, summary: &mut Summary) {
    if !outputs.iter().any(|output| extension(output) == "geojson") || crs.geographic_projection().is_ok() {
        return;
    }
    summary.warn(
        "geojson-without-reference-system",
        "GeoJSON has the coordinates of the cloud, not longitude and latitude: the reference system of the scene is unknown. Other \
                   programs will misplace it; give --crs EPSG:CODE where the balls are built",
    );
}

/// Refuses an output in a folder that is not there.
pub(crate) fn check_parent(path: &Path) -> Result<()> {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            bail!("{}: the folder {} does not exist; create it first", path.display(), parent.display())
        }
        _ => Ok(()),
    }
}

/// Refuses an output folder that cannot be made or that has the name of a point cloud, before hours of work go into it.
pub(crate) fn check_folder(path: &Path) -> Result<()> {
    let is_new = !path.exists();
    if is_new && CLOUD_EXTENSIONS.contains(&extension(path).as_str()) {
        return refuse(format!(
            "-o {}: results are several files in a folder; give it a name without .{}",
            path.display(),
            extension(path)
        ));
    }
    atomic::make_folder(path)?;
    if is_new {
        std::fs::remove_dir(path).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// Refuses other files that are among `own`, the files of the folder that a flag names.
pub(crate) fn refuse_files_of<'a>(
    flag: &str,
    own: &[PathBuf],
    others: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<()> {
    let real = |path: &Path| path.canonicalize().or_else(|_| std::path::absolute(path)).ok();
    let place = |path: &Path| Some((real(path.parent()?)?, path.file_name()?.to_owned()));
    let is_same = |a: &Path, b: &Path| real(a) == real(b) || place(a).is_some_and(|a| Some(a) == place(b));
    match others.into_iter().find(|other| own.iter().any(|file| is_same(file, other))) {
        Some(other) => {
            refuse(format!("{}: a file of {flag} has this name; choose another, or another folder", other.display()))
        }
        None => Ok(()),
    }
}

/// Returns true if a folder in the layout of masbcpp is written where it was read. Its coordinates then stay unchanged:
/// they may be finer than the f32 of the layout.
pub(crate) fn is_written_back(inputs: &[PathBuf], folder: &Path) -> bool {
    let same = |a: &Path, b: &Path| matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    inputs.iter().any(|input| same(input, folder) || same(input, &folder.join("coords.npy")))
}

/// The rows of a table of points for an output that is a table too.
pub(crate) fn text_rows_for(path: &Path, output: &Path) -> Result<Option<TextRows>> {
    let is_table = |path: &Path| ["csv", "txt", "xyz"].contains(&extension(path).as_str());
    if is_table(path) && is_table(output) { Ok(Some(read_text_rows(path)?)) } else { Ok(None) }
}
