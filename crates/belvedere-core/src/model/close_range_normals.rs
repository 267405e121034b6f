//! Normals of scans from the ground, where points may lie closer than their noise.

use crate::clean::drop_near;
use crate::neighbors::{Neighbor, NeighborIndex};
use crate::normals::Normals;
use crate::normals::estimate::{Neighborhood, estimate};
use belvedere_data::Result;
use belvedere_data::control::{Control, Stop};
use rayon::prelude::*;

/// Distance between the points that normals are estimated from, metres: several times the noise of such scanners. Nearer ones
/// lie on one scan line, or their noise outweighs the distance between them, as above a tripod.
const LEAST_DISTANCE: f64 = 0.01;

/// One normal per point of `positions`, (N, 3) local metres: that of the nearest of those points that lie [`LEAST_DISTANCE`] or more apart.
///
/// # Errors
/// Those of [`estimate`].
pub(super) fn close_range_normals(
    positions: &[[f32; 3]],
    neighborhood: Neighborhood,
    control: &Control<'_>,
) -> Result<Normals> {
    let Ok(count) = u32::try_from(positions.len()) else { return Ok(Normals::default()) };
    let mut rows: Vec<u32> = (0..count).collect();
    drop_near(positions, &mut rows, LEAST_DISTANCE, control)?;
    let apart: Vec<[f32; 3]> = rows.iter().map(|&row| positions[row as usize]).collect();
    let index = NeighborIndex::new(&apart, control)?;
    let normals = estimate(&apart, &index, neighborhood, control)?;
    let stop = Stop::new(control);
    let nearest = |near: &mut Vec<_>, &p: &[f32; 3]| {
        if !stop.is_set() {
            index.k_nearest(p, 1, near);
        }
        near.first().map_or(([0.0; 3], 0.0), |found: &Neighbor| {
            let row = found.index as usize;
            (normals.vectors[row], normals.quality[row])
        })
    };
    let (vectors, quality) = positions.par_iter().map_init(Vec::new, nearest).unzip();
    stop.check()?;
    Ok(Normals { vectors, quality })
}
