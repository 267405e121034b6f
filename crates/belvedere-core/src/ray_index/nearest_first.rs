//! Walk through the tree of boxes that opens the nearest first, and only those that are still wanted.

use super::node_parts::{NodePart, NodeParts, PARTS};
use super::{RayIndex, TREE_SLACK};
use belvedere_data::vector::to_f32;
use smallvec::SmallVec;

/// Reach of a box as a walk sees it.
#[derive(Clone, Copy)]
pub(crate) struct BoxReach {
    /// Its least distance, metres.
    pub(crate) distance: f32,
    /// Least and greatest tangent of the elevations that it may hide.
    pub(crate) tangents: [f32; 2],
}

impl RayIndex {
    /// Visits rows box by box, the nearest first. `reaches` measures the boxes of a node, with the rounding of their
    /// corners, metres; the rows of a box without a reach, or that `is_wanted` no more when its turn comes, are passed
    /// over. `visit` ends the walk by false. All get `state`.
    pub(crate) fn visit_nearest_first<S>(
        &self,
        state: &mut S,
        reaches: impl Fn(&S, &NodeParts, f32) -> [Option<BoxReach>; PARTS],
        is_wanted: impl Fn(&S, &BoxReach) -> bool,
        mut visit: impl FnMut(&mut S, u32) -> bool,
    ) {
        let slack = to_f32(self.slack() + TREE_SLACK);
        // boxes that wait, the nearest last
        let mut waiting: SmallVec<[(BoxReach, NodePart); 64]> = SmallVec::new();
        let mut open = self.root();
        loop {
            if let Some(parts) = open.and_then(|node| self.parts(node)) {
                let first = waiting.len();
                for (reach, part) in reaches(state, &parts, slack).into_iter().zip(parts.parts) {
                    waiting.extend(reach.filter(|_| part != NodePart::Nothing).map(|reach| (reach, part)));
                }
                waiting[first..].sort_unstable_by(|(a, _), (b, _)| b.distance.total_cmp(&a.distance));
            }
            let Some((reach, part)) = waiting.pop() else { return };
            open = None;
            if !is_wanted(state, &reach) {
                continue;
            }
            match part {
                NodePart::Node(node) => open = Some(node),
                NodePart::Rows { first, count } => {
                    if !(first..first + count).all(|row| visit(state, row)) {
                        return;
                    }
                }
                NodePart::Nothing => {}
            }
        }
    }
}
