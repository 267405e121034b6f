//! Tiles on one grid.

use belvedere::Bounds;
use belvedere::cast::{to_f32s, to_i32, to_i64};
use belvedere::query::BlockedLines;
use serde::{Deserialize, Serialize};

/// Side of the blocks in which the survey counts points and some rules for balls work, metres.
pub(crate) const CELL: f64 = 64.0;
/// Side of the squares on which tops of balls are kept, metres.
pub(crate) const TOP_SIDE: f64 = 16.0;
/// Half-width added to lines of sight, metres. It exceeds the rounding of f32 and the distance of the parallel lines of
/// probabilities.
pub(crate) const LINE_ROOM: f64 = BlockedLines::WIDTH + 0.03;

/// Tile: column and row on the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct TileId {
    /// Row, counted north from the origin of the reference system.
    pub north: i64,
    /// Column, counted east from the origin of the reference system.
    pub east: i64,
}

impl TileId {
    /// Returns the name of the tile in file names.
    #[must_use]
    pub fn name(self) -> String {
        format!("e{}_n{}", self.east, self.north)
    }
}

/// Grid of square tiles in local coordinates, counted from the origin of the reference system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileGrid {
    /// Side of a tile, metres.
    pub size: f64,
    /// Origin of local coordinates, metres east and north.
    pub origin: [f64; 2],
}

/// Rectangle on the map from its lowest to its highest corner, local metres. The lower sides belong to it, the upper
/// sides do not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapArea {
    pub(crate) low: [f64; 2],
    pub(crate) high: [f64; 2],
}

impl TileGrid {
    /// Returns the core of a tile.
    pub(crate) fn core(&self, tile: TileId) -> MapArea {
        let low = [tile.east as f64 * self.size - self.origin[0], tile.north as f64 * self.size - self.origin[1]];
        MapArea { low, high: low.map(|v| v + self.size) }
    }

    /// Returns the tile whose core contains a local position.
    pub(crate) fn tile_of(&self, [x, y]: [f64; 2]) -> TileId {
        let number = |v: f64, axis: usize| to_i64(((v + self.origin[axis]) / self.size).floor());
        TileId { east: number(x, 0), north: number(y, 1) }
    }
}

impl MapArea {
    pub(crate) fn holds(&self, [x, y]: [f64; 2]) -> bool {
        self.low[0] <= x && x < self.high[0] && self.low[1] <= y && y < self.high[1]
    }

    /// Returns the rectangle of a single place.
    pub(crate) fn at([x, y, _]: [f64; 3]) -> Self {
        Self { low: [x, y], high: [x, y] }
    }

    pub(crate) fn corners(&self) -> [[f64; 2]; 4] {
        [self.low, [self.high[0], self.low[1]], [self.low[0], self.high[1]], self.high]
    }

    /// Returns its lowest and highest coordinate along an axis on the map.
    pub(crate) fn span(&self, axis: [f64; 2]) -> [f64; 2] {
        let places = self.corners().map(|[x, y]| x * axis[0] + y * axis[1]);
        [places.into_iter().fold(f64::INFINITY, f64::min), places.into_iter().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Returns the maximum distance on the map between a place of this rectangle and one of `other`, metres.
    pub(crate) fn farthest(&self, other: &Self) -> f64 {
        let side = |axis: usize| (other.high[axis] - self.low[axis]).max(self.high[axis] - other.low[axis]);
        side(0).hypot(side(1))
    }

    /// Returns the smallest rectangle around both.
    pub(crate) fn joined(&self, other: &Self) -> Self {
        let low = [0, 1].map(|axis| self.low[axis].min(other.low[axis]));
        Self { low, high: [0, 1].map(|axis| self.high[axis].max(other.high[axis])) }
    }

    /// Returns the intersection of both; `None` if they do not meet.
    pub(crate) fn common(&self, other: &Self) -> Option<Self> {
        let low = [0, 1].map(|axis| self.low[axis].max(other.low[axis]));
        let high = [0, 1].map(|axis| self.high[axis].min(other.high[axis]));
        self.meets(other).then_some(Self { low, high })
    }

    /// Returns true if both have a place in common.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.low[axis] < other.high[axis] && other.low[axis] < self.high[axis])
    }

    pub(crate) fn widened(&self, by: f64) -> Self {
        Self { low: self.low.map(|v| v - by), high: self.high.map(|v| v + by) }
    }

    /// Returns the rectangle extended to whole blocks of 64 m from the origin of local coordinates.
    pub(crate) fn in_blocks(&self) -> Self {
        Self { low: self.low.map(|v| (v / CELL).floor() * CELL), high: self.high.map(|v| (v / CELL).ceil() * CELL) }
    }

    /// Returns the numbers of the blocks that it meets, east and north.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = [i32; 2]> + use<> {
        let range = |axis: usize| to_i32((self.low[axis] / CELL).floor())..to_i32((self.high[axis] / CELL).ceil());
        let (east, north) = (range(0), range(1));
        north.flat_map(move |north| east.clone().map(move |east| [east, north]))
    }

    /// Returns the distance on the map to a rectangle, metres; 0 if they meet.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let gap = |axis: usize| (other.low[axis] - self.high[axis]).max(self.low[axis] - other.high[axis]).max(0.0);
        gap(0).hypot(gap(1))
    }

    /// Returns the box of all heights over the rectangle.
    pub(crate) fn column(&self) -> Bounds {
        let [low, high] = [self.low, self.high].map(to_f32s);
        let (bottom, top) = (-1e6, 1e6);
        Bounds { low: [low[0], low[1], bottom], high: [high[0], high[1], top] }
    }
}

/// Returns the rectangle of a block of 64 m.
pub(crate) fn block_area(block: [i32; 2]) -> MapArea {
    square_area(block, CELL)
}

/// Returns the number of the block of 64 m that contains a local position.
pub(crate) fn block_of(position: [f32; 2]) -> [i32; 2] {
    square_at(position, CELL)
}

/// Returns the square of side `side` with a number, counted east and north from the origin of local coordinates.
pub(crate) fn square_area(number: [i32; 2], side: f64) -> MapArea {
    let low = number.map(|number| f64::from(number) * side);
    MapArea { low, high: low.map(|v| v + side) }
}

/// Returns the number of the square of side `side` that contains a local position.
pub(crate) fn square_at(position: [f32; 2], side: f64) -> [i32; 2] {
    position.map(|v| to_i32((f64::from(v) / side).floor()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_has_one_tile_and_edges_belong_to_the_upper_one() {
        let grid = TileGrid { size: 75.0, origin: [154_624.0, 463_872.0] };
        for place in [[0.0, 0.0], [-300.2, 17.5], [1000.0, -512.0], [1.0, 150.0 - 72.0]] {
            let tile = grid.tile_of(place);
            assert!(grid.core(tile).holds(place), "{place:?}");
            for (east, north) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let other = TileId { east: tile.east + east, north: tile.north + north };
                assert!(!grid.core(other).holds(place));
            }
        }
        let core = grid.core(TileId { east: 2062, north: 6185 });
        assert_eq!(grid.tile_of(core.low), TileId { east: 2062, north: 6185 });
        assert_eq!(grid.tile_of(core.high), TileId { east: 2063, north: 6186 });
    }

    #[test]
    fn areas_know_their_blocks_and_how_far_apart_they_are() {
        let area = MapArea { low: [-10.0, 0.0], high: [64.0, 70.0] };
        assert_eq!(area.blocks().collect::<Vec<_>>(), [[-1, 0], [0, 0], [-1, 1], [0, 1]]);
        assert_eq!(area.in_blocks(), MapArea { low: [-64.0, 0.0], high: [64.0, 128.0] });
        assert_eq!(area.distance(&block_area([1, 1])), 0.0);
        assert_eq!(area.distance(&block_area([2, 2])), 64.0_f64.hypot(58.0));
        assert_eq!(block_of([-0.1, 64.0]), [-1, 1]);
    }
}
