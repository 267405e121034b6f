//! Reading one cloud from one or several sources.

use std::path::{Path, PathBuf};

#[cfg(feature = "npy")]
use crate::arrays::masbcpp;
#[cfg(feature = "npy")]
use crate::arrays::npy;
use crate::files::source::{Source, extension, unusable};
#[cfg(feature = "las")]
use crate::las;
#[cfg(feature = "las")]
use crate::las::ept;
#[cfg(feature = "ply")]
use crate::ply;
use crate::points::assemble;
use crate::points::file_part::FilePart;
use crate::points::read_options::{ReadOptions, Reading, UpAxis};
use crate::points::read_report::ReadReport;
use crate::text::pcd;
use crate::text::ptx;
use crate::text::xyz;
use crate::vpc;
use belvedere_data::cloud::PointCloud;
use belvedere_data::contradiction::FoundContradiction;
use belvedere_data::control::Control;
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::{Error, Result};

/// File extensions [`read_cloud`] knows, in lower case.
pub const CLOUD_EXTENSIONS: &[&str] =
    &["las", "laz", "ply", "xyz", "txt", "csv", "pts", "asc", "pcd", "e57", "npy", "ptx"];

/// Names of passed-over files that a note gives.
const MAX_NAMED: usize = 5;

/// The same for messages.
const SUPPORTED: &str = ".las, .laz, .ply, .xyz, .txt, .csv, .pts, .asc, .pcd, .e57, .npy, .ptx, .vpc, ept.json";

/// One cloud from `sources`, in that order and the order of their points, with a report.
///
/// A path to a folder means all files in it with one of [`CLOUD_EXTENSIONS`], sorted by name. A folder with
/// `coords.npy` has the layout of masbcpp and is one cloud with its normals. A catalogue of tiles (`.vpc`) means its
/// files, and so do entwine point tiles (`ept.json`, or its folder, with LAZ nodes).
///
/// With a box ([`ReadOptions::within`]) only files of a catalogue whose bounds meet it are opened. The same holds for
/// LAS and LAZ files beyond their header, and for chunks of COPC files. The extension selects the format, in upper or
/// lower case.
///
/// Coordinates become metres by the unit of the reference system and f32 relative to a near origin. The origin is that
/// of [`ReadOptions::frame`], or else the middle, in whole metres, of the points within 10 km of the median point of
/// all files. Points more than 1000 km from the median (or from the given origin) along an axis, and points that are
/// not finite, are left out and counted. A file of several that lies there as a whole is refused, unless
/// [`ReadOptions::distant`] accepts it.
///
/// Colours that are all zero are none. An attribute that one of the files lacks is dropped; files without any point are
/// ignored. The result does not depend on the number of threads. The items of progress are points. Tables without x, y
/// and z in a folder are skipped and reported.
///
/// # Errors
/// - [`Error::Io`], [`Error::UnknownFormat`], [`Error::MissingFeature`] and [`Error::Malformed`] about the source at
///   fault.
/// - [`Error::UnusableCrs`] for degrees, earth-centred coordinates and files whose systems differ from each other or
///   from that of the frame.
/// - [`Error::DistantFile`].
/// - [`Error::NoPoints`] if no file has a point.
/// - [`Error::InvalidParameter`] for options that cannot be followed.
/// - [`Error::MissingAttribute`] if classes are requested but a file has none.
/// - [`Error::Cancelled`].
pub fn read_cloud<'a, S: Into<Source<'a>>>(
    sources: impl IntoIterator<Item = S>,
    options: &ReadOptions,
    control: &Control<'_>,
) -> Result<(PointCloud, ReadReport)> {
    let forced = options.forced_crs()?;
    let reading = Reading { options, forced: forced.as_ref(), control };
    let mut systems = Systems::new(options);
    let mut parts: Vec<FilePart> = Vec::new();
    let CloudFiles { sources, tables, notes, contradictions } =
        files_of(sources.into_iter().map(Into::into), &reading)?;
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
    let (cloud, mut report) = assemble::assemble(parts, options)?;
    report.notes.splice(..0, notes);
    report.contradictions.splice(..0, contradictions);
    Ok((cloud, ReadReport { skipped_files: tables, ..report }))
}

/// The reference system that all files must share.
pub(crate) struct Systems {
    /// The first known system, and the name of its source.
    known: Option<(Crs, String)>,
}

impl Systems {
    pub(crate) fn new(options: &ReadOptions) -> Self {
        let frame = options.frame.as_ref().filter(|frame| frame.crs.kind != CrsKind::Unknown);
        Self { known: frame.map(|frame| (frame.crs.clone(), "the frame to read into".to_owned())) }
    }

    /// Gives `part` the system of the option, and refuses one that cannot be used together with the others.
    pub(crate) fn accept(&mut self, part: &mut FilePart, reading: &Reading<'_>) -> Result<()> {
        let somewhere = part.somewhere.unwrap_or_else(|| assemble::any_position(part));
        // a file without a point lies nowhere
        let is_empty = part.somewhere.is_none() && part.coordinates.len() == 0;
        let on_map = if is_empty { [f64::NAN; 2] } else { [somewhere[0], somewhere[1]] };
        if reading.forced.is_some() {
            reading.check_given(&part.crs, on_map, &part.report.path)?;
            part.set_crs(reading.system(&part.crs), "option");
        }
        let path = &part.report.path;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        part.crs.doubt = part.crs.doubt.take().map(|doubt| format!("{name}: {doubt}"));
        if let Some(what) = part.crs.refusal(somewhere) {
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
    Ok(cloud_sources(paths)?.0.iter().map(|source| source.name().to_owned()).collect())
}

/// The same files, each with its entry in a hierarchy or a catalogue; and contradictions among these.
///
/// # Errors
/// Those of [`cloud_files`].
pub fn cloud_sources(paths: &[PathBuf]) -> Result<(Vec<Source<'_>>, Vec<FoundContradiction>)> {
    let (options, control) = (ReadOptions::default(), Control::none());
    let reading = Reading { options: &options, forced: None, control: &control };
    let files = files_of(paths.iter().map(Source::from), &reading)?;
    Ok((files.sources, files.contradictions))
}

/// Files of a cloud, after folders and catalogues were replaced by their files.
#[derive(Default)]
pub(crate) struct CloudFiles<'a> {
    pub(crate) sources: Vec<Source<'a>>,
    /// Files of folders that are tables or grids of something else.
    tables: Vec<PathBuf>,
    /// Notes on skipped files of folders.
    notes: Vec<String>,
    /// Contradictions in catalogues.
    contradictions: Vec<FoundContradiction>,
}

/// The sources with folders and catalogues replaced by their files. Tiles of catalogues that cannot have a point that
/// `reading` requests are left out.
pub(crate) fn files_of<'a>(sources: impl Iterator<Item = Source<'a>>, reading: &Reading<'_>) -> Result<CloudFiles<'a>> {
    let mut found = CloudFiles::default();
    for source in sources {
        let name = source.name().to_owned();
        let source = match opened(source, reading)? {
            Opened::Other(source) => *source,
            Opened::Catalogue(files, _) if files.is_empty() => {
                let what = format!("no file of {} lies in the box to read", name.display());
                return Err(Error::NoPoints { what });
            }
            Opened::Catalogue(files, contradictions) => {
                found.sources.extend(files);
                found.contradictions.extend(contradictions);
                continue;
            }
        };
        let Some(folder) = source.folder().filter(|folder| !is_masbcpp(folder)) else {
            found.sources.push(source);
            continue;
        };
        let (files, note) = files_in(folder)?;
        let beside_scans = files.iter().any(|file| !is_text(file));
        let is_stray = |file: &PathBuf| is_text(file) && is_another_table(file, beside_scans);
        let (others, clouds): (Vec<PathBuf>, Vec<PathBuf>) = files.into_iter().partition(is_stray);
        if clouds.is_empty() {
            return Err(Error::malformed(folder, "the folder holds tables, but none with columns x, y and z"));
        }
        found.sources.extend(clouds.into_iter().map(Source::path));
        found.tables.extend(others);
        found.notes.extend(note);
    }
    if found.sources.is_empty() {
        return Err(Error::NoPoints { what: "no file was given".to_owned() });
    }
    Ok(found)
}

/// Kind of a source.
enum Opened<'a> {
    /// A catalogue, with its files that may have points in the box to read, and its contradictions.
    Catalogue(Vec<Source<'static>>, Vec<FoundContradiction>),
    Other(Box<Source<'a>>),
}

fn opened<'a>(source: Source<'a>, reading: &Reading<'_>) -> Result<Opened<'a>> {
    let wanted = reading.box_of_unopened();
    #[cfg(feature = "las")]
    if let Some(description) = ept::description(&source) {
        let found = ept::files_within(&description, wanted.as_ref(), reading.control)?;
        return Ok(Opened::Catalogue(found.files, found.contradictions));
    }
    if source.extension() != "vpc" {
        return Ok(Opened::Other(Box::new(source)));
    }
    Ok(Opened::Catalogue(vpc::files_within(source, wanted.as_ref())?, Vec::new()))
}

fn is_text(file: &Path) -> bool {
    ["xyz", "txt", "csv", "pts", "asc"].contains(&extension(file).as_str())
}

/// Returns true if a text file of a folder is a table or a grid that belongs to its clouds. Examples are a list of
/// tiles, a model of the ground, or, `beside_scans`, a trajectory or the positions of a scanner.
fn is_another_table(file: &Path, beside_scans: bool) -> bool {
    Source::path(file).open_text().is_ok_and(|input| xyz::is_another_table(input, beside_scans))
}

/// The files of a folder with an extension of clouds, by name, and a note on the others. Those that systems and
/// programs keep for themselves begin with a point or with `~$`, as `._tile.laz` of macOS.
fn files_in(folder: &Path) -> Result<(Vec<PathBuf>, Option<String>)> {
    let entries =
        folder.read_dir().and_then(Iterator::collect::<std::io::Result<Vec<_>>>).map_err(Error::io(folder))?;
    let files = entries.into_iter().map(|entry| entry.path()).filter(|path| path.is_file());
    let name = |file: &PathBuf| file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let (mut files, mut others): (Vec<PathBuf>, Vec<PathBuf>) = files.partition(|file| {
        let name = name(file);
        CLOUD_EXTENSIONS.contains(&extension(file).as_str()) && !name.starts_with('.') && !name.starts_with("~$")
    });
    if files.is_empty() {
        return Err(Error::malformed(folder, "the folder holds no point cloud file"));
    }
    files.sort();
    others.sort();
    let named: Vec<String> = others.iter().take(MAX_NAMED).map(name).collect();
    let note = || {
        let more = if others.len() > MAX_NAMED { ", …" } else { "" };
        let (folder, count) = (folder.display(), others.len());
        format!("{folder}: files that are no point clouds were passed over: {count} ({}{more})", named.join(", "))
    };
    let note = (!others.is_empty()).then(note);
    Ok((files, note))
}

/// Returns true if a folder has the layout of masbcpp.
fn is_masbcpp(folder: &Path) -> bool {
    folder.join("coords.npy").is_file()
}

/// The points of one source, without those that are not requested.
pub(crate) fn read_one(source: Source<'_>, reading: &Reading<'_>) -> Result<FilePart> {
    if let Some(folder) = source.folder() {
        #[cfg(feature = "npy")]
        let part = masbcpp::read(folder);
        #[cfg(not(feature = "npy"))]
        let part = Err(Error::missing_feature(folder, "npy"));
        return selected(part?, reading);
    }
    let beside = source.system_beside();
    let mut part = match source.extension().as_str() {
        // the points of these files are selected batch by batch
        #[cfg(feature = "las")]
        "las" | "laz" => return las::read(source, reading),
        #[cfg(feature = "ply")]
        "ply" => ply::read(source.open()?, reading),
        "xyz" | "txt" | "csv" | "pts" | "asc" => xyz::read(source.open_text()?, reading),
        "pcd" => pcd::read(source.open()?, reading),
        #[cfg(feature = "e57")]
        "e57" => crate::e57::read(source.open()?, reading),
        #[cfg(feature = "npy")]
        "npy" => npy::read(source.open()?),
        "ptx" => ptx::read(source.open_text()?, reading),
        _ => Err(unusable(source.name(), "point cloud", SUPPORTED)),
    }?;
    if beside.is_some() {
        let [x, y, _] = assemble::any_position(&part);
        part.take_system(beside, [x, y]);
    }
    selected(part, reading)
}

fn selected(mut part: FilePart, reading: &Reading<'_>) -> Result<FilePart> {
    reading.control.advance(part.coordinates.len());
    part.keep_selected(reading)?;
    Ok(part)
}
