//! The seam between the scene and whatever answers lines of sight in bulk.
//!
//! A backend takes the balls once ([`Backend::prepare`]) and then answers batch after batch. It may be conservative: a
//! line of sight that it cannot decide for certain it leaves *open*, and the exact lines of sight of the processor
//! decide that one. So the answers are the same bits on any device.

use super::ball_tree::BallTree;
use crate::depth::{DepthBounds, DepthMap, ItemBuffer};
use belvedere_data::Result;
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::Control;
use belvedere_data::view::View;
use std::sync::Arc;

/// Whatever can answer lines of sight in bulk: the processor ([`super::Cpu`]), or another device.
pub trait Backend: Send + Sync + std::fmt::Debug {
    /// Takes the balls and the rule by which they block ([`crate::blocking`]).
    ///
    /// # Errors
    /// Errors of the device.
    fn prepare(&self, balls: &Arc<BallTree>) -> Result<Box<dyn PreparedBackend>>;

    /// Takes balls to draw them in views of so many pixels; `None`, the default, where that is no faster than
    /// [`depth_map`](crate::depth::depth_map()).
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    fn drawable<'b>(
        &self,
        balls: &'b MedialBalls,
        pixel_count: usize,
        control: &Control<'_>,
    ) -> Result<Option<Box<dyn Drawable + 'b>>> {
        let _ = (balls, pixel_count, control);
        Ok(None)
    }

    /// The name of the device that is ready for queries; `None`, the default, for the processor.
    fn device(&self) -> Option<String> {
        None
    }

    /// Returns one line for each piece of work that fell to the processor, with the reason.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Balls made ready by a backend. Costly parts are made on first use and kept.
pub trait PreparedBackend: Send + Sync {
    /// Bounds of the depth of the first surface over each pixel of `view`, as [`crate::depth::depth_bounds`] defines
    /// them: they may be wider, but must hold. Balls that reach before `start`, as
    /// [`crate::depth::BoundsParams::start`], block nothing.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled) and errors of the device.
    fn depth(&self, view: &View, start: f64, control: &Control<'_>) -> Result<DepthBounds>;

    /// Settles the lines of sight without end of each of `targets`, (M, 3) local metres, in each of `directions`, (D,
    /// 3) unit vectors. Targets that are neighbours in space are close in the list.
    ///
    /// # Errors
    /// As [`PreparedBackend::depth`].
    fn settle(&self, targets: &[[f32; 3]], directions: &[[f64; 3]], control: &Control<'_>) -> Result<Settled>;

    /// Settles the lines of sight of each of `targets` to each of a few `viewers`, which take the place of directions
    /// in the result. `None`, the default, if this backend is no faster than lines of sight one by one, or a tree of
    /// targets.
    ///
    /// # Errors
    /// As [`PreparedBackend::depth`].
    fn settle_few(&self, targets: &[[f32; 3]], viewers: Viewers<'_>, control: &Control<'_>) -> Result<Option<Settled>> {
        let _ = (targets, viewers, control);
        Ok(None)
    }
}

/// Maximum difference between the depth of a pixel from a backend and that of [`depth_map`](crate::depth::depth_map()),
/// as a share of it: 1 mm at 100 m.
pub const DEPTH_MAP_TOLERANCE: f32 = 1e-5;

/// Balls made ready to be drawn by a backend.
pub trait Drawable: Send + Sync {
    /// The depth map of the balls in `view`, as [`depth_map`](crate::depth::depth_map()) makes it of spheres, but for
    /// depths: each may differ by [`DEPTH_MAP_TOLERANCE`] of itself. Pixels without a ball and the balls of pixels are
    /// the same.
    ///
    /// # Errors
    /// Those of [`depth_map`](crate::depth::depth_map()).
    fn depth_map(&self, view: &View, items: ItemBuffer, control: &Control<'_>) -> Result<DepthMap>;
}

/// Viewers of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewers<'a> {
    /// Infinitely far away, in the directions of these unit vectors.
    Directions(&'a [[f64; 3]]),
    /// Viewers at these places, local metres.
    Eyes(&'a [[f64; 3]]),
}

impl Viewers<'_> {
    /// Returns the number of viewers.
    #[must_use]
    pub fn len(&self) -> usize {
        let (Self::Directions(vectors) | Self::Eyes(vectors)) = self;
        vectors.len()
    }

    /// Returns true if there is no viewer.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The first `count` of them, or all.
    #[must_use]
    pub fn first(self, count: usize) -> Self {
        let count = count.min(self.len());
        match self {
            Self::Directions(vectors) => Self::Directions(&vectors[..count]),
            Self::Eyes(places) => Self::Eyes(&places[..count]),
        }
    }
}

/// State of a line of sight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineAnswer {
    /// No ball blocks it.
    Free,
    /// A ball blocks it.
    Blocked,
    /// Undecided: the exact line of sight decides.
    Open,
}

/// Bits in a word.
pub(super) const WORD: usize = 64;
/// Words with a bit for each target of a block.
pub(super) const WORDS: usize = 4;
/// Number of targets stored and tested together: neighbours, which share obstacles.
pub(super) const BLOCK: usize = WORDS * WORD;

/// A bit for each target of a block.
pub(super) type WordBits = [u64; WORDS];

/// Result of a backend: free, blocked or open for each target and each direction or viewer.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    direction_count: usize,
    /// Block after block, in each direction after direction.
    pub(super) free: Vec<WordBits>,
    pub(super) blocked: Vec<WordBits>,
    /// For each direction the range before which nothing blocks a line that is open, metres.
    pub(super) open_from: Vec<f64>,
}

impl Settled {
    /// All lines open.
    #[must_use]
    pub fn new(target_count: usize, direction_count: usize) -> Self {
        let open = vec![[0; WORDS]; target_count.div_ceil(BLOCK) * direction_count];
        let open_from = vec![f64::NEG_INFINITY; direction_count];
        Self { direction_count, free: open.clone(), blocked: open, open_from }
    }

    /// Sets the answer of a line.
    pub fn set(&mut self, target: usize, direction: usize, line: LineAnswer) {
        let (at, word, bit) = self.place(target, direction);
        for (bits, of) in [(&mut self.free, LineAnswer::Free), (&mut self.blocked, LineAnswer::Blocked)] {
            if let Some(bits) = bits.get_mut(at) {
                bits[word] = bits[word] & !bit | if line == of { bit } else { 0 };
            }
        }
    }

    /// Sets the answers of all lines of a direction: a bit for each target, 32 a word, of those that are free and of
    /// those that are blocked. Bits beyond the last target must not be set.
    pub fn set_direction(&mut self, direction: usize, free: &[u32], blocked: &[u32]) {
        let count = self.direction_count;
        each_word(&mut self.free, [direction, count], free, |word, known| *word = known);
        each_word(&mut self.blocked, [direction, count], blocked, |word, known| *word = known);
    }

    /// Combines the result for a direction with one past other balls, given as in [`Settled::set_direction`]. Lines are
    /// free if they are free past both, and blocked if either blocks them.
    pub fn join_direction(&mut self, direction: usize, free: &[u32], blocked: &[u32]) {
        let count = self.direction_count;
        each_word(&mut self.free, [direction, count], free, |word, known| *word &= known);
        each_word(&mut self.blocked, [direction, count], blocked, |word, known| *word |= known);
    }

    /// Sets the answers of all lines of the directions from `first` on to those of `known`, for the same targets.
    pub fn set_directions(&mut self, first: usize, known: &Self) {
        let count = known.direction_count;
        let parts = [(&mut self.free, &known.free), (&mut self.blocked, &known.blocked)];
        for (bits, known) in parts {
            for (bits, known) in bits.chunks_mut(self.direction_count.max(1)).zip(known.chunks(count.max(1))) {
                for (bits, known) in bits.iter_mut().skip(first).zip(known) {
                    *bits = *known;
                }
            }
        }
        for (range, known) in self.open_from.iter_mut().skip(first).zip(&known.open_from) {
            *range = *known;
        }
    }

    /// Returns the state of a line.
    #[must_use]
    pub fn line(&self, target: usize, direction: usize) -> LineAnswer {
        let (at, word, bit) = self.place(target, direction);
        let is_set = |bits: &[WordBits]| bits.get(at).is_some_and(|bits| bits[word] & bit != 0);
        match (is_set(&self.free), is_set(&self.blocked)) {
            (true, _) => LineAnswer::Free,
            (_, true) => LineAnswer::Blocked,
            _ => LineAnswer::Open,
        }
    }

    /// Says that nothing blocks the open lines of a direction nearer to their targets than `range` metres, which saves
    /// work.
    pub fn set_open_from(&mut self, direction: usize, range: f64) {
        if let Some(open_from) = self.open_from.get_mut(direction) {
            *open_from = range;
        }
    }

    fn place(&self, target: usize, direction: usize) -> (usize, usize, u64) {
        (target / BLOCK * self.direction_count + direction, target % BLOCK / WORD, 1 << (target % WORD))
    }
}

/// Calls `put` with each word of a direction, given by its number and how many there are, and the same 64 bits of
/// `words`.
fn each_word(bits: &mut [WordBits], [direction, count]: [usize; 2], words: &[u32], put: impl Fn(&mut u64, u64)) {
    let of_direction = bits.iter_mut().skip(direction).step_by(count.max(1));
    for (bits, words) in of_direction.zip(words.chunks(2 * WORDS)) {
        for (word, halves) in bits.iter_mut().zip(words.chunks(2)) {
            put(word, halves.iter().rev().fold(0, |word, half| word << 32 | u64::from(*half)));
        }
    }
}
