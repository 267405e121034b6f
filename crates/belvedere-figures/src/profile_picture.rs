//! Profiles along a line of sight: the ground, the obstacles on it, and the line.

use crate::font::{HEIGHT, draw_text, fitted, text_width};
use crate::picture::{INK, PAPER, Picture};
use crate::round_step::round_step;
use belvedere_data::cast::to_index;

/// Size of the diagram, pixels, and of a dot of its text.
const SIZE: [usize; 2] = [1100, 420];
const SCALE: usize = 2;
const GROUND: [u8; 3] = [186, 160, 122];
const SOLID: [u8; 3] = [120, 124, 132];
const SEEN: [u8; 3] = [20, 140, 60];
const HIDDEN: [u8; 3] = [205, 45, 45];
const GRID: [u8; 3] = [228, 229, 233];

/// A profile, one value for each of equally spaced distances.
pub struct DistanceProfile<'a> {
    /// Distance on the map from the observer, metres, rising.
    pub distances: &'a [f64],
    /// Height of the ground, metres, NaN where not known.
    pub ground: &'a [f64],
    /// Height of the line of sight, metres.
    pub line: &'a [f64],
    /// Pieces of the vertical through each distance that lie in balls: (from, to) heights, metres.
    pub solid: &'a [Vec<[f64; 2]>],
    /// Distance on the map at which the line of sight is blocked, if it is, metres.
    pub blocked_at: Option<f64>,
    /// Title above the diagram.
    pub title: &'a str,
}

/// The profile as a diagram: ground brown, obstacles grey, the line green to where it is blocked and red behind.
/// Heights are exaggerated to fill it; both axes have their scale.
#[must_use]
pub fn profile_picture(profile: &DistanceProfile<'_>) -> Picture {
    let margin = 8 * SCALE;
    let line_height = (HEIGHT + 4) * SCALE;
    let mut sheet = Picture::filled(SIZE[0], SIZE[1], PAPER);
    let title = fitted(profile.title, SIZE[0] - 2 * margin, SCALE);
    draw_text(&mut sheet, margin, margin, &title, SCALE, INK);
    let (left, right) = (margin + text_width("-0000", SCALE) + 4 * SCALE, SIZE[0] - margin);
    let (top, bottom) = (margin + line_height + 4 * SCALE, SIZE[1] - margin - 2 * line_height);
    let span = profile.distances.last().copied().unwrap_or(1.0).max(1e-6);
    let tops = profile.solid.iter().flatten().map(|piece| piece[1]);
    let finite = || profile.ground.iter().chain(profile.line).copied().filter(|v| v.is_finite());
    let low = finite().fold(f64::INFINITY, f64::min);
    let high = finite().chain(tops.filter(|v| v.is_finite())).fold(f64::NEG_INFINITY, f64::max);
    if !(low <= high) {
        return sheet;
    }
    let pad = ((high - low) * 0.08).max(1.0);
    let (low, high) = (low - pad, high + pad);
    let column_of = |distance: f64| to_index(left as f64 + distance / span * (right - left) as f64);
    let row_of = |height: f64| {
        to_index(
            (bottom as f64 - (height - low) / (high - low) * (bottom - top) as f64).clamp(top as f64, bottom as f64),
        )
    };
    for (tick, text) in ticks(low, high) {
        let row = row_of(tick);
        sheet.fill_rectangle([left, row], [right - left, 1], GRID);
        let text_left = left.saturating_sub(text_width(&text, SCALE) + 3 * SCALE);
        draw_text(&mut sheet, text_left, row.saturating_sub(4 * SCALE), &text, SCALE, INK);
    }
    for (tick, text) in ticks(0.0, span) {
        let column = column_of(tick);
        sheet.fill_rectangle([column, top], [1, bottom - top], GRID);
        let text_left = column.saturating_sub(text_width(&text, SCALE) / 2).min(right - text_width(&text, SCALE));
        draw_text(&mut sheet, text_left, bottom + 3 * SCALE, &text, SCALE, INK);
    }
    for column in left..right {
        // the sample whose distance is nearest
        let share = (column - left) as f64 / (right - left) as f64;
        let last = profile.distances.len().saturating_sub(1);
        let sample = to_index(share * last as f64 + 0.5).min(last);
        for piece in profile.solid.get(sample).into_iter().flatten() {
            let (from, to) = (row_of(piece[1]), row_of(piece[0]));
            sheet.fill_rectangle([column, from], [1, (to - from).max(1)], SOLID);
        }
        if let Some(ground) = profile.ground.get(sample).filter(|v| v.is_finite()) {
            let row = row_of(*ground);
            sheet.fill_rectangle([column, row], [1, bottom - row], GROUND);
        }
        if let Some(line) = profile.line.get(sample) {
            let hidden = profile.blocked_at.is_some_and(|at| share * span > at);
            let color = if hidden { HIDDEN } else { SEEN };
            sheet.fill_rectangle([column, row_of(*line).saturating_sub(1)], [1, 3], color);
        }
    }
    sheet.fill_rectangle([left, top], [2, bottom - top], INK);
    sheet.fill_rectangle([left, bottom], [right - left, 2], INK);
    draw_legend(&mut sheet, [left, right], SIZE[1] - margin - 9 * SCALE);
    sheet
}

/// Draws the legend of the colours, in a row between two columns.
fn draw_legend(sheet: &mut Picture, [left, right]: [usize; 2], row: usize) {
    let mut at = left;
    for (color, text) in [(GROUND, "ground"), (SOLID, "blocks"), (SEEN, "seen"), (HIDDEN, "hidden")] {
        sheet.fill_rectangle([at, row], [12 * SCALE, 8 * SCALE], color);
        draw_text(sheet, at + 16 * SCALE, row + SCALE / 2, text, SCALE, INK);
        at += 30 * SCALE + text_width(text, SCALE);
    }
    let note = "metres; heights exaggerated";
    draw_text(sheet, right - text_width(note, SCALE), row, note, SCALE, INK);
}

/// About six round numbers between two values, as written.
fn ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let step = round_step((high - low) / 6.0);
    let decimals = usize::from(step < 1.0);
    (0..20)
        .map(|i| ((low / step).ceil() + f64::from(i)) * step)
        .take_while(|&v| v <= high)
        .map(|v| (v, format!("{v:.decimals$}")))
        .collect()
}
