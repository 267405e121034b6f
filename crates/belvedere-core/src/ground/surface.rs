//! Height of the highest surface above the ground at the middle of each cell, for questions about places above it.

use super::{Ground, MAX_GAP_FROM_RETURNS, cells_near_returns, highest_points};
use crate::neighbors::{Neighbor, NeighborIndex};
use belvedere_data::cast::to_f32;
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Maximum distance from the middle of a cell at which a point shows the cover of the middle, metres: half of a cell
/// that is larger.
const NEAR: f64 = 0.5;
/// Distance to the next point up to which it tells of the middle of a cell, metres: that of sparse surveys, or the side
/// of a larger cell.
const REACH: f64 = 1.0;
/// Fewest points of a layer that make a plane: two more than any three points have.
const FEWEST: usize = 5;
/// Determinant of the normal equations, in units of their diagonal, below which points lie on a line.
const ON_A_LINE: f64 = 1e-3;

/// Parameters of the surface height at the middle of a cell, estimated from the points around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceParams {
    /// Points around the middle that are looked at, 3 to 256. Default 12: a square metre of usual airborne surveys.
    pub neighbors: usize,
    /// Maximum step between the heights of points of one layer, metres, above 0. Default 0.4: twelve points on a roof
    /// of 60 degrees lie closer than that, eaves and chimneys stand higher.
    pub step: f64,
    /// Root mean squared distance in height of the points of a layer from their plane beyond which it is no plane,
    /// metres, 0 or more. Default 0.12: ranging noise and a ridge stay below it, crowns and shrubs do not.
    pub roughness: f64,
    /// Maximum distance from the middle for points that are used, metres, above 0. Default: any distance.
    pub farthest: f32,
    /// Maximum horizontal distance between the middle of a cell without ground and the nearest point for which it has a
    /// height, metres, above 0. Default 5: a hole in the survey has no surface.
    pub max_gap_from_returns: f64,
}

impl Default for SurfaceParams {
    fn default() -> Self {
        let max_gap_from_returns = MAX_GAP_FROM_RETURNS;
        Self { neighbors: 12, step: 0.4, roughness: 0.12, farthest: f32::INFINITY, max_gap_from_returns }
    }
}

impl SurfaceParams {
    /// Returns the maximum distance from a point, metres, at which [`top_surface`] may give a cell of this side a
    /// height.
    #[must_use]
    pub fn reach(cell: f64) -> f64 {
        // to the middle of a cell, or to the next cell
        REACH.max(cell) + cell
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for one outside its range.
    pub fn validate(&self) -> Result<()> {
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::Surface, value, expected));
        if !(3..=256).contains(&self.neighbors) {
            return invalid(format!("one of {} neighbours", self.neighbors), "one of 3 to 256");
        }
        if !(self.step > 0.0 && self.step.is_finite()) {
            return invalid(format!("one in steps of {}", self.step), "one in steps above zero metres");
        }
        if !(self.roughness >= 0.0 && self.roughness.is_finite()) {
            return invalid(format!("one of roughness {}", self.roughness), "one of roughness 0 metres or more");
        }
        Ok(())
    }
}

/// Height of the top surface of `positions`, (N, 3) local metres, at the middle of each cell of `ground`.
///
/// The layer on top at the middle is that of the highest point near it. If its points, five at least, lie on a plane,
/// as on roofs and streets, the result is the plane's height at the middle, clamped to the heights of the points.
/// Otherwise, as in crowns, it is the highest point of the cell, so that a place above it is outside.
///
/// Cells far from any point are as in [`highest_points`]. Those in a hole of the survey
/// ([`SurfaceParams::max_gap_from_returns`]) have no height unless the ground has.
///
/// # Errors
/// [`Error::InvalidParameter`] for a parameter outside its range or a point that is not finite, [`Error::Cancelled`].
pub fn top_surface(
    positions: &[[f32; 3]],
    ground: &Ground,
    params: &SurfaceParams,
    control: &Control<'_>,
) -> Result<Raster<f32>> {
    params.validate()?;
    let positions = &super::in_order(positions.to_vec())[..];
    let mut heights = highest_points(positions, ground);
    let grid = ground.grid;
    let flat: Vec<[f32; 3]> = positions.iter().map(|p| [p[0], p[1], 0.0]).collect();
    let index = NeighborIndex::new(&flat, control)?;
    let (near, reach) = (NEAR.min(0.5 * grid.cell), REACH.max(grid.cell));
    heights.values_mut().par_chunks_mut(grid.width.max(1)).enumerate().try_for_each_init(
        || (Vec::new(), Vec::new()),
        |(found, around), (row, heights)| {
            control.check()?;
            for (column, height) in heights.iter_mut().enumerate() {
                let middle = grid.center(column, row);
                let query = [to_f32(middle[0]), to_f32(middle[1]), 0.0];
                index.k_nearest(query, params.neighbors, found);
                found.retain(|near| near.distance_squared <= params.farthest * params.farthest);
                if found.first().is_none_or(|nearest| f64::from(nearest.distance_squared).sqrt() > reach) {
                    continue;
                }
                gather(positions, found, middle, around);
                if let Some(surface) = at_middle(around, near, params) {
                    *height = surface;
                }
            }
            Ok(())
        },
    )?;
    let returns = positions.iter().map(|p| [f64::from(p[0]), f64::from(p[1])]);
    let near = cells_near_returns(returns, &grid, params.max_gap_from_returns);
    for ((height, ground), is_near) in heights.values_mut().iter_mut().zip(ground.heights.values()).zip(near) {
        if !is_near && ground.is_nan() {
            *height = f32::NAN;
        }
    }
    Ok(heights)
}

/// A point relative to the middle of a cell.
#[derive(Clone, Copy)]
struct Around {
    east: f64,
    north: f64,
    height: f64,
    /// Squared distance on the map.
    distance_squared: f64,
}

/// The points found around a middle, the highest first.
fn gather(positions: &[[f32; 3]], found: &[Neighbor], [x, y]: [f64; 2], around: &mut Vec<Around>) {
    around.clear();
    around.extend(found.iter().filter_map(|neighbor| {
        let [east, north, height] = positions.get(neighbor.index as usize)?.map(f64::from);
        let distance_squared = f64::from(neighbor.distance_squared);
        Some(Around { east: east - x, north: north - y, height, distance_squared })
    }));
    // of equal heights the nearer, which the index gives first, stays first
    around.sort_by(|a, b| b.height.total_cmp(&a.height));
}

/// The height of the plane of the top layer; `None` where there is no plane.
fn at_middle(around: &[Around], near: f64, params: &SurfaceParams) -> Option<f32> {
    let is_near = |point: &Around| point.distance_squared <= near * near;
    let top = around.iter().position(is_near).or_else(|| {
        (0..around.len()).min_by(|&a, &b| around[a].distance_squared.total_cmp(&around[b].distance_squared))
    })?;
    let follows = |pair: &[Around]| pair[0].height - pair[1].height <= params.step;
    let above = around[..=top].windows(2).rev().take_while(|pair| follows(pair)).count();
    let below = around[top..].windows(2).take_while(|pair| follows(pair)).count();
    let layer = &around[top - above..=top + below];
    if layer.len() < FEWEST.min(params.neighbors) {
        return None;
    }
    let (height, roughness) = plane(layer)?;
    let (highest, lowest) = (layer.first()?.height, layer.last()?.height);
    (roughness <= params.roughness).then(|| to_f32(height.clamp(lowest, highest)))
}

/// Fits a plane to a layer by weighted least squares, with larger weights for nearer points. Returns its height at the
/// middle and the root mean squared distance of the points from it; the mean height if there is no plane. `None` for a
/// layer without points.
fn plane(layer: &[Around]) -> Option<(f64, f64)> {
    let reach = layer.iter().map(|point| point.distance_squared).fold(0.0, f64::max) * 1.1 + 1e-6;
    let weight = |point: &Around| 1.0 - point.distance_squared / reach;
    let sum = |value: &dyn Fn(&Around) -> f64| layer.iter().map(|point| weight(point) * value(point)).sum::<f64>();
    let whole = sum(&|_| 1.0);
    if !(whole > 0.0) {
        return None;
    }
    let [east, north, height] = [sum(&|p| p.east), sum(&|p| p.north), sum(&|p| p.height)].map(|s| s / whole);
    let xx = sum(&|p| (p.east - east).powi(2));
    let yy = sum(&|p| (p.north - north).powi(2));
    let xy = sum(&|p| (p.east - east) * (p.north - north));
    let xz = sum(&|p| (p.east - east) * (p.height - height));
    let yz = sum(&|p| (p.north - north) * (p.height - height));
    let determinant = xx * yy - xy * xy;
    let [a, b] = if determinant > ON_A_LINE * (xx + yy) * (xx + yy) {
        [(xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant]
    } else {
        [0.0; 2]
    };
    let off = |p: &Around| p.height - height - a * (p.east - east) - b * (p.north - north);
    // three numbers were fitted
    let freedom = layer.len() as f64 / (layer.len() as f64 - 3.0).max(1.0);
    let roughness = (sum(&|p| off(p).powi(2)) / whole * freedom).sqrt();
    Some((height - a * east - b * north, roughness))
}
