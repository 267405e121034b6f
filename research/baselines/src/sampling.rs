//! How densely a cloud samples the surface around each of its points.

use belvedere::cast::to_f32;
use belvedere::neighbors::NeighborIndex;
use belvedere::{Error, Parameter, Result};
use rayon::prelude::*;

/// Points handed to a thread at once; their searches share the cache.
const CHUNK: usize = 1024;

/// Runs `describe` with the `k` nearest points of each point (their indices, itself first, and the distance to the
/// last, metres) and returns what it gives, in the order of `positions`.
pub(crate) fn for_neighborhoods<T: Send + Clone + Default>(
    positions: &[[f32; 3]],
    index: &NeighborIndex,
    k: usize,
    describe: impl Fn(usize, &[usize], f32) -> T + Sync,
) -> Vec<T> {
    let order = index.tree_order();
    let mut in_tree_order = vec![T::default(); positions.len()];
    in_tree_order.par_chunks_mut(CHUNK).zip(order.par_chunks(CHUNK)).for_each(|(values, points)| {
        let (mut found, mut indices) = (Vec::with_capacity(k + 2), Vec::with_capacity(k + 2));
        for (value, &point) in values.iter_mut().zip(points) {
            index.k_nearest(positions[point as usize], k + 1, &mut found);
            indices.clear();
            indices.extend(found.iter().map(|neighbor| neighbor.index as usize));
            let farthest = found.last().map_or(0.0, |neighbor| neighbor.distance_squared.sqrt());
            *value = describe(point as usize, &indices, farthest);
        }
    });
    let mut values = vec![T::default(); positions.len()];
    for (&point, value) in order.iter().zip(in_tree_order) {
        values[point as usize] = value;
    }
    values
}

/// Distance of each point to its `k`-th nearest neighbour, (N), metres, but no more than `cap` times the median of
/// those above zero: a point that stands alone would otherwise count for a wide surface.
pub(crate) fn capped_spacing(positions: &[[f32; 3]], index: &NeighborIndex, k: usize, cap: f64) -> Vec<f32> {
    let mut spacing = for_neighborhoods(positions, index, k, |_, _, farthest| farthest);
    // duplicates have no spacing
    let mut sorted: Vec<f32> = spacing.iter().copied().filter(|&distance| distance > 0.0).collect();
    let middle = sorted.len() / 2;
    if sorted.is_empty() {
        return spacing;
    }
    let median = *sorted.select_nth_unstable_by(middle, f32::total_cmp).1;
    let max = to_f32(f64::from(median) * cap);
    spacing.iter_mut().for_each(|distance| *distance = distance.min(max));
    spacing
}

/// Checks the number of a neighbour.
pub(crate) fn check_neighbor(name: &'static str, k: usize) -> Result<()> {
    if (1..=256).contains(&k) {
        return Ok(());
    }
    Err(Error::InvalidParameter {
        parameter: Parameter::MethodSetting,
        value: format!("{k} for the {name}"),
        expected: "1 to 256",
    })
}
