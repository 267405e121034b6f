//! The indicator function on grids from coarse to fine: the first fills the box, each finer one lies around the points.

use super::OrientedSample;
use belvedere::cast::{to_i64, to_row};
use rayon::prelude::*;

/// No node.
const NONE: u32 = u32::MAX;
/// Bits of a coordinate in the key of a node.
const BITS: u32 = 21;
/// A level reaches this many cells beyond that of a sample.
const REACH: i64 = 1;
/// Steps of the solver at most, and by how much it makes the residual smaller: the surface then moves by less than a
/// hundredth of a cell.
const MAX_STEPS: usize = 200;
const RESIDUAL: f64 = 1e-3;
/// Values summed at once, so that sums do not depend on threads.
const CHUNK: usize = 4096;

/// Values at nodes of a grid.
pub(super) struct GridLevel {
    /// Place of the node 0, 0, 0, metres; the same for all levels.
    corner: [f64; 3],
    /// Side of a cell, metres; half of the level before.
    pub(super) cell: f64,
    /// Nodes in the order of their keys: x, y, z, 21 bits each.
    keys: Vec<u64>,
    /// The greatest node along each axis where the level is the first.
    last: [i64; 3],
    pub(super) values: Vec<f64>,
}

pub(super) fn key([x, y, z]: [i64; 3]) -> u64 {
    let bits = |v: i64| v.cast_unsigned() & ((1 << BITS) - 1);
    bits(x) << (2 * BITS) | bits(y) << BITS | bits(z)
}

pub(super) fn node(key: u64) -> [i64; 3] {
    [2 * BITS, BITS, 0].map(|shift| (key >> shift & ((1 << BITS) - 1)).cast_signed())
}

impl GridLevel {
    /// All nodes of a box of `size` cells.
    pub(super) fn whole(corner: [f64; 3], cell: f64, size: [f64; 3]) -> Self {
        let last = size.map(to_i64);
        let range = |axis: usize| 0..=last[axis];
        let nodes = range(0).flat_map(|x| range(1).flat_map(move |y| range(2).map(move |z| key([x, y, z]))));
        Self { corner, cell, keys: nodes.collect(), last, values: Vec::new() }
    }

    /// The nodes around samples: those of the cell of each and of the cells next to it.
    pub(super) fn around(corner: [f64; 3], cell: f64, samples: &[OrientedSample]) -> Self {
        let mut level = Self { corner, cell, keys: Vec::new(), last: [0; 3], values: Vec::new() };
        let mut keys: Vec<u64> = samples.par_iter().map(|sample| key(level.locate(sample.position).0)).collect();
        for axis in 0..3 {
            keys.par_sort_unstable();
            keys.dedup();
            keys = keys
                .par_iter()
                .flat_map_iter(|&cell| {
                    (-REACH..=REACH + 1).map(move |step| {
                        let mut to = node(cell);
                        to[axis] += step;
                        key(to)
                    })
                })
                .collect();
        }
        keys.par_sort_unstable();
        keys.dedup();
        level.keys = keys;
        level
    }

    /// The cell that holds a place, and where in it, 0 to 1.
    pub(super) fn locate(&self, place: [f64; 3]) -> ([i64; 3], [f64; 3]) {
        let cells: [f64; 3] = std::array::from_fn(|axis| (place[axis] - self.corner[axis]) / self.cell);
        let whole = cells.map(|v| to_i64(v.floor()));
        (whole, std::array::from_fn(|axis| cells[axis] - whole[axis] as f64))
    }

    /// Place of a node, metres.
    pub(super) fn place(&self, node: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| self.corner[axis] + self.cell * node[axis])
    }

    /// Whether a cell lies in the box that the first level fills.
    pub(super) fn holds(&self, cell: [i64; 3]) -> bool {
        (0..3).all(|axis| cell[axis] < self.last[axis])
    }

    fn find(&self, node: [i64; 3]) -> Option<usize> {
        self.keys.binary_search(&key(node)).ok()
    }
}

/// The value at a node of level `number`, from the finest level up to that one which has it; halfway between nodes of a
/// coarser level, their mean.
pub(super) fn value(levels: &[GridLevel], number: usize, node: [i64; 3]) -> f64 {
    let level = &levels[number];
    if number == 0 {
        let within = std::array::from_fn(|axis| node[axis].clamp(0, level.last[axis]));
        return level.find(within).map_or(0.0, |found| level.values[found]);
    }
    if let Some(found) = level.find(node) {
        return level.values[found];
    }
    coarser_value(levels, number, node)
}

/// The value that the levels before `number` give a node of it.
fn coarser_value(levels: &[GridLevel], number: usize, node: [i64; 3]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for corner in 0..8_i64 {
        let step = [corner & 1, corner >> 1 & 1, corner >> 2];
        // an even coordinate is a node of the coarser level as well
        if (0..3).all(|axis| step[axis] <= node[axis] & 1) {
            sum += value(levels, number - 1, std::array::from_fn(|axis| (node[axis] >> 1) + step[axis]));
            count += 1.0;
        }
    }
    sum / count
}

/// The value at a place, linear between the nodes of the finest level there.
pub(super) fn value_at(levels: &[GridLevel], place: [f64; 3]) -> f64 {
    let Some(last) = levels.last() else { return 0.0 };
    let (cell, share) = last.locate(place);
    corners(share).map(|(step, weight)| weight * value(levels, levels.len() - 1, plus(cell, step))).sum()
}

fn plus(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

/// The corners of a cell, with what each counts at a place in it.
fn corners(share: [f64; 3]) -> impl Iterator<Item = ([i64; 3], f64)> {
    (0..8_i64).map(move |corner| {
        let step = [corner & 1, corner >> 1 & 1, corner >> 2];
        (step, (0..3).map(|axis| if step[axis] == 1 { share[axis] } else { 1.0 - share[axis] }).product())
    })
}

/// The linear equations of a level: conjugate gradients with the diagonal as preconditioner (Hestenes & Stiefel 1952).
pub(super) struct LevelSolver {
    /// For each node those before and after it along each axis, or [`NONE`].
    neighbors: Vec<[u32; 6]>,
    /// Neighbours that count, on this level or with the value of a coarser one.
    counted: Vec<f64>,
    /// For each sample the corners of its cell and what they count there.
    at_samples: Vec<[(u32, f64); 8]>,
    /// For each sample what its value counts.
    screening: Vec<f64>,
    /// For each node where its part of `of_node` begins.
    starts: Vec<u32>,
    /// Samples at each node, and what the node counts there.
    of_node: Vec<(u32, f64)>,
    right: Vec<f64>,
    values: Vec<f64>,
}

impl LevelSolver {
    /// The equations of `level`, whose coarser levels are solved.
    pub(super) fn new(level: &GridLevel, coarser: &[GridLevel], samples: &[OrientedSample], screening: f64) -> Self {
        let count = level.keys.len();
        let neighbors = neighbors(&level.keys);
        let values: Vec<f64> = if coarser.is_empty() {
            vec![0.0; count]
        } else {
            level.keys.par_iter().map(|&key| coarser_of(coarser, node(key))).collect()
        };
        let beyond = |i: usize, slot: usize| {
            let mut to = node(level.keys[i]);
            to[slot / 2] += if slot % 2 == 1 { 1 } else { -1 };
            coarser_of(coarser, to)
        };
        // on the first level nothing lies beyond, on the others what the coarser ones have
        let (counted, mut right): (Vec<f64>, Vec<f64>) = neighbors
            .par_iter()
            .enumerate()
            .map(|(i, slots)| {
                let missing = (0..6).filter(|&slot| slots[slot] == NONE);
                if coarser.is_empty() {
                    (6.0 - missing.count() as f64, 0.0)
                } else {
                    (6.0, missing.map(|slot| beyond(i, slot)).sum())
                }
            })
            .unzip();
        let area_of_side = level.cell * level.cell;
        for sample in samples {
            for axis in 0..3 {
                // the field lies between nodes
                let mut place = sample.position;
                place[axis] -= 0.5 * level.cell;
                let (cell, share) = level.locate(place);
                for (step, weight) in corners(share) {
                    let flow = sample.area * sample.normal[axis] * weight / area_of_side;
                    if let Some(from) = level.find(plus(cell, step)) {
                        let to = neighbors[from][2 * axis + 1];
                        if to != NONE {
                            right[to as usize] += flow;
                            right[from] -= flow;
                        }
                    }
                }
            }
        }
        let at_samples: Vec<[(u32, f64); 8]> = samples
            .par_iter()
            .map(|sample| {
                let (cell, share) = level.locate(sample.position);
                let mut at = [(0, 0.0); 8];
                for (slot, (step, weight)) in at.iter_mut().zip(corners(share)) {
                    if let Some(found) = level.find(plus(cell, step)) {
                        *slot = (to_row(found), weight);
                    }
                }
                at
            })
            .collect();
        let (starts, of_node) = by_node(&at_samples, count);
        let screening = samples.iter().map(|sample| screening * sample.area / area_of_side).collect();
        Self { neighbors, counted, at_samples, screening, starts, of_node, right, values }
    }

    /// The values at the nodes.
    pub(super) fn solve(mut self) -> Vec<f64> {
        let diagonal: Vec<f64> = (0..self.right.len()).into_par_iter().map(|i| self.diagonal(i)).collect();
        let mut residual = self.times(&self.values);
        residual.par_iter_mut().zip(&self.right).for_each(|(residual, right)| *residual = right - *residual);
        let precondition = |residual: &[f64]| -> Vec<f64> {
            residual.par_iter().zip(&diagonal).map(|(residual, diagonal)| residual / diagonal).collect()
        };
        let mut scaled = precondition(&residual);
        let mut direction = scaled.clone();
        let mut size = product(&residual, &scaled);
        let enough = RESIDUAL * RESIDUAL * product(&self.right, &precondition(&self.right));
        for _ in 0..MAX_STEPS {
            if !(size > enough) {
                break;
            }
            let image = self.times(&direction);
            let step = size / product(&direction, &image);
            self.values.par_iter_mut().zip(&direction).for_each(|(value, along)| *value += step * along);
            residual.par_iter_mut().zip(&image).for_each(|(residual, image)| *residual -= step * image);
            scaled = precondition(&residual);
            let next = product(&residual, &scaled);
            let share = next / size;
            direction.par_iter_mut().zip(&scaled).for_each(|(along, scaled)| *along = scaled + share * *along);
            size = next;
        }
        self.values
    }

    fn samples_of(&self, node: usize) -> &[(u32, f64)] {
        &self.of_node[self.starts[node] as usize..self.starts[node + 1] as usize]
    }

    fn diagonal(&self, node: usize) -> f64 {
        let of_samples = self.samples_of(node).iter().map(|&(s, weight)| self.screening[s as usize] * weight * weight);
        self.counted[node] + of_samples.sum::<f64>()
    }

    /// The left side of the equations.
    fn times(&self, values: &[f64]) -> Vec<f64> {
        let at_sample = |(at, screening): (&[(u32, f64); 8], &f64)| {
            screening * at.iter().map(|&(node, weight)| weight * values[node as usize]).sum::<f64>()
        };
        let pulls: Vec<f64> = self.at_samples.par_iter().zip(&self.screening).map(at_sample).collect();
        (0..values.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|i| {
                let around: f64 = self.neighbors[i].iter().filter_map(|&neighbor| values.get(neighbor as usize)).sum();
                let pull: f64 = self.samples_of(i).iter().map(|&(s, weight)| weight * pulls[s as usize]).sum();
                self.counted[i] * values[i] - around + pull
            })
            .collect()
    }
}

/// What the coarser levels give a node of the next one.
fn coarser_of(coarser: &[GridLevel], node: [i64; 3]) -> f64 {
    coarser_value(coarser, coarser.len(), node)
}

/// Sum of products, in an order that does not depend on threads.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let sums: Vec<f64> =
        a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a * b).sum()).collect();
    sums.iter().sum()
}

/// The nodes before and after each along each axis.
fn neighbors(keys: &[u64]) -> Vec<[u32; 6]> {
    let mut neighbors = vec![[NONE; 6]; keys.len()];
    for axis in 0..3 {
        let mut step = [0; 3];
        step[axis] = 1;
        let step = key(step);
        let mut next = 0;
        for (i, &from) in keys.iter().enumerate() {
            while keys.get(next).is_some_and(|&to| to < from + step) {
                next += 1;
            }
            if keys.get(next) == Some(&(from + step)) {
                neighbors[i][2 * axis + 1] = to_row(next);
                neighbors[next][2 * axis] = to_row(i);
            }
        }
    }
    neighbors
}

/// The samples at each node: where its part begins, and all parts.
fn by_node(at_samples: &[[(u32, f64); 8]], count: usize) -> (Vec<u32>, Vec<(u32, f64)>) {
    let mut starts = vec![0_u32; count + 1];
    for &(node, _) in at_samples.as_flattened() {
        starts[node as usize + 1] += 1;
    }
    for i in 0..count {
        starts[i + 1] += starts[i];
    }
    let mut free = starts.clone();
    let mut of_node = vec![(0, 0.0); at_samples.len() * 8];
    for (sample, at) in (0..).zip(at_samples) {
        for &(node, weight) in at {
            of_node[free[node as usize] as usize] = (sample, weight);
            free[node as usize] += 1;
        }
    }
    (starts, of_node)
}
