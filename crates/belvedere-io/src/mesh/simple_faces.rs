//! Faces that can be triangulated in bounded time: corners that repeat, and edges that cross.

use std::collections::HashSet;

/// Maximum mean number of passes of a ring through its places. A ring may pass a corner more than once, for example
/// where an edge leads to a hole and back; one with more passes turns around in itself.
const MAX_PASSES: usize = 2;

/// Returns the corners of a ring without those that repeat the one before, also at its end. If the ring passes its
/// places more than twice on the average, each corner is kept once, and the flag is true. Corners are the same at the
/// same place.
pub(crate) fn without_repeats(ring: &[u32], vertices: &[[f64; 3]]) -> (Vec<u32>, bool) {
    // adding zero makes -0 into 0
    let place = |&corner: &u32| vertices.get(corner as usize).map(|v| v.map(|v| (v + 0.0).to_bits()));
    let mut corners = ring.to_vec();
    corners.dedup_by_key(|corner| place(corner));
    while corners.len() > 1 && corners.first().map(place) == corners.last().map(place) {
        corners.pop();
    }
    if corners.len() <= 4 {
        return (corners, false);
    }
    let mut seen = HashSet::with_capacity(corners.len());
    let first_passes: Vec<u32> = corners.iter().copied().filter(|corner| seen.insert(place(corner))).collect();
    if corners.len() > MAX_PASSES * first_passes.len() { (first_passes, true) } else { (corners, false) }
}

/// An edge from its western to its eastern end.
struct Edge {
    west: [f64; 2],
    east: [f64; 2],
    low: f64,
    high: f64,
}

/// Returns true if two edges of a polygon cross between their ends. The first ring of `corners` ends where the next
/// begins, at the first of `hole_starts`. Edges that only touch, or lie on each other, such as on the way to a hole, do
/// not cross.
pub(crate) fn crosses_itself(corners: &[[f64; 2]], hole_starts: &[u32]) -> bool {
    let mut edges: Vec<Edge> = Vec::with_capacity(corners.len());
    let ends = hole_starts.iter().map(|&start| start as usize).chain([corners.len()]);
    let mut start = 0;
    for end in ends {
        let ring = corners.get(start..end).unwrap_or_default();
        start = end;
        for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let (west, east) = if a[0] <= b[0] { (a, b) } else { (b, a) };
            edges.push(Edge { west, east, low: a[1].min(b[1]), high: a[1].max(b[1]) });
        }
    }
    edges.sort_unstable_by(|a, b| a.west[0].total_cmp(&b.west[0]));
    // edges that the sweep from west to east has not left behind
    let mut active: Vec<&Edge> = Vec::new();
    for edge in &edges {
        active.retain(|other| other.east[0] >= edge.west[0]);
        if active.iter().any(|other| other.low <= edge.high && edge.low <= other.high && cross(other, edge)) {
            return true;
        }
        active.push(edge);
    }
    false
}

/// Returns true if each edge has its ends on both sides of the other.
fn cross(a: &Edge, b: &Edge) -> bool {
    let side = |edge: &Edge, p: [f64; 2]| {
        let along = [edge.east[0] - edge.west[0], edge.east[1] - edge.west[1]];
        let to = [p[0] - edge.west[0], p[1] - edge.west[1]];
        let (area, size) = (along[0] * to[1] - along[1] * to[0], along[0].hypot(along[1]) * to[0].hypot(to[1]));
        // what rounding can make of a corner on the edge is on neither side
        if area.abs() <= 1e-12 * size { 0.0 } else { area }
    };
    side(a, b.west) * side(a, b.east) < 0.0 && side(b, a.west) * side(b, a.east) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_that_repeat_are_dropped_and_bridges_to_holes_stay() {
        let vertices: Vec<[f64; 3]> = (0..9).map(|i| [f64::from(i % 3), f64::from(i / 3), 0.0]).collect();
        assert_eq!(without_repeats(&[0, 0, 1, 1, 2, 0], &vertices), (vec![0, 1, 2], false));
        assert_eq!(without_repeats(&[0, 1, 4].repeat(1000), &vertices), (vec![0, 1, 4], true));
        // to the hole 3, 4, 5 and back
        let bridge = [0, 1, 2, 3, 4, 5, 3, 2];
        assert_eq!(without_repeats(&bridge, &vertices), (bridge.to_vec(), false));
    }

    #[test]
    fn crossing_edges_are_found_and_touching_ones_are_not() {
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(crosses_itself(&bow, &[]));
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let hole = [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [4.0, 1.0]];
        assert!(!crosses_itself(&[&square[..], &hole].concat(), &[4]));
        let out = hole.map(|[x, y]| [x + 1.0, y]);
        assert!(crosses_itself(&[&square[..], &out].concat(), &[4]));
        let keyhole = [&square[..], &[[0.0, 0.0], [1.0, 1.0], [1.0, 2.0], [2.0, 1.0], [1.0, 1.0]]].concat();
        assert!(!crosses_itself(&keyhole, &[]));
    }
}
