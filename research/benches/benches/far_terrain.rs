//! How much faster than a cast over every cell are the horizons of an elevation raster, and the question whether it
//! blocks a direction, in 41 km of mountains at 10 m?
//!
//! Run with `RAYON_NUM_THREADS=1`: only one of the two uses threads.
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "indices of cells")]

use belvedere::ElevationGrid;
use belvedere::apps::sky_view::SkyDirections;
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{BlockRule, EarthParams, FarTerrain, MedialScene};
use belvedere::random::uniform;
use belvedere_benches::Group;
use mountains::mountains;
use std::f64::consts::TAU;

#[path = "../../../crates/belvedere/tests/all/mountains.rs"]
mod mountains;

/// Nodes a side, and their distance, metres.
const COUNT: usize = 4097;
const CELL: f64 = 10.0;
const AZIMUTHS: usize = 360;

/// The tangent of the horizon by a walk over all lines of the grid, with a height between two nodes on each, as far as
/// the first that is above `limit`.
fn cast(grid: &ElevationGrid, place: [f64; 3], azimuth: f64, limit: f64, earth: &EarthParams) -> f64 {
    let heights = grid.heights().values();
    let (sin, cos) = azimuth.sin_cos();
    let step = [sin / CELL, -cos / CELL];
    let start = [place[0] / CELL, -place[1] / CELL];
    let rate = (1.0 - earth.refraction) / (2.0 * earth.radius);
    let next = |axis: usize, span: f64| {
        let at = start[axis] + step[axis] * span;
        let line = if step[axis] > 0.0 { at.floor() + 1.0 } else { at.ceil() - 1.0 };
        (line - start[axis]) / step[axis]
    };
    let apart = step.map(|step| (1.0 / step).abs());
    let mut spans = [next(0, CELL), next(1, CELL)];
    let mut highest = f64::NEG_INFINITY;
    loop {
        let axis = usize::from(spans[1] < spans[0]);
        let span = spans[axis];
        spans[axis] += apart[axis];
        let along = start[1 - axis] + step[1 - axis] * span;
        let line = (start[axis] + step[axis] * span).round();
        if highest > limit || !(along >= 0.0 && along < (COUNT - 1) as f64 && line >= 0.0 && line < COUNT as f64) {
            return highest;
        }
        let (node, share) = (along as usize, along.fract());
        let first = if axis == 0 { node * COUNT + line as usize } else { line as usize * COUNT + node };
        let second = first + if axis == 0 { COUNT } else { 1 };
        let height = f64::from(heights[first]) * (1.0 - share) + f64::from(heights[second]) * share;
        highest = highest.max((height - place[2] - rate * span * span) / span);
    }
}

fn horizons() {
    let far = FarTerrain::default().with_grid(mountains(COUNT, CELL, 2000.0), None);
    let (grid, earth) = (far.grid().unwrap(), EarthParams::default());
    let places: Vec<[f64; 3]> = (0..20)
        .map(|i| {
            let node = [0, 1].map(|axis| ((0.25 + 0.5 * uniform(11, 2 * i + axis)) * COUNT as f64) as usize);
            let height = f64::from(grid.heights().get(node[0], node[1]).unwrap()) + 1.7;
            [node[0] as f64 * CELL, node[1] as f64 * -CELL, height]
        })
        .collect();
    let mut group = Group::new("horizons of 20 places in 41 km of mountains at 10 m");
    group.sample_size(10);
    group.throughput(places.len() * AZIMUTHS);
    group.bench_function("maxima of blocks", |b| {
        // away from the axes, so that every line crosses both kinds of grid lines
        let step = [0.5, TAU / AZIMUTHS as f64];
        b.iter(|| places.iter().map(|&place| far.elevations(place, step, AZIMUTHS, &earth)[0]).sum::<f64>());
    });
    group.bench_function("every cell", |b| {
        let azimuth = |i: usize| 0.5 + i as f64 * TAU / AZIMUTHS as f64;
        let all = |&place: &[f64; 3]| {
            (0..AZIMUTHS).map(|i| cast(grid, place, azimuth(i), f64::INFINITY, &earth)).sum::<f64>()
        };
        b.iter(|| places.iter().map(all).sum::<f64>());
    });

    let directions = SkyDirections::even(600).unwrap().directions;
    let mut group = Group::new("is a direction blocked, of 600 over the sky and 20 places there");
    group.sample_size(10);
    group.throughput(places.len() * directions.len());
    group.bench_function("maxima of blocks", |b| {
        let blocked = |&place: &[f64; 3]| directions.iter().filter(|&&d| far.hides(place, d)).count();
        b.iter(|| places.iter().map(blocked).sum::<usize>());
    });
    group.bench_function("every cell", |b| {
        let is_blocked = |place: [f64; 3], [x, y, z]: [f64; 3]| {
            let tangent = z / x.hypot(y);
            cast(grid, place, x.atan2(y), tangent, &earth) > tangent
        };
        let blocked = |&place: &[f64; 3]| directions.iter().filter(|&&d| is_blocked(place, d)).count();
        b.iter(|| places.iter().map(blocked).sum::<usize>());
    });
    // cells of 1 m side by side at the first place, in a scene without balls
    let scene = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap();
    let scene = scene.with_far_terrain(far.clone());
    let [x, y, z] = places[0].map(|v| v as f32);
    let cells: Vec<[f32; 3]> = (0..512_u16).map(|i| [x + f32::from(i % 32), y + f32::from(i / 32), z]).collect();
    group.throughput(cells.len() * directions.len());
    group.bench_function("maxima of blocks, 512 cells of 1 m", |b| {
        b.iter(|| scene.visibility_matrix(&cells, &directions, &Control::none()).unwrap());
    });
}

fn main() {
    horizons();
}
