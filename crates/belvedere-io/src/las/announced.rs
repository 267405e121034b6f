//! Points and bounds that a hierarchy or a catalogue announces for a file, against the header of the file.

use crate::files::announced::{Announced, BoundsAre};
use crate::las::header::LasHeader;
use belvedere_data::contradiction::{ANNOUNCED_BOUNDS, ANNOUNCED_POINTS, FoundContradiction};

/// A hierarchy or catalogue writes decimals where the header of the file has steps: coordinates in this range, in the
/// unit of the file, are the same.
const MIN_ROOM: f64 = 0.01;

impl Announced {
    /// Returns the parts of it that contradict the header of the file.
    pub(crate) fn contradictions(&self, header: &LasHeader) -> Vec<FoundContradiction> {
        let mut found = Vec::new();
        let by = &self.by;
        if let Some(points) = self.points.filter(|&points| points != header.points) {
            let own = header.points;
            let text = format!("{by} announces {points} points in it, but it has {own}; copy or make both again");
            let of = |count: u64| count as f64;
            found.push(ANNOUNCED_POINTS.found(text).with("announced", of(points)).with("of_file", of(own)));
        }
        if let Some(bounds) = self.bounds.filter(|_| header.points > 0 && header.has_bounds()) {
            let room = header.scale.map(|scale| (ANNOUNCED_BOUNDS.tolerance * scale.abs()).max(MIN_ROOM));
            let is_in = |i: usize| {
                let ([low, high], [own_low, own_high]) =
                    ([bounds.0[i] - room[i], bounds.1[i] + room[i]], header.bounds[i]);
                match self.bounds_are {
                    BoundsAre::OfPoints => low <= own_low && own_high <= high,
                    BoundsAre::OfCell => low <= own_high && own_low <= high,
                }
            };
            if !(0..3).all(is_in) {
                let [low, high] = [0, 1].map(|end| [0, 1, 2].map(|axis| header.bounds[axis][end]));
                let ((a, b), (c, d)) = (bounds, (low, high));
                let text = format!(
                    "{by} puts it between {} and {}, but its points lie between {} and {}: a box to read may miss points",
                    corner(a),
                    corner(b),
                    corner(c),
                    corner(d)
                );
                found.push(ANNOUNCED_BOUNDS.found(text));
            }
        }
        found
    }
}

/// Returns true if the bounds of a header are set.
pub(crate) fn are_given(bounds: &[[f64; 2]; 3]) -> bool {
    bounds.iter().all(|[low, high]| low <= high) && bounds.as_flattened().iter().any(|&v| v != 0.0)
}

impl LasHeader {
    /// Returns true if the header gives bounds.
    pub(crate) fn has_bounds(&self) -> bool {
        are_given(&self.bounds)
    }
}

fn corner(place: [f64; 3]) -> String {
    let coordinates = place.iter().filter(|v| v.is_finite()).map(|v| format!("{v:.2}"));
    coordinates.collect::<Vec<_>>().join(", ")
}
