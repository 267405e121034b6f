//! Remarks on targets of one viewer, for all tests.

use super::remark::Remark;
use belvedere_core::query::{BlockingTriangles, Coverage, MedialScene};
use belvedere_data::contradiction::{FoundContradiction, REFERENCE_SYSTEM, UP_AXIS};
use belvedere_data::{Bounds, Frame, Mesh};

const OUTSIDE_CLOUD: &str = "are outside the cloud, where nothing is known, and have no answer";
const BESIDE_CLOUD: &str = "beside the cloud: what stands between the two is unknown, and counts as free";

/// A warning of an eye outside the cloud; a note of one in the air beside it.
#[must_use]
pub fn remark_on_eye(coverage: Option<&Coverage>, eye: [f64; 3]) -> Option<Remark> {
    let coverage = coverage.filter(|coverage| !coverage.holds(eye))?;
    Some(match coverage.holds_end(eye) {
        true => remark_on_beside("the eye is"),
        false => {
            let text = "the eye is outside the cloud: what stands around it and before it is unknown";
            Remark::warning("eye-outside-cloud", text)
        }
    })
}

/// A note of those who look from the air beside the cloud.
pub(super) fn remark_on_beside(who_are: &str) -> Remark {
    Remark::note("eye-beside-cloud", format!("{who_are} {BESIDE_CLOUD}"))
}

/// A note of `targets`, local metres, which are called `things`, in the air beside the cloud; `None` where none is.
#[must_use]
pub fn remark_on_targets_beside(coverage: Option<&Coverage>, targets: &[[f32; 3]], things: &str) -> Option<Remark> {
    let beside = coverage.map_or(0, |coverage| coverage.beside_count(targets));
    let are_so = format!("are {BESIDE_CLOUD}");
    Remark::of_share("targets-beside-cloud", beside, targets.len(), things, &are_so).map(Remark::into_note)
}

/// A warning that `outside` of `count` targets, which are called `things`, are outside the cloud; `None` where none is.
#[must_use]
pub fn remark_on_outside(outside: usize, count: usize, things: &str) -> Option<Remark> {
    Remark::of_share("targets-outside-cloud", outside, count, things, OUTSIDE_CLOUD)
}

/// A warning of evidence against a reference system.
#[must_use]
pub fn remark_on_doubt(doubt: Option<&str>) -> Option<Remark> {
    doubt.and_then(|doubt| Remark::of_contradiction(REFERENCE_SYSTEM.found(doubt)))
}

/// Returns remarks on files that were read. They concern the reference system, files with fewer points than their
/// headers announce (each with its name and the missing number), and contradictions. Of many contradictions of one kind
/// the first is named, with their number.
#[must_use]
pub fn remarks_on_reading(
    doubt: Option<&str>,
    missing: impl IntoIterator<Item = (String, usize)>,
    contradictions: impl IntoIterator<Item = FoundContradiction>,
) -> Vec<Remark> {
    let cut_off = |(name, count): (String, usize)| {
        let text = format!("{name}: the file is cut off: {count} points of its header are missing; copy it again");
        (count > 0).then(|| Remark::warning("file-cut-off", text))
    };
    let mut kinds: Vec<(FoundContradiction, usize)> = Vec::new();
    for found in contradictions {
        match kinds.iter_mut().find(|(first, _)| first.row.key == found.row.key) {
            Some((_, more)) => *more += 1,
            None => kinds.push((found, 0)),
        }
    }
    let of_kind = |(first, more): (FoundContradiction, usize)| {
        let text = if more > 0 { format!("{}; and {more} more of this kind", first.text) } else { first.text.clone() };
        Remark::of_contradiction(FoundContradiction { text, ..first })
    };
    let of_kinds = kinds.into_iter().filter_map(of_kind);
    remark_on_doubt(doubt).into_iter().chain(missing.into_iter().filter_map(cut_off)).chain(of_kinds).collect()
}

/// A warning of a mesh that blocks nothing, since it lies beside a cloud of these bounds; `None` where it does not.
#[must_use]
pub fn remark_on_mesh(mesh: &Mesh, name: &str, frame: &Frame, bounds: &Bounds) -> Option<Remark> {
    let blocking = BlockingTriangles::new(mesh, name, frame.origin, Coverage::of(*bounds).as_ref(), None);
    blocking.err().map(|error| Remark::warning("mesh-beside-cloud", error.to_string()))
}

/// A note that `count` faces of a mesh turn around in themselves; `None` where none does.
#[must_use]
pub fn remark_on_faces(name: &str, count: usize) -> Option<Remark> {
    let text = || format!("{name}: {count} faces turn around in themselves; each corner was taken once");
    (count > 0).then(|| Remark::note("faces-turn-around", text()).with("count", count as f64))
}

/// Warns that a `file` has columns or properties that are not used. These look like limits of observers and are not
/// understood, or are `limits` that are understood, but of no use to the question.
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

/// A note that `inside` of `count` targets are inside an obstacle; `None` where none is.
#[must_use]
pub fn remark_on_targets_inside(inside: usize, count: usize) -> Option<Remark> {
    let so = "are inside an obstacle, or their eye is: they are neither visible nor blocked";
    Remark::of_share("targets-inside-obstacle", inside, count, "targets", so).map(Remark::into_note)
}

/// Warns of an end of lines of sight that lies so deep in an obstacle that all of them are blocked. `what` is a word
/// for it such as "eye".
#[must_use]
pub fn remark_on_inside(blockers: &MedialScene, end: [f64; 3], what: &str) -> Option<Remark> {
    blockers.is_inside_obstacle(end).then(|| {
        let depth = blockers.enclosure(end).depth;
        let text = format!(
            "the {what} is inside an obstacle, {depth:.2} m deep: it sees nothing, and nothing sees it; give a place outside"
        );
        Remark::warning("end-inside-obstacle", text).with("depth_m", depth)
    })
}

/// A warning that a cloud lies on its side.
#[must_use]
pub fn remark_on_axis(looks_y_up: bool) -> Option<Remark> {
    let text = "y looks up in this cloud, not z: its flat surfaces face along y, and it is lowest that way; \
                if so, read it with y as the axis that is up (--up y, up=\"y\")";
    Remark::of_contradiction(UP_AXIS.found(text)).filter(|_| looks_y_up)
}

/// A warning that no surface of a building was found, where there are no `roofs`.
#[must_use]
pub fn remark_on_roofs(roofs: usize) -> Option<Remark> {
    let text = "no roof was found: points of class 6 show roofs, or where there are none single returns of classes 0 \
                and 1 that lie above points of class 2; classify the points first if there are buildings";
    (roofs == 0).then(|| Remark::warning("no-roofs", text))
}

/// A warning that nothing was cleared, where `points` of the cloud were.
#[must_use]
pub fn remark_on_cleared(points: usize) -> Option<Remark> {
    (points == 0).then(|| Remark::warning("nothing-cleared", "nothing stands there that could be cleared"))
}

#[cfg(test)]
mod tests {
    use super::remarks_on_reading;
    use belvedere_data::contradiction::{COLUMN_TWICE, Contradiction, SCAN_POSE};

    #[test]
    fn files_that_are_whole_need_no_remark() {
        let files = [("whole.las".to_owned(), 0), ("cut.las".to_owned(), 5)];
        let remarks = remarks_on_reading(Some("the system is far away"), files, []);
        let keys: Vec<&str> = remarks.iter().map(|remark| remark.key).collect();
        assert_eq!(keys, ["reference-system-doubtful", "file-cut-off"]);
        assert!(remarks[1].text.starts_with("cut.las") && remarks[1].text.contains("5 points"), "{}", remarks[1].text);
        assert!(remarks_on_reading(None, [("whole.las".to_owned(), 0)], []).is_empty());
    }

    #[test]
    fn contradictions_of_one_kind_are_said_once_with_their_number() {
        let found = |row: &'static Contradiction, text: &str| row.found(text);
        let all = [found(&SCAN_POSE, "a"), found(&COLUMN_TWICE, "b"), found(&SCAN_POSE, "c"), found(&SCAN_POSE, "d")];
        let remarks = remarks_on_reading(None, [], all);
        let said: Vec<(&str, &str)> = remarks.iter().map(|remark| (remark.key, remark.text.as_str())).collect();
        assert_eq!(said, [("scan-pose", "a; and 2 more of this kind"), ("column-twice", "b")]);
    }
}
