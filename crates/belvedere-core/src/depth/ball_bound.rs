//! Radius with which a ball is drawn, so that it bounds the depth of every point of a pixel.

use crate::blocking::BlockRule;
use belvedere_data::cast::to_f32;

/// Rounding of f32 as a share of the coordinates it works on: 32 units of 2⁻²³. Positions in the view, directions of
/// pixels and products of both err by fewer than 16 of them together.
const ROUNDING: f64 = 4e-6;
/// Rounding of f32 near the origin of the view, metres.
const MIN_ROUNDING: f64 = 1e-6;

/// Bound that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BoundSide {
    Lower,
    Upper,
}

/// Parameters of a ball drawn as a bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct BallBound {
    pub(super) side: BoundSide,
    pub(super) rule: BlockRule,
    /// Nearest and farthest end of the lines of sight on the viewer's side, metres.
    pub(super) start: [f64; 2],
    /// True if lines of sight end at the eye.
    pub(super) is_to_eye: bool,
}

impl BallBound {
    /// Returns the radius that bounds a ball of `radius` whose centre is `distance` metres from the eye, metres, within
    /// `margin`. The result is at least the radius for the lower bound, and at most the radius for any target for the
    /// upper one.
    pub(super) fn radius_at_eye(&self, radius: f64, distance: f64, margin: f64) -> f64 {
        let (outside, shell) = (distance - radius, self.rule.shell_of(radius));
        match self.side {
            _ if !self.is_to_eye || outside >= shell + margin || outside <= margin - shell => radius,
            BoundSide::Lower => self.rule.radius_for(radius, distance),
            BoundSide::Upper => self.rule.min_radius(radius),
        }
    }

    /// The radius to draw a ball with, `None` where it does not count. `size` is at least the largest of its
    /// coordinates, metres; `fronts` the least and the most depth of its front; nothing smaller than `min_cover` covers
    /// a pixel at its distance.
    pub(super) fn radius(&self, radius: f32, size: f64, [min, max]: [f64; 2], min_cover: f64) -> Option<f32> {
        let radius = f64::from(radius);
        let margin = margin(size, radius);
        match self.side {
            BoundSide::Lower => (max + margin > self.start[0]).then(|| to_f32(radius + margin).next_up()),
            BoundSide::Upper => {
                // twice, since giving way halves what is left of one
                let drawn = radius - 2.0 * margin;
                (drawn > min_cover && min - margin > self.start[1]).then(|| to_f32(drawn).next_down())
            }
        }
    }

    /// The radius that is left of a ball drawn with `radius` for any target, however near to its surface.
    #[inline(always)]
    pub(super) fn min_radius(&self, radius: f32) -> f32 {
        self.rule.min_radius_f32(radius)
    }

    /// A depth behind which every target lies farther than the shell from a ball drawn with `radius` around `center`
    /// deep, so that it counts with all of its radius.
    #[inline(always)]
    pub(super) fn behind(&self, center: f32, radius: f32, margin: f32) -> f32 {
        center + radius + to_f32(self.rule.shell) + 4.0 * margin
    }
}

/// Returns the margin by which a ball is drawn too large or too small, metres.
pub(super) fn margin(size: f64, radius: f64) -> f64 {
    ROUNDING * (size + radius) + MIN_ROUNDING
}
