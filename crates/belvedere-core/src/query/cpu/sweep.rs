//! One direction swept through the layers of space from the top down: 64 lines of sight at a time.

use super::space_layers::{CellBits, SpaceLayers};
use super::whole_cells::{SweptDirection, TargetCell};
use crate::query::backend::WORD;
use belvedere_data::Result;
use belvedere_data::control::Control;
use rayon::prelude::*;

/// Targets from the highest down.
struct Descending {
    /// Targets with their places in the order of the tree.
    targets: Vec<(TargetCell, u32)>,
}

impl Descending {
    fn new(places: &[Option<TargetCell>]) -> Self {
        let mut targets: Vec<(TargetCell, u32)> =
            places.iter().zip(0..).filter_map(|(place, number)| Some(((*place)?, number))).collect();
        // stable: equal heights stay in the order of the tree
        targets.sort_by_key(|(place, _)| std::cmp::Reverse(place.height));
        Self { targets }
    }
}

/// Result of a sweep: bit masks over the targets, 64 a word, in the order of the tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Swept {
    /// No ball is reached beyond the near space of the target.
    pub(super) free: Vec<u64>,
    /// A ball blocks.
    pub(super) blocked: Vec<u64>,
}

/// A square of the lines of sight, as they meet the lowest level, a bit for each cell.
struct LineSquare {
    /// Cell of the first bit.
    first: [i64; 2],
    size: [usize; 2],
    width: usize,
    bits: Vec<u64>,
}

impl LineSquare {
    fn new(first: [i64; 2], size: [usize; 2]) -> Self {
        // a word more, so that moved rows fit
        let width = size[0].div_ceil(WORD) + 1;
        Self { first, size, width, bits: vec![0; width * size[1]] }
    }

    /// Adds the cells of a layer that lies `by` cells to the east and north of the lines.
    fn add(&mut self, space: &SpaceLayers, cells: &CellBits, layer: usize, by: [i64; 2]) {
        // cell i of the layer belongs to the lines i − by
        let [Ok(x), Ok(y)] = [0, 1].map(|axis| usize::try_from(-by[axis] - self.first[axis])) else { return };
        let (word, shift) = (x / WORD, x % WORD);
        for row in 0..space.size[1] {
            let (from, cells) = cells.row(layer * space.size[1] + row);
            let (Some(&first), Some(&last)) = (cells.first(), cells.last()) else { continue };
            let start = (y + row) * self.width + word + from;
            let Some(out) = self.bits.get_mut(start..=start + cells.len()) else { return };
            let (head, tail) = out.split_at_mut(1);
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
    fn get(&self, [x, y]: [i32; 2]) -> bool {
        let from_first = [i64::from(x) - self.first[0], i64::from(y) - self.first[1]];
        let [Ok(x), Ok(y)] = from_first.map(usize::try_from) else { return false };
        if x >= self.size[0] || y >= self.size[1] {
            return false;
        }
        self.bits.get(y * self.width + x / WORD).is_some_and(|word| word >> (x % WORD) & 1 == 1)
    }
}

/// Sweeps `headings`, one after the other, for targets in `places`; lines of those that have none stay open.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn sweep_all(
    space: &SpaceLayers,
    places: &[Option<TargetCell>],
    headings: &[SweptDirection],
    control: &Control<'_>,
) -> Result<Vec<Swept>> {
    let descending = Descending::new(places);
    let word_count = places.len().div_ceil(WORD);
    let of_heading = |heading| {
        control.check()?;
        Ok(sweep(space, &descending, word_count, heading))
    };
    headings.par_iter().map(of_heading).collect()
}

/// Sweeps a direction.
///
/// Lines of sight are sorted by the cell in which they meet the lowest level. Each layer is added once for each stretch
/// between two passages of sides of cells, moved by whole cells.
fn sweep(space: &SpaceLayers, targets: &Descending, word_count: usize, heading: &SweptDirection) -> Swept {
    let depth = space.size[2];
    let ranges = [0, 1].map(|axis| heading.range(axis, depth));
    let first = [-ranges[0][1], -ranges[1][1]];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a range runs upward")]
    let size = std::array::from_fn(|axis| space.size[axis] + (ranges[axis][1] - ranges[axis][0]) as usize + 1);
    let mut reached = LineSquare::new(first, size);
    let mut filled = LineSquare::new(first, size);
    let mut swept = Swept { free: vec![0; word_count], blocked: vec![0; word_count] };
    let mut left = targets.targets.iter().peekable();
    let mut answer = |(place, number): &(TargetCell, u32), reached: &LineSquare, filled: &LineSquare| {
        let Some(cell) = place.cell(heading) else { return };
        let (word, bit) = (*number as usize / WORD, *number as usize % WORD);
        swept.blocked[word] |= u64::from(filled.get(cell)) << bit;
        swept.free[word] |= u64::from(!reached.get(cell)) << bit;
    };
    let mut moves = Vec::new();
    for layer in (0..depth).rev() {
        if left.peek().is_none() {
            break;
        }
        heading.moves_in(layer, &mut moves);
        for &by in &moves {
            reached.add(space, &space.reached, layer, by);
        }
        // of those that start in this layer it is not known which of its cells they meet
        let is_in = |place: &TargetCell| i64::from(place.layer(heading)) >= layer as i64;
        while let Some(target) = left.next_if(|(place, _)| is_in(place)) {
            answer(target, &reached, &filled);
        }
        for &by in &moves {
            filled.add(space, &space.filled, layer, by);
        }
    }
    for target in left {
        answer(target, &reached, &filled);
    }
    swept
}
