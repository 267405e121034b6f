//! Vegetation in clouds without a class for it.

use super::kinds::Kind;
use crate::neighbors::{FARTHEST_NEIGHBOR, NeighborIndex};
use crate::normals::OrientedCloud;
use belvedere_data::control::{Control, Stop};
use belvedere_data::{Attributes, Error, Parameter, Result};
use rayon::prelude::*;

/// Detection of vegetation in clouds without its classes (3 to 5), such as AHN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VegetationParams {
    /// Neighbours that are looked at, 1 to 256. Default 16.
    pub neighbors: usize,
    /// Share of them whose pulse had several returns from which a point is vegetation, 0 to 1. Default 0.4.
    pub several_returns: f32,
    /// Mean quality of their normals up to which a point is vegetation, 0 to 1. Default 0.6: where the two smallest
    /// eigenvalues of neighbourhoods are within a factor of 2.5, there is no surface.
    pub max_quality: f32,
}

impl Default for VegetationParams {
    fn default() -> Self {
        Self { neighbors: 16, several_returns: 0.4, max_quality: 0.6 }
    }
}

/// Points handed to a thread at once; their searches share the cache.
const CHUNK: usize = 512;

/// Changes points of no particular class (0, 1 or none) into [`Kind::Vegetation`] and returns their number. Their
/// neighbourhood is not flat, or lets pulses through: trees, hedges, and also cars and other small things. For clouds
/// without the classes of vegetation. `index` holds the points of `cloud`; neighbours lie within [`FARTHEST_NEIGHBOR`].
///
/// # Errors
/// [`Error::InvalidParameter`] for a number of neighbours out of range.
pub(super) fn find_vegetation(
    kinds: &mut [Kind],
    cloud: &OrientedCloud,
    index: &NeighborIndex,
    attributes: &Attributes,
    params: &VegetationParams,
    control: &Control<'_>,
) -> Result<usize> {
    let stop = Stop::new(control);
    if !(1..=256).contains(&params.neighbors) {
        let value = params.neighbors.to_string();
        return Err(Error::invalid(Parameter::NeighborCount, value, "1 to 256"));
    }
    let class = |row: usize| attributes.classification.as_ref().and_then(|classes| classes.get(row)).copied();
    let returns = |row: usize| attributes.return_count.as_ref().and_then(|counts| counts.get(row)).copied();
    let number = |row: usize| attributes.return_number.as_ref().and_then(|numbers| numbers.get(row)).copied();
    let several = |row: usize| returns(row).max(number(row)).is_some_and(|returns| returns > 1);
    let open = |row: usize| matches!(kinds[row], Kind::Other | Kind::Later) && matches!(class(row), None | Some(0 | 1));
    let (positions, quality) = (cloud.positions(), cloud.quality());
    let found_rows: Vec<u32> = index
        .tree_order()
        .par_chunks(CHUNK)
        .flat_map_iter(|rows| {
            let mut found = Vec::with_capacity(params.neighbors + 1);
            let mut vegetation = Vec::new();
            if stop.is_set() {
                return vegetation;
            }
            for &row in rows.iter().filter(|row| open(**row as usize)) {
                index.k_nearest(positions[row as usize], params.neighbors, &mut found);
                found.retain(|neighbor| neighbor.distance_squared <= FARTHEST_NEIGHBOR * FARTHEST_NEIGHBOR);
                let (mut split, mut flat) = (0.0, 0.0);
                for neighbor in &found {
                    split += f32::from(u8::from(several(neighbor.index as usize)));
                    flat += quality[neighbor.index as usize];
                }
                let count = found.len().max(1) as f32;
                if split >= params.several_returns * count || flat <= params.max_quality * count {
                    vegetation.push(row);
                }
            }
            control.advance(rows.len());
            vegetation
        })
        .collect();
    stop.check()?;
    for &row in &found_rows {
        kinds[row as usize] = Kind::Vegetation;
    }
    Ok(found_rows.len())
}
