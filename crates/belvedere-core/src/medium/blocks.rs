//! Which blocks of voxels hold anything.

use std::collections::HashMap;

/// Voxels along a side of a block. A block of 8 m is passed in one step where nothing grows.
pub(super) const SIDE: i32 = 8;
/// Voxels of a block.
pub(super) const VOXELS: usize = (SIDE * SIDE * SIDE) as usize;
/// Most places of a table that has one for each block of the box around all: 256 MiB. What is spread wider has a hash
/// table, which is slower.
const MAX_DENSE: u64 = 1 << 26;
/// Place without a block.
const NONE: u32 = u32::MAX;

/// The number of the block that a voxel lies in.
pub(super) fn block_of(voxel: [i32; 3]) -> [i32; 3] {
    voxel.map(|v| v.div_euclid(SIDE))
}

/// Where a voxel lies in its block.
pub(super) fn place_in_block(voxel: [i32; 3]) -> usize {
    let [x, y, z] = voxel.map(|v| v.rem_euclid(SIDE) as usize);
    (z * SIDE as usize + y) * SIDE as usize + x
}

/// Blocks by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct BlockTable {
    /// The blocks, ascending.
    pub(super) numbers: Vec<[i32; 3]>,
    /// Lowest block on each axis, and one beyond the highest.
    pub(super) bounds: [[i32; 3]; 2],
    places: Places,
}

#[derive(Clone, Debug)]
enum Places {
    Dense(Vec<u32>),
    Hashed(HashMap<[i32; 3], u32>),
}

impl Default for Places {
    fn default() -> Self {
        Self::Dense(Vec::new())
    }
}

impl BlockTable {
    /// The table of `numbers`, in any order, some more than once.
    pub(super) fn new(mut numbers: Vec<[i32; 3]>) -> Self {
        numbers.sort_unstable();
        numbers.dedup();
        let Some(&first) = numbers.first() else { return Self::default() };
        let mut bounds = [first, first];
        for number in &numbers {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(number[axis]);
                bounds[1][axis] = bounds[1][axis].max(number[axis]);
            }
        }
        bounds[1] = bounds[1].map(|high| high + 1);
        let size: [u64; 3] = std::array::from_fn(|axis| bounds[0][axis].abs_diff(bounds[1][axis]).into());
        let count = size.into_iter().try_fold(1_u64, u64::checked_mul).filter(|count| *count <= MAX_DENSE);
        let places = match count {
            Some(count) => {
                #[expect(clippy::cast_possible_truncation, reason = "at most MAX_DENSE")]
                let mut dense = vec![NONE; count as usize];
                for (place, number) in (0_u32..).zip(&numbers) {
                    dense[dense_place(bounds, *number)] = place;
                }
                Places::Dense(dense)
            }
            None => Places::Hashed(numbers.iter().copied().zip(0..).collect()),
        };
        Self { numbers, bounds, places }
    }

    /// The place of a block within the bounds among [`BlockTable::numbers`].
    #[inline]
    pub(super) fn get(&self, number: [i32; 3]) -> Option<usize> {
        match &self.places {
            Places::Dense(dense) => {
                dense.get(dense_place(self.bounds, number)).filter(|&&place| place != NONE).map(|&place| place as usize)
            }
            Places::Hashed(hashed) => hashed.get(&number).map(|&place| place as usize),
        }
    }

    /// The place of a block that may lie outside the bounds.
    pub(super) fn find(&self, number: [i32; 3]) -> Option<usize> {
        let is_in = (0..3).all(|axis| (self.bounds[0][axis]..self.bounds[1][axis]).contains(&number[axis]));
        if is_in { self.get(number) } else { None }
    }
}

/// Place of a block in a table with one for each within `bounds`; height fastest, since lines rise.
#[inline]
fn dense_place([low, high]: [[i32; 3]; 2], number: [i32; 3]) -> usize {
    let [x, y, z] = std::array::from_fn(|axis| (number[axis] - low[axis]) as usize);
    let [deep, tall] = [1, 2].map(|axis| (high[axis] - low[axis]) as usize);
    (x * deep + y) * tall + z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_and_far_blocks_are_found_alike() {
        let near = vec![[3, -2, 1], [-4, 5, 0], [3, -2, 1], [0, 0, 7]];
        let far = near.iter().copied().chain([[1 << 24, -(1 << 24), 1 << 20]]).collect::<Vec<_>>();
        for numbers in [near, far] {
            let table = BlockTable::new(numbers.clone());
            assert!(numbers.iter().all(|number| table.find(*number).map(|at| table.numbers[at]) == Some(*number)));
            assert!([[3, -2, 2], [100, 0, 0], [-5, 5, 0]].iter().all(|number| table.find(*number).is_none()));
        }
        assert!(BlockTable::new(Vec::new()).find([0, 0, 0]).is_none());
        assert_eq!((block_of([-1, 8, 7]), place_in_block([-1, 8, 7])), ([-1, 1, 0], 7 * 64 + 7));
    }
}
