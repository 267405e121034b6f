//! Matrix of the directions that each of many targets sees free: the terms of the sums of sun hours, sky views and
//! irradiance.

mod behind_triangles;
mod free_lines;
mod looking;
mod packet;

pub use free_lines::FreeLines;

use super::MedialScene;
use super::backend::WORD;
use belvedere_data::control::Control;
use belvedere_data::{Error, Result};

/// One bit for each target and direction: set where no ball blocks the line of sight that leaves the target in the
/// direction.
#[derive(Clone, Debug)]
pub struct VisibilityMatrix {
    /// Row of each target; neighbours are together, and all targets that are not finite share one empty row.
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

    /// Returns true if a target sees the sky in a direction; false beyond the rows and columns.
    #[must_use]
    pub fn is_free(&self, target: usize, direction: usize) -> bool {
        let word = self.row(target).get(direction / WORD).copied().unwrap_or(0);
        direction < self.direction_count && word >> (direction % WORD) & 1 == 1
    }

    /// The bits of a target, 64 directions a word from the lowest bit on, those beyond the last unset; empty beyond the
    /// last target.
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

impl MedialScene {
    /// Computes which of `directions`, (D, 3) unit vectors, each of `targets`, (M, 3) local metres, sees free of balls
    /// and triangles. Each pair equals [`MedialScene::answer`] at infinite range, without a test of pulses. A target
    /// that is not finite sees nothing. Progress counts targets.
    ///
    /// The backend settles most lines of sight ([`super::backend::PreparedBackend::settle`]). The others are tested
    /// against the ball that blocked the neighbours, and finally against all balls. The data that the backend prepares
    /// stay with the scene, so that targets may be queried in blocks.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a direction that is not of unit length (to a millionth), and
    /// [`Error::Cancelled`].
    pub fn visibility_matrix(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> Result<VisibilityMatrix> {
        let mut free = FreeLines::new(targets, directions)?;
        let columns: Vec<usize> = (0..directions.len()).collect();
        // the triangles first: they leave fewer lines to the balls
        if let Some(triangles) = self.triangles() {
            free.hide_behind_triangles(triangles, control)?;
        }
        free.hide_behind_balls(self, &columns, control)?;
        free.hide_behind_terrain(&self.far_terrain, control)?;
        Ok(free.into_matrix())
    }
}
