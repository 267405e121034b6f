//! Minimum visible height: how high a target must be to be seen over obstacles.

use super::vertical_plane::VerticalPlane;
use crate::query::{EarthParams, MedialScene};
use crate::triangle_tree::Corners;
use belvedere_data::vector::{length, sub, unit};

/// Minimum step upward, metres: for rounding that leaves a line of sight in a ball whose top it just reached.
const MIN_STEP: f64 = 1e-3;
/// Accuracy of the top of a ball that gives way to the target, metres.
const TOP_TOLERANCE: f64 = 1e-3;

impl MedialScene {
    /// Returns the lowest visible height above `foot`, local metres, for `observer`, metres: 0 if the foot itself is
    /// visible, `None` if nothing is up to `ceiling` metres. Higher places may be blocked again, as below a bridge. The
    /// height exceeds the true one of the balls by at most 2 mm; pulses are not considered.
    ///
    /// Every ball blocks one interval of heights. Each step therefore rises to the top of the highest ball that blocks
    /// at that height, in closed form: the upper tangent from the observer, or the ball's own top. Tops of balls near
    /// the target, which give way to it, are found by bisection.
    #[must_use]
    pub fn min_visible_height(
        &self,
        observer: [f64; 3],
        foot: [f64; 3],
        ceiling: f64,
        earth: &EarthParams,
    ) -> Option<f64> {
        if !observer.iter().chain(&foot).all(|v| v.is_finite()) {
            return None;
        }
        let mut height = 0.0;
        loop {
            let target = [foot[0], foot[1], foot[2] + height];
            if target == observer {
                return Some(height);
            }
            let mut clear: Option<f64> = None;
            self.each_blocker(observer, target, earth, |number| {
                let top = self.top(number, observer, target, earth) - foot[2];
                clear = Some(clear.map_or(top, |clear| clear.max(top)));
            });
            self.each_blocking_triangle(observer, target, earth, |corners, sheet| {
                let shadow = shadow_top_of_triangle(corners, observer, target, earth);
                // below the top of its shadow it may give way to the target
                let top = sheet.height_of_giving_way(target).map_or(shadow, |height| shadow.min(height)) - foot[2];
                clear = Some(clear.map_or(top, |clear| clear.max(top)));
            });
            let Some(clear) = clear else { return Some(height) };
            height = clear.max(height + MIN_STEP);
            if !(height <= ceiling) {
                return None;
            }
        }
    }

    /// Returns the height at which a ball stops blocking on the vertical through `target`, local metres; infinite if it
    /// never does.
    fn top(&self, number: usize, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> f64 {
        let Some(ball) = self.tree().balls().get(number) else { return target[2] };
        let (center, radius) = (ball.center.map(f64::from), f64::from(ball.radius));
        let rule = self.tree().rule();
        // it gives way to the observer too
        let seen_radius = rule.radius_for(radius, ball.distance_to(observer));
        let whole = shadow_top(center, seen_radius, observer, target, earth);
        let beside = (center[0] - target[0]).hypot(center[1] - target[1]);
        let margin = rule.shell + rule.bias;
        if beside > radius + margin || earth.bends(target, observer) {
            return whole;
        }
        let blocks = |z: f64| {
            let place = [target[0], target[1], z];
            let towards = sub(observer, place);
            let ray = unit(towards).map(|unit| self.ray(place, unit, length(towards)));
            ray.is_some_and(|ray| self.front(number, &ray).is_some())
        };
        // above the ball itself it no longer gives way: only the tangent counts there
        let (mut low, mut high) = (target[2], whole.min(center[2] + radius + margin));
        if !(high > low) || blocks(high) {
            return whole;
        }
        while high - low > TOP_TOLERANCE {
            let middle = f64::midpoint(low, high);
            if blocks(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// Returns the upper end of the shadow that a triangle casts from `observer` on the vertical through `target`.
fn shadow_top_of_triangle(corners: &Corners, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> f64 {
    let Some(plane) = VerticalPlane::new(observer, target, earth, earth.bends(target, observer)) else {
        // straight below or above the observer nothing is seen past it
        let highest = corners.iter().map(|corner| corner[2]).fold(f64::NEG_INFINITY, f64::max);
        return if highest > observer[2] { f64::INFINITY } else { highest };
    };
    plane.hidden_by_triangle(corners).map_or(target[2], |[_, top]| plane.height_at(top))
}

/// Returns the upper end of the shadow that a whole ball casts from `observer` on the vertical through `target`.
fn shadow_top(center: [f64; 3], radius: f64, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> f64 {
    let Some(plane) = VerticalPlane::new(observer, target, earth, earth.bends(target, observer)) else {
        return if center[2] > observer[2] { f64::INFINITY } else { center[2] + radius };
    };
    match plane.hidden_by_ball(center, radius) {
        Some([_, top]) => plane.height_at(top),
        None if length(sub(center, observer)) <= radius => f64::INFINITY,
        // the line only grazes it
        None => target[2],
    }
}
