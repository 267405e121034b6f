//! Drawing balls tile by tile, from front to back, leaving out what is hidden.
//!
//! Balls are sorted into the tiles they may touch. Each tile then draws its own from the nearest to the farthest and stops
//! at the first that begins behind everything drawn so far. Within a tile, blocks of 8 x 8 pixels know their farthest depth,
//! and a ball skips those it cannot come nearer in. Large balls (a 30 m ball covers thousands of pixels) thus cost what
//! is seen of them.

use super::depth_map::{ItemBuffer, NO_BALL};
use super::splat_balls::{Scale, Shape, Splat};
use crate::medial::{MedialBalls, NO_TOUCH};
use crate::raster::Raster;
use crate::view::View;
use rayon::prelude::*;

/// Side of a tile in pixels: its depths fill half a first-level cache.
const TILE: usize = 64;
/// Side of a block in pixels.
const BLOCK: usize = 8;
const BLOCKS: usize = TILE / BLOCK;
/// A ball over more tiles than this is not listed in each but offered to all, which bounds the memory of the lists.
const MOST_LISTED_TILES: usize = 16;
/// Balls handed to a thread at once.
const CHUNK: usize = 8192;

pub(super) fn draw<S: Shape>(
    balls: &MedialBalls,
    view: &View,
    items: ItemBuffer,
) -> (Raster<f32>, Option<Raster<u32>>) {
    let [width, height] = view.size_px;
    let scale = S::scale(view);
    let splats = project::<S>(balls, view, scale);
    let lists = TileLists::new(&splats, view.size_px, scale);

    let mut depth = Raster::filled(width, height, f32::INFINITY);
    let mut nearest = match items {
        ItemBuffer::With => Some(Raster::filled(width, height, NO_BALL)),
        ItemBuffer::Without => None,
    };
    let band = width * TILE;
    let draw_band = |row: usize, depth: &mut [f32], nearest: Option<&mut [u32]>| {
        let mut nearest = nearest;
        for column in 0..width.div_ceil(TILE) {
            let mut tile = Tile::new(column, row, scale);
            let with_items = nearest.is_some();
            tile.draw::<S>(&splats, &lists.of_tile(&splats, column, row), with_items);
            tile.store(depth, nearest.as_deref_mut(), width);
        }
    };
    match &mut nearest {
        Some(nearest) => depth
            .values_mut()
            .par_chunks_mut(band)
            .zip(nearest.values_mut().par_chunks_mut(band))
            .enumerate()
            .for_each(|(row, (depth, nearest))| draw_band(row, depth, Some(nearest))),
        None => {
            depth.values_mut().par_chunks_mut(band).enumerate().for_each(|(row, depth)| draw_band(row, depth, None));
        }
    }
    (depth, nearest)
}

fn project<S: Shape>(balls: &MedialBalls, view: &View, scale: Scale) -> Vec<Splat> {
    let [width, height] = view.size_px.map(|v| v as f64);
    let pixels_per_metre = view.pixels_per_metre();
    (0..balls.len())
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter_map(|i| {
            let radius = balls.radii[i];
            if balls.touch[i] == NO_TOUCH || !(radius > 0.0 && radius.is_finite()) {
                return None;
            }
            let [x, y, z] = view.frame.view_from_local(balls.centers[i]);
            let (x, y) = (x * pixels_per_metre, y * pixels_per_metre);
            // a pixel more than the ball reaches: the cone's centre moves by up to half of one
            let reach = f64::from(radius) * pixels_per_metre + 1.0;
            // a comparison with NaN is false, so centres that are not finite fall out here
            let inside = x + reach > 0.0 && x - reach < width && y + reach > 0.0 && y - reach < height && z.is_finite();
            #[expect(clippy::cast_possible_truncation, reason = "the number of balls was checked")]
            if inside { S::place(x, y, z, radius, i as u32, scale) } else { None }
        })
        .collect()
}

/// Which splats each tile has to look at.
struct TileLists {
    columns: usize,
    /// Where the list of each tile begins, row by row, and the end of the last.
    starts: Vec<usize>,
    listed: Vec<u32>,
    /// Splats over so many tiles that each tile looks at them itself.
    wide: Vec<u32>,
    scale: Scale,
}

impl TileLists {
    #[expect(clippy::cast_possible_truncation, reason = "there are fewer splats than 2^32")]
    fn new(splats: &[Splat], [width, height]: [usize; 2], scale: Scale) -> Self {
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let tiles_of = |splat: &Splat| {
            let [x0, x1] = pixel_range(splat.x, splat.radius / scale.units_per_pixel, width);
            let [y0, y1] = pixel_range(splat.y, splat.radius / scale.units_per_pixel, height);
            let columns = if x0 < x1 { x0 / TILE..(x1 - 1) / TILE + 1 } else { 0..0 };
            let rows = if y0 < y1 { y0 / TILE..(y1 - 1) / TILE + 1 } else { 0..0 };
            (columns, rows)
        };
        let mut counts = vec![0usize; columns * rows + 1];
        let mut wide = Vec::new();
        for (i, splat) in splats.iter().enumerate() {
            let (across, down) = tiles_of(splat);
            if across.len() * down.len() > MOST_LISTED_TILES {
                wide.push(i as u32);
                continue;
            }
            for row in down {
                for column in across.clone() {
                    counts[row * columns + column + 1] += 1;
                }
            }
        }
        for i in 1..counts.len() {
            counts[i] += counts[i - 1];
        }
        let starts = counts.clone();
        let mut listed = vec![0; counts[columns * rows]];
        for (i, splat) in splats.iter().enumerate() {
            let (across, down) = tiles_of(splat);
            if across.len() * down.len() > MOST_LISTED_TILES {
                continue;
            }
            for row in down {
                for column in across.clone() {
                    let next = &mut counts[row * columns + column];
                    listed[*next] = i as u32;
                    *next += 1;
                }
            }
        }
        Self { columns, starts, listed, wide, scale }
    }

    /// The splats of one tile, nearest first, equally near ones by row of the ball: places in `splats` in the low half of
    /// each key.
    fn of_tile(&self, splats: &[Splat], column: usize, row: usize) -> Vec<u64> {
        let tile = row * self.columns + column;
        let listed = &self.listed[self.starts[tile]..self.starts[tile + 1]];
        let touches = |from: usize, center: f32, reach: f32| {
            let from = from as f32 * TILE as f32;
            center + reach > from && center - reach < from + TILE as f32
        };
        let wide = self.wide.iter().filter(|&&i| {
            let splat = &splats[i as usize];
            let reach = splat.radius / self.scale.units_per_pixel;
            touches(column, splat.x, reach) && touches(row, splat.y, reach)
        });
        // splats are in the order of their balls, so a key of depth and place sorts by depth and ball
        let mut keys: Vec<u64> = listed
            .iter()
            .chain(wide)
            .map(|&i| u64::from(ascending_bits(splats[i as usize].near())) << 32 | u64::from(i))
            .collect();
        keys.sort_unstable();
        keys
    }
}

/// Bits that ascend as the value does, below zero too.
fn ascending_bits(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

/// First and one past the last pixel whose centre may lie within `reach` of `center`; one or two pixels too many at most.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates and is clamped to the picture")]
fn pixel_range(center: f32, reach: f32, size: usize) -> [usize; 2] {
    let end = center + reach + 1.5;
    if end < 1.0 {
        return [0, 0];
    }
    // a cast rounds towards zero, which is down for what is not negative
    [((center - reach - 0.5).max(0.0) as usize).min(size), (end as usize).min(size)]
}

struct Tile {
    /// First pixel.
    left: usize,
    top: usize,
    units_per_pixel: f32,
    depth: [f32; TILE * TILE],
    nearest: [u32; TILE * TILE],
    /// At least the farthest depth of each block.
    farthest: [f32; BLOCKS * BLOCKS],
    /// Whether a block was drawn on since its farthest depth was taken.
    stale: [bool; BLOCKS * BLOCKS],
    units_per_metre: f32,
}

impl Tile {
    fn new(column: usize, row: usize, scale: Scale) -> Self {
        Self {
            left: column * TILE,
            top: row * TILE,
            units_per_pixel: scale.units_per_pixel,
            units_per_metre: scale.units_per_metre,
            depth: [f32::INFINITY; TILE * TILE],
            nearest: [NO_BALL; TILE * TILE],
            farthest: [f32::INFINITY; BLOCKS * BLOCKS],
            stale: [false; BLOCKS * BLOCKS],
        }
    }

    fn draw<S: Shape>(&mut self, splats: &[Splat], nearest_first: &[u64], with_items: bool) {
        for (drawn, &key) in nearest_first.iter().enumerate() {
            #[expect(clippy::cast_possible_truncation, reason = "the low half of a key is a place")]
            let splat = &splats[key as u32 as usize];
            // finding the farthest depth of the whole tile costs as much as a few balls
            if drawn % 32 == 31 && splat.near() > self.farthest_of_all() {
                return;
            }
            self.draw_ball::<S>(splat, with_items);
        }
    }

    fn draw_ball<S: Shape>(&mut self, splat: &Splat, with_items: bool) {
        let reach = splat.radius / self.units_per_pixel;
        let [x0, x1] = pixel_range(splat.x - self.left as f32, reach, TILE);
        let [y0, y1] = pixel_range(splat.y - self.top as f32, reach, TILE);
        if x0 >= x1 || y0 >= y1 {
            return;
        }
        for block_row in y0 / BLOCK..=(y1 - 1) / BLOCK {
            for block_column in x0 / BLOCK..=(x1 - 1) / BLOCK {
                let block = block_row * BLOCKS + block_column;
                if splat.near() > self.farthest_of(block) || self.least_depth::<S>(splat, block) > self.farthest[block]
                {
                    continue;
                }
                let rows = y0.max(block_row * BLOCK)..y1.min((block_row + 1) * BLOCK);
                if with_items {
                    self.draw_rows_with_items::<S>(splat, block_column * BLOCK, rows);
                } else {
                    self.draw_rows::<S>(splat, block_column * BLOCK, rows);
                }
                self.stale[block] = true;
            }
        }
    }

    /// Least depth of the ball at any pixel of a block, +∞ where it touches none.
    ///
    /// This is the depth at the offset within the block that is nearest to the centre. Every operation from offset to
    /// depth is monotone in f32, so no pixel of the block can come out nearer, not even by rounding.
    fn least_depth<S: Shape>(&self, splat: &Splat, block: usize) -> f32 {
        let offset = |first: usize, center: f32| {
            let [first, last] = [first, first + BLOCK - 1].map(|pixel| pixel as f32 + 0.5 - center);
            0f32.clamp(first, last) * self.units_per_pixel
        };
        let (row, column) = (block / BLOCKS, block % BLOCKS);
        let dx = offset(self.left + column * BLOCK, splat.x);
        let dy = offset(self.top + row * BLOCK, splat.y);
        S::depth(splat, dx, dy)
    }

    fn farthest_of(&mut self, block: usize) -> f32 {
        if self.stale[block] {
            let first = block / BLOCKS * BLOCK * TILE + block % BLOCKS * BLOCK;
            let mut lanes = [f32::NEG_INFINITY; BLOCK];
            for row in 0..BLOCK {
                let pixels = &self.depth[first + row * TILE..][..BLOCK];
                for (lane, &depth) in lanes.iter_mut().zip(pixels) {
                    *lane = if depth > *lane { depth } else { *lane };
                }
            }
            self.farthest[block] = lanes.into_iter().fold(f32::NEG_INFINITY, f32::max);
            self.stale[block] = false;
        }
        self.farthest[block]
    }

    fn farthest_of_all(&mut self) -> f32 {
        (0..BLOCKS * BLOCKS).map(|block| self.farthest_of(block)).fold(f32::NEG_INFINITY, f32::max)
    }

    /// Offsets from the centre of the ball to the pixels of a block row.
    #[inline(always)]
    fn offsets(&self, splat: &Splat, first_column: usize) -> [f32; BLOCK] {
        std::array::from_fn(|lane| ((self.left + first_column + lane) as f32 + 0.5 - splat.x) * self.units_per_pixel)
    }

    #[inline(always)]
    fn draw_rows<S: Shape>(&mut self, splat: &Splat, first_column: usize, rows: std::ops::Range<usize>) {
        let dx = self.offsets(splat, first_column);
        for row in rows {
            let dy = ((self.top + row) as f32 + 0.5 - splat.y) * self.units_per_pixel;
            let pixels = &mut self.depth[row * TILE + first_column..][..BLOCK];
            for (pixel, dx) in pixels.iter_mut().zip(dx) {
                let depth = S::depth(splat, dx, dy);
                *pixel = if depth < *pixel { depth } else { *pixel };
            }
        }
    }

    #[inline(always)]
    fn draw_rows_with_items<S: Shape>(&mut self, splat: &Splat, first_column: usize, rows: std::ops::Range<usize>) {
        let dx = self.offsets(splat, first_column);
        for row in rows {
            let dy = ((self.top + row) as f32 + 0.5 - splat.y) * self.units_per_pixel;
            let first = row * TILE + first_column;
            let depths = &mut self.depth[first..][..BLOCK];
            let balls = &mut self.nearest[first..][..BLOCK];
            for ((pixel, ball), dx) in depths.iter_mut().zip(balls).zip(dx) {
                let depth = S::depth(splat, dx, dy);
                // no short circuit: every lane does the same
                let wins = (depth < *pixel) | ((depth == *pixel) & (splat.ball < *ball) & (depth < f32::INFINITY));
                *pixel = if wins { depth } else { *pixel };
                *ball = if wins { splat.ball } else { *ball };
            }
        }
    }

    /// Copies the part of the tile that lies in the picture into its band of rows, in metres.
    fn store(&self, depth: &mut [f32], nearest: Option<&mut [u32]>, width: usize) {
        let columns = TILE.min(width - self.left);
        for (row, band) in depth.chunks_mut(width).enumerate() {
            let from = &self.depth[row * TILE..][..columns];
            for (to, &depth) in band[self.left..].iter_mut().zip(from) {
                *to = depth / self.units_per_metre;
            }
        }
        if let Some(nearest) = nearest {
            for (row, band) in nearest.chunks_mut(width).enumerate() {
                band[self.left..][..columns].copy_from_slice(&self.nearest[row * TILE..][..columns]);
            }
        }
    }
}
