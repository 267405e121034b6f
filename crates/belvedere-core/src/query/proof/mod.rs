//! Proof by pulses of the space along a line of sight.

pub(super) mod freed_space;
mod seen_space;

pub use freed_space::FreedSpace;

use super::lazy::Lazy;
use crate::pulses::{FreeSegmentColumns, FreeSegments, lower_ends};
use belvedere_data::cast::to_cell;
use belvedere_data::control::Control;
use belvedere_data::model::ProofParts;
use belvedere_data::vector::box_around;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use seen_space::SeenSpace;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Distance ahead within which the next pulse is searched if none is near, metres: half a street.
const LOOK_AHEAD: f64 = 4.0;
/// Nearness where pulses are dense enough, metres: pulses that carve balls of half a metre leave no room for obstacles.
const MIN_NEARNESS: f64 = 0.7;
/// Share of the pulses that run more sideways than up from which on a survey is one from the ground.
const GROUND_SHARE: f64 = 0.3;
/// Side of the cells that pulses are counted in, metres.
const COUNTING_CELL: f32 = 4.0;

/// Parameters of the proof of a visible line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProofParams {
    /// Maximum distance of a pulse from a place that counts as seen, metres, above 0; `None`, the default, for
    /// [`nearness`] of the pulses.
    pub nearness: Option<f64>,
    /// Maximum total length of a line of sight in space not seen, metres, 0 or more. Default 0.5: less than the width
    /// of a person or a trunk.
    pub tolerance: f64,
    /// Step where no pulse is near, metres, above 0. Default 0.1. A seen piece shorter than this between two that are
    /// not may be counted with them; all other lengths are exact.
    pub step: f64,
    /// Treatment of space beside the survey.
    pub beside: Beside,
}

/// Treatment of space beside the box around the lower ends of all pulses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// It needs no proof: a line of sight is followed to the edge of the survey.
    Ignored,
    /// No pulse saw it.
    Unseen,
}

impl Default for ProofParams {
    fn default() -> Self {
        Self { nearness: None, tolerance: 0.5, step: 0.1, beside: Beside::Ignored }
    }
}

/// Pulses that show how much of a line of sight none of them came near to. Their index is made when it is first needed,
/// once for all clones.
#[derive(Clone)]
pub struct Proof {
    nearness: f64,
    params: ProofParams,
    pulses: ProofSource,
    /// Parts kept from an index, until it is made of them.
    kept: Arc<Mutex<Option<ProofParts>>>,
    index: Arc<Lazy<ProofIndex>>,
}

impl fmt::Debug for Proof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Proof").field("nearness", &self.nearness).field("params", &self.params).finish_non_exhaustive()
    }
}

/// Pulses of which a proof is made.
#[derive(Clone)]
enum ProofSource {
    /// Indexed already.
    Indexed(Arc<FreeSegments>),
    /// To be indexed, and then let go.
    Columns(Arc<Mutex<FreeSegmentColumns>>),
}

/// Pulses, made ready for lines of sight.
struct ProofIndex {
    free_segments: Arc<FreeSegments>,
    seen_space: SeenSpace,
    /// West, south and east, north of the lower ends.
    extent: [[f64; 2]; 2],
}

/// Returns the maximum distance of a pulse from a place that counts as seen, metres: 0.7, or the typical distance
/// between pulses, 1/√density, if larger. The density is the median over cells of 4 m that have any.
///
/// # Source
/// This project's own.
#[must_use]
pub fn nearness(free_segments: &FreeSegments) -> f64 {
    nearness_of(free_segments.lower_ends())
}

/// [`nearness`] of pulses with these lower ends, local metres.
#[must_use]
pub fn nearness_of(lower_ends: impl Iterator<Item = [f32; 3]>) -> f64 {
    let cell = |start: [f32; 3]| [0, 1].map(|i| to_cell(f64::from(start[i] / COUNTING_CELL)));
    let mut cells: Vec<[i32; 2]> = lower_ends.map(cell).collect();
    cells.par_sort_unstable();
    let mut counts: Vec<usize> = cells.chunk_by(|a, b| a == b).map(<[_]>::len).collect();
    counts.sort_unstable();
    let median = counts.get(counts.len() / 2).copied().unwrap_or(1);
    let density = median as f64 / f64::from(COUNTING_CELL * COUNTING_CELL);
    MIN_NEARNESS.max(1.0 / density.sqrt())
}

impl Proof {
    /// Takes the pulses of a survey.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a parameter outside its range.
    pub fn new(free_segments: FreeSegments, params: &ProofParams) -> Result<Self> {
        let nearness = params.nearness.unwrap_or_else(|| nearness(&free_segments));
        Self::of_pulses(ProofSource::Indexed(Arc::new(free_segments)), nearness, params)
    }

    /// Takes pulses as ball files store them; these are not indexed before the first line of sight needs it.
    ///
    /// # Errors
    /// As [`Proof::new`], and those of [`FreeSegmentColumns::validate`].
    pub fn from_columns(columns: FreeSegmentColumns, params: &ProofParams) -> Result<Self> {
        columns.validate()?;
        let nearness = params.nearness.unwrap_or_else(|| nearness_of(lower_ends(&columns)));
        Self::of_pulses(ProofSource::Columns(Arc::new(Mutex::new(columns))), nearness, params)
    }

    fn of_pulses(pulses: ProofSource, nearness: f64, params: &ProofParams) -> Result<Self> {
        let invalid = |parameter, value: f64, expected| Err(Error::invalid(parameter, value, expected));
        if !(nearness.is_finite() && nearness > 0.0) {
            return invalid(Parameter::PulseNearness, nearness, "finite and above zero metres");
        }
        if !(params.tolerance >= 0.0) {
            return invalid(Parameter::UnprovenLength, params.tolerance, "zero metres or more");
        }
        if !(params.step.is_finite() && params.step > 0.0) {
            return invalid(Parameter::UnprovenStep, params.step, "finite and above zero metres");
        }
        Ok(Self { nearness, params: *params, pulses, kept: Arc::default(), index: Arc::new(Lazy::new()) })
    }

    /// This, with the result of [`Proof::to_parts`] for the same pulses, which is not computed again.
    #[must_use]
    pub(crate) fn with_parts(self, parts: ProofParts) -> Self {
        Self { kept: Arc::new(Mutex::new(Some(parts))), index: Arc::new(Lazy::new()), ..self }
    }

    /// Its index, to be kept; `None` as long as it is not made.
    pub(crate) fn to_parts(&self) -> Option<ProofParts> {
        if !self.index.is_made() {
            return self.lock_kept().clone();
        }
        let index = self.index.get(|control| self.make_index(control))?;
        let seen_space = index.seen_space.to_words().unwrap_or_default();
        let (order, boxes) = index.free_segments.order_and_boxes();
        Some(ProofParts { order, boxes, seen_space })
    }

    fn lock_kept(&self) -> MutexGuard<'_, Option<ProofParts>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Indexes the pulses, if no line of sight needed that before. All else does it by itself, but cannot be cancelled
    /// meanwhile.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn prepare(&self, control: &Control<'_>) -> Result<()> {
        self.index.get_or_make(|| self.make_index(control)).map(|_| ())
    }

    /// Indexes the pulses, and where all of them are upright finds the space that they saw, so that no line of sight
    /// anywhere waits for it.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub(crate) fn prepare_all(&self, control: &Control<'_>) -> Result<()> {
        let ProofIndex { free_segments, seen_space, .. } = self.index.get_or_make(|| self.make_index(control))?;
        match free_segments.upright_count() == free_segments.len() {
            true => seen_space.make_all(free_segments, control),
            false => Ok(()),
        }
    }

    fn make_index(&self, control: &Control<'_>) -> Result<ProofIndex> {
        let kept = self.lock_kept().take();
        let free_segments = match (&self.pulses, &kept) {
            (ProofSource::Indexed(free_segments), _) => Arc::clone(free_segments),
            (ProofSource::Columns(columns), kept) => {
                let columns = columns.lock().unwrap_or_else(PoisonError::into_inner);
                Arc::new(match kept {
                    None => FreeSegments::from_columns(&columns, control)?,
                    Some(ProofParts { order, boxes, .. }) => {
                        FreeSegments::from_index(&columns, (order, boxes), control)?
                    }
                })
            }
        };
        control.check()?;
        let extent = box_around(free_segments.lower_ends().map(|[x, y, _]| [x, y].map(f64::from)));
        let seen_space = SeenSpace::new(&free_segments, extent, self.nearness);
        if let Some(kept) = &kept {
            seen_space.take(&kept.seen_space);
        }
        // nothing can fail any more
        if let ProofSource::Columns(columns) = &self.pulses {
            *columns.lock().unwrap_or_else(PoisonError::into_inner) = FreeSegmentColumns::default();
        }
        Ok(ProofIndex { free_segments, seen_space, extent })
    }

    /// Returns the maximum distance of a pulse from a place that counts as seen, metres.
    #[must_use]
    pub fn nearness(&self) -> f64 {
        self.nearness
    }

    /// Returns true if most pulses are those of scanners on the ground: they run more sideways than up.
    #[must_use]
    pub fn is_from_ground(&self) -> bool {
        let index = self.index.get(|control| self.make_index(control));
        index.is_some_and(|index| index.free_segments.sideways_share() > GROUND_SHARE)
    }

    /// Returns true if a place, local metres, lies above the highest return.
    #[must_use]
    pub fn is_above_all(&self, place: [f64; 3]) -> bool {
        let index = self.index.get(|control| self.make_index(control));
        index.is_some_and(|index| place[2] > f64::from(index.free_segments.top()))
    }

    /// Length that may be unseen, metres.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.params.tolerance
    }

    /// Returns the length, metres, of a line through space that no pulse came near to. The line starts at `target`,
    /// local metres, and runs `range` metres (infinite for a direction) along the unit vector `towards`. All space
    /// above the highest return is free. Without any pulse the whole line is unseen, and so is a line that runs down
    /// without end.
    #[must_use]
    pub fn unproven_length(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> f64 {
        self.length(target, towards, range, f64::INFINITY, |_| ())
    }

    /// Returns the length, metres, of a piece of a line in space that no pulse came near to. The piece lies between two
    /// distances from `origin`. The search stops once the length exceeds `enough`. Space beside the survey or above its
    /// returns is unknown and counts whole. For surveys of which a part is in memory at a time.
    #[must_use]
    pub fn unseen_length_between(
        &self,
        (origin, direction): ([f64; 3], [f64; 3]),
        [from, to]: [f64; 2],
        enough: f64,
    ) -> f64 {
        match self.index.get(|control| self.make_index(control)) {
            Some(index) if !index.free_segments.is_empty() => {
                self.length_inside(index, (origin, direction), [from, to], enough, |_| ())
            }
            _ => (to - from).max(0.0),
        }
    }

    /// About [`Proof::unseen_length_between`], or `enough` or more as soon as it is so much, measured as
    /// [`Proof::sampled_unproven_length`] does.
    #[must_use]
    pub fn sampled_unseen_length_between(&self, line: ([f64; 3], [f64; 3]), [from, to]: [f64; 2], enough: f64) -> f64 {
        match self.index.get(|control| self.make_index(control)) {
            Some(index) if !index.free_segments.is_empty() => sampled_length(index, line, [from, to], enough)
                .unwrap_or_else(|| self.length_inside(index, line, [from, to], enough, |_| ())),
            _ => (to - from).max(0.0),
        }
    }

    /// About [`Proof::unproven_length`], or `enough` or more as soon as it is so much: the length through boxes of the
    /// survey's space whose middles no pulse came near to. Each middle is looked at once, so that many lines
    /// cost little.
    #[must_use]
    pub fn sampled_unproven_length(&self, target: [f64; 3], towards: [f64; 3], range: f64, enough: f64) -> f64 {
        self.length_by((target, towards, range), enough, |index, line, piece, enough| {
            sampled_length(index, line, piece, enough)
                .unwrap_or_else(|| self.length_inside(index, line, piece, enough, |_| ()))
        })
    }

    /// Returns true if more than the tolerated length runs through unseen space; faster than measuring it.
    #[must_use]
    pub fn is_unproven(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        self.length(target, towards, range, self.params.tolerance, |_| ()) > self.params.tolerance
    }

    /// Returns true if a pulse came near to a place, local metres, or it lies above the highest return.
    #[must_use]
    pub fn is_seen(&self, place: [f64; 3]) -> bool {
        self.is_seen_within(place, self.nearness)
    }

    /// Returns true if a pulse came within `distance` metres of a place, local metres, or it lies above the highest
    /// return.
    #[must_use]
    pub fn is_seen_within(&self, place: [f64; 3], distance: f64) -> bool {
        let index = self.index.get(|control| self.make_index(control));
        self.is_above_all(place) || index.is_some_and(|index| index.free_segments.passes_within(place, distance))
    }

    /// Returns the pieces that [`Proof::unproven_length`] counts, from and to, metres from `target`, along the line.
    /// Empty without pulses, and beside the survey.
    #[must_use]
    pub fn unproven_pieces(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Vec<[f64; 2]> {
        let mut pieces = Vec::new();
        let is_turned = runs_back(towards, range);
        self.length(target, towards, range, f64::INFINITY, |piece| pieces.push(piece));
        if is_turned {
            pieces.iter_mut().for_each(|[from, to]| [*from, *to] = [range - *to, range - *from]);
            pieces.reverse();
        }
        pieces
    }

    /// The unseen length, or something above `enough` as soon as it is known to exceed that. `visit` gets the unseen
    /// pieces that end before, metres from the end at which steps begin ([`runs_back`]).
    fn length(&self, target: [f64; 3], towards: [f64; 3], range: f64, enough: f64, visit: impl FnMut([f64; 2])) -> f64 {
        self.length_by((target, towards, range), enough, |index, line, piece, enough| {
            self.length_inside(index, line, piece, enough, visit)
        })
    }

    /// Returns the unseen length that `measure` finds on the piece of a line over the survey, plus the length beside
    /// it. `measure` gets the line, the piece, and the length at which it may stop.
    fn length_by(
        &self,
        (target, towards, range): ([f64; 3], [f64; 3], f64),
        enough: f64,
        measure: impl FnOnce(&ProofIndex, ([f64; 3], [f64; 3]), [f64; 2], f64) -> f64,
    ) -> f64 {
        // the same steps whichever end is the target: a piece shorter than a step counts or not by where steps begin
        let (target, towards) = match runs_back(towards, range) {
            true => (std::array::from_fn(|i| target[i] + range * towards[i]), towards.map(|v| -v)),
            false => (target, towards),
        };
        let Some(index) = self.index.get(|control| self.make_index(control)) else { return range };
        if index.free_segments.is_empty() {
            return range;
        }
        let top = f64::from(index.free_segments.top());
        let mut below = [0.0, range];
        clip(&mut below, target[2], towards[2], [f64::NEG_INFINITY, top]);
        let mut inside = below;
        for axis in 0..2 {
            clip(&mut inside, target[axis], towards[axis], [index.extent[0][axis], index.extent[1][axis]]);
        }
        let span = |[from, to]: [f64; 2]| (to - from).max(0.0);
        let beside = match self.params.beside {
            Beside::Ignored => 0.0,
            Beside::Unseen => span(below) - span(inside),
        };
        if span(inside) == f64::INFINITY {
            return f64::INFINITY;
        }
        if beside > enough || !(span(inside) > 0.0) {
            return beside;
        }
        beside + measure(index, (target, towards), inside, enough - beside)
    }

    fn length_inside(
        &self,
        index: &ProofIndex,
        (origin, direction): ([f64; 3], [f64; 3]),
        [from, to]: [f64; 2],
        enough: f64,
        mut visit: impl FnMut([f64; 2]),
    ) -> f64 {
        let ProofIndex { free_segments, seen_space, .. } = index;
        let point = |at: f64| -> [f64; 3] { std::array::from_fn(|i| origin[i] + at * direction[i]) };
        let backward = direction.map(|v| -v);
        let mut unseen = 0.0;
        let mut gap_from: Option<f64> = None;
        let mut at = from;
        while at < to {
            let seen_to = seen_space.near_until(free_segments, (origin, direction), at).or_else(|| {
                free_segments.near_piece(origin, direction, at, self.nearness).map(|[_, piece_to]| piece_to)
            });
            if let Some(seen_to) = seen_to {
                if let Some(start) = gap_from.take() {
                    // the last step may have gone past where pulses come near again
                    let mut end = at;
                    while let Some([_, before]) = free_segments.near_piece(origin, backward, -end, self.nearness)
                        && end > start
                    {
                        end = -before;
                    }
                    unseen += (end - start).max(0.0);
                    if end > start {
                        visit([start, end]);
                    }
                }
                at = seen_to;
                continue;
            }
            let start = *gap_from.get_or_insert(at);
            let reach = self.nearness + LOOK_AHEAD;
            let clear = free_segments.free_distance(point(at), reach) - self.nearness;
            if unseen + (at + clear.max(0.0)).min(to) - start > enough {
                return f64::max(unseen + (at + clear.max(0.0)).min(to) - start, enough);
            }
            at += clear.max(self.params.step);
        }
        unseen
            + gap_from.map_or(0.0, |start| {
                visit([start, to]);
                to - start
            })
    }
}

/// The length through boxes whose middles no pulse came near to; `None` where there are no boxes.
fn sampled_length(
    ProofIndex { free_segments, seen_space, .. }: &ProofIndex,
    line: ([f64; 3], [f64; 3]),
    piece: [f64; 2],
    enough: f64,
) -> Option<f64> {
    seen_space.unseen_length(free_segments, line, piece, enough)
}

/// Returns true if the steps along a line begin at its far end.
fn runs_back(towards: [f64; 3], range: f64) -> bool {
    range.is_finite() && towards.into_iter().find(|v| *v != 0.0).is_some_and(|v| v < 0.0)
}

/// Cuts the piece of a line down to where one of its coordinates lies between two bounds.
pub(super) fn clip(piece: &mut [f64; 2], origin: f64, slope: f64, [low, high]: [f64; 2]) {
    if slope == 0.0 {
        if !(low..=high).contains(&origin) {
            piece[1] = piece[0];
        }
        return;
    }
    let (a, b) = ((low - origin) / slope, (high - origin) / slope);
    piece[0] = piece[0].max(a.min(b));
    piece[1] = piece[1].min(a.max(b)).max(piece[0]);
}
