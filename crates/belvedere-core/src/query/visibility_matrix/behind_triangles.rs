//! Lines of sight of the matrix that triangles block.

use super::super::BlockingTriangles;
use super::super::backend::{BLOCK, WORD};
use belvedere_data::Result;
use belvedere_data::control::Control;
use rayon::prelude::*;

/// Widening of boxes, metres: more than f32 and f64 err.
const ROOM: f64 = 0.01;
/// Maximum distance of the targets of a packet from the first of them along an axis, metres. The sky of 60 000 points
/// of a town with 3000 triangles (145 directions) took 0.92 s with 4 and 8, 0.77 with 16.
const SPREAD: f64 = 16.0;

/// Unsets the bits of lines of sight that triangles block, in rows of `words` for `targets`, (M, 3), neighbours
/// together, and `directions`, (D, 3).
pub(super) fn hide_behind_triangles(
    triangles: &BlockingTriangles,
    targets: &[[f32; 3]],
    directions: &[[f64; 3]],
    words: &mut [u64],
    control: &Control<'_>,
) -> Result<()> {
    let width = directions.len().div_ceil(WORD);
    let blocks = words.par_chunks_mut(width * BLOCK).zip(targets.par_chunks(BLOCK));
    blocks.try_for_each(|(rows, targets)| {
        control.check()?;
        let around = bounding_box(targets);
        let meets = |(_, direction): &(usize, &[f64; 3])| may_meet(around, **direction, triangles.bounds());
        let met: Vec<(usize, [f64; 3])> =
            directions.iter().enumerate().filter(meets).map(|(column, direction)| (column, *direction)).collect();
        let mut packet = Packet { triangles, rows: Vec::new(), targets: Vec::new() };
        for &(column, direction) in &met {
            let (word, bit) = (column / WORD, 1 << (column % WORD));
            for (row, &target) in targets.iter().enumerate() {
                let target = target.map(f64::from);
                if rows[row * width + word] & bit == 0 {
                    continue;
                }
                if !packet.fits(target) {
                    packet.find(direction, |row| rows[row * width + word] &= !bit);
                }
                packet.rows.push(row);
                packet.targets.push(target);
            }
            packet.find(direction, |row| rows[row * width + word] &= !bit);
        }
        Ok(())
    })
}

/// Lines of sight of neighbours in one direction.
struct Packet<'a> {
    triangles: &'a BlockingTriangles,
    /// Numbers of the targets.
    rows: Vec<usize>,
    targets: Vec<[f64; 3]>,
}

impl Packet<'_> {
    /// Returns true if a target lies near the first of the packet.
    fn fits(&self, target: [f64; 3]) -> bool {
        self.targets.first().is_none_or(|first| (0..3).all(|axis| (first[axis] - target[axis]).abs() < SPREAD))
    }

    /// Gives `block` the numbers of the lines in a direction that are blocked; the packet is empty then.
    fn find(&mut self, direction: [f64; 3], mut block: impl FnMut(usize)) {
        if !self.targets.is_empty() {
            let rows = &self.rows;
            self.triangles.each_blocked(&self.targets, direction, |number| block(rows[number]));
        }
        self.rows.clear();
        self.targets.clear();
    }
}

/// Lowest and highest corner of a box around targets.
fn bounding_box(targets: &[[f32; 3]]) -> [[f64; 3]; 2] {
    let bound = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|axis| targets.iter().map(|target| f64::from(target[axis])).fold(start, pick))
    };
    [bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY)]
}

/// Returns true if a line of sight along `direction` from anywhere in a box may meet another box.
fn may_meet([low, high]: [[f64; 3]; 2], direction: [f64; 3], [first, last]: [[f64; 3]; 2]) -> bool {
    let (mut from, mut to) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        // how far the box must move along the axis to touch the other, and to have passed it
        let (near, far) = (first[axis] - high[axis] - ROOM, last[axis] - low[axis] + ROOM);
        let slope = direction[axis];
        if slope == 0.0 {
            if near > 0.0 || far < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (near / slope, far / slope);
        from = from.max(a.min(b));
        to = to.min(a.max(b));
    }
    from <= to
}
