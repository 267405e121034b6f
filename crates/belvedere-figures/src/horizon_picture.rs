//! Horizons as diagrams: azimuth across, elevation up.

use crate::font::{HEIGHT, draw_text, fitted, text_width};
use crate::picture::{INK, PAPER, Picture};
use belvedere_data::cast::to_index;

/// Size of the diagram, pixels, and of a dot of its text.
const SIZE: [usize; 2] = [1100, 420];
const SCALE: usize = 2;
/// Width of the line of a skyline.
const LINE: usize = 2;
const SKY: [u8; 3] = [214, 232, 248];
const SOLID: [u8; 3] = [96, 102, 112];
/// Colour of elevations at which the sky may begin as well.
const UNSURE: [u8; 3] = [164, 174, 188];
const GRID: [u8; 3] = [178, 190, 202];
/// Names of azimuths, eighths of a circle apart from north.
const COMPASS: [&str; 9] = ["N", "NE", "E", "SE", "S", "SW", "W", "NW", "N"];

/// A diagram of `elevations_deg`, one for each of equal steps clockwise from north: the sky pale, obstacles before it
/// grey. Where `intervals_deg` has the ends of an interval, light grey lies between them, and a line on the elevation.
/// It reaches from the horizon, or from the lowest elevation above -30 where one is below it, to the next ten degrees
/// above the highest.
#[must_use]
pub fn horizon_picture(elevations_deg: &[f64], intervals_deg: Option<&[[f64; 2]]>, title: &str) -> Picture {
    let margin = 8 * SCALE;
    let line = (HEIGHT + 4) * SCALE;
    let mut sheet = Picture::filled(SIZE[0], SIZE[1], PAPER);
    let title = fitted(title, SIZE[0] - 2 * margin, SCALE);
    draw_text(&mut sheet, margin, margin, &title, SCALE, INK);
    let left = margin + text_width("-00°", SCALE) + 4 * SCALE;
    let (right, top, bottom) =
        (SIZE[0] - margin - text_width("N", SCALE), margin + line + 4 * SCALE, SIZE[1] - 2 * line);
    let all = || elevations_deg.iter().chain(intervals_deg.unwrap_or_default().as_flattened());
    let finite = || all().copied().filter(|v| v.is_finite());
    let highest = finite().fold(10.0, f64::max);
    let lowest = finite().filter(|v| *v > -30.0).fold(0.0, f64::min);
    let (low, high) = ((lowest / 10.0).floor() * 10.0, ((highest / 10.0).ceil() * 10.0).min(90.0));
    let row_of = |elevation: f64| {
        let share = ((elevation - low) / (high - low)).clamp(0.0, 1.0);
        to_index((bottom as f64 - share * (bottom - top) as f64).round())
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
        let mut fill = |elevation: Option<f64>, color| {
            if let Some(row) = elevation.filter(|v| *v > low).map(row_of) {
                sheet.fill_rectangle([column, row], [1, bottom - row], color);
            }
        };
        let elevation = elevations_deg.get(at).copied();
        match intervals_deg.and_then(|intervals| intervals.get(at)) {
            Some(&[from, to]) => {
                fill(Some(to), UNSURE);
                fill(Some(from), SOLID);
                if let Some(row) = elevation.filter(|v| *v > low).map(row_of) {
                    sheet.fill_rectangle([column, row], [1, LINE], INK);
                }
            }
            None => fill(elevation, SOLID),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_grey_lies_between_the_ends_of_an_interval() {
        let elevations = [20.0; 8];
        let plain = horizon_picture(&elevations, None, "plain");
        let sure = horizon_picture(&elevations, Some(&[[10.0, 30.0]; 8]), "sure");
        // a column between two lines of the grid
        let column = SIZE[0] / 2 + 40;
        let rows =
            |picture: &Picture, color| (0..SIZE[1]).filter(|&row| picture.get(column, row) == Some(color)).count();
        // the plain one reaches to 20 degrees, the other to 30
        let whole = rows(&plain, SOLID) as f64;
        assert!(whole > 200.0 && rows(&plain, UNSURE) == 0);
        let [solid, unsure] = [SOLID, UNSURE].map(|color| rows(&sure, color) as f64);
        // lines of the axis, of the grid and of the skyline take five pixels at most
        assert!((solid - whole / 3.0).abs() < 6.0 && (unsure - whole * 2.0 / 3.0).abs() < 6.0, "{solid} {unsure}");
    }
}
