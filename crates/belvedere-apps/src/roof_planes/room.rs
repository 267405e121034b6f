//! Room for panels on a plane.

use super::RoofPlaneParams;
use super::cells::PlaneCells;
use super::fit::PlaneFit;
use belvedere_core::neighbors::NeighborIndex;
use belvedere_data::cast::{to_f32, to_f32s};
use belvedere_data::vector::{dot, sub};
use std::f64::consts::{PI, TAU};

/// Minimum height above its plane of an obstacle to a panel, metres: twice the distance up to which points count as on
/// the plane. Parapets, chimneys and dormers are higher.
const CLEARANCE: f64 = 0.25;
/// Maximum height above a plane at which a point over a cell is an obstacle, metres. Chimneys and the walls of higher
/// parts are lower, or have points below that height.
const OVERHEAD: f64 = 6.0;
/// A point of no plane.
const NO_PLANE: u32 = u32::MAX;

/// Assignment of the points of a roof to planes.
pub(super) struct Room<'a> {
    points: &'a [[f32; 3]],
    index: &'a NeighborIndex,
    /// Number of the plane of each point.
    owner: Vec<u32>,
    /// Radius around a middle within which points count, metres.
    reach: f64,
}

impl<'a> Room<'a> {
    pub(super) fn new(
        points: &'a [[f32; 3]],
        index: &'a NeighborIndex,
        planes: &[(Vec<u32>, PlaneFit)],
        params: &RoofPlaneParams,
    ) -> Self {
        let mut owner = vec![NO_PLANE; points.len()];
        for (number, (rows, _)) in (0..).zip(planes) {
            rows.iter().filter_map(|&row| usize::try_from(row).ok()).for_each(|row| owner[row] = number);
        }
        Self { points, index, owner, reach: params.reach.max(params.cell) }
    }

    /// Returns true if a panel fits on the cell of plane `number` with this middle. Points of the plane lie all around
    /// the middle, so that it is not beyond the edge, and nothing stands on the cell.
    pub(super) fn fits(&self, number: u32, cells: &PlaneCells, normal: [f64; 3], middle: [f64; 3]) -> bool {
        let offset = |row: usize| {
            let offset = sub(self.points[row].map(f64::from), middle);
            [cells.along, cells.up, normal].map(|axis| dot(offset, axis))
        };
        let near = |center: [f64; 3], radius: f64, visit: &mut dyn FnMut(usize)| {
            self.index.within_radius(to_f32s(center), to_f32(radius), |found| visit(found.index as usize));
        };
        let mut around = Vec::new();
        near(middle, self.reach, &mut |row| {
            if self.owner[row] == number {
                let [u, v, _] = offset(row);
                around.push(v.atan2(u));
            }
        });
        if !is_all_around(around) {
            return false;
        }
        let mut is_clear = true;
        let above = [0, 1, 2].map(|i| middle[i] + OVERHEAD / 2.0 * normal[i]);
        near(above, OVERHEAD / 2.0 + cells.cell, &mut |row| {
            let [u, v, height] = offset(row);
            is_clear &= self.owner[row] == number || height <= CLEARANCE || u.abs().max(v.abs()) >= cells.cell / 2.0;
        });
        is_clear
    }
}

/// Returns true if directions leave no half circle empty.
fn is_all_around(mut angles: Vec<f64>) -> bool {
    angles.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return false };
    let over_the_end = first + TAU - last;
    angles.windows(2).map(|pair| pair[1] - pair[0]).fold(over_the_end, f64::max) < PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_middle_is_among_points_where_no_half_circle_is_empty() {
        let degrees = |list: &[f64]| is_all_around(list.iter().map(|v| v.to_radians()).collect());
        assert!(degrees(&[0.0, 120.0, -120.0]) && degrees(&[10.0, 80.0, 175.0, -100.0]));
        assert!(!degrees(&[0.0, 90.0, 175.0]) && !degrees(&[-179.0, 179.0]) && !degrees(&[30.0]) && !degrees(&[]));
    }
}
