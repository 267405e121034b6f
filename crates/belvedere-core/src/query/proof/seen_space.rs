//! Boxes of space that are near some pulse everywhere: most of a line of sight is proven by a look at these.

use crate::pulses::FreeSegments;
use belvedere_data::Result;
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// Side of a box as a share of the nearness. A pulse that passes the middle of a box within nearness − side/√2 is near
/// to all of it. Smaller boxes more often find such a pulse, but there are more of them.
const SIDE_PER_NEARNESS: f64 = 0.45;
/// Height of a box as a share of the nearness: leaning pulses need low boxes.
const HEIGHT_PER_NEARNESS: f64 = 1.0;
/// Height of a box as a share of the nearness where pulses run in all directions: boxes are cubes.
const HEIGHT_AMONG_FLAT: f64 = SIDE_PER_NEARNESS;
/// Boxes above one another: bits of a word. Higher scenes get higher boxes, of which fewer are near one pulse over
/// their whole height.
const MAX_LAYERS: f64 = 64.0;
/// Maximum number of columns, 160 MB; a larger survey gets larger boxes, and lines that these cannot prove are tested
/// with the pulses.
const MAX_COLUMNS: f64 = 2e7;
/// Maximum shift of a pulse by rounding to f32, metres.
const ROUNDING: f64 = 2e-3;

/// Columns of boxes along a side of a tile: 5 m of usual pulses.
const TILE: usize = 16;

/// A grid of boxes, each known to be near pulses or not. It proves less than the pulses themselves and nothing that
/// they do not.
///
/// Tiles of it are made when a line first runs through them, so that a few lines cost little and many share the work.
pub(super) struct SeenSpace {
    /// Lowest corner.
    low: [f64; 3],
    /// Width and height of a box.
    side: f64,
    height: f64,
    /// Boxes in a metre.
    per_side: f64,
    /// Boxes above one another.
    layers: usize,
    /// Maximum distance of a pulse, less its possible shift by rounding, metres.
    nearness: f64,
    /// Maximum distance of a pulse from the middle line of a box, metres.
    reach: f64,
    size: [usize; 2],
    /// Tiles in a row.
    width: usize,
    tiles: Vec<OnceLock<Box<BoxColumns>>>,
}

/// Columns along a side of a block of a tile.
const BLOCK: usize = 4;
const BLOCKS: usize = TILE / BLOCK;

/// Columns of boxes; the lowest box of a column is the lowest bit of its word.
struct BoxColumns {
    /// Each column, row by row.
    columns: [u64; TILE * TILE],
    /// The layers on which all columns of a block are near pulses, so that a line crosses it in one step.
    blocks: [u64; BLOCKS * BLOCKS],
    /// The layers on which all columns of the tile are near pulses.
    all: u64,
    /// Results at the middles of other boxes, once any was tested.
    middles: OnceLock<Box<[Middles; TILE * TILE]>>,
}

/// The middles of the boxes of a column: bits as in [`BoxColumns`].
#[derive(Default)]
struct Middles {
    /// Bit mask of the middles that were tested.
    known: AtomicU64,
    /// Bit mask of the middles near a pulse.
    near: AtomicU64,
}

/// The bits from one up to another, which is left out and at most 64.
#[inline]
fn bits(from: u32, to: u32) -> u64 {
    if from < to { u64::MAX >> (64 - (to - from)) << from } else { 0 }
}

/// The lower of two numbers, and the higher: one instruction each, since neither is NaN here.
#[inline]
fn lower(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline]
fn higher(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

impl BoxColumns {
    fn new(columns: [u64; TILE * TILE]) -> Self {
        let mut blocks = [u64::MAX; BLOCKS * BLOCKS];
        for (index, word) in columns.iter().enumerate() {
            blocks[index / TILE / BLOCK * BLOCKS + index % TILE / BLOCK] &= word;
        }
        let all = blocks.iter().fold(u64::MAX, |all, word| all & word);
        Self { columns, blocks, all, middles: OnceLock::new() }
    }

    /// The widest group of columns around one that is near pulses on a layer: its side and its word.
    fn widest(&self, [column, row]: [usize; 2], layer: usize) -> Option<(usize, u64)> {
        let block = self.blocks[row / BLOCK * BLOCKS + column / BLOCK];
        let groups = [(TILE, self.all), (BLOCK, block), (1, self.columns[row * TILE + column])];
        groups.into_iter().find(|(_, word)| word >> layer & 1 == 1)
    }

    /// Returns true if a pulse came near to the middle of a box; `look` tests it the first time.
    fn is_middle_near(&self, column: usize, layer: usize, look: impl FnOnce() -> bool) -> bool {
        let middles = self.middles.get_or_init(|| Box::new(std::array::from_fn(|_| Middles::default())));
        let Middles { known, near } = &middles[column];
        let bit = 1 << layer;
        // whoever sees that it is known sees what was found before; two that look at once find the same
        if known.load(Ordering::Acquire) & bit == 0 {
            let is_near = look();
            near.fetch_or(if is_near { bit } else { 0 }, Ordering::Relaxed);
            known.fetch_or(bit, Ordering::Release);
            return is_near;
        }
        near.load(Ordering::Relaxed) & bit != 0
    }
}

impl SeenSpace {
    /// Boxes over the rectangle from `low` to `high`, for pulses that count up to `nearness` metres.
    pub(super) fn new(free_segments: &FreeSegments, [low, high]: [[f64; 2]; 2], nearness: f64) -> Self {
        let extent = [0, 1].map(|axis| high[axis] - low[axis]);
        let side = (SIDE_PER_NEARNESS * nearness).max((extent[0] * extent[1] / MAX_COLUMNS).max(0.0).sqrt());
        let nearness = nearness - ROUNDING;
        let reach = nearness - half_diagonal(side);
        let floor = free_segments.lower_ends().map(|start| f64::from(start[2])).fold(f64::INFINITY, f64::min);
        let rise = f64::from(free_segments.top()) - floor;
        let per_nearness =
            if free_segments.upright_count() < free_segments.len() { HEIGHT_AMONG_FLAT } else { HEIGHT_PER_NEARNESS };
        let layers = (rise / (per_nearness * nearness)).ceil().clamp(1.0, MAX_LAYERS);
        let counts = extent.map(|extent| (extent / side).floor() + 1.0);
        let usable = reach > 0.0 && rise > 0.0 && rise.is_finite() && counts[0] * counts[1] < 2.0 * MAX_COLUMNS;
        let size = if usable { counts.map(to_index) } else { [0; 2] };
        let [width, rows] = size.map(|count| count.div_ceil(TILE));
        Self {
            low: [low[0], low[1], floor],
            side,
            height: rise / layers,
            per_side: 1.0 / side,
            layers: to_index(layers),
            nearness,
            reach,
            size,
            width,
            tiles: (0..width * rows).map(|_| OnceLock::new()).collect(),
        }
    }

    /// Makes all tiles that no line has run through yet.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn make_all(&self, free_segments: &FreeSegments, control: &Control<'_>) -> Result<()> {
        self.tiles.par_iter().enumerate().try_for_each(|(number, tile)| {
            control.check()?;
            tile.get_or_init(|| self.tile(free_segments, [number % self.width * TILE, number / self.width * TILE]));
            Ok(())
        })
    }

    /// The columns of all tiles; `None` as long as one is not made.
    pub(super) fn to_words(&self) -> Option<Vec<u64>> {
        let mut words = Vec::with_capacity(self.tiles.len() * TILE * TILE);
        for tile in &self.tiles {
            words.extend(tile.get()?.columns);
        }
        Some(words)
    }

    /// Takes the columns of [`SeenSpace::to_words`] for the same pulses; other numbers of them are left.
    pub(super) fn take(&self, words: &[u64]) {
        let (tiles, rest) = words.as_chunks::<{ TILE * TILE }>();
        if tiles.len() == self.tiles.len() && rest.is_empty() {
            for (tile, columns) in self.tiles.iter().zip(tiles) {
                tile.get_or_init(|| Box::new(BoxColumns::new(*columns)));
            }
        }
    }

    /// The boxes of the tile whose lowest column and row are `first`.
    fn tile(&self, free_segments: &FreeSegments, first: [usize; 2]) -> Box<BoxColumns> {
        let mut boxes = [0; TILE * TILE];
        // one more box on all sides than the pulses that count for the tile need
        let room = self.reach + self.side;
        let low = [0, 1].map(|axis| self.low[axis] + first[axis] as f64 * self.side - room);
        let high = low.map(|low| low + TILE as f64 * self.side + 2.0 * room);
        free_segments.each_upright_over([low, high], |ends| self.mark(ends, [low, high], first, &mut boxes));
        if free_segments.upright_count() < free_segments.len() {
            self.mark_around_middles(free_segments, first, &mut boxes);
        }
        Box::new(BoxColumns::new(boxes))
    }

    /// Marks the boxes of a tile that are near a pulse: those with all corners near it, since the space near a pulse is
    /// convex. The pulse must be within `reach` of the middle line of a box where it enters and where it leaves the
    /// layer. In the layer where it begins it must be nearer, since the lower corners lie below its end. Such boxes lie
    /// below the part of the pulse over the rectangle `over`.
    fn mark(
        &self,
        [start, end]: [[f64; 3]; 2],
        over: [[f64; 2]; 2],
        first: [usize; 2],
        boxes: &mut [u64; TILE * TILE],
    ) {
        // heights in layers, places on the map in metres from the middle of the tile's first box
        let [bottom, top] = [start[2], end[2]].map(|z| (z - self.low[2]) / self.height);
        let lean = [0, 1].map(|axis| (end[axis] - start[axis]) / (top - bottom));
        let place = [0, 1].map(|axis| start[axis] - self.low[axis] - (first[axis] as f64 + 0.5) * self.side);
        // the layers that it passes through between two heights above its lower end; that it begins in is not one of
        // them
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 64, and `as` saturates")]
        let layers_between = |from: f64, to: f64| {
            bits(((bottom + from) as u32).saturating_add(1), ((bottom + to) as u32).min(self.layers as u32))
        };
        // a pulse that ends at the common top counts for the highest layer
        let rise = top - bottom + ROUNDING / self.height;
        self.mark_lowest([bottom, bottom + rise], place, lean, boxes);
        // where it comes over the rectangle, and where it leaves it
        let mut inside = [0.0, rise];
        for axis in 0..2 {
            if lean[axis] != 0.0 {
                let [a, b] = over.map(|over| (over[axis] - start[axis]) / lean[axis]);
                inside = [higher(inside[0], lower(a, b)), lower(inside[1], higher(a, b))];
            }
        }
        if !(inside[0] < inside[1]) {
            return;
        }
        let square = lean[0] * lean[0] + lean[1] * lean[1];
        let at = |axis: usize, risen: f64| place[axis] + risen * lean[axis];
        for row in self.boxes_between(at(1, inside[0]), at(1, inside[1]), self.reach) {
            let y = place[1] - row as f64 * self.side;
            let mut beside = inside;
            if lean[1] != 0.0 {
                let [a, b] = [-self.reach, self.reach].map(|edge| (edge - y) / lean[1]);
                beside = [higher(beside[0], lower(a, b)), lower(beside[1], higher(a, b))];
            }
            if !(beside[0] < beside[1]) {
                continue;
            }
            let wanted = layers_between(beside[0], beside[1]);
            for column in self.boxes_between(at(0, beside[0]), at(0, beside[1]), self.reach) {
                let word = &mut boxes[row * TILE + column];
                if *word & wanted == wanted {
                    continue;
                }
                // (x + r lean)² + (y + r lean)² < reach² between two heights r
                let x = place[0] - column as f64 * self.side;
                let half = x * lean[0] + y * lean[1];
                let spare = self.reach * self.reach - x * x - y * y;
                let discriminant = half * half + square * spare;
                if square == 0.0 {
                    *word |= if spare > 0.0 { wanted } else { 0 };
                } else if discriminant > 0.0 {
                    let root = discriminant.sqrt();
                    let [from, to] = [-half - root, root - half].map(|r| r / square);
                    *word |= layers_between(higher(from, beside[0]), higher(lower(to, beside[1]), 0.0));
                }
            }
        }
    }

    /// Marks boxes of the layer in which a pulse begins, if it ends above that. Its ends are in layers, and its lower
    /// end is at `place`, metres from the middle of the tile's first box.
    fn mark_lowest(&self, [bottom, top]: [f64; 2], place: [f64; 2], lean: [f64; 2], boxes: &mut [u64; TILE * TILE]) {
        let layer = to_index(bottom);
        let above = (layer + 1) as f64;
        let below = (bottom - layer as f64) * self.height;
        let reach = (self.nearness.powi(2) - below.powi(2)).max(0.0).sqrt() - half_diagonal(self.side);
        if !(reach > 0.0 && above <= top) || layer >= self.layers {
            return;
        }
        let leaves = [0, 1].map(|axis| place[axis] + (above - bottom) * lean[axis]);
        for row in self.boxes_between(place[1], place[1], reach) {
            let y = [place[1], leaves[1]].map(|y| y - row as f64 * self.side);
            for column in self.boxes_between(place[0], place[0], reach) {
                let x = [place[0], leaves[0]].map(|x| x - column as f64 * self.side);
                let is_near =
                    x[0].powi(2) + y[0].powi(2) < reach.powi(2) && x[1].powi(2) + y[1].powi(2) < self.reach.powi(2);
                boxes[row * TILE + column] |= u64::from(is_near) << layer;
            }
        }
    }

    /// Returns the columns or rows of a tile whose middles may be within reach of the interval between two places,
    /// metres from the middle of its first box. It may return one more: exact rounding would take longer than a vain
    /// test.
    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index into the tile")]
    fn boxes_between(&self, a: f64, b: f64, reach: f64) -> Range<usize> {
        let [low, high] = [lower(a, b) - reach, higher(a, b) + reach].map(|place| place * self.per_side);
        let within = |place: f64| lower(higher(place, 0.0), TILE as f64) as u32 as usize;
        within(low)..within(high + 1.0)
    }

    /// Marks those other boxes of a tile whose middle any pulse passes so closely that the whole box is near to it.
    fn mark_around_middles(&self, free_segments: &FreeSegments, first: [usize; 2], boxes: &mut [u64; TILE * TILE]) {
        let reach = self.nearness - half_diagonal(self.side).hypot(self.height / 2.0);
        for (index, word) in boxes.iter_mut().enumerate() {
            let cell = [first[0] + index % TILE, first[1] + index / TILE];
            let [x, y] = [0, 1].map(|axis| self.low[axis] + (cell[axis] as f64 + 0.5) * self.side);
            for layer in 0..self.layers {
                if *word >> layer & 1 == 1 {
                    continue;
                }
                let z = self.low[2] + (layer as f64 + 0.5) * self.height;
                *word |= u64::from(free_segments.passes_within([x, y, z], reach)) << layer;
            }
        }
    }

    /// Returns the distance along a line at which it leaves the boxes around the one at `at`, if all of these are near
    /// `free_segments`, those of the grid.
    pub(super) fn near_until(&self, free_segments: &FreeSegments, line: ([f64; 3], [f64; 3]), at: f64) -> Option<f64> {
        let [column, row, layer] = self.places(line, at);
        if !(column >= 0.0 && row >= 0.0 && layer >= 0.0) {
            return None;
        }
        let [column, row, layer] = [column, row, layer].map(to_index);
        if column >= self.size[0] || row >= self.size[1] || layer >= 64 {
            return None;
        }
        let (tile, within) = self.tile_around(free_segments, [column, row])?;
        let (width, word) = tile.widest(within, layer)?;
        let edges = boxes_around([column, row, layer], width, word).map(|ends| ends.map(|edge| edge as f64));
        let exit = self.exit(line, edges);
        // at least a micrometre on, so that a walk ends
        (exit > at + 1e-6).then_some(exit)
    }

    /// About how much of a line between two ranges runs through space that is not near `free_segments`, those that the
    /// grid was made for: through boxes whose middle is not. The outermost boxes reach out without end. `enough` or
    /// more as soon as it is so much; `None` if there is no grid. Each middle is looked at once, whatever runs there.
    pub(super) fn unseen_length(
        &self,
        free_segments: &FreeSegments,
        line: ([f64; 3], [f64; 3]),
        [from, to]: [f64; 2],
        enough: f64,
    ) -> Option<f64> {
        let last = [self.size[0].checked_sub(1)?, self.size[1].checked_sub(1)?, self.layers - 1];
        let mut unseen = 0.0;
        let mut at = from;
        while at < to && unseen < enough {
            let places = self.places(line, at);
            let [column, row, layer] = std::array::from_fn(|axis| to_index(places[axis]).min(last[axis]));
            let (tile, within) = self.tile_around(free_segments, [column, row])?;
            let (boxes, is_near) = match tile.widest(within, layer) {
                Some((width, word)) => (boxes_around([column, row, layer], width, word), true),
                None => {
                    let look = || free_segments.passes_within(self.middle([column, row, layer]), self.nearness);
                    let is_near = tile.is_middle_near(within[1] * TILE + within[0], layer, look);
                    ([[column, column + 1], [row, row + 1], [layer, layer + 1]], is_near)
                }
            };
            let mut edges = boxes.map(|ends| ends.map(|edge| edge as f64));
            for (axis, [first, end]) in boxes.into_iter().enumerate() {
                edges[axis][0] = if first == 0 { f64::NEG_INFINITY } else { edges[axis][0] };
                edges[axis][1] = if end > last[axis] { f64::INFINITY } else { edges[axis][1] };
            }
            let exit = self.exit(line, edges).max(at + 1e-6).min(to);
            // so far away that a step is lost in rounding
            if exit <= at {
                break;
            }
            unseen += if is_near { 0.0 } else { exit - at };
            at = exit;
        }
        Some(unseen)
    }

    /// Returns the position of a line at `at`, in boxes from the lowest corner. It is advanced slightly, so that a line
    /// at the edge of a box counts in the one it enters.
    fn places(&self, (origin, direction): ([f64; 3], [f64; 3]), at: f64) -> [f64; 3] {
        let within = at + 1e-9;
        let sides = self.sides();
        std::array::from_fn(|axis| (origin[axis] + within * direction[axis] - self.low[axis]) / sides[axis])
    }

    fn sides(&self) -> [f64; 3] {
        [self.side, self.side, self.height]
    }

    fn middle(&self, cell: [usize; 3]) -> [f64; 3] {
        let sides = self.sides();
        std::array::from_fn(|axis| self.low[axis] + (cell[axis] as f64 + 0.5) * sides[axis])
    }

    /// The tile of a column, made if no line has run through it yet, and where in it the column is.
    fn tile_around(&self, free_segments: &FreeSegments, cell: [usize; 2]) -> Option<(&BoxColumns, [usize; 2])> {
        let [column, row] = cell;
        let tile = self.tiles.get(row / TILE * self.width + column / TILE)?;
        let first = cell.map(|index| index / TILE * TILE);
        Some((tile.get_or_init(|| self.tile(free_segments, first)), cell.map(|index| index % TILE)))
    }

    /// Returns the distance at which a line leaves boxes, given from one edge to another along each axis.
    fn exit(&self, (origin, direction): ([f64; 3], [f64; 3]), edges: [[f64; 2]; 3]) -> f64 {
        let sides = self.sides();
        let mut exit = f64::INFINITY;
        for axis in 0..3 {
            if direction[axis] != 0.0 {
                let edge = edges[axis][usize::from(direction[axis] > 0.0)];
                exit = exit.min((self.low[axis] + edge * sides[axis] - origin[axis]) / direction[axis]);
            }
        }
        exit
    }
}

/// Returns the edges of the group of columns around a box, `width` columns a side, and of the layers above and below
/// that are near as well. `word` is the bit mask of the group.
fn boxes_around([column, row, layer]: [usize; 3], width: usize, word: u64) -> [[usize; 2]; 3] {
    let up = (word >> layer).trailing_ones() as usize;
    let down = (word << (63 - layer)).leading_ones() as usize;
    let [column, row] = [column, row].map(|index| index / width * width);
    [[column, column + width], [row, row + width], [layer + 1 - down, layer + up]]
}

/// Returns the distance from the middle of a square to its corners.
fn half_diagonal(side: f64) -> f64 {
    side * std::f64::consts::FRAC_1_SQRT_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pulses::FreeSegmentParams;
    use belvedere_data::control::Control;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::box_around;
    use belvedere_data::vector::{dot, length, sub, to_f32};

    #[test]
    fn boxes_are_marked_where_one_segment_is_near_to_all_corners() {
        // from an aircraft, leaning to all sides, and from the ground, where fewer boxes that are near are found to be
        assert_boxes([[-130.0, -80.0, 300.0], [170.0, 120.0, 300.0]], 0.75);
        assert_boxes([[12.0, 18.0, 1.6], [12.5, 18.0, 1.6]], 0.5);
    }

    #[test]
    fn a_segment_that_hardly_leans_marks_what_an_upright_one_does() {
        let returns = [[-3.0, -3.0, 0.0], [3.0, 3.0, 9.0]];
        let scanner = [[0.0, 0.0, 300.0]; 2];
        let (free_segments, _) =
            FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
        let space = SeenSpace::new(&free_segments, [[-3.0; 2], [3.0; 2]], 1.1);
        let marked = |lean: f64| {
            let mut boxes = [0; TILE * TILE];
            space.mark([[0.0, 0.0, 0.5], [lean, -lean, 300.0]], [[-9.0; 2], [9.0; 2]], [0, 0], &mut boxes);
            boxes
        };
        let upright = marked(0.0);
        assert!(upright.contains(&0) && upright.iter().any(|word| *word != 0));
        // squares of the smallest are zero, and places where the others come into reach are beyond all whole numbers
        for lean in [1e-300, 1e-100, 1e-30, 1e-20, 1e-12] {
            assert_eq!([lean, -lean].map(marked), [upright; 2], "{lean}");
        }
    }

    /// Asserts that only boxes near pulses are marked, and at least a share of those, for scanners between two places.
    fn assert_boxes(scanners: [[f32; 3]; 2], min_share: f64) {
        let random = |i: u64, k: u64| to_f32(uniform(6, 8 * i + k));
        let count = 3000;
        let returns: Vec<[f32; 3]> =
            (0..count).map(|i| [40.0 * random(i, 0) - 3.0, 40.0 * random(i, 1), 9.0 * random(i, 2).powi(3)]).collect();
        let scanner: Vec<[f32; 3]> = (0..count)
            .map(|i| {
                std::array::from_fn(|k| scanners[0][k] + random(i, 3 + k as u64) * (scanners[1][k] - scanners[0][k]))
            })
            .collect();
        let (free_segments, _) =
            FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
        let extent = box_around(free_segments.lower_ends().map(|[x, y, _]| [x, y].map(f64::from)));
        let space = SeenSpace::new(&free_segments, extent, 1.1);
        let ends: Vec<[[f64; 3]; 2]> = (0..free_segments.len())
            .filter_map(|number| {
                let (start, up, length) = free_segments.segment(number)?;
                let (start, up) = (start.map(f64::from), up.map(f64::from));
                Some([start, std::array::from_fn(|i| start[i] + f64::from(length) * up[i])])
            })
            .collect();
        // from a place to the piece of a line
        let distance = |place: [f64; 3], [start, end]: &[[f64; 3]; 2]| {
            let (way, from) = (sub(*end, *start), sub(place, *start));
            let share = (dot(way, from) / dot(way, way)).clamp(0.0, 1.0);
            length(std::array::from_fn(|i| from[i] - share * way[i]))
        };
        // by how much one pulse is near to all corners; negative where none is
        let spare = |cell: [usize; 3]| {
            let corner = |number: usize| -> [f64; 3] {
                let sides = [space.side, space.side, space.height];
                std::array::from_fn(|i| space.low[i] + (cell[i] + (number >> i & 1)) as f64 * sides[i])
            };
            let farthest =
                |free_segment| (0..8).map(|number| distance(corner(number), free_segment)).fold(0.0, f64::max);
            1.1 - ends.iter().map(farthest).fold(f64::INFINITY, f64::min)
        };
        let (mut marked_count, mut near_count) = (0, 0);
        let mut queried = 0;
        for row in (0..space.size[1]).step_by(3) {
            for column in (0..space.size[0]).step_by(3) {
                let tile = space.tiles[row / TILE * space.width + column / TILE]
                    .get_or_init(|| space.tile(&free_segments, [column, row].map(|index| index / TILE * TILE)));
                let word = tile.columns[row % TILE * TILE + column % TILE];
                for layer in 0..space.layers {
                    let marked = word >> layer & 1 == 1;
                    let spare = spare([column, row, layer]);
                    assert!(!marked || spare > 0.0, "column {column}, row {row}, layer {layer}: {spare}");
                    marked_count += usize::from(marked);
                    // marked boxes must be a little nearer than this
                    near_count += usize::from(spare > 0.0);
                    queried += 1;
                }
            }
        }
        assert!(near_count > queried / 10 && near_count < queried * 9 / 10, "{near_count} of {queried}");
        assert!(marked_count as f64 > min_share * near_count as f64, "{marked_count} of {near_count}");
    }

    #[test]
    fn unseen_length_is_that_through_boxes_whose_middles_are_not_near() {
        const STEP: f64 = 4e-3;
        let point = |i: u64| [20.0 * uniform(41, i), 20.0 * uniform(42, i), 8.0 * uniform(43, i)];
        let returns: Vec<[f32; 3]> = (0..400).map(|i| point(i).map(to_f32)).collect();
        let scanner = vec![[10.0, 10.0, 300.0]; returns.len()];
        let params = FreeSegmentParams::default();
        let (segments, _) = FreeSegments::new(&returns, &scanner, &params, &Control::none()).unwrap();
        let space = SeenSpace::new(&segments, [[0.0; 2], [20.0; 2]], 0.7);
        let mut unseen_lines = 0;
        for i in 0..60 {
            let (from, to) = (point(1000 + i), point(2000 + i));
            let range = length(sub(to, from));
            let direction = sub(to, from).map(|v| v / range);
            let mut expected = 0.0;
            let mut at = STEP / 2.0;
            while at < range {
                let places = space.places((from, direction), at);
                let cell: [usize; 3] = std::array::from_fn(|axis| to_index(places[axis]));
                expected += if segments.passes_within(space.middle(cell), space.nearness) { 0.0 } else { STEP };
                at += STEP;
            }
            let found = space.unseen_length(&segments, (from, direction), [0.0, range], f64::INFINITY).unwrap();
            assert!((found - expected).abs() < 0.1, "line {i}: {found}, in steps {expected}");
            unseen_lines += usize::from(found > 1.0);
        }
        assert!(unseen_lines > 20, "{unseen_lines} lines run through unseen boxes");
    }
}
