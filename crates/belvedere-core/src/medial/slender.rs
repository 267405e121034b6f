//! Things so slender that pulses pass them closely on both sides: fences, railings, garden walls, wires, masts.
//!
//! Their points have no surface about them that a normal could be taken from, and the balls there fill the air beside
//! them.

use super::cells::cell;
use super::chains::Chain;
use super::marking_rule::{MarkingRule, Phase};
use super::marks::{Cap, Fill, Marks};
use super::midway::{distance_in_plan, neighbors_after, one_in_each_cell};
use super::survey::Survey;
use crate::neighbors::{NeighborIndex, Tangent};
use belvedere_data::Result;
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::{Control, Stop};
use rayon::prelude::*;
use std::f32::consts::FRAC_1_SQRT_2;

/// Parameters of slender things: detection and representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlenderParams {
    /// Radius of the balls that decide whether a thing is slender, metres, above 0. It is slender if pulses enter all
    /// balls of this radius that touch its point from eight sides; into a wall, a car or a roof one of them can grow
    /// on. Default 0.5: at eight pulses a square metre, some pulse passes within that of most points of fences. 0.35
    /// finds fewer.
    pub gap: f32,
    /// Depth below its point at which the balls touch, metres, 0 or more; never below the lowest point near by. Default
    /// 0.7: more than the gap, so that pulses that end beside the point, on the same roof, do not count.
    pub lowering: f32,
    /// Maximum radius of the balls at its points, in spacings of pulses, above 0. Default 0.32: pulses pass closer on
    /// both sides.
    pub radius_spacings: f32,
    /// Minimum height above the lowest point near by, metres, 0 or more. Default 0.3: kerbs and noise are lower.
    pub min_height: f32,
    /// Height up to which it stands on the ground, rather than hang in the air, metres. Default 2.5: higher fences are
    /// rare, lower wires too.
    pub standing_height: f32,
    /// Maximum radius of the balls that fill standing things, in spacings of pulses, above 0. Default 0.47: space that
    /// pulses passed cannot be blocked, and 0.32 lets more through.
    pub standing_spacings: f32,
    /// Distance of these balls below each other, metres, above 0. Default 0.2.
    pub spacing: f32,
    /// Maximum distance of two points of one thing between which it is filled as well, metres, 0 or more. Default 1:
    /// twice the distance of most hits along a fence; wider gaps may be gates.
    pub reach: f32,
}

impl Default for SlenderParams {
    fn default() -> Self {
        Self {
            gap: 0.5,
            lowering: 0.7,
            radius_spacings: 0.32,
            min_height: 0.3,
            standing_height: 2.5,
            standing_spacings: 0.47,
            spacing: 0.2,
            reach: 1.0,
        }
    }
}

/// Half of the eight sides from which balls touch a point; the others are opposite.
const SIDES: [[f32; 2]; 4] = [[1.0, 0.0], [FRAC_1_SQRT_2, FRAC_1_SQRT_2], [0.0, 1.0], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2]];
/// Radius around a point in which the top of the thing is searched, metres.
const TOP_REACH_M: f32 = 0.4;
/// Points handed to a thread at once.
const CHUNK: usize = 512;

impl MarkingRule for SlenderParams {
    fn stage(&self) -> Option<(Phase, &'static str)> {
        Some((Phase::Points, "finding thin objects"))
    }

    /// Returns caps at all slender things, and fills of those that stand on the ground. Fills are balls below each
    /// other, from the highest point of the thing close by down to the ground. They stand at each point, and midway
    /// between neighbouring points.
    fn marks(&self, survey: &Survey<'_>, _: &MedialBalls, control: &Control<'_>) -> Result<Marks> {
        let heights = self.heights(survey, control)?;
        let rows = (0..heights.len()).filter(|&row| !heights[row].is_nan());
        let caps: Vec<Cap> = rows
            .map(|row| Cap {
                is_claimed: heights[row] <= self.standing_height,
                ..Cap::tangent(row, self.radius_spacings * survey.spacing[row])
            })
            .collect();
        let standing = caps.iter().filter(|cap| cap.is_claimed).map(|cap| cap.row).collect();
        let fills = self.fills(survey, &heights, standing, control)?;
        Ok(Marks { counts: vec![("points_on_thin_objects", caps.len())], caps, fills, ..Marks::default() })
    }

    fn fills_name(&self) -> &'static str {
        "balls_in_thin_objects"
    }
}

impl SlenderParams {
    /// Returns the height of each point of a slender object above the lowest point near it, NaN for all others.
    ///
    /// Points of ground, vegetation and buildings belong to none. A building has class 6, or has no class and is higher
    /// than objects on the ground. Points also need a minimum height, and pulses that pass them on every side.
    fn heights(&self, survey: &Survey<'_>, control: &Control<'_>) -> Result<Vec<f32>> {
        let stop = Stop::new(control);
        let positions = survey.positions();
        let passed = |p: [f32; 3], [x, y]: [f32; 2]| {
            let tangent = Tangent { point: p, inward: [x, y, 0.0], margin: 0.0 };
            survey.free_segments.smallest_tangent_ball(&tangent, self.gap).is_some()
        };
        let height = |(row, &p): (usize, &[f32; 3])| {
            let height = survey.lowest.get(cell(p)).map_or(0.0, |lowest| p[2] - lowest);
            // without a class what is high up may be the parapet of a roof
            let may_be_building = match survey.class(row) {
                Some(6) => true,
                None | Some(0) => height > self.standing_height,
                Some(_) => false,
            };
            if !survey.is_solid(row) || may_be_building || stop.is_set() {
                return f32::NAN;
            }
            let below = [p[0], p[1], p[2] - self.lowering.min(height / 2.0)];
            let is_slender = height >= self.min_height
                && SIDES.iter().all(|&side| passed(below, side) && passed(below, side.map(|v| -v)));
            if is_slender { height } else { f32::NAN }
        };
        let heights = positions.par_iter().enumerate().with_min_len(CHUNK).map(height).collect();
        stop.check()?;
        control.advance(positions.len());
        Ok(heights)
    }

    /// The fills of objects on the ground, whose points are the rows `standing`.
    fn fills(
        &self,
        survey: &Survey<'_>,
        heights: &[f32],
        standing: Vec<usize>,
        control: &Control<'_>,
    ) -> Result<Vec<Fill>> {
        let rows = one_in_each_cell(survey.positions(), standing, self.spacing / 2.0);
        let places: Vec<[f32; 3]> = rows.iter().map(|&row| survey.positions()[row]).collect();
        let index = NeighborIndex::new(&places, control)?;
        let stop = Stop::new(control);
        let place = |number: usize| {
            let row = rows[number];
            Place { row, position: places[number], height: heights[row], spacing: survey.spacing[row] }
        };
        let fills = |number: usize| {
            let mut near = Vec::new();
            index.within_radius(places[number], self.reach, |found| near.push(place(found.index as usize)));
            near.retain(|other| other.position != places[number]);
            self.fills_at(&place(number), &near)
        };
        let numbers = (0..rows.len()).into_par_iter().with_min_len(CHUNK);
        let found = numbers.filter(|_| !stop.is_set()).flat_map_iter(fills).collect();
        stop.check()?;
        Ok(found)
    }

    /// The fills at a place and between it and those next to it.
    fn fills_at(&self, place: &Place, near: &[Place]) -> Vec<Fill> {
        let p = place.position;
        let beside: Vec<_> = near.iter().map(|other| other.position).collect();
        let close_by = beside.iter().filter(|q| distance_in_plan(p, **q) < TOP_REACH_M);
        let top = close_by.fold(p[2], |top, q| top.max(q[2]));
        let ground = p[2] - place.height;
        let chain = Chain { row: place.row, radius: self.standing_spacings * place.spacing, spacing: self.spacing };
        let mut fills: Vec<_> = chain.fills_below([p[0], p[1], top], ground).collect();
        for number in neighbors_after(p, &beside, self.spacing, 1.0) {
            let q = beside[number];
            let middle = [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0, p[2].max(q[2])];
            fills.extend(chain.fills_below(middle, ground.min(q[2] - near[number].height)));
        }
        fills
    }
}

/// A point of something that stands.
struct Place {
    row: usize,
    position: [f32; 3],
    height: f32,
    /// Between pulses about it, metres.
    spacing: f32,
}
