//! Where a method errs, seen from above.

use super::case::{ComparisonCase, bounds_of};
use super::judge::{SHOWN_SET, SHOWN_VIEW};
use anyhow::Result;
use belvedere::cast::to_index;
use belvedere::figures::{Canvas, Colors, side_by_side, write_png};
use belvedere::query::Answer;
use belvedere::view::View;
use std::path::Path;

/// Pixels along the longer side.
const SIDE_PX: f64 = 560.0;
const LIT: [u8; 3] = [250, 225, 130];
const SHADED: [u8; 3] = [95, 105, 130];
const FALSE_BLOCKED: [u8; 3] = [214, 30, 40];
const FALSE_VISIBLE: [u8; 3] = [20, 90, 230];
const UNPROVEN: [u8; 3] = [170, 60, 190];
const BACKDROP: [u8; 3] = [222, 222, 218];

/// What the colours mean, for captions.
pub(super) const LEGEND: &str = "yellow: correctly lit; grey-blue: correctly in shadow; red: lit, but called blocked; blue: in shadow, but called visible; purple: no answer";

/// Draws the pedestrians of a place under one sun as a method answers them.
pub(super) fn write_errors(path: &Path, case: &ComparisonCase, title: &str, answers: &[Answer]) -> Result<()> {
    let Some(set) = case.sets.iter().find(|set| set.name == SHOWN_SET) else { return Ok(()) };
    let Some((_, truth)) = set.truth.iter().find(|(view, _)| *view == SHOWN_VIEW) else { return Ok(()) };
    let belvedere::Bounds { low, high } = bounds_of(&case.place.cloud)?;
    let (low, high) = (low.map(f64::from), high.map(f64::from));
    let pixel = (0..2).map(|i| high[i] - low[i]).fold(0.0, f64::max) / SIDE_PX;
    let from_above = View::parallel([0.0, 0.0, -1.0], low, high, pixel)?;
    let mut canvas = Canvas::new(&from_above, [255; 3]);
    let colors: Vec<[u8; 3]> = truth
        .iter()
        .zip(answers)
        .map(|pair| match pair {
            (Some(true), Answer::Visible) => LIT,
            (Some(false), Answer::Blocked) => SHADED,
            (Some(true), Answer::Blocked) => FALSE_BLOCKED,
            (Some(false), Answer::Visible) => FALSE_VISIBLE,
            _ => UNPROVEN,
        })
        .collect();
    // targets first and at one height, so that crowns and roofs of the backdrop do not hide those below them
    let flat = |p: &[f32; 3]| [p[0], p[1], 0.0];
    let targets: Vec<[f32; 3]> = set.targets.iter().map(flat).collect();
    let per_target = ((high[0] - low[0]) * (high[1] - low[1]) / targets.len().max(1) as f64).sqrt();
    let size_px = to_index((per_target / pixel).ceil().clamp(1.0, 9.0));
    canvas.draw_points(&targets, Colors::Each(&colors), size_px)?;
    let backdrop: Vec<[f32; 3]> = case.place.cloud.positions.iter().map(|p| [p[0], p[1], -1.0]).collect();
    canvas.draw_points(&backdrop, Colors::One(BACKDROP), 2)?;
    write_png(path, &side_by_side(&[canvas.into_picture()], &[title]))?;
    Ok(())
}
