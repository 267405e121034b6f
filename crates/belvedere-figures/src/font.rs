//! A small bitmap font, so that legends need no font file.

use crate::picture::Picture;

/// Columns of a character including the gap to the next.
pub(crate) const ADVANCE: usize = 6;
/// Rows of a character including one for descenders.
pub(crate) const HEIGHT: usize = 8;

/// Rows from the top, bit 4 the leftmost of five columns; from blank to tilde in the order of ASCII.
#[rustfmt::skip]
const GLYPHS: [[u8; HEIGHT]; 95] = [
    [0, 0, 0, 0, 0, 0, 0, 0], [4, 4, 4, 4, 4, 0, 4, 0], [10, 10, 10, 0, 0, 0, 0, 0], [10, 10, 31, 10, 31, 10, 10, 0],
    [4, 15, 20, 14, 5, 30, 4, 0], [24, 25, 2, 4, 8, 19, 3, 0], [12, 18, 20, 8, 21, 18, 13, 0], [4, 4, 8, 0, 0, 0, 0, 0],
    [2, 4, 8, 8, 8, 4, 2, 0], [8, 4, 2, 2, 2, 4, 8, 0], [0, 4, 21, 14, 21, 4, 0, 0], [0, 4, 4, 31, 4, 4, 0, 0],
    [0, 0, 0, 0, 0, 12, 4, 8], [0, 0, 0, 31, 0, 0, 0, 0], [0, 0, 0, 0, 0, 12, 12, 0], [0, 1, 2, 4, 8, 16, 0, 0],
    [14, 17, 19, 21, 25, 17, 14, 0], [4, 12, 4, 4, 4, 4, 14, 0], [14, 17, 1, 6, 8, 16, 31, 0], [14, 17, 1, 6, 1, 17, 14, 0],
    [2, 6, 10, 18, 31, 2, 2, 0], [31, 16, 30, 1, 1, 17, 14, 0], [6, 8, 16, 30, 17, 17, 14, 0], [31, 1, 2, 4, 8, 8, 8, 0],
    [14, 17, 17, 14, 17, 17, 14, 0], [14, 17, 17, 15, 1, 2, 12, 0], [0, 12, 12, 0, 12, 12, 0, 0], [0, 12, 12, 0, 12, 4, 8, 0],
    [1, 2, 4, 8, 4, 2, 1, 0], [0, 0, 31, 0, 31, 0, 0, 0], [16, 8, 4, 2, 4, 8, 16, 0], [14, 17, 1, 2, 4, 0, 4, 0],
    [14, 17, 23, 21, 23, 16, 14, 0], [4, 10, 17, 17, 31, 17, 17, 0], [30, 17, 17, 30, 17, 17, 30, 0], [14, 17, 16, 16, 16, 17, 14, 0],
    [28, 18, 17, 17, 17, 18, 28, 0], [31, 16, 16, 30, 16, 16, 31, 0], [31, 16, 16, 30, 16, 16, 16, 0], [14, 17, 16, 23, 17, 17, 15, 0],
    [17, 17, 17, 31, 17, 17, 17, 0], [14, 4, 4, 4, 4, 4, 14, 0], [7, 2, 2, 2, 2, 18, 12, 0], [17, 18, 20, 24, 20, 18, 17, 0],
    [16, 16, 16, 16, 16, 16, 31, 0], [17, 27, 21, 21, 17, 17, 17, 0], [17, 25, 21, 19, 17, 17, 17, 0], [14, 17, 17, 17, 17, 17, 14, 0],
    [30, 17, 17, 30, 16, 16, 16, 0], [14, 17, 17, 17, 21, 18, 13, 0], [30, 17, 17, 30, 20, 18, 17, 0], [15, 16, 16, 14, 1, 1, 30, 0],
    [31, 4, 4, 4, 4, 4, 4, 0], [17, 17, 17, 17, 17, 17, 14, 0], [17, 17, 17, 17, 10, 10, 4, 0], [17, 17, 17, 21, 21, 27, 17, 0],
    [17, 17, 10, 4, 10, 17, 17, 0], [17, 17, 10, 4, 4, 4, 4, 0], [31, 1, 2, 4, 8, 16, 31, 0], [14, 8, 8, 8, 8, 8, 14, 0],
    [0, 16, 8, 4, 2, 1, 0, 0], [14, 2, 2, 2, 2, 2, 14, 0], [4, 10, 17, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0, 31],
    [8, 4, 2, 0, 0, 0, 0, 0], [0, 0, 14, 1, 15, 17, 15, 0], [16, 16, 30, 17, 17, 17, 30, 0], [0, 0, 14, 17, 16, 17, 14, 0],
    [1, 1, 15, 17, 17, 17, 15, 0], [0, 0, 14, 17, 31, 16, 14, 0], [6, 9, 8, 28, 8, 8, 8, 0], [0, 0, 15, 17, 17, 15, 1, 14],
    [16, 16, 30, 17, 17, 17, 17, 0], [4, 0, 12, 4, 4, 4, 14, 0], [2, 0, 6, 2, 2, 2, 18, 12], [16, 16, 18, 20, 24, 20, 18, 0],
    [12, 4, 4, 4, 4, 4, 14, 0], [0, 0, 26, 21, 21, 21, 21, 0], [0, 0, 30, 17, 17, 17, 17, 0], [0, 0, 14, 17, 17, 17, 14, 0],
    [0, 0, 30, 17, 17, 30, 16, 16], [0, 0, 15, 17, 17, 15, 1, 1], [0, 0, 22, 25, 16, 16, 16, 0], [0, 0, 15, 16, 14, 1, 30, 0],
    [8, 8, 28, 8, 8, 9, 6, 0], [0, 0, 17, 17, 17, 19, 13, 0], [0, 0, 17, 17, 17, 10, 4, 0], [0, 0, 17, 17, 21, 21, 10, 0],
    [0, 0, 17, 10, 4, 10, 17, 0], [0, 0, 17, 17, 17, 15, 1, 14], [0, 0, 31, 2, 4, 8, 31, 0], [2, 4, 4, 8, 4, 4, 2, 0],
    [4, 4, 4, 4, 4, 4, 4, 0], [8, 4, 4, 2, 4, 4, 8, 0], [0, 0, 8, 21, 2, 0, 0, 0],
];
const DEGREE: [u8; HEIGHT] = [12, 18, 18, 12, 0, 0, 0, 0];
const SQUARED: [u8; HEIGHT] = [12, 2, 4, 8, 14, 0, 0, 0];
const UNKNOWN: [u8; HEIGHT] = [31, 17, 17, 17, 17, 17, 31, 0];

fn glyph(c: char) -> [u8; HEIGHT] {
    match c {
        '°' => DEGREE,
        '²' => SQUARED,
        '–' | '—' | '−' => GLYPHS[13],
        _ => u32::from(c).checked_sub(32).and_then(|i| GLYPHS.get(i as usize)).copied().unwrap_or(UNKNOWN),
    }
}

/// Width in pixels of `text` at `scale` pixels per dot.
pub(crate) fn text_width(text: &str, scale: usize) -> usize {
    (text.chars().count() * ADVANCE).saturating_sub(1) * scale
}

/// Draws `text` with its upper left corner at (`x`, `y`); what lies outside the picture is cut off.
pub(crate) fn draw_text(picture: &mut Picture, x: usize, y: usize, text: &str, scale: usize, color: [u8; 3]) {
    for (place, c) in text.chars().enumerate() {
        for (row, bits) in glyph(c).into_iter().enumerate() {
            for column in (0..5).filter(|column| bits >> (4 - column) & 1 == 1) {
                let left = x + (place * ADVANCE + column) * scale;
                picture.fill_rectangle([left, y + row * scale], [scale, scale], color);
            }
        }
    }
}

/// `text` cut with dots at the end so that it fits into `width` pixels.
pub(crate) fn fitted(text: &str, width: usize, scale: usize) -> String {
    if text_width(text, scale) <= width {
        return text.to_owned();
    }
    let most = (width / scale + 1) / ADVANCE;
    let kept: String = text.chars().take(most.saturating_sub(2)).collect();
    format!("{}..", kept.trim_end())
}
