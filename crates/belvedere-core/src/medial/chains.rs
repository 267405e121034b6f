//! Balls that hang below each other: how what has points on its top only is filled.

use crate::pulses::FreeSegments;

/// Least radius of a ball worth keeping, as a share of the most.
pub(super) const LEAST_SHARE: f32 = 0.25;
/// Most balls below each other, so that odd parameters cannot fill the memory.
const MOST_BELOW: usize = 64;

/// How balls hang below each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chain {
    /// Most radius, metres, above 0.
    pub(super) radius: f32,
    /// From centre to centre, metres, above 0.
    pub(super) spacing: f32,
}

impl Chain {
    /// Centres and radii of the balls from `top`, local metres, which the first touches from below, down to the height `bottom`,
    /// which no centre is at or below. Each is as large as the pulses leave it; those that they leave next to nothing of are
    /// left out.
    pub(super) fn below<'a>(
        self,
        top: [f32; 3],
        bottom: f32,
        needles: &'a FreeSegments,
    ) -> impl Iterator<Item = ([f32; 3], f32)> + 'a {
        let Self { radius, spacing } = self;
        let centers = (0_u8..).map(move |step| [top[0], top[1], top[2] - radius - spacing * f32::from(step)]);
        centers
            .take(MOST_BELOW)
            .take_while(move |center| center[2] > bottom)
            .map(move |center| (center, needles.clearance(center, radius)))
            .filter(move |&(_, left)| left >= LEAST_SHARE * radius)
    }
}
