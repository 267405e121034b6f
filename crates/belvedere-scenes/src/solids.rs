//! Closed solids for buildings.

use crate::scene::{Material, ObjectPart, middle};
use crate::vector::{add, add_scaled, length, scale, sub};

/// Depth of a joint in the solid it belongs to, metres. Solids that merely touch would leave a seam that a scanner sees
/// into.
pub(crate) const JOINT: f64 = 0.1;

/// Position and orientation of a piece of the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanPlacement {
    /// Absolute position of the local (0, 0), metres.
    pub origin: [f64; 2],
    /// Direction of the local u axis, radians counter-clockwise from east; v is a quarter turn further.
    pub angle: f64,
}

impl PlanPlacement {
    /// Returns the absolute position of the local (u, v), metres.
    #[must_use]
    pub fn at(&self, u: f64, v: f64) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        [self.origin[0] + u * cos - v * sin, self.origin[1] + u * sin + v * cos]
    }

    /// Returns the placement with its origin at the local (u, v), turned by a further `angle` radians.
    #[must_use]
    pub fn moved(&self, u: f64, v: f64, angle: f64) -> Self {
        Self { origin: self.at(u, v), angle: self.angle + angle }
    }

    /// Returns the corners of a rectangle about the origin, `length` along u and `width` along v. They are
    /// counter-clockwise from the lower left, (4, 2), metres.
    #[must_use]
    pub fn rectangle(&self, length: f64, width: f64) -> [[f64; 2]; 4] {
        let (u, v) = (length / 2.0, width / 2.0);
        [self.at(-u, -v), self.at(u, -v), self.at(u, v), self.at(-u, v)]
    }

    /// Returns the corners of an L whose outer corner is the origin: one wing along u to `length_u`, one along v to
    /// `length_v`. Both wings are `width` wide. The corners are counter-clockwise from the inner corner, (6, 2),
    /// metres.
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

/// Returns a closed prism with a flat roof over `footprint`, (N, 2), metres, from height `bottom` to `top`. The
/// footprint is counter-clockwise seen from above.
///
/// All of the footprint must be in sight of its first corner, as in a convex polygon and in an L from its inner corner.
/// Fewer than three corners give an empty part.
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

/// Returns a closed house over the rectangle `footprint`, (4, 2), metres, counter-clockwise. Walls rise from `bottom`
/// to `eaves`. The ridge of the roof, at height `ridge`, is parallel to the first side.
///
/// The ridge ends `hip` metres from each end of the house. 0 gives gables (upright, facade), more gives hipped ends
/// (roof). Beyond half the length the ridge would cross itself.
#[must_use]
pub fn ridged(footprint: &[[f64; 2]; 4], bottom: f64, eaves: f64, ridge: f64, hip: f64) -> ObjectPart {
    ridged_to(footprint, hip, &RidgedProfile { bottom, eaves, ridge, overhang: Overhang::default() })
}

/// Absolute heights of a building with a ridge, and the overhang of its roof, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RidgedProfile {
    pub(crate) bottom: f64,
    /// Height of the line in which the plane of the roof meets the plane of the wall.
    pub(crate) eaves: f64,
    pub(crate) ridge: f64,
    pub(crate) overhang: Overhang,
}

/// Level distance by which a sloped roof extends beyond the walls, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Overhang {
    /// Overhang beyond the walls below the eaves, in the slope of the roof. 0 for none.
    pub(crate) eaves: f64,
    /// Overhang beyond gables, if there are eaves. 0 ends the eaves in the plane of the gable.
    pub(crate) verge: f64,
}

/// Vertical thickness of a roof with an overhang, metres.
const ROOF_THICKNESS: f64 = 0.2;

/// Returns a house as [`ridged`] does, with the heights and the overhang of `profile`. The sides and the underside of
/// an overhang are roof.
pub(crate) fn ridged_to(footprint: &[[f64; 2]; 4], hip: f64, profile: &RidgedProfile) -> ObjectPart {
    let mut part = ObjectPart::default();
    add_walls(&mut part, footprint, profile.bottom, profile.eaves);
    let [a, b, c, d] = footprint.map(|[x, y]| [x, y, profile.ridge]);
    let (start, end) = (middle(d, a), middle(b, c));
    let along = sub(end, start);
    let inset = hip / (along[0] * along[0] + along[1] * along[1]).sqrt();
    part.vertices.push(add_scaled(start, along, inset));
    part.vertices.push(add_scaled(start, along, 1.0 - inset));
    let has_eaves = profile.overhang.eaves > 0.0;
    let share = if has_eaves { profile.overhang.eaves / (length(sub(d, a)) / 2.0) } else { 0.0 };
    let has_gables = !(hip > 0.0);
    let verge = if has_gables && has_eaves { profile.overhang.verge / length(along) } else { 0.0 };
    let beyond = [scale(along, -verge), scale(along, verge)];
    let [a, b, c, d] = [(4, 0), (5, 1), (6, 1), (7, 0)]
        .map(|(wall, end)| RoofCorner::eaves(&mut part, wall, 8 + end, share, beyond[end]));
    let [start, end] = [0, 1].map(|end| RoofCorner::new(&mut part, 8 + end, beyond[end]));
    part.add_polygon(&[a.upper, b.upper, end.upper, start.upper], Material::Roof);
    part.add_polygon(&[c.upper, d.upper, start.upper, end.upper], Material::Roof);
    if has_gables {
        part.add_polygon(&[b.wall, c.wall, end.wall], Material::Facade);
        part.add_polygon(&[d.wall, a.wall, start.wall], Material::Facade);
        add_overhang(&mut part, &[a, b, end, c, d, start]);
    } else {
        part.add_polygon(&[b.upper, c.upper, end.upper], Material::Roof);
        part.add_polygon(&[d.upper, a.upper, start.upper], Material::Roof);
        add_overhang(&mut part, &[a, b, c, d]);
    }
    part
}

/// Corner at the edge of a roof, as three indices of vertices. They are the end of the wall below, and the lower and
/// the upper corner of the overhang. Without an overhang all three are the same.
#[derive(Clone, Copy)]
struct RoofCorner {
    wall: usize,
    lower: usize,
    upper: usize,
}

impl RoofCorner {
    /// Creates the corner over the vertex `wall`, which lies in the plane of the roof. The roof extends `outward`
    /// beyond it, metres. The wall then ends below the roof.
    fn new(part: &mut ObjectPart, wall: usize, outward: [f64; 3]) -> Self {
        if length(outward) == 0.0 {
            return Self { wall, lower: wall, upper: wall };
        }
        let below = [0.0, 0.0, -ROOF_THICKNESS];
        let edge = add(part.vertices[wall], outward);
        part.vertices[wall] = add(part.vertices[wall], below);
        part.vertices.extend([add(edge, below), edge]);
        Self { wall, lower: part.vertices.len() - 2, upper: part.vertices.len() - 1 }
    }

    /// Creates a corner of eaves over the vertex `wall`. The roof extends by a `share` of the vector from the vertex
    /// `ridge` to the wall, and by `aside`.
    fn eaves(part: &mut ObjectPart, wall: usize, ridge: usize, share: f64, aside: [f64; 3]) -> Self {
        let down = sub(part.vertices[wall], part.vertices[ridge]);
        Self::new(part, wall, add(scale(down, share), aside))
    }
}

/// Adds the underside and the side of an overhang along the closed `edge` of a roof, counter-clockwise seen from above.
fn add_overhang(part: &mut ObjectPart, edge: &[RoofCorner]) {
    for (from, to) in edge.iter().zip(edge.iter().cycle().skip(1)) {
        part.add_polygon(&[from.wall, to.wall, to.lower, from.lower], Material::Roof);
        part.add_polygon(&[from.lower, to.lower, to.upper, from.upper], Material::Roof);
    }
}

/// Returns a closed L-shaped house (see [`PlanPlacement::l_shape`]) with a gable at the end of each wing. It has a
/// valley over the inner corner and a hip over the outer one. Lengths and heights are in metres.
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

/// Returns a closed solid through `rings`, each with the same number of corners. Neighbouring rings are joined by
/// sides, and the first and the last ring are caps. An upright prism is two rings, a sagging wire many.
///
/// Rings run counter-clockwise seen from the end of the sweep. All of a cap must be in sight of its first corner.
/// `side_materials` has one material per edge of a ring; edge k runs from corner k to the next. The last material
/// applies to all further edges. Sides need not be flat. Fewer than two rings, or rings with fewer than three corners,
/// give an empty part.
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

/// Returns an upright prism of one material over the convex `footprint`, (N, 2), counter-clockwise, heights in metres.
pub(crate) fn prism(footprint: &[[f64; 2]], bottom: f64, top: f64, material: Material) -> ObjectPart {
    let ring = |height: f64| footprint.iter().map(|&[x, y]| [x, y, height]).collect::<Vec<_>>();
    swept(&[ring(bottom), ring(top)], &[material], material)
}

/// Shape of a course of wings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WingCourse {
    /// Course with a gable at either end: one wing, an L, a U.
    Open,
    /// Course around a courtyard.
    Closed,
}

/// Returns a closed building of wings along a course. The outer corners `outer`, (N, 2), are on the right and `inner`,
/// (N, 2), on the left. The opposite walls of a wing are parallel. The ridge runs midway between them. A ridge at the
/// height of the eaves makes a flat roof, which must not overhang.
pub(crate) fn winged(
    outer: &[[f64; 2]],
    inner: &[[f64; 2]],
    course: WingCourse,
    profile: &RidgedProfile,
) -> ObjectPart {
    let mut part = ObjectPart::default();
    let count = outer.len().min(inner.len());
    if count < 2 {
        return part;
    }
    let RidgedProfile { bottom, eaves, ridge, overhang } = *profile;
    for (&[ox, oy], &[ix, iy]) in outer.iter().zip(inner) {
        part.vertices.extend([[ox, oy, bottom], [ix, iy, bottom], [ox, oy, eaves], [ix, iy, eaves]]);
        part.vertices.push([(ox + ix) / 2.0, (oy + iy) / 2.0, ridge]);
    }
    let corner = |station: usize| [0, 1, 2, 3, 4].map(|k| 5 * station + k);
    let is_open = course == WingCourse::Open;
    let half_width = distance_from_line(outer[0], outer[1], inner[0]) / 2.0;
    let share = if overhang.eaves > 0.0 { overhang.eaves / half_width } else { 0.0 };
    let verges = if is_open && share > 0.0 { ends_beyond(&outer[..count], overhang.verge) } else { [[0.0; 3]; 2] };
    let (mut outer_edge, mut inner_edge, mut ridges) = (Vec::new(), Vec::new(), Vec::new());
    for station in 0..count {
        let [_, _, outer_eaves, inner_eaves, ridge] = corner(station);
        let aside = match station {
            0 => verges[0],
            last if last == count - 1 => verges[1],
            _ => [0.0; 3],
        };
        outer_edge.push(RoofCorner::eaves(&mut part, outer_eaves, ridge, share, aside));
        inner_edge.push(RoofCorner::eaves(&mut part, inner_eaves, ridge, share, aside));
        ridges.push(RoofCorner::new(&mut part, ridge, aside));
    }
    let wings = if is_open { count - 1 } else { count };
    for station in 0..wings {
        let next = (station + 1) % count;
        let [outer_a, inner_a, outer_eaves_a, inner_eaves_a, _] = corner(station);
        let [outer_b, inner_b, outer_eaves_b, inner_eaves_b, _] = corner(next);
        let (ridge_a, ridge_b) = (ridges[station].upper, ridges[next].upper);
        part.add_polygon(&[outer_a, outer_b, outer_eaves_b, outer_eaves_a], Material::Facade);
        part.add_polygon(&[inner_b, inner_a, inner_eaves_a, inner_eaves_b], Material::Facade);
        part.add_polygon(&[outer_a, inner_a, inner_b, outer_b], Material::Facade);
        part.add_polygon(&[outer_edge[station].upper, outer_edge[next].upper, ridge_b, ridge_a], Material::Roof);
        part.add_polygon(&[ridge_a, ridge_b, inner_edge[next].upper, inner_edge[station].upper], Material::Roof);
    }
    inner_edge.reverse();
    if is_open {
        let around = [outer_edge.as_slice(), &ridges[count - 1..], &inner_edge, &ridges[..1]].concat();
        add_overhang(&mut part, &around);
        let [outer, inner, outer_eaves, inner_eaves, ridge] = corner(0);
        part.add_polygon(&[outer, outer_eaves, ridge, inner_eaves, inner], Material::Facade);
        let [outer, inner, outer_eaves, inner_eaves, ridge] = corner(count - 1);
        part.add_polygon(&[outer, inner, inner_eaves, ridge, outer_eaves], Material::Facade);
    } else {
        add_overhang(&mut part, &outer_edge);
        add_overhang(&mut part, &inner_edge);
    }
    part
}

/// Returns the distance of `point` from the line through two points, metres.
fn distance_from_line(from: [f64; 2], to: [f64; 2], point: [f64; 2]) -> f64 {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    ((point[0] - from[0]) * dy - (point[1] - from[1]) * dx).abs() / dx.hypot(dy)
}

/// Returns level steps of `way` metres beyond both ends of a line.
fn ends_beyond(line: &[[f64; 2]], way: f64) -> [[f64; 3]; 2] {
    let step = |from: [f64; 2], to: [f64; 2]| {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let share = way / dx.hypot(dy);
        [dx * share, dy * share, 0.0]
    };
    [step(line[1], line[0]), step(line[line.len() - 2], line[line.len() - 1])]
}

/// Returns a parapet on the walls over `outline`, (N, 2), counter-clockwise, in metres. It is an upright ring of
/// `thickness` inside the outline, from slightly below the roof at height `roof` up to `height` above it. It is a solid
/// of its own, because no part of it is a roof or a wall of rooms. Its material is slab, as for the parapets of
/// balconies.
pub(crate) fn parapet(outline: &[[f64; 2]], thickness: f64, roof: f64, height: f64) -> ObjectPart {
    let top = roof + height;
    let profile = RidgedProfile { bottom: roof - JOINT, eaves: top, ridge: top, overhang: Overhang::default() };
    winged(outline, &inset(outline, thickness), WingCourse::Closed, &profile).with_material(Material::Slab)
}

/// Returns the corners of `outline`, (N, 2), counter-clockwise, with all its sides moved inwards by `distance` metres.
fn inset(outline: &[[f64; 2]], distance: f64) -> Vec<[f64; 2]> {
    let count = outline.len();
    let inward = |from: [f64; 2], to: [f64; 2]| {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        [-dy / length, dx / length]
    };
    let moved = |i: usize| {
        let corner = outline[i];
        let before = inward(outline[(i + count - 1) % count], corner);
        let after = inward(corner, outline[(i + 1) % count]);
        // Both sides are this far from the corner of the mitre.
        let way = distance / (1.0 + before[0] * after[0] + before[1] * after[1]);
        [0, 1].map(|axis| corner[axis] + way * (before[axis] + after[axis]))
    };
    (0..count).map(moved).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    const PLACE: PlanPlacement = PlanPlacement { origin: [155_000.0, 463_000.0], angle: 0.3 };

    /// Fails unless `part` is closed, has no face without area, and encloses `expected` m³.
    #[track_caller]
    fn assert_solid(part: &ObjectPart, expected: f64) {
        let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
        for &[a, b, c] in &part.triangles {
            assert!(a != b && b != c && c != a);
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_default() += 1;
            }
        }
        assert!(edges.iter().all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1)), "open");
        let volume = part.volume();
        assert!((volume - expected).abs() < 1e-6 * expected, "{volume} instead of {expected}");
    }

    fn profile(overhang: Overhang) -> RidgedProfile {
        RidgedProfile { bottom: -1.0, eaves: 5.0, ridge: 8.0, overhang }
    }

    #[test]
    fn an_overhang_adds_its_area_times_the_thickness_of_the_roof() {
        let footprint = PLACE.rectangle(10.0, 6.0);
        // The house and half a box of roof. A hip of 2 m takes two thirds of a prism of 6 by 2 by 3 m, halved.
        let (gabled, hipped) = (10.0 * 6.0 * (6.0 + 1.5), 10.0 * 6.0 * (6.0 + 1.5) - 2.0 * 6.0 * 3.0 * 2.0 / 6.0);
        for (eaves, verge) in [(0.0, 0.0), (0.0, 0.2), (0.4, 0.0), (0.4, 0.2)] {
            let overhang = Overhang { eaves, verge };
            // No verge without eaves.
            let plan = |end: f64| if eaves > 0.0 { (10.0 + 2.0 * end) * (6.0 + 2.0 * eaves) - 60.0 } else { 0.0 };
            assert_solid(&ridged_to(&footprint, 0.0, &profile(overhang)), gabled + ROOF_THICKNESS * plan(verge));
            // The slope of the hip is that of the sides times 3 / 2: its eaves extend less far.
            let end = eaves * 2.0 / 3.0;
            assert_solid(&ridged_to(&footprint, 2.0, &profile(overhang)), hipped + ROOF_THICKNESS * plan(end));
        }
    }

    #[test]
    fn eaves_go_round_the_corners_of_wings() {
        let corners =
            |half: f64| [[-half, half], [-half, -half], [half, -half], [half, half]].map(|[u, v]| PLACE.at(u, v));
        let (outer, inner) = (corners(20.0), corners(12.0));
        let roof = |plan: f64| plan * (6.0 + 1.5);
        let square = |half: f64| 4.0 * half * half;
        let ring = square(20.0) - square(12.0);
        let overhang = Overhang { eaves: 0.5, verge: 0.2 };
        let closed = winged(&outer, &inner, WingCourse::Closed, &profile(overhang));
        let around = square(20.5) - square(20.0) + square(12.0) - square(11.5);
        assert_solid(&closed, roof(ring) + ROOF_THICKNESS * around);
        // A court open towards +v: three wings, of which the two at the ends continue for the length of the fourth.
        let mut inner = inner;
        (inner[0], inner[3]) = (PLACE.at(-12.0, 20.0), PLACE.at(12.0, 20.0));
        let open = winged(&outer, &inner, WingCourse::Open, &profile(overhang));
        let court = 24.0 * 32.0;
        let plan = square(20.0) - court;
        // Outwards to all sides, into the court, and the verges at both ends with the eaves beside them.
        let beyond = 41.0 * 40.7 - 1600.0 + court - 23.0 * 31.5 - 23.0 * 0.2;
        assert_solid(&open, roof(plan) + ROOF_THICKNESS * beyond);
    }

    #[test]
    fn parapets_follow_any_outline() {
        let upright_ring = (0.8 + JOINT) * 0.25;
        let rectangle = parapet(&PLACE.rectangle(10.0, 6.0), 0.25, 9.0, 0.8);
        assert_solid(&rectangle, upright_ring * (2.0 * 16.0 - 4.0 * 0.25));
        // An L has five corners to the outside and one to the inside.
        let l_shaped = parapet(&PLACE.l_shape(12.0, 9.0, 4.0), 0.25, 9.0, 0.8);
        assert_solid(&l_shaped, upright_ring * (2.0 * 21.0 - 4.0 * 0.25));
        assert!(rectangle.vertices.iter().all(|v| v[2] > 8.8 && v[2] < 9.81));
    }
}
