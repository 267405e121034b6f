//! Walls that no pulse reached, told by the edges of the roofs above them.
//!
//! Behind balconies and on walls along the flight there are hardly any points, and balls from the far side of a house bulge out
//! between them. A house does not reach beyond its roof, so that what comes from within is cut below the roof's edge.

use super::bounds::Kind;
use super::cells::{Cells, cell};
use super::thin_surfaces::{Gap, widest_gap};
use crate::neighbors::NeighborIndex;
use crate::normals::OrientedCloud;
use belvedere_data::Result;
use belvedere_data::balls::{MedialBalls, NO_TOUCH, PULSE_TOUCH};
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::{dot, sub};
use rayon::prelude::*;

/// Least upward part of the normal of a roof: 60° of slope.
pub(super) const LEAST_UP: f32 = 0.5;
/// How far below a point its neighbours may lie and still be of the same roof, metres.
const SAME_ROOF: f32 = 0.6;
/// Least horizontal distance of neighbours that tell a direction, metres: above noise.
const LEAST_DISTANCE: f32 = 0.05;
/// Widest gap of an edge, radians: half a radian more than at a corner of 90°. Beyond it a point stands alone.
const WIDEST_GAP: f32 = 5.2;
/// Distance of a wall from the roof and from the ground at which it is taken to begin, metres.
const ENDS: f32 = 0.3;

/// How balls are cut below the edges of roofs, and where they reach above the roof. Defaults were chosen on three simulated towns of seed 7 at 8 pulses per m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoofEdgeParams {
    /// Distance within which a point on a roof has no neighbour on one side if it lies at the edge, in spacings of pulses, above 0. Default
    /// 3. 4.5 finds fewer edges and loses a third of the gain.
    pub around_spacings: f32,
    /// Least angle without a neighbour at an edge, radians. Default 2.6: a straight edge leaves π less what the raggedness
    /// of its points takes.
    pub least_gap: f32,
    /// Least height of an edge above the lowest point near by, metres, above 0. Default 2.
    pub least_height: f32,
    /// How far beyond its outermost points a roof is taken to reach, in spacings of pulses, 0 or more. Default 0.3. 0.9 gains nothing
    /// more on facades and lets more through houses.
    pub outside_spacings: f32,
    /// Distance of the places on a wall below each other, metres, above 0. Default 0.5.
    pub spacing: f32,
    /// How far a ball may reach beyond these places, metres, above 0. Default 0.05.
    pub penetration: f32,
    /// Least cosine between the way a wall faces and the way from a ball's centre to the place it touches. Default 0.85: at 0.7
    /// houses with few points on their walls begin to leak, at 0.9 a fifth of the gain is lost.
    pub least_cosine: f32,
    /// Radius below which balls are not cut, metres, above 0. Default 0.5.
    pub least_radius: f32,
}

impl Default for RoofEdgeParams {
    fn default() -> Self {
        Self {
            around_spacings: 3.0,
            least_gap: 2.6,
            least_height: 2.0,
            outside_spacings: 0.3,
            spacing: 0.5,
            penetration: 0.05,
            least_cosine: 0.85,
            least_radius: 0.5,
        }
    }
}

/// Places on the walls below the edges of roofs.
pub(super) struct RoofEdges {
    places: Vec<[f32; 3]>,
    /// The way each of them faces, a unit vector east and north.
    outward: Vec<[f32; 2]>,
    index: NeighborIndex,
}

impl RoofEdges {
    /// Those of `oriented`, whose points are of these `kinds` and held by `index`; `lowest` are the lowest points near by,
    /// and `spacing` is that of the pulses at each point.
    ///
    /// # Errors
    /// Those of [`NeighborIndex::new`].
    pub(super) fn find(
        oriented: &OrientedCloud,
        kinds: &[Kind],
        index: &NeighborIndex,
        (lowest, spacing): (&Cells<f32>, &[f32]),
        params: &RoofEdgeParams,
        control: &Control<'_>,
    ) -> Result<Self> {
        let stop = Stop::new(control);
        let positions = oriented.positions();
        let below = |row: usize| -> Vec<([f32; 3], [f32; 2])> {
            let p = positions[row];
            let is_roof = kinds.get(row) == Some(&Kind::Other) && oriented.normals()[row][2] >= LEAST_UP;
            let Some(low) =
                lowest.get(cell(p)).filter(|low| is_roof && p[2] - low >= params.least_height && !stop.is_set())
            else {
                return Vec::new();
            };
            let is_beside = |other: usize| {
                let [x, y, up] = sub(positions[other], p);
                let solid = matches!(kinds.get(other), Some(Kind::Other | Kind::Later));
                solid && up > -SAME_ROOF && x.hypot(y) > LEAST_DISTANCE
            };
            let Gap { width, middle, .. } =
                widest_gap(positions, index, p, params.around_spacings * spacing[row], is_beside);
            if !(params.least_gap..=WIDEST_GAP).contains(&width) {
                return Vec::new();
            }
            let outward = [middle.cos(), middle.sin()];
            let [x, y] = [0, 1].map(|axis| p[axis] + params.outside_spacings * spacing[row] * outward[axis]);
            let heights = (0u16..).map(|k| p[2] - ENDS - f32::from(k) * params.spacing);
            heights.take_while(|&z| z > low + ENDS).map(|z| ([x, y, z], outward)).collect()
        };
        let (places, outward): (Vec<_>, Vec<_>) = (0..positions.len()).into_par_iter().flat_map_iter(below).unzip();
        stop.check()?;
        Ok(Self { index: NeighborIndex::new(&places, control)?, places, outward })
    }

    /// Cuts `balls`, row i of which is the interior ball of point i of `oriented`, where they come from within and reach out
    /// of a wall; returns how many. The result depends on neither the order of points nor the number of threads.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn cut(
        &self,
        balls: &mut MedialBalls,
        oriented: &OrientedCloud,
        params: &RoofEdgeParams,
        control: &Control<'_>,
    ) -> Result<usize> {
        let stop = Stop::new(control);
        let (positions, normals) = (oriented.positions(), oriented.normals());
        let radii: Vec<f32> = (0..balls.len())
            .into_par_iter()
            .map(|row| {
                let is_usable = balls.touch[row] != NO_TOUCH && balls.radii[row] > params.least_radius;
                if is_usable && !stop.is_set() {
                    self.radius(positions[row], normals[row], balls.radii[row], params)
                } else {
                    balls.radii[row]
                }
            })
            .collect();
        stop.check()?;
        Ok(shrink(balls, oriented, &radii))
    }

    /// What is left of the radius of the ball at a point with this outward normal.
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
            if x * east + y * north > params.least_cosine * touching {
                least = least.min(touching + params.penetration);
            }
        });
        least.max(params.least_radius)
    }
}

/// Shrinks `balls`, row i of which is the interior ball of point i of `oriented`, to `radii` where these are less; returns how many.
pub(super) fn shrink(balls: &mut MedialBalls, oriented: &OrientedCloud, radii: &[f32]) -> usize {
    let mut count = 0;
    for (row, &radius) in radii.iter().enumerate() {
        if !(radius < balls.radii[row]) {
            continue;
        }
        count += 1;
        let (p, n) = (oriented.positions()[row], oriented.normals()[row]);
        balls.radii[row] = radius;
        balls.centers[row] = std::array::from_fn(|i| p[i] - n[i] * radius);
        balls.touch[row] = PULSE_TOUCH;
        balls.separation_angles[row] = f32::NAN;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medial::cells::lowest_near;

    const HEIGHT: f32 = 9.0;
    /// Half the width of the house, metres.
    const HALF: f32 = 4.0;

    /// A flat roof over level ground, points 0.25 m apart, and one point on the west wall; nothing on the east wall.
    fn house() -> (OrientedCloud, Vec<Kind>) {
        let (mut positions, mut kinds) = (vec![[-HALF, 0.0, 4.5]], vec![Kind::Other]);
        let mut normals = vec![[-1.0, 0.0, 0.0]];
        for i in 0i16..80 {
            for k in 0i16..80 {
                let [x, y] = [i, k].map(|number| (f32::from(number) - 39.5) * 0.25);
                let on_roof = x.abs() < HALF && y.abs() < HALF;
                positions.push([x, y, if on_roof { HEIGHT } else { 0.0 }]);
                kinds.push(if on_roof { Kind::Other } else { Kind::Ground });
                normals.push([0.0, 0.0, 1.0]);
            }
        }
        (OrientedCloud::with_known_normals(positions, normals).unwrap(), kinds)
    }

    fn edges(oriented: &OrientedCloud, kinds: &[Kind]) -> RoofEdges {
        let index = NeighborIndex::new(oriented.positions(), &Control::none()).unwrap();
        let lowest = lowest_near(oriented.positions());
        RoofEdges::find(oriented, kinds, &index, (&lowest, &[0.33; 6401]), &RoofEdgeParams::default(), &Control::none())
            .unwrap()
    }

    /// One ball at the first point, of this radius.
    fn ball(oriented: &OrientedCloud, radius: f32) -> MedialBalls {
        let mut balls = MedialBalls::default();
        let (p, n) = (oriented.positions()[0], oriented.normals()[0]);
        balls.push(0, std::array::from_fn(|i| p[i] - radius * n[i]), radius, 7);
        balls
    }

    #[test]
    fn walls_stand_below_the_outline_of_the_roof() {
        let (oriented, kinds) = house();
        let edges = edges(&oriented, &kinds);
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
        let (oriented, kinds) = house();
        let params = RoofEdgeParams::default();
        let mut balls = ball(&oriented, 5.0);
        assert_eq!(edges(&oriented, &kinds).cut(&mut balls, &oriented, &params, &Control::none()).unwrap(), 1);
        // places every 0.25 m by 0.5 m leave bulges below a centimetre
        let reach = -HALF + 2.0 * balls.radii[0];
        assert!((reach - HALF).abs() < 0.025 + params.penetration + 0.01, "it reaches to {reach}");
        assert_eq!(balls.touch[0], PULSE_TOUCH);
    }

    #[test]
    fn balls_that_end_within_the_house_or_lie_outside_stay() {
        let (oriented, kinds) = house();
        let edges = edges(&oriented, &kinds);
        let mut within = ball(&oriented, 3.0);
        assert_eq!(edges.cut(&mut within, &oriented, &RoofEdgeParams::default(), &Control::none()).unwrap(), 0);
        // a lean-to against the east wall: its ball comes through that wall from outside
        let lean_to = OrientedCloud::with_known_normals(vec![[HALF + 2.0, 0.0, 2.0]], vec![[1.0, 0.0, 0.0]]).unwrap();
        let mut outside = ball(&lean_to, 2.0);
        assert_eq!(edges.cut(&mut outside, &lean_to, &RoofEdgeParams::default(), &Control::none()).unwrap(), 0);
    }
}
