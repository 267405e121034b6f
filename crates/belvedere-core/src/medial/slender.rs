//! Things so slender that pulses pass them closely on both sides: fences, railings, garden walls, wires, masts.
//!
//! Their points have no surface about them that a normal could be taken from, and the balls there fill the air beside them.

use super::bounds::{Kind, RadiusBounds};
use super::cells::{Cells, cell};
use super::chains::Chain;
use super::midway::{apart, neighbors_after, one_in_each_cell};
use crate::neighbors::{NeighborIndex, Tangent};
use crate::pulses::FreeSegments;
use belvedere_data::balls::{MedialBalls, PULSE_TOUCH};
use belvedere_data::control::{Control, Stop};
use belvedere_data::{Attributes, Result};
use rayon::prelude::*;
use std::f32::consts::FRAC_1_SQRT_2;

/// How slender things are told and represented.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlenderParams {
    /// A thing is slender where pulses enter the balls that touch its point from eight sides before any has this radius,
    /// metres, above 0: into a wall, a car or a roof one of them can grow on. Default 0.5: some pulse passes within that of
    /// most points of fences at eight pulses a square metre; 0.35 finds fewer.
    pub gap: f32,
    /// How far below its point the balls touch, metres, 0 or more; above the lowest point near by in any case. Default
    /// 0.7: more than the gap, so that pulses that end beside the point, on the same roof, do not count.
    pub lowering: f32,
    /// Most radius of the balls at its points, in spacings of pulses, above 0. Default 0.32: pulses pass closer on both sides.
    pub radius_spacings: f32,
    /// Least height above the lowest point near by, metres, 0 or more. Default 0.3: kerbs and noise are lower.
    pub least_height: f32,
    /// Height up to which it stands on the ground, rather than hang in the air, metres. Default 2.5: higher fences are rare, lower
    /// wires too.
    pub standing_height: f32,
    /// Most radius of the balls that fill what stands, in spacings of pulses, above 0. Default 0.47: what pulses passed by cannot be
    /// blocked, and 0.32 lets more through.
    pub standing_spacings: f32,
    /// Distance of these balls below each other, metres, above 0. Default 0.2.
    pub spacing: f32,
    /// Most distance of two points of one thing between which it is filled as well, metres, 0 or more. Default 1: twice the
    /// distance of most hits along a fence; wider gaps may be gates.
    pub reach: f32,
}

impl Default for SlenderParams {
    fn default() -> Self {
        Self {
            gap: 0.5,
            lowering: 0.7,
            radius_spacings: 0.32,
            least_height: 0.3,
            standing_height: 2.5,
            standing_spacings: 0.47,
            spacing: 0.2,
            reach: 1.0,
        }
    }
}

/// Half of the eight sides from which balls touch a point; the others are opposite.
const SIDES: [[f32; 2]; 4] = [[1.0, 0.0], [FRAC_1_SQRT_2, FRAC_1_SQRT_2], [0.0, 1.0], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2]];
/// How far beside a point others say how high the thing is there, metres.
const TOP_REACH_M: f32 = 0.4;
/// Points handed to a thread at once.
const CHUNK: usize = 512;

/// The slender things of a cloud.
pub(super) struct Slender<'a> {
    positions: &'a [[f32; 3]],
    params: &'a SlenderParams,
    /// Height above the lowest point near by, NaN for points of anything else.
    heights: Vec<f32>,
    /// As [`super::spacing::pulse_spacing`] gives it.
    spacing: &'a [f32],
}

impl<'a> Slender<'a> {
    /// Tells the points of slender things: neither ground, vegetation nor building (class 6; what has no class and is
    /// higher than what stands), high enough above the lowest point near by, and passed by pulses on all sides. `lowest` is [`super::cells::lowest_near`].
    pub(super) fn find(
        positions: &'a [[f32; 3]],
        kinds: &[Kind],
        attributes: &Attributes,
        (lowest, spacing): (&Cells<f32>, &'a [f32]),
        needles: &FreeSegments,
        params: &'a SlenderParams,
        control: &Control<'_>,
    ) -> Result<Self> {
        let stop = Stop::new(control);
        let classes = attributes.classification.as_deref();
        let class = |row: usize| classes.and_then(|classes| classes.get(row)).copied();
        let passed = |p: [f32; 3], [x, y]: [f32; 2]| {
            let tangent = Tangent { point: p, inward: [x, y, 0.0], margin: 0.0 };
            needles.smallest_tangent_ball(&tangent, params.gap).is_some()
        };
        let height = |(row, (&p, kind)): (usize, (&[f32; 3], &Kind))| {
            let height = lowest.get(cell(p)).map_or(0.0, |lowest| p[2] - lowest);
            // without a class what is high up may be the parapet of a roof
            let may_be_building = match class(row) {
                Some(6) => true,
                None | Some(0) => height > params.standing_height,
                Some(_) => false,
            };
            if !matches!(kind, Kind::Other | Kind::Later) || may_be_building || stop.is_set() {
                return f32::NAN;
            }
            let below = [p[0], p[1], p[2] - params.lowering.min(height / 2.0)];
            let is_slender = height >= params.least_height
                && SIDES.iter().all(|&side| passed(below, side) && passed(below, side.map(|v| -v)));
            if is_slender { height } else { f32::NAN }
        };
        let heights = positions.par_iter().zip(kinds).enumerate().with_min_len(CHUNK).map(height).collect();
        stop.check()?;
        control.advance(positions.len());
        Ok(Self { positions, params, heights, spacing })
    }

    /// Cuts the radii at slender things, and says of how many balls.
    pub(super) fn limit(&self, bounds: &mut RadiusBounds) -> usize {
        let rows = (0..self.heights.len()).filter(|&row| !self.heights[row].is_nan());
        rows.map(|row| bounds.limit(row, self.params.radius_spacings * self.spacing[row])).count()
    }

    /// Adds balls that fill what stands on the ground, and says how many.
    ///
    /// Balls hang below each other, at each point from the highest point of the thing close by down to the ground, and midway
    /// between points that have no other between them; each as large as the pulses leave it.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn fill(&self, balls: &mut MedialBalls, needles: &FreeSegments, control: &Control<'_>) -> Result<usize> {
        let standing = (0..self.heights.len()).filter(|&row| self.stands(row)).collect();
        let rows = one_in_each_cell(self.positions, standing, self.params.spacing / 2.0);
        let places: Vec<[f32; 3]> = rows.iter().map(|&row| self.positions[row]).collect();
        let index = NeighborIndex::new(&places, control)?;
        let stop = Stop::new(control);
        let place = |number: usize| Place {
            position: places[number],
            height: self.heights[rows[number]],
            spacing: self.spacing[rows[number]],
        };
        let fills = |number: usize| {
            let mut near = Vec::new();
            index.within_radius(places[number], self.params.reach, |found| near.push(place(found.index as usize)));
            near.retain(|other| other.position != places[number]);
            self.fills(&place(number), &near, needles).into_iter().map(move |ball| (number, ball))
        };
        let numbers = (0..rows.len()).into_par_iter().with_min_len(CHUNK);
        let found: Vec<_> = numbers.filter(|_| !stop.is_set()).flat_map_iter(fills).collect();
        stop.check()?;
        for &(number, (center, radius)) in &found {
            balls.push(rows[number], center, radius, PULSE_TOUCH);
        }
        Ok(found.len())
    }

    /// Whether point `row` is part of what [`Slender::fill`] fills.
    pub(super) fn stands(&self, row: usize) -> bool {
        self.heights[row] <= self.params.standing_height
    }

    /// The balls that fill at a place and between it and those next to it.
    fn fills(&self, place: &Place, near: &[Place], needles: &FreeSegments) -> Vec<([f32; 3], f32)> {
        let p = place.position;
        let beside: Vec<_> = near.iter().map(|other| other.position).collect();
        let close_by = beside.iter().filter(|q| apart(p, **q) < TOP_REACH_M);
        let top = close_by.fold(p[2], |top, q| top.max(q[2]));
        let ground = p[2] - place.height;
        let chain = Chain { radius: self.params.standing_spacings * place.spacing, spacing: self.params.spacing };
        let mut balls: Vec<_> = chain.below([p[0], p[1], top], ground, needles).collect();
        for number in neighbors_after(p, &beside, self.params.spacing, 1.0) {
            let q = beside[number];
            let middle = [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0, p[2].max(q[2])];
            balls.extend(chain.below(middle, ground.min(q[2] - near[number].height), needles));
        }
        balls
    }
}

/// A point of something that stands.
struct Place {
    position: [f32; 3],
    height: f32,
    /// Between pulses about it, metres.
    spacing: f32,
}
