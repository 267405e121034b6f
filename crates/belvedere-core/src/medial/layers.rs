//! Points sorted into columns of small voxels, for searches above, below and beside a place.

use belvedere_data::cast::{to_cell, to_f32, to_i32, to_i64};
use std::ops::Range;

/// Cells fill blocks of this side, metres, without a remainder, so that surfaces can end at blocks.
const BLOCK: f32 = super::survey::BLOCK;
/// Height of a voxel, metres.
const STEP: f32 = 0.4;
/// Voxels up and down that count as of the same height, which allows for slopes up to 45° and for the parapet of a
/// balcony.
const SAME_HEIGHT: i32 = 2;
/// Share of a step by which rounding may put an origin before the corner that it lies on.
const ROUNDING: f64 = 1e-6;
/// Maximum number of cells: beyond this the columns would take gigabytes.
const MAX_CELLS: f32 = 5e8;

/// East and north number of a cell.
type Cell = [i32; 2];

/// The voxels that hold points, column by column.
pub(super) struct Layers {
    /// Side of a cell, metres.
    side: f32,
    /// Cells along half the side of a block.
    cells_of_half_block: i64,
    /// Offset of the local origin from the corner of its half block, and from the voxel side below it, metres.
    shift: [f32; 3],
    /// Number of the first cell east and north of that corner.
    first_cell: Cell,
    /// Number of the cell at that corner, east and north, in the reference system.
    corner: [i64; 2],
    size: [i32; 2],
    /// First voxel of each cell, and the number of voxels.
    first: Vec<u32>,
    /// Number of each voxel upward.
    level: Vec<i32>,
    /// Cell of each voxel.
    cell: Vec<u32>,
    /// True for voxels that hold a solid point.
    solid: Vec<bool>,
}

impl Layers {
    /// Voxels of `positions`, metres from `origin`, and which of them hold a point whose row is `solid`; `None` for no
    /// points, or for a place too wide. Cells are those of the reference system, whatever the origin, and at least
    /// `min_side` metres wide: as little more as makes half a block a whole number of them.
    pub(super) fn new(
        positions: &[[f32; 3]],
        origin: [f64; 3],
        min_side: f32,
        solid: impl Fn(usize) -> bool,
    ) -> Option<Self> {
        let half = (BLOCK / 2.0 / min_side).floor().max(1.0);
        let side = BLOCK / 2.0 / half;
        let cells_of_half_block = to_i64(f64::from(half));
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for p in positions {
            for axis in 0..2 {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
        }
        let steps = [f64::from(BLOCK) / 2.0, f64::from(BLOCK) / 2.0, f64::from(STEP)];
        // an origin on a corner stays on it
        let corners: [f64; 3] = std::array::from_fn(|axis| (origin[axis] / steps[axis] + ROUNDING).floor());
        let shift: [f32; 3] = std::array::from_fn(|axis| to_f32((origin[axis] - corners[axis] * steps[axis]).max(0.0)));
        let corner = [0, 1].map(|axis| to_i64(corners[axis]).saturating_mul(cells_of_half_block));
        let first_cell = [0, 1].map(|axis| cell_from_corner(low[axis] + shift[axis], side));
        low = [0, 1].map(|axis| first_cell[axis] as f32 * side - shift[axis]);
        let [width, height] = [0, 1].map(|axis| ((high[axis] - low[axis]) / side).floor() + 2.0);
        if !(width > 0.0 && height > 0.0 && width * height < MAX_CELLS) {
            return None;
        }
        let size = [to_i32(f64::from(width)), to_i32(f64::from(height))];
        let (first, level, cell, solid_voxels) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut layers = Self {
            side,
            cells_of_half_block,
            shift,
            first_cell,
            corner,
            size,
            first,
            level,
            cell,
            solid: solid_voxels,
        };
        let voxel = |(row, &p): (usize, &[f32; 3])| {
            Some((u32::try_from(layers.number(layers.cell(p))?).ok()?, layers.level_of(p[2]), !solid(row)))
        };
        let mut voxels: Vec<(u32, i32, bool)> = positions.iter().enumerate().filter_map(voxel).collect();
        voxels.sort_unstable();
        // the first of each voxel is solid if any is
        voxels.dedup_by_key(|&mut (cell, level, _)| (cell, level));
        let count = usize::try_from(i64::from(size[0]) * i64::from(size[1])).ok()?;
        layers.first = vec![0; count + 1];
        for &(cell, ..) in &voxels {
            layers.first[cell as usize + 1] += 1;
        }
        for cell in 0..count {
            layers.first[cell + 1] += layers.first[cell];
        }
        layers.cell = voxels.iter().map(|voxel| voxel.0).collect();
        layers.level = voxels.iter().map(|voxel| voxel.1).collect();
        layers.solid = voxels.iter().map(|voxel| !voxel.2).collect();
        Some(layers)
    }

    /// Number of voxels.
    pub(super) fn len(&self) -> usize {
        self.level.len()
    }

    /// Height of the upper side of the highest voxel.
    pub(super) fn top(&self) -> f32 {
        self.level.iter().max().map_or(f32::NEG_INFINITY, |&level| (level + 1) as f32 * STEP - self.shift[2])
    }

    /// Height of the lower side of a voxel.
    pub(super) fn bottom(&self, voxel: usize) -> f32 {
        self.level[voxel] as f32 * STEP - self.shift[2]
    }

    /// Height of the middle of a voxel.
    pub(super) fn middle(&self, voxel: usize) -> f32 {
        self.bottom(voxel) + STEP / 2.0
    }

    /// The voxel that holds a point, if one does.
    pub(super) fn voxel_of(&self, point: [f32; 3]) -> Option<usize> {
        let column = self.column(self.cell(point));
        let found = self.level[column.clone()].binary_search(&self.level_of(point[2])).ok()?;
        Some(column.start + found)
    }

    /// Returns how many of the eight neighbouring cells continue the surface of a solid voxel, 0 to 8. They hold solid
    /// points at its height, or none at all, which is no evidence. 0 for a voxel that is not solid.
    pub(super) fn count_beside(&self, voxel: usize) -> usize {
        let own = self.cell_of(voxel);
        let goes_on = |cell: Cell| self.same_height(cell, voxel).next().is_some() || self.column(cell).is_empty();
        if self.solid[voxel] { square(own).filter(|&cell| cell != own && goes_on(cell)).count() } else { 0 }
    }

    /// Calls `visit` with the voxels of this and the four cells beside that lie at the height of `voxel` or one off.
    pub(super) fn adjoining(&self, voxel: usize, mut visit: impl FnMut(usize)) {
        let [x, y] = self.cell_of(voxel);
        let own = self.level[voxel];
        for cell in [[x, y], [x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]] {
            self.column(cell).filter(|&other| (self.level[other] - own).abs() <= 1).for_each(&mut visit);
        }
    }

    /// Calls `visit` with the solid voxels of this and the eight cells about that lie at about the height of `voxel`.
    pub(super) fn visit_around(&self, voxel: usize, mut visit: impl FnMut(usize)) {
        square(self.cell_of(voxel)).for_each(|cell| self.same_height(cell, voxel).for_each(&mut visit));
    }

    /// Calls `visit` with the voxels of each cell that a line crosses, and the distances along it, metres, at which it
    /// enters and leaves the cell. The line runs from `start` along the unit vector `up` for `length` metres. It ends
    /// when `visit` returns false, or at the edge of the raster.
    pub(super) fn walk(
        &self,
        start: [f32; 3],
        up: [f32; 3],
        length: f32,
        mut visit: impl FnMut(Range<usize>, [f32; 2]) -> bool,
    ) {
        let mut cell = self.cell(start);
        let mut from = 0.0;
        // where along the line it leaves its cell over the side across one axis
        let leave = |cell: Cell, axis: usize| {
            // from the corner, so that rounding does not depend on where the points begin
            let number = self.first_cell[axis].saturating_add(cell[axis]);
            let side = number.saturating_add(i32::from(up[axis] > 0.0)) as f32 * self.side - self.shift[axis];
            if up[axis] == 0.0 { f32::INFINITY } else { (side - start[axis]) / up[axis] }
        };
        loop {
            let ends = [leave(cell, 0), leave(cell, 1)];
            let axis = usize::from(ends[1] < ends[0]);
            let to = ends[axis].clamp(from, length);
            if !visit(self.column(cell), [from, to]) || !(ends[axis] < length) {
                return;
            }
            cell[axis] += if up[axis] > 0.0 { 1 } else { -1 };
            if !(0..self.size[axis]).contains(&cell[axis]) {
                return;
            }
            from = to;
        }
    }

    /// The voxels of a cell, upward; none beyond the raster.
    fn column(&self, cell: Cell) -> Range<usize> {
        self.number(cell).map_or(0..0, |number| self.first[number] as usize..self.first[number + 1] as usize)
    }

    /// The solid voxels of `cell` at about the height of `voxel`.
    fn same_height(&self, cell: Cell, voxel: usize) -> impl Iterator<Item = usize> + '_ {
        let own = self.level[voxel];
        self.column(cell).filter(move |&other| self.solid[other] && (self.level[other] - own).abs() <= SAME_HEIGHT)
    }

    fn cell_of(&self, voxel: usize) -> Cell {
        let number = self.cell[voxel] as i32;
        [number % self.size[0], number / self.size[0]]
    }

    /// Cell of a point, which may lie beyond the raster.
    fn cell(&self, point: [f32; 3]) -> Cell {
        [0, 1].map(|axis| {
            cell_from_corner(point[axis] + self.shift[axis], self.side).saturating_sub(self.first_cell[axis])
        })
    }

    /// Number east and north of the block that a voxel lies in. Blocks begin `offset` halves of their side west and
    /// south of the origin of the reference system.
    pub(super) fn block(&self, voxel: usize, offset: [i64; 2]) -> [i64; 2] {
        let own = self.cell_of(voxel);
        [0, 1].map(|axis| {
            let moved = offset[axis] * self.cells_of_half_block;
            let local = i64::from(self.first_cell[axis]) + i64::from(own[axis]) + moved;
            self.corner[axis].saturating_add(local).div_euclid(2 * self.cells_of_half_block)
        })
    }

    /// Number upward of the voxel of height `z`.
    fn level_of(&self, z: f32) -> i32 {
        to_cell(f64::from((z + self.shift[2]) / STEP))
    }

    fn number(&self, cell: Cell) -> Option<usize> {
        let inside = (0..2).all(|axis| (0..self.size[axis]).contains(&cell[axis]));
        let number = i64::from(cell[1]) * i64::from(self.size[0]) + i64::from(cell[0]);
        if inside { usize::try_from(number).ok() } else { None }
    }
}

/// Number of a cell of this side from a corner on.
fn cell_from_corner(coordinate: f32, side: f32) -> i32 {
    to_cell(f64::from(coordinate / side))
}

/// A cell and the eight about it.
fn square([x, y]: Cell) -> impl Iterator<Item = Cell> {
    (y - 1..=y + 1).flat_map(move |y| (x - 1..=x + 1).map(move |x| [x, y]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::random::uniform;

    /// Points of 40 m, in metres of the reference system, from a local origin.
    fn from_origin(origin: [f64; 3]) -> Vec<[f32; 3]> {
        let corner = [155_003.0, 462_990.0, 5.0];
        let place = |i: u64| {
            let random = |k: u64| uniform(7, 3 * i + k);
            // 128ths of a metre, which no frame rounds, and of which none lies on the side of a cell
            let steps = [2560.0 * random(0), 2560.0 * random(1), 320.0 * random(2)].map(|v| v.floor() + 0.5);
            std::array::from_fn(|axis| to_f32(corner[axis] + steps[axis] / 64.0 - origin[axis]))
        };
        (0..2000).map(place).collect()
    }

    #[test]
    fn cells_are_those_of_the_reference_system_whatever_the_origin() {
        let corner_of_blocks = [154_624.0, 462_848.0, 0.0];
        for side in [0.5, 0.643, 0.9] {
            let found = [corner_of_blocks, [155_000.0, 463_000.0, 6.0], [155_017.5, 462_901.25, -3.5]].map(|origin| {
                let positions = from_origin(origin);
                let layers = Layers::new(&positions, origin, side, |row| row % 3 != 0).unwrap();
                let of_point = |p: &[f32; 3]| {
                    let voxel = layers.voxel_of(*p).unwrap();
                    let above = f64::from(layers.bottom(voxel)) + origin[2];
                    // heights of f32 a few metres from zero
                    let height = to_i64((1e4 * above).round());
                    (layers.block(voxel, [0, 1]), layers.count_beside(voxel), height)
                };
                (layers.len(), positions.iter().map(of_point).collect::<Vec<_>>())
            });
            assert!(found[0].0 > 500 && found[1] == found[0] && found[2] == found[0], "{side}");
        }
    }
}
