//! A tree over free segments of one main direction: its nodes store where their segments pass two planes.

use super::segment::FreeSegment;
use belvedere_data::cast::to_row;
use belvedere_data::control::{Control, Stop};
use std::ops::{ControlFlow, Range};

/// Segments in a leaf.
const LEAF: usize = 8;
/// Below this many segments a thread continues alone.
const PARALLEL: usize = 8192;
/// Minimum distance of the two planes of a node, metres: rounding must not tilt the space between them.
const MIN_SPAN: f32 = 0.01;
/// Segments by which a way of splitting a node is judged.
const SAMPLE: usize = 32;
/// Radius of the balls that the boxes of a tree are made for, metres.
const TYPICAL_RADIUS: f32 = 0.1;
/// Minimum rise of an upright segment per metre of its length. Segments from aircraft are upright and form one tree.
const UPRIGHT_RISE: f64 = 0.3;

/// The main direction of a segment: an axis and a sense along it. Across this axis a segment shifts by at most 3.2 m
/// per metre where it is upright, otherwise by at most 1 m.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SegmentAxis {
    /// 0 east, 1 north, 2 up.
    pub(super) axis: usize,
    /// True for segments against the axis.
    pub(super) is_backward: bool,
}

impl SegmentAxis {
    pub(super) const UP: Self = Self { axis: 2, is_backward: false };
    /// Every way; its place here is the number it is saved by.
    pub(super) const ALL: [Self; 6] = [
        Self::UP,
        Self { axis: 0, is_backward: false },
        Self { axis: 1, is_backward: false },
        Self { axis: 2, is_backward: true },
        Self { axis: 0, is_backward: true },
        Self { axis: 1, is_backward: true },
    ];

    /// The axis of a unit vector; `None` if it is not a number.
    pub(super) fn of(direction: [f64; 3]) -> Option<Self> {
        if direction[2] > UPRIGHT_RISE {
            return Some(Self::UP);
        }
        let axis = (0..3).max_by(|&a, &b| direction[a].abs().total_cmp(&direction[b].abs()))?;
        let along = direction[axis];
        (along.abs() > 0.0).then_some(Self { axis, is_backward: along < 0.0 })
    }

    /// Place in [`SegmentAxis::ALL`].
    pub(super) fn number(self) -> usize {
        (self.axis + 1) % 3 + if self.is_backward { 3 } else { 0 }
    }

    /// Returns a place as its part along the axis, and those across in the order of [`SegmentAxis::across`].
    fn turned(self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        match self.axis {
            0 => [x, y, z],
            1 => [y, z, x],
            _ => [z, x, y],
        }
    }

    /// The two axes across it.
    pub(super) fn across(self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }
}

/// Bounding volume of the segments of a node: their range along the axis, and their box at both ends of that range.
/// Segments are straight, so they lie within the box interpolated between the two planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct SegmentNode {
    /// Minimum of both axes across, then maximum, at the lower plane.
    pub(super) below: [f32; 4],
    pub(super) above: [f32; 4],
    /// The two planes: least and most along the axis.
    pub(super) planes: [f32; 2],
    /// The first segment of a leaf, or the second child; the first child follows its parent.
    pub(super) next: u32,
    /// Segments of a leaf; 0 for an inner node.
    pub(super) count: u32,
}

/// Segments of one main direction.
pub(super) struct SegmentTree {
    pub(super) way: SegmentAxis,
    /// Number of its first segment.
    pub(super) first: usize,
    nodes: Vec<SegmentNode>,
}

impl SegmentTree {
    /// The tree over `free_segments`, which it puts in order; the first of them becomes segment number `first`. They
    /// are in the order of a tree already where its [`SegmentTree::boxes`] are given. After a cancelled build the
    /// result is no tree.
    pub(super) fn new(
        (way, boxes): (SegmentAxis, Option<&[[f32; 10]]>),
        free_segments: &mut [FreeSegment],
        first: usize,
        stop: &Stop<'_>,
        control: &Control<'_>,
    ) -> Self {
        let mut nodes = vec![SegmentNode::EMPTY; node_count(free_segments.len())];
        TreeBuild { way, boxes, stop, control }.node(free_segments, first, &mut nodes, 0);
        Self { way, first, nodes }
    }

    /// The boxes of its nodes at both planes, and these.
    pub(super) fn boxes(&self) -> impl Iterator<Item = [f32; 10]> + '_ {
        self.nodes.iter().map(
            |SegmentNode { below: [a, b, c, d], above: [e, f, g, h], planes: [low, high], .. }| {
                [*a, *b, *c, *d, *e, *f, *g, *h, *low, *high]
            },
        )
    }

    /// Calls `visit` with the numbers of the segments of every leaf that `may_hold` does not rule out, nor a node above
    /// it, until it breaks off. Both share `state`.
    #[inline]
    pub(super) fn walk<S>(
        &self,
        state: &mut S,
        may_hold: impl Fn(&SegmentNode, &S) -> bool,
        mut visit: impl FnMut(Range<usize>, &mut S) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut stack = [0_u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            if !may_hold(node, state) {
                continue;
            }
            let next = node.next as usize;
            if node.count > 0 {
                visit(next..next + node.count as usize, state)?;
                continue;
            }
            let first = to_row(index) + 1;
            (stack[depth], stack[depth + 1]) = (node.next, first);
            depth += 2;
        }
        ControlFlow::Continue(())
    }

    /// Returns true if a segment below `node` may enter the ball.
    #[inline]
    pub(super) fn may_enter(&self, node: &SegmentNode, center: [f32; 3], radius: f32) -> bool {
        // rounding of f32 at coordinates of kilometres is a tenth of a millimetre
        let reach = radius * (1.0 + 1e-5) + 1e-3;
        let [along, across @ ..] = self.way.turned(center);
        let low = larger(node.planes[0], along - reach);
        let high = smaller(node.planes[1], along + reach);
        if low > high {
            return false;
        }
        let span = node.planes[1] - node.planes[0];
        let sides = |at: f32| -> [f32; 4] {
            let share = (at - node.planes[0]) / span;
            std::array::from_fn(|side| node.below[side] + share * (node.above[side] - node.below[side]))
        };
        let (s, t) = (sides(low), sides(high));
        let mut square = 0.0;
        for (side, at) in across.into_iter().enumerate() {
            let min = smaller(s[side], t[side]);
            let max = larger(s[side + 2], t[side + 2]);
            let off = larger(larger(min - at, at - max), 0.0);
            square += off * off;
        }
        let off = larger(larger(low - along, along - high), 0.0);
        square + off * off < reach * reach
    }
}

/// The smaller number, in one instruction: `f32::min` takes five to pass over what is not a number.
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger number, as [`smaller`].
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

impl SegmentNode {
    const EMPTY: Self = Self {
        below: [f32::INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY],
        above: [f32::INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY],
        planes: [f32::INFINITY, f32::NEG_INFINITY],
        next: 0,
        count: 0,
    };

    /// A node of [`SegmentTree::boxes`].
    fn of_box([a, b, c, d, e, f, g, h, low, high]: [f32; 10]) -> Self {
        Self { below: [a, b, c, d], above: [e, f, g, h], planes: [low, high], ..Self::EMPTY }
    }

    /// The box around `free_segments`.
    fn around(free_segments: &[FreeSegment], way: SegmentAxis) -> Self {
        let mut node = Self::EMPTY;
        for free_segment in free_segments {
            let start = free_segment.start[way.axis];
            let end = start + free_segment.direction[way.axis] * free_segment.length;
            node.planes = [node.planes[0].min(start.min(end)), node.planes[1].max(start.max(end))];
        }
        node.planes[1] = node.planes[1].max(node.planes[0] + MIN_SPAN);
        for free_segment in free_segments {
            let per_metre = 1.0 / free_segment.direction[way.axis];
            for (side, axis) in way.across().into_iter().enumerate() {
                let slope = free_segment.direction[axis] * per_metre;
                let at = |plane: f32| free_segment.start[axis] + (plane - free_segment.start[way.axis]) * slope;
                for (plane, found) in node.planes.into_iter().zip([&mut node.below, &mut node.above]) {
                    let at = at(plane);
                    found[side] = found[side].min(at);
                    found[side + 2] = found[side + 2].max(at);
                }
            }
        }
        node
    }

    /// Volume in which the centre of a ball of [`TYPICAL_RADIUS`] may lie that the node must be opened for, m³.
    fn volume(&self) -> f32 {
        let margin = 2.0 * TYPICAL_RADIUS;
        let area = |side: [f32; 4]| (side[2] - side[0] + margin) * (side[3] - side[1] + margin);
        (self.planes[1] - self.planes[0] + margin) * (area(self.below) + area(self.above)) / 2.0
    }
}

/// The key by which segments are sorted: a coordinate of one of their ends.
#[derive(Clone, Copy)]
struct SegmentKey {
    axis: usize,
    is_far_end: bool,
}

impl SegmentKey {
    const ALL: [Self; 6] = [
        Self { axis: 0, is_far_end: false },
        Self { axis: 1, is_far_end: false },
        Self { axis: 2, is_far_end: false },
        Self { axis: 0, is_far_end: true },
        Self { axis: 1, is_far_end: true },
        Self { axis: 2, is_far_end: true },
    ];

    fn of(self, free_segment: &FreeSegment) -> f32 {
        let start = free_segment.start[self.axis];
        if self.is_far_end { start + free_segment.direction[self.axis] * free_segment.length } else { start }
    }
}

/// Nodes of the tree over `count` segments.
pub(super) fn node_count(count: usize) -> usize {
    if count <= LEAF { 1 } else { 1 + node_count(cut(count)) + node_count(count - cut(count)) }
}

/// Returns the length of the first of two runs of whole leaves, as equal as possible.
fn cut(count: usize) -> usize {
    count.div_ceil(LEAF) / 2 * LEAF
}

#[derive(Clone, Copy)]
struct TreeBuild<'a> {
    way: SegmentAxis,
    /// Boxes of the nodes, if the segments are in order already.
    boxes: Option<&'a [[f32; 10]]>,
    stop: &'a Stop<'a>,
    control: &'a Control<'a>,
}

impl TreeBuild<'_> {
    /// Returns the sort key whose split has the least volume of both boxes, judged by a sample in the given order.
    fn best_key(self, free_segments: &[FreeSegment]) -> SegmentKey {
        let step = free_segments.len().div_ceil(SAMPLE);
        let mut sample: Vec<FreeSegment> = free_segments.iter().step_by(step).copied().collect();
        let middle = sample.len() / 2;
        let mut best = (f32::INFINITY, SegmentKey::ALL[0]);
        for key in SegmentKey::ALL {
            sample.select_nth_unstable_by(middle, |a, b| key.of(a).total_cmp(&key.of(b)));
            let (near, far) = sample.split_at(middle);
            let cost = SegmentNode::around(near, self.way).volume() + SegmentNode::around(far, self.way).volume();
            if cost < best.0 {
                best = (cost, key);
            }
        }
        best.1
    }

    /// Builds the node over `items`, whose first segment is number `first`, into `nodes[0]`, and its descendants
    /// behind.
    fn node(self, items: &mut [FreeSegment], first: usize, nodes: &mut [SegmentNode], index: usize) {
        if items.len() > PARALLEL && self.stop.is_set() {
            return;
        }
        let kept = self.boxes.and_then(|boxes| boxes.get(index));
        let mut node = kept.map_or_else(|| SegmentNode::around(items, self.way), |kept| SegmentNode::of_box(*kept));
        let Some((own, below)) = nodes.split_first_mut() else { return };
        let number = |value: usize| to_row(value);
        if items.len() <= LEAF {
            (node.next, node.count) = (number(first), number(items.len()));
            *own = node;
            return;
        }
        let middle = cut(items.len());
        if self.boxes.is_none() {
            let key = self.best_key(items);
            items.select_nth_unstable_by(middle, |a, b| key.of(a).total_cmp(&key.of(b)));
        }
        let (left, right) = items.split_at_mut(middle);
        let left_nodes = node_count(left.len());
        node.next = number(index + 1 + left_nodes);
        *own = node;
        let (near, far) = below.split_at_mut(left_nodes);
        let far_index = index + 1 + left_nodes;
        if left.len() + right.len() > PARALLEL {
            rayon::join(
                || self.node(left, first, near, index + 1),
                || self.node(right, first + middle, far, far_index),
            );
        } else {
            self.node(left, first, near, index + 1);
            self.node(right, first + middle, far, far_index);
            if left.len() + right.len() > PARALLEL / 2 {
                self.control.advance(left.len() + right.len());
            }
        }
    }
}
