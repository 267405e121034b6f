//! Points and balls as seen in a view.

use belvedere_data::cast::{to_index, to_u8};
use rayon::prelude::*;

use crate::picture::Picture;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{sub, to_f32, unit};
use belvedere_data::view::View;
use belvedere_data::{Error, Result};

/// Rows that one task draws; tasks never share a pixel, so that the result does not depend on their order.
const ROWS_PER_BAND: usize = 32;
/// Towards the light in the view (right, down, forward): from the upper left behind the viewer.
const TO_LIGHT: [f64; 3] = [-0.45, -0.6, -0.661_437_827_766_147_7];
/// Share of the colour that is seen on the side away from the light.
const AMBIENT: f64 = 0.35;

/// Colours of points or balls.
#[derive(Clone, Copy, Debug)]
pub enum Colors<'a> {
    /// The same for all.
    One([u8; 3]),
    /// One for each, (N).
    Each(&'a [[u8; 3]]),
}

impl Colors<'_> {
    fn get(&self, index: usize) -> [u8; 3] {
        match self {
            Self::One(color) => *color,
            Self::Each(colors) => colors.get(index).copied().unwrap_or([128; 3]),
        }
    }

    fn check(&self, expected: usize) -> Result<()> {
        match self {
            Self::Each(colors) if colors.len() != expected => {
                Err(Error::LengthMismatch { what: "colours", expected, found: colors.len() })
            }
            _ => Ok(()),
        }
    }
}

/// A picture in the making: nearer things hide farther ones, in whatever order they are drawn. At equal depths the
/// first drawn stays.
#[derive(Clone, Debug)]
pub struct Canvas {
    view: View,
    picture: Picture,
    depth: Vec<f32>,
}

/// Something that covers pixels of the picture: its middle and half size in pixels, and its depth in metres.
#[derive(Clone, Copy)]
struct Mark {
    x: f64,
    y: f64,
    half: f64,
    depth: f64,
    index: usize,
}

impl Canvas {
    /// An empty picture of the extent of `view`.
    #[must_use]
    pub fn new(view: &View, background: [u8; 3]) -> Self {
        let [width, height] = view.size_px;
        Self {
            view: *view,
            picture: Picture::filled(width, height, background),
            depth: vec![f32::INFINITY; width * height],
        }
    }

    /// Draws `points`, (N, 3) local metres, as squares of `size_px` pixels.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless there is one colour or one for each point.
    pub fn draw_points(&mut self, points: &[[f32; 3]], colors: Colors<'_>, size_px: usize) -> Result<()> {
        colors.check(points.len())?;
        let half = size_px.max(1) as f64 / 2.0;
        let marks = self.marks(points, |_| half);
        self.draw(&marks, |mark, _, _| Some((mark.depth, colors.get(mark.index))));
        Ok(())
    }

    /// Draws the balls of a depth map as spheres lit from the upper left. `depth` and `items`, (height, width) of this
    /// canvas's view, give the depth and the ball of each pixel. `centers`, (B, 3) local metres, and `radii`, (B)
    /// metres, give the curvature there.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless both rasters have the size of the picture, there is one radius for each centre,
    /// and one colour or one for each ball.
    pub fn draw_seen_balls(
        &mut self,
        (depth, items): (&Raster<f32>, &Raster<u32>),
        (centers, radii): (&[[f32; 3]], &[f32]),
        colors: Colors<'_>,
    ) -> Result<()> {
        let expected = self.depth.len();
        for (what, found) in [("depth map", depth.values().len()), ("item buffer", items.values().len())] {
            if found != expected {
                return Err(Error::LengthMismatch { what, expected, found });
            }
        }
        if radii.len() != centers.len() {
            return Err(Error::LengthMismatch { what: "radii of balls", expected: centers.len(), found: radii.len() });
        }
        colors.check(centers.len())?;
        let (width, view) = (self.view.size_px[0].max(1), self.view);
        self.picture
            .rgb
            .par_chunks_mut(3)
            .zip(self.depth.par_iter_mut())
            .zip(depth.values().par_iter().zip(items.values()))
            .enumerate()
            .for_each(|(pixel, ((rgb, nearest), (&depth, &ball)))| {
                let Some(&center) = centers.get(ball as usize) else { return };
                if depth >= *nearest {
                    return;
                }
                let center = view.frame.view_from_local(center);
                let place = [pixel % width, pixel / width].map(|pixel| pixel as f64 + 0.5);
                let surface = view.position(place, f64::from(depth));
                let Some(normal) = unit(sub(surface, center)) else { return };
                let facing = (0..3).map(|i| normal[i] * TO_LIGHT[i]).sum::<f64>().max(0.0);
                *nearest = depth;
                rgb.copy_from_slice(&colors.get(ball as usize).map(|c| scaled(c, AMBIENT + (1.0 - AMBIENT) * facing)));
            });
        Ok(())
    }

    /// The picture as drawn so far.
    #[must_use]
    pub fn into_picture(self) -> Picture {
        self.picture
    }

    /// The marks that touch the picture, in the order of `points`.
    fn marks(&self, points: &[[f32; 3]], half: impl Fn(usize) -> f64 + Sync) -> Vec<Mark> {
        let [width, height] = self.view.size_px.map(|v| v as f64);
        points
            .par_iter()
            .enumerate()
            .filter_map(|(index, &point)| {
                let [x, y, depth] = self.view.project(point)?;
                let half = half(index);
                let inside = x + half > 0.0 && x - half < width && y + half > 0.0 && y - half < height;
                (inside && depth.is_finite()).then_some(Mark { x, y, half, depth, index })
            })
            .collect()
    }

    /// Asks `shade` for depth and colour of every pixel in the square around each mark and keeps the nearest.
    fn draw(&mut self, marks: &[Mark], shade: impl Fn(&Mark, usize, usize) -> Option<(f64, [u8; 3])> + Sync) {
        let [width, height] = self.view.size_px;
        if width == 0 || height == 0 {
            return;
        }
        let mut in_band: Vec<Vec<usize>> = vec![Vec::new(); height.div_ceil(ROWS_PER_BAND)];
        for (i, mark) in marks.iter().enumerate() {
            let rows = pixels(mark.y, mark.half, height);
            let bands = rows.start / ROWS_PER_BAND..rows.end.div_ceil(ROWS_PER_BAND);
            for members in in_band.get_mut(bands).into_iter().flatten() {
                members.push(i);
            }
        }
        let band_pixels = ROWS_PER_BAND * width;
        self.picture
            .rgb
            .par_chunks_mut(band_pixels * 3)
            .zip(self.depth.par_chunks_mut(band_pixels))
            .zip(in_band)
            .enumerate()
            .for_each(|(band, ((rgb, depths), members))| {
                let first_row = band * ROWS_PER_BAND;
                for mark in members.into_iter().map(|i| &marks[i]) {
                    let rows = pixels(mark.y, mark.half, height);
                    for row in rows.start.max(first_row)..rows.end.min(first_row + depths.len() / width) {
                        for column in pixels(mark.x, mark.half, width) {
                            let Some((depth, color)) = shade(mark, column, row) else { continue };
                            let at = (row - first_row) * width + column;
                            let depth = to_f32(depth);
                            if depth < depths[at] {
                                depths[at] = depth;
                                rgb[at * 3..at * 3 + 3].copy_from_slice(&color);
                            }
                        }
                    }
                }
            });
    }
}

/// Pixels whose middle lies within `half` of `middle`, at most `count`.
fn pixels(middle: f64, half: f64, count: usize) -> std::ops::Range<usize> {
    let pixel = |v: f64| to_index(v.clamp(0.0, count as f64));
    // half-open, so that a square of one pixel covers one pixel wherever it lies
    pixel((middle - half - 0.5).ceil())..pixel((middle + half - 0.5).ceil())
}

fn scaled(channel: u8, factor: f64) -> u8 {
    to_u8((f64::from(channel) * factor).round().clamp(0.0, 255.0))
}
