//! Balls and boxes of the index as beams take them: eight side by side, so that they are tested at once.

use crate::blocking::Ball;
use crate::ray_index::{OpenNode, PARTS, PartSides};

/// Balls, or nodes, that are tested side by side.
pub(super) const LANES: usize = PARTS;

/// A node of the index and its box.
#[derive(Clone, Copy)]
pub(super) struct IndexNode {
    /// Lowest and highest side by axis, local metres.
    pub(super) sides: [[f32; 2]; 3],
    pub(super) number: u32,
}

/// Block of up to eight nodes.
#[derive(Clone, Copy)]
pub(super) struct NodeBlock {
    pub(super) sides: PartSides,
    pub(super) number: [u32; LANES],
    /// Number of slots that are taken.
    pub(super) count: usize,
}

/// Block of up to eight balls.
#[derive(Clone, Copy)]
pub(super) struct BallBlock {
    /// Centres by axis, and radii: below zero for those that are not taken, which nothing meets.
    pub(super) columns: [[f32; LANES]; 4],
    /// Rows of the balls among those of the index.
    pub(super) row: [u32; LANES],
}

/// Things in blocks of eight. Lists that follow each other start with a block of their own.
pub(super) struct Blocks<B> {
    blocks: Vec<B>,
    /// Number of slots taken in the last block.
    last: usize,
}

/// A block of eight things.
pub(super) trait BeamBlock: Copy {
    type Item;
    const EMPTY: Self;
    fn set(&mut self, lane: usize, item: Self::Item);
}

impl BeamBlock for NodeBlock {
    type Item = IndexNode;
    const EMPTY: Self = Self { sides: [[[0.0; LANES]; 2]; 3], number: [0; LANES], count: 0 };

    #[inline(always)]
    fn set(&mut self, lane: usize, node: IndexNode) {
        for axis in 0..3 {
            for side in 0..2 {
                self.sides[axis][side][lane] = node.sides[axis][side];
            }
        }
        self.number[lane] = node.number;
        self.count = lane + 1;
    }
}

impl NodeBlock {
    #[inline(always)]
    pub(super) fn get(&self, lane: usize) -> IndexNode {
        IndexNode { sides: sides_of(&self.sides, lane), number: self.number[lane] }
    }
}

impl IndexNode {
    /// The part of an opened node, which is a node.
    #[inline(always)]
    pub(super) fn of(opened: &OpenNode<'_>, part: usize) -> Self {
        Self { sides: sides_of(&opened.sides, part), number: opened.number(part) }
    }
}

#[inline(always)]
fn sides_of([x, y, z]: &PartSides, lane: usize) -> [[f32; 2]; 3] {
    [[x[0][lane], x[1][lane]], [y[0][lane], y[1][lane]], [z[0][lane], z[1][lane]]]
}

impl BeamBlock for BallBlock {
    type Item = (Ball, u32);
    const EMPTY: Self =
        Self { columns: [[0.0; LANES], [0.0; LANES], [0.0; LANES], [f32::NEG_INFINITY; LANES]], row: [0; LANES] };

    #[inline(always)]
    fn set(&mut self, lane: usize, (ball, row): Self::Item) {
        self.columns[0][lane] = ball.center[0];
        self.columns[1][lane] = ball.center[1];
        self.columns[2][lane] = ball.center[2];
        self.columns[3][lane] = ball.radius;
        self.row[lane] = row;
    }
}

impl BallBlock {
    #[inline(always)]
    pub(super) fn get(&self, lane: usize) -> (Ball, u32) {
        let [x, y, z, radius] = &self.columns;
        (Ball { center: [x[lane], y[lane], z[lane]], radius: radius[lane] }, self.row[lane])
    }
}

impl<B> Default for Blocks<B> {
    fn default() -> Self {
        Self { blocks: Vec::new(), last: LANES }
    }
}

impl<B: BeamBlock> Blocks<B> {
    /// Number of blocks; the next entry gets a block of its own.
    pub(super) fn end(&mut self) -> usize {
        self.last = LANES;
        self.blocks.len()
    }

    #[inline(always)]
    pub(super) fn push(&mut self, item: B::Item) {
        if self.last == LANES {
            self.blocks.push(B::EMPTY);
            self.last = 0;
        }
        if let Some(block) = self.blocks.last_mut() {
            block.set(self.last, item);
            self.last += 1;
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, block: usize) -> &B {
        &self.blocks[block]
    }

    /// The blocks from a number on.
    #[inline(always)]
    pub(super) fn from(&self, first: usize) -> &[B] {
        self.blocks.get(first..).unwrap_or_default()
    }

    /// Drops all blocks but the first `count`.
    pub(super) fn truncate(&mut self, count: usize) {
        self.blocks.truncate(count);
        self.last = LANES;
    }
}
