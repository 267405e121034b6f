//! How far pulses pass from each other: the length that sizes of balls are given in.
//!
//! What lies between two pulses nothing is known of. Balls that close a surface are as large as that, whatever the survey: half a metre
//! for two pulses a square metre, half a decimetre for a hundred.

use super::cells::{Cells, cell};
use belvedere_data::Attributes;
use rayon::prelude::*;

/// Area that pulses are counted on, m²: a cell and those about it.
const AREA_M2: f32 = 9.0;

/// Mean horizontal distance between pulses about each of `positions`, (N), metres: the side of the square that each has to itself. A pulse
/// counts by its first return; without return numbers all points do.
pub(super) fn pulse_spacing(positions: &[[f32; 3]], attributes: &Attributes) -> Vec<f32> {
    let numbers = attributes.return_number.as_deref();
    let is_first = |row: usize| numbers.and_then(|numbers| numbers.get(row)).is_none_or(|&number| number <= 1);
    let rows = (0..positions.len()).into_par_iter();
    let counts = rows.map(|row| (cell(positions[row]), u32::from(is_first(row)))).collect();
    let near = Cells::new(counts, |a, b| a + b).with_neighbors(|a, b| a + b);
    let spacing = |&p: &[f32; 3]| {
        let count = near.get(cell(p)).unwrap_or_default().max(1);
        #[expect(clippy::cast_precision_loss, reason = "a count on nine square metres")]
        let area = AREA_M2 / count as f32;
        area.sqrt()
    };
    positions.par_iter().map(spacing).collect()
}
