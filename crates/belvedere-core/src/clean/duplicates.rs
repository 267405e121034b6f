//! Points that repeat another.

use belvedere_data::cast::to_i64;
use std::ops::ControlFlow;

use rayon::prelude::*;

use super::grid::{SortedGrid, squared_distance};
use belvedere_data::Result;
use belvedere_data::control::{Control, Stop};

/// Side of the cells, in multiples of the distance. A point then mostly needs its own cell only, and a heap of points
/// in one cell keeps at most some hundreds of them.
const CELL_PER_DISTANCE: f64 = 8.0;
/// Points looked at between two looks at whether to go on.
const CHUNK: usize = 4096;

/// Leaves out of `kept` (ascending) every point at the position of an earlier one; returns how many. Positive and
/// negative zero are the same.
pub(super) fn drop_exact(positions: &[[f32; 3]], kept: &mut Vec<u32>) -> usize {
    // adding zero turns -0 into 0, so that equal coordinates have equal bits
    let bits = |i: u32| positions[i as usize].map(|v| (v + 0.0).to_bits());
    let mut order = kept.clone();
    order.par_sort_unstable_by_key(|&i| (bits(i), i));
    let mut repeated: Vec<u32> =
        order.par_windows(2).filter(|pair| bits(pair[0]) == bits(pair[1])).map(|pair| pair[1]).collect();
    drop(order);
    repeated.par_sort_unstable();
    remove_sorted(kept, &repeated)
}

/// Leaves out of `kept` (ascending) every point within `distance` metres of an earlier one that stays; returns how
/// many.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(crate) fn drop_near(
    positions: &[[f32; 3]],
    kept: &mut Vec<u32>,
    distance: f64,
    control: &Control<'_>,
) -> Result<usize> {
    let (cell_size, limit) = (distance * CELL_PER_DISTANCE, distance * distance);
    let close = |a: u32, b: u32| squared_distance(positions[a as usize], positions[b as usize]) <= limit;
    // which point stays depends on the ones before, but only points with another close by are concerned: few
    let grid = SortedGrid::new(positions, kept, cell_size);
    control.check()?;
    let stop = Stop::new(control);
    let concerned: Vec<u32> = kept
        .par_iter()
        .copied()
        .filter(|&i| {
            !stop.is_set()
                && grid
                    .visit_near(positions[i as usize], distance, |other| {
                        if other != i && close(i, other) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                    })
                    .is_break()
        })
        .collect();
    stop.check()?;
    drop(grid);
    let mut staying = StayingPoints::new(positions, &concerned, cell_size);
    let mut repeated: Vec<u32> = Vec::new();
    for some in concerned.chunks(CHUNK) {
        control.check()?;
        repeated.extend(some.iter().copied().filter(|&i| !staying.admit(positions, i, distance, &close)));
    }
    Ok(remove_sorted(kept, &repeated))
}

/// The points found to stay so far, by cell: each cell has room for all its points and a count of those that stay.
struct StayingPoints {
    cells: Vec<([i64; 3], u32, u32)>,
    slots: Vec<u32>,
    cell_size: f64,
}

impl StayingPoints {
    fn new(positions: &[[f32; 3]], indices: &[u32], cell_size: f64) -> Self {
        let mut numbers: Vec<[i64; 3]> =
            indices.par_iter().map(|&i| cell_of(positions[i as usize].map(f64::from), cell_size)).collect();
        numbers.par_sort_unstable();
        let mut cells: Vec<([i64; 3], u32, u32)> = Vec::new();
        for (start, number) in (0_u32..).zip(numbers) {
            if cells.last().is_none_or(|last| last.0 != number) {
                cells.push((number, start, 0));
            }
        }
        Self { cells, slots: vec![0; indices.len()], cell_size }
    }

    /// Keeps a point if no kept point is close to it, and returns true if it was kept.
    fn admit(&mut self, positions: &[[f32; 3]], index: u32, distance: f64, close: &impl Fn(u32, u32) -> bool) -> bool {
        let p = positions[index as usize].map(f64::from);
        let low = cell_of(p.map(|v| v - distance), self.cell_size);
        let high = cell_of(p.map(|v| v + distance), self.cell_size);
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                let start = self.cells.partition_point(|cell| cell.0 < [x, y, low[2]]);
                for &(_, first, count) in self.cells[start..].iter().take_while(|cell| cell.0 <= [x, y, high[2]]) {
                    let staying = &self.slots[first as usize..(first + count) as usize];
                    if staying.iter().any(|&other| close(index, other)) {
                        return false;
                    }
                }
            }
        }
        let own = cell_of(p, self.cell_size);
        if let Ok(place) = self.cells.binary_search_by(|cell| cell.0.cmp(&own)) {
            let (_, first, count) = &mut self.cells[place];
            self.slots[(*first + *count) as usize] = index;
            *count += 1;
        }
        true
    }
}

fn cell_of(position: [f64; 3], cell_size: f64) -> [i64; 3] {
    position.map(|v| to_i64((v / cell_size).floor()).clamp(i64::MIN / 4, i64::MAX / 4))
}

/// Takes the sorted indices `gone` out of the sorted `kept`; returns how many they are.
pub(super) fn remove_sorted(kept: &mut Vec<u32>, gone: &[u32]) -> usize {
    let mut next = gone.iter().peekable();
    kept.retain(|i| next.next_if(|&&leaving| leaving == *i).is_none());
    gone.len()
}
