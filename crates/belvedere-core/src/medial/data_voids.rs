//! Data voids: places on the map that pulses reached and did not return from, above all water.
//!
//! A ball grows from its point to the next one that it meets. Beside a canal it meets none for many metres, and reaches
//! as far over the water as the first pulse that passes. Nothing stands there: the pulses that were sent there met
//! neither a crown nor a roof.

use super::cells::{Cell, Cells, cell};
use super::marking_rule::{MarkingRule, Phase};
use super::marks::{Cut, Marks, cuts_of};
use super::spacing::spacing_of;
use super::survey::Survey;
use crate::normals::OrientedCloud;
use belvedere_data::Result;
use belvedere_data::balls::{MedialBalls, NO_TOUCH};
use belvedere_data::control::{Control, Stop};
use rayon::prelude::*;
use std::collections::HashMap;

/// Smaller balls reach no middle of an empty cell, which lies half a metre or more from every point.
const MIN_RADIUS: f32 = 0.25;
/// Search radius, in cells, for the lowest point around a void and for the voids around a point: the reach of a ball of
/// 5 m.
const FARTHEST: i32 = 10;
/// Rings of cells about a void, from the nearest one with a pulse on, whose pulses show where the scanner was.
const BORDER_WIDTH: i32 = 3;
/// Balls that are looked at together: their empty cells take up to a few hundred megabytes where points are sparse.
const BALLS_AT_ONCE: usize = 1 << 16;
/// Steps towards a scanner, metres on the map: half a cell; and how many are made at most.
const STEP_M: f32 = 0.5;
const MAX_STEPS: u16 = 4096;
/// Minimum sine of the angle between a pulse and the vertical. Pulses that are assumed to fall straight down show no
/// shadow of objects.
const MIN_LEAN: f32 = 1e-4;

/// Parameters of cutting balls at data voids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DataVoidParams {
    /// Maximum spacing of pulses around a void, metres, above 0. Default 0.75, a quarter of the side of the smallest
    /// void, 3 m. The lidar base specification of the US Geological Survey defines a void as an area of at least four
    /// spacings squared without first returns.
    pub max_spacing: f32,
    /// Height above the lowest point around a void from which on balls do not reach into it, metres, 0 or more. Default
    /// 0.5.
    pub min_height: f32,
}

impl Default for DataVoidParams {
    fn default() -> Self {
        Self { max_spacing: 0.75, min_height: 0.5 }
    }
}

impl MarkingRule for DataVoidParams {
    fn stage(&self) -> Option<(Phase, &'static str)> {
        Some((Phase::Balls, "cutting at data voids"))
    }

    fn marks(&self, survey: &Survey<'_>, balls: &MedialBalls, control: &Control<'_>) -> Result<Marks> {
        let cuts = DataVoids::new(survey, self).cuts(survey.oriented, balls, control)?;
        Ok(Marks { counts: vec![("balls_cut_at_data_voids", cuts.len())], cuts, ..Marks::default() })
    }
}

/// Criteria that separate voids from places in the shadow of an object.
struct DataVoids<'a> {
    params: &'a DataVoidParams,
    /// Heights of the highest points in cells.
    highest: &'a Cells<f32>,
    /// Heights of the lowest points in cells and those about them.
    lowest: &'a Cells<f32>,
    /// Number of pulses that end in each cell and its neighbours.
    counts: &'a Cells<u32>,
    /// Unit vectors towards the scanner of the steepest pulses that end in cells.
    ways: Cells<[f32; 3]>,
    /// Height of the highest point.
    top: f32,
}

impl<'a> DataVoids<'a> {
    /// Finds the data voids of a survey.
    fn new(survey: &'a Survey<'_>, params: &'a DataVoidParams) -> Self {
        let Survey { highest, lowest, counts, free_segments, .. } = survey;
        let way = |number: usize| {
            let (start, towards, _) = free_segments.segment(number)?;
            (towards[2] > 0.0 && towards[0].hypot(towards[1]) > MIN_LEAN).then(|| (cell(start), towards))
        };
        let steeper = |a: [f32; 3], b: [f32; 3]| if (a[2], a[0], a[1]) > (b[2], b[0], b[1]) { a } else { b };
        let ways = Cells::new((0..free_segments.len()).into_par_iter().filter_map(way).collect(), steeper);
        Self { params, lowest, counts, ways, top: highest.all(f32::max).unwrap_or(f32::NEG_INFINITY), highest }
    }

    /// Cuts of `balls`, row i of which is the interior ball of point i of `oriented`, where they reach over the middle
    /// of a cell in a void. The result depends on neither the order of points nor the number of threads.
    fn cuts(&self, oriented: &OrientedCloud, balls: &MedialBalls, control: &Control<'_>) -> Result<Vec<Cut>> {
        let stop = Stop::new(control);
        let (positions, normals) = (oriented.positions(), oriented.normals());
        let dense = self.dense_areas();
        let empty_cells = |row: usize| {
            let mut cells = Vec::new();
            let may_reach = balls.touch[row] != NO_TOUCH && balls.radii[row] > MIN_RADIUS;
            if may_reach && dense.get(area(cell(positions[row]))).is_some() && !stop.is_set() {
                self.empty_cells(positions[row], normals[row], balls.radii[row], &mut cells);
            }
            cells.into_iter().map(move |cell| (row, cell))
        };
        let mut floors: HashMap<Cell, Option<f32>> = HashMap::new();
        let mut radii = balls.radii.clone();
        for start in (0..balls.len()).step_by(BALLS_AT_ONCE) {
            let rows = start..balls.len().min(start + BALLS_AT_ONCE);
            let empty: Vec<(usize, Cell)> = rows.into_par_iter().flat_map_iter(empty_cells).collect();
            // a void is made of squares of 3 × 3 empty cells
            let middles = unique(empty.par_iter().map(|&(_, cell)| cell).collect())
                .into_par_iter()
                .flat_map_iter(cell_and_neighbors);
            let is_new = |middle: &Cell| !floors.contains_key(middle) && self.is_empty_around(*middle);
            let middles = unique(middles.filter(is_new).collect());
            let floor = |middle| (middle, self.floor(middle).filter(|_| !stop.is_set()));
            floors.par_extend(middles.into_par_iter().map(floor));
            for (row, cell) in empty {
                let top = balls.centers[row][2] + balls.radii[row];
                let is_below =
                    |middle| matches!(floors.get(&middle), Some(Some(floor)) if floor + self.params.min_height < top);
                if cell_and_neighbors(cell).any(is_below) {
                    radii[row] = radii[row].min(touching(positions[row], normals[row], cell));
                }
            }
            stop.check()?;
        }
        cuts_of(balls, MIN_RADIUS, control, |row| radii[row])
    }

    /// Returns true if neither a cell nor its neighbours hold a point.
    fn is_empty_around(&self, cell: Cell) -> bool {
        let (low, high) = square(cell, 1);
        self.highest.in_rectangle(low, high, f32::max).is_none()
    }

    /// The areas from which a void between dense pulses may be reached.
    fn dense_areas(&self) -> Cells<()> {
        let is_dense = |&(_, count): &(Cell, u32)| spacing_of(count) <= self.params.max_spacing;
        let mut dense: Vec<Cell> = self.counts.iter().filter(is_dense).map(|(cell, _)| area(cell)).collect();
        dense.dedup();
        Cells::new(dense.into_iter().flat_map(cell_and_neighbors).map(|area| (area, ())).collect(), |(), ()| ())
    }

    /// The cells without points whose middle lies below or above the ball of this radius at a point with this outward
    /// normal.
    fn empty_cells(&self, point: [f32; 3], normal: [f32; 3], radius: f32, cells: &mut Vec<Cell>) {
        let corner = |off: f32| cell(std::array::from_fn(|axis| point[axis] - radius * normal[axis] + off));
        let ((south, west), (north, east)) = (corner(-radius), corner(radius));
        let (low, high) = square(cell(point), FARTHEST);
        let (low, high) = ((south.max(low.0), west.max(low.1)), (north.min(high.0), east.min(high.1)));
        self.highest.empty_in_rectangle(low, high, |cell| {
            if touching(point, normal, cell) < radius {
                cells.push(cell);
            }
        });
    }

    /// Returns the height down to which pulses passed through a cell without points. It is that of the lowest point
    /// around it, if nothing stands between there and the scanner of any pulse that ended beside the void.
    fn floor(&self, cell: Cell) -> Option<f32> {
        let (low, high) = square(cell, FARTHEST);
        let count = self.counts.in_rectangle(low, high, u32::max)?;
        if spacing_of(count) > self.params.max_spacing {
            return None;
        }
        let (mut ways, mut nearest) = (Vec::new(), FARTHEST);
        for distance in 1..=FARTHEST {
            if distance >= nearest + BORDER_WIDTH {
                break;
            }
            for way in ring(cell, distance).filter_map(|beside| self.ways.get(beside)) {
                nearest = nearest.min(distance);
                ways.push(way);
            }
        }
        let floor = self.lowest.in_rectangle(low, high, f32::min)?;
        (!ways.is_empty() && !ways.into_iter().any(|way| self.is_shaded(cell, floor, way))).then_some(floor)
    }

    /// Returns true if a point lies above the line from the centre of a cell at this height towards a scanner.
    fn is_shaded(&self, (row, column): Cell, height: f32, way: [f32; 3]) -> bool {
        let lean = way[0].hypot(way[1]);
        let from = [column as f32 + 0.5, row as f32 + 0.5, height];
        let along = (0..MAX_STEPS).map(|step| f32::from(step) * STEP_M / lean);
        let places = along.map(|t| -> [f32; 3] { std::array::from_fn(|axis| from[axis] + t * way[axis]) });
        let is_below = |place: [f32; 3]| self.highest.get(cell(place)).is_some_and(|highest| highest > place[2]);
        places.take_while(|place| place[2] < self.top).any(is_below)
    }
}

/// Radius from which on the balls of a point with this outward normal reach below or above the middle of a cell.
fn touching(point: [f32; 3], normal: [f32; 3], (row, column): Cell) -> f32 {
    let [x, y] = [(column, point[0]), (row, point[1])].map(|(number, from)| number as f32 + 0.5 - from);
    // with d from the point to that place on the map: |d|² + 2 r d·n = r² (1 - n·n)
    let (square, outward) = (x * x + y * y, x * normal[0] + y * normal[1]);
    let up = (1.0 - normal[0] * normal[0] - normal[1] * normal[1]).max(0.0);
    // in this form level normals, for which nothing is left to divide by, need no case of their own
    square / ((outward * outward + up * square).sqrt() - outward).max(0.0)
}

/// These cells, sorted and without duplicates.
fn unique(mut cells: Vec<Cell>) -> Vec<Cell> {
    cells.par_sort_unstable();
    cells.dedup();
    cells
}

/// The cells of least and of greatest row and column of the square that reaches this many cells from its middle.
fn square((row, column): Cell, reach: i32) -> (Cell, Cell) {
    ((row - reach, column - reach), (row + reach, column + reach))
}

/// The area of 32 by 32 cells that a cell lies in: voids and the pulses around them lie within 20 cells of a point.
fn area((row, column): Cell) -> Cell {
    (row.div_euclid(32), column.div_euclid(32))
}

/// A cell and those beside it.
fn cell_and_neighbors((row, column): Cell) -> impl Iterator<Item = Cell> {
    (row - 1..=row + 1).flat_map(move |row| (column - 1..=column + 1).map(move |column| (row, column)))
}

/// The cells that lie this many rows or columns from a cell, whichever are more.
fn ring((row, column): Cell, distance: i32) -> impl Iterator<Item = Cell> {
    let ends = (-distance..=distance).flat_map(move |off| [(-distance, off), (distance, off)]);
    let sides = (1 - distance..distance).flat_map(move |off| [(off, -distance), (off, distance)]);
    ends.chain(sides).map(move |(up, right)| (row + up, column + right))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medial::survey::tests::with_survey;
    use belvedere_data::cast::{to_f32, to_i32};
    use belvedere_data::random::uniform;

    const RADIUS: f32 = 4.0;
    /// Direction to a scanner in the west, 27° from straight up.
    const WEST: [f32; 3] = [-0.5, 0.0, 1.0];
    const STRAIGHT_UP: [f32; 3] = [0.0, 0.0, 1.0];

    /// Creates points of a survey of 20 m, 0.25 m apart, at the heights that `height` gives, if any. The first point is
    /// 3 m above the origin; its inside lies to the east.
    fn survey(height: impl Fn(f32, f32) -> Option<f32>) -> OrientedCloud {
        let (mut positions, mut normals) = (vec![[0.0, 0.0, 3.0]], vec![[-1.0, 0.0, 0.0]]);
        for i in 0_u8..80 {
            for k in 0_u8..80 {
                let [x, y] = [i, k].map(|number| f32::from(number) * 0.25 - 9.9);
                if let Some(z) = height(x, y) {
                    positions.push([x, y, z]);
                    normals.push([0.0, 0.0, 1.0]);
                }
            }
        }
        OrientedCloud::with_known_normals(positions, normals).unwrap()
    }

    /// Returns the remaining radius of a ball of [`RADIUS`] at point `row`, for scanners towards `way`.
    fn remaining_radius(oriented: &OrientedCloud, row: usize, way: [f32; 3]) -> f32 {
        let positions = oriented.positions();
        let scanner: Vec<[f32; 3]> =
            positions.iter().map(|p| std::array::from_fn(|axis| p[axis] + 400.0 * way[axis])).collect();
        let mut balls = MedialBalls::default();
        for (row, (p, n)) in positions.iter().zip(oriented.normals()).enumerate() {
            balls.push(row, std::array::from_fn(|axis| p[axis] - RADIUS * n[axis]), RADIUS, 7);
        }
        let marks = with_survey(oriented, None, &scanner, |survey| {
            DataVoidParams::default().marks(&survey, &balls, &Control::none()).unwrap()
        });
        let own = marks.cuts.iter().find(|cut| cut.row == row);
        own.and_then(|cut| cut.radius).unwrap_or(RADIUS)
    }

    /// A canal from the origin to 8 m east of it.
    fn canal(x: f32, _: f32) -> Option<f32> {
        (!(0.0..8.0).contains(&x)).then_some(0.0)
    }

    #[test]
    fn a_ball_reaches_no_farther_over_water_than_the_middle_of_a_cell() {
        // the middles of the nearest cells lie 0.5 m east and 0.5 m to both sides: |d|² / 2 d·m with d = (0.5, 0.5)
        assert!((remaining_radius(&survey(canal), 0, WEST) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn what_lies_in_a_shadow_is_no_void() {
        let towered = |x: f32, y: f32| if (-4.0..-1.0).contains(&x) { Some(30.0) } else { canal(x, y) };
        assert_eq!(remaining_radius(&survey(towered), 0, WEST), RADIUS);
        // a scanner on the other side looks below it
        assert!(remaining_radius(&survey(towered), 0, [0.5, 0.0, 1.0]) < 1.0);
    }

    #[test]
    fn assumed_pulses_tell_of_no_void() {
        assert_eq!(remaining_radius(&survey(canal), 0, STRAIGHT_UP), RADIUS);
    }

    #[test]
    fn a_few_empty_cells_are_no_void() {
        let puddle = |x: f32, y: f32| (!(0.0..2.0).contains(&x) || y.abs() > 3.0).then_some(0.0);
        assert_eq!(remaining_radius(&survey(puddle), 0, WEST), RADIUS);
    }

    #[test]
    fn between_sparse_pulses_there_are_no_voids() {
        // one point of each square metre
        let is_kept = |v: f32| (v + 9.9).rem_euclid(1.0) < 0.1;
        let sparse = |x: f32, y: f32| canal(x, y).filter(|_| is_kept(x) && is_kept(y));
        assert_eq!(remaining_radius(&survey(sparse), 0, WEST), RADIUS);
    }

    #[test]
    fn balls_below_the_lowest_point_around_a_void_stay() {
        let oriented = survey(canal);
        let quay = (1..oriented.len()).find(|&row| (-0.5..0.0).contains(&oriented.positions()[row][0])).unwrap();
        assert_eq!(remaining_radius(&oriented, quay, WEST), RADIUS);
    }

    #[test]
    fn touching_is_where_the_ball_reaches_the_middle() {
        for number in 0..2000 {
            let random = |k: u64| to_f32(uniform(k, number)) * 2.0 - 1.0;
            let normal = [random(1), random(2), random(3)];
            let length = normal.iter().map(|v| v * v).sum::<f32>().sqrt();
            let normal = normal.map(|v| v / length);
            let (point, cell) = (
                [random(4), random(5), random(6)],
                (to_i32(f64::from(random(7) * 9.0)), to_i32(f64::from(random(8) * 9.0))),
            );
            let found = touching(point, normal, cell);
            let is_over = |radius: f32| {
                let off = [(cell.1, 0), (cell.0, 1)]
                    .map(|(number, axis)| number as f32 + 0.5 - (point[axis] - radius * normal[axis]));
                off[0].hypot(off[1]) < radius
            };
            // rounding moves the place by parts of 1e-7 of some metres
            assert!(found > 1e3 || (!is_over(found * 0.999) && is_over(found * 1.001)), "{normal:?} {found}");
        }
    }
}
