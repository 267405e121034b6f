//! Flags the cells of a grid that lie near a return of the survey. In a hole of the survey nothing is known.

use super::MapGrid;
use belvedere_data::cast::to_index;
use rayon::prelude::*;

/// Default greatest distance on the map from the middle of a cell to the nearest return, metres. Occlusion beside
/// buildings and sparse surveys stay below it; a missing tile and wide water do not.
pub const MAX_GAP_FROM_RETURNS: f64 = 5.0;

/// Side of the squares that settle most cells at once, for a distance of 1. Their diagonal is shorter than that, so
/// that a return is near to all of its square.
const SQUARE: f64 = 0.7;
/// Squares from that of a return to the farthest that holds a place within the distance.
const AROUND: usize = 2;

/// For each cell of `grid`, whether its middle lies within `distance` metres, above 0, of any of the `returns` on the
/// map, local metres, (cells). Returns that are not finite are near to nothing.
///
/// Only returns near squares without any are compared with cells one by one.
pub fn cells_near_returns(returns: impl Iterator<Item = [f64; 2]> + Clone, grid: &MapGrid, distance: f64) -> Vec<bool> {
    let mut near = vec![false; grid.len()];
    let side = SQUARE * distance;
    // of larger cells a return is near to a few at most
    let squares = (grid.cell < side).then(|| Squares::new(returns.clone(), grid, side));
    if let Some(squares) = &squares {
        near.par_chunks_mut(grid.width.max(1)).enumerate().for_each(|(row, near)| {
            for (column, near) in near.iter_mut().enumerate() {
                *near = squares.hold_a_return(grid.center(column, row));
            }
        });
    }
    for place in returns {
        if squares.as_ref().is_none_or(|squares| squares.are_open_around(place)) {
            mark(place, grid, distance, &mut near);
        }
    }
    near
}

/// Marks the cells whose middles lie within a distance of a place.
fn mark([x, y]: [f64; 2], grid: &MapGrid, distance: f64, near: &mut [bool]) {
    let (east, south) = ((x - grid.corner[0]) / grid.cell, (grid.corner[1] - y) / grid.cell);
    let reach = distance / grid.cell;
    let cells = |middle: f64, count: usize| {
        let end = |value: f64| to_index(value.clamp(0.0, count as f64));
        // a cell more on either side than rounding can need
        end((middle - reach - 1.5).floor())..end((middle + reach + 1.5).ceil())
    };
    for row in cells(south, grid.height) {
        for column in cells(east, grid.width) {
            let [center_x, center_y] = grid.center(column, row);
            if (center_x - x).powi(2) + (center_y - y).powi(2) <= distance * distance
                && let Some(near) = near.get_mut(row * grid.width + column)
            {
                *near = true;
            }
        }
    }
}

/// Squares over a grid, and two more on each side.
struct Squares {
    squares: MapGrid,
    /// True for squares that hold a return.
    are_filled: Vec<bool>,
    /// True for squares with an empty square over the grid at most two squares away.
    are_open_around: Vec<bool>,
}

impl Squares {
    fn new(returns: impl Iterator<Item = [f64; 2]>, grid: &MapGrid, side: f64) -> Self {
        let across = |count: usize| to_index((count as f64 * grid.cell / side).ceil()) + 2 * AROUND;
        let beside = AROUND as f64 * side;
        let corner = [grid.corner[0] - beside, grid.corner[1] + beside];
        let squares = MapGrid { corner, cell: side, width: across(grid.width), height: across(grid.height) };
        let none = vec![false; squares.len()];
        let mut found = Self { squares, are_filled: none.clone(), are_open_around: none };
        for place in returns {
            if let Some(square) = found.square_of(place) {
                found.are_filled[square] = true;
            }
        }
        let (width, height) = (squares.width, squares.height);
        for row in AROUND..height - AROUND {
            for column in AROUND..width - AROUND {
                if found.are_filled[row * width + column] {
                    continue;
                }
                for near in row - AROUND..=row + AROUND {
                    let first = near * width + column - AROUND;
                    found.are_open_around[first..=first + 2 * AROUND].fill(true);
                }
            }
        }
        found
    }

    /// The number of the square that holds a place.
    fn square_of(&self, place: [f64; 2]) -> Option<usize> {
        self.squares.cell_of(place).map(|[column, row]| row * self.squares.width + column)
    }

    fn hold_a_return(&self, place: [f64; 2]) -> bool {
        self.square_of(place).is_some_and(|square| self.are_filled[square])
    }

    fn are_open_around(&self, place: [f64; 2]) -> bool {
        self.square_of(place).is_some_and(|square| self.are_open_around[square])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::random::uniform;

    #[test]
    fn cells_near_returns_are_those_of_brute_force() {
        // dense in the west, single returns in the east, and some beside the grid
        let returns: Vec<[f64; 2]> = (0..3000)
            .map(|i| {
                let [u, v] = [uniform(5, 2 * i), uniform(5, 2 * i + 1)];
                if i % 100 == 0 { [90.0 * u - 10.0, 70.0 * v - 10.0] } else { [30.0 * u * v, 50.0 * v] }
            })
            .collect();
        for (cell, distance) in [(0.5, 5.0), (1.3, 2.0), (4.0, 5.0), (7.0, 5.0), (20.0, 5.0), (0.4, 30.0)] {
            let grid = MapGrid::covering([0.0; 2], [70.0, 50.0], cell, [0.3, 0.1]).unwrap();
            let near = cells_near_returns(returns.iter().copied(), &grid, distance);
            for row in 0..grid.height {
                for column in 0..grid.width {
                    let [x, y] = grid.center(column, row);
                    let expected =
                        returns.iter().any(|[a, b]| (a - x).powi(2) + (b - y).powi(2) <= distance * distance);
                    assert_eq!(near[row * grid.width + column], expected, "{cell} {distance}: {x} {y}");
                }
            }
            assert!(cells_near_returns(std::iter::empty(), &grid, distance).iter().all(|near| !near));
        }
    }
}
