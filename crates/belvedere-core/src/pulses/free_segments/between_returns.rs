//! Paths of pulses between their returns, as evidence of free space below crowns and beside edges.

use super::{FreeSegmentParams, FreeSegments};
use crate::neighbors::NeighborIndex;
use crate::pulses::Pulses;
use belvedere_data::control::{Control, Stop};
use belvedere_data::{PointCloud, Result};
use rayon::prelude::*;

/// Minimum height between the first and the last return of a pulse through a crown, metres; past a car or a fence it is
/// less.
const CROWN_DEPTH: f32 = 2.0;
/// A first return over a crown is a top where none within this lies higher, metres: half the width of small crowns.
const TOP_REACH: f32 = 2.0;
/// Minimum level distance between tops of crowns and ways between returns, metres: 0.7, which a pulse proves around
/// itself, and half a metre for the stem. A line of sight through the stem then has a metre unproven, twice the
/// tolerance.
const STEM_REACH: f32 = 1.2;

impl FreeSegments {
    /// The paths of `pulses` from each of their returns to the one before, as free segments with the same upper limit
    /// of height as those of this survey. Rows of `pulses` are those of `cloud`.
    ///
    /// The rest of a beam went that way, so that nothing as large as the gaps between such pulses stands there. Stems
    /// of trees are smaller, and crowns keep pulses off them: ways near the top of a crown, below which its stem
    /// stands, prove nothing and are left out. They must not carve, because leaves that let a part of a beam through
    /// are there.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    ///
    /// # Source
    /// This project's own. Tops of trees as local maxima of the canopy: Popescu & Wynne 2004, Photogrammetric
    /// Engineering & Remote Sensing 70.
    pub fn between_returns(
        &self,
        cloud: &PointCloud,
        pulses: &Pulses,
        params: &FreeSegmentParams,
        control: &Control<'_>,
    ) -> Result<Self> {
        let place = |row: u32| cloud.positions.get(row as usize).copied();
        let number = |row: u32| {
            let numbers = cloud.attributes.return_number.as_deref();
            numbers.and_then(|numbers| numbers.get(row as usize)).copied().unwrap_or_default()
        };
        let entry = |pulse: usize| {
            let [first, .., last] = *pulses.returns_of(pulse) else { return None };
            let (first, last) = (place(first)?, place(last)?);
            (first[2] - last[2] > CROWN_DEPTH).then_some(first)
        };
        let entries: Vec<[f32; 3]> = (0..pulses.len()).into_par_iter().filter_map(entry).collect();
        let tops = CrownTops::of(&entries, control)?;
        let stop = Stop::new(control);
        let of_pulse = |pulse: usize| {
            let pairs = pulses.returns_of(pulse).windows(2).filter(|_| !stop.is_set());
            // a return that was cleaned away may have stood between two others
            let follow = pairs.filter(|pair| number(pair[0]) + 1 == number(pair[1]));
            let ways = follow.filter_map(|pair| Some((place(pair[1])?, place(pair[0])?)));
            ways.filter(|&(later, earlier)| !tops.are_near(later, earlier)).collect::<Vec<_>>()
        };
        let ways: Vec<_> = (0..pulses.len()).into_par_iter().flat_map_iter(of_pulse).collect();
        stop.check()?;
        let (later, earlier): (Vec<_>, Vec<_>) = ways.into_iter().unzip();
        Ok(Self::build_below(&later, &earlier, Some(self.top - params.headroom), params, control)?.0)
    }
}

/// The tops of crowns, seen from above.
struct CrownTops {
    places: Vec<[f32; 3]>,
    index: NeighborIndex,
}

impl CrownTops {
    /// Finds the highest of `entries`, the places where pulses entered crowns, local metres.
    fn of(entries: &[[f32; 3]], control: &Control<'_>) -> Result<Self> {
        let flat: Vec<[f32; 3]> = entries.iter().copied().map(level).collect();
        let index = NeighborIndex::new(&flat, control)?;
        let stop = Stop::new(control);
        let is_top = |&number: &usize| {
            let mut is_top = !stop.is_set();
            index.within_radius(flat[number], TOP_REACH, |found| {
                is_top &= entries[found.index as usize][2] <= entries[number][2];
            });
            is_top
        };
        let places: Vec<[f32; 3]> =
            (0..entries.len()).into_par_iter().filter(is_top).map(|number| flat[number]).collect();
        stop.check()?;
        let index = NeighborIndex::new(&places, control)?;
        Ok(Self { places, index })
    }

    /// Returns true if a top lies near the segment from `a` to `b` in plan.
    fn are_near(&self, a: [f32; 3], b: [f32; 3]) -> bool {
        let (a, b) = (level(a), level(b));
        let along = [b[0] - a[0], b[1] - a[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let middle = [f32::midpoint(a[0], b[0]), f32::midpoint(a[1], b[1]), 0.0];
        let distance = |top: [f32; 3]| {
            let from = [top[0] - a[0], top[1] - a[1]];
            let share = if square > 0.0 { (from[0] * along[0] + from[1] * along[1]) / square } else { 0.0 };
            let share = share.clamp(0.0, 1.0);
            (from[0] - share * along[0]).hypot(from[1] - share * along[1])
        };
        let mut is_near = false;
        self.index.within_radius(middle, square.sqrt() / 2.0 + STEM_REACH, |found| {
            is_near |= distance(self.places[found.index as usize]) < STEM_REACH;
        });
        is_near
    }
}

/// Seen from above.
fn level([x, y, _]: [f32; 3]) -> [f32; 3] {
    [x, y, 0.0]
}
