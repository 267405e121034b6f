//! Strips of lines of sight that are still free, and the minimum height of a ball that blocks one of them.
//!
//! Seen along a direction, the lines from a tile lie side by side in strips. An obstacle in a strip must be higher than
//! the lowest line there. Few lines run far, so that most distant obstacles need no test and no index.

use crate::answer::lines::MAX_BALL;
use crate::grid::{LINE_ROOM, MapArea, TOP_SIDE, square_area, square_at};
use belvedere::cast::to_index;
use belvedere::query::FreeLines;
use rayon::prelude::*;
use std::collections::HashMap;

/// Minimum width of a strip, metres, and maximum number of strips in a direction.
const WIDTH: f64 = 4.0;
const MAX_STRIPS: f64 = 1024.0;
/// Maximum slope of lines, metres of height for each metre on the map. Steeper lines get this slope. In the highest
/// scene they then move by less than [`LINE_ROOM`].
const STEEPEST: f64 = 1e6;
/// Slope below which lines run far: 11 degrees.
const LOW_SLOPE: f64 = 0.2;
/// Number of low lines up to which each line has its own start, and number of neighbours that share one start on
/// steeper lines.
const MAX_STARTS: usize = 1 << 24;
const NEIGHBOURS: usize = 256;
/// Number of directions that a thread takes at once.
const TOGETHER: usize = 64;
/// Number of cells along the side of a square, and their side, metres. Balls are grouped by these cells.
const PARTS: i32 = 2;
const CELL: f64 = TOP_SIDE / PARTS as f64;
/// Maximum radii of the two groups of balls that are looked up together, metres.
const RADII: [f64; 2] = [1.0, MAX_BALL];

/// Lines of sight in one direction.
struct DirectionLines {
    /// Horizontal unit vector along the lines.
    along: [f64; 2],
    slope: f64,
    /// Coordinate across the lines of the left side of the first strip.
    left: f64,
    strips: Vec<LineStrip>,
}

/// Lines of sight side by side.
#[derive(Clone, Copy)]
struct LineStrip {
    /// Coordinate along the direction of the first start of a line.
    start: f64,
    /// Height of the lowest line, continued back to coordinate zero along the direction.
    height: f64,
}

const NO_LINES: LineStrip = LineStrip { start: f64::INFINITY, height: f64::INFINITY };

/// Lines of sight that are still free.
pub(crate) struct Strips {
    width: f64,
    /// Lines of each direction.
    courses: Vec<DirectionLines>,
}

impl Strips {
    /// Creates strips without lines, for `directions` from targets over an area.
    pub(crate) fn new(directions: &[[f64; 3]], targets: &MapArea) -> Self {
        let extent = (targets.high[0] - targets.low[0]).hypot(targets.high[1] - targets.low[1]);
        let width = WIDTH.max(extent / MAX_STRIPS);
        Self {
            width,
            courses: directions.iter().map(|direction| DirectionLines::new(*direction, targets, width)).collect(),
        }
    }

    /// Finds the strips of the lines of `free` in the directions of `columns`, which ascend.
    pub(crate) fn look_up(&mut self, free: &FreeLines<'_>, columns: &[usize]) {
        let (width, courses) = (self.width, self.courses.iter_mut().enumerate());
        let mut looked_up: Vec<(usize, &mut DirectionLines)> =
            courses.filter(|(column, _)| columns.binary_search(column).is_ok()).collect();
        let low_count = looked_up.iter().filter(|(_, course)| course.is_low()).count();
        // Where lines run far, each has its own start.
        let of_low = (free.target_count() * low_count).div_ceil(MAX_STARTS);
        looked_up.par_chunks_mut(TOGETHER).for_each(|courses| {
            for (is_low, together) in [(true, of_low), (false, NEIGHBOURS)] {
                let (columns, mut courses): (Vec<usize>, Vec<&mut DirectionLines>) = courses
                    .iter_mut()
                    .filter(|(_, course)| course.is_low() == is_low)
                    .map(|(column, course)| (*column, &mut **course))
                    .unzip();
                courses.iter_mut().for_each(|course| course.strips.fill(NO_LINES));
                free.each_start(&columns, together, |number, corners, lowest| {
                    let [low, high] = corners.map(|corner| corner.map(f64::from));
                    if let Some(course) = courses.get_mut(number) {
                        course.add(&MapArea { low, high }, f64::from(lowest), width);
                    }
                });
            }
        });
    }

    /// Returns the columns of directions with a line that may be blocked. Obstacles lie on squares of 16 m with the
    /// highest `tops`.
    pub(crate) fn meeting(&self, tops: &[([i32; 2], f32)]) -> Vec<usize> {
        let squares: Vec<(MapArea, f64)> =
            tops.iter().map(|&(number, top)| (square_area(number, TOP_SIDE), f64::from(top))).collect();
        let meets =
            |course: &DirectionLines| squares.iter().any(|(area, top)| *top >= course.min_top(area, self.width));
        let courses = self.courses.par_iter().enumerate();
        courses.filter(|(_, course)| meets(course)).map(|(column, _)| column).collect()
    }

    /// Returns the minimum tops of balls that may block a line in any direction of `columns`. Balls lie on squares of
    /// 16 m with the highest `tops`.
    pub(crate) fn min_tops(&self, columns: &[usize], tops: &[([i32; 2], f32)]) -> MinTops {
        let courses: Vec<&DirectionLines> = columns.iter().filter_map(|&column| self.courses.get(column)).collect();
        let min = |area: &MapArea| {
            courses.iter().map(|course| course.min_top(area, self.width)).fold(f64::INFINITY, f64::min)
        };
        let of_square = |&(number, top): &([i32; 2], f32)| {
            let reached = f64::from(top) >= min(&square_area(number, TOP_SIDE).widened(MAX_BALL));
            // Numbers in a damaged record may have any value.
            let [east, north] = number.map(|number| number.wrapping_mul(PARTS));
            let cells =
                (0..PARTS * PARTS).map(move |part| [east.wrapping_add(part % PARTS), north.wrapping_add(part / PARTS)]);
            let with_min = move |cell| (cell, RADII.map(|radius| min(&square_area(cell, CELL).widened(radius))));
            cells.filter(move |_| reached).map(with_min)
        };
        MinTops(tops.par_iter().flat_map_iter(of_square).collect())
    }
}

/// Minimum tops of balls that block a line, by the cell of their centre: for small balls and for balls of any radius.
/// In other cells no ball blocks.
pub(crate) struct MinTops(HashMap<[i32; 2], [f64; 2]>);

impl MinTops {
    pub(crate) fn may_block(&self, [x, y, z]: [f32; 3], radius: f32) -> bool {
        let radius = f64::from(radius);
        let Some(kind) = RADII.iter().position(|max| radius <= *max) else { return true };
        let min = self.0.get(&square_at([x, y], CELL));
        min.is_some_and(|min| f64::from(z) + radius >= min[kind])
    }
}

impl DirectionLines {
    fn new(direction: [f64; 3], targets: &MapArea, width: f64) -> Self {
        let level = direction[0].hypot(direction[1]);
        let slope = direction[2] / level;
        let (along, slope) = if slope < STEEPEST {
            ([direction[0] / level, direction[1] / level], slope)
        } else {
            ([1.0, 0.0], STEEPEST)
        };
        let [left, right] = targets.widened(LINE_ROOM).span([-along[1], along[0]]);
        let count = to_index((right - left) / width) + 1;
        Self { along, slope, left, strips: vec![NO_LINES; count] }
    }

    /// True if lines run far.
    fn is_low(&self) -> bool {
        self.slope < LOW_SLOPE
    }

    /// Returns the ranges of an area along the lines and across.
    fn spans(&self, area: &MapArea) -> [[f64; 2]; 2] {
        [area.span(self.along), area.span([-self.along[1], self.along[0]])]
    }

    /// Returns the strips that meet a range across the lines.
    fn met(&self, [from, to]: [f64; 2], width: f64) -> std::ops::Range<usize> {
        let place = |v: f64| (v - self.left) / width;
        let number = |v: f64| to_index(v).min(self.strips.len());
        if place(to) < 0.0 { 0..0 } else { number(place(from))..number(place(to) + 1.0) }
    }

    /// Adds lines that start over an area, none lower than `lowest`.
    fn add(&mut self, area: &MapArea, lowest: f64, width: f64) {
        let [[first, last], across] = self.spans(area);
        let met = self.met(across, width);
        let height = lowest - last * self.slope;
        for strip in self.strips.get_mut(met).into_iter().flatten() {
            *strip = LineStrip { start: strip.start.min(first), height: strip.height.min(height) };
        }
    }

    /// Returns the minimum top of an obstacle over `area` that may block a line, local metres.
    fn min_top(&self, area: &MapArea, width: f64) -> f64 {
        let [[near, far], [left, right]] = self.spans(area);
        let met = self.strips.get(self.met([left - LINE_ROOM, right + LINE_ROOM], width)).unwrap_or_default();
        let ahead = met.iter().filter(|strip| far >= strip.start - LINE_ROOM);
        ahead.map(|strip| strip.height + near.max(strip.start) * self.slope - LINE_ROOM).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::make_balls::tops;
    use belvedere::cast::to_f32;
    use belvedere::medial::MedialBalls;
    use belvedere::random::uniform;

    /// Random lines and balls, steep lines among them: no ball that blocks a line is left out, and many others are.
    #[test]
    fn what_blocks_a_line_is_found_and_little_else() {
        let random = |seed: u64, i: u64, low: f64, high: f64| low + (high - low) * uniform(seed, i);
        let place = |seed: u64, i: u64, across: [f64; 2], heights: [f64; 2]| -> [f32; 3] {
            let ranges = [across, across, heights];
            std::array::from_fn(|axis| to_f32(random(seed + axis as u64, i, ranges[axis][0], ranges[axis][1])))
        };
        let mut directions: Vec<[f64; 3]> = (0..30)
            .map(|i| {
                let (azimuth, elevation) = (random(1, i, 0.0, 6.3), random(2, i, 0.01, 0.5));
                [azimuth.sin() * elevation.cos(), azimuth.cos() * elevation.cos(), elevation.sin()]
            })
            .collect();
        directions.extend([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
        let columns: Vec<usize> = (0..directions.len()).collect();
        for count in [3, 300, 40_000] {
            let targets: Vec<[f32; 3]> = (0..count).map(|i| place(3, i, [0.0, 200.0], [0.0, 8.0])).collect();
            let free = FreeLines::new(&targets, &directions).unwrap();
            let area = MapArea { low: [0.0; 2], high: [200.0; 2] };
            let mut strips = Strips::new(&directions, &area);
            strips.look_up(&free, &columns);
            let balls = MedialBalls {
                centers: (0..2000).map(|i| place(6, i, [-300.0, 500.0], [-20.0, 30.0])).collect(),
                radii: (0..2000).map(|i| if i % 50 == 0 { 12.0 } else { 0.1 + 0.04 * (i % 100) as f32 }).collect(),
                source: vec![0; 2000],
                touch: vec![0; 2000],
                separation_angles: vec![1.0; 2000],
            };
            let tops = tops(&balls);
            let min_tops = strips.min_tops(&strips.meeting(&tops), &tops);
            let may_block = |row: &usize| min_tops.may_block(balls.centers[*row], balls.radii[*row]);
            let rows: Vec<usize> = (0..2000).filter(may_block).collect();
            let blocks = |row: usize| {
                let (center, radius) = (balls.centers[row].map(f64::from), f64::from(balls.radii[row]));
                targets.iter().any(|target| {
                    let way: [f64; 3] = std::array::from_fn(|i| center[i] - f64::from(target[i]));
                    directions.iter().any(|direction| {
                        let span = (0..3).map(|i| way[i] * direction[i]).sum::<f64>().max(0.0);
                        (0..3).map(|i| (way[i] - span * direction[i]).powi(2)).sum::<f64>() < radius * radius
                    })
                })
            };
            // As many tests of lines for many targets as for few.
            let tried = (0..2000).step_by(1 + targets.len() / 2000);
            let blocking: Vec<usize> = tried.filter(|&row| blocks(row)).collect();
            assert!(!blocking.is_empty());
            assert!(blocking.iter().all(|row| rows.binary_search(row).is_ok()), "{count} targets");
            assert!(rows.len() < 1900, "{count} targets: {} of 2000", rows.len());
        }
    }
}
