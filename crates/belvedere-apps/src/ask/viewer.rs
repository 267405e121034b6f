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

/// A warning that columns or properties of a `file` look as if they said how observers look, but are not used.
#[must_use]
pub fn remark_on_unused(file: &str, names: &[String]) -> Option<Remark> {
    let text = || {
        format!(
            "{file}: not used: {}; what is understood is z, height, min_distance, max_distance, azimuth_from, azimuth_to, \
             elevation_from, elevation_to, and these as QGIS and ArcGIS name them",
            names.join(", ")
        )
    };
    (!names.is_empty()).then(|| Remark::warning("columns-not-used", text()).with("count", names.len() as f64))
}

/// A warning that nothing was cleared, where `points` of the cloud were.
#[must_use]
pub fn remark_on_cleared(points: usize) -> Option<Remark> {
    (points == 0).then(|| Remark::warning("nothing-cleared", "nothing stands there that could be cleared"))
}
