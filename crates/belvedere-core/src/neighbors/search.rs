//! Walks through the tree, the same for every kind of lanes.

use super::lanes::{Child, LANES, Lanes, PointTree};

/// A point found, by its index in the array the index was built from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// Index of the point.
    pub index: u32,
    /// Its squared distance from the query, square metres.
    pub distance_squared: f32,
}

/// Children waiting to be opened, nearest on top.
///
/// A node leaves at most seven children behind for each level, and eight-fold splits of 2³² points make ten levels.
pub(super) struct Pending {
    entries: [(f32, Child); 80],
    count: usize,
}

impl Pending {
    #[inline(always)]
    pub(super) fn root() -> Self {
        Self { entries: [(0.0, Child::node(0)); 80], count: 1 }
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<(f32, Child)> {
        self.count = self.count.checked_sub(1)?;
        Some(self.entries[self.count])
    }

    /// Adds the children named by `mask` so that the nearest is opened first.
    #[inline(always)]
    pub(super) fn push(&mut self, mask: u32, distances: &[f32; LANES], children: &[Child; LANES]) {
        let base = self.count;
        for lane in set_lanes(mask) {
            let mut at = self.count;
            while at > base && self.entries[at - 1].0 < distances[lane] {
                self.entries[at] = self.entries[at - 1];
                at -= 1;
            }
            self.entries[at] = (distances[lane], children[lane]);
            self.count += 1;
        }
    }
}

/// The lanes of a mask, lowest first.
#[inline(always)]
pub(super) fn set_lanes(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        if mask == 0 {
            return None;
        }
        let lane = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        Some(lane)
    })
}

/// Calls `visit` with the points no farther than the bound it returns, which must not grow.
#[inline(always)]
fn walk<L: Lanes>(tree: &PointTree, query: [f32; 3], bound: f32, mut visit: impl FnMut(Neighbor) -> f32) {
    if tree.is_empty() || !(bound >= 0.0) {
        return;
    }
    // missing children lie at an infinite distance, which must stay above every bound
    let mut bound = bound.min(f32::MAX);
    let mut distances = [0.0; LANES];
    let mut pending = Pending::root();
    while let Some((distance, child)) = pending.pop() {
        if distance > bound {
            continue;
        }
        match child.open() {
            Ok(node) => {
                let node = &tree.nodes[node];
                let mask = L::boxes(node, query, bound, &mut distances);
                pending.push(mask, &distances, &node.children);
            }
            Err(blocks) => {
                for block in blocks {
                    let mask = L::points(&tree.blocks[block], query, bound, &mut distances);
                    for lane in set_lanes(mask) {
                        let distance_squared = distances[lane];
                        bound = visit(Neighbor { index: tree.order[block * LANES + lane], distance_squared });
                    }
                }
            }
        }
    }
}

#[inline(always)]
pub(super) fn nearest<L: Lanes>(tree: &PointTree, query: [f32; 3], bound_squared: f32) -> Option<Neighbor> {
    if !(bound_squared > 0.0) {
        return None;
    }
    let mut best = Neighbor { index: u32::MAX, distance_squared: bound_squared.next_down().min(f32::MAX) };
    walk::<L>(tree, query, best.distance_squared, |found| {
        if found.distance_squared < best.distance_squared
            || (found.distance_squared == best.distance_squared && found.index < best.index)
        {
            best = found;
        }
        best.distance_squared
    });
    (best.index != u32::MAX).then_some(best)
}

#[inline(always)]
pub(super) fn k_nearest<L: Lanes>(tree: &PointTree, query: [f32; 3], k: usize, found: &mut Vec<Neighbor>) {
    found.clear();
    if k == 0 {
        return;
    }
    walk::<L>(tree, query, f32::MAX, |new| {
        let after = |old: &Neighbor| {
            old.distance_squared > new.distance_squared
                || (old.distance_squared == new.distance_squared && old.index > new.index)
        };
        if found.len() == k {
            if !found.last().is_some_and(after) {
                return found[k - 1].distance_squared;
            }
            found.pop();
        }
        let mut at = found.len();
        while at > 0 && after(&found[at - 1]) {
            at -= 1;
        }
        found.insert(at, new);
        if found.len() == k { found[k - 1].distance_squared } else { f32::MAX }
    });
}

#[inline(always)]
pub(super) fn within_radius<L: Lanes>(tree: &PointTree, query: [f32; 3], radius: f32, mut visit: impl FnMut(Neighbor)) {
    if !(radius >= 0.0) {
        return;
    }
    let bound = radius * radius;
    walk::<L>(tree, query, bound, |found| {
        if found.distance_squared <= bound {
            visit(found);
        }
        bound
    });
}
