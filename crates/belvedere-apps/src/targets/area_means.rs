//! Measures of the cells of a grid, summed up over areas such as parcels.

use super::{Measure, Targets};
use belvedere_core::ground::MapGrid;
use belvedere_data::cast::to_index;
use belvedere_data::polygon::PolygonIndex;
use belvedere_data::{Error, Result};
use std::ops::Range;

/// Digits of means beyond those of the values.
const FURTHER_DECIMALS: usize = 2;

/// Measures over the cells of an area.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AreaMeans {
    /// Number of cells of which the first measure has a value.
    pub cells: usize,
    /// Mean of each measure, and the least and greatest value of the first.
    pub results: Vec<AreaResult>,
}

/// One figure of an area.
#[derive(Clone, Debug, PartialEq)]
pub struct AreaResult {
    /// Name of its column.
    pub name: String,
    /// Digits after the point.
    pub decimals: usize,
    /// NaN where no cell has a value.
    pub value: f64,
}

impl AreaMeans {
    /// Returns the means of `measures` over the cells whose middle lies in an area: polygons, each an outline and its
    /// holes, on the map in local metres. Cells without a value do not count.
    ///
    /// # Errors
    /// [`Error::UnsupportedTargets`] for targets that are no cells.
    pub fn of(area: &[Vec<Vec<[f64; 2]>>], targets: &Targets, measures: &[Measure]) -> Result<Self> {
        let Some(ground) = targets.ground() else {
            return Err(Error::UnsupportedTargets { method: "areas", what: "they sum up the cells of a grid" });
        };
        let cells: Vec<usize> =
            cells_in(area, &ground.grid).into_iter().filter(|&cell| targets.is_target(cell)).collect();
        let mut found = Self::default();
        for (number, measure) in measures.iter().enumerate() {
            let values = || cells.iter().map(|&cell| f64::from(measure.values[cell])).filter(|value| !value.is_nan());
            let count = values().count();
            let mean = if count > 0 { values().sum::<f64>() / count as f64 } else { f64::NAN };
            found.add(&measure.name, measure.decimals + FURTHER_DECIMALS, mean);
            if number == 0 {
                found.cells = count;
                found.add(&format!("{}_min", measure.name), measure.decimals, values().fold(f64::NAN, f64::min));
                found.add(&format!("{}_max", measure.name), measure.decimals, values().fold(f64::NAN, f64::max));
            }
        }
        Ok(found)
    }

    fn add(&mut self, name: &str, decimals: usize, value: f64) {
        self.results.push(AreaResult { name: name.to_owned(), decimals, value });
    }
}

/// Returns the cells of a grid whose middle lies in an area, row by row.
fn cells_in(area: &[Vec<Vec<[f64; 2]>>], grid: &MapGrid) -> Vec<usize> {
    let index = PolygonIndex::of_polygons(area.iter().map(Vec::as_slice));
    let end = |axis: usize, pick: fn(f64, f64) -> f64| {
        area.iter().flatten().flatten().map(|corner| corner[axis]).fold(f64::NAN, pick)
    };
    let columns = [end(0, f64::min), end(0, f64::max)].map(|x| (x - grid.corner[0]) / grid.cell);
    let rows = [end(1, f64::max), end(1, f64::min)].map(|y| (grid.corner[1] - y) / grid.cell);
    let (columns, rows) = (whole_range(columns, grid.width), whole_range(rows, grid.height));
    rows.flat_map(|row| columns.clone().map(move |column| [column, row]))
        .filter(|&[column, row]| index.holds(grid.center(column, row)))
        .map(|[column, row]| row * grid.width + column)
        .collect()
}

/// Returns the columns or rows that a range touches, of `count`; none for NaN.
fn whole_range([low, high]: [f64; 2], count: usize) -> Range<usize> {
    let [low, high] = [low.floor(), high.ceil()].map(|end| to_index(end).min(count));
    low..high
}
