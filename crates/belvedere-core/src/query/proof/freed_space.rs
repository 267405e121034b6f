//! Space that is free because its objects were cleared.

use super::clip;
use crate::ground::MapGrid;
use crate::ray_index::Ray;
use belvedere_data::raster::Raster;

/// Columns of space, each free up to a height.
#[derive(Clone, Debug)]
pub struct FreedSpace {
    grid: MapGrid,
    /// Height up to which a column is free, local metres; NaN for one that is not.
    tops: Raster<f32>,
    highest: f64,
}

impl FreedSpace {
    /// The columns over the cells of `grid` that have a height in `tops`; `None` where no cell has.
    #[must_use]
    pub fn new(grid: MapGrid, tops: Raster<f32>) -> Option<Self> {
        let heights = tops.values().iter().filter(|top| top.is_finite());
        let highest = heights.fold(f64::NEG_INFINITY, |max, top| max.max(f64::from(*top)));
        highest.is_finite().then_some(Self { grid, tops, highest })
    }

    /// Appends the parts of `piece`, from and to along the line of `ray`, that lie outside.
    fn cut(&self, ray: &Ray, piece: [f64; 2], outside: &mut Vec<[f64; 2]>) {
        let Ray { origin, direction, .. } = *ray;
        let grid = &self.grid;
        let size = [grid.width as f64 * grid.cell, grid.height as f64 * grid.cell];
        let low = [grid.corner[0], grid.corner[1] - size[1]];
        let mut within = piece;
        for axis in 0..2 {
            clip(&mut within, origin[axis], direction[axis], [low[axis], low[axis] + size[axis]]);
        }
        clip(&mut within, origin[2], direction[2], [f64::NEG_INFINITY, self.highest]);
        if !(within[0] < within[1] && within[1].is_finite() && within[0].is_finite()) {
            outside.push(piece);
            return;
        }
        // where the line passes from cell to cell
        let mut stops = vec![within[0], within[1]];
        for axis in (0..2).filter(|&axis| direction[axis] != 0.0) {
            let cells = within.map(|at| (origin[axis] + at * direction[axis] - low[axis]) / grid.cell);
            let (first, last) = (cells[0].min(cells[1]).ceil(), cells[0].max(cells[1]).floor());
            let mut side = first;
            while side <= last {
                stops.push((low[axis] + side * grid.cell - origin[axis]) / direction[axis]);
                side += 1.0;
            }
        }
        stops.sort_by(f64::total_cmp);
        let mut from = piece[0];
        for pair in stops.windows(2) {
            let middle = ray.at(f64::midpoint(pair[0], pair[1]));
            let cell = grid.cell_of([middle[0], middle[1]]);
            let top = cell.and_then(|[column, row]| self.tops.get(column, row)).filter(|top| top.is_finite());
            let Some(top) = top else { continue };
            let mut free = [pair[0].max(piece[0]), pair[1].min(piece[1])];
            clip(&mut free, origin[2], direction[2], [f64::NEG_INFINITY, f64::from(top)]);
            if free[0] < free[1] {
                if free[0] > from {
                    outside.push([from, free[0]]);
                }
                from = from.max(free[1]);
            }
        }
        if from < piece[1] {
            outside.push([from, piece[1]]);
        }
    }
}

/// The parts of a line that lie outside all of `spaces`: from and to.
pub(in crate::query) fn pieces_outside(spaces: &[FreedSpace], ray: &Ray) -> Vec<[f64; 2]> {
    spaces.iter().fold(vec![ray.ranges], |pieces, space| {
        let mut outside = Vec::with_capacity(pieces.len() + 1);
        pieces.into_iter().for_each(|piece| space.cut(ray, piece, &mut outside));
        outside
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_where_they_run_through_columns_below_their_tops() {
        let grid = MapGrid { corner: [0.0, 4.0], cell: 1.0, width: 4, height: 4 };
        let mut tops = Raster::filled(4, 4, f32::NAN);
        for (column, row) in [(1, 2), (2, 2)] {
            tops.values_mut()[row * 4 + column] = 5.0;
        }
        let space = [FreedSpace::new(grid, tops).unwrap()];
        let cut = |origin: [f64; 3], direction: [f64; 3], end: f64| {
            pieces_outside(&space, &Ray { origin, direction, ranges: [0.0, end] })
        };
        assert_eq!(cut([-2.0, 1.5, 3.0], [1.0, 0.0, 0.0], 10.0), [[0.0, 3.0], [5.0, 10.0]]);
        assert_eq!(cut([-2.0, 1.5, 5.5], [1.0, 0.0, 0.0], 10.0), [[0.0, 10.0]]);
        assert_eq!(cut([-2.0, 0.5, 3.0], [1.0, 0.0, 0.0], 10.0), [[0.0, 10.0]]);
        assert_eq!(cut([1.5, 1.5, 3.0], [0.0, 0.0, 1.0], f64::INFINITY), [[2.0, f64::INFINITY]]);
        // rising through the top of the second cell
        assert_eq!(cut([0.0, 1.5, 3.0], [0.8, 0.0, 0.6], f64::INFINITY)[..1], [[0.0, 1.25]]);
        let rising = cut([0.0, 1.5, 3.0], [0.8, 0.0, 0.6], f64::INFINITY);
        assert!((rising[1][0] - 2.0 / 0.6).abs() < 1e-12 && rising[1][1] == f64::INFINITY);
        assert_eq!(cut([2.5, 1.5, 3.0], [0.0, -1.0, 0.0], 0.4), Vec::<[f64; 2]>::new());
    }
}
