//! Eight boxes or points at a time: the memory layout, and the scalar form of each test.

use super::tangent::Tangent;

/// Points or boxes tested together.
pub(super) const LANES: usize = 8;

/// Eight points, or one face of eight boxes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct LaneBlock {
    pub(super) x: [f32; LANES],
    pub(super) y: [f32; LANES],
    pub(super) z: [f32; LANES],
}

impl LaneBlock {
    pub(super) const fn filled(value: f32) -> Self {
        Self { x: [value; LANES], y: [value; LANES], z: [value; LANES] }
    }

    pub(super) fn set(&mut self, lane: usize, point: [f32; 3]) {
        self.x[lane] = point[0];
        self.y[lane] = point[1];
        self.z[lane] = point[2];
    }
}

/// Eight children with their tight boxes; a missing child has a box turned inside out, infinitely far from everything.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct WideNode {
    pub(super) low: LaneBlock,
    pub(super) high: LaneBlock,
    pub(super) children: [Child; LANES],
}

/// A child: another node, or a leaf of one to four blocks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 points make fewer than 2^27 nodes")]
    pub(super) const fn node(index: usize) -> Self {
        Self(index as u32)
    }

    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 points make at most 2^29 blocks")]
    pub(super) const fn leaf(first_block: usize, block_count: usize) -> Self {
        Self(Self::LEAF | (first_block as u32) << 2 | (block_count as u32 - 1))
    }

    /// The node, or the range of blocks.
    #[inline(always)]
    pub(super) const fn open(self) -> Result<usize, std::ops::Range<usize>> {
        if self.0 & Self::LEAF == 0 {
            return Ok(self.0 as usize);
        }
        let first = (self.0 & !Self::LEAF) as usize >> 2;
        Err(first..first + (self.0 & 3) as usize + 1)
    }
}

/// The tree of an index: nodes, the root first; blocks of points in its order; and the index of the point in each slot.
#[derive(Debug)]
pub(super) struct PointTree {
    pub(super) nodes: Vec<WideNode>,
    pub(super) blocks: Vec<LaneBlock>,
    pub(super) order: Vec<u32>,
}

impl PointTree {
    pub(super) fn is_empty(&self) -> bool {
        self.order.is_empty()
    }
}

/// The tests a search makes of eight boxes or points. Each returns a mask of the lanes that pass and leaves their
/// values in `out`; implementations round alike, so that searches on either give the same answer.
pub(super) trait Lanes {
    /// Squared distance from `query` to each box; passes up to and including `bound`.
    fn boxes(node: &WideNode, query: [f32; 3], bound: f32, out: &mut [f32; LANES]) -> u32;
    /// Squared distance from `query` to each point; passes up to and including `bound`.
    fn points(block: &LaneBlock, query: [f32; 3], bound: f32, out: &mut [f32; LANES]) -> u32;
    /// Radius of the tangent ball through each point; passes up to and including `bound`.
    fn tangent_radii(block: &LaneBlock, tangent: &Tangent, bound: f32, out: &mut [f32; LANES]) -> u32;
}

/// One lane after the other.
#[cfg_attr(
    all(target_arch = "wasm32", target_feature = "simd128"),
    expect(dead_code, reason = "simd128.rs takes its place")
)]
pub(super) struct NeighborScalar;

#[expect(clippy::needless_range_loop, reason = "reads like the eight lanes of avx2.rs that it must agree with")]
impl Lanes for NeighborScalar {
    #[inline(always)]
    fn boxes(node: &WideNode, query: [f32; 3], bound: f32, out: &mut [f32; LANES]) -> u32 {
        let gap = |low: f32, high: f32, q: f32| (low - q).max(q - high).max(0.0);
        let mut mask = 0;
        for lane in 0..LANES {
            let dx = gap(node.low.x[lane], node.high.x[lane], query[0]);
            let dy = gap(node.low.y[lane], node.high.y[lane], query[1]);
            let dz = gap(node.low.z[lane], node.high.z[lane], query[2]);
            out[lane] = dx * dx + dy * dy + dz * dz;
            mask |= u32::from(out[lane] <= bound) << lane;
        }
        mask
    }

    #[inline(always)]
    fn points(block: &LaneBlock, query: [f32; 3], bound: f32, out: &mut [f32; LANES]) -> u32 {
        let mut mask = 0;
        for lane in 0..LANES {
            let dx = block.x[lane] - query[0];
            let dy = block.y[lane] - query[1];
            let dz = block.z[lane] - query[2];
            out[lane] = dx * dx + dy * dy + dz * dz;
            mask |= u32::from(out[lane] <= bound) << lane;
        }
        mask
    }

    #[inline(always)]
    fn tangent_radii(block: &LaneBlock, tangent: &Tangent, bound: f32, out: &mut [f32; LANES]) -> u32 {
        let mut mask = 0;
        let Tangent { point, inward, margin } = *tangent;
        for lane in 0..LANES {
            let ax = (block.x[lane] - point[0]) - margin * inward[0];
            let ay = (block.y[lane] - point[1]) - margin * inward[1];
            let az = (block.z[lane] - point[2]) - margin * inward[2];
            let depth = ax * inward[0] + ay * inward[1] + az * inward[2];
            out[lane] = (ax * ax + ay * ay + az * az) / (depth + depth);
            mask |= u32::from(depth > 0.0 && out[lane] <= bound) << lane;
        }
        mask
    }
}
