//! Sources of input: a file, an address of the web, bytes in memory, or any reader.

use std::fs::File;
use std::io::{BufReader, Cursor, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::files::announced::Announced;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// Reader that a [`Source`] can use. Implemented for everything that reads, seeks and may move to another thread.
pub trait ReadSeek: Read + Seek + Send {}
impl<T: Read + Seek + Send> ReadSeek for T {}

/// Bytes read ahead of the parser: more than most headers, and little beside a window of a large file or a chunk of
/// one.
const BUFFER_BYTES: usize = 1 << 12;

/// One input with a name. The extension of the name selects the format; messages about the input begin with the name.
///
/// Paths become sources by themselves: a path is accepted wherever a source is expected. So is the address of a file on
/// a web server (`https://…`, `http://…`). Only the parts that are read are transferred, if the server gives parts of
/// files (HTTP ranges).
///
/// ```
/// use belvedere_io::{ReadOptions, Source, read_cloud};
/// use belvedere_data::control::Control;
///
/// # fn main() -> belvedere_data::Result<()> {
/// let text = b"x y z\n1 2 3\n4 5 6\n";
/// let (cloud, _report) = read_cloud([Source::bytes("points.xyz", text)], &ReadOptions::default(), &Control::none())?;
/// assert_eq!(cloud.len(), 2);
/// # Ok(())
/// # }
/// ```
pub struct Source<'a> {
    pub(crate) name: PathBuf,
    pub(crate) content: Content<'a>,
    /// Rows of points that are not known to lie beside a window.
    pub(crate) likely_rows: Option<Vec<Range<u64>>>,
    /// The system of a source that names none, where a catalogue gives it.
    pub(crate) system: Option<SystemBeside>,
    /// Description of its points by a hierarchy or a catalogue.
    pub(crate) announced: Option<Announced>,
}

/// Reference system from a file beside it.
#[derive(Clone, Debug, PartialEq)]
pub enum SystemBeside {
    /// A system, and the file that names it.
    Known {
        /// The system.
        crs: Crs,
        /// Name of that file, such as "tile.prj".
        found_in: String,
    },
    /// A file that should name a system, which cannot be read.
    Unreadable {
        /// The file.
        found_in: String,
    },
}

pub(crate) enum Content<'a> {
    /// The file, folder or address that the source is named after.
    Path,
    Reader(Box<dyn ReadSeek + 'a>),
}

impl<'a> Source<'a> {
    /// The file or folder at `path`, or the file at an address of the web. User, password and key of that are no part
    /// of its name ([`crate::hidden`]).
    #[must_use]
    pub fn path(path: impl Into<PathBuf>) -> Self {
        Self::of(crate::files::secrets::hidden(&path.into()), Content::Path)
    }

    /// Bytes in memory, such as a download. `name` needs an extension, such as `tile.laz`.
    #[must_use]
    pub fn bytes(name: impl Into<PathBuf>, bytes: &'a (impl AsRef<[u8]> + ?Sized)) -> Self {
        Self::reader(name, Cursor::new(bytes.as_ref()))
    }

    /// Anything that reads and seeks, from its first byte to its last. `name` needs an extension, such as `tile.laz`.
    #[must_use]
    pub fn reader(name: impl Into<PathBuf>, reader: impl Read + Seek + Send + 'a) -> Self {
        Self::of(name.into(), Content::Reader(Box::new(reader)))
    }

    fn of(name: PathBuf, content: Content<'a>) -> Self {
        Self { name, content, likely_rows: None, system: None, announced: None }
    }

    /// Adds the rows that may hold points of a window ([`crate::ReadOptions::within`]): ranges of rows from 0, in their
    /// order and without a row in two of them. Pieces and chunks of LAS and LAZ files without such rows are then not
    /// read. Other formats, and COPC, which has a hierarchy, have better means or are read whole. Points beside the
    /// window are left out as always.
    #[must_use]
    pub fn with_likely_rows(mut self, rows: Vec<Range<u64>>) -> Self {
        self.likely_rows = Some(rows);
        self
    }

    /// The path, or the name that was given.
    #[must_use]
    pub fn name(&self) -> &Path {
        &self.name
    }

    /// Returns true for a file or folder on this machine, beside which others may lie.
    pub(crate) fn is_on_disk(&self) -> bool {
        matches!(self.content, Content::Path) && web_address(&self.name).is_none()
    }

    /// The extension of the name in lower case; empty where there is none.
    #[must_use]
    pub fn extension(&self) -> String {
        extension(&self.name)
    }

    /// Returns the description of its points by a hierarchy or a catalogue, as text that changes with it.
    #[must_use]
    pub fn announced_in_words(&self) -> String {
        self.announced.as_ref().map(|announced| format!("{announced:?}")).unwrap_or_default()
    }

    /// The folder at the path, where the source is one.
    pub(crate) fn folder(&self) -> Option<&Path> {
        (matches!(self.content, Content::Path) && self.name.is_dir()).then_some(self.name.as_path())
    }

    /// Opens the source at its first byte.
    pub(crate) fn open(self) -> Result<Input<'a>> {
        let (name, OpenSource { reader, size, .. }) = self.opened()?;
        Ok(Input { name, reader: BufReader::with_capacity(BUFFER_BYTES, reader), size })
    }

    fn opened(self) -> Result<(PathBuf, OpenSource<'a>)> {
        let Self { name, content, .. } = self;
        let opened = match content {
            Content::Path if web_address(&name).is_some() => remote(&name)?,
            Content::Path => {
                // opening a pipe would wait for somebody who writes into it
                if !std::fs::metadata(&name).map_err(Error::io(&name))?.is_file() {
                    return Err(Error::malformed(&name, "is not a file: save what it gives first"));
                }
                let file = File::open(&name).map_err(Error::io(&name))?;
                let metadata = file.metadata().map_err(Error::io(&name))?;
                let modified =
                    metadata.modified().ok().and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
                let version = modified.map(|time| time.as_nanos().to_string());
                OpenSource { reader: Box::new(file), size: metadata.len(), version }
            }
            Content::Reader(mut reader) => {
                let size = reader.seek(SeekFrom::End(0)).map_err(Error::io(&name))?;
                reader.seek(SeekFrom::Start(0)).map_err(Error::io(&name))?;
                OpenSource { reader, size, version: None }
            }
        };
        Ok((name, opened))
    }

    /// The source at its first byte, without a buffer, and a value that tells its versions apart.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Malformed`] for a path that is no file.
    pub fn into_versioned_reader(self) -> Result<OpenSource<'a>> {
        Ok(self.opened()?.1)
    }

    /// A reader at the first byte of the source, and its size in bytes.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Malformed`] for a path that is no file.
    pub fn into_reader(self) -> Result<(impl Read + Seek + Send + 'a, u64)> {
        let input = self.open()?;
        Ok((input.reader, input.size))
    }

    /// The same, as UTF-8 where it is UTF-16.
    pub(crate) fn open_text(self) -> Result<Input<'a>> {
        self.open()?.into_utf8()
    }

    /// The name and all bytes of a text, as UTF-8 without a byte order mark.
    pub(crate) fn read_text(self) -> Result<(PathBuf, Vec<u8>)> {
        let Input { name, mut reader, size } = self.open_text()?;
        let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
        reader.read_to_end(&mut bytes).map_err(Error::io(&name))?;
        if bytes.starts_with(UTF8_MARK) {
            bytes.drain(..UTF8_MARK.len());
        }
        Ok((name, bytes))
    }

    /// The name and all bytes of the source.
    pub(crate) fn read_all(self) -> Result<(PathBuf, Vec<u8>)> {
        let Input { name, mut reader, size } = self.open()?;
        let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
        reader.read_to_end(&mut bytes).map_err(Error::io(&name))?;
        Ok((name, bytes))
    }
}

/// A source at its first byte.
pub struct OpenSource<'a> {
    /// Reads it, without a buffer.
    pub reader: Box<dyn ReadSeek + 'a>,
    /// Size, bytes.
    pub size: u64,
    /// Version that changes with its content: the time of the last change of a file, nanoseconds since 1970, or the
    /// version named by a server. `None` if that is not known.
    pub version: Option<String>,
}

/// An open source.
pub(crate) struct Input<'a> {
    /// For messages.
    pub(crate) name: PathBuf,
    pub(crate) reader: SourceReader<'a>,
    /// Number of bytes.
    pub(crate) size: u64,
}

/// Byte order mark of UTF-8.
const UTF8_MARK: &[u8] = b"\xef\xbb\xbf";

impl<'a> Input<'a> {
    /// Converts UTF-16, which spreadsheets call "Unicode text", to UTF-8. It has a byte order mark, or a zero in each
    /// of the first characters, which no text has.
    pub(crate) fn into_utf8(mut self) -> Result<Self> {
        let mut start = Vec::new();
        (&mut self.reader).take(4).read_to_end(&mut start).map_err(Error::io(&self.name))?;
        self.reader.seek(SeekFrom::Start(0)).map_err(Error::io(&self.name))?;
        let decode = match start[..] {
            [0xff, 0xfe, 0, 0] | [0, 0, 0xfe, 0xff] => {
                return Err(Error::malformed(&self.name, "is UTF-32; save it as UTF-8"));
            }
            [0xff, 0xfe, ..] | [1..=255, 0, 1..=255, 0] => u16::from_le_bytes,
            [0xfe, 0xff, ..] | [0, 1..=255, 0, 1..=255] => u16::from_be_bytes,
            _ => return Ok(self),
        };
        let mut bytes = Vec::new();
        self.reader.read_to_end(&mut bytes).map_err(Error::io(&self.name))?;
        let units = bytes.as_chunks::<2>().0.iter().map(|&unit| decode(unit));
        let text: String = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        let text = text.trim_start_matches('\u{feff}').to_owned().into_bytes();
        let size = text.len() as u64;
        let reader: Box<dyn ReadSeek + 'a> = Box::new(Cursor::new(text));
        Ok(Self { name: self.name, reader: BufReader::with_capacity(BUFFER_BYTES, reader), size })
    }
}

/// Returns the path of a file that a catalogue in `folder` names; either may be an address.
pub(crate) fn place_in(folder: &Path, path: &str) -> PathBuf {
    if web_address(Path::new(path)).is_some() {
        return PathBuf::from(path);
    }
    match web_address(folder) {
        // servers know no `.`
        Some(folder) => format!("{}/{}", folder.trim_end_matches('/'), path.trim_start_matches("./")).into(),
        None => folder.join(path),
    }
}

/// The folder of a file, and the part of an address behind its path, such as a key, `ept.json?sig=KEY`: files below it
/// need it too.
pub(crate) fn folder_and_query(file: &Path) -> (PathBuf, &str) {
    let text = web_address(file).unwrap_or_default();
    let plain = text.split(['?', '#']).next().unwrap_or_default();
    let folder = if text.is_empty() { file } else { Path::new(plain) }.parent().unwrap_or(Path::new(""));
    let query = text.get(plain.len()..).and_then(|rest| rest.split('#').next()).unwrap_or_default();
    (folder.to_owned(), query)
}

/// Returns the path of a file that another one names with `path`, in the `folder` and with the `query` of that one. A
/// path to another server, or with a query of its own, gets none.
pub(crate) fn place_beside((folder, query): &(PathBuf, &str), path: &str) -> PathBuf {
    let place = place_in(folder, path);
    match web_address(&place) {
        Some(address) if web_address(Path::new(path)).is_none() && !address.contains('?') && !query.is_empty() => {
            format!("{address}{query}").into()
        }
        _ => place,
    }
}

/// Reader of an open source.
pub(crate) type SourceReader<'a> = BufReader<Box<dyn ReadSeek + 'a>>;

/// The file at an address of the web.
#[cfg(feature = "http")]
fn remote<'a>(name: &Path) -> Result<OpenSource<'a>> {
    let Some(address) = crate::files::secrets::whole(web_address(name).unwrap_or_default()) else {
        let what = "its user, password or key is not known here, since none is ever written down; \
                    give the whole address, or download the file";
        return Err(Error::malformed(name, what));
    };
    let file = crate::files::remote::Remote::open(&address).map_err(Error::io(name))?;
    let (size, version) = (file.size(), file.version().map(str::to_owned));
    Ok(OpenSource { reader: Box::new(file), size, version })
}

#[cfg(not(feature = "http"))]
fn remote<'a>(name: &Path) -> Result<OpenSource<'a>> {
    Err(Error::missing_feature(name, "http"))
}

/// The address of the web that a path is.
#[must_use]
pub fn web_address(path: &Path) -> Option<&str> {
    let text = path.to_str()?;
    let is_address = |start: &str| text.get(..start.len()).is_some_and(|own| own.eq_ignore_ascii_case(start));
    ["https://", "http://"].into_iter().any(is_address).then_some(text)
}

/// Extension in lower case, empty where there is none. An address ends before its query.
pub(crate) fn extension(path: &Path) -> String {
    let path = web_address(path).and_then(|text| text.split(['?', '#']).next()).map_or(path, Path::new);
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// An error with the conversion to run, for formats of shapes that are not read.
pub(crate) fn refuse_other_shapes(name: &Path) -> Result<()> {
    let format = match extension(name).as_str() {
        "dbf" | "shx" | "prj" => "a part of a Shapefile",
        "kml" | "kmz" => "KML",
        "gml" => "GML",
        _ => return Ok(()),
    };
    let file = name.display();
    let what = format!(
        "is {format}; convert it to GeoJSON: ogr2ogr -f GeoJSON {} {file}",
        name.with_extension("geojson").display()
    );
    Err(Error::malformed(name, what))
}

/// Why a name is of no use: its format was not built in, or is none of `supported`, the extensions that would do.
pub(crate) fn unusable(name: &Path, kind: &'static str, supported: &'static str) -> Error {
    let extension = extension(name);
    let feature = match extension.as_str() {
        "las" | "laz" if !cfg!(feature = "las") => Some("las"),
        "ply" if !cfg!(feature = "ply") => Some("ply"),
        "e57" if !cfg!(feature = "e57") => Some("e57"),
        "npy" | "npz" if !cfg!(feature = "npy") => Some("npy"),
        _ => None,
    };
    match feature.filter(|_| supported.contains(&format!(".{extension}"))) {
        Some(feature) => Error::missing_feature(name, feature),
        None => Error::UnknownFormat { path: name.to_owned(), kind, supported },
    }
}

impl From<PathBuf> for Source<'_> {
    fn from(path: PathBuf) -> Self {
        Self::path(path)
    }
}

impl From<&PathBuf> for Source<'_> {
    fn from(path: &PathBuf) -> Self {
        Self::path(path)
    }
}

impl From<&Path> for Source<'_> {
    fn from(path: &Path) -> Self {
        Self::path(path)
    }
}

impl From<&str> for Source<'_> {
    fn from(path: &str) -> Self {
        Self::path(path)
    }
}
