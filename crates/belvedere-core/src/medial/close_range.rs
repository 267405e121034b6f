//! Balls for scanners that stand among the things they measure: tripods, cars, rooms.
//!
//! Such a scanner sees a wall, a car or a trunk from one side, from a short distance, and nothing behind it. Balls as
//! thick as those of surveys from the air would fill that space, although lines of sight run through it that never meet
//! the surface. Here balls are only as thick as needed to close the surface; space that no pulse has seen is left for
//! the pulses to call unproven.

use super::below_tripods::{FloorPlace, floors_below};
use super::carve::CarveReport;
use super::shrinking_ball::{ShrinkMethod, ShrinkParams, ShrinkReport, shrink, spacing_at};
use super::survey::CarvedInput;
use crate::neighbors::Tangent;
use crate::pulses::GAP_M;
use belvedere_data::Result;
use belvedere_data::balls::{LIMIT_TOUCH, MedialBalls, NO_TOUCH, PULSE_TOUCH, Side};
use belvedere_data::control::Control;
use rayon::prelude::*;

/// Balls handed to a thread at once; their searches share the cache.
const CHUNK: usize = 512;
/// Minimum radius of a ball, metres: smaller ones are noise, as pulses passed on all sides.
const MIN_RADIUS: f32 = 1e-3;

/// Sizes of balls for scanners that stand among the things they measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseRangeParams {
    /// Maximum radius in spacings of the points around, above 0.5: below that there are gaps between points in squares.
    /// Default 2, since scan lines are often twice as far apart as the points on them. 1.5 leaves gaps at the edges of
    /// rooms.
    pub max_spacings: f32,
    /// Maximum radius, metres, above 0. Default 0.15: 0.25 blocks twice as much of the visible space behind cars and
    /// fences.
    pub max_radius: f32,
    /// Depth to which points and pulses may enter a ball before it gives way to them, as a share of the most radius, 0
    /// to 0.5. Default 0.25. The balls that are left end as deep below the surface, so that no pulse enters them at
    /// all, and points that noise moved inward remain visible.
    pub penetration_share: f32,
    /// Maximum of that depth, metres. Default 0.0075: the noise of such scanners; 0.02 makes a room of 10 × 6 × 3 m 3.5
    /// % too large.
    pub max_penetration: f32,
}

impl Default for CloseRangeParams {
    fn default() -> Self {
        Self { max_spacings: 2.0, max_radius: 0.15, penetration_share: 0.25, max_penetration: 0.0075 }
    }
}

/// Balls that close the surfaces, with counts by outcome.
pub(super) struct CloseRangeBalls {
    pub(super) balls: MedialBalls,
    pub(super) shrinking: ShrinkReport,
    pub(super) carving: CarveReport,
    /// Balls of floors below tripods.
    pub(super) below_tripods: usize,
}

impl CloseRangeParams {
    /// The balls of a survey.
    ///
    /// # Errors
    /// Those of [`shrink`].
    pub(super) fn balls(&self, input: &CarvedInput<'_>, control: &Control<'_>) -> Result<CloseRangeBalls> {
        let CarvedInput { oriented, index, .. } = *input;
        let shrinking = ShrinkParams {
            method: ShrinkMethod::Tau { penetration: self.max_penetration.min(0.5 * self.max_radius) },
            initial_radius: self.max_radius,
            max_radius: f32::INFINITY,
            max_spacings: self.max_spacings,
        };
        let (mut balls, mut shrinking) = control.stage("shrinking balls", oriented.len(), || {
            shrink(oriented, index, Side::Interior, &shrinking, control)
        })?;
        let carving = control.stage("carving balls", oriented.len(), || self.carve(&mut balls, input, control))?;
        // what no point bounds is bounded by these sizes
        shrinking.limited += std::mem::take(&mut shrinking.never_shrunk);
        let below_tripods =
            control.stage("closing floors below tripods", 0, || Ok(self.close_floors(&mut balls, input)))?;
        Ok(CloseRangeBalls { balls, shrinking, carving, below_tripods })
    }

    /// Adds balls to the floors that tripods stand on; returns how many.
    fn close_floors(&self, balls: &mut MedialBalls, input: &CarvedInput<'_>) -> usize {
        let spacing = 0.5 * self.max_radius;
        let before = balls.len();
        for FloorPlace { position, row } in
            floors_below(input.oriented.positions(), input.index, input.free_segments, spacing)
        {
            let tangent = Tangent { point: position, inward: [0.0, 0.0, -1.0], margin: self.max_penetration };
            let most = self.max_radius - self.max_penetration;
            let radius = input.free_segments.smallest_tangent_ball(&tangent, most).map_or(most, |empty| empty - GAP_M);
            if radius >= MIN_RADIUS {
                let [x, y, z] = position;
                balls.push(row, [x, y, z - self.max_penetration - GAP_M - radius], radius, LIMIT_TOUCH);
            }
        }
        balls.len() - before
    }

    /// Cuts balls down to where no pulse enters them.
    fn carve(&self, balls: &mut MedialBalls, input: &CarvedInput<'_>, control: &Control<'_>) -> Result<CarveReport> {
        let CarvedInput { oriented, index, free_segments, .. } = *input;
        let (positions, normals) = (oriented.positions(), oriented.normals());
        let order = index.tree_order();
        let mut cut: Vec<(f32, f32, bool)> = vec![(0.0, 0.0, false); order.len()];
        cut.par_chunks_mut(CHUNK).zip(order.par_chunks(CHUNK)).try_for_each(|(cut, rows)| {
            control.check()?;
            let mut near = Vec::new();
            for (cut, &row) in cut.iter_mut().zip(rows) {
                let row = row as usize;
                let most = self.max_radius.min(self.max_spacings * spacing_at(index, positions[row], &mut near));
                let radius = balls.radii[row].min(most);
                let margin = self.max_penetration.min(self.penetration_share * most);
                if !(radius > margin) {
                    continue;
                }
                let tangent = Tangent { point: positions[row], inward: normals[row].map(|v| -v), margin };
                *cut = match free_segments.smallest_tangent_ball(&tangent, radius - margin) {
                    Some(empty) => (empty - GAP_M, margin + GAP_M, true),
                    None => (radius - margin, margin, false),
                };
            }
            control.advance(rows.len());
            Ok(())
        })?;
        let mut report = CarveReport::default();
        for (&row, (radius, margin, is_cut)) in order.iter().zip(cut) {
            let row = row as usize;
            if !(radius >= MIN_RADIUS) {
                (balls.radii[row], balls.touch[row]) = (0.0, NO_TOUCH);
                continue;
            }
            let deep = radius + margin;
            balls.centers[row] = std::array::from_fn(|axis| positions[row][axis] - normals[row][axis] * deep);
            balls.radii[row] = radius;
            if is_cut {
                report.carved += 1;
                balls.touch[row] = PULSE_TOUCH;
                balls.separation_angles[row] = f32::NAN;
            } else if balls.touch[row] == NO_TOUCH {
                report.limited += 1;
                balls.touch[row] = LIMIT_TOUCH;
            }
        }
        Ok(report)
    }
}
