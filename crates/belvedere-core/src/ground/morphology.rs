//! Erosion and dilation of grids of heights by squares.

use belvedere_data::raster::Raster;
use rayon::prelude::*;

/// Operation on a square window.
#[derive(Clone, Copy)]
enum Extreme {
    Min,
    Max,
}

/// Morphological opening of `heights` with a square of `2 · radius + 1` cells: minimum filter, then maximum filter. No
/// height may be NaN.
pub(super) fn opened(heights: &Raster<f32>, radius: usize) -> Raster<f32> {
    window(&window(heights, radius, Extreme::Min), radius, Extreme::Max)
}

/// The extreme of the square of `2 · radius + 1` cells around each cell, cut at the edge of the raster: along rows,
/// then along columns.
fn window(heights: &Raster<f32>, radius: usize, extreme: Extreme) -> Raster<f32> {
    let (width, height) = (heights.width(), heights.height());
    let mut along_rows = heights.clone();
    along_rows.values_mut().par_chunks_mut(width.max(1)).for_each(|row| line(row, radius, extreme));
    let mut columns = transposed(&along_rows, width, height);
    columns.par_chunks_mut(height.max(1)).for_each(|column| line(column, radius, extreme));
    let mut result = along_rows;
    result.values_mut().par_chunks_mut(width.max(1)).enumerate().for_each(|(row, values)| {
        for (column, value) in values.iter_mut().enumerate() {
            *value = columns[column * height + row];
        }
    });
    result
}

fn transposed(raster: &Raster<f32>, width: usize, height: usize) -> Vec<f32> {
    let values = raster.values();
    let mut columns = vec![0.0; values.len()];
    columns.par_chunks_mut(height.max(1)).enumerate().for_each(|(column, out)| {
        for (row, value) in out.iter_mut().enumerate() {
            *value = values[row * width + column];
        }
    });
    columns
}

/// Replaces each value by the extreme of those at most `radius` away: three comparisons a value whatever the radius.
///
/// # Source
/// van Herk 1992, "A fast algorithm for local minimum and maximum filters on rectangular and octagonal kernels".
fn line(values: &mut [f32], radius: usize, extreme: Extreme) {
    let pick = |a: f32, b: f32| match extreme {
        Extreme::Min => a.min(b),
        Extreme::Max => a.max(b),
    };
    let neutral = match extreme {
        Extreme::Min => f32::INFINITY,
        Extreme::Max => f32::NEG_INFINITY,
    };
    let size = 2 * radius + 1;
    let count = values.len();
    let padded_count = (count + 2 * radius).div_ceil(size) * size;
    let mut forward = vec![neutral; padded_count];
    for (out, &value) in forward.iter_mut().skip(radius).zip(values.iter()) {
        *out = value;
    }
    let mut backward = forward.clone();
    for block in forward.chunks_mut(size) {
        for i in 1..block.len() {
            block[i] = pick(block[i], block[i - 1]);
        }
    }
    for block in backward.chunks_mut(size) {
        for i in (1..block.len()).rev() {
            block[i - 1] = pick(block[i - 1], block[i]);
        }
    }
    for (i, value) in values.iter_mut().enumerate() {
        *value = pick(backward[i], forward[i + size - 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::cast::to_f32;
    use belvedere_data::random::uniform;

    #[test]
    fn windows_are_those_of_every_cell_tried() {
        let (width, height) = (23, 17);
        let values: Vec<f32> = (0..width * height).map(|i| to_f32(uniform(5, i as u64))).collect();
        let raster = Raster::from_values(width, height, values).unwrap();
        for radius in [0, 1, 3, 30] {
            let min = window(&raster, radius, Extreme::Min);
            for row in 0..height {
                for column in 0..width {
                    let mut expected = f32::INFINITY;
                    for r in row.saturating_sub(radius)..(row + radius + 1).min(height) {
                        for c in column.saturating_sub(radius)..(column + radius + 1).min(width) {
                            expected = expected.min(raster.get(c, r).unwrap());
                        }
                    }
                    assert_eq!(min.get(column, row), Some(expected), "{radius} {column} {row}");
                }
            }
        }
    }

    #[test]
    fn opening_takes_away_what_is_narrower_than_the_window() {
        let mut raster = Raster::filled(30, 30, 0.0);
        for row in 10..15 {
            for column in 10..15 {
                raster.values_mut()[row * 30 + column] = 8.0;
            }
        }
        assert!(opened(&raster, 3).values().iter().all(|&v| v == 0.0));
        assert_eq!(opened(&raster, 2), raster);
    }
}
