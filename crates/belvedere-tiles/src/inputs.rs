//! The files of a survey, and whether they are still what they were when the plan was made.

use belvedere::apps::ask::Remark;
use belvedere::contradiction::FoundContradiction;
use belvedere::io::{LasHead, OpenSource, ReadSeek, Source, hidden, read_las_head, web_address};
use belvedere::{Bounds, Error, GpsTimeKind, Result};
use serde::{Deserialize, Serialize};
use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Samples of a file that its fingerprint is taken of: their number and bytes. What changed at random in a hundredth of
/// it is found by them alone.
const SAMPLES: u64 = 64;
const SAMPLE_BYTES: u64 = 1 << 12;
/// Samples of a file on a server, of which each is a request.
const REMOTE_SAMPLES: u64 = 4;
/// Bytes at either end of a file on the disk that are sampled too: headers and tables.
const ENDS: u64 = 1 << 16;
/// Bytes that are read at once for the checksum of a whole file.
const AT_ONCE: usize = 1 << 20;

/// A file of a survey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InputFile {
    /// Where it lies.
    pub path: PathBuf,
    /// Size, bytes.
    pub bytes: u64,
    /// Number of points.
    pub points: u64,
    /// Lowest and highest corner, in its own coordinates.
    pub bounds: [[f64; 3]; 2],
    /// CRC-32 over its size and samples all over it, as hexadecimal digits.
    pub fingerprint: String,
    /// When it was changed last, or what its server calls its version, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    version: Option<String>,
    /// CRC-32 of all of it, as hexadecimal digits; `None` for a file on a server.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    contents: Option<String>,
    /// A version that was found to be the file of the plan, so that it is compared once.
    #[serde(skip)]
    compared: OnceLock<Option<String>>,
    /// The rectangle around each piece of its rows: west, south, east and north, whole local metres. Empty where that
    /// is not known.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) pieces: Vec<PieceCell>,
}

/// Rows of a file that one rectangle is kept for: a chunk of most LAZ files.
pub(crate) const PIECE_ROWS: u64 = 50_000;

/// West, south, east and north of a piece, whole local metres.
pub(crate) type PieceCell = [i32; 4];

/// The rectangle of a piece without points, which meets nothing.
pub(crate) const NOWHERE: PieceCell = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];

/// Widens a rectangle to hold a local position.
#[expect(clippy::cast_possible_truncation, reason = "some kilometres; `as` saturates")]
pub(crate) fn hold([west, south, east, north]: &mut PieceCell, [x, y, _]: [f32; 3]) {
    (*west, *south) = ((*west).min(x.floor() as i32), (*south).min(y.floor() as i32));
    (*east, *north) = ((*east).max(x.ceil() as i32), (*north).max(y.ceil() as i32));
}

/// What to know of a file by its header.
pub(crate) fn remarks_on_file(path: &Path, head: &LasHead) -> Vec<Remark> {
    let path = path.display().to_string();
    let notes = head.notes.iter().map(|note| Remark::note("file-odd", format!("{path}: {note}")));
    let contradictions = head.contradictions.iter().filter_map(|found| {
        Remark::of_contradiction(FoundContradiction { text: format!("{path}: {}", found.text), ..found.clone() })
    });
    notes.chain(contradictions).collect()
}

impl InputFile {
    /// A file as it is now, and what its header says.
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

    /// The file, of which only rows are read that may lie in a column of local coordinates.
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

    /// Whether the pieces are those of its points, or not known.
    pub(crate) fn has_sound_pieces(&self) -> bool {
        self.pieces.is_empty() || self.pieces.len() as u64 == self.points.div_ceil(PIECE_ROWS)
    }

    /// Refuses a file that is no longer what it was: its size, its samples, and where its time is another one, its
    /// whole content. Of a file on a server, its version, its size and samples.
    ///
    /// # Errors
    /// [`Error::Io`] for a file that is gone, [`Error::Malformed`] for one that changed.
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
        // samples of a file on a server are taken once; those of the disk also find what keeps its time
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

/// The place of a file, whatever the folder that the program is started in.
pub(crate) fn absolute(path: &Path) -> Result<PathBuf> {
    match web_address(path) {
        Some(_) => Ok(hidden(path)),
        None => std::path::absolute(path).map_err(Error::io(path)),
    }
}

/// What is known of a file without a look at its content.
struct FileVersion {
    reader: Box<dyn ReadSeek>,
    bytes: u64,
    /// When it was changed last, or what its server calls its version.
    name: Option<String>,
}

impl FileVersion {
    fn of(path: &Path) -> Result<Self> {
        let OpenSource { reader, size, version } = Source::path(path).into_versioned_reader()?;
        Ok(Self { reader, bytes: size, name: version })
    }

    /// The hash of the size of a file and of samples all over it.
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

/// The hash of all of a file.
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

/// All bytes of a file of a run. What is none is refused: a pipe with its name would be waited for for ever.
pub(crate) fn bytes_of_file(path: &Path) -> std::io::Result<Vec<u8>> {
    if std::fs::metadata(path)?.is_file() { std::fs::read(path) } else { Err(std::io::Error::other("is not a file")) }
}

/// CRC-32, as hexadecimal digits: what changed is to be found, and no more than that.
pub(crate) fn hash(bytes: &[u8]) -> String {
    format!("{:08x}", crc32fast::hash(bytes))
}

/// The columns of points that all files have and tiles need.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct PointColumns {
    /// GPS times of one kind.
    pub(crate) gps_times: bool,
    /// Channels of the scanner.
    pub(crate) channels: bool,
}

impl PointColumns {
    /// Those of all files with these headers.
    pub(crate) fn common(heads: &[LasHead]) -> Self {
        let kinds: Vec<Option<GpsTimeKind>> = heads.iter().map(|head| head.gps_times).collect();
        Self {
            gps_times: kinds.first().is_some_and(|first| first.is_some() && kinds.iter().all(|kind| kind == first)),
            channels: heads.iter().all(|head| head.has_channels),
        }
    }
}
