//! Flags consistent ground points: small groups metres below or above the ground around are removed.

use belvedere_data::Result;
use belvedere_data::cast::{to_cell, to_row};
use belvedere_data::control::Control;
use rayon::prelude::*;

/// Maximum number of points of a group that is doubted: more are a pit, a terrace or a roof of unknown kind.
const MAX_GROUP_POINTS: usize = 30;
/// Maximum number of cells between the sides of such a group.
const MAX_GROUP_CELLS: i32 = 8;
/// Maximum height difference between a group and the ground around it, metres, beside a slope of 45° on the way there.
/// It is more than errors of classes beside walls, hedges and cars.
const MAX_STEP: f32 = 2.0;
/// Minimum side of the cells in which points are joined, metres.
const MIN_CELL: f32 = 1.0;
/// Maximum side of these cells, metres: larger ones would join points metres apart.
const MAX_CELL: f32 = 4.0;
/// Search radius for ground around a group, cells.
const SEARCH: i32 = 30;
/// Neighbours that say how high the ground around is.
const NEIGHBORS: usize = 8;

/// Points in one cell whose heights follow each other without a gap.
#[derive(Clone, Copy, Debug)]
struct Level {
    column: i32,
    row: i32,
    low: f32,
    high: f32,
    /// First of its points in the order of cells and heights, and their number.
    first: usize,
    count: usize,
}

/// A point by its cell and height.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) row: i32,
    pub(super) column: i32,
    pub(super) height: f32,
    pub(super) number: u32,
}

/// Groups of levels that hang together.
struct Groups {
    /// For each level another one of its group; itself for one that represents all of them.
    parents: Vec<usize>,
}

/// Extent and size of a group.
#[derive(Clone, Copy, Debug)]
struct Group {
    count: usize,
    low: [i32; 2],
    high: [i32; 2],
}

/// Flags the `points`, (N, 3) local metres, that are consistent with the ground around, (N). Small groups that are not
/// connected with the rest, and lie metres below or above it, are not. All are flagged if no large group exists.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn believed(points: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<bool>> {
    let mut believed = vec![true; points.len()];
    let cell = cell_of(points);
    // what hangs together differs by less from cell to cell
    let link = cell + 0.5;
    let placed = placed(points, cell);
    control.check()?;
    let levels = levels(&placed, link);
    let groups = Groups::of(&levels, link);
    control.check()?;
    let sizes = groups.sizes(&levels);
    let is_large = |level: usize| !sizes[level].is_small();
    for (number, level) in levels.iter().enumerate().filter(|(number, _)| !is_large(*number)) {
        let around = ground_around(&levels, level, &is_large);
        if is_off(level, &around, cell) {
            for point in placed.iter().skip(level.first).take(level.count) {
                believed[point.number as usize] = false;
            }
        }
        if number % 1024 == 0 {
            control.check()?;
        }
    }
    Ok(believed)
}

/// Side of the cells, metres: doubled until of four that make a larger one more than two hold points.
fn cell_of(points: &[[f32; 3]]) -> f32 {
    let mut cells: Vec<[i32; 2]> = points.par_iter().map(|point| place(point, MIN_CELL)).collect();
    let mut cell = MIN_CELL;
    cells.par_sort_unstable();
    cells.dedup();
    while cell < MAX_CELL {
        let mut wider: Vec<[i32; 2]> = cells.iter().map(|cell| cell.map(|v| v.div_euclid(2))).collect();
        wider.par_sort_unstable();
        wider.dedup();
        if cells.len() > 2 * wider.len() {
            break;
        }
        cells = wider;
        cell *= 2.0;
    }
    cell
}

/// Row and column of a point in cells of a side, metres.
fn place(point: &[f32; 3], cell: f32) -> [i32; 2] {
    let at = |v: f32| to_cell(f64::from(v / cell));
    [at(point[1]), at(point[0])]
}

/// The points in the order of their cells, and of their heights in each.
pub(super) fn placed(points: &[[f32; 3]], cell: f32) -> Vec<Placed> {
    let one = |(number, point): (usize, &[f32; 3])| {
        let [row, column] = place(point, cell);
        Placed { row, column, height: point[2], number: to_row(number) }
    };
    let mut placed: Vec<Placed> = points.par_iter().enumerate().map(one).collect();
    placed.par_sort_unstable_by(|a, b| {
        (a.row, a.column).cmp(&(b.row, b.column)).then(a.height.total_cmp(&b.height)).then(a.number.cmp(&b.number))
    });
    placed
}

/// The levels of all cells, in the order of cells and heights.
fn levels(placed: &[Placed], link: f32) -> Vec<Level> {
    let mut levels: Vec<Level> = Vec::new();
    for (at, point) in placed.iter().enumerate() {
        let is_next = |level: &&mut Level| {
            (level.row, level.column) == (point.row, point.column) && point.height - level.high <= link
        };
        match levels.last_mut().filter(is_next) {
            Some(level) => {
                level.high = point.height;
                level.count += 1;
            }
            None => {
                let Placed { row, column, height, .. } = *point;
                levels.push(Level { column, row, low: height, high: height, first: at, count: 1 });
            }
        }
    }
    levels
}

/// The levels of a cell.
fn of_cell(levels: &[Level], row: i32, column: i32) -> &[Level] {
    let from = levels.partition_point(|level| (level.row, level.column) < (row, column));
    let rest = levels.get(from..).unwrap_or_default();
    let count = rest.iter().take_while(|level| (level.row, level.column) == (row, column)).count();
    rest.get(..count).unwrap_or_default()
}

impl Groups {
    fn of(levels: &[Level], link: f32) -> Self {
        let mut groups = Self { parents: (0..levels.len()).collect() };
        // the cell to the right, and the three of the next row, each looked through in step with this one
        for [down, right] in [[0, 1], [1, -1], [1, 0], [1, 1]] {
            let mut from = 0;
            for (number, level) in levels.iter().enumerate() {
                let wanted = (level.row + down, level.column + right);
                while levels.get(from).is_some_and(|other| (other.row, other.column) < wanted) {
                    from += 1;
                }
                let others = levels.iter().enumerate().skip(from);
                for (other, beside) in others.take_while(|(_, other)| (other.row, other.column) == wanted) {
                    if level.low - beside.high <= link && beside.low - level.high <= link {
                        groups.join(number, other);
                    }
                }
            }
        }
        groups
    }

    fn top(&self, mut level: usize) -> usize {
        while self.parents[level] != level {
            level = self.parents[level];
        }
        level
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.shortened(a), self.shortened(b));
        let (first, second) = (a.min(b), a.max(b));
        self.parents[second] = first;
    }

    /// The one that represents the group of a level, with the way there halved.
    fn shortened(&mut self, mut level: usize) -> usize {
        while self.parents[level] != level {
            let next = self.parents[self.parents[level]];
            self.parents[level] = next;
            level = next;
        }
        level
    }

    /// Size and extent of the group of each level.
    fn sizes(&self, levels: &[Level]) -> Vec<Group> {
        let mut sizes: Vec<Group> = levels.iter().map(Group::of).collect();
        for (number, level) in levels.iter().enumerate() {
            let top = self.top(number);
            if top != number {
                sizes[top].take(level);
            }
        }
        (0..levels.len()).map(|number| sizes[self.top(number)]).collect()
    }
}

impl Group {
    fn of(level: &Level) -> Self {
        let place = [level.row, level.column];
        Self { count: level.count, low: place, high: place }
    }

    fn take(&mut self, level: &Level) {
        self.count += level.count;
        for (axis, place) in [level.row, level.column].into_iter().enumerate() {
            self.low[axis] = self.low[axis].min(place);
            self.high[axis] = self.high[axis].max(place);
        }
    }

    fn is_small(&self) -> bool {
        self.count <= MAX_GROUP_POINTS && (0..2).all(|axis| self.high[axis] - self.low[axis] < MAX_GROUP_CELLS)
    }
}

/// Levels of large groups in the nearest cells around one, each with how many cells away it is.
fn ground_around(levels: &[Level], level: &Level, is_large: &impl Fn(usize) -> bool) -> Vec<(Level, f32)> {
    let mut around = Vec::new();
    let mut look = |row: i32, column: i32, ring: i32| {
        let from = levels.partition_point(|other| (other.row, other.column) < (row, column));
        for (at, other) in (from..).zip(of_cell(levels, row, column)) {
            if is_large(at) {
                around.push((*other, ring as f32));
            }
        }
        around.len()
    };
    for ring in 0..=SEARCH {
        let mut count = 0;
        for step in -ring..=ring {
            count = look(level.row + step, level.column - ring, ring);
            if ring > 0 {
                count = look(level.row + step, level.column + ring, ring);
            }
            if step.abs() < ring {
                look(level.row - ring, level.column + step, ring);
                count = look(level.row + ring, level.column + step, ring);
            }
        }
        if count >= NEIGHBORS {
            break;
        }
    }
    around
}

/// Returns true if a level lies metres below or above most of the ground around.
fn is_off(level: &Level, around: &[(Level, f32)], cell: f32) -> bool {
    let is_below = |(ground, cells): &&(Level, f32)| level.high + MAX_STEP + cells * cell < ground.low;
    let is_above = |(ground, cells): &&(Level, f32)| level.low - MAX_STEP - cells * cell > ground.high;
    let most = around.len() / 2;
    around.iter().filter(is_below).count() > most || around.iter().filter(is_above).count() > most
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::cast::{to_f32, to_index};
    use belvedere_data::random::uniform;

    /// Ground of `density` points a square metre on a square of 60 m, at the height of `ground`.
    fn ground(density: f64, ground: impl Fn(f32, f32) -> f32) -> Vec<[f32; 3]> {
        let random = |seed: u64, i: u64| 60.0 * to_f32(uniform(seed, i));
        let count = to_index(3600.0 * density) as u64;
        (0..count).map(|i| (random(1, i), random(2, i))).map(|(x, y)| [x, y, ground(x, y)]).collect()
    }

    /// Counts the doubted points of a scene, and those of the points added to it.
    fn doubted(mut points: Vec<[f32; 3]>, added: &[[f32; 3]]) -> [usize; 2] {
        let count = points.len();
        points.extend(added);
        let believed = believed(&points, &Control::none()).unwrap();
        let of = |part: &[bool]| part.iter().filter(|believed| !**believed).count();
        [of(&believed[..count]), of(&believed[count..])]
    }

    /// A group of `count` points within `size` metres of (30, 30), at a height.
    fn group(count: u64, size: f32, height: f32) -> Vec<[f32; 3]> {
        let at = |seed: u64, i: u64| 30.0 + size * (to_f32(uniform(seed, i)) - 0.5);
        (0..count).map(|i| [at(5, i), at(6, i), height + 0.2 * to_f32(uniform(7, i))]).collect()
    }

    #[test]
    fn low_and_high_groups_are_doubted_on_level_and_steep_ground() {
        let level = |_: f32, _: f32| 0.0;
        let hill = |x: f32, _: f32| 0.7 * x;
        let (of_hill, none) = (21.0, [0, 0]);
        for density in [0.5, 2.0, 8.0] {
            for count in [1, 3, 10, 30] {
                for height in [-50.0, -4.0 - 2.0 / to_f32(density), 6.0, 30.0] {
                    let added = group(count, 2.0, height);
                    let what = format!("{count} at {height}, {density} points a square metre");
                    assert_eq!(doubted(ground(density, level), &added), [0, added.len()], "{what}");
                    if height.abs() > 20.0 {
                        let added = group(count, 2.0, of_hill + height);
                        assert_eq!(doubted(ground(density, hill), &added), [0, added.len()], "{what} on a hill");
                    }
                }
                assert_eq!(doubted(ground(density, level), &group(count, 2.0, 0.0)), none);
            }
        }
    }

    #[test]
    fn cliffs_courts_and_pits_are_believed() {
        // a cliff of 12 m, a quarry of 14 m, a court 4 m below the street behind walls, and few points in all
        let cliff = |x: f32, _: f32| if x < 30.0 { 0.0 } else { 12.0 };
        let quarry = |x: f32, y: f32| if (x - 30.0).hypot(y - 30.0) < 7.0 { -5.0 } else { 0.0 };
        for density in [0.5, 4.0] {
            assert_eq!(doubted(ground(density, cliff), &[]), [0, 0]);
            assert_eq!(doubted(ground(density, quarry), &[]), [0, 0]);
        }
        let apart = |point: &[f32; 3]| (point[0] - 30.0).hypot(point[1] - 30.0) > 9.0;
        let street: Vec<[f32; 3]> = ground(4.0, |_, _| 0.0).into_iter().filter(apart).collect();
        assert_eq!(doubted(street, &group(20, 3.0, -4.0)), [0, 0]);
        assert_eq!(doubted(vec![[0.0, 0.0, 0.0], [1.0, 0.0, -9.0], [0.0, 1.0, 30.0]], &[]), [0, 0]);
        assert_eq!(doubted(Vec::new(), &[]), [0, 0]);
    }
}
