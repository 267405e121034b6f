//! Exact visibility: the first surface on a ray through a scene, and obstacles between two points.

use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::{CwBvh, bvh2_to_cwbvh::bvh2_to_cwbvh};
use obvhs::ploc::PlocBuilder;
use obvhs::ray::{Ray, RayHit};
use obvhs::{Boundable, BvhBuildParams};
use rayon::prelude::*;

use crate::scene::TriangleScene;
use crate::vector::{add_scaled, cross, dot, length, sub, unit};

/// Minimum distance of a blocking surface from the start of a ray or the end of a segment: 1 µm.
///
/// A point computed to lie on a triangle is off it by about 1e-9 m in a national grid. A µm is more than this error,
/// and far less than the resolution of a scanner. A point on a surface is therefore not hidden by that surface, unless
/// the ray starts on its far side.
pub const CONTACT: f64 = 1e-6;

/// Padding of the boxes of the search tree, as a share of the size of the scene.
///
/// The tree works in f32. A ray enters it at the box of the scene, so no number exceeds the size of the scene. The slab
/// test errs by a few units of 6e-8 of that size. A padding a hundred times larger costs nothing and loses no triangle.
const BOX_PADDING: f64 = 1e-5;
/// Minimum padding of boxes, and margin beyond the given range in which the tree searches, metres. The tree passes over
/// boxes within the first 0.1 mm of a ray, or behind its end.
const TREE_SLACK: f64 = 1e-3;

/// First surface on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the origin of the ray, metres.
    pub range: f64,
    /// Index of the triangle; the lowest of several at the same range.
    pub triangle: u32,
}

/// Index of a scene that answers ray queries exactly.
///
/// The search tree only proposes triangles; each is tested in f64 against its original corners. The test is watertight:
/// a ray through a shared edge meets at least one of the two triangles. Results do not depend on the tree, and
/// therefore not on the number of threads that built it. Both sides of a triangle block.
#[derive(Debug)]
pub struct Truth {
    /// Triangles in the order of the tree's leaves, with corners relative to `centre`.
    triangles: Vec<IndexedTriangle>,
    centre: [f64; 3],
    /// Half the size of the box about `centre` that contains every triangle, padding included, metres.
    half_size: [f64; 3],
    tree: CwBvh,
}

#[derive(Clone, Copy, Debug)]
struct IndexedTriangle {
    corners: [[f64; 3]; 3],
    index: u32,
}

struct PaddedBox(Aabb);

impl Boundable for PaddedBox {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Truth {
    /// Indexes `scene`. Triangles with missing or non-finite vertices are left out; a scene without triangles blocks
    /// nothing.
    #[must_use]
    pub fn new(scene: &TriangleScene) -> Self {
        let given = (0_u32..).take(scene.triangles.len());
        let usable = given.filter_map(|index| {
            let corners = scene.corners(index as usize)?;
            corners.as_flattened().iter().all(|v| v.is_finite()).then_some(IndexedTriangle { corners, index })
        });
        let mut triangles: Vec<IndexedTriangle> = usable.collect();
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in triangles.iter().flat_map(|t| t.corners) {
            for axis in 0..3 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        if triangles.is_empty() {
            return Self { triangles, centre: [0.0; 3], half_size: [0.0; 3], tree: CwBvh::default() };
        }
        let centre: [f64; 3] = std::array::from_fn(|i| low[i] / 2.0 + high[i] / 2.0);
        let padding = (BOX_PADDING * length(sub(high, low))).max(TREE_SLACK);
        let half_size = std::array::from_fn(|i| (high[i] - low[i]) / 2.0 + padding);
        for triangle in &mut triangles {
            triangle.corners = triangle.corners.map(|corner| sub(corner, centre));
        }
        let boxes: Vec<PaddedBox> = triangles.iter().map(|t| padded_box(&t.corners, padding)).collect();
        let tree = search_tree(&boxes);
        let in_tree_order = tree.primitive_indices.iter().filter_map(|&i| triangles.get(i as usize).copied()).collect();
        Self { triangles: in_tree_order, centre, half_size, tree }
    }

    /// Returns the first triangle within `max_range` metres (may be infinite) from `origin` along `direction`; `None`
    /// without one. The length of `direction` does not matter. A direction of zero or non-finite length, or any NaN,
    /// meets nothing. Surfaces nearer than [`CONTACT`] to the origin are ignored.
    #[must_use]
    pub fn first_hit(&self, origin: [f64; 3], direction: [f64; 3], max_range: f64) -> Option<Hit> {
        self.first_hit_between(origin, unit(direction)?, CONTACT, max_range)
    }

    /// Returns the first hits of many rays, in parallel. Each ray starts at a row of `origins`, (N, 3), along the row
    /// of `directions`, (N, 3) ([`Truth::first_hit`]). Surplus rows of the longer one are ignored.
    #[must_use]
    pub fn first_hits(&self, origins: &[[f64; 3]], directions: &[[f64; 3]], max_range: f64) -> Vec<Option<Hit>> {
        origins
            .par_iter()
            .zip(directions)
            .map(|(&origin, &direction)| self.first_hit(origin, direction, max_range))
            .collect()
    }

    /// Returns true if a triangle lies between the two points, farther than [`CONTACT`] from both.
    #[must_use]
    pub fn occluded(&self, from: [f64; 3], to: [f64; 3]) -> bool {
        let between = sub(to, from);
        unit(between).is_some_and(|direction| self.blocked(from, direction, length(between) - CONTACT))
    }

    /// Returns [`Truth::occluded`] between `eye` and each of `points`, (N, 3), in parallel.
    #[must_use]
    pub fn occluded_each(&self, points: &[[f64; 3]], eye: [f64; 3]) -> Vec<bool> {
        points.par_iter().map(|&point| self.occluded(point, eye)).collect()
    }

    /// Returns true if a triangle lies from `from` towards `direction`, such as towards the sun, farther than
    /// [`CONTACT`].
    #[must_use]
    pub fn occluded_towards(&self, from: [f64; 3], direction: [f64; 3]) -> bool {
        unit(direction).is_some_and(|direction| self.blocked(from, direction, f64::INFINITY))
    }

    /// Returns [`Truth::occluded_towards`] of each of `points`, (N, 3), in parallel.
    #[must_use]
    pub fn occluded_towards_each(&self, points: &[[f64; 3]], direction: [f64; 3]) -> Vec<bool> {
        points.par_iter().map(|&point| self.occluded_towards(point, direction)).collect()
    }

    /// Returns the first triangle at a range from `min_range` to `max_range` along the unit vector `direction`.
    pub(crate) fn first_hit_between(
        &self,
        origin: [f64; 3],
        direction: [f64; 3],
        min_range: f64,
        max_range: f64,
    ) -> Option<Hit> {
        let local = sub(origin, self.centre);
        let entry = self.enter(local, direction, min_range, max_range)?;
        let mut best: Option<Hit> = None;
        self.tree.ray_traverse(entry.ray, &mut RayHit::none(), |_, leaf| {
            let Some(triangle) = self.triangles.get(leaf) else { return f32::INFINITY };
            let Some(range) = crossing(&triangle.corners, local, direction) else { return f32::INFINITY };
            let hit = Hit { range, triangle: triangle.index };
            let nearer = best.is_none_or(|b| (range, hit.triangle) < (b.range, b.triangle));
            if !nearer || range < min_range || range > max_range {
                return f32::INFINITY;
            }
            best = Some(hit);
            tree_reach(range - entry.start)
        });
        best
    }

    /// Returns true if a triangle lies at a range from [`CONTACT`] to `max_range` along the unit vector `direction`.
    fn blocked(&self, origin: [f64; 3], direction: [f64; 3], max_range: f64) -> bool {
        let local = sub(origin, self.centre);
        let Some(entry) = self.enter(local, direction, CONTACT, max_range) else { return false };
        !self.tree.ray_traverse_miss(entry.ray, |_, leaf| {
            let range = self.triangles.get(leaf).and_then(|t| crossing(&t.corners, local, direction));
            // Only "in reach or not" counts here. Any value below the reach of the ray stops the search.
            if range.is_some_and(|r| (CONTACT..=max_range).contains(&r)) { 0.0 } else { f32::INFINITY }
        })
    }

    /// Returns the part of a ray inside the box of the scene, in the form of the tree; `None` for a ray that misses the
    /// box.
    fn enter(&self, local: [f64; 3], direction: [f64; 3], min_range: f64, max_range: f64) -> Option<TruthRay> {
        let (mut start, mut end) = (min_range, max_range);
        if self.triangles.is_empty() || max_range.is_nan() || !local.iter().all(|v| v.is_finite()) {
            return None;
        }
        for axis in 0..3 {
            let inverse = 1.0 / direction[axis];
            let (a, b) =
                ((-self.half_size[axis] - local[axis]) * inverse, (self.half_size[axis] - local[axis]) * inverse);
            // For a ray in a face of the box 0 · ∞ = NaN, which `min` and `max` ignore. The ray is not clipped at that
            // face.
            start = start.max(a.min(b));
            end = end.min(a.max(b));
        }
        if start > end {
            return None;
        }
        // −0 + 0 = +0: the tree takes the slope of −0 for negative but its sign for positive, and would miss every box.
        let tree_direction = to_f32(direction).map(|component| component + 0.0);
        let ray = Ray::new(
            to_f32(add_scaled(local, direction, start)).into(),
            tree_direction.into(),
            0.0,
            tree_reach(end - start),
        );
        Some(TruthRay { ray, start })
    }
}

/// Ray in the form of the search tree.
struct TruthRay {
    ray: Ray,
    /// Range at which the tree's ray starts, metres.
    start: f64,
}

/// Returns the range at which the line through `origin` along the unit vector `direction` crosses a triangle, metres.
/// It is negative behind the origin. `None` for a line that passes by or runs within the plane of the triangle.
///
/// The three terms are the volumes between the ray and each edge. Two triangles compute the volume of a shared edge
/// from the same numbers with opposite sign, so no ray slips between them.
fn crossing(corners: &[[f64; 3]; 3], origin: [f64; 3], direction: [f64; 3]) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| sub(corner, origin));
    let sides = [dot(direction, cross(b, c)), dot(direction, cross(c, a)), dot(direction, cross(a, b))];
    if !(sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)) {
        return None;
    }
    let normal = cross(sub(b, a), sub(c, a));
    let steepness = dot(direction, normal);
    (steepness != 0.0).then(|| dot(a, normal) / steepness)
}

/// Returns a search tree over `boxes`, which must not be empty.
///
/// The steps are those of the crate's own `build_cwbvh` without its final check in debug builds. That check compares
/// boxes to a fixed 1e-5, which f32 cannot resolve farther than about 80 m from the centre. It would panic on sound
/// trees of larger scenes.
fn search_tree(boxes: &[PaddedBox]) -> CwBvh {
    let params = BvhBuildParams::medium_build();
    let mut binary = PlocBuilder::with_capacity(boxes.len()).build(
        params.ploc_search_distance,
        boxes,
        (0..).take(boxes.len()).collect(),
        params.sort_precision,
        params.search_depth_threshold,
    );
    ReinsertionOptimizer::default().run(&mut binary, params.reinsertion_batch_ratio, None);
    bvh2_to_cwbvh(&binary, params.max_prims_per_leaf.clamp(1, 3), true, false)
}

fn padded_box(corners: &[[f64; 3]; 3], padding: f64) -> PaddedBox {
    let [a, b, c] = corners;
    let low = std::array::from_fn(|i| a[i].min(b[i]).min(c[i]) - padding);
    let high = std::array::from_fn(|i| a[i].max(b[i]).max(c[i]) + padding);
    PaddedBox(Aabb::new(to_f32(low).into(), to_f32(high).into()))
}

/// Rounds local coordinates for the search tree, whose padded boxes allow for the rounding.
#[expect(clippy::cast_possible_truncation, reason = "the padding of the boxes exceeds the rounding")]
fn to_f32(local: [f64; 3]) -> [f32; 3] {
    local.map(|v| v as f32)
}

/// Returns the range up to which the tree must search to find every box with a triangle within `range`, metres.
#[expect(clippy::cast_possible_truncation, reason = "rounded up on purpose")]
fn tree_reach(range: f64) -> f32 {
    ((range + TREE_SLACK) as f32).next_up()
}
