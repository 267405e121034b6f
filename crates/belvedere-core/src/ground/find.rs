//! Ground detection for points without classes: the simple morphological filter.

use super::morphology::opened;
use super::{Ground, MapGrid, WITHHELD};
use belvedere_data::Bounds;
use belvedere_data::cast::{to_f32, to_index, to_row};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::vector::compare_places;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use rayon::prelude::*;

/// Classes that are never ground: noise, low and high.
const NOISE: [u8; 2] = [7, 18];
/// Depth below its surroundings at which a cell counts as an error, metres (Pingel et al.: a slope of 500 % from cell
/// to cell).
const PIT: f32 = 5.0;

/// Points between two looks at whether to go on.
const CHUNK: usize = 65_536;

/// Parameters of ground detection among all points.
///
/// # Source
/// Pingel, Clarke & McBride 2013, "An improved simple morphological filter for the terrain classification of airborne
/// LIDAR data": SMRF. Here windows are squares, grow faster beyond 18 cells, and gaps are triangulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FinderParams {
    /// Side of the cells whose lowest points are looked at, metres, above 0. Default 1, as in the source.
    pub cell: f64,
    /// Steepest slope of the ground, metres a metre, above 0. Default 0.15, as in the source.
    pub slope: f64,
    /// Half the width of the widest building, metres, above 0. Default 40: halls and blocks of 80 m (the source has
    /// 18).
    pub window: f64,
    /// Maximum distance of a ground point from the surface found, metres, 0 or more, on level ground. Default 0.3: the
    /// source's 0.5 takes cars' bonnets and low hedges for ground.
    pub tolerance: f64,
    /// Increase of the tolerance with the slope, metres for a slope of 1, 0 or more. Default 1.25, as in the source.
    pub slope_tolerance: f64,
}

impl Default for FinderParams {
    fn default() -> Self {
        Self { cell: 1.0, slope: 0.15, window: 40.0, tolerance: 0.3, slope_tolerance: 1.25 }
    }
}

impl FinderParams {
    fn validate(&self) -> Result<()> {
        let above_zero = [("cell", self.cell), ("slope", self.slope), ("window", self.window)];
        for (name, value) in above_zero {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::invalid(Parameter::GroundDetection, format!("{name} of {value}"), "above zero"));
            }
        }
        if self.window / self.cell > 10_000.0 {
            let value = format!("a window of {} m at cells of {} m", self.window, self.cell);
            return Err(Error::invalid(Parameter::GroundDetection, value, "at most 10 000 cells"));
        }
        for (name, value) in [("tolerance", self.tolerance), ("slope tolerance", self.slope_tolerance)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(Error::invalid(Parameter::GroundDetection, format!("{name} of {value}"), "zero or more"));
            }
        }
        Ok(())
    }
}

/// Rows of the points of `cloud` that are ground, in rising order: those near the surface through the cells that no
/// window takes for something standing on it. Noise and withheld points are none.
///
/// # Errors
/// [`Error::InvalidParameter`] for a parameter outside its range or a cloud too wide for its cells, [`Error::NoPoints`]
/// where no point is left to be ground, [`Error::Cancelled`].
pub fn find_ground(cloud: &PointCloud, params: &FinderParams, control: &Control<'_>) -> Result<Vec<u32>> {
    params.validate()?;
    let classes = cloud.attributes.classification.as_deref();
    let flags = cloud.attributes.flags.as_deref();
    let usable = |row: usize| {
        classes.and_then(|classes| classes.get(row)).is_none_or(|class| !NOISE.contains(class))
            && flags.and_then(|flags| flags.get(row)).is_none_or(|flags| flags & WITHHELD == 0)
    };
    let mut rows: Vec<usize> = (0..cloud.len()).filter(|&row| usable(row)).collect();
    // the first of several points that are equally low is taken
    rows.par_sort_unstable_by(|&a, &b| compare_places(&cloud.positions[a], &cloud.positions[b]).then(a.cmp(&b)));
    let positions: Vec<[f32; 3]> = rows.iter().filter_map(|&row| cloud.positions.get(row).copied()).collect();
    let Some(Bounds { low, high }) = Bounds::around(positions.iter().copied()) else {
        return Err(Error::NoPoints { what: "all points are noise or withheld, so there is no ground".to_owned() });
    };
    let on_map = |p: [f32; 3]| [f64::from(p[0]), f64::from(p[1])];
    let grid = MapGrid::covering(on_map(low), on_map(high), params.cell, [0.0; 2])?;
    let lowest = lowest_points(&positions, &grid);
    let standing = standing_cells(&positions, &lowest, &grid, params, control)?;
    let bare: Vec<[f32; 3]> = lowest
        .values()
        .iter()
        .zip(&standing)
        .filter(|(point, standing)| **point != NO_POINT && !**standing)
        .filter_map(|(&point, _)| positions.get(point as usize).copied())
        .collect();
    let surface = Ground::of_points(&bare, grid, f64::INFINITY, control)?;
    let near = |&(_, position): &(&usize, &[f32; 3])| {
        let place = on_map(*position);
        let Some(height) = surface.height_at(place) else { return false };
        let allowed = params.tolerance + params.slope_tolerance * slope_at(&surface, place);
        (f64::from(position[2]) - height).abs() <= allowed
    };
    let mut found: Vec<u32> = Vec::new();
    for (rows, positions) in rows.chunks(CHUNK).zip(positions.chunks(CHUNK)) {
        control.check()?;
        found.extend(rows.iter().zip(positions).filter(near).map(|(&row, _)| to_row(row)));
    }
    if found.is_empty() {
        return Err(Error::NoPoints { what: "no ground was detected; classify it first".to_owned() });
    }
    found.par_sort_unstable();
    Ok(found)
}

const NO_POINT: u32 = u32::MAX;

/// The lowest point of each cell, the first of equals; [`NO_POINT`] in empty cells.
fn lowest_points(positions: &[[f32; 3]], grid: &MapGrid) -> Raster<u32> {
    let mut lowest = Raster::filled(grid.width, grid.height, NO_POINT);
    let width = grid.width;
    let values = lowest.values_mut();
    for (point, position) in (0_u32..).zip(positions) {
        let Some([column, row]) = grid.cell_of([f64::from(position[0]), f64::from(position[1])]) else { continue };
        let value = &mut values[row * width + column];
        let held = positions.get(*value as usize).map_or(f32::INFINITY, |p| p[2]);
        if position[2] < held {
            *value = point;
        }
    }
    lowest
}

/// Flags the cells of objects above the ground, and of pits below any ground.
fn standing_cells(
    positions: &[[f32; 3]],
    lowest: &Raster<u32>,
    grid: &MapGrid,
    params: &FinderParams,
    control: &Control<'_>,
) -> Result<Vec<bool>> {
    let mut heights = lowest
        .clone()
        .values()
        .iter()
        .map(|&point| positions.get(point as usize).map_or(f32::NAN, |p| p[2]))
        .collect::<Vec<f32>>();
    let mut standing = vec![false; heights.len()];
    fill_gaps(&mut heights, grid.width);
    // upside down, what is narrow and high is a pit
    let inverted = Raster::from_values(grid.width, grid.height, heights.iter().map(|h| -h).collect());
    if let Ok(inverted) = inverted {
        let level = opened(&inverted, 1);
        for ((height, level), standing) in heights.iter_mut().zip(level.values()).zip(&mut standing) {
            if -*height - level > PIT {
                *height = -level;
                *standing = true;
            }
        }
    }
    let Ok(mut surface) = Raster::from_values(grid.width, grid.height, heights) else { return Ok(standing) };
    for radius in windows(params) {
        control.check()?;
        let lower = opened(&surface, radius);
        let threshold = to_f32(params.slope * radius as f64 * params.cell);
        for ((standing, &before), &after) in standing.iter_mut().zip(surface.values()).zip(lower.values()) {
            *standing |= before - after > threshold;
        }
        surface = lower;
    }
    Ok(standing)
}

/// Radii in cells: each up to 18, as in the source, then a fifth more each.
fn windows(params: &FinderParams) -> Vec<usize> {
    let last = to_index((params.window / params.cell).ceil());
    let mut radii = vec![];
    let mut radius = 1;
    while radius < last {
        radii.push(radius);
        radius = if radius < 18 { radius + 1 } else { radius + radius / 5 };
    }
    radii.push(last);
    radii
}

/// Gives empty cells (NaN) the height of the nearest filled one, by sweeps from row to row and back.
fn fill_gaps(heights: &mut [f32], width: usize) {
    let height = heights.len().checked_div(width).unwrap_or(0);
    // offset to the filled cell that each cell takes its height from
    let far = [i32::MAX / 4; 2];
    let mut offsets: Vec<[i32; 2]> = heights.iter().map(|h| if h.is_nan() { far } else { [0, 0] }).collect();
    let square = |o: [i32; 2]| i64::from(o[0]).pow(2) + i64::from(o[1]).pow(2);
    let mut take = |at: usize, from: Option<usize>, step: [i32; 2]| {
        if let Some(&offset) = from.and_then(|from| offsets.get(from)) {
            let offset = [offset[0] + step[0], offset[1] + step[1]];
            if square(offset) < square(offsets[at]) {
                offsets[at] = offset;
            }
        }
    };
    for row in 0..height {
        for column in 0..width {
            let at = row * width + column;
            take(at, (row > 0).then(|| at - width), [0, -1]);
            take(at, (column > 0).then(|| at - 1), [-1, 0]);
        }
        for column in (0..width).rev() {
            let at = row * width + column;
            take(at, (column + 1 < width).then_some(at + 1), [1, 0]);
        }
    }
    for row in (0..height).rev() {
        for column in (0..width).rev() {
            let at = row * width + column;
            take(at, (row + 1 < height).then_some(at + width), [0, 1]);
            take(at, (column + 1 < width).then_some(at + 1), [1, 0]);
        }
        for column in 0..width {
            let at = row * width + column;
            take(at, (column > 0).then(|| at - 1), [-1, 0]);
        }
    }
    for at in 0..heights.len() {
        let [x, y] = offsets[at];
        let from = at as i64 + i64::from(x) + i64::from(y) * width as i64;
        if let Some(&value) = usize::try_from(from).ok().and_then(|from| heights.get(from)) {
            heights[at] = value;
        }
    }
}

/// Slope of a surface at a place on the map, metres a metre; 0 where it is not known.
fn slope_at(surface: &Ground, [x, y]: [f64; 2]) -> f64 {
    let step = surface.grid.cell;
    let rise = |dx: f64, dy: f64| {
        let (a, b) = (surface.height_at([x - dx, y - dy]), surface.height_at([x + dx, y + dy]));
        a.zip(b).map_or(0.0, |(a, b)| (b - a) / (2.0 * step))
    };
    rise(step, 0.0).hypot(rise(0.0, step))
}
