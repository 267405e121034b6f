//! Spacing of pulses: the unit of the sizes of balls.
//!
//! Nothing is known of the space between two neighbouring pulses. Balls that close a surface are as large as that
//! spacing, whatever the survey: half a metre for two pulses a square metre, half a decimetre for a hundred.

use super::cells::{Cells, cell};
use belvedere_data::Attributes;
use rayon::prelude::*;

/// Area that pulses are counted on, m²: a cell and those about it.
const AREA_M2: f32 = 9.0;

/// Counts the first returns in each cell and its neighbours, one for each pulse. Without return numbers all of
/// `positions`, (N, 3) local metres, count.
pub(super) fn pulse_counts(positions: &[[f32; 3]], attributes: &Attributes) -> Cells<u32> {
    let numbers = attributes.return_number.as_deref();
    let is_first = |row: usize| numbers.and_then(|numbers| numbers.get(row)).is_none_or(|&number| number <= 1);
    let rows = (0..positions.len()).into_par_iter();
    let counts = rows.map(|row| (cell(positions[row]), u32::from(is_first(row)))).collect();
    Cells::new(counts, |a, b| a + b).with_neighbors(|a, b| a + b)
}

/// Mean horizontal distance between so many pulses of [`pulse_counts`], metres: the side of the square that each has to
/// itself.
pub(super) fn spacing_of(count: u32) -> f32 {
    let area = AREA_M2 / count.max(1) as f32;
    area.sqrt()
}

/// Mean horizontal distance between pulses about each of `positions`, (N), metres.
pub(super) fn pulse_spacing(positions: &[[f32; 3]], counts: &Cells<u32>) -> Vec<f32> {
    positions.par_iter().map(|&p| spacing_of(counts.get(cell(p)).unwrap_or_default())).collect()
}

/// Median of [`spacing_of`] over the cells that pulses reach, metres; 0 for none.
pub(super) fn median_spacing(counts: &Cells<u32>) -> f32 {
    let mut counts: Vec<u32> = counts.iter().map(|(_, count)| count).collect();
    counts.sort_unstable();
    counts.get(counts.len() / 2).map_or(0.0, |&count| spacing_of(count))
}
