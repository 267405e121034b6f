//! Local feature size, and thinning of a cloud by it.

use crate::neighbors::NeighborIndex;
use belvedere_data::balls::{MedialBalls, NO_TOUCH};
use belvedere_data::cast::to_i32;
use belvedere_data::control::{Control, Stop};
use belvedere_data::{Error, Parameter, Result, random};
use rayon::prelude::*;

/// Parameters of [`local_feature_size`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureSizeParams {
    /// A medial point counts if its bisector differs from those of its neighbours by less than this, radians, above 0;
    /// masbcpp: 2°.
    pub max_bisector_angle: f32,
    /// Number of neighbouring medial points for comparison, 1 to 64; masbcpp: 3.
    pub neighbor_count: usize,
}

impl Default for FeatureSizeParams {
    fn default() -> Self {
        Self { max_bisector_angle: 2f32.to_radians(), neighbor_count: 3 }
    }
}

/// Distance of each point to the medial axis, (N), metres: to the nearest centre, of any of `sides`, whose bisector
/// agrees with those around it. Infinite where no medial point is reliable.
///
/// Balls that never shrank are left out; masbcpp compares with them, and reads bisectors for them that it never wrote.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters out of range, or if a ball refers to a point that does not exist;
/// [`Error::Cancelled`].
///
/// # Source
/// Amenta & Bern 1998 (local feature size); the reliability test by bisectors is masbcpp's.
pub fn local_feature_size(
    positions: &[[f32; 3]],
    sides: &[&MedialBalls],
    params: &FeatureSizeParams,
    control: &Control<'_>,
) -> Result<Vec<f32>> {
    let stop = Stop::new(control);
    if !(params.max_bisector_angle > 0.0) {
        return Err(Error::invalid(
            Parameter::BisectorAngle,
            params.max_bisector_angle.to_degrees(),
            "above 0 degrees",
        ));
    }
    if !(1..=64).contains(&params.neighbor_count) {
        return Err(Error::invalid(Parameter::NeighborCount, params.neighbor_count, "1 to 64"));
    }
    let mut reliable = Vec::new();
    for balls in sides {
        reliable.extend(reliable_centers(positions, balls, params, control)?);
    }
    let index = NeighborIndex::new(&reliable, control)?;
    let size = |&p: &[f32; 3]| {
        let nearest = if stop.is_set() { None } else { index.nearest_within(p, f32::INFINITY) };
        nearest.map_or(f32::INFINITY, |n| n.distance_squared.sqrt())
    };
    let sizes = positions.par_iter().map(size).collect();
    stop.check()?;
    Ok(sizes)
}

fn reliable_centers(
    positions: &[[f32; 3]],
    balls: &MedialBalls,
    params: &FeatureSizeParams,
    control: &Control<'_>,
) -> Result<Vec<[f32; 3]>> {
    let stop = Stop::new(control);
    let missing = |i: u32| Error::invalid(Parameter::Ball, i, "an index into the points the balls were made from");
    let point = |i: u32| positions.get(i as usize).copied().ok_or_else(|| missing(i));
    let mut centers = Vec::new();
    let mut bisectors = Vec::new();
    for ((&center, &source), &touch) in balls.centers.iter().zip(&balls.source).zip(&balls.touch) {
        if touch == NO_TOUCH {
            continue;
        }
        let (p, q) = (point(source)?, point(touch)?);
        let sum: [f32; 3] = std::array::from_fn(|i| (p[i] - center[i]) + (q[i] - center[i]));
        let length = sum.iter().map(|v| v * v).sum::<f32>().sqrt();
        centers.push(center);
        // p and q opposite each other have no bisector; NaN agrees with nothing
        bisectors.push(sum.map(|v| v / length));
    }
    let index = NeighborIndex::new(&centers, control)?;
    let min_cosine = params.max_bisector_angle.cos();
    let agrees: Vec<bool> = (0..centers.len())
        .into_par_iter()
        .map_init(Vec::new, |found, i| {
            if stop.is_set() {
                return false;
            }
            index.k_nearest(centers[i], params.neighbor_count + 1, found);
            let others = found.iter().filter(|n| n.index as usize != i).take(params.neighbor_count);
            others.into_iter().all(|n| {
                let (a, b) = (bisectors[i], bisectors[n.index as usize]);
                a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > min_cosine
            })
        })
        .collect();
    stop.check()?;
    Ok(centers.into_iter().zip(agrees).filter_map(|(center, agrees)| agrees.then_some(center)).collect())
}

/// Cells in which [`simplify`] counts points: columns or cubes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    /// Columns of any height.
    Columns,
    /// Cubes.
    Cubes,
}

/// Parameters of [`simplify`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimplifyParams {
    /// ε: the spacing left, as a share of the local feature size, above 0; masbcpp: 0.4.
    pub spacing: f32,
    /// Side of a cell, metres, above 0; masbcpp: 0.5.
    pub cell_size: f32,
    /// Columns or cubes; masbcpp: cubes.
    pub cells: Cells,
    /// A cell whose points differ in height by more than this, metres, keeps a hundred times as many: edges of roofs
    /// and kerbs. `None`: never; masbcpp: 0.5, which only columns can exceed with its cells.
    pub edge_height: Option<f32>,
    /// Minimum and maximum number of points per square metre to leave.
    pub density_limits: [f32; 2],
    /// Seed of the random choice.
    pub seed: u64,
}

impl Default for SimplifyParams {
    fn default() -> Self {
        Self {
            spacing: 0.4,
            cell_size: 0.5,
            cells: Cells::Cubes,
            edge_height: Some(0.5),
            density_limits: [0.0, f32::INFINITY],
            seed: 1,
        }
    }
}

/// Returns a mask of the points to keep, (N): in each cell of area A a random choice of A / (ε·m)² points, where m is
/// the mean local feature size there. The same seed gives the same choice.
///
/// # Errors
/// [`Error::LengthMismatch`] unless there is one feature size per point, [`Error::InvalidParameter`] for parameters out
/// of range.
///
/// # Source
/// Peters & Ledoux 2016; cells and bounds as in masbcpp, whose choice cannot be repeated because it takes its seed from
/// the system.
pub fn simplify(positions: &[[f32; 3]], feature_sizes: &[f32], params: &SimplifyParams) -> Result<Vec<bool>> {
    if feature_sizes.len() != positions.len() {
        return Err(Error::LengthMismatch {
            what: "local feature size",
            expected: positions.len(),
            found: feature_sizes.len(),
        });
    }
    let [least, most] = params.density_limits;
    for (parameter, value) in [(Parameter::Spacing, params.spacing), (Parameter::Cell, params.cell_size)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::invalid(parameter, value, "above 0"));
        }
    }
    if !(least >= 0.0 && most >= least) {
        return Err(Error::invalid(
            Parameter::DensityLimits,
            format!("{least} to {most}"),
            "0 or more, in ascending order",
        ));
    }
    let low = positions.iter().fold([f32::INFINITY; 3], |low, p| std::array::from_fn(|i| low[i].min(p[i])));
    let cell_of = |p: [f32; 3]| -> [i32; 3] {
        let mut cell = std::array::from_fn(|i| to_i32(f64::from((p[i] - low[i]) / params.cell_size)));
        if params.cells == Cells::Columns {
            cell[2] = 0;
        }
        cell
    };
    let mut by_cell: Vec<([i32; 3], u32)> = positions.iter().map(|&p| cell_of(p)).zip(0..).collect();
    by_cell.par_sort_unstable();
    let area = params.cell_size * params.cell_size;
    let mut keep = vec![false; positions.len()];
    for cell in by_cell.chunk_by(|a, b| a.0 == b.0) {
        let count = cell.len() as f32;
        let mut mean = cell.iter().map(|&(_, i)| feature_sizes[i as usize]).sum::<f32>() / count;
        let heights = cell.iter().map(|&(_, i)| positions[i as usize][2]);
        let (lowest, highest) =
            heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
        if params.edge_height.is_some_and(|limit| highest - lowest > limit) {
            mean /= 10.0;
        }
        let target = (area / (params.spacing * mean).powi(2)).clamp(least * area, most * area);
        for &(_, i) in cell {
            keep[i as usize] = random::uniform(params.seed, u64::from(i)) <= f64::from(target / count);
        }
    }
    Ok(keep)
}
