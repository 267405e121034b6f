//! The files of a survey, and whether they are still what they were when the plan was made.

use belvedere::io::{LasHead, Source, read_las_head, web_address};
use belvedere::{Bounds, Error, GpsTimeKind, Result};
use serde::{Deserialize, Serialize};
use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Bytes at either end of a file that its quick fingerprint is taken of.
const ENDS: u64 = 1 << 16;

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
    /// CRC-32 over its size and its first and last 64 KiB, as hexadecimal digits.
    pub fingerprint: String,
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

impl InputFile {
    /// A file as it is now, and what its header says.
    ///
    /// # Errors
    /// Those of [`read_las_head`].
    pub(crate) fn new(path: &Path) -> Result<(Self, LasHead)> {
        let is_las = ["las", "laz"].contains(&Source::path(path).extension().as_str());
        if !is_las {
            return Err(Error::UnknownFormat {
                path: path.to_owned(),
                kind: "tile",
                supported: ".las, .laz, .copc.laz; convert other clouds first",
            });
        }
        let head = read_las_head(path)?;
        if head.missing_points > 0 {
            let (points, announced) = (head.points, head.points + head.missing_points);
            let what = format!("is cut off: it holds {points} of the {announced} points of its header; copy it again");
            return Err(Error::malformed(path, what));
        }
        let path = absolute(path)?;
        let (_, fingerprint) = fingerprint(&path)?;
        Ok((
            Self { path, bytes: head.bytes, points: head.points, bounds: head.bounds, fingerprint, pieces: Vec::new() },
            head,
        ))
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

    /// Refuses a file that is no longer what it was.
    ///
    /// # Errors
    /// [`Error::Io`] for a file that is gone, [`Error::Malformed`] for one that changed.
    pub(crate) fn check(&self) -> Result<()> {
        if fingerprint(&self.path)? != (self.bytes, self.fingerprint.clone()) {
            let what = "is no longer what it was when the plan was made; make the plan again";
            return Err(Error::malformed(&self.path, what));
        }
        Ok(())
    }
}

/// The place of a file, whatever the folder that the program is started in.
pub(crate) fn absolute(path: &Path) -> Result<PathBuf> {
    match web_address(path) {
        Some(_) => Ok(path.to_owned()),
        None => std::path::absolute(path).map_err(Error::io(path)),
    }
}

/// The size of a file in bytes, and the hash of the size and of its ends.
fn fingerprint(path: &Path) -> Result<(u64, String)> {
    let (mut file, size) = Source::path(path).into_reader()?;
    let mut bytes = size.to_le_bytes().to_vec();
    file.by_ref().take(ENDS).read_to_end(&mut bytes).map_err(Error::io(path))?;
    file.seek(SeekFrom::Start(size.saturating_sub(ENDS))).map_err(Error::io(path))?;
    file.take(ENDS).read_to_end(&mut bytes).map_err(Error::io(path))?;
    Ok((size, hash(&bytes)))
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
