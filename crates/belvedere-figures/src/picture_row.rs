//! Rows of pictures with captions.

use crate::font::{HEIGHT, draw_text, fitted};
use crate::picture::{INK, PAPER, Picture, text_scale};

/// `pictures` in one row from left to right, each under its caption; a caption that is too wide is cut, missing ones
/// stay empty. Pictures much smaller than the tallest are enlarged by a whole factor, so that they can be compared.
#[must_use]
pub fn side_by_side(pictures: &[Picture], captions: &[&str]) -> Picture {
    let tallest = pictures.iter().map(|p| p.height).max().unwrap_or(0);
    let scaled: Vec<Picture> = pictures.iter().map(|p| p.enlarged((tallest / p.height.max(1)).clamp(1, 64))).collect();
    let total: usize = scaled.iter().map(|p| p.width).sum();
    let scale = text_scale(tallest.max(total / scaled.len().max(1)));
    let gap = 8 * scale;
    let header = (HEIGHT + 4) * scale;
    let mut sheet = Picture::filled(total + gap * (scaled.len() + 1), tallest + header + 2 * gap, PAPER);
    let mut left = gap;
    for (i, picture) in scaled.iter().enumerate() {
        let caption = fitted(captions.get(i).copied().unwrap_or_default(), picture.width, scale);
        draw_text(&mut sheet, left, gap, &caption, scale, INK);
        sheet.paste(picture, [left, gap + header]);
        left += picture.width + gap;
    }
    sheet
}
