//! The one index that rays are traced through: boxes around whatever may block, such as balls, discs and triangles.

use belvedere_data::vector::unit;
use belvedere_data::{Error, Result};
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::{CwBvh, bvh2_to_cwbvh::bvh2_to_cwbvh};
use obvhs::ploc::PlocBuilder;
use obvhs::ray::RayHit;
use obvhs::{Boundable, BvhBuildParams};

/// Padding of the boxes, as a share of the size of the scene: the tree works in f32 and a ray enters it at the box of the
/// scene, so that its slab test errs by a few units of 6e-8 of that size.
const BOX_PADDING: f64 = 1e-6;
/// Least padding, and how much farther than asked the tree looks, metres: it passes over boxes that a ray leaves, or stops
/// before, within its first 0.1 mm.
const TREE_SLACK: f64 = 1e-3;

/// A piece of a straight line, local metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where ranges count from.
    pub origin: [f64; 3],
    /// Unit vector.
    pub direction: [f64; 3],
    /// Ranges looked at, from and to, metres; the second may be infinite.
    pub ranges: [f64; 2],
}

impl Ray {
    /// The ray from `origin` along `direction` (any length) between two ranges, or `None` for one without direction or with a
    /// number that is not finite (an infinite end excepted).
    #[must_use]
    pub fn new(origin: [f64; 3], direction: [f64; 3], ranges: [f64; 2]) -> Option<Self> {
        let usable = origin.iter().all(|v| v.is_finite()) && ranges[0].is_finite() && !ranges[1].is_nan();
        usable.then_some(Self { origin, direction: unit(direction)?, ranges })
    }

    /// The point at `range`.
    #[must_use]
    pub fn at(&self, range: f64) -> [f64; 3] {
        std::array::from_fn(|i| self.origin[i] + range * self.direction[i])
    }
}

/// Boxes in a tree. It proposes boxes that a ray may meet and leaves the exact test to the caller, so that results never
/// depend on the tree.
pub struct RayIndex {
    tree: CwBvh,
    center: [f64; 3],
    half_size: [f64; 3],
}

/// The parts of a node of a [`RayIndex`].
pub struct Parts {
    /// What they are.
    pub parts: [Part; PARTS],
    /// Middles of their boxes, local metres, by axis.
    pub centers: [[f32; PARTS]; 3],
    /// Half sizes of their boxes, metres, by axis.
    pub half_sizes: [[f32; PARTS]; 3],
}

/// Most parts of a node of a [`RayIndex`].
pub const PARTS: usize = 8;

/// Words of a node: see [`RayIndex::node_words`].
pub const NODE_WORDS: usize = 20;

/// What a node of a [`RayIndex`] is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A place that is not taken.
    Nothing,
    /// Another node.
    Node(u32),
    /// Rows of the index.
    Rows {
        /// The lowest row.
        first: u32,
        /// How many there are.
        count: u32,
    },
}

struct PaddedBox(Aabb);

impl Boundable for PaddedBox {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl RayIndex {
    /// Indexes boxes given by their lowest and highest corner, local metres. The rows of the index are numbered in the
    /// order of the tree, see [`RayIndex::order`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a box that is not finite.
    pub fn new(boxes: &[[[f32; 3]; 2]]) -> Result<Self> {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corners in boxes {
            if !corners.as_flattened().iter().all(|v| v.is_finite()) {
                return Err(Error::InvalidParameter {
                    name: "box of an obstacle",
                    value: format!("{corners:?}"),
                    expected: "finite",
                });
            }
            for axis in 0..3 {
                low[axis] = low[axis].min(f64::from(corners[0][axis]));
                high[axis] = high[axis].max(f64::from(corners[1][axis]));
            }
        }
        if boxes.is_empty() {
            return Ok(Self { tree: CwBvh::default(), center: [0.0; 3], half_size: [0.0; 3] });
        }
        let center: [f64; 3] = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
        let size = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let padding = (BOX_PADDING * size).max(TREE_SLACK);
        let half_size = std::array::from_fn(|i| (high[i] - low[i]) / 2.0 + padding);
        let padded: Vec<PaddedBox> = boxes
            .iter()
            .map(|[low, high]| {
                let local = |corner: &[f32; 3], padding: f64| -> [f32; 3] {
                    to_f32(std::array::from_fn(|i| f64::from(corner[i]) - center[i] + padding))
                };
                PaddedBox(Aabb::new(local(low, -padding).into(), local(high, padding).into()))
            })
            .collect();
        let tree = search_tree(&padded);
        Ok(Self { tree, center, half_size })
    }

    /// For each row of the index, the box it was made from. Obstacles kept in this order lie close together in memory where
    /// they lie close together in space.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        &self.tree.primitive_indices
    }

    /// Whether `blocks` is true for any row whose box `ray` may meet.
    pub fn any(&self, ray: &Ray, mut blocks: impl FnMut(usize) -> bool) -> bool {
        let Some(entry) = self.enter(ray) else { return false };
        // only "in reach or not" counts here: a range of zero ends the search
        !self.tree.ray_traverse_miss(entry.ray, |_, row| if blocks(row) { 0.0 } else { f32::INFINITY })
    }

    /// The row whose `range` is least within the ranges of `ray`, and that range; the lowest row where several are equal.
    /// `range` gives the range at which the ray meets the obstacle of a row first, if it does.
    pub fn nearest(&self, ray: &Ray, mut range: impl FnMut(usize) -> Option<f64>) -> Option<(usize, f64)> {
        let entry = self.enter(ray)?;
        let mut best: Option<(usize, f64)> = None;
        self.tree.ray_traverse(entry.ray, &mut RayHit::none(), |_, row| {
            let Some(range) = range(row) else { return f32::INFINITY };
            let nearer = best.is_none_or(|(best_row, best)| (range, row) < (best, best_row));
            if !nearer || range < ray.ranges[0] || range > ray.ranges[1] {
                return f32::INFINITY;
            }
            best = Some((row, range));
            tree_reach(range - entry.start)
        });
        best
    }

    /// Calls `visit` for every row whose box `ray` may meet, in no particular order.
    pub fn each(&self, ray: &Ray, mut visit: impl FnMut(usize)) {
        if let Some(entry) = self.enter(ray) {
            self.tree.ray_traverse_anyhit(entry.ray, |_, row| visit(row));
        }
    }

    /// Calls `visit` for every row whose box may meet the box between two corners, local metres, in no particular order.
    pub fn near(&self, low: [f64; 3], high: [f64; 3], mut visit: impl FnMut(usize)) {
        // what the corners of nodes are rounded by
        let slack = (0..3).map(|axis| self.center[axis].abs() + self.half_size[axis]).fold(0.0, f64::max) * BOX_PADDING;
        let mut nodes: Vec<u32> = self.root().into_iter().collect();
        while let Some(parts) = nodes.pop().and_then(|node| self.parts(node)) {
            for (child, part) in parts.parts.into_iter().enumerate() {
                let meets = (0..3).all(|axis| {
                    let (center, half) =
                        (f64::from(parts.centers[axis][child]), f64::from(parts.half_sizes[axis][child]));
                    center - half - slack <= high[axis] && center + half + slack >= low[axis]
                });
                match part {
                    Part::Rows { first, count } if meets => (first..first + count).for_each(|row| visit(row as usize)),
                    Part::Node(node) if meets => nodes.push(node),
                    _ => {}
                }
            }
        }
    }

    /// Where the boxes of nodes count from, local metres.
    #[must_use]
    pub fn center(&self) -> [f64; 3] {
        self.center
    }

    /// Half the size of the box that holds every row, metres.
    #[must_use]
    pub fn half_size(&self) -> [f64; 3] {
        self.half_size
    }

    /// Number of the node that holds all others, if there is any row.
    #[must_use]
    pub fn root(&self) -> Option<u32> {
        (!self.tree.nodes.is_empty()).then_some(0)
    }

    /// The parts of a node and their boxes, each of which holds the boxes of all rows in it, but for what f32 rounds: a few units of
    /// 6e-8 of the largest coordinate.
    #[must_use]
    #[inline]
    pub fn parts(&self, node: u32) -> Option<Parts> {
        let node = self.tree.nodes.get(node as usize)?;
        let parts = std::array::from_fn(|child| {
            if node.is_child_empty(child) {
                Part::Nothing
            } else if node.is_leaf(child) {
                let (first, count) = node.child_primitives(child);
                Part::Rows { first, count }
            } else {
                Part::Node(node.child_node_index(child))
            }
        });
        let steps = node.compute_extent().to_array();
        let origin = node.p.to_array();
        let sides = [
            (&node.child_min_x, &node.child_max_x),
            (&node.child_min_y, &node.child_max_y),
            (&node.child_min_z, &node.child_max_z),
        ];
        let (mut centers, mut half_sizes) = ([[0.0; PARTS]; 3], [[0.0; PARTS]; 3]);
        for axis in 0..3 {
            let (low, high) = sides[axis];
            let half_step = 0.5 * steps[axis];
            #[expect(clippy::cast_possible_truncation, reason = "a rounding that callers allow for")]
            let start = (f64::from(origin[axis]) + self.center[axis]) as f32;
            for child in 0..PARTS {
                let (low, high) = (f32::from(low[child]), f32::from(high[child]));
                centers[axis][child] = start + half_step * (low + high);
                half_sizes[axis][child] = half_step * (high - low);
            }
        }
        Some(Parts { parts, centers, half_sizes })
    }

    /// The nodes as words, for devices that trace rays themselves, in the layout of compressed nodes (Ylitie, Karras & Laine 2017) with lowest and highest sides
    /// axis by axis: lowest corner from [`RayIndex::center`] (three f32); exponents of the steps along x, y, z and a bit for each part that is a
    /// node (four bytes); first node; first row; the eight parts (a byte each, for rows their count as bits above five bits of their
    /// offset); lowest and highest sides of the parts in steps, along x, y and z (eight bytes each).
    pub fn node_words(&self) -> impl ExactSizeIterator<Item = [u32; NODE_WORDS]> + '_ {
        self.tree.nodes.iter().map(|node| {
            let [x, y, z] = node.p.to_array().map(f32::to_bits);
            let [ex, ey, ez] = node.e;
            let mut words = [0; NODE_WORDS];
            let head =
                [x, y, z, u32::from_le_bytes([ex, ey, ez, node.imask]), node.child_base_idx, node.primitive_base_idx];
            words[..head.len()].copy_from_slice(&head);
            let sides = [
                &node.child_meta,
                &node.child_min_x,
                &node.child_max_x,
                &node.child_min_y,
                &node.child_max_y,
                &node.child_min_z,
                &node.child_max_z,
            ];
            let bytes = sides.into_iter().flat_map(|bytes| bytes.as_chunks::<4>().0);
            for (word, bytes) in words[head.len()..].iter_mut().zip(bytes) {
                *word = u32::from_le_bytes(*bytes);
            }
            words
        })
    }

    /// The part of a ray inside the box of the scene, as the tree takes it, or `None` where it misses the box.
    fn enter(&self, ray: &Ray) -> Option<Entry> {
        let local: [f64; 3] = std::array::from_fn(|i| ray.origin[i] - self.center[i]);
        let [mut start, mut end] = ray.ranges;
        if self.tree.nodes.is_empty() {
            return None;
        }
        for ((local, half_size), direction) in local.into_iter().zip(self.half_size).zip(ray.direction) {
            let (a, b) = ((-half_size - local) / direction, (half_size - local) / direction);
            // a ray that runs in a face of the box gives 0 / 0 = NaN, which `min` and `max` pass over: not clipped there
            start = start.max(a.min(b));
            end = end.min(a.max(b));
        }
        if !(start <= end) {
            return None;
        }
        // −0 + 0 = +0: the tree takes the slope of −0 for negative but its sign for positive, and would miss every box
        let direction = to_f32(ray.direction).map(|component| component + 0.0);
        let origin = to_f32(std::array::from_fn(|i| local[i] + start * ray.direction[i]));
        let ray = obvhs::ray::Ray::new(origin.into(), direction.into(), 0.0, tree_reach(end - start));
        Some(Entry { ray, start })
    }
}

/// The tree over `boxes`, which must not be empty: the steps of `build_cwbvh`, but for its check of the boxes in debug builds,
/// which allows for errors of 1e-5 and panics on sound trees wider than some hundred metres.
fn search_tree(boxes: &[PaddedBox]) -> CwBvh {
    let params = BvhBuildParams::medium_build();
    let rows = (0..).take(boxes.len()).collect();
    let mut binary = PlocBuilder::with_capacity(boxes.len()).build(
        params.ploc_search_distance,
        boxes,
        rows,
        params.sort_precision,
        params.search_depth_threshold,
    );
    ReinsertionOptimizer::default().run(&mut binary, params.reinsertion_batch_ratio, None);
    bvh2_to_cwbvh(&binary, params.max_prims_per_leaf.clamp(1, 3), true, false)
}

/// A ray as the tree takes it.
struct Entry {
    ray: obvhs::ray::Ray,
    /// Range at which the tree's ray starts.
    start: f64,
}

#[expect(clippy::cast_possible_truncation, reason = "the padding of the boxes exceeds the rounding")]
fn to_f32(v: [f64; 3]) -> [f32; 3] {
    v.map(|v| v as f32)
}

/// How far the tree must look to find every box that holds something within `range`.
#[expect(clippy::cast_possible_truncation, reason = "rounded up on purpose")]
fn tree_reach(range: f64) -> f32 {
    ((range + TREE_SLACK) as f32).next_up()
}
