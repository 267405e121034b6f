//! Good selections of cameras: the best next one again and again, then exchanges.

use super::problem::{CameraSelection, Loss, TOLERANCE};
use belvedere_data::Result;
use belvedere_data::control::Control;
use rayon::prelude::*;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Cameras handed to a thread at once.
const CHUNK: usize = 64;

/// A camera with its gain; of equal ones the first.
#[derive(PartialEq)]
struct Gain(f64, Reverse<usize>);

impl Eq for Gain {}

impl Ord for Gain {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

impl PartialOrd for Gain {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Adds the camera of `candidates` with the largest gain until `is_enough` or no camera gains anything. The gain of a
/// camera only shrinks as others are added, so that few gains are computed anew.
///
/// # Source
/// Nemhauser, Wolsey & Fisher 1978: at least 1 − 1/e of the best possible gain. Minoux 1978: the lazy order.
pub(super) fn fill(
    selection: &mut CameraSelection<'_>,
    candidates: &[usize],
    mut is_enough: impl FnMut(&CameraSelection<'_>) -> bool,
    control: &Control<'_>,
) -> Result<()> {
    let gain = |&camera: &usize| Gain(selection.gain(camera), Reverse(camera));
    let mut queue: BinaryHeap<Gain> = candidates.par_iter().with_min_len(CHUNK).map(gain).collect();
    while !is_enough(selection) {
        control.check()?;
        let Some(camera) = next(selection, &mut queue) else { break };
        selection.add(camera);
    }
    Ok(())
}

/// The camera that gains most; `None` if none gains anything.
fn next(selection: &CameraSelection<'_>, queue: &mut BinaryHeap<Gain>) -> Option<usize> {
    loop {
        let Gain(_, Reverse(camera)) = queue.pop()?;
        let now = Gain(selection.gain(camera), Reverse(camera));
        if now.0 == 0.0 {
            continue;
        }
        if queue.peek().is_none_or(|next| *next <= now) {
            return Some(camera);
        }
        queue.push(now);
    }
}

/// Exchanges chosen cameras, but not the first `fixed`, for others of `candidates` as long as that gains anything: the
/// best exchange first.
pub(super) fn exchange(
    selection: &mut CameraSelection<'_>,
    fixed: usize,
    candidates: &[usize],
    control: &Control<'_>,
) -> Result<()> {
    loop {
        control.check()?;
        let losses: Vec<Loss> = selection.chosen[fixed..].par_iter().map(|&camera| selection.loss(camera)).collect();
        let is_chosen = |camera: &usize| selection.chosen.contains(camera);
        let best_of = |&camera: &usize| {
            let gain = if is_chosen(&camera) { return None } else { selection.gain(camera) };
            let mut best: Option<(f64, usize)> = None;
            for (place, loss) in losses.iter().enumerate() {
                let min = best.map_or(TOLERANCE, |(better, _)| better);
                if gain + loss.tight_worth - loss.worth > min {
                    let better = gain + selection.saved(camera, loss) - loss.worth;
                    if better > min {
                        best = Some((better, place));
                    }
                }
            }
            best.map(|(better, place)| (Gain(better, Reverse(camera)), place))
        };
        let found = candidates.par_iter().with_min_len(CHUNK).filter_map(best_of).max_by(|a, b| a.0.cmp(&b.0));
        let Some((Gain(_, Reverse(camera)), place)) = found else { return Ok(()) };
        selection.remove(fixed + place);
        selection.add(camera);
    }
}
