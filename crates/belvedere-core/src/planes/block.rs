//! The points of a block and of what lies about it, in an order that follows from their positions.

use super::edges::Outline;
use super::ridges::RidgeLine;
use super::roof_planes::Roofs;
use super::walls::WallLine;
use super::{BLOCK, BuildingPoints, BuildingSurfaces, Edge, PlaneParams, Ridge, RoofPlane, SurveyPoints, Wall};
use belvedere_data::control::Control;
use belvedere_data::{Error, Result};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Side of the cells in which points of a block are looked up, metres.
const CELL: f64 = 2.0;
/// Least upward part of the way to a scanner that flies, as a share.
const MIN_UP: f64 = 0.3;

/// A return as surfaces need it, metres from the corner of the block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Return {
    pub(super) p: [f64; 3],
    /// Metres east and north for each metre up, on the way to the scanner; NaN where it is unknown.
    pub(super) lean: [f64; 2],
    /// Whether it may lie on a building.
    pub(super) is_building: bool,
    /// Whether it is the first of its pulse.
    pub(super) is_first: bool,
    /// Whether its pulse has several returns: a part of the beam went on.
    pub(super) is_split: bool,
}

/// A block with what lies about it.
pub(super) struct Block {
    /// Corner of the block in local metres, height 0.
    pub(super) corner: [f64; 3],
    /// Sorted by position.
    pub(super) returns: Vec<Return>,
    /// Rows of returns in each cell of the grid.
    cells: Vec<Vec<u32>>,
    /// Lowest corner of the grid.
    low: [f64; 2],
    /// Columns and rows of the grid.
    size: [usize; 2],
    /// Lowest return.
    pub(super) lowest: f64,
    /// Most lean of a pulse.
    max_lean: f64,
    /// Number of first returns in each square metre of the grid, in its own order.
    counts: Vec<u32>,
}

/// A block and the rows of its points and of those about it.
pub(super) struct BlockRows {
    number: [i64; 2],
    rows: Vec<u32>,
}

/// The blocks that hold building points, with their rows.
pub(super) fn blocks(
    survey: &SurveyPoints<'_>,
    params: &PlaneParams,
    control: &Control<'_>,
) -> Result<Vec<BlockRows>> {
    let expected = survey.positions.len();
    if survey.scanner.len() != expected {
        return Err(Error::LengthMismatch { what: "scanner positions", expected, found: survey.scanner.len() });
    }
    let mut rows_of: BTreeMap<[i64; 2], (bool, Vec<u32>)> = BTreeMap::new();
    #[expect(clippy::cast_possible_truncation, reason = "positions of a cloud are far below 2^63 blocks")]
    let number = |v: f64| (v / BLOCK).floor() as i64;
    for (row, p) in survey.positions.iter().enumerate() {
        if row % 65_536 == 0 {
            control.check()?;
        }
        let Ok(short) = u32::try_from(row) else { break };
        let [x, y] = [0, 1].map(|axis| f64::from(p[axis]) + survey.origin[axis]);
        let own = [number(x), number(y)];
        let is_building = is_building(survey, row);
        for column in number(x - params.margin)..=number(x + params.margin) {
            for line in number(y - params.margin)..=number(y + params.margin) {
                let (holds, rows) = rows_of.entry([column, line]).or_default();
                *holds |= is_building && own == [column, line];
                rows.push(short);
            }
        }
    }
    let with_buildings = rows_of.into_iter().filter(|(_, (holds, _))| *holds);
    Ok(with_buildings.map(|(number, (_, rows))| BlockRows { number, rows }).collect())
}

/// Whether a point may lie on a building.
fn is_building(survey: &SurveyPoints<'_>, row: usize) -> bool {
    let class = survey.attributes.classification.as_ref().and_then(|classes| classes.get(row)).copied();
    match survey.buildings {
        BuildingPoints::Classified => class == Some(6),
        BuildingPoints::ByShape => !matches!(class, Some(2..=5 | 7 | 9 | 17 | 18)),
    }
}

impl Block {
    /// The points of a block.
    ///
    /// # Errors
    /// None so far.
    pub(super) fn new(survey: &SurveyPoints<'_>, block: BlockRows) -> Result<Self> {
        #[expect(clippy::cast_precision_loss, reason = "numbers of blocks")]
        let [x, y] = [0, 1].map(|axis| block.number[axis] as f64 * BLOCK - survey.origin[axis]);
        let corner = [x, y, 0.0];
        let number_of = |row: usize| survey.attributes.return_number.as_ref().and_then(|n| n.get(row)).copied();
        let count_of = |row: usize| survey.attributes.return_count.as_ref().and_then(|n| n.get(row)).copied();
        let mut returns: Vec<Return> = Vec::with_capacity(block.rows.len());
        for row in block.rows.into_iter().map(|row| row as usize) {
            let (is_first, is_building) = (number_of(row).is_none_or(|n| n <= 1), is_building(survey, row));
            if !(is_first || is_building) {
                continue;
            }
            let (at, from) = (survey.positions[row], survey.scanner[row]);
            let way: [f64; 3] = std::array::from_fn(|i| f64::from(from[i]) - f64::from(at[i]));
            let is_flown = way[2] > MIN_UP * way[0].hypot(way[1]);
            let lean = if is_flown { [way[0] / way[2], way[1] / way[2]] } else { [f64::NAN; 2] };
            let p = std::array::from_fn(|i| f64::from(at[i]) - corner[i]);
            let is_split = count_of(row).is_some_and(|n| n > 1);
            returns.push(Return { p, lean, is_building, is_first, is_split });
        }
        returns.sort_unstable_by(|a, b| {
            let by_place = (0..3).fold(Ordering::Equal, |order, i| order.then(a.p[i].total_cmp(&b.p[i])));
            let by_lean = (0..2).fold(by_place, |order, i| order.then(a.lean[i].total_cmp(&b.lean[i])));
            by_lean.then(b.is_first.cmp(&a.is_first)).then(b.is_split.cmp(&a.is_split))
        });
        Ok(Self::indexed(corner, returns))
    }

    /// A block of sorted returns.
    fn indexed(corner: [f64; 3], returns: Vec<Return>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (mut lowest, mut max_lean) = (f64::INFINITY, 0.0_f64);
        for found in &returns {
            for axis in 0..2 {
                low[axis] = low[axis].min(found.p[axis]);
                high[axis] = high[axis].max(found.p[axis]);
            }
            lowest = lowest.min(found.p[2]);
            max_lean = max_lean.max(found.lean[0].hypot(found.lean[1]));
        }
        let size = [0, 1].map(|axis| count_of((high[axis] - low[axis]).max(0.0) / CELL) + 1);
        let mut block = Self {
            corner,
            cells: vec![Vec::new(); size[0] * size[1]],
            counts: vec![0; size[0] * size[1]],
            returns,
            low,
            size,
            lowest,
            max_lean,
        };
        for row in 0..block.returns.len() {
            let [column, line] = block.cell(block.returns[row].p);
            let cell = line * block.size[0] + column;
            block.counts[cell] += u32::from(block.returns[row].is_first);
            block.cells[cell].extend(u32::try_from(row));
        }
        block
    }

    /// Column and row of the cell of a place, the nearest one for places beyond.
    fn cell(&self, p: [f64; 3]) -> [usize; 2] {
        [0, 1].map(|axis| count_of((p[axis] - self.low[axis]) / CELL).min(self.size[axis] - 1))
    }

    /// Calls `visit` with every return between two corners in plan, and some about them.
    pub(super) fn each_in(&self, low: [f64; 2], high: [f64; 2], mut visit: impl FnMut(usize, &Return)) {
        let [from, to] = [low, high].map(|p| self.cell([p[0], p[1], 0.0]));
        for line in from[1]..=to[1] {
            for column in from[0]..=to[0] {
                for &row in &self.cells[line * self.size[0] + column] {
                    let row = row as usize;
                    visit(row, &self.returns[row]);
                }
            }
        }
    }

    /// How far in plan a pulse moves at most from where it crosses a height to its return.
    pub(super) fn max_shift(&self, height: f64) -> f64 {
        (height - self.lowest).max(0.0) * self.max_lean
    }

    /// Mean distance of pulses about a place, metres.
    pub(super) fn spacing(&self, p: [f64; 3]) -> f64 {
        let [column, line] = self.cell(p);
        let (mut count, mut cells) = (0, 0.0);
        for line in line.saturating_sub(1)..=(line + 1).min(self.size[1] - 1) {
            for column in column.saturating_sub(1)..=(column + 1).min(self.size[0] - 1) {
                count += self.counts[line * self.size[0] + column];
                cells += 1.0;
            }
        }
        (cells * CELL * CELL / f64::from(count.max(1))).sqrt()
    }

    /// Whether a place in plan lies in the block itself.
    pub(super) fn holds(&self, p: [f64; 2]) -> bool {
        p.iter().all(|v| (0.0..BLOCK).contains(v))
    }

    /// A place of the block in local metres.
    pub(super) fn local(&self, p: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| p[i] + self.corner[i])
    }

    /// The piece of a line in plan within the block, as ranges from 0 to 1 between two points; `None` outside.
    fn piece(&self, [a, b]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
        let mut range = [0.0_f64, 1.0_f64];
        for axis in 0..2 {
            let step = b[axis] - a[axis];
            let [to_low, to_high] = [0.0 - a[axis], BLOCK - a[axis]];
            if step.abs() < 1e-12 {
                if !(0.0..BLOCK).contains(&a[axis]) {
                    return None;
                }
                continue;
            }
            let [s, t] = [to_low / step, to_high / step];
            range = [range[0].max(s.min(t)), range[1].min(s.max(t))];
        }
        (range[0] < range[1]).then_some(range)
    }

    /// Gives out planes, edges, ridges and walls as far as they lie in the block.
    pub(super) fn give_out(
        &self,
        roofs: &Roofs,
        ridges: &[RidgeLine],
        outlines: &[Outline],
        walls: &[WallLine],
        found: &mut BuildingSurfaces,
    ) {
        let mut row_of = vec![usize::MAX; roofs.planes.len()];
        for (number, roof) in roofs.planes.iter().enumerate() {
            let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
            let mut is_here = false;
            for &row in &roof.rows {
                let p = roofs.points[row as usize];
                is_here |= self.holds([p[0], p[1]]);
                for axis in 0..3 {
                    bounds[0][axis] = bounds[0][axis].min(p[axis]);
                    bounds[1][axis] = bounds[1][axis].max(p[axis]);
                }
            }
            if is_here {
                row_of[number] = found.planes.len();
                found.planes.push(RoofPlane {
                    normal: roof.plane.normal,
                    center: self.local(roof.center),
                    bounds: bounds.map(|corner| self.local(corner)),
                    count: roof.rows.len(),
                    noise: roof.plane.noise,
                    sd: roof.sd(),
                });
            }
        }
        let lifted = |plane: usize, [a, b]: [[f64; 2]; 2], [from, to]: [f64; 2]| {
            [from, to].map(|share| {
                let p = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
                self.local([p[0], p[1], roofs.planes[plane].plane.height(p)])
            })
        };
        let mut edge_row: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for (plane, outline) in outlines.iter().enumerate() {
            for (number, edge) in outline.edges.iter().enumerate() {
                let ends = edge.line.end_points();
                let Some(range) = self.piece(ends).filter(|_| row_of[plane] != usize::MAX) else { continue };
                edge_row.insert((plane, number), found.edges.len());
                found.edges.push(Edge {
                    ends: lifted(plane, ends, range),
                    plane: row_of[plane],
                    sd: edge.sd,
                    count: edge.count,
                    drop: edge.drop,
                });
            }
        }
        for ridge in ridges {
            let ends = ridge.line.end_points();
            let planes = ridge.planes.map(|plane| row_of[plane]);
            if let Some(range) = self.piece(ends).filter(|_| planes.iter().all(|&row| row != usize::MAX)) {
                found.ridges.push(Ridge {
                    ends: lifted(ridge.planes[0], ends, range),
                    planes,
                    is_convex: ridge.is_convex,
                });
            }
        }
        for wall in walls {
            let ends = wall.line.end_points();
            let edge = edge_row.get(&(wall.plane, wall.edge));
            if let (Some(range), Some(&edge)) = (self.piece(ends), edge) {
                let ends = lifted(wall.plane, ends, range);
                let middle = f64::midpoint(ends[0][2], ends[1][2]);
                found.walls.push(Wall {
                    ends: ends.map(|p| [p[0], p[1]]),
                    heights: [wall.bottom, middle],
                    edge,
                    count: wall.points.len(),
                    noise: wall.noise,
                    sd: wall.sd,
                    share: wall.share,
                    eaves: wall.eaves,
                });
            }
        }
    }
}

/// A number of cells, 0 for what is below.
fn count_of(cells: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cells of a block, and saturating")]
    let count = cells.max(0.0) as usize;
    count
}
