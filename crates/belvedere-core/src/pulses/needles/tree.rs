//! A tree over needles that run one way: its nodes keep where their needles pass two planes.

use super::Needle;
use belvedere_data::control::{Control, Stop};
use std::ops::{ControlFlow, Range};

/// Needles in a leaf.
const LEAF: usize = 8;
/// Below this many needles a thread goes on alone.
const PARALLEL: usize = 8192;
/// Least distance of the two planes of a node, metres: rounding must not tilt what lies between them.
const LEAST_SPAN: f32 = 0.01;
/// An upright needle rises at least so much per metre of its length. Those of aircraft do, and make one tree.
const UPRIGHT_RISE: f64 = 0.3;

/// The way along which a needle gets on most, an axis and a side of it. Across it a needle shifts by 3.2 m per metre at most where it
/// is upright, otherwise by 1 m.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Way {
    /// 0 east, 1 north, 2 up.
    pub(super) axis: usize,
    /// Whether against the axis.
    pub(super) is_backward: bool,
}

impl Way {
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

    /// The way of a unit vector; `None` for what is not a number.
    pub(super) fn of(direction: [f64; 3]) -> Option<Self> {
        if direction[2] > UPRIGHT_RISE {
            return Some(Self::UP);
        }
        let axis = (0..3).max_by(|&a, &b| direction[a].abs().total_cmp(&direction[b].abs()))?;
        let along = direction[axis];
        (along.abs() > 0.0).then_some(Self { axis, is_backward: along < 0.0 })
    }

    /// Place in [`Way::ALL`].
    pub(super) fn number(self) -> usize {
        (self.axis + 1) % 3 + if self.is_backward { 3 } else { 0 }
    }

    /// The two axes across it.
    pub(super) fn across(self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }
}

/// Where the needles of a node lie: what they span along their way, and their box at both ends of that. Between the two planes lines
/// are straight, so that anywhere they lie within the box interpolated between the two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Least of both axes across, then most, at the lower plane.
    pub(super) below: [f32; 4],
    pub(super) above: [f32; 4],
    /// The two planes: least and most along the axis.
    pub(super) planes: [f32; 2],
    /// The first needle of a leaf, or the second child; the first child follows its parent.
    pub(super) next: u32,
    /// Needles of a leaf; 0 for an inner node.
    pub(super) count: u32,
}

/// Needles that run one way.
pub(super) struct Tree {
    pub(super) way: Way,
    /// Number of its first needle.
    pub(super) first: usize,
    nodes: Vec<Node>,
}

/// A needle on its way into a tree, with where its line meets two planes that are the same for all.
#[derive(Clone, Copy)]
pub(super) struct Item {
    pub(super) needle: Needle,
    at: [f32; 4],
}

impl Item {
    /// A needle from `start` along the unit vector `direction`, compared with others of its way at two `planes` across that.
    #[expect(clippy::cast_possible_truncation, reason = "local coordinates")]
    pub(super) fn new(way: Way, start: [f64; 3], direction: [f64; 3], length: f64, planes: [f32; 2]) -> Self {
        let at = |plane: f32, axis: usize| {
            (start[axis] + (f64::from(plane) - start[way.axis]) / direction[way.axis] * direction[axis]) as f32
        };
        let [u, v] = way.across();
        Self {
            needle: Needle {
                start: start.map(|v| v as f32),
                direction: direction.map(|v| v as f32),
                length: length as f32,
            },
            at: [at(planes[0], u), at(planes[0], v), at(planes[1], u), at(planes[1], v)],
        }
    }
}

impl Tree {
    /// The tree over `items`, which it puts in order; their first will be needle number `first`. What is left when the work is
    /// cancelled is no tree.
    pub(super) fn new(way: Way, items: &mut [Item], first: usize, stop: &Stop<'_>, control: &Control<'_>) -> Self {
        let mut nodes = vec![Node::EMPTY; node_count(items.len())];
        Build { way, stop, control }.node(items, first, &mut nodes, 0);
        Self { way, first, nodes }
    }

    /// Shows `visit` the numbers of the needles of every leaf that `may_hold` does not rule out, nor a node above it, until it breaks
    /// off. Both share `state`.
    #[inline]
    pub(super) fn walk<S>(
        &self,
        state: &mut S,
        may_hold: impl Fn(&Node, &S) -> bool,
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
            #[expect(clippy::cast_possible_truncation, reason = "nodes are numbered with 32 bits")]
            let first = index as u32 + 1;
            (stack[depth], stack[depth + 1]) = (node.next, first);
            depth += 2;
        }
        ControlFlow::Continue(())
    }

    /// Whether a needle below `node` may enter the ball.
    #[inline]
    pub(super) fn may_enter(&self, node: &Node, center: [f32; 3], radius: f32) -> bool {
        // rounding of f32 at coordinates of kilometres is a tenth of a millimetre
        let reach = radius * (1.0 + 1e-5) + 1e-3;
        let along = center[self.way.axis];
        let low = node.planes[0].max(along - reach);
        let high = node.planes[1].min(along + reach);
        if low > high {
            return false;
        }
        let span = node.planes[1] - node.planes[0];
        let share = |at: f32| (at - node.planes[0]) / span;
        let (s, t) = (share(low), share(high));
        let mut square = 0.0;
        for (side, axis) in self.way.across().into_iter().enumerate() {
            let at = |share: f32, side: usize| node.below[side] + share * (node.above[side] - node.below[side]);
            let least = at(s, side).min(at(t, side));
            let most = at(s, side + 2).max(at(t, side + 2));
            let off = (least - center[axis]).max(center[axis] - most).max(0.0);
            square += off * off;
        }
        let off = (low - along).max(along - high).max(0.0);
        square + off * off < reach * reach
    }
}

impl Node {
    const EMPTY: Self = Self {
        below: [f32::INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY],
        above: [f32::INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY],
        planes: [f32::INFINITY, f32::NEG_INFINITY],
        next: 0,
        count: 0,
    };

    /// The box around `items`.
    fn around(items: &[Item], way: Way) -> Self {
        let mut node = Self::EMPTY;
        for Item { needle, .. } in items {
            let start = needle.start[way.axis];
            let end = start + needle.direction[way.axis] * needle.length;
            node.planes = [node.planes[0].min(start.min(end)), node.planes[1].max(start.max(end))];
        }
        node.planes[1] = node.planes[1].max(node.planes[0] + LEAST_SPAN);
        for Item { needle, .. } in items {
            let per_metre = 1.0 / needle.direction[way.axis];
            for (side, axis) in way.across().into_iter().enumerate() {
                let slope = needle.direction[axis] * per_metre;
                let at = |plane: f32| needle.start[axis] + (plane - needle.start[way.axis]) * slope;
                for (plane, found) in node.planes.into_iter().zip([&mut node.below, &mut node.above]) {
                    let at = at(plane);
                    found[side] = found[side].min(at);
                    found[side + 2] = found[side + 2].max(at);
                }
            }
        }
        node
    }
}

/// Nodes of the tree over `count` needles.
fn node_count(count: usize) -> usize {
    if count <= LEAF { 1 } else { 1 + node_count(cut(count)) + node_count(count - cut(count)) }
}

/// Where a run is cut: into two runs of whole leaves, as equal as can be.
fn cut(count: usize) -> usize {
    count.div_ceil(LEAF) / 2 * LEAF
}

/// How far apart `items` are at each of the four places that their lines are compared at.
fn extents(items: &[Item]) -> [f32; 4] {
    let mut ranges = [[f32::INFINITY, f32::NEG_INFINITY]; 4];
    for item in items {
        for (range, at) in ranges.iter_mut().zip(item.at) {
            *range = [range[0].min(at), range[1].max(at)];
        }
    }
    ranges.map(|[least, most]| most - least)
}

#[derive(Clone, Copy)]
struct Build<'a> {
    way: Way,
    stop: &'a Stop<'a>,
    control: &'a Control<'a>,
}

impl Build<'_> {
    /// Builds the node over `items`, whose first needle is number `first`, into `nodes[0]`, and what is below it behind.
    fn node(self, items: &mut [Item], first: usize, nodes: &mut [Node], index: usize) {
        if items.len() > PARALLEL && self.stop.is_set() {
            return;
        }
        let mut node = Node::around(items, self.way);
        let Some((own, below)) = nodes.split_first_mut() else { return };
        #[expect(clippy::cast_possible_truncation, reason = "needles and nodes are numbered with 32 bits")]
        let number = |value: usize| value as u32;
        if items.len() <= LEAF {
            (node.next, node.count) = (number(first), number(items.len()));
            *own = node;
            return;
        }
        let extents = extents(items);
        let widest = (1..4).fold(0, |widest, k| if extents[k] > extents[widest] { k } else { widest });
        let middle = cut(items.len());
        items.select_nth_unstable_by(middle, |a, b| a.at[widest].total_cmp(&b.at[widest]));
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
