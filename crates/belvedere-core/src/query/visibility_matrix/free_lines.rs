//! Lines of sight from which obstacles are taken away, all at once or part by part.

use super::super::backend::{BLOCK, WORD};
use super::super::far_terrain::hide_behind_terrain;
use super::super::target_tree::TargetTree;
use super::super::{AddedMeshes, FarTerrain, MedialScene};
use super::VisibilityMatrix;
use super::behind_added::hide_behind_added;
use super::looking::{Sky, headings};
use belvedere_data::control::Control;
use belvedere_data::vector::length;
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Directions that are settled before targets are looked at: two bits of each are kept for every target meanwhile.
const BATCH: usize = 512;
/// Targets that are looked at before the next: as many as keep what is settled of them below 100 MB.
const MOST_TARGETS: usize = BLOCK << 10;

/// Which of many directions each of many targets sees, as far as obstacles were asked.
///
/// A line of sight is free where no obstacle blocks it, so that neither their order nor how they are cut into parts matters: with the balls of a
/// scene one part after the other, the bits at the end are those of [`MedialScene::visibility_matrix`]. A part is asked only about lines that
/// are still free.
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
    /// All lines of sight of `targets`, (M, 3) local metres, in `directions`, (D, 3) unit vectors, as if nothing stood anywhere. A target that is
    /// not finite sees nothing.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a direction that is not of unit length (to a millionth).
    pub fn new(targets: &[[f32; 3]], directions: &'a [[f64; 3]]) -> Result<Self> {
        if let Some(bad) = directions.iter().find(|direction| !((length(**direction) - 1.0).abs() < 1e-6)) {
            return Err(Error::InvalidParameter {
                name: "direction",
                value: format!("{bad:?}"),
                expected: "a vector of length 1",
            });
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

    /// Takes away what the balls of `scene` block of the directions in `columns`, each given once. Progress counts targets.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a column beyond the last, what the backend of the scene reports, and [`Error::Cancelled`].
    pub fn hide_behind_balls(&mut self, scene: &MedialScene, columns: &[usize], control: &Control<'_>) -> Result<()> {
        if let Some(bad) = columns.iter().find(|&&column| column >= self.directions.len()) {
            let value = bad.to_string();
            return Err(Error::InvalidParameter {
                name: "column",
                value,
                expected: "less than the number of directions",
            });
        }
        if scene.ball_count() == 0 || columns.is_empty() {
            return Ok(());
        }
        let headings = headings(self.directions, columns);
        // batches of the same size, so that none is too small to be worth a sweep
        let batch = headings.len().div_ceil(headings.len().div_ceil(BATCH));
        // a target counts as done when as many lines of sight are
        let asked = AtomicUsize::new(0);
        let advance = |lines: usize| {
            let before = asked.fetch_add(lines, Ordering::Relaxed);
            control.advance((before + lines) / columns.len() - before / columns.len());
        };
        let (width, positions) = (self.width, self.tree.positions());
        for (words, targets) in self.words.chunks_mut(width * MOST_TARGETS).zip(positions.chunks(MOST_TARGETS)) {
            for headings in headings.chunks(batch) {
                let of_batch: Vec<[f64; 3]> = headings.iter().map(|heading| heading.direction).collect();
                let settled = scene.prepared()?.settle(targets, &of_batch, control)?;
                let sky = Sky::new(scene.tree(), headings, &settled, self.directions.len());
                let blocks = words.par_chunks_mut(width * BLOCK).zip(targets.par_chunks(BLOCK));
                blocks.enumerate().try_for_each(|(block, (rows, targets))| {
                    control.check()?;
                    sky.look(targets, block, rows, width);
                    advance(targets.len() * headings.len());
                    Ok(())
                })?;
            }
        }
        Ok(())
    }

    /// Takes away what meshes block.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn hide_behind_meshes(&mut self, added: &AddedMeshes, control: &Control<'_>) -> Result<()> {
        if self.width == 0 {
            return Ok(());
        }
        hide_behind_added(added, self.tree.positions(), self.directions, &mut self.words, control)
    }

    /// Takes away what far terrain blocks.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn hide_behind_terrain(&mut self, far: &FarTerrain, control: &Control<'_>) -> Result<()> {
        if far.is_empty() {
            return Ok(());
        }
        hide_behind_terrain(far, self.tree.positions(), self.directions, &mut self.words, control)
    }

    /// Takes away what is not free in `other`, which is a clone of this from which other obstacles were taken.
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

    /// What is still free.
    #[must_use]
    pub fn into_matrix(self) -> VisibilityMatrix {
        #[expect(clippy::cast_possible_truncation, reason = "targets are numbered with 32 bits")]
        let mut places = vec![self.tree.positions().len() as u32; self.tree.len()];
        for (place, &row) in (0..).zip(self.tree.rows()) {
            places[row as usize] = place;
        }
        VisibilityMatrix { places, direction_count: self.directions.len(), width: self.width, words: self.words }
    }
}
