//! Surfaces as small pieces that represent their visible parts: strata with a random place in each.

pub mod mesh;

use crate::neighbors::NeighborIndex;
use belvedere_data::cast::{to_index, to_row};
use belvedere_data::control::Control;
use belvedere_data::random::uniform;
use belvedere_data::vector::{cross, dot, length, sub, to_f32, unit};
use belvedere_data::{Error, Mesh, Parameter, Result};
use rayon::prelude::*;

/// Maximum number of pieces of a surface: 60 bytes each still fit into the memory of a usual machine.
const MAX_PIECES: usize = 50_000_000;
/// Number of neighbours whose distance gives the area that a point represents.
const NEIGHBORS: usize = 8;

/// A small triangle of a surface and the place on it for which visibility is queried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePiece {
    /// Corners, local metres, counter-clockwise seen from outside where that is known.
    pub corners: [[f32; 3]; 3],
    /// A place drawn evenly on it, local metres.
    pub place: [f32; 3],
    /// Unit normal outward: that of its face, which small corners in f32 would not tell.
    pub normal: [f32; 3],
    /// Area that it represents, m².
    pub area: f32,
    /// Face that it belongs to: a triangle of a mesh, or a point.
    pub face: u32,
}

/// Outside of a surface: known, or both sides.
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
    pub pieces: Vec<SurfacePiece>,
    /// Number of faces, those without area among them, which have no piece.
    pub face_count: usize,
    /// Outside of the faces: known, or both sides.
    pub sides: Sides,
}

impl SurfacePieces {
    /// Cuts the triangles of `mesh`, metres, around the local origin `origin`, metres, into slices and cells until no
    /// side is longer than `spacing` metres. A triangle with an area has at least one piece. A random place on each is
    /// drawn from `seed`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a spacing that is not above zero or would make more than 50 million pieces. Also
    /// for vertices that are not finite or lie 10 000 km or more from the origin.
    pub fn of_mesh(mesh: &Mesh, origin: [f64; 3], spacing: f64, seed: u64) -> Result<Self> {
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(Error::invalid(Parameter::Spacing, spacing, "above zero metres"));
        }
        let local: Vec<Option<[[f64; 3]; 3]>> = (0..mesh.triangles.len())
            .map(|t| mesh.corners(t).map(|corners| corners.map(|corner| sub(corner, origin))))
            .collect();
        let mut expected = 0.0;
        for corners in local.iter().flatten() {
            if !corners.as_flattened().iter().all(|v| v.abs() < 1e7) {
                return Err(Error::invalid(
                    Parameter::MeshVertex,
                    format!("{:?}", corners[0]),
                    "within 10 000 km of the scene",
                ));
            }
            let [a, b, c] = *corners;
            let longest = length(sub(b, a)).max(length(sub(c, b))).max(length(sub(a, c)));
            // cells are half the square of the spacing, and those at the edge mostly two or three pieces
            expected += 1.0 + 8.0 * area_of(*corners) / (spacing * spacing) + 6.0 * longest / spacing;
        }
        if !(expected <= MAX_PIECES as f64) {
            let value = format!("{spacing} m, which makes about {expected:.0} samples");
            return Err(Error::invalid(Parameter::Spacing, value, "large enough for at most 50 million samples"));
        }
        let of_face = |(face, corners): (usize, &Option<[[f64; 3]; 3]>)| {
            let mut pieces = Vec::new();
            if let Some(corners) = corners.filter(|corners| area_of(*corners) > 0.0) {
                cut(corners, spacing, &mut pieces);
            }
            let normal = corners
                .and_then(|[a, b, c]| unit(cross(sub(b, a), sub(c, a))))
                .map_or([0.0; 3], |normal| normal.map(to_f32));
            let number = index_u32(face);
            let piece = move |(i, corners): (usize, [[f64; 3]; 3])| {
                let counter = ((face as u64) << 32) | ((i as u64) << 1);
                let place = place_on(corners, [uniform(seed, counter), uniform(seed, counter + 1)]);
                SurfacePiece {
                    corners: corners.map(|corner| corner.map(to_f32)),
                    place: place.map(to_f32),
                    normal,
                    area: to_f32(area_of(corners)),
                    face: number,
                }
            };
            pieces.into_iter().enumerate().map(piece).collect::<Vec<_>>()
        };
        let pieces: Vec<Vec<SurfacePiece>> = local.par_iter().enumerate().map(of_face).collect();
        Ok(Self { pieces: pieces.concat(), face_count: mesh.triangles.len(), sides: Sides::Known })
    }

    /// Creates the surface of `points`, (N, 3) local metres. Each is a triangle perpendicular to its normal (`normals`,
    /// (N, 3), of any sign). Its area is π d² / 8 for the distance d to the eighth neighbour, at most that of a disc of
    /// `max_radius` metres. Points without a normal, (0, 0, 0), face upward.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless there is a normal for each point, [`Error::InvalidParameter`] for a point that
    /// is not finite and a radius that is not above zero.
    pub fn of_points(
        points: &[[f32; 3]],
        normals: &[[f32; 3]],
        max_radius: f64,
        control: &Control<'_>,
    ) -> Result<Self> {
        if normals.len() != points.len() {
            return Err(Error::LengthMismatch { what: "normals", expected: points.len(), found: normals.len() });
        }
        if !(max_radius.is_finite() && max_radius > 0.0) {
            return Err(Error::invalid(Parameter::PointRadius, max_radius, "above zero metres"));
        }
        let index = NeighborIndex::new(points, control)?;
        let max_area = std::f64::consts::PI * max_radius * max_radius;
        let piece = |(face, (&point, normal)): (usize, (&[f32; 3], &[f32; 3]))| {
            let mut found = Vec::new();
            // the point itself is among them
            index.k_nearest(point, NEIGHBORS + 1, &mut found);
            let count = found.len().saturating_sub(1);
            let farthest = found.iter().map(|n| f64::from(n.distance_squared)).fold(0.0, f64::max);
            let area = match count {
                0 => max_area,
                _ => (std::f64::consts::PI * farthest / count as f64).min(max_area),
            };
            let normal = unit(normal.map(f64::from)).unwrap_or([0.0, 0.0, 1.0]);
            let aside = if normal[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
            let right = unit(cross(aside, normal)).unwrap_or([1.0, 0.0, 0.0]);
            let up = cross(normal, right);
            // an equilateral triangle of that area about the point
            let reach = (4.0 * area / 27.0_f64.sqrt()).sqrt();
            let corner = |turn: f64| {
                let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
                std::array::from_fn(|i| to_f32(f64::from(point[i]) + reach * (cos * right[i] + sin * up[i])))
            };
            let corners = [corner(0.0), corner(1.0 / 3.0), corner(2.0 / 3.0)];
            SurfacePiece {
                corners,
                place: point,
                normal: normal.map(to_f32),
                area: to_f32(area),
                face: index_u32(face),
            }
        };
        let pieces = points.par_iter().zip(normals).enumerate().map(piece).collect();
        Ok(Self { pieces, face_count: points.len(), sides: Sides::Both })
    }

    /// Area of all pieces, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.pieces.iter().map(|piece| f64::from(piece.area)).sum()
    }

    /// Mean place of the pieces on the map, local metres; the origin without any.
    #[must_use]
    pub fn middle_on_map(&self) -> [f64; 2] {
        let count = self.pieces.len().max(1) as f64;
        [0, 1].map(|i| self.pieces.iter().map(|piece| f64::from(piece.place[i])).sum::<f64>() / count)
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

    /// Mean of `values`, one for each piece, over the area of each face, (faces). Pieces whose value is NaN do not
    /// count; NaN for a face without any.
    #[must_use]
    pub fn face_means(&self, values: &[f32]) -> Vec<f64> {
        let mut sums = vec![[0.0, 0.0]; self.face_count];
        for (piece, &value) in self.pieces.iter().zip(values).filter(|(_, value)| !value.is_nan()) {
            if let Some(sum) = sums.get_mut(piece.face as usize) {
                sum[0] += f64::from(piece.area) * f64::from(value);
                sum[1] += f64::from(piece.area);
            }
        }
        sums.into_iter().map(|[sum, area]| sum / area).collect()
    }
}

/// A triangle in pieces without a side longer than `spacing`, neighbours after each other: slices across its longest
/// side, each cut along that side too where it is wide.
fn cut(corners: [[f64; 3]; 3], spacing: f64, pieces: &mut Vec<[[f64; 3]; 3]>) {
    let [a, b, c] = corners;
    let sides = [sub(b, a), sub(c, b), sub(a, c)];
    let size = |i: usize| dot(sides[i], sides[i]);
    let longest = (1..3).fold(0, |longest, i| if size(i) > size(longest) { i } else { longest });
    let start = corners[longest];
    let axes = unit(sides[longest]).zip(unit(cross(sides[0], sides[1])));
    let Some((along, normal)) = axes.filter(|_| size(longest) > spacing * spacing) else {
        pieces.push(corners);
        return;
    };
    let across = cross(normal, along);
    // the diagonal of a cell is the longest side there can be
    let step = spacing * std::f64::consts::FRAC_1_SQRT_2;
    let outline = corners.map(|corner| [dot(sub(corner, start), along), dot(sub(corner, start), across)]);
    for slice in slices(&outline, 0, step) {
        for cell in slices(&slice, 1, step) {
            for pair in cell.get(1..).unwrap_or_default().windows(2) {
                let place = |[x, y]: [f64; 2]| std::array::from_fn(|i| start[i] + x * along[i] + y * across[i]);
                let piece = [cell[0], pair[0], pair[1]].map(place);
                if area_of(piece) > 0.0 {
                    pieces.push(piece);
                }
            }
        }
    }
}

/// A convex polygon in equal slices along an axis, none wider than `step`.
fn slices(outline: &[[f64; 2]], axis: usize, step: f64) -> Vec<Vec<[f64; 2]>> {
    let ends = outline
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [f64::min(low, p[axis]), f64::max(high, p[axis])]);
    let width = ends[1] - ends[0];
    let count = to_index((width / step).ceil().max(1.0));
    let edge = |i: usize| ends[0] + width * i as f64 / count as f64;
    (0..count)
        .map(|i| {
            let above = if i == 0 { outline.to_vec() } else { part_beyond(outline, axis, edge(i), 1.0) };
            if i + 1 == count { above } else { part_beyond(&above, axis, edge(i + 1), -1.0) }
        })
        .collect()
}

/// The part of a convex polygon where `sign` times the coordinate is at least `sign` times `bound`.
///
/// # Source
/// Sutherland & Hodgman 1974.
fn part_beyond(outline: &[[f64; 2]], axis: usize, bound: f64, sign: f64) -> Vec<[f64; 2]> {
    let mut part = Vec::with_capacity(outline.len() + 1);
    for (i, &p) in outline.iter().enumerate() {
        let q = outline[(i + 1) % outline.len()];
        let [before, after] = [p, q].map(|p| sign * (p[axis] - bound));
        if before >= 0.0 {
            part.push(p);
        }
        if (before < 0.0) != (after < 0.0) {
            let share = before / (before - after);
            let mut crossing: [f64; 2] = std::array::from_fn(|i| p[i] + share * (q[i] - p[i]));
            crossing[axis] = bound;
            part.push(crossing);
        }
    }
    part
}

fn area_of([a, b, c]: [[f64; 3]; 3]) -> f64 {
    length(cross(sub(b, a), sub(c, a))) / 2.0
}

/// The place on a triangle for two numbers from 0 to 1: evenly spread numbers give evenly spread places.
fn place_on([a, b, c]: [[f64; 3]; 3], [u, v]: [f64; 2]) -> [f64; 3] {
    let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
    std::array::from_fn(|i| a[i] + u * (b[i] - a[i]) + v * (c[i] - a[i]))
}

fn index_u32(index: usize) -> u32 {
    to_row(index)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(corners: [[f64; 3]; 3]) -> Mesh {
        Mesh { vertices: corners.to_vec(), triangles: vec![[0, 1, 2]], ..Mesh::default() }
    }

    #[test]
    fn pieces_are_short_cover_the_triangle_and_hold_their_places() {
        for (corners, max) in [
            ([[0.0, 0.0, 0.0], [7.0, 0.0, 1.0], [2.0, 5.0, 0.0]], 1200),
            // a strip 100 m long and 1 cm wide costs its length: 283 slices of two pieces
            ([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [100.0, 0.01, 0.0]], 567),
        ] {
            let pieces = SurfacePieces::of_mesh(&mesh(corners), [0.0; 3], 0.5, 3).unwrap();
            assert!((100..max).contains(&pieces.pieces.len()), "{}", pieces.pieces.len());
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
