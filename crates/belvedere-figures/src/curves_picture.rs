//! Curves over a few values: how errors change with the density of a survey.

use crate::font::{HEIGHT, draw_text, fitted, text_width};
use crate::picture::{INK, PAPER, Picture};
use crate::round_step::round_step;
use belvedere_data::cast::to_index;

/// Size of the diagram, pixels, and of a dot of its text.
const SIZE: [usize; 2] = [760, 460];
const SCALE: usize = 2;
const GRID: [u8; 3] = [228, 229, 233];
/// One for each curve, from the start again after the last: dark and bright ones in turn.
const COLORS: [[u8; 3]; 8] = [
    [205, 45, 45],
    [30, 90, 200],
    [20, 140, 60],
    [230, 150, 20],
    [130, 60, 170],
    [20, 160, 170],
    [120, 90, 60],
    [110, 114, 122],
];

/// Curves that share their horizontal positions.
pub struct Curves<'a> {
    /// Title above the diagram.
    pub title: &'a str,
    /// Label of each position; they are equally far apart.
    pub positions: &'a [String],
    /// Name and values of each curve, one for each position, 0 or more; NaN where not known.
    pub curves: &'a [(String, Vec<f64>)],
}

/// The curves as a diagram from 0 to above the highest value, with their names below.
#[must_use]
pub fn curves_picture(curves: &Curves<'_>) -> Picture {
    let margin = 8 * SCALE;
    let line_height = (HEIGHT + 4) * SCALE;
    let mut sheet = Picture::filled(SIZE[0], SIZE[1], PAPER);
    let title = fitted(curves.title, SIZE[0] - 2 * margin, SCALE);
    draw_text(&mut sheet, margin, margin, &title, SCALE, INK);
    let (left, right) = (margin + text_width("00.0", SCALE) + 4 * SCALE, SIZE[0] - 3 * margin);
    let legend_height = curves.curves.len().div_ceil(2) * line_height;
    let (top, bottom) = (margin + line_height + 4 * SCALE, SIZE[1] - margin - line_height - legend_height);
    let highest = curves.curves.iter().flat_map(|(_, values)| values).copied().filter(|v| v.is_finite());
    let step = step_for(highest.fold(0.0, f64::max));
    let high = STEPS * step;
    let row_of = |value: f64| to_index(bottom as f64 - (value / high).min(1.0) * (bottom - top) as f64);
    let last = curves.positions.len().saturating_sub(1).max(1);
    let column_of = |index: usize| left + index * (right - left) / last;
    for tick in 0..=5_u8 {
        let value = f64::from(tick) * step;
        let (row, text) = (row_of(value), if step < 1.0 { format!("{value:.1}") } else { format!("{value:.0}") });
        sheet.fill_rectangle([left, row], [right - left, 1], GRID);
        let text_left = left.saturating_sub(text_width(&text, SCALE) + 3 * SCALE);
        draw_text(&mut sheet, text_left, row.saturating_sub(4 * SCALE), &text, SCALE, INK);
    }
    for (index, text) in curves.positions.iter().enumerate() {
        let column = column_of(index);
        sheet.fill_rectangle([column, top], [1, bottom - top], GRID);
        draw_text(&mut sheet, column.saturating_sub(text_width(text, SCALE) / 2), bottom + 3 * SCALE, text, SCALE, INK);
    }
    for (number, (name, values)) in curves.curves.iter().enumerate() {
        let color = COLORS[number % COLORS.len()];
        for (index, pair) in values.windows(2).enumerate() {
            let [from, to] = [index, index + 1].map(&column_of);
            if pair.iter().any(|value| !value.is_finite()) {
                continue;
            }
            let row = |column: usize| {
                let share = (column - from) as f64 / (to - from).max(1) as f64;
                row_of(pair[0] + share * (pair[1] - pair[0]))
            };
            for column in from..to {
                let (a, b) = (row(column), row(column + 1));
                sheet.fill_rectangle([column, a.min(b).saturating_sub(1)], [1, a.abs_diff(b) + 3], color);
            }
        }
        for (index, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            let corner = [column_of(index).saturating_sub(4), row_of(*value).saturating_sub(4)];
            sheet.fill_rectangle(corner, [9, 9], color);
        }
        let (column, row) = (number % 2, number / 2);
        let at = [margin + column * (SIZE[0] / 2), SIZE[1] - margin - legend_height + row * line_height + 4 * SCALE];
        sheet.fill_rectangle(at, [12 * SCALE, 8 * SCALE], color);
        let name = fitted(name, SIZE[0] / 2 - margin - 20 * SCALE, SCALE);
        draw_text(&mut sheet, at[0] + 16 * SCALE, at[1] + SCALE / 2, &name, SCALE, INK);
    }
    sheet.fill_rectangle([left, top], [2, bottom - top], INK);
    sheet.fill_rectangle([left, bottom], [right - left, 2], INK);
    sheet
}

/// Steps from the foot of the diagram to its top.
const STEPS: f64 = 5.0;

/// The least round step of which five reach `highest`.
fn step_for(highest: f64) -> f64 {
    round_step((highest / STEPS).max(0.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagram_reaches_from_zero_to_the_next_round_step_above_all_values() {
        for (highest, step) in [(0.0, 0.1), (0.5, 0.1), (0.51, 0.2), (7.0, 2.0), (10.0, 2.0), (26.0, 10.0)] {
            assert!((step_for(highest) - step).abs() < 1e-9, "{highest}: {}", step_for(highest));
        }
    }

    #[test]
    fn values_lie_where_their_axes_say() {
        let positions = ["5", "10", "20"].map(str::to_owned);
        let curves = [("flat".to_owned(), vec![5.0, 5.0, 5.0]), ("unknown".to_owned(), vec![f64::NAN; 3])];
        let picture = curves_picture(&Curves { title: "t", positions: &positions, curves: &curves });
        // a level line of the first colour halfway up an axis to 5, and nothing of the second above the legend
        let rows = |color: [u8; 3], column: usize| {
            (0..SIZE[1] - 60).filter(|&row| picture.get(column, row) == Some(color)).count()
        };
        let middle = SIZE[0] / 2 + 40;
        assert_eq!([rows(COLORS[0], middle), rows(COLORS[1], middle)], [3, 0]);
    }
}
