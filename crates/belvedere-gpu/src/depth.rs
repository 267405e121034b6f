//! Depth maps of balls, and bounds of depth, drawn on a device: balls and views as words, the stages, and the words
//! that come back. The arithmetic is in the shaders below `depth`.

mod place;
mod stages;

use crate::device::{Device, DeviceKind};
use belvedere_core::blocking::SHELL_SHARE;
use belvedere_core::depth::{BoundsParams, ItemBuffer};
use belvedere_data::cast::{to_f32, to_row};
use belvedere_data::control::Control;
use belvedere_data::view::{Projection, View};
use belvedere_data::{Error, Result};
use bytemuck::cast_slice;
pub(crate) use place::{PlacedBalls, place};
use stages::{BoundStages, DepthBuffers, DepthStages, ShaderView, Sizes};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Threads of a group, and pixels of a tile.
const GROUP: usize = 256;
/// Groups along an axis that every device allows.
const MAX_GROUPS: usize = 65_535;
/// Side of the smallest tiles, pixels.
const TILE: usize = 16;
/// Sizes of tiles, each four times as long as the one before.
const LEVELS: u32 = 7;
/// Steps of depth, by which balls of a tile are ordered.
const STEPS: usize = 32;
/// Lists that are summed up together, and how many of such blocks there can be.
const BLOCK: usize = 2048;
/// Tiles of a ball, at most.
const MAX_TILES: usize = 9;
/// Words of the ranges of depth in which balls are counted.
const RANGES: usize = 4096;
/// Maximum number of balls at a time on a device in software. Mesa's ends a loop of a thread after 65 535 turns, and a
/// pixel may turn once for each ball.
const MAX_SOFTWARE_BALLS: usize = 1 << 15;
/// Bytes of a pixel in the largest buffer.
const PIXEL_BYTES: usize = 16;
/// Pixels that the shaders widen outlines by.
const BEYOND: f64 = 2.0;
/// Views with a nearest depth beyond this are the CPU's, metres.
const MAX_NEAR: f64 = 1e9;
/// Limit of depth without end on a device, metres: beyond all that it draws.
const ENDLESS: f64 = 1e30;
/// Tiles that are drawn at a time on a graphics card, and on any other device: as for lines of sight, so that no
/// picture freezes.
const CARD_TILES: usize = 1 << 16;
const OTHER_TILES: usize = 1 << 12;

/// A device with the shaders of depth maps, those of each kind of view made when first needed.
#[derive(Debug)]
pub(crate) struct Painter {
    device: Arc<Device>,
    stages: Mutex<HashMap<(ShaderView, Shows), Arc<DepthStages>>>,
    /// One picture at a time: together they could need more memory than there is.
    turn: Mutex<()>,
}

/// Content of pixels, as the shaders number it.
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
pub(crate) struct DevicePicture<'v> {
    view: &'v View,
    shows: Shows,
    /// Limits of depth.
    limits: [f64; 2],
    /// Starts of the bounds.
    starts: [f64; 2],
    shell: f64,
}

impl<'v> DevicePicture<'v> {
    /// A depth map.
    pub(crate) fn depths(view: &'v View, items: ItemBuffer) -> Self {
        let shows = if items == ItemBuffer::With { Shows::Balls } else { Shows::Depths };
        Self { view, shows, limits: view.limits(), starts: [0.0; 2], shell: 0.0 }
    }

    /// Bounds of depth. The start of `params` limits lines of sight, not the limits of the view.
    pub(crate) fn bounds(view: &'v View, params: &BoundsParams) -> Self {
        let near = if view.is_central() { 0.0 } else { -ENDLESS };
        let starts = params.starts(view);
        Self { view, shows: Shows::Bounds, limits: [near, ENDLESS], starts, shell: params.shell }
    }

    /// Returns true if single precision can represent its parameters.
    pub(crate) fn can_be_drawn(&self) -> bool {
        self.limits[0] <= MAX_NEAR && (1e-6..=1e9).contains(&scale_of(self.view))
    }
}

/// Result of a device.
#[derive(Debug)]
pub(crate) struct Drawn {
    /// Depths, or upper bounds. The sign of a pixel that the CPU has to draw again is set.
    pub(crate) depth: Vec<f32>,
    /// Rows of balls, or bits of lower bounds.
    pub(crate) rows: Option<Vec<u32>>,
    /// For pixels with the sign: which balls may be the nearest. `None` if there are too many.
    pub(crate) candidates: Option<Vec<Candidate>>,
}

/// A ball that may be the nearest at a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    /// Number of the pixel in the picture.
    pub(crate) pixel: usize,
    /// Row of the ball.
    pub(crate) row: u32,
}

/// A part of a picture that is drawn at a time: first row and number of rows.
type PixelRows = [usize; 2];

impl Painter {
    pub(crate) fn new(device: Arc<Device>) -> Self {
        Self { device, stages: Mutex::default(), turn: Mutex::default() }
    }

    /// Balls that are drawn at a time.
    fn max_balls(&self) -> usize {
        let most = match self.device.info.kind {
            DeviceKind::Software => MAX_SOFTWARE_BALLS,
            _ => MAX_GROUPS * GROUP,
        };
        (self.device.limit() / (4 * MAX_TILES)).clamp(1, most)
    }

    /// # Errors
    /// [`Error::Device`] where the device cannot run the shaders.
    fn stages(&self, kind: ShaderView, shows: Shows) -> Result<Arc<DepthStages>> {
        let mut made = self.stages.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(stages) = made.get(&(kind, shows)) {
            return Ok(Arc::clone(stages));
        }
        let stages = Arc::new(DepthStages::new(&self.device.device, kind, shows));
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
        placed: &PlacedBalls,
        picture: &DevicePicture<'_>,
        fails_after: Option<usize>,
        control: &Control<'_>,
    ) -> Result<Drawn> {
        let [width, height] = picture.view.size_px;
        let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        let stages = self.stages(ShaderView::of(picture.view), picture.shows)?;
        let row_count = self.rows_of_band(width, height)?;
        let part_count = placed.splats.len().div_ceil(self.max_balls());
        let parts: Vec<&[[f32; 4]]> =
            placed.splats.chunks(placed.splats.len().div_ceil(part_count.max(1)).max(1)).collect();
        let buffers = DepthBuffers::new(
            &self.device.device,
            &Sizes {
                ball_count: parts.first().map_or(0, |part| part.len()),
                is_whole: parts.len() <= 1,
                size_px: [width, row_count],
                shows: picture.shows,
            },
        );
        self.device.trouble.check()?;
        let mut drawn = Drawn {
            depth: Vec::with_capacity(width * height),
            rows: (picture.shows != Shows::Depths).then(|| Vec::with_capacity(width * height)),
            candidates: Some(Vec::new()),
        };
        for (number, top) in (0..height).step_by(row_count).enumerate() {
            if fails_after == Some(number) {
                return Err(Error::Device { what: "the device was lost: a test".to_owned() });
            }
            let band = [top, row_count.min(height - top)];
            self.draw_band(&stages, &buffers, &parts, picture, band, control)?;
            self.read_back(&buffers, picture, band, &mut drawn)?;
        }
        Ok(drawn)
    }

    /// Rows of a picture that buffers have room for, whole tiles.
    fn rows_of_band(&self, width: usize, height: usize) -> Result<usize> {
        let fits = |rows: usize| {
            let lists = tiles_before([width, rows])[LEVELS as usize] * STEPS;
            lists <= BLOCK * BLOCK && (4 * lists).max(PIXEL_BYTES * width * rows) <= self.device.limit()
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
        stages: &DepthStages,
        buffers: &DepthBuffers,
        parts: &[&[[f32; 4]]],
        picture: &DevicePicture<'_>,
        band: PixelRows,
        control: &Control<'_>,
    ) -> Result<()> {
        let device = &self.device.device;
        let list_count = tiles_before([picture.view.size_px[0], band[1]])[LEVELS as usize] * STEPS;
        let turns: &[bool] = if picture.shows == Shows::Bounds { &[false] } else { &[false, true] };
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&buffers.candidates, 0, Some(4));
        let only = if let [part] = parts { Some(self.device.filled_buffer(cast_slice(part))) } else { None };
        for &is_listing in turns {
            let mut first_ball = 0;
            for (number, part) in parts.iter().enumerate() {
                let is_last = number + 1 == parts.len();
                let splats = only.clone().unwrap_or_else(|| self.device.filled_buffer(cast_slice(part)));
                let words = view_bytes(picture, band, &BallRows { first: first_ball, count: part.len(), is_last });
                let bound = stages.bind(device, buffers, &self.device.filled_buffer(&words), &splats);
                self.device.trouble.check()?;
                // the lists of a single part are there already
                if !is_listing || parts.len() > 1 {
                    for buffer in [&buffers.counters, &buffers.before, &buffers.depths] {
                        encoder.clear_buffer(buffer, 0, None);
                    }
                    bound.sort(&mut encoder, part.len().div_ceil(GROUP), list_count.div_ceil(BLOCK));
                }
                self.device.queue.submit([encoder.finish()]);
                self.draw_pieces(&bound, buffers, picture.view, band, is_listing, control)?;
                first_ball += part.len();
                encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            }
        }
        Ok(())
    }

    /// Draws the pixels of a band, or lists candidates of its marked pixels, in pieces.
    fn draw_pieces(
        &self,
        bound: &BoundStages<'_>,
        buffers: &DepthBuffers,
        view: &View,
        band: PixelRows,
        is_listing: bool,
        control: &Control<'_>,
    ) -> Result<()> {
        let [columns, rows] = [view.size_px[0].div_ceil(TILE), band[1].div_ceil(TILE)];
        let tiles = if self.device.info.kind == DeviceKind::Separate { CARD_TILES } else { OTHER_TILES };
        let row_count = (tiles / columns).max(1);
        let mut before = None;
        for first_row in (0..rows).step_by(row_count) {
            control.check()?;
            let piece = [to_row(first_row), u32::from(is_listing)];
            self.device.queue.write_buffer(&buffers.piece, 0, cast_slice(&piece));
            let mut encoder = self.device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            bound.draw(&mut encoder, [columns, row_count.min(rows - first_row)]);
            let this = self.device.queue.submit([encoder.finish()]);
            // two pieces are under way at a time, so that the device does not wait
            if let Some(before) = before.replace(this) {
                self.device.wait_for(Some(before))?;
            }
            self.device.trouble.check()?;
        }
        Ok(())
    }

    /// Appends a band to the picture.
    fn read_back(
        &self,
        buffers: &DepthBuffers,
        picture: &DevicePicture<'_>,
        [top, rows]: PixelRows,
        drawn: &mut Drawn,
    ) -> Result<()> {
        let width = picture.view.size_px[0];
        let pixel_bytes = 4 * (width * rows) as u64;
        drawn.depth.extend(self.words(&buffers.pixels, pixel_bytes)?.into_iter().map(f32::from_bits));
        if let Some(all) = &mut drawn.rows {
            all.extend(self.words(&buffers.rows, pixel_bytes)?);
        }
        if picture.shows == Shows::Bounds {
            return Ok(());
        }
        let count = u64::from(self.words(&buffers.candidates, 4)?.first().copied().unwrap_or_default());
        let bytes = 4 + 8 * count;
        if bytes > buffers.candidates.size() {
            drawn.candidates = None;
        }
        let Some(all) = drawn.candidates.as_mut().filter(|_| count > 0) else { return Ok(()) };
        let words = self.words(&buffers.candidates, bytes)?;
        let pairs = words.get(1..).unwrap_or_default().as_chunks::<2>().0;
        all.extend(pairs.iter().map(|&[pixel, row]| Candidate { pixel: top * width + pixel as usize, row }));
        Ok(())
    }

    /// The first words of a buffer.
    fn words(&self, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<u32>> {
        let device = &self.device.device;
        let staging = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("on its way back"),
            size: bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.device.trouble.check()?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, bytes);
        self.device.queue.submit([encoder.finish()]);
        staging.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        self.device.wait_for(None)?;
        let range = staging.slice(..).get_mapped_range();
        let bytes = range.map_err(|error| Error::Device { what: format!("no picture comes back: {error}") })?;
        Ok(bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect())
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

/// Pixels of a unit: a metre, or a direction 45° off the axis, or one at right angles to it.
fn scale_of(view: &View) -> f64 {
    match view.projection {
        Projection::Orthographic { pixels_per_metre } => pixels_per_metre,
        Projection::Perspective { focal_px, .. } => focal_px,
        Projection::Hemispherical { radius_px, .. } => radius_px,
    }
}

/// Some balls of a scene.
struct BallRows {
    first: usize,
    count: usize,
    /// True if no others come after them.
    is_last: bool,
}

/// `View` of the shaders, for a band of a picture and some balls.
fn view_bytes(picture: &DevicePicture<'_>, [top, rows]: PixelRows, balls: &BallRows) -> Vec<u8> {
    let view = picture.view;
    let scale = scale_of(view);
    let [near, far] = picture.limits;
    let start = picture.starts.map(|start| to_f32(start.clamp(-ENDLESS, ENDLESS)));
    let of_bounds =
        [start[0].next_down(), start[1].next_up(), to_f32(picture.shell.min(ENDLESS)).next_up(), to_f32(SHELL_SHARE)];
    let middle = view.middle();
    let [width, _] = view.size_px;
    let tiles = tiles_before([width, rows]);
    let of_view = [scale, 1.0 / scale, near, far.min(ENDLESS)].map(to_f32);
    let of_band = [balls.count, width, rows, top].map(to_row);
    let of_middle = [middle[0], middle[1] - top as f64].map(to_f32);
    let of_balls = [to_row(balls.first), u32::from(balls.is_last)];
    let words = (of_view.map(f32::to_bits).into_iter())
        .chain(of_band)
        .chain(of_middle.map(f32::to_bits))
        .chain(of_balls)
        .chain(of_bounds.map(f32::to_bits))
        .chain(tiles.into_iter().take(LEVELS as usize).map(to_row));
    words.flat_map(u32::to_le_bytes).collect()
}
