//! Triangles in a tree of boxes, and where rays cross them, exactly.

use crate::ray_index::{END, Ray, RayIndex};
use belvedere_data::Result;
use belvedere_data::vector::{sub, to_f32};
use smallvec::SmallVec;

/// Widening of boxes and edges before rays are tested exactly, metres: more than f32 errs near a packet.
const ROOM: f64 = 1e-3;
/// The same as a share of coordinates: f32 rounds products of them by a tenth of this.
const ROUNDING: f64 = 1e-6;

/// Corners of a triangle, local metres.
pub type Corners = [[f64; 3]; 3];

/// Triangles that rays are traced against. Both sides count, and no ray slips through an edge that two triangles share.
pub struct TriangleTree {
    /// In the order of the index.
    triangles: Vec<Corners>,
    index: RayIndex,
    bounds: Option<[[f64; 3]; 2]>,
}

impl TriangleTree {
    /// Indexes triangles by their corners, (T, 3, 3), local metres.
    ///
    /// # Errors
    /// Those of [`RayIndex::new`] for a corner that is not finite.
    pub fn new(triangles: &[Corners]) -> Result<Self> {
        let boxes: Vec<_> = triangles.iter().map(bounding_box).collect();
        let index = RayIndex::new(&boxes)?;
        let triangles: Vec<Corners> =
            index.order().iter().filter_map(|&i| triangles.get(i as usize).copied()).collect();
        let bounds = bounds(&triangles);
        Ok(Self { triangles, index, bounds })
    }

    /// For each of [`TriangleTree::triangles`] its row among those given.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        self.index.order()
    }

    /// The tree of boxes around the triangles.
    #[must_use]
    pub fn index(&self) -> &RayIndex {
        &self.index
    }

    /// The triangles in the order of the tree.
    #[must_use]
    pub fn triangles(&self) -> &[Corners] {
        &self.triangles
    }

    /// Lowest and highest corner of all triangles, or `None` without any.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        self.bounds
    }

    /// Returns true if `ray` crosses a triangle within its ranges for which `counts` is true. `counts` gets the row of
    /// the triangle.
    #[must_use]
    pub fn any(&self, ray: &Ray, mut counts: impl FnMut(usize) -> bool) -> bool {
        let crossing = RayAxes::new(ray);
        self.index.any(ray, |row| self.range(&crossing, row, ray).is_some() && counts(row))
    }

    /// Finds the rays from `origins`, neighbours in space, along a unit vector without end that cross a triangle for
    /// which `counts` is true. `counts` gets the index of the ray and the row of the triangle, until it was true for
    /// the ray once. Each ray is found as [`TriangleTree::any`] finds it, but they walk through the tree together.
    pub(crate) fn any_of(
        &self,
        origins: &[[f64; 3]],
        direction: [f64; 3],
        mut counts: impl FnMut(usize, usize) -> bool,
    ) {
        let bound = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
            std::array::from_fn(|axis| origins.iter().map(|origin| origin[axis]).fold(start, pick))
        };
        let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
        let ray = |origin: [f64; 3]| Ray { origin, direction, ranges: [0.0, f64::INFINITY] };
        let middle = ray(std::array::from_fn(|axis| f64::midpoint(low[axis], high[axis])));
        let room = std::array::from_fn(|axis| 0.5 * (high[axis] - low[axis]) + ROOM);
        let axes = RayAxes::new(&middle);
        let mut groups: SmallVec<[RayGroup; 8]> =
            origins.chunks(RayGroup::LANES).map(|origins| RayGroup::new(origins, &axes)).collect();
        self.index.visit_beside(&middle, room, |row: usize| {
            let Some(triangle) = self.triangles.get(row) else { return f32::INFINITY };
            let shadow = Shadow::new(triangle.map(|corner| axes.seen(corner)));
            let mut left = 0;
            for (group, start) in groups.iter_mut().zip((0..).step_by(RayGroup::LANES)) {
                let mut near = group.rays_near(&shadow);
                while near != 0 {
                    let lane = near.trailing_zeros();
                    near &= near - 1;
                    let number = start + lane as usize;
                    let ray = ray(origins[number]);
                    if self.range(&RayAxes::new(&ray), row, &ray).is_some() && counts(number, row) {
                        group.left &= !(1 << lane);
                    }
                }
                left |= group.left;
            }
            if left == 0 { END } else { f32::INFINITY }
        });
    }

    /// The triangle for which `counts` is true that `ray` crosses first within its ranges, by its row, and the range;
    /// the lowest row where several are equal.
    #[must_use]
    pub fn nearest(&self, ray: &Ray, mut counts: impl FnMut(usize) -> bool) -> Option<(usize, f64)> {
        let crossing = RayAxes::new(ray);
        self.index.nearest(ray, |row| self.range(&crossing, row, ray).filter(|_| counts(row)))
    }

    /// Calls `visit` with the row of every triangle that `ray` crosses within its ranges, and the range, in no
    /// particular order.
    pub fn each(&self, ray: &Ray, mut visit: impl FnMut(usize, f64)) {
        let crossing = RayAxes::new(ray);
        self.index.each(ray, |row| {
            if let Some(range) = self.range(&crossing, row, ray) {
                visit(row, range);
            }
        });
    }

    /// Calls `visit` with the row of every triangle whose box may meet the box between two corners, local metres, in no
    /// particular order.
    pub fn each_near(&self, low: [f64; 3], high: [f64; 3], visit: impl FnMut(usize)) {
        self.index.visit_near(low, high, visit);
    }

    fn range(&self, crossing: &RayAxes, row: usize, ray: &Ray) -> Option<f64> {
        let range = crossing.range(self.triangles.get(row)?)?;
        (ray.ranges[0] <= range && range <= ray.ranges[1]).then_some(range)
    }
}

/// Lowest and highest corner of triangles, or `None` without any.
fn bounds(triangles: &[Corners]) -> Option<[[f64; 3]; 2]> {
    let first = *triangles.first()?.first()?;
    Some(triangles.as_flattened().iter().fold([first; 2], |[low, high], corner| {
        [std::array::from_fn(|i| low[i].min(corner[i])), std::array::from_fn(|i| high[i].max(corner[i]))]
    }))
}

/// The box around a triangle, rounded outward.
fn bounding_box([a, b, c]: &Corners) -> [[f32; 3]; 2] {
    let low = std::array::from_fn(|i| to_f32(a[i].min(b[i]).min(c[i])).next_down());
    let high = std::array::from_fn(|i| to_f32(a[i].max(b[i]).max(c[i])).next_up());
    [low, high]
}

/// A ray in the space where it runs along the third axis, in which a triangle is met where its shadow on the first two
/// axes holds the origin.
///
/// # Source
/// Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection". It gives the barycentric coordinates of Möller &
/// Trumbore 1997, but two triangles compute the side of a shared edge from the same numbers, so that no ray passes
/// between them. All in f64, hence without the paper's fallback.
struct RayAxes {
    origin: [f64; 3],
    axes: [usize; 3],
    shear: [f64; 3],
}

impl RayAxes {
    fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let longest = |a: usize, b: usize| if d[b].abs() > d[a].abs() { b } else { a };
        let z = longest(longest(0, 1), 2);
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        Self { origin: ray.origin, axes: [x, y, z], shear: [d[x] / d[z], d[y] / d[z], 1.0 / d[z]] }
    }

    /// Projects a place along the rays: returns its coordinates across the third axis.
    fn seen(&self, place: [f64; 3]) -> [f64; 2] {
        let ([x, y, z], [shear_x, shear_y, _]) = (self.axes, self.shear);
        let p = sub(place, self.origin);
        [p[x] - shear_x * p[z], p[y] - shear_y * p[z]]
    }

    /// Range at which the line of the ray crosses a triangle, negative behind its origin; `None` where it passes by or
    /// runs within its plane.
    fn range(&self, corners: &Corners) -> Option<f64> {
        let [x, y, z] = self.axes;
        let [shear_x, shear_y, scale_z] = self.shear;
        let [a, b, c] = corners.map(|corner| {
            let p = sub(corner, self.origin);
            [p[x] - shear_x * p[z], p[y] - shear_y * p[z], p[z]]
        });
        let side = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (side(b, c), side(c, a), side(a, b));
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let sum = u + v + w;
        (sum != 0.0).then(|| (u * a[2] + v * b[2] + w * c[2]) * scale_z / sum)
    }
}

/// A triangle as seen along rays, with edges that run counter-clockwise.
struct Shadow {
    corners: [[f32; 2]; 3],
    /// Distance outside each edge up to which a place may still be covered, times minus the length of the edge.
    margins: [f32; 3],
    low: [f32; 2],
    high: [f32; 2],
}

impl Shadow {
    fn new([a, b, c]: [[f64; 2]; 3]) -> Self {
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let corners = if turn < 0.0 { [a, c, b] } else { [a, b, c] };
        let largest = corners.as_flattened().iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
        let room = ROOM + ROUNDING * largest;
        let margin = |i: usize| {
            let (from, to) = (corners[i], corners[(i + 1) % 3]);
            to_f32(-room * ((to[0] - from[0]).abs() + (to[1] - from[1]).abs()))
        };
        Self {
            corners: corners.map(|corner| corner.map(to_f32)),
            margins: [0, 1, 2].map(margin),
            low: std::array::from_fn(|axis| to_f32(a[axis].min(b[axis]).min(c[axis]) - room)),
            high: std::array::from_fn(|axis| to_f32(a[axis].max(b[axis]).max(c[axis]) + room)),
        }
    }
}

/// Rays side by side, as seen along them.
struct RayGroup {
    /// Start of each ray, by axis; beyond the last ray a place that no triangle is near.
    starts: [[f32; Self::LANES]; 2],
    low: [f32; 2],
    high: [f32; 2],
    /// A bit for each ray for which nothing was found yet.
    left: u32,
}

impl RayGroup {
    const LANES: usize = 32;

    fn new(origins: &[[f64; 3]], axes: &RayAxes) -> Self {
        let mut group = Self {
            starts: [[f32::INFINITY; Self::LANES]; 2],
            low: [f32::INFINITY; 2],
            high: [f32::NEG_INFINITY; 2],
            left: 0,
        };
        for (lane, &origin) in origins.iter().take(Self::LANES).enumerate() {
            for (axis, value) in axes.seen(origin).map(to_f32).into_iter().enumerate() {
                group.starts[axis][lane] = value;
                group.low[axis] = group.low[axis].min(value);
                group.high[axis] = group.high[axis].max(value);
            }
            group.left |= 1 << lane;
        }
        group
    }

    /// The rays that are left and may cross a triangle, a bit each.
    #[inline]
    fn rays_near(&self, shadow: &Shadow) -> u32 {
        let meets = (0..2).all(|axis| shadow.low[axis] <= self.high[axis] && self.low[axis] <= shadow.high[axis]);
        if self.left == 0 || !meets {
            return 0;
        }
        let mut is_near = [true; Self::LANES];
        for (i, margin) in shadow.margins.into_iter().enumerate() {
            let ([x, y], [next_x, next_y]) = (shadow.corners[i], shadow.corners[(i + 1) % 3]);
            let (along_x, along_y) = (next_x - x, next_y - y);
            for (lane, is_near) in is_near.iter_mut().enumerate() {
                let beside = along_x * (self.starts[1][lane] - y) - along_y * (self.starts[0][lane] - x);
                *is_near &= beside >= margin;
            }
        }
        let bits = (0..Self::LANES).fold(0, |bits, lane| bits | u32::from(is_near[lane]) << lane);
        bits & self.left
    }
}
