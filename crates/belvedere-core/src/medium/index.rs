//! The extinction as a continuous field, and its integral along lines.

use super::blocks::{BlockTable, SIDE, block_of};
use super::walk::GridLine;
use belvedere_data::medium::{ExtinctionVoxels, VOXEL_SIDE};
use std::ops::ControlFlow;

/// Corners along a side of a block: the field between two voxels belongs to the block of the lower one.
const CORNERS: usize = SIDE as usize + 1;
/// Corners of a block.
const BLOCK_CORNERS: usize = CORNERS * CORNERS * CORNERS;
/// Places of the two points of Gauss's rule in an interval from 0 to 1.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Optical depth from which on a line is taken to be dark: 2 millionths pass. What lies behind makes no difference.
const DARK: f64 = 13.0;

/// Extinction, linearly interpolated between the middles of voxels.
#[derive(Clone, Debug, Default)]
pub struct Medium {
    /// From local positions to positions between middles of voxels: what is added.
    shift: [f64; 3],
    table: BlockTable,
    /// Extinctions at the corners of each block, x fastest.
    corners: Vec<f32>,
    /// A bit for each cell of a block between eight middles, a word for each height: set where any of them takes light.
    filled: Vec<[u64; SIDE as usize]>,
}

impl Medium {
    /// The field of `voxels` in the coordinates of a frame with this `origin`.
    #[must_use]
    pub fn new(voxels: &ExtinctionVoxels, origin: [f64; 3]) -> Self {
        // whole numbers of voxels near the origin keep all digits of local positions
        let base = origin.map(|v| (v / VOXEL_SIDE).floor());
        let shift = std::array::from_fn(|axis| origin[axis] / VOXEL_SIDE - base[axis] - 0.5);
        #[expect(clippy::cast_possible_truncation, reason = "origins lie within a million km of zero")]
        let base = base.map(|v| v as i32);
        let relative = |voxel: &[i32; 3]| -> [i32; 3] {
            std::array::from_fn(|axis| voxel[axis].saturating_sub(base[axis]).clamp(i32::MIN / 4, i32::MAX / 4))
        };
        let known = || voxels.voxels.iter().zip(&voxels.extinction).filter(|(_, extinction)| **extinction > 0.0);
        let table = BlockTable::new(known().flat_map(|(voxel, _)| blocks_around(relative(voxel))).collect());
        let mut corners = vec![0.0; table.numbers.len() * BLOCK_CORNERS];
        for (voxel, &extinction) in known() {
            let voxel = relative(voxel);
            for block in blocks_around(voxel) {
                let Some(at) = table.get(block) else { continue };
                let [x, y, z] = std::array::from_fn(|axis| (voxel[axis] - block[axis] * SIDE) as usize);
                corners[at * BLOCK_CORNERS + (z * CORNERS + y) * CORNERS + x] = extinction;
            }
        }
        let filled = corners.chunks_exact(BLOCK_CORNERS).map(filled_cells).collect();
        Self { shift, table, corners, filled }
    }

    /// Whether nothing takes light.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.filled.is_empty()
    }

    /// Optical depth of the line from `start`, local metres, to `range` metres (infinite for a direction) along the
    /// unit vector `towards`, 0 or more: exact but for rounding, and for what lies behind 13, where 2 millionths pass.
    #[must_use]
    pub fn optical_depth(&self, start: [f64; 3], towards: [f64; 3], range: f64) -> f64 {
        let start = std::array::from_fn(|axis| start[axis] / VOXEL_SIDE + self.shift[axis]);
        let line = GridLine::new(start, towards);
        let Some(ranges) = line.within(self.table.bounds, [0.0, range / VOXEL_SIDE]) else { return 0.0 };
        let mut depth = 0.0;
        let _ = line.each_cell(SIDE, self.table.bounds, ranges, |block, ranges| {
            let Some(at) = self.table.get(block) else { return ControlFlow::Continue(()) };
            self.add_block(&line, (block, at), ranges, &mut depth);
            if depth > DARK { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        depth * VOXEL_SIDE
    }

    /// Share of the light that gets along a line: see [`Medium::optical_depth`].
    #[must_use]
    pub fn transmission(&self, start: [f64; 3], towards: [f64; 3], range: f64) -> f64 {
        (-self.optical_depth(start, towards, range)).exp()
    }

    /// Adds to `depth` what a line meets in a block.
    fn add_block(&self, line: &GridLine, (block, at): ([i32; 3], usize), ranges: [f64; 2], depth: &mut f64) {
        let low = block.map(|v| v * SIDE);
        let corners = &self.corners[at * BLOCK_CORNERS..(at + 1) * BLOCK_CORNERS];
        let filled = &self.filled[at];
        let _ = line.each_cell::<()>(1, [low, low.map(|v| v + SIDE)], ranges, |cell, [from, to]| {
            let [x, y, z] = std::array::from_fn(|axis| (cell[axis] - low[axis]) as usize);
            if filled[z] >> (y * SIDE as usize + x) & 1 == 1 {
                let first = (z * CORNERS + y) * CORNERS + x;
                let length = to - from;
                // the field along a line is a cubic in each cell, which two points integrate exactly
                let [a, b] = GAUSS.map(|place| {
                    let place = line.at(from + place * length);
                    interpolated(corners, first, std::array::from_fn(|axis| place[axis] - f64::from(cell[axis])))
                });
                *depth += 0.5 * length * (a + b);
            }
            ControlFlow::Continue(())
        });
    }
}

/// The blocks that hold the middle of a voxel at a corner: one, and those before it where it lies on their sides.
fn blocks_around(voxel: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    let own = block_of(voxel);
    let is_first = voxel.map(|v| v.rem_euclid(SIDE) == 0);
    (0..8).filter_map(move |bits: i32| {
        let back: [bool; 3] = std::array::from_fn(|axis| bits >> axis & 1 == 1);
        let exists = (0..3).all(|axis| !back[axis] || is_first[axis]);
        exists.then(|| std::array::from_fn(|axis| own[axis] - i32::from(back[axis])))
    })
}

/// The cells of a block of which any corner takes light.
fn filled_cells(corners: &[f32]) -> [u64; SIDE as usize] {
    std::array::from_fn(|z| {
        let mut bits = 0;
        for (y, x) in (0..SIDE as usize).flat_map(|y| (0..SIDE as usize).map(move |x| (y, x))) {
            let first = (z * CORNERS + y) * CORNERS + x;
            let is_filled = CELL.iter().any(|offset| corners[first + offset] > 0.0);
            bits |= u64::from(is_filled) << (y * SIDE as usize + x);
        }
        bits
    })
}

/// Corners of a cell from its first on: x fastest, then y, then z.
const CELL: [usize; 8] = {
    let (y, z) = (CORNERS, CORNERS * CORNERS);
    [0, 1, y, y + 1, z, z + 1, z + y, z + y + 1]
};

/// The value at a place in a cell, 0 to 1 on each axis, between those at its corners.
#[inline]
fn interpolated(corners: &[f32], first: usize, [x, y, z]: [f64; 3]) -> f64 {
    let at = |corner: usize| f64::from(corners[first + CELL[corner]]);
    let along = |corner: usize| at(corner) + x * (at(corner + 1) - at(corner));
    let [near, far] = [0, 4].map(|level| along(level) + y * (along(level + 2) - along(level)));
    near + z * (far - near)
}

#[cfg(test)]
mod tests {
    use super::*;
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
                        voxels.extinction.push(uniform(2, number) as f32);
                    }
                }
            }
        }
        voxels
    }

    /// The field at a local place, from the voxels alone.
    fn value(voxels: &ExtinctionVoxels, origin: [f64; 3], place: [f64; 3]) -> f64 {
        let mut sum = 0.0;
        for (voxel, &extinction) in voxels.voxels.iter().zip(&voxels.extinction) {
            let weight: f64 = (0..3)
                .map(|axis| (1.0 - (place[axis] + origin[axis] - f64::from(voxel[axis]) - 0.5).abs()).max(0.0))
                .product();
            sum += weight * f64::from(extinction);
        }
        sum
    }

    #[test]
    fn optical_depth_is_the_integral_of_the_interpolated_field() {
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
            // the midpoint rule errs at kinks by step times slope
            assert!((found - sum).abs() < 2e-3, "{i}: {found} {sum}");
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
            assert!((whole - in_two).abs() < 1e-9 && (whole - of_parts).abs() < 1e-9, "{i}");
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
