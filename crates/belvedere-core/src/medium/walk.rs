//! The cells of a grid that a line passes, one after the other.

use super::blocks::SIDE;
use belvedere_data::cast::to_i32;
use std::ops::ControlFlow;

/// A line in the coordinates of a grid.
pub(super) struct GridLine {
    start: [f64; 3],
    towards: [f64; 3],
    /// Reciprocals of `towards`.
    inverse: [f64; 3],
}

impl GridLine {
    pub(super) fn new(start: [f64; 3], towards: [f64; 3]) -> Self {
        Self { start, towards, inverse: towards.map(f64::recip) }
    }

    /// Where it is after `range`.
    #[inline]
    pub(super) fn at(&self, range: f64) -> [f64; 3] {
        std::array::from_fn(|axis| self.start[axis] + range * self.towards[axis])
    }

    /// The range at which it passes a plane across an axis. Not added up on the way, so that it does not depend on
    /// where a walk began.
    #[inline]
    fn crossing(&self, axis: usize, plane: i32) -> f64 {
        (f64::from(plane) - self.start[axis]) * self.inverse[axis]
    }

    /// The part of `ranges` within blocks from `low` to one before `high`.
    pub(super) fn within(&self, [low, high]: [[i32; 3]; 2], ranges: [f64; 2]) -> Option<[f64; 2]> {
        let [mut from, mut to] = ranges;
        for axis in 0..3 {
            let [low, high] = [low[axis] * SIDE, high[axis] * SIDE];
            if self.towards[axis] == 0.0 {
                if self.start[axis] < f64::from(low) || self.start[axis] >= f64::from(high) {
                    return None;
                }
                continue;
            }
            let (a, b) = (self.crossing(axis, low), self.crossing(axis, high));
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from < to).then_some([from, to])
    }

    /// Calls `visit` with each cell of `side` units from `low` to one before `high`, in cells, that the line passes
    /// within `ranges`, and the ranges at which it does, in order, until `visit` breaks.
    #[inline]
    pub(super) fn each_cell<B>(
        &self,
        side: i32,
        [low, high]: [[i32; 3]; 2],
        [from, to]: [f64; 2],
        mut visit: impl FnMut([i32; 3], [f64; 2]) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let entry = self.at(from);
        let mut cell: [i32; 3] = std::array::from_fn(|axis| {
            // rounding may put the entry beside the first or the last cell
            to_i32((entry[axis] / f64::from(side)).floor()).clamp(low[axis], high[axis] - 1)
        });
        let step: [i32; 3] = self.towards.map(|v| if v > 0.0 { 1 } else { -1 });
        let leaves = |axis: usize, cell: i32| {
            if self.towards[axis] == 0.0 {
                return f64::INFINITY;
            }
            self.crossing(axis, (cell + i32::from(step[axis] > 0)) * side)
        };
        let mut next: [f64; 3] = std::array::from_fn(|axis| leaves(axis, cell[axis]));
        let mut at = from;
        loop {
            let axis = if next[0] <= next[1] && next[0] <= next[2] { 0 } else { 1 + usize::from(next[2] < next[1]) };
            let end = next[axis].min(to);
            if end > at {
                visit(cell, [at, end])?;
                at = end;
            }
            if next[axis] >= to {
                return ControlFlow::Continue(());
            }
            cell[axis] += step[axis];
            if cell[axis] < low[axis] || cell[axis] >= high[axis] {
                return ControlFlow::Continue(());
            }
            next[axis] = leaves(axis, cell[axis]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::unit;

    #[test]
    fn cells_of_a_line_are_those_of_its_places() {
        let mut passed = 0;
        for i in 0..500 {
            let random = |k: u64| uniform(3, 8 * i + k);
            let start: [f64; 3] = std::array::from_fn(|axis| 40.0 * random(axis as u64) - 10.0);
            let towards =
                if i % 5 == 0 { [0.0, 0.0, 1.0] } else { unit([random(3) - 0.5, random(4) - 0.5, random(5)]).unwrap() };
            let line = GridLine::new(start, towards);
            let bounds = [[-1, -1, -1], [4, 4, 4]];
            let Some(ranges) = line.within(bounds, [0.0, f64::INFINITY]) else { continue };
            let mut total = 0.0;
            let all = bounds.map(|corner| corner.map(|v| v * SIDE));
            let _ = line.each_cell::<()>(1, all, ranges, |cell, [from, to]| {
                let middle = line.at(f64::midpoint(from, to));
                if to - from > 1e-9 {
                    assert_eq!(cell, middle.map(|v| to_i32(v.floor())), "{i}");
                }
                total += to - from;
                ControlFlow::Continue(())
            });
            assert!((total - (ranges[1] - ranges[0])).abs() < 1e-9, "{i}");
            passed += 1;
        }
        assert!(passed > 300, "{passed}");
    }
}
