//! Which of many directions each of many targets sees free: what sun hours, sky views and irradiance are sums over.

use super::MedialScene;
use crate::progress::Progress;
use crate::vector::length;
use crate::{Error, Result};
use rayon::prelude::*;

/// Bits in a word.
const WORD: usize = 64;

/// One bit for each target and direction: set where no ball blocks the line of sight that leaves the target in the direction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VisibilityMatrix {
    target_count: usize,
    direction_count: usize,
    /// Words of a row.
    width: usize,
    words: Vec<u64>,
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
        Ok(Self { target_count, direction_count, width, words })
    }

    /// Number of rows.
    #[must_use]
    pub fn target_count(&self) -> usize {
        self.target_count
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
        let first = target.saturating_mul(self.width);
        self.words.get(first..first + self.width).unwrap_or_default()
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

/// Which of `directions`, (D, 3) unit vectors, each of `targets`, (M, 3) local metres, sees free of balls: for every pair the same as
/// [`MedialScene::answer`] at infinite range, pulses not being asked. A target that is not finite sees nothing. Progress counts targets.
///
/// # Errors
/// [`Error::InvalidParameter`] for a direction that is not of unit length (to a millionth).
pub fn visibility_matrix(
    scene: &MedialScene,
    targets: &[[f32; 3]],
    directions: &[[f64; 3]],
    progress: Progress<'_>,
) -> Result<VisibilityMatrix> {
    if let Some(bad) = directions.iter().find(|direction| !((length(**direction) - 1.0).abs() < 1e-6)) {
        return Err(Error::InvalidParameter {
            name: "direction",
            value: format!("{bad:?}"),
            expected: "a vector of length 1",
        });
    }
    let width = directions.len().div_ceil(WORD);
    let mut words = vec![0; width * targets.len()];
    if width > 0 {
        words.par_chunks_mut(width).zip(targets).with_min_len(64).for_each(|(row, target)| {
            let target = target.map(f64::from);
            if target.iter().all(|v| v.is_finite()) {
                for (column, &direction) in directions.iter().enumerate() {
                    let is_free = !scene.blocked(target, direction, f64::INFINITY);
                    row[column / WORD] |= u64::from(is_free) << (column % WORD);
                }
            }
            progress.advance(1);
        });
    }
    Ok(VisibilityMatrix { target_count: targets.len(), direction_count: directions.len(), width, words })
}
