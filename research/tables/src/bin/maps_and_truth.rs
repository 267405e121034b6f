//! How far do depth maps of the medial balls of an exact mesh lie from the mesh, as it is sampled more densely and
//! pixels shrink?
//!
//!     cargo research maps_and_truth
//!
//! A simulated town of 60 m, its triangles sampled evenly at random with their exact normals; seen by the sun and by a
//! camera over a corner. Errors are depth minus truth through the middle of each pixel, where both see something.
#![allow(clippy::print_stdout, reason = "the table is what this example is for")]

use belvedere::Bounds;
use belvedere::PointCloud;
use belvedere::blocking::Ball;
use belvedere::control::Control;
use belvedere::depth::{BoundsParams, ItemBuffer, Profile, depth_bounds, depth_map};
use belvedere::medial::{ShrinkMethod, ShrinkParams, Side, shrink};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::OrientedCloud;
use belvedere::random::uniform;
use belvedere::vector::{cross, length, sub, unit};
use belvedere::view::{View, to_sun};
use belvedere_scenes::{Material, TownParams, TriangleScene, Truth, town};

/// The ground is a sheet without thickness: a ball below it touches nothing. Its underside is put this far below,
/// metres.
const UNDERSIDE: f64 = 3.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = town(&TownParams { extent: 60.0, ..TownParams::default() });
    let truth = Truth::new(&scene);
    println!(
        "| spacing m | pixel m | view | median error m | 90 % of errors below m | beyond 0.5 m | truth within bounds | bracket < 0.5 m |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for spacing in [0.8, 0.4, 0.2, 0.1] {
        let (positions, normals) = sampled(&scene, spacing);
        let (cloud, _) = PointCloud::from_coordinates(&positions);
        let ones = vec![1.0; normals.len()];
        let oriented = OrientedCloud::new(cloud.positions.clone(), normals, ones.clone(), ones)?;
        let index = NeighborIndex::new(&cloud.positions, &Control::none())?;
        #[expect(clippy::cast_possible_truncation, reason = "a length in metres")]
        let method = ShrinkMethod::Tau { penetration: (0.05 * spacing) as f32 };
        let params = ShrinkParams { method, initial_radius: 5.0, max_radius: 5.0, max_spacings: f32::INFINITY };
        let (balls, _) = shrink(&oriented, &index, Side::Interior, &params, &Control::none())?;
        let balls = balls.shrunk();
        let list: Vec<_> =
            balls.centers.iter().zip(&balls.radii).map(|(&center, &radius)| Ball { center, radius }).collect();
        let Bounds { low, high } = cloud.bounds().ok_or("no points")?;
        let (low, high) = (low.map(f64::from), high.map(f64::from));
        let middle: [f64; 3] = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
        let corner = [low[0], low[1], high[2] + 10.0];
        for pixel in if spacing == 0.1 { vec![0.5, 0.25, 0.125] } else { vec![0.25] } {
            let sun = to_sun(235f64.to_radians(), 30f64.to_radians());
            let parallel = View::parallel(sun.map(|v| -v), low, high, pixel)?;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a picture of some hundred pixels"
            )]
            let width = (length(sub(middle, corner)) * 2.0 * 0.6f64.tan() / pixel).round() as usize;
            let camera = View::perspective(corner, middle, 1.2, [width, width], 0.0, f64::INFINITY)?;
            for (name, view) in [("sun", parallel), ("camera", camera)] {
                let map = depth_map(&balls, &view, Profile::Sphere, ItemBuffer::Without, &Control::none())?;
                let bounds = depth_bounds(&list, &view, &BoundsParams::default(), &Control::none())?;
                let mut errors = Vec::new();
                let (mut within, mut narrow) = (0, 0);
                for row in 0..view.size_px[1] {
                    for column in 0..view.size_px[0] {
                        let place = [column as f64 + 0.5, row as f64 + 0.5];
                        let [start, end] = [0.0, 1.0].map(|depth| {
                            let local = view.frame.local_from_view(view.position(place, depth));
                            std::array::from_fn::<f64, 3, _>(|i| local[i] + cloud.frame.origin[i])
                        });
                        let step = sub(end, start);
                        let (Some(hit), Some(mine), Some([lower, upper])) = (
                            truth.first_hit(start, step, f64::INFINITY),
                            map.depth.get(column, row),
                            bounds.bounds.get(column, row),
                        ) else {
                            continue;
                        };
                        if !mine.is_finite() {
                            continue;
                        }
                        // a step of depth 1 may be longer than a metre
                        let range_per_depth = length(step);
                        errors.push(f64::from(mine) - hit.range / range_per_depth);
                        within += usize::from((f64::from(lower)..=f64::from(upper)).contains(&hit.range));
                        narrow += usize::from(upper - lower < 0.5);
                    }
                }
                let count = errors.len().max(1) as f64;
                let beyond = errors.iter().filter(|e| e.abs() > 0.5).count();
                errors.sort_by(f64::total_cmp);
                let median = errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN);
                let mut sizes: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
                sizes.sort_by(f64::total_cmp);
                let max = sizes.get(sizes.len() * 9 / 10).copied().unwrap_or(f64::NAN);
                let percent = |n: usize| 100.0 * n as f64 / count;
                println!(
                    "| {spacing} | {pixel} | {name} | {median:.4} | {max:.3} | {:.1} % | {:.1} % | {:.1} % |",
                    percent(beyond),
                    percent(within),
                    percent(narrow)
                );
            }
        }
    }
    Ok(())
}

/// Points on all triangles, evenly at random, as many as a grid of `spacing` metres would have, with outward normals.
fn sampled(scene: &TriangleScene, spacing: f64) -> (Vec<[f64; 3]>, Vec<[f32; 3]>) {
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    let mut owed = 0.0;
    let mut draw = 0;
    for ([a, b, c], &material) in (0..scene.triangles.len()).filter_map(|i| scene.corners(i)).zip(&scene.materials) {
        let (ab, ac) = (sub(b, a), sub(c, a));
        let across = cross(ab, ac);
        let Some(normal) = unit(across) else { continue };
        owed += length(across) / 2.0 / (spacing * spacing);
        while owed >= 1.0 {
            owed -= 1.0;
            let (mut u, mut v) = (uniform(1, draw), uniform(1, draw + 1));
            draw += 2;
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let point: [f64; 3] = std::array::from_fn(|i| a[i] + u * ab[i] + v * ac[i]);
            #[expect(clippy::cast_possible_truncation, reason = "a unit vector")]
            let normal = normal.map(|v| v as f32);
            positions.push(point);
            normals.push(normal);
            if material == Material::Terrain {
                positions.push([point[0], point[1], point[2] - UNDERSIDE]);
                normals.push(normal.map(|v| -v));
            }
        }
    }
    (positions, normals)
}
