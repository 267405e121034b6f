//! The octree of COPC files and EPT folders: where a node lies.

use crate::points::read_options::FileBox;

/// Deepest level of an octree that is believed: a kilometre in cells of a nanometre.
const DEEPEST: i32 = 40;

/// The cube of the root, in the coordinates of the file.
pub(crate) struct OctreeCube {
    pub(crate) low: [f64; 3],
    pub(crate) side: f64,
}

impl OctreeCube {
    /// Returns true if the cell of a node, widened by `room`, meets `wanted`, as all cells do without a box; `None` for
    /// an impossible node. The key is its level, and its number along x, y and z.
    pub(crate) fn node_meets(&self, key: [i32; 4], room: [f64; 3], wanted: Option<&FileBox>) -> Option<bool> {
        let [level, place @ ..] = key;
        if !(0..=DEEPEST).contains(&level) {
            return None;
        }
        if place.iter().any(|&v| v < 0 || f64::from(v) >= f64::from(level).exp2()) {
            return None;
        }
        let (low, high) = self.node_bounds(key, room);
        Some(wanted.is_none_or(|wanted| wanted.meets(low, high)))
    }

    /// Lowest and highest corner of the cell of a node, widened by `room`.
    pub(crate) fn node_bounds(&self, key: [i32; 4], room: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let [level, place @ ..] = key;
        let side = self.side / f64::from(level).exp2();
        let low: [f64; 3] = std::array::from_fn(|i| self.low[i] + f64::from(place[i]) * side - room[i]);
        (low, std::array::from_fn(|i| low[i] + side + 2.0 * room[i]))
    }
}
