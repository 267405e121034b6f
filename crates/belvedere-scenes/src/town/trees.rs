//! Trees: a stem and a crown, which is a closed bumpy hull, many small leaves or bare branches.

use std::f64::consts::{PI, TAU};

use crate::random::Random;
use crate::scene::{Material, ObjectPart};
use crate::solids::{PlanPlacement, extruded};
use crate::vector::{add, add_scaled, cross, length, scale, sub, unit};

/// Size of a tree, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TreeShape {
    pub(crate) height: f64,
    pub(crate) crown_radius: f64,
    pub(crate) trunk_radius: f64,
}

impl TreeShape {
    /// Returns a broad-leaved tree of a random height between the two.
    pub(crate) fn random([lowest, highest]: [f64; 2], random: &mut Random) -> Self {
        let height = random.between(lowest, highest);
        Self {
            height,
            crown_radius: height * random.between(0.22, 0.3),
            trunk_radius: height * random.between(0.015, 0.022),
        }
    }
}

/// Share of the height of a tree that is bare stem.
const BARE_STEM: f64 = 0.3;
/// Amplitude of the bumps of the crown, as a share of its radius.
const BUMP: f64 = 0.12;
/// Number of rows and columns of the crown: facets of about a metre, the footprint of a few laser pulses.
const ROWS: usize = 9;
const COLUMNS: usize = 14;

/// Material of the crowns of trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrownMaterial {
    /// Closed hull that lets no light through ([`Material::TreeCrown`]). Part of the scanner's beam passes through it
    /// if its parameters allow that.
    Opaque,
    /// Sprays of leaves, 0.2 to 0.4 m, in clumps with gaps between ([`Material::Leaf`]). About two in five straight
    /// lines through the crown stay free.
    Porous,
    /// Trunk and branches only ([`Material::Trunk`]), as in winter.
    Bare,
}

/// Returns the trunk and the crown of a tree at `foot`, absolute, metres. Its trunk extends `buried` metres below.
pub(crate) fn tree(
    foot: [f64; 3],
    shape: &TreeShape,
    crowns: CrownMaterial,
    buried: f64,
    random: &mut Random,
) -> [ObjectPart; 2] {
    let half_height = shape.height * (1.0 - BARE_STEM) / 2.0;
    let centre = [foot[0], foot[1], foot[2] + shape.height - half_height];
    let around = PlanPlacement { origin: [foot[0], foot[1]], angle: random.between(0.0, TAU) };
    let ring: Vec<[f64; 2]> = (0..8)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * TAU / 8.0).sin_cos();
            around.at(shape.trunk_radius * cos, shape.trunk_radius * sin)
        })
        .collect();
    let trunk = extruded(&ring, foot[2] - buried, centre[2]).with_material(Material::Trunk);
    let crown = match crowns {
        CrownMaterial::Opaque => crown(centre, shape.crown_radius, half_height, random),
        CrownMaterial::Porous => leaves(centre, shape.crown_radius, half_height, random),
        CrownMaterial::Bare => branches(centre, shape, half_height, random),
    };
    [trunk, crown]
}

/// Number of sprays per crown: enough for the look of foliage, few enough that hundreds of trees stay below a million
/// triangles.
const SPRAYS: u32 = 400;
/// Number of clumps of sprays.
const CLUMPS: usize = 24;
/// Area of the sprays seen from one side, as a share of that of the crown. About two in five lines through the inner
/// crown stay free.
const COVER: f64 = 0.55;

/// Returns sprays within an ellipsoid about `centre`: each a closed flat tetrahedron, turned at random.
fn leaves(centre: [f64; 3], radius: f64, half_height: f64, random: &mut Random) -> ObjectPart {
    let mut part = ObjectPart::default();
    let clumps: Vec<[f64; 3]> = (0..CLUMPS).map(|_| scale(direction(random), random.between(0.45, 0.85))).collect();
    // Seen from all sides on average, a flat spray of edge a covers a²/4.
    let edge = (COVER * PI * radius * half_height / f64::from(SPRAYS) * 4.0).sqrt();
    for spray in 0..SPRAYS {
        let clump = clumps[spray as usize % CLUMPS];
        let place = add_scaled(clump, direction(random), 0.45 * random.uniform());
        let reach = length(place);
        let place = if reach > 0.95 { scale(place, 0.95 / reach) } else { place };
        let middle = add(centre, [place[0] * radius, place[1] * radius, place[2] * half_height]);
        let size = edge * random.between(0.8, 1.2);
        let (normal, around) = (direction(random), direction(random));
        let along = unit(cross(normal, around)).unwrap_or([1.0, 0.0, 0.0]);
        let across = cross(normal, along);
        // Two opposite edges at right angles, 4 cm apart: a square from above, a sliver from the side.
        let corner = |axis: [f64; 3], share: f64, up: f64| {
            add_scaled(add_scaled(middle, axis, share * size / 2.0), normal, up * SPRAY_THICKNESS / 2.0)
        };
        let first = part.vertices.len();
        part.vertices.extend([corner(along, -1.0, -1.0), corner(along, 1.0, -1.0)]);
        part.vertices.extend([corner(across, -1.0, 1.0), corner(across, 1.0, 1.0)]);
        for corners in [[0, 3, 1], [1, 2, 0], [2, 1, 3], [3, 0, 2]] {
            part.add_polygon(&corners.map(|corner| first + corner), Material::Leaf);
        }
    }
    part
}

/// Number of limbs of a tree without leaves, and of twigs on each, so that every metre of the crown contains one.
const LIMBS: u32 = 14;
const TWIGS: u32 = 4;
/// Radius of the tip of a limb or a twig, metres.
const TIP_RADIUS: f64 = 0.01;

/// Returns the branches of a tree without leaves, within an ellipsoid about `centre`: each a closed prism that tapers.
/// The trunk continues to the top.
fn branches(centre: [f64; 3], shape: &TreeShape, half_height: f64, random: &mut Random) -> ObjectPart {
    let TreeShape { crown_radius: radius, trunk_radius, .. } = *shape;
    let mut part = ObjectPart::default();
    let top = [centre[0], centre[1], centre[2] + half_height];
    add_branch(&mut part, centre, top, trunk_radius * 0.7);
    for limb in 0..LIMBS {
        let share = (f64::from(limb) + random.uniform()) / f64::from(LIMBS);
        let from = [centre[0], centre[1], centre[2] + half_height * (1.4 * share - 0.8)];
        let (sin, cos) = random.between(0.0, TAU).sin_cos();
        // Longest in the middle of the crown, and rising.
        let reach = radius * (1.0 - (1.4 * share - 0.8).powi(2)).sqrt() * random.between(0.7, 0.95);
        let end = add(from, [reach * cos, reach * sin, reach * random.between(0.3, 0.6)]);
        let thickness = trunk_radius * random.between(0.25, 0.4);
        add_branch(&mut part, from, end, thickness);
        for _ in 0..TWIGS {
            let start = add_scaled(from, sub(end, from), random.between(0.3, 0.9));
            let tip = add_scaled(start, direction(random), reach * random.between(0.2, 0.45));
            add_branch(&mut part, start, tip, thickness * 0.5);
        }
    }
    part
}

/// Adds a closed prism of three sides that tapers from `radius` at `from` to [`TIP_RADIUS`] at `to`. Adds nothing if
/// both coincide.
fn add_branch(part: &mut ObjectPart, from: [f64; 3], to: [f64; 3], radius: f64) {
    let Some(along) = unit(sub(to, from)) else { return };
    let aside = if along[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let Some(across) = unit(cross(aside, along)) else { return };
    let other = cross(along, across);
    let first = part.vertices.len();
    for (end, radius) in [(from, radius.max(TIP_RADIUS)), (to, TIP_RADIUS)] {
        for side in 0_u8..3 {
            let (sin, cos) = (f64::from(side) * TAU / 3.0).sin_cos();
            part.vertices.push(add_scaled(add_scaled(end, across, radius * cos), other, radius * sin));
        }
    }
    for side in 0..3 {
        let [a, b] = [first + side, first + (side + 1) % 3];
        part.add_polygon(&[a, b, b + 3], Material::Trunk);
        part.add_polygon(&[a, b + 3, a + 3], Material::Trunk);
    }
    part.add_polygon(&[first + 2, first + 1, first], Material::Trunk);
    part.add_polygon(&[first + 3, first + 4, first + 5], Material::Trunk);
}

/// Thickness of a spray, metres.
const SPRAY_THICKNESS: f64 = 0.04;

/// Returns a random unit vector, uniform over all directions.
fn direction(random: &mut Random) -> [f64; 3] {
    let (height, turn) = (random.between(-1.0, 1.0), random.between(0.0, TAU));
    let across = (1.0 - height * height).sqrt();
    [across * turn.cos(), across * turn.sin(), height]
}

/// Returns a closed bumpy ellipsoid about `centre`.
fn crown(centre: [f64; 3], radius: f64, half_height: f64, random: &mut Random) -> ObjectPart {
    let mut part = ObjectPart::default();
    let phases: [f64; 3] = std::array::from_fn(|_| random.between(0.0, TAU));
    // A factor on the distance from the centre, so that the crown stays free of folds.
    let bulge = |latitude: f64, longitude: f64| {
        let waves = (2.0 * longitude + phases[0]).sin() + (3.0 * longitude + phases[1] + 2.0 * latitude).sin();
        1.0 + BUMP * (0.5 * waves * latitude.cos() + 0.5 * (3.0 * latitude + phases[2]).sin())
    };
    let mut add_vertex = |latitude: f64, longitude: f64| {
        let factor = bulge(latitude, longitude);
        let across = radius * factor * latitude.cos();
        part.vertices.push([
            centre[0] + across * longitude.cos(),
            centre[1] + across * longitude.sin(),
            centre[2] + half_height * factor * latitude.sin(),
        ]);
    };
    add_vertex(-PI / 2.0, 0.0);
    for row in 1..ROWS {
        for column in 0..COLUMNS {
            add_vertex(PI * (row as f64 / ROWS as f64 - 0.5), TAU * column as f64 / COLUMNS as f64);
        }
    }
    add_vertex(PI / 2.0, 0.0);

    let vertex = |row: usize, column: usize| 1 + (row - 1) * COLUMNS + column % COLUMNS;
    let top = 1 + (ROWS - 1) * COLUMNS;
    for column in 0..COLUMNS {
        part.add_polygon(&[0, vertex(1, column + 1), vertex(1, column)], Material::TreeCrown);
        for row in 1..ROWS - 1 {
            // Two triangles instead of a polygon, because the four corners do not lie in one plane.
            let [a, b] = [vertex(row, column), vertex(row, column + 1)];
            let [c, d] = [vertex(row + 1, column + 1), vertex(row + 1, column)];
            part.add_polygon(&[a, b, c], Material::TreeCrown);
            part.add_polygon(&[a, c, d], Material::TreeCrown);
        }
        part.add_polygon(&[vertex(ROWS - 1, column), vertex(ROWS - 1, column + 1), top], Material::TreeCrown);
    }
    part
}
