//! Normals of scans from the ground, where points may lie closer than their noise.

use crate::clean::drop_near;
use crate::neighbors::{Neighbor, NeighborIndex};
use crate::normals::estimate::{Neighborhood, estimate_with_scatter, estimate_within_reach};
use crate::normals::{Normals, Scatter};
use belvedere_data::Result;
use belvedere_data::cast::to_row;
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::dot;
use rayon::prelude::*;

/// Distance between the places that normals are estimated at, metres: nearer points mostly have one surface in common.
const MIN_DISTANCE: f64 = 0.01;
/// Minimum radius around a place within which all points count, in multiples of the range noise: a smaller part of a
/// surface is as thick as it is wide.
const NOISES_WIDE: f32 = 5.0;
/// Number of neighbours that determine how far others count where neighbourhoods choose their size.
const USUAL_NEIGHBORS: usize = 16;

/// Results of the neighbourhoods of points that were scanned from the ground.
pub(super) struct CloseRange {
    /// One per point.
    pub(super) normals: Normals,
    /// The planes that these belong to.
    pub(super) scatter: Scatter,
    /// Noise of ranges, metres.
    pub(super) noise: Option<f32>,
}

impl CloseRange {
    /// For points at `positions`, which `index` was built from, measured from `scanner`, both (N, 3) local metres.
    ///
    /// The plane of a point is that of its nearest point among those that lie a centimetre or more apart. It is fitted
    /// to all points within the distance of that point's neighbours among these, and at least five times the noise.
    /// Above and below a tripod hundreds of points lie there, and a few of them would scatter as much as the points
    /// themselves.
    ///
    /// # Errors
    /// Those of [`estimate_with_scatter`].
    pub(super) fn estimate(
        positions: &[[f32; 3]],
        index: &NeighborIndex,
        scanner: &[[f32; 3]],
        neighborhood: Neighborhood,
        control: &Control<'_>,
    ) -> Result<Self> {
        let mut rows: Vec<u32> = (0..to_row(positions.len())).collect();
        drop_near(positions, &mut rows, MIN_DISTANCE, control)?;
        let of_rows = |column: &[[f32; 3]]| -> Vec<[f32; 3]> {
            rows.iter().filter_map(|&row| column.get(row as usize).copied()).collect()
        };
        let (places, scanner) = (of_rows(positions), of_rows(scanner));
        let apart = NeighborIndex::new(&places, control)?;
        let (normals, scatter) = estimate_with_scatter(&places, &apart, neighborhood, control)?;
        let min = NOISES_WIDE * scatter.noise_of_ranges(&places, &normals.vectors, &scanner).unwrap_or_default();
        let count = match neighborhood {
            Neighborhood::Fixed { k } => k,
            Neighborhood::Adaptive { .. } => USUAL_NEIGHBORS,
        };
        let stop = Stop::new(control);
        let reach = |near: &mut Vec<Neighbor>, &place: &[f32; 3]| {
            if !stop.is_set() {
                apart.k_nearest(place, count + 1, near);
            }
            near.last().map_or(0.0, |farthest| farthest.distance_squared.sqrt()).max(min)
        };
        let reach: Vec<f32> = places.par_iter().map_init(Vec::new, reach).collect();
        stop.check()?;
        let (of_places, planes) = estimate_within_reach(positions, index, &places, &reach, control)?;
        let noise = planes.noise_of_ranges(&places, &of_places.vectors, &scanner);
        let at_nearest = |near: &mut Vec<Neighbor>, &p: &[f32; 3]| {
            if !stop.is_set() {
                apart.k_nearest(p, 1, near);
            }
            near.first().map_or(([0.0; 3], 0.0, [0.0; 3], f32::INFINITY), |found| {
                let place = found.index as usize;
                let normal = of_places.vectors[place];
                let from = std::array::from_fn(|i| places[place][i] + planes.to_plane[place][i] - p[i]);
                let to_plane = normal.map(|v| v * dot(normal, from));
                (normal, of_places.quality[place], to_plane, planes.roughness[place])
            })
        };
        let found: Vec<_> = positions.par_iter().map_init(Vec::new, at_nearest).collect();
        stop.check()?;
        let (mut normals, mut scatter) = (Normals::default(), Scatter::default());
        for (vector, quality, to_plane, roughness) in found {
            normals.vectors.push(vector);
            normals.quality.push(quality);
            scatter.to_plane.push(to_plane);
            scatter.roughness.push(roughness);
        }
        Ok(Self { normals, scatter, noise })
    }
}
