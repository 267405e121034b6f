//! Reading one cloud from one or several files.

use std::path::PathBuf;

use super::part::Part;
use super::write_cloud::extension;
use super::{assemble, e57, las, masbcpp, npy, pcd, ply, ptx, xyz};
use belvedere_data::cloud::PointCloud;
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::{Error, Result};

/// File extensions [`read_cloud`] knows, in lower case.
pub const CLOUD_EXTENSIONS: &[&str] = &["las", "laz", "ply", "xyz", "txt", "csv", "pcd", "e57", "npy", "ptx"];

/// How to read.
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    /// Reference system as for [`Crs::parse`], in place of what the files say. Default: none, the files are believed.
    pub crs: Option<String>,
}

/// What reading a cloud found.
#[derive(Clone, Debug, Default)]
pub struct ReadReport {
    /// One entry per file, in the order of their points.
    pub files: Vec<FileReport>,
    /// The reference system of the cloud in words, see [`Crs::describe`].
    pub crs: String,
    /// Where it was found, such as "WKT record" or "option"; empty where none is known.
    pub crs_source: String,
    /// Attributes that only some of the files have and the cloud therefore lacks.
    pub dropped_attributes: Vec<&'static str>,
    /// What should be known before the cloud is used.
    pub notes: Vec<String>,
}

/// What reading one file found.
#[derive(Clone, Debug, Default)]
pub struct FileReport {
    /// The file.
    pub path: PathBuf,
    /// Its format, such as "LAS 1.2, point format 1, LAZ".
    pub format: String,
    /// Points taken from it.
    pub points: usize,
    /// Points left out, by reason.
    pub left_out: Vec<LeftOut>,
    /// Names of the attributes found, as in [`belvedere_data::cloud::Attributes::columns`].
    pub attributes: Vec<&'static str>,
    /// Its reference system in words; empty where it gives none.
    pub crs: String,
    /// Where that was found; empty where nowhere.
    pub crs_source: String,
    /// What is odd about it.
    pub notes: Vec<String>,
}

/// Points left out for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// How many.
    pub count: usize,
    /// Why.
    pub reason: String,
}

impl ReadReport {
    /// Points left out of all files.
    #[must_use]
    pub fn left_out_count(&self) -> usize {
        self.files.iter().flat_map(|file| &file.left_out).map(|left_out| left_out.count).sum()
    }
}

/// One cloud from the files at `paths`, in that order and the order of their points, with a report.
///
/// A folder stands for all files in it with one of [`CLOUD_EXTENSIONS`], sorted by name; a folder with `coords.npy`
/// is masbcpp's layout and stands for one cloud with its normals. Formats are told by extension, in any case.
///
/// Coordinates become metres by the unit of the reference system and f32 relative to a near origin: the middle, in
/// whole metres, of the points within 10 km of the median point of all files. Points more than 1000 km from the
/// median along an axis, and points that are not finite, are left out and counted. An attribute that one of the files
/// lacks is dropped; files without any point count for nothing. The result does not depend on the number of threads.
///
/// # Errors
/// [`Error::Io`], [`Error::UnknownFormat`] and [`Error::Malformed`] about the file at fault; [`Error::UnusableCrs`] for
/// degrees, earth-centred coordinates and files whose systems differ; [`Error::NoPoints`] where no file has a point;
/// [`Error::InvalidParameter`] for a reference system in `options` that is not understood.
pub fn read_cloud(paths: &[PathBuf], options: &ReadOptions) -> Result<(PointCloud, ReadReport)> {
    let forced = options.crs.as_deref().map(Crs::parse).transpose()?;
    let mut parts: Vec<Part> = Vec::new();
    for source in sources(paths)? {
        let mut part = read_one(&source, forced.as_ref())?;
        if let Some(crs) = &forced {
            part.set_crs(crs.clone(), "option");
        }
        if let Some(why) = part.crs.refusal(assemble::any_position(&part)) {
            return Err(Error::UnusableCrs { path: part.report.path, what: why });
        }
        part.check_attributes();
        part.check_precision();
        let known = parts.iter().find(|earlier| earlier.crs.kind != CrsKind::Unknown);
        if let (Some(first), true) = (known, part.crs.kind != CrsKind::Unknown)
            && !first.crs.same_system(&part.crs)
        {
            return Err(Error::UnusableCrs {
                what: format!(
                    "is in {}, but {} is in {}; convert one of them, or say which holds for all",
                    part.crs.describe(),
                    first.report.path.display(),
                    first.crs.describe()
                ),
                path: part.report.path,
            });
        }
        parts.push(part);
    }
    assemble::assemble(parts)
}

/// A file, or a folder in masbcpp's layout.
enum Source {
    File(PathBuf),
    Masbcpp(PathBuf),
}

fn sources(paths: &[PathBuf]) -> Result<Vec<Source>> {
    let mut sources = Vec::new();
    for path in paths {
        if !path.is_dir() {
            sources.push(Source::File(path.clone()));
            continue;
        }
        if path.join(masbcpp::COORDINATES).is_file() {
            sources.push(Source::Masbcpp(path.clone()));
            continue;
        }
        let entries =
            path.read_dir().and_then(Iterator::collect::<std::io::Result<Vec<_>>>).map_err(Error::io(path))?;
        let mut files: Vec<PathBuf> = entries
            .into_iter()
            .map(|entry| entry.path())
            .filter(|file| file.is_file() && CLOUD_EXTENSIONS.contains(&extension(file).as_str()))
            .collect();
        if files.is_empty() {
            return Err(Error::malformed(path, "the folder holds no point cloud file"));
        }
        files.sort();
        sources.extend(files.into_iter().map(Source::File));
    }
    if sources.is_empty() {
        return Err(Error::NoPoints { what: "no file was given".to_owned() });
    }
    Ok(sources)
}

fn read_one(source: &Source, forced: Option<&Crs>) -> Result<Part> {
    let path = match source {
        Source::Masbcpp(folder) => return masbcpp::read(folder),
        Source::File(path) => path,
    };
    match extension(path).as_str() {
        "las" | "laz" => las::read(path, forced),
        "ply" => ply::read(path),
        "xyz" | "txt" | "csv" => xyz::read(path),
        "pcd" => pcd::read(path),
        "e57" => e57::read(path),
        "npy" => npy::read(path),
        "ptx" => ptx::read(path),
        _ => Err(Error::UnknownFormat {
            path: path.clone(),
            kind: "point cloud",
            supported: ".las, .laz, .ply, .xyz, .txt, .csv, .pcd, .e57, .npy, .ptx",
        }),
    }
}
