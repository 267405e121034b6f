//! Files of a survey, and the test that they are unchanged since the plan was made.

use belvedere::apps::ask::Remark;
use belvedere::cast::to_i32;
use belvedere::contradiction::FoundContradiction;
use belvedere::io::{LasHead, OpenSource, ReadSeek, Source, hidden, read_las_head, web_address};
use belvedere::{Bounds, Error, GpsTimeKind, Result};
use serde::{Deserialize, Serialize};
use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Number of samples of a file for its fingerprint, and bytes of each. The samples alone find random changes in one
/// hundredth of the file.
const SAMPLES: u64 = 64;
const SAMPLE_BYTES: u64 = 1 << 12;
/// Number of samples of a file on a server, where each sample is a request.
const REMOTE_SAMPLES: u64 = 4;
/// Bytes at either end of a file on the disk that are sampled too, because headers and tables lie there.
const ENDS: u64 = 1 << 16;
/// Bytes read at once for the checksum of a whole file.
const AT_ONCE: usize = 1 << 20;

/// File of a survey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InputFile {
    /// Path or web address.
    pub path: PathBuf,
    /// Size, bytes.
    pub bytes: u64,
    /// Number of points.
    pub points: u64,
    /// Lowest and highest corner, in the coordinates of the file.
    pub bounds: [[f64; 3]; 2],
    /// CRC-32 over its size and samples all over it, as hexadecimal digits.
    pub fingerprint: String,
    /// Time of the last change, or the version on its server, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    version: Option<String>,
    /// CRC-32 of the whole file, as hexadecimal digits; `None` for a file on a server.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    contents: Option<String>,
    /// Last version that proved to be the file of the plan, so that the file is compared once.
    #[serde(skip)]
    compared: OnceLock<Option<String>>,
    /// Rectangle around each piece of its rows: west, south, east and north, whole local metres. Empty if unknown.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) pieces: Vec<PieceCell>,
}

/// Number of rows of a file in one piece: a chunk of most LAZ files.
pub(crate) const PIECE_ROWS: u64 = 50_000;

/// West, south, east and north of a piece, whole local metres.
pub(crate) type PieceCell = [i32; 4];

/// Rectangle of a piece without points, which meets nothing.
pub(crate) const NOWHERE: PieceCell = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];

/// Widens a rectangle to hold a local position.
pub(crate) fn hold([west, south, east, north]: &mut PieceCell, [x, y, _]: [f32; 3]) {
    let [x, y] = [x, y].map(f64::from);
    (*west, *south) = ((*west).min(to_i32(x.floor())), (*south).min(to_i32(y.floor())));
    (*east, *north) = ((*east).max(to_i32(x.ceil())), (*north).max(to_i32(y.ceil())));
}

/// Returns remarks on a file from its header.
pub(crate) fn remarks_on_file(path: &Path, head: &LasHead) -> Vec<Remark> {
    let path = path.display().to_string();
    let notes = head.notes.iter().map(|note| Remark::note("file-odd", format!("{path}: {note}")));
    let contradictions = head.contradictions.iter().filter_map(|found| {
        Remark::of_contradiction(FoundContradiction { text: format!("{path}: {}", found.text), ..found.clone() })
    });
    notes.chain(contradictions).collect()
}

impl InputFile {
    /// Returns a file in its present state, with its header.
    ///
    /// # Errors
    /// Those of [`read_las_head`].
    pub(crate) fn new(source: Source<'_>) -> Result<(Self, LasHead)> {
        let name = source.name().to_owned();
        let path = name.as_path();
        if !["las", "laz"].contains(&source.extension().as_str()) {
            return Err(Error::UnknownFormat {
                path: path.to_owned(),
                kind: "tile",
                supported: ".las, .laz, .copc.laz; convert other clouds first",
            });
        }
        let head = read_las_head(source)?;
        if head.missing_points > 0 {
            let (points, announced) = (head.points, head.points + head.missing_points);
            let what = format!("is cut off: it holds {points} of the {announced} points of its header; copy it again");
            return Err(Error::malformed(path, what));
        }
        let path = absolute(path)?;
        let mut version = FileVersion::of(&path)?;
        let file = Self {
            fingerprint: version.fingerprint(&path)?,
            contents: if web_address(&path).is_none() { Some(contents(&path)?) } else { None },
            version: version.name,
            compared: OnceLock::new(),
            bytes: version.bytes,
            points: head.points,
            bounds: head.bounds,
            pieces: Vec::new(),
            path,
        };
        Ok((file, head))
    }

    /// Returns the file, restricted to rows that may lie in a column of local coordinates.
    pub(crate) fn source_within(&self, column: &Bounds) -> Source<'static> {
        let source = Source::path(&self.path);
        if self.pieces.is_empty() {
            return source;
        }
        let [low, high] = [column.low, column.high].map(|end| end.map(f64::from));
        let meets = |&[west, south, east, north]: &PieceCell| {
            let [west, south, east, north] = [west, south, east, north].map(f64::from);
            west <= high[0] && low[0] <= east && south <= high[1] && low[1] <= north
        };
        let mut rows: Vec<Range<u64>> = Vec::new();
        for (number, _) in (0_u64..).zip(&self.pieces).filter(|(_, piece)| meets(piece)) {
            let [from, to] = [number, number + 1].map(|number| number * PIECE_ROWS);
            match rows.last_mut() {
                Some(last) if last.end == from => last.end = to,
                _ => rows.push(from..to),
            }
        }
        source.with_likely_rows(rows)
    }

    /// True if the number of pieces fits the number of points, or pieces are unknown.
    pub(crate) fn has_sound_pieces(&self) -> bool {
        self.pieces.is_empty() || self.pieces.len() as u64 == self.points.div_ceil(PIECE_ROWS)
    }

    /// Refuses a changed file. Its size and its samples are compared, and with another time its whole content. For a
    /// file on a server, its version, its size and its samples are compared.
    ///
    /// # Errors
    /// [`Error::Io`] for a missing file, [`Error::Malformed`] for a changed file.
    pub(crate) fn check(&self) -> Result<()> {
        let path = &self.path;
        let is_remote = web_address(path).is_some();
        let changed = || {
            let place = if is_remote { "changed on the server since" } else { "is no longer what it was when" };
            Err(Error::malformed(path, format!("{place} the plan was made; make the plan again")))
        };
        let mut now = FileVersion::of(path)?;
        let was_compared = self.compared.get() == Some(&now.name);
        if now.bytes != self.bytes {
            return changed();
        }
        // Samples of a file on a server are taken once. Samples of a file on the disk also find changes that keep its
        // time.
        if is_remote && was_compared && now.name.is_some() {
            return Ok(());
        }
        if now.fingerprint(path)? != self.fingerprint {
            return changed();
        }
        if now.name != self.version && !was_compared {
            match &self.contents {
                Some(before) if contents(path)? == *before => {}
                _ => return changed(),
            }
        }
        self.compared.get_or_init(|| now.name);
        Ok(())
    }
}

/// Returns the place of a file, independent of the folder in which the program is started.
pub(crate) fn absolute(path: &Path) -> Result<PathBuf> {
    match web_address(path) {
        Some(_) => Ok(hidden(path)),
        None => std::path::absolute(path).map_err(Error::io(path)),
    }
}

/// Data of a file that are known without reading its content.
struct FileVersion {
    reader: Box<dyn ReadSeek>,
    bytes: u64,
    /// Time of the last change, or the version on its server.
    name: Option<String>,
}

impl FileVersion {
    fn of(path: &Path) -> Result<Self> {
        let OpenSource { reader, size, version } = Source::path(path).into_versioned_reader()?;
        Ok(Self { reader, bytes: size, name: version })
    }

    /// Returns the hash of the size of a file and of samples all over it.
    fn fingerprint(&mut self, path: &Path) -> Result<String> {
        let (samples, ends) =
            if web_address(path).is_some() { (REMOTE_SAMPLES, SAMPLE_BYTES) } else { (SAMPLES, ENDS) };
        let last = |length: u64| self.bytes.saturating_sub(length);
        let mut parts = vec![(0, ends)];
        let place = |number: u64| u128::from(last(SAMPLE_BYTES)) * u128::from(number) / u128::from(samples);
        parts.extend((1..samples).map(|number| (u64::try_from(place(number)).unwrap_or(0), SAMPLE_BYTES)));
        parts.push((last(ends), ends));
        let mut bytes = self.bytes.to_le_bytes().to_vec();
        for (start, length) in parts {
            self.reader.seek(SeekFrom::Start(start)).map_err(Error::io(path))?;
            self.reader.by_ref().take(length).read_to_end(&mut bytes).map_err(Error::io(path))?;
        }
        Ok(hash(&bytes))
    }
}

/// Returns the hash of a whole file.
fn contents(path: &Path) -> Result<String> {
    let mut file = Source::path(path).into_versioned_reader()?.reader;
    let (mut sum, mut bytes) = (crc32fast::Hasher::new(), vec![0; AT_ONCE]);
    loop {
        match file.read(&mut bytes).map_err(Error::io(path))? {
            0 => return Ok(format!("{:08x}", sum.finalize())),
            count => sum.update(bytes.get(..count).unwrap_or_default()),
        }
    }
}

/// Returns all bytes of a file of a run. Anything but a regular file is refused, because a read from a pipe with this
/// name would never end.
pub(crate) fn bytes_of_file(path: &Path) -> std::io::Result<Vec<u8>> {
    if std::fs::metadata(path)?.is_file() { std::fs::read(path) } else { Err(std::io::Error::other("is not a file")) }
}

/// Returns the CRC-32 as hexadecimal digits. It only has to find accidental changes.
pub(crate) fn hash(bytes: &[u8]) -> String {
    format!("{:08x}", crc32fast::hash(bytes))
}

/// Columns of points that tiles need and all files have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct PointColumns {
    /// True for GPS times of one kind.
    pub(crate) gps_times: bool,
    /// True for channels of the scanner.
    pub(crate) channels: bool,
}

impl PointColumns {
    /// Returns the columns that all files with these headers have.
    pub(crate) fn common(heads: &[LasHead]) -> Self {
        let kinds: Vec<Option<GpsTimeKind>> = heads.iter().map(|head| head.gps_times).collect();
        Self {
            gps_times: kinds.first().is_some_and(|first| first.is_some() && kinds.iter().all(|kind| kind == first)),
            channels: heads.iter().all(|head| head.has_channels),
        }
    }
}
