//! Houses whose surfaces are known in closed form, scanned by pulses that meet flat polygons.

use super::*;
use belvedere_data::Attributes;
use belvedere_data::cast::{to_f32, to_index};
use belvedere_data::control::Control;
use belvedere_data::patches::PatchKind;
use belvedere_data::random::uniform;
use belvedere_data::vector::{cross, dot, length, sub};

/// A flat convex polygon and its class.
type Face = (Vec<[f64; 3]>, u8);

const SEED: u64 = 7;
/// Noise of ranges, metres.
const NOISE: f64 = 0.02;

/// A scan of faces over level ground, with ten pulses per square metre from two lines.
fn scan(faces: &[Face], low: [f64; 2], high: [f64; 2]) -> Scene {
    let mut scene = Scene::default();
    let count = to_index(10.0 * (high[0] - low[0]) * (high[1] - low[1])) as u64;
    let mut number = 0;
    let mut draw = || {
        number += 1;
        uniform(SEED, number)
    };
    for pulse in 0..count {
        let foot = [0, 1].map(|axis: usize| low[axis] + draw() * (high[axis] - low[axis]));
        let line = if pulse % 2 == 0 { [-150.0, 40.0] } else { [160.0, -60.0] };
        let scanner = [foot[0] + line[0], foot[1] + line[1], 450.0];
        let way = sub([foot[0], foot[1], 0.0], scanner);
        let ground = (1.0, 2);
        let met = faces.iter().filter_map(|(corners, class)| Some((meets(corners, scanner, way)?, *class)));
        let (share, class) = met.fold(ground, |best, other| if other.0 < best.0 { other } else { best });
        // the sum of uniform numbers is nearly normal: of twelve it has a deviation of 1
        let error = NOISE * ((0..12).map(|_| draw()).sum::<f64>() - 6.0);
        let range = share + error / length(way);
        let p: [f64; 3] = std::array::from_fn(|i| scanner[i] + range * way[i]);
        scene.positions.push(p.map(to_f32));
        scene.scanner.push(scanner.map(to_f32));
        scene.classes.push(class);
    }
    scene
}

/// Returns the intersection of a line with a convex polygon, as a share of its length.
fn meets(corners: &[[f64; 3]], from: [f64; 3], way: [f64; 3]) -> Option<f64> {
    let normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
    let share = dot(normal, sub(corners[0], from)) / dot(normal, way);
    let p: [f64; 3] = std::array::from_fn(|i| from[i] + share * way[i]);
    let sides: Vec<f64> = (0..corners.len())
        .map(|i| {
            let next = corners[(i + 1) % corners.len()];
            dot(normal, cross(sub(next, corners[i]), sub(p, corners[i])))
        })
        .collect();
    ((0.0..1.0).contains(&share) && sides.iter().all(|&side| side >= 0.0)).then_some(share)
}

#[derive(Clone, Default)]
struct Scene {
    positions: Vec<[f32; 3]>,
    scanner: Vec<[f32; 3]>,
    classes: Vec<u8>,
}

impl Scene {
    fn surfaces(&self) -> BuildingSurfaces {
        let attributes = Attributes { classification: Some(self.classes.clone()), ..Attributes::default() };
        let (positions, scanner, origin) = (&self.positions[..], &self.scanner[..], [1000.0, 2000.0, 0.0]);
        let survey = SurveyPoints { positions, scanner, attributes: &attributes, origin };
        find(&survey, &PlaneParams::default(), &Control::none()).unwrap()
    }

    fn select(&self, wanted: impl Fn([f32; 3]) -> bool) -> Self {
        let mut some = Self::default();
        for row in (0..self.positions.len()).filter(|&row| wanted(self.positions[row])) {
            some.positions.push(self.positions[row]);
            some.scanner.push(self.scanner[row]);
            some.classes.push(self.classes[row]);
        }
        some
    }
}

/// The walls below a flat outline, counter-clockwise, from the ground to a height at each corner.
fn walls_of(outline: &[[f64; 2]], heights: &[f64]) -> Vec<Face> {
    (0..outline.len())
        .map(|i| {
            let j = (i + 1) % outline.len();
            let ([a, b], [c, d]) = (outline[i], outline[j]);
            (vec![[a, b, 0.0], [c, d, 0.0], [c, d, heights[j]], [a, b, heights[i]]], 6)
        })
        .collect()
}

/// A box from the ground to a height, flat on top.
fn block_of(low: [f64; 2], high: [f64; 2], height: f64) -> Vec<Face> {
    let outline = [low, [high[0], low[1]], high, [low[0], high[1]]];
    let mut faces = walls_of(&outline, &[height; 4]);
    faces.push((outline.iter().map(|p| [p[0], p[1], height]).collect(), 6));
    faces
}

/// A house of 12 m by 8 m, 6 m to the eaves, whose ridge lies 9 m high; the roof stands out by `eaves` to the south and
/// north.
fn gable(eaves: f64) -> Vec<Face> {
    let outline = [[-6.0, -4.0], [6.0, -4.0], [6.0, 4.0], [-6.0, 4.0]];
    let mut faces = walls_of(&outline, &[6.0; 4]);
    let (y, z) = (4.0 + eaves, 6.0 - 0.75 * eaves);
    faces.push((vec![[-6.0, -y, z], [6.0, -y, z], [6.0, 0.0, 9.0], [-6.0, 0.0, 9.0]], 6));
    faces.push((vec![[6.0, y, z], [-6.0, y, z], [-6.0, 0.0, 9.0], [6.0, 0.0, 9.0]], 6));
    for x in [-6.0, 6.0] {
        faces.push((vec![[x, -4.0 * x / 6.0, 6.0], [x, 4.0 * x / 6.0, 6.0], [x, 0.0, 9.0]], 6));
    }
    faces
}

const AROUND: [[f64; 2]; 2] = [[-20.0, -20.0], [20.0, 20.0]];

/// Returns the heights at which a line straight down meets patches of a kind at each of some places.
fn heights_of(surfaces: &BuildingSurfaces, kind: PatchKind, [x, y]: [f64; 2]) -> Vec<f64> {
    let of_kind = surfaces.patches.triangles.iter().zip(&surfaces.patches.kinds).filter(|(_, own)| **own == kind);
    let from = [x, y, 100.0];
    let down = [0.0, 0.0, -200.0];
    of_kind
        .filter_map(|(corners, _)| Some(100.0 - 200.0 * meets(&corners.map(|p| p.map(f64::from)), from, down)?))
        .collect()
}

/// Area of the patches of a kind seen from above, m².
fn area_of(surfaces: &BuildingSurfaces, kind: PatchKind) -> f64 {
    let of_kind = surfaces.patches.triangles.iter().zip(&surfaces.patches.kinds).filter(|(_, own)| **own == kind);
    of_kind
        .map(|(corners, _)| {
            let [a, b, c] = corners.map(|p| p.map(f64::from));
            cross(sub(b, a), sub(c, a))[2] / 2.0
        })
        .sum()
}

/// The edge that faces a way, and how far along this way it lies.
fn facing(surfaces: &BuildingSurfaces, way: [f64; 2]) -> Vec<(f64, Edge)> {
    let mut found = Vec::new();
    for edge in &surfaces.outlines.edges {
        let [a, b] = edge.ends;
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        let along = (x * way[1] - y * way[0]).abs();
        let right = [y, -x];
        let long = x.hypot(y);
        if along > 0.99 * long && right[0] * way[0] + right[1] * way[1] > 0.0 && long > 3.0 {
            found.push((f64::midpoint(a[0] * way[0] + a[1] * way[1], b[0] * way[0] + b[1] * way[1]), *edge));
        }
    }
    found
}

#[test]
fn a_gable_house_has_two_planes_a_ridge_and_its_outline() {
    let surfaces = scan(&gable(0.0), AROUND[0], AROUND[1]).surfaces();
    assert_eq!(surfaces.outlines.planes.len(), 2);
    for plane in &surfaces.outlines.planes {
        // a slope of 3 in 4; 500 points of 2 cm leave less than a thousandth
        assert!((plane.normal[2] - 0.8).abs() < 2e-3 && (plane.normal[1].abs() - 0.6).abs() < 2e-3, "{plane:?}");
    }
    let [ridge] = surfaces.outlines.ridges[..] else { panic!("{:?}", surfaces.outlines.ridges) };
    assert!(ridge.is_convex);
    for end in ridge.ends {
        assert!(end[1].abs() < 0.02 && (end[2] - 9.0).abs() < 0.02, "{ridge:?}");
    }
    for way in [[0.0, -1.0], [0.0, 1.0]] {
        let found = facing(&surfaces, way);
        assert_eq!(found.len(), 1, "{way:?} {found:?}");
        // three of its own standard deviations
        assert!((found[0].0 - 4.0).abs() < 3.0 * found[0].1.sd && found[0].1.sd < 0.05, "{found:?}");
    }
    for way in [[-1.0, 0.0], [1.0, 0.0]] {
        let found = facing(&surfaces, way);
        assert_eq!(found.len(), 2, "each plane has a verge {way:?}: {:?}", surfaces.outlines.edges);
        assert!(found.iter().all(|(at, edge)| (at - 6.0).abs() < 3.0 * edge.sd), "{found:?}");
    }
    // 12 m by 8 m; edges err by 3 cm each
    assert!((area_of(&surfaces, PatchKind::Roof) - 96.0).abs() < 2.0);
    for (place, height) in [([0.0, -3.5], 6.375), ([3.0, 2.0], 7.5), ([-5.7, -0.1], 8.925)] {
        let heights = heights_of(&surfaces, PatchKind::Roof, place);
        assert!(heights.len() == 1 && (heights[0] - height).abs() < 0.02, "{place:?}: {heights:?}");
    }
    for place in [[0.0, -4.2], [6.2, 0.0], [-6.2, 3.0]] {
        assert!(heights_of(&surfaces, PatchKind::Roof, place).is_empty());
    }
    assert!(!surfaces.outlines.walls.is_empty());
    for wall in &surfaces.outlines.walls {
        let middle = [0, 1].map(|axis| f64::midpoint(wall.ends[0][axis], wall.ends[1][axis]));
        let off = (middle[0].abs() - 6.0).abs().min((middle[1].abs() - 4.0).abs());
        assert!(off < 3.0 * wall.sd, "{wall:?}");
    }
}

#[test]
fn a_hip_roof_has_four_planes_that_meet_in_five_convex_lines() {
    let (a, b, c, d) = ([-6.0, -4.0, 6.0], [6.0, -4.0, 6.0], [6.0, 4.0, 6.0], [-6.0, 4.0, 6.0]);
    let (west, east) = ([-2.0, 0.0, 9.0], [2.0, 0.0, 9.0]);
    let mut faces = walls_of(&[[-6.0, -4.0], [6.0, -4.0], [6.0, 4.0], [-6.0, 4.0]], &[6.0; 4]);
    faces.extend([
        (vec![a, b, east, west], 6),
        (vec![b, c, east], 6),
        (vec![c, d, west, east], 6),
        (vec![d, a, west], 6),
    ]);
    let surfaces = scan(&faces, AROUND[0], AROUND[1]).surfaces();
    assert_eq!(surfaces.outlines.planes.len(), 4);
    assert_eq!(
        surfaces.outlines.ridges.iter().filter(|ridge| ridge.is_convex).count(),
        5,
        "{:?}",
        surfaces.outlines.ridges
    );
    assert!((area_of(&surfaces, PatchKind::Roof) - 96.0).abs() < 2.0);
    // patches do not reach beyond hips and ridges: one height everywhere
    for place in [[-4.5, -3.5], [-3.9, 2.3], [0.1, 0.1], [4.0, -2.2], [5.5, 0.2]] {
        assert_eq!(heights_of(&surfaces, PatchKind::Roof, place).len(), 1, "{place:?}");
    }
}

#[test]
fn a_flat_roof_with_a_parapet_has_a_sheet_along_its_edge() {
    let mut faces = block_of([-6.0, -5.0], [6.0, 5.0], 8.0);
    // a wall 0.3 m thick, 0.6 m high along the south edge
    let outline = [[-6.0, -5.0], [6.0, -5.0], [6.0, -4.7], [-6.0, -4.7]];
    faces.push((outline.iter().map(|p| [p[0], p[1], 8.6]).collect(), 6));
    faces.push((vec![[-6.0, -5.0, 8.0], [6.0, -5.0, 8.0], [6.0, -5.0, 8.6], [-6.0, -5.0, 8.6]], 6));
    let surfaces = scan(&faces, AROUND[0], AROUND[1]).surfaces();
    let of_kind =
        surfaces.patches.triangles.iter().zip(&surfaces.patches.kinds).filter(|(_, kind)| **kind == PatchKind::Parapet);
    let corners: Vec<[f32; 3]> = of_kind.flat_map(|(corners, _)| *corners).collect();
    assert!(!corners.is_empty());
    // the outer face lies at the edge, to three of its standard deviations; 120 points in each metre across the inner
    // face leave a few centimetres
    let [(_, edge)] = facing(&surfaces, [0.0, -1.0])[..] else { panic!("{:?}", surfaces.outlines.edges) };
    let is_on = |p: &[f32; 3], face: f64, error: f64| (f64::from(p[1]) - face).abs() < error;
    let (outer, inner): (Vec<_>, Vec<_>) = corners.iter().partition(|p| p[1] < -4.85);
    assert!(outer.len() >= 4 && outer.iter().all(|p| is_on(p, -5.0, 3.0 * edge.sd)), "{outer:?}");
    assert!(inner.len() >= 4 && inner.iter().all(|p| is_on(p, -4.7, 0.04)), "{inner:?}");
    assert!(corners.iter().all(|p| (7.95..8.65).contains(&p[2])), "{corners:?}");
    // what is thin from above is no box
    assert!(surfaces.patches.kinds.iter().all(|kind| *kind != PatchKind::Box));
}

/// Corners of the patches of a kind.
fn corners_of(surfaces: &BuildingSurfaces, kind: PatchKind) -> Vec<[f64; 3]> {
    let of_kind = surfaces.patches.triangles.iter().zip(&surfaces.patches.kinds).filter(|(_, own)| **own == kind);
    of_kind.flat_map(|(corners, _)| corners.map(|p| p.map(f64::from))).collect()
}

/// The sides and the top of a box that stands on something.
fn box_on(low: [f64; 2], high: [f64; 2], foot: f64, top: f64) -> Vec<Face> {
    let mut faces = block_of(low, high, top);
    faces.iter_mut().flat_map(|(corners, _)| corners).for_each(|p| p[2] = p[2].max(foot));
    faces
}

#[test]
fn a_chimney_on_a_slope_has_a_level_top_and_a_foot_on_the_roof() {
    let mut faces = gable(0.0);
    // 1.4 m by 1.2 m in the north slope, whose roof lies between 6.6 and 7.5 m there
    faces.extend(box_on([1.0, 2.0], [2.4, 3.2], 6.0, 9.2));
    let surfaces = scan(&faces, AROUND[0], AROUND[1]).surfaces();
    let corners = corners_of(&surfaces, PatchKind::Box);
    assert!(corners.len() >= 24, "{corners:?}");
    for &[x, y, z] in &corners {
        // sides lie within half of the spacing of pulses
        assert!((0.84..2.56).contains(&x) && (1.84..3.36).contains(&y), "{x} {y}");
        let roof = 9.0 - 0.75 * y;
        // the highest of its points are a little too high by noise
        assert!((z - 9.2).abs() < 0.05 || (z - roof).abs() < 0.03, "{z} over {roof}: {corners:?}");
    }
}

#[test]
fn pulses_that_pass_a_box_bound_it() {
    let mut faces = block_of([-8.0, -6.0], [8.0, 6.0], 8.0);
    faces.extend(box_on([-1.0, -0.8], [1.0, 0.8], 8.0, 9.5));
    let surfaces = scan(&faces, AROUND[0], AROUND[1]).surfaces();
    let corners = corners_of(&surfaces, PatchKind::Box);
    let reach = |axis: usize, sign: f64| corners.iter().map(|p| sign * p[axis]).fold(f64::NEG_INFINITY, f64::max);
    // its top has 32 points, so that some lie within a decimetre of each side
    for (axis, half) in [(0, 1.0), (1, 0.8)] {
        for sign in [-1.0, 1.0] {
            assert!((reach(axis, sign) - half).abs() < 0.1, "{axis} {sign}: {}", reach(axis, sign));
        }
    }
    assert!(corners.iter().all(|p| (p[2] - 9.5).abs() < 0.05 || (p[2] - 8.0).abs() < 0.03), "{corners:?}");
}

#[test]
fn a_canopy_with_a_high_edge_has_no_inside() {
    // a roof on posts, whose edge of 0.8 m pulses meet from the side
    let (low, high) = ([-8.0, -6.0], [8.0, 6.0]);
    let outline = [low, [high[0], low[1]], high, [low[0], high[1]]];
    let mut faces = box_on(low, high, 4.2, 5.0);
    faces.push((outline.iter().rev().map(|p| [p[0], p[1], 4.2]).collect(), 6));
    let scene = scan(&faces, AROUND[0], AROUND[1]);
    let surfaces = scene.surfaces();
    assert!(surfaces.outlines.walls.len() >= 2, "its edge is taken for walls: {:?}", surfaces.outlines.walls);
    assert!(corners_of(&surfaces, PatchKind::Inside).is_empty());
    // a house of the same outline has one
    let house = scan(&block_of(low, high, 5.0), AROUND[0], AROUND[1]).surfaces();
    assert!(!corners_of(&house, PatchKind::Inside).is_empty());
}

#[test]
fn an_l_stays_open_in_its_corner() {
    let outline = [[-8.0, -8.0], [8.0, -8.0], [8.0, 0.0], [0.0, 0.0], [0.0, 8.0], [-8.0, 8.0]];
    let mut faces = walls_of(&outline, &[7.0; 6]);
    let top = |low: [f64; 2], high: [f64; 2]| {
        (vec![[low[0], low[1], 7.0], [high[0], low[1], 7.0], [high[0], high[1], 7.0], [low[0], high[1], 7.0]], 6)
    };
    faces.extend([top([-8.0, -8.0], [8.0, 0.0]), top([-8.0, 0.0], [0.0, 8.0])]);
    let surfaces = scan(&faces, AROUND[0], AROUND[1]).surfaces();
    assert_eq!(surfaces.outlines.planes.len(), 1);
    assert_eq!(surfaces.outlines.edges.iter().filter(|edge| edge.sd < 0.1).count(), 6, "{:?}", surfaces.outlines.edges);
    // 64 m of edges that err by 2 cm
    assert!((area_of(&surfaces, PatchKind::Roof) - 192.0).abs() < 2.0, "{}", area_of(&surfaces, PatchKind::Roof));
    assert!(heights_of(&surfaces, PatchKind::Roof, [0.3, 0.3]).is_empty());
    assert_eq!(heights_of(&surfaces, PatchKind::Roof, [-0.3, 0.3]).len(), 1);
    // few triangles: what lines bound is not cut into cells
    let count = surfaces.patches.kinds.iter().filter(|kind| **kind == PatchKind::Roof).count();
    assert!(count <= 40, "{count}");
}

#[test]
fn below_eaves_the_wall_is_a_plane_of_its_own() {
    let surfaces = scan(&gable(0.5), AROUND[0], AROUND[1]).surfaces();
    let below: Vec<&Wall> = surfaces.outlines.walls.iter().filter(|wall| wall.eaves > 0.3).collect();
    assert!(!below.is_empty());
    for wall in below {
        let edge = &surfaces.outlines.edges[wall.edge];
        assert!((wall.eaves - 0.5).abs() < 3.0 * edge.sd, "{wall:?}");
        let middle = f64::midpoint(wall.ends[0][1], wall.ends[1][1]);
        // a direction that few points show moves the middle
        assert!((middle.abs() - 4.0).abs() < 3.0 * wall.sd + 0.01, "{wall:?}");
        let south = wall.ends[0][1].signum();
        // the ball of a point of this wall may not bulge out of it below the eaves, and nothing hinders it within
        let y = to_f32(4.0 * south);
        let regions = surfaces.regions.of_point([0.0, y, 3.0]);
        let holds = |y: f64| regions.iter().any(|region| region.distance([0.0, y * south, 3.0]) < 0.0);
        assert!(holds(4.1) && holds(4.4) && !holds(3.9) && !holds(3.95), "{regions:?}");
    }
}

#[test]
fn a_point_before_a_wall_is_not_bound_by_it() {
    let surfaces = scan(&block_of([-6.0, -5.0], [6.0, 5.0], 8.0), AROUND[0], AROUND[1]).surfaces();
    assert!(!surfaces.regions.of_point([0.0, -5.0, 4.0]).is_empty());
    for (place, what) in [([0.0, -6.0, 4.0], "a balcony"), ([0.0, 0.0, 10.0], "a chimney")] {
        let regions = surfaces.regions.of_point(place);
        assert!(regions.iter().all(|region| region.distance(place.map(f64::from)) > 0.5), "{what}: {regions:?}");
    }
}

#[test]
fn a_ball_ends_at_the_wall_that_its_point_lies_behind() {
    let surfaces = scan(&block_of([-6.0, -5.0], [6.0, 5.0], 8.0), AROUND[0], AROUND[1]).surfaces();
    // a ball of the roof 0.5 m within the south edge, which bulges half a metre out of the wall
    let (point, center) = ([0.0, -4.5, 8.0], [0.0, -4.5, 7.0]);
    let radius = surfaces.regions.radius_of(point, center, 1.0);
    let wall = surfaces.outlines.walls.iter().find(|wall| wall.ends[0][1] < -4.0 && wall.ends[1][1] < -4.0).unwrap();
    // it may stand out by 2 cm, of the wall and of the edge, whichever lies farther out
    let edge = &surfaces.outlines.edges[wall.edge];
    let farthest = f64::midpoint(wall.ends[0][1], wall.ends[1][1]).min(f64::midpoint(edge.ends[0][1], edge.ends[1][1]));
    let nearest = f64::midpoint(wall.ends[0][1], wall.ends[1][1]).max(f64::midpoint(edge.ends[0][1], edge.ends[1][1]));
    let reach = -4.5 - f64::from(radius);
    assert!((farthest - 0.03..nearest - 0.01).contains(&reach), "{reach} beside {nearest}");
    // one that stays within keeps its size, and one before the wall as well
    assert_eq!(surfaces.regions.radius_of([0.0, 0.0, 8.0], [0.0, 0.0, 7.0], 1.0), 1.0);
    assert_eq!(surfaces.regions.radius_of([0.0, -7.0, 2.0], [0.0, -7.0, 1.0], 1.0), 1.0);
}

#[test]
fn a_tree_and_a_deck_give_no_walls_and_no_inside() {
    // leaves of a crown, each facing another way and taken for a building by mistake, and a deck on posts that pulses
    // see below
    let leaf = |number: u64| {
        let [x, y, z, s, t] = std::array::from_fn(|k| uniform(3, 5 * number + k as u64) - 0.5);
        let center = [-8.0 + 6.0 * x, 6.0 * y, 8.0 + 5.0 * z];
        let corner = |a: f64, b: f64| [center[0] + a, center[1] + b, center[2] + 0.8 * s * a + 0.8 * t * b];
        (vec![corner(-0.2, -0.2), corner(0.2, -0.2), corner(0.2, 0.2), corner(-0.2, 0.2)], 6)
    };
    let mut faces: Vec<Face> = (0..800).map(leaf).collect();
    let tree = scan(&faces, AROUND[0], AROUND[1]).surfaces();
    assert_eq!((tree.outlines.planes.len(), tree.patches.len()), (0, 0));
    faces.push((vec![[4.0, -3.0, 4.0], [12.0, -3.0, 4.0], [12.0, 3.0, 4.0], [4.0, 3.0, 4.0]], 6));
    let deck = scan(&faces, AROUND[0], AROUND[1]).surfaces();
    assert_eq!((deck.outlines.planes.len(), deck.outlines.walls.len()), (1, 0));
    assert!(deck.patches.kinds.iter().all(|kind| matches!(kind, PatchKind::Roof | PatchKind::Slab)));
}

#[test]
fn without_a_class_of_buildings_a_house_is_known_by_its_shape() {
    // a house, a car, leaves of a crown and a low wall
    let mut faces = gable(0.4);
    faces.extend(block_of([9.0, -2.0], [11.0, 3.0], 1.5));
    let leaf = |number: u64| {
        let [x, y, z, s, t] = std::array::from_fn(|k| uniform(3, 5 * number + k as u64) - 0.5);
        let center = [-14.0 + 6.0 * x, 6.0 * y, 8.0 + 5.0 * z];
        let corner = |a: f64, b: f64| [center[0] + a, center[1] + b, center[2] + 0.8 * s * a + 0.8 * t * b];
        (vec![corner(-0.2, -0.2), corner(0.2, -0.2), corner(0.2, 0.2), corner(-0.2, 0.2)], 6)
    };
    faces.extend((0..800).map(leaf));
    faces.extend(block_of([-6.0, -14.0], [8.0, -13.6], 1.2));
    let mut scene = scan(&faces, AROUND[0], AROUND[1]);
    let classified = scan(&gable(0.4), AROUND[0], AROUND[1]).surfaces();
    scene.classes.iter_mut().filter(|class| **class == 6).for_each(|class| *class = 1);
    let surfaces = scene.surfaces();
    assert_eq!((surfaces.outlines.planes.len(), surfaces.outlines.ridges.len()), (2, 1));
    assert!(surfaces.outlines.walls.len() >= 2 && surfaces.patches.len() > classified.patches.len() / 2);
    let roof = area_of(&surfaces, PatchKind::Roof);
    assert!((roof - area_of(&classified, PatchKind::Roof)).abs() < 2.0, "{roof} m²");
    // one point of class 6 says that buildings were classified
    let mut with_one = scene.clone();
    with_one.classes[0] = 6;
    assert_eq!(with_one.surfaces().outlines.planes.len(), 0);
    // nothing tells how high it stands
    scene.classes.iter_mut().for_each(|class| *class = 1);
    assert_eq!(scene.surfaces().patches.len(), 0);
}

#[test]
fn a_part_finds_what_the_whole_finds_in_any_order() {
    // houses over the corner of four blocks of 64 m: the origin of the scene is 1000, 2000
    let corner = [24.0, -16.0];
    let mut faces = Vec::new();
    for [x, y] in [[-12.0, -9.0], [2.0, 3.0], [9.0, -14.0], [-15.0, 8.0]] {
        let low = [corner[0] + x, corner[1] + y];
        faces.extend(block_of(low, [low[0] + 11.0, low[1] + 8.0], 6.0 + y / 5.0));
    }
    let scene = scan(&faces, [-10.0, -50.0], [60.0, 20.0]);
    let whole = scene.surfaces();
    let margin = to_f32(PlaneParams::default().margin);
    let is_of = |p: [f64; 3]| p[0] < corner[0] && p[1] < corner[1];
    let mut part = scene.select(|p| p[0] < to_f32(corner[0]) + margin + 0.1 && p[1] < to_f32(corner[1]) + margin + 0.1);
    part.positions.reverse();
    part.scanner.reverse();
    part.classes.reverse();
    let part = part.surfaces();
    let middle =
        |corners: &[[f32; 3]; 3]| std::array::from_fn(|i| corners.iter().map(|p| f64::from(p[i])).sum::<f64>() / 3.0);
    let of = |surfaces: &BuildingSurfaces| {
        let triangles: Vec<_> = surfaces.patches.triangles.iter().copied().filter(|t| is_of(middle(t))).collect();
        let edges: Vec<_> =
            surfaces.outlines.edges.iter().map(|e| (e.ends, e.sd)).filter(|e| is_of(e.0[0]) && is_of(e.0[1])).collect();
        (triangles, edges)
    };
    let (of_whole, of_part) = (of(&whole), of(&part));
    assert!(of_whole.0.len() > 10 && of_whole.1.len() > 3);
    assert_eq!(of_whole, of_part);
}

/// A level polygon at a height.
fn level(low: [f64; 2], high: [f64; 2], height: f64, class: u8) -> Face {
    (
        vec![
            [low[0], low[1], height],
            [high[0], low[1], height],
            [high[0], high[1], height],
            [low[0], high[1], height],
        ],
        class,
    )
}

#[test]
fn a_deck_is_two_sheets_and_eaves_are_none() {
    // a deck of 5 m by 8 m beside a flat roof that stands out over its walls by 0.5 m
    let mut faces = vec![level([-16.0, -4.0], [-11.0, 4.0], 3.5, 1)];
    faces.extend(block_of([2.0, -5.0], [12.0, 5.0], 5.9));
    faces.push(level([1.5, -5.5], [12.5, 5.5], 6.0, 6));
    let scene = scan(&faces, AROUND[0], AROUND[1]);
    let surfaces = scene.surfaces();
    let mut heights = heights_of(&surfaces, PatchKind::Slab, [-13.5, 0.0]);
    let above = heights_of(&surfaces, PatchKind::Slab, [7.0, 0.0]);
    assert!(above.is_empty() && heights_of(&surfaces, PatchKind::Roof, [7.0, 0.0]).len() == 1, "{above:?}");
    heights.sort_by(f64::total_cmp);
    assert_eq!(heights.len(), 2, "{heights:?}");
    assert!((heights[0] - 3.2).abs() < 0.02 && (heights[1] - 3.5).abs() < 0.02, "{heights:?}");
    // 40 m², to a sixth of a spacing all round
    let tops = |([a, ..], kind): &(&[[f32; 3]; 3], PatchKind)| *kind == PatchKind::Slab && a[2] > 3.35;
    let area: f64 = surfaces
        .patches
        .iter()
        .filter(tops)
        .map(|(corners, _)| {
            let [a, b, c] = corners.map(|p| p.map(f64::from));
            cross(sub(b, a), sub(c, a))[2] / 2.0
        })
        .sum();
    assert!((area - 40.0).abs() < 4.0, "{area} m²");
    let is_deck = |row: &&u32| scene.classes[**row as usize] == 1;
    let decks = scene.classes.iter().filter(|class| **class == 1).count();
    let on_deck = surfaces.slab_rows.iter().filter(is_deck).count();
    assert_eq!((surfaces.slab_rows.len() - on_deck, surfaces.slabs), (0, 1));
    assert!(on_deck as f64 > 0.95 * decks as f64, "{on_deck} of {decks}");
}

#[test]
fn a_bridge_deck_by_its_class_needs_no_pulse_below() {
    // as wide as the scene, so that no pulse gets below it but from the sides
    let narrow = |class: u8| scan(&[level([-20.0, -9.0], [20.0, 9.0], 6.0, class)], AROUND[0], AROUND[1]).surfaces();
    assert!(narrow(17).slabs > 0);
    // of a class that says nothing it may be the roof of a hall
    assert_eq!(narrow(6).slabs, 0);
}
