//! Walls that no pulse reached, found by the edges of the roofs above them.
//!
//! Behind balconies and on walls along the flight there are hardly any points, and balls from the far side of a house
//! bulge out between them. A house does not reach beyond its roof, so that balls from inside are cut below the roof's
//! edge.

use super::cells::cell;
use super::kinds::Kind;
use super::marking_rule::{MarkingRule, Phase};
use super::marks::{Marks, cuts_of};
use super::roof_tops::{MIN_UP, RoofTops};
use super::survey::Survey;
use super::thin_surfaces::{Gap, widest_gap};
use crate::neighbors::NeighborIndex;
use belvedere_data::Result;
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::{dot, sub};
use rayon::prelude::*;

/// Maximum depth of neighbours below a point of the same roof, metres.
const SAME_ROOF: f32 = 0.6;
/// Minimum horizontal distance of neighbours that give a direction, metres: above noise.
const MIN_DISTANCE: f32 = 0.05;
/// Widest gap of an edge, radians: half a radian more than at a corner of 90°. Beyond it a point stands alone.
const WIDEST_GAP: f32 = 5.2;
/// Distance of a wall from the roof and from the ground at which it is taken to begin, metres.
const ENDS: f32 = 0.3;

/// Parameters of cutting balls below the edges of roofs and above roofs. Defaults were chosen on three simulated towns
/// of seed 7 at 8 pulses per m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoofEdgeParams {
    /// Distance within which a point on a roof has no neighbour on one side if it lies at the edge, in spacings of
    /// pulses, above 0. Default 3: with 4.5 fewer edges are found and a third of the gain is lost.
    pub around_spacings: f32,
    /// Minimum angle without a neighbour at an edge, radians. Default 2.6: a straight edge leaves π less the raggedness
    /// of its points.
    pub min_gap: f32,
    /// Minimum height of an edge above the lowest point near by, metres, above 0. Default 2.
    pub min_height: f32,
    /// Distance by which a roof extends beyond its outermost points, in spacings of pulses, 0 or more. Default 0.3. 0.9
    /// gains nothing more on facades and lets more through houses.
    pub outside_spacings: f32,
    /// Distance of the places on a wall below each other, metres, above 0. Default 0.5.
    pub spacing: f32,
    /// Maximum penetration of a ball beyond these places, metres, above 0. Default 0.05.
    pub penetration: f32,
    /// Minimum cosine between the direction that a wall faces and that from a ball's centre to the place it touches.
    /// Default 0.85: at 0.7 houses with few points on their walls begin to leak, at 0.9 a fifth of the gain is lost.
    pub min_cosine: f32,
    /// Radius below which balls are not cut, metres, above 0. Default 0.5.
    pub min_radius: f32,
}

impl Default for RoofEdgeParams {
    fn default() -> Self {
        Self {
            around_spacings: 3.0,
            min_gap: 2.6,
            min_height: 2.0,
            outside_spacings: 0.3,
            spacing: 0.5,
            penetration: 0.05,
            min_cosine: 0.85,
            min_radius: 0.5,
        }
    }
}

impl MarkingRule for RoofEdgeParams {
    fn stage(&self) -> Option<(Phase, &'static str)> {
        Some((Phase::Balls, "cutting at roof edges"))
    }

    fn marks(&self, survey: &Survey<'_>, balls: &MedialBalls, control: &Control<'_>) -> Result<Marks> {
        let edges = RoofEdges::find(survey, self, control)?;
        let tops = RoofTops::new(survey.oriented, &survey.highest, self.penetration, self.min_radius);
        let (positions, normals) = (survey.positions(), survey.oriented.normals());
        let cuts = cuts_of(balls, self.min_radius, control, |row| {
            let (point, normal) = (positions[row], normals[row]);
            let radius = edges.radius(point, normal, balls.radii[row], self);
            let center = if radius < balls.radii[row] {
                std::array::from_fn(|i| point[i] - normal[i] * radius)
            } else {
                balls.centers[row]
            };
            let is_usable = radius > self.min_radius;
            if is_usable { tops.radius(center, radius, point[2], normal[2]) } else { radius }
        })?;
        Ok(Marks { counts: vec![("balls_cut_at_roof_edges", cuts.len())], cuts, ..Marks::default() })
    }
}

/// Places on the walls below the edges of roofs.
struct RoofEdges {
    places: Vec<[f32; 3]>,
    /// The way each of them faces, a unit vector east and north.
    outward: Vec<[f32; 2]>,
    index: NeighborIndex,
}

impl RoofEdges {
    /// Finds the roof edges of a survey.
    ///
    /// # Errors
    /// Those of [`NeighborIndex::new`].
    fn find(survey: &Survey<'_>, params: &RoofEdgeParams, control: &Control<'_>) -> Result<Self> {
        let stop = Stop::new(control);
        let positions = survey.positions();
        let below = |row: usize| -> Vec<([f32; 3], [f32; 2])> {
            let p = positions[row];
            let is_roof = survey.kinds.get(row) == Some(&Kind::Other) && survey.oriented.normals()[row][2] >= MIN_UP;
            let is_high = |low: &f32| is_roof && p[2] - low >= params.min_height && !stop.is_set();
            let Some(low) = survey.lowest.get(cell(p)).filter(is_high) else { return Vec::new() };
            let is_beside = |other: usize| {
                let [x, y, up] = sub(positions[other], p);
                survey.is_solid(other) && up > -SAME_ROOF && x.hypot(y) > MIN_DISTANCE
            };
            let around = params.around_spacings * survey.spacing[row];
            let Gap { width, middle, .. } = widest_gap(positions, survey.index, p, around, is_beside);
            if !(params.min_gap..=WIDEST_GAP).contains(&width) {
                return Vec::new();
            }
            let outward = [middle.cos(), middle.sin()];
            let beyond = params.outside_spacings * survey.spacing[row];
            let [x, y] = [0, 1].map(|axis| p[axis] + beyond * outward[axis]);
            let heights = (0u16..).map(|k| p[2] - ENDS - f32::from(k) * params.spacing);
            heights.take_while(|&z| z > low + ENDS).map(|z| ([x, y, z], outward)).collect()
        };
        let (places, outward): (Vec<_>, Vec<_>) = (0..positions.len()).into_par_iter().flat_map_iter(below).unzip();
        stop.check()?;
        Ok(Self { index: NeighborIndex::new(&places, control)?, places, outward })
    }

    /// Returns the remaining radius of the ball at a point with this outward normal.
    fn radius(&self, point: [f32; 3], normal: [f32; 3], radius: f32, params: &RoofEdgeParams) -> f32 {
        // as in shrinking: the noise-free ball is tangent below the point
        let p: [f32; 3] = std::array::from_fn(|i| point[i] - params.penetration * normal[i]);
        let center = std::array::from_fn(|i| point[i] - radius * normal[i]);
        let mut least = radius;
        self.index.within_radius(center, radius - params.penetration, |found| {
            let place = found.index as usize;
            let chord = sub(self.places[place], p);
            let inward = -dot(chord, normal);
            if !(inward > 0.0) {
                return;
            }
            let touching = dot(chord, chord) / (2.0 * inward);
            let [x, y] = [0, 1].map(|i| chord[i] + touching * normal[i]);
            let [east, north] = self.outward[place];
            if x * east + y * north > params.min_cosine * touching {
                least = least.min(touching + params.penetration);
            }
        });
        least.max(params.min_radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medial::survey::tests::with_survey;
    use crate::normals::OrientedCloud;

    const HEIGHT: f32 = 9.0;
    /// Half the width of the house, metres.
    const HALF: f32 = 4.0;

    /// A flat roof over level ground, points 0.25 m apart, and one point on the west wall; nothing on the east wall.
    fn house() -> (OrientedCloud, Vec<u8>) {
        let (mut positions, mut classes) = (vec![[-HALF, 0.0, 4.5]], vec![1]);
        let mut normals = vec![[-1.0, 0.0, 0.0]];
        for i in 0i16..80 {
            for k in 0i16..80 {
                let [x, y] = [i, k].map(|number| (f32::from(number) - 39.5) * 0.25);
                let on_roof = x.abs() < HALF && y.abs() < HALF;
                positions.push([x, y, if on_roof { HEIGHT } else { 0.0 }]);
                classes.push(if on_roof { 1 } else { 2 });
                normals.push([0.0, 0.0, 1.0]);
            }
        }
        (OrientedCloud::with_known_normals(positions, normals).unwrap(), classes)
    }

    /// Places below the roof edges, and the remaining radius of a ball of this radius at the first point of `of`.
    fn edges_and_radius(roof: &OrientedCloud, classes: Vec<u8>, of: &OrientedCloud, radius: f32) -> (RoofEdges, f32) {
        let params = RoofEdgeParams::default();
        let edges = with_survey(roof, Some(classes), &[], |mut survey| {
            survey.spacing.fill(0.33);
            RoofEdges::find(&survey, &params, &Control::none()).unwrap()
        });
        let left = edges.radius(of.positions()[0], of.normals()[0], radius, &params);
        (edges, left)
    }

    #[test]
    fn walls_stand_below_the_outline_of_the_roof() {
        let (oriented, classes) = house();
        let (edges, _) = edges_and_radius(&oriented, classes, &oriented, 1.0);
        assert!(!edges.places.is_empty());
        for (place, outward) in edges.places.iter().zip(&edges.outward) {
            // the outermost points lie 0.125 m within the walls, 0.1 m is added; at corners 0.1 m along the diagonal
            let off = place[0].abs().max(place[1].abs()) - HALF;
            assert!(off.abs() < 0.06, "{place:?}");
            assert!(place[0] * outward[0] + place[1] * outward[1] > 0.0, "{place:?} faces {outward:?}");
        }
    }

    #[test]
    fn a_ball_from_the_far_side_ends_at_the_wall_that_no_pulse_reached() {
        let (oriented, classes) = house();
        let (_, radius) = edges_and_radius(&oriented, classes, &oriented, 5.0);
        // places every 0.25 m by 0.5 m leave bulges below a centimetre
        let reach = -HALF + 2.0 * radius;
        let penetration = RoofEdgeParams::default().penetration;
        assert!((reach - HALF).abs() < 0.025 + penetration + 0.01, "it reaches to {reach}");
    }

    #[test]
    fn balls_that_end_within_the_house_or_lie_outside_stay() {
        let (oriented, classes) = house();
        assert_eq!(edges_and_radius(&oriented, classes.clone(), &oriented, 3.0).1, 3.0);
        // a lean-to against the east wall: its ball comes through that wall from outside
        let lean_to = OrientedCloud::with_known_normals(vec![[HALF + 2.0, 0.0, 2.0]], vec![[1.0, 0.0, 0.0]]).unwrap();
        assert_eq!(edges_and_radius(&oriented, classes, &lean_to, 2.0).1, 2.0);
    }
}
