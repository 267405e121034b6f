//! Rays through the implicit surface that the points define.

mod along_ray;

use crate::lines_of_sight::{check_clearance, check_least, check_positive, sight};
use crate::sampling::{capped_spacing, check_neighbor};
use along_ray::Crossings;
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::query::{Sight, Viewer, Visibility};
use belvedere::ray_index::{Ray, RayIndex};
use belvedere::{PointCloud, Result};

/// How an [`ImplicitSurface`] is made and traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImplicitSurfaceParams {
    /// Neighbours whose principal components give the normals, 3 to 256. Default 16.
    pub normal_neighbors: usize,
    /// Which neighbour's distance the support is a multiple of, 1 to 256. Default 6.
    pub support_neighbor: usize,
    /// Radius of the ball in which a sample counts, as a multiple of that distance, above 0. Default 1.5.
    pub support_scale: f64,
    /// Greatest support as a multiple of the median, 1 or more. Default 4.
    pub max_support_in_medians: f64,
    /// The surface ends where it lies farther than this share of the support from the mean of the samples around it, 0.1 to 1:
    /// beyond the rim of what was sampled the formula goes on, the surface does not. Default 0.5.
    pub rim: f64,
    /// Samples needed for a surface, 1 or more. Default 3: as many as a plane.
    pub min_samples: usize,
    /// Step along a ray as a share of the support of the smallest sample there, 0.01 to 1. Default 0.25.
    pub step: f64,
    /// The surface blocks only farther than this from the target, metres, 0 or more. Default 0.25.
    pub clearance: f64,
}

impl Default for ImplicitSurfaceParams {
    fn default() -> Self {
        Self {
            normal_neighbors: 16,
            support_neighbor: 6,
            support_scale: 1.5,
            max_support_in_medians: 4.0,
            rim: 0.5,
            min_samples: 3,
            step: 0.25,
            clearance: 0.25,
        }
    }
}

/// A sample of the surface.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    position: [f32; 3],
    /// Unit vector of either sign.
    normal: [f32; 3],
    /// Radius of the ball in which it counts, metres.
    support: f32,
}

/// The surface f(x) = n̄(x) · (x − p̄(x)) = 0, where p̄ and n̄ are weighted means of the samples and their normals around x. It
/// blocks from both sides.
///
/// It encloses nothing that was not scanned: an eye inside a house sees out where a wall has no points. Points whose neighbours
/// determine no plane have no part in it.
///
/// # Source
/// Wald & Seidel 2005, "Interactive Ray Tracing of Point-based Models", sections 3 and 4, after Adamson & Alexa 2003. Theirs are
/// oriented normals and Gaussian weights cut off at a radius; ours are unoriented normals, made to agree around each place, and
/// a polynomial that reaches zero at that radius.
pub struct ImplicitSurface {
    /// In the order of the index.
    samples: Vec<Sample>,
    index: RayIndex,
    params: ImplicitSurfaceParams,
    left_out: usize,
}

impl ImplicitSurface {
    /// Makes a sample of each point of `cloud`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](belvedere::Error::InvalidParameter) for a parameter out of its range or a position that is
    /// not finite.
    pub fn new(cloud: &PointCloud, params: &ImplicitSurfaceParams) -> Result<Self> {
        check_neighbor("neighbour that gives the support", params.support_neighbor)?;
        check_positive("support as a multiple of the spacing", params.support_scale)?;
        check_least("greatest support in medians", params.max_support_in_medians, 1.0, "finite and at least 1")?;
        check_least("rim as a share of the support", params.rim, 0.1, "0.1 to 1")?;
        check_least("1 / step along a ray", 1.0 / params.step, 1.0, "1 to 100")?;
        check_least("step along a ray", params.step, 0.01, "0.01 to 1")?;
        check_clearance(params.clearance)?;
        let positions = &cloud.positions;
        let neighbors = NeighborIndex::new(positions)?;
        let normals = estimate(positions, &neighbors, Neighborhood::Fixed { k: params.normal_neighbors })?;
        let spacing = capped_spacing(positions, &neighbors, params.support_neighbor, params.max_support_in_medians);
        let given = positions.iter().zip(&normals.vectors).zip(&spacing);
        let samples: Vec<Sample> = given
            .filter(|((_, normal), spacing)| **normal != [0.0; 3] && **spacing > 0.0)
            .map(|((&position, &normal), &spacing)| {
                #[expect(clippy::cast_possible_truncation, reason = "kept in f32 like the points")]
                let support = (f64::from(spacing) * params.support_scale) as f32;
                Sample { position, normal, support }
            })
            .collect();
        let boxes: Vec<_> =
            samples.iter().map(|s| [-1.0, 1.0].map(|sign| s.position.map(|v| v + sign * s.support))).collect();
        let index = RayIndex::new(&boxes)?;
        let left_out = positions.len() - samples.len();
        let samples = index.order().iter().map(|&i| samples[i as usize]).collect();
        Ok(Self { samples, index, params: *params, left_out })
    }

    /// Number of points without a normal, or with as many duplicates as neighbours, that have no part in the surface.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// The range at which `ray` crosses the surface first within its ranges.
    #[must_use]
    pub fn first(&self, ray: &Ray) -> Option<f64> {
        Crossings::new(&self.samples, &self.index, ray, &self.params).next()
    }
}

impl Visibility for ImplicitSurface {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        sight(viewer, self.params.clearance, |ray| self.first(ray).is_some())
    }
}
