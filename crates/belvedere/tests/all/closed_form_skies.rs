//! Sky view factor and openness where they are formulas: street canyons, basins, tilted planes; and how well directions
//! represent the sky.

use belvedere::apps::sky_view::{SkyDirections, SkyView, sky_view};
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{BlockRule, MedialScene};
use belvedere::random::uniform;
use std::f64::consts::{PI, TAU};

/// Minimum radius of the balls of a wall, metres. Seen from 2 m or more an edge made of them lies lower by 0.41 of it.
/// That is at most 0.004 of the tangent of its elevation, which moves the views of the sky by less than 0.002.
const FINEST: f64 = 0.01;

/// Returns balls in the corner below `top` and beyond `wall` of an upright section, as (beyond the wall, height,
/// radius). Each touches both. Every line of sight into the wall meets one of them, since the circles beside a corner
/// that a line misses have a ratio of 5.8 and more.
fn corner_balls(top: f64, largest: f64) -> impl Iterator<Item = (f64, f64, f64)> {
    let count = (largest / FINEST).log2().ceil() as i32 + 1;
    (0..count).map(move |i| {
        let radius = FINEST * 2f64.powi(i);
        (radius, top - radius, radius)
    })
}

fn add(balls: &mut MedialBalls, center: [f64; 3], radius: f64) {
    balls.centers.push(center.map(|v| v as f32));
    balls.radii.push(radius as f32);
    balls.source.push(0);
    balls.touch.push(0);
    balls.separation_angles.push(1.0);
}

/// Spacing of balls along a wall, in radii: they leave 3 % of a radius between them.
const STEP: f64 = 0.5;

/// Street along x with walls of `heights` at y = 0 and y = `width`, 240 m to either side of x = 0.
fn canyon(width: f64, heights: [f64; 2]) -> MedialScene {
    let mut balls = MedialBalls::default();
    for (height, wall, outward) in [(heights[0], 0.0, -1.0), (heights[1], width, 1.0)] {
        for (beyond, z, radius) in corner_balls(height, 2.0 * height) {
            let count = (240.0 / (STEP * radius)).ceil() as i32;
            for i in -count..=count {
                add(&mut balls, [f64::from(i) * STEP * radius, wall + outward * beyond, z], radius);
            }
        }
    }
    MedialScene::new(&balls, &BlockRule::default()).unwrap()
}

/// Round basin whose edge lies `radius` metres off at height `edge`.
fn basin(radius: f64, edge: f64) -> MedialScene {
    let mut balls = MedialBalls::default();
    for (beyond, z, ball) in corner_balls(edge, 2.0 * edge) {
        let count = (TAU * (radius + beyond) / (STEP * ball)).ceil() as i32;
        for i in 0..count {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
            add(&mut balls, [(radius + beyond) * cos, (radius + beyond) * sin, z], ball);
        }
    }
    MedialScene::new(&balls, &BlockRule::default()).unwrap()
}

fn view(scene: &MedialScene, targets: &[[f64; 3]], normals: Option<&[[f32; 3]]>, count: usize) -> SkyView {
    let sky = SkyDirections::even(count).unwrap();
    let targets: Vec<[f32; 3]> = targets.iter().map(|p| p.map(|v| v as f32)).collect();
    let matrix = scene.visibility_matrix(&targets, &sky.directions, &Control::none()).unwrap();
    sky_view(&matrix, &sky, normals).unwrap()
}

/// The two figures of the floor of an endless canyon with eaves at two elevations (Johnson & Watson 1984 for the
/// first).
fn floor_of_canyon(eaves: [f64; 2]) -> [f64; 2] {
    [f64::midpoint(eaves[0].cos(), eaves[1].cos()), 1.0 - (eaves[0] + eaves[1]) / PI]
}

/// Errors of the sky view factor and of openness of a target; neither may exceed `max`.
fn errors(found: &SkyView, target: usize, expected: [f64; 2], max: f64, what: &str) -> [f64; 2] {
    let errors = [found.factors[target], found.openness[target]];
    let errors = [0, 1].map(|i| f64::from(errors[i]) - expected[i]);
    assert!(errors.iter().all(|error| error.abs() < max), "{what}: {errors:.4?} off {expected:.4?}");
    errors
}

#[test]
fn street_canyons_have_the_sky_of_the_formula() {
    // an edge of a roof cuts the sky between directions: root mean square errors of 0.004 at 577 directions, thrice
    // that at most, and a tenth of it at 20 000, where what is left is that of the balls and of the sky at the open
    // ends
    for (count, max, max_rms) in [(577, 0.0126, 0.005), (20_000, 0.0025, 0.001)] {
        let mut all = Vec::new();
        for (width, heights) in [(20.0, [10.0, 10.0]), (10.0, [10.0, 10.0]), (8.0, [12.0, 16.0]), (30.0, [6.0, 20.0])] {
            let scene = canyon(width, heights);
            let places = [0.5, 0.25, 0.8].map(|share| [0.0, share * width, 0.0]);
            let found = view(&scene, &places, None, count);
            for (target, [_, y, _]) in places.into_iter().enumerate() {
                let eaves = [(heights[0] / y).atan(), (heights[1] / (width - y)).atan()];
                let what = format!("canyon of {width} m by {heights:?} m at {y} m");
                all.extend(errors(&found, target, floor_of_canyon(eaves), max, &what));
            }
            // upright on the wall at y = 0, at a third of its height and 0.1 m below its top
            let places = [heights[0] / 3.0, heights[0] - 0.1].map(|z| [0.0, 0.001, z]);
            let found = view(&scene, &places, Some(&[[0.0, 1.0, 0.0]; 2]), count);
            for (target, [_, _, z]) in places.into_iter().enumerate() {
                let eaves = ((heights[1] - z) / width).atan().max(0.0);
                let expected = [(1.0 - eaves.sin()) / 2.0, 0.5 - eaves / PI];
                all.extend(errors(
                    &found,
                    target,
                    expected,
                    max,
                    &format!("wall of {width} m by {heights:?} m at {z} m"),
                ));
            }
        }
        let rms = (all.iter().map(|error| error * error).sum::<f64>() / all.len() as f64).sqrt();
        println!("{count} directions: {rms:.4}");
        assert!(rms < max_rms, "{count} directions: {rms}");
    }
}

#[test]
fn basins_have_the_sky_of_the_formula() {
    for edge_deg in [10.0, 30.0, 50.0, 70.0] {
        let elevation = f64::to_radians(edge_deg);
        let scene = basin(10.0, 10.0 * elevation.tan());
        let found = view(&scene, &[[0.0; 3]], None, 577);
        let expected = [elevation.cos().powi(2), 1.0 - elevation.sin()];
        errors(&found, 0, expected, 0.005, &format!("basin up to {edge_deg} degrees"));
    }
}

#[test]
fn tilted_free_planes_see_what_their_tilt_leaves() {
    let scene = MedialScene::new(&MedialBalls::default(), &BlockRule::default()).unwrap();
    let tilts_deg = [0.0, 15.0, 40.0, 65.0, 90.0, 120.0, 180.0];
    for azimuth in [0.0, 2.0, 4.5] {
        let normals: Vec<[f32; 3]> = tilts_deg
            .iter()
            .map(|tilt: &f64| {
                let (sin, cos) = tilt.to_radians().sin_cos();
                [sin * f64::sin(azimuth), sin * f64::cos(azimuth), cos].map(|v| v as f32)
            })
            .collect();
        let found = view(&scene, &vec![[1.0, 2.0, 3.0]; normals.len()], Some(&normals), 577);
        for (target, tilt) in tilts_deg.iter().map(|tilt| tilt.to_radians()).enumerate() {
            let expected = [f64::midpoint(1.0, tilt.cos()), 1.0 - tilt / PI];
            errors(&found, target, expected, 0.005, &format!("tilt {tilt}"));
        }
    }
}

/// Returns the root mean square errors over 400 canyons of sky view factor and openness on the floor, and of the sky
/// view factor of walls, from directions tested with the exact horizon.
fn errors_of_directions(count: usize) -> [f64; 3] {
    let sky = SkyDirections::even(count).unwrap();
    let mut squares = [0.0; 3];
    for case in 0..400 {
        let drawn = |i: u64| uniform(77, 8 * case + i);
        // streets half as wide as high to four times as wide, in any direction, seen from anywhere across
        let (width, heights) = (5.0 + 35.0 * drawn(0), [5.0 + 15.0 * drawn(1), 5.0 + 15.0 * drawn(2)]);
        let y = width * (0.05 + 0.9 * drawn(3));
        let (sin, cos) = (TAU * drawn(4)).sin_cos();
        let z = heights[0] * drawn(5);
        let mut sums = [0.0; 3];
        for (direction, solid_angle) in sky.directions.iter().zip(&sky.solid_angles) {
            let across = direction[0] * cos + direction[1] * sin;
            let clears = |distance: f64, rise: f64| direction[2] * distance >= rise * across.abs();
            let free = if across > 0.0 { clears(width - y, heights[1]) } else { clears(y, heights[0]) };
            if free {
                sums[0] += direction[2] * solid_angle / PI;
                sums[1] += solid_angle / TAU;
            }
            if across > 0.0 && clears(width, heights[1] - z) {
                sums[2] += across * solid_angle / PI;
            }
        }
        let eaves = [(heights[0] / y).atan(), (heights[1] / (width - y)).atan()];
        let [factor, openness] = floor_of_canyon(eaves);
        let wall = (1.0 - ((heights[1] - z) / width).atan().max(0.0).sin()) / 2.0;
        for (square, (sum, expected)) in squares.iter_mut().zip(sums.into_iter().zip([factor, openness, wall])) {
            *square += (sum - expected) * (sum - expected) / 400.0;
        }
    }
    squares.map(f64::sqrt)
}

#[test]
fn even_directions_err_as_documented() {
    // those of SkyDirections::even, and fewer
    for (count, documented) in [
        (64, [0.021, 0.018, 0.0125]),
        (145, [0.0118, 0.0106, 0.0062]),
        (577, [0.0041, 0.0036, 0.0020]),
        (2305, [0.0015, 0.0013, 0.0008]),
    ] {
        let found = errors_of_directions(count);
        println!("{count} directions: {found:.4?}");
        for (found, documented) in found.into_iter().zip(documented) {
            // other canyons than those of the documentation
            assert!(found < 1.15 * documented && found > 0.85 * documented, "{count}: {found} and {documented}");
        }
    }
}
