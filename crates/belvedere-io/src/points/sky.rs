//! Pulses that returned nothing: the empty cells of structured scans that see the sky.
//!
//! A structured scan is a grid of pulses, row by column. Its empty cells say which pulses met nothing, but not where
//! they went: that follows from the angles of the cells beside them. Glass, water and dark paint return nothing either.
//! So only cells above the horizon count that hang together up to the top of the grid.

use crate::points::read_options::UpAxis;
use belvedere_data::cast::to_index;
use belvedere_data::sky_region::SkyRegion;
use belvedere_data::vector::to_f32;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Maximum number of columns around, and of rows up to the zenith and down, before cells are put together in blocks:
/// blocks of 0.2° of a full turn. Pulses that are nearer to each other prove no more.
const BLOCKS: [usize; 2] = [900, 1800];
/// Blocks of a grid at most. More columns than that go around more than once, or the sizes mean something else.
const MAX_BLOCKS: usize = 4 * BLOCKS[0] * BLOCKS[1];
/// Returns from which angles are found, and the fewest that are enough.
const SAMPLE: u64 = 500_000;
const MIN_SAMPLE: usize = 100;
/// Maximum deviation of the directions of 95 % of the returns from the regular grid, radians: 0.1°, 0.17 m in 100 m, a
/// quarter of the radius that a pulse proves around itself.
const TOLERANCE: f64 = 0.1 * DEGREE;
const TOLERATED_SHARE: f64 = 0.95;
/// Margin about cells with a return, radians; at least a row. Beams and angles that are a little off graze no edge.
const MARGIN: f64 = 0.1 * DEGREE;
/// Minimum elevation of the top of a grid for its empty cells to be the sky, radians: below, a window may reach it.
const MIN_TOP: f64 = 45.0 * DEGREE;
/// Smallest piece of the sky that counts, steradians: 36° across. The lamp and the skylight of a room are smaller.
const MIN_SOLID_ANGLE: f64 = 0.3;
/// Share of the returns that come from farther away than pulses prove their way empty. An object that returns that many
/// pulses is no single reflector.
const FARTHER_SHARE: f64 = 0.001;
/// Maximum turn of the columns, radians: once around, and the part that scanners measure twice.
const MAX_TURN: f64 = 1.05 * TAU;
/// Above this elevation a direction does not tell its column, radians.
const NEAR_ZENITH: f64 = 80.0 * DEGREE;
const DEGREE: f64 = TAU / 360.0;

/// The cells of one scan as they are read.
#[derive(Debug)]
pub(crate) struct ScanGrid {
    /// Rows and columns that the file announces, and those that have been seen in use.
    size: [u64; 2],
    seen: [u64; 2],
    /// Cells of a block, and blocks: down and across.
    block: [u64; 2],
    blocks: [usize; 2],
    has_return: Vec<bool>,
    return_count: u64,
    sample: Vec<SampledReturn>,
}

/// A return from which angles are found.
#[derive(Clone, Copy, Debug)]
struct SampledReturn {
    cell: [f64; 2],
    azimuth: f64,
    elevation: f64,
    range: f64,
}

/// Angles of the cells of a scan: a start and a step.
#[derive(Clone, Copy, Debug)]
struct GridAngles {
    azimuth: [f64; 2],
    elevation: [f64; 2],
}

impl ScanGrid {
    /// A grid of rows and columns; `None` for sizes that no grid of angles has.
    pub(crate) fn new(size: [u64; 2]) -> Option<Self> {
        let block = [0, 1].map(|i| (size[i] / BLOCKS[i] as u64).max(1));
        let blocks = [0, 1].map(|i| usize::try_from(size[i] / block[i]).unwrap_or(usize::MAX));
        let count = blocks[0].checked_mul(blocks[1]).filter(|count| (1..=MAX_BLOCKS).contains(count))?;
        let (has_return, sample) = (vec![false; count], Vec::new());
        Some(Self { size, seen: [0; 2], block, blocks, has_return, return_count: 0, sample })
    }

    /// A cell of the file, with or without a return.
    pub(crate) fn add_cell(&mut self, cell: [u64; 2]) {
        self.seen = [0, 1].map(|i| self.seen[i].max(cell[i].saturating_add(1)).min(self.size[i]));
    }

    /// All cells that were announced were measured.
    pub(crate) fn add_all_cells(&mut self) {
        self.seen = self.size;
    }

    /// A return at `position`, seen from the scanner along the axes of the scan, in the unit of the file.
    pub(crate) fn add_return(&mut self, cell: [u64; 2], position: [f64; 3]) {
        self.return_count += 1;
        let block = [0, 1].map(|i| usize::try_from(cell[i] / self.block[i]).unwrap_or(usize::MAX));
        if block[0] < self.blocks[0]
            && block[1] < self.blocks[1]
            && let Some(has_return) = self.has_return.get_mut(block[0] * self.blocks[1] + block[1])
        {
            *has_return = true;
        }
        // spread over rows and columns, and the same whatever the order
        let spread =
            (cell[0].wrapping_mul(self.size[1]).wrapping_add(cell[1])).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        let each = (self.size[0].saturating_mul(self.size[1]) / SAMPLE).max(1);
        let [x, y, z] = position;
        let level = x.hypot(y);
        let range = level.hypot(z);
        if spread.is_multiple_of(each) && range > 0.0 && range.is_finite() {
            let cell = cell.map(|index| index as f64);
            self.sample.push(SampledReturn { cell, azimuth: y.atan2(x), elevation: z.atan2(level), range });
        }
    }

    fn empty_count(&self) -> u64 {
        self.seen[0].saturating_mul(self.seen[1]).saturating_sub(self.return_count)
    }

    /// The cells that see the sky, blocks of them as cells of the region; `None` where these are none.
    fn region(&self, angles: &GridAngles, scanner: u16, axes: [[f64; 3]; 3], up: UpAxis) -> Option<SkyRegion> {
        let [rows, columns] = [0, 1].map(|i| usize::try_from(self.seen[i] / self.block[i]).unwrap_or(0));
        // of a few cells in the corner of a large grid no block is whole
        if rows == 0 || columns == 0 {
            return None;
        }
        let of_blocks = |angle: [f64; 2], block: u64| {
            let block = block as f64;
            [angle[0] + angle[1] * (block - 1.0) / 2.0, angle[1] * block]
        };
        let mut region = SkyRegion {
            scanner,
            range: self.far_range()?,
            axes,
            azimuth: of_blocks(angles.azimuth, self.block[1]),
            elevation: of_blocks(angles.elevation, self.block[0]),
            columns,
            is_open: Vec::new(),
        };
        let vertical = if up == UpAxis::Y { 1 } else { 2 };
        // water, dark cars and wet ground lie below the horizon of a tripod
        let is_high = |cell| region.direction(cell)[vertical] > 0.0;
        let has_return = |row: usize, column: usize| self.has_return.get(row * self.blocks[1] + column) != Some(&false);
        let closed: Vec<bool> =
            (0..rows).flat_map(|row| (0..columns).map(move |column| has_return(row, column))).collect();
        let mut free: Vec<bool> = widened(&closed, &region, rows).into_iter().map(|is_closed| !is_closed).collect();
        for (cell, is_free) in free.iter_mut().enumerate() {
            let [row, column] = [cell / columns, cell % columns];
            *is_free &= region.elevation_of(row).abs() < FRAC_PI_2 && is_high([row, column]);
        }
        region.is_open = reaching_the_top(&free, &region, rows);
        let is_used = |row: &usize| region.is_open[row * columns..(row + 1) * columns].contains(&true);
        let (first, last) = ((0..rows).find(is_used)?, (0..rows).rfind(is_used)?);
        region.is_open = region.is_open[first * columns..(last + 1) * columns].to_vec();
        region.elevation[0] = region.elevation_of(first);
        Some(region)
    }

    /// Returns the maximum range at which the scanner still received returns, in the unit of the file.
    fn far_range(&self) -> Option<f32> {
        let mut ranges: Vec<f64> = self.sample.iter().map(|found| found.range).collect();
        let place = at_share(1.0 - FARTHER_SHARE, ranges.len())?;
        Some(to_f32(*ranges.select_nth_unstable_by(place, f64::total_cmp).1))
    }
}

/// Place of a share in a sorted list; `None` in one without entries.
fn at_share(share: f64, count: usize) -> Option<usize> {
    count.checked_sub(1).map(|last| to_index(share * count as f64).min(last))
}

/// Returns true if the columns of a grid go all around, so that the last stands beside the first.
fn goes_around(region: &SkyRegion) -> bool {
    let turn = region.azimuth[1].abs() * region.columns as f64;
    (turn - TAU).abs() < 1.5 * region.azimuth[1].abs()
}

/// Returns the number of columns that are at least `angle` wide in a row.
fn columns_of(angle: f64, region: &SkyRegion, row: usize) -> usize {
    let width = region.azimuth[1].abs() * region.elevation_of(row).cos().max(0.0);
    to_index((angle / width - 1e-6).ceil()).clamp(1, region.columns)
}

/// The closed cells of a grid, and those within the margin of one.
fn widened(closed: &[bool], region: &SkyRegion, rows: usize) -> Vec<bool> {
    let (columns, height) = (region.columns, region.elevation[1].abs());
    let margin = MARGIN.max(height);
    let mut across = vec![false; closed.len()];
    for row in 0..rows {
        let reach = columns_of(margin, region, row);
        let own = &closed[row * columns..(row + 1) * columns];
        for column in (0..columns).filter(|&column| own[column]) {
            for step in 0..=2 * reach {
                let at = (column + step).checked_sub(reach).filter(|&at| at < columns);
                let around = (column + step + columns - reach) % columns;
                if let Some(at) = at.or(goes_around(region).then_some(around)) {
                    across[row * columns + at] = true;
                }
            }
        }
    }
    let reach = to_index((margin / height - 1e-6).ceil()).clamp(1, rows);
    let mut all = vec![false; closed.len()];
    for row in 0..rows {
        for near in row.saturating_sub(reach)..(row + reach + 1).min(rows) {
            for column in 0..columns {
                all[row * columns + column] |= across[near * columns + column];
            }
        }
    }
    all
}

/// The free cells that hang together with the top row, and are many enough to be the sky.
fn reaching_the_top(free: &[bool], region: &SkyRegion, rows: usize) -> Vec<bool> {
    let columns = region.columns;
    let mut open = vec![false; free.len()];
    let top = if region.elevation[1] > 0.0 { rows.saturating_sub(1) } else { 0 };
    if rows == 0 || region.elevation_of(top) < MIN_TOP {
        return open;
    }
    let is_around = goes_around(region);
    let mut is_visited = vec![false; free.len()];
    for seed in top * columns..(top + 1) * columns {
        if !free[seed] || is_visited[seed] {
            continue;
        }
        is_visited[seed] = true;
        let (mut piece, mut next) = (vec![seed], 0);
        while let Some(&cell) = piece.get(next) {
            next += 1;
            let (row, column) = (cell / columns, cell % columns);
            let beside = |at: usize| row * columns + at;
            let east = if column + 1 < columns { Some(beside(column + 1)) } else { is_around.then(|| beside(0)) };
            let west = if column > 0 { Some(beside(column - 1)) } else { is_around.then(|| beside(columns - 1)) };
            let (below, above) = (cell.checked_sub(columns), (row + 1 < rows).then_some(cell + columns));
            for near in [east, west, below, above].into_iter().flatten().filter(|&near| free[near]) {
                if !std::mem::replace(&mut is_visited[near], true) {
                    piece.push(near);
                }
            }
        }
        let size = |cell: &usize| region.elevation_of(cell / columns).cos();
        let solid_angle = region.azimuth[1].abs() * region.elevation[1].abs() * piece.iter().map(size).sum::<f64>();
        if solid_angle >= MIN_SOLID_ANGLE {
            piece.into_iter().for_each(|cell| open[cell] = true);
        }
    }
    open
}

impl GridAngles {
    /// Fits the angles of the grid to the returns. `None` if these do not lie on a regular grid, or go around more than
    /// once: neighbours in the grid would not be all neighbours in the sky.
    fn of(sample: &[SampledReturn], columns: u64) -> Option<Self> {
        if sample.len() < MIN_SAMPLE {
            return None;
        }
        let elevation = line_through(sample.iter().map(|found| [found.cell[0], found.elevation]))?;
        let azimuth = azimuths(sample)?;
        let angles = Self { azimuth, elevation };
        let mut errors: Vec<f64> = sample.iter().map(|found| angles.error(found)).collect();
        let place = at_share(TOLERATED_SHARE, errors.len())?;
        let error = *errors.select_nth_unstable_by(place, f64::total_cmp).1;
        let has_steps = azimuth[1] != 0.0 && elevation[1] != 0.0;
        let is_once = azimuth[1].abs() * columns as f64 <= MAX_TURN;
        (has_steps && is_once && error <= TOLERANCE).then_some(angles)
    }

    /// Angle between a return and the middle of its cell.
    fn error(&self, found: &SampledReturn) -> f64 {
        let at = |[start, step]: [f64; 2], number: f64| start + step * number;
        let off = found.elevation - at(self.elevation, found.cell[0]);
        let across = wrapped(found.azimuth - at(self.azimuth, found.cell[1])) * found.elevation.cos();
        off.hypot(across)
    }
}

/// Start and step of the azimuths of columns.
fn azimuths(sample: &[SampledReturn]) -> Option<[f64; 2]> {
    let mut low: Vec<&SampledReturn> = sample.iter().filter(|found| found.elevation.abs() < NEAR_ZENITH).collect();
    low.sort_by(|a, b| a.cell[1].total_cmp(&b.cell[1]));
    let of_column = |returns: &[&SampledReturn]| {
        let sum = |part: fn(f64) -> f64| returns.iter().map(|found| part(found.azimuth)).sum::<f64>();
        Some([returns.first()?.cell[1], sum(f64::sin).atan2(sum(f64::cos))])
    };
    let columns: Vec<[f64; 2]> = low.chunk_by(|a, b| a.cell[1] == b.cell[1]).filter_map(of_column).collect();
    // from column to column, then once around
    let mut steps: Vec<f64> =
        columns.windows(2).map(|pair| wrapped(pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).collect();
    let place = at_share(0.5, steps.len())?;
    let step = *steps.select_nth_unstable_by(place, f64::total_cmp).1;
    let rest = |[column, azimuth]: [f64; 2]| azimuth - step * column;
    let sum = |part: fn(f64) -> f64| columns.iter().map(|&found| part(rest(found))).sum::<f64>();
    let start = sum(f64::sin).atan2(sum(f64::cos));
    let [more_start, more_step] = line_through(columns.iter().map(|&found| [found[0], wrapped(rest(found) - start)]))?;
    Some([start + more_start, step + more_step])
}

/// Start and slope of the line through points by least squares; `None` where they do not tell.
fn line_through(points: impl Iterator<Item = [f64; 2]> + Clone) -> Option<[f64; 2]> {
    let count = points.clone().count() as f64;
    let middle = [0, 1].map(|i| points.clone().map(|point| point[i]).sum::<f64>() / count);
    let moment = |i: usize| points.clone().map(|point| (point[0] - middle[0]) * (point[i] - middle[i])).sum::<f64>();
    let (spread, shared) = (moment(0), moment(1));
    let slope = shared / spread;
    (spread > 0.0 && slope.is_finite()).then(|| [middle[1] - slope * middle[0], slope])
}

/// An angle between −π and π.
fn wrapped(angle: f64) -> f64 {
    (angle + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0
}

/// Sky seen by the scans of a file.
#[derive(Debug, Default)]
pub(crate) struct Skies {
    regions: Vec<SkyRegion>,
    /// Cells without a return, and those of them that see the sky.
    empty_count: u64,
    open_count: u64,
    /// Scans whose cells do not lie on a regular grid of angles.
    irregular_count: usize,
}

impl Skies {
    /// Adds the scan of a scanner with the axes of a scan in coordinates of the file.
    pub(crate) fn add(&mut self, grid: &ScanGrid, scanner: u16, axes: [[f64; 3]; 3], up: UpAxis) {
        if grid.empty_count() == 0 || grid.sample.is_empty() {
            return;
        }
        let Some(angles) = GridAngles::of(&grid.sample, grid.seen[1]) else {
            self.irregular_count += 1;
            return;
        };
        self.empty_count += grid.empty_count();
        if let Some(region) = grid.region(&angles, scanner, axes, up) {
            self.open_count += region.open_cells().count() as u64 * grid.block[0] * grid.block[1];
            self.regions.push(region);
        }
    }

    /// Turns scans whose y is up: (x, y, z) becomes (x, −z, y).
    pub(crate) fn turn_y_up(&mut self) {
        for axes in self.regions.iter_mut().flat_map(|region| &mut region.axes) {
            *axes = [axes[0], -axes[2], axes[1]];
        }
    }

    /// Returns the regions, in metres and with the scanners' numbers in the cloud, by `numbers`; and notes in words.
    pub(crate) fn placed(self, numbers: &[u16], units: [f64; 3]) -> (Vec<SkyRegion>, Vec<String>) {
        let mut notes = Vec::new();
        if self.irregular_count > 0 {
            notes.push(format!(
                "the cells of {} scan{} do not lie on a regular grid of angles, so that pulses without a return prove nothing",
                self.irregular_count,
                if self.irregular_count == 1 { "" } else { "s" }
            ));
        }
        let number = |region: &SkyRegion| numbers.get(usize::from(region.scanner)).copied().unwrap_or(u16::MAX);
        let mut regions = self.regions;
        // directions would be others in heights of another unit
        regions.retain(|region| number(region) != u16::MAX && units[0] == units[2]);
        for region in &mut regions {
            region.scanner = number(region);
            let range = to_f32(f64::from(region.range) * units[0]);
            region.range = range;
        }
        let ranges = || regions.iter().map(|region| region.range);
        let (nearest, farthest) = (ranges().fold(f32::INFINITY, f32::min), ranges().fold(0.0, f32::max));
        if !regions.is_empty() {
            let reach =
                if nearest < farthest { format!("{nearest:.1} to {farthest:.1}") } else { format!("{farthest:.1}") };
            notes.push(format!(
                "{} of {} grid cells without a return see the sky: their pulses prove space empty up to {reach} m from \
                 the scanner",
                self.open_count, self.empty_count
            ));
        }
        (regions, notes)
    }
}
