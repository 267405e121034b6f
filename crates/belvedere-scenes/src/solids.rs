//! Closed solids that buildings are made of.

use crate::scene::{Material, Part, middle};
use crate::vector::{add_scaled, sub};

/// Where a piece of the plan lies and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Local (0, 0), metres, absolute.
    pub origin: [f64; 2],
    /// Direction of the local u axis, radians counter-clockwise from east; v is a quarter turn further.
    pub angle: f64,
}

impl Placement {
    /// Absolute position of the local (u, v), metres.
    #[must_use]
    pub fn at(&self, u: f64, v: f64) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        [self.origin[0] + u * cos - v * sin, self.origin[1] + u * sin + v * cos]
    }

    /// Placement with its origin at the local (u, v), turned by a further `angle` radians.
    #[must_use]
    pub fn moved(&self, u: f64, v: f64, angle: f64) -> Self {
        Self { origin: self.at(u, v), angle: self.angle + angle }
    }

    /// Corners of a rectangle about the origin, `length` along u and `width` along v, counter-clockwise from the
    /// lower left, (4, 2), metres.
    #[must_use]
    pub fn rectangle(&self, length: f64, width: f64) -> [[f64; 2]; 4] {
        let (u, v) = (length / 2.0, width / 2.0);
        [self.at(-u, -v), self.at(u, -v), self.at(u, v), self.at(-u, v)]
    }

    /// Corners of an L whose outer corner is the origin: one wing along u to `length_u`, one along v to `length_v`, both
    /// `width` wide; counter-clockwise from the inner corner, (6, 2), metres.
    #[must_use]
    pub fn l_shape(&self, length_u: f64, length_v: f64, width: f64) -> [[f64; 2]; 6] {
        [
            self.at(width, width),
            self.at(width, length_v),
            self.at(0.0, length_v),
            self.at(0.0, 0.0),
            self.at(length_u, 0.0),
            self.at(length_u, width),
        ]
    }
}

/// Closed prism with a flat roof over `footprint`, (N, 2), metres, counter-clockwise seen from above, from height
/// `bottom` to `top`.
///
/// All of the footprint must be in sight of its first corner, as it is in a convex polygon and in an L from its inner
/// corner. Fewer than three corners give an empty part.
#[must_use]
pub fn extruded(footprint: &[[f64; 2]], bottom: f64, top: f64) -> Part {
    let mut part = Part::default();
    let count = footprint.len();
    if count < 3 {
        return part;
    }
    add_walls(&mut part, footprint, bottom, top);
    part.add_polygon(&(count..2 * count).collect::<Vec<_>>(), Material::Roof);
    part
}

/// Closed house over the rectangle `footprint`, (4, 2), metres, counter-clockwise: walls from `bottom` to `eaves`, and a
/// roof whose ridge at height `ridge` runs parallel to the first side.
///
/// The ridge ends `hip` metres short of each end of the house: 0 gives gables (upright, facade), more gives hipped ends
/// (roof); beyond half the length the ridge would cross itself.
#[must_use]
pub fn ridged(footprint: &[[f64; 2]; 4], bottom: f64, eaves: f64, ridge: f64, hip: f64) -> Part {
    let mut part = Part::default();
    add_walls(&mut part, footprint, bottom, eaves);
    let [a, b, c, d] = footprint.map(|[x, y]| [x, y, ridge]);
    let (start, end) = (middle(d, a), middle(b, c));
    let along = sub(end, start);
    let inset = hip / (along[0] * along[0] + along[1] * along[1]).sqrt();
    part.vertices.push(add_scaled(start, along, inset));
    part.vertices.push(add_scaled(start, along, 1.0 - inset));
    let (start, end) = (8, 9);
    part.add_polygon(&[4, 5, end, start], Material::Roof);
    part.add_polygon(&[6, 7, start, end], Material::Roof);
    let end_material = if hip > 0.0 { Material::Roof } else { Material::Facade };
    part.add_polygon(&[5, 6, end], end_material);
    part.add_polygon(&[7, 4, start], end_material);
    part
}

/// Closed L-shaped house (see [`Placement::l_shape`]) with a gable at the end of each wing, a valley over the inner corner
/// and a hip over the outer one. Lengths and heights in metres.
#[must_use]
pub fn l_shaped_ridged(
    placement: &Placement,
    lengths: [f64; 2],
    width: f64,
    bottom: f64,
    eaves: f64,
    ridge: f64,
) -> Part {
    let mut part = Part::default();
    add_walls(&mut part, &placement.l_shape(lengths[0], lengths[1], width), bottom, eaves);
    let at_ridge = |u, v| {
        let [x, y] = placement.at(u, v);
        [x, y, ridge]
    };
    let half = width / 2.0;
    part.vertices.extend([at_ridge(half, half), at_ridge(lengths[0], half), at_ridge(half, lengths[1])]);
    let [inner, v_inner, v_outer, outer, u_outer, u_inner] = [6, 7, 8, 9, 10, 11];
    let (joint, u_end, v_end) = (12, 13, 14);
    part.add_polygon(&[outer, u_outer, u_end, joint], Material::Roof);
    part.add_polygon(&[u_inner, inner, joint, u_end], Material::Roof);
    part.add_polygon(&[inner, v_inner, v_end, joint], Material::Roof);
    part.add_polygon(&[v_outer, outer, joint, v_end], Material::Roof);
    part.add_polygon(&[u_outer, u_inner, u_end], Material::Facade);
    part.add_polygon(&[v_inner, v_outer, v_end], Material::Facade);
    part
}

/// Starts `part` with the corners of `footprint` at `bottom`, then at `top`, the walls between them and the floor.
fn add_walls(part: &mut Part, footprint: &[[f64; 2]], bottom: f64, top: f64) {
    let count = footprint.len();
    for height in [bottom, top] {
        part.vertices.extend(footprint.iter().map(|&[x, y]| [x, y, height]));
    }
    for i in 0..count {
        let next = (i + 1) % count;
        part.add_polygon(&[i, next, count + next, count + i], Material::Facade);
    }
    let floor: Vec<usize> = std::iter::once(0).chain((1..count).rev()).collect();
    part.add_polygon(&floor, Material::Facade);
}
