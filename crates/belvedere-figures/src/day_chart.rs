//! Charts of a year: days across, hours of the clock up.

use crate::font::{HEIGHT, draw_text, fitted, text_width};
use crate::picture::{INK, PAPER, Picture};
use belvedere_data::cast::to_index;

/// Pixels of a day and of an hour, and of a dot of text.
const DAY: usize = 3;
const HOUR: usize = 20;
const SCALE: usize = 2;
const NIGHT: [u8; 3] = [226, 229, 234];
const LIGHT: [u8; 3] = [250, 248, 240];
const GRID: [u8; 3] = [198, 204, 212];

/// A piece of a day: its number from 0, start and end in hours of the clock, and colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DayPiece {
    /// Number of the day.
    pub day: usize,
    /// Start and end, hours.
    pub hours: [f64; 2],
    /// Its colour.
    pub color: [u8; 3],
}

/// A chart of `labels.len()` days: `light` is the time between sunrise and sunset of each, later pieces lie over
/// earlier ones. A label that is not empty begins a month; `legend` names colours.
#[must_use]
pub fn day_chart(
    labels: &[String],
    light: &[[f64; 2]],
    pieces: &[DayPiece],
    legend: &[([u8; 3], &str)],
    title: &str,
) -> Picture {
    let (margin, line) = (8 * SCALE, (HEIGHT + 4) * SCALE);
    let day = DAY.max(360 / labels.len().max(1));
    let left = margin + text_width("00:00", SCALE) + 4 * SCALE;
    let top = margin + 2 * line + 4 * SCALE;
    let (width, height) = (labels.len() * day, 24 * HOUR);
    let mut sheet = Picture::filled(left + width + margin, top + height + line + margin, PAPER);
    let title = fitted(title, left + width - 2 * margin, SCALE);
    draw_text(&mut sheet, margin, margin, &title, SCALE, INK);
    let mut at = margin;
    for (color, text) in legend {
        sheet.fill_rectangle([at, margin + line], [HEIGHT * SCALE, HEIGHT * SCALE], *color);
        draw_text(&mut sheet, at + (HEIGHT + 4) * SCALE, margin + line, text, SCALE, INK);
        at += (HEIGHT + 12) * SCALE + text_width(text, SCALE);
    }
    sheet.fill_rectangle([left, top], [width, height], NIGHT);
    let row = |hours: f64| {
        let row = to_index((hours.clamp(0.0, 24.0) * HOUR as f64).round());
        top + height - row
    };
    let fill = |sheet: &mut Picture, number: usize, hours: [f64; 2], color| {
        // hours before and after the day are drawn at its other end
        for shift in [-24.0, 0.0, 24.0] {
            let [low, high] = hours.map(|hour| row(hour + shift));
            if number < labels.len() && high < low {
                sheet.fill_rectangle([left + number * day, high], [day, low - high], color);
            }
        }
    };
    for (number, &hours) in light.iter().enumerate() {
        fill(&mut sheet, number, hours, LIGHT);
    }
    for (hour, number) in (0..=24).step_by(3).zip(0_u32..) {
        sheet.fill_rectangle([left, row(f64::from(number * 3))], [width, 1], GRID);
        let text = format!("{hour:02}:00");
        let text_left = left.saturating_sub(text_width(&text, SCALE) + 4 * SCALE);
        draw_text(&mut sheet, text_left, row(f64::from(number * 3)).saturating_sub(HEIGHT), &text, SCALE, INK);
    }
    for (number, label) in labels.iter().enumerate().filter(|(_, label)| !label.is_empty()) {
        sheet.fill_rectangle([left + number * day, top], [1, height], GRID);
        draw_text(&mut sheet, left + number * day + 2 * SCALE, top + height + 2 * SCALE, label, SCALE, INK);
    }
    for piece in pieces {
        fill(&mut sheet, piece.day, piece.hours, piece.color);
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_lie_at_their_day_and_hours() {
        let labels: Vec<String> = (0..365).map(|day| if day == 0 { "Jan".to_owned() } else { String::new() }).collect();
        let red = [200, 30, 30];
        let piece = DayPiece { day: 100, hours: [6.0, 7.0], color: red };
        let chart = day_chart(&labels, &vec![[6.0, 18.0]; 365], &[piece], &[], "Glare");
        let count = (0..chart.height).flat_map(|y| (0..chart.width).map(move |x| [x, y]));
        let of_piece: Vec<[usize; 2]> = count.filter(|&[x, y]| chart.get(x, y) == Some(red)).collect();
        assert_eq!(of_piece.len(), DAY * HOUR);
        // an hour before midnight and an hour after it
        let late = DayPiece { hours: [23.0, 25.0], ..piece };
        let chart = day_chart(&labels, &[], &[late], &[], "");
        let count = (0..chart.height).flat_map(|y| (0..chart.width).map(move |x| [x, y]));
        assert_eq!(count.filter(|&[x, y]| chart.get(x, y) == Some(red)).count(), 2 * DAY * HOUR);
        // beyond the days and upside down there is nothing to draw
        let odd = [
            DayPiece { day: 365, ..piece },
            DayPiece { hours: [7.0, 6.0], ..piece },
            DayPiece { hours: [f64::NAN; 2], ..piece },
        ];
        let chart = day_chart(&labels, &[], &odd, &[], "");
        let is_drawn =
            |chart: &Picture| (0..chart.height).any(|y| (0..chart.width).any(|x| chart.get(x, y) == Some(red)));
        assert!(!is_drawn(&chart) && !is_drawn(&day_chart(&[], &[], &odd, &[], "")));
    }
}
