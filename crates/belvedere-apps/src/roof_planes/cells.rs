//! The cells of a plane: where it is, and where panels would lie.

use super::fit::{PlaneFit, axes};
use belvedere_data::cast::to_index;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{dot, sub};

/// Cells along one side beyond which a plane is none of a building.
const MAX_CELLS: f64 = 20_000.0;
/// Shares of a side by which cells are shifted to measure an area.
const SHIFTS: [f64; 4] = [0.125, 0.375, 0.625, 0.875];
/// Mean number of points of a cell of the extent of a plane. Cells that the outline crosses then extend over it by as
/// much as they lack ([`area`] has the formula), and few cells inside are empty by chance.
const POINTS_OF_CELL: f64 = 2.0;
/// Minimum side of a cell of an extent, metres: outlines of denser clouds need not be finer.
const MIN_EXTENT_CELL: f64 = 0.2;
/// Holes of an extent up to this area belong to it, m²: chimneys, windows and dormers. Pieces beside it of this area do
/// not.
const MAX_HOLE: f64 = 2.0;

/// Square cells in a plane, rows along its contour lines from its lower edge up.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneCells {
    /// Side of a cell, metres.
    pub cell: f64,
    /// Lower corner of the first cell, local metres.
    pub corner: [f64; 3],
    /// Unit vector along the rows.
    pub along: [f64; 3],
    /// Unit vector from row to row, up the slope.
    pub up: [f64; 3],
    /// The cells; row 0 lowest. Of panels those on which one can lie: their middle is among points of the plane, and
    /// nothing stands on them.
    pub filled: Raster<bool>,
}

impl PlaneCells {
    /// Creates the cells of a plane that hold some of `rows` among `points`, from its lowest and outermost points on.
    /// `is_usable` accepts or rejects a cell, given its middle.
    pub(super) fn of(
        points: &[[f32; 3]],
        rows: &[u32],
        plane: &PlaneFit,
        cell: f64,
        is_usable: impl Fn(&Self, [f64; 3]) -> bool,
    ) -> Self {
        let [along, up] = axes(plane.normal);
        let (filled, [u, v], cell) = filled(&in_plane(points, rows, plane), cell, 0.0);
        let corner = [0, 1, 2].map(|i| plane.middle[i] + u * along[i] + v * up[i]);
        let mut cells = Self { cell, corner, along, up, filled };
        let width = cells.filled.width();
        let keep: Vec<bool> = (0..cells.filled.values().len())
            .map(|i| cells.filled.values()[i] && is_usable(&cells, cells.middle(i % width, i / width)))
            .collect();
        cells.filled.values_mut().copy_from_slice(&keep);
        cells
    }

    /// The plane of `area` m² that `rows` among `points` were drawn from, without holes that are small.
    pub(super) fn extent(points: &[[f32; 3]], rows: &[u32], plane: &PlaneFit, area: f64) -> Self {
        let cell = (POINTS_OF_CELL * area / (rows.len().max(1) as f64)).sqrt().max(MIN_EXTENT_CELL);
        let mut cells = Self::of(points, rows, plane, cell, |_, _| true);
        smooth(&mut cells.filled, MAX_HOLE / (cells.cell * cells.cell));
        cells
    }

    /// Returns the number of cells.
    #[must_use]
    pub fn count(&self) -> usize {
        self.filled.values().iter().filter(|filled| **filled).count()
    }

    fn middle(&self, column: usize, row: usize) -> [f64; 3] {
        self.place([column as f64 + 0.5, row as f64 + 0.5])
    }

    /// Middles of the filled cells, local metres, row by row, and the row of each.
    #[must_use]
    pub fn middles(&self) -> Vec<([f64; 3], usize)> {
        let width = self.filled.width();
        let filled = self.filled.values().iter().enumerate().filter(|(_, filled)| **filled);
        filled.map(|(i, _)| (self.middle(i % width, i / width), i / width)).collect()
    }

    /// Local metres of a place given in cells from the corner, along the rows and up.
    #[must_use]
    pub fn place(&self, [columns, rows]: [f64; 2]) -> [f64; 3] {
        let (u, v) = (columns * self.cell, rows * self.cell);
        [0, 1, 2].map(|i| self.corner[i] + u * self.along[i] + v * self.up[i])
    }
}

/// Area of the plane that `rows` among `points` were drawn from, m², by cells of about the given side.
///
/// Of a cell that the outline crosses, a share f lies within; f is uniform between 0 and 1 for any direction of the
/// outline. The cell holds a point with a chance of 1 - exp(-n f), n being the points of a whole cell. On average
/// such cells reach k = 1/2 - (1 - exp(-n))/n of their side over the outline, which Steiner's formula subtracts. Cells
/// are laid several times, since outlines may run along them.
pub(super) fn area(points: &[[f32; 3]], rows: &[u32], plane: &PlaneFit, cell: f64) -> f64 {
    let flat = in_plane(points, rows, plane);
    let of_shift = |shift: &f64| {
        let (cells, _, cell) = filled(&flat, cell, *shift);
        cells_covered(&cells, rows.len()) * cell * cell
    };
    SHIFTS.iter().map(of_shift).sum::<f64>() / SHIFTS.len() as f64
}

/// Points in the axes of their plane, from its middle.
fn in_plane(points: &[[f32; 3]], rows: &[u32], plane: &PlaneFit) -> Vec<[f64; 2]> {
    let [along, up] = axes(plane.normal);
    let place = |&row: &u32| {
        let offset = sub(points[row as usize].map(f64::from), plane.middle);
        [dot(offset, along), dot(offset, up)]
    };
    rows.iter().map(place).collect()
}

/// Cells that hold points, the first of them `shift` of a side below and left of the outermost; their lower corner, and
/// their side.
fn filled(flat: &[[f64; 2]], cell: f64, shift: f64) -> (Raster<bool>, [f64; 2], f64) {
    let min = |axis: usize| flat.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
    let max = |axis: usize| flat.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
    let span = [0, 1].map(|axis| max(axis) - min(axis));
    let cell = cell.max(span[0].max(span[1]) / MAX_CELLS);
    let low = [0, 1].map(|axis| min(axis) - shift * cell);
    let [width, height] = span.map(|span| to_index((span / cell + shift).floor()) + 1);
    let mut filled = Raster::filled(width, height, false);
    for [u, v] in flat {
        let (column, row) = (to_index((u - low[0]) / cell), to_index((v - low[1]) / cell));
        if let Some(value) = filled.values_mut().get_mut(row.min(height - 1) * width + column.min(width - 1)) {
            *value = true;
        }
    }
    (without_gaps(&filled), low, cell)
}

/// Inverts groups of at most `max_count` cells: empty ones that filled ones enclose, and filled ones that touch the
/// others at a corner only.
fn smooth(cells: &mut Raster<bool>, max_count: f64) {
    for value in [false, true] {
        for group in groups(cells, value) {
            let is_part = value || group.is_enclosed;
            if is_part && group.cells.len() as f64 <= max_count {
                group.cells.into_iter().for_each(|at| cells.values_mut()[at] = !value);
            }
        }
    }
}

/// Cells of one value that hang together by their sides.
struct CellGroup {
    cells: Vec<usize>,
    /// True if no cell is at the border.
    is_enclosed: bool,
}

fn groups(cells: &Raster<bool>, value: bool) -> Vec<CellGroup> {
    let (width, height) = (cells.width(), cells.height());
    let mut is_seen: Vec<bool> = cells.values().iter().map(|own| *own != value).collect();
    let mut found = Vec::new();
    for first in 0..is_seen.len() {
        let (mut group, mut next) = (CellGroup { cells: Vec::new(), is_enclosed: true }, vec![first]);
        while let Some(at) = next.pop() {
            if std::mem::replace(&mut is_seen[at], true) {
                continue;
            }
            group.cells.push(at);
            let (column, row) = (at % width, at / width);
            group.is_enclosed &= column > 0 && row > 0 && column + 1 < width && row + 1 < height;
            next.extend((column > 0).then(|| at - 1));
            next.extend((row > 0).then(|| at - width));
            next.extend((column + 1 < width).then_some(at + 1));
            next.extend((row + 1 < height).then_some(at + width));
        }
        found.extend((!group.cells.is_empty()).then_some(group));
    }
    found
}

/// Estimates the number of cells from which the `point_count` points that fill these were drawn.
fn cells_covered(cells: &Raster<bool>, point_count: usize) -> f64 {
    let is_filled = |column: usize, row: usize| cells.get(column, row).unwrap_or(false);
    let (mut count, mut sides, mut corners) = (0.0, 0.0, 0.0);
    for row in 0..=cells.height() {
        for column in 0..=cells.width() {
            let here = is_filled(column, row);
            let left = column > 0 && is_filled(column - 1, row);
            let below = row > 0 && is_filled(column, row - 1);
            let across = column > 0 && row > 0 && is_filled(column - 1, row - 1);
            count += f64::from(u8::from(here));
            sides += f64::from(u8::from(here != left)) + f64::from(u8::from(here != below));
            // turns of the outline: four make an outer outline, and four the other way a hole
            corners += match u8::from(here) + u8::from(left) + u8::from(below) + u8::from(across) {
                1 => 0.25,
                3 => -0.25,
                _ => 0.0,
            };
        }
    }
    let of_cell = point_count as f64 / f64::max(count, 1.0);
    let over = if of_cell > 0.0 { 0.5 - (1.0 - (-of_cell).exp()) / of_cell } else { 0.0 };
    let area: f64 = count - over * sides + 4.0 * over * over * corners;
    area.max(0.25 * count)
}

/// Cells with the gaps filled that chance leaves between sparse points: empty ones with at least three of four
/// neighbours filled.
fn without_gaps(cells: &Raster<bool>) -> Raster<bool> {
    let mut filled = cells.clone();
    let width = cells.width();
    for (i, value) in filled.values_mut().iter_mut().enumerate() {
        let (column, row) = (i % width, i / width);
        let at = |column: Option<usize>, row: Option<usize>| {
            u8::from(column.zip(row).and_then(|(column, row)| cells.get(column, row)).unwrap_or(false))
        };
        let beside = at(column.checked_sub(1), Some(row))
            + at(Some(column + 1), Some(row))
            + at(Some(column), row.checked_sub(1))
            + at(Some(column), Some(row + 1));
        *value |= beside >= 3;
    }
    filled
}
