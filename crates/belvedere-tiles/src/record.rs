//! What became of a tile. A record is written after its result, so that whatever has one is complete.

use crate::grid::TileId;
use crate::inputs::{bytes_of_file, hash};
use crate::plan::Plan;
use crate::sealed::{is_sound, sealed};
use crate::stage::Stage;
use belvedere::io::atomic;
use belvedere::{Error, Result};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;
use std::time::UNIX_EPOCH;

/// Largest record that is believed, bytes.
const MAX_BYTES: u64 = 1 << 26;

/// What became of a tile.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TileOutcome {
    /// Its result is there.
    Done,
    /// Nothing is there, and there is no result.
    #[default]
    Nothing,
    /// It could not be done, and why.
    Failed(String),
}

/// A file of a result as it was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Stamp {
    bytes: u64,
    /// CRC-32, as hexadecimal digits.
    fingerprint: String,
    /// When it was changed last, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    modified: Option<String>,
}

impl Stamp {
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let modified = modified(path);
        let bytes = bytes_of_file(path).map_err(Error::io(path))?;
        Ok(Self { bytes: bytes.len() as u64, fingerprint: hash(&bytes), modified })
    }

    /// The bytes of the file, refused unless they are what was written.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Malformed`] for a file that changed since.
    pub(crate) fn read(&self, path: &Path) -> Result<Vec<u8>> {
        let bytes = bytes_of_file(path).map_err(Error::io(path))?;
        if self.fingerprint != hash(&bytes) {
            return Err(Error::malformed(path, "is damaged: compute it again with `belvedere city run`"));
        }
        Ok(bytes)
    }

    /// What became of the file since; `None` where nothing did.
    fn damage(&self, path: &Path) -> Option<String> {
        let what = match std::fs::metadata(path) {
            Err(_) => "is gone",
            Ok(found) if found.len() != self.bytes || !self.fits(path) => "is damaged",
            Ok(_) => return None,
        };
        Some(format!("{} {what}", path.display()))
    }

    /// Whether the file is what was written. Its content is looked at where it has another time.
    fn fits(&self, path: &Path) -> bool {
        (self.modified.is_some() && modified(path) == self.modified)
            || bytes_of_file(path).is_ok_and(|bytes| hash(&bytes) == self.fingerprint)
    }
}

/// When a file was changed last, nanoseconds since 1970.
fn modified(path: &Path) -> Option<String> {
    let time = std::fs::metadata(path).ok()?.modified().ok()?;
    Some(time.duration_since(UNIX_EPOCH).ok()?.as_nanos().to_string())
}

/// The record of a tile.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TileRecord {
    /// Name of the plan that it belongs to; of balls, of what they follow from.
    pub(crate) plan: String,
    /// What became of the tile.
    pub outcome: TileOutcome,
    /// The file of its result, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) result: Option<Stamp>,
    /// The file of the pulses that end in it, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) pulses: Option<Stamp>,
    /// The file of its crowns, where it has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) crowns: Option<Stamp>,
    /// Points that were read.
    pub points: usize,
    /// Balls that were made, or that could matter for the answer.
    pub balls: usize,
    /// Most balls that were held at a time for an answer.
    #[serde(rename = "most_balls", default, skip_serializing_if = "is_zero")]
    pub max_balls: usize,
    /// Cells that are targets.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub cells: usize,
    /// Cells on the ground under a cover, which are no targets.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub covered_cells: usize,
    /// Cells whose answer is unproven because balls are missing.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub unproven_cells: usize,
    /// Cells that are near the edge of the survey for the light of the question; `None` where it is not about light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near_edge_cells: Option<usize>,
    /// Observers that stand inside an obstacle, and see nothing.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub skipped_observers: usize,
    /// Seconds that it took, where the program has a clock.
    #[serde(default)]
    pub seconds: f64,
    /// Squares of 16 m that balls reach into, and the highest top of them there, local metres.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) tops: Vec<([i32; 2], f32)>,
    /// Balls that were found damaged on the way, and were made again.
    #[serde(skip)]
    pub(crate) damaged: Vec<String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde requires a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl TileRecord {
    /// The record of a tile in a run; `None` where there is none that belongs to the plan and is what was written.
    pub(crate) fn read(plan: &Plan, run: &Path, stage: Stage<'_>, tile: TileId) -> Option<Self> {
        let path = stage.record(plan, run, tile);
        if std::fs::metadata(&path).ok()?.len() > MAX_BYTES {
            return None;
        }
        let bytes = bytes_of_file(&path).ok()?;
        let record: Self = is_sound(&bytes).then(|| serde_json::from_slice(&bytes).ok())??;
        (record.plan == plan.name_for(stage)).then_some(record)
    }

    /// Whether the tile need not be done again.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        !matches!(self.outcome, TileOutcome::Failed(_))
    }

    /// What became of its files since; `None` where nothing did.
    pub(crate) fn damage(&self, plan: &Plan, run: &Path, stage: Stage<'_>, tile: TileId) -> Option<String> {
        let of_result = || self.result.as_ref()?.damage(&stage.result(plan, run, tile));
        let of_pulses = || self.pulses.as_ref()?.damage(&stage.pulses(plan, run, tile));
        let of_crowns = || self.crowns.as_ref()?.damage(&stage.crowns(plan, run, tile));
        of_result().or_else(of_pulses).or_else(of_crowns)
    }

    /// The bytes of the file of its result, refused unless they are what was written.
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
        let record = Self { plan: plan.name_for(stage).to_owned(), ..self.clone() };
        let text = sealed(&record).map_err(|e| Error::malformed(&path, format!("cannot be written: {e}")))?;
        atomic::write(&path, |file| file.write_all(text.as_bytes()).map_err(Error::io(&path)))
    }
}
