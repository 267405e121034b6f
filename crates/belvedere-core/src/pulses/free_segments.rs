//! Pulses as proven-empty lines, indexed so that a pencil of balls finds the one that cuts it most.

mod between_returns;
mod columns;
mod into_the_sky;
mod proximity;
mod segment;
mod tree;

pub use belvedere_data::free_segments::FreeSegmentColumns;
pub use columns::ends_of_pulse;
pub(crate) use columns::lower_ends;
pub(crate) use proximity::come_from_the_ground;

use crate::neighbors::Tangent;
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::{dot, to_f32};
use belvedere_data::{Error, PointCloud, Result};
use segment::{FreeSegment, SegmentsByAxis};
use serde::Serialize;
use std::ops::ControlFlow;
use tree::{SegmentAxis, SegmentTree, node_count};

/// Clearance between balls and pulses, metres: the coordinate step of most files, and more than the rounding of f32.
pub(crate) const GAP_M: f32 = 1e-3;
/// Pulses between two looks at whether to go on.
const CHECK_EACH: usize = 4096;

/// Parameters that turn pulses into free segments: line segments that are proven to be empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeSegmentParams {
    /// Length before the first return that is not counted as empty, metres, 0 to 1. Default 0.05: the noise of a range.
    /// A model of a scan from one place on the ground takes less where it finds less noise.
    pub end_margin: f32,
    /// Height above the highest return up to which free segments reach, metres, above 0. Default 2; nothing stands
    /// higher.
    pub headroom: f32,
}

impl Default for FreeSegmentParams {
    fn default() -> Self {
        Self { end_margin: 0.05, headroom: 2.0 }
    }
}

/// The free segments of a survey, in all directions.
pub struct FreeSegments {
    /// Segments of all trees, one tree after the other.
    free_segments: Vec<FreeSegment>,
    /// Trees, at most one for each direction; none is empty.
    trees: Vec<SegmentTree>,
    /// Height that none rises above.
    top: f32,
}

/// Counts of pulses that became free segments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct FreeSegmentReport {
    /// Free segments.
    #[serde(rename = "pulses_used")]
    pub used: usize,
    /// First returns whose scanner position is unknown.
    #[serde(rename = "pulses_without_scanner")]
    pub without_scanner: usize,
}

impl FreeSegments {
    /// Free segments of the first returns of `cloud`, all its points where it has no return numbers, for scanners at
    /// `scanner`, (N, 3) local metres, NaN where unknown.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless there is a scanner position for each point; [`Error::Cancelled`].
    pub fn of_cloud(
        cloud: &PointCloud,
        scanner: &[[f32; 3]],
        params: &FreeSegmentParams,
        control: &Control<'_>,
    ) -> Result<(Self, FreeSegmentReport)> {
        Self::of_cloud_below(cloud, scanner, None, params, control)
    }

    /// The free segments of [`FreeSegments::of_cloud`], below `highest` where it is given: the height of the highest
    /// return of the survey that `cloud` is a part of, local metres.
    ///
    /// # Errors
    /// Those of [`FreeSegments::of_cloud`].
    pub(crate) fn of_cloud_below(
        cloud: &PointCloud,
        scanner: &[[f32; 3]],
        highest: Option<f32>,
        params: &FreeSegmentParams,
        control: &Control<'_>,
    ) -> Result<(Self, FreeSegmentReport)> {
        cloud.validate()?;
        if scanner.len() != cloud.len() {
            return Err(Error::LengthMismatch {
                what: "scanner positions",
                expected: cloud.len(),
                found: scanner.len(),
            });
        }
        let numbers = cloud.attributes.return_number.as_deref();
        let is_first = |row: &usize| numbers.is_none_or(|numbers| numbers[*row] <= 1);
        let rows = || (0..cloud.len()).filter(is_first);
        let returns: Vec<[f32; 3]> = rows().map(|row| cloud.positions[row]).collect();
        let scanner: Vec<[f32; 3]> = rows().map(|row| scanner[row]).collect();
        Self::build_below(&returns, &scanner, highest, params, control)
    }

    /// Free segments from `first_returns`, (N, 3) local metres, towards `scanner`, (N, 3) local metres, NaN where
    /// unknown.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] where the two differ in length; [`Error::Cancelled`].
    pub fn new(
        first_returns: &[[f32; 3]],
        scanner: &[[f32; 3]],
        params: &FreeSegmentParams,
        control: &Control<'_>,
    ) -> Result<(Self, FreeSegmentReport)> {
        Self::build_below(first_returns, scanner, None, params, control)
    }

    fn build_below(
        first_returns: &[[f32; 3]],
        scanner: &[[f32; 3]],
        highest: Option<f32>,
        params: &FreeSegmentParams,
        control: &Control<'_>,
    ) -> Result<(Self, FreeSegmentReport)> {
        if scanner.len() != first_returns.len() {
            return Err(Error::LengthMismatch {
                what: "scanner positions",
                expected: first_returns.len(),
                found: scanner.len(),
            });
        }
        let finite = first_returns.iter().filter(|p| p.iter().all(|v| v.is_finite()));
        let own = || finite.map(|p| p[2]).fold(f32::NEG_INFINITY, f32::max);
        let top = highest.unwrap_or_else(own) + params.headroom;
        let mut report = FreeSegmentReport::default();
        let mut by_way = SegmentsByAxis::default();
        for (number, (p, s)) in first_returns.iter().zip(scanner).enumerate() {
            if number % CHECK_EACH == 0 {
                control.check()?;
            }
            if !s.iter().chain(p).all(|v| v.is_finite()) {
                report.without_scanner += 1;
                continue;
            }
            let sight: [f64; 3] = std::array::from_fn(|i| f64::from(s[i]) - f64::from(p[i]));
            let range = dot(sight, sight).sqrt();
            let towards = sight.map(|v| v / range);
            let Some(way) = SegmentAxis::of(towards) else { continue };
            let margin = f64::from(params.end_margin);
            let start: [f64; 3] = std::array::from_fn(|i| f64::from(p[i]) + margin * towards[i]);
            let to_top = if towards[2] > 0.0 { (f64::from(top) - start[2]) / towards[2] } else { f64::INFINITY };
            let length = to_top.min(range - margin);
            if length > 0.0 {
                by_way[way.number()].push(FreeSegment::new(start, towards, length));
            }
        }
        report.used = by_way.iter().map(Vec::len).sum();
        Ok((Self::index(by_way, None, top, control)?, report))
    }

    /// These free segments, each extended so that it begins `by` metres nearer to its return.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub(crate) fn extended(&self, by: f32, control: &Control<'_>) -> Result<Self> {
        let mut by_way = SegmentsByAxis::default();
        for free_segment in &self.free_segments {
            let start = std::array::from_fn(|i| free_segment.start[i] - by * free_segment.direction[i]);
            if let Some(way) = SegmentAxis::of(free_segment.direction.map(f64::from)) {
                by_way[way.number()].push(FreeSegment { start, length: free_segment.length + by, ..*free_segment });
            }
        }
        Self::index(by_way, None, self.top, control)
    }

    /// The index of the free segments of each direction, none of which rises above `top`. They are in the order of an
    /// index already where the boxes of its nodes are given.
    fn index(by_way: SegmentsByAxis, mut boxes: Option<&[[f32; 10]]>, top: f32, control: &Control<'_>) -> Result<Self> {
        let stop = Stop::new(control);
        let (mut free_segments, mut trees) = (Vec::with_capacity(by_way.iter().map(Vec::len).sum()), Vec::new());
        for (way, mut own) in SegmentAxis::ALL.into_iter().zip(by_way).filter(|(_, own)| !own.is_empty()) {
            let of_tree = boxes.and_then(|boxes| boxes.split_at_checked(node_count(own.len())));
            boxes = of_tree.map(|(_, rest)| rest);
            let of_tree = (way, of_tree.map(|(own, _)| own));
            trees.push(SegmentTree::new(of_tree, &mut own, free_segments.len(), &stop, control));
            free_segments.append(&mut own);
            stop.check()?;
        }
        Ok(Self { free_segments, trees, top })
    }

    /// Share of the segments that run more sideways than up, 0 to 1: most of those of scanners on the ground.
    #[must_use]
    pub fn sideways_share(&self) -> f64 {
        let ends = self.trees.iter().skip(1).map(|tree| tree.first).chain([self.free_segments.len()]);
        let counts = self.trees.iter().zip(ends).filter(|(tree, _)| tree.way != SegmentAxis::UP);
        let sideways: usize = counts.map(|(tree, end)| end - tree.first).sum();
        sideways as f64 / self.free_segments.len().max(1) as f64
    }

    /// Returns segment `number`: its start, local metres; the unit vector along it, towards the scanner; and its
    /// length, metres. Segments are in the order of the index. `None` from [`FreeSegments::len`] on.
    #[must_use]
    pub fn segment(&self, number: usize) -> Option<([f32; 3], [f32; 3], f32)> {
        self.free_segments
            .get(number)
            .map(|free_segment| (free_segment.start, free_segment.direction, free_segment.length))
    }

    /// The greatest radius, below `max_radius`, of the balls of a pencil that no segment enters, or `None` where no
    /// segment enters the ball of `max_radius`. Metres.
    ///
    /// # Source
    /// The closed form for a line is this project's. The ball of the pencil through a point at t metres along a segment
    /// has the radius |p′−a−tu|² / 2 n·(p′−a−tu), a convex function of t.
    #[must_use]
    pub fn smallest_tangent_ball(&self, tangent: &Tangent, max_radius: f32) -> Option<f32> {
        if !(max_radius > 0.0) {
            return None;
        }
        let touching = tangent.center(0.0);
        let mut found = (max_radius, false);
        for tree in &self.trees {
            let may_enter =
                |node: &_, (radius, _): &(f32, bool)| tree.may_enter(node, tangent.center(*radius), *radius);
            let _ = tree.walk(&mut found, may_enter, |numbers, (radius, is_cut)| {
                for free_segment in &self.free_segments[numbers] {
                    if let Some(found) = free_segment.tangent_radius(touching, tangent.inward)
                        && found < f64::from(*radius)
                    {
                        let found = to_f32(found);
                        (*radius, *is_cut) = (found.max(0.0), true);
                    }
                }
                ControlFlow::Continue(())
            });
        }
        found.1.then_some(found.0)
    }
}
