//! Closed solids that buildings are made of.

use crate::scene::{Material, ObjectPart, middle};
use crate::vector::{add_scaled, sub};

/// Where a piece of the plan lies and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanPlacement {
    /// Local (0, 0), metres, absolute.
    pub origin: [f64; 2],
    /// Direction of the local u axis, radians counter-clockwise from east; v is a quarter turn further.
    pub angle: f64,
}

impl PlanPlacement {
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

    /// Corners of an L whose outer corner is the origin: one wing along u to `length_u`, one along v to `length_v`,
    /// both `width` wide; counter-clockwise from the inner corner, (6, 2), metres.
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
pub fn extruded(footprint: &[[f64; 2]], bottom: f64, top: f64) -> ObjectPart {
    let mut part = ObjectPart::default();
    let count = footprint.len();
    if count < 3 {
        return part;
    }
    add_walls(&mut part, footprint, bottom, top);
    part.add_polygon(&(count..2 * count).collect::<Vec<_>>(), Material::Roof);
    part
}

/// Closed house over the rectangle `footprint`, (4, 2), metres, counter-clockwise: walls from `bottom` to `eaves`, and
/// a roof whose ridge at height `ridge` runs parallel to the first side.
///
/// The ridge ends `hip` metres short of each end of the house: 0 gives gables (upright, facade), more gives hipped ends
/// (roof); beyond half the length the ridge would cross itself.
#[must_use]
pub fn ridged(footprint: &[[f64; 2]; 4], bottom: f64, eaves: f64, ridge: f64, hip: f64) -> ObjectPart {
    let mut part = ObjectPart::default();
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

/// Closed L-shaped house (see [`PlanPlacement::l_shape`]) with a gable at the end of each wing, a valley over the inner
/// corner and a hip over the outer one. Lengths and heights in metres.
#[must_use]
pub fn l_shaped_ridged(
    placement: &PlanPlacement,
    lengths: [f64; 2],
    width: f64,
    bottom: f64,
    eaves: f64,
    ridge: f64,
) -> ObjectPart {
    let mut part = ObjectPart::default();
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

/// Closed solid through `rings`, each of the same number of corners: sides between neighbouring rings, the first and
/// the last ring as caps. An upright prism is two rings, a sagging wire many.
///
/// Rings run counter-clockwise seen from the end that the sweep goes to; all of a cap must be in sight of its first
/// corner. `side_materials` has one material per edge of a ring, edge k from corner k to the next; the last one holds
/// for all that follow. Sides need not be flat. Fewer than two rings, or none with three corners, give an empty part.
pub(crate) fn swept<R: AsRef<[[f64; 3]]>>(rings: &[R], side_materials: &[Material], cap: Material) -> ObjectPart {
    let mut part = ObjectPart::default();
    let count = rings.iter().map(|ring| ring.as_ref().len()).min().unwrap_or(0);
    let material = |k: usize| side_materials.get(k).or(side_materials.last()).copied().unwrap_or(cap);
    if count < 3 || rings.len() < 2 {
        return part;
    }
    for ring in rings {
        part.vertices.extend(ring.as_ref().iter().take(count));
    }
    for ring in 1..rings.len() {
        let (before, after) = ((ring - 1) * count, ring * count);
        for k in 0..count {
            let next = (k + 1) % count;
            part.add_polygon(&[before + k, before + next, after + next, after + k], material(k));
        }
    }
    let last = (rings.len() - 1) * count;
    let start: Vec<usize> = std::iter::once(0).chain((1..count).rev()).collect();
    part.add_polygon(&start, cap);
    part.add_polygon(&(last..last + count).collect::<Vec<_>>(), cap);
    part
}

/// Upright prism of one material over the convex `footprint`, (N, 2), counter-clockwise, heights in metres.
pub(crate) fn prism(footprint: &[[f64; 2]], bottom: f64, top: f64, material: Material) -> ObjectPart {
    let ring = |height: f64| footprint.iter().map(|&[x, y]| [x, y, height]).collect::<Vec<_>>();
    swept(&[ring(bottom), ring(top)], &[material], material)
}

/// Whether a course of wings comes back to where it starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WingCourse {
    /// With a gable at either end: one wing, an L, a U.
    Open,
    /// Around a courtyard.
    Closed,
}

/// Closed building of wings along a course, with the outer corners `outer`, (N, 2), on the right and `inner`, (N, 2),
/// on the left; the opposite walls of a wing are parallel. The ridge runs midway between them; at the height of the
/// eaves it makes a flat roof. Heights in metres.
pub(crate) fn winged(
    outer: &[[f64; 2]],
    inner: &[[f64; 2]],
    course: WingCourse,
    bottom: f64,
    eaves: f64,
    ridge: f64,
) -> ObjectPart {
    let mut part = ObjectPart::default();
    let count = outer.len().min(inner.len());
    if count < 2 {
        return part;
    }
    for (&[ox, oy], &[ix, iy]) in outer.iter().zip(inner) {
        part.vertices.extend([[ox, oy, bottom], [ix, iy, bottom], [ox, oy, eaves], [ix, iy, eaves]]);
        part.vertices.push([(ox + ix) / 2.0, (oy + iy) / 2.0, ridge]);
    }
    let corner = |station: usize| [0, 1, 2, 3, 4].map(|k| 5 * station + k);
    let wings = if course == WingCourse::Closed { count } else { count - 1 };
    for station in 0..wings {
        let [outer_a, inner_a, outer_eaves_a, inner_eaves_a, ridge_a] = corner(station);
        let [outer_b, inner_b, outer_eaves_b, inner_eaves_b, ridge_b] = corner((station + 1) % count);
        part.add_polygon(&[outer_a, outer_b, outer_eaves_b, outer_eaves_a], Material::Facade);
        part.add_polygon(&[inner_b, inner_a, inner_eaves_a, inner_eaves_b], Material::Facade);
        part.add_polygon(&[outer_a, inner_a, inner_b, outer_b], Material::Facade);
        part.add_polygon(&[outer_eaves_a, outer_eaves_b, ridge_b, ridge_a], Material::Roof);
        part.add_polygon(&[ridge_a, ridge_b, inner_eaves_b, inner_eaves_a], Material::Roof);
    }
    if course == WingCourse::Open {
        let [outer, inner, outer_eaves, inner_eaves, ridge] = corner(0);
        part.add_polygon(&[outer, outer_eaves, ridge, inner_eaves, inner], Material::Facade);
        let [outer, inner, outer_eaves, inner_eaves, ridge] = corner(count - 1);
        part.add_polygon(&[outer, inner, inner_eaves, ridge, outer_eaves], Material::Facade);
    }
    part
}

/// Starts `part` with the corners of `footprint` at `bottom`, then at `top`, the walls between them and the floor.
fn add_walls(part: &mut ObjectPart, footprint: &[[f64; 2]], bottom: f64, top: f64) {
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
