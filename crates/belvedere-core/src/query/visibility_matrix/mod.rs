//! Which of many directions each of many targets sees free: what sun hours, sky views and irradiance are sums over.

mod behind_added;
mod looking;

use super::MedialScene;
use super::backend::{BLOCK, WORD};
use super::far_terrain::hide_behind_terrain;
use super::target_tree::TargetTree;
use behind_added::hide_behind_added;
use belvedere_data::control::Control;
use belvedere_data::vector::length;
use belvedere_data::{Error, Result};
use looking::{Sky, headings};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// One bit for each target and direction: set where no ball blocks the line of sight that leaves the target in the direction.
#[derive(Clone, Debug)]
pub struct VisibilityMatrix {
    /// Where the row of each target lies: neighbours together, and one empty row for all that are not finite.
    places: Vec<u32>,
    direction_count: usize,
    /// Words of a row.
    width: usize,
    words: Vec<u64>,
}

impl PartialEq for VisibilityMatrix {
    fn eq(&self, other: &Self) -> bool {
        (self.target_count(), self.direction_count) == (other.target_count(), other.direction_count)
            && (0..self.target_count()).all(|target| self.row(target) == other.row(target))
    }
}

impl VisibilityMatrix {
    /// The matrix of bits that were kept: `words` hold row after row, as [`VisibilityMatrix::row`] gives them.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] where the words are not those of so many targets and directions.
    pub fn from_words(target_count: usize, direction_count: usize, words: Vec<u64>) -> Result<Self> {
        let width = direction_count.div_ceil(WORD);
        let (expected, found) = (target_count.saturating_mul(width), words.len());
        if expected != found {
            return Err(Error::LengthMismatch { what: "words of the matrix", expected, found });
        }
        Ok(Self { places: (0..).take(target_count).collect(), direction_count, width, words })
    }

    /// Number of rows.
    #[must_use]
    pub fn target_count(&self) -> usize {
        self.places.len()
    }

    /// Number of columns.
    #[must_use]
    pub fn direction_count(&self) -> usize {
        self.direction_count
    }

    /// Whether a target sees the sky in a direction; never beyond the rows and columns.
    #[must_use]
    pub fn is_free(&self, target: usize, direction: usize) -> bool {
        let word = self.row(target).get(direction / WORD).copied().unwrap_or(0);
        direction < self.direction_count && word >> (direction % WORD) & 1 == 1
    }

    /// The bits of a target, 64 directions a word from the lowest bit on, those beyond the last unset; empty beyond the last target.
    #[must_use]
    pub fn row(&self, target: usize) -> &[u64] {
        let place = self.places.get(target).copied().unwrap_or(u32::MAX) as usize;
        self.words.get(place.saturating_mul(self.width)..).and_then(|words| words.get(..self.width)).unwrap_or_default()
    }

    /// Sum of `weights`, one for each direction, over the directions that a target sees free.
    #[must_use]
    pub fn sum(&self, target: usize, weights: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (&word, weights) in self.row(target).iter().zip(weights.chunks(WORD)) {
            let mut left = word;
            while left != 0 {
                sum += weights.get(left.trailing_zeros() as usize).copied().unwrap_or(0.0);
                left &= left - 1;
            }
        }
        sum
    }
}

/// Directions that are settled before targets are looked at: two bits of each are kept for every target meanwhile.
const BATCH: usize = 512;
/// Targets that are looked at before the next: as many as keep what is settled of them below 100 MB.
const MOST_TARGETS: usize = BLOCK << 10;

impl MedialScene {
    /// Which of `directions`, (D, 3) unit vectors, each of `targets`, (M, 3) local metres, sees free of balls and of what was added: for every pair the same as
    /// [`MedialScene::answer`] at infinite range, pulses not being asked. A target that is not finite sees nothing. Progress counts
    /// targets.
    ///
    /// The backend settles most lines of sight ([`super::backend::Prepared::settle`]). What it leaves open is asked of the ball that
    /// blocked its neighbours, and last of all balls. What the backend makes ready stays with the scene, so that targets may be
    /// asked in blocks.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a direction that is not of unit length (to a millionth), and [`Error::Cancelled`].
    pub fn visibility_matrix(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> Result<VisibilityMatrix> {
        if let Some(bad) = directions.iter().find(|direction| !((length(**direction) - 1.0).abs() < 1e-6)) {
            return Err(Error::InvalidParameter {
                name: "direction",
                value: format!("{bad:?}"),
                expected: "a vector of length 1",
            });
        }
        let width = directions.len().div_ceil(WORD);
        let tree = TargetTree::new(targets);
        let known_count = tree.positions().len();
        let mut words = vec![0; width * (known_count + 1)];
        #[expect(clippy::cast_possible_truncation, reason = "targets are numbered with 32 bits")]
        let mut places = vec![known_count as u32; targets.len()];
        for (place, &row) in (0..).zip(tree.rows()) {
            places[row as usize] = place;
        }
        if self.ball_count() == 0 {
            let whole = directions.chunks(WORD).map(|part| u64::MAX >> (WORD - part.len()));
            let row: Vec<u64> = whole.collect();
            words[..width * known_count].chunks_mut(width.max(1)).for_each(|words| words.copy_from_slice(&row));
        } else if width > 0 {
            let headings = headings(directions);
            // batches of the same size, so that none is too small to be worth a sweep
            let batch = directions.len().div_ceil(directions.len().div_ceil(BATCH));
            // a target counts as done when as many lines of sight are
            let asked = AtomicUsize::new(0);
            let advance = |lines: usize| {
                let before = asked.fetch_add(lines, Ordering::Relaxed);
                control.advance((before + lines) / directions.len() - before / directions.len());
            };
            for (words, targets) in words.chunks_mut(width * MOST_TARGETS).zip(tree.positions().chunks(MOST_TARGETS)) {
                for headings in headings.chunks(batch) {
                    let of_batch: Vec<[f64; 3]> = headings.iter().map(|heading| heading.direction).collect();
                    let settled = self.prepared()?.settle(targets, &of_batch, control)?;
                    let sky = Sky::new(self.tree(), headings, &settled, directions.len());
                    let blocks = words.par_chunks_mut(width * BLOCK).zip(targets.par_chunks(BLOCK));
                    blocks.enumerate().try_for_each(|(block, (rows, targets))| {
                        control.check()?;
                        sky.look(targets, block, rows, width);
                        advance(targets.len() * headings.len());
                        Ok(())
                    })?;
                }
            }
        }
        if let Some(added) = self.added().filter(|_| width > 0) {
            hide_behind_added(added, tree.positions(), directions, &mut words, control)?;
        }
        if !self.far_terrain.is_empty() {
            hide_behind_terrain(&self.far_terrain, tree.positions(), directions, &mut words, control)?;
        }
        Ok(VisibilityMatrix { places, direction_count: directions.len(), width, words })
    }
}
