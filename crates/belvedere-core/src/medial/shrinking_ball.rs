//! The shrinking ball: from oriented points to medial balls.

use crate::neighbors::{Neighbor, NeighborIndex, Tangent};
use crate::normals::OrientedCloud;
use belvedere_data::balls::{LIMIT_TOUCH, MedialBalls, NO_TOUCH, Side};
use belvedere_data::control::Control;
use belvedere_data::vector::{dot, sub};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::Serialize;

/// Stopping criterion of a shrinking ball in the presence of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShrinkMethod {
    /// The heuristics of the paper, as its reference program masbcpp has them: the ball before the one whose separation
    /// angle is too small. Such a ball may hold points.
    Angles {
        /// The paper's t_a: the first smaller ball is refused, and the ball stays at its initial radius, if its
        /// separation angle is below this. Radians, 0 to π, 0 switches the test off; masbcpp: 32°.
        first_separation_angle: f64,
        /// The paper's t_b: a later ball is refused, and its predecessor kept, if its separation angle is below this.
        /// Radians, 0 to π, 0 switches the test off; masbcpp: 20°.
        next_separation_angle: f64,
    },
    /// Bounded penetration: the largest ball that no point enters by more than `penetration`.
    Tau {
        /// Metres, above 0 and below the initial radius; two to three times the noise along the normals: 0.05 to 0.1
        /// for airborne scans, 0.01 to 0.02 for terrestrial ones.
        penetration: f32,
    },
}

/// Parameters of [`shrink`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShrinkParams {
    /// Stopping criterion.
    pub method: ShrinkMethod,
    /// Radius every ball starts with, metres, up to 100 000.
    pub initial_radius: f32,
    /// Maximum radius, metres, above 0; +∞ for no limit. A larger ball is replaced by the one of this radius within it
    /// that is tangent at the same point, with the same touch and separation angle. An interior ball of
    /// [`ShrinkMethod::Tau`] that met no point gets this radius too. Nothing lies behind its surface, as behind the
    /// outer walls of a scanned room, and that surface blocks.
    pub max_radius: f32,
    /// Maximum radius of interior balls of [`ShrinkMethod::Tau`] in point spacings at their points, above 0; +∞ for no
    /// such limit. Where points are dense, balls need not be thick to leave no gap, and thick ones stand out of thin
    /// things. The penetration is then at most a quarter of the limit.
    pub max_spacings: f32,
}

impl ShrinkParams {
    /// The paper's method with the values of its reference program: 32°, 20°, 200 m.
    #[must_use]
    pub fn angles() -> Self {
        Self {
            method: ShrinkMethod::Angles {
                first_separation_angle: 32f64.to_radians(),
                next_separation_angle: 20f64.to_radians(),
            },
            initial_radius: 200.0,
            max_radius: f32::INFINITY,
            max_spacings: f32::INFINITY,
        }
    }

    /// Balls of bounded penetration: 0.05 m, started at 30 m, which is more than half the thickness of nearly every
    /// building, and cut down to half a metre.
    ///
    /// The limit is for airborne scans, where large balls bulge out through facades with few returns. It was measured
    /// on simulated towns of 11 points a square metre (seeds 1 and 2, sun 30° high). Unlimited balls call nine tenths
    /// of the sunlit street shadowed. Limits of 2, 1 and 0.5 m leave 46 to 52, 22 to 24 and 9 to 10 %, while missed
    /// shadow grows from 0.1 to 2.4 %. Much sparser clouds need about twice their point spacing.
    #[must_use]
    pub fn tau() -> Self {
        let method = ShrinkMethod::Tau { penetration: 0.05 };
        Self { method, initial_radius: 30.0, max_radius: 0.5, max_spacings: f32::INFINITY }
    }

    /// Returns parameters for clouds that no pulse can carve, such as scans from the ground without the position of the
    /// scanner. Their points lie millimetres apart near the scanner and decimetres apart far from it. Balls are limited
    /// to three spacings, so that they overlap even if scan lines are ten times farther apart than the points on them.
    #[must_use]
    pub fn tau_by_spacing() -> Self {
        Self { max_spacings: 3.0, ..Self::tau() }
    }

    /// Makes the checks of [`shrink`] before a cloud is there.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for the first parameter out of its range.
    pub fn check(&self) -> Result<()> {
        let invalid = |parameter, value: f64, expected| Err(Error::invalid(parameter, value, expected));
        let radius = self.initial_radius;
        if !(radius > 0.0 && radius <= 1e5) {
            return invalid(Parameter::InitialRadius, radius.into(), "above 0 and at most 100000 metres");
        }
        if !(self.max_radius > 0.0) {
            return invalid(Parameter::MaxRadius, self.max_radius.into(), "above 0 metres");
        }
        if !(self.max_spacings > 0.0) {
            return invalid(Parameter::MaxRadius, self.max_spacings.into(), "above 0");
        }
        match self.method {
            ShrinkMethod::Angles { first_separation_angle, next_separation_angle } => {
                for angle in [first_separation_angle, next_separation_angle] {
                    if !(0.0..=std::f64::consts::PI).contains(&angle) {
                        return invalid(Parameter::SeparationAngle, angle.to_degrees(), "0 to 180 degrees");
                    }
                }
            }
            ShrinkMethod::Tau { penetration } => {
                if !(penetration > 0.0 && penetration < radius) {
                    return invalid(Parameter::Penetration, penetration.into(), "above 0 and below the initial radius");
                }
            }
        }
        Ok(())
    }
}

/// Counts of points by outcome of [`shrink`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ShrinkReport {
    /// Balls that touch a second point.
    #[serde(rename = "balls_shrunk")]
    pub shrunk: usize,
    /// Balls that no point bounds and that were cut to the limit of radii.
    #[serde(rename = "balls_of_maximum_radius")]
    pub limited: usize,
    /// Balls that no point bounds and that kept the initial radius. Visibility does not use them unless pulses bound
    /// them.
    #[serde(rename = "balls_without_bound")]
    pub never_shrunk: usize,
    /// Points without a normal, which get no ball: radius 0, no touch.
    #[serde(rename = "points_without_normal")]
    pub without_normal: usize,
}

/// Points handed to a thread at once; their searches share the cache.
const CHUNK: usize = 512;

/// One ball per point of `cloud` on the given side, row i for point i, with counts by outcome.
///
/// `index` must have been built from the cloud's positions. A point without a normal gets a ball of radius 0 at its own
/// place that touches nothing.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters out of range, [`Error::LengthMismatch`] where `index` holds another
/// number of points, [`Error::Cancelled`].
///
/// # Source
/// Ma, Bae & Choi 2012 (shrinking ball); Peters, Ledoux & Biljecki 2015, section 3.1 (angle thresholds). The order of
/// tests and the f32 arithmetic of `Angles` follow masbcpp.
///
/// `Tau` is ours. Consider the ball of radius r that every point q enters by at most τ. It is the noise-free ball of
/// radius r − τ that is tangent τ below p. With p′ = p − τn, therefore, r = τ + min |p′−q|² / 2 n·(p′−q). Nested balls
/// make the minimum independent of any order.
pub fn shrink(
    cloud: &OrientedCloud,
    index: &NeighborIndex,
    side: Side,
    params: &ShrinkParams,
    control: &Control<'_>,
) -> Result<(MedialBalls, ShrinkReport)> {
    params.check()?;
    let (positions, normals) = (cloud.positions(), cloud.normals());
    let count = positions.len();
    if index.len() != count {
        return Err(Error::LengthMismatch { what: "neighbour index", expected: count, found: index.len() });
    }
    let order = index.tree_order();
    let limits_radii = side == Side::Interior && matches!(params.method, ShrinkMethod::Tau { .. });
    let mut in_tree_order = vec![Ball::NONE; count];
    in_tree_order.par_chunks_mut(CHUNK).zip(order.par_chunks(CHUNK)).try_for_each(|(balls, points)| {
        control.check()?;
        let mut near = Vec::new();
        for (ball, &i) in balls.iter_mut().zip(points) {
            let (p, n) = (positions[i as usize], normals[i as usize]);
            let inward = match side {
                Side::Interior => n.map(|v| -v),
                Side::Exterior => n,
            };
            let mut limit = params.max_radius;
            if limits_radii && params.max_spacings.is_finite() {
                limit = limit.min(params.max_spacings * spacing_at(index, p, &mut near));
            }
            *ball = match params.method {
                _ if n == [0.0; 3] => Ball { center: p, ..Ball::NONE },
                ShrinkMethod::Angles { first_separation_angle, next_separation_angle } => {
                    let cosines = [first_separation_angle, next_separation_angle].map(min_cosine);
                    shrink_by_angles(positions, index, p, inward, params.initial_radius, cosines)
                }
                ShrinkMethod::Tau { penetration } if limit < params.max_radius => {
                    let penetration = penetration.min(LIMITED_PENETRATION * limit);
                    shrink_by_penetration(index, p, inward, params.initial_radius.min(limit), penetration)
                }
                ShrinkMethod::Tau { penetration } => {
                    shrink_by_penetration(index, p, inward, params.initial_radius, penetration)
                }
            };
            ball.limit = limit;
        }
        control.advance(points.len());
        Ok(())
    })?;

    let mut balls = MedialBalls {
        centers: vec![[0.0; 3]; count],
        radii: vec![0.0; count],
        source: (0..).take(count).collect(),
        touch: vec![NO_TOUCH; count],
        separation_angles: vec![f32::NAN; count],
    };
    let mut report = ShrinkReport::default();
    let cut = |balls: &mut MedialBalls, i: usize, radius: f32| {
        let (p, share) = (positions[i], radius / balls.radii[i]);
        balls.centers[i] = std::array::from_fn(|axis| p[axis] + (balls.centers[i][axis] - p[axis]) * share);
        balls.radii[i] = radius;
    };
    for (&i, ball) in order.iter().zip(in_tree_order) {
        let i = i as usize;
        balls.centers[i] = ball.center;
        balls.radii[i] = ball.radius;
        balls.touch[i] = ball.touch;
        if ball.touch != NO_TOUCH {
            report.shrunk += 1;
            let cosine = separation_cosine(positions[i], positions[ball.touch as usize], ball.center);
            balls.separation_angles[i] = cosine.acos();
            if ball.radius > ball.limit {
                cut(&mut balls, i, ball.limit);
            }
        } else if ball.radius > 0.0 && limits_radii && ball.limit < params.initial_radius {
            report.limited += 1;
            balls.touch[i] = LIMIT_TOUCH;
            cut(&mut balls, i, ball.limit);
        } else if ball.radius > 0.0 {
            report.never_shrunk += 1;
        } else {
            report.without_normal += 1;
        }
    }
    Ok((balls, report))
}

#[derive(Clone, Copy)]
struct Ball {
    center: [f32; 3],
    radius: f32,
    touch: u32,
    /// Maximum radius after shrinking.
    limit: f32,
}

impl Ball {
    const NONE: Self = Self { center: [0.0; 3], radius: 0.0, touch: NO_TOUCH, limit: f32::INFINITY };
}

/// Share of the limit of a radius that penetration is at most, where spacing limits it.
const LIMITED_PENETRATION: f32 = 0.25;
/// Number of neighbours that give the spacing of points: enough to reach from one scan line to the next.
const SPACING_NEIGHBORS: usize = 12;

/// Minimum point distance that counts, metres. Above and below a tripod, scan lines lie up to 0.03 m apart while the
/// points on them touch; balls must close the gaps between the lines.
const MIN_SPACING: f32 = 0.0135;

/// Distance between points at `p`, metres, if those around it lay in squares; [`MIN_SPACING`] or more.
pub(super) fn spacing_at(index: &NeighborIndex, p: [f32; 3], near: &mut Vec<Neighbor>) -> f32 {
    index.k_nearest(p, SPACING_NEIGHBORS + 1, near);
    let farthest = near.last().map_or(f32::INFINITY, |found| found.distance_squared.sqrt());
    (farthest / (SPACING_NEIGHBORS as f32 / std::f32::consts::PI).sqrt()).max(MIN_SPACING)
}

/// Cosine of ∠pcq, within −1 to 1.
fn separation_cosine(p: [f32; 3], q: [f32; 3], center: [f32; 3]) -> f32 {
    let (a, b) = (sub(p, center), sub(q, center));
    (dot(a, b) / (dot(a, a).sqrt() * dot(b, b).sqrt())).clamp(-1.0, 1.0)
}

/// Cosine above which a separation angle is too small; none is where the threshold is 0.
fn min_cosine(threshold: f64) -> f64 {
    if threshold > 0.0 { threshold.cos() } else { f64::INFINITY }
}

/// masbcpp's distance, metres, by which a point must lie inside a ball to count.
const CONVERGED: f32 = 1e-5;
/// masbcpp's limit of accepted balls; noise-free input needs three to ten.
const MAX_SHRINKS: usize = 31;

fn shrink_by_angles(
    positions: &[[f32; 3]],
    index: &NeighborIndex,
    p: [f32; 3],
    inward: [f32; 3],
    initial_radius: f32,
    [first_cosine, next_cosine]: [f64; 2],
) -> Ball {
    let center_of = |radius: f32| std::array::from_fn(|i| p[i] + inward[i] * radius);
    let mut ball = Ball { center: center_of(initial_radius), radius: initial_radius, ..Ball::NONE };
    for shrinks in 0..MAX_SHRINKS {
        let inside = ball.radius - CONVERGED;
        let Some(nearest) = index.nearest_within(ball.center, inside * inside) else { break };
        let q = positions[nearest.index as usize];
        if q == p {
            break;
        }
        let chord = sub(q, p);
        let length = dot(chord, chord).sqrt();
        let radius = length / (2.0 * (dot(inward, chord) / length));
        let center: [f32; 3] = center_of(radius);
        if !center.iter().all(|v| v.is_finite()) {
            break;
        }
        let cosine = f64::from(separation_cosine(p, q, center));
        let too_small = if shrinks == 0 { cosine > first_cosine } else { cosine > next_cosine && radius > length };
        if too_small {
            break;
        }
        ball = Ball { center, radius, touch: nearest.index, ..ball };
    }
    ball
}

fn shrink_by_penetration(
    index: &NeighborIndex,
    p: [f32; 3],
    inward: [f32; 3],
    initial_radius: f32,
    penetration: f32,
) -> Ball {
    let tangent = Tangent { point: p, inward, margin: penetration };
    match index.smallest_tangent_ball(&tangent, initial_radius - penetration) {
        Some((empty_radius, touch)) => {
            Ball { center: tangent.center(empty_radius), radius: empty_radius + penetration, touch, ..Ball::NONE }
        }
        None => Ball { center: tangent.center(initial_radius - penetration), radius: initial_radius, ..Ball::NONE },
    }
}
