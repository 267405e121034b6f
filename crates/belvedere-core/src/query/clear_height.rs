//! Minimum visible height: how high a target must be to be seen over obstacles.

use super::skyline::cut;
use super::{EarthParams, MedialScene};
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
    let across = [target[0] - observer[0], target[1] - observer[1]];
    let span = across[0].hypot(across[1]);
    let bends = earth.bends(target, observer);
    let fall = |along: f64| if bends { earth.fall(along) } else { 0.0 };
    let offsets = corners.map(|corner| {
        let [x, y, z] = sub(corner, observer);
        [x, y, z - fall(x.hypot(y))]
    });
    if span == 0.0 {
        // straight below or above the observer: nothing is seen past it
        let highest = corners.iter().map(|corner| corner[2]).fold(f64::NEG_INFINITY, f64::max);
        return if highest > observer[2] { f64::INFINITY } else { highest };
    }
    let Some([near, far]) = cut(&offsets, [across[0] / span, across[1] / span]) else { return target[2] };
    let at = |along: f64| match far[0] > near[0] {
        true => near[1] + (far[1] - near[1]) * (along - near[0]) / (far[0] - near[0]),
        false => far[1].max(near[1]),
    };
    // the piece between the observer and the vertical
    let ends = [near[0].max(0.0), far[0].min(span)];
    let shadow = |along: f64| match at(along) {
        up if along > 0.0 => up * span / along,
        up if up > 0.0 => f64::INFINITY,
        _ => f64::NEG_INFINITY,
    };
    observer[2] + shadow(ends[0]).max(shadow(ends[1])) + fall(span)
}

/// Returns the upper end of the shadow that a whole ball casts from `observer` on the vertical through `target`.
fn shadow_top(center: [f64; 3], radius: f64, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> f64 {
    let across = [target[0] - observer[0], target[1] - observer[1]];
    let span = across[0].hypot(across[1]);
    let offset = sub(center, observer);
    if span == 0.0 {
        return if offset[2] > 0.0 { f64::INFINITY } else { center[2] + radius };
    }
    // seen from the observer a curved earth falls away below straight lines of sight
    let bends = earth.bends(target, observer);
    let fall = |along: f64| if bends { earth.fall(along) } else { 0.0 };
    let along = (offset[0] * across[0] + offset[1] * across[1]) / span;
    let beside = (offset[0] * across[1] - offset[1] * across[0]) / span;
    let disc = (radius * radius - beside * beside).max(0.0).sqrt();
    let up = offset[2] - fall(along);
    let distance = along.hypot(up);
    if distance <= disc {
        return f64::INFINITY;
    }
    let tangent = up.atan2(along) + (disc / distance).asin();
    let touches = (distance * distance - disc * disc).max(0.0).sqrt() * tangent.cos();
    let past = span - along;
    if touches > span && past.abs() < disc {
        return center[2] + (disc * disc - past * past).sqrt();
    }
    if tangent >= std::f64::consts::FRAC_PI_2 {
        return f64::INFINITY;
    }
    observer[2] + span * tangent.tan() + fall(span)
}
