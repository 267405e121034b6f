//! The land that may be built on, cut into the columns of a grid.

use super::convex::ConvexPolygon;
use belvedere_core::ground::MapGrid;
use belvedere_data::cast::to_index;
use belvedere_data::polygon::simple_rings;
use belvedere_data::{Error, Parameter, Result};

/// Maximum number of corners of a parcel: more are a damaged file, and each cell is cut at all of their heights.
const MAX_CORNERS: usize = 10_000;
/// Minimum area of a parcel, m²: below it the corners lie in a line.
const MIN_AREA: f64 = 0.01;
/// Strips and pieces thinner than this are rounding, metres.
const THIN: f64 = 1e-9;

/// The land that may be built on: one or several areas, with or without holes.
#[derive(Clone, Debug, PartialEq)]
pub struct Parcel {
    rings: Vec<Vec<[f64; 2]>>,
}

/// The part of a cell of a grid that lies on a parcel.
#[derive(Clone, Debug, PartialEq)]
pub struct ParcelCell {
    /// Number of the cell, rows from the north.
    pub cell: usize,
    /// Pieces that make it up: the square itself where the cell lies wholly on the parcel.
    pub pieces: Vec<ConvexPolygon>,
    /// Their area, m².
    pub area: f64,
    /// True if the cell lies wholly on the parcel.
    pub is_whole: bool,
}

impl Parcel {
    /// Creates the parcel within `rings`, local metres in plan. Each ring is an outline or a hole, of any orientation,
    /// with the first corner repeated at the end or not. The inside of an odd number of rings belongs to it.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a corner that is not finite, a ring with less than three corners, sides that
    /// cross each other, more than 10 000 corners, and rings that enclose nothing.
    pub fn new(rings: &[Vec<[f64; 2]>]) -> Result<Self> {
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::Parcel, value, expected));
        let count: usize = rings.iter().map(Vec::len).sum();
        if count == 0 || count > MAX_CORNERS {
            return invalid(format!("of {count} corners"), "a polygon of 3 to 10 000 corners");
        }
        let parcel = match simple_rings(rings) {
            Ok(rings) => Self { rings },
            Err(fault) => return Err(fault.refusal(Parameter::Parcel)),
        };
        // sides that run over each other cancel by pairs, as do the strips below
        let area = parcel.area();
        if !(area >= MIN_AREA) {
            return invalid(format!("of {area} m2"), "an area: its corners must not lie in one line");
        }
        Ok(parcel)
    }

    /// Lowest and highest corner of the box around it, local metres.
    #[must_use]
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for corner in self.rings.iter().flatten() {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(corner[axis]);
                bounds[1][axis] = bounds[1][axis].max(corner[axis]);
            }
        }
        bounds
    }

    /// Area, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        let [low, high] = self.bounds();
        self.trapezoids(low[1], high[1]).iter().map(ConvexPolygon::area).sum()
    }

    /// Its rings, the first corner not repeated, local metres.
    #[must_use]
    pub fn rings(&self) -> &[Vec<[f64; 2]>] {
        &self.rings
    }

    /// The cells of `grid` that have a part on the parcel, in their order.
    #[must_use]
    pub fn footprints(&self, grid: &MapGrid) -> Vec<ParcelCell> {
        let mut footprints = Vec::new();
        let cell_area = grid.cell * grid.cell;
        for row in 0..grid.height {
            let [_, north] = grid.corner_at([0, row]);
            let [_, south] = grid.corner_at([0, row + 1]);
            let mut cells: Vec<Vec<ConvexPolygon>> = vec![Vec::new(); grid.width];
            for trapezoid in self.trapezoids(south, north) {
                let [west, east] = trapezoid.span(0).map(|x| (x - grid.corner[0]) / grid.cell);
                let [first, last] = [west.floor(), east.ceil()].map(to_index);
                for (column, cell) in cells.iter_mut().enumerate().take(last).skip(first) {
                    let [west, _] = grid.corner_at([column, row]);
                    let [east, _] = grid.corner_at([column + 1, row]);
                    let part = trapezoid.clipped(|p| p[0] - west).clipped(|p| east - p[0]);
                    if part.area() > THIN * grid.cell {
                        cell.push(part);
                    }
                }
            }
            for (column, mut pieces) in cells.into_iter().enumerate().filter(|(_, pieces)| !pieces.is_empty()) {
                let mut area: f64 = pieces.iter().map(ConvexPolygon::area).sum();
                let is_whole = area > cell_area * (1.0 - THIN);
                if is_whole {
                    let ([west, _], [east, _]) = (grid.corner_at([column, row]), grid.corner_at([column + 1, row]));
                    pieces = vec![ConvexPolygon::of_box([west, south], [east, north])];
                    area = cell_area;
                }
                footprints.push(ParcelCell { cell: row * grid.width + column, pieces, area, is_whole });
            }
        }
        footprints
    }

    fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        self.rings.iter().flat_map(|ring| (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]))
    }

    /// The part between two northings as trapezoids with level sides: between two heights of corners no two sides
    /// cross, so that every second gap between them is inside.
    fn trapezoids(&self, south: f64, north: f64) -> Vec<ConvexPolygon> {
        let mut levels: Vec<f64> =
            self.rings.iter().flatten().map(|corner| corner[1]).filter(|y| (south..north).contains(y)).collect();
        levels.extend([south, north]);
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let mut found = Vec::new();
        for pair in levels.windows(2) {
            let &[low, high] = pair else { continue };
            if high - low < THIN {
                continue;
            }
            let mut crossings: Vec<[f64; 2]> = self
                .sides()
                .filter(|[a, b]| a[1].min(b[1]) <= low && a[1].max(b[1]) >= high)
                .map(|[a, b]| {
                    let at = |y: f64| a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                    [at(low), at(high)]
                })
                .collect();
            crossings.sort_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
            for sides in crossings.as_chunks::<2>().0 {
                let [[a, d], [b, c]] = *sides;
                found.push(ConvexPolygon::new(&[[a, low], [b, low], [c, high], [d, high]]));
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> MapGrid {
        MapGrid { corner: [-2.0, 12.0], cell: 1.0, width: 14, height: 14 }
    }

    fn ring(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
        corners.to_vec()
    }

    #[test]
    fn footprints_add_up_to_the_area_of_the_parcel() {
        let outline = ring(&[[0.3, 0.2], [9.7, 1.1], [8.2, 9.4], [5.0, 4.0], [1.1, 8.8]]);
        let hole = ring(&[[3.0, 2.0], [3.5, 3.5], [4.5, 2.2]]);
        // shoelace formula, by hand of the test
        let shoelace = |ring: &[[f64; 2]]| {
            let sum: f64 = (0..ring.len())
                .map(|i| {
                    let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                    a[0] * b[1] - a[1] * b[0]
                })
                .sum();
            (sum / 2.0).abs()
        };
        let expected = shoelace(&outline) - shoelace(&hole);
        let parcel = Parcel::new(&[outline, hole]).unwrap();
        let footprints = parcel.footprints(&grid());
        let area: f64 = footprints.iter().map(|f| f.area).sum();
        assert!((area - expected).abs() < 1e-6 && (parcel.area() - expected).abs() < 1e-9, "{area} {expected}");
        for footprint in &footprints {
            let pieces: f64 = footprint.pieces.iter().map(ConvexPolygon::area).sum();
            assert!((pieces - footprint.area).abs() < 1e-9 && footprint.area <= 1.0 + 1e-9);
            assert!(!footprint.is_whole || footprint.pieces.len() == 1);
        }
        assert!(footprints.iter().any(|f| f.is_whole) && footprints.iter().any(|f| !f.is_whole));
    }

    #[test]
    fn what_is_no_parcel_is_refused_with_the_reason() {
        let refused = |rings: &[Vec<[f64; 2]>]| Parcel::new(rings).unwrap_err().to_string();
        assert!(refused(&[]).contains("0 corners"));
        assert!(refused(&[ring(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]])]).contains("2 corners"));
        assert!(refused(&[ring(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]])]).contains("one line"));
        assert!(refused(&[ring(&[[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]])]).contains("crossing itself"));
        assert!(refused(&[ring(&[[0.0, 0.0], [4.0, f64::NAN], [4.0, 0.0]])]).contains("finite"));
        assert!(refused(&[ring(&[[0.0, 0.0], [f64::INFINITY, 1.0], [4.0, 0.0]])]).contains("finite"));
        // a hole that crosses the outline
        let outline = ring(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        let hole = ring(&[[3.0, 1.0], [5.0, 1.0], [5.0, 2.0], [3.0, 2.0]]);
        assert!(refused(&[outline, hole]).contains("crossing itself"));
        assert!(refused(&[vec![[0.0, 0.0]; 200]]).contains("1 corners"));
        assert!(refused(&[vec![[0.0, 0.0]; 20_000]]).contains("20000 corners"));
    }
}
