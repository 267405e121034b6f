//! Shadows on level ground of things whose shadow is a formula: the outline is right to a pixel at three suns.

use belvedere::control::Control;
use belvedere::medial::{MedialBalls, ShrinkMethod, ShrinkParams, Side, shrink};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::normals::{Orientation, orient};
use belvedere::query::{BlockRule, MedialScene};
use belvedere::random::uniform;
use belvedere::view::to_sun;
use belvedere::{Mesh, PointCloud};
use belvedere_scenes::{TriangleScene, closed_forms, extruded};
use std::f64::consts::TAU;

/// Azimuth and elevation, degrees: morning, high, and low in the evening, none along a side of anything here.
const SUNS_DEG: [[f64; 2]; 3] = [[110.0, 20.0], [170.0, 62.0], [245.0, 35.0]];
/// Height of targets above the ground, metres: a target on a surface is tested from just outside of it.
const LIFT: f64 = 0.02;

/// Formula that returns true if the sun is hidden from a place.
type Form<'a> = &'a dyn Fn([f64; 3], [f64; 3]) -> bool;

/// Points about `spacing` metres apart, drawn anew in each cell of a rectangle: what a scanner leaves is no grid.
fn sampled(corner: [f64; 3], sides: [[f64; 3]; 2], spacing: f64, seed: u64, cloud: &mut Vec<[f32; 3]>) {
    let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    let [columns, rows] = sides.map(|side| (length(side) / spacing).ceil() as u64);
    for i in 0..columns * rows {
        let u = ((i % columns) as f64 + uniform(seed, 2 * i)) / columns as f64;
        let v = ((i / columns) as f64 + uniform(seed, 2 * i + 1)) / rows as f64;
        cloud.push(std::array::from_fn(|k| (corner[k] + u * sides[0][k] + v * sides[1][k]) as f32));
    }
}

/// Interior balls of points as the pipeline makes them without pulses, turned outward by the exact mesh.
fn balls_of(points: Vec<[f32; 3]>, model: &TriangleScene, neighbors: usize) -> MedialBalls {
    let cloud = PointCloud { positions: points, ..PointCloud::default() };
    let index = NeighborIndex::new(&cloud.positions, &Control::none()).unwrap();
    let normals = estimate(&cloud.positions, &index, Neighborhood::Fixed { k: neighbors }, &Control::none()).unwrap();
    let mesh = Mesh { vertices: model.vertices.clone(), triangles: model.triangles.clone(), ..Mesh::default() };
    let (oriented, _) = orient(&cloud, normals, &Orientation::Mesh(&mesh), &Control::none()).unwrap();
    // points without noise: a centimetre
    let params = ShrinkParams { method: ShrinkMethod::Tau { penetration: 0.01 }, ..ShrinkParams::tau() };
    shrink(&oriented, &index, Side::Interior, &params, &Control::none()).unwrap().0.shrunk()
}

/// Compares the shade that balls cast on squares of ground of 2 · `half_side` around `middles` with `form`: every pixel
/// at least a pixel off the outline must agree. Returns the number of pixels compared, in the sun and in the shade, and
/// each sun has both.
fn compare(balls: &MedialBalls, form: Form<'_>, pixel: f64, middles: &[[f64; 2]], half_side: f64) -> [usize; 2] {
    let scene = MedialScene::new(balls, &BlockRule::carved()).unwrap();
    let across = (2.0 * half_side / pixel).round() as usize;
    let center = |i: usize| (i as f64 + 0.5) * pixel - half_side;
    let place = |middle: &[f64; 2], i: usize| {
        [(middle[0] + center(i % across)) as f32, (middle[1] + center(i / across)) as f32, LIFT as f32]
    };
    let targets: Vec<[f32; 3]> =
        middles.iter().flat_map(|middle| (0..across * across).map(move |i| place(middle, i))).collect();
    let suns = SUNS_DEG.map(|[azimuth, elevation]| to_sun(azimuth.to_radians(), elevation.to_radians()));
    let matrix = scene.visibility_matrix(&targets, &suns, &Control::none()).unwrap();
    let mut compared = [0, 0];
    for (column, &sun) in suns.iter().enumerate() {
        let (mut here, mut wrong) = ([0, 0], Vec::new());
        for (target, &place) in targets.iter().enumerate() {
            let [x, y, z] = place.map(f64::from);
            let shaded = form([x, y, z], sun);
            let is_off_outline = (0..16).all(|i| {
                let (sin, cos) = (TAU * f64::from(i) / 16.0).sin_cos();
                form([x + pixel * cos, y + pixel * sin, z], sun) == shaded
            });
            if is_off_outline {
                here[usize::from(shaded)] += 1;
                if matrix.is_free(target, column) == shaded {
                    wrong.push((place, shaded));
                }
            }
        }
        assert!(
            wrong.is_empty(),
            "sun {:?}: {} wrong, {:?}",
            SUNS_DEG[column],
            wrong.len(),
            &wrong[..wrong.len().min(20)]
        );
        assert!(here.iter().all(|&count| count > 20), "sun {:?}: {here:?}", SUNS_DEG[column]);
        compared = [compared[0] + here[0], compared[1] + here[1]];
    }
    compared
}

/// Returns true if a line of sight enters a box that stands on the ground, by its slabs.
fn box_hides(half: [f64; 2], height: f64, p: [f64; 3], to_sun: [f64; 3]) -> bool {
    let limits = [[-half[0], half[0]], [-half[1], half[1]], [0.0, height]];
    let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let [a, b] = limits[axis].map(|limit| (limit - p[axis]) / to_sun[axis]);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    enter < leave
}

#[test]
fn the_shadow_of_a_box_is_a_hexagon() {
    let (size, height) = ([6.0, 4.0], 8.0);
    let mut points = Vec::new();
    sampled([-20.0, -20.0, 0.0], [[40.0, 0.0, 0.0], [0.0, 40.0, 0.0]], 0.25, 1, &mut points);
    points.retain(|p| f64::from(p[0]).abs() > 3.0 || f64::from(p[1]).abs() > 2.0);
    sampled([-3.0, -2.0, height], [[size[0], 0.0, 0.0], [0.0, size[1], 0.0]], 0.08, 2, &mut points);
    for (seed, side) in [(3, -1.0), (4, 1.0)] {
        sampled([-3.0, side * 2.0, 0.0], [[size[0], 0.0, 0.0], [0.0, 0.0, height]], 0.08, seed, &mut points);
        sampled([side * 3.0, -2.0, 0.0], [[0.0, size[1], 0.0], [0.0, 0.0, height]], 0.08, seed + 2, &mut points);
    }
    let balls = balls_of(points, &closed_forms::box_on_plane(size, height), 12);
    let form = |p: [f64; 3], sun: [f64; 3]| box_hides([3.0, 2.0], height, p, sun);
    // two and a half times the spacing of the points on the box
    let compared = compare(&balls, &form, 0.2, &[[0.0, 0.0]], 16.0);
    assert!(compared[1] > 5000, "{compared:?}");
}

#[test]
fn the_shadow_of_a_pole_is_as_wide_as_the_pole() {
    // a cylinder of 0.15 m that points stand 3 cm apart on
    let (radius, height) = (0.15, 6.0);
    let (columns, rows) = (32_u32, 200_u32);
    let ring = |radius: f64, z: f64, turn: f64| {
        (0..columns).map(move |i| {
            let (sin, cos) = (TAU * (f64::from(i) + turn) / f64::from(columns)).sin_cos();
            [(radius * cos) as f32, (radius * sin) as f32, z as f32]
        })
    };
    let mut points: Vec<[f32; 3]> = (0..=rows)
        .flat_map(|row| ring(radius, height * f64::from(row) / f64::from(rows), 0.5 * f64::from(row % 2)))
        .collect();
    for share in [0.25, 0.5, 0.75] {
        points.extend(ring(share * radius, height, share));
    }
    let mut model = TriangleScene::default();
    let footprint: Vec<[f64; 2]> = (0..64)
        .map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 64.0).sin_cos();
            [radius * cos, radius * sin]
        })
        .collect();
    model.add_object("pole", &[extruded(&footprint, 0.0, height)]);
    let balls = balls_of(points, &model, 10);
    let form = |p: [f64; 3], sun: [f64; 3]| {
        // the infinite cylinder on the map, and the heights at which the line of sight is in it
        let level = sun[0].hypot(sun[1]);
        let [east, north] = [sun[0] / level, sun[1] / level];
        let along = -(p[0] * east + p[1] * north);
        let beside = p[0] * north - p[1] * east;
        let half = (radius * radius - beside * beside).max(0.0).sqrt();
        let enters = p[2] + (along - half).max(0.0) * sun[2] / level;
        half > 0.0 && along + half > 0.0 && enters < height
    };
    // beside the foot, where the shadow begins, and about the tips
    let along = |[azimuth, elevation]: [f64; 2], height: f64| {
        let length = height / elevation.to_radians().tan();
        [-length * azimuth.to_radians().sin(), -length * azimuth.to_radians().cos()]
    };
    let beside = SUNS_DEG.map(|[azimuth, _]| along([azimuth, 45.0], 1.6));
    let tips = SUNS_DEG.map(|sun| along(sun, height));
    let compared = compare(&balls, &form, 0.05, &[beside, tips].concat(), 1.0);
    assert!(compared[1] > 300, "{compared:?}");
}

#[test]
fn the_shadow_of_a_sphere_is_an_ellipse() {
    let (radius, height) = (3.0, 6.0);
    let form = |p: [f64; 3], sun: [f64; 3]| {
        let offset = [-p[0], -p[1], height - p[2]];
        let along: f64 = (0..3).map(|k| offset[k] * sun[k]).sum();
        let square: f64 = offset.iter().map(|v| v * v).sum();
        square - along * along < radius * radius
    };
    // a sphere is a ball
    let ball = MedialBalls {
        centers: vec![[0.0, 0.0, height as f32]],
        radii: vec![radius as f32],
        source: vec![0],
        touch: vec![0],
        separation_angles: vec![1.0],
    };
    // as fine as rounding allows: 16 m in f32
    compare(&ball, &form, 0.05, &[[0.0, 0.0]], 16.0);
    // and so it is where only points of it are known, 8 cm apart along a spiral
    let count = (4.0 * std::f64::consts::PI * radius * radius / 0.0064) as u32;
    let turn = TAU / f64::midpoint(1.0, 5f64.sqrt());
    let points = (0..count).map(|i| {
        let up = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let (sin, cos) = (turn * f64::from(i)).sin_cos();
        let across = (1.0 - up * up).sqrt();
        [across * cos, across * sin, up].map(|v| radius * v)
    });
    let points = points.map(|p| [p[0] as f32, p[1] as f32, (p[2] + height) as f32]).collect();
    let balls = balls_of(points, &closed_forms::sphere_over_plane(radius, height, 0.01), 10);
    compare(&balls, &form, 0.1, &[[0.0, 0.0]], 16.0);
}
