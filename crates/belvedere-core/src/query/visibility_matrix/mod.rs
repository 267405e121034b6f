//! Which of many directions each of many targets sees free: what sun hours, sky views and irradiance are sums over.

mod looking;
mod nearby;
mod space_layers;
mod sweep;

use super::{MedialScene, TargetTree};
use crate::blocking::Profile;
use belvedere_data::control::Control;
use belvedere_data::vector::length;
use belvedere_data::{Error, Result};
use looking::{CHUNK, Sky, headings};
use rayon::prelude::*;
use space_layers::SpaceLayers;
use std::sync::atomic::{AtomicUsize, Ordering};
use sweep::{Descending, sweep};

/// Bits in a word.
const WORD: usize = 64;

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

/// Directions from which on it pays to gather what is near a target, and to sweep them.
const WORTH_GATHERING: usize = 16;
/// Lines of sight for each ball from which on it pays to sweep.
const WORTH_SWEEPING: f64 = 4.0;
/// Directions swept before targets are looked at: two bits of each are kept for every target meanwhile.
const BATCH: usize = 512;

/// Which of `directions`, (D, 3) unit vectors, each of `targets`, (M, 3) local metres, sees free of balls: for every pair the same as
/// [`MedialScene::answer`] at infinite range, pulses not being asked. A target that is not finite sees nothing. Progress counts targets.
///
/// Where there are many, each direction is swept through cells of space first, 64 lines of sight at a time, which tells of most whether
/// they meet cells that no ball reaches only, or one that a ball fills. The balls near a target are gathered once for all
/// directions. What is then open is asked of the ball that blocked its neighbours, and last of all balls.
///
/// # Errors
/// [`Error::InvalidParameter`] for a direction that is not of unit length (to a millionth).
pub fn visibility_matrix(
    scene: &MedialScene,
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
    if scene.ball_count() == 0 {
        let whole = directions.chunks(WORD).map(|part| u64::MAX >> (WORD - part.len()));
        let row: Vec<u64> = whole.collect();
        words[..width * known_count].chunks_mut(width.max(1)).for_each(|words| words.copy_from_slice(&row));
        return Ok(VisibilityMatrix { places, direction_count: directions.len(), width, words });
    }
    let headings = headings(directions);
    let lines = targets.len() as f64 * directions.len() as f64;
    let is_swept = scene.params().profile == Profile::Sphere
        && directions.len() >= WORTH_GATHERING
        && lines > WORTH_SWEEPING * scene.ball_count() as f64;
    let space = is_swept.then(|| {
        let space = SpaceLayers::new(scene.balls(), scene.params());
        let descending = Descending::new(&space, tree.positions());
        (space, descending)
    });
    // a target counts as done when as many lines of sight are
    let asked = AtomicUsize::new(0);
    let advance = |lines: usize| {
        let before = asked.fetch_add(lines, Ordering::Relaxed);
        control.advance((before + lines) / directions.len() - before / directions.len());
    };
    for batch in headings.chunks(BATCH) {
        let settled = match &space {
            None => Vec::new(),
            Some((space, descending)) => batch
                .par_iter()
                .map(|heading| sweep(space, descending, heading.direction, heading.near.max(scene.params().bias)))
                .collect(),
        };
        let sky = Sky::new(scene, batch, settled, directions.len());
        let chunks = words.par_chunks_mut(width * CHUNK).zip(tree.positions().par_chunks(CHUNK));
        chunks.enumerate().for_each(|(chunk, (rows, targets))| {
            sky.look(targets, chunk, rows, width);
            advance(targets.len() * batch.len());
        });
    }
    Ok(VisibilityMatrix { places, direction_count: directions.len(), width, words })
}
