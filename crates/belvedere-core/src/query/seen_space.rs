//! Boxes of space that are near some pulse everywhere: most of a line of sight is proven by a look at these.

use crate::pulses::Needles;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Side of a box as a share of the nearness. A needle that passes the middle of a box within nearness − side/√2 is near to all of
/// it; the smaller the boxes, the more of them find such a needle, and the more there are.
const SIDE_PER_NEARNESS: f64 = 0.45;
/// Height of a box as a share of the nearness: leaning needles stay in low boxes.
const HEIGHT_PER_NEARNESS: f64 = 1.0;
/// Boxes above one another: bits of a word. Higher scenes get higher boxes, of which fewer are near one needle all the way up.
const MOST_LAYERS: f64 = 64.0;
/// Most columns, 160 MB; a larger survey gets larger boxes, and what these cannot prove is asked of the pulses.
const MOST_COLUMNS: f64 = 2e7;
/// What rounding of f32 may shift a needle by, metres.
const ROUNDING: f64 = 2e-3;

/// A grid of boxes, each known to be near pulses or not. It proves less than the pulses themselves and nothing that they do not.
pub(super) struct SeenSpace {
    /// Lowest corner.
    low: [f64; 3],
    /// Width and height of a box.
    side: f64,
    height: f64,
    size: [usize; 2],
    /// A word for each column of boxes, lowest bit first.
    columns: Vec<u64>,
}

impl SeenSpace {
    /// Boxes over the rectangle from `rim[0]` to `rim[1]`, for needles that count up to `nearness` metres.
    pub(super) fn new(needles: &Needles, rim: [[f64; 2]; 2], nearness: f64) -> Self {
        let extent = [0, 1].map(|axis| rim[1][axis] - rim[0][axis]);
        let side = (SIDE_PER_NEARNESS * nearness).max((extent[0] * extent[1] / MOST_COLUMNS).max(0.0).sqrt());
        let reach = nearness - side / std::f64::consts::SQRT_2 - ROUNDING;
        let floor = needles.lower_ends().map(|start| f64::from(start[2])).fold(f64::INFINITY, f64::min);
        let rise = f64::from(needles.top()) - floor;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates; NaN becomes 0")]
        let whole = |count: f64| count as usize;
        let layers = (rise / (HEIGHT_PER_NEARNESS * nearness)).ceil().clamp(1.0, MOST_LAYERS);
        let counts = extent.map(|extent| (extent / side).floor() + 1.0);
        let usable = reach > 0.0 && rise > 0.0 && rise.is_finite() && counts[0] * counts[1] < 2.0 * MOST_COLUMNS;
        let size = if usable { counts.map(whole) } else { [0; 2] };
        let mut space =
            Self { low: [rim[0][0], rim[0][1], floor], side, height: rise / layers, size, columns: Vec::new() };
        // bits are only ever set, so that no order matters
        let columns: Vec<AtomicU64> = (0..size[0] * size[1]).map(|_| AtomicU64::new(0)).collect();
        if !columns.is_empty() {
            needles.par_ends().for_each(|ends| space.mark(ends, reach, whole(layers), &columns));
        }
        space.columns = columns.into_iter().map(AtomicU64::into_inner).collect();
        space
    }

    /// Marks the boxes that a needle is near to: those whose middle line it passes within `reach` both where it enters their
    /// layer and where it leaves it.
    fn mark(&self, [start, end]: [[f64; 3]; 2], reach: f64, layers: usize, columns: &[AtomicU64]) {
        let lean = [0, 1].map(|axis| (end[axis] - start[axis]) / (end[2] - start[2]));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
        let first = ((start[2] - ROUNDING - self.low[2]) / self.height).ceil().max(0.0) as usize;
        for layer in first..layers {
            let bounds = [layer, layer + 1].map(|step| self.low[2] + step as f64 * self.height);
            if bounds[1] > end[2] + ROUNDING {
                break;
            }
            let at = bounds.map(|z| [0, 1].map(|axis| start[axis] + (z - start[2]) * lean[axis] - self.low[axis]));
            let range = [0, 1].map(|axis| {
                let (least, most) = (at[0][axis].min(at[1][axis]), at[0][axis].max(at[1][axis]));
                let last = self.size[axis] as f64 - 1.0;
                // middles within reach of both places
                let from = ((most - reach) / self.side - 0.5).ceil().clamp(0.0, last + 1.0);
                let to = ((least + reach) / self.side - 0.5).floor().clamp(-1.0, last) + 1.0;
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index into the grid")]
                let range = from as usize..to as usize;
                range
            });
            for row in range[1].clone() {
                for column in range[0].clone() {
                    let middle = [column, row].map(|index| (index as f64 + 0.5) * self.side);
                    let near = |at: [f64; 2]| (at[0] - middle[0]).powi(2) + (at[1] - middle[1]).powi(2) < reach * reach;
                    let bit = 1 << layer;
                    let word = &columns[row * self.size[0] + column];
                    if near(at[0]) && near(at[1]) && word.load(Ordering::Relaxed) & bit == 0 {
                        word.fetch_or(bit, Ordering::Relaxed);
                    }
                }
            }
        }
    }

    /// Where a line leaves the box that it is in at `at`, if all of that box is near pulses.
    pub(super) fn near_until(&self, origin: [f64; 3], direction: [f64; 3], at: f64) -> Option<f64> {
        let sides = [self.side, self.side, self.height];
        // a little on, so that a line at the edge of a box is taken for in the one it enters
        let within = at + 1e-9;
        let mut cell = [0_usize; 3];
        let mut exit = f64::INFINITY;
        for axis in 0..3 {
            let place = (origin[axis] + within * direction[axis] - self.low[axis]) / sides[axis];
            if !(place >= 0.0) {
                return None;
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; saturates")]
            let index = place as usize;
            cell[axis] = index;
            if direction[axis] != 0.0 {
                let edge = index as f64 + if direction[axis] > 0.0 { 1.0 } else { 0.0 };
                exit = exit.min((self.low[axis] + edge * sides[axis] - origin[axis]) / direction[axis]);
            }
        }
        let [column, row, layer] = cell;
        if column >= self.size[0] || row >= self.size[1] || layer >= 64 {
            return None;
        }
        let word = self.columns.get(row * self.size[0] + column)?;
        // at least a micrometre on, so that a walk ends
        (word >> layer & 1 == 1 && exit > at + 1e-6).then_some(exit)
    }
}
