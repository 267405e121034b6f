//! The order in which points are inserted into a hull, and looked for.

use belvedere::cast::{to_index, to_row};

/// Points in the first round of insertions; each later round holds as many as all before it.
const FIRST_ROUND: usize = 1000;
/// Cells per side of the space-filling curve: its keys fit beside the round in 64 bits.
const CURVE_CELLS: f64 = 262_143.0;

/// All points but `first`: rounds that double in size, chosen at random, each along a space-filling curve.
pub(crate) fn insertion_order(points: &[[f64; 3]], first: &[u32], curve: &Curve) -> Vec<u32> {
    let round_count = (points.len() / FIRST_ROUND).max(1).ilog2();
    let mut keys: Vec<(u64, u32)> = (0..to_row(points.len()))
        .filter(|index| !first.contains(index))
        .map(|index| {
            // half of the points come in the last round, a quarter in the one before
            let lot = belvedere::random::uniform(0, u64::from(index)).max(1e-9);
            let rounds_before_last = to_row(to_index(-lot.log2())).min(round_count);
            (u64::from(round_count - rounds_before_last) << 54 | curve.key(points[index as usize]), index)
        })
        .collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, index)| index).collect()
}

/// Places in space in an order that keeps neighbours together (Morton 1966).
pub(crate) struct Curve {
    low: [f64; 3],
    cells_per_metre: f64,
}

impl Curve {
    pub(crate) fn new(points: &[[f64; 3]]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in points {
            for axis in 0..3 {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
        }
        let size = (0..3).map(|axis| high[axis] - low[axis]).fold(f64::MIN_POSITIVE, f64::max);
        Self { low, cells_per_metre: CURVE_CELLS / size }
    }

    /// Below 2^54.
    pub(crate) fn key(&self, point: [f64; 3]) -> u64 {
        let cell = |axis: usize| {
            let cells = (point[axis] - self.low[axis]) * self.cells_per_metre;
            to_index(cells.clamp(0.0, CURVE_CELLS)) as u64
        };
        spread(cell(0)) | spread(cell(1)) << 1 | spread(cell(2)) << 2
    }
}

/// The lowest 18 bits of `v`, three places apart.
fn spread(v: u64) -> u64 {
    let mut x = v & 0x3_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}
