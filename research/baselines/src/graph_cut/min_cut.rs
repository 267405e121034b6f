//! Minimum cut of a graph whose nodes have up to four neighbours each, such as tetrahedra.

use std::collections::VecDeque;

/// A graph with capacities. No two of the neighbours of a node are the same.
#[derive(Clone, Debug)]
pub(super) struct Graph {
    /// For each node up to four others; a number that no node has is none. Each has the node among its own.
    pub(super) neighbors: Vec<[u32; 4]>,
    /// Capacity from each node to each neighbour, 0 or more.
    pub(super) capacity: Vec<[i64; 4]>,
    /// Capacity from the source to each node, less that from the node to the sink.
    pub(super) terminal: Vec<i64>,
}

/// Which of the two trees a node belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum CutTree {
    None,
    Source,
    Sink,
}

/// Places of a parent: one of the neighbours 0 to 3, or these.
const TERMINAL: u8 = 4;
const ORPHAN: u8 = 5;

/// Augments paths between two search trees that are kept from one path to the next.
struct Flow {
    graph: Graph,
    tree: Vec<CutTree>,
    parent: Vec<u8>,
    /// Distance to the terminal, correct where `checked` is the present `time`.
    distance: Vec<u32>,
    checked: Vec<u32>,
    time: u32,
    active: VecDeque<u32>,
    is_active: Vec<bool>,
    orphans: VecDeque<u32>,
}

/// Whether each node lies on the side of the sink of a minimum cut. Nodes that can reach neither terminal do not.
///
/// # Source
/// Boykov & Kolmogorov 2004, "An Experimental Comparison of Min-Cut/Max-Flow Algorithms for Energy Minimization in
/// Vision", section 3; time stamps and distances: Kolmogorov 2003.
pub(super) fn sink_side(graph: Graph) -> Vec<bool> {
    let count = graph.terminal.len();
    let mut flow = Flow {
        tree: vec![CutTree::None; count],
        parent: vec![ORPHAN; count],
        distance: vec![0; count],
        checked: vec![0; count],
        time: 0,
        active: VecDeque::new(),
        is_active: vec![false; count],
        orphans: VecDeque::new(),
        graph,
    };
    flow.run();
    flow.tree.into_iter().map(|tree| tree == CutTree::Sink).collect()
}

impl Flow {
    fn run(&mut self) {
        for node in (0..).take(self.tree.len()) {
            let n = node as usize;
            if self.graph.terminal[n] != 0 {
                self.tree[n] = if self.graph.terminal[n] > 0 { CutTree::Source } else { CutTree::Sink };
                (self.parent[n], self.distance[n]) = (TERMINAL, 1);
                self.activate(node);
            }
        }
        while let Some(&node) = self.active.front() {
            let path = if self.tree[node as usize] == CutTree::None { None } else { self.grow(node) };
            let Some((from, slot)) = path else {
                self.active.pop_front();
                self.is_active[node as usize] = false;
                continue;
            };
            self.time += 1;
            self.augment(from, slot);
            while let Some(orphan) = self.orphans.pop_front() {
                self.adopt(orphan);
            }
        }
    }

    fn activate(&mut self, node: u32) {
        if !self.is_active[node as usize] {
            self.is_active[node as usize] = true;
            self.active.push_back(node);
        }
    }

    /// The neighbour at a slot, and the slot of `node` among its neighbours.
    fn across(&self, node: u32, slot: usize) -> Option<(u32, usize)> {
        let other = self.graph.neighbors[node as usize][slot];
        let back = self.graph.neighbors.get(other as usize)?.iter().position(|&back| back == node)?;
        Some((other, back))
    }

    /// What can still flow away from the terminal of `tree` through a slot of `node`: out of it in the tree of the
    /// source, into it in that of the sink.
    fn residual_outward(&self, node: u32, slot: usize, (other, back): (u32, usize), tree: CutTree) -> i64 {
        match tree {
            CutTree::Sink => self.graph.capacity[other as usize][back],
            _ => self.graph.capacity[node as usize][slot],
        }
    }

    /// Lets the tree of `node` grow by its neighbours; returns the arc from the source's tree to the sink's where it
    /// meets the other.
    fn grow(&mut self, node: u32) -> Option<(u32, usize)> {
        let n = node as usize;
        for slot in 0..4 {
            let Some((other, back)) = self.across(node, slot) else { continue };
            if self.residual_outward(node, slot, (other, back), self.tree[n]) == 0 {
                continue;
            }
            let m = other as usize;
            if self.tree[m] == CutTree::None {
                self.tree[m] = self.tree[n];
                self.hang(other, back, n);
                self.activate(other);
            } else if self.tree[m] != self.tree[n] {
                return Some(if self.tree[n] == CutTree::Source { (node, slot) } else { (other, back) });
            } else if self.checked[m] <= self.checked[n] && self.distance[m] > self.distance[n] + 1 {
                self.hang(other, back, n);
            }
        }
        None
    }

    #[expect(clippy::cast_possible_truncation, reason = "a slot is 0 to 3")]
    fn hang(&mut self, child: u32, slot: usize, parent: usize) {
        let c = child as usize;
        self.parent[c] = slot as u8;
        (self.distance[c], self.checked[c]) = (self.distance[parent] + 1, self.checked[parent]);
    }

    /// Sends all that fits along the path through an arc from the tree of the source to that of the sink.
    fn augment(&mut self, from: u32, slot: usize) {
        let Some((to, back)) = self.across(from, slot) else { return };
        let mut amount = self.graph.capacity[from as usize][slot];
        for end in [from, to] {
            self.along_path(end, |_, residual| amount = amount.min(residual.abs()));
        }
        self.graph.capacity[from as usize][slot] -= amount;
        self.graph.capacity[to as usize][back] += amount;
        for end in [from, to] {
            self.push(end, amount);
        }
    }

    /// Calls `visit` with each node of the path from `node` to its terminal and what can still flow between it and its
    /// parent.
    fn along_path(&self, mut node: u32, mut visit: impl FnMut(u32, i64)) {
        let tree = self.tree[node as usize];
        loop {
            let slot = usize::from(self.parent[node as usize]);
            let Some((parent, back)) = (slot < 4).then(|| self.across(node, slot)).flatten() else {
                visit(node, self.graph.terminal[node as usize]);
                return;
            };
            visit(node, self.residual_outward(parent, back, (node, slot), tree));
            node = parent;
        }
    }

    /// Sends `amount` between `node` and its terminal. Where nothing more fits, a node loses its parent.
    fn push(&mut self, mut node: u32, amount: i64) {
        let tree = self.tree[node as usize];
        loop {
            let n = node as usize;
            let slot = usize::from(self.parent[n]);
            let Some((parent, back)) = (slot < 4).then(|| self.across(node, slot)).flatten() else {
                self.graph.terminal[n] -= if tree == CutTree::Source { amount } else { -amount };
                if self.graph.terminal[n] == 0 {
                    self.parent[n] = ORPHAN;
                    self.orphans.push_front(node);
                }
                return;
            };
            let p = parent as usize;
            let sign = if tree == CutTree::Source { 1 } else { -1 };
            self.graph.capacity[p][back] -= sign * amount;
            self.graph.capacity[n][slot] += sign * amount;
            if self.residual_outward(parent, back, (node, slot), tree) == 0 {
                self.parent[n] = ORPHAN;
                self.orphans.push_front(node);
            }
            node = parent;
        }
    }

    /// Finds another parent for a node whose own was lost, the nearest to the terminal, or sets it free.
    fn adopt(&mut self, node: u32) {
        let n = node as usize;
        let tree = self.tree[n];
        let mut best: Option<(u32, usize)> = None;
        for slot in 0..4 {
            let Some((other, back)) = self.across(node, slot) else { continue };
            if self.tree[other as usize] != tree || self.residual_outward(other, back, (node, slot), tree) == 0 {
                continue;
            }
            if let Some(distance) = self.distance_to_terminal(other)
                && best.is_none_or(|(min, _)| distance < min)
            {
                best = Some((distance, slot));
            }
        }
        if let Some((distance, slot)) = best {
            #[expect(clippy::cast_possible_truncation, reason = "a slot is 0 to 3")]
            let slot = slot as u8;
            (self.parent[n], self.distance[n], self.checked[n]) = (slot, distance + 1, self.time);
            return;
        }
        for slot in 0..4 {
            let Some((other, back)) = self.across(node, slot) else { continue };
            if self.tree[other as usize] != tree {
                continue;
            }
            if self.residual_outward(other, back, (node, slot), tree) > 0 {
                self.activate(other);
            }
            if usize::from(self.parent[other as usize]) == back {
                self.parent[other as usize] = ORPHAN;
                self.orphans.push_back(other);
            }
        }
        self.tree[n] = CutTree::None;
        self.parent[n] = ORPHAN;
    }

    /// Steps from `node` to its terminal, or `None` where its path ends at an orphan. Remembers what it finds.
    fn distance_to_terminal(&mut self, node: u32) -> Option<u32> {
        let (mut at, mut steps) = (node, 0);
        let total = loop {
            let n = at as usize;
            if self.checked[n] == self.time {
                break steps + self.distance[n];
            }
            match self.parent[n] {
                TERMINAL => break steps + 1,
                ORPHAN => return None,
                slot => at = self.graph.neighbors[n][usize::from(slot)],
            }
            steps += 1;
        };
        let (mut at, mut left) = (node, total);
        while self.checked[at as usize] != self.time {
            let n = at as usize;
            (self.distance[n], self.checked[n]) = (left, self.time);
            if self.parent[n] == TERMINAL {
                break;
            }
            at = self.graph.neighbors[n][usize::from(self.parent[n])];
            left -= 1;
        }
        Some(total)
    }
}

#[cfg(test)]
mod tests {
    use super::{Graph, sink_side};

    const NONE: u32 = u32::MAX;

    /// A graph without pattern: pairs of nodes that have a slot left are joined.
    fn random_graph(count: u32, seed: u64) -> Graph {
        let mut counter = 0;
        let mut random = |max: u32| {
            counter += 1;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below `most`")]
            let number = (belvedere::random::uniform(seed, counter) * f64::from(max)) as u32;
            number
        };
        let mut graph = Graph {
            neighbors: vec![[NONE; 4]; count as usize],
            capacity: vec![[0; 4]; count as usize],
            terminal: (0..count).map(|_| i64::from(random(15)) - 7).collect(),
        };
        for _ in 0..4 * count {
            let (a, b) = (random(count), random(count));
            let slot = |node: u32| graph.neighbors[node as usize].iter().position(|&other| other == NONE);
            if let (Some(i), Some(j)) = (slot(a), slot(b))
                && a != b
                && !graph.neighbors[a as usize].contains(&b)
            {
                (graph.neighbors[a as usize][i], graph.neighbors[b as usize][j]) = (b, a);
                graph.capacity[a as usize][i] = i64::from(random(9));
                graph.capacity[b as usize][j] = i64::from(random(9));
            }
        }
        graph
    }

    /// What it costs to separate the nodes of the sink from all others.
    fn cost(graph: &Graph, is_sink: impl Fn(usize) -> bool) -> i64 {
        let mut cost = 0;
        for (n, &terminal) in graph.terminal.iter().enumerate() {
            cost += if is_sink(n) { terminal.max(0) } else { (-terminal).max(0) };
            for (&other, &capacity) in graph.neighbors[n].iter().zip(&graph.capacity[n]) {
                if other != NONE && !is_sink(n) && is_sink(other as usize) {
                    cost += capacity;
                }
            }
        }
        cost
    }

    #[test]
    fn the_cut_costs_as_little_as_the_best_of_all_cuts() {
        for seed in 0..300 {
            let count = 2 + u32::try_from(seed % 10).unwrap();
            let graph = random_graph(count, seed);
            let min = (0..1_u32 << count).map(|cut| cost(&graph, |n| cut >> n & 1 == 1)).min().unwrap();
            let found = sink_side(graph.clone());
            assert_eq!(cost(&graph, |n| found[n]), min, "seed {seed}");
        }
    }

    #[test]
    fn a_long_chain_breaks_at_its_weakest_link() {
        let count = 2000_u32;
        let weakest = 1234;
        let mut graph = Graph {
            neighbors: (0..count).map(|n| [n.wrapping_sub(1), n + 1, NONE, NONE]).collect(),
            capacity: (0..count).map(|n| [3, if n == weakest { 4 } else { 9 }, 0, 0]).collect(),
            terminal: vec![0; count as usize],
        };
        graph.neighbors[count as usize - 1][1] = NONE;
        (graph.terminal[0], graph.terminal[count as usize - 1]) = (100, -100);
        let expected: Vec<bool> = (0..count).map(|n| n > weakest).collect();
        assert_eq!(sink_side(graph), expected);
    }
}
