//! Sampling error of a figure, from resampled blocks of targets.

use belvedere_data::cast::{to_i64, to_index};
use belvedere_data::random::uniform;
use serde::Serialize;

/// Resamples that an interval rests on.
const RESAMPLES: u64 = 400;

/// A figure, and where it would lie for other targets of the same kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Figure of all targets.
    pub value: f64,
    /// 2.5 % of resampled figures lie below.
    pub low: f64,
    /// 2.5 % of resampled figures lie above.
    pub high: f64,
}

/// Tile in plan of each target, numbered from 0, and the number of tiles.
#[derive(Clone, Debug)]
pub struct Tiles {
    /// Tile of each target, (M).
    pub of_target: Vec<u32>,
    /// Tiles in all.
    pub count: usize,
}

impl Tiles {
    /// Square tiles of `side` metres under `targets`, (M, 3) local metres. Targets that are not finite share a tile.
    #[must_use]
    pub fn new(targets: &[[f32; 3]], side: f32) -> Self {
        let mut numbers = std::collections::BTreeMap::new();
        let cells: Vec<[i64; 2]> =
            targets.iter().map(|p| [0, 1].map(|axis| to_i64((p[axis] / side).floor().into()))).collect();
        for &cell in &cells {
            numbers.insert(cell, 0_u32);
        }
        for (number, tile) in (0..).zip(numbers.values_mut()) {
            *tile = number;
        }
        let of_target = cells.iter().map(|cell| numbers.get(cell).copied().unwrap_or(0)).collect();
        Self { of_target, count: numbers.len() }
    }
}

/// The figure of `count` blocks, such as tiles, with its 95 % interval. `figure` gets how often each block counts, or
/// `None` where each counts once. `None` where it has no value.
///
/// Whole blocks are drawn with replacement, because errors are clustered: one wrong ball or one missing tree affects
/// all targets around it. Targets resampled one by one would look far more certain than they are.
///
/// # Source
/// Efron & Tibshirani 1993, chapter 13 (percentile intervals); blocks as in Künsch 1989.
#[must_use]
pub fn resampled(count: usize, seed: u64, figure: impl Fn(Option<&[u32]>) -> Option<f64>) -> Option<Interval> {
    let value = figure(None)?;
    let of_resample = |resample: u64| {
        let mut weights = vec![0_u32; count];
        for draw in 0..count as u64 {
            let chosen = uniform(seed, resample * count as u64 + draw) * count as f64;
            weights[to_index(chosen).min(count - 1)] += 1;
        }
        figure(Some(&weights))
    };
    Some(percentiles(value, (0..RESAMPLES).filter_map(of_resample).collect()))
}

/// The interval that holds 95 % of `resampled`.
fn percentiles(value: f64, mut resampled: Vec<f64>) -> Interval {
    resampled.sort_by(f64::total_cmp);
    let quantile = |share: f64| {
        let index = to_index((share * (resampled.len().max(1) - 1) as f64).round());
        resampled.get(index).copied().unwrap_or(value)
    };
    Interval { value, low: quantile(0.025), high: quantile(0.975) }
}
