//! Planar patches of surfaces that are known from the survey better than from single points.

use crate::frame::{FARTHEST, is_near};
use crate::polygon::PolygonIndex;
use crate::vector::{cross, length, sub, to_f32};
use crate::{Error, Parameter, Result};

/// Kind of surface that a patch belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PatchKind {
    /// A roof.
    Roof,
    /// A wall.
    Wall,
    /// The upright edge of a flat roof.
    Parapet,
    /// A sheet from the edge of a roof down to a roof close below it.
    Step,
    /// A side or top of something that stands on a roof.
    Box,
    /// An upright sheet within a building, from the roof to the ground.
    Inside,
    /// The top or the underside of a deck, a canopy, a balcony or a bridge.
    Slab,
}

impl PatchKind {
    /// All kinds, in the order of their codes.
    pub const ALL: [Self; 7] = [Self::Roof, Self::Wall, Self::Parapet, Self::Step, Self::Box, Self::Inside, Self::Slab];

    /// Its number in files.
    #[must_use]
    pub fn code(self) -> u8 {
        self as u8
    }

    /// The kind of a number in a file.
    #[must_use]
    pub fn of_code(code: u8) -> Option<Self> {
        Self::ALL.get(usize::from(code)).copied()
    }

    /// Returns its name in answers and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["roof", "wall", "parapet", "step", "box", "inside", "slab"][self as usize]
    }
}

/// A triangle of a patch: its corners, local metres, counter-clockwise seen from outside.
pub type PatchTriangle = [[f32; 3]; 3];

/// Planar patches of surfaces of the survey: triangles that block lines of sight beside the balls. They are parts of
/// buildings (ASPRS class 6).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfacePatches {
    /// Corners, (T, 3, 3), local metres, counter-clockwise seen from outside.
    pub triangles: Vec<PatchTriangle>,
    /// Kind of each, (T).
    pub kinds: Vec<PatchKind>,
}

/// Number and area of the triangles of a kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatchCount {
    /// Triangles.
    pub count: usize,
    /// Their area, m².
    pub area_m2: f64,
}

impl SurfacePatches {
    /// The building class of ASPRS, which all patches belong to.
    pub const CLASS: u8 = 6;

    /// Number of triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Returns true if there is no triangle.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Adds a triangle.
    pub fn push(&mut self, triangle: PatchTriangle, kind: PatchKind) {
        self.triangles.push(triangle);
        self.kinds.push(kind);
    }

    /// The triangles and their kinds.
    pub fn iter(&self) -> impl Iterator<Item = (&PatchTriangle, PatchKind)> + Clone {
        self.triangles.iter().zip(self.kinds.iter().copied())
    }

    /// Checks that each triangle has a kind, and that all corners lie within [`FARTHEST`].
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] or [`Error::InvalidParameter`] for the first fault.
    pub fn validate(&self) -> Result<()> {
        let (expected, found) = (self.triangles.len(), self.kinds.len());
        if expected != found {
            return Err(Error::LengthMismatch { what: "kinds of surface patches", expected, found });
        }
        match self.triangles.as_flattened().iter().find(|corner| !is_near(**corner)) {
            None => Ok(()),
            Some(corner) => Err(Error::invalid(
                Parameter::Obstacle,
                format!("a surface patch with a corner at {corner:?}, farther than {FARTHEST} m away"),
                "within 10000 km of the origin",
            )),
        }
    }

    /// Returns the number and area of the triangles of each kind, in the order of [`PatchKind::ALL`].
    #[must_use]
    pub fn counts(&self) -> [PatchCount; 7] {
        let mut counts = [PatchCount::default(); 7];
        for (triangle, kind) in self.iter() {
            let count = &mut counts[kind as usize];
            count.count += 1;
            count.area_m2 += area(&in_f64(triangle));
        }
        counts
    }

    /// Area of all triangles, m².
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.counts().iter().map(|count| count.area_m2).sum()
    }

    /// Returns the patches outside `rings`, local metres in plan: an outline and its holes. Triangles that an edge of
    /// the rings crosses are cut there; all others are kept or dropped whole. So are triangles near more than a
    /// thousand sides of the rings.
    #[must_use]
    pub fn outside(&self, rings: &[Vec<[f64; 2]>]) -> Self {
        self.outside_polygons(&PolygonIndex::new(rings))
    }

    /// The same outside some polygons.
    #[must_use]
    pub fn outside_polygons(&self, index: &PolygonIndex) -> Self {
        let holds =
            |piece: &Triangle| index.holds(std::array::from_fn(|i| piece.iter().map(|c| c[i]).sum::<f64>() / 3.0));
        let mut left = Self::default();
        for (triangle, kind) in self.iter() {
            let whole = in_f64(triangle);
            let bound = |pick: fn(f64, f64) -> f64| {
                [0, 1].map(|axis| whole.iter().map(|corner| corner[axis]).fold(whole[0][axis], pick))
            };
            let mut sides = Vec::new();
            index.each_side_near(bound(f64::min), bound(f64::max), |side| sides.push(side));
            let mut pieces = Vec::new();
            let sides = if sides.len() <= MAX_SIDES { &sides[..] } else { &[] };
            cut_along(whole, sides, &mut pieces);
            if !pieces.iter().any(holds) {
                left.push(*triangle, kind);
                continue;
            }
            for piece in pieces.iter().filter(|piece| !holds(piece) && area(piece) > MIN_AREA) {
                left.push(piece.map(|corner| corner.map(to_f32)), kind);
            }
        }
        left
    }
}

/// Maximum number of sides of an area that a triangle is cut along: a triangle that more of them cross stays or goes
/// with its middle.
const MAX_SIDES: usize = 1000;
/// Pieces that are smaller are left out when triangles are cut, m²: a square millimetre.
const MIN_AREA: f64 = 1e-6;

type Triangle = [[f64; 3]; 3];

fn in_f64(triangle: &PatchTriangle) -> Triangle {
    triangle.map(|corner| corner.map(f64::from))
}

fn area([a, b, c]: &Triangle) -> f64 {
    0.5 * length(cross(sub(*b, *a), sub(*c, *a)))
}

/// Returns true if the boxes of a triangle and an edge meet in plan.
fn may_cross(piece: &Triangle, edge: &[[f64; 2]; 2]) -> bool {
    (0..2).all(|axis| {
        let [low, high] = [f64::min, f64::max].map(|pick| {
            let of_edge = pick(edge[0][axis], edge[1][axis]);
            (piece.iter().map(|corner| corner[axis]).fold(piece[0][axis], pick), of_edge)
        });
        low.0 <= high.1 && low.1 <= high.0
    })
}

/// Returns true if an edge runs through the inside of a triangle in plan, or may if that is a line there.
fn crosses(piece: &Triangle, edge: &[[f64; 2]; 2]) -> bool {
    let turn = |a: [f64; 3], b: [f64; 3], [x, y]: [f64; 2]| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    let [a, b, c] = *piece;
    let doubled_area = turn(a, b, [c[0], c[1]]);
    let is_beside = |[from, to]: [[f64; 3]; 2]| edge.iter().all(|end| turn(from, to, *end) * doubled_area <= 0.0);
    may_cross(piece, edge) && (doubled_area == 0.0 || ![[a, b], [b, c], [c, a]].into_iter().any(is_beside))
}

/// Appends the pieces of a triangle that edges cut it into. Each piece is cut by the edges that cross it only. The
/// number of pieces therefore grows with that of the edges of an outline, and not with its square.
fn cut_along(piece: Triangle, edges: &[[[f64; 2]; 2]], pieces: &mut Vec<Triangle>) {
    let mut pending = vec![(piece, edges.to_vec())];
    while let Some((piece, mut edges)) = pending.pop() {
        edges.retain(|edge| crosses(&piece, edge));
        let parts = loop {
            let Some(edge) = edges.pop() else { break Vec::new() };
            let parts = cut(piece, &edge);
            if parts.len() > 1 {
                break parts;
            }
        };
        match &parts[..] {
            [] => pieces.push(piece),
            parts => pending.extend(parts.iter().map(|part| (*part, edges.clone()))),
        }
    }
}

/// A triangle cut along the vertical plane of an edge, where the edge may cross it.
fn cut(piece: Triangle, edge: &[[f64; 2]; 2]) -> Vec<Triangle> {
    let [from, to] = *edge;
    let beside =
        |corner: [f64; 3]| (to[0] - from[0]) * (corner[1] - from[1]) - (to[1] - from[1]) * (corner[0] - from[0]);
    let sides = piece.map(beside);
    // the corner that lies alone on its side
    let alone = (0..3).find(|&i| {
        let [own, next, last] = [0, 1, 2].map(|k| sides[(i + k) % 3] > 0.0);
        own != next && own != last
    });
    let Some(i) = alone.filter(|_| may_cross(&piece, edge)) else { return vec![piece] };
    let [a, b, c] = [0, 1, 2].map(|k| piece[(i + k) % 3]);
    let [of_a, of_b, of_c] = [0, 1, 2].map(|k| sides[(i + k) % 3]);
    let between = |end: [f64; 3], of_end: f64| -> [f64; 3] {
        let share = of_a / (of_a - of_end);
        std::array::from_fn(|axis| a[axis] + share * (end[axis] - a[axis]))
    };
    let (on_b, on_c) = (between(b, of_b), between(c, of_c));
    vec![[a, on_b, on_c], [on_b, b, c], [on_b, c, on_c]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof of 10 by 6 m at 5 m, and a wall below its southern edge.
    fn house() -> SurfacePatches {
        let mut patches = SurfacePatches::default();
        let roof = [[0.0, 0.0, 5.0], [10.0, 0.0, 5.0], [10.0, 6.0, 5.0], [0.0, 6.0, 5.0]];
        let wall = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 0.0, 5.0], [0.0, 0.0, 5.0]];
        for ([a, b, c, d], kind) in [(roof, PatchKind::Roof), (wall, PatchKind::Wall)] {
            patches.push([a, b, c], kind);
            patches.push([a, c, d], kind);
        }
        patches
    }

    #[test]
    fn patches_are_counted_by_kind() {
        let counts = house().counts();
        assert_eq!(counts.map(|count| count.count), [2, 2, 0, 0, 0, 0, 0]);
        assert!((counts[0].area_m2 - 60.0).abs() < 1e-9 && (counts[1].area_m2 - 50.0).abs() < 1e-9);
        for (code, kind) in (0..).zip(PatchKind::ALL) {
            assert_eq!((kind.code(), PatchKind::of_code(code)), (code, Some(kind)));
        }
        assert_eq!(PatchKind::of_code(7), None);
    }

    #[test]
    fn damaged_patches_are_refused() {
        let mut patches = house();
        patches.kinds.pop();
        assert!(matches!(patches.validate(), Err(Error::LengthMismatch { expected: 4, found: 3, .. })));
        for wrong in [f32::NAN, f32::INFINITY, 2e7] {
            let mut patches = house();
            patches.triangles[3][1][2] = wrong;
            assert!(patches.validate().is_err(), "{wrong}");
        }
        assert!(house().validate().is_ok());
    }

    #[test]
    fn a_round_area_is_cut_out_of_many_triangles() {
        let mut floor = SurfacePatches::default();
        for i in 0..40_i16 {
            for j in 0..40_i16 {
                let [x, y] = [i, j].map(|v| -10.0 + 0.5 * f32::from(v));
                let [a, b, c, d] = [[x, y, 3.0], [x + 0.5, y, 3.0], [x + 0.5, y + 0.5, 3.0], [x, y + 0.5, 3.0]];
                floor.push([a, b, c], PatchKind::Roof);
                floor.push([a, c, d], PatchKind::Roof);
            }
        }
        let circle = |count: i32| -> Vec<[f64; 2]> {
            let at = |i: i32| 1e-3 + std::f64::consts::TAU * f64::from(i) / f64::from(count);
            (0..count).map(|i| [4.0 * at(i).cos(), 4.0 * at(i).sin()]).collect()
        };
        let area = |count: i32| 8.0 * f64::from(count) * (std::f64::consts::TAU / f64::from(count)).sin();
        let left = floor.outside(&[circle(2000)]).area_m2();
        // each side leaves some slivers of less than a square millimetre, which go
        assert!((left - (400.0 - area(2000))).abs() < 2000.0 * 10.0 * MIN_AREA, "{left}");
        // where thousands of sides cross each triangle, these go with their middles: off by less than their areas
        let left = floor.outside(&[circle(1_000_000)]).area_m2();
        assert!((left - (400.0 - area(1_000_000))).abs() < 4.0, "{left}");
    }

    #[test]
    fn what_is_outside_an_area_stays_to_its_edge() {
        let house = house();
        // a square beside it changes no bit
        let beside = vec![vec![[20.0, 0.0], [24.0, 0.0], [24.0, 4.0], [20.0, 4.0]]];
        assert_eq!(house.outside(&beside), house);
        // all of it
        let around = vec![vec![[-1.0, -1.0], [11.0, -1.0], [11.0, 7.0], [-1.0, 7.0]]];
        assert!(house.outside(&around).is_empty());
        // the eastern part, along a slanted edge, with a hole of one square metre
        let outline = vec![[4.0, -1.0], [20.0, -1.0], [20.0, 7.0], [6.0, 7.0]];
        let hole = vec![[7.0, 2.0], [8.0, 2.0], [8.0, 3.0], [7.0, 3.0]];
        let left = house.outside(&[outline, hole]);
        let counts = left.counts();
        // the edge runs through x = 4.25 at y = 0 and 5.75 at y = 6
        assert!((counts[0].area_m2 - (6.0 * 5.0 + 1.0)).abs() < 1e-4, "{counts:?}");
        assert!((counts[1].area_m2 - 4.25 * 5.0).abs() < 1e-4, "{counts:?}");
        // they look the same way as before
        for (triangle, kind) in left.iter() {
            let [a, b, c] = in_f64(triangle);
            let normal = cross(sub(b, a), sub(c, a));
            assert!(if kind == PatchKind::Roof { normal[2] > 0.0 } else { normal[1] < 0.0 }, "{triangle:?}");
        }
    }
}
