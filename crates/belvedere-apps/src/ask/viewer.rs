//! What to know of targets of one viewer, however they are tested.

use super::Remark;
use belvedere_core::query::Coverage;

const OUTSIDE_CLOUD: &str = "are outside the cloud, where nothing is known, and have no answer";

/// A warning of an eye outside the cloud.
#[must_use]
pub fn remark_on_eye(coverage: Option<&Coverage>, eye: [f64; 3]) -> Option<Remark> {
    let is_outside = coverage.is_some_and(|coverage| !coverage.holds(eye));
    let text = "the eye is outside the cloud: what stands around it and before it is unknown";
    is_outside.then(|| Remark::warning("eye-outside-cloud", text))
}

/// A warning that `outside` of `count` targets, which are called `things`, are outside the cloud; `None` where none is.
#[must_use]
pub fn remark_on_outside(outside: usize, count: usize, things: &str) -> Option<Remark> {
    Remark::of_share("targets-outside-cloud", outside, count, things, OUTSIDE_CLOUD)
}

/// A warning of what speaks against a reference system.
#[must_use]
pub fn remark_on_doubt(doubt: Option<&str>) -> Option<Remark> {
    doubt.map(|doubt| Remark::warning("reference-system-doubtful", doubt))
}

/// A warning that a `file` has columns or properties that are not used: those that look as if they said how observers
/// look and are not understood, and `limits` that are understood, but of no use to the question.
#[must_use]
pub fn remark_on_unused(file: &str, unknown: &[String], limits: &[String]) -> Option<Remark> {
    let advice = "understood are z, height, min_distance, max_distance, azimuth_from, azimuth_to, elevation_from, \
                  elevation_to, and these as QGIS and ArcGIS name them";
    let unknown_names = (!unknown.is_empty()).then(|| format!("not used: {}; {advice}", unknown.join(", ")));
    let limit_names = (!limits.is_empty()).then(|| format!("not used for this question: {}", limits.join(", ")));
    let parts: Vec<String> = limit_names.into_iter().chain(unknown_names).collect();
    let count = unknown.len() + limits.len();
    let text = format!("{file}: {}", parts.join("; "));
    (count > 0).then(|| Remark::warning("columns-not-used", text).with("count", count as f64))
}

/// A warning that nothing was cleared, where `points` of the cloud were.
#[must_use]
pub fn remark_on_cleared(points: usize) -> Option<Remark> {
    (points == 0).then(|| Remark::warning("nothing-cleared", "nothing stands there that could be cleared"))
}
