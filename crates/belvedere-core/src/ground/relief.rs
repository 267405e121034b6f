//! The highest point of each cell, for maps.

use super::{Ground, MapGrid};
use belvedere_data::raster::Raster;

/// The highest point of each cell of a grid, of points that come part by part.
pub struct HighestPoints {
    grid: MapGrid,
    heights: Raster<f32>,
}

impl HighestPoints {
    /// Creates a grid without points.
    #[must_use]
    pub fn new(grid: MapGrid) -> Self {
        Self { grid, heights: Raster::filled(grid.width, grid.height, f32::NAN) }
    }

    /// Adds points, (N, 3) local metres.
    pub fn add(&mut self, positions: &[[f32; 3]]) {
        for p in positions {
            if let Some([column, row]) = self.grid.cell_of([f64::from(p[0]), f64::from(p[1])])
                && let Some(value) = self.heights.values_mut().get_mut(row * self.grid.width + column)
                && !(*value >= p[2])
            {
                *value = p[2];
            }
        }
    }

    /// The heights, local metres: in cells without a point the mean of the filled neighbours, else the value of
    /// `fallback` for the cell of that number.
    #[must_use]
    pub fn filled(self, fallback: impl Fn(usize) -> f32) -> Raster<f32> {
        let Self { grid, heights: mut highest } = self;
        let sparse = highest.clone();
        for row in 0..grid.height {
            for column in 0..grid.width {
                let at = row * grid.width + column;
                if !sparse.values()[at].is_nan() {
                    continue;
                }
                let (mut sum, mut count) = (0.0, 0.0);
                for r in row.saturating_sub(1)..=row + 1 {
                    for c in column.saturating_sub(1)..=column + 1 {
                        if let Some(value) = sparse.get(c, r).filter(|v| !v.is_nan()) {
                            sum += value;
                            count += 1.0;
                        }
                    }
                }
                highest.values_mut()[at] = if count > 0.0 { sum / count } else { fallback(at) };
            }
        }
        highest
    }
}

/// Returns the height of the highest of `positions`, (N, 3) local metres, in each cell of `ground`. Cells without any
/// have the mean of the filled neighbours, else the ground, NaN if that is not known.
#[must_use]
pub fn highest_points(positions: &[[f32; 3]], ground: &Ground) -> Raster<f32> {
    let mut highest = HighestPoints::new(ground.grid);
    highest.add(positions);
    highest.filled(|cell| ground.heights.values().get(cell).copied().unwrap_or(f32::NAN))
}

/// Minimum distance to the next ground point for a cell to count as hidden, metres: a few spacings of usual airborne
/// surveys.
const HIDDEN_GAP: f32 = 1.0;
/// Minimum height of the object that hides it, metres: more than cars and hedges.
const HIDDEN_BELOW: f32 = 2.0;

/// Flags the cells of `ground` whose ground no survey saw, (cells): no ground point lies within a metre, and something
/// of more than 2 m stands there. Most lie under buildings, where a height of the ground is no place for a target.
#[must_use]
pub fn hidden_ground(positions: &[[f32; 3]], ground: &Ground) -> Vec<bool> {
    let highest = highest_points(positions, ground);
    let cells = ground.heights.values().iter().zip(ground.gaps.values()).zip(highest.values());
    cells.map(|((height, gap), highest)| *gap > HIDDEN_GAP && highest - height > HIDDEN_BELOW).collect()
}
