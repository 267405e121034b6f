//! Rays through the implicit surface that the points define.

mod along_ray;

use crate::MethodInput;
use crate::lines_of_sight::{check_clearance, check_min, check_positive, sight};
use crate::sampling::{capped_spacing, check_neighbor};
use along_ray::Crossings;
use belvedere::Result;
use belvedere::cast::to_f32;
use belvedere::control::Control;
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::normals::{Normals, Orientation, orient};
use belvedere::query::{Sight, Viewer, Visibility};
use belvedere::ray_index::{Ray, RayIndex};
use belvedere::vector::{dot, sub};

/// What the signs of the normals are taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalSigns {
    /// Towards the scanner where it is known, else upward or, of steep points, away from what is high around them
    /// ([`Orientation::Up`]).
    Outward,
    /// None are needed: around each place, normals are made to agree with the nearest, and along a ray with the last.
    /// Ridges and corners of 90° and less are beyond this.
    Agreeing,
}

/// How an [`ImplicitSurface`] is made and traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImplicitSurfaceParams {
    /// Neighbours whose principal components give the normals, 3 to 256. Default 16.
    pub normal_neighbors: usize,
    /// What the signs of the normals are taken from. Default agreeing: on a simulated town of 11 points/m² (seed 7, not
    /// one that is reported) it casts fewer false shadows (0.3 % of sunlit pedestrian points instead of 1.6 %) at
    /// nearly the same misses (2.4 and 2.1 %), for signs towards the scanner err in crowns and on sparse walls.
    pub signs: NormalSigns,
    /// Which neighbour's distance the support is a multiple of, 1 to 256. Default 6.
    pub support_neighbor: usize,
    /// Radius of the ball in which a sample counts, as a multiple of that distance, above 0. Default 0.9: of 0.75 to
    /// 2.5 in the same town where most pedestrian points are right (98.6 %; 96.7 at 0.75, 95.9 at 1.5). Smaller leaves
    /// holes, larger mixes the two sides of ridges and corners.
    pub support_scale: f64,
    /// Greatest support as a multiple of the median, 1 or more. Default 4.
    pub max_support_in_medians: f64,
    /// The surface ends where it lies farther than this share of the support from the mean of the samples around it,
    /// 0.1 to 1: beyond the edge of the sampled area the formula continues, the surface does not. Default 0.5: 0.7
    /// doubles the false shadows of the same town.
    pub edge: f64,
    /// Samples needed for a surface, 1 or more. Default 2: 3 leaves holes (roof misses 7.3 instead of 4.8 %).
    pub min_samples: usize,
    /// Step along a ray as a share of the support of the smallest sample there, 0.01 to 1. Default 0.25; 0.125 changes
    /// no share of answers by more than 0.1 %.
    pub step: f64,
    /// The surface blocks only farther than this from the target, metres, 0 or more. Default 0.5, as for splats.
    pub clearance: f64,
}

impl Default for ImplicitSurfaceParams {
    fn default() -> Self {
        Self {
            normal_neighbors: 16,
            signs: NormalSigns::Agreeing,
            support_neighbor: 6,
            support_scale: 0.9,
            max_support_in_medians: 4.0,
            edge: 0.5,
            min_samples: 2,
            step: 0.25,
            clearance: 0.5,
        }
    }
}

/// A sample of the surface.
#[derive(Clone, Copy, Debug, Default)]
struct SurfaceSample {
    position: [f32; 3],
    /// Unit vector, outward or of either sign.
    normal: [f32; 3],
    /// Radius of the ball in which it counts, metres.
    support: f32,
}

/// The surface f(x) = n̄(x) · (x − p̄(x)) = 0, where p̄ and n̄ are weighted means of the samples and their normals
/// around x. It blocks from both sides.
///
/// It encloses nothing that was not scanned: an eye inside a house sees out where a wall has no points. Points whose
/// neighbours determine no plane have no part in it.
///
/// # Source
/// Wald & Seidel 2005, "Interactive Ray Tracing of Point-based Models", after Adamson & Alexa 2003. Their weights are
/// Gaussian and cut off at a radius; ours are a polynomial that reaches zero at that radius. The rule for the edge is
/// ours.
pub struct ImplicitSurface {
    /// In the order of the index.
    samples: Vec<SurfaceSample>,
    index: RayIndex,
    params: ImplicitSurfaceParams,
    left_out: usize,
}

impl ImplicitSurface {
    /// Makes a sample of each point of the cloud of `survey`, whose scanner positions it uses.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](belvedere::Error::InvalidParameter) for a parameter out of its range or a position
    /// that is not finite, [`Error::LengthMismatch`](belvedere::Error::LengthMismatch) for a column of another length.
    pub fn new(survey: &MethodInput<'_>, params: &ImplicitSurfaceParams) -> Result<Self> {
        check_neighbor("neighbour that gives the support", params.support_neighbor)?;
        check_positive("support as a multiple of the spacing", params.support_scale)?;
        check_min("maximum support in medians", params.max_support_in_medians, 1.0, "finite and at least 1")?;
        check_min("edge as a share of the support", params.edge, 0.1, "0.1 to 1")?;
        check_min("1 / step along a ray", 1.0 / params.step, 1.0, "1 to 100")?;
        check_min("step along a ray", params.step, 0.01, "0.01 to 1")?;
        check_clearance(params.clearance)?;
        let positions = &survey.cloud.positions;
        let neighbors = NeighborIndex::new(positions, &Control::none())?;
        let normals =
            estimate(positions, &neighbors, Neighborhood::Fixed { k: params.normal_neighbors }, &Control::none())?;
        let normals = match params.signs {
            NormalSigns::Agreeing => normals.vectors,
            NormalSigns::Outward => outward(survey, normals)?,
        };
        let spacing = capped_spacing(positions, &neighbors, params.support_neighbor, params.max_support_in_medians);
        let given = positions.iter().zip(&normals).zip(&spacing);
        let samples: Vec<SurfaceSample> = given
            .filter(|((_, normal), spacing)| **normal != [0.0; 3] && **spacing > 0.0)
            .map(|((&position, &normal), &spacing)| {
                let support = to_f32(f64::from(spacing) * params.support_scale);
                SurfaceSample { position, normal, support }
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

/// Normals with signs as [`NormalSigns::Outward`] has them.
pub(crate) fn outward(survey: &MethodInput<'_>, normals: Normals) -> Result<Vec<[f32; 3]>> {
    let (oriented, _report) = orient(survey.cloud, normals, &Orientation::Up, &Control::none())?;
    let positions = &survey.cloud.positions;
    let mut vectors = oriented.normals().to_vec();
    for ((normal, position), scanner) in vectors.iter_mut().zip(positions).zip(survey.scanner) {
        // false for a scanner that is not known: NaN
        if dot(*normal, sub(*scanner, *position)) < 0.0 {
            *normal = normal.map(|v| -v);
        }
    }
    Ok(vectors)
}

impl Visibility for ImplicitSurface {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        sight(viewer, self.params.clearance, |ray| self.first(ray).is_some())
    }
}
