//! Depth maps of balls, and bounds of depth, drawn on a device: balls and views as words, the stages, and the words that come back. The arithmetic is in the shaders below `depth`.

#[cfg(test)]
mod floats;
mod stages;

use crate::device::{Device, DeviceKind};
use belvedere_core::blocking::SHELL_SHARE;
use belvedere_core::depth::{BoundsParams, ItemBuffer};
use belvedere_data::control::Control;
use belvedere_data::vector::{cross, length};
use belvedere_data::view::{Projection, View};
use belvedere_data::{Error, Result};
use bytemuck::cast_slice;
use stages::{Buffers, Kind, Stages};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Threads of a group, and pixels of a tile.
const GROUP: usize = 256;
/// Groups along an axis that every device allows.
const MOST_GROUPS: usize = 65_535;
/// Side of the smallest tiles, pixels.
const TILE: usize = 16;
/// Sizes of tiles, each four times as long as the one before.
const LEVELS: u32 = 7;
/// Steps of depth, by which balls of a tile are ordered.
const STEPS: usize = 32;
/// Lists that are summed up together, and how many of such blocks there can be.
const BLOCK: usize = 2048;
/// Most tiles of a ball.
const MOST_TILES: usize = 9;
/// Words of the ranges of depth in which balls are counted.
const RANGES: usize = 4096;
/// Words before the list of balls for the CPU, and balls in that list.
const HEAD: usize = 8;
const MOST_LEFT: usize = 65_536;
/// Most balls at a time on a device in software: Mesa's ends the loops of a thread after 65 535 turns in all, and each pixel may turn twice for each ball.
const SOFTWARE_BALLS: usize = 1 << 14;
/// Views farther away, or with a nearest depth beyond it, are the CPU's, metres.
const FARTHEST: f64 = 1e9;
/// What a limit of depth without end is on a device, metres: beyond all that it draws.
const ENDLESS: f64 = 1e30;
/// Tiles that are drawn at a time on a graphics card, and on any other device: as for lines of sight, so that no picture freezes.
const CARD_TILES: usize = 1 << 16;
const OTHER_TILES: usize = 1 << 12;

/// A device with the shaders of depth maps, those of each kind of view made when first needed.
#[derive(Debug)]
pub(crate) struct Painter {
    device: Arc<Device>,
    stages: Mutex<HashMap<(Kind, Shows), Arc<Stages>>>,
    /// One picture at a time: together they could need more memory than there is.
    turn: Mutex<()>,
    is_counted: bool,
}

/// Balls for the device, in as many parts as its buffers need. A single part stays in its memory.
#[derive(Debug)]
pub(crate) struct Canvas {
    parts: Vec<Vec<[f32; 4]>>,
    only: Option<wgpu::Buffer>,
    ball_count: usize,
}

/// What pixels show, as the shaders number it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Shows {
    /// Depths at their centres.
    Depths,
    /// The row of the ball of each as well.
    Balls,
    /// Bounds of the depth over all of a pixel.
    Bounds,
}

/// A picture to draw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture<'v> {
    view: &'v View,
    shows: Shows,
    /// Of depth.
    limits: [f64; 2],
    /// Of bounds.
    starts: [f64; 2],
    shell: f64,
}

impl<'v> Picture<'v> {
    /// A depth map.
    pub(crate) fn depths(view: &'v View, items: ItemBuffer) -> Self {
        let shows = if items == ItemBuffer::With { Shows::Balls } else { Shows::Depths };
        Self { view, shows, limits: view.limits(), starts: [0.0; 2], shell: 0.0 }
    }

    /// Bounds of depth. What limits lines of sight is said by the start of `params`, not by the limits of the view.
    pub(crate) fn bounds(view: &'v View, params: &BoundsParams) -> Self {
        let near = if view.is_central() { 0.0 } else { -ENDLESS };
        let starts = params.starts(view);
        Self { view, shows: Shows::Bounds, limits: [near, ENDLESS], starts, shell: params.shell }
    }

    /// Whether a device may be asked for it: places near enough for single precision.
    pub(crate) fn can_be_drawn(&self) -> bool {
        let scale = scale_of(self.view);
        let is_near = self.view.frame.eye.iter().all(|v| v.abs() <= FARTHEST);
        is_near && self.limits[0] <= FARTHEST && (1e-6..=1e9).contains(&scale)
    }
}

/// What a device has drawn.
#[derive(Debug)]
pub(crate) struct Drawn {
    /// Depths, or upper bounds.
    pub(crate) depth: Vec<f32>,
    /// Rows of balls, or bits of lower bounds.
    pub(crate) rows: Option<Vec<u32>>,
    pub(crate) around_eye_count: usize,
    /// Rows of the balls that it left to the CPU, ascending; `None` if there are too many to list.
    pub(crate) left: Option<Vec<u32>>,
    pub(crate) work: Work,
}

/// How much work a picture was, counted if that is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Entries of all lists.
    pub listed: u64,
    /// Entries of lists that tiles looked at.
    pub looked_at: u64,
    /// Balls that each pixel of a block of 8 x 8 was tested with.
    pub tested: u64,
    /// Depths that were computed exactly.
    pub exact: u64,
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.listed += other.listed;
        self.looked_at += other.looked_at;
        self.tested += other.tested;
        self.exact += other.exact;
    }
}

/// A part of a picture that is drawn at a time: first row and number of rows.
type Band = [usize; 2];

impl Painter {
    pub(crate) fn new(device: Arc<Device>, is_counted: bool) -> Self {
        Self { device, stages: Mutex::default(), turn: Mutex::default(), is_counted }
    }

    /// Makes balls ready, and brings them to the device if they fit as a whole. `ball` gives the centre and radius of each row; the radius is 0 if it is left out.
    ///
    /// # Errors
    /// [`Error::Device`] where they do not fit, [`Error::Cancelled`].
    pub(crate) fn canvas(
        &self,
        count: usize,
        ball: impl Fn(usize) -> [f32; 4],
        control: &Control<'_>,
    ) -> Result<Canvas> {
        let most = match self.device.info.kind {
            // what a bench counts is the work of a graphics card
            DeviceKind::Software if !self.is_counted => SOFTWARE_BALLS,
            _ => MOST_GROUPS * GROUP,
        };
        let most = (self.device.limit() / (4 * MOST_TILES)).clamp(1, most);
        let of_part = count.div_ceil(count.div_ceil(most).max(1)).max(1);
        let mut parts = Vec::new();
        for first in (0..count).step_by(of_part) {
            control.check()?;
            parts.push((first..count.min(first + of_part)).map(&ball).collect());
        }
        let mut canvas = Canvas { parts, only: None, ball_count: count };
        if let [part] = &mut canvas.parts[..] {
            canvas.only = Some(self.device.filled_buffer(cast_slice(part)));
            // it stays on the device
            *part = Vec::new();
        }
        self.device.trouble.check()?;
        Ok(canvas)
    }

    /// # Errors
    /// [`Error::Device`] where the device cannot run the shaders.
    fn stages(&self, kind: Kind, shows: Shows) -> Result<Arc<Stages>> {
        let mut made = self.stages.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(stages) = made.get(&(kind, shows)) {
            return Ok(Arc::clone(stages));
        }
        let stages = Arc::new(Stages::new(&self.device.device, kind, shows, self.is_counted));
        self.device.trouble.check()?;
        made.insert((kind, shows), Arc::clone(&stages));
        Ok(stages)
    }

    /// Draws a picture, part after part. For tests it fails after `fails_after` parts.
    ///
    /// # Errors
    /// [`Error::Cancelled`], and [`Error::Device`] where the device fails.
    pub(crate) fn draw(
        &self,
        canvas: &Canvas,
        picture: &Picture<'_>,
        fails_after: Option<usize>,
        control: &Control<'_>,
    ) -> Result<Drawn> {
        let [width, height] = picture.view.size_px;
        let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        let stages = self.stages(Kind::of(picture.view), picture.shows)?;
        let of_band = self.rows_of_band(width, height)?;
        let most_balls = canvas.ball_count.div_ceil(canvas.parts.len().max(1));
        let buffers = Buffers::new(&self.device.device, most_balls, [width, of_band], picture.shows);
        self.device.trouble.check()?;
        let mut drawn = Drawn {
            depth: Vec::with_capacity(width * height),
            rows: (picture.shows != Shows::Depths).then(|| Vec::with_capacity(width * height)),
            around_eye_count: 0,
            left: Some(Vec::new()),
            work: Work::default(),
        };
        for (number, top) in (0..height).step_by(of_band).enumerate() {
            if fails_after == Some(number) {
                return Err(Error::Device { what: "the device was lost: a test".to_owned() });
            }
            let band = [top, of_band.min(height - top)];
            self.draw_band(&stages, &buffers, canvas, picture, band, control)?;
            self.read_back(&buffers, width * band[1], top == 0, &mut drawn)?;
        }
        if let Some(left) = &mut drawn.left {
            left.sort_unstable();
            left.dedup();
        }
        Ok(drawn)
    }

    /// Rows of a picture that buffers have room for, whole tiles.
    fn rows_of_band(&self, width: usize, height: usize) -> Result<usize> {
        let fits = |rows: usize| {
            let lists = tiles_before([width, rows])[LEVELS as usize] * STEPS;
            lists <= BLOCK * BLOCK && lists.max(width * rows) <= self.device.limit() / 4
        };
        let mut rows = height.next_multiple_of(TILE);
        while !fits(rows) && rows > TILE {
            rows = (rows / 2).next_multiple_of(TILE);
        }
        if fits(rows) {
            return Ok(rows);
        }
        let what = format!("a picture of {width} columns does not fit into a buffer of the device");
        Err(Error::Device { what })
    }

    fn draw_band(
        &self,
        stages: &Stages,
        buffers: &Buffers,
        canvas: &Canvas,
        picture: &Picture<'_>,
        band: Band,
        control: &Control<'_>,
    ) -> Result<()> {
        let (device, view) = (&self.device.device, picture.view);
        let [columns, rows] = [view.size_px[0].div_ceil(TILE), band[1].div_ceil(TILE)];
        let offsets = self.device.filled_buffer(&offset_bytes(view, band));
        let list_count = tiles_before([view.size_px[0], band[1]])[LEVELS as usize] * STEPS;
        let piece = if self.device.info.kind == DeviceKind::Separate { CARD_TILES } else { OTHER_TILES };
        let mut first_ball = 0;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&buffers.left_out, 0, None);
        for part in &canvas.parts {
            let brought;
            let (balls, count) = match &canvas.only {
                Some(balls) => (balls, canvas.ball_count),
                None => {
                    brought = self.device.filled_buffer(cast_slice(part));
                    (&brought, part.len())
                }
            };
            let words = self.device.filled_buffer(&view_bytes(picture, band, [first_ball, count]));
            let bound = stages.bind(device, buffers, [&words, balls, &offsets]);
            self.device.trouble.check()?;
            for buffer in [&buffers.counters, &buffers.before, &buffers.depths] {
                encoder.clear_buffer(buffer, 0, None);
            }
            bound.sort(&mut encoder, count.div_ceil(GROUP), list_count.div_ceil(BLOCK));
            self.device.queue.submit([encoder.finish()]);
            let of_piece = (piece / columns).max(1);
            let mut before = None;
            for first_row in (0..rows).step_by(of_piece) {
                control.check()?;
                self.device.queue.write_buffer(&buffers.piece, 0, &whole(first_row).to_le_bytes());
                let mut of_rows = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                bound.draw(&mut of_rows, [columns, of_piece.min(rows - first_row)]);
                let this = self.device.queue.submit([of_rows.finish()]);
                // two pieces are under way at a time, so that the device does not wait
                if let Some(before) = before.replace(this) {
                    self.device.wait_for(Some(before))?;
                }
                self.device.trouble.check()?;
            }
            first_ball += count;
            encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        }
        Ok(())
    }

    /// Appends a band of so many pixels to the picture, and what was left out to its lists.
    fn read_back(&self, buffers: &Buffers, pixel_count: usize, is_first: bool, drawn: &mut Drawn) -> Result<()> {
        let of_pixels = 4 * pixel_count as u64;
        let of_rows = if drawn.rows.is_some() { of_pixels } else { 0 };
        let of_left = buffers.left_out.size();
        let staging = self.device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture on its way back"),
            size: of_pixels + of_rows + of_left,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.device.trouble.check()?;
        let mut encoder = self.device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&buffers.pixels, 0, &staging, 0, of_pixels);
        if of_rows > 0 {
            encoder.copy_buffer_to_buffer(&buffers.rows, 0, &staging, of_pixels, of_rows);
        }
        encoder.copy_buffer_to_buffer(&buffers.left_out, 0, &staging, of_pixels + of_rows, of_left);
        self.device.queue.submit([encoder.finish()]);
        staging.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        self.device.wait_for(None)?;
        let range = staging.slice(..).get_mapped_range();
        let bytes = range.map_err(|error| Error::Device { what: format!("no picture comes back: {error}") })?;
        let words = bytes.as_chunks::<4>().0;
        let word = |word: &[u8; 4]| u32::from_le_bytes(*word);
        let (pixels, words) = words.split_at(pixel_count);
        let (rows, left) = words.split_at(if of_rows > 0 { pixel_count } else { 0 });
        drawn.depth.extend(pixels.iter().map(|bytes| f32::from_le_bytes(*bytes)));
        if let Some(all) = &mut drawn.rows {
            all.extend(rows.iter().map(word));
        }
        let head: Vec<u32> = left.iter().take(HEAD).map(word).collect();
        if is_first {
            // each part of the picture finds the same
            drawn.around_eye_count = head[0] as usize;
        }
        let [looked_at, tested, exact, listed] = [head[2], head[3], head[4], head[5]].map(u64::from);
        drawn.work += Work { listed, looked_at, tested, exact };
        let count = head[1] as usize;
        match &mut drawn.left {
            Some(all) if count <= MOST_LEFT => all.extend(left[HEAD..][..count].iter().map(word)),
            _ => drawn.left = None,
        }
        Ok(())
    }
}

/// Tiles of all levels before each level, and of all.
fn tiles_before([width, height]: [usize; 2]) -> [usize; LEVELS as usize + 1] {
    let mut before = [0; LEVELS as usize + 1];
    for level in 0..LEVELS {
        let side = TILE << (2 * level);
        before[level as usize + 1] = before[level as usize] + width.div_ceil(side) * height.div_ceil(side);
    }
    before
}

/// Pixels of a unit: a metre, or what is seen 45° off the axis, or at right angles to it.
fn scale_of(view: &View) -> f64 {
    match view.projection {
        Projection::Orthographic { pixels_per_metre } => pixels_per_metre,
        Projection::Perspective { focal_px, .. } => focal_px,
        Projection::Hemispherical { radius_px, .. } => radius_px,
    }
}

/// `View` of the shaders, for a band of a picture and some balls: the first, and how many.
fn view_bytes(picture: &Picture<'_>, [top, rows]: Band, [first_ball, ball_count]: [usize; 2]) -> Vec<u8> {
    let view = picture.view;
    let scale = scale_of(view);
    let [near, far] = picture.limits;
    let start = picture.starts.map(|start| single(start.clamp(-ENDLESS, ENDLESS)));
    let of_bounds =
        [start[0].next_down(), start[1].next_up(), single(picture.shell.min(ENDLESS)).next_up(), single(SHELL_SHARE)];
    let middle = view.middle();
    let [width, _] = view.size_px;
    let before = tiles_before([width, rows]);
    let least_pixel = 0.25 * length(cross(view.direction([0.0; 2]), view.direction([1.0; 2])));
    let frame = &view.frame;
    let doubles = [frame.right, frame.down, frame.forward, frame.eye].into_iter().flatten().chain([scale]);
    let singles = [scale, 1.0 / scale, near, far.min(ENDLESS), least_pixel].map(single);
    let words = [ball_count, width, rows, top].map(whole);
    let middle = [middle[0], middle[1] - top as f64].map(single);
    let tiles = before[..LEVELS as usize].iter().copied();
    (doubles.flat_map(f64::to_le_bytes))
        .chain(singles.into_iter().flat_map(f32::to_le_bytes))
        .chain(words.into_iter().flat_map(u32::to_le_bytes))
        .chain([0; 4])
        .chain(middle.into_iter().flat_map(f32::to_le_bytes))
        .chain(tiles.chain([first_ball]).map(whole).flat_map(u32::to_le_bytes))
        .chain(of_bounds.into_iter().flat_map(f32::to_le_bytes))
        .collect()
}

/// What the directions of pixels are made of, as `View::direction` has it: for each column, then for each row of a band.
fn offset_bytes(view: &View, [top, rows]: Band) -> Vec<u8> {
    let (middle, scale) = (view.middle(), scale_of(view));
    let offset = |axis: usize, pixel: usize| (pixel as f64 + 0.5 - middle[axis]) / scale;
    let across = (0..view.size_px[0]).map(|column| offset(0, column));
    across.chain((top..top + rows).map(|row| offset(1, row))).flat_map(f64::to_le_bytes).collect()
}

#[expect(clippy::cast_possible_truncation, reason = "as the CPU does it, or with room")]
fn single(v: f64) -> f32 {
    v as f32
}

/// A count that is known to be small: all are bounded by the size of buffers.
fn whole(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
