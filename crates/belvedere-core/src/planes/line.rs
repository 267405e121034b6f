//! Straight lines in plan.

use belvedere_data::cast::to_index;

/// A piece of a straight line in plan, metres from the corner of its block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PlanLine {
    /// A point of it, its range 0.
    pub(super) point: [f64; 2],
    /// Unit vector along it: the roof lies to the left.
    pub(super) along: [f64; 2],
    /// Ranges of both ends.
    pub(super) ends: [f64; 2],
}

impl PlanLine {
    /// Unit vector to the right, away from the roof.
    pub(super) fn outward(&self) -> [f64; 2] {
        [self.along[1], -self.along[0]]
    }

    /// Range along the line and distance to its right.
    pub(super) fn of(&self, p: [f64; 2]) -> [f64; 2] {
        let [x, y] = [p[0] - self.point[0], p[1] - self.point[1]];
        let [a, b] = self.along;
        [x * a + y * b, x * b - y * a]
    }

    /// The point at a range, so far to the right.
    pub(super) fn at(&self, range: f64, right: f64) -> [f64; 2] {
        let [a, b] = self.along;
        [self.point[0] + range * a + right * b, self.point[1] + range * b - right * a]
    }

    /// The line so far to the right.
    pub(super) fn moved(&self, right: f64) -> Self {
        Self { point: self.at(0.0, right), ..*self }
    }

    /// The same line the other way, with the roof to its right.
    pub(super) fn turned(&self) -> Self {
        Self { point: self.point, along: self.along.map(|v| -v), ends: [-self.ends[1], -self.ends[0]] }
    }

    /// Length, metres.
    pub(super) fn length(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    /// Both ends.
    pub(super) fn end_points(&self) -> [[f64; 2]; 2] {
        self.ends.map(|range| self.at(range, 0.0))
    }

    /// Pieces of about `of` metres that it is cut into.
    pub(super) fn pieces(&self, of: f64) -> Pieces {
        let length = self.length();
        let count = to_index((length / of).ceil().max(1.0)).min(10_000);
        Pieces { first: self.ends[0], length: length / count as f64, count }
    }

    /// Range on this line at which the other one, without its ends, crosses it; `None` where both run within 15° of
    /// each other.
    pub(super) fn crossing(&self, other: &Self) -> Option<f64> {
        let across = self.along[0] * other.along[1] - self.along[1] * other.along[0];
        let [x, y] = [other.point[0] - self.point[0], other.point[1] - self.point[1]];
        (across.abs() > 0.26).then(|| (x * other.along[1] - y * other.along[0]) / across)
    }

    /// The line through `points` that is nearest to them by squares, along `about`, with the ranges of the outermost,
    /// and the root mean square distance. `None` for fewer than two.
    pub(super) fn fit(points: impl Iterator<Item = [f64; 2]> + Clone, about: [f64; 2]) -> Option<(Self, f64)> {
        let (mut n, mut sum) = (0.0, [0.0; 2]);
        for p in points.clone() {
            n += 1.0;
            sum = [sum[0] + p[0], sum[1] + p[1]];
        }
        if n < 2.0 {
            return None;
        }
        let point = sum.map(|v| v / n);
        let mut m = [0.0; 3];
        for p in points.clone() {
            let [x, y] = [p[0] - point[0], p[1] - point[1]];
            m = [m[0] + x * x, m[1] + x * y, m[2] + y * y];
        }
        let angle = 0.5 * (2.0 * m[1]).atan2(m[0] - m[2]);
        let mut along = [angle.cos(), angle.sin()];
        if along[0] * about[0] + along[1] * about[1] < 0.0 {
            along = along.map(|v| -v);
        }
        let mut line = Self { point, along, ends: [f64::INFINITY, f64::NEG_INFINITY] };
        let mut squares = 0.0;
        for p in points {
            let [t, d] = line.of(p);
            line.ends = [line.ends[0].min(t), line.ends[1].max(t)];
            squares += d * d;
        }
        Some((line, (squares / n).sqrt()))
    }
}

/// Pieces of equal length of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pieces {
    /// Range at which the first one begins, metres.
    first: f64,
    /// Length of each, metres.
    length: f64,
    pub(super) count: usize,
}

impl Pieces {
    /// Number of the piece of a range.
    pub(super) fn number(&self, range: f64) -> usize {
        to_index((range - self.first) / self.length).min(self.count - 1)
    }

    /// Range at which a piece begins.
    pub(super) fn start(&self, piece: usize) -> f64 {
        self.first + piece as f64 * self.length
    }
}

/// Area below which a polygon closes nothing, m².
pub(super) const SLIVER: f64 = 0.005;

/// The part of a convex polygon in plan where `side` is not above zero, of a linear function.
pub(super) fn clip(polygon: &[[f64; 2]], side: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (a, b) = (side(p), side(q));
        if a <= 0.0 {
            kept.push(p);
        }
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            let share = a / (a - b);
            kept.push([p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])]);
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

/// Area of a polygon in plan, counter-clockwise above zero, m².
pub(super) fn area(polygon: &[[f64; 2]]) -> f64 {
    let Some(&o) = polygon.first() else { return 0.0 };
    let cross = |p: [f64; 2], q: [f64; 2]| (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
    polygon.windows(2).map(|pair| cross(pair[0], pair[1])).sum::<f64>() / 2.0
}
