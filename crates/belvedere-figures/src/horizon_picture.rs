//! Horizons as diagrams: azimuth across, elevation up.

use crate::font::{HEIGHT, draw_text, fitted, text_width};
use crate::picture::{INK, PAPER, Picture};

/// Size of the diagram, pixels, and of a dot of its text.
const SIZE: [usize; 2] = [1100, 420];
const SCALE: usize = 2;
const SKY: [u8; 3] = [214, 232, 248];
const SOLID: [u8; 3] = [96, 102, 112];
const GRID: [u8; 3] = [178, 190, 202];
/// Names of azimuths, eighths of a circle apart from north.
const COMPASS: [&str; 9] = ["N", "NE", "E", "SE", "S", "SW", "W", "NW", "N"];

/// A diagram of `elevations_deg`, one for each of equal steps clockwise from north: the sky pale, what stands before it
/// grey. It reaches from the horizon, or from the lowest elevation above -30 where one is below it, to the next ten
/// degrees above the highest.
#[must_use]
pub fn horizon_picture(elevations_deg: &[f64], title: &str) -> Picture {
    let margin = 8 * SCALE;
    let line = (HEIGHT + 4) * SCALE;
    let mut sheet = Picture::filled(SIZE[0], SIZE[1], PAPER);
    let title = fitted(title, SIZE[0] - 2 * margin, SCALE);
    draw_text(&mut sheet, margin, margin, &title, SCALE, INK);
    let left = margin + text_width("-00°", SCALE) + 4 * SCALE;
    let (right, top, bottom) =
        (SIZE[0] - margin - text_width("N", SCALE), margin + line + 4 * SCALE, SIZE[1] - 2 * line);
    let finite = || elevations_deg.iter().copied().filter(|v| v.is_finite());
    let highest = finite().fold(10.0, f64::max);
    let lowest = finite().filter(|v| *v > -30.0).fold(0.0, f64::min);
    let (low, high) = ((lowest / 10.0).floor() * 10.0, ((highest / 10.0).ceil() * 10.0).min(90.0));
    let row_of = |elevation: f64| {
        let share = ((elevation - low) / (high - low)).clamp(0.0, 1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the picture")]
        let row = (bottom as f64 - share * (bottom - top) as f64).round() as usize;
        row
    };
    sheet.fill_rectangle([left, top], [right - left, bottom - top], SKY);
    let step = if high - low > 45.0 {
        15.0
    } else if high - low > 20.0 {
        10.0
    } else {
        5.0
    };
    let ticks = || (0..20).map(|i| ((low / step).ceil() + f64::from(i)) * step).take_while(|v| *v <= high);
    for tick in ticks() {
        sheet.fill_rectangle([left, row_of(tick)], [right - left, 1], GRID);
    }
    for (i, name) in COMPASS.iter().enumerate() {
        let column = left + i * (right - left) / 8;
        sheet.fill_rectangle([column, top], [1, bottom - top], GRID);
        let text_left = column.saturating_sub(text_width(name, SCALE) / 2);
        draw_text(&mut sheet, text_left, bottom + 4 * SCALE, name, SCALE, INK);
    }
    let count = elevations_deg.len().max(1);
    for column in left..right {
        // the value whose azimuth is nearest
        let at = ((column - left) * count * 2 + (right - left)) / (2 * (right - left)) % count;
        if let Some(&elevation) = elevations_deg.get(at).filter(|v| **v > low) {
            let row = row_of(elevation);
            sheet.fill_rectangle([column, row], [1, bottom - row], SOLID);
        }
    }
    for tick in ticks() {
        let text = format!("{tick:.0}°");
        let text_left = left.saturating_sub(text_width(&text, SCALE) + 3 * SCALE);
        draw_text(&mut sheet, text_left, row_of(tick).saturating_sub(4 * SCALE), &text, SCALE, INK);
    }
    sheet.fill_rectangle([left, row_of(0.0)], [right - left, 2], INK);
    sheet.fill_rectangle([left, top], [2, bottom - top], INK);
    sheet
}
