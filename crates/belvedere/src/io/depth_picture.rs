//! Depth maps as pictures with a legend.

use rayon::prelude::*;

use crate::io::colors::{percentiles, ramp};
use crate::io::font::{HEIGHT, draw_text, fitted, text_width};
use crate::io::picture::{INK, PAPER, Picture, text_scale};
use crate::raster::Raster;

/// Where a view hit nothing.
const NOTHING: [u8; 3] = [222, 224, 228];
const NOTHING_LABEL: &str = "nothing hit";
const TITLE_GAP: usize = 6;
/// Maps smaller than this are enlarged.
const LEAST_SIDE: usize = 480;

/// A picture of a depth map, metres: near yellow, far violet, light grey where nothing was hit (not finite), with `title`
/// above and a legend at the right. The colours span the first to the last hundredth of the depths, so that a few far pixels
/// do not flatten the rest. Small maps are enlarged by repeating pixels.
#[must_use]
pub fn depth_picture(depth: &Raster<f32>, title: &str) -> Picture {
    let (near, far) =
        percentiles(depth.values(), 0.01, 0.99).map_or((0.0, 1.0), |(near, far)| (f64::from(near), f64::from(far)));
    let span = if far > near { far - near } else { 1.0 };
    let mut map = Picture::filled(depth.width(), depth.height(), NOTHING);
    map.rgb.par_chunks_exact_mut(3).zip(depth.values()).for_each(|(pixel, &value)| {
        if value.is_finite() {
            pixel.copy_from_slice(&ramp(1.0 - (f64::from(value) - near) / span));
        }
    });
    let longest = map.width.max(map.height).max(1);
    let map = map.enlarged((LEAST_SIDE.div_ceil(longest)).clamp(1, LEAST_SIDE));
    with_legend(&map, near, near + span, title)
}

fn with_legend(map: &Picture, near: f64, far: f64, title: &str) -> Picture {
    let scale = text_scale(map.width.max(map.height));
    let (margin, line) = (8 * scale, (HEIGHT + 4) * scale);
    let (step, ticks) = ticks(near, far);
    let decimals = (0..6).find(|&d| step * 10.0_f64.powi(d) >= 0.999).map_or(6, |d| usize::try_from(d).unwrap_or(0));
    let labels: Vec<String> =
        ticks.iter().map(|v| format!("{:.decimals$}", if *v == 0.0 { 0.0 } else { *v })).collect();

    let bar_width = 12 * scale;
    // room for the swatch of "nothing hit" below the bar, whatever the height of the map
    let bar_height = map.height.max(line * 7).saturating_sub(line * 4).min(320 * scale);
    let label_left = margin * 2 + map.width + bar_width + 5 * scale;
    let widest =
        labels.iter().map(String::as_str).chain(["depth (m)"]).map(|t| text_width(t, scale)).max().unwrap_or(0);
    let legend_right =
        (label_left + widest).max(margin * 2 + map.width + bar_width + 5 * scale + text_width(NOTHING_LABEL, scale));
    let header = if title.is_empty() { 0 } else { line + TITLE_GAP * scale };
    let top = margin + header;
    let height = top + map.height.max(bar_height + line * 4) + margin;
    let mut sheet = Picture::filled(legend_right + margin, height, PAPER);
    let title = fitted(title, sheet.width - 2 * margin, scale);
    draw_text(&mut sheet, margin, margin, &title, scale, INK);
    sheet.paste(map, [margin, top]);

    let left = margin * 2 + map.width;
    draw_text(&mut sheet, left, top, "depth (m)", scale, INK);
    let bar_top = top + line + HEIGHT * scale / 2;
    let rim = scale.div_ceil(2);
    sheet.fill_rectangle([left - rim, bar_top - rim], [bar_width + 2 * rim, bar_height + 2 * rim], INK);
    for row in 0..bar_height {
        let color = ramp(1.0 - (row as f64 + 0.5) / bar_height as f64);
        sheet.fill_rectangle([left, bar_top + row], [bar_width, 1], color);
    }
    for (value, label) in ticks.iter().zip(&labels) {
        let share = (value - near) / (far - near);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of the bar's height")]
        let row = (share.clamp(0.0, 1.0) * (bar_height.saturating_sub(1)) as f64).round() as usize;
        sheet.fill_rectangle([left + bar_width, bar_top + row], [3 * scale, scale], INK);
        let text_top = (bar_top + row + scale / 2).saturating_sub(7 * scale / 2);
        draw_text(&mut sheet, label_left, text_top, label, scale, INK);
    }
    let swatch_top = bar_top + bar_height + line;
    sheet.fill_rectangle([left - rim, swatch_top - rim], [bar_width + 2 * rim, 8 * scale + 2 * rim], INK);
    sheet.fill_rectangle([left, swatch_top], [bar_width, 8 * scale], NOTHING);
    draw_text(&mut sheet, label_left, swatch_top + scale / 2, NOTHING_LABEL, scale, INK);
    sheet
}

/// Step and values of about five round numbers within a range.
fn ticks(low: f64, high: f64) -> (f64, Vec<f64>) {
    let rough = (high - low) / 5.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|&s| s >= rough * 0.999).unwrap_or(power * 10.0);
    let first = (low / step).ceil();
    let values = (0..12).map(|i| (first + f64::from(i)) * step).take_while(|&v| v <= high + 1e-9 * step).collect();
    (step, values)
}
