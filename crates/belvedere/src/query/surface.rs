//! Surfaces as small pieces that stand for what is seen of them: strata with a place drawn in each.

use crate::neighbors::NeighborIndex;
use crate::random::uniform;
use crate::vector::{cross, dot, length, sub, unit};
use crate::{Error, Mesh, Result};
use rayon::prelude::*;

/// Most pieces of a surface: 60 bytes each still fit into the memory of a usual machine.
const MOST_PIECES: usize = 50_000_000;
/// Halvings after which a triangle is not cut further: its sides are then a billionth of its longest.
const MOST_HALVINGS: usize = 60;
/// Neighbours whose distance tells how much surface a point stands for.
const NEIGHBORS: usize = 8;

/// A small triangle of a surface and the place on it where it is asked whether it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Corners, local metres, counter-clockwise seen from outside where that is known.
    pub corners: [[f32; 3]; 3],
    /// A place drawn evenly on it, local metres.
    pub place: [f32; 3],
    /// Area it stands for, m².
    pub area: f32,
    /// Face that it belongs to: a triangle of a mesh, or a point.
    pub face: u32,
}

/// Whether a surface knows its outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// Faces have an outside, as those of closed meshes.
    Known,
    /// Faces are seen from either side.
    Both,
}

/// A surface as pieces, those of a face together and in rising order of faces.
#[derive(Clone, Debug)]
pub struct SurfacePieces {
    /// The pieces.
    pub pieces: Vec<Piece>,
    /// Number of faces, those without area among them, which have no piece.
    pub face_count: usize,
    /// Whether faces have an outside.
    pub sides: Sides,
}

impl Piece {
    /// Unit normal outward, or `None` for a piece without area.
    #[must_use]
    pub fn normal(&self) -> Option<[f64; 3]> {
        let [a, b, c] = self.corners.map(|corner| corner.map(f64::from));
        unit(cross(sub(b, a), sub(c, a)))
    }
}

impl SurfacePieces {
    /// The triangles of `mesh`, metres, about the local origin `origin`, metres, each halved across its longest side until no side is
    /// longer than `spacing` metres; at least one piece a triangle that has an area. A place is drawn on each from `seed`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a spacing that is not above zero or would make more than 50 million pieces, and for
    /// vertices that are not finite or lie 10 000 km or more from the origin.
    ///
    /// # Source
    /// Halving of the longest side: Rosenberg & Stenger 1975. No angle of a piece is below half the least angle of the triangle, so
    /// that pieces stay plump and a long thin wall costs its length.
    pub fn of_mesh(mesh: &Mesh, origin: [f64; 3], spacing: f64, seed: u64) -> Result<Self> {
        if !(spacing.is_finite() && spacing > 0.0) {
            return invalid("spacing of samples", spacing.to_string(), "above zero metres");
        }
        let local: Vec<Option<[[f64; 3]; 3]>> = (0..mesh.triangles.len())
            .map(|t| mesh.corners(t).map(|corners| corners.map(|corner| sub(corner, origin))))
            .collect();
        let mut expected = 0.0;
        for corners in local.iter().flatten() {
            if !corners.as_flattened().iter().all(|v| v.abs() < 1e7) {
                return invalid("vertex of the mesh", format!("{:?}", corners[0]), "within 10 000 km of the scene");
            }
            let [a, b, c] = *corners;
            let longest = length(sub(b, a)).max(length(sub(c, b))).max(length(sub(a, c)));
            // a piece has at least a quarter of the area of a right-angled one with two sides of half the spacing, or the triangle is
            // thin and cut along its length alone
            expected += 1.0 + 8.0 * area_of(*corners) / (spacing * spacing) + 2.0 * longest / spacing;
        }
        if !(expected <= MOST_PIECES as f64) {
            let value = format!("{spacing} m, which makes about {expected:.0} samples");
            return invalid("spacing of samples", value, "large enough for at most 50 million samples");
        }
        let of_face = |(face, corners): (usize, &Option<[[f64; 3]; 3]>)| {
            let mut pieces = Vec::new();
            if let Some(corners) = corners.filter(|corners| area_of(*corners) > 0.0) {
                halve(corners, spacing, MOST_HALVINGS, &mut pieces);
            }
            let number = index_u32(face);
            let piece = move |(i, corners): (usize, [[f64; 3]; 3])| {
                let counter = ((face as u64) << 32) | ((i as u64) << 1);
                let place = place_on(corners, [uniform(seed, counter), uniform(seed, counter + 1)]);
                Piece {
                    corners: corners.map(to_f32),
                    place: to_f32(place),
                    area: single(area_of(corners)),
                    face: number,
                }
            };
            pieces.into_iter().enumerate().map(piece).collect::<Vec<_>>()
        };
        let pieces: Vec<Vec<Piece>> = local.par_iter().enumerate().map(of_face).collect();
        Ok(Self { pieces: pieces.concat(), face_count: mesh.triangles.len(), sides: Sides::Known })
    }

    /// The surface that `points`, (N, 3) local metres, lie on: about each a triangle square to its normal (`normals`, (N, 3), of any
    /// sign), whose area follows from how near the eighth neighbour is, π d² / 8, and is that of a disc of `most_radius`
    /// metres at most. Points without a normal, (0, 0, 0), are turned upward.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless there is a normal for each point, [`Error::InvalidParameter`] for a point that is not finite and
    /// a radius that is not above zero.
    pub fn of_points(points: &[[f32; 3]], normals: &[[f32; 3]], most_radius: f64) -> Result<Self> {
        if normals.len() != points.len() {
            return Err(Error::LengthMismatch { what: "normals", expected: points.len(), found: normals.len() });
        }
        if !(most_radius.is_finite() && most_radius > 0.0) {
            return invalid("greatest radius of a point", most_radius.to_string(), "above zero metres");
        }
        let index = NeighborIndex::new(points)?;
        let most_area = std::f64::consts::PI * most_radius * most_radius;
        let piece = |(face, (&point, normal)): (usize, (&[f32; 3], &[f32; 3]))| {
            let mut found = Vec::new();
            // the point itself is among them
            index.k_nearest(point, NEIGHBORS + 1, &mut found);
            let count = found.len().saturating_sub(1);
            let farthest = found.iter().map(|n| f64::from(n.distance_squared)).fold(0.0, f64::max);
            let area = match count {
                0 => most_area,
                _ => (std::f64::consts::PI * farthest / count as f64).min(most_area),
            };
            let normal = unit(normal.map(f64::from)).unwrap_or([0.0, 0.0, 1.0]);
            let aside = if normal[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
            let right = unit(cross(aside, normal)).unwrap_or([1.0, 0.0, 0.0]);
            let up = cross(normal, right);
            // an equilateral triangle of that area about the point
            let reach = (4.0 * area / 27.0_f64.sqrt()).sqrt();
            let corner = |turn: f64| {
                let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
                to_f32(std::array::from_fn(|i| f64::from(point[i]) + reach * (cos * right[i] + sin * up[i])))
            };
            let corners = [corner(0.0), corner(1.0 / 3.0), corner(2.0 / 3.0)];
            Piece { corners, place: point, area: single(area), face: index_u32(face) }
        };
        let pieces = points.par_iter().zip(normals).enumerate().map(piece).collect();
        Ok(Self { pieces, face_count: points.len(), sides: Sides::Both })
    }

    /// Area of all pieces, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.pieces.iter().map(|piece| f64::from(piece.area)).sum()
    }

    /// Area of each face, (faces) m².
    #[must_use]
    pub fn face_areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.face_count];
        for piece in &self.pieces {
            if let Some(area) = areas.get_mut(piece.face as usize) {
                *area += f64::from(piece.area);
            }
        }
        areas
    }
}

fn invalid<T>(name: &'static str, value: String, expected: &'static str) -> Result<T> {
    Err(Error::InvalidParameter { name, value, expected })
}

/// Halves of halves of a triangle, none with a side longer than `spacing`, neighbours after each other.
fn halve(corners: [[f64; 3]; 3], spacing: f64, halvings: usize, pieces: &mut Vec<[[f64; 3]; 3]>) {
    let [a, b, c] = corners;
    let sides = [sub(b, a), sub(c, b), sub(a, c)].map(|side| dot(side, side));
    let longest = (1..3).fold(0, |longest, i| if sides[i] > sides[longest] { i } else { longest });
    if sides[longest] <= spacing * spacing || halvings == 0 {
        pieces.push(corners);
        return;
    }
    // turned so that the longest side runs from the first corner to the second
    let [a, b, c] = [[a, b, c], [b, c, a], [c, a, b]][longest];
    let middle = std::array::from_fn(|i| (a[i] + b[i]) / 2.0);
    halve([a, middle, c], spacing, halvings - 1, pieces);
    halve([middle, b, c], spacing, halvings - 1, pieces);
}

fn area_of([a, b, c]: [[f64; 3]; 3]) -> f64 {
    length(cross(sub(b, a), sub(c, a))) / 2.0
}

/// The place on a triangle that two numbers from 0 to 1 stand for, evenly spread.
fn place_on([a, b, c]: [[f64; 3]; 3], [u, v]: [f64; 2]) -> [f64; 3] {
    let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
    std::array::from_fn(|i| a[i] + u * (b[i] - a[i]) + v * (c[i] - a[i]))
}

#[expect(clippy::cast_possible_truncation, reason = "local positions are f32")]
fn to_f32(v: [f64; 3]) -> [f32; 3] {
    v.map(|v| v as f32)
}

#[expect(clippy::cast_possible_truncation, reason = "an area needs no more digits")]
fn single(area: f64) -> f32 {
    area as f32
}

#[expect(clippy::cast_possible_truncation, reason = "faces are numbered with 32 bits")]
fn index_u32(index: usize) -> u32 {
    index as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(corners: [[f64; 3]; 3]) -> Mesh {
        Mesh { vertices: corners.to_vec(), triangles: vec![[0, 1, 2]], ..Mesh::default() }
    }

    #[test]
    fn pieces_are_short_cover_the_triangle_and_hold_their_places() {
        for (corners, most) in [
            ([[0.0, 0.0, 0.0], [7.0, 0.0, 1.0], [2.0, 5.0, 0.0]], 1200),
            // a strip 100 m long and 1 cm wide costs its length, not the square of it
            ([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [100.0, 0.01, 0.0]], 520),
        ] {
            let pieces = SurfacePieces::of_mesh(&mesh(corners), [0.0; 3], 0.5, 3).unwrap();
            assert!((100..most).contains(&pieces.pieces.len()), "{}", pieces.pieces.len());
            // areas are f32
            assert!((pieces.area() / area_of(corners) - 1.0).abs() < 1e-5);
            for piece in &pieces.pieces {
                let [a, b, c] = piece.corners.map(|p| p.map(f64::from));
                // corners are f32: 100 m carry 8 µm
                assert!([sub(a, b), sub(b, c), sub(c, a)].iter().all(|&side| length(side) <= 0.5 + 1e-4));
                let p = piece.place.map(f64::from);
                let parts: f64 = [[a, b, p], [b, c, p], [c, a, p]].into_iter().map(area_of).sum();
                assert!((parts - f64::from(piece.area)).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn senseless_spacings_and_vertices_are_refused() {
        let corners = [[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [0.0, 100.0, 0.0]];
        for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-4] {
            let error = SurfacePieces::of_mesh(&mesh(corners), [0.0; 3], spacing, 1).unwrap_err().to_string();
            assert!(error.contains("spacing"), "{error}");
        }
        let far = [[0.0; 3], [1e9, 0.0, 0.0], [0.0, f64::NAN, 0.0]];
        assert!(SurfacePieces::of_mesh(&mesh(far), [0.0; 3], 1.0, 1).is_err());
        let flat = SurfacePieces::of_mesh(&mesh([[1.0; 3]; 3]), [0.0; 3], 1.0, 1).unwrap();
        assert!(flat.pieces.is_empty() && flat.face_count == 1);
    }
}
