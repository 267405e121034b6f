//! The hole that a new point makes in a hull.

use super::NONE;

/// What an insertion needs to remember, kept from one to the next so that nothing is allocated.
pub(super) struct Cavity {
    /// Facets seen by the new point, in the order found, and how many of them have been looked around from.
    seen: Vec<u32>,
    expanded: usize,
    /// For each facet, the last insertion that saw it.
    seen_by: Vec<u32>,
    insertion: u32,
    /// Edges around the seen facets, from and to, and the facet beyond.
    pub(super) border: Vec<[u32; 3]>,
    /// For each point, the new facet whose border edge starts there.
    pub(super) fan_from: Vec<u32>,
    /// Numbers of facets that are no longer in use.
    pub(super) free: Vec<u32>,
}

impl Cavity {
    pub(super) fn new(point_count: usize) -> Self {
        Self {
            seen: Vec::new(),
            expanded: 0,
            seen_by: vec![0; 2 * point_count + 8],
            insertion: 0,
            border: Vec::new(),
            fan_from: vec![NONE; point_count],
            free: Vec::new(),
        }
    }

    pub(super) fn begin(&mut self, first: u32) {
        self.insertion += 1;
        self.seen.clear();
        self.expanded = 0;
        self.add(first);
    }

    pub(super) fn add(&mut self, facet: u32) {
        // Euler: a hull of n points has at most 2n − 4 facets, and freed numbers are used again
        self.seen_by[facet as usize] = self.insertion;
        self.seen.push(facet);
    }

    pub(super) fn next(&mut self) -> Option<u32> {
        self.expanded += 1;
        self.seen.get(self.expanded - 1).copied()
    }

    pub(super) fn knows(&self, facet: u32) -> bool {
        self.seen_by[facet as usize] == self.insertion
    }

    pub(super) fn release(&mut self) {
        self.free.append(&mut self.seen);
    }
}
