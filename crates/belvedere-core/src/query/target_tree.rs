//! Targets in a tree, so that many can be answered at once.

/// Targets of a leaf: about as many as share the few balls that lie before one of them.
pub(super) const LEAF: usize = 8;
/// Targets from which on two threads order them.
const SHARED: usize = 16_384;

/// Targets ordered so that neighbours are answered together; made once for any number of viewers.
///
/// See [`super::MedialScene::visible_among`] and [`super::MedialScene::answer_among`].
pub struct TargetTree {
    /// Depth first; the root comes first.
    pub(super) nodes: Vec<TargetNode>,
    /// Local metres, in the order of the tree.
    positions: Vec<[f32; 3]>,
    /// Row of each of them among the targets given.
    rows: Vec<u32>,
    given_count: usize,
}

/// Some of the targets, and the box that just holds them.
pub(super) struct TargetNode {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
    /// Places of the targets in the order of the tree.
    pub(super) first: usize,
    pub(super) count: usize,
    /// Nodes of the two halves; `None` for a leaf.
    pub(super) halves: Option<[usize; 2]>,
}

impl TargetTree {
    /// Orders `targets`, (M, 3) local metres. Those that are not finite are never visible to anybody.
    #[must_use]
    pub fn new(targets: &[[f32; 3]]) -> Self {
        let finite = |row: &u32| targets.get(*row as usize).is_some_and(|p| p.iter().all(|v| v.is_finite()));
        let mut rows: Vec<u32> = (0..).take(targets.len()).filter(finite).collect();
        order(&mut rows, targets);
        let positions: Vec<[f32; 3]> = rows.iter().map(|&row| targets[row as usize]).collect();
        let mut nodes = Vec::with_capacity(2 * positions.len().div_ceil(LEAF / 2));
        if !positions.is_empty() {
            add_nodes(&mut nodes, &positions, 0);
        }
        Self { nodes, positions, rows, given_count: targets.len() }
    }

    /// Number of targets given.
    #[must_use]
    pub fn len(&self) -> usize {
        self.given_count
    }

    /// Returns true if no target was given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.given_count == 0
    }

    /// Row of each target among those given, in the order of the tree; without those that are not finite.
    #[must_use]
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// Positions in the order of the tree, local metres.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Lowest and highest corner of the box that just holds them, local metres; `None` without any that is finite.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f32; 3]; 2]> {
        self.nodes.first().map(|root| [root.low, root.high])
    }

    /// Returns true if a corner of that box fulfils `condition`, for one that holds beyond some distance if it holds
    /// anywhere.
    pub fn any_corner(&self, condition: impl Fn([f64; 3]) -> bool) -> bool {
        self.bounds().is_some_and(|bounds| {
            (0..8).any(|corner| condition(std::array::from_fn(|axis| f64::from(bounds[corner >> axis & 1][axis]))))
        })
    }

    /// Nodes of at most `max` targets, or leaves, that together hold every target, in the order of the tree.
    pub(super) fn subtrees(&self, max: usize) -> Vec<usize> {
        let mut found = Vec::new();
        let mut waiting: Vec<usize> = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(node) = waiting.pop() {
            match self.nodes[node].halves {
                Some([left, right]) if self.nodes[node].count > max => waiting.extend([right, left]),
                _ => found.push(node),
            }
        }
        found
    }
}

/// Puts the lower half along the longest side of the box first, and so on within each half.
fn order(rows: &mut [u32], targets: &[[f32; 3]]) {
    if rows.len() <= LEAF {
        return;
    }
    let (low, high) = bounds(rows.iter().map(|&row| targets[row as usize]));
    let side = |axis: usize| high[axis] - low[axis];
    let axis = (1..3).fold(0, |longest, axis| if side(axis) > side(longest) { axis } else { longest });
    let half = rows.len() / 2;
    // ties by row, so that the order does not depend on how the selection works
    rows.select_nth_unstable_by(half, |&a, &b| {
        targets[a as usize][axis].total_cmp(&targets[b as usize][axis]).then(a.cmp(&b))
    });
    let shared = rows.len() >= SHARED;
    let (lower, upper) = rows.split_at_mut(half);
    if shared {
        rayon::join(|| order(lower, targets), || order(upper, targets));
    } else {
        order(lower, targets);
        order(upper, targets);
    }
}

/// Appends the node of `positions`, which begin at place `first`, and the nodes of its halves; returns its number.
fn add_nodes(nodes: &mut Vec<TargetNode>, positions: &[[f32; 3]], first: usize) -> usize {
    let (low, high) = bounds(positions.iter().copied());
    let number = nodes.len();
    nodes.push(TargetNode { low, high, first, count: positions.len(), halves: None });
    if positions.len() > LEAF {
        let (lower, upper) = positions.split_at(positions.len() / 2);
        let left = add_nodes(nodes, lower, first);
        let right = add_nodes(nodes, upper, first + lower.len());
        nodes[number].halves = Some([left, right]);
    }
    number
}

fn bounds(positions: impl Iterator<Item = [f32; 3]>) -> ([f32; 3], [f32; 3]) {
    positions.fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(low, high), p| {
        (std::array::from_fn(|i| low[i].min(p[i])), std::array::from_fn(|i| high[i].max(p[i])))
    })
}
