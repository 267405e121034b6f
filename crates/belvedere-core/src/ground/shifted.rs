//! Detects areas of class-2 points that are offset by 0.7 m or more from other points of class 2: at the same places,
//! or in the next strip.
//!
//! A step alone is no evidence: quays, terraces and pits have one. No terrain lies at two heights in the same places
//! over an area, or steps where one strip ends and the next begins. Areas are squares of a few cells, so that a wall,
//! which has two heights along a line, is none.

use super::believed::{Placed, placed};
use belvedere_data::control::Control;
use belvedere_data::{PointCloud, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Minimum offset of the ground, metres: more than kerbs, stairs and steep slopes do within a cell.
const MIN_SHIFT: f32 = 0.7;
/// Minimum gap between two levels of a cell, metres: beside noise and slopes.
const MIN_GAP: f32 = 0.5;
/// Maximum difference between the quartiles of a shift, as a share of it: a strip is off by the same everywhere.
const MAX_SPREAD: f32 = 0.4;
/// Minimum and maximum side of cells, metres.
const CELLS: [f32; 2] = [1.0, 8.0];
/// Ground points that a cell should have.
const POINTS_OF_CELL: usize = 4;
/// Cells along a side of a square.
const SQUARE: i32 = 6;
/// Cells of a square that must be able to say something.
const MIN_CELLS: usize = 8;
/// Squares that must say the same.
const MIN_SQUARES: usize = 2;
/// Minimum share of the cells of a square that have two levels: a wall across it crosses a third.
const MIN_TWO_LEVELS: f32 = 0.6;
/// Maximum mean horizontal offset between the upper and the lower level of the cells of a square, as a share of a cell.
/// On a slope the upper level lies uphill.
const MAX_LEAN: f32 = 0.25;
/// Search radius for the ground around squares with two levels, squares.
const AROUND: i32 = 2;
/// Places where two strips must meet.
const MIN_MEETINGS: usize = 15;
/// Ground points that contradict other points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroundShift {
    /// Points of class 2 that lie off.
    pub point_count: usize,
    /// Height of the points above the evidence, metres; negative if they lie below it.
    pub rise: f32,
    /// South-western corner of the box around them on the map, local metres.
    pub low: [f32; 2],
    /// Its north-eastern corner.
    pub high: [f32; 2],
    /// Evidence against the points.
    pub against: ShiftEvidence,
}

/// Evidence against ground points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ShiftEvidence {
    /// More points of class 2 at the same places.
    SecondLevel,
    /// Points of class 2 of another strip, where the two meet.
    Strips {
        /// Source of the points that lie off: of the two strips the one with fewer points.
        shifted: u16,
        /// Source of the others.
        other: u16,
    },
}

/// A cell with ground points.
#[derive(Clone, Copy, Debug)]
struct Cell {
    at: [i32; 2],
    /// First of its points in the order of cells and heights, and their number.
    first: usize,
    count: usize,
}

/// Some cells together.
#[derive(Clone, Debug, Default)]
struct Square {
    /// Lowest ground point of each cell.
    heights: Vec<f32>,
    /// Cells with points enough for two levels.
    measured: usize,
    /// Height difference of the two levels of each cell that has two, the points at either, and the sum of the
    /// horizontal offsets from the lower to the upper level, metres.
    steps: Vec<f32>,
    level_counts: [usize; 2],
    lean: [f32; 2],
}

impl Square {
    /// The height of most of its ground, local metres; `None` where it has too little.
    fn height(&self) -> Option<f32> {
        let [_, median, _] = quartiles(&self.heights).filter(|_| self.heights.len() >= POINTS_OF_CELL)?;
        Some(median)
    }
}

/// Squares by row and column.
type Squares = BTreeMap<[i32; 2], Square>;

/// Returns the ground `points` of a cloud, (N, 3) local metres, `rows` of it, that are offset over an area, with the
/// strongest evidence. `None` if nothing contradicts them.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn shift_of(
    cloud: &PointCloud,
    rows: &[u32],
    points: &[[f32; 3]],
    control: &Control<'_>,
) -> Result<Option<GroundShift>> {
    let (side, placed) = placed_in_cells(points);
    control.check()?;
    let cells = cells_of(&placed);
    let squares = squares_of(&cells, &placed, points);
    let strips = cloud.attributes.point_source_id.as_deref().unwrap_or_default();
    let strip = |point: &Placed| rows.get(point.number as usize).and_then(|&row| strips.get(row as usize).copied());
    let found = [two_levels(&squares, side), strips_apart(&cells, &placed, side, &strip)];
    Ok(found.into_iter().flatten().max_by_key(|shift| shift.point_count))
}

/// Cells that hold points enough on average, and the points in their order.
fn placed_in_cells(points: &[[f32; 3]]) -> (f32, Vec<Placed>) {
    let mut side = CELLS[0];
    loop {
        let placed = placed(points, side);
        let count = placed.chunk_by(is_in_one_cell).count();
        if side >= CELLS[1] || placed.len() >= POINTS_OF_CELL * count {
            return (side, placed);
        }
        side *= 2.0;
    }
}

fn is_in_one_cell(a: &Placed, b: &Placed) -> bool {
    (a.row, a.column) == (b.row, b.column)
}

fn cells_of(placed: &[Placed]) -> Vec<Cell> {
    let mut first = 0;
    let of = |points: &[Placed]| {
        let cell = Cell { at: [points[0].row, points[0].column], first, count: points.len() };
        first += points.len();
        cell
    };
    placed.chunk_by(is_in_one_cell).map(of).collect()
}

impl Cell {
    fn points<'a>(&self, placed: &'a [Placed]) -> &'a [Placed] {
        placed.get(self.first..self.first + self.count).unwrap_or_default()
    }
}

fn find(cells: &[Cell], at: [i32; 2]) -> Option<usize> {
    cells.binary_search_by_key(&at, |cell| cell.at).ok()
}

fn squares_of(cells: &[Cell], placed: &[Placed], points: &[[f32; 3]]) -> Squares {
    let mut squares = Squares::new();
    let middle = |level: &[Placed]| {
        let sum =
            |axis: usize| level.iter().filter_map(|own| Some(points.get(own.number as usize)?[axis])).sum::<f32>();
        [sum(0), sum(1)].map(|sum| sum / level.len() as f32)
    };
    for cell in cells {
        let square = squares.entry(cell.at.map(|v| v.div_euclid(SQUARE))).or_default();
        let heights: Vec<f32> = cell.points(placed).iter().map(|point| point.height).collect();
        let Some(ground) = heights.first() else { continue };
        square.heights.push(*ground);
        if heights.len() >= POINTS_OF_CELL {
            square.measured += 1;
            if let Some((step, lower)) = step_of(&heights) {
                square.steps.push(step);
                let (lower, upper) = cell.points(placed).split_at(lower);
                square.level_counts[0] += lower.len();
                square.level_counts[1] += upper.len();
                let (from, to) = (middle(lower), middle(upper));
                (0..2).for_each(|axis| square.lean[axis] += to[axis] - from[axis]);
            }
        }
    }
    squares
}

/// Returns the height difference of the two levels of ascending heights, and the number of points at the lower one.
/// `None` if there is one level: neither may be thicker than the gap between them, as the parts of a slope are.
fn step_of(heights: &[f32]) -> Option<(f32, usize)> {
    let gaps = heights.windows(2).map(|pair| pair[1] - pair[0]).enumerate();
    let (before, gap) = gaps.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let (lower, upper) = heights.split_at(before + 1);
    let thickness = |level: &[f32]| level.last().zip(level.first()).map_or(0.0, |(last, first)| last - first);
    let mean = |level: &[f32]| level.iter().sum::<f32>() / level.len() as f32;
    (gap >= MIN_GAP.max(thickness(lower)).max(thickness(upper))).then(|| (mean(upper) - mean(lower), lower.len()))
}

/// The quartiles of some values; `None` of none.
fn quartiles(values: &[f32]) -> Option<[f32; 3]> {
    let mut values = values.to_vec();
    values.sort_unstable_by(f32::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some([last / 4, last / 2, last - last / 4].map(|at| values[at]))
}

/// Returns the median of values that are nearly equal, and far from 0.
fn common(values: &[f32]) -> Option<f32> {
    let [low, median, high] = quartiles(values)?;
    (median.abs() >= MIN_SHIFT && high - low <= MAX_SPREAD * median.abs()).then_some(median)
}

/// Ground at two heights in the same places.
fn two_levels(squares: &Squares, side: f32) -> Option<GroundShift> {
    let mut found: BTreeMap<[i32; 2], f32> = BTreeMap::new();
    let mut level_counts = [0; 2];
    for (at, square) in squares {
        let count = square.steps.len() as f32;
        let is_measured = square.measured >= MIN_CELLS && count >= MIN_TWO_LEVELS * square.measured as f32;
        if !is_measured || square.lean[0].hypot(square.lean[1]) > MAX_LEAN * side * count {
            continue;
        }
        if let Some(step) = common(&square.steps) {
            found.insert(*at, step);
            (0..2).for_each(|level| level_counts[level] += square.level_counts[level]);
        }
    }
    let off = match level_around(squares, &found) {
        Some(level) if level < 1.0 / 3.0 => 1,
        Some(level) if level > 2.0 / 3.0 => 0,
        _ => usize::from(level_counts[1] < level_counts[0]),
    };
    let corners = found.keys().fold(None, |corners, at| Some(widened(corners, *at)));
    let [low, high] = on_map(corners.filter(|_| found.len() >= MIN_SQUARES)?, side * SQUARE as f32);
    let [_, step, _] = quartiles(&found.into_values().collect::<Vec<f32>>())?;
    let rise = if off == 1 { step } else { -step };
    Some(GroundShift { point_count: level_counts[off], rise, low, high, against: ShiftEvidence::SecondLevel })
}

/// Returns the mean level of the ground around squares with two levels, in units of their height difference: 0 for the
/// lower one and 1 for the upper one. `None` without such ground. A slope cancels out between opposite sides.
fn level_around(squares: &Squares, steps: &BTreeMap<[i32; 2], f32>) -> Option<f32> {
    let (mut sum, mut count) = (0.0, 0.0);
    for (at, step) in steps {
        let Some(lower) = squares.get(at).and_then(Square::height) else { continue };
        let ways = (-AROUND..=AROUND).flat_map(|down| (-AROUND..=AROUND).map(move |right| [down, right]));
        for way in ways {
            let beside = [0, 1].map(|axis| at[axis].saturating_add(way[axis]));
            // squares at the edge have both levels in some of their cells
            let square = squares.get(&beside).filter(|square| square.steps.len() * 10 <= square.measured);
            if let Some(height) = square.and_then(Square::height) {
                sum += (height - lower) / step;
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// The rows and columns of a box, widened by one more place.
fn widened(corners: Option<[[i32; 2]; 2]>, at: [i32; 2]) -> [[i32; 2]; 2] {
    let [low, high] = corners.unwrap_or([at; 2]);
    [std::array::from_fn(|axis| low[axis].min(at[axis])), std::array::from_fn(|axis| high[axis].max(at[axis]))]
}

/// The box on the map, local metres, of rows and columns of a side.
fn on_map([low, high]: [[i32; 2]; 2], side: f32) -> [[f32; 2]; 2] {
    [[low[1] as f32, low[0] as f32], [(high[1] + 1) as f32, (high[0] + 1) as f32]].map(|v| v.map(|v| v * side))
}

/// Overlap of two strips.
#[derive(Default)]
struct Meeting {
    /// Height of the second strip above the first.
    rises: Vec<f32>,
    corners: Option<[[i32; 2]; 2]>,
}

/// Two strips whose ground lies apart where one ends and the other begins.
fn strips_apart(
    cells: &[Cell],
    placed: &[Placed],
    side: f32,
    strip: &impl Fn(&Placed) -> Option<u16>,
) -> Option<GroundShift> {
    let of_cell = |cell: &Cell| {
        let points = cell.points(placed);
        let first = points.first().and_then(strip)?;
        let mean = points.iter().map(|point| point.height).sum::<f32>() / points.len() as f32;
        points.iter().all(|point| strip(point) == Some(first)).then_some((first, mean))
    };
    let pure: Vec<Option<(u16, f32)>> = cells.iter().map(of_cell).collect();
    let mut meetings: BTreeMap<[u16; 2], Meeting> = BTreeMap::new();
    for (cell, own) in cells.iter().zip(&pure) {
        let Some((from, _)) = own else { continue };
        for [down, right] in [[0, 1], [1, 0]] {
            let along = |step: i32| {
                let at = find(cells, [cell.at[0] + step * down, cell.at[1] + step * right])?;
                *pure.get(at)?
            };
            let Some((to, _)) = along(1).filter(|(to, _)| to != from) else { continue };
            // beyond the slope of the ground on either side
            let line = [-1, 0, 1, 2].map(along);
            let [Some((a, before)), Some((_, last)), Some((_, first)), Some((b, behind))] = line else { continue };
            if a != *from || b != to {
                continue;
            }
            let rise = (first - last) - 0.5 * ((last - before) + (behind - first));
            let (pair, rise) = if *from < to { ([*from, to], rise) } else { ([to, *from], -rise) };
            let meeting = meetings.entry(pair).or_default();
            meeting.rises.push(rise);
            meeting.corners = Some(widened(meeting.corners, cell.at));
        }
    }
    let mut counts: BTreeMap<u16, usize> = BTreeMap::new();
    placed.iter().filter_map(strip).for_each(|strip| *counts.entry(strip).or_default() += 1);
    let count = |strip: u16| counts.get(&strip).copied().unwrap_or(0);
    let shift = |([first, second], meeting): ([u16; 2], Meeting)| {
        let rise = common(&meeting.rises).filter(|_| meeting.rises.len() >= MIN_MEETINGS)?;
        let (shifted, other, rise) =
            if count(first) < count(second) { (first, second, -rise) } else { (second, first, rise) };
        let [low, high] = on_map(meeting.corners?, side);
        let against = ShiftEvidence::Strips { shifted, other };
        Some(GroundShift { point_count: count(shifted), rise, low, high, against })
    };
    meetings.into_iter().filter_map(shift).max_by_key(|shift| shift.point_count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::Attributes;
    use belvedere_data::cast::{to_f32, to_index, to_row};
    use belvedere_data::cloud::GROUND;
    use belvedere_data::random::uniform;

    /// A point of a test: place, class and strip.
    type Return = ([f32; 3], u8, u16);

    /// Two strips of ground over a square of 60 m, which overlap wholly, at the height of `ground`.
    fn strips(density: f64, ground: impl Fn(f32, f32) -> f32) -> Vec<Return> {
        let count = to_index(3600.0 * density) as u64;
        let one = |i: u64| {
            let [x, y] = [1, 2].map(|seed| 60.0 * to_f32(uniform(seed, i)));
            ([x, y, ground(x, y) + 0.06 * (to_f32(uniform(3, i)) - 0.5)], GROUND, 1 + (i % 2) as u16)
        };
        (0..count).map(one).collect()
    }

    /// The same with those that `is_off` chooses higher by `rise`.
    fn shifted(mut returns: Vec<Return>, rise: f32, is_off: impl Fn(&Return) -> bool) -> Vec<Return> {
        returns.iter_mut().filter(|one| one.1 == GROUND && is_off(one)).for_each(|one| one.0[2] += rise);
        returns
    }

    fn found(returns: &[Return]) -> Option<GroundShift> {
        let positions: Vec<[f32; 3]> = returns.iter().map(|one| one.0).collect();
        let attributes = Attributes {
            classification: Some(returns.iter().map(|one| one.1).collect()),
            point_source_id: Some(returns.iter().map(|one| one.2).collect()),
            ..Attributes::default()
        };
        let cloud = PointCloud { positions, attributes, ..PointCloud::default() };
        let is_ground = |row: &u32| returns[*row as usize].1 == GROUND;
        let rows: Vec<u32> = (0..to_row(returns.len())).filter(is_ground).collect();
        let points: Vec<[f32; 3]> = rows.iter().map(|&row| returns[row as usize].0).collect();
        shift_of(&cloud, &rows, &points, &Control::none()).unwrap()
    }

    fn is_in_area([x, y, _]: [f32; 3]) -> bool {
        (15.0..45.0).contains(&x) && (15.0..45.0).contains(&y)
    }

    #[test]
    fn a_strip_that_lies_off_where_another_lies_too_is_found() {
        let grounds: [fn(f32, f32) -> f32; 3] =
            [|_, _| 10.0, |x, _| 0.3 * x, |x, y| (0.2 * x).sin() + (0.15 * y).cos()];
        for density in [1.0, 4.0, 12.0] {
            for (number, ground) in grounds.into_iter().enumerate() {
                for rise in [-6.0_f32, -1.5, -1.0, 1.0, 2.5] {
                    let what = format!("ground {number}, {density} a square metre, {rise} m");
                    // cells of sparse points are wide, and a slope across them is as high as a small step
                    if density < 4.0 && rise.abs() < 1.5 && number > 0 {
                        continue;
                    }
                    let whole = found(&shifted(strips(density, ground), rise, |one| one.2 == 2)).expect(&what);
                    assert_eq!(whole.against, ShiftEvidence::SecondLevel, "{what}");
                    assert!((whole.rise.abs() - rise.abs()).abs() < 0.2 + 0.1 * rise.abs(), "{what}: {whole:?}");
                    let part = |one: &Return| one.2 == 2 && is_in_area(one.0);
                    let part = found(&shifted(strips(density, ground), rise, part)).expect(&what);
                    assert!(part.low.iter().all(|low| *low > 0.0) && part.high.iter().all(|high| *high < 60.0));
                    assert!(part.point_count < whole.point_count, "{what}: {part:?}");
                    // the ground around says which of the two levels is off
                    assert!((part.rise - rise).abs() < 0.2 + 0.1 * rise.abs(), "{what}: {part:?}");
                }
            }
        }
        // a third of the points, without the numbers of strips
        let some = shifted(strips(8.0, |_, _| 0.0), -1.2, |one| (17.0 * one.0[0]).fract() < 0.33);
        let some: Vec<Return> = some.into_iter().map(|(place, class, _)| (place, class, 0)).collect();
        let shift = found(&some).unwrap();
        assert!((shift.rise + 1.2).abs() < 0.05, "{shift:?}");
        // squares whose cells happen to have one level are left out
        assert!((shift.point_count as f64 / some.len() as f64 - 0.33).abs() < 0.1, "{shift:?}");
    }

    #[test]
    fn strips_that_lie_apart_where_one_ends_are_found() {
        for (rise, slope) in [(-1.0_f32, 0.0_f32), (3.0, 0.0), (1.5, 0.6)] {
            let west = |one: &Return| one.0[0] < 25.0;
            let mut returns = strips(4.0, |x, _| slope * x);
            returns.iter_mut().for_each(|one| one.2 = if west(one) { 7 } else { 4 });
            assert_eq!(found(&returns), None, "{rise}");
            let shift = found(&shifted(returns, rise, west)).unwrap();
            assert_eq!(shift.against, ShiftEvidence::Strips { shifted: 7, other: 4 });
            assert!((shift.rise - rise).abs() < 0.1, "{shift:?}");
            assert!(shift.low[0] > 20.0 && shift.high[0] < 30.0, "{shift:?}");
        }
    }

    #[test]
    fn terraces_quays_pits_and_crops_are_believed() {
        let terraces: fn(f32, f32) -> f32 = |x, _| 1.5 * (x / 4.0).floor();
        let pit: fn(f32, f32) -> f32 = |x, y| if is_in_area([x, y, 0.0]) { -3.0 } else { 0.0 };
        let quay: fn(f32, f32) -> f32 = |x, y| if x + 0.3 * y < 40.0 { 0.0 } else { 2.0 };
        let steep: fn(f32, f32) -> f32 = |x, y| 1.2 * x + 0.5 * y;
        for density in [0.3, 1.0, 4.0, 12.0] {
            for (number, ground) in [terraces, pit, quay, steep].into_iter().enumerate() {
                assert_eq!(found(&strips(density, ground)), None, "ground {number}, {density} a square metre");
            }
        }
        // every second return of a field is the top of its maize, 1.8 m high
        let mut crops = strips(8.0, |_, _| 0.0);
        let is_top = |one: &&mut Return| is_in_area(one.0) && one.2 == 2;
        crops.iter_mut().filter(is_top).for_each(|one| (one.0[2], one.1) = (one.0[2] + 1.8, 3));
        assert_eq!(found(&crops), None);
        assert_eq!(found(&[]), None);
        assert_eq!(found(&[([0.0; 3], GROUND, 1)]), None);
    }
}
