//! Scenes whose shadows and sky view factors are known as formulas.
//!
//! All scenes lie about the origin on a level square of ground at height 0, 2 km wide.
//!
//! ```
//! use belvedere_scenes::{Truth, closed_forms::box_on_plane};
//!
//! // 10 m high, the sun in the east at 45°: the shadow ends 10 m west of the wall at x = −3
//! let truth = Truth::new(&box_on_plane([6.0, 8.0], 10.0));
//! assert!(truth.occluded_towards([-12.99, 0.0, 0.0], [1.0, 0.0, 1.0]));
//! assert!(!truth.occluded_towards([-13.01, 0.0, 0.0], [1.0, 0.0, 1.0]));
//! ```

use std::f64::consts::{PI, TAU};

use crate::scene::{Material, ObjectPart, TriangleScene};
use crate::solids::{Overhang, PlanPlacement, RidgedProfile, WingCourse, extruded, prism, swept, winged};

/// Half the side of the ground, metres. It contains the shadow of a height of 17 m at an elevation of 1°.
const GROUND_HALF_SIDE: f64 = 1000.0;
/// Depth of solids on the ground below it, metres.
const BURIED: f64 = 1.0;

const UPRIGHT: PlanPlacement = PlanPlacement { origin: [0.0; 2], angle: 0.0 };

/// Returns level ground with a solid on or above it.
fn on_plane(name: &str, parts: &[ObjectPart]) -> TriangleScene {
    let corners = UPRIGHT.rectangle(2.0 * GROUND_HALF_SIDE, 2.0 * GROUND_HALF_SIDE);
    let mut ground = ObjectPart { vertices: corners.map(|[x, y]| [x, y, 0.0]).to_vec(), ..ObjectPart::default() };
    ground.add_polygon(&[0, 1, 2, 3], Material::Terrain);
    let mut scene = TriangleScene::default();
    scene.add_object("terrain", &[ground]);
    scene.add_object(name, parts);
    scene
}

/// Returns a sphere of `radius` metres about (0, 0, `centre_height`).
///
/// Its vertices lie on the sphere, and its facets at most `tolerance` metres inside it. This takes about 10 · `radius`
/// / `tolerance` triangles. Tolerances are limited to between 1e-8 and 0.5 of the radius.
///
/// For the sun at elevation e, the shadow on the ground is an ellipse. Its semi-axes are `radius` across and `radius` /
/// sin e along the light, and its middle is `centre_height` / tan e away from the sun. The shadow of the mesh lies
/// within, by no more than `tolerance` / sin e.
#[must_use]
pub fn sphere_over_plane(radius: f64, centre_height: f64, tolerance: f64) -> TriangleScene {
    // A facet lies below the sphere by r (1 − cos ρ) for its angular circumradius ρ. The widest facets are half squares
    // of side π / rows at the equator, ρ = π / (√2 rows).
    let reach = (1.0 - (tolerance / radius).clamp(1e-8, 0.5)).acos();
    let rows = crate::town::street_furniture::pieces(PI, reach * 2.0_f64.sqrt()).max(4);
    let columns = 2 * rows;
    let mut part = ObjectPart::default();
    let mut add_vertex = |latitude: f64, longitude: f64| {
        let across = radius * latitude.cos();
        let height = centre_height + radius * latitude.sin();
        part.vertices.push([across * longitude.cos(), across * longitude.sin(), height]);
    };
    add_vertex(-PI / 2.0, 0.0);
    for row in 1..rows {
        for column in 0..columns {
            let latitude = PI * (f64::from(row) / f64::from(rows) - 0.5);
            add_vertex(latitude, TAU * f64::from(column) / f64::from(columns));
        }
    }
    add_vertex(PI / 2.0, 0.0);
    let vertex = |row: u32, column: u32| (1 + (row - 1) * columns + column % columns) as usize;
    let top = (1 + (rows - 1) * columns) as usize;
    for column in 0..columns {
        part.add_polygon(&[0, vertex(1, column + 1), vertex(1, column)], Material::Roof);
        for row in 1..rows - 1 {
            let lower = [vertex(row, column), vertex(row, column + 1)];
            let upper = [vertex(row + 1, column + 1), vertex(row + 1, column)];
            part.add_polygon(&[lower[0], lower[1], upper[0], upper[1]], Material::Roof);
        }
        part.add_polygon(&[vertex(rows - 1, column), vertex(rows - 1, column + 1), top], Material::Roof);
    }
    on_plane("sphere", &[part])
}

/// Returns a level slab of `size` (x, y) metres that hovers with its underside at height `underside`.
///
/// Its shadow is the convex hull of two moved rectangles. They are moved away from the sun by `underside` / tan e and
/// by (`underside` + `thickness`) / tan e.
#[must_use]
pub fn slab_over_plane(size: [f64; 2], underside: f64, thickness: f64) -> TriangleScene {
    let footprint = UPRIGHT.rectangle(size[0], size[1]);
    on_plane("slab", &[prism(&footprint, underside, underside + thickness, Material::Slab)])
}

/// Returns a box of `size` (x, y) metres and `height` that stands on the ground.
///
/// Its shadow, with the ground beneath, is the convex hull of the rectangle and the rectangle moved away from the sun
/// by `height` / tan e.
#[must_use]
pub fn box_on_plane(size: [f64; 2], height: f64) -> TriangleScene {
    on_plane("building 1", &[extruded(&UPRIGHT.rectangle(size[0], size[1]), -BURIED, height)])
}

/// Returns a street canyon along x: the faces of its walls at y = ± `width` / 2, `height` metres high, `length` metres
/// long.
///
/// For an endless canyon, the sky view factor of the floor is (cos β₁ + cos β₂) / 2, with the elevations β of the two
/// eaves. For a wall at height h it is (1 − sin γ) / 2, with the elevation γ of the opposite eaves. For the middle, the
/// open ends add less than `width` · `height`² / `length`³.
///
/// # Source
/// Johnson & Watson 1984, "The determination of view-factors in urban canyons", J. Climate Appl. Meteor. 23. The ends:
/// past the end of a wall the sky reaches from elevation 2 `height` / `length` at most down to 0. It covers an angle of
/// 2 `width` / `length` to either side; sin² is integrated over both.
#[must_use]
pub fn canyon(width: f64, height: f64, length: f64) -> TriangleScene {
    let thickness = 10.0;
    let walls = [-1.0, 1.0].map(|side| {
        let placement = UPRIGHT.moved(0.0, side * (width + thickness) / 2.0, 0.0);
        extruded(&placement.rectangle(length, thickness), -BURIED, height)
    });
    on_plane("building 1", &walls)
}

/// Returns a round basin of `radius` metres, with its edge at `horizon_elevation` (radians) seen from its middle on the
/// ground.
///
/// From there the sky view factor is cos² of that elevation, and the share of the sky's solid angle is 1 − sin of it.
/// The edge is a polygon of 720 sides with its corners on the circle. Midway between corners its elevation is greater
/// by less than 5e-6.
#[must_use]
pub fn basin(radius: f64, horizon_elevation: f64) -> TriangleScene {
    let sides = 720;
    let top = radius * horizon_elevation.tan();
    let ring = |radius: f64| -> Vec<[f64; 2]> {
        (0..sides)
            .map(|i| {
                let (sin, cos) = (TAU * f64::from(i) / f64::from(sides)).sin_cos();
                [radius * cos, radius * sin]
            })
            .collect()
    };
    let profile = RidgedProfile { bottom: -BURIED, eaves: top, ridge: top, overhang: Overhang::default() };
    let wall = winged(&ring(radius + 1.0), &ring(radius), WingCourse::Closed, &profile);
    on_plane("basin", &[wall])
}

/// Returns straight stairs that rise towards +x: `step_count` steps of `tread` by `rise` metres, `width` metres across
/// about y = 0. The first riser is at x = 0. The top step ends upright.
///
/// The sun is beyond the top, at elevation e and with its azimuth turned by α from +x. Each riser then shades the tread
/// in front of it over a length of `rise` · cos α / tan e, up to the whole tread.
#[must_use]
pub fn stairs(step_count: u32, tread: f64, rise: f64, width: f64) -> TriangleScene {
    let end = f64::from(step_count) * tread;
    // From the foot of the end wall every corner of the section is in sight.
    let mut section = vec![[end, -BURIED], [end, f64::from(step_count) * rise]];
    for step in (0..step_count).rev() {
        let x = f64::from(step) * tread;
        section.push([x, f64::from(step + 1) * rise]);
        section.push([x, if step == 0 { -BURIED } else { f64::from(step) * rise }]);
    }
    // Swept towards −y, from where the section runs counter-clockwise.
    let ring = |y: f64| section.iter().map(|&[x, z]| [x, y, z]).collect::<Vec<_>>();
    on_plane("stairs", &[swept(&[ring(width / 2.0), ring(-width / 2.0)], &[Material::Roof], Material::Facade)])
}
