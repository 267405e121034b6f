//! One free segment: a piece of a line that a pulse proves empty.

use belvedere_data::vector::{dot, sub, to_f32};

/// A proven-empty piece of a line, from just before a first return towards the scanner.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeSegment {
    pub(super) start: [f32; 3],
    /// Unit vector towards the scanner.
    pub(super) direction: [f32; 3],
    pub(super) length: f32,
    /// Row of its pulse among the columns that it was read from.
    pub(super) row: u32,
}

/// Segments that are not indexed yet, by the number of their direction.
pub(super) type SegmentsByAxis = [Vec<FreeSegment>; 6];

impl FreeSegment {
    pub(super) fn new(start: [f64; 3], direction: [f64; 3], length: f64) -> Self {
        Self { start: start.map(to_f32), direction: direction.map(to_f32), length: to_f32(length), row: 0 }
    }

    /// Radius of the ball of the pencil through `touching` along `inward` that this segment touches, or `None` where it
    /// touches none.
    pub(super) fn tangent_radius(&self, touching: [f32; 3], inward: [f32; 3]) -> Option<f64> {
        let (start, along) = (self.start.map(f64::from), self.direction.map(f64::from));
        let inward = inward.map(f64::from);
        // q = a + t u lies on the ball of radius |q−p|² / 2 m·(q−p) with m inward
        let from = sub(start, touching.map(f64::from));
        let (alpha, beta) = (dot(inward, from), dot(inward, along));
        let (b, c) = (dot(from, along), dot(from, from));
        let length = f64::from(self.length);
        let ends = [0.0, length];
        let radius = |t: f64| {
            let height = alpha + beta * t;
            (height > 0.0).then(|| (c + 2.0 * b * t + t * t) / (2.0 * height))
        };
        let best = if beta.abs() < 1e-12 {
            -b
        } else {
            // the derivative vanishes where β t² + 2 α t + 2 α b − β c = 0; of its roots the one on the inner side
            let discriminant = (alpha * alpha - beta * (2.0 * alpha * b - beta * c)).max(0.0).sqrt();
            (-alpha + discriminant) / beta
        };
        let inside = radius(best.clamp(0.0, length));
        let at_ends = ends.into_iter().filter_map(radius).reduce(f64::min);
        inside.into_iter().chain(at_ends).reduce(f64::min)
    }
}
