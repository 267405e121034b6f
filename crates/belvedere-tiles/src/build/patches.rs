//! Surface patches of tiles. A tile keeps all triangles that reach into it. Some are kept by several tiles, which
//! changes no answer. At each place where a line of sight meets a triangle, the tile there has the triangle.

use crate::grid::{LINE_ROOM, MapArea, TOP_SIDE, square_at};
use belvedere::SurfacePatches;
use belvedere::model::ClearedArea;
use belvedere::patches::PatchTriangle;
use std::collections::BTreeMap;

/// Returns the patches that reach into the `core` of a tile, without cleared patches. Each patch lies in one block.
/// Patches of blocks with their middle outside the tile are left to other tiles.
pub(crate) fn of_tile(patches: &SurfacePatches, core: &MapArea, cleared: &[ClearedArea]) -> SurfacePatches {
    let blocks = core.in_blocks();
    let middle = |area: &MapArea| [0, 1].map(|axis| f64::midpoint(area.low[axis], area.high[axis]));
    let mut own = select(patches, |area, _| area.meets(core) && blocks.holds(middle(area)));
    for area in cleared {
        match area {
            ClearedArea::Polygon(_) | ClearedArea::Polygons(_) => own = own.outside_polygons(&area.index()),
            ClearedArea::Class(SurfacePatches::CLASS) => own = SurfacePatches::default(),
            ClearedArea::Class(_) => {}
        }
    }
    own
}

/// Raises the highest tops over squares of 16 m to the patches that reach into them.
pub(crate) fn raise(tops: Vec<([i32; 2], f32)>, patches: &SurfacePatches) -> Vec<([i32; 2], f32)> {
    let mut tops: BTreeMap<[i32; 2], f32> = tops.into_iter().collect();
    for triangle in &patches.triangles {
        let bound = |pick: fn(f32, f32) -> f32, axis: usize| {
            triangle.iter().map(|corner| corner[axis]).fold(triangle[0][axis], pick)
        };
        let [first, last] = [f32::min, f32::max].map(|pick| square_at([bound(pick, 0), bound(pick, 1)], TOP_SIDE));
        for north in first[1]..=last[1] {
            for east in first[0]..=last[0] {
                let top = tops.entry([east, north]).or_insert(f32::NEG_INFINITY);
                *top = top.max(bound(f32::max, 2));
            }
        }
    }
    tops.into_iter().collect()
}

/// Returns the patches that `is_chosen` selects by their area on the map and their top.
pub(crate) fn select(patches: &SurfacePatches, is_chosen: impl Fn(&MapArea, f64) -> bool) -> SurfacePatches {
    let mut chosen = SurfacePatches::default();
    for (triangle, kind) in patches.iter() {
        let (area, top) = area_and_top(triangle);
        if is_chosen(&area, top) {
            chosen.push(*triangle, kind);
        }
    }
    chosen
}

/// Returns the rectangle around a triangle on the map, with a margin for an upright one, and its top, local metres.
fn area_and_top(triangle: &PatchTriangle) -> (MapArea, f64) {
    let corners = triangle.map(|corner| corner.map(f64::from));
    let around = corners.map(MapArea::at).iter().fold(MapArea::at(corners[0]), |all, own| all.joined(own));
    (around.widened(LINE_ROOM), corners.iter().map(|corner| corner[2]).fold(f64::NEG_INFINITY, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere::PatchKind;

    /// Returns a wall of 40 m, a roof that reaches into two tiles, and a small roof.
    fn patches() -> SurfacePatches {
        let mut patches = SurfacePatches::default();
        patches.push([[64.0, 10.0, 0.0], [64.0, 50.0, 0.0], [64.0, 50.0, 12.0]], PatchKind::Wall);
        patches.push([[50.0, 10.0, 9.0], [80.0, 10.0, 9.0], [80.0, 30.0, 14.0]], PatchKind::Roof);
        patches.push([[1.0, 1.0, 4.0], [9.0, 1.0, 4.0], [9.0, 9.0, 4.0]], PatchKind::Roof);
        patches
    }

    #[test]
    fn a_tile_keeps_what_reaches_into_it() {
        let tile = |from: f64, to: f64| MapArea { low: [from, 0.0], high: [to, 64.0] };
        let (west, east) = (tile(0.0, 70.0), tile(70.0, 140.0));
        assert_eq!(of_tile(&patches(), &west, &[]), patches());
        assert_eq!(of_tile(&patches(), &east, &[]).len(), 1);
        assert!(of_tile(&patches(), &tile(192.0, 256.0), &[]).is_empty());
        // The middle of the roof lies in a block of which this tile has only a part.
        assert!(of_tile(&patches(), &tile(40.0, 60.0), &[]).is_empty());
        let square = ClearedArea::Polygon(vec![vec![[0.0, 0.0], [12.0, 0.0], [12.0, 12.0], [0.0, 12.0]]]);
        assert_eq!(of_tile(&patches(), &west, &[square, ClearedArea::Class(5)]).len(), 2);
        assert!(of_tile(&patches(), &west, &[ClearedArea::Class(6)]).is_empty());
    }

    #[test]
    fn tops_are_raised_to_patches() {
        let tops = raise(vec![([0, 0], 7.0), ([4, 1], 20.0)], &patches());
        let of = |square: [i32; 2]| tops.iter().find(|(at, _)| *at == square).map(|(_, top)| *top);
        assert_eq!((of([0, 0]), of([4, 1]), of([4, 2]), of([3, 0])), (Some(7.0), Some(20.0), Some(12.0), Some(14.0)));
        assert_eq!((of([5, 1]), of([6, 0])), (Some(14.0), None));
    }
}
