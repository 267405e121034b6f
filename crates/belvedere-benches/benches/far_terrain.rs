//! How much faster than a cast over every cell are the horizons of an elevation raster, 360 azimuths of a place, in 41 km of mountains at 10 m?
//!
//! Run with `RAYON_NUM_THREADS=1`: only one of the two uses threads.
#![allow(missing_docs, reason = "the macros of criterion write functions without")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "indices of cells")]

use belvedere::ElevationGrid;
use belvedere::query::{EarthParams, FarTerrain};
use belvedere::random::uniform;
use belvedere::raster::Raster;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::f64::consts::TAU;

/// Nodes a side, and their distance, metres.
const COUNT: usize = 4097;
const CELL: f64 = 10.0;
const AZIMUTHS: usize = 360;

/// Ridges and valleys of all sizes, up to some 2000 m high, the largest 12 km wide.
fn mountains() -> ElevationGrid {
    let waves: Vec<[f64; 4]> = (0..14)
        .map(|i| {
            let width = 12_000.0 / 1.6f64.powi(i);
            let turn = TAU * uniform(5, 2 * i as u64);
            [turn.sin() / width, turn.cos() / width, uniform(5, 2 * i as u64 + 1), width / 12_000.0]
        })
        .collect();
    let height = |i: usize| {
        let (x, y) = ((i % COUNT) as f64 * CELL, (i / COUNT) as f64 * -CELL);
        let ridge = |[a, b, phase, size]: &[f64; 4]| size * (1.0 - (TAU / 2.0 * (a * x + b * y + phase)).sin().abs());
        (800.0 * waves.iter().map(ridge).sum::<f64>()) as f32
    };
    let heights = Raster::from_values(COUNT, COUNT, (0..COUNT * COUNT).map(height).collect()).unwrap();
    ElevationGrid::new(heights, [0.0, 0.0], [CELL; 2]).unwrap()
}

/// The tangent of the horizon by a walk over all lines of the grid, with a height between two nodes on each.
fn cast(grid: &ElevationGrid, place: [f64; 3], azimuth: f64, earth: &EarthParams) -> f64 {
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
        if !(along >= 0.0 && along < (COUNT - 1) as f64 && line >= 0.0 && line < COUNT as f64) {
            return highest;
        }
        let (node, share) = (along as usize, along.fract());
        let first = if axis == 0 { node * COUNT + line as usize } else { line as usize * COUNT + node };
        let second = first + if axis == 0 { COUNT } else { 1 };
        let height = f64::from(heights[first]) * (1.0 - share) + f64::from(heights[second]) * share;
        highest = highest.max((height - place[2] - rate * span * span) / span);
    }
}

fn horizons(c: &mut Criterion) {
    let far = FarTerrain::default().with_grid(mountains(), None);
    let (grid, earth) = (far.grid().unwrap(), EarthParams::default());
    let places: Vec<[f64; 3]> = (0..20)
        .map(|i| {
            let node = [0, 1].map(|axis| ((0.25 + 0.5 * uniform(11, 2 * i + axis)) * COUNT as f64) as usize);
            let height = f64::from(grid.heights().get(node[0], node[1]).unwrap()) + 1.7;
            [node[0] as f64 * CELL, node[1] as f64 * -CELL, height]
        })
        .collect();
    let mut group = c.benchmark_group("horizons of 20 places in 41 km of mountains at 10 m");
    group.sample_size(10);
    group.throughput(Throughput::Elements((places.len() * AZIMUTHS) as u64));
    group.bench_function("maxima of blocks", |b| {
        // away from the axes, so that every line crosses both kinds of grid lines
        let step = [0.5, TAU / AZIMUTHS as f64];
        b.iter(|| places.iter().map(|&place| far.elevations(place, step, AZIMUTHS, &earth)[0]).sum::<f64>());
    });
    group.bench_function("every cell", |b| {
        let azimuth = |i: usize| 0.5 + i as f64 * TAU / AZIMUTHS as f64;
        let all = |&place: &[f64; 3]| (0..AZIMUTHS).map(|i| cast(grid, place, azimuth(i), &earth)).sum::<f64>();
        b.iter(|| places.iter().map(all).sum::<f64>());
    });
    group.finish();
}

criterion_group!(benches, horizons);
criterion_main!(benches);
