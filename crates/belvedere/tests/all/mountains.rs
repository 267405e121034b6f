//! Simulated mountains of tests.

use belvedere::ElevationGrid;
use belvedere::random::uniform;
use belvedere::raster::Raster;
use std::f64::consts::TAU;

/// A square raster of `count` nodes a side, the first at (0, 0), with these heights of (x, y).
pub(crate) fn grid(count: usize, cell: f64, height: impl Fn(f64, f64) -> f64) -> ElevationGrid {
    let node = |i: usize| height((i % count) as f64 * cell, -((i / count) as f64) * cell) as f32;
    let heights = Raster::from_values(count, count, (0..count * count).map(node).collect()).unwrap();
    ElevationGrid::new(heights, [0.0, 0.0], [cell; 2]).unwrap()
}

/// Ridges and valleys of all sizes, up to `relief` metres high, the largest some 12 km wide.
pub(crate) fn mountains(count: usize, cell: f64, relief: f64) -> ElevationGrid {
    let waves: Vec<[f64; 4]> = (0..14)
        .map(|i| {
            let width = 12_000.0 / 1.6f64.powi(i);
            let turn = TAU * uniform(5, 2 * i as u64);
            [turn.sin() / width, turn.cos() / width, uniform(5, 2 * i as u64 + 1), width / 12_000.0]
        })
        .collect();
    grid(count, cell, |x, y| {
        let ridge = |[a, b, phase, size]: &[f64; 4]| size * (1.0 - (TAU / 2.0 * (a * x + b * y + phase)).sin().abs());
        relief * 0.4 * waves.iter().map(ridge).sum::<f64>()
    })
}
