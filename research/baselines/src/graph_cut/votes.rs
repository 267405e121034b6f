//! What lines of sight say of the tetrahedra that they pass.

use super::{GraphCutParams, PARTS};
use crate::MethodInput;
use crate::delaunay::{Delaunay, NONE};
use belvedere::vector::{cross, dot, length, sub};
use rayon::prelude::*;
use std::sync::atomic::{AtomicI64, Ordering};

/// Sums over lines of sight, in parts of one. Sums of integers do not depend on the order, and so not on the threads.
pub(super) struct Votes<'a> {
    delaunay: &'a Delaunay,
    /// Lines that come into each tetrahedron through each face.
    inward: Vec<[AtomicI64; 4]>,
    /// Lines that end in each tetrahedron and say that it is inside, less those that say that it is outside.
    inside: Vec<AtomicI64>,
    params: GraphCutParams,
}

/// A way from a point through tetrahedra.
struct TetrahedronPath {
    from: [f64; 3],
    /// Unit length.
    direction: [f64; 3],
    /// Metres.
    end: f64,
}

impl<'a> Votes<'a> {
    /// Counts the votes of first returns among the points, which are the rows `kept` of the cloud: the way to each is
    /// free, what lies just behind is solid.
    pub(super) fn new(
        delaunay: &'a Delaunay,
        survey: &MethodInput<'_>,
        kept: &[usize],
        params: &GraphCutParams,
    ) -> Self {
        let count = delaunay.tetrahedra.len();
        let zeros = || std::array::from_fn(|_| AtomicI64::new(0));
        let votes = Self {
            delaunay,
            inward: (0..count).map(|_| zeros()).collect(),
            inside: (0..count).map(|_| AtomicI64::new(0)).collect(),
            params: *params,
        };
        let numbers = survey.cloud.attributes.return_number.as_deref();
        kept.par_iter().enumerate().with_min_len(256).for_each(|(point, &row)| {
            let is_first = numbers.and_then(|numbers| numbers.get(row)).is_none_or(|&number| number <= 1);
            let from = delaunay.points[point];
            let scanner = survey.scanner.get(row).map(|p| p.map(f64::from)).filter(|p| p.iter().all(|v| v.is_finite()));
            let towards = scanner.map_or([0.0, 0.0, f64::MAX.sqrt()], |scanner| sub(scanner, from));
            let range = length(towards);
            if is_first && range > 0.0 && range.is_finite() && delaunay.at_point[point] != NONE {
                let direction = towards.map(|v| v / range);
                votes.free(point, &TetrahedronPath { from, direction, end: range });
                let depth = params.depth_in_noises * params.noise;
                votes.solid(point, &TetrahedronPath { from, direction: direction.map(|v| -v), end: depth });
            }
        });
        votes
    }

    /// Capacities from each tetrahedron to its neighbours, in the order of its faces, where what comes from beyond the
    /// hull stands at that face; and capacities from the source less those to the sink.
    pub(super) fn into_capacities(self) -> (Vec<[i64; 4]>, Vec<i64>) {
        let terminal = self.inside.iter().map(|votes| -votes.load(Ordering::Relaxed)).collect();
        let tetrahedra = &self.delaunay.tetrahedra;
        let capacity = (0..tetrahedra.len()).map(|index| {
            std::array::from_fn(|i| {
                let neighbor = tetrahedra[index].neighbors[i] as usize;
                let Some(other) = tetrahedra.get(neighbor) else {
                    return self.inward[index][i].load(Ordering::Relaxed);
                };
                let back = other.neighbors.iter().position(|&back| back as usize == index);
                back.map_or(0, |back| self.inward[neighbor][back].load(Ordering::Relaxed))
            })
        });
        (capacity.collect(), terminal)
    }

    /// A line of sight runs along `way` towards the point where it starts.
    fn free(&self, point: usize, way: &TetrahedronPath) {
        let last = self.walk(point, way, |tetrahedron, face, _, range| {
            self.inward[tetrahedron as usize][face].fetch_add(self.weight(range), Ordering::Relaxed);
        });
        if let Some(last) = last {
            self.inside[last as usize].fetch_sub(self.weight(f64::INFINITY), Ordering::Relaxed);
        }
    }

    /// A line of sight would go on along `way`, and is known to have ended before its end.
    fn solid(&self, point: usize, way: &TetrahedronPath) {
        let last = self.walk(point, way, |_, _, next, range| {
            if let Some((tetrahedron, face)) = next {
                self.inward[tetrahedron as usize][face].fetch_add(self.weight(range), Ordering::Relaxed);
            }
        });
        if let Some(last) = last {
            self.inside[last as usize].fetch_add(self.weight(f64::INFINITY), Ordering::Relaxed);
        }
    }

    /// What a line of sight counts at a face so far from its point (the soft visibility of the source).
    fn weight(&self, range: f64) -> i64 {
        let sigmas = range / self.params.noise;
        #[expect(clippy::cast_possible_truncation, reason = "0 to PARTS")]
        let weight = (PARTS * (1.0 - (-0.5 * sigmas * sigmas).exp())) as i64;
        weight
    }

    /// Follows a way from a point and calls `leave` with each tetrahedron left, through which face, the next one with
    /// the face of entry, and how far from the point. Returns the tetrahedron in which the way ends, or `None` beyond
    /// the hull.
    fn walk(
        &self,
        point: usize,
        way: &TetrahedronPath,
        mut leave: impl FnMut(u32, usize, Option<(u32, usize)>, f64),
    ) -> Option<u32> {
        let (mut at, apex) = self.start(point, way.direction)?;
        // from a corner, a way leaves through the face opposite
        let mut exit = Some((apex, self.range_of_face(at, apex, way)));
        let mut steps = 0;
        loop {
            let (face, range) = exit?;
            if range >= way.end {
                return Some(at);
            }
            let neighbor = self.delaunay.tetrahedra[at as usize].neighbors[face];
            let entry = self
                .delaunay
                .tetrahedra
                .get(neighbor as usize)
                .and_then(|next| next.neighbors.iter().position(|&back| back == at));
            let next = entry.map(|entry| (neighbor, entry));
            leave(at, face, next, range);
            let (tetrahedron, entry) = next?;
            at = tetrahedron;
            let faces = (0..4).filter(|&face| face != entry);
            let ranges = faces.map(|face| (face, self.range_of_face(at, face, way)));
            exit = ranges.reduce(|best, other| if other.1 < best.1 { other } else { best });
            // rounding could lead around an edge for ever
            steps += 1;
            if steps > self.delaunay.tetrahedra.len() {
                return None;
            }
        }
    }

    /// The tetrahedron at `point` into which `direction` leads, and which of its corners the point is.
    fn start(&self, point: usize, direction: [f64; 3]) -> Option<(u32, usize)> {
        let from = self.delaunay.points[point];
        let mut found = vec![self.delaunay.at_point[point]];
        let mut next = 0;
        while let Some(&index) = found.get(next) {
            next += 1;
            let tetrahedron = self.delaunay.tetrahedra[index as usize];
            let apex = tetrahedron.corners.iter().position(|&corner| corner as usize == point)?;
            let corners = self.delaunay.corners(index);
            let arms: [[f64; 3]; 3] = std::array::from_fn(|k| sub(corners[(apex + 1 + k) % 4], from));
            let volume = dot(arms[0], cross(arms[1], arms[2]));
            let is_between = (0..3).all(|k| dot(direction, cross(arms[k], arms[(k + 1) % 3])) * volume.signum() >= 0.0);
            if is_between {
                return Some((index, apex));
            }
            for (i, &neighbor) in tetrahedron.neighbors.iter().enumerate() {
                if i != apex && neighbor != NONE && !found.contains(&neighbor) {
                    found.push(neighbor);
                }
            }
        }
        None
    }

    /// How far along a way the plane of a face lies through which it leaves a tetrahedron; infinite for one through
    /// which it does not.
    fn range_of_face(&self, tetrahedron: u32, face: usize, way: &TetrahedronPath) -> f64 {
        let corners = self.delaunay.corners(tetrahedron);
        let [a, b, c]: [[f64; 3]; 3] = std::array::from_fn(|k| corners[(face + 1 + k) % 4]);
        let normal = cross(sub(b, a), sub(c, a));
        // corners in positive order, so that the side of the fourth follows from which one it is
        let outward = if face % 2 == 1 { 1.0 } else { -1.0 };
        let speed = outward * dot(normal, way.direction);
        if speed > 0.0 { outward * dot(normal, sub(a, way.from)) / speed } else { f64::INFINITY }
    }
}
