//! One direction swept through the layers of space from the top down: 64 lines of sight at a time.

use super::space_layers::SpaceLayers;
use crate::query::backend::WORD;

/// Most cells that a line of sight moves on in a layer; flatter directions are not swept.
const MOST_SLOPE: f64 = 24.0;
/// By how much the place of a target is widened, cells: more than f64 errs.
const ROUNDING: f64 = 1e-6;

/// Targets from the highest down.
pub(super) struct Descending {
    /// Positions in cells from the corner of the layers, with their places in the order of the tree.
    targets: Vec<([f64; 3], u32)>,
}

impl Descending {
    pub(super) fn new(space: &SpaceLayers, positions: &[[f32; 3]]) -> Self {
        let in_cells = |p: &[f32; 3]| std::array::from_fn(|i| (f64::from(p[i]) - space.low[i]) / space.cell);
        let mut targets: Vec<([f64; 3], u32)> = positions.iter().map(in_cells).zip(0..).collect();
        // stable: equal heights stay in the order of the tree
        targets.sort_by(|a, b| b.0[2].total_cmp(&a.0[2]));
        Self { targets }
    }
}

/// What a sweep settles: a bit for each target, 64 a word, in the order of the tree.
pub(super) struct Swept {
    /// No ball is reached beyond the near space of the target.
    pub(super) free: Vec<u64>,
    /// A ball blocks.
    pub(super) blocked: Vec<u64>,
}

/// A square of the lines of sight, as they meet the lowest level, a bit for each cell.
struct Lines {
    /// Cell of the first bit.
    first: [i64; 2],
    size: [usize; 2],
    width: usize,
    bits: Vec<u64>,
}

impl Lines {
    fn new(first: [i64; 2], size: [usize; 2]) -> Self {
        // a word more, so that moved rows fit
        let width = size[0].div_ceil(WORD) + 1;
        Self { first, size, width, bits: vec![0; width * size[1]] }
    }

    /// Adds the bits of a layer that lies `by` cells to the east and north of the lines.
    fn add(&mut self, space: &SpaceLayers, bits: &[u64], layer: usize, by: [i64; 2]) {
        // cell i of the layer belongs to the lines i − by
        let [Ok(x), Ok(y)] = [0, 1].map(|axis| usize::try_from(-by[axis] - self.first[axis])) else { return };
        let (word, shift) = (x / WORD, x % WORD);
        for row in space.rows(layer) {
            let start = (y + row) * self.width + word;
            let cells = space.row(bits, layer, row);
            let Some(out) = self.bits.get_mut(start..=start + cells.len()) else { return };
            let (head, tail) = out.split_at_mut(1);
            let (Some(&first), Some(&last)) = (cells.first(), cells.last()) else { return };
            if shift == 0 {
                head[0] |= first;
                tail.iter_mut().zip(&cells[1..]).for_each(|(out, cells)| *out |= cells);
                continue;
            }
            let rest = WORD - shift;
            head[0] |= first << shift;
            for (out, pair) in tail.iter_mut().zip(cells.array_windows::<2>()) {
                *out |= pair[1] << shift | pair[0] >> rest;
            }
            tail[cells.len() - 1] |= last >> rest;
        }
    }

    #[inline]
    fn get(&self, [x, y]: [i64; 2]) -> bool {
        let [Ok(x), Ok(y)] = [x - self.first[0], y - self.first[1]].map(usize::try_from) else { return false };
        if x >= self.size[0] || y >= self.size[1] {
            return false;
        }
        self.bits.get(y * self.width + x / WORD).is_some_and(|word| word >> (x % WORD) & 1 == 1)
    }
}

/// Sweeps `direction` for targets whose lines of sight are known up to `near` metres from them; `None` for a direction that is too flat.
///
/// Lines of sight are sorted by the cell in which they meet the lowest level. Those of a cell lie over two by two cells of a layer, the
/// same ones until they pass a side of a cell to the east or north: each layer is added once for each stretch between two
/// such passages, moved by whole cells.
pub(super) fn sweep(space: &SpaceLayers, targets: &Descending, direction: [f64; 3], near: f64) -> Option<Swept> {
    // cells that a line moves on in a layer
    let slope = [direction[0] / direction[2], direction[1] / direction[2]];
    if !(direction[2] > 0.0 && slope[0].abs().max(slope[1].abs()) <= MOST_SLOPE) {
        return None;
    }
    let rise = near * direction[2] / space.cell;
    let depth = space.size[2];
    let range = |axis: usize| {
        let (a, b) = (whole(0.0), whole(depth as f64 * slope[axis]));
        [a.min(b) - 1, a.max(b) + 1]
    };
    let ranges = [range(0), range(1)];
    let first = [-ranges[0][1], -ranges[1][1]];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a range runs upward")]
    let size = std::array::from_fn(|axis| space.size[axis] + (ranges[axis][1] - ranges[axis][0]) as usize + 1);
    let mut reached = Lines::new(first, size);
    let mut filled = Lines::new(first, size);
    let word_count = targets.targets.len().div_ceil(WORD);
    let mut swept = Swept { free: vec![0; word_count], blocked: vec![0; word_count] };
    let mut left = targets.targets.iter().peekable();
    let mut answer = |(at, place): &([f64; 3], u32), reached: &Lines, filled: &Lines| {
        let line: [f64; 2] = std::array::from_fn(|i| at[i] - at[2] * slope[i]);
        let cell = line.map(whole);
        // on the rim of a cell the line may belong to its neighbour
        if (0..2).any(|i| !(ROUNDING..1.0 - ROUNDING).contains(&(line[i] - cell[i] as f64))) {
            return;
        }
        let (word, bit) = (*place as usize / WORD, *place as usize % WORD);
        swept.blocked[word] |= u64::from(filled.get(cell)) << bit;
        swept.free[word] |= u64::from(!reached.get(cell)) << bit;
    };
    let mut moves = Vec::new();
    for layer in (0..depth).rev() {
        if left.peek().is_none() {
            break;
        }
        moves_in(slope, layer as f64, &mut moves);
        for &by in &moves {
            reached.add(space, &space.reached, layer, by);
        }
        // of those that start in this layer it is not known which of its cells they meet
        while let Some(target) = left.next_if(|(at, _)| at[2] + rise - ROUNDING >= layer as f64) {
            answer(target, &reached, &filled);
        }
        for &by in &moves {
            filled.add(space, &space.filled, layer, by);
        }
    }
    for target in left {
        answer(target, &reached, &filled);
    }
    Some(swept)
}

/// By how many whole cells lines of sight have moved in each stretch of a layer.
fn moves_in(slope: [f64; 2], layer: f64, moves: &mut Vec<[i64; 2]>) {
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

/// The whole number below.
#[expect(clippy::cast_possible_truncation, reason = "cells of a scene")]
fn whole(value: f64) -> i64 {
    let toward_zero = value as i64;
    toward_zero - i64::from(toward_zero as f64 > value)
}
