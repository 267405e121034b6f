//! Heights of terrain on a grid, such as those of an elevation raster around a cloud.

use crate::cast::to_index;
use crate::raster::Raster;
use crate::{Error, Parameter, Result};

/// Heights at the nodes of a grid along the axes of a frame, and between four neighbouring nodes bilinearly.
#[derive(Clone, Debug, PartialEq)]
pub struct ElevationGrid {
    heights: Raster<f32>,
    north_west: [f64; 2],
    cell: [f64; 2],
}

impl ElevationGrid {
    /// The grid of `heights`, local metres, rows from the north, NaN where nothing is known. The first height is that
    /// at `north_west`, local metres; columns lie `cell[0]` metres apart to the east and rows `cell[1]` to the south.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for fewer than 2 x 2 heights, none that is known, a cell that is not above zero, or
    /// a place that is not finite.
    pub fn new(mut heights: Raster<f32>, north_west: [f64; 2], cell: [f64; 2]) -> Result<Self> {
        let invalid = |parameter, value: String, expected| Err(Error::invalid(parameter, value, expected));
        let (width, height) = (heights.width(), heights.height());
        if width < 2 || height < 2 {
            return invalid(Parameter::Terrain, format!("{width} x {height} cells"), "at least 2 x 2 cells");
        }
        if !cell.iter().all(|side| side.is_finite() && *side > 0.0) || !north_west.iter().all(|v| v.is_finite()) {
            let value = format!("cells of {cell:?} m from {north_west:?} m on");
            return invalid(Parameter::Terrain, value, "of cells above zero, at a finite place");
        }
        heights.values_mut().iter_mut().filter(|v| !v.is_finite()).for_each(|v| *v = f32::NAN);
        if heights.values().iter().all(|v| v.is_nan()) {
            return invalid(
                Parameter::Terrain,
                "without a height".to_owned(),
                "a raster in which some cells have values",
            );
        }
        Ok(Self { heights, north_west, cell })
    }

    /// Heights of the nodes, local metres, rows from the north; NaN where nothing is known.
    #[must_use]
    pub fn heights(&self) -> &Raster<f32> {
        &self.heights
    }

    /// Local position of the first node on the map.
    #[must_use]
    pub fn north_west(&self) -> [f64; 2] {
        self.north_west
    }

    /// Distances of columns and of rows, metres.
    #[must_use]
    pub fn cell(&self) -> [f64; 2] {
        self.cell
    }

    /// Lowest and highest corner on the map, local metres: where the outermost nodes lie.
    #[must_use]
    pub fn on_map(&self) -> ([f64; 2], [f64; 2]) {
        let [west, north] = self.north_west;
        let east = west + (self.heights.width() - 1) as f64 * self.cell[0];
        let south = north - (self.heights.height() - 1) as f64 * self.cell[1];
        ([west, south], [east, north])
    }

    /// Number of nodes without a height.
    #[must_use]
    pub fn unknown_count(&self) -> usize {
        self.heights.values().iter().filter(|v| v.is_nan()).count()
    }

    /// Returns the position of a node, local metres; `None` for one without a height.
    #[must_use]
    pub fn node(&self, column: usize, row: usize) -> Option<[f64; 3]> {
        let height = self.heights.get(column, row).filter(|height| !height.is_nan())?;
        let [west, north] = self.north_west;
        Some([west + column as f64 * self.cell[0], north - row as f64 * self.cell[1], f64::from(height)])
    }

    /// Returns the height at a place in plan, both local metres, bilinear between the four nodes around it. `None`
    /// beyond the outermost nodes, and if one of the four is not known.
    #[must_use]
    pub fn height_at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let [west, north] = self.north_west;
        let across = [(x - west) / self.cell[0], (north - y) / self.cell[1]];
        let last = [self.heights.width() - 1, self.heights.height() - 1];
        if !(0..2).all(|axis| (0.0..=last[axis] as f64).contains(&across[axis])) {
            return None;
        }
        let [column, row] = [0, 1].map(|axis| to_index(across[axis]).min(last[axis] - 1));
        let [u, v] = [across[0] - column as f64, across[1] - row as f64];
        let node = |right: usize, down: usize| self.heights.get(column + right, row + down).map_or(f64::NAN, f64::from);
        let upper = (1.0 - u) * node(0, 0) + u * node(1, 0);
        let lower = (1.0 - u) * node(0, 1) + u * node(1, 1);
        Some((1.0 - v) * upper + v * lower).filter(|height| !height.is_nan())
    }

    /// The nodes within a box on the map, local metres; `None` where it holds fewer than 2 x 2, or none with a height.
    #[must_use]
    pub fn part(&self, within: ([f64; 2], [f64; 2])) -> Option<Self> {
        let [columns, rows] = self.nodes_within(within)?;
        let row = |row: usize| columns.clone().filter_map(move |column| self.heights.get(column, row));
        let heights = Raster::from_values(columns.len(), rows.len(), rows.clone().flat_map(row).collect()).ok()?;
        let [west, north] = self.north_west;
        let first = [west + columns.start as f64 * self.cell[0], north - rows.start as f64 * self.cell[1]];
        Self::new(heights, first, self.cell).ok()
    }

    /// Columns and rows of the nodes within a box on the map, local metres, if there are any.
    fn nodes_within(&self, (low, high): ([f64; 2], [f64; 2])) -> Option<[std::ops::Range<usize>; 2]> {
        let [west, north] = self.north_west;
        let (width, height) = (self.heights.width(), self.heights.height());
        Some([
            nodes_between((low[0] - west) / self.cell[0], (high[0] - west) / self.cell[0], width)?,
            nodes_between((north - high[1]) / self.cell[1], (north - low[1]) / self.cell[1], height)?,
        ])
    }

    /// Lowest and highest height of the nodes within a box on the map, local metres; `None` where it holds no node with
    /// a height.
    #[must_use]
    pub fn height_range(&self, within: ([f64; 2], [f64; 2])) -> Option<[f32; 2]> {
        let [columns, rows] = self.nodes_within(within)?;
        let known = rows.flat_map(|row| columns.clone().filter_map(move |column| self.heights.get(column, row)));
        let known = known.filter(|v| !v.is_nan());
        known.fold(None, |range: Option<[f32; 2]>, v| {
            Some(range.map_or([v, v], |[low, high]| [low.min(v), high.max(v)]))
        })
    }
}

/// The whole numbers from `from` to `to` below `count`, if there are any.
fn nodes_between(from: f64, to: f64, count: usize) -> Option<std::ops::Range<usize>> {
    let (first, end) = (from.ceil().max(0.0), (to.floor() + 1.0).min(count as f64));
    (first < end).then_some(to_index(first)..to_index(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_knows_where_its_nodes_lie_and_what_is_around_them() {
        let heights = Raster::from_values(3, 2, vec![1.0, 2.0, 3.0, 4.0, f32::INFINITY, 6.0]).unwrap();
        let grid = ElevationGrid::new(heights, [10.0, 50.0], [5.0, 20.0]).unwrap();
        assert_eq!(grid.on_map(), ([10.0, 30.0], [20.0, 50.0]));
        assert_eq!(grid.unknown_count(), 1);
        assert_eq!(grid.height_range(([0.0, 0.0], [99.0, 99.0])), Some([1.0, 6.0]));
        assert_eq!(grid.height_range(([14.0, 29.0], [20.0, 31.0])), Some([6.0, 6.0]));
        assert_eq!(grid.height_range(([14.0, 29.0], [16.0, 31.0])), None);
        assert_eq!((grid.node(1, 1), grid.node(2, 1)), (None, Some([20.0, 30.0, 6.0])));
        let whole = Raster::from_values(3, 2, vec![1.0, 2.0, 4.0, 3.0, 8.0, f32::NAN]).unwrap();
        let whole = ElevationGrid::new(whole, [10.0, 50.0], [5.0, 20.0]).unwrap();
        assert_eq!([[10.0, 50.0], [10.0, 30.0]].map(|place| whole.height_at(place)), [Some(1.0), Some(3.0)]);
        assert_eq!(whole.height_at([12.5, 45.0]), Some(1.5 * 0.75 + 5.5 * 0.25));
        for outside in [[9.9, 40.0], [16.0, 40.0], [12.0, 29.9], [12.0, f64::NAN], [20.1, 50.0], [15.0, 30.0]] {
            assert_eq!(whole.height_at(outside), None, "{outside:?}");
        }
        let part = grid.part(([14.0, 0.0], [21.0, 60.0])).unwrap();
        assert_eq!((part.north_west(), part.heights().width(), part.node(0, 0)), ([15.0, 50.0], 2, grid.node(1, 0)));
        assert_eq!((grid.part(([14.0, 0.0], [16.0, 60.0])), grid.part(([50.0; 2], [60.0; 2]))), (None, None));
        for outside in [([-9.0, -9.0], [9.0, 99.0]), ([21.0, -9.0], [99.0, 99.0]), ([11.0, 31.0], [14.0, 49.0])] {
            assert_eq!(grid.height_range(outside), None, "{outside:?}");
        }
        let raster = |width, values: &[f32]| Raster::from_values(width, values.len() / width, values.to_vec()).unwrap();
        for (heights, cell) in [
            (raster(1, &[1.0, 2.0]), [1.0; 2]),
            (raster(2, &[f32::NAN; 4]), [1.0; 2]),
            (raster(2, &[1.0; 4]), [0.0, 1.0]),
        ] {
            assert!(ElevationGrid::new(heights, [0.0; 2], cell).is_err());
        }
    }
}
