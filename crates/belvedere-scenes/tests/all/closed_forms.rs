//! Shadows and sky view factors in the closed-form scenes, by exact rays against the formulas.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic like the tests themselves")]

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, TAU};

use belvedere_scenes::closed_forms::{basin, box_on_plane, canyon, slab_over_plane, sphere_over_plane, stairs};
use belvedere_scenes::{Material, TriangleScene, Truth};

/// Azimuth, clockwise from north, and elevation of suns, degrees.
const SUNS: [[f64; 2]; 3] = [[110.0, 25.0], [180.0, 52.0], [241.0, 35.0]];
/// Tolerance of an outline, metres: the claim under test.
const MILLIMETRE: f64 = 1e-3;

struct Sun {
    direction: [f64; 3],
    elevation: f64,
    /// Unit vector on the ground, away from the sun.
    away: [f64; 2],
}

fn suns() -> [Sun; 3] {
    SUNS.map(|[azimuth, elevation]| {
        let ((sin, cos), elevation) = (azimuth.to_radians().sin_cos(), elevation.to_radians());
        let direction = [sin * elevation.cos(), cos * elevation.cos(), elevation.sin()];
        Sun { direction, elevation, away: [-sin, -cos] }
    })
}

/// Returns the distance on the ground from `start`, in the shadow, along `heading` to the end of the shadow, by
/// bisection.
fn shadow_end(truth: &Truth, sun: &Sun, start: [f64; 2], heading: f64, farthest: f64) -> f64 {
    let at = |distance: f64| [start[0] + distance * heading.cos(), start[1] + distance * heading.sin(), 0.0];
    let dark = |distance: f64| truth.occluded_towards(at(distance), sun.direction);
    let (mut inside, mut outside) = (0.0, farthest);
    assert!(dark(inside) && !dark(outside), "{start:?} {heading}");
    for _ in 0..50 {
        let middle = (inside + outside) / 2.0;
        if dark(middle) { inside = middle } else { outside = middle }
    }
    outside
}

/// Returns the distance from `start` along `heading` to the edge of a convex polygon, corners counter-clockwise.
fn distance_to_edge(polygon: &[[f64; 2]], start: [f64; 2], heading: f64) -> f64 {
    let direction = [heading.cos(), heading.sin()];
    (0..polygon.len())
        .map(|i| {
            let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            let outward = [b[1] - a[1], a[0] - b[0]];
            let towards = outward[0] * direction[0] + outward[1] * direction[1];
            let gap = outward[0] * (a[0] - start[0]) + outward[1] * (a[1] - start[1]);
            assert!(gap > 0.0, "start lies inside");
            if towards > 0.0 { gap / towards } else { f64::INFINITY }
        })
        .fold(f64::INFINITY, f64::min)
}

/// Returns the convex hull, counter-clockwise (gift wrapping, sufficient for few points).
fn hull(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let side = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let start = *points.iter().min_by(|a, b| a.partial_cmp(b).unwrap()).unwrap();
    let mut ring = vec![start];
    loop {
        let last = *ring.last().unwrap();
        let mut next = *points.iter().find(|&&p| p != last).unwrap();
        for &p in points {
            if side(last, next, p) < 0.0 {
                next = p;
            }
        }
        if next == start {
            return ring;
        }
        ring.push(next);
    }
}

fn moved(rectangle: [f64; 2], sun: &Sun, height: f64) -> [[f64; 2]; 4] {
    let shift = height / sun.elevation.tan();
    let (x, y) = (rectangle[0] / 2.0, rectangle[1] / 2.0);
    [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| [x + shift * sun.away[0], y + shift * sun.away[1]])
}

fn check_hull(scene: &TriangleScene, sun: &Sun, corners: &[[f64; 2]]) {
    let truth = Truth::new(scene);
    let outline = hull(corners);
    let count = outline.len() as f64;
    let middle = [0, 1].map(|axis| outline.iter().map(|p| p[axis]).sum::<f64>() / count);
    for step in 0..72 {
        let heading = TAU * f64::from(step) / 72.0 + 0.01;
        let (found, expected) =
            (shadow_end(&truth, sun, middle, heading, 200.0), distance_to_edge(&outline, middle, heading));
        // Flat faces: the two differ by rounding only, far below the required millimetre.
        assert!((found - expected).abs() < MILLIMETRE / 100.0, "{heading}: {found} {expected}");
    }
}

#[test]
fn shadow_of_a_box_is_the_hull_of_base_and_moved_top() {
    for sun in suns() {
        let size = [7.0, 11.0];
        let corners = [moved(size, &sun, 0.0), moved(size, &sun, 9.0)].concat();
        check_hull(&box_on_plane(size, 9.0), &sun, &corners);
    }
}

#[test]
fn shadow_of_a_hovering_slab_is_the_hull_of_its_moved_faces_and_leaves_the_ground_below_lit() {
    for sun in suns() {
        let size = [6.0, 4.0];
        let scene = slab_over_plane(size, 5.0, 0.25);
        let corners = [moved(size, &sun, 5.0), moved(size, &sun, 5.25)].concat();
        check_hull(&scene, &sun, &corners);
        // All three suns stand lower than the edge of the slab seen from below its middle.
        let truth = Truth::new(&scene);
        assert!(!truth.occluded_towards([0.0; 3], sun.direction) && truth.occluded_towards([0.0; 3], [0.0, 0.0, 1.0]));
    }
}

#[test]
fn shadow_of_a_sphere_is_an_ellipse() {
    let (radius, height, tolerance) = (2.0, 3.0, 2.5e-4);
    let scene = sphere_over_plane(radius, height, tolerance);
    let truth = Truth::new(&scene);
    let expected_triangles = 10.0 * radius / tolerance;
    assert!((0.7..1.3).contains(&(scene.triangles.len() as f64 / expected_triangles)), "{}", scene.triangles.len());
    for sun in suns() {
        let middle = sun.away.map(|v| v * height / sun.elevation.tan());
        let along = radius / sun.elevation.sin();
        for step in 0..72 {
            let turn = TAU * f64::from(step) / 72.0 + 0.01;
            let heading = sun.away[1].atan2(sun.away[0]) + turn;
            let expected = ((turn.cos() / along).powi(2) + (turn.sin() / radius).powi(2)).powf(-0.5);
            let found = shadow_end(&truth, &sun, middle, heading, 30.0);
            assert!(found <= expected + 1e-9, "the mesh lies inside the sphere: {found} {expected}");
            assert!(found > expected - tolerance / sun.elevation.sin() - 1e-9, "{found} {expected}");
            assert!(expected - found < MILLIMETRE);
        }
    }
}

#[test]
fn treads_are_shaded_over_rise_times_cosine_over_tangent() {
    let (count, tread, rise, width) = (8_u32, 0.6, 0.25, 40.0);
    let truth = Truth::new(&stairs(count, tread, rise, width));
    // Beyond the top of the stairs, turned from it by α; the wide steps leave their middle free of the ends.
    for (alpha, elevation) in [(0.0_f64, 40.0_f64), (0.35, 30.0), (-0.6, 55.0)] {
        let elevation = elevation.to_radians();
        let (sin, cos) = alpha.sin_cos();
        let sun = [cos * elevation.cos(), sin * elevation.cos(), elevation.sin()];
        let expected = rise * cos / elevation.tan();
        assert!(expected < tread);
        for step in 1..count {
            // The tread in front of riser `step`, at x from (step − 1) · tread to step · tread.
            let (riser, height) = (f64::from(step) * tread, f64::from(step) * rise);
            let dark = |before: f64| truth.occluded_towards([riser - before, 0.3, height], sun);
            assert!(dark(expected - MILLIMETRE / 10.0) && !dark(expected + MILLIMETRE / 10.0), "{alpha} {step}");
        }
        // The ground in front of the first riser.
        let dark = |before: f64| truth.occluded_towards([-before, 0.3, 0.0], sun);
        assert!(dark(expected - MILLIMETRE / 10.0) && !dark(expected + MILLIMETRE / 10.0));
    }
    // A sun lower than the slope of the stairs leaves all of them dark. The ground is dark up to the end of the shadow
    // of the top.
    let elevation = 12_f64.to_radians();
    let sun = [elevation.cos(), 0.0, elevation.sin()];
    let end = f64::from(count) * rise / elevation.tan() - f64::from(count - 1) * tread;
    for (x, is_dark) in [(-end + MILLIMETRE, true), (-end - MILLIMETRE, false)] {
        assert_eq!(truth.occluded_towards([x, 0.0, 0.0], sun), is_dark, "{x}");
    }
}

/// Returns the cosine-weighted share of a hemisphere about `normal` that is free of the scene, by `rows`² stratified
/// rays. Equal areas on the unit disc are lifted to the hemisphere (Malley's method).
fn sky_view(truth: &Truth, point: [f64; 3], frame: [[f64; 3]; 3], rows: u32) -> f64 {
    let origins = vec![point; (rows * rows) as usize];
    let directions: Vec<[f64; 3]> = (0..rows)
        .flat_map(|i| (0..rows).map(move |j| (i, j)))
        .map(|(i, j)| {
            // A lattice instead of a grid of columns, so that the symmetry of a formula does not flatter it.
            let radius = ((f64::from(i) + 0.5) / f64::from(rows)).sqrt();
            let turn = TAU * (f64::from(j) + 0.5 + 0.618 * f64::from(i)) / f64::from(rows);
            let parts = [radius * turn.cos(), radius * turn.sin(), (1.0 - radius * radius).sqrt()];
            std::array::from_fn(|k| (0..3).map(|axis| parts[axis] * frame[axis][k]).sum())
        })
        .collect();
    let free = truth.first_hits(&origins, &directions, f64::INFINITY).iter().filter(|hit| hit.is_none()).count();
    free as f64 / origins.len() as f64
}

const UP: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// Number of rays per side, and maximum error from cells that a horizon cuts. About 4 cells per row lie on the horizon,
/// each wrong by half at most and at random. The error is far above that of the open ends of the canyon (2e-6).
const ROWS: u32 = 600;
const SAMPLING: f64 = 1e-3;

#[test]
fn sky_view_of_a_canyon_matches_the_closed_form() {
    let (width, height, length) = (12.0, 15.0, 1000.0);
    let truth = Truth::new(&canyon(width, height, length));
    for y in [0.0, 2.5, -5.0] {
        let cosine = |distance: f64| (height / distance).atan().cos();
        let expected = (cosine(width / 2.0 - y) + cosine(width / 2.0 + y)) / 2.0;
        let found = sky_view(&truth, [0.0, y, 0.0], UP, ROWS);
        assert!((found - expected).abs() < SAMPLING, "{y}: {found} {expected}");
    }
    // The well-known value for the middle of the canyon.
    let middle = (2.0 * height / width).atan().cos();
    assert!((sky_view(&truth, [0.0; 3], UP, ROWS) - middle).abs() < SAMPLING);
    // On the wall at y = −6, which faces +y.
    let wall = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]];
    for h in [1.0, 7.0, 14.0] {
        let expected = (1.0 - ((height - h) / width).atan().sin()) / 2.0;
        let found = sky_view(&truth, [0.0, -width / 2.0, h], wall, ROWS);
        assert!((found - expected).abs() < SAMPLING, "{h}: {found} {expected}");
    }
}

#[test]
fn sky_view_of_a_basin_is_the_squared_cosine_of_its_horizon() {
    for horizon_deg in [10.0_f64, 30.0, 60.0] {
        let horizon = horizon_deg.to_radians();
        let truth = Truth::new(&basin(25.0, horizon));
        let found = sky_view(&truth, [0.0; 3], UP, ROWS);
        // A round horizon cuts between rows of the same elevation, 1 / ROWS of the sky apart.
        assert!((found - horizon.cos().powi(2)).abs() < 1.0 / f64::from(ROWS), "{horizon_deg}: {found}");
        // The horizon itself, in all directions.
        for step in 0..360 {
            let (sin, cos) = (TAU * f64::from(step) / 360.0 + 0.003).sin_cos();
            let blocked = |elevation: f64| {
                truth.occluded_towards([0.0; 3], [cos * elevation.cos(), sin * elevation.cos(), elevation.sin()])
            };
            assert!(blocked(horizon - 1e-6) && !blocked(horizon + 1e-5), "{horizon_deg}");
        }
    }
}

#[test]
fn solids_of_the_closed_forms_are_closed() {
    let scenes = [
        sphere_over_plane(2.0, 3.0, 1e-3),
        sphere_over_plane(1.0, 1.0, 10.0),
        slab_over_plane([3.0, 2.0], 2.0, 0.2),
        box_on_plane([3.0, 2.0], 2.0),
        canyon(10.0, 10.0, 100.0),
        basin(10.0, FRAC_PI_2 / 2.0),
        stairs(5, 0.3, 0.17, 1.2),
    ];
    for (number, scene) in scenes.iter().enumerate() {
        let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
        for (&[a, b, c], _) in scene.triangles.iter().zip(&scene.materials).filter(|&(_, &m)| m != Material::Terrain) {
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_default() += 1;
            }
        }
        assert!(edges.iter().all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1)), "{number}");
    }
}
