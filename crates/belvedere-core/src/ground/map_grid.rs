//! Grids of square cells on the map.

use belvedere_data::{Error, Parameter, Result};

/// Most cells of a grid: what a few bytes each still fit into the memory of a usual machine.
const MOST_CELLS: f64 = 1e8;
/// Cells up to this side may be larger than the area that they divide, metres: a small area still is one cell.
const LEAST_SIDE: f64 = 100.0;

/// Square cells on the map, rows from the north, columns from the west.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapGrid {
    /// West and north rim, local metres.
    pub corner: [f64; 2],
    /// Side of a cell, metres.
    pub cell: f64,
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
}

impl MapGrid {
    /// The grid over the box on the map from `low` to `high`, local metres, whose rims lie at whole multiples of `cell` metres counted
    /// from where `origin`, metres, counts from: grids of neighbouring surveys fit together.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a cell that is not above zero or longer than the box and than 100 m, a box that is not finite, and more than 100 million cells.
    pub fn covering(low: [f64; 2], high: [f64; 2], cell: f64, origin: [f64; 2]) -> Result<Self> {
        let invalid = |parameter, value: String, expected| Err(Error::InvalidParameter { parameter, value, expected });
        if !(cell.is_finite() && cell > 0.0) {
            return invalid(Parameter::Cell, cell.to_string(), "above zero metres");
        }
        if !low.iter().chain(&high).all(|v| v.is_finite()) || low[0] > high[0] || low[1] > high[1] {
            return invalid(Parameter::GridBox, format!("{low:?} to {high:?}"), "finite");
        }
        let side = (high[0] - low[0]).max(high[1] - low[1]);
        if cell > side.max(LEAST_SIDE) {
            return invalid(Parameter::Cell, format!("{cell} m"), "at most as long as the area that it divides");
        }
        let west = ((low[0] + origin[0]) / cell).floor();
        let south = ((low[1] + origin[1]) / cell).floor();
        // a point on the east or north rim has a cell too
        let (east, north) = (
            (((high[0] + origin[0]) / cell).floor() + 1.0).max(west + 1.0),
            (((high[1] + origin[1]) / cell).floor() + 1.0).max(south + 1.0),
        );
        let (columns, rows) = (east - west, north - south);
        if !(columns * rows <= MOST_CELLS) {
            return invalid(
                Parameter::Cell,
                format!("{cell} m, which makes {columns} x {rows} cells"),
                "large enough for at most 100 million cells",
            );
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers up to 1e8")]
        let (width, height) = (columns as usize, rows as usize);
        Ok(Self { corner: [west * cell - origin[0], north * cell - origin[1]], cell, width, height })
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Whether there is no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Middle of a cell, local metres.
    #[must_use]
    pub fn center(&self, column: usize, row: usize) -> [f64; 2] {
        [self.corner[0] + (column as f64 + 0.5) * self.cell, self.corner[1] - (row as f64 + 0.5) * self.cell]
    }

    /// Where a corner of cells lies, in whole columns from the west and rows from the north, local metres.
    #[must_use]
    pub fn corner_at(&self, [column, row]: [usize; 2]) -> [f64; 2] {
        [self.corner[0] + column as f64 * self.cell, self.corner[1] - row as f64 * self.cell]
    }

    /// Where a local position lies, in columns from the west and rows from the north, fractions counted; `None` outside the grid.
    #[must_use]
    pub fn cell_position(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let position = [(x - self.corner[0]) / self.cell, (self.corner[1] - y) / self.cell];
        let inside =
            (0.0..=self.width as f64).contains(&position[0]) && (0.0..=self.height as f64).contains(&position[1]);
        inside.then_some(position)
    }

    /// Column and row of the cell that holds a local position; `None` outside.
    #[must_use]
    pub fn cell_of(&self, position: [f64; 2]) -> Option<[usize; 2]> {
        let [column, row] = self.cell_position(position)?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the grid")]
        let cell = [(column as usize).min(self.width.checked_sub(1)?), (row as usize).min(self.height.checked_sub(1)?)];
        Some(cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rims_lie_at_whole_cells_of_the_map_and_every_point_has_a_cell() {
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
