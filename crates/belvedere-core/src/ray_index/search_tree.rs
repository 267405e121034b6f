//! Trees over boxes, large ones in parts side by side: the steps that make nodes of eight parts from a binary tree run
//! on one thread each.

#![expect(
    clippy::cast_possible_truncation,
    reason = "nodes and rows are numbered with 32 bits, sides and exponents with 8"
)]

use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::cwbvh::node::CwBvhNode;
use obvhs::cwbvh::{BRANCHING, CwBvh};
use obvhs::ploc::PlocBuilder;
use rayon::prelude::*;

/// Boxes from which on a tree is made of parts: fewer take some hundredths of a second.
const LARGE: usize = 1 << 16;
/// Maximum number of boxes of a leaf.
const MAX_IN_LEAF: u32 = 3;
/// Bits that mark a node among the parts of a node, beside its place.
const IS_NODE: u8 = 0b0011_1000;

/// The tree over `boxes`, which must not be empty. It depends on the boxes only, not on the number of threads.
pub(super) fn search_tree(boxes: &[Aabb]) -> CwBvh {
    let mut rows: Vec<u32> = (0..).take(boxes.len()).collect();
    tree_of(boxes, &mut rows)
}

/// The tree over the boxes of `rows`.
fn tree_of(boxes: &[Aabb], rows: &mut [u32]) -> CwBvh {
    if rows.len() < LARGE {
        return one_tree(boxes, rows);
    }
    let mut groups = vec![rows];
    while groups.len() < BRANCHING {
        groups = groups.into_par_iter().flat_map_iter(|rows| halves(boxes, rows)).collect();
    }
    let trees: Vec<CwBvh> = groups.into_par_iter().map(|rows| tree_of(boxes, rows)).collect();
    joined(&trees)
}

/// Builds the tree over the boxes of `rows` at once. The steps are those of `build_cwbvh` without its check of the
/// boxes in debug builds. That check allows for errors of 1e-5 and panics on sound trees wider than some hundred
/// metres.
fn one_tree(boxes: &[Aabb], rows: &[u32]) -> CwBvh {
    let params = BvhBuildParams::medium_build();
    let of_rows: Vec<Aabb> = rows.iter().map(|&row| boxes[row as usize]).collect();
    let mut binary = PlocBuilder::with_capacity(rows.len()).build(
        params.ploc_search_distance,
        &of_rows,
        (0..).take(rows.len()).collect(),
        params.sort_precision,
        params.search_depth_threshold,
    );
    ReinsertionOptimizer::default().run(&mut binary, params.reinsertion_batch_ratio, None);
    let mut tree = bvh2_to_cwbvh(&binary, MAX_IN_LEAF, true, false);
    tree.primitive_indices.iter_mut().for_each(|place| *place = rows[*place as usize]);
    tree
}

/// The rows in two halves, side by side along the longest side of the box around the middles of their boxes.
fn halves<'r>(boxes: &[Aabb], rows: &'r mut [u32]) -> [&'r mut [u32]; 2] {
    let middle = |row: u32| {
        let bounds = boxes[row as usize];
        (bounds.min + bounds.max).to_array()
    };
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for &row in &*rows {
        let middle = middle(row);
        low = std::array::from_fn(|axis| low[axis].min(middle[axis]));
        high = std::array::from_fn(|axis| high[axis].max(middle[axis]));
    }
    let side = |axis: &usize| high[*axis] - low[*axis];
    let longest = (0..3).max_by(|a, b| side(a).total_cmp(&side(b))).unwrap_or(0);
    let half = rows.len() / 2;
    rows.select_nth_unstable_by(half, |&a, &b| middle(a)[longest].total_cmp(&middle(b)[longest]));
    let (before, after) = rows.split_at_mut(half);
    [before, after]
}

/// One tree of at most eight, whose roots become the parts of one node.
fn joined(trees: &[CwBvh]) -> CwBvh {
    let bounds: Vec<Aabb> = trees.iter().map(|tree| tree.total_aabb).collect();
    let total_aabb = bounds.iter().fold(Aabb::empty(), |all, bounds| all.union(bounds));
    let mut all = CwBvh { nodes: vec![node_of(&bounds, &total_aabb)], total_aabb, ..CwBvh::default() };
    // roots come first, as the parts of a node follow each other
    all.nodes.extend(trees.iter().map(|tree| tree.nodes[0]));
    for (place, tree) in trees.iter().enumerate() {
        let (first_node, first_row) = (all.nodes.len() as u32, all.primitive_indices.len() as u32);
        let others = all.nodes.len()..all.nodes.len() + tree.nodes.len() - 1;
        all.nodes.extend_from_slice(&tree.nodes[1..]);
        for number in std::iter::once(place + 1).chain(others) {
            let node = &mut all.nodes[number];
            node.child_base_idx += first_node - 1;
            node.primitive_base_idx += first_row;
        }
        all.primitive_indices.extend_from_slice(&tree.primitive_indices);
    }
    all
}

/// A node whose parts are nodes, the next ones, with boxes in steps from its lowest corner: the smallest powers of two
/// of which 255 reach the highest one.
fn node_of(parts: &[Aabb], around: &Aabb) -> CwBvhNode {
    let size = (around.max - around.min).to_array();
    let steps = size.map(|size| (size.max(1e-20) / 255.0).log2().ceil().exp2());
    let mut node = CwBvhNode {
        p: around.min.into(),
        // powers of two have no other bits than those of the exponent
        e: steps.map(|step| (step.to_bits() >> 23) as u8),
        child_base_idx: 1,
        ..CwBvhNode::default()
    };
    for (place, bounds) in parts.iter().enumerate() {
        node.imask |= 1 << place;
        node.child_meta[place] = IS_NODE + place as u8;
        let [low, high] = [bounds.min, bounds.max].map(|corner| (corner - around.min).to_array());
        let sides = [
            [&mut node.child_min_x, &mut node.child_max_x],
            [&mut node.child_min_y, &mut node.child_max_y],
            [&mut node.child_min_z, &mut node.child_max_z],
        ];
        for (axis, [lowest, highest]) in sides.into_iter().enumerate() {
            // `as` saturates
            lowest[place] = (low[axis] / steps[axis]).floor() as u8;
            highest[place] = (high[axis] / steps[axis]).ceil() as u8;
        }
    }
    node
}

#[cfg(test)]
mod tests {
    use super::super::{NodePart, RayIndex};
    use super::{BRANCHING, LARGE};
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;

    type BoxSides = [[f64; 3]; 2];

    /// The box around all rows below a node, which must lie in the boxes of all parts above them; counts how often each
    /// row is there.
    fn around_rows(index: &RayIndex, boxes: &[[[f32; 3]; 2]], node: u32, counts: &mut [u32]) -> BoxSides {
        let parts = index.parts(node).unwrap();
        let mut around = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for (place, part) in parts.parts.into_iter().enumerate() {
            let mut own = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
            match part {
                NodePart::Nothing => continue,
                NodePart::Node(node) => own = around_rows(index, boxes, node, counts),
                NodePart::Rows { first, count } => {
                    for row in first..first + count {
                        let number = index.order()[row as usize] as usize;
                        counts[number] += 1;
                        own = joined(own, boxes[number].map(|corner| corner.map(f64::from)));
                    }
                }
            }
            for (axis, (low, high)) in own[0].into_iter().zip(own[1]).enumerate() {
                let (middle, half) = (parts.centers[axis][place], parts.half_sizes[axis][place]);
                let holds = f64::from(middle - half) <= low && high <= f64::from(middle + half);
                assert!(holds, "node {node}, part {place}, axis {axis}");
            }
            around = joined(around, own);
        }
        around
    }

    fn joined(a: BoxSides, b: BoxSides) -> BoxSides {
        [
            std::array::from_fn(|axis| f64::min(a[0][axis], b[0][axis])),
            std::array::from_fn(|axis| f64::max(a[1][axis], b[1][axis])),
        ]
    }

    #[test]
    fn trees_of_parts_hold_each_box_once_and_in_their_boxes() {
        let random = |i: u64, k: u64| to_f32(uniform(5, 8 * i + k));
        // one level of parts, and two; then boxes at one place but for one far away
        for (count, extent) in [(LARGE, 500.0), (BRANCHING * LARGE + 3, 500.0), (LARGE, 0.0)] {
            let box_of = |i: u64| {
                let low = std::array::from_fn(|axis| if i == 0 { 9000.0 } else { extent * random(i, axis as u64) });
                [low, low.map(|v| v + random(i, 3))]
            };
            let boxes: Vec<[[f32; 3]; 2]> = (0..count as u64).map(box_of).collect();
            let index = RayIndex::new(&boxes).unwrap();
            let mut counts = vec![0; count];
            around_rows(&index, &boxes, index.root().unwrap(), &mut counts);
            assert!(counts.iter().all(|count| *count == 1), "{count} boxes");
        }
    }
}
