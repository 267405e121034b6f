//! The pictures of docs/methods/carving.md: a section through a street, and its shade, with balls made in three ways.

use crate::place::{CarvingSite, Missing};
use belvedere::Bounds;
use belvedere::cast::to_index;
use belvedere::figures::{Picture, side_by_side, write_png};
use belvedere::medial::{MedialBalls, ShrinkParams};
use belvedere::model::BallParams;
use belvedere::query::{Answer, Viewer, Visibility};
use belvedere::view::to_sun;
use belvedere::{Error, Result};
use belvedere_baselines::medial::{MedialBaseline, MedialParams, Outward};
use belvedere_scenes::Preset;
use std::path::Path;

const FREE: [u8; 3] = [255, 255, 255];
const SOLID: [u8; 3] = [150, 150, 150];
const FALSE_BLOCKED: [u8; 3] = [222, 70, 50];
const FALSE_VISIBLE: [u8; 3] = [50, 110, 215];
const POINT: [u8; 3] = [0, 0, 0];
/// Width of the section, metres, and its heights above the lowest point.
const SECTION: [f32; 3] = [90.0, -1.0, 24.0];
/// Where the section lies, as a share of the way from south to north: through houses, trees and a courtyard.
const SECTION_SHARE: f32 = 0.35;
const SECTION_PIXEL: f32 = 0.1;
/// Points this near to the section are shown, metres.
const NEAR: f32 = 0.4;
const SHADE_PIXEL: f32 = 0.25;
const SHADE_SIDE: f32 = 110.0;
const SUN_DEG: [f64; 2] = [240.0, 35.0];
const CHEST: f32 = 1.5;

/// Draws them into `folder`.
pub(crate) fn draw(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|source| Error::Io { path: folder.to_owned(), source })?;
    let place = CarvingSite::simulated(Preset::OldTown, 7, None, Missing::default())?;
    let uncarved = MedialParams {
        making: BallParams::Shrunk(ShrinkParams { max_radius: f32::INFINITY, ..ShrinkParams::tau() }),
        ..MedialParams::cut_to_half_a_metre()
    };
    let ways = [
        ("cut by the points alone", uncarved),
        ("cut to half a metre", MedialParams::cut_to_half_a_metre()),
        ("cut by the pulses, with all rules", MedialParams::carved()),
    ];
    let (mut sections, mut shades, mut captions) = (Vec::new(), Vec::new(), Vec::new());
    for (caption, params) in ways {
        let model = MedialBaseline::new(&place.survey(), Outward::Survey, &params)?;
        sections.push(side_by_side(&[section(&place, model.balls())], &[caption]));
        shades.push(shade(&place, &model)?);
        captions.push(caption);
    }
    write_png(&folder.join("carving_section.png"), &stacked(&sections))?;
    write_png(&folder.join("carving_shade.png"), &side_by_side(&shades, &captions))
}

fn stacked(pictures: &[Picture]) -> Picture {
    let width = pictures.iter().map(|p| p.width).max().unwrap_or(0);
    let mut all = Picture::filled(width, pictures.iter().map(|p| p.height).sum(), FREE);
    let mut row = 0;
    for picture in pictures {
        all.paste(picture, [0, row]);
        row += picture.height;
    }
    all
}

fn pixels(length: f32, pixel: f32) -> usize {
    to_index(f64::from(length / pixel))
}

/// An upright section from west to east through the middle of the place.
fn section(place: &CarvingSite, balls: &MedialBalls) -> Picture {
    let [width, bottom, top] = SECTION;
    let size = [pixels(width, SECTION_PIXEL), pixels(top - bottom, SECTION_PIXEL)];
    let Bounds { low, high } = place.bounds();
    let (west, north) = ((low[0] + high[0] - width) / 2.0, low[1] + SECTION_SHARE * (high[1] - low[1]));
    let at = |column: usize, row: usize| {
        let x = west + (column as f32 + 0.5) * SECTION_PIXEL;
        [x, north, low[2] + top - (row as f32 + 0.5) * SECTION_PIXEL]
    };
    let mut filled = vec![false; size[0] * size[1]];
    for (center, &radius) in balls.centers.iter().zip(&balls.radii) {
        let beside = radius * radius - (center[1] - north).powi(2);
        if beside <= 0.0 {
            continue;
        }
        let reach = beside.sqrt();
        for row in 0..size[1] {
            let half = reach * reach - (at(0, row)[2] - center[2]).powi(2);
            if half > 0.0 {
                for column in 0..size[0] {
                    if (at(column, row)[0] - center[0]).abs() < half.sqrt() {
                        filled[row * size[0] + column] = true;
                    }
                }
            }
        }
    }
    let mut picture = Picture::filled(size[0], size[1], FREE);
    for row in 0..size[1] {
        for column in 0..size[0] {
            let color = match (place.is_inside(at(column, row)), filled[row * size[0] + column]) {
                (true, true) => SOLID,
                (true, false) => FALSE_VISIBLE,
                (false, true) => FALSE_BLOCKED,
                (false, false) => FREE,
            };
            picture.fill_rectangle([column, row], [1, 1], color);
        }
    }
    for p in place.survey().cloud.positions.iter().filter(|p| (p[1] - north).abs() < NEAR) {
        let (column, row) = ((p[0] - west) / SECTION_PIXEL, (low[2] + top - p[2]) / SECTION_PIXEL);
        if column >= 1.0 && row >= 1.0 {
            picture.fill_rectangle([pixels(column, 1.0), pixels(row, 1.0)], [2, 2], POINT);
        }
    }
    picture
}

/// What lies in shade 1.5 m above the ground, seen from above.
fn shade(place: &CarvingSite, model: &MedialBaseline) -> Result<Picture> {
    let size = pixels(SHADE_SIDE, SHADE_PIXEL);
    let Bounds { low, high } = place.bounds();
    let corner = [low[0] + high[0] - SHADE_SIDE, low[1] + high[1] + SHADE_SIDE].map(|v| v / 2.0);
    let [azimuth, elevation] = SUN_DEG.map(f64::to_radians);
    let sun = to_sun(azimuth, elevation);
    let (mut cells, mut targets) = (Vec::new(), Vec::new());
    let mut picture = Picture::filled(size, size, [225, 215, 195]);
    for row in 0..size {
        for column in 0..size {
            let x = corner[0] + (column as f32 + 0.5) * SHADE_PIXEL;
            let y = corner[1] - (row as f32 + 0.5) * SHADE_PIXEL;
            if let Some(target) = place.above_ground([x, y], CHEST) {
                cells.push([column, row]);
                targets.push(target);
            }
        }
    }
    let answers = model.visible(Viewer::Direction(sun), &targets)?;
    for ((cell, target), answer) in cells.into_iter().zip(&targets).zip(answers) {
        let color = match (place.is_lit(*target, sun), answer == Answer::Visible) {
            (true, true) => FREE,
            (true, false) => FALSE_BLOCKED,
            (false, true) => FALSE_VISIBLE,
            (false, false) => SOLID,
        };
        picture.fill_rectangle(cell, [1, 1], color);
    }
    Ok(picture)
}
