//! Depth maps as pictures with a legend.

use belvedere_data::cast::{to_index, to_u8};
use rayon::prelude::*;

use crate::font::{HEIGHT, draw_text, fitted, text_width};
use crate::picture::{INK, PAPER, Picture, text_scale};
use crate::round_step::round_step;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{cross, dot, sub, unit};
use belvedere_data::view::{View, panorama_direction};
use belvedere_io::colors::{percentiles, ramp};

/// Colour of pixels without a surface.
const NOTHING: [u8; 3] = [222, 224, 228];
const NOTHING_LABEL: &str = "nothing hit";
const TITLE_GAP: usize = 6;
/// Share of the colour that a surface edge-on shows.
const AMBIENT: f64 = 0.35;
/// Maps smaller than this are enlarged.
const MIN_SIDE: usize = 480;

/// A picture of a depth map, metres: near yellow, far violet, light grey where nothing was hit (not finite), with
/// `title` above and a legend at the right. The colours span the first to the last hundredth of the depths, so that a
/// few far pixels do not flatten the rest. Small maps are enlarged by repeating pixels.
#[must_use]
pub fn depth_picture(depth: &Raster<f32>, title: &str) -> Picture {
    let (near, far) =
        percentiles(depth.values(), 0.01, 0.99).map_or((0.0, 1.0), |(near, far)| (f64::from(near), f64::from(far)));
    let colors = DepthColors::Even { near, span: if far > near { far - near } else { 1.0 } };
    with_legend(&enlarged(colored(depth, &colors, |_| 1.0)), &colors, title, "depth (m)")
}

/// Draws the depths that `view` shows, as [`depth_picture`], but for an eye. Equal ratios of depth are equal steps of
/// colour, since near depths would otherwise be all alike. Surfaces are shaded as if lit from the upper left behind the
/// eye.
#[must_use]
pub fn camera_picture(view: &View, depth: &Raster<f32>, title: &str) -> Picture {
    let position =
        |[column, row]: [usize; 2], depth: f64| view.position([column as f64 + 0.5, row as f64 + 0.5], depth);
    let colors = DepthColors::by_ratio(depth);
    let shaded = colored(depth, &colors, |pixel| {
        facing(depth, pixel, position).map_or(1.0, |(normal, to_eye)| shade(normal, to_eye, [-0.4, -0.6, 0.0]))
    });
    with_legend(&enlarged(shaded), &colors, title, "depth (m)")
}

/// A picture of the ranges around an eye, columns and rows as in [`panorama_direction`], coloured and shaded as
/// [`camera_picture`], with the points of the compass below.
#[must_use]
pub fn panorama_picture(range: &Raster<f32>, title: &str) -> Picture {
    let width = range.width();
    let position = |pixel: [usize; 2], range: f64| panorama_direction(width, pixel).map(|v| v * range);
    let colors = DepthColors::by_ratio(range);
    let shaded = colored(range, &colors, |pixel| {
        facing(range, pixel, position).map_or(1.0, |(normal, to_eye)| {
            // left of the line of sight, and up
            let left = unit([-to_eye[1], to_eye[0], 0.0]).unwrap_or([0.0; 3]).map(|v| -0.4 * v);
            shade(normal, to_eye, [left[0], left[1], 0.6])
        })
    });
    with_legend(&with_compass(&enlarged(shaded)), &colors, title, "range (m)")
}

/// Colour scale of depths.
enum DepthColors {
    /// Equal differences are equal steps of colour.
    Even { near: f64, span: f64 },
    /// Equal ratios are.
    ByRatio { near: f64, far: f64 },
}

impl DepthColors {
    /// Colours by ratio from the first to the last hundredth of the depths above zero.
    fn by_ratio(depth: &Raster<f32>) -> Self {
        let (near, far) = percentiles(depth.values(), 0.01, 0.99).unwrap_or((1.0, 10.0));
        let near = f64::from(near).max(0.1);
        Self::ByRatio { near, far: f64::from(far).max(near * 2.0) }
    }

    fn limits(&self) -> [f64; 2] {
        match *self {
            Self::Even { near, span } => [near, near + span],
            Self::ByRatio { near, far } => [near, far],
        }
    }

    /// Returns the position of a depth between the limits, 0 to 1 from near to far.
    fn share(&self, depth: f64) -> f64 {
        match *self {
            Self::Even { near, span } => (depth - near) / span,
            Self::ByRatio { near, far } => (depth.max(near) / near).ln() / (far / near).ln(),
        }
    }

    /// Values for the legend, and the digits behind their points.
    fn ticks(&self) -> (usize, Vec<f64>) {
        let [near, far] = self.limits();
        match self {
            Self::Even { .. } => {
                let (step, ticks) = ticks(near, far);
                let digits = |&d: &i32| step * 10.0_f64.powi(d) >= 0.999;
                ((0..6).find(digits).map_or(6, |d| usize::try_from(d).unwrap_or(0)), ticks)
            }
            Self::ByRatio { .. } => {
                let coarse = [1.0, 2.0, 5.0];
                let fine = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0];
                let series = |steps: &[f64]| -> Vec<f64> {
                    let powers = (-1..9).map(|power| 10.0_f64.powi(power));
                    let all = powers.flat_map(|power| steps.iter().map(move |step| step * power));
                    all.filter(|v| (near..=far).contains(v)).collect()
                };
                let ticks = series(&coarse);
                let ticks = if ticks.len() < 4 { series(&fine) } else { ticks };
                (usize::from(ticks.iter().any(|v| v.fract() != 0.0)), ticks)
            }
        }
    }
}

/// The colour of each depth, darkened to a share of itself.
fn colored(depth: &Raster<f32>, colors: &DepthColors, share: impl Fn([usize; 2]) -> f64 + Sync) -> Picture {
    let width = depth.width().max(1);
    let mut map = Picture::filled(depth.width(), depth.height(), NOTHING);
    map.rgb.par_chunks_exact_mut(3).zip(depth.values()).enumerate().for_each(|(at, (pixel, &value))| {
        if value.is_finite() {
            let color = ramp(1.0 - colors.share(f64::from(value)));
            let share = share([at % width, at / width]);
            pixel.copy_from_slice(&if share < 1.0 { scaled(color, share) } else { color });
        }
    });
    map
}

fn scaled(color: [u8; 3], share: f64) -> [u8; 3] {
    color.map(|channel| to_u8((f64::from(channel) * share.clamp(0.0, 1.0)).round()))
}

/// Returns the unit normal of the surface that a pixel shows, and the unit vector towards the eye at the origin of
/// `position`. `None` if no neighbour in one of both directions shows a surface.
fn facing(
    depth: &Raster<f32>,
    [column, row]: [usize; 2],
    position: impl Fn([usize; 2], f64) -> [f64; 3],
) -> Option<([f64; 3], [f64; 3])> {
    let at = |pixel: [usize; 2]| {
        let depth = depth.get(pixel[0], pixel[1]).filter(|depth| depth.is_finite())?;
        Some((position(pixel, f64::from(depth)), f64::from(depth)))
    };
    let (here, own) = at([column, row])?;
    // of both neighbours the one that lies more likely on the same surface
    let step = |before: Option<[usize; 2]>, after: [usize; 2]| {
        let neighbors = [(before, -1.0), (Some(after), 1.0)];
        let found = neighbors.into_iter().filter_map(|(pixel, sign)| Some((at(pixel?)?, sign)));
        let ((there, _), sign) = found.min_by(|a, b| (a.0.1 - own).abs().total_cmp(&(b.0.1 - own).abs()))?;
        Some(sub(there, here).map(|v| v * sign))
    };
    let across = step(column.checked_sub(1).map(|column| [column, row]), [column + 1, row])?;
    let down = step(row.checked_sub(1).map(|row| [column, row]), [column, row + 1])?;
    let (normal, to_eye) = (unit(cross(across, down))?, unit(here.map(|v| -v))?);
    let sign = if dot(normal, to_eye) < 0.0 { -1.0 } else { 1.0 };
    Some((normal.map(|v| v * sign), to_eye))
}

/// Share of its colour that a surface shows under a lamp which lies `aside` of the eye.
fn shade(normal: [f64; 3], to_eye: [f64; 3], aside: [f64; 3]) -> f64 {
    let to_light = unit(std::array::from_fn(|i| to_eye[i] + aside[i])).unwrap_or(to_eye);
    AMBIENT + (1.0 - AMBIENT) * dot(normal, to_light).max(0.0)
}

fn enlarged(map: Picture) -> Picture {
    let longest = map.width.max(map.height).max(1);
    map.enlarged((MIN_SIDE.div_ceil(longest)).clamp(1, MIN_SIDE))
}

/// A panorama with the points of the compass below.
fn with_compass(map: &Picture) -> Picture {
    let scale = text_scale(map.width.max(map.height));
    let mut sheet = Picture::filled(map.width, map.height + (HEIGHT + 5) * scale, PAPER);
    sheet.paste(map, [0, 0]);
    for (eighth, name) in ["S", "SW", "W", "NW", "N", "NE", "E", "SE", "S"].into_iter().enumerate() {
        let (at, width) = (map.width * eighth / 8, text_width(name, scale));
        let left = at.saturating_sub(width / 2).min(map.width.saturating_sub(width));
        sheet.fill_rectangle([at.min(map.width.saturating_sub(scale)), map.height], [scale, 3 * scale], INK);
        draw_text(&mut sheet, left, map.height + 4 * scale, name, scale, INK);
    }
    sheet
}

fn with_legend(map: &Picture, colors: &DepthColors, title: &str, legend: &str) -> Picture {
    let scale = text_scale(map.width.max(map.height));
    let (margin, line) = (8 * scale, (HEIGHT + 4) * scale);
    let (decimals, ticks) = colors.ticks();
    let labels: Vec<String> =
        ticks.iter().map(|v| format!("{:.decimals$}", if *v == 0.0 { 0.0 } else { *v })).collect();

    let bar_width = 12 * scale;
    // room for the swatch of "nothing hit" below the bar, whatever the height of the map
    let bar_height = map.height.max(line * 7).saturating_sub(line * 4).min(320 * scale);
    let label_left = margin * 2 + map.width + bar_width + 5 * scale;
    let widest = labels.iter().map(String::as_str).chain([legend]).map(|t| text_width(t, scale)).max().unwrap_or(0);
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
    draw_text(&mut sheet, left, top, legend, scale, INK);
    let bar_top = top + line + HEIGHT * scale / 2;
    let border = scale.div_ceil(2);
    sheet.fill_rectangle([left - border, bar_top - border], [bar_width + 2 * border, bar_height + 2 * border], INK);
    for row in 0..bar_height {
        let color = ramp(1.0 - (row as f64 + 0.5) / bar_height as f64);
        sheet.fill_rectangle([left, bar_top + row], [bar_width, 1], color);
    }
    for (value, label) in ticks.iter().zip(&labels) {
        let share = colors.share(*value);
        let row = to_index((share.clamp(0.0, 1.0) * (bar_height.saturating_sub(1)) as f64).round());
        sheet.fill_rectangle([left + bar_width, bar_top + row], [3 * scale, scale], INK);
        let text_top = (bar_top + row + scale / 2).saturating_sub(7 * scale / 2);
        draw_text(&mut sheet, label_left, text_top, label, scale, INK);
    }
    let swatch_top = bar_top + bar_height + line;
    sheet.fill_rectangle([left - border, swatch_top - border], [bar_width + 2 * border, 8 * scale + 2 * border], INK);
    sheet.fill_rectangle([left, swatch_top], [bar_width, 8 * scale], NOTHING);
    draw_text(&mut sheet, label_left, swatch_top + scale / 2, NOTHING_LABEL, scale, INK);
    sheet
}

/// Step and values of about five round numbers within a range.
fn ticks(low: f64, high: f64) -> (f64, Vec<f64>) {
    let step = round_step(0.999 * (high - low) / 5.0);
    let first = (low / step).ceil();
    let values = (0..12).map(|i| (first + f64::from(i)) * step).take_while(|&v| v <= high + 1e-9 * step).collect();
    (step, values)
}
