//! Targets and directions in whole numbers: the same line of sight has the same cell in every query, because no step
//! rounds.
//!
//! A line of sight belongs to the cell in which it meets the lowest level of the layers. With the place (x, y, z) of
//! its target in cells and the slope s of its direction this is x − z·s. Heights have 18 bits of fraction and slopes
//! 26, so that their product has 44, as x and y have: the difference is exact. The rounding of heights and slopes
//! before moves the line by less than 24 · 2⁻¹⁸ + 4096 · 2⁻²⁷ < 2⁻¹² cells. A line closer than that to the border of
//! its cell has none ([`TargetCell::cell`]) and stays open.

use super::space_layers::SpaceLayers;
use belvedere_data::cast::{to_i32, to_i64};

/// Bits of the fraction of a height, in cells.
const HEIGHT_BITS: u32 = 18;
/// Bits of the fraction of a slope, in cells that a line moves on in a layer.
const SLOPE_BITS: u32 = 26;
/// Bits of the fraction of a place along x or y, in cells.
const ACROSS_BITS: u32 = HEIGHT_BITS + SLOPE_BITS;
/// A line closer than this part of a cell (2 to the power of minus this) to a border may belong to the next cell.
const BORDER_BITS: u32 = 12;
/// Maximum height of a target above or below the lowest layer, cells: 2 km for cells of 0.5 m. Lines of others stay
/// open.
const MAX_HEIGHT: f64 = 4096.0;
/// Maximum distance of a target from the corner along x or y, cells: 131 km for cells of 0.5 m.
const MAX_ACROSS: f64 = 262_144.0;
/// Maximum shift of a line of sight in a layer, cells; flatter directions are not swept.
const MAX_SLOPE: f64 = 24.0;

/// A target, in cells from the corner of the layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TargetCell {
    /// Along x and y, with 44 bits of fraction.
    pub(super) across: [i64; 2],
    /// Above the lowest layer, with 18 bits of fraction.
    pub(super) height: i32,
}

impl TargetCell {
    /// Locates a target, local metres; `None` for one too far from the layers.
    #[must_use]
    pub(super) fn new(space: &SpaceLayers, position: [f32; 3]) -> Option<Self> {
        let at: [f64; 3] = std::array::from_fn(|i| (f64::from(position[i]) - space.low[i]) / space.cell);
        let is_near = at[0].abs() < MAX_ACROSS && at[1].abs() < MAX_ACROSS && at[2].abs() < MAX_HEIGHT;
        is_near.then(|| Self {
            across: [at[0], at[1]].map(|v| to_i64((v * (1_i64 << ACROSS_BITS) as f64).floor())),
            height: to_i32((at[2] * f64::from(1 << HEIGHT_BITS)).floor()),
        })
    }

    /// The cell in which the line of sight of this target meets the lowest level, along x and y; `None` where it may be
    /// the next one.
    #[must_use]
    #[inline]
    pub(super) fn cell(&self, heading: &SweptDirection) -> Option<[i32; 2]> {
        let line: [i32; 2] = std::array::from_fn(|i| {
            let line = self.across[i] - i64::from(self.height) * i64::from(heading.slope[i]);
            // 2¹⁹ cells and 12 bits of fraction are 31 bits
            (line >> (ACROSS_BITS - BORDER_BITS)) as i32
        });
        let last = (1 << BORDER_BITS) - 1;
        line.iter().all(|line| (1..last).contains(&(line & last))).then(|| line.map(|line| line >> BORDER_BITS))
    }

    /// The layer in which the line of sight leaves the near space of this target; below zero for one below all layers.
    #[must_use]
    #[inline]
    pub(super) fn layer(&self, heading: &SweptDirection) -> i32 {
        (self.height + heading.rise) >> HEIGHT_BITS
    }
}

/// A direction that is swept.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SweptDirection {
    /// Cells that a line moves on in a layer along x and y, with 26 bits of fraction.
    pub(super) slope: [i32; 2],
    /// Number of layers above its target at which a line leaves the near space, with 18 bits of fraction.
    pub(super) rise: i32,
    /// The slope itself.
    slope_exact: [f64; 2],
}

impl SweptDirection {
    /// The unit vector `direction` for targets whose lines of sight are known up to `near` metres from them; `None` for
    /// one that is too flat.
    #[must_use]
    pub(super) fn new(space: &SpaceLayers, direction: [f64; 3], near: f64) -> Option<Self> {
        let slope = [direction[0] / direction[2], direction[1] / direction[2]];
        let rise = near * direction[2] / space.cell;
        let is_swept = direction[2] > 0.0 && slope[0].abs().max(slope[1].abs()) <= MAX_SLOPE && rise < MAX_HEIGHT;
        is_swept.then(|| Self {
            slope: slope.map(|v| to_i32((v * f64::from(1 << SLOPE_BITS)).round())),
            rise: to_i32((rise * f64::from(1 << HEIGHT_BITS)).floor()),
            slope_exact: slope,
        })
    }

    /// Returns the minimum and maximum shift of lines of sight in `depth` layers along an axis, whole cells.
    pub(super) fn range(&self, axis: usize, depth: usize) -> [i64; 2] {
        let (a, b) = (whole(0.0), whole(depth as f64 * self.slope_exact[axis]));
        [a.min(b) - 1, a.max(b) + 1]
    }

    /// Writes the shift along x and y of lines of sight in each stretch of a layer, whole cells, into `moves`.
    ///
    /// The lines of a cell lie over two by two cells of the layer, the same ones until they pass a side of a cell to
    /// the east or north. A stretch runs from one such passage to the next.
    pub(super) fn moves_in(&self, layer: usize, moves: &mut Vec<[i64; 2]>) {
        let slope = self.slope_exact;
        let layer = layer as f64;
        moves.clear();
        let mut level = layer;
        let mut by = slope.map(|slope| whole(level * slope));
        loop {
            moves.push(by);
            // where the next side of a cell is passed
            let next: [f64; 2] = std::array::from_fn(|axis| match slope[axis] {
                up if up > 0.0 => (by[axis] + 1) as f64 / up,
                down if down < 0.0 => by[axis] as f64 / down,
                _ => f64::INFINITY,
            });
            let axis = usize::from(next[1] < next[0]);
            level = level.max(next[axis]);
            if !(level < layer + 1.0) {
                return;
            }
            by[axis] += if slope[axis] > 0.0 { 1 } else { -1 };
        }
    }
}

/// The whole number below.
fn whole(value: f64) -> i64 {
    let toward_zero = to_i64(value);
    toward_zero - i64::from(toward_zero as f64 > value)
}
