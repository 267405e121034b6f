//! Triangles where a function on a grid crosses a value: a vertex in each cell that the surface crosses, a square
//! across each edge.

use super::OrientedSample;
use super::level::{GridLevel, key, node, value};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};

/// A cell that the surface crosses.
struct Crossed {
    cell: u64,
    vertex: [f64; 3],
    /// Bit k where corner k is below the value.
    below: u8,
}

/// The triangles where the levels have the value `iso`, found from the cells of the samples on, as far as `is_near`
/// holds.
///
/// # Source
/// Gibson 1998, "Constrained Elastic Surface Nets", section 3, with vertices at the mean of the crossings of their
/// cell; from cell to cell as in Bloomenthal 1988.
pub(super) fn triangles(
    levels: &[GridLevel],
    samples: &[OrientedSample],
    iso: f64,
    is_near: impl Fn([f64; 3]) -> bool + Sync,
) -> Vec<[[f64; 3]; 3]> {
    let Some(finest) = levels.last() else { return Vec::new() };
    let mut front: Vec<u64> = samples
        .par_iter()
        .flat_map_iter(|sample| {
            // the surface passes a sample in its cell or one of those around
            let cell = finest.locate(sample.position).0;
            (0..27_i64).map(move |k| key([cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1]))
        })
        .collect();
    let mut known: HashSet<u64> = HashSet::new();
    let mut crossed: Vec<Crossed> = Vec::new();
    while !front.is_empty() {
        front.par_sort_unstable();
        front.dedup();
        front.retain(|&cell| known.insert(cell));
        let found: Vec<Crossed> = front.par_iter().filter_map(|&cell| cross(levels, cell, iso)).collect();
        let found: Vec<Crossed> = found.into_par_iter().filter(|crossed| is_near(crossed.vertex)).collect();
        front = found.iter().flat_map(Crossed::next_cells).filter(|cell| !known.contains(cell)).collect();
        crossed.extend(found);
    }
    crossed.sort_unstable_by_key(|crossed| crossed.cell);
    let vertices: HashMap<u64, [f64; 3]> = crossed.iter().map(|crossed| (crossed.cell, crossed.vertex)).collect();
    crossed.par_iter().flat_map_iter(|crossed| crossed.squares(&vertices)).collect()
}

/// The steps from the first corner of a cell to corner `k`.
fn step(k: usize) -> [i64; 3] {
    [0, 1, 2].map(|axis| i64::from(k >> axis & 1 == 1))
}

/// What the surface does in a cell; `None` where it does not cross it.
fn cross(levels: &[GridLevel], cell: u64, iso: f64) -> Option<Crossed> {
    let (finest, number) = (levels.last()?, levels.len() - 1);
    let first = node(cell);
    if !levels[0].holds(first.map(|v| v >> number)) {
        return None;
    }
    let values: [f64; 8] = std::array::from_fn(|k| {
        let step = step(k);
        value(levels, number, std::array::from_fn(|axis| first[axis] + step[axis])) - iso
    });
    let below = (0..8).fold(0, |below, k| below | u8::from(values[k] < 0.0) << k);
    if below == 0 || below == u8::MAX {
        return None;
    }
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for from in 0..8_usize {
        for axis in 0..3 {
            let to = from | 1 << axis;
            if to == from || (below >> from & 1) == (below >> to & 1) {
                continue;
            }
            let share = values[from] / (values[from] - values[to]);
            for (i, sum) in sum.iter_mut().enumerate() {
                *sum += step(from)[i] as f64 + if i == axis { share } else { 0.0 };
            }
            count += 1.0;
        }
    }
    let vertex = finest.place(std::array::from_fn(|axis| first[axis] as f64 + sum[axis] / count));
    Some(Crossed { cell, vertex, below })
}

impl Crossed {
    /// The cells across those faces that the surface crosses.
    fn next_cells(&self) -> impl Iterator<Item = u64> {
        let first = node(self.cell);
        (0..6).filter_map(move |face| {
            let (axis, side) = (face / 2, face % 2);
            let mask = (0..8).filter(|&k| k >> axis & 1 == side).fold(0_u8, |mask, k| mask | 1 << k);
            let mut to = first;
            to[axis] += if side == 1 { 1 } else { -1 };
            let is_crossed = self.below & mask != 0 && self.below & mask != mask;
            (is_crossed && to[axis] >= 0).then(|| key(to))
        })
    }

    /// Two triangles across each edge at the first corner that the surface crosses, between the vertices of the four
    /// cells around it.
    fn squares(&self, vertices: &HashMap<u64, [f64; 3]>) -> impl Iterator<Item = [[f64; 3]; 3]> {
        let first = node(self.cell);
        (0..3)
            .filter_map(move |axis| {
                if (self.below & 1) == (self.below >> (1 << axis) & 1) {
                    return None;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let vertex = |back_u: i64, back_v: i64| {
                    let mut cell = first;
                    cell[u] -= back_u;
                    cell[v] -= back_v;
                    vertices.get(&key(cell)).copied()
                };
                let (a, b, c, d) = (vertex(0, 0)?, vertex(1, 0)?, vertex(1, 1)?, vertex(0, 1)?);
                Some([[a, b, c], [a, c, d]])
            })
            .flatten()
    }
}
