//! Reading one cloud from one or several sources.

use std::path::{Path, PathBuf};

#[cfg(feature = "e57")]
use super::e57;
#[cfg(feature = "las")]
use super::las;
use super::part::FilePart;
#[cfg(feature = "ply")]
use super::ply;
use super::read_options::{ReadOptions, Reading, UpAxis};
use super::source::{Source, extension, unusable};
use super::{assemble, pcd, ptx, vpc, xyz};
#[cfg(feature = "npy")]
use super::{masbcpp, npy};
use belvedere_data::cloud::PointCloud;
use belvedere_data::control::Control;
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::{Error, Result};

/// File extensions [`read_cloud`] knows, in lower case.
pub const CLOUD_EXTENSIONS: &[&str] = &["las", "laz", "ply", "xyz", "txt", "csv", "pcd", "e57", "npy", "ptx"];

/// The same for messages.
const SUPPORTED: &str = ".las, .laz, .ply, .xyz, .txt, .csv, .pcd, .e57, .npy, .ptx, .vpc";

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
    /// Files of a folder that are no point clouds although their names look so: tables without x, y and z.
    pub skipped_files: Vec<PathBuf>,
    /// What should be known before the cloud is used.
    pub notes: Vec<String>,
    /// Row of each point among the points of its file, from 0, where [`ReadOptions::row_numbers`] requests it; empty
    /// otherwise. The points of the files follow each other as in `files`.
    pub rows: Vec<u64>,
}

/// What reading one file found.
#[derive(Clone, Debug, Default)]
pub struct FileReport {
    /// The path, or the name of the source.
    pub path: PathBuf,
    /// Its format, such as "LAS 1.2, point format 1, LAZ".
    pub format: String,
    /// Points taken from it.
    pub points: usize,
    /// Points left out, by reason.
    pub left_out: Vec<LeftOut>,
    /// Of these, points that the header announces but the file lacks: it is cut off.
    pub missing_points: usize,
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

/// One cloud from `sources`, in that order and the order of their points, with a report.
///
/// A path to a folder means all files in it with one of [`CLOUD_EXTENSIONS`], sorted by name; a folder with
/// `coords.npy` has the layout of masbcpp and is one cloud with its normals. A catalogue of tiles (`.vpc`) means its
/// files. Of a box ([`ReadOptions::within`]) only those files of a catalogue are opened, those LAS and LAZ files are
/// read beyond their header, and those chunks of COPC files are read, whose bounds meet it. The extension selects the
/// format, in upper or lower case.
///
/// Coordinates become metres by the unit of the reference system and f32 relative to a near origin: that of
/// [`ReadOptions::frame`], or else the middle, in whole metres, of the points within 10 km of the median point of all
/// files. Points more than 1000 km from the median (or from the given origin) along an axis, and points that are not
/// finite, are left out and counted. Colours that are all zero are none. An attribute that one of the files lacks is
/// dropped; files without any point are ignored. The result does not depend on the number of threads. The items of
/// progress are points. Tables without x, y and z in a folder are skipped and reported.
///
/// # Errors
/// [`Error::Io`], [`Error::UnknownFormat`], [`Error::MissingFeature`] and [`Error::Malformed`] about the source at
/// fault; [`Error::UnusableCrs`] for degrees, earth-centred coordinates and files whose systems differ from each other
/// or from that of the frame; [`Error::NoPoints`] where no file has a point; [`Error::InvalidParameter`] for options
/// that cannot be followed; [`Error::MissingAttribute`] where classes are requested but a file has none;
/// [`Error::Cancelled`].
pub fn read_cloud<'a, S: Into<Source<'a>>>(
    sources: impl IntoIterator<Item = S>,
    options: &ReadOptions,
    control: &Control<'_>,
) -> Result<(PointCloud, ReadReport)> {
    let forced = options.forced_crs()?;
    let reading = Reading { options, forced: forced.as_ref(), control };
    let mut systems = Systems::new(options);
    let mut parts: Vec<FilePart> = Vec::new();
    let (sources, skipped_files) = files_of(sources.into_iter().map(Into::into), &reading)?;
    for source in sources {
        control.check()?;
        let mut part = read_one(source, &reading)?;
        systems.accept(&mut part, &reading)?;
        if options.up == UpAxis::Y {
            part.turn_y_up();
        }
        part.check_attributes();
        part.check_precision();
        parts.push(part);
    }
    control.check()?;
    // black in all files is a field that nobody filled; black in one of several may be what was measured
    if parts.iter().all(FilePart::is_black) {
        parts.iter_mut().for_each(FilePart::drop_black);
    }
    let (cloud, report) = assemble::assemble(parts, options)?;
    Ok((cloud, ReadReport { skipped_files, ..report }))
}

/// The reference system that all files must share.
pub(super) struct Systems {
    /// The first that is known, and what names it.
    known: Option<(Crs, String)>,
}

impl Systems {
    pub(super) fn new(options: &ReadOptions) -> Self {
        let frame = options.frame.as_ref().filter(|frame| frame.crs.kind != CrsKind::Unknown);
        Self { known: frame.map(|frame| (frame.crs.clone(), "the frame to read into".to_owned())) }
    }

    /// Gives `part` the system of the option, and refuses one that cannot be used together with the others.
    pub(super) fn accept(&mut self, part: &mut FilePart, reading: &Reading<'_>) -> Result<()> {
        if let Some(crs) = reading.forced {
            part.set_crs(crs.clone(), "option");
        }
        let path = &part.report.path;
        if let Some(what) = part.crs.refusal(assemble::any_position(part)) {
            return Err(Error::UnusableCrs { path: path.clone(), what });
        }
        if part.crs.kind == CrsKind::Unknown {
            return Ok(());
        }
        match &self.known {
            None => self.known = Some((part.crs.clone(), path.display().to_string())),
            Some((crs, name)) if !crs.same_system(&part.crs) => {
                let what = format!(
                    "is in {}, but {name} is in {}; convert one of them, or say which holds for all",
                    part.crs.describe(),
                    crs.describe()
                );
                return Err(Error::UnusableCrs { path: path.clone(), what });
            }
            Some(_) => {}
        }
        Ok(())
    }
}

/// The files that `paths` mean: folders and catalogues of tiles (`.vpc`) replaced by their files, in the order that
/// [`read_cloud`] has.
///
/// # Errors
/// Those of [`read_cloud`] about folders and catalogues.
pub fn cloud_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let (options, control) = (ReadOptions::default(), Control::none());
    let reading = Reading { options: &options, forced: None, control: &control };
    let (sources, _) = files_of(paths.iter().map(Source::from), &reading)?;
    Ok(sources.iter().map(|source| source.name().to_owned()).collect())
}

/// The sources with folders and catalogues replaced by their files, and the files of folders that are tables of
/// something else. Tiles of catalogues that cannot have a point that `reading` requests are left out.
pub(super) fn files_of<'a>(
    sources: impl Iterator<Item = Source<'a>>,
    reading: &Reading<'_>,
) -> Result<(Vec<Source<'a>>, Vec<PathBuf>)> {
    let (mut found, mut skipped) = (Vec::new(), Vec::new());
    for source in sources {
        if source.extension() == "vpc" {
            let name = source.name().to_owned();
            let files = vpc::files_within(source, reading.box_of_unopened().as_ref())?;
            if files.is_empty() {
                let what = format!("no file of {} lies in the box to read", name.display());
                return Err(Error::NoPoints { what });
            }
            found.extend(files.into_iter().map(Source::path));
            continue;
        }
        let Some(folder) = source.folder().filter(|folder| !is_masbcpp(folder)) else {
            found.push(source);
            continue;
        };
        let (others, clouds): (Vec<PathBuf>, Vec<PathBuf>) =
            files_in(folder)?.into_iter().partition(|file| is_stray(file));
        if clouds.is_empty() {
            return Err(Error::malformed(folder, "the folder holds tables, but none with columns x, y and z"));
        }
        found.extend(clouds.into_iter().map(Source::path));
        skipped.extend(others);
    }
    if found.is_empty() {
        return Err(Error::NoPoints { what: "no file was given".to_owned() });
    }
    Ok((found, skipped))
}

/// Whether a file beside clouds is a table that belongs to them, such as a trajectory of other columns or a list of
/// tiles.
fn is_stray(file: &Path) -> bool {
    ["xyz", "txt", "csv"].contains(&extension(file).as_str())
        && Source::path(file).open().is_ok_and(xyz::is_another_table)
}

fn files_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries =
        folder.read_dir().and_then(Iterator::collect::<std::io::Result<Vec<_>>>).map_err(Error::io(folder))?;
    let mut files: Vec<PathBuf> = entries
        .into_iter()
        .map(|entry| entry.path())
        .filter(|file| file.is_file() && CLOUD_EXTENSIONS.contains(&extension(file).as_str()))
        .collect();
    if files.is_empty() {
        return Err(Error::malformed(folder, "the folder holds no point cloud file"));
    }
    files.sort();
    Ok(files)
}

/// Whether a folder has the layout of masbcpp.
fn is_masbcpp(folder: &Path) -> bool {
    folder.join("coords.npy").is_file()
}

/// The points of one source, without those that are not requested.
pub(super) fn read_one(source: Source<'_>, reading: &Reading<'_>) -> Result<FilePart> {
    if let Some(folder) = source.folder() {
        #[cfg(feature = "npy")]
        let part = masbcpp::read(folder);
        #[cfg(not(feature = "npy"))]
        let part = Err(Error::missing_feature(folder, "npy"));
        return selected(part?, reading);
    }
    let part = match source.extension().as_str() {
        // the points of these files are selected batch by batch
        #[cfg(feature = "las")]
        "las" | "laz" => return las::read(source, reading),
        #[cfg(feature = "ply")]
        "ply" => ply::read(source.open()?, reading),
        "xyz" | "txt" | "csv" => xyz::read(source.open()?, reading),
        "pcd" => pcd::read(source.open()?, reading),
        #[cfg(feature = "e57")]
        "e57" => e57::read(source.open()?, reading),
        #[cfg(feature = "npy")]
        "npy" => npy::read(source.open()?),
        "ptx" => ptx::read(source.open()?, reading),
        _ => Err(unusable(source.name(), "point cloud", SUPPORTED)),
    };
    selected(part?, reading)
}

fn selected(mut part: FilePart, reading: &Reading<'_>) -> Result<FilePart> {
    reading.control.advance(part.coordinates.len());
    part.keep_selected(reading)?;
    Ok(part)
}
