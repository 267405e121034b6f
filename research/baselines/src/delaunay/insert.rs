//! Points inserted one by one into a tetrahedralisation of all space.

use super::{NONE, Tetrahedron, in_sphere, number, orient};

/// The corner at infinity. A tetrahedron with it lies beyond a face of the hull.
const INFINITE: u32 = u32::MAX;

/// A tetrahedralisation that grows. Tetrahedra with the corner at infinity close it, so that each has four neighbours.
pub(super) struct DelaunayBuilder<'a> {
    points: &'a [[f64; 3]],
    tetrahedra: Vec<Tetrahedron>,
    /// Unused places among `tetrahedra`; their corners are all infinite.
    free: Vec<u32>,
    /// For each tetrahedron twice the number of the insertion that tested it last, and one more if it was in conflict.
    tested: Vec<u32>,
    insertion: u32,
    last: u32,
    turns: u64,
    cavity: Vec<u32>,
    /// Faces of the cavity: the new tetrahedron there, the corner that is the new point, and what lies beyond.
    boundary: Vec<(Tetrahedron, usize, u32, u32)>,
    /// Edges of these faces, each seen from the two tetrahedra that meet there.
    edges: Vec<(u64, u32, usize)>,
}

impl<'a> DelaunayBuilder<'a> {
    /// Starts with a tetrahedron in positive order.
    pub(super) fn new(points: &'a [[f64; 3]], first: [u32; 4]) -> Self {
        let mut tetrahedra = vec![Tetrahedron { corners: first, neighbors: [1, 2, 3, 4] }];
        for i in 0..4_u32 {
            // two corners swapped, for it lies on the other side of the face
            let mut corners = first;
            corners[i as usize] = INFINITE;
            let (j, k) = ((i as usize + 1) % 4, (i as usize + 2) % 4);
            corners.swap(j, k);
            let mut neighbors = [1, 2, 3, 4];
            neighbors[i as usize] = 0;
            neighbors.swap(j, k);
            tetrahedra.push(Tetrahedron { corners, neighbors });
        }
        let tested = vec![0; tetrahedra.len()];
        let (free, cavity, boundary, edges) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { points, tetrahedra, free, tested, insertion: 0, last: 0, turns: 0, cavity, boundary, edges }
    }

    /// Adds a point: the tetrahedra whose circumsphere holds it give way to a fan about it. A second point at one place
    /// is left out.
    pub(super) fn insert(&mut self, index: u32) {
        let point = self.points[index as usize];
        let found = self.locate(point);
        let corners = self.tetrahedra[found as usize].corners;
        if corners.iter().any(|&corner| corner != INFINITE && self.points[corner as usize] == point) {
            return;
        }
        self.insertion += 1;
        self.dig(found, point, index);
        self.free.append(&mut self.cavity);
        self.fill();
    }

    /// The tetrahedron that holds `point`, or one at infinity from whose face of the hull it lies outward.
    ///
    /// # Source
    /// Stochastic visibility walk: Devillers, Pion & Teillaud 2002.
    fn locate(&mut self, point: [f64; 3]) -> u32 {
        let mut at = self.last;
        if let Some(i) = self.infinite_corner(at) {
            at = self.tetrahedra[at as usize].neighbors[i];
        }
        let mut came_from = NONE;
        'walk: loop {
            let Tetrahedron { corners, neighbors } = self.tetrahedra[at as usize];
            let places = corners.map(|corner| self.points[corner as usize]);
            let first = self.turn();
            for i in (first..first + 4).map(|i| i % 4) {
                if neighbors[i] == came_from {
                    continue;
                }
                let mut with_point = places;
                with_point[i] = point;
                if orient(with_point) < 0.0 {
                    (came_from, at) = (at, neighbors[i]);
                    if self.infinite_corner(at).is_some() {
                        return at;
                    }
                    continue 'walk;
                }
            }
            return at;
        }
    }

    /// A number from 0 to 3 that follows no pattern: with a fixed order of tests a walk could go round for ever.
    fn turn(&mut self) -> usize {
        self.turns = self.turns.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.turns >> 62) as usize
    }

    fn infinite_corner(&self, tetrahedron: u32) -> Option<usize> {
        self.tetrahedra[tetrahedron as usize].corners.iter().position(|&corner| corner == INFINITE)
    }

    /// Whether `point` lies strictly inside the circumsphere. That of a tetrahedron at infinity is the half-space
    /// beyond its face, with the circle of the face in its boundary, which is also in the circumsphere of the
    /// neighbour.
    fn is_in_conflict(&self, tetrahedron: u32, point: [f64; 3]) -> bool {
        let Tetrahedron { corners, neighbors } = self.tetrahedra[tetrahedron as usize];
        let Some(i) = self.infinite_corner(tetrahedron) else {
            return in_sphere(corners.map(|corner| self.points[corner as usize]), point) > 0.0;
        };
        let place = |corner: u32| if corner == INFINITE { point } else { self.points[corner as usize] };
        let side = orient(corners.map(place));
        side > 0.0 || side == 0.0 && self.is_in_conflict(neighbors[i], point)
    }

    /// Collects the tetrahedra in conflict with `point`, from `first` on, and the fan that will take their place.
    fn dig(&mut self, first: u32, point: [f64; 3], index: u32) {
        self.cavity.push(first);
        self.tested[first as usize] = 2 * self.insertion + 1;
        let mut next = 0;
        while let Some(&inside) = self.cavity.get(next) {
            next += 1;
            let tetrahedron = self.tetrahedra[inside as usize];
            for (i, neighbor) in tetrahedron.neighbors.into_iter().enumerate() {
                if self.tested[neighbor as usize] < 2 * self.insertion {
                    let conflict = self.is_in_conflict(neighbor, point);
                    self.tested[neighbor as usize] = 2 * self.insertion + u32::from(conflict);
                    if conflict {
                        self.cavity.push(neighbor);
                    }
                }
                if self.tested[neighbor as usize] == 2 * self.insertion {
                    let mut corners = tetrahedron.corners;
                    corners[i] = index;
                    let mut neighbors = [NONE; 4];
                    neighbors[i] = neighbor;
                    self.boundary.push((Tetrahedron { corners, neighbors }, i, neighbor, inside));
                }
            }
        }
    }

    /// Places the fan and joins its tetrahedra to what lies beyond and to each other.
    fn fill(&mut self) {
        let boundary = std::mem::take(&mut self.boundary);
        self.edges.clear();
        for &(tetrahedron, apex, beyond, inside) in &boundary {
            let place = self.free.pop().unwrap_or_else(|| {
                self.tetrahedra.push(tetrahedron);
                self.tested.push(0);
                number(self.tetrahedra.len()) - 1
            });
            self.tetrahedra[place as usize] = tetrahedron;
            self.tested[place as usize] = 0;
            for back in &mut self.tetrahedra[beyond as usize].neighbors {
                if *back == inside {
                    // marked, so that a place used anew is not taken for the one that was there
                    *back = place | PLACED;
                }
            }
            for (i, _) in tetrahedron.corners.iter().enumerate().filter(|&(i, _)| i != apex) {
                let mut ends = (0..4).filter(|&k| k != i && k != apex).map(|k| tetrahedron.corners[k]);
                let (from, to) = (ends.next().unwrap_or(NONE), ends.next().unwrap_or(NONE));
                self.edges.push((u64::from(from.min(to)) << 32 | u64::from(from.max(to)), place, i));
            }
            self.last = place;
        }
        for &(_, _, beyond, _) in &boundary {
            self.tetrahedra[beyond as usize].neighbors.iter_mut().for_each(|back| *back &= !PLACED);
        }
        self.edges.sort_unstable();
        for pair in self.edges.as_chunks::<2>().0 {
            let [(_, a, i), (_, b, j)] = *pair;
            self.tetrahedra[a as usize].neighbors[i] = b;
            self.tetrahedra[b as usize].neighbors[j] = a;
        }
        self.boundary = boundary;
        self.boundary.clear();
        for &place in &self.free {
            self.tetrahedra[place as usize].corners = [INFINITE; 4];
        }
    }

    /// The tetrahedra without a corner at infinity.
    pub(super) fn finite_tetrahedra(self) -> Vec<Tetrahedron> {
        let is_finite = |tetrahedron: &Tetrahedron| !tetrahedron.corners.contains(&INFINITE);
        let mut count = 0;
        let renumbered: Vec<u32> = self
            .tetrahedra
            .iter()
            .map(|tetrahedron| {
                if !is_finite(tetrahedron) {
                    return NONE;
                }
                count += 1;
                count - 1
            })
            .collect();
        let mut tetrahedra = self.tetrahedra;
        tetrahedra.retain(is_finite);
        for tetrahedron in &mut tetrahedra {
            tetrahedron.neighbors = tetrahedron.neighbors.map(|neighbor| renumbered[neighbor as usize]);
        }
        tetrahedra
    }
}

/// Marks a number of a tetrahedron; there are fewer than half as many as fit 32 bits.
const PLACED: u32 = 1 << 31;
