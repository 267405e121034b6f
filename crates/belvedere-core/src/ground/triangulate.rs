//! Heights between scattered points: linear in each triangle of their Delaunay triangulation.

use super::MapGrid;
use belvedere_data::cast::to_index;
use belvedere_data::raster::Raster;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};
use delaunator::{EMPTY, Point, triangulate};

/// Returns the height at the middle of each cell of `grid` on the triangulated `points`, (N, 3) local metres. NaN
/// outside their convex hull, and everywhere with fewer than three points or all in one line.
///
/// # Errors
/// [`Error::InvalidParameter`] for a point that is not finite.
pub(super) fn heights(points: &[[f32; 3]], grid: &MapGrid) -> Result<Raster<f32>> {
    Ok(heights_of(triangles(points)?.as_chunks::<3>().0.iter().copied(), points, grid))
}

/// The Delaunay triangles of `points`, (N, 3) local metres, in plan: the rows of their corners, three each. None for
/// fewer than three points or all in one line.
///
/// # Errors
/// [`Error::InvalidParameter`] for a point that is not finite.
pub(super) fn triangles(points: &[[f32; 3]]) -> Result<Vec<usize>> {
    if let Some(p) = points.iter().find(|p| !p.iter().all(|v| v.is_finite())) {
        return Err(Error::invalid(Parameter::Position, format!("{p:?}"), "finite"));
    }
    let on_map: Vec<Point> = points.iter().map(|p| Point { x: f64::from(p[0]), y: f64::from(p[1]) }).collect();
    Ok(triangulate(&on_map).triangles)
}

/// Height at the middle of each cell of `grid` on some `triangles` of `points`, given by the rows of their corners; of
/// several at one place the last counts.
pub(super) fn heights_of(
    triangles: impl IntoIterator<Item = [usize; 3]>,
    points: &[[f32; 3]],
    grid: &MapGrid,
) -> Raster<f32> {
    let mut heights = Raster::filled(grid.width, grid.height, f32::NAN);
    for [a, b, c] in triangles {
        let (Some(&a), Some(&b), Some(&c)) = (points.get(a), points.get(b), points.get(c)) else { continue };
        fill(heights.values_mut(), grid.width, grid, [a, b, c].map(|p| p.map(f64::from)));
    }
    heights
}

/// The sides of the Delaunay triangulation of places in plan, (N, 2), each by the rows of its ends. None for fewer than
/// three places or all in one line.
pub(crate) fn sides(places: &[[f64; 2]]) -> Vec<[usize; 2]> {
    let points: Vec<Point> = places.iter().map(|&[x, y]| Point { x, y }).collect();
    let found = triangulate(&points);
    let mut sides = Vec::with_capacity(found.triangles.len() / 2 + 1);
    for (side, (&start, &twin)) in found.triangles.iter().zip(&found.halfedges).enumerate() {
        let next = if side % 3 == 2 { side - 2 } else { side + 1 };
        if let Some(&end) = found.triangles.get(next).filter(|_| twin == EMPTY || twin > side) {
            sides.push([start, end]);
        }
    }
    sides
}

/// Sets the cells whose middles lie in a triangle or on its edges.
fn fill(heights: &mut [f32], width: usize, grid: &MapGrid, [a, b, c]: [[f64; 3]; 3]) {
    let doubled_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if doubled_area == 0.0 {
        return;
    }
    let min = |axis: usize| a[axis].min(b[axis]).min(c[axis]);
    let max = |axis: usize| a[axis].max(b[axis]).max(c[axis]);
    let columns = cells((min(0) - grid.corner[0]) / grid.cell, (max(0) - grid.corner[0]) / grid.cell, grid.width);
    let rows = cells((grid.corner[1] - max(1)) / grid.cell, (grid.corner[1] - min(1)) / grid.cell, grid.height);
    for row in rows {
        for column in columns.clone() {
            let [x, y] = grid.center(column, row);
            let v = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / doubled_area;
            let w = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / doubled_area;
            let u = 1.0 - v - w;
            // a middle on an edge belongs to both triangles, also where rounding moves it off both
            if u >= -1e-9 && v >= -1e-9 && w >= -1e-9 {
                let height = to_f32(u * a[2] + v * b[2] + w * c[2]);
                if let Some(value) = heights.get_mut(row * width + column) {
                    *value = height;
                }
            }
        }
    }
}

/// Cells whose middles lie between two positions, in cells.
fn cells(from: f64, to: f64, count: usize) -> std::ops::Range<usize> {
    let last = count as f64;
    let cell = |v: f64| to_index(v.clamp(0.0, last));
    cell((from - 0.5).ceil())..cell((to - 0.5).floor() + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::random::uniform;

    #[test]
    fn a_plane_comes_back_and_beyond_the_hull_there_is_nothing() {
        let points: Vec<[f32; 3]> = (0..500)
            .map(|i| {
                let (x, y) = (40.0 * uniform(1, 2 * i), 40.0 * uniform(1, 2 * i + 1));
                [to_f32(x), to_f32(y), to_f32(0.1 * x - 0.3 * y)]
            })
            .collect();
        let grid = MapGrid::covering([-5.0; 2], [45.0; 2], 0.5, [0.0; 2]).unwrap();
        let heights = heights(&points, &grid).unwrap();
        let mut known = 0;
        for row in 0..grid.height {
            for column in 0..grid.width {
                let ([x, y], height) = (grid.center(column, row), heights.get(column, row).unwrap());
                let inside = (3.0..37.0).contains(&x) && (3.0..37.0).contains(&y);
                let outside = !(0.0..=40.0).contains(&x) || !(0.0..=40.0).contains(&y);
                assert!(!inside || height.is_finite(), "{x} {y}");
                assert!(!outside || height.is_nan(), "{x} {y}");
                if height.is_finite() {
                    known += 1;
                    // f32 places of 40 m carry 2e-6 m
                    assert!((f64::from(height) - (0.1 * x - 0.3 * y)).abs() < 1e-4);
                }
            }
        }
        assert!(known > 5000);
    }

    #[test]
    fn points_in_one_line_have_no_triangles() {
        let grid = MapGrid::covering([0.0; 2], [4.0; 2], 1.0, [0.0; 2]).unwrap();
        for points in [vec![], vec![[1.0, 1.0, 0.0]], vec![[0.0; 3], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]]] {
            assert!(heights(&points, &grid).unwrap().values().iter().all(|h| h.is_nan()));
        }
        assert!(heights(&[[f32::NAN; 3]], &grid).is_err());
    }

    #[test]
    fn a_square_with_a_middle_has_eight_sides_each_once() {
        let places = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.1]];
        let mut found: Vec<[usize; 2]> = sides(&places).into_iter().map(|[a, b]| [a.min(b), a.max(b)]).collect();
        found.sort_unstable();
        assert_eq!(found, [[0, 1], [0, 3], [0, 4], [1, 2], [1, 4], [2, 3], [2, 4], [3, 4]]);
        assert!(sides(&places[..2]).is_empty() && sides(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).is_empty());
    }
}
