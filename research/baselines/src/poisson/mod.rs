//! A smooth closed surface where the indicator function of the solid, whose gradient are the normals, crosses its mean.

mod level;
mod nets;

use crate::MethodInput;
use crate::implicit_surface::outward;
use crate::lines_of_sight::{check_clearance, check_min, check_positive};
use crate::mesh_rays::{MeshRays, MeshRaysParams};
use crate::sampling::{capped_spacing, check_neighbor};
use belvedere::cast::to_f32s;
use belvedere::control::Control;
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::query::{Sight, Viewer, Visibility};
use belvedere::{Error, Parameter, Result};

use level::{GridLevel, LevelSolver};

/// How a [`Poisson`] surface is made and traced.
///
/// Chosen on two simulated towns of 9 points/m² (seeds 7 and 77, not ones that are reported); single changes on seed 7
/// alone. The mean error is that of both kinds over targets in the air, pedestrians, roofs and facades under suns, and
/// over observers above and in streets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoissonParams {
    /// Neighbours whose principal components give the normals, 3 to 256. Default 48: mean errors are 7.0 % at 24, 6.6 %
    /// at 32 and 6.5 % at 48.
    pub normal_neighbors: usize,
    /// Which neighbour's distance the area of a point follows from, 1 to 256. Default 6; 12 changes the mean error by
    /// less than 0.1 points.
    pub area_neighbor: usize,
    /// Side of the finest cells as a multiple of the median spacing of the points, 0.25 or more. Default 0.7: with 32
    /// neighbours mean errors are 7.0 % at 1, 6.6 % at 0.7 and 6.5 % at 0.5, which takes twice the time.
    pub cell_in_spacings: f64,
    /// Side of the finest cells at least, metres, above 0. Default 0.1: scans on the ground have
    /// points so near to each other that the surface between sparse ones would have too many cells.
    pub min_cell: f64,
    /// Weight of the points against that of the normals, 0 or more. Default 1; 0.5 has the same mean error with 32
    /// neighbours, and the 4 of the source one that is 0.2 points higher with 16.
    pub screening: f64,
    /// The surface ends where it lies farther than this from the nearest point, metres, above 0. Default 1.5: with 16
    /// neighbours, cells of 1 and a weight of 4, mean errors are 18.7 % at 0.5, 8.6 % at 1, 7.7 % at 1.5, 8.0 % at 2
    /// and at 4.
    pub trim: f64,
    /// A triangle blocks only if it lies farther than this from the target, metres, 0 or more. Default 0.5, as for
    /// splats; 0.3 changes the mean error by 0.1 points.
    pub clearance: f64,
}

impl Default for PoissonParams {
    fn default() -> Self {
        Self {
            normal_neighbors: 48,
            area_neighbor: 6,
            cell_in_spacings: 0.7,
            min_cell: 0.1,
            screening: 1.0,
            trim: 1.5,
            clearance: 0.5,
        }
    }
}

/// The surface on which the indicator function χ has its mean over the points. χ minimises ∫ |∇χ − V|² and, over the
/// points, χ² by their area, where V is the field of outward normals. The surface blocks from both sides.
///
/// Points whose neighbours determine no plane have no part in it. Signs of normals are those towards the scanner where
/// it is known, else upward or, of steep points, away from what is high around them.
///
/// # Source
/// Kazhdan & Hoppe 2013, "Screened Poisson Surface Reconstruction", section 3, solved from coarse to fine as in
/// Kazhdan, Bolitho & Hoppe 2006, section 4. Ours takes finite differences on grids in place of B-splines on an octree,
/// and triangles from surface nets (Gibson 1998).
pub struct Poisson {
    rays: MeshRays,
    left_out: usize,
}

/// A point with a normal.
#[derive(Clone, Copy, Debug)]
struct OrientedSample {
    position: [f64; 3],
    /// Outward, unit length.
    normal: [f64; 3],
    /// Square metres of the surface for which it counts.
    area: f64,
}

impl Poisson {
    /// Reconstructs the surface of the cloud of `survey`, whose scanner positions it uses.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a parameter out of its range, for a position that is not finite and for a cloud
    /// that is a million times as wide as its points are apart, [`Error::LengthMismatch`] for a column of another
    /// length.
    pub fn new(survey: &MethodInput<'_>, params: &PoissonParams) -> Result<Self> {
        check_neighbor("neighbour that gives the area of a point", params.area_neighbor)?;
        check_min("cell in spacings", params.cell_in_spacings, 0.25, "finite and at least 0.25")?;
        check_positive("least cell", params.min_cell)?;
        check_min("weight of the points", params.screening, 0.0, "finite and not negative")?;
        check_positive("distance at which the surface ends", params.trim)?;
        check_clearance(params.clearance)?;
        let positions = &survey.cloud.positions;
        let (expected, found) = (positions.len(), survey.scanner.len());
        if found != 0 && found != expected {
            return Err(Error::LengthMismatch { what: "scanner positions of the points", expected, found });
        }
        let neighbors = NeighborIndex::new(positions, &Control::none())?;
        let samples = samples(survey, &neighbors, params)?;
        let left_out = positions.len() - samples.len();
        let triangles = reconstruct(&samples, &neighbors, params)?;
        let rays = MeshRays::from_local_triangles(triangles, &MeshRaysParams { clearance: params.clearance })?;
        Ok(Self { rays, left_out })
    }

    /// The triangles as something rays are traced against.
    #[must_use]
    pub fn rays(&self) -> &MeshRays {
        &self.rays
    }

    /// Number of points without a normal, or with as many duplicates as neighbours, that have no part in the surface.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.left_out
    }
}

impl Visibility for Poisson {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        self.rays.seen_from(viewer)
    }
}

/// Greatest distance of the neighbour that gives an area, as a multiple of the median: as for splats.
const MAX_SPACING_IN_MEDIANS: f64 = 4.0;

fn samples(survey: &MethodInput<'_>, neighbors: &NeighborIndex, params: &PoissonParams) -> Result<Vec<OrientedSample>> {
    let positions = &survey.cloud.positions;
    let neighborhood = Neighborhood::Fixed { k: params.normal_neighbors };
    let normals = outward(survey, estimate(positions, neighbors, neighborhood, &Control::none())?)?;
    let spacing = capped_spacing(positions, neighbors, params.area_neighbor, MAX_SPACING_IN_MEDIANS);
    let given = positions.iter().zip(&normals).zip(&spacing);
    let samples = given.filter(|((_, normal), spacing)| **normal != [0.0; 3] && **spacing > 0.0);
    Ok(samples
        .map(|((position, normal), &spacing)| OrientedSample {
            position: position.map(f64::from),
            normal: normal.map(f64::from),
            // the disc to a neighbour holds as many points
            area: std::f64::consts::PI * f64::from(spacing).powi(2) / params.area_neighbor as f64,
        })
        .collect())
}

/// Cells of the coarsest level along the longest side of the cloud.
const COARSEST_CELLS: f64 = 32.0;
/// Cells of the coarsest level around the cloud.
const MARGIN: f64 = 3.0;
/// Levels at most: cells of the finest are numbered by 20 bits.
const MAX_LEVELS: u32 = 15;

/// The triangles of the surface, (T, 3, 3).
fn reconstruct(
    samples: &[OrientedSample],
    neighbors: &NeighborIndex,
    params: &PoissonParams,
) -> Result<Vec<[[f64; 3]; 3]>> {
    let mut areas: Vec<f64> = samples.iter().map(|sample| sample.area).collect();
    if areas.is_empty() {
        return Ok(Vec::new());
    }
    let middle = areas.len() / 2;
    let spacing = areas.select_nth_unstable_by(middle, f64::total_cmp).1.sqrt();
    let cell = params.min_cell.max(params.cell_in_spacings * spacing);
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for sample in samples {
        for axis in 0..3 {
            low[axis] = low[axis].min(sample.position[axis]);
            high[axis] = high[axis].max(sample.position[axis]);
        }
    }
    let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    let Some(depth) = (0..MAX_LEVELS).find(|&depth| longest <= COARSEST_CELLS * cell * f64::from(1 << depth)) else {
        let value = format!("{longest} m by {cell} m");
        let expected = "points that are not a million times as far apart as neighbours: take out stray points";
        return Err(Error::InvalidParameter { parameter: Parameter::Extent, value, expected });
    };
    let coarsest = cell * f64::from(1 << depth);
    let corner = low.map(|v| v - MARGIN * coarsest);
    let size = std::array::from_fn(|axis| ((high[axis] - corner[axis]) / coarsest).ceil() + MARGIN);
    let mut levels: Vec<GridLevel> = Vec::new();
    for number in 0..=depth {
        let side = coarsest / f64::from(1 << number);
        let mut level = match levels.last() {
            None => GridLevel::whole(corner, side, size),
            Some(_) => GridLevel::around(corner, side, samples),
        };
        level.values = LevelSolver::new(&level, &levels, samples, params.screening).solve();
        levels.push(level);
    }
    // areas weigh the mean
    let (mut sum, mut area) = (0.0, 0.0);
    for sample in samples {
        sum += sample.area * level::value_at(&levels, sample.position);
        area += sample.area;
    }
    let is_near = |place: [f64; 3]| {
        let mut found = Vec::new();
        neighbors.k_nearest(to_f32s(place), 1, &mut found);
        found.first().is_some_and(|nearest| f64::from(nearest.distance_squared) <= params.trim * params.trim)
    };
    Ok(nets::triangles(&levels, samples, sum / area, is_near))
}
