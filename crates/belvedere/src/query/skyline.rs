//! Heights from which everything above is near some pulse: most of a line of sight is proven by a look at these.

use crate::pulses::Needles;
use std::sync::atomic::{AtomicU32, Ordering};

/// Side of a cell as a share of the nearness. What lies within nearness − side/√2 of the middle of a cell lies within the
/// nearness of all of it, at the same height; the smaller the cells, the more of them find such a pulse, and the more there are.
const SIDE_PER_NEARNESS: f64 = 0.7;
/// Most cells; a larger survey gets larger cells, and what these cannot prove is asked of the pulses.
const MOST_CELLS: f64 = 5e7;
/// A height that was not asked for yet: no height is this NaN.
const UNKNOWN: u32 = u32::MAX;

/// A grid of heights, each found when it is first asked for.
pub(super) struct Skyline {
    low: [f64; 2],
    side: f64,
    size: [usize; 2],
    /// How near a pulse must pass to the middle of a cell.
    distance: f64,
    /// Bits of f32. Whoever writes one writes the same, so that no order matters.
    heights: Vec<AtomicU32>,
}

impl Skyline {
    /// A grid over the box from `rim[0]` to `rim[1]`, for pulses that count up to `nearness` metres.
    pub(super) fn new(rim: [[f64; 2]; 2], nearness: f64) -> Self {
        let extent = [0, 1].map(|axis| rim[1][axis] - rim[0][axis]);
        let side = (SIDE_PER_NEARNESS * nearness).max((extent[0] * extent[1] / MOST_CELLS).max(0.0).sqrt());
        let distance = nearness - side / std::f64::consts::SQRT_2;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates; NaN becomes 0")]
        let count = extent.map(|extent| (extent / side) as usize);
        let usable =
            distance > 0.0 && count.iter().all(|&n| (n as f64) < MOST_CELLS) && extent.iter().all(|e| *e >= 0.0);
        let size = if usable { count.map(|n| n + 1) } else { [0; 2] };
        let heights = (0..size[0] * size[1]).map(|_| AtomicU32::new(UNKNOWN)).collect();
        Self { low: rim[0], side, size, distance, heights }
    }

    /// How far along a line, from `at` on, all is near pulses, as far as the cell at `at` tells; `None` where it tells nothing.
    pub(super) fn free_until(&self, needles: &Needles, origin: [f64; 3], direction: [f64; 3], at: f64) -> Option<f64> {
        // a little on, so that a line at the edge of a cell is taken for in the one it enters
        let within = at + 1e-9 * self.side;
        let mut cell = [0_usize; 2];
        let mut exit = f64::INFINITY;
        for axis in 0..2 {
            let place = (origin[axis] + within * direction[axis] - self.low[axis]) / self.side;
            if !(place >= 0.0) {
                return None;
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; saturates")]
            let index = place as usize;
            cell[axis] = index;
            let edge =
                self.low[axis] + self.side * if direction[axis] > 0.0 { index as f64 + 1.0 } else { index as f64 };
            if direction[axis] != 0.0 {
                exit = exit.min((edge - origin[axis]) / direction[axis]);
            }
        }
        let height = f64::from(self.height(needles, cell)?);
        if origin[2] + at * direction[2] < height {
            return None;
        }
        if direction[2] < 0.0 {
            exit = exit.min((height - origin[2]) / direction[2]);
        }
        // to the middle of nowhere at least a micrometre, so that a walk goes on
        (exit > at + 1e-6 * self.side).then_some(exit)
    }

    /// The height of a cell, or `None` beside the grid.
    fn height(&self, needles: &Needles, [column, row]: [usize; 2]) -> Option<f32> {
        if column >= self.size[0] {
            return None;
        }
        let stored = self.heights.get(row * self.size[0] + column)?;
        let bits = stored.load(Ordering::Relaxed);
        if bits != UNKNOWN {
            return Some(f32::from_bits(bits));
        }
        let middle = [column, row].map(|index| (index as f64 + 0.5) * self.side);
        let top = f64::from(needles.top());
        let origin = [self.low[0] + middle[0], self.low[1] + middle[1], top];
        // downward from the top for as long as one needle after the other stays near
        let mut down = 0.0;
        while let Some([_, to]) = needles.near_piece(origin, [0.0, 0.0, -1.0], down, self.distance) {
            down = to;
        }
        #[expect(clippy::cast_possible_truncation, reason = "rounded up")]
        let height = if down > 0.0 { ((top - down) as f32).next_up() } else { f32::INFINITY };
        stored.store(height.to_bits(), Ordering::Relaxed);
        Some(height)
    }
}
