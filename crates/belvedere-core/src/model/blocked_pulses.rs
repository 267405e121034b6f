//! A check of finished balls against the pulses that carved them.

use super::report::BlockedPulses;
use crate::pulses::FreeSegments;
use crate::query::BallTree;
use belvedere_data::Result;
use belvedere_data::control::{Control, Stop};
use belvedere_data::report::percent;
use rayon::prelude::*;

/// Pulses handed to a thread at once.
const CHUNK: usize = 4096;

/// How many of `pulses`, which ran through empty space, the balls of `tree` block.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn blocked_pulses(tree: &BallTree, pulses: &FreeSegments, control: &Control<'_>) -> Result<BlockedPulses> {
    let stop = Stop::new(control);
    let is_blocked = |(start, up, length): &([f64; 3], [f64; 3], f64)| {
        !stop.is_set() && tree.blocks(&tree.ray(*start, *up, *length))
    };
    let count = pulses.lines().with_min_len(CHUNK).filter(is_blocked).count();
    stop.check()?;
    control.advance(pulses.len());
    Ok(BlockedPulses { count, percent: percent(count, pulses.len()) })
}
