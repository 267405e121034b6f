//! Parts of a node: boxes, and further nodes or rows.

use obvhs::cwbvh::node::CwBvhNode;

/// The parts of a node of a [`RayIndex`](super::RayIndex).
pub struct NodeParts {
    /// The parts.
    pub parts: [NodePart; PARTS],
    /// Middles of their boxes, local metres, by axis.
    pub centers: [[f32; PARTS]; 3],
    /// Half sizes of their boxes, metres, by axis.
    pub half_sizes: [[f32; PARTS]; 3],
}

/// Maximum number of parts of a node of a [`RayIndex`](super::RayIndex).
pub const PARTS: usize = 8;

/// Part of a node of a [`RayIndex`](super::RayIndex).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodePart {
    /// A place that is not taken.
    Nothing,
    /// Another node.
    Node(u32),
    /// Rows of the index.
    Rows {
        /// The lowest row.
        first: u32,
        /// Number of rows.
        count: u32,
    },
}

/// Returns the kind of a part of a node.
#[inline(always)]
pub(super) fn part_of(node: &CwBvhNode, part: usize) -> NodePart {
    if node.is_child_empty(part) {
        NodePart::Nothing
    } else if node.is_leaf(part) {
        let (first, count) = node.child_primitives(part);
        NodePart::Rows { first, count }
    } else {
        NodePart::Node(node.child_node_index(part))
    }
}
