//! Convex hull of a point set and the eye, with exact arithmetic.
//!
//! General hull programs spend their time far from what is needed here: flipped points lie close to a sphere about the
//! eye, so that most are on the hull, and neighbours in the picture are neighbours on the hull. Points are therefore
//! inserted along a space-filling curve, in rounds that double, and each is found by a walk of a few facets from the
//! last one.

mod cavity;
mod start;
#[cfg(test)]
mod tests;

use crate::curve::{Curve, insertion_order};
use belvedere::cast::to_row;
use belvedere::vector::{cross, dot, sub};
use robust::{Coord3D, orient3d};

use cavity::Cavity;
use start::{first_tetrahedron, middle, tetrahedron};

/// How near to the eye walks aim from, as a share of the way from the eye to the middle of the first tetrahedron: a
/// power of two, so that the centre stays on that way exactly, and small enough to count as the eye itself.
const CENTRE_SHARE: f64 = 1.0 / 1_048_576.0;
/// A hull of so many points has twice as many facets, whose numbers fit 32 bits.
pub(crate) const MAX_POINTS: usize = 1 << 30;
/// No facet.
const NONE: u32 = u32::MAX;

/// Corners counter-clockwise as seen from outside; neighbour `i` lies across the edge from corner `i` to the next.
#[derive(Clone, Copy)]
struct Facet {
    corners: [u32; 3],
    neighbors: [u32; 3],
}

/// Convex hull of a point set and the eye, which is the origin of coordinates.
pub(crate) struct Hull {
    /// The points given, then the eye, then whatever makes the set three-dimensional.
    points: Vec<[f64; 3]>,
    facets: Vec<Facet>,
    /// Strictly inside the hull, next to the eye.
    centre: [f64; 3],
    /// For each point given, the first one found at the same place.
    representative: Vec<u32>,
    /// Whether each of `points` is a corner in the strict sense: not in the convex hull of all the others.
    extreme: Vec<bool>,
    curve: Curve,
}

/// Where the last walk ended, and the numbers that choose the order of its tests.
#[derive(Clone, Copy, Default)]
pub(crate) struct HullWalk {
    facet: u32,
    turns: u64,
}

impl HullWalk {
    /// A number from 0 to 2 that follows no pattern: walks through facets that lie in one plane could go round for ever
    /// with a fixed order of tests (Devillers, Pion & Teillaud 2002).
    fn turn(&mut self) -> usize {
        self.turns = self.turns.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.turns >> 33) % 3) as usize
    }
}

impl Hull {
    /// The hull of `points`, (N, 3), and the eye at the origin. Coordinates are finite and below 1e50.
    ///
    /// A set that fills no volume with the eye (all in a plane through it, up to rounding, or fewer than three points)
    /// is completed by pairs of points opposite each other about the eye. The eye lies between the two, so they change
    /// nothing about which points of the set are extreme.
    ///
    /// # Source
    /// Insertion in rounds: Amenta, Choi & Rote 2003. Exact signs: Shewchuk 1997. The hull is unique, so neither order
    /// nor method shows in [`Hull::is_extreme`].
    pub(crate) fn new(mut points: Vec<[f64; 3]>) -> Self {
        let given_count = points.len();
        let eye = to_row(given_count);
        points.push([0.0; 3]);
        let first = first_tetrahedron(&mut points, eye);
        let mut hull = Self {
            representative: (0..eye).collect(),
            extreme: Vec::new(),
            centre: middle(&points, first).map(|v| v * CENTRE_SHARE),
            facets: tetrahedron(&points, first),
            curve: Curve::new(&points),
            points,
        };
        let order = insertion_order(&hull.points, &first, &hull.curve);
        let mut cavity = Cavity::new(hull.points.len());
        let mut walk = HullWalk::default();
        for point in order {
            hull.insert(point, &mut walk, &mut cavity);
        }
        cavity.free.sort_unstable_by(|a, b| b.cmp(a));
        hull.drop_free_facets(&cavity.free);
        hull.extreme = hull.strict_corners();
        hull
    }

    /// Whether point number `index` of those given is a corner of the hull; points at the same place all are or none
    /// is.
    pub(crate) fn is_extreme(&self, index: usize) -> bool {
        self.representative
            .get(index)
            .and_then(|&first| self.extreme.get(first as usize))
            .is_some_and(|&extreme| extreme)
    }

    /// Whether `point` lies strictly outside, and if not, how far inside along the ray from the eye: 0 on the hull.
    pub(crate) fn depth_below(&self, point: [f64; 3], walk: &mut HullWalk) -> Option<f64> {
        let facet = self.locate(point, walk);
        let [a, b, c] = self.corners(facet);
        if orient(a, b, c, point) < 0.0 {
            return None;
        }
        let normal = cross(sub(b, a), sub(c, a));
        let ray = sub(point, self.centre);
        // differences of neighbours come first: the coordinates are far larger than the depth
        let depth = dot(normal, sub(a, point)) / dot(normal, ray) * dot(ray, ray).sqrt();
        Some(if depth.is_finite() { depth.max(0.0) } else { f64::INFINITY })
    }

    /// The rows of `points` such that neighbours in space follow each other; those without a point come first.
    pub(crate) fn order_along_curve(&self, points: &[Option<[f64; 3]>]) -> Vec<u32> {
        let mut keys: Vec<(u64, u32)> =
            (0..).zip(points).map(|(row, point)| (point.map_or(0, |p| self.curve.key(p)), row)).collect();
        keys.sort_unstable();
        keys.into_iter().map(|(_, row)| row).collect()
    }

    fn corners(&self, facet: u32) -> [[f64; 3]; 3] {
        self.facets[facet as usize].corners.map(|corner| self.points[corner as usize])
    }

    /// The facet that the ray from the centre through `point` meets.
    ///
    /// Each step crosses an edge that has `point` on its other side. Seen from inside, the facets of a convex hull are
    /// in front of each other in no circle, so the walk ends.
    fn locate(&self, point: [f64; 3], walk: &mut HullWalk) -> u32 {
        let mut came_from = NONE;
        'walk: loop {
            let facet = &self.facets[walk.facet as usize];
            let corners = self.corners(walk.facet);
            let first = walk.turn();
            for i in (first..first + 3).map(|i| i % 3) {
                if facet.neighbors[i] == came_from {
                    continue;
                }
                if orient(self.centre, corners[i], corners[(i + 1) % 3], point) > 0.0 {
                    came_from = walk.facet;
                    walk.facet = facet.neighbors[i];
                    continue 'walk;
                }
            }
            return walk.facet;
        }
    }

    /// Adds a point: the facets that it sees give way to a fan from their border.
    fn insert(&mut self, index: u32, walk: &mut HullWalk, cavity: &mut Cavity) {
        let point = self.points[index as usize];
        let seen = self.locate(point, walk);
        if !self.sees(point, seen) {
            let same = self.facets[seen as usize].corners.into_iter().find(|&c| self.points[c as usize] == point);
            if let (Some(same), Some(representative)) = (same, self.representative.get_mut(index as usize)) {
                *representative = same;
            }
            return;
        }
        cavity.begin(seen);
        while let Some(facet) = cavity.next() {
            for i in 0..3 {
                let Facet { corners, neighbors } = self.facets[facet as usize];
                let neighbor = neighbors[i];
                if cavity.knows(neighbor) {
                    continue;
                }
                if self.sees(point, neighbor) {
                    cavity.add(neighbor);
                } else {
                    cavity.border.push([corners[i], corners[(i + 1) % 3], neighbor]);
                }
            }
        }
        cavity.release();
        let border = std::mem::take(&mut cavity.border);
        for &[from, to, outer] in &border {
            let facet = Facet { corners: [from, to, index], neighbors: [outer, NONE, NONE] };
            let number = self.place(facet, cavity);
            cavity.fan_from[from as usize] = number;
            let backwards = &mut self.facets[outer as usize];
            if let Some(i) = (0..3).find(|&i| backwards.corners[i] == to) {
                backwards.neighbors[i] = number;
            }
            walk.facet = number;
        }
        for &[from, to, _] in &border {
            let (this, next) = (cavity.fan_from[from as usize], cavity.fan_from[to as usize]);
            self.facets[this as usize].neighbors[1] = next;
            self.facets[next as usize].neighbors[2] = this;
        }
        cavity.border = border;
        cavity.border.clear();
    }

    fn sees(&self, point: [f64; 3], facet: u32) -> bool {
        let [a, b, c] = self.corners(facet);
        orient(a, b, c, point) < 0.0
    }

    fn place(&mut self, facet: Facet, cavity: &mut Cavity) -> u32 {
        if let Some(number) = cavity.free.pop() {
            self.facets[number as usize] = facet;
            return number;
        }
        self.facets.push(facet);
        to_row(self.facets.len()) - 1
    }

    /// Closes the gaps that `free` (decreasing) leaves among the facets.
    fn drop_free_facets(&mut self, free: &[u32]) {
        for &gap in free {
            let last = to_row(self.facets.len()) - 1;
            self.facets.swap_remove(gap as usize);
            if gap == last {
                continue;
            }
            // the facet that was last has moved into the gap
            let neighbors = self.facets[gap as usize].neighbors;
            for neighbor in neighbors {
                for back in &mut self.facets[neighbor as usize].neighbors {
                    if *back == last {
                        *back = gap;
                    }
                }
            }
        }
    }

    /// Which points are corners in the strict sense. A point within an edge or a flat side that was inserted before the
    /// ends of that edge is a corner of facets too, but fewer than three of its edges are bent.
    fn strict_corners(&self) -> Vec<bool> {
        let mut bent_edges = vec![0_u8; self.points.len()];
        for facet in &self.facets {
            for i in 0..3 {
                let (from, to) = (facet.corners[i], facet.corners[(i + 1) % 3]);
                if from > to {
                    continue;
                }
                let beyond = &self.facets[facet.neighbors[i] as usize];
                let apex = beyond.corners.into_iter().find(|&c| c != from && c != to);
                let [a, b, c] = facet.corners.map(|corner| self.points[corner as usize]);
                if apex.is_some_and(|apex| orient(a, b, c, self.points[apex as usize]) > 0.0) {
                    for end in [from, to] {
                        bent_edges[end as usize] = bent_edges[end as usize].saturating_add(1);
                    }
                }
            }
        }
        bent_edges.into_iter().map(|count| count >= 3).collect()
    }
}

/// Positive where `d` lies below the plane of `a`, `b` and `c`, which turn counter-clockwise as seen from above; exact
/// sign.
fn orient(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> f64 {
    let coordinates = |[x, y, z]: [f64; 3]| Coord3D { x, y, z };
    orient3d(coordinates(a), coordinates(b), coordinates(c), coordinates(d))
}
