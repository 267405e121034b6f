//! Convex pieces of the map, small enough to live on the stack.

/// Maximum number of corners: a piece between two edges of a parcel and the sides of a cell has six, three cuts add one
/// each; the rest is spare.
const MAX_CORNERS: usize = 12;

/// A convex polygon on the map, counter-clockwise, local metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexPolygon {
    corners: [[f64; 2]; MAX_CORNERS],
    count: usize,
}

impl ConvexPolygon {
    /// The polygon through `corners`, counter-clockwise; corners beyond the twelfth are dropped.
    #[must_use]
    pub fn new(corners: &[[f64; 2]]) -> Self {
        let mut polygon = Self { corners: [[0.0; 2]; MAX_CORNERS], count: 0 };
        corners.iter().for_each(|&corner| polygon.push(corner));
        polygon
    }

    /// The box between two corners.
    #[must_use]
    pub fn of_box(low: [f64; 2], high: [f64; 2]) -> Self {
        Self::new(&[low, [high[0], low[1]], high, [low[0], high[1]]])
    }

    /// Its corners, (C, 2).
    #[must_use]
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.count]
    }

    /// Area, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        let [first, rest @ ..] = self.corners() else { return 0.0 };
        let doubled = |pair: &[[f64; 2]]| match pair {
            [a, b] => (a[0] - first[0]) * (b[1] - first[1]) - (a[1] - first[1]) * (b[0] - first[0]),
            _ => 0.0,
        };
        rest.windows(2).map(doubled).sum::<f64>() / 2.0
    }

    /// The part where `side`, a linear function of the place, is not below zero.
    ///
    /// # Source
    /// Sutherland & Hodgman 1974.
    #[must_use]
    pub fn clipped(&self, side: impl Fn([f64; 2]) -> f64) -> Self {
        let mut part = Self { corners: [[0.0; 2]; MAX_CORNERS], count: 0 };
        let Some(&last) = self.corners().last() else { return part };
        let (mut from, mut before) = (last, side(last));
        for &to in self.corners() {
            let after = side(to);
            if (before < 0.0) != (after < 0.0) {
                let share = before / (before - after);
                part.push([0, 1].map(|i| from[i] + share * (to[i] - from[i])));
            }
            if after >= 0.0 {
                part.push(to);
            }
            (from, before) = (to, after);
        }
        part
    }

    /// Lowest and highest value of a coordinate.
    #[must_use]
    pub fn span(&self, axis: usize) -> [f64; 2] {
        let values = || self.corners().iter().map(|corner| corner[axis]);
        [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Between which multiples of `step`, 0 to `max`, a line from `start` runs within the polygon, where it does.
    #[must_use]
    pub fn crossing(&self, start: [f64; 2], step: [f64; 2], max: f64) -> Option<[f64; 2]> {
        let (mut from, mut to) = (0.0_f64, max);
        for (i, &a) in self.corners().iter().enumerate() {
            let b = self.corners()[(i + 1) % self.count];
            let edge = [b[0] - a[0], b[1] - a[1]];
            // inside is left of the edge
            let at_start = edge[0] * (start[1] - a[1]) - edge[1] * (start[0] - a[0]);
            let change = edge[0] * step[1] - edge[1] * step[0];
            if change > 0.0 {
                from = from.max(-at_start / change);
            } else if change < 0.0 {
                to = to.min(-at_start / change);
            } else if at_start < 0.0 {
                return None;
            }
        }
        (from < to).then_some([from, to])
    }

    fn push(&mut self, corner: [f64; 2]) {
        if self.count < MAX_CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}
