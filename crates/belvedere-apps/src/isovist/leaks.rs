//! Rays that leave a room between the points of its surface: they are left out of the isovist.

use belvedere_data::cast::to_index;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Thresholds for closed rooms and for gaps in their surface. Neighbouring values were not measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClosedRoomParams {
    /// Maximum share of open directions of a closed room, 0 to 1. Default 0.1: streets and courtyards see more sky.
    max_open: f64,
    /// Minimum share of pairs of neighbouring ranges that are alike, 0 to 1. Default 0.9: walls and furniture, but no
    /// crowns.
    min_smooth: f64,
    /// Maximum ratio of two ranges that are alike, above 1. Default 1.15.
    max_ratio: f64,
    /// Maximum share of all directions of a gap that the surface around it bounds, 0 to 1. Default 0.02: a floor below
    /// a tripod.
    max_gap_share: f64,
    /// Maximum width of a gap that counts as closed at any length, metres. Default 0.5: scans have no points where a
    /// ceiling meets a wall.
    max_gap_width: f64,
    /// Maximum range of the surface around a gap, as a share of the maximum range of the isovist, 0 to 1. Default 0.5:
    /// farther away, the place goes on, as corridors do.
    max_gap_range: f64,
}

impl Default for ClosedRoomParams {
    fn default() -> Self {
        Self {
            max_open: 0.1,
            min_smooth: 0.9,
            max_ratio: 1.15,
            max_gap_share: 0.02,
            max_gap_width: 0.5,
            max_gap_range: 0.5,
        }
    }
}

/// A panorama of ranges.
#[derive(Clone, Copy)]
pub(super) struct RangeGrid<'a> {
    /// Row by row, `None` where nothing blocks.
    pub(super) ranges: &'a [Option<f64>],
    /// Columns, twice as many as rows.
    pub(super) width: usize,
    /// Solid angle of a cell of each row, in steradians.
    pub(super) weights: &'a [f64],
    /// Maximum range, metres.
    pub(super) reach: f64,
}

/// The surface of a room without its gaps.
pub(super) struct ClosedSurface {
    /// Ranges with those of the surface around in its gaps; `None` in true openings.
    pub(super) ranges: Vec<Option<f64>>,
    width: usize,
    /// Maximum range of a surface that closes a gap, metres.
    max_range: f64,
    /// Share of all directions that are gaps, 0 to 1.
    pub(super) gap_share: f64,
}

impl ClosedSurface {
    /// The surface around an eye; `None` where it is in no room.
    pub(super) fn of(grid: &RangeGrid<'_>, params: &ClosedRoomParams) -> Option<Self> {
        let total: f64 = grid.weights.iter().sum::<f64>() * grid.width as f64;
        let open: f64 = (0..grid.ranges.len()).filter(|&at| grid.ranges[at].is_none()).map(|at| grid.weight(at)).sum();
        if open > params.max_open * total || !grid.is_smooth(params) {
            return None;
        }
        let max_range = params.max_gap_range * grid.reach;
        let mut ranges = grid.ranges.to_vec();
        let mut gaps = 0.0;
        for cells in grid.openings() {
            let share = cells.iter().map(|&at| grid.weight(at)).sum::<f64>() / total;
            let filled: Vec<Option<f64>> = cells.iter().map(|&at| grid.range_around(at)).collect();
            let goes_on = filled.iter().flatten().any(|range| *range > max_range);
            if goes_on || share > params.max_gap_share && grid.width_of(&cells, &filled) > params.max_gap_width {
                continue;
            }
            gaps += share;
            for (&at, range) in cells.iter().zip(filled) {
                ranges[at] = range;
            }
        }
        Some(Self { ranges, width: grid.width, max_range, gap_share: gaps })
    }

    /// Range of the surface in the cell of a direction.
    pub(super) fn range_at(&self, [x, y, z]: [f64; 3]) -> Option<f64> {
        let step = TAU / self.width as f64;
        let cell = |angle: f64| to_index(angle / step);
        let column = cell(x.atan2(y) + PI) % self.width;
        let row = cell(FRAC_PI_2 - z.clamp(-1.0, 1.0).asin()).min(self.width / 2 - 1);
        let range = self.ranges.get(row * self.width + column).copied().flatten();
        range.filter(|range| *range <= self.max_range)
    }
}

impl RangeGrid<'_> {
    fn weight(&self, at: usize) -> f64 {
        self.weights.get(at / self.width).copied().unwrap_or(0.0)
    }

    fn height(&self) -> usize {
        self.width / 2
    }

    /// The cell a step to the right, to the left, below and above.
    fn neighbors(&self, at: usize) -> [Option<usize>; 4] {
        let (column, row) = (at % self.width, at / self.width);
        let in_row = |column: usize| row * self.width + column % self.width;
        [
            Some(in_row(column + 1)),
            Some(in_row(column + self.width - 1)),
            (row + 1 < self.height()).then(|| at + self.width),
            at.checked_sub(self.width),
        ]
    }

    /// Returns true if neighbouring ranges are mostly alike.
    fn is_smooth(&self, params: &ClosedRoomParams) -> bool {
        let (mut pairs, mut alike) = (0_usize, 0_usize);
        for (at, range) in self.ranges.iter().enumerate() {
            let [right, _, below, _] = self.neighbors(at);
            for other in [right, below].into_iter().flatten() {
                if let (Some(a), Some(b)) = (range, self.ranges[other]) {
                    pairs += 1;
                    alike += usize::from(a.max(b) <= params.max_ratio * a.min(b));
                }
            }
        }
        alike as f64 >= params.min_smooth * pairs as f64
    }

    /// Cells of each opening, which hang together by their sides.
    fn openings(&self) -> Vec<Vec<usize>> {
        let mut is_seen = vec![false; self.ranges.len()];
        let mut openings = Vec::new();
        for first in 0..self.ranges.len() {
            if self.ranges[first].is_some() || std::mem::replace(&mut is_seen[first], true) {
                continue;
            }
            let (mut cells, mut next) = (vec![first], 0);
            while let Some(&at) = cells.get(next) {
                next += 1;
                for other in self.neighbors(at).into_iter().flatten() {
                    if self.ranges[other].is_none() && !std::mem::replace(&mut is_seen[other], true) {
                        cells.push(other);
                    }
                }
            }
            openings.push(cells);
        }
        openings
    }

    /// Range of the surface on both sides of an open cell, along the shorter way across the opening.
    fn range_around(&self, at: usize) -> Option<f64> {
        let nearest = |way: usize| {
            let (mut cell, mut steps) = (at, 0_usize);
            while steps <= self.width {
                cell = self.neighbors(cell)[way]?;
                steps += 1;
                if let Some(range) = self.ranges[cell] {
                    return Some((steps, range));
                }
            }
            None
        };
        let across = [[0, 1], [2, 3]].map(|ways| match ways.map(nearest) {
            // the farther of the two may have been seen through the gap
            [Some((a, first)), Some((b, second))] => Some((a + b, first.min(second))),
            [Some((steps, range)), None] | [None, Some((steps, range))] => Some((2 * steps, range)),
            [None, None] => None,
        });
        across.into_iter().flatten().min_by_key(|(steps, _)| *steps).map(|(_, range)| range)
    }

    /// Width of an opening in the surface around it, metres: that of a strip with its area and border.
    fn width_of(&self, cells: &[usize], ranges: &[Option<f64>]) -> f64 {
        let step = TAU / self.width as f64;
        let (mut area, mut border) = (0.0, 0.0);
        for (&at, range) in cells.iter().zip(ranges) {
            let range = range.unwrap_or(0.0);
            area += self.weight(at) * range.powi(2);
            let neighbors = self.neighbors(at).into_iter().flatten();
            border += neighbors.filter(|&other| self.ranges[other].is_some()).count() as f64 * step * range;
        }
        2.0 * area / border
    }
}

#[cfg(test)]
mod tests {
    use crate::isovist::{Isovist, IsovistParams, isovist_of};
    use belvedere_data::control::Control;

    const SIDES: [f64; 3] = [6.0, 4.0, 3.0];

    /// Simulates the isovist of an eye in a room of 6 by 4 by 3 m, whose surface has no points where `is_gap` of a
    /// place on it.
    fn isovist_of_room(is_gap: impl Fn([f64; 3]) -> bool + Sync, max_range: f64) -> Isovist {
        let eye = [4.5, 3.0, 1.2];
        let range = |direction: [f64; 3]| {
            let to_side = |axis: usize| {
                let way = direction[axis];
                match way {
                    0.0 => f64::INFINITY,
                    way if way > 0.0 => (SIDES[axis] - eye[axis]) / way,
                    way => -eye[axis] / way,
                }
            };
            let range = (0..3).map(to_side).fold(f64::INFINITY, f64::min);
            let place = [0, 1, 2].map(|axis| eye[axis] + range * direction[axis]);
            (!is_gap(place)).then_some(range)
        };
        isovist_of(&range, &IsovistParams::default().with_max_range(max_range), &Control::none()).unwrap()
    }

    fn is_right(isovist: &Isovist) -> bool {
        (isovist.volume - 72.0).abs() < 1.0 && (isovist.plan.area - 24.0).abs() < 0.3
    }

    #[test]
    fn what_leaves_between_points_is_no_part_of_a_room() {
        // the far corner of the room, 5.7 m away, is nearer than half of the greatest range
        for reach in [15.0, 100.0] {
            let whole = isovist_of_room(|_| false, reach);
            assert!(is_right(&whole) && whole.unbounded == 0.0, "{} {}", whole.volume, whole.plan.area);
            // a slit of 15 cm where the ceiling meets the walls, and one at a corner
            let slit = isovist_of_room(|[x, y, z]| z > 2.85 && z < 2.999 || x < 0.1 && y < 0.1, reach);
            assert!(is_right(&slit) && slit.unbounded > 0.005, "{} {}", slit.volume, slit.plan.area);
            // a hole below a tripod, and one of a finger
            let hole = isovist_of_room(|[x, y, z]| z < 1e-9 && (x - 2.0).hypot(y - 1.5) < 0.8, reach);
            assert!(is_right(&hole) && hole.unbounded > 0.001, "{}", hole.volume);
            let pinhole = isovist_of_room(|[x, y, z]| x < 1e-9 && (y - 2.0).hypot(z - 1.2) < 0.03, reach);
            assert!(is_right(&pinhole), "{} {}", pinhole.volume, pinhole.plan.area);
        }
    }

    #[test]
    fn a_wall_that_is_missing_stays_open() {
        let open = isovist_of_room(|[x, _, _]| x < 1e-9, 100.0);
        assert!(open.volume > 10_000.0 && open.unbounded == 0.0, "{}", open.volume);
        let no_ceiling = isovist_of_room(|[_, _, z]| z > 2.99, 100.0);
        assert!(no_ceiling.volume > 100_000.0 && no_ceiling.unbounded == 0.0, "{}", no_ceiling.volume);
    }
}
