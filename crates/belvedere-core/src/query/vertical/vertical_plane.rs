//! The vertical plane through an eye and a vertical line, and what obstacles hide of it: intervals of elevations.

use super::skyline::cut;
use crate::blocking::Ball;
use crate::query::EarthParams;
use crate::triangle_tree::Corners;
use belvedere_data::vector::sub;

/// The vertical plane from an eye to a vertical line. Elevations are tangents of their angles, as they appear over the
/// curved earth.
#[derive(Clone, Copy)]
pub(super) struct VerticalPlane {
    pub(super) eye: [f64; 3],
    /// Unit vector to the line on the map.
    pub(super) along: [f64; 2],
    /// Horizontal distance to the line, metres.
    pub(super) span: f64,
    /// Fall of places for each square metre of their squared distance, 1/m: 0 over a plane earth.
    pub(super) fall: f64,
}

impl VerticalPlane {
    /// The plane from `eye` to the vertical line through `place`, local metres, over a curved or a plane earth; `None`
    /// if the eye is straight above or below it.
    pub(super) fn new(eye: [f64; 3], place: [f64; 3], earth: &EarthParams, is_curved: bool) -> Option<Self> {
        let across = [place[0] - eye[0], place[1] - eye[1]];
        let span = (across[0] * across[0] + across[1] * across[1]).sqrt();
        let fall = if is_curved { earth.fall_rate() } else { 0.0 };
        (span > 0.0).then(|| Self { eye, along: across.map(|v| v / span), span, fall })
    }

    /// Tangent of the elevation at which a height of the line, local metres, appears.
    pub(super) fn tangent_of(&self, height: f64) -> f64 {
        (height - self.eye[2]) / self.span - self.fall * self.span
    }

    /// Height of the line, local metres, that appears at a tangent.
    pub(super) fn height_at(&self, tangent: f64) -> f64 {
        self.eye[2] + (tangent + self.fall * self.span) * self.span
    }

    /// Returns true if the plane may meet a ball before the line.
    pub(super) fn meets(&self, ball: Ball) -> bool {
        let [x, y, _] = sub(ball.center.map(f64::from), self.eye);
        let [east, north] = self.along;
        let (along, radius) = (x * east + y * north, f64::from(ball.radius));
        (y * east - x * north).abs() < radius && -radius < along && along < self.span + radius
    }

    /// Returns the tangents that a ball of `radius` hides, if any. One that holds the eye hides nothing.
    pub(super) fn hidden_by_ball(&self, center: [f64; 3], radius: f64) -> Option<[f64; 2]> {
        let (span, [x, y, up]) = (self.span, sub(center, self.eye));
        let [east, north] = self.along;
        let (along, beside) = (x * east + y * north, y * east - x * north);
        let up = up - self.fall * along * along;
        let disc = radius * radius - beside * beside;
        let touch_square = along * along + up * up - disc;
        if disc <= 0.0 || touch_square <= 0.0 {
            return None;
        }
        let half = disc.sqrt();
        if along + half <= 0.0 || along - half >= span {
            return None;
        }
        // slopes m of the two tangents: (along m - up)² = disc (1 + m²), without a difference of like numbers
        let (ahead, product) = (along * along - disc, along * up);
        let root = half * touch_square.sqrt();
        let other = up * up - disc;
        let [minus, plus] = match product >= 0.0 {
            true => [other / (product + root), (product + root) / ahead],
            false => [(product - root) / ahead, other / (product - root)],
        };
        // a disc over the eye, or below it, has one of them on either side
        let slopes = match ahead > 0.0 {
            true => [minus, plus],
            false if up > 0.0 => [minus, f64::INFINITY],
            false => [f64::NEG_INFINITY, plus],
        };
        // beyond the line the disc ends at it
        let past = span - along;
        let of_line = (disc - past * past).max(0.0).sqrt();
        let end = |slope: f64, side: f64| match touch_square > span * span * (1.0 + slope * slope) {
            true => (up + side * of_line) / span,
            false => slope,
        };
        Some([end(slopes[0], -1.0), end(slopes[1], 1.0)])
    }

    /// Returns the tangents that a triangle hides, if any.
    pub(super) fn hidden_by_triangle(&self, corners: &Corners) -> Option<[f64; 2]> {
        let offsets = corners.map(|corner| {
            let [x, y, up] = sub(corner, self.eye);
            [x, y, up - self.fall * (x * x + y * y)]
        });
        let [near, far] = cut(&offsets, self.along)?;
        let (from, to) = (near[0].max(0.0), far[0].min(self.span));
        if !(from <= to) || to <= 0.0 {
            return None;
        }
        let tangent = |[along, up]: [f64; 2]| if along > 0.0 { up / along } else { f64::INFINITY.copysign(up) };
        let at = |along: f64| [along, near[1] + (far[1] - near[1]) * (along - near[0]) / (far[0] - near[0])];
        // a piece that stands upright in the plane has both of its heights at one distance
        let ends = if far[0] > near[0] { [at(from), at(to)] } else { [near, far] }.map(tangent);
        Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
    }
}
