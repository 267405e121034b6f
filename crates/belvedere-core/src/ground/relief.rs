//! The highest point of each cell, for maps.

use super::Ground;
use belvedere_data::raster::Raster;

/// Height of the highest of `positions`, (N, 3) local metres, in each cell of `ground`; in cells without any the mean
/// of the filled neighbours, else the ground, NaN where that is not known.
#[must_use]
pub fn highest_points(positions: &[[f32; 3]], ground: &Ground) -> Raster<f32> {
    let grid = ground.grid;
    let mut highest = Raster::filled(grid.width, grid.height, f32::NAN);
    for p in positions {
        if let Some([column, row]) = grid.cell_of([f64::from(p[0]), f64::from(p[1])])
            && let Some(value) = highest.values_mut().get_mut(row * grid.width + column)
            && !(*value >= p[2])
        {
            *value = p[2];
        }
    }
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
            let fallback = ground.heights.values().get(at).copied().unwrap_or(f32::NAN);
            highest.values_mut()[at] = if count > 0.0 { sum / count } else { fallback };
        }
    }
    highest
}

/// Least distance to the next ground point for a cell to count as hidden, metres: a few spacings of usual airborne
/// surveys.
const HIDDEN_GAP: f32 = 1.0;
/// Least height of what hides it, metres: more than cars and hedges.
const HIDDEN_BELOW: f32 = 2.0;

/// Which cells of `ground` no survey saw the ground of: nothing was measured on it within a metre, and something of
/// more than 2 m stands there, (cells). Mostly these lie under buildings, where a height of the ground is no place.
#[must_use]
pub fn hidden_ground(positions: &[[f32; 3]], ground: &Ground) -> Vec<bool> {
    let highest = highest_points(positions, ground);
    let cells = ground.heights.values().iter().zip(ground.gaps.values()).zip(highest.values());
    cells.map(|((height, gap), highest)| *gap > HIDDEN_GAP && highest - height > HIDDEN_BELOW).collect()
}
