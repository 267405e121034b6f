//! Points sorted by the cell of a uniform grid that each lies in.

use belvedere_data::cast::to_i64;
use std::ops::ControlFlow;

use rayon::prelude::*;

/// Bits of a cell number per axis. Cells that are two million apart share a key, which costs a comparison of distances
/// and nothing else; thus one point far away does not matter.
const AXIS_BITS: u32 = 21;
const AXIS_MASK: i64 = (1 << AXIS_BITS) - 1;

/// Indices of points sorted by cell, 16 bytes each.
pub(super) struct SortedGrid {
    cell_size: f64,
    entries: Vec<(u64, u32)>,
}

impl SortedGrid {
    /// Grid of the points at `indices` (each in range), cells of `cell_size` metres.
    pub(super) fn new(positions: &[[f32; 3]], indices: &[u32], cell_size: f64) -> Self {
        let mut entries: Vec<(u64, u32)> =
            indices.par_iter().map(|&i| (key(positions[i as usize].map(|v| cell(v.into(), cell_size))), i)).collect();
        entries.par_sort_unstable();
        Self { cell_size, entries }
    }

    /// Calls `visit` with every point that may lie within `radius` of `position`, each once, until it breaks. The
    /// points come by row of cells; callers check the distance.
    pub(super) fn visit_near(
        &self,
        position: [f32; 3],
        radius: f64,
        visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.visit_within(position, [radius; 3], visit)
    }

    /// Calls `visit` with every point that may lie in the box of these half sides about `position`, as
    /// [`Self::visit_near`] does. A high box costs no more than the points in it.
    pub(super) fn visit_within(
        &self,
        position: [f32; 3],
        half_sides: [f64; 3],
        mut visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let bound = |sign: f64| -> [i64; 3] {
            std::array::from_fn(|axis| cell(f64::from(position[axis]) + sign * half_sides[axis], self.cell_size))
        };
        let (low, high) = (bound(-1.0), bound(1.0));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                let mut z = low[2];
                while z <= high[2] {
                    // cells above each other are neighbours in the order of keys, up to where the numbers wrap
                    let row_end = high[2].min(z | AXIS_MASK);
                    let (first, last) = (key([x, y, z]), key([x, y, row_end]));
                    let start = self.entries.partition_point(|entry| entry.0 < first);
                    for &(_, index) in self.entries[start..].iter().take_while(|entry| entry.0 <= last) {
                        visit(index)?;
                    }
                    z = row_end + 1;
                }
            }
        }
        ControlFlow::Continue(())
    }
}

/// Squared distance of two local positions, m².
pub(super) fn squared_distance(a: [f32; 3], b: [f32; 3]) -> f64 {
    (0..3).map(|i| (f64::from(a[i]) - f64::from(b[i])).powi(2)).sum()
}

fn cell(coordinate: f64, cell_size: f64) -> i64 {
    // clear of the ends of i64, so that the next cell always exists
    to_i64((coordinate / cell_size).floor()).clamp(i64::MIN / 4, i64::MAX / 4)
}

fn key(cell: [i64; 3]) -> u64 {
    cell.iter().fold(0, |key, &c| key << AXIS_BITS | (c & AXIS_MASK).unsigned_abs())
}
