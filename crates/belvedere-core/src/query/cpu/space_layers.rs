//! Space in layers of cells, a bit each: cells that some ball reaches, and cells that one ball fills.

use crate::blocking::{Ball, BlockRule};
use crate::query::backend::WORD;
use belvedere_data::Result;
use belvedere_data::cast::{to_index, to_row};
use belvedere_data::control::Control;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Side of a cell, metres: finer ones leave less open but take longer to sweep.
const CELL: f64 = 0.5;
/// Maximum number of cells: four bits each while they are made.
const MAX_CELLS: f64 = (1_u64 << 30) as f64;
/// Margin by which balls are too large where they reach cells and too small where they fill them, metres: far more than
/// f64 errs.
const MARGIN: f64 = 1e-3;
/// Balls handed to a thread at once.
const CHUNK: usize = 4096;

/// Cells of space in level layers from the lowest up, rows from the south, cells from the west, 64 a word.
pub(super) struct SpaceLayers {
    /// Lowest corner, local metres.
    pub(super) low: [f64; 3],
    /// Side of a cell, metres.
    pub(super) cell: f64,
    /// Cells along each axis, margins among them: the lowest along x and y are empty.
    pub(super) size: [usize; 3],
    /// Words of a row.
    pub(super) width: usize,
    /// Bit i, j: whether any ball reaches one of the cells i, i + 1, j, j + 1.
    pub(super) reached: CellBits,
    /// Bit i, j: whether each of the cells i, i + 1, j, j + 1 is filled by one ball, however it gives way.
    pub(super) filled: CellBits,
}

/// Bits of cells, row after row of all layers. Most rows above the ground are empty but for a few buildings.
#[derive(Default)]
pub(super) struct CellBits {
    bits: Vec<u64>,
    /// Words of a row.
    width: usize,
    /// For each row its first word with a bit that is set, and the word after the last.
    taken: Vec<[u32; 2]>,
}

impl CellBits {
    fn new(bits: Vec<u64>, width: usize) -> Self {
        let of_row = |row: &[u64]| {
            let first = row.iter().position(|word| *word != 0).unwrap_or(0);
            [first, row.iter().rposition(|word| *word != 0).map_or(first, |last| last + 1)].map(to_row)
        };
        let taken = bits.par_chunks(width).with_min_len(CHUNK).map(of_row).collect();
        Self { bits, width, taken }
    }

    /// The words of a row from the first to the last with a bit that is set, and the number of the first.
    #[inline]
    pub(super) fn row(&self, row: usize) -> (usize, &[u64]) {
        let [first, end] = self.taken.get(row).map_or([0; 2], |taken| taken.map(|word| word as usize));
        let start = row * self.width;
        (first, self.bits.get(start + first..start + end).unwrap_or_default())
    }
}

impl SpaceLayers {
    /// Layers over `balls`, which give way as `rule` says.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn new(balls: &[Ball], rule: &BlockRule, control: &Control<'_>) -> Result<Self> {
        let (low, high) = balls
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&Ball { center, radius }| {
                let reach = f64::from(radius) + MARGIN;
                (center.map(|c| f64::from(c) - reach), center.map(|c| f64::from(c) + reach))
            })
            .reduce(
                || ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]),
                |a, b| (std::array::from_fn(|i| a.0[i].min(b.0[i])), std::array::from_fn(|i| a.1[i].max(b.1[i]))),
            );
        let count = |cell: f64, axis: usize| ((high[axis] - low[axis]).max(0.0) / cell).floor() + 1.0;
        let mut cell = CELL;
        while (count(cell, 0) + 64.0) * (count(cell, 1) + 1.0) * count(cell, 2) > MAX_CELLS {
            cell *= 1.25;
        }
        let mut size: [usize; 3] = std::array::from_fn(|axis| to_index(count(cell, axis)));
        size[0] += 1;
        size[1] += 1;
        let width = size[0].div_ceil(WORD);
        let bits = || -> Vec<AtomicU64> { (0..width * size[1] * size[2]).map(|_| AtomicU64::new(0)).collect() };
        let (reached, filled) = (bits(), bits());
        let low = [low[0] - cell, low[1] - cell, low[2]];
        let mut layers = Self { low, cell, size, width, reached: CellBits::default(), filled: CellBits::default() };
        // bits are only ever set, so that their order does not matter
        balls.par_iter().with_min_len(CHUNK).try_for_each(|&Ball { center, radius }| {
            let radius = f64::from(radius);
            let radii = [radius + MARGIN, rule.min_radius(radius) - MARGIN];
            layers.mark([&reached, &filled], center.map(f64::from), radii);
            control.check()
        })?;
        let plain = |bits: Vec<AtomicU64>| -> Vec<u64> { bits.into_iter().map(AtomicU64::into_inner).collect() };
        layers.reached = CellBits::new(layers.joined(&plain(reached), |a, b| a | b), width);
        layers.filled = CellBits::new(layers.joined(&plain(filled), |a, b| a & b), width);
        Ok(layers)
    }

    /// Words that a direction is swept through.
    pub(super) fn word_count(&self) -> usize {
        self.reached.bits.len()
    }

    /// Marks the cells that a ball with the first of two radii reaches, and those that one with the second fills.
    fn mark(&self, [reached, filled]: [&[AtomicU64]; 2], center: [f64; 3], [reach, fill]: [f64; 2]) {
        // in cells from the corner
        let at: [f64; 3] = std::array::from_fn(|i| (center[i] - self.low[i]) / self.cell);
        let (reach, fill) = (reach / self.cell, fill.max(0.0) / self.cell);
        let cells =
            |axis: usize, from: f64, to: f64| -> [usize; 2] { [to_index(from), to_index(to).min(self.size[axis] - 1)] };
        let near = |axis: usize, k: usize| (k as f64 - at[axis]).max(at[axis] - (k + 1) as f64).max(0.0);
        let far = |axis: usize, k: usize| (at[axis] - k as f64).abs().max((at[axis] - (k + 1) as f64).abs());
        let [z0, z1] = cells(2, at[2] - reach, at[2] + reach);
        let [y0, y1] = cells(1, at[1] - reach, at[1] + reach);
        for z in z0..=z1 {
            for y in y0..=y1 {
                let row = (z * self.size[1] + y) * self.width;
                let beside = near(2, z).powi(2) + near(1, y).powi(2);
                if beside >= reach * reach {
                    continue;
                }
                let half = (reach * reach - beside).sqrt();
                set(reached, row, cells(0, at[0] - half, at[0] + half));
                let beside = far(2, z).powi(2) + far(1, y).powi(2);
                if beside < fill * fill {
                    let half = (fill * fill - beside).sqrt();
                    // whole cells between
                    let (from, to) = ((at[0] - half).ceil(), (at[0] + half).floor());
                    if to > from {
                        set(filled, row, cells(0, from, to - 1.0));
                    }
                }
            }
        }
    }

    /// Each bit put together with those of the next cells along x and y.
    fn joined(&self, bits: &[u64], join: impl Fn(u64, u64) -> u64 + Sync) -> Vec<u64> {
        let mut out = vec![0; bits.len()];
        let width = self.width;
        let layer = width * self.size[1];
        out.par_chunks_mut(layer).zip(bits.par_chunks(layer)).for_each(|(out, bits)| {
            for (y, out) in out.chunks_mut(width).enumerate() {
                let along_x = |y: usize, x: usize| {
                    let row = bits.get(y * width..(y + 1) * width).unwrap_or_default();
                    let word = |x: usize| row.get(x).copied().unwrap_or(0);
                    join(word(x), word(x) >> 1 | word(x + 1) << (WORD - 1))
                };
                for (x, out) in out.iter_mut().enumerate() {
                    *out = join(along_x(y, x), along_x(y + 1, x));
                }
            }
        });
        out
    }
}

/// Sets the bits of the cells from `x0` to `x1` of a row that begins at the word `row`.
fn set(bits: &[AtomicU64], row: usize, [x0, x1]: [usize; 2]) {
    for word in x0 / WORD..=x1 / WORD {
        let first = x0.saturating_sub(word * WORD);
        let last = (x1 - word * WORD).min(WORD - 1);
        let mask = (u64::MAX >> (WORD - 1 - last)) & (u64::MAX << first);
        if let Some(bits) = bits.get(row + word)
            && bits.load(Ordering::Relaxed) & mask != mask
        {
            bits.fetch_or(mask, Ordering::Relaxed);
        }
    }
}
