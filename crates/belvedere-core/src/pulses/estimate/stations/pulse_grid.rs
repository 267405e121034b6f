//! The grid of directions in which a scanner on a tripod sends its pulses.

use belvedere_data::cast::to_cell;
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Directions nearer to the zenith or nadir are left out, radians from the horizon: columns meet there.
const MAX_ELEVATION: f64 = 1.22;
/// Maximum deviation between neighbouring directions and a step of the grid, in steps.
const TOLERANCE: f64 = 0.3;
/// Maximum deviation in the last rounds, in steps.
const LAST_TOLERANCE: f64 = 0.15;
/// Rounds in which pairs are found and the station is fitted to them.
const ROUNDS: usize = 8;
/// Deviation of a pair, in steps, from which on it counts less (Huber 1964).
const HUBER: f64 = 0.1;
/// Position, tilt about two axes, and the two steps.
const UNKNOWNS: usize = 7;

/// A station, as a grid of pulses shows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct StationFit {
    /// Local metres.
    pub(super) position: [f64; 3],
    /// Steps around and up, radians.
    pub(super) steps: [f64; 2],
    /// Standard deviation of the position, metres, the root of the sum over the axes.
    pub(super) sd: f64,
}

/// Azimuth and elevation of `point` seen from a place, radians, after levelling.
fn direction(point: [f64; 3], place: [f64; 3], tilt: [f64; 2]) -> [f64; 2] {
    let [x, y, z] = [0, 1, 2].map(|i| point[i] - place[i]);
    let [x, y, z] = [x + tilt[1] * z, y - tilt[0] * z, z + tilt[0] * y - tilt[1] * x];
    [y.atan2(x), z.atan2(x.hypot(y))]
}

/// Directions of `points` from `place`, without those near the poles.
fn directions(points: &[[f64; 3]], place: [f64; 3], tilt: [f64; 2]) -> Vec<([f64; 2], usize)> {
    let seen = |(row, point): (usize, &[f64; 3])| (direction(*point, place, tilt), row);
    let is_kept = |(d, _): &([f64; 2], usize)| d[1].abs() < MAX_ELEVATION;
    points.iter().enumerate().map(seen).filter(is_kept).collect()
}

/// Number of the cell of side `side` radians that a direction lies in.
fn cell(d: [f64; 2], side: f64) -> [i32; 2] {
    [to_cell((d[0] + PI) / side), to_cell((d[1] + FRAC_PI_2) / side)]
}

fn sorted_cells(directions: &[([f64; 2], usize)], side: f64) -> Vec<[i32; 2]> {
    let mut cells: Vec<[i32; 2]> = directions.iter().map(|(d, _)| cell(*d, side)).collect();
    cells.sort_unstable();
    cells
}

/// Side of cells that hold `each` of these directions on average where they hold any, radians.
fn cell_side(directions: &[([f64; 2], usize)], each: f64) -> f64 {
    let count = directions.len().max(1) as f64;
    let coarse = (TAU * 2.0 * MAX_ELEVATION * 8.0 / count).sqrt();
    let taken = sorted_cells(directions, coarse).chunk_by(|a, b| a == b).count();
    (each * taken as f64 * coarse * coarse / count).sqrt()
}

/// Returns the crowding of the directions of `points` from `place`, in cells that hold `each` of them on average: the
/// mean number of others in a point's cell, over that of chance. It is 1 for random directions, more for preferred
/// ones, and almost 0 for a grid of pulses with one in each cell.
pub(super) fn crowding(points: &[[f64; 3]], place: [f64; 3], each: f64) -> f64 {
    let directions = directions(points, place, [0.0; 2]);
    if directions.is_empty() {
        return f64::INFINITY;
    }
    let cells = sorted_cells(&directions, cell_side(&directions, each));
    let pairs: f64 = cells.chunk_by(|a, b| a == b).map(|own| own.len() as f64 * (own.len() as f64 - 1.0)).sum();
    pairs / directions.len() as f64 / each
}

/// Share of all directions, the poles aside, that `points` fill seen from `place`.
pub(super) fn filled_share(points: &[[f64; 3]], place: [f64; 3]) -> f64 {
    let directions = directions(points, place, [0.0; 2]);
    let side = cell_side(&directions, 1.0);
    side * side * directions.len() as f64 / (TAU * 2.0 * MAX_ELEVATION)
}

/// A point and its neighbour in the grid, one step on around or up.
struct GridPair {
    rows: [usize; 2],
    is_around: bool,
}

/// The way from a direction to the next, along and beside an axis, and the row of its point.
type Next = Option<(f64, f64, usize)>;

/// The nearest direction around and the nearest up of each, and the middle of these steps.
fn pairs(
    points: &[[f64; 3]],
    place: [f64; 3],
    tilt: [f64; 2],
    tolerance: f64,
    max: usize,
) -> Option<(Vec<GridPair>, [f64; 2])> {
    let directions = directions(points, place, tilt);
    let side = cell_side(&directions, 1.0);
    let mut cells: Vec<([i32; 2], [f64; 2], usize)> =
        directions.par_iter().map(|&(d, row)| (cell(d, side), d, row)).collect();
    cells.par_sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1[0].total_cmp(&b.1[0])).then(a.1[1].total_cmp(&b.1[1])));
    let stride = cells.len().div_ceil(max / 2).max(1);
    let next = |&(at, d, row): &([i32; 2], [f64; 2], usize)| {
        let mut nearest = [Next::None; 2];
        for column in at[0] - 1..=at[0] + 2 {
            let from = cells.partition_point(|(other, ..)| *other < [column, at[1] - 2]);
            let rest = cells.get(from..).unwrap_or_default();
            for &(_, other, to) in rest.iter().take_while(|(other, ..)| *other <= [column, at[1] + 2]) {
                let way = [other[0] - d[0], other[1] - d[1]];
                for (axis, best) in nearest.iter_mut().enumerate() {
                    let (on, beside) = (way[axis], way[1 - axis]);
                    let is_next = on > 0.25 * side && beside.abs() < 0.5 * on;
                    if is_next && best.is_none_or(|(step, ..)| on < step) {
                        *best = Some((on, beside, to));
                    }
                }
            }
        }
        (row, nearest)
    };
    let found: Vec<(usize, [Next; 2])> = cells.par_iter().step_by(stride).map(next).collect();
    let middle = |axis: usize| {
        let mut steps: Vec<f64> =
            found.iter().filter_map(|(_, nearest)| nearest[axis].map(|(step, ..)| step)).collect();
        steps.sort_unstable_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied()
    };
    let steps = [middle(0)?, middle(1)?];
    let mut pairs = Vec::new();
    for (row, nearest) in found {
        for (axis, next) in nearest.into_iter().enumerate() {
            let Some((on, beside, to)) = next else { continue };
            let is_step = (on / steps[axis] - 1.0).abs() < tolerance && beside.abs() < tolerance * steps[1 - axis];
            if is_step {
                pairs.push(GridPair { rows: [row, to], is_around: axis == 0 });
            }
        }
    }
    Some((pairs, steps))
}

/// Returns the deviation of a pair from one grid step, in azimuth and elevation, in steps.
fn misfit(points: &[[f64; 3]], pair: &GridPair, unknowns: &SVector<f64, UNKNOWNS>) -> [f64; 2] {
    let place = [unknowns[0], unknowns[1], unknowns[2]];
    let [from, to] = pair.rows.map(|row| direction(points[row], place, [unknowns[3], unknowns[4]]));
    let steps = [unknowns[5], unknowns[6]];
    let mut way = [to[0] - from[0], to[1] - from[1]];
    way[usize::from(!pair.is_around)] -= steps[usize::from(!pair.is_around)];
    // what a pulse is off by across its direction counts the same at all elevations
    [way[0] / steps[0] * from[1].cos(), way[1] / steps[1]]
}

/// The station from which neighbouring directions of `points` are one step of a grid apart, from a `start` a few
/// decimetres away; `None` where none is found.
///
/// Points of one row have the same elevation, those of one column the same azimuth, and steps are everywhere the same.
/// Errors of ranges do not matter: they lie along the pulses.
///
/// # Source
/// This project's own. Gauss–Newton with the weights of Huber 1964.
pub(super) fn fit(points: &[[f64; 3]], start: [f64; 3], max_pairs: usize) -> Option<StationFit> {
    let mut unknowns = SVector::<f64, UNKNOWNS>::from_row_slice(&[start[0], start[1], start[2], 0.0, 0.0, 1.0, 1.0]);
    let mut sd = f64::INFINITY;
    let mut moved = f64::INFINITY;
    let mut tolerance = TOLERANCE;
    for _ in 0..ROUNDS {
        let (pairs, steps) =
            pairs(points, [unknowns[0], unknowns[1], unknowns[2]], [unknowns[3], unknowns[4]], tolerance, max_pairs)?;
        if pairs.len() < 10 * UNKNOWNS {
            return None;
        }
        (unknowns[5], unknowns[6]) = (steps[0], steps[1]);
        let before = unknowns;
        for _ in 0..2 {
            let (normal, right, square) = normal_equations(points, &pairs, &unknowns);
            let factor = normal.cholesky()?;
            unknowns += factor.solve(&right);
            let covariance = factor.inverse();
            let variance = square / (2 * pairs.len()) as f64;
            sd = (variance * (covariance[(0, 0)] + covariance[(1, 1)] + covariance[(2, 2)])).sqrt();
        }
        moved = (0..3).map(|i| (unknowns[i] - before[i]).powi(2)).sum::<f64>().sqrt();
        if !moved.is_finite() || moved > 1.0 || unknowns[3].hypot(unknowns[4]) > 0.2 {
            return None;
        }
        if moved < 5e-4 && tolerance < TOLERANCE {
            break;
        }
        if moved < 1e-2 {
            tolerance = LAST_TOLERANCE;
        }
    }
    (moved < 5e-3).then_some(StationFit {
        position: [unknowns[0], unknowns[1], unknowns[2]],
        steps: [unknowns[5], unknowns[6]],
        sd,
    })
}

type GridEquations = (SMatrix<f64, UNKNOWNS, UNKNOWNS>, SVector<f64, UNKNOWNS>, f64);

fn normal_equations(points: &[[f64; 3]], pairs: &[GridPair], unknowns: &SVector<f64, UNKNOWNS>) -> GridEquations {
    const SHARE: usize = 1024;
    let nudges = [1e-5, 1e-5, 1e-5, 1e-6, 1e-6, 1e-8, 1e-8];
    let of_share = |share: &[GridPair]| {
        let mut sums: GridEquations = (SMatrix::zeros(), SVector::zeros(), 0.0);
        for pair in share {
            let now = misfit(points, pair, unknowns);
            let mut slopes = [SVector::<f64, UNKNOWNS>::zeros(); 2];
            for (i, nudge) in nudges.iter().enumerate() {
                let mut other = *unknowns;
                other[i] += nudge;
                let then = misfit(points, pair, &other);
                (slopes[0][i], slopes[1][i]) = ((then[0] - now[0]) / nudge, (then[1] - now[1]) / nudge);
            }
            for (off, slope) in now.iter().zip(&slopes) {
                let weight = (HUBER / off.abs()).min(1.0);
                sums.0 += slope * slope.transpose() * weight;
                sums.1 -= slope * (weight * off);
                sums.2 += weight * off * off;
            }
        }
        sums
    };
    // shares are added in order, so that the sum does not depend on the number of threads
    let sums: Vec<GridEquations> = pairs.par_chunks(SHARE).map(of_share).collect();
    sums.into_iter().fold((SMatrix::zeros(), SVector::zeros(), 0.0), |a, b| (a.0 + b.0, a.1 + b.1, a.2 + b.2))
}
