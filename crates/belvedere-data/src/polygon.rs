//! Polygons on the map.

use crate::vector::box_around;
use crate::{Error, Parameter};
use std::ops::{ControlFlow, Range};

/// Outline of a building on the map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Name of the building.
    pub name: String,
    /// Polygons, each an outer ring and its holes; they may overlap.
    pub polygons: Vec<Vec<Vec<[f64; 2]>>>,
}

impl Footprint {
    /// Returns the lowest and the highest corner of the box around it; infinite without a corner.
    #[must_use]
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        box_around(self.polygons.iter().flatten().flatten().copied())
    }
}

/// Returns true if a place lies within an outline and outside its holes, by odd crossings over all rings, which may be
/// closed or not.
#[must_use]
pub fn is_inside(rings: &[Vec<[f64; 2]>], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    for ring in rings {
        let Some(mut previous) = ring.last() else { continue };
        for corner in ring {
            let ([ax, ay], [bx, by]) = (*previous, *corner);
            if (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax) {
                inside = !inside;
            }
            previous = corner;
        }
    }
    inside
}

/// Coordinates of corners beyond this are no place on a map in any unit, metres.
const MAX_COORDINATE: f64 = 1e7;
/// Sides of a leaf of an index.
const LEAF: usize = 8;
/// Pairs of sides whose boxes meet that are tested for crossing: for each side, and for any polygon. Outlines of
/// buildings have two to three for each side.
const PAIRS_PER_SIDE: usize = 1000;
const FREE_PAIRS: usize = 10_000_000;

/// Why rings are no polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RingFault {
    /// A corner is no place on a map.
    NoPlace([f64; 2]),
    /// A ring has fewer than three corners.
    FewCorners(usize),
    /// Two sides cross each other.
    Crossing([[[f64; 2]; 2]; 2]),
    /// Too many sides lie close beside others to test all for crossings.
    Intricate,
}

impl RingFault {
    /// The error about a parameter whose rings these are.
    #[must_use]
    pub fn refusal(self, parameter: Parameter) -> Error {
        let (value, expected) = match self {
            Self::NoPlace(corner) => (
                format!("with a corner at {corner:?}"),
                "finite, within 10 000 km of the scene's origin: in the coordinates of the cloud",
            ),
            Self::FewCorners(count) => {
                (format!("a ring of {count} corners"), "a polygon: three corners or more in each ring")
            }
            Self::Crossing([a, b]) => (
                format!(
                    "crossing itself: the side from {:.2?} to {:.2?} crosses that from {:.2?} to {:.2?} (local metres)",
                    a[0], a[1], b[0], b[1]
                ),
                "free of crossings; repair it, for example with a buffer of 0 in a GIS",
            ),
            Self::Intricate => (
                "with too many sides close beside each other".to_owned(),
                "simple enough to be tested for crossings; simplify it in a GIS",
            ),
        };
        Error::invalid(parameter, value, expected)
    }
}

/// Index of polygons that finds the sides near a place without testing all of them: a tree over the sides of each ring,
/// in their order, and one over the polygons.
#[derive(Clone, Debug)]
pub struct PolygonIndex {
    /// Corners of all rings, the first of each repeated at its end.
    corners: Vec<[f64; 2]>,
    nodes: Vec<RingNode>,
    /// The first node of each ring, polygon by polygon.
    roots: Vec<usize>,
    polygons: Vec<PolygonNode>,
}

/// Some polygons that lie beside each other, and the box around them.
#[derive(Clone, Debug)]
struct PolygonNode {
    low: [f64; 2],
    high: [f64; 2],
    content: PolygonContent,
}

#[derive(Clone, Debug)]
enum PolygonContent {
    /// One polygon, by its place among the roots.
    One(Range<usize>),
    /// The second of the two nodes that it consists of; the first follows it.
    Two(usize),
}

/// A run of sides of a ring, and the box around them.
#[derive(Clone, Debug)]
struct RingNode {
    low: [f64; 2],
    high: [f64; 2],
    /// Numbers of the first and the last corner.
    first: usize,
    last: usize,
    /// The second of the two nodes that it consists of; the first follows it. `None` for a leaf.
    second: Option<usize>,
}

impl PolygonIndex {
    /// The index of an outline and its holes, which may be closed or not.
    #[must_use]
    pub fn new(rings: &[Vec<[f64; 2]>]) -> Self {
        Self::of_polygons([rings])
    }

    /// The index of some polygons, each an outline and its holes, which may be closed or not.
    #[must_use]
    pub fn of_polygons<'a>(polygons: impl IntoIterator<Item = &'a [Vec<[f64; 2]>]>) -> Self {
        let mut index = Self { corners: Vec::new(), nodes: Vec::new(), roots: Vec::new(), polygons: Vec::new() };
        let mut leaves = Vec::new();
        for rings in polygons {
            let start = index.roots.len();
            for ring in rings {
                let Some(&corner) = ring.first() else { continue };
                let first = index.corners.len();
                index.corners.extend(ring);
                index.corners.push(corner);
                let root = index.push(first, index.corners.len() - 1);
                index.roots.push(root);
            }
            let nodes = index.roots[start..].iter().map(|&root| &index.nodes[root]);
            let [low, high] = box_around(nodes.flat_map(|node| [node.low, node.high]));
            if index.roots.len() > start {
                leaves.push(PolygonNode { low, high, content: PolygonContent::One(start..index.roots.len()) });
            }
        }
        index.polygons.reserve(2 * leaves.len());
        index.push_polygons(&mut leaves);
        index
    }

    /// Appends the nodes over some polygons, parted in the middle of the longer side of their box.
    fn push_polygons(&mut self, leaves: &mut [PolygonNode]) {
        let [leaf] = leaves else {
            if leaves.is_empty() {
                return;
            }
            let bound = |axis: usize| {
                let low = leaves.iter().map(|leaf| leaf.low[axis]).fold(f64::INFINITY, f64::min);
                (low, leaves.iter().map(|leaf| leaf.high[axis]).fold(f64::NEG_INFINITY, f64::max))
            };
            let [east, north] = [0, 1].map(bound);
            let axis = usize::from(north.1 - north.0 > east.1 - east.0);
            let middle = |leaf: &PolygonNode| leaf.low[axis] + leaf.high[axis];
            let half = leaves.len() / 2;
            leaves.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
            let number = self.polygons.len();
            let (low, high) = ([east.0, north.0], [east.1, north.1]);
            self.polygons.push(PolygonNode { low, high, content: PolygonContent::Two(0) });
            let (first, second) = leaves.split_at_mut(half);
            self.push_polygons(first);
            self.polygons[number].content = PolygonContent::Two(self.polygons.len());
            self.push_polygons(second);
            return;
        };
        self.polygons.push(leaf.clone());
    }

    /// The roots of each polygon whose box meets that between two corners, edges included, until `visit` breaks.
    fn each_polygon_near(
        &self,
        low: [f64; 2],
        high: [f64; 2],
        mut visit: impl FnMut(&[usize]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut pending: Vec<usize> = (!self.polygons.is_empty()).then_some(0).into_iter().collect();
        while let Some(number) = pending.pop() {
            let node = &self.polygons[number];
            // of a place that is no number every comparison fails, and it lies in none
            if !(0..2).all(|axis| node.low[axis] <= high[axis] && low[axis] <= node.high[axis]) {
                continue;
            }
            match &node.content {
                PolygonContent::One(roots) => visit(&self.roots[roots.clone()])?,
                PolygonContent::Two(second) => pending.extend([number + 1, *second]),
            }
        }
        ControlFlow::Continue(())
    }

    /// Appends the nodes of the sides between two corners; returns the number of the first.
    fn push(&mut self, first: usize, last: usize) -> usize {
        let number = self.nodes.len();
        let [low, high] = box_around(self.corners[first..=last].iter().copied());
        self.nodes.push(RingNode { low, high, first, last, second: None });
        if last - first > LEAF {
            let middle = usize::midpoint(first, last);
            self.push(first, middle);
            let second = self.push(middle, last);
            self.nodes[number].second = Some(second);
        }
        number
    }

    /// Calls `visit` with the sides of the polygons whose boxes meet the box between two corners, edges included.
    pub fn each_side_near(&self, low: [f64; 2], high: [f64; 2], mut visit: impl FnMut([[f64; 2]; 2])) {
        let meets = |of: [[f64; 2]; 2]| (0..2).all(|axis| of[0][axis] <= high[axis] && low[axis] <= of[1][axis]);
        let mut pending: Vec<usize> = Vec::new();
        let _ = self.each_polygon_near(low, high, |roots: &[usize]| {
            pending.extend(roots);
            ControlFlow::Continue(())
        });
        while let Some(number) = pending.pop() {
            let node = &self.nodes[number];
            if !meets([node.low, node.high]) {
                continue;
            }
            if let Some(second) = node.second {
                pending.extend([number + 1, second]);
                continue;
            }
            for side in node.first..node.last {
                let [a, b] = [self.corners[side], self.corners[side + 1]];
                if meets([f64::min, f64::max].map(|pick| [0, 1].map(|axis| pick(a[axis], b[axis])))) {
                    visit([a, b]);
                }
            }
        }
    }

    /// Returns true if a place lies within the outline of a polygon and outside its holes, by odd crossings as in
    /// [`is_inside`].
    #[must_use]
    pub fn holds(&self, place: [f64; 2]) -> bool {
        let is_in = |roots: &[usize]| {
            if self.is_within(roots, place) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        self.each_polygon_near(place, place, is_in).is_break()
    }

    /// Returns true if a place lies within the rings with these roots.
    fn is_within(&self, roots: &[usize], [x, y]: [f64; 2]) -> bool {
        let mut inside = false;
        let mut pending = roots.to_vec();
        while let Some(number) = pending.pop() {
            let node = &self.nodes[number];
            if y < node.low[1] || y > node.high[1] || x > node.high[0] {
                continue;
            }
            if x < node.low[0] {
                // all of it lies to the right: sides cross an odd number of times where its ends lie on two sides
                inside ^= (self.corners[node.first][1] > y) != (self.corners[node.last][1] > y);
                continue;
            }
            if let Some(second) = node.second {
                pending.extend([number + 1, second]);
                continue;
            }
            for pair in self.corners[node.first..=node.last].windows(2) {
                let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
                inside ^= (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax);
            }
        }
        inside
    }

    /// Two sides that cross each other at a place that is an end of neither, if there are any.
    fn crossing(&self) -> Result<Option<[[[f64; 2]; 2]; 2]>, RingFault> {
        let sides: usize = self.corners.len();
        let mut left = sides.saturating_mul(PAIRS_PER_SIDE).max(FREE_PAIRS);
        for leaf in self.nodes.iter().filter(|node| node.second.is_none()) {
            for at in leaf.first..leaf.last {
                let side = [self.corners[at], self.corners[at + 1]];
                if let Some(other) = self.crossed_after(at, &side, &mut left)? {
                    return Ok(Some([side, other]));
                }
            }
        }
        Ok(None)
    }

    /// A side behind that from corner `at` which crosses it.
    fn crossed_after(
        &self,
        at: usize,
        side: &[[f64; 2]; 2],
        left: &mut usize,
    ) -> Result<Option<[[f64; 2]; 2]>, RingFault> {
        let [low, high] = [f64::min, f64::max].map(|pick| [0, 1].map(|axis| pick(side[0][axis], side[1][axis])));
        let mut pending = self.roots.clone();
        while let Some(number) = pending.pop() {
            let node = &self.nodes[number];
            if node.last <= at + 1 || (0..2).any(|axis| low[axis] > node.high[axis] || high[axis] < node.low[axis]) {
                continue;
            }
            *left = left.checked_sub(1).ok_or(RingFault::Intricate)?;
            if let Some(second) = node.second {
                pending.extend([number + 1, second]);
                continue;
            }
            for pair in self.corners[node.first.max(at + 1)..=node.last].windows(2) {
                let other = [pair[0], pair[1]];
                if cross_each_other(side, &other) {
                    return Ok(Some(other));
                }
            }
        }
        Ok(None)
    }
}

/// Returns true if two sides cross at a place that is an end of neither.
fn cross_each_other([a, b]: &[[f64; 2]; 2], [c, d]: &[[f64; 2]; 2]) -> bool {
    let turn = |p: &[f64; 2], q: &[f64; 2], r: &[f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

/// Rings as a polygon has them: without corners that repeat the one before, the first corner not repeated at the end.
///
/// # Errors
/// Why they are no polygon. Two rings that cross each other are none either.
pub fn simple_rings(rings: &[Vec<[f64; 2]>]) -> Result<Vec<Vec<[f64; 2]>>, RingFault> {
    let mut kept: Vec<Vec<[f64; 2]>> = Vec::new();
    for ring in rings {
        if let Some(corner) = ring.iter().find(|corner| !corner.iter().all(|v| v.abs() < MAX_COORDINATE)) {
            return Err(RingFault::NoPlace(*corner));
        }
        let mut ring = ring.clone();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        if ring.len() < 3 {
            return Err(RingFault::FewCorners(ring.len()));
        }
        kept.push(ring);
    }
    match PolygonIndex::new(&kept).crossing()? {
        Some(sides) => Err(RingFault::Crossing(sides)),
        None => Ok(kept),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::uniform;
    use std::time::Instant;

    /// A star of many spikes around a place, and a hole within it.
    fn star(count: usize) -> Vec<Vec<[f64; 2]>> {
        let at = |i: usize, radius: f64| {
            let angle = i as f64 / count as f64 * std::f64::consts::TAU;
            [radius * angle.cos(), radius * angle.sin()]
        };
        let spikes = (0..count).map(|i| at(i, if i % 2 == 0 { 10.0 } else { 4.0 + uniform(3, i as u64) })).collect();
        vec![spikes, (0..count).map(|i| at(i, 2.0)).collect()]
    }

    /// A comb whose teeth stand beside each other: all of them cross each line from west to east.
    fn comb(count: usize) -> Vec<Vec<[f64; 2]>> {
        let teeth = (0..count).map(|i| [i as f64 / count as f64, if i % 2 == 0 { 0.0 } else { 10.0 }]);
        vec![teeth.chain([[2.0, 20.0], [-1.0, 20.0]]).collect()]
    }

    #[test]
    fn an_index_says_of_each_place_what_a_look_at_all_sides_says() {
        for rings in [star(1), star(7), star(1001), comb(1000), Vec::new(), vec![Vec::new()]] {
            let index = PolygonIndex::new(&rings);
            for number in 0..2000_u64 {
                let place = [uniform(1, number), uniform(2, number)].map(|v| 24.0 * v - 12.0);
                assert_eq!(index.holds(place), is_inside(&rings, place), "{place:?}");
            }
            // at corners and on level sides too
            for &corner in rings.iter().flatten() {
                assert_eq!(index.holds(corner), is_inside(&rings, corner), "{corner:?}");
            }
        }
    }

    #[test]
    fn an_index_of_many_polygons_says_what_each_of_them_says() {
        let polygon = |number: u64| -> Vec<Vec<[f64; 2]>> {
            let [x, y] = [0, 1].map(|axis| 100.0 * uniform(7 + axis, number) - 50.0);
            star(3 + usize::try_from(number % 9).unwrap())
                .iter()
                .map(|ring| ring.iter().map(|c| [c[0] + x, c[1] + y]).collect())
                .collect()
        };
        for count in [0, 1, 2, 3, 40, 301] {
            let polygons: Vec<_> = (0..count).map(polygon).collect();
            let index = PolygonIndex::of_polygons(polygons.iter().map(Vec::as_slice));
            for number in 0..2000_u64 {
                let place = [uniform(1, number), uniform(2, number)].map(|v| 140.0 * v - 70.0);
                assert_eq!(index.holds(place), polygons.iter().any(|rings| is_inside(rings, place)), "{place:?}");
                let mut sides = 0;
                index.each_side_near(place, place.map(|v| v + 3.0), |_| sides += 1);
                let alone = |rings: &Vec<Vec<[f64; 2]>>| {
                    let mut sides = 0;
                    PolygonIndex::new(rings).each_side_near(place, place.map(|v| v + 3.0), |_| sides += 1);
                    sides
                };
                assert!(number > 100 || sides == polygons.iter().map(alone).sum::<usize>(), "{place:?}");
            }
            assert!(!index.holds([f64::NAN, 0.0]));
        }
    }

    #[test]
    fn rings_that_are_none_are_named() {
        let square = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        assert_eq!(simple_rings(&[vec![[0.0, 0.0], [1e300, 0.0], [0.0, 1.0]]]), Err(RingFault::NoPlace([1e300, 0.0])));
        assert!(matches!(simple_rings(&[vec![[f64::NAN, 0.0]; 4]]), Err(RingFault::NoPlace(_))));
        assert_eq!(simple_rings(&[square[..2].to_vec()]), Err(RingFault::FewCorners(2)));
        assert_eq!(simple_rings(&[vec![[1.0, 1.0]; 9]]), Err(RingFault::FewCorners(1)));
        let eight = vec![[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]];
        assert!(matches!(simple_rings(&[eight]), Err(RingFault::Crossing(_))));
        let hole = vec![[3.0, 1.0], [5.0, 1.0], [5.0, 2.0], [3.0, 2.0]];
        assert!(matches!(simple_rings(&[square.clone(), hole]), Err(RingFault::Crossing(_))));
        // closed or not, with corners twice, and touching itself in a corner
        let twice = [&square[..2], &square[1..], &square[..1]].concat();
        assert_eq!(simple_rings(&[twice]).unwrap(), std::slice::from_ref(&square));
        let touching = vec![[0.0, 0.0], [2.0, 2.0], [4.0, 0.0], [4.0, 4.0], [2.0, 2.0], [0.0, 4.0]];
        assert!(simple_rings(&[touching]).is_ok());
        // one crossing among many sides
        let mut many = star(20_001);
        assert!(simple_rings(&many).is_ok());
        many[0].swap(500, 502);
        assert!(matches!(simple_rings(&many), Err(RingFault::Crossing(_))));
    }

    #[test]
    fn a_million_corners_take_a_moment_and_what_takes_longer_is_refused() {
        let start = Instant::now();
        let circle = (0..1_000_000).map(|i| {
            let angle = f64::from(i) * 1e-6 * std::f64::consts::TAU;
            [10.0 * angle.cos(), 10.0 * angle.sin()]
        });
        for rings in [vec![circle.collect()], comb(1_000_000)] {
            let index = PolygonIndex::new(&simple_rings(&rings).unwrap());
            let inside =
                (0..100_000_u64).filter(|&i| index.holds([uniform(5, i) * 12.0, uniform(6, i) * 12.0])).count();
            assert!(inside > 1000, "{inside}");
        }
        // a hundred thousand sides beside each other, at a slant: the boxes of all meet, and the last side crosses them
        let slant = (0..100_000).map(|i| {
            let at = f64::from(i) * 1e-5;
            if i % 2 == 0 { [at, 0.0] } else { [100.0 + at, 100.0] }
        });
        assert!(simple_rings(&[slant.collect()]).is_err());
        // a hundred times what it takes, for a busy machine
        assert!(start.elapsed().as_secs_f64() < 60.0, "{:?}", start.elapsed());
    }

    #[test]
    fn holes_and_closed_rings_are_understood() {
        let outline = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
        let hole = vec![[4.0, 4.0], [6.0, 4.0], [6.0, 6.0], [4.0, 6.0]];
        let polygon = [outline, hole];
        for (place, expected) in
            [([1.0, 1.0], true), ([5.0, 5.0], false), ([5.0, 3.0], true), ([11.0, 5.0], false), ([-1.0, 4.0], false)]
        {
            assert_eq!(is_inside(&polygon, place), expected, "{place:?}");
        }
        assert!(!is_inside(&[], [0.0; 2]));
    }
}
