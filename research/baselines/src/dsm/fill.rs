//! Heights for cells without points.

/// How a cell without points gets its height. Both work inward from the edge of a gap, one ring of cells after the
/// other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GapFill {
    /// The lowest of the eight neighbours that have one: gaps are mostly ground behind a building.
    Lowest,
    /// The mean of the eight neighbours that have one.
    Mean,
    /// None: such cells block nothing.
    Leave,
}

/// Replaces the NaN in `heights`, rows of `width` cells. Without any height they stay.
pub(super) fn fill(heights: &mut [f32], width: usize, method: GapFill) {
    if method == GapFill::Leave {
        return;
    }
    let mut gaps: Vec<usize> = (0..heights.len()).filter(|&cell| heights[cell].is_nan()).collect();
    while !gaps.is_empty() {
        // all of a ring at once, from the ring outside it, so that the order of the cells does not matter
        let filled: Vec<(usize, f32)> =
            gaps.iter().filter_map(|&cell| Some((cell, from_neighbors(heights, width, cell, method)?))).collect();
        if filled.is_empty() {
            return;
        }
        for (cell, height) in filled {
            heights[cell] = height;
        }
        gaps.retain(|&cell| heights[cell].is_nan());
    }
}

fn from_neighbors(heights: &[f32], width: usize, cell: usize, method: GapFill) -> Option<f32> {
    let (row, column) = (cell / width, cell % width);
    let (mut lowest, mut sum, mut count) = (f32::INFINITY, 0.0, 0.0);
    for other_row in row.saturating_sub(1)..=row + 1 {
        for other_column in column.saturating_sub(1)..=(column + 1).min(width - 1) {
            match heights.get(other_row * width + other_column) {
                Some(&height) if !height.is_nan() => {
                    lowest = lowest.min(height);
                    sum += height;
                    count += 1.0;
                }
                _ => {}
            }
        }
    }
    (count > 0.0).then_some(if method == GapFill::Lowest { lowest } else { sum / count })
}
