//! Drawing of balls tile by tile, from front to back, with occlusion culling.
//!
//! Balls are sorted into the tiles they may touch. Each tile then draws its own from the nearest to the farthest and
//! stops at the first that begins behind everything drawn so far. Within a tile, blocks of 8 x 8 pixels know their
//! farthest depth, and a ball skips the blocks in which it cannot be nearer. Large balls (a 30 m ball covers thousands
//! of pixels) thus cost only their visible part.

use crate::blocking::Ball;
use belvedere_data::Result;
use belvedere_data::cast::to_ascending_bits;
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use rayon::prelude::*;

/// Value of the item buffer where no ball is hit.
pub const NO_BALL: u32 = u32::MAX;

/// Choice of an item buffer: the index of the ball in each pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ItemBuffer {
    /// Depths only.
    #[default]
    Without,
    /// The ball of each pixel beside its depth.
    With,
}

/// Side of a tile in pixels: its depths fill half a first-level cache.
pub(super) const TILE: usize = 64;
/// Side of a block in pixels.
pub(super) const BLOCK: usize = 8;
const BLOCKS: usize = TILE / BLOCK;
/// A ball over more tiles than this is not listed in each but offered to all, which bounds the memory of the lists.
const MAX_LISTED_TILES: usize = 16;
/// Balls handed to a thread at once.
const CHUNK: usize = 8192;

/// A surface that represents a ball in a view, and the data to draw it. All depths are in one unit, which the surface
/// chooses.
pub(super) trait SplatSurface: Sync {
    /// A ball in the view.
    type Splat: Copy + Send + Sync;
    /// Data shared by the pixels of one tile.
    type PixelTile;
    /// A ball, its centre local, or `None` where it cannot be seen or is no ball of finite size.
    fn place(&self, center: [f32; 3], radius: f32, ball: u32) -> Option<Self::Splat>;
    /// Row of the ball.
    fn ball(splat: &Self::Splat) -> u32;
    /// Returns a lower bound of the depth of the ball at any pixel.
    fn nearest_depth(splat: &Self::Splat) -> f32;
    /// Returns the range of columns and of rows that pixel centres on the ball may have, in pixels.
    fn extent(&self, splat: &Self::Splat) -> [[f32; 2]; 2];
    /// The tile whose upper left pixel stands at a column and a row.
    fn tile(&self, left: usize, top: usize) -> Self::PixelTile;
    /// Returns a lower bound of the depth of the ball at any pixel of the block at a column and a row of the tile, +∞
    /// if it touches none.
    fn min_depth(&self, tile: &Self::PixelTile, splat: &Self::Splat, block: [usize; 2]) -> f32;
    /// Depths at the pixels of one row of a block, which starts at a column and a row of the tile; +∞ beside the ball.
    fn depths(&self, tile: &Self::PixelTile, splat: &Self::Splat, first: [usize; 2]) -> [f32; BLOCK];
    /// Units of depth in a metre.
    fn units_per_metre(&self) -> f32 {
        1.0
    }
}

/// The least depth of `count` balls, given by centre (local) and radius, at each pixel of a picture, metres; +∞ where
/// there is none. `ball` is `None` for those to be left out.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn draw<S: SplatSurface>(
    shape: &S,
    [width, height]: [usize; 2],
    count: usize,
    ball: impl Fn(usize) -> Option<Ball> + Sync,
    items: ItemBuffer,
    control: &Control<'_>,
) -> Result<(Raster<f32>, Option<Raster<u32>>)> {
    let splats: Vec<S::Splat> = (0..count)
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter_map(|i| {
            let Ball { center, radius } = ball(i)?;
            #[expect(clippy::cast_possible_truncation, reason = "callers check the number of balls")]
            shape.place(center, radius, i as u32)
        })
        .collect();
    control.check()?;
    let lists = TileLists::new(shape, &splats, [width, height]);

    let mut depth = Raster::filled(width, height, f32::INFINITY);
    let mut nearest = match items {
        ItemBuffer::With => Some(Raster::filled(width, height, NO_BALL)),
        ItemBuffer::Without => None,
    };
    let band = width * TILE;
    let draw_band = |row: usize, depth: &mut [f32], nearest: Option<&mut [u32]>| -> Result<()> {
        let mut nearest = nearest;
        for column in 0..width.div_ceil(TILE) {
            control.check()?;
            let with_items = nearest.is_some();
            let nearest_first = lists.of_tile(shape, &splats, column, row);
            if nearest_first.is_empty() {
                continue;
            }
            let mut tile = Tile::new(shape, column, row);
            tile.draw(&splats, &nearest_first, with_items);
            tile.store(depth, nearest.as_deref_mut(), width);
        }
        Ok(())
    };
    match &mut nearest {
        Some(nearest) => depth
            .values_mut()
            .par_chunks_mut(band)
            .zip(nearest.values_mut().par_chunks_mut(band))
            .enumerate()
            .try_for_each(|(row, (depth, nearest))| draw_band(row, depth, Some(nearest)))?,
        None => {
            let bands = depth.values_mut().par_chunks_mut(band).enumerate();
            bands.try_for_each(|(row, depth)| draw_band(row, depth, None))?;
        }
    }
    Ok((depth, nearest))
}

/// Splats that each tile has to test.
struct TileLists {
    columns: usize,
    /// Start of the list of each tile, row by row, and the end of the last.
    starts: Vec<usize>,
    listed: Vec<u32>,
    /// Splats over so many tiles that each tile looks at them itself.
    wide: Vec<u32>,
}

impl TileLists {
    #[expect(clippy::cast_possible_truncation, reason = "there are fewer splats than 2^32")]
    fn new<S: SplatSurface>(shape: &S, splats: &[S::Splat], [width, height]: [usize; 2]) -> Self {
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let tiles_of = |splat: &S::Splat| {
            let [across, down] = shape.extent(splat);
            let [x0, x1] = pixel_range(across, width);
            let [y0, y1] = pixel_range(down, height);
            let columns = if x0 < x1 { x0 / TILE..(x1 - 1) / TILE + 1 } else { 0..0 };
            let rows = if y0 < y1 { y0 / TILE..(y1 - 1) / TILE + 1 } else { 0..0 };
            (columns, rows)
        };
        let mut counts = vec![0usize; columns * rows + 1];
        let mut wide = Vec::new();
        for (i, splat) in splats.iter().enumerate() {
            let (across, down) = tiles_of(splat);
            if across.len() * down.len() > MAX_LISTED_TILES {
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
            if across.len() * down.len() > MAX_LISTED_TILES {
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
        Self { columns, starts, listed, wide }
    }

    /// The splats of one tile, nearest first, equally near ones by row of the ball: places in `splats` in the low half
    /// of each key.
    fn of_tile<S: SplatSurface>(&self, shape: &S, splats: &[S::Splat], column: usize, row: usize) -> Vec<u64> {
        let tile = row * self.columns + column;
        let listed = &self.listed[self.starts[tile]..self.starts[tile + 1]];
        let touches = |from: usize, [min, max]: [f32; 2]| {
            let from = from as f32 * TILE as f32;
            max > from && min < from + TILE as f32
        };
        let wide = self.wide.iter().filter(|&&i| {
            let [across, down] = shape.extent(&splats[i as usize]);
            touches(column, across) && touches(row, down)
        });
        // splats are in the order of their balls, so a key of depth and place sorts by depth and ball
        let mut keys: Vec<u64> = listed
            .iter()
            .chain(wide)
            .map(|&i| u64::from(to_ascending_bits(S::nearest_depth(&splats[i as usize]))) << 32 | u64::from(i))
            .collect();
        keys.sort_unstable();
        keys
    }
}

/// First and one past the last pixel whose centre may lie from `min` to `max`; one or two pixels too many at most.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates and is clamped to the picture")]
fn pixel_range([min, max]: [f32; 2], size: usize) -> [usize; 2] {
    let end = max + 1.5;
    if end < 1.0 {
        return [0, 0];
    }
    // a cast rounds towards zero, which is down for what is not negative
    [((min - 0.5).max(0.0) as usize).min(size), (end as usize).min(size)]
}

struct Tile<'a, S: SplatSurface> {
    shape: &'a S,
    /// Data shared by its pixels.
    pixels: S::PixelTile,
    /// First pixel.
    left: usize,
    top: usize,
    depth: [f32; TILE * TILE],
    nearest: [u32; TILE * TILE],
    /// Upper bound of the depth of each block.
    farthest: [f32; BLOCKS * BLOCKS],
    /// True for blocks that were drawn on since their farthest depth was taken.
    stale: [bool; BLOCKS * BLOCKS],
}

impl<'a, S: SplatSurface> Tile<'a, S> {
    fn new(shape: &'a S, column: usize, row: usize) -> Self {
        let (left, top) = (column * TILE, row * TILE);
        Self {
            shape,
            pixels: shape.tile(left, top),
            left,
            top,
            depth: [f32::INFINITY; TILE * TILE],
            nearest: [NO_BALL; TILE * TILE],
            farthest: [f32::INFINITY; BLOCKS * BLOCKS],
            stale: [false; BLOCKS * BLOCKS],
        }
    }

    fn draw(&mut self, splats: &[S::Splat], nearest_first: &[u64], with_items: bool) {
        for (drawn, &key) in nearest_first.iter().enumerate() {
            #[expect(clippy::cast_possible_truncation, reason = "the low half of a key is a place")]
            let splat = &splats[key as u32 as usize];
            // finding the farthest depth of the whole tile costs as much as a few balls
            if drawn % 32 == 31 && S::nearest_depth(splat) > self.farthest_of_all() {
                return;
            }
            self.draw_ball(splat, with_items);
        }
    }

    fn draw_ball(&mut self, splat: &S::Splat, with_items: bool) {
        let [across, down] = self.shape.extent(splat);
        let [x0, x1] = pixel_range(across.map(|v| v - self.left as f32), TILE);
        let [y0, y1] = pixel_range(down.map(|v| v - self.top as f32), TILE);
        if x0 >= x1 || y0 >= y1 {
            return;
        }
        for block_row in y0 / BLOCK..=(y1 - 1) / BLOCK {
            for block_column in x0 / BLOCK..=(x1 - 1) / BLOCK {
                let block = block_row * BLOCKS + block_column;
                let corner = [block_column * BLOCK, block_row * BLOCK];
                if S::nearest_depth(splat) > self.farthest_of(block)
                    || self.shape.min_depth(&self.pixels, splat, corner) > self.farthest[block]
                {
                    continue;
                }
                let rows = y0.max(block_row * BLOCK)..y1.min((block_row + 1) * BLOCK);
                if with_items {
                    self.draw_rows_with_items(splat, block_column * BLOCK, rows);
                } else {
                    self.draw_rows(splat, block_column * BLOCK, rows);
                }
                self.stale[block] = true;
            }
        }
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

    #[inline(always)]
    fn draw_rows(&mut self, splat: &S::Splat, first_column: usize, rows: std::ops::Range<usize>) {
        for row in rows {
            let depths = self.shape.depths(&self.pixels, splat, [first_column, row]);
            let pixels = &mut self.depth[row * TILE + first_column..][..BLOCK];
            for (pixel, depth) in pixels.iter_mut().zip(depths) {
                *pixel = if depth < *pixel { depth } else { *pixel };
            }
        }
    }

    #[inline(always)]
    fn draw_rows_with_items(&mut self, splat: &S::Splat, first_column: usize, rows: std::ops::Range<usize>) {
        let own = S::ball(splat);
        for row in rows {
            let depths = self.shape.depths(&self.pixels, splat, [first_column, row]);
            let first = row * TILE + first_column;
            let pixels = &mut self.depth[first..][..BLOCK];
            let balls = &mut self.nearest[first..][..BLOCK];
            for ((pixel, ball), depth) in pixels.iter_mut().zip(balls).zip(depths) {
                // no short circuit: every lane does the same
                let wins = (depth < *pixel) | ((depth == *pixel) & (own < *ball) & (depth < f32::INFINITY));
                *pixel = if wins { depth } else { *pixel };
                *ball = if wins { own } else { *ball };
            }
        }
    }

    /// Copies the part of the tile that lies in the picture into its band of rows, in metres.
    fn store(&self, depth: &mut [f32], nearest: Option<&mut [u32]>, width: usize) {
        let columns = TILE.min(width - self.left);
        let units_per_metre = self.shape.units_per_metre();
        for (row, band) in depth.chunks_mut(width).enumerate() {
            let from = &self.depth[row * TILE..][..columns];
            for (to, &depth) in band[self.left..].iter_mut().zip(from) {
                *to = depth / units_per_metre;
            }
        }
        if let Some(nearest) = nearest {
            for (row, band) in nearest.chunks_mut(width).enumerate() {
                band[self.left..][..columns].copy_from_slice(&self.nearest[row * TILE..][..columns]);
            }
        }
    }
}
