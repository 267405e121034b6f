//! Tests of eight boxes or balls at once. They are conservative: all that pass are tested exactly.

use super::blockers::LANES;
use crate::blocking::Ball;
use crate::ray_index::PartSides;
use belvedere_data::vector::{cross, dot};

/// Planes around a beam.
pub(super) const PLANES: usize = 6;

/// Centres by axis, and radii, of eight balls.
pub(super) type LaneColumns = [[f32; LANES]; 4];

/// A convex space between planes.
pub(super) struct ConvexSpace {
    pub(super) normals: [[f32; 3]; PLANES],
    pub(super) offsets: [f32; PLANES],
    /// For each plane and axis the side of a box that lies farther inward: 0 for the lowest, 1 for the highest.
    pub(super) inward: [[u8; 3]; PLANES],
}

impl ConvexSpace {
    /// All space.
    pub(super) fn all() -> Self {
        Self { normals: [[0.0; 3]; PLANES], offsets: [f32::MAX; PLANES], inward: [[0; 3]; PLANES] }
    }

    /// Limits the space by a plane with an outward unit normal, so far out along it, local metres. The rounding of f32
    /// must be added to the offset; boxes of nodes are padded by as much again.
    pub(super) fn set(&mut self, plane: usize, normal: [f32; 3], offset: f32) {
        self.normals[plane] = normal;
        self.offsets[plane] = offset;
        self.inward[plane] = normal.map(|v| u8::from(v < 0.0));
    }
}

/// A half line from `origin` along the unit vector `direction`, and by how much it is widened.
#[derive(Clone, Copy)]
pub(super) struct HalfLine {
    pub(super) origin: [f32; 3],
    pub(super) direction: [f32; 3],
    pub(super) room: f32,
}

/// Bit mask over eight lanes: one bit for each that fulfils a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LaneBits(pub(super) u32);

impl LaneBits {
    /// Keeps the bits of the first `count` lanes.
    #[inline(always)]
    pub(super) fn first(self, count: usize) -> Self {
        if count < LANES { Self(self.0 & !(u32::MAX << count)) } else { self }
    }

    #[inline(always)]
    pub(super) fn holds(self, lane: usize) -> bool {
        self.0 >> lane & 1 == 1
    }
}

impl Iterator for LaneBits {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let lane = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(lane)
    }
}

/// The tests, for one set of instructions.
pub(super) trait Kernels {
    /// Flags the boxes that may reach into the space.
    fn meet_boxes(space: &ConvexSpace, sides: &PartSides) -> LaneBits;
    /// Flags the balls that may reach into the space.
    fn meet_balls(space: &ConvexSpace, balls: &LaneColumns) -> LaneBits;
    /// Flags the balls that reach about as far on all sides as the space, whose first four planes enclose it. Only
    /// these are worth the exact test of hiding all of it.
    fn may_cover(space: &ConvexSpace, balls: &LaneColumns) -> LaneBits;
    /// Flags the balls that may touch a half line.
    fn near_line(balls: &LaneColumns, line: &HalfLine) -> LaneBits;
    /// Balls by column.
    fn columns(balls: &[Ball; LANES]) -> LaneColumns;
}

/// Plain loops over eight lanes without branches, which compilers turn into the vector instructions that they may use.
/// With `FUSED`, products are added before they are rounded, which is slow on machines that have no such instruction.
pub(super) struct BeamScalar<const FUSED: bool>;

/// The bits of lanes that are true.
#[inline(always)]
fn bits(lanes: [bool; LANES]) -> LaneBits {
    let mut bits = 0;
    for (lane, holds) in lanes.into_iter().enumerate() {
        bits |= u32::from(holds) << lane;
    }
    LaneBits(bits)
}

impl<const FUSED: bool> BeamScalar<FUSED> {
    /// Returns the depth of places behind a plane, metres.
    #[inline(always)]
    fn depths(space: &ConvexSpace, plane: usize, [x, y, z]: [&[f32; LANES]; 3]) -> [f32; LANES] {
        let (normal, offset) = (space.normals[plane], space.offsets[plane]);
        let less = |depth: f32, a: f32, b: f32| if FUSED { (-a).mul_add(b, depth) } else { depth - a * b };
        let mut depths = [offset; LANES];
        for lane in 0..LANES {
            for (axis, place) in [x, y, z].into_iter().enumerate() {
                depths[lane] = less(depths[lane], normal[axis], place[lane]);
            }
        }
        depths
    }
}

impl<const FUSED: bool> Kernels for BeamScalar<FUSED> {
    #[inline(always)]
    fn meet_boxes(space: &ConvexSpace, sides: &PartSides) -> LaneBits {
        let mut min = [f32::INFINITY; LANES];
        for plane in 0..PLANES {
            let [x, y, z] = space.inward[plane].map(|side| usize::from(side & 1));
            let depths = Self::depths(space, plane, [&sides[0][x], &sides[1][y], &sides[2][z]]);
            for lane in 0..LANES {
                min[lane] = if depths[lane] < min[lane] { depths[lane] } else { min[lane] };
            }
        }
        bits(min.map(|min| min >= 0.0))
    }

    #[inline(always)]
    fn meet_balls(space: &ConvexSpace, [x, y, z, radius]: &LaneColumns) -> LaneBits {
        let mut min = *radius;
        for plane in 0..PLANES {
            let depths = Self::depths(space, plane, [x, y, z]);
            for lane in 0..LANES {
                min[lane] = if depths[lane] < min[lane] { depths[lane] } else { min[lane] };
            }
        }
        let mut meets = [false; LANES];
        for lane in 0..LANES {
            meets[lane] = min[lane] >= -radius[lane];
        }
        bits(meets)
    }

    #[inline(always)]
    fn may_cover(space: &ConvexSpace, [x, y, z, radius]: &LaneColumns) -> LaneBits {
        let planes: [[f32; LANES]; 4] = std::array::from_fn(|plane| Self::depths(space, plane, [x, y, z]));
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let mut covers = [false; LANES];
        for lane in 0..LANES {
            let across = larger(planes[0][lane], planes[1][lane]);
            let along = larger(planes[2][lane], planes[3][lane]);
            covers[lane] = across * across + along * along <= radius[lane] * radius[lane];
        }
        bits(covers)
    }

    #[inline(always)]
    fn near_line([x, y, z, radius]: &LaneColumns, line: &HalfLine) -> LaneBits {
        let mut near = [false; LANES];
        for lane in 0..LANES {
            let m = [x[lane] - line.origin[0], y[lane] - line.origin[1], z[lane] - line.origin[2]];
            let across = cross(m, line.direction);
            let reach = radius[lane] + line.room;
            near[lane] = (dot(across, across) <= reach * reach) & (dot(m, line.direction) >= -reach) & (reach > 0.0);
        }
        bits(near)
    }

    #[inline(always)]
    fn columns(balls: &[Ball; LANES]) -> LaneColumns {
        let axis = |axis: usize| balls.map(|ball| ball.center[axis]);
        [axis(0), axis(1), axis(2), balls.map(|ball| ball.radius)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The form for machines without fused products.
    type Plain = BeamScalar<false>;

    /// The wedge of points with x from −1 to 1 and y at most 2.
    fn wedge() -> ConvexSpace {
        let mut space = ConvexSpace::all();
        space.set(0, [1.0, 0.0, 0.0], 1.0);
        space.set(1, [-1.0, 0.0, 0.0], 1.0);
        space.set(4, [0.0, 1.0, 0.0], 2.0);
        space
    }

    #[test]
    fn boxes_and_balls_that_reach_into_a_space_are_met_and_others_are_not() {
        let x = [0.0, 3.0, 2.0, -2.0, 0.0, 0.0, 1.5, -9.0];
        let y = [0.0, 0.0, 0.0, 0.0, 3.0, 4.0, 2.5, 0.0];
        // each with a half size, or a radius, of 1: it touches in the third, fourth and fifth case
        let met = LaneBits(0b0101_1101);
        let around = |centers: [f32; LANES]| [centers.map(|v| v - 1.0), centers.map(|v| v + 1.0)];
        assert_eq!(Plain::meet_boxes(&wedge(), &[around(x), around(y), around([7.0; LANES])]), met);
        let balls: LaneColumns = [x, y, [7.0; LANES], [1.0; LANES]];
        assert_eq!(Plain::meet_balls(&wedge(), &balls), met);
        assert_eq!(Plain::meet_balls(&wedge(), &[x, y, x, [f32::NEG_INFINITY; LANES]]), LaneBits(0));
    }

    #[test]
    fn balls_near_a_half_line_are_those_before_or_at_its_start_and_beside_it() {
        let line = HalfLine { origin: [0.0; 3], direction: [1.0, 0.0, 0.0], room: 0.0 };
        let x = [5.0, -0.5, -2.0, 5.0, 5.0, 0.0, 100.0, 1.0];
        let y = [0.5, 0.0, 0.0, 1.5, -1.0, 0.0, 0.0, 0.0];
        let radius = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, f32::NEG_INFINITY];
        assert_eq!(Plain::near_line(&[x, y, [0.0; LANES], radius], &line), LaneBits(0b0111_0011));
    }

    #[test]
    fn bits_are_gone_through_from_the_lowest() {
        let bits = LaneBits(0b1010_0110);
        assert_eq!(bits.collect::<Vec<_>>(), [1, 2, 5, 7]);
        assert_eq!(bits.first(5).collect::<Vec<_>>(), [1, 2]);
        assert_eq!(bits.first(8), bits);
        assert!(bits.holds(5) && !bits.holds(0));
    }
}
