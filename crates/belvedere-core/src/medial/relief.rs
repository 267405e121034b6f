//! Thin relief: upper edges of walls, ridges, chimneys, dormers, low walls on roofs.
//!
//! Where two surfaces meet at an edge, balls that touch either of them round it off, and where a thing is narrower than twice
//! the spacing of pulses, normals at its few points say little. What is left of it lets lines of sight through just below its
//! points, where it is most certain to be solid.

use super::bounds::Kind;
use super::chains::Chain;
use crate::neighbors::NeighborIndex;
use crate::pulses::FreeSegments;
use belvedere_data::Result;
use belvedere_data::balls::{MedialBalls, PULSE_TOUCH};
use belvedere_data::control::{Control, Stop};
use rayon::prelude::*;

/// How thin relief is told and filled.
///
/// Defaults were chosen on three simulated towns of seed 7 at 8 pulses per m². The rule takes the balanced rate of roofs from
/// 95.1 to 96.5 % and what it lets through on streets from 3.3 to 3.0 %, at the cost of a quarter more balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefParams {
    /// Horizontal distance within which the next lower level is looked for, in spacings of pulses, above 0. Default 2.4: 0.85 m at 8
    /// pulses per m², and 0.27 m at 80, where 0.75 m takes slopes for edges and costs own points 0.6 points false-blocked.
    pub reach_spacings: f32,
    /// Least and most height above that level, metres. Default 0.2 to 1.5: less is noise; what falls off deeper may overhang,
    /// and 2.5 m blocks a point more of what is visible from the street.
    pub heights: [f32; 2],
    /// Radius above which the ball at a point represents it well enough, metres, above 0. Default 0.75: 0.4 gains 0.5 points
    /// less on roofs; 1.5 gains another 0.1 of twice as many points.
    pub well_represented: f32,
    /// Most radius of the balls that fill, in spacings of pulses, above 0. Default 0.47: 0.8 gains another 0.3 points on roofs and
    /// loses 0.6 on walls, beside which no pulse passes near enough.
    pub radius_spacings: f32,
    /// Distance of these balls below each other, metres, above 0. Default 0.15; 0.2 saves a fifth of them and lets
    /// 0.1 points more through, on roofs and streets.
    pub spacing: f32,
}

impl Default for ReliefParams {
    fn default() -> Self {
        Self { reach_spacings: 2.4, heights: [0.2, 1.5], well_represented: 0.75, radius_spacings: 0.47, spacing: 0.15 }
    }
}

/// Points handed to a thread at once.
const CHUNK: usize = 512;

/// The thin relief of a cloud.
pub(super) struct Relief<'a> {
    positions: &'a [[f32; 3]],
    params: &'a ReliefParams,
    /// Rows of its points, and the height of the next lower level at each.
    points: Vec<(usize, f32)>,
    /// As [`super::spacing::pulse_spacing`] gives it.
    spacing: &'a [f32],
}

impl<'a> Relief<'a> {
    /// Tells the points of thin relief: neither ground nor vegetation nor left out, of a small ball, and as high above the
    /// lowest point near by as the parameters say; what lies deeper than the most of that is not looked at. Row i of `balls` must be the
    /// ball of point i, pruned or not.
    pub(super) fn find(
        positions: &'a [[f32; 3]],
        kinds: &[Kind],
        is_left_out: impl Fn(usize) -> bool + Sync,
        (balls, spacing): (&MedialBalls, &'a [f32]),
        index: &NeighborIndex,
        params: &'a ReliefParams,
        control: &Control<'_>,
    ) -> Result<Self> {
        let stop = Stop::new(control);
        let [least, most] = params.heights;
        let is_wanted = |row: usize| {
            matches!(kinds.get(row), Some(Kind::Other | Kind::Later))
                && !is_left_out(row)
                && balls.radii.get(row).is_some_and(|&radius| radius <= params.well_represented)
        };
        let point = |row: usize| {
            let p = positions[row];
            let reach = params.reach_spacings * spacing[row];
            let mut level = p[2];
            index.within_radius(p, reach.hypot(most), |found| {
                let q = positions[found.index as usize];
                if (q[0] - p[0]).hypot(q[1] - p[1]) < reach && p[2] - q[2] < most {
                    level = level.min(q[2]);
                }
            });
            (p[2] - level >= least).then_some((row, level))
        };
        let rows = (0..positions.len()).into_par_iter().with_min_len(CHUNK);
        let points = rows.filter(|&row| !stop.is_set() && is_wanted(row)).filter_map(point).collect();
        stop.check()?;
        control.advance(positions.len());
        Ok(Self { positions, params, points, spacing })
    }

    /// Number of its points.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// Adds balls below its points down to the next lower level, as large as the pulses leave them, and says how many.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn fill(&self, balls: &mut MedialBalls, needles: &FreeSegments, control: &Control<'_>) -> Result<usize> {
        let stop = Stop::new(control);
        let points = self.points.par_iter().with_min_len(CHUNK);
        let below = |&(row, level): &(usize, f32)| {
            let chain = Chain { radius: self.params.radius_spacings * self.spacing[row], spacing: self.params.spacing };
            chain.below(self.positions[row], level, needles).map(move |ball| (row, ball))
        };
        let found: Vec<_> = points.filter(|_| !stop.is_set()).flat_map_iter(below).collect();
        stop.check()?;
        for &(row, (center, radius)) in &found {
            balls.push(row, center, radius, PULSE_TOUCH);
        }
        Ok(found.len())
    }
}
