//! Outcome of a tile. A record is written after its result, so that a tile with a record is complete.

use crate::grid::TileId;
use crate::inputs::{bytes_of_file, hash};
use crate::plan::Plan;
use crate::plan::stage::Stage;
use crate::sealed::{is_sound, sealed};
use belvedere::io::atomic;
use belvedere::{Error, Result};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;
use std::time::UNIX_EPOCH;

/// Maximum size of a record, bytes. A larger file is not read.
const MAX_BYTES: u64 = 1 << 26;

/// Outcome of a tile.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TileOutcome {
    /// The result exists.
    Done,
    /// The tile is empty and has no result.
    #[default]
    Nothing,
    /// The tile failed, with the reason.
    Failed(String),
}

/// File of a result in the state in which it was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Stamp {
    bytes: u64,
    /// CRC-32, as hexadecimal digits.
    fingerprint: String,
    /// Time of the last change, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    modified: Option<String>,
}

impl Stamp {
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let modified = modified(path);
        let bytes = bytes_of_file(path).map_err(Error::io(path))?;
        Ok(Self { bytes: bytes.len() as u64, fingerprint: hash(&bytes), modified })
    }

    /// Returns the bytes of the file, and refuses a changed file.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Malformed`] for a file that changed since it was written.
    pub(crate) fn read(&self, path: &Path) -> Result<Vec<u8>> {
        let bytes = bytes_of_file(path).map_err(Error::io(path))?;
        if self.fingerprint != hash(&bytes) {
            return Err(Error::malformed(path, "is damaged: compute it again with `belvedere city run`"));
        }
        Ok(bytes)
    }

    /// Returns a description of damage to the file since it was written; `None` without damage.
    fn damage(&self, path: &Path) -> Option<String> {
        let what = match std::fs::metadata(path) {
            Err(_) => "is gone",
            Ok(found) if found.len() != self.bytes || !self.fits(path) => "is damaged",
            Ok(_) => return None,
        };
        Some(format!("{} {what}", path.display()))
    }

    /// Returns true if the file is unchanged. Its content is compared only if its time differs.
    fn fits(&self, path: &Path) -> bool {
        (self.modified.is_some() && modified(path) == self.modified)
            || bytes_of_file(path).is_ok_and(|bytes| hash(&bytes) == self.fingerprint)
    }
}

/// Returns the time of the last change of a file, nanoseconds since 1970.
fn modified(path: &Path) -> Option<String> {
    let time = std::fs::metadata(path).ok()?.modified().ok()?;
    Some(time.duration_since(UNIX_EPOCH).ok()?.as_nanos().to_string())
}

/// Record of a tile.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TileRecord {
    /// Name of the plan of the record. A record of balls has the name of the plan without questions.
    pub(crate) plan: String,
    /// Outcome of the tile.
    pub outcome: TileOutcome,
    /// File of its result, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) result: Option<Stamp>,
    /// File of the pulses that end in it, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) pulses: Option<Stamp>,
    /// File of its crowns, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) crowns: Option<Stamp>,
    /// Number of points read.
    pub points: usize,
    /// Number of balls that were made, or that were tested for the answer.
    pub balls: usize,
    /// Maximum number of balls held at a time for an answer.
    #[serde(rename = "most_balls", default, skip_serializing_if = "is_zero")]
    pub max_balls: usize,
    /// Number of cells that are targets.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub cells: usize,
    /// Number of cells on the ground under a cover, which are no targets.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub covered_cells: usize,
    /// Number of cells without an answer because balls are missing.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub unproven_cells: usize,
    /// Number of cells near the edge of the survey for the light of the question; `None` for questions about other
    /// topics.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near_edge_cells: Option<usize>,
    /// Number of observers inside an obstacle, which see nothing.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub skipped_observers: usize,
    /// Number of blocked cells of a viewshed inside obstacles.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub inside_cells: usize,
    /// Time for the tile, seconds; 0 in a program without a clock.
    #[serde(default)]
    pub seconds: f64,
    /// Squares of 16 m that balls reach into, with the highest top of balls over each, local metres.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) tops: Vec<([i32; 2], f32)>,
    /// Damaged balls that were found during the answer, and were made again.
    #[serde(skip)]
    pub(crate) damaged: Vec<String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde requires a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl TileRecord {
    /// Returns the record of a tile in a run; `None` without an undamaged record of the plan.
    pub(crate) fn read(plan: &Plan, run: &Path, stage: Stage<'_>, tile: TileId) -> Option<Self> {
        let path = stage.record(plan, run, tile);
        if std::fs::metadata(&path).ok()?.len() > MAX_BYTES {
            return None;
        }
        let bytes = bytes_of_file(&path).ok()?;
        let record: Self = is_sound(&bytes).then(|| serde_json::from_slice(&bytes).ok())??;
        (record.plan == stage.plan_name(plan)).then_some(record)
    }

    /// Returns true if the tile does not need another run.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        !matches!(self.outcome, TileOutcome::Failed(_))
    }

    /// Returns a description of damage to its files since they were written; `None` without damage.
    pub(crate) fn damage(&self, plan: &Plan, run: &Path, stage: Stage<'_>, tile: TileId) -> Option<String> {
        let of_result = || self.result.as_ref()?.damage(&stage.result(plan, run, tile));
        let of_pulses = || self.pulses.as_ref()?.damage(&stage.pulses(plan, run, tile));
        let of_crowns = || self.crowns.as_ref()?.damage(&stage.crowns(plan, run, tile));
        of_result().or_else(of_pulses).or_else(of_crowns)
    }

    /// Returns the bytes of the file of its result, and refuses a changed file.
    ///
    /// # Errors
    /// Those of [`Stamp::read`].
    pub(crate) fn read_result(&self, path: &Path) -> Result<Vec<u8>> {
        match &self.result {
            Some(stamp) => stamp.read(path),
            None => bytes_of_file(path).map_err(Error::io(path)),
        }
    }

    pub(crate) fn write(&self, plan: &Plan, run: &Path, stage: Stage<'_>, tile: TileId) -> Result<()> {
        let path = stage.record(plan, run, tile);
        let record = Self { plan: stage.plan_name(plan).to_owned(), ..self.clone() };
        let text = sealed(&record).map_err(|e| Error::malformed(&path, format!("cannot be written: {e}")))?;
        atomic::write(&path, |file| file.write_all(text.as_bytes()).map_err(Error::io(&path)))
    }
}
