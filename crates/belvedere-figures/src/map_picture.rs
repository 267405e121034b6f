//! Maps over a shaded relief, with coordinates, a legend, a scale bar and an arrow to the north.

use belvedere_data::cast::{to_index, to_u8};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::font::{HEIGHT, draw_text, fitted, text_width, wrapped};
use crate::picture::{INK, PAPER, Picture, text_scale};
use crate::round_step::round_step;
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Result};
use belvedere_io::Georeference;
use belvedere_io::colors::ramp;

/// Maps smaller than this are enlarged.
const MIN_SIDE: usize = 600;
/// Colour of unknown relief.
const UNKNOWN: [u8; 3] = [236, 237, 240];
/// Share of a pixel that the colour of the map takes, the rest is relief.
const TINT: f64 = 0.5;
/// Towards the light, from the north-west, 45° high (east, north, up).
const TO_LIGHT: [f64; 3] = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];
/// Bare relief where it is level, for the legend.
const BARE: [u8; 3] = [197; 3];
/// Colours of a mark: its disc and the ring around it.
const MARK: [[u8; 3]; 2] = [[225, 30, 45], [255, 255, 255]];
/// Length of the view of a mark, width of its edge, and distance of its label, in radii of the mark.
const WEDGE: f64 = 7.0;
const EDGE: f64 = 0.2;
const LABEL: f64 = 4.5;

/// About so many coordinates along the longer side of a map.
const COORDINATES: f64 = 5.0;
/// Maximum number of round values beside a ramp.
const MAX_TICKS: f64 = 9.0;

/// Content of a map.
pub struct MapPicture<'a> {
    /// Heights whose relief lies below the colours, metres, NaN where not known; row 0 in the north.
    pub relief: &'a Raster<f32>,
    /// Side of a pixel, metres.
    pub cell: f64,
    /// Position of the map, for coordinates along its sides, in the reference system and unit of the file; `None` draws
    /// none.
    pub place: Option<&'a Georeference>,
    /// Colour of each pixel, as many as heights; `None`, where there is no answer, shows the bare relief, and the
    /// legend says so.
    pub colors: &'a [Option<[u8; 3]>],
    /// Places to mark.
    pub marks: &'a [MapMark],
    /// Name of the marks, for the legend.
    pub mark_name: &'a str,
    /// Title above the map.
    pub title: &'a str,
    /// Legend beside the map.
    pub legend: MapLegend<'a>,
}

impl<'a> MapPicture<'a> {
    /// A map without marks.
    #[must_use]
    pub fn of_colors(
        relief: &'a Raster<f32>,
        cell: f64,
        place: Option<&'a Georeference>,
        colors: &'a [Option<[u8; 3]>],
        title: &'a str,
        legend: MapLegend<'a>,
    ) -> Self {
        Self { relief, cell, place, colors, marks: &[], mark_name: "", title, legend }
    }
}

/// A place that is marked on a map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapMark {
    /// Columns from the west and rows from the north.
    pub place: [f64; 2],
    /// Azimuth that it looks to, clockwise from the north of the grid, and width of its view, radians: drawn as a
    /// wedge.
    pub view: Option<[f64; 2]>,
    /// Label beside it; empty for none.
    pub label: String,
}

/// Meaning of colours.
pub enum MapLegend<'a> {
    /// Each colour and its meaning.
    Colors(&'a [([u8; 3], &'a str)]),
    /// Colours from dark violet to yellow, as [`belvedere_io::ramp`] has them, between two values, with the name of the
    /// measure, and further colours with their meanings.
    Ramp(&'a str, [f64; 2], &'a [([u8; 3], &'a str)]),
}

/// The map as a picture with title, legend, scale bar and coordinates, small ones enlarged by repeating pixels.
///
/// # Errors
/// [`Error::LengthMismatch`] unless there is a colour, or none, for each height.
pub fn map_picture(map: &MapPicture<'_>) -> Result<Picture> {
    let factor = MIN_SIDE.div_ceil(map.relief.width().max(map.relief.height()).max(1)).clamp(1, MIN_SIDE);
    Ok(framed(&map_image(map, factor)?, map, map.cell / factor as f64))
}

/// The map alone, each pixel repeated `factor` times in both directions.
///
/// # Errors
/// Those of [`map_picture`].
pub fn map_image(map: &MapPicture<'_>, factor: usize) -> Result<Picture> {
    let (width, height) = (map.relief.width(), map.relief.height());
    if map.colors.len() != width * height {
        return Err(Error::LengthMismatch {
            what: "colours of a map",
            expected: width * height,
            found: map.colors.len(),
        });
    }
    let mut picture = Picture::filled(width, height, PAPER);
    picture.rgb.par_chunks_exact_mut(3).enumerate().for_each(|(at, pixel)| {
        let light = shade(map.relief, at % width, at / width, map.cell);
        let base = light.map_or(UNKNOWN.map(f64::from), |light| [70.0 + 180.0 * light; 3]);
        for (channel, out) in pixel.iter_mut().enumerate() {
            let value = match map.colors.get(at).copied().flatten() {
                // the relief darkens the colour, so that both are seen
                Some(color) => {
                    let lit = light.unwrap_or(0.7) * 0.75 + 0.45;
                    TINT * f64::from(color[channel]) * lit.min(1.0)
                        + (1.0 - TINT) * (0.5 * base[channel] + 0.5 * f64::from(color[channel]))
                }
                None => base[channel],
            };
            let byte = to_u8(value.clamp(0.0, 255.0));
            *out = byte;
        }
    });
    let mut picture = picture.enlarged(factor);
    let radius = picture.width.max(picture.height) as f64 / 130.0 + 2.0;
    // many observers are dots, not a cover over the map
    let radius = if map.marks.len() > 30 { radius * 0.5 } else { radius };
    let at = |mark: &MapMark| mark.place.map(|v| v * factor as f64);
    for mark in map.marks {
        draw_view(&mut picture, at(mark), mark.view, radius);
    }
    for mark in map.marks {
        draw_mark(&mut picture, at(mark), radius);
    }
    for mark in map.marks {
        draw_label(&mut picture, at(mark), mark, radius);
    }
    Ok(picture)
}

/// Light on the relief, 0 to 1, from differences to the neighbours.
fn shade(heights: &Raster<f32>, column: usize, row: usize, cell: f64) -> Option<f64> {
    let own = heights.get(column, row).map(f64::from).filter(|h| h.is_finite())?;
    let at = |column: Option<usize>, row: Option<usize>| {
        let height = heights.get(column?, row?)?;
        height.is_finite().then_some(f64::from(height))
    };
    let (c, r) = (Some(column), Some(row));
    let east = at(Some(column + 1), r).unwrap_or(own) - at(column.checked_sub(1), r).unwrap_or(own);
    let north = at(c, row.checked_sub(1)).unwrap_or(own) - at(c, Some(row + 1)).unwrap_or(own);
    // walls of whole metres from pixel to pixel must not swallow the grey of everything else
    let gentle = |rise: f64| (rise / (2.0 * cell)).clamp(-2.0, 2.0);
    let normal = [-gentle(east), -gentle(north), 1.0];
    let length = normal.iter().map(|v| v * v).sum::<f64>().sqrt();
    let facing = normal.iter().zip(TO_LIGHT).map(|(n, l)| n * l).sum::<f64>() / length;
    Some(facing.clamp(0.0, 1.0))
}

fn draw_mark(picture: &mut Picture, place: [f64; 2], radius: f64) {
    for (radius, color) in [(radius * 1.45, MARK[1]), (radius, MARK[0])] {
        for_pixels_around(picture, place, radius, |picture, pixel, _| picture.fill_rectangle(pixel, [1, 1], color));
    }
}

/// Draws the view of a mark, as a transparent wedge.
fn draw_view(picture: &mut Picture, place: [f64; 2], view: Option<[f64; 2]>, radius: f64) {
    let Some([heading, width]) = view.filter(|view| view[0].is_finite() && view[1] < TAU) else { return };
    for_pixels_around(picture, place, radius * WEDGE, |picture, pixel, [east, south]| {
        let from_middle = (east.atan2(-south) - heading + PI).rem_euclid(TAU) - PI;
        let inwards = width / 2.0 - from_middle.abs();
        let Some(below) = picture.get(pixel[0], pixel[1]).filter(|_| inwards >= 0.0) else { return };
        let range = east.hypot(south);
        // edges part the wedges of cameras that stand in one place
        let is_edge = inwards * range < EDGE * radius || radius * (WEDGE - EDGE) < range;
        let color = if is_edge { MARK[1] } else { [0, 1, 2].map(|i| below[i] / 2 + MARK[0][i] / 2) };
        picture.fill_rectangle(pixel, [1, 1], color);
    });
}

/// The label of a mark: in its wedge, or else beside it.
fn draw_label(picture: &mut Picture, [x, y]: [f64; 2], mark: &MapMark, radius: f64) {
    if mark.label.is_empty() {
        return;
    }
    let heading = mark.view.map_or(FRAC_PI_2, |[heading, _]| if heading.is_finite() { heading } else { FRAC_PI_2 });
    let scale = text_scale(picture.width.max(picture.height));
    let (width, height) = (text_width(&mark.label, scale), HEIGHT * scale);
    let [middle, line] = [x + LABEL * radius * heading.sin(), y - LABEL * radius * heading.cos()];
    let corner = [to_index(middle - width as f64 / 2.0), to_index(line - height as f64 / 2.0)];
    let border = scale.div_ceil(2);
    for right in 0..3 {
        for down in 0..3 {
            let [left, top] = [corner[0] + right * border, corner[1] + down * border].map(|v| v.saturating_sub(border));
            draw_text(picture, left, top, &mark.label, scale, MARK[1]);
        }
    }
    draw_text(picture, corner[0], corner[1], &mark.label, scale, MARK[0].map(|v| v / 2));
}

/// Calls `draw` with each pixel of a disc and how far it lies east and south of its middle.
fn for_pixels_around(
    picture: &mut Picture,
    [x, y]: [f64; 2],
    radius: f64,
    mut draw: impl FnMut(&mut Picture, [usize; 2], [f64; 2]),
) {
    let pixels = |v: f64, max: usize| to_index(v - radius)..max.min(to_index(v + radius + 1.0));
    for row in pixels(y, picture.height) {
        for column in pixels(x, picture.width) {
            let offset = [column as f64 + 0.5 - x, row as f64 + 0.5 - y];
            if offset[0].hypot(offset[1]) <= radius {
                draw(picture, [column, row], offset);
            }
        }
    }
}

fn framed(map: &Picture, what: &MapPicture<'_>, pixel: f64) -> Picture {
    let scale = text_scale(map.width.max(map.height));
    let (margin, line) = (8 * scale, (HEIGHT + 4) * scale);
    let swatch = 12 * scale;
    let lines = legend_lines(what);
    let heading = if let MapLegend::Ramp(name, ..) = &what.legend { *name } else { "" };
    let (bar, bar_text) = scale_bar(map.width as f64 * pixel / 4.0);
    let bar_px = to_index((bar / pixel).round());
    let marks = if what.marks.is_empty() { "" } else { what.mark_name };
    let texts = lines.iter().map(|(_, text)| text.as_str()).chain([heading, marks]);
    let legend = texts.map(|text| text_width(text, scale)).max().unwrap_or(0) + swatch + 5 * scale;
    let axes =
        what.place.map(|place| Axes::new(place, what.relief, [map.width, map.height], scale)).unwrap_or_default();
    let (indent, shelf) = axes.room(scale);
    let sheet_width = margin * 3 + indent + map.width + legend;
    let title = wrapped(what.title, sheet_width - 2 * margin, scale);
    let top = margin + title.len() * line + 4 * scale;
    let rows = lines.len() + usize::from(!heading.is_empty()) + usize::from(!marks.is_empty());
    let system = what.place.map_or(String::new(), |place| place.crs.describe());
    let below_bar = if system.is_empty() { 0 } else { line };
    let height = top + (map.height + shelf).max(rows * (line + 3 * scale)) + margin + line + below_bar + 2 * scale;
    let mut sheet = Picture::filled(sheet_width, height + margin, PAPER);
    for (number, text) in title.iter().enumerate() {
        draw_text(&mut sheet, margin, margin + number * line, text, scale, INK);
    }
    sheet.paste(map, [margin + indent, top]);
    axes.draw(&mut sheet, [margin + indent, top], [map.width, map.height], scale);
    let left = margin * 2 + indent + map.width;
    let mut at = top;
    if !heading.is_empty() {
        draw_text(&mut sheet, left, at, heading, scale, INK);
        at += line + 3 * scale;
    }
    let border = scale.div_ceil(2);
    for (color, text) in &lines {
        sheet.fill_rectangle([left - border, at - border], [swatch + 2 * border, 9 * scale + 2 * border], INK);
        sheet.fill_rectangle([left, at], [swatch, 9 * scale], *color);
        draw_text(&mut sheet, left + swatch + 5 * scale, at + scale, text, scale, INK);
        at += line + 3 * scale;
    }
    if !marks.is_empty() {
        draw_mark(&mut sheet, [left + swatch / 2, at + 9 * scale / 2].map(|v| v as f64), 3.0 * scale as f64);
        draw_text(&mut sheet, left + swatch + 5 * scale, at + scale, marks, scale, INK);
    }
    let (below, from) = (top + map.height + shelf + margin, margin + indent);
    sheet.fill_rectangle([from, below + 2 * scale], [bar_px, 3 * scale], INK);
    draw_text(&mut sheet, from + bar_px + 4 * scale, below, &bar_text, scale, INK);
    let arrow = (from + map.width).saturating_sub(text_width("N", scale) + 10 * scale);
    draw_north(&mut sheet, [arrow, below], scale);
    let system = fitted(&system, sheet.width - from - margin, scale);
    draw_text(&mut sheet, from, below + line + 2 * scale, &system, scale, INK);
    sheet
}

/// The colours of a legend and the text beside each.
fn legend_lines(map: &MapPicture<'_>) -> Vec<([u8; 3], String)> {
    let (ticks, classes) = match &map.legend {
        MapLegend::Colors(colors) => (Vec::new(), *colors),
        MapLegend::Ramp(_, range, others) => (ticks(*range), *others),
    };
    // a cell without a colour is bare relief, or blank where the survey has a hole
    let without = |has_relief: bool| {
        let mut cells = map.colors.iter().enumerate().filter(|(_, color)| color.is_none());
        let width = map.relief.width().max(1);
        cells.any(|(at, _)| map.relief.get(at % width, at / width).is_some_and(f32::is_finite) == has_relief)
    };
    let bare = without(true).then_some((BARE, "no answer"));
    let blank = without(false).then_some((UNKNOWN, "no data"));
    let classes = classes.iter().copied().chain(bare).chain(blank).map(|(color, text)| (color, text.to_owned()));
    ticks.into_iter().rev().map(|(share, text)| (ramp(share), text)).chain(classes).collect()
}

/// An arrow up, where maps have the north of their grid, and its letter.
fn draw_north(sheet: &mut Picture, [left, top]: [usize; 2], scale: usize) {
    let height = (HEIGHT + 2) * scale;
    for row in 0..height {
        // a slender triangle
        let half = row * 3 * scale / height;
        sheet.fill_rectangle([left + 4 * scale - half, top + row], [2 * half + 1, 1], INK);
    }
    draw_text(sheet, left + 9 * scale, top + scale, "N", scale, INK);
}

/// Round coordinates along the sides of a map: pixels from its west side with their eastings, and from its north side
/// with their northings.
#[derive(Default)]
struct Axes {
    eastings: Vec<(usize, String)>,
    northings: Vec<(usize, String)>,
}

impl Axes {
    fn new(place: &Georeference, relief: &Raster<f32>, size_px: [usize; 2], scale: usize) -> Self {
        let spans = [place.column_step[0] * relief.width() as f64, -place.row_step[1] * relief.height() as f64];
        if !spans.iter().all(|span| *span > 0.0 && span.is_finite()) {
            return Self::default();
        }
        let step = round_step(spans[0].max(spans[1]) / COORDINATES);
        let along = |from: f64, span: f64| {
            let first = (from / step).ceil();
            (0..100).map(move |i| (first + f64::from(i)) * step).take_while(move |value| *value <= from + span)
        };
        let decimals = usize::try_from((0..6).find(|&n| step * 10f64.powi(n) >= 0.999).unwrap_or(6)).unwrap_or(0);
        let pixel = |share: f64, size: usize| to_index(share * size as f64);
        let [west, north] = place.upper_left;
        let mut eastings: Vec<(usize, String)> = Vec::new();
        let mut free_from = 0;
        for value in along(west, spans[0]) {
            let (at, text) = (pixel((value - west) / spans[0], size_px[0]), format!("{value:.decimals$}"));
            let half = text_width(&text, scale) / 2;
            // coordinates are long, and those of small maps would run into each other
            if at >= free_from + half || eastings.is_empty() {
                free_from = at + half + 6 * scale;
                eastings.push((at, text));
            }
        }
        let northings = along(north - spans[1], spans[1])
            .map(|value| (pixel((north - value) / spans[1], size_px[1]), format!("{value:.decimals$}")))
            .collect();
        Self { eastings, northings }
    }

    /// Pixels that coordinates take left of a map and below it.
    fn room(&self, scale: usize) -> (usize, usize) {
        let widest = self.northings.iter().map(|(_, text)| text_width(text, scale)).max();
        let indent = widest.map_or(0, |widest| widest + 6 * scale);
        (indent, if self.eastings.is_empty() { 0 } else { (HEIGHT + 6) * scale })
    }

    /// Draws ticks and coordinates of a map of `size` pixels at `corner`.
    fn draw(&self, sheet: &mut Picture, [left, top]: [usize; 2], [width, height]: [usize; 2], scale: usize) {
        if self.eastings.is_empty() && self.northings.is_empty() {
            return;
        }
        let pen = scale.div_ceil(2);
        for (corner, size) in [
            ([left - pen, top - pen], [width + 2 * pen, pen]),
            ([left - pen, top + height], [width + 2 * pen, pen]),
            ([left - pen, top], [pen, height]),
            ([left + width, top], [pen, height]),
        ] {
            sheet.fill_rectangle(corner, size, INK);
        }
        for (at, text) in &self.eastings {
            sheet.fill_rectangle([left + at, top + height], [pen, 4 * scale], INK);
            let from = (left + at).saturating_sub(text_width(text, scale) / 2);
            draw_text(sheet, from, top + height + 5 * scale, text, scale, INK);
        }
        for (at, text) in &self.northings {
            sheet.fill_rectangle([left - 4 * scale, top + at], [4 * scale, pen], INK);
            let from = left.saturating_sub(text_width(text, scale) + 5 * scale);
            draw_text(sheet, from, (top + at).saturating_sub(4 * scale), text, scale, INK);
        }
    }
}

/// Returns round values between `low` and `high`, and either end that is half a step or more from the next of them
/// (counts begin at 1). Each has its position between the ends, 0 to 1, and its text.
fn ticks([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    /// Rounding error of a whole number of steps.
    const ROUNDING: f64 = 1e-6;
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return vec![(0.5, format!("{low:.0}"))];
    }
    let power = 10.0_f64.powf(span.log10().floor());
    // 0 is added so that 0 has no sign
    let whole = |step: f64| [(low / step - ROUNDING).ceil() + 0.0, (high / step + ROUNDING).floor()];
    let is_few = |step: &f64| whole(*step)[1] - whole(*step)[0] < MAX_TICKS;
    // between whole numbers from two on lie whole numbers: half an observer sees nothing
    let is_count = low.fract() == 0.0 && high.fract() == 0.0 && span >= 2.0;
    let steps = [0.1, 0.2, 0.5].map(|m| m * power).into_iter();
    let step = steps.filter(|&step| step >= 1.0 || !is_count).find(is_few).unwrap_or(power);
    let [first, last] = whole(step);
    let mut values = Vec::new();
    if first * step - low >= 0.5 * step {
        values.push(low);
    }
    let mut number = first;
    while number <= last {
        values.push(number * step);
        number += 1.0;
    }
    if high - last * step >= 0.5 * step {
        values.push(high);
    }
    let decimals = (0..9).find(|&n| step * 10.0_f64.powi(n) > 1.0 - ROUNDING).unwrap_or(9);
    let written = |value: f64| format!("{:.*}", usize::try_from(decimals).unwrap_or(0), value);
    values.into_iter().map(|value| (((value - low) / span).clamp(0.0, 1.0), written(value))).collect()
}

/// The longest round length up to `max` metres, and how it is written.
fn scale_bar(max: f64) -> (f64, String) {
    let power = 10.0_f64.powf(max.max(1e-3).log10().floor());
    let length = [5.0, 2.0, 1.0].map(|m| m * power).into_iter().find(|&l| l <= max).unwrap_or(power);
    let text = if length >= 1000.0 { format!("{} km", length / 1000.0) } else { format!("{length} m") };
    (length, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_along_a_map_are_round_and_where_they_belong() {
        let place = Georeference {
            upper_left: [84_985.0, 446_015.0],
            column_step: [0.5, 0.0],
            row_step: [0.0, -0.5],
            crs: belvedere_data::crs::Crs::default(),
        };
        let axes = Axes::new(&place, &Raster::filled(60, 40, 0.0), [600, 400], 1);
        // 30 m across: every ten metres would be three, every five too many
        let labels =
            |ticks: &[(usize, String)]| ticks.iter().map(|(at, text)| format!("{at} {text}")).collect::<Vec<_>>();
        assert_eq!(labels(&axes.eastings), ["100 84990", "300 85000", "500 85010"]);
        assert_eq!(labels(&axes.northings), ["300 446000", "100 446010"]);
        assert_eq!([0.3, 1.0, 6.1, 140.0].map(round_step), [0.5, 1.0, 10.0, 200.0]);
    }

    #[test]
    fn each_count_has_the_colour_of_the_legend_and_cells_without_an_answer_are_named() {
        let (relief, max) = (Raster::filled(2, 2, 0.0), 3.0);
        let unproven = ([90, 150, 240], "unproven");
        let colors = [Some(ramp(0.0)), Some(ramp(2.0 / max)), Some(ramp(1.0)), None];
        let map = MapPicture {
            relief: &relief,
            cell: 1.0,
            place: None,
            colors: &colors,
            marks: &[],
            mark_name: "",
            title: "",
            legend: MapLegend::Ramp("observers", [0.0, max], &[unproven]),
        };
        let lines = legend_lines(&map);
        let texts: Vec<&str> = lines.iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!(texts, ["3", "2", "1", "0", "unproven", "no answer"]);
        assert_eq!([lines[3].0, lines[1].0, lines[0].0].map(Some), colors[..3]);
        assert!((0..4).all(|i| (0..i).all(|j| lines[i].0 != lines[j].0)));
        // a hole of the survey is blank, and so is its line
        let hole = Raster::filled(2, 2, f32::NAN);
        let map = MapPicture { relief: &hole, ..map };
        let lines = legend_lines(&map);
        assert_eq!(lines.last(), Some(&(UNKNOWN, "no data".to_owned())));
        assert!(lines.iter().all(|(_, text)| text != "no answer"));
        // a map with an answer everywhere has no such line
        let lines = legend_lines(&MapPicture { colors: &[Some(unproven.0); 4], ..map });
        assert!(lines.iter().all(|(_, text)| text != "no answer" && text != "no data"));
        assert_eq!(ticks([0.0, 2.0]).into_iter().map(|(_, text)| text).collect::<Vec<_>>(), ["0", "1", "2"]);
    }

    #[test]
    fn the_wedge_of_a_camera_lies_in_its_heading() {
        let relief = Raster::filled(60, 60, 0.0);
        let colors = vec![Some([0, 255, 0]); 3600];
        let drawn = |view| {
            let mark = MapMark { place: [30.0, 30.0], view, label: String::new() };
            let (marks, legend) = ([mark], MapLegend::Colors(&[]));
            let (mark_name, title, place) = ("camera", "", None);
            let map = MapPicture {
                relief: &relief,
                cell: 1.0,
                place,
                colors: &colors,
                marks: &marks,
                mark_name,
                title,
                legend,
            };
            map_picture(&map).unwrap()
        };
        let bare = drawn(None);
        // columns and rows of what a heading changes
        let changed = |heading| {
            let picture = drawn(Some([heading, FRAC_PI_2]));
            let pixels = (0..bare.width).flat_map(|column| (0..bare.height).map(move |row| [column, row]));
            let changed: Vec<[usize; 2]> = pixels.filter(|&[c, r]| bare.get(c, r) != picture.get(c, r)).collect();
            [0, 1].map(|axis| {
                let along = || changed.iter().map(|place| place[axis]);
                [along().min().unwrap(), along().max().unwrap()]
            })
        };
        let [north, east, south, west] = [0.0, FRAC_PI_2, PI, 3.0 * FRAC_PI_2].map(changed);
        assert!(west[0][1] < east[0][0] && north[1][1] < south[1][0], "{north:?} {east:?} {south:?} {west:?}");
        // all around is no wedge
        assert_eq!(drawn(Some([0.0, TAU])), bare);
    }

    #[test]
    fn values_beside_a_ramp_are_round() {
        let texts = |range| ticks(range).into_iter().map(|(_, text)| text).collect::<Vec<_>>().join(" ");
        assert_eq!(texts([0.0, 1.0]), "0.0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(texts([0.0, 16.66]), "0 2 4 6 8 10 12 14 16");
        assert_eq!(texts([0.0, 1627.7]), "0 200 400 600 800 1000 1200 1400 1600");
        assert_eq!(texts([1.0, 60.0]), "1 10 20 30 40 50 60");
        assert_eq!(texts([1.0, 3.0]), "1 2 3");
        assert_eq!(texts([0.0, 0.03]), "0.000 0.005 0.010 0.015 0.020 0.025 0.030");
        assert_eq!(texts([-4.0, 13.0]), "-4 -2 0 2 4 6 8 10 12 13");
        assert_eq!(texts([5.0, 5.0]), "5");
        // a colour lies where its value does
        assert_eq!(ticks([0.0, 16.66])[8].0, 16.0 / 16.66);
    }
}
