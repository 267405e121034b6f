//! Check of balls and surfaces against the pulses that carved them.

use super::report::BlockedPulses;
use crate::pulses::FreeSegments;
use crate::query::{BallTree, BlockingTriangles};
use belvedere_data::Result;
use belvedere_data::control::{Control, Stop};
use belvedere_data::report::percent;
use rayon::prelude::*;

/// Pulses handed to a thread at once.
const CHUNK: usize = 4096;

/// Counts the `pulses`, which ran through empty space, that the balls of `tree` block, and those that only `triangles`
/// block.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn blocked_pulses(
    tree: &BallTree,
    triangles: Option<&BlockingTriangles>,
    pulses: &FreeSegments,
    control: &Control<'_>,
) -> Result<BlockedPulses> {
    let stop = Stop::new(control);
    let blocked_by = |(start, up, length): ([f64; 3], [f64; 3], f64)| {
        if stop.is_set() {
            [0, 0]
        } else if tree.blocks(&tree.ray(start, up, length)) {
            [1, 0]
        } else {
            [0, usize::from(triangles.is_some_and(|triangles| triangles.blocks(start, up, length)))]
        }
    };
    let sum = |a: [usize; 2], b: [usize; 2]| [a[0] + b[0], a[1] + b[1]];
    let [by_balls, by_surfaces] = pulses.lines().with_min_len(CHUNK).map(blocked_by).reduce(|| [0; 2], sum);
    stop.check()?;
    control.advance(pulses.len());
    let of_pulses = |count: usize| percent(count, pulses.len());
    Ok(BlockedPulses {
        count: by_balls,
        percent: of_pulses(by_balls),
        by_surfaces,
        by_surfaces_percent: of_pulses(by_surfaces),
    })
}
