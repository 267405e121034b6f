//! The points of a block and its margin, in an order that follows from their positions.

use super::line::clip;
use belvedere_data::cast::{to_ascending_bits, to_i64, to_index, to_row};
use belvedere_data::cloud::GROUND;
use belvedere_data::control::Control;
use belvedere_data::patches::SurfacePatches;
use belvedere_data::{Attributes, Error, Result};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Side of the blocks in which surfaces are found, metres.
pub(super) const BLOCK: f64 = 64.0;
/// Side of the cells in which points of a block are looked up, metres.
const CELL: f64 = 2.0;
/// Classes of bridge decks: that of ASPRS, and that of the Dutch AHN.
const DECKS: [u8; 2] = [17, 26];
/// Minimum upward part of the direction to a scanner that flies, as a share.
const MIN_UP: f64 = 0.3;

/// The points that surfaces are found in. Columns have a row for each point.
#[derive(Clone, Copy)]
pub struct SurveyPoints<'a> {
    /// Measured positions, (N, 3) local metres.
    pub positions: &'a [[f32; 3]],
    /// The scanner at each point, (N, 3) local metres, NaN where unknown.
    pub scanner: &'a [[f32; 3]],
    /// Return numbers are used where present. Points of class 6 lie on buildings; where there are none, single returns
    /// of classes 0 and 1 may, if there are points of class 2 below them. Without classes nothing is found.
    pub attributes: &'a Attributes,
    /// Origin of the local positions in the reference system, metres.
    pub origin: [f64; 3],
}

/// A return as surfaces need it, metres from the corner of the block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Return {
    /// Its row in the survey.
    pub(super) row: u32,
    pub(super) p: [f64; 3],
    /// Metres east and north for each metre up, on the way to the scanner; NaN where it is unknown.
    pub(super) lean: [f64; 2],
    /// Knowledge of whether it lies on a building.
    pub(super) building: Building,
    /// True if its class is open, or that of a structure.
    pub(super) is_structure: bool,
    /// True if it has the class of bridge decks.
    pub(super) is_deck: bool,
    /// True if it lies on the ground.
    pub(super) is_ground: bool,
    /// True if it is the first of its pulse.
    pub(super) is_first: bool,
    /// True if its pulse has several returns: a part of the beam went on.
    pub(super) is_split: bool,
}

/// Knowledge of whether a return lies on a building.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Building {
    /// Another class says that it does not, or its pulse has several returns, as in trees.
    No,
    /// It has class 0 or 1, and no point of the block or about it has class 6. If it lies on a plane that is large,
    /// flat and high enough, it does.
    Unknown,
    /// Class 6.
    Yes,
}

impl Return {
    pub(super) fn may_be_building(&self) -> bool {
        self.building != Building::No
    }

    /// Returns true if it lies on a building or another structure.
    pub(super) fn is_solid(&self) -> bool {
        self.may_be_building() || self.is_structure
    }

    /// Returns true if it may lie on a slab that is no part of a building.
    pub(super) fn may_be_slab(&self) -> bool {
        self.is_structure && !self.may_be_building() && self.is_first && !self.is_split
    }
}

/// A block with its margin.
pub(super) struct Block {
    /// Its number in the grid of the reference system.
    pub(super) number: [i64; 2],
    /// Origin of local positions in the reference system, metres.
    pub(super) origin: [f64; 3],
    /// Corner of the block in local metres, height 0.
    pub(super) corner: [f64; 3],
    /// Sorted by cell, and by position in each.
    pub(super) returns: Vec<Return>,
    /// First return of each cell of the grid, and the end.
    cells: Vec<u32>,
    grid: Grid,
    /// Lowest return.
    pub(super) lowest: f64,
    /// Maximum lean of a pulse.
    pub(super) max_lean: f64,
    /// Number of first returns in each cell of the grid.
    counts: Vec<u32>,
}

/// The cells of a block and its margin.
#[derive(Clone, Copy)]
struct Grid {
    /// Margin beyond the block, metres.
    margin: f64,
    /// Columns, and rows.
    side: usize,
}

impl Grid {
    fn new(margin: f64) -> Self {
        Self { margin, side: to_index((BLOCK + 2.0 * margin) / CELL) + 1 }
    }

    /// Column or row of a coordinate, the nearest one for those beyond.
    fn cell(&self, v: f64) -> usize {
        to_index((v + self.margin) / CELL).min(self.side - 1)
    }

    /// Number of the cell of a place.
    fn number(&self, p: [f64; 3]) -> usize {
        self.cell(p[1]) * self.side + self.cell(p[0])
    }
}

/// A block and the rows of its points and of those about it.
pub(super) struct BlockRows {
    number: [i64; 2],
    rows: Vec<u32>,
}

/// The blocks that hold building points, with their rows.
pub(super) fn blocks(survey: &SurveyPoints<'_>, margin: f64, control: &Control<'_>) -> Result<Vec<BlockRows>> {
    let expected = survey.positions.len();
    if survey.scanner.len() != expected {
        return Err(Error::LengthMismatch { what: "scanner positions", expected, found: survey.scanner.len() });
    }
    let mut rows_of: BTreeMap<[i64; 2], (bool, Vec<u32>)> = BTreeMap::new();
    for (row, p) in survey.positions.iter().enumerate() {
        if row % 65_536 == 0 {
            control.check()?;
        }
        let Ok(short) = u32::try_from(row) else { break };
        let may_be_building = building(survey, row) != Building::No;
        let is_first = is_first(survey, row);
        if !(may_be_building || is_first) {
            continue;
        }
        let is_wanted = may_be_building || (is_structure(survey, row) && returns(survey, row) <= 1);
        let [x, y] = [0, 1].map(|axis| f64::from(p[axis]) + survey.origin[axis]);
        let own = [number(x), number(y)];
        for column in number(x - margin)..=number(x + margin) {
            for line in number(y - margin)..=number(y + margin) {
                let (holds, rows) = rows_of.entry([column, line]).or_default();
                *holds |= is_wanted && own == [column, line];
                rows.push(short);
            }
        }
    }
    let with_buildings = rows_of.into_iter().filter(|(_, (holds, _))| *holds);
    Ok(with_buildings.map(|(number, (_, rows))| BlockRows { number, rows }).collect())
}

/// Number of the block of a coordinate of the reference system.
fn number(v: f64) -> i64 {
    to_i64((v / BLOCK).floor())
}

/// Number of the block that a local position lies in.
pub(super) fn block_of(p: [f32; 3], origin: [f64; 2]) -> [i64; 2] {
    [0, 1].map(|axis| number(f64::from(p[axis]) + origin[axis]))
}

/// Returns true if a point is the first return of its pulse.
fn is_first(survey: &SurveyPoints<'_>, row: usize) -> bool {
    survey.attributes.return_number.as_ref().and_then(|numbers| numbers.get(row)).is_none_or(|&number| number <= 1)
}

/// Returns whether a point lies on a building.
fn building(survey: &SurveyPoints<'_>, row: usize) -> Building {
    match survey.attributes.class_of(row) {
        Some(SurfacePatches::CLASS) => Building::Yes,
        Some(0 | 1) if returns(survey, row) <= 1 => Building::Unknown,
        _ => Building::No,
    }
}

/// Returns true if the class of a point is none of ground, plants, noise, water and wires.
fn is_structure(survey: &SurveyPoints<'_>, row: usize) -> bool {
    survey.attributes.class_of(row).is_some_and(|class| !matches!(class, 2..=5 | 7..=9 | 13..=16 | 18 | 20 | 40..=45))
}

/// Number of returns of the pulse of a point, 1 where it is unknown.
fn returns(survey: &SurveyPoints, row: usize) -> u8 {
    survey.attributes.return_count.as_ref().and_then(|counts| counts.get(row)).map_or(1, |&count| count)
}

impl Block {
    /// The points of a block.
    pub(super) fn new(survey: &SurveyPoints<'_>, block: BlockRows, margin: f64) -> Self {
        let [x, y] = [0, 1].map(|axis| block.number[axis] as f64 * BLOCK - survey.origin[axis]);
        let corner = [x, y, 0.0];
        let grid = Grid::new(margin);
        let read = |short: u32| {
            let row = short as usize;
            let (at, from) = (survey.positions[row], survey.scanner[row]);
            let way: [f64; 3] = std::array::from_fn(|i| f64::from(from[i]) - f64::from(at[i]));
            let is_flown = way[2] > MIN_UP * way[0].hypot(way[1]);
            Return {
                row: short,
                p: std::array::from_fn(|i| f64::from(at[i]) - corner[i]),
                lean: if is_flown { [way[0] / way[2], way[1] / way[2]] } else { [f64::NAN; 2] },
                building: building(survey, row),
                is_structure: is_structure(survey, row),
                is_deck: survey.attributes.class_of(row).is_some_and(|class| DECKS.contains(&class)),
                is_ground: survey.attributes.class_of(row) == Some(GROUND),
                is_first: is_first(survey, row),
                is_split: returns(survey, row) > 1,
            }
        };
        // keys are sorted rather than returns, which are longer
        let mut keys: Vec<(u32, [u32; 3], u32)> = Vec::with_capacity(block.rows.len());
        for row in block.rows {
            let at = survey.positions[row as usize];
            let cell = grid.number(std::array::from_fn(|i| f64::from(at[i]) - corner[i]));
            keys.push((to_row(cell), at.map(to_ascending_bits), row));
        }
        keys.sort_unstable_by_key(|key| (key.0, key.1));
        let mut returns: Vec<Return> = keys.iter().map(|key| read(key.2)).collect();
        if returns.iter().any(|found| found.building == Building::Yes) {
            // who classified buildings here left out what is none
            let unknown = returns.iter_mut().filter(|found| found.building == Building::Unknown);
            unknown.for_each(|found| found.building = Building::No);
        }
        // what lies in one place has an order of its own
        let mut first = 0;
        for group in keys.chunk_by(|a, b| a.1 == b.1) {
            if group.len() > 1 {
                returns[first..first + group.len()].sort_unstable_by(|a, b| {
                    let by_lean = (0..2).fold(Ordering::Equal, |order, i| order.then(a.lean[i].total_cmp(&b.lean[i])));
                    let flags =
                        |r: &Return| (r.building, [r.is_ground, r.is_first, r.is_split, r.is_structure, r.is_deck]);
                    by_lean.then(flags(a).cmp(&flags(b)))
                });
            }
            first += group.len();
        }
        Self { number: block.number, origin: survey.origin, ..Self::indexed(corner, grid, returns) }
    }

    /// A block of sorted returns.
    fn indexed(corner: [f64; 3], grid: Grid, returns: Vec<Return>) -> Self {
        let (mut lowest, mut max_lean) = (f64::INFINITY, 0.0_f64);
        let mut counts = vec![0; grid.side * grid.side];
        let mut cells = vec![0_u32; grid.side * grid.side + 1];
        for found in &returns {
            lowest = lowest.min(found.p[2]);
            let lean = found.lean[0].powi(2) + found.lean[1].powi(2);
            max_lean = max_lean.max(lean);
            let cell = grid.number(found.p);
            counts[cell] += u32::from(found.is_first);
            cells[cell + 1] += 1;
        }
        for cell in 1..cells.len() {
            cells[cell] += cells[cell - 1];
        }
        Self {
            number: [0; 2],
            origin: [0.0; 3],
            corner,
            returns,
            cells,
            grid,
            lowest,
            max_lean: max_lean.sqrt(),
            counts,
        }
    }

    /// Calls `visit` with every return between two corners in plan, and some about them.
    pub(super) fn each_in(&self, low: [f64; 2], high: [f64; 2], mut visit: impl FnMut(usize, &Return)) {
        let [columns, rows] = [0, 1].map(|axis| [self.grid.cell(low[axis]), self.grid.cell(high[axis])]);
        for row in rows[0]..=rows[1] {
            let first = row * self.grid.side;
            let [from, to] = [first + columns[0], first + columns[1] + 1].map(|cell| self.cells[cell] as usize);
            for (row, found) in self.returns[from..to].iter().enumerate() {
                visit(from + row, found);
            }
        }
    }

    /// Highest ground between two corners in plan and about them; `None` without any.
    pub(super) fn ground(&self, low: [f64; 2], high: [f64; 2]) -> Option<f64> {
        let mut highest = None;
        self.each_in(low, high, |_, found| {
            if found.is_ground {
                highest = Some(highest.map_or(found.p[2], |z: f64| z.max(found.p[2])));
            }
        });
        highest
    }

    /// Returns the maximum horizontal shift of a pulse between a height and its return, metres.
    pub(super) fn max_shift(&self, height: f64) -> f64 {
        (height - self.lowest).max(0.0) * self.max_lean
    }

    /// Mean distance of pulses about a place, metres.
    pub(super) fn spacing(&self, p: [f64; 3]) -> f64 {
        let [columns, rows] = [0, 1].map(|axis| {
            let cell = self.grid.cell(p[axis]);
            cell.saturating_sub(1)..=(cell + 1).min(self.grid.side - 1)
        });
        let (mut count, mut cells) = (0, 0.0);
        for row in rows {
            for column in columns.clone() {
                count += self.counts[row * self.grid.side + column];
                cells += 1.0;
            }
        }
        (cells * CELL * CELL / f64::from(count.max(1))).sqrt()
    }

    /// Returns true if a place in plan lies in the block itself.
    pub(super) fn holds(&self, p: [f64; 2]) -> bool {
        p.iter().all(|v| (0.0..BLOCK).contains(v))
    }

    /// A place of the block in local metres.
    pub(super) fn local(&self, p: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| p[i] + self.corner[i])
    }

    /// The part of a convex polygon in plan within the block.
    pub(super) fn clipped(&self, polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut polygon = polygon.to_vec();
        for axis in 0..2 {
            polygon = clip(&polygon, |p| -p[axis]);
            polygon = clip(&polygon, |p| p[axis] - BLOCK);
        }
        polygon
    }

    /// The piece of a line in plan within the block, as ranges from 0 to 1 between two points; `None` outside.
    pub(super) fn piece(&self, [a, b]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
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
}
