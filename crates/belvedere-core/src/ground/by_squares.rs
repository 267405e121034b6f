//! The ground of a few cells at a time: the points that show it are sorted by squares on the map once.

use super::{Ground, GroundParams, GroundReport, MapGrid, cells_near_returns, tested_points, triangulate};
use crate::neighbors::NeighborIndex;
use belvedere_data::cast::{to_index, to_row, to_u32};
use belvedere_data::control::Control;
use belvedere_data::model::GroundParts;
use belvedere_data::raster::Raster;
use belvedere_data::vector::box_around;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use rayon::prelude::*;
use std::ops::RangeInclusive;
use std::sync::OnceLock;

/// Ground points in a square, about.
const POINTS_OF_SQUARE: f64 = 32.0;
/// Triangles that lie in more squares than this are kept beside the others.
const MAX_SQUARES: usize = 64;
/// Margin around a grid within which its nearest ground points are searched first, metres.
const NEAR: f64 = 20.0;

/// Index of the ground of a cloud for grids of few cells anywhere. Each grid takes a moment, where [`Ground::of_cloud`]
/// reads the whole cloud again. The results are the same bits.
pub struct GroundBySquares {
    params: GroundParams,
    /// Report without cells.
    report: GroundReport,
    points: Vec<[f32; 3]>,
    /// Index of all points on the map, made for a grid without ground points near it.
    nearest: OnceLock<NeighborIndex>,
    squares: Squares,
    /// Rows of the corners of the Delaunay triangles.
    triangles: Vec<[u32; 3]>,
    /// Numbers of triangles, by squares that they reach into.
    of_squares: BySquare<u32>,
    /// Numbers of triangles that reach into many squares.
    large: Vec<u32>,
    /// Rows of ground points, by their squares.
    points_of_squares: BySquare<u32>,
    /// Returns on the map, by their squares.
    returns: BySquare<[f32; 2]>,
}

impl GroundBySquares {
    /// Selects the points that show the ground of a cloud.
    ///
    /// # Errors
    /// Those of [`Ground::of_cloud`].
    pub fn new(cloud: &PointCloud, params: &GroundParams, control: &Control<'_>) -> Result<Self> {
        params.check()?;
        let found = tested_points(cloud, params, control)?.in_order(cloud);
        let points = found.positions(cloud);
        let (triangles, shift) =
            rayon::join(|| triangulate::triangles(&points), || found.shift(cloud, &points, control));
        let corners = |corners: &[usize; 3]| corners.map(to_row);
        let triangles: Vec<[u32; 3]> = triangles?.as_chunks::<3>().0.iter().map(corners).collect();
        control.check()?;
        let squares = Squares::over(&points);
        let (mut of_squares, mut large) = (Vec::new(), Vec::new());
        for (number, corners) in (0..).zip(&triangles) {
            let corners = corners.map(|row| points[row as usize]);
            let low = [0, 1].map(|axis| corners.iter().map(|p| f64::from(p[axis])).fold(f64::INFINITY, f64::min));
            let high = [0, 1].map(|axis| corners.iter().map(|p| f64::from(p[axis])).fold(f64::NEG_INFINITY, f64::max));
            let [columns, rows] = squares.squares_between(low, high);
            if columns.clone().count().saturating_mul(rows.clone().count()) > MAX_SQUARES {
                large.push(number);
            } else {
                let numbers = rows.flat_map(|row| columns.clone().map(move |column| [column, row]));
                of_squares.extend(numbers.map(|square| (squares.number(square), number)));
            }
        }
        let places = cloud.positions.iter().map(|p| [p[0], p[1]]).chain(cloud.cleared_places.iter().copied());
        let returns = places.map(|place| (squares.of(place.map(f64::from)), place)).collect();
        let rows = (0..).zip(&points).map(|(row, p)| (squares.of([p[0], p[1]].map(f64::from)), row)).collect();
        let of_squares = BySquare::new(&squares, of_squares);
        let (points_of_squares, returns) = (BySquare::new(&squares, rows), BySquare::new(&squares, returns));
        let report = found.report(points.len(), shift?);
        let nearest = OnceLock::new();
        let params = *params;
        Ok(Self { params, report, points, nearest, squares, triangles, of_squares, large, points_of_squares, returns })
    }

    /// Returns the report on the ground points, and the index as numbers, for [`GroundBySquares::from_parts`].
    #[must_use]
    pub fn to_parts(&self) -> (GroundReport, GroundParts) {
        let Squares { low, side, last } = self.squares;
        let starts = [&self.of_squares.starts, &self.points_of_squares.starts, &self.returns.starts];
        let of_square = |square: usize| starts.map(|starts| starts[square] as u64);
        let parts = GroundParts {
            points: self.points.clone(),
            triangles: self.triangles.clone(),
            large: self.large.clone(),
            squares: [low[0], low[1], side, last[0], last[1]],
            starts: (0..=self.squares.count()).map(of_square).collect(),
            triangles_of_squares: self.of_squares.items.clone(),
            points_of_squares: self.points_of_squares.items.clone(),
            returns: self.returns.items.clone(),
        };
        (self.report, parts)
    }

    /// Creates the index from the numbers of another one.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] and [`Error::InvalidParameter`] where the numbers do not belong together.
    pub fn from_parts(params: &GroundParams, report: GroundReport, parts: GroundParts) -> Result<Self> {
        let GroundParts { points, triangles, large, squares: [x, y, side, columns, rows], starts, .. } = parts;
        let squares = Squares { low: [x, y], side, last: [columns, rows] };
        // no more squares than points: see `Squares::over`
        let max = points.len() as f64;
        if ![columns, rows].iter().all(|last| (0.0..=max).contains(last)) || !(side > 0.0) {
            return Err(Error::invalid(Parameter::Ground, "damaged", "an index over squares"));
        }
        let (expected, found) = (squares.count() + 1, starts.len());
        if expected != found {
            return Err(Error::LengthMismatch { what: "squares of ground", expected, found });
        }
        let start = |start: u64| usize::try_from(start).unwrap_or(usize::MAX);
        let starts_of = |column: usize| starts.iter().map(|starts| start(starts[column])).collect();
        let of_squares = BySquare::from_parts(starts_of(0), parts.triangles_of_squares)?;
        let points_of_squares = BySquare::from_parts(starts_of(1), parts.points_of_squares)?;
        let returns = BySquare::from_parts(starts_of(2), parts.returns)?;
        let is_row = |row: &u32| (*row as usize) < points.len();
        let is_number = |number: &u32| (*number as usize) < triangles.len();
        if !(triangles.as_flattened().par_iter().all(is_row)
            && points_of_squares.items.par_iter().all(is_row)
            && of_squares.items.par_iter().chain(&large).all(is_number))
        {
            return Err(Error::invalid(Parameter::Ground, "damaged", "an index with triangles of its points"));
        }
        let (params, nearest) = (*params, OnceLock::new());
        Ok(Self { params, report, points, nearest, squares, triangles, of_squares, large, points_of_squares, returns })
    }

    /// Returns the parameters of the ground.
    #[must_use]
    pub fn params(&self) -> &GroundParams {
        &self.params
    }

    /// [`Ground::of_cloud`] on `grid`.
    ///
    /// # Errors
    /// [`belvedere_data::Error::Cancelled`].
    pub fn make(&self, grid: MapGrid, control: &Control<'_>) -> Result<(Ground, GroundReport)> {
        let (low, high) = (grid.corner_at([0, grid.height]), grid.corner_at([grid.width, 0]));
        let mut numbers = self.large.clone();
        numbers.extend(self.of_squares.items_within(&self.squares, low, high));
        // in the order of the whole: a cell on a side takes the height of the last
        numbers.sort_unstable();
        numbers.dedup();
        let triangles = numbers.iter().map(|&number| self.triangles[number as usize].map(|row| row as usize));
        let heights = triangulate::heights_of(triangles, &self.points, &grid);
        let ground = self.near_points((grid, heights), [low, high], control)?;
        let gap = self.params.max_gap_from_returns;
        let near = self.returns.items_within(&self.squares, low.map(|v| v - gap), high.map(|v| v + gap));
        let near = cells_near_returns(near.map(|place| place.map(f64::from)), &grid, gap);
        Ok(ground.known_near_returns(&near, self.report))
    }
}

impl GroundBySquares {
    /// [`Ground::near_points`] for a grid between two corners: among the points around it, and among all where a cell
    /// has none there.
    fn near_points(
        &self,
        (grid, heights): (MapGrid, Raster<f32>),
        [low, high]: [[f64; 2]; 2],
        control: &Control<'_>,
    ) -> Result<Ground> {
        let within = [low.map(|v| v - NEAR), high.map(|v| v + NEAR)];
        let mut rows: Vec<u32> = self.points_of_squares.items_within(&self.squares, within[0], within[1]).collect();
        // of equally near points the first of all counts
        rows.sort_unstable();
        let points: Vec<[f32; 3]> = rows.iter().map(|&row| self.points[row as usize]).collect();
        let around = NeighborIndex::new(&super::on_map(&points), control)?;
        let reach = self.params.reach;
        let ground = Ground::near_points(&points, &around, (grid, heights.clone()), reach, control)?;
        if ground.gaps.values().iter().all(|gap| f64::from(*gap) < NEAR) {
            return Ok(ground);
        }
        let nearest = match self.nearest.get() {
            Some(nearest) => nearest,
            None => {
                let made = NeighborIndex::new(&super::on_map(&self.points), control)?;
                self.nearest.get_or_init(|| made)
            }
        };
        Ground::near_points(&self.points, nearest, (grid, heights), reach, control)
    }
}

/// Squares over ground points, rows from the south; places outside them belong to the nearest outermost square.
struct Squares {
    low: [f64; 2],
    side: f64,
    /// Columns and rows less one.
    last: [f64; 2],
}

impl Squares {
    fn over(points: &[[f32; 3]]) -> Self {
        let [low, high] = box_around(points.iter().map(|&[x, y, _]| [x, y].map(f64::from)));
        let size = [0, 1].map(|axis| (high[axis] - low[axis]).max(0.0));
        let share = POINTS_OF_SQUARE / points.len().max(1) as f64;
        // no more squares than points, even in one line
        let side = (size[0] * size[1] * share).sqrt().max(size[0].max(size[1]) * share).max(f64::MIN_POSITIVE);
        Self { low, side, last: size.map(|size| (size / side).floor()) }
    }

    fn at(&self, place: f64, axis: usize) -> u32 {
        to_u32(((place - self.low[axis]) / self.side).clamp(0.0, self.last[axis]))
    }

    fn number(&self, [column, row]: [u32; 2]) -> u32 {
        let columns = to_u32(self.last[0]) + 1;
        row * columns + column
    }

    fn of(&self, place: [f64; 2]) -> u32 {
        self.number([0, 1].map(|axis| self.at(place[axis], axis)))
    }

    /// The columns and rows that a box reaches into.
    fn squares_between(&self, low: [f64; 2], high: [f64; 2]) -> [RangeInclusive<u32>; 2] {
        [0, 1].map(|axis| self.at(low[axis], axis)..=self.at(high[axis], axis))
    }

    fn count(&self) -> usize {
        let [columns, rows] = self.last.map(|last| to_index(last) + 1);
        columns * rows
    }
}

/// Items by square.
struct BySquare<T> {
    /// First item of each square, and the number of items after the last square.
    starts: Vec<usize>,
    items: Vec<T>,
}

impl<T: Copy + Send> BySquare<T> {
    /// Sorts items, each with its square.
    fn new(squares: &Squares, mut items: Vec<(u32, T)>) -> Self {
        items.par_sort_unstable_by_key(|(square, _)| *square);
        let mut starts = vec![0; squares.count() + 1];
        for (square, _) in &items {
            starts[*square as usize + 1] += 1;
        }
        for square in 1..starts.len() {
            starts[square] += starts[square - 1];
        }
        Self { starts, items: items.into_iter().map(|(_, item)| item).collect() }
    }

    fn from_parts(starts: Vec<usize>, items: Vec<T>) -> Result<Self> {
        let (expected, found) = (starts.last().copied().unwrap_or_default(), items.len());
        if expected != found || !starts.is_sorted() {
            return Err(Error::LengthMismatch { what: "items of squares", expected, found });
        }
        Ok(Self { starts, items })
    }

    /// Returns the items in the squares that a box reaches into.
    fn items_within(&self, squares: &Squares, low: [f64; 2], high: [f64; 2]) -> impl Iterator<Item = T> + Clone {
        let [columns, rows] = squares.squares_between(low, high);
        let of_row = |row| {
            let [first, last] = [*columns.start(), *columns.end()].map(|column| squares.number([column, row]) as usize);
            self.items.get(self.starts[first]..self.starts[last + 1]).unwrap_or_default()
        };
        rows.map(of_row).collect::<Vec<&[T]>>().into_iter().flatten().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::cast::to_f32;
    use belvedere_data::random::uniform;

    /// Ground with a hole and a block on it, a cleared place, and a point far away.
    fn cloud() -> PointCloud {
        let place = |i: u64| [0, 1].map(|axis| to_f32(120.0 * uniform(7, 2 * i + axis)));
        let places = (0..20_000).map(place).filter(|[x, y]| (x - 80.0).hypot(y - 80.0) > 15.0);
        let is_block = |[x, y]: [f32; 2]| (20.0..40.0).contains(&x) && (30.0..50.0).contains(&y);
        let point = |[x, y]: [f32; 2]| [x, y, if is_block([x, y]) { 9.0 } else { 0.05 * x + (0.3 * y).sin() }];
        let mut positions: Vec<[f32; 3]> = places.map(point).collect();
        positions.push([900.0, -300.0, 4.0]);
        let classes = positions.iter().map(|p| if is_block([p[0], p[1]]) { 6 } else { 2 }).collect();
        let mut cloud = PointCloud { positions, ..PointCloud::default() };
        cloud.attributes.classification = Some(classes);
        cloud.cleared_places.push([80.0, 80.0]);
        cloud
    }

    fn bits(raster: &Raster<f32>) -> Vec<u32> {
        raster.values().iter().map(|value| value.to_bits()).collect()
    }

    #[test]
    fn a_few_cells_are_those_of_the_whole_bit_by_bit() {
        let cloud = cloud();
        for points in [super::super::GroundPoints::Classed, super::super::GroundPoints::Found] {
            let params = GroundParams { points, ..GroundParams::default() };
            let (report, parts) = GroundBySquares::new(&cloud, &params, &Control::none()).unwrap().to_parts();
            let mut damaged = parts.clone();
            damaged.triangles[7][1] = u32::MAX;
            assert!(GroundBySquares::from_parts(&params, report, damaged).is_err());
            let damaged = GroundParts { squares: [0.0, 0.0, 1.0, 1e300, f64::NAN], ..parts.clone() };
            assert!(GroundBySquares::from_parts(&params, report, damaged).is_err());
            let kept = GroundBySquares::from_parts(&params, report, parts).unwrap();
            let mut known = 0;
            for (number, cell) in (0..16).zip([0.25, 0.5, 1.7, 6.0].into_iter().cycle()) {
                let middle = [0, 1].map(|axis| 170.0 * uniform(8, 2 * number + axis) - 25.0);
                let (low, high) = (middle.map(|v| v - 4.0), middle.map(|v| v + 6.0));
                let grid = MapGrid::covering(low, high, cell, [0.3, 0.2]).unwrap();
                let expected = Ground::of_cloud(&cloud, grid, &params, &Control::none()).unwrap();
                let found = kept.make(grid, &Control::none()).unwrap();
                assert_eq!(bits(&found.0.heights), bits(&expected.0.heights), "{grid:?}");
                assert_eq!(bits(&found.0.gaps), bits(&expected.0.gaps), "{grid:?}");
                assert_eq!(found.1, expected.1);
                known += found.1.cell_count;
            }
            assert!(known > 400);
        }
    }

    #[test]
    fn points_in_one_line_and_a_single_one_have_few_squares() {
        let line: Vec<[f32; 3]> = (0_u8..200).map(|i| [f32::from(i), 0.0, 0.0]).collect();
        for points in [&line[..], &line[..1]] {
            let squares = Squares::over(points);
            assert!((squares.last[0] + 1.0) * (squares.last[1] + 1.0) <= points.len() as f64);
        }
    }
}
