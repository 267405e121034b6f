//! Chains of balls below each other, which fill objects with points on their tops only.

use super::marks::{Fill, FillPlace};

/// Smallest radius of a ball worth keeping, as a share of the largest.
pub(super) const MIN_SHARE: f32 = 0.25;
/// Maximum number of balls below each other, so that odd parameters cannot fill the memory.
const MAX_BELOW: usize = 64;

/// Chain of balls that hang below a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chain {
    /// Row of the point that tells of them.
    pub(super) row: usize,
    /// Largest radius, metres, above 0.
    pub(super) radius: f32,
    /// Distance from centre to centre, metres, above 0.
    pub(super) spacing: f32,
}

impl Chain {
    /// The fills from `top`, local metres, which the first touches from below, down to the height `bottom`, which no
    /// centre is at or below.
    pub(super) fn fills_below(self, top: [f32; 3], bottom: f32) -> impl Iterator<Item = Fill> {
        let Self { row, radius, spacing } = self;
        let centers = (0_u8..).map(move |step| [top[0], top[1], top[2] - radius - spacing * f32::from(step)]);
        let fill = move |center| Fill {
            row,
            place: FillPlace::Center(center),
            max_radius: radius,
            min_radius: MIN_SHARE * radius,
        };
        centers.take(MAX_BELOW).take_while(move |center| center[2] > bottom).map(fill)
    }
}
