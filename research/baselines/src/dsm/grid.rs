//! Rays over a height field, with a pyramid of greatest heights that lets them step over what lies far below.

use super::DsmSurface;
use belvedere::cast::to_i64;
use belvedere::raster::Raster;
use belvedere::ray_index::Ray;

/// A height field cut into patches: cells, or the squares between the middles of four cells.
pub(super) struct HeightGrid {
    heights: Raster<f32>,
    corner: [f64; 2],
    cell: f64,
    relief: DsmSurface,
    /// Greatest height of each patch, then of 2 × 2, 4 × 4… patches; −∞ where there is none.
    greatest: Vec<Raster<f32>>,
    lowest: f32,
}

/// A ray in units of patches across and metres up, from `start` to `end`, metres along it.
struct Track {
    at: [f64; 2],
    step: [f64; 2],
    height: f64,
    rise: f64,
    end: f64,
}

impl Track {
    fn across(&self, axis: usize, range: f64) -> f64 {
        if self.step[axis] == 0.0 { self.at[axis] } else { self.at[axis] + range * self.step[axis] }
    }

    fn up(&self, range: f64) -> f64 {
        if self.rise == 0.0 { self.height } else { self.height + range * self.rise }
    }
}

impl HeightGrid {
    /// `heights` with row 0 in the south, NaN where there is none; `corner` is the south-western corner of the first
    /// cell.
    pub(super) fn new(heights: Raster<f32>, corner: [f64; 2], cell: f64, relief: DsmSurface) -> Self {
        let base = match relief {
            DsmSurface::Columns => pooled(&heights, [heights.width(), heights.height()], 1, 1),
            DsmSurface::Bilinear => pooled(&heights, [heights.width() - 1, heights.height() - 1], 1, 2),
        };
        let mut greatest = vec![base];
        while let Some(finest) = greatest.last().filter(|level| level.width() > 1 || level.height() > 1) {
            let size = [finest.width().div_ceil(2), finest.height().div_ceil(2)];
            greatest.push(pooled(finest, size, 2, 2));
        }
        let lowest = heights.values().iter().copied().fold(f32::INFINITY, f32::min);
        Self { heights, corner, cell, relief, greatest, lowest }
    }

    pub(super) fn heights(&self) -> &Raster<f32> {
        &self.heights
    }

    pub(super) fn corner(&self) -> [f64; 2] {
        self.corner
    }

    /// Whether the surface lies above some part of `ray` within its ranges; of columns, those that hold the two ends of
    /// the line of sight (the origin of the ray and the end of its ranges) do not count.
    ///
    /// # Source
    /// Maximum mipmaps: Tevs, Ihrke & Seidel 2008, "Maximum Mipmaps for Fast, Accurate, and Scalable Dynamic Height
    /// Field Rendering".
    pub(super) fn blocks(&self, ray: &Ray) -> bool {
        let Some(top) = self.greatest.last().and_then(|level| level.get(0, 0)) else { return false };
        let offset = if self.relief == DsmSurface::Bilinear { 0.5 } else { 0.0 };
        let mut track = Track {
            at: [0, 1].map(|axis| (ray.origin[axis] - self.corner[axis]) / self.cell - offset),
            step: [0, 1].map(|axis| ray.direction[axis] / self.cell),
            height: ray.origin[2],
            rise: ray.direction[2],
            end: ray.ranges[1],
        };
        let ends = [Some(0.0), track.end.is_finite().then_some(track.end)]
            .map(|range| range.map(|range| [0, 1].map(|axis| cell(track.across(axis, range)))));
        if track.rise > 0.0 {
            track.end = track.end.min((f64::from(top) - track.height) / track.rise);
        } else if track.step == [0.0; 2] {
            // straight down: a metre below the lowest height the answer is certain
            let bottom = f64::from(self.lowest) - 1.0;
            track.end = track.end.min(((bottom - track.height) / track.rise).max(ray.ranges[0]));
        }
        let Some((mut range, mut patch)) = self.enter(&mut track, ray.ranges[0]) else { return false };
        let mut level = self.greatest.len() - 1;
        loop {
            let block = patch.map(|index| index >> level);
            let borders = [0, 1].map(|axis| match track.step[axis] {
                step if step > 0.0 => (((block[axis] + 1) << level) as f64 - track.at[axis]) / step,
                step if step < 0.0 => ((block[axis] << level) as f64 - track.at[axis]) / step,
                _ => f64::INFINITY,
            });
            let axis = usize::from(borders[1] < borders[0]);
            let leave = borders[axis].min(track.end).max(range);
            let lowest = track.up(range).min(track.up(leave));
            if self.greatest_at(level, block).is_some_and(|greatest| lowest < f64::from(greatest)) {
                if level > 0 {
                    level -= 1;
                    continue;
                }
                let counts = self.relief == DsmSurface::Bilinear || !ends.contains(&Some(patch));
                if counts && self.patch_blocks(patch, &track, [range, leave]) {
                    return true;
                }
            }
            if borders[axis] >= track.end {
                return false;
            }
            let other = 1 - axis;
            let mut next = patch;
            let onward = track.step[axis] > 0.0;
            next[axis] = if onward { (block[axis] + 1) << level } else { (block[axis] << level) - 1 };
            let [first, last] = [block[other] << level, ((block[other] + 1) << level) - 1];
            next[other] = cell(track.across(other, leave)).clamp(first, last);
            if !self.holds(next) {
                return false;
            }
            let leaves_parent = [0, 1].iter().any(|&a| next[a] >> (level + 1) != patch[a] >> (level + 1));
            if leaves_parent && level + 1 < self.greatest.len() {
                level += 1;
            }
            (range, patch) = (leave, next);
        }
    }

    /// Where a track from `start` on enters the field, and the patch there; shortens it to the field.
    fn enter(&self, track: &mut Track, start: f64) -> Option<(f64, [i64; 2])> {
        let size = self.size();
        let mut start = start;
        for ((at, step), size) in track.at.into_iter().zip(track.step).zip(size) {
            let size = size as f64;
            if step == 0.0 {
                if !(at >= 0.0 && at <= size) {
                    return None;
                }
                continue;
            }
            let (a, b) = (-at / step, (size - at) / step);
            start = start.max(a.min(b));
            track.end = track.end.min(a.max(b));
        }
        let patch = [0, 1].map(|axis| cell(track.across(axis, start)).clamp(0, (size[axis] - 1).max(0)));
        (start <= track.end && self.holds(patch)).then_some((start, patch))
    }

    fn size(&self) -> [i64; 2] {
        self.greatest.first().map_or([0; 2], |finest| [finest.width(), finest.height()].map(|n| n as i64))
    }

    fn holds(&self, patch: [i64; 2]) -> bool {
        let size = self.size();
        [0, 1].iter().all(|&axis| (0..size[axis]).contains(&patch[axis]))
    }

    fn greatest_at(&self, level: usize, block: [i64; 2]) -> Option<f32> {
        let [column, row] = [usize::try_from(block[0]).ok()?, usize::try_from(block[1]).ok()?];
        self.greatest.get(level)?.get(column, row)
    }

    /// Whether the surface of a patch lies above the track between two ranges.
    fn patch_blocks(&self, patch: [i64; 2], track: &Track, ranges: [f64; 2]) -> bool {
        let (Ok(column), Ok(row)) = (usize::try_from(patch[0]), usize::try_from(patch[1])) else { return false };
        if self.relief == DsmSurface::Columns {
            // the greatest height of a column is its height, which the caller has compared
            return true;
        }
        let corner = |dx: usize, dy: usize| self.heights.get(column + dx, row + dy).map_or(f64::NAN, f64::from);
        let (base, dx, dy) = (corner(0, 0), corner(1, 0) - corner(0, 0), corner(0, 1) - corner(0, 0));
        let twist = corner(1, 1) - corner(0, 0) - dx - dy;
        let from_corner = |range: f64| [0, 1].map(|axis| track.across(axis, range) - patch[axis] as f64);
        let clearance = |range: f64| {
            let [u, v] = from_corner(range);
            track.up(range) - (base + dx * u + dy * v + twist * u * v)
        };
        // along the track the clearance is a parabola, whose second derivative is −2 · twist · step · step
        let [start, end] = ranges;
        let curvature = -twist * track.step[0] * track.step[1];
        if clearance(start) < 0.0 || clearance(end) < 0.0 {
            return true;
        }
        let [u, v] = from_corner(start);
        let slope =
            track.rise - (dx * track.step[0] + dy * track.step[1] + twist * (u * track.step[1] + v * track.step[0]));
        let vertex = start - slope / (2.0 * curvature);
        curvature > 0.0 && start < vertex && vertex < end && clearance(vertex) < 0.0
    }
}

/// The greatest value of each window of `window` × `window` values, `stride` apart; windows that hold NaN are lower
/// than all.
fn pooled(values: &Raster<f32>, size: [usize; 2], stride: usize, window: usize) -> Raster<f32> {
    let [width, height] = size;
    let mut pooled = Raster::filled(width, height, f32::NEG_INFINITY);
    for (index, greatest) in pooled.values_mut().iter_mut().enumerate() {
        let (column, row) = (index % width * stride, index / width * stride);
        for dy in 0..window {
            for dx in 0..window {
                *greatest = values.get(column + dx, row + dy).map_or(*greatest, |value| greatest.max(value));
            }
        }
    }
    pooled
}

fn cell(coordinate: f64) -> i64 {
    to_i64(coordinate.floor())
}
