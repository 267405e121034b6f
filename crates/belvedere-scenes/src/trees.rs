//! Trees: a stem and a bumpy crown, both closed.

use std::f64::consts::{PI, TAU};

use crate::random::Random;
use crate::scene::{Material, Part};
use crate::solids::{Placement, extruded};

/// Size of a tree, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TreeShape {
    pub(crate) height: f64,
    pub(crate) crown_radius: f64,
    pub(crate) trunk_radius: f64,
}

impl TreeShape {
    /// A broad-leaved street tree of 7 to 13 m.
    pub(crate) fn random(random: &mut Random) -> Self {
        let height = random.between(7.0, 13.0);
        Self {
            height,
            crown_radius: height * random.between(0.22, 0.3),
            trunk_radius: height * random.between(0.015, 0.022),
        }
    }
}

/// Share of the height of a tree that is bare stem.
const BARE_STEM: f64 = 0.3;
/// How far the crown bulges in and out, as a share of its radius.
const BUMP: f64 = 0.12;
/// Rows and columns of the crown: facets of about a metre, the footprint of a few laser pulses.
const ROWS: usize = 9;
const COLUMNS: usize = 14;

/// Trunk and crown of a tree that stands at `foot`, absolute, metres, its trunk reaching `buried` metres below.
pub(crate) fn tree(foot: [f64; 3], shape: &TreeShape, buried: f64, random: &mut Random) -> [Part; 2] {
    let half_height = shape.height * (1.0 - BARE_STEM) / 2.0;
    let centre = [foot[0], foot[1], foot[2] + shape.height - half_height];
    let around = Placement { origin: [foot[0], foot[1]], angle: random.between(0.0, TAU) };
    let ring: Vec<[f64; 2]> = (0..8)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * TAU / 8.0).sin_cos();
            around.at(shape.trunk_radius * cos, shape.trunk_radius * sin)
        })
        .collect();
    let trunk = extruded(&ring, foot[2] - buried, centre[2]).with_material(Material::Trunk);
    [trunk, crown(centre, shape.crown_radius, half_height, random)]
}

/// Closed bumpy ellipsoid about `centre`.
fn crown(centre: [f64; 3], radius: f64, half_height: f64, random: &mut Random) -> Part {
    let mut part = Part::default();
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
            // Two triangles rather than a polygon: the four corners do not lie in one plane.
            let [a, b] = [vertex(row, column), vertex(row, column + 1)];
            let [c, d] = [vertex(row + 1, column + 1), vertex(row + 1, column)];
            part.add_polygon(&[a, b, c], Material::TreeCrown);
            part.add_polygon(&[a, c, d], Material::TreeCrown);
        }
        part.add_polygon(&[vertex(ROWS - 1, column), vertex(ROWS - 1, column + 1), top], Material::TreeCrown);
    }
    part
}
