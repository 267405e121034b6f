//! Pencils of balls that touch one plane at one point.

/// A pencil of balls: all that touch, at one point, the plane across one direction.
#[derive(Clone, Copy, Debug)]
pub struct Tangent {
    /// A point of the surface, local metres.
    pub point: [f32; 3],
    /// Unit vector from there to the centres.
    pub inward: [f32; 3],
    /// Distance inward of `point` at which the balls touch, metres; the point itself and its noise stay outside them.
    pub margin: f32,
}

impl Tangent {
    /// Centre of the ball of `radius`.
    #[inline(always)]
    #[must_use]
    pub fn center(&self, radius: f32) -> [f32; 3] {
        std::array::from_fn(|i| self.point[i] + self.inward[i] * (radius + self.margin))
    }
}
