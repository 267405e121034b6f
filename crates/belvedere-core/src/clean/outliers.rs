//! Points that are alone: birds, and echoes that took a detour.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::duplicates::remove_sorted;
use super::grid::{SortedGrid, squared_distance};
use belvedere_data::control::{Control, Stop};
use belvedere_data::{Error, Parameter, Result};

/// Points whose nearest neighbour is looked for to learn the spacing: their median is known to a few per cent.
const SPACING_SAMPLE_COUNT: usize = 2000;

/// The nearest neighbour is looked for at up to 2 to this power times the first guess.
const SPACING_DOUBLINGS: i32 = 5;

/// Maximum height of points above and below a point that stands between them, metres. Only towers are higher, and a
/// tower has more points.
const COLUMN: f64 = 100.0;

/// Detection of isolated points: few others lie around them, and not some below and some above. A stray echo hangs in
/// the air or lies below the ground. A point of a wall has the edge of the roof above and the ground below, however few
/// pulses hit the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IsolatedPoints {
    /// Search radius for other points.
    pub radius: IsolationRadius,
    /// A point stays with this many others within the radius, at least 1. Default 2: two birds, or the two returns of
    /// one stray pulse, still go, whereas points on a wire or a sparse facade have more.
    pub min_neighbors: usize,
}

/// Search radius for the neighbours of a point that may be isolated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IsolationRadius {
    /// This many metres, above 0 and at most 1000.
    Metres(f64),
    /// A multiple of the median distance of a point to its nearest neighbour, but no less than a metre.
    ///
    /// Default: 10. A facade seen from the air has a tenth of the density of a roof, so three times its spacing; ten
    /// leaves room for wires. The metre protects terrestrial scans, whose spacing at the median range is millimetres
    /// but at the far end decimetres.
    SpacingMultiple(f64),
}

/// Minimum radius from a multiple of the spacing.
const MIN_RADIUS_M: f64 = 1.0;

impl Default for IsolatedPoints {
    fn default() -> Self {
        Self { radius: IsolationRadius::SpacingMultiple(10.0), min_neighbors: 2 }
    }
}

impl IsolatedPoints {
    pub(super) fn check(&self) -> Result<()> {
        if self.min_neighbors == 0 {
            let value = self.min_neighbors.to_string();
            return Err(Error::invalid(Parameter::NeighborCount, value, "at least 1"));
        }
        match self.radius {
            IsolationRadius::Metres(metres) => check_length(Parameter::IsolationRadius, metres),
            IsolationRadius::SpacingMultiple(multiple) if multiple > 0.0 && multiple <= 1e4 => Ok(()),
            IsolationRadius::SpacingMultiple(multiple) => Err(Error::invalid(
                Parameter::IsolationRadius,
                format!("{multiple} times the spacing"),
                "above 0 and at most 10000 times",
            )),
        }
    }

    /// The radius in metres, or `None` where the cloud has no spacing to derive it from.
    pub(super) fn radius_for(
        &self,
        positions: &[[f32; 3]],
        kept: &[u32],
        control: &Control<'_>,
    ) -> Result<Option<f64>> {
        Ok(match self.radius {
            IsolationRadius::Metres(metres) => Some(metres),
            IsolationRadius::SpacingMultiple(multiple) => {
                median_spacing(positions, kept, control)?.map(|spacing| (multiple * spacing).max(MIN_RADIUS_M))
            }
        })
    }
}

/// Removes from `kept` (ascending) the points with fewer than `min_neighbors` others within `radius` metres, and
/// returns their number. A point stays if as many lie above it, and as many below it, within this radius in plan.
/// Neighbours are counted before any point is removed, so that the order does not matter.
///
/// # Errors
/// [`Error::Cancelled`].
pub(super) fn drop_isolated(
    positions: &[[f32; 3]],
    kept: &mut Vec<u32>,
    radius: f64,
    min_neighbors: usize,
    control: &Control<'_>,
) -> Result<usize> {
    let grid = SortedGrid::new(positions, kept, radius);
    control.check()?;
    let stop = Stop::new(control);
    let alone: Vec<u32> = kept
        .par_iter()
        .copied()
        .filter(|&i| {
            if stop.is_set() {
                return false;
            }
            let mut found = 0;
            let p = positions[i as usize];
            grid.visit_near(p, radius, |other| {
                if other != i && squared_distance(p, positions[other as usize]) <= radius * radius {
                    found += 1;
                }
                if found >= min_neighbors { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
            .is_continue()
                && !is_between(positions, &grid, i, radius, min_neighbors)
        })
        .collect();
    stop.check()?;
    Ok(remove_sorted(kept, &alone))
}

/// Returns true if `count` points lie above a point, and as many below it, farther from it than `radius`, but no
/// farther in plan.
fn is_between(positions: &[[f32; 3]], grid: &SortedGrid, index: u32, radius: f64, count: usize) -> bool {
    let p = positions[index as usize];
    let [mut above, mut below] = [0, 0];
    let visited = grid.visit_within(p, [radius, radius, COLUMN], |other| {
        let q = positions[other as usize];
        let [x, y, z] = std::array::from_fn(|axis| f64::from(q[axis]) - f64::from(p[axis]));
        if x * x + y * y <= radius * radius && z.abs() <= COLUMN && x * x + y * y + z * z > radius * radius {
            above += usize::from(z > 0.0);
            below += usize::from(z < 0.0);
        }
        if above >= count && below >= count { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    visited.is_break()
}

/// Returns the median distance from a sample of points to their nearest neighbours, metres. `None` for fewer than two
/// points, or if half of them are farther apart than any guess.
fn median_spacing(positions: &[[f32; 3]], kept: &[u32], control: &Control<'_>) -> Result<Option<f64>> {
    if kept.len() < 2 {
        return Ok(None);
    }
    let sample: Vec<u32> = kept.iter().copied().step_by(kept.len().div_ceil(SPACING_SAMPLE_COUNT)).collect();
    let mut guess = spacing_guess(positions, kept, &sample);
    for _ in 0..6 {
        control.check()?;
        let grid = SortedGrid::new(positions, kept, guess);
        let mut nearest: Vec<f64> = sample.par_iter().map(|&i| nearest_distance(&grid, positions, i, guess)).collect();
        nearest.par_sort_unstable_by(f64::total_cmp);
        let median = nearest.get(nearest.len() / 2).copied().filter(|median| median.is_finite());
        if median.is_some() {
            return Ok(median);
        }
        guess *= 2.0_f64.powi(SPACING_DOUBLINGS);
    }
    Ok(None)
}

/// Spacing if the points lay evenly on the map, judged by the middle nine tenths so that a stray point does not count.
fn spacing_guess(positions: &[[f32; 3]], kept: &[u32], sample: &[u32]) -> f64 {
    let extent = |axis: usize| {
        let mut values: Vec<f32> = sample.iter().map(|&i| positions[i as usize][axis]).collect();
        values.sort_unstable_by(f32::total_cmp);
        let at = |twentieths: usize| values.get((values.len() - 1) * twentieths / 20).copied().unwrap_or(0.0);
        f64::from(at(19)) - f64::from(at(1))
    };
    let mut sides = [extent(0), extent(1), extent(2)];
    sides.sort_unstable_by(f64::total_cmp);
    let guess = 0.5 * (sides[1] * sides[2] / kept.len() as f64).sqrt();
    if guess.is_finite() { guess.clamp(1e-4, 1e4) } else { 1.0 }
}

fn nearest_distance(grid: &SortedGrid, positions: &[[f32; 3]], index: u32, guess: f64) -> f64 {
    let p = positions[index as usize];
    for doubling in 0..=SPACING_DOUBLINGS {
        let radius = guess * 2.0_f64.powi(doubling);
        let mut min = f64::INFINITY;
        let _ = grid.visit_near(p, radius, |other| {
            if other != index {
                min = min.min(squared_distance(p, positions[other as usize]));
            }
            ControlFlow::Continue(())
        });
        if min <= radius * radius {
            return min.sqrt();
        }
    }
    f64::INFINITY
}
/// Refuses a distance that is not above 0 and at most 1000 metres.
pub(super) fn check_length(parameter: Parameter, metres: f64) -> Result<()> {
    if metres > 0.0 && metres <= 1000.0 {
        return Ok(());
    }
    Err(Error::invalid(parameter, metres, "above 0 and at most 1000 metres"))
}
