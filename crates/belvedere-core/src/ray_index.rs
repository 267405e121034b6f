//! The one index that rays are traced through: boxes around whatever may block, such as balls, discs and triangles.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod nearest_first;
mod node_parts;
mod open_node;
mod search_tree;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod simd128;
mod walk;

pub(crate) use nearest_first::BoxReach;
pub use node_parts::{NodePart, NodeParts, PARTS};
pub(crate) use open_node::{OpenNode, PartSides};

pub(crate) use walk::Visit;

use crate::instructions::Instructions;
use belvedere_data::cast::to_row;
use belvedere_data::model::TreeParts;
use belvedere_data::vector::{dot, length, sub, to_f32, unit};
use belvedere_data::{Error, Parameter, Result};
use node_parts::part_of;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::node::CwBvhNode;
use search_tree::search_tree;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use simd128::RaySimd128 as RayPlain;
use walk::{TreeRay, walk};

/// Scalar test of boxes for machines without AVX2.
#[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
type RayPlain = walk::RayScalar<false>;

/// Padding of the boxes, as a share of the size of the scene. The tree works in f32, and a ray enters it at the box of
/// the scene, so that its slab test errs by a few units of 6e-8 of that size.
const BOX_PADDING: f64 = 1e-6;
/// Minimum padding, and how much farther than requested the tree searches, metres: far more than f32 errs within some
/// hundred metres.
const TREE_SLACK: f64 = 1e-3;
/// Range that ends a walk: no range is below zero.
pub(crate) const END: f32 = -1.0;

/// A piece of a straight line, local metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Point at range 0.
    pub origin: [f64; 3],
    /// Unit vector.
    pub direction: [f64; 3],
    /// Ranges looked at, from and to, metres; the second may be infinite.
    pub ranges: [f64; 2],
}

impl Ray {
    /// The ray from `origin` along `direction` (any length) between two ranges, or `None` for one without direction or
    /// with a number that is not finite (an infinite end excepted).
    #[must_use]
    pub fn new(origin: [f64; 3], direction: [f64; 3], ranges: [f64; 2]) -> Option<Self> {
        let usable = origin.iter().all(|v| v.is_finite()) && ranges[0].is_finite() && !ranges[1].is_nan();
        usable.then_some(Self { origin, direction: unit(direction)?, ranges })
    }

    /// The ray between two ends, `None` as for [`Ray::new`]. It starts at the end that [`in_order`] puts first, so that
    /// it is the same to the last bit whichever end is given first.
    #[must_use]
    pub fn between(a: [f64; 3], b: [f64; 3]) -> Option<Self> {
        let [from, to] = in_order([a, b]);
        let across = sub(to, from);
        Self::new(from, across, [0.0, length(across)])
    }

    /// The point at `range`.
    #[must_use]
    pub fn at(&self, range: f64) -> [f64; 3] {
        std::array::from_fn(|i| self.origin[i] + range * self.direction[i])
    }
}

/// Returns two ends of a line in a fixed order: first the one nearer to the local origin, where rounding is smaller
/// than at a distant viewer. If both are equally far, the order is by x, then y, then z.
///
/// Rounding depends on the end from which a line is tested. With one order for all, observer and target can change
/// places, and no answer changes.
#[must_use]
pub fn in_order([a, b]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    let key = |end: [f64; 3]| (dot(end, end), end);
    if key(b) < key(a) { [b, a] } else { [a, b] }
}

/// Boxes in a tree. It proposes boxes that a ray may meet and leaves the exact test to the caller, so that results
/// never depend on the tree.
pub struct RayIndex {
    tree: CwBvh,
    center: [f64; 3],
    half_size: [f64; 3],
    instructions: Instructions,
}

/// Words of a node: see [`RayIndex::node_words`].
pub const NODE_WORDS: usize = 20;

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
                return Err(Error::invalid(Parameter::Obstacle, format!("{corners:?}"), "finite"));
            }
            for axis in 0..3 {
                low[axis] = low[axis].min(f64::from(corners[0][axis]));
                high[axis] = high[axis].max(f64::from(corners[1][axis]));
            }
        }
        if boxes.is_empty() {
            let instructions = Instructions::detect();
            return Ok(Self { tree: CwBvh::default(), center: [0.0; 3], half_size: [0.0; 3], instructions });
        }
        let center: [f64; 3] = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
        let size = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let padding = (BOX_PADDING * size).max(TREE_SLACK);
        let half_size = std::array::from_fn(|i| (high[i] - low[i]) / 2.0 + padding);
        let padded: Vec<Aabb> = boxes
            .iter()
            .map(|[low, high]| {
                let local = |corner: &[f32; 3], padding: f64| -> [f32; 3] {
                    std::array::from_fn(|i| to_f32(f64::from(corner[i]) - center[i] + padding))
                };
                Aabb::new(local(low, -padding).into(), local(high, padding).into())
            })
            .collect();
        let tree = search_tree(&padded);
        Ok(Self { tree, center, half_size, instructions: Instructions::detect() })
    }

    /// For each row of the index, the box it was made from. Obstacles kept in this order lie close together in memory
    /// where they lie close together in space.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        &self.tree.primitive_indices
    }

    /// Returns true if `blocks` is true for any row whose box `ray` may meet.
    pub fn any(&self, ray: &Ray, mut blocks: impl FnMut(usize) -> bool) -> bool {
        let Some(entry) = self.enter(ray, [0.0; 3]) else { return false };
        let mut any = false;
        self.walk(entry.ray, |row| {
            any = blocks(row);
            if any { END } else { f32::INFINITY }
        });
        any
    }

    /// Visits the rows whose boxes may be met by a ray parallel to `ray`, between the same ranges, that starts up to
    /// `room` metres from its origin along each axis. The order is roughly by range.
    pub(crate) fn visit_beside(&self, ray: &Ray, room: [f64; 3], visit: impl Visit) {
        if let Some(entry) = self.enter(ray, room) {
            self.walk(entry.ray, visit);
        }
    }

    /// The row whose `range` is least within the ranges of `ray`, and that range; the lowest row where several are
    /// equal. `range` gives the range at which the ray meets the obstacle of a row first, if it does.
    pub fn nearest(&self, ray: &Ray, mut range: impl FnMut(usize) -> Option<f64>) -> Option<(usize, f64)> {
        let entry = self.enter(ray, [0.0; 3])?;
        let mut best: Option<(usize, f64)> = None;
        self.walk(entry.ray, |row| {
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
        if let Some(entry) = self.enter(ray, [0.0; 3]) {
            self.walk(entry.ray, |row| {
                visit(row);
                f32::INFINITY
            });
        }
    }

    #[inline]
    fn walk(&self, ray: TreeRay, visit: impl Visit) {
        match self.instructions {
            Instructions::Scalar => walk::<RayPlain>(&self.tree.nodes, ray, visit),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => avx2::run(&self.tree.nodes, ray, visit),
        }
    }

    /// Calls `visit` for every row whose box may meet the box between two corners, local metres, in no particular
    /// order.
    pub fn visit_near(&self, low: [f64; 3], high: [f64; 3], mut visit: impl FnMut(usize)) {
        let slack = self.slack();
        let mut nodes: Vec<u32> = self.root().into_iter().collect();
        while let Some(parts) = nodes.pop().and_then(|node| self.parts(node)) {
            for (child, part) in parts.parts.into_iter().enumerate() {
                let meets = (0..3).all(|axis| {
                    let (center, half) =
                        (f64::from(parts.centers[axis][child]), f64::from(parts.half_sizes[axis][child]));
                    center - half - slack <= high[axis] && center + half + slack >= low[axis]
                });
                match part {
                    NodePart::Rows { first, count } if meets => {
                        (first..first + count).for_each(|row| visit(row as usize));
                    }
                    NodePart::Node(node) if meets => nodes.push(node),
                    _ => {}
                }
            }
        }
    }

    /// Rounding of the corners of nodes, metres.
    fn slack(&self) -> f64 {
        (0..3).map(|axis| self.center[axis].abs() + self.half_size[axis]).fold(0.0, f64::max) * BOX_PADDING
    }

    /// Returns the origin of the boxes of nodes, local metres.
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

    /// Returns the parts of a node and their boxes. Each box holds the boxes of all rows in it, apart from rounding of
    /// f32: a few units of 6e-8 of the largest coordinate.
    #[must_use]
    #[inline]
    pub fn parts(&self, node: u32) -> Option<NodeParts> {
        let node = self.tree.nodes.get(node as usize)?;
        let parts = std::array::from_fn(|child| part_of(node, child));
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
            let start = to_f32(f64::from(origin[axis]) + self.center[axis]);
            for child in 0..PARTS {
                let (low, high) = (f32::from(low[child]), f32::from(high[child]));
                centers[axis][child] = start + half_step * (low + high);
                half_sizes[axis][child] = half_step * (high - low);
            }
        }
        Some(NodeParts { parts, centers, half_sizes })
    }

    /// Returns the nodes as words, for devices that trace rays themselves, in the layout of compressed nodes (Ylitie,
    /// Karras & Laine 2017). Lowest and highest sides are stored axis by axis:
    ///
    /// - lowest corner from [`RayIndex::center`] (three f32);
    /// - exponents of the steps along x, y, z, and a bit for each part that is a node (four bytes);
    /// - first node; first row;
    /// - the eight parts (a byte each; for rows their count as bits above five bits of their offset);
    /// - lowest and highest sides of the parts in steps, along x, y and z (eight bytes each).
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

    /// The tree as numbers.
    pub(crate) fn to_parts(&self) -> TreeParts {
        let (nodes, order) = (self.node_words().collect(), self.order().to_vec());
        TreeParts { nodes, order, around: [self.center, self.half_size] }
    }

    /// The tree of such numbers over `count` boxes.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] where they are not those of a tree: parts beyond its nodes or boxes, or above them.
    pub(crate) fn from_parts(parts: TreeParts, count: usize) -> Result<Self> {
        let TreeParts { nodes, order, around: [center, half_size] } = parts;
        let nodes: Vec<CwBvhNode> = nodes.iter().map(node_of_words).collect();
        let total_aabb = Aabb::new(half_size.map(|v| to_f32(-v)).into(), half_size.map(to_f32).into());
        let tree = CwBvh { nodes, primitive_indices: order, total_aabb, ..CwBvh::default() };
        let index = Self { tree, center, half_size, instructions: Instructions::detect() };
        if index.is_sound(count) { Ok(index) } else { Err(damaged_tree()) }
    }

    /// Returns true if every part of a node lies within the tree and below its node, so that every walk ends.
    fn is_sound(&self, count: usize) -> bool {
        let nodes = self.tree.nodes.len();
        let is_within = |number: u32, part: NodePart| match part {
            NodePart::Nothing => true,
            NodePart::Node(below) => below > number && (below as usize) < nodes,
            NodePart::Rows { first, count: rows } => first as usize + rows as usize <= count,
        };
        let numbers = 0..to_row(nodes);
        let mut seen = vec![false; count];
        self.tree.primitive_indices.len() == count
            && self
                .tree
                .primitive_indices
                .iter()
                .all(|&row| seen.get_mut(row as usize).is_some_and(|seen| !std::mem::replace(seen, true)))
            && (count == 0 || nodes > 0)
            && [self.center, self.half_size].as_flattened().iter().all(|v| v.is_finite())
            && numbers.into_iter().all(|number| {
                self.parts(number).is_some_and(|found| found.parts.into_iter().all(|part| is_within(number, part)))
            })
    }

    /// The part of a ray inside the box of the scene, larger by `room`, as the tree takes it, or `None` where it misses
    /// the box.
    fn enter(&self, ray: &Ray, room: [f64; 3]) -> Option<PreparedRay> {
        let local: [f64; 3] = std::array::from_fn(|i| ray.origin[i] - self.center[i]);
        let [mut start, mut end] = ray.ranges;
        if self.tree.nodes.is_empty() {
            return None;
        }
        for (axis, (local, direction)) in local.into_iter().zip(ray.direction).enumerate() {
            let half_size = self.half_size[axis] + room[axis];
            let (a, b) = ((-half_size - local) / direction, (half_size - local) / direction);
            // a ray that runs in a face of the box gives 0 / 0 = NaN, which `min` and `max` pass over: not clipped
            // there
            start = start.max(a.min(b));
            end = end.min(a.max(b));
        }
        if !(start <= end) {
            return None;
        }
        let origin = std::array::from_fn(|i| to_f32(local[i] + start * ray.direction[i]));
        let ray = TreeRay::new(origin, ray.direction.map(to_f32), room.map(to_f32), tree_reach(end - start));
        Some(PreparedRay { ray, start })
    }
}

fn damaged_tree() -> Error {
    Error::invalid(Parameter::Obstacle, "a damaged tree", "one that holds every box once")
}

/// The node of [`RayIndex::node_words`].
fn node_of_words(words: &[u32; NODE_WORDS]) -> CwBvhNode {
    let [x, y, z, flags, child_base_idx, primitive_base_idx, sides @ ..] = *words;
    let [ex, ey, ez, imask] = flags.to_le_bytes();
    let sides: [u64; (NODE_WORDS - 6) / 2] =
        std::array::from_fn(|i| u64::from(sides[2 * i]) | u64::from(sides[2 * i + 1]) << 32);
    let [child_meta, child_min_x, child_max_x, child_min_y, child_max_y, child_min_z, child_max_z] =
        sides.map(u64::to_le_bytes);
    CwBvhNode {
        p: [x, y, z].map(f32::from_bits).into(),
        e: [ex, ey, ez],
        imask,
        child_base_idx,
        primitive_base_idx,
        child_meta,
        child_min_x,
        child_max_x,
        child_min_y,
        child_max_y,
        child_min_z,
        child_max_z,
    }
}

/// A ray as the tree takes it.
struct PreparedRay {
    ray: TreeRay,
    /// Range at which the tree's ray starts.
    start: f64,
}

/// Returns the reach of the tree, metres, that finds every box that holds something within `range`.
fn tree_reach(range: f64) -> f32 {
    to_f32(range + TREE_SLACK).next_up()
}

#[cfg(test)]
mod tests {
    use super::walk::RayScalar;
    use super::*;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::piece_in_box;
    use std::collections::BTreeSet;

    fn boxes(count: u64) -> Vec<[[f32; 3]; 2]> {
        let random = |i: u64, k: u64| to_f32(uniform(8, 16 * i + k));
        (0..count)
            .map(|i| {
                let low: [f32; 3] = std::array::from_fn(|k| [80.0, 50.0, 20.0][k] * random(i, k as u64));
                // from flat ones to some that reach over a part of the scene
                let size = |k: u64| random(i, 8 + k).powi(6) * 15.0;
                [low, [low[0] + size(0), low[1] + size(1), low[2] + size(2)]]
            })
            .collect()
    }

    /// Rays in general directions, along axes and in planes of two axes, some from inside, some cut off.
    fn rays(count: u64) -> Vec<Ray> {
        let random = |i: u64, k: u64| uniform(9, 16 * i + k);
        let component = |i: u64, k: u64| match i % 5 {
            0 if k == 1 => 0.0,
            1 if k != 2 => -0.0,
            _ => random(i, 4 + k) - 0.5,
        };
        (0..count)
            .filter_map(|i| {
                let origin = std::array::from_fn(|k| [100.0, 70.0, 40.0][k] * random(i, k as u64) - 10.0);
                let end = if i % 3 == 0 { 60.0 * random(i, 8) } else { f64::INFINITY };
                Ray::new(origin, std::array::from_fn(|k| component(i, k as u64)), [random(i, 9), end])
            })
            .collect()
    }

    fn meets(ray: &Ray, [low, high]: [[f32; 3]; 2]) -> bool {
        let sides = std::array::from_fn(|axis| [low[axis], high[axis]].map(|side| f64::from(side) - ray.origin[axis]));
        piece_in_box(sides, ray.direction, ray.ranges).is_some()
    }

    #[test]
    fn every_box_that_a_ray_meets_is_proposed_on_all_instructions() {
        let boxes = boxes(5000);
        let mut index = RayIndex::new(&boxes).unwrap();
        let (rays, mut proposals) = (rays(2000), 0);
        for instructions in [Instructions::Scalar, Instructions::detect()] {
            index.instructions = instructions;
            for ray in &rays {
                let mut proposed = BTreeSet::new();
                index.each(ray, |row| assert!(proposed.insert(index.order()[row] as usize), "a row comes twice"));
                proposals += proposed.len();
                for (number, corners) in boxes.iter().enumerate() {
                    let is_met = meets(ray, *corners);
                    assert!(!is_met || proposed.contains(&number), "{instructions:?} {ray:?} {corners:?}");
                }
            }
        }
        // a tree that proposed everything would pass as well
        assert!(proposals < 2 * rays.len() * boxes.len() / 50, "{proposals} proposals");
    }

    #[test]
    fn every_box_that_a_ray_beside_meets_is_visited_on_all_instructions() {
        let boxes = boxes(3000);
        let mut index = RayIndex::new(&boxes).unwrap();
        let room = [1.5, 0.0, 0.4];
        let mut visits = 0;
        for instructions in [Instructions::Scalar, Instructions::detect()] {
            index.instructions = instructions;
            for (number, ray) in (0..).zip(rays(1000)) {
                let mut visited = BTreeSet::new();
                index.visit_beside(&ray, room, |row: usize| {
                    assert!(visited.insert(index.order()[row] as usize), "a row comes twice");
                    f32::INFINITY
                });
                visits += visited.len();
                for place in 0..4 {
                    let aside =
                        |axis: usize| room[axis] * (2.0 * uniform(11, 12 * number + 3 * place + axis as u64) - 1.0);
                    let beside = Ray { origin: std::array::from_fn(|axis| ray.origin[axis] + aside(axis)), ..ray };
                    for (number, corners) in boxes.iter().enumerate() {
                        let is_met = meets(&beside, *corners);
                        assert!(!is_met || visited.contains(&number), "{instructions:?} {beside:?} {corners:?}");
                    }
                }
            }
        }
        assert!(visits < 2 * 1000 * boxes.len() / 20, "{visits} visits");
    }

    /// The rows that a walk visits in turn: all, the first three, and those of a ray that each row shortens.
    fn visited(walk: impl Fn(&mut dyn FnMut(usize) -> f32)) -> [Vec<usize>; 3] {
        let of_reach = |reach: &dyn Fn(usize) -> f32| {
            let mut rows = Vec::new();
            walk(&mut |row| {
                rows.push(row);
                reach(rows.len())
            });
            rows
        };
        [
            of_reach(&|_| f32::INFINITY),
            of_reach(&|count| if count < 3 { f32::INFINITY } else { END }),
            of_reach(&|count| 100.0 / count as f32),
        ]
    }

    #[test]
    fn eight_boxes_at_once_give_the_rows_of_one_after_the_other() {
        let index = RayIndex::new(&boxes(5000)).unwrap();
        if index.instructions == Instructions::Scalar {
            use std::io::Write;
            // not `println!`, which the test runner captures
            let what = "a comparison of instructions: this machine has no AVX2 or no FMA";
            let _ = writeln!(std::io::stderr().lock(), "SKIPPED {what}");
            return;
        }
        let mut counts = [0; 3];
        for (ray, room) in rays(2000).into_iter().zip([[0.0; 3], [0.7, 0.0, 0.2]].into_iter().cycle()) {
            let Some(entry) = index.enter(&ray, room) else { continue };
            let fused =
                |visit: &mut dyn FnMut(usize) -> f32| walk::<RayScalar<true>>(&index.tree.nodes, entry.ray, visit);
            let rows = visited(fused);
            assert_eq!(visited(|visit| index.walk(entry.ray, visit)), rows);
            counts.iter_mut().zip(&rows).for_each(|(count, rows)| *count += rows.len());
        }
        assert!(counts[0] > counts[2] && counts[2] > counts[1] && counts[1] > 2000, "{counts:?}");
    }

    #[test]
    fn a_chain_of_boxes_deeper_than_the_stack_is_walked_to_its_end() {
        // each box holds all those before: trees over such boxes are as deep as they get
        let boxes: Vec<[[f32; 3]; 2]> = (1..2000_u16).map(|i| [[0.0; 3], [f32::from(i).powi(2); 3]]).collect();
        let index = RayIndex::new(&boxes).unwrap();
        let ray = Ray::new([-1.0, 0.5, 0.5], [1.0, 0.0, 0.0], [0.0, f64::INFINITY]).unwrap();
        let mut count = 0;
        index.each(&ray, |_| count += 1);
        assert_eq!(count, boxes.len());
    }
}
