//! Grids of square cells on the map.

use belvedere_data::cast::to_index;
use belvedere_data::{Error, Parameter, Result};

/// Maximum number of cells of a grid: a few bytes each still fit into the memory of a usual machine.
const MAX_CELLS: f64 = 1e8;
/// Cells up to this side may be larger than the area that they divide, metres: a small area still is one cell.
const MIN_SIDE: f64 = 100.0;

/// Share of a cell by which a place may lie beyond an edge of a grid and still count as on it: local coordinates are
/// rounded to f32.
const ON_EDGE: f64 = 1e-3;

/// Square cells on the map, rows from the north, columns from the west. A cell holds its west and south edges, not its
/// east and north ones, so that each place lies in one cell and the grids of adjoining areas share none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapGrid {
    /// West and north edge, local metres.
    pub corner: [f64; 2],
    /// Side of a cell, metres.
    pub cell: f64,
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
}

impl MapGrid {
    /// Creates the grid over the box in plan from `low` to `high`, local metres. Its edges lie at whole multiples of
    /// `cell` metres from the zero of `origin`, metres, so that grids of neighbouring surveys fit together. A box that
    /// ends at such a multiple gets no cells beyond it, so that adjoining boxes share no cell. A box without an extent
    /// gets one cell.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a cell that is not above zero or longer than the box and than 100 m, a box that
    /// is not finite, and more than 100 million cells.
    pub fn covering(low: [f64; 2], high: [f64; 2], cell: f64, origin: [f64; 2]) -> Result<Self> {
        let invalid = |parameter, value: String, expected| Err(Error::invalid(parameter, value, expected));
        if !(cell.is_finite() && cell > 0.0) {
            return invalid(Parameter::Cell, cell.to_string(), "above zero metres");
        }
        if !low.iter().chain(&high).all(|v| v.is_finite()) || low[0] > high[0] || low[1] > high[1] {
            return invalid(Parameter::GridBox, format!("{low:?} to {high:?}"), "finite");
        }
        let side = (high[0] - low[0]).max(high[1] - low[1]);
        if cell > side.max(MIN_SIDE) {
            return invalid(Parameter::Cell, format!("{cell} m"), "at most as long as the area that it divides");
        }
        let edge = |local: f64, origin: f64, outward: fn(f64) -> f64| {
            let position = (local + origin) / cell;
            let rounding = (local.abs() * f64::from(f32::EPSILON) / cell).min(ON_EDGE);
            if (position - position.round()).abs() <= rounding { position.round() } else { outward(position) }
        };
        let [west, south] = [0, 1].map(|axis| edge(low[axis], origin[axis], f64::floor));
        let east = edge(high[0], origin[0], f64::ceil).max(west + 1.0);
        let north = edge(high[1], origin[1], f64::ceil).max(south + 1.0);
        let (columns, rows) = (east - west, north - south);
        if !(columns * rows <= MAX_CELLS) {
            return invalid(
                Parameter::Cell,
                format!("{cell} m, which makes {columns} x {rows} cells"),
                "large enough for at most 100 million cells",
            );
        }
        let (width, height) = (to_index(columns), to_index(rows));
        Ok(Self { corner: [west * cell - origin[0], north * cell - origin[1]], cell, width, height })
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Returns true if there is no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Middle of a cell, local metres.
    #[must_use]
    pub fn center(&self, column: usize, row: usize) -> [f64; 2] {
        [self.corner[0] + (column as f64 + 0.5) * self.cell, self.corner[1] - (row as f64 + 0.5) * self.cell]
    }

    /// Returns the position of a corner of cells, given in whole columns from the west and rows from the north, local
    /// metres.
    #[must_use]
    pub fn corner_at(&self, [column, row]: [usize; 2]) -> [f64; 2] {
        [self.corner[0] + column as f64 * self.cell, self.corner[1] - row as f64 * self.cell]
    }

    /// Returns a local position in columns from the west and rows from the north, with fractions. `None` outside the
    /// grid; its outer edges are inside, so that interpolation between cells has a value on them.
    #[must_use]
    pub fn cell_position(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let on_axis = |position: f64, count: usize| {
            let last = count as f64;
            (-ON_EDGE..=last + ON_EDGE).contains(&position).then(|| position.clamp(0.0, last))
        };
        let column = on_axis((x - self.corner[0]) / self.cell, self.width)?;
        let row = on_axis((self.corner[1] - y) / self.cell, self.height)?;
        Some([column, row])
    }

    /// Column and row of the cell that holds a local position; `None` outside, and on the east and north edges of the
    /// grid, which belong to the cells beyond.
    #[must_use]
    pub fn cell_of(&self, position: [f64; 2]) -> Option<[usize; 2]> {
        let [column, row] = self.cell_position(position)?;
        if column > self.width as f64 - ON_EDGE || row < ON_EDGE {
            return None;
        }
        // rows count from the north: a row holds the edge at its end
        Some([to_index(column), to_index(row.ceil() - 1.0)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adjoining_tiles_share_no_cell() {
        // the edge of two tiles at a whole number of cells, which f32 rounds either way
        for (cell, edge) in [(0.5, 60.5_f32), (1.0, 33.0), (0.1, 60.3), (0.1, 60.7), (0.3, 30.3)] {
            let (edge, origin) = (f64::from(edge), [154_999.0, 463_000.0]);
            let origin = if cell == 0.3 { [0.0; 2] } else { origin };
            let west = MapGrid::covering([-10.0, -10.0], [edge, edge], cell, origin).unwrap();
            let east = MapGrid::covering([edge, -10.0], [90.0, edge], cell, origin).unwrap();
            let north = MapGrid::covering([-10.0, edge], [edge, 90.0], cell, origin).unwrap();
            let end = west.corner_at([west.width, west.height]);
            assert!((end[0] - east.corner[0]).abs() < 1e-6, "{cell} {edge}");
            let low = north.corner_at([north.width, north.height]);
            assert!((west.corner[1] - low[1]).abs() < 1e-6, "{cell} {edge}");
            // a point on the shared edges is in one tile only
            assert_eq!((west.cell_of([edge, 0.0]), east.cell_of([edge, 0.0]).unwrap()[0]), (None, 0));
            assert_eq!((west.cell_of([0.0, edge]), north.cell_of([0.0, edge]).unwrap()[1]), (None, north.height - 1));
        }
    }

    #[test]
    fn a_cell_holds_its_west_and_south_edges_and_the_grid_ends_with_the_box() {
        let grid = MapGrid::covering([0.0; 2], [3.0, 2.0], 1.0, [0.0; 2]).unwrap();
        assert_eq!((grid.width, grid.height, grid.corner), (3, 2, [0.0, 2.0]));
        assert_eq!(
            [[0.0, 0.0], [1.0, 1.0], [2.9, 1.9]].map(|place| grid.cell_of(place).unwrap()),
            [[0, 1], [1, 0], [2, 0]]
        );
        assert_eq!([[3.0, 1.0], [1.0, 2.0], [-0.1, 1.0]].map(|place| grid.cell_of(place)), [None; 3]);
        assert_eq!(grid.cell_position([3.0, 2.0]), Some([3.0, 0.0]));
        let point = MapGrid::covering([1.0; 2], [1.0; 2], 1.0, [0.0; 2]).unwrap();
        assert_eq!((point.width, point.height, point.cell_of([1.0; 2])), (1, 1, Some([0, 0])));
    }

    #[test]
    fn edges_lie_at_whole_cells_of_the_map_and_every_point_within_has_a_cell() {
        let origin = [1000.3, 2000.7];
        let grid = MapGrid::covering([-1.0, -2.0], [3.0, 2.0], 0.5, origin).unwrap();
        let west = (grid.corner[0] + origin[0]) / 0.5;
        assert!((west - west.round()).abs() < 1e-9);
        for position in [[-1.0, -2.0], [3.0, 2.0], [0.2, 0.1]] {
            let [column, row] = grid.cell_of(position).unwrap();
            let [x, y] = grid.center(column, row);
            assert!((x - position[0]).abs() <= 0.25 + 1e-9 && (y - position[1]).abs() <= 0.25 + 1e-9);
        }
        assert_eq!(grid.cell_of([9.0, 0.0]), None);
    }

    #[test]
    fn too_many_cells_are_refused_before_they_are_made() {
        for (cell, high) in [(1e-6, 100.0), (0.0, 1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            assert!(MapGrid::covering([0.0; 2], [high; 2], cell, [0.0; 2]).is_err());
        }
    }
}
