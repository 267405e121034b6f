//! Nodes whose parts are tested side by side, for searches that follow more than one ray at once.

use super::RayIndex;
use super::node_parts::PARTS;
use belvedere_data::vector::to_f32;
use obvhs::cwbvh::node::CwBvhNode;
use std::ops::Range;

/// Lowest and highest sides of eight boxes, by axis, local metres.
pub(crate) type PartSides = [[[f32; PARTS]; 2]; 3];

/// A node whose parts are looked at. Parts are given as bits, the lowest for the first.
pub(crate) struct OpenNode<'a> {
    node: &'a CwBvhNode,
    /// Boxes of the parts; those of parts that are not taken mean nothing.
    pub(crate) sides: PartSides,
}

impl RayIndex {
    /// Opens the node of a number.
    #[inline(always)]
    pub(crate) fn open(&self, node: u32) -> Option<OpenNode<'_>> {
        let node = self.tree.nodes.get(node as usize)?;
        let (origin, steps) = (node.p.to_array(), node.compute_extent().to_array());
        let parts = [
            [&node.child_min_x, &node.child_max_x],
            [&node.child_min_y, &node.child_max_y],
            [&node.child_min_z, &node.child_max_z],
        ];
        let mut sides = [[[0.0; PARTS]; 2]; 3];
        for axis in 0..3 {
            let start = to_f32(f64::from(origin[axis]) + self.center[axis]);
            for side in 0..2 {
                for part in 0..PARTS {
                    sides[axis][side][part] = start + steps[axis] * f32::from(parts[axis][side][part]);
                }
            }
        }
        Some(OpenNode { node, sides })
    }
}

impl OpenNode<'_> {
    /// Selects those of `parts` that are nodes.
    #[inline(always)]
    pub(crate) fn nodes(&self, parts: u32) -> u32 {
        parts & u32::from(self.node.imask)
    }

    /// Number of the node that a part is.
    #[inline(always)]
    pub(crate) fn number(&self, part: usize) -> u32 {
        let before = u32::from(self.node.imask) & !(u32::MAX << part);
        self.node.child_base_idx + before.count_ones()
    }

    /// Rows from the first to the last, exclusive, of those of `parts` that are rows; others may lie between. Rows of
    /// later parts come later.
    #[inline(always)]
    pub(crate) fn rows(&self, parts: u32) -> Range<u32> {
        let rows = parts & self.parts_in_use() & !u32::from(self.node.imask);
        if rows == 0 {
            return 0..0;
        }
        let [first, last] = [rows.trailing_zeros(), rows.ilog2()].map(|part| self.node.child_primitives(part as usize));
        first.0..last.0 + last.1
    }

    /// Parts that are nodes or rows.
    #[inline(always)]
    fn parts_in_use(&self) -> u32 {
        /// Set in the byte of each part that is taken.
        const TAKEN: u64 = 0x2020_2020_2020_2020;
        /// Brings the bits of bytes together in the highest byte.
        const TOGETHER: u64 = 0x0102_0408_1020_4080;
        let bytes = u64::from_le_bytes(self.node.child_meta);
        (((bytes & TAKEN) >> 5).wrapping_mul(TOGETHER) >> 56) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray_index::NodePart;
    use belvedere_data::random::uniform;

    #[test]
    fn an_opened_node_has_the_parts_of_the_node_and_all_their_rows() {
        let random = |i: u64, k: u64| to_f32(uniform(7, 8 * i + k));
        let boxes: Vec<[[f32; 3]; 2]> = (0..5000)
            .map(|i| {
                let low = std::array::from_fn(|axis| 3000.0 + 100.0 * random(i, axis as u64));
                [low, low.map(|v| v + 4.0 * random(i, 3))]
            })
            .collect();
        let index = RayIndex::new(&boxes).unwrap();
        let mut row_count = 0;
        let mut waiting: Vec<u32> = index.root().into_iter().collect();
        while let Some(number) = waiting.pop() {
            let (node, parts) = (index.open(number).unwrap(), index.parts(number).unwrap());
            for (place, part) in parts.parts.into_iter().enumerate() {
                let bit = 1 << place;
                assert_eq!(node.nodes(bit) != 0, matches!(part, NodePart::Node(_)));
                match part {
                    NodePart::Nothing => assert!(node.rows(bit).is_empty()),
                    NodePart::Node(child) => {
                        assert_eq!(node.number(place), child);
                        assert!(node.rows(bit).is_empty());
                        waiting.push(child);
                    }
                    NodePart::Rows { first, count } => {
                        assert_eq!(node.rows(bit), first..first + count);
                        let all = node.rows(0xff);
                        assert!(all.contains(&first) && all.end >= first + count);
                        row_count += count;
                        for row in first..first + count {
                            let given = boxes[index.order()[row as usize] as usize];
                            for (axis, [low, high]) in node.sides.iter().enumerate() {
                                assert!(low[place] <= given[0][axis] && high[place] >= given[1][axis]);
                            }
                        }
                    }
                }
            }
        }
        assert_eq!(row_count, 5000);
    }
}
