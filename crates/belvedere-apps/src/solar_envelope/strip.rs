//! Maximum height of a column whose shadow stays off one protected edge at one sun, in closed form: the edge is swept
//! toward the sun.

use super::convex::ConvexPolygon;

/// An edge that sweeps less than this across the sun's direction is swept as a ray, metres.
const NARROW: f64 = 1e-6;
/// A column must share more than this with a strip, m², or with a ray, metres: a wall that stands flush with a fence
/// shades beside it.
const TOUCH: f64 = 1e-9;

/// The strip of the map from which things shade a protected edge at one sun, and the plane of heights above it up to
/// which they do not.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadingStrip {
    start: [f64; 3],
    along: [f64; 3],
    /// Unit vector on the map to the sun.
    to_sun: [f64; 2],
    /// Tangent of the sun's elevation.
    slope: f64,
    /// Signed width of the swept edge across the sun's direction, metres.
    across: f64,
}

impl ShadingStrip {
    /// The strip of the edge from `a` to `b`, local metres, at a sun that stands in the direction `to_sun` on the map,
    /// with the tangent of its elevation.
    pub(super) fn new(a: [f64; 3], b: [f64; 3], to_sun: [f64; 2], slope: f64) -> Self {
        let along = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        Self { start: a, along, to_sun, slope, across: along[0] * to_sun[1] - along[1] * to_sun[0] }
    }

    fn is_ray(&self) -> bool {
        self.across.abs() < NARROW
    }

    /// Share of the way along the edge, and distance from it toward the sun, at a place.
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (dx, dy) = (x - self.start[0], y - self.start[1]);
        let share = (dx * self.to_sun[1] - dy * self.to_sun[0]) / self.across;
        let distance = -(dx * self.along[1] - dy * self.along[0]) / self.across;
        [share, distance]
    }

    /// The part of a piece of the map that lies on the strip.
    fn part_of(&self, piece: &ConvexPolygon) -> ConvexPolygon {
        let share = |p| self.place(p)[0];
        piece.clipped(|p| self.place(p)[1]).clipped(share).clipped(|p| 1.0 - share(p))
    }

    /// Returns the lowest and highest x of the strip on a piece of the plan; `None` if it misses the piece.
    pub(super) fn span_x(&self, piece: &ConvexPolygon) -> Option<[f64; 2]> {
        if self.is_ray() {
            let [a, b] = self.ends();
            let spans = [a, b].map(|end| {
                let [x, y, _] = end;
                piece.crossing([x, y], self.to_sun, f64::INFINITY).map(|range| range.map(|t| x + t * self.to_sun[0]))
            });
            // the edge itself lies between the two
            let on_edge = piece.crossing([a[0], a[1]], [self.along[0], self.along[1]], 1.0);
            let on_edge = on_edge.map(|range| range.map(|share| a[0] + share * self.along[0]));
            return spans
                .into_iter()
                .chain([on_edge])
                .flatten()
                .map(|[a, b]| [a.min(b), a.max(b)])
                .reduce(|known, more| [known[0].min(more[0]), known[1].max(more[1])]);
        }
        let part = self.part_of(piece);
        (!part.corners().is_empty()).then(|| part.span(0))
    }

    fn ends(&self) -> [[f64; 3]; 2] {
        [self.start, [0, 1, 2].map(|i| self.start[i] + self.along[i])]
    }

    /// Returns the maximum height, local metres, of objects over a piece of the plan that do not shade the edge; `None`
    /// if none there can shade it.
    pub(super) fn limit(&self, piece: &ConvexPolygon) -> Option<f64> {
        if self.is_ray() {
            return self.limit_of_ray(piece);
        }
        // most pieces lie beside the strip
        let mut outside = [true; 3];
        for &corner in piece.corners() {
            let [share, distance] = self.place(corner);
            outside = [outside[0] && share <= 0.0, outside[1] && share >= 1.0, outside[2] && distance <= 0.0];
        }
        if outside.contains(&true) {
            return None;
        }
        let part = self.part_of(piece);
        if !(part.area() > TOUCH) {
            return None;
        }
        // linear over the part, hence least at a corner
        let height = |&corner: &[f64; 2]| {
            let [share, distance] = self.place(corner);
            self.start[2] + share.clamp(0.0, 1.0) * self.along[2] + distance.max(0.0) * self.slope
        };
        part.corners().iter().map(height).reduce(f64::min)
    }

    /// Limit of an edge that runs toward the sun, or of a point: from the region behind its ends, and on it.
    fn limit_of_ray(&self, piece: &ConvexPolygon) -> Option<f64> {
        let behind = |[x, y, z]: [f64; 3]| {
            let [from, to] = piece.crossing([x, y], self.to_sun, f64::INFINITY)?;
            (to - from > TOUCH).then_some(z + from * self.slope)
        };
        let on_edge = || {
            let [from, to] = piece.crossing([self.start[0], self.start[1]], [self.along[0], self.along[1]], 1.0)?;
            let length = (to - from) * self.along[0].hypot(self.along[1]);
            let height = |share: f64| self.start[2] + share * self.along[2];
            (length > TOUCH).then(|| height(from).min(height(to)))
        };
        self.ends().map(behind).into_iter().chain([on_edge()]).flatten().reduce(f64::min)
    }
}
