//! Rays against the triangles of a model: what city models are for.

use crate::lines_of_sight::{check_clearance, sight};
use belvedere::query::{Sight, Viewer, Visibility};
use belvedere::ray_index::Ray;
use belvedere::triangle_tree::TriangleTree;
use belvedere::vector::sub;
use belvedere::{Mesh, Result};

/// How [`MeshRays`] answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshRaysParams {
    /// A triangle blocks only if it lies farther than this from the target, metres, 0 or more. Default 0.001: targets
    /// are f32, which is off by 0.1 mm within a kilometre of the origin, and a target computed to lie on a triangle
    /// must not be hidden by it.
    pub clearance: f64,
}

impl Default for MeshRaysParams {
    fn default() -> Self {
        Self { clearance: 1e-3 }
    }
}

/// Triangles that block lines of sight, from both sides.
///
/// An eye inside a closed solid sees its inside and nothing beyond it.
pub struct MeshRays {
    tree: TriangleTree,
    params: MeshRaysParams,
    left_out: usize,
}

impl MeshRays {
    /// Indexes `mesh`, metres of its reference system, for local positions relative to `origin`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](belvedere::Error::InvalidParameter) for a clearance that is negative or not finite.
    pub fn new(mesh: &Mesh, origin: [f64; 3], params: &MeshRaysParams) -> Result<Self> {
        let local = |index| mesh.corners(index).map(|corners| corners.map(|corner| sub(corner, origin)));
        let triangles: Vec<_> = (0..mesh.triangles.len()).filter_map(local).collect();
        let missing = mesh.triangles.len() - triangles.len();
        let mut rays = Self::from_local_triangles(triangles, params)?;
        rays.left_out += missing;
        Ok(rays)
    }

    /// Indexes triangles given by their local corners, (T, 3, 3), metres.
    ///
    /// # Errors
    /// As [`MeshRays::new`].
    pub fn from_local_triangles(mut triangles: Vec<[[f64; 3]; 3]>, params: &MeshRaysParams) -> Result<Self> {
        check_clearance(params.clearance)?;
        let given = triangles.len();
        // f32::MAX is far beyond any place on Earth; within it boxes stay finite
        triangles.retain(|corners| corners.as_flattened().iter().all(|v| v.abs() < f64::from(f32::MAX)));
        let left_out = given - triangles.len();
        Ok(Self { tree: TriangleTree::new(&triangles)?, params: *params, left_out })
    }

    /// Number of triangles left out because a corner is missing or not finite.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// Whether a triangle lies within the ranges of `ray`.
    #[must_use]
    pub fn blocks(&self, ray: &Ray) -> bool {
        self.tree.any(ray, |_| true)
    }

    /// The range at which `ray` meets a triangle first within its ranges, and the corners of that triangle.
    #[must_use]
    pub fn first(&self, ray: &Ray) -> Option<(f64, [[f64; 3]; 3])> {
        let (row, range) = self.tree.nearest(ray, |_| true)?;
        Some((range, *self.tree.triangles().get(row)?))
    }

    /// Lowest and highest local corner of all triangles, or `None` without any.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        self.tree.bounds()
    }
}

impl Visibility for MeshRays {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        sight(viewer, self.params.clearance, |ray| self.blocks(ray))
    }
}
