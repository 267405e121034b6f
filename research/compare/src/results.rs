//! What was found, as kept in JSON files so that an interrupted comparison goes on where it stopped.

use super::scanners::ComparisonScanner;
use anyhow::{Context, Result};
use belvedere::io::atomic;
use belvedere_baselines::agreement::TruthCounts;
use belvedere_baselines::methods::Listing;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::io::Write;
use std::path::Path;

/// A rate and its 95 % interval, shares from 0 to 1: value, low, high.
pub(super) type Rated = [f64; 3];

/// Accuracy of a method on one kind of target, averaged over a group of views.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub(super) struct MethodScore {
    /// Kind of target.
    pub(super) set: String,
    /// Group of views: `suns`, `observers`, `street` or `pairs`.
    pub(super) views: String,
    /// Targets queried in each view.
    pub(super) targets: usize,
    pub(super) false_blocked: Option<Rated>,
    pub(super) false_visible: Option<Rated>,
    pub(super) balanced: Option<Rated>,
    pub(super) blocked_iou: Option<Rated>,
    /// Share of the targets without an answer.
    pub(super) unanswered: Option<Rated>,
    /// Views that were answered.
    pub(super) observers: usize,
    /// Balanced accuracy that a tenth of the views stay below.
    pub(super) tenth_balanced: Option<f64>,
    /// What probabilities are worth.
    pub(super) calibration: Option<CalibrationScore>,
    /// Why there are no answers.
    pub(super) refused: Option<String>,
}

/// What probabilities of being visible are worth; answers of methods that give none count as 0 and 1.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, PartialEq)]
pub(super) struct CalibrationScore {
    pub(super) brier: f64,
    pub(super) expected_error: f64,
    pub(super) error_of_most_certain: f64,
}

/// What a method cost.
#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq)]
pub(super) struct Cost {
    pub(super) build_seconds: f64,
    /// Mean over the views.
    pub(super) seconds_per_view: f64,
    /// Over all views and sets; `None` where nothing was answered.
    pub(super) queries_per_second: Option<f64>,
    /// Peak of resident memory above what it was before building, MiB; `None` where the system does not report it.
    pub(super) peak_mib: Option<f64>,
}

/// A method on a place.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub(super) struct MethodResult {
    /// What the result depends on; another one makes it stale.
    pub(super) made_from: String,
    pub(super) place: String,
    /// What scanned it, where that was simulated.
    pub(super) scanner: Option<ComparisonScanner>,
    pub(super) method: String,
    pub(super) title: String,
    pub(super) page: String,
    /// Why the method could not be built.
    pub(super) failed: Option<String>,
    pub(super) cost: Cost,
    pub(super) scores: Vec<MethodScore>,
}

/// What a place is like.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub(super) struct PlaceResult {
    pub(super) made_from: String,
    pub(super) place: String,
    pub(super) points: usize,
    pub(super) area_m2: f64,
    pub(super) triangles: usize,
    /// Keys of the methods that can be judged here.
    pub(super) methods: Vec<String>,
    /// Those of them that run only when named.
    pub(super) when_named: Vec<String>,
    /// Name, and share of the targets that are blocked in truth, of each set and group of views.
    pub(super) blocked_in_truth: Vec<(String, String, f64)>,
    /// Balls of the published method by the surface they are tangent at.
    pub(super) audit: Vec<AuditRow>,
    /// Pedestrians under the suns with only some of these balls.
    pub(super) ablation: Vec<AblationRow>,
    /// What each answer of carved balls is worth.
    pub(super) answers: Vec<AnswerRow>,
}

impl PlaceResult {
    /// When the method of a key runs.
    pub(super) fn listing(&self, key: &str) -> Listing {
        if self.when_named.iter().any(|name| name == key) { Listing::WhenNamed } else { Listing::Always }
    }
}

/// Answers of carved balls to one set in one kind of view: how many, and how many of them are right.
#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq)]
pub(super) struct AnswerRow {
    pub(super) set: String,
    pub(super) views: String,
    pub(super) visible: [u64; 2],
    pub(super) unproven: [u64; 2],
    pub(super) blocked: [u64; 2],
}

impl AnswerRow {
    /// Counts more answers.
    pub(super) fn add(&mut self, counts: &TruthCounts) {
        let proven = counts.visible - counts.unproven_visible;
        let wrongly_proven = counts.false_visible - counts.unproven_blocked;
        let pairs = [
            (&mut self.visible, proven, wrongly_proven),
            (&mut self.unproven, counts.unproven_visible, counts.unproven_blocked),
            (&mut self.blocked, counts.blocked, counts.false_blocked),
        ];
        for ([given, correct], right, wrong) in pairs {
            *given += right + wrong;
            *correct += right;
        }
    }
}

/// Balls tangent at one kind of surface.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub(super) struct AuditRow {
    pub(super) surface: String,
    pub(super) balls: usize,
    pub(super) wrong: usize,
    pub(super) flipped: usize,
    pub(super) tilted: usize,
    pub(super) bulging: usize,
}

/// A union of some of the balls.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub(super) struct AblationRow {
    pub(super) balls: String,
    pub(super) number: usize,
    pub(super) false_blocked: Option<Rated>,
    pub(super) false_visible: Option<Rated>,
}

/// The held-out pulses of a cloud, as one method sees them.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub(super) struct HeldOutResult {
    pub(super) made_from: String,
    pub(super) cloud: String,
    /// Pulses held out.
    pub(super) pulses: usize,
    /// Share of all pulses whose scanner position is known.
    pub(super) scanner_known: f64,
    pub(super) method: String,
    pub(super) title: String,
    /// Name and share, 0 to 1, in the order of the table; `None` where nothing was queried.
    pub(super) shares: Vec<(String, Option<f64>)>,
    /// Why there are no shares.
    pub(super) failed: Option<String>,
}

/// A result that knows what it was made from.
pub(super) trait StoredResult: Serialize + DeserializeOwned {
    fn made_from(&self) -> &str;
}

macro_rules! kept {
    ($($kind:ty),*) => {$(
        impl StoredResult for $kind {
            fn made_from(&self) -> &str {
                &self.made_from
            }
        }
    )*};
}
kept!(MethodResult, PlaceResult, HeldOutResult);

/// The result at `path` if it was made from the same, or `None`: a file that is missing, unreadable or of another
/// making is made anew.
pub(super) fn kept<T: StoredResult>(path: &Path, made_from: &str) -> Option<T> {
    let result: T = serde_json::from_slice(&std::fs::read(path).ok()?).ok()?;
    (result.made_from() == made_from).then_some(result)
}

/// Writes a result.
pub(super) fn keep<T: Serialize>(path: &Path, result: &T) -> Result<()> {
    let text = serde_json::to_string_pretty(result).context("a result as JSON")?;
    atomic::write(path, |file| writeln!(file, "{text}").map_err(belvedere::Error::io(path)))?;
    Ok(())
}
