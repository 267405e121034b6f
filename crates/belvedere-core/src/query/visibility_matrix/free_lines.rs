//! Lines of sight from which obstacles are taken away, all at once or part by part.

use super::super::backend::{BLOCK, Settled, WORD};
use super::super::far_terrain::hide_behind_terrain;
use super::super::target_tree::TargetTree;
use super::super::{BlockingTriangles, FarTerrain, MedialScene};
use super::VisibilityMatrix;
use super::behind_triangles::hide_behind_triangles;
use super::looking::{Sky, headings};
use belvedere_data::cast::to_row;
use belvedere_data::control::Control;
use belvedere_data::vector::{length, piece_in_box};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Directions that are settled before targets are looked at: two bits of each are kept for every target meanwhile.
const BATCH: usize = 512;
/// Number of targets tested before the next: as many as keep their settled lines below 100 MB.
const MAX_TARGETS: usize = BLOCK << 10;

/// Share of lines of sight near balls below which each such line is tested separately. Settling a line takes about a
/// tenth of the time of testing one: 6 and 53 ns on two cores, before lines were tested in packets, for a strip of
/// balls beside a tile of a village.
const WORTH_SETTLING: f64 = 0.1;

/// Widening of the box around balls, metres: far more than the rounding.
const ROOM: f64 = 0.01;

/// Lines of sight that are still free and run near balls.
struct Meeting {
    /// Upper bound of their number.
    line_count: usize,
    /// Columns of any of them.
    columns: Vec<usize>,
    /// Blocks of targets with any of them.
    blocks: Vec<OpenBlock>,
}

/// A block of targets by its number, with the columns of its lines that run near balls as words of a row.
struct OpenBlock {
    block: usize,
    met: Vec<u64>,
}

/// Bit matrix of lines of sight, of many targets in many directions, that are free of the obstacles tested so far.
///
/// A line of sight is free if no obstacle blocks it, so that neither their order nor their division into parts matters.
/// With the balls of a scene in parts, the final bits are those of [`MedialScene::visibility_matrix`]. A part is tested
/// only for lines that are still free.
#[derive(Clone)]
pub struct FreeLines<'a> {
    tree: Arc<TargetTree>,
    directions: &'a [[f64; 3]],
    /// Words of a row.
    width: usize,
    /// Rows of the targets in the order of the tree, and one that is empty.
    words: Vec<u64>,
}

impl<'a> FreeLines<'a> {
    /// All lines of sight of `targets`, (M, 3) local metres, in `directions`, (D, 3) unit vectors, as if nothing stood
    /// anywhere. A target that is not finite sees nothing.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a direction that is not of unit length (to a millionth).
    pub fn new(targets: &[[f32; 3]], directions: &'a [[f64; 3]]) -> Result<Self> {
        if let Some(bad) = directions.iter().find(|direction| !((length(**direction) - 1.0).abs() < 1e-6)) {
            return Err(Error::invalid(Parameter::Direction, format!("{bad:?}"), "a vector of length 1"));
        }
        let tree = Arc::new(TargetTree::new(targets));
        let row: Vec<u64> = directions.chunks(WORD).map(|part| u64::MAX >> (WORD - part.len())).collect();
        let mut words = row.repeat(tree.positions().len());
        words.resize(words.len() + row.len(), 0);
        Ok(Self { tree, directions, width: row.len(), words })
    }

    /// The directions that any target still sees, by their columns.
    #[must_use]
    pub fn free_columns(&self) -> Vec<usize> {
        let mut any = vec![0; self.width];
        for row in self.words.chunks_exact(self.width.max(1)) {
            any.iter_mut().zip(row).for_each(|(any, word)| *any |= word);
        }
        let is_free = |column: &usize| any.get(column / WORD).is_some_and(|word| word >> (column % WORD) & 1 == 1);
        (0..self.directions.len()).filter(is_free).collect()
    }

    /// Returns the number of targets.
    #[must_use]
    pub fn target_count(&self) -> usize {
        self.tree.positions().len()
    }

    /// Calls `visit` with the rectangles in which lines of sight that are still free start. It gets the index of their
    /// column among `columns`, which ascend; the lowest and the highest corner, and the minimum height of the targets
    /// there, local metres. `together` neighbours, at least one, share a rectangle.
    pub fn each_start(&self, columns: &[usize], together: usize, mut visit: impl FnMut(usize, [[f32; 2]; 2], f32)) {
        // the words with any of the columns, these, and how many come before
        let mut queried: Vec<(usize, u64, usize)> = Vec::new();
        let mut before = 0;
        for (word, bits) in self.words_of(columns).into_iter().enumerate().filter(|(_, bits)| *bits != 0) {
            queried.push((word, bits, before));
            before += bits.count_ones() as usize;
        }
        if queried.is_empty() {
            return;
        }
        let together = together.max(1);
        let rows = self.words.chunks(self.width * together);
        for (rows, targets) in rows.zip(self.tree.positions().chunks(together)) {
            let mut place = None;
            for &(word, columns, before) in &queried {
                let of_rows = rows.chunks(self.width).fold(0, |bits, row| bits | row[word]);
                let mut free = of_rows & columns;
                while free != 0 {
                    let lowest = free & free.wrapping_neg();
                    free ^= lowest;
                    let number = before + (columns & (lowest - 1)).count_ones() as usize;
                    let [low, high] = *place.get_or_insert_with(|| corners(targets));
                    visit(number, [[low[0], low[1]], [high[0], high[1]]], low[2]);
                }
            }
        }
    }

    /// Clears the bits of lines that the balls of `scene` block, of the directions in `columns`, each given once.
    /// Progress counts targets.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a column beyond the last, errors of the backend of the scene, and
    /// [`Error::Cancelled`].
    pub fn hide_behind_balls(&mut self, scene: &MedialScene, columns: &[usize], control: &Control<'_>) -> Result<()> {
        if let Some(bad) = columns.iter().find(|&&column| column >= self.directions.len()) {
            let value = format!("of column {bad}");
            return Err(Error::invalid(Parameter::Direction, value, "of a column that there is"));
        }
        if scene.ball_count() == 0 || columns.is_empty() {
            return Ok(());
        }
        // a target counts as done when as many lines of sight are
        // lines pass 32 bits
        let queried = AtomicU64::new(0);
        let advance = |targets: usize, directions: usize| {
            let lines = targets as u64 * directions as u64;
            let before = queried.fetch_add(lines, Ordering::Relaxed);
            let done = (before + lines) / columns.len() as u64 - before / columns.len() as u64;
            control.advance(usize::try_from(done).unwrap_or(usize::MAX));
        };
        let meeting = self.meeting(scene, columns);
        let headings = headings(self.directions, &meeting.columns);
        // batches of the same size, so that none is too small to be worth a sweep
        let batch = headings.len().div_ceil(headings.len().div_ceil(BATCH).max(1)).max(1);
        let (width, positions) = (self.width, self.tree.positions());
        let of_block = |block: usize| positions.chunks(BLOCK).nth(block).unwrap_or_default();
        let open_count: usize = meeting.blocks.iter().map(|open| of_block(open.block).len()).sum();
        let is_worth_settling = meeting.line_count as f64 > WORTH_SETTLING * open_count as f64 * headings.len() as f64;
        // these are settled: all lines of targets in blocks that are not open, and of directions that meet nothing
        advance(positions.len() - open_count, columns.len());
        advance(open_count, columns.len() - headings.len());
        for open in meeting.blocks.chunks(MAX_TARGETS / BLOCK) {
            let targets = open.iter().map(|open| of_block(open.block)).collect::<Vec<_>>().concat();
            let mut numbers = vec![None; positions.len().div_ceil(BLOCK)];
            open.iter().enumerate().for_each(|(number, open)| numbers[open.block] = Some((number, &open.met)));
            for headings in headings.chunks(batch) {
                let of_batch: Vec<[f64; 3]> = headings.iter().map(|heading| heading.direction).collect();
                let settled = if is_worth_settling {
                    scene.prepared()?.settle(&targets, &of_batch, control)?
                } else {
                    Settled::new(targets.len(), of_batch.len())
                };
                let sky = Sky::new(scene.tree(), headings, &settled, self.directions.len());
                let blocks = self.words.par_chunks_mut(width * BLOCK).zip(positions.par_chunks(BLOCK)).zip(&numbers);
                blocks.try_for_each(|((rows, targets), number)| {
                    let Some((number, met)) = *number else { return Ok(()) };
                    control.check()?;
                    sky.look(targets, number, met, rows);
                    advance(targets.len(), headings.len());
                    Ok(())
                })?;
            }
        }
        Ok(())
    }

    /// Finds the lines in the directions of `columns` that are still free and run through the box around the balls of
    /// `scene`.
    fn meeting(&self, scene: &MedialScene, columns: &[usize]) -> Meeting {
        let index = scene.tree().index();
        let queried = self.words_of(columns);
        let of_block = |(block, (rows, targets)): (usize, (&[u64], &[[f32; 3]]))| {
            let bound = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
                targets.iter().map(|target| f64::from(target[axis])).fold(start, pick)
            };
            // the box as seen from the targets
            let sides: [[f64; 2]; 3] = std::array::from_fn(|axis| {
                let (middle, half) = (index.center()[axis], index.half_size()[axis] + ROOM);
                [
                    middle - half - bound(axis, f64::max, f64::NEG_INFINITY),
                    middle + half - bound(axis, f64::min, f64::INFINITY),
                ]
            });
            let mut met = queried.clone();
            for (word, met) in met.iter_mut().enumerate() {
                *met &= rows.chunks(self.width).fold(0, |bits, row| bits | row[word]);
            }
            for &column in columns {
                if piece_in_box(sides, self.directions[column], [0.0, f64::INFINITY]).is_none() {
                    met[column / WORD] &= !(1 << (column % WORD));
                }
            }
            let of_row =
                |row: &[u64]| row.iter().zip(&met).map(|(row, met)| (row & met).count_ones() as usize).sum::<usize>();
            (rows.chunks(self.width).map(of_row).sum(), OpenBlock { block, met })
        };
        let blocks = self.words.par_chunks(self.width * BLOCK).zip(self.tree.positions().par_chunks(BLOCK));
        let mut found: Vec<(usize, OpenBlock)> = blocks.enumerate().map(of_block).collect();
        found.retain(|(line_count, _)| *line_count > 0);
        let is_met = |open: &OpenBlock, column: usize| open.met[column / WORD] >> (column % WORD) & 1 == 1;
        let of_any = |column: &&usize| found.iter().any(|(_, open)| is_met(open, **column));
        Meeting {
            line_count: found.iter().map(|(line_count, _)| line_count).sum(),
            columns: columns.iter().filter(of_any).copied().collect(),
            blocks: found.into_iter().map(|(_, open)| open).collect(),
        }
    }

    /// The words of a row that sees `columns` only, without those beyond the last.
    fn words_of(&self, columns: &[usize]) -> Vec<u64> {
        let mut words = vec![0; self.width];
        for column in columns {
            words.get_mut(column / WORD).into_iter().for_each(|word| *word |= 1 << (column % WORD));
        }
        words
    }

    /// Clears the bits of lines that triangles block.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn hide_behind_triangles(&mut self, triangles: &BlockingTriangles, control: &Control<'_>) -> Result<()> {
        if self.width == 0 {
            return Ok(());
        }
        hide_behind_triangles(triangles, self.tree.positions(), self.directions, &mut self.words, control)
    }

    /// Clears the bits of lines that far terrain blocks.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn hide_behind_terrain(&mut self, far: &FarTerrain, control: &Control<'_>) -> Result<()> {
        if far.is_empty() {
            return Ok(());
        }
        hide_behind_terrain(far, self.tree.positions(), self.directions, &mut self.words, control)
    }

    /// Clears the bits that are not set in `other`, a clone of this with other obstacles applied.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for another number of targets or directions.
    pub fn hide_what_is_hidden_in(&mut self, other: &Self) -> Result<()> {
        let (expected, found) = (self.words.len(), other.words.len());
        if expected != found || self.width != other.width {
            return Err(Error::LengthMismatch { what: "words of the lines of sight", expected, found });
        }
        self.words.iter_mut().zip(&other.words).for_each(|(word, other)| *word &= other);
        Ok(())
    }

    /// Converts the lines that are still free into a matrix.
    #[must_use]
    pub fn into_matrix(self) -> VisibilityMatrix {
        let mut places = vec![to_row(self.tree.positions().len()); self.tree.len()];
        for (place, &row) in (0..).zip(self.tree.rows()) {
            places[row as usize] = place;
        }
        VisibilityMatrix { places, direction_count: self.directions.len(), width: self.width, words: self.words }
    }
}

/// Lowest and highest corner of the box around targets.
fn corners(targets: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let bound = |pick: fn(f32, f32) -> f32, start: f32| -> [f32; 3] {
        std::array::from_fn(|axis| targets.iter().map(|target| target[axis]).fold(start, pick))
    };
    [bound(f32::min, f32::INFINITY), bound(f32::max, f32::NEG_INFINITY)]
}
