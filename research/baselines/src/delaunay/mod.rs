//! Delaunay tetrahedralisation of points in space, with exact signs.

mod insert;
#[cfg(test)]
mod tests;

use crate::curve::{Curve, insertion_order, number};
use belvedere::vector::{cross, dot, sub};
use robust::{Coord3D, insphere, orient3d};

use insert::DelaunayBuilder;

/// No tetrahedron: what lies beyond a face of the convex hull.
pub(crate) const NONE: u32 = u32::MAX;
/// More points could have more tetrahedra than there are numbers of 32 bits.
pub(crate) const MAX_POINTS: usize = 1 << 27;

/// A tetrahedron, its corners in positive order: seen from the first, the others turn counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tetrahedron {
    /// Numbers of points.
    pub(crate) corners: [u32; 4],
    /// The tetrahedron across the face opposite to each corner, or [`NONE`].
    pub(crate) neighbors: [u32; 4],
}

/// The Delaunay tetrahedra of a set of points: no point lies inside the circumsphere of any of them.
pub(crate) struct Delaunay {
    /// The points given, (N, 3).
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) tetrahedra: Vec<Tetrahedron>,
    /// A tetrahedron at each point; [`NONE`] for all but one of several points at one place.
    pub(crate) at_point: Vec<u32>,
}

impl Delaunay {
    /// Tetrahedralises `points`, (N, 3), finite and of f32 precision, at most [`MAX_POINTS`]. Points in one plane have
    /// no tetrahedra. Of points at one place one is used.
    ///
    /// # Source
    /// Bowyer 1981 and Watson 1981, with one corner at infinity for what lies outside; insertion in rounds: Amenta,
    /// Choi & Rote 2003; exact signs: Shewchuk 1997.
    pub(crate) fn new(points: Vec<[f64; 3]>) -> Self {
        let Some(first) = first_tetrahedron(&points) else {
            let at_point = vec![NONE; points.len()];
            return Self { points, tetrahedra: Vec::new(), at_point };
        };
        let curve = Curve::new(&points);
        let mut builder = DelaunayBuilder::new(&points, first);
        for point in insertion_order(&points, &first, &curve) {
            builder.insert(point);
        }
        let tetrahedra = builder.finite_tetrahedra();
        let mut at_point = vec![NONE; points.len()];
        for (index, tetrahedron) in tetrahedra.iter().enumerate() {
            for corner in tetrahedron.corners {
                at_point[corner as usize] = number(index);
            }
        }
        Self { points, tetrahedra, at_point }
    }

    /// The corners of a tetrahedron.
    pub(crate) fn corners(&self, tetrahedron: u32) -> [[f64; 3]; 4] {
        self.tetrahedra[tetrahedron as usize].corners.map(|corner| self.points[corner as usize])
    }
}

/// Four points that do not lie in one plane, in positive order.
fn first_tetrahedron(points: &[[f64; 3]]) -> Option<[u32; 4]> {
    let &a = points.first()?;
    let farthest = |size: &dyn Fn([f64; 3]) -> f64| {
        let sizes = (0..).zip(points).map(|(index, &p)| (index, size(p)));
        sizes.reduce(|best, other| if other.1 > best.1 { other } else { best }).filter(|best| best.1 > 0.0)
    };
    let square = |v: [f64; 3]| dot(v, v);
    let (second, _) = farthest(&|p| square(sub(p, a)))?;
    let b: [f64; 3] = points[second as usize];
    let (third, _) = farthest(&|p| square(cross(sub(b, a), sub(p, a))))?;
    let c = points[third as usize];
    let (fourth, _) = farthest(&|p| orient([a, b, c, p]).abs())?;
    let is_positive = orient([a, b, c, points[fourth as usize]]) > 0.0;
    Some(if is_positive { [0, second, third, fourth] } else { [0, third, second, fourth] })
}

/// Above zero where the corners are in positive order; exact sign.
fn orient(corners: [[f64; 3]; 4]) -> f64 {
    let [a, b, c, d] = corners.map(coordinates);
    orient3d(a, b, c, d)
}

/// Above zero where `point` lies inside the sphere through four corners in positive order; exact sign.
fn in_sphere(corners: [[f64; 3]; 4], point: [f64; 3]) -> f64 {
    let [a, b, c, d] = corners.map(coordinates);
    insphere(a, b, c, d, coordinates(point))
}

fn coordinates([x, y, z]: [f64; 3]) -> Coord3D<f64> {
    Coord3D { x, y, z }
}
