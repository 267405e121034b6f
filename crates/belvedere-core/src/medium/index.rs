//! The extinction as a continuous field, and its integral along lines.

use super::blocks::{BlockTable, SIDE, VOXELS, block_of, place_in_block};
use super::walk::GridLine;
use belvedere_data::cast::to_i32;
use belvedere_data::medium::{ExtinctionVoxels, VOXEL_SIDE};
use std::ops::ControlFlow;

/// Optical depth from which on a line is taken to be dark: a ten-thousandth passes even where crowns of which leaves
/// fell have a fifth of it. What lies behind makes no difference.
const DARK: f64 = 46.0;
/// Voxels that meet at a corner.
const AROUND: usize = 8;

/// Extinction that is even in each cell between the middles of eight voxels: their mean. Shadows then do not follow the
/// grid of the voxels, and a line takes one number from each cell.
#[derive(Clone, Debug, Default)]
pub struct Medium {
    /// From local positions to positions between middles of voxels: what is added.
    shift: [f64; 3],
    table: BlockTable,
    /// Extinctions of the cells of each block, x fastest.
    cells: Vec<f32>,
}

impl Medium {
    /// The field of `voxels` in the coordinates of a frame with this `origin`.
    #[must_use]
    pub fn new(voxels: &ExtinctionVoxels, origin: [f64; 3]) -> Self {
        // whole numbers of voxels near the origin keep all digits of local positions
        let base = origin.map(|v| (v / VOXEL_SIDE).floor());
        let shift = std::array::from_fn(|axis| origin[axis] / VOXEL_SIDE - base[axis] - 0.5);
        let base = base.map(to_i32);
        let relative = |voxel: &[i32; 3]| -> [i32; 3] {
            std::array::from_fn(|axis| voxel[axis].saturating_sub(base[axis]).clamp(i32::MIN / 4, i32::MAX / 4))
        };
        // voxels ascend, so that the sum in a cell has one order
        let known = || voxels.voxels.iter().zip(&voxels.extinction).filter(|(_, extinction)| **extinction > 0.0);
        let mut blocks: Vec<[i32; 3]> = Vec::new();
        for cell in known().flat_map(|(voxel, _)| cells_around(relative(voxel))) {
            let block = block_of(cell);
            if blocks.last() != Some(&block) {
                blocks.push(block);
            }
        }
        let table = BlockTable::new(blocks);
        let mut cells = vec![0.0; table.numbers.len() * VOXELS];
        for (voxel, extinction) in known() {
            for cell in cells_around(relative(voxel)) {
                if let Some(at) = table.get(block_of(cell)) {
                    cells[at * VOXELS + place_in_block(cell)] += extinction / AROUND as f32;
                }
            }
        }
        Self { shift, table, cells }
    }

    /// Whether nothing takes light.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Optical depth of the line from `start`, local metres, to `range` metres (infinite for a direction) along the
    /// unit vector `towards`, 0 or more: exact but for rounding, and for what lies behind 46, where nothing passes.
    #[must_use]
    pub fn optical_depth(&self, start: [f64; 3], towards: [f64; 3], range: f64) -> f64 {
        let start = std::array::from_fn(|axis| start[axis] / VOXEL_SIDE + self.shift[axis]);
        let line = GridLine::new(start, towards);
        let Some(ranges) = line.within(self.table.bounds, [0.0, range / VOXEL_SIDE]) else { return 0.0 };
        let mut depth = 0.0;
        let _ = line.each_cell(SIDE, self.table.bounds, ranges, |block, ranges| {
            let Some(at) = self.table.get(block) else { return ControlFlow::Continue(()) };
            let low = block.map(|v| v * SIDE);
            let cells = &self.cells[at * VOXELS..(at + 1) * VOXELS];
            let _ = line.each_cell::<()>(1, [low, low.map(|v| v + SIDE)], ranges, |cell, [from, to]| {
                depth += (to - from) * f64::from(cells[place_in_block(cell)]);
                ControlFlow::Continue(())
            });
            if depth > DARK { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        depth * VOXEL_SIDE
    }

    /// Share of the light that gets along a line: see [`Medium::optical_depth`].
    #[must_use]
    pub fn transmission(&self, start: [f64; 3], towards: [f64; 3], range: f64) -> f64 {
        (-self.optical_depth(start, towards, range)).exp()
    }
}

/// The cells that have the middle of a voxel as a corner.
fn cells_around(voxel: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    (0..8).map(move |bits: i32| std::array::from_fn(|axis| voxel[axis] - (bits >> axis & 1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::cast::to_f32;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::unit;

    fn cloud_of_voxels(origin: [i32; 3]) -> ExtinctionVoxels {
        let mut voxels = ExtinctionVoxels::default();
        for x in 0..20 {
            for y in 0..20 {
                for z in 0..12 {
                    let number = (x * 400 + y * 20 + z) as u64;
                    if uniform(1, number) < 0.3 {
                        voxels.voxels.push([origin[0] + x, origin[1] + y, origin[2] + z]);
                        voxels.extinction.push(to_f32(uniform(2, number)));
                    }
                }
            }
        }
        voxels
    }

    /// The field at a local place, from the voxels alone: the mean of the eight whose middles are around it.
    fn value(voxels: &ExtinctionVoxels, origin: [f64; 3], place: [f64; 3]) -> f64 {
        let is_near = |voxel: &[i32; 3]| {
            (0..3).all(|axis| {
                let middle = f64::from(voxel[axis]) + 0.5;
                (middle.floor() - (place[axis] + origin[axis] - 0.5).floor()).abs() < 0.5
                    || (middle.floor() - (place[axis] + origin[axis] - 0.5).floor() - 1.0).abs() < 0.5
            })
        };
        let near = voxels.voxels.iter().zip(&voxels.extinction).filter(|(voxel, _)| is_near(voxel));
        near.map(|(_, &extinction)| f64::from(extinction)).sum::<f64>() / 8.0
    }

    #[test]
    fn optical_depth_is_the_integral_of_the_means_of_voxels() {
        let origin = [85_000.25, 446_000.5, -3.75];
        let voxels = cloud_of_voxels([85_003, 446_002, -5]);
        let medium = Medium::new(&voxels, origin);
        for i in 0..12 {
            let random = |k: u64| uniform(5, 8 * i + k);
            let start = [24.0 * random(0), 24.0 * random(1), 6.0 * random(2) - 3.0];
            let towards =
                if i == 0 { [0.0, 0.0, 1.0] } else { unit([random(3) - 0.5, random(4) - 0.5, random(5)]).unwrap() };
            let range = if i % 2 == 0 { f64::INFINITY } else { 9.0 };
            let (steps, length) = (4000, if range.is_finite() { range } else { 60.0 });
            let step = length / f64::from(steps);
            let sum: f64 = (0..steps)
                .map(|k| {
                    let at = (f64::from(k) + 0.5) * step;
                    step * value(&voxels, origin, std::array::from_fn(|axis| start[axis] + at * towards[axis]))
                })
                .sum();
            let found = medium.optical_depth(start, towards, range);
            // the midpoint rule errs at each of some sixty steps of the field by half a step of the sum
            assert!((found - sum).abs() < 0.02, "{i}: {found} {sum}");
        }
        assert_eq!(medium.optical_depth([500.0, 0.0, 0.0], [1.0, 0.0, 0.0], f64::INFINITY), 0.0);
        assert_eq!(Medium::default().optical_depth([0.0; 3], [0.0, 0.0, 1.0], f64::INFINITY), 0.0);
    }

    #[test]
    fn depths_add_up_along_a_line_and_through_parts_of_the_voxels() {
        let voxels = cloud_of_voxels([-4, -4, 0]);
        let medium = Medium::new(&voxels, [0.0; 3]);
        let parts = [0, 1].map(|part| {
            let part = voxels.filtered(|voxel| (voxel[0] + voxel[1]).rem_euclid(2) == part);
            Medium::new(&part, [0.0; 3])
        });
        for i in 0..200 {
            let random = |k: u64| uniform(9, 8 * i + k);
            let start = [12.0 * random(0), 12.0 * random(1), 1.0];
            let towards = unit([random(3) - 0.5, random(4) - 0.5, 0.6 * random(5)]).unwrap();
            let whole = medium.optical_depth(start, towards, 12.0);
            let middle = std::array::from_fn(|axis| start[axis] + 5.0 * towards[axis]);
            let in_two = medium.optical_depth(start, towards, 5.0) + medium.optical_depth(middle, towards, 7.0);
            let of_parts: f64 = parts.iter().map(|part| part.optical_depth(start, towards, 12.0)).sum();
            assert!((whole - in_two).abs() < 1e-9, "{i}");
            // a cell holds the mean of its voxels in single precision
            assert!((whole - of_parts).abs() < 1e-5, "{i}: {whole} {of_parts}");
        }
    }

    #[test]
    fn voxels_elsewhere_change_no_bit() {
        let voxels = cloud_of_voxels([0, 0, 0]);
        let mut more = voxels.clone();
        let far = voxels.voxels.iter().map(|v| [v[0] + 300, v[1] - 40, v[2]]).collect();
        more.append(&ExtinctionVoxels { voxels: far, extinction: voxels.extinction.clone() });
        let [own, all] = [voxels, more].map(|voxels| Medium::new(&voxels, [0.3, 0.7, 0.1]));
        for i in 0..500 {
            let random = |k: u64| uniform(13, 8 * i + k);
            let start = [20.0 * random(0), 20.0 * random(1), 3.0 * random(2)];
            let towards = unit([random(3) - 0.5, random(4) - 0.5, 0.2 + random(5)]).unwrap();
            let [one, other] = [&own, &all].map(|medium| medium.optical_depth(start, towards, 25.0));
            assert!(one.to_bits() == other.to_bits(), "{i}: {one} {other}");
        }
    }
}
