//! Values on a horizontal grid of which few cells are occupied.

use belvedere_data::cast::to_cell;
use rayon::prelude::*;

/// Side of a cell, metres: two to three times the spacing of usual airborne scans, so that few cells among roofs and
/// trees are empty.
const SIDE_M: f64 = 1.0;

/// Row and column of a cell.
pub(super) type Cell = (i32, i32);

/// The cell that a local position lies in.
pub(super) fn cell(position: [f32; 3]) -> Cell {
    let number = |v: f32| to_cell(f64::from(v) / SIDE_M);
    (number(position[1]), number(position[0]))
}

/// A value for each occupied cell, sorted by cell.
pub(super) struct Cells<V> {
    cells: Vec<(Cell, V)>,
}

impl<V: Copy + Send + Sync> Cells<V> {
    /// Gathers `entries` with `merge`, whose result must not depend on the order of its arguments.
    pub(super) fn new(mut entries: Vec<(Cell, V)>, merge: impl Fn(V, V) -> V) -> Self {
        entries.par_sort_unstable_by_key(|entry| entry.0);
        entries.dedup_by(|later, earlier| {
            let same = later.0 == earlier.0;
            if same {
                earlier.1 = merge(earlier.1, later.1);
            }
            same
        });
        entries.shrink_to_fit();
        Self { cells: entries }
    }

    /// The occupied cells and their values.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Cell, V)> {
        self.cells.iter().copied()
    }

    /// The value of a cell, `None` where it is empty.
    pub(super) fn get(&self, cell: Cell) -> Option<V> {
        let place = self.cells.binary_search_by_key(&cell, |entry| entry.0).ok()?;
        self.cells.get(place).map(|entry| entry.1)
    }

    /// The values of all cells from the one with the least row and column to the one with the greatest, merged; `None`
    /// where all are empty.
    pub(super) fn in_rectangle(&self, low: Cell, high: Cell, merge: impl Fn(V, V) -> V) -> Option<V> {
        let of_row = |row: i32| {
            let start = self.cells.partition_point(|entry| entry.0 < (row, low.1));
            self.cells.iter().skip(start).take_while(move |entry| entry.0 <= (row, high.1)).map(|entry| entry.1)
        };
        (low.0..=high.0).flat_map(of_row).reduce(merge)
    }

    /// Calls `visit` with each empty cell from the one with the least row and column to the one with the greatest.
    pub(super) fn empty_in_rectangle(&self, low: Cell, high: Cell, mut visit: impl FnMut(Cell)) {
        for row in low.0..=high.0 {
            let start = self.cells.partition_point(|entry| entry.0 < (row, low.1));
            let mut held = self.cells.iter().skip(start).map(|entry| entry.0).peekable();
            for cell in (low.1..=high.1).map(|column| (row, column)) {
                if held.next_if_eq(&cell).is_none() {
                    visit(cell);
                }
            }
        }
    }

    /// All values merged, `None` without any.
    pub(super) fn all(&self, merge: impl Fn(V, V) -> V) -> Option<V> {
        self.cells.iter().map(|entry| entry.1).reduce(merge)
    }

    /// For each occupied cell its value merged with those of the eight cells about it.
    pub(super) fn with_neighbors(&self, merge: impl Fn(V, V) -> V + Sync) -> Self {
        let near = |&((row, column), own): &(Cell, V)| {
            let mut value: Option<V> = None;
            for row in row - 1..=row + 1 {
                let start = self.cells.partition_point(|entry| entry.0 < (row, column - 1));
                for entry in self.cells.iter().skip(start).take_while(|entry| entry.0 <= (row, column + 1)) {
                    value = Some(value.map_or(entry.1, |value| merge(value, entry.1)));
                }
            }
            ((row, column), value.unwrap_or(own))
        };
        Self { cells: self.cells.par_iter().map(near).collect() }
    }
}

/// The lowest of `positions`, (N, 3) local metres, in each cell and those about it: the height of the ground, but below
/// large roofs.
pub(super) fn lowest_near(positions: &[[f32; 3]]) -> Cells<f32> {
    Cells::new(positions.par_iter().map(|&p| (cell(p), p[2])).collect(), f32::min).with_neighbors(f32::min)
}

/// The highest of `positions`, (N, 3) local metres, in each cell.
pub(super) fn highest(positions: &[[f32; 3]]) -> Cells<f32> {
    Cells::new(positions.par_iter().map(|&p| (cell(p), p[2])).collect(), f32::max)
}
