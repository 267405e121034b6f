//! Rays against the triangles of a model: what city models are for.

use crate::lines_of_sight::{box_corner, check_clearance, sight};
use belvedere::query::{Sight, Viewer, Visibility};
use belvedere::ray_index::{Ray, RayIndex};
use belvedere::vector::sub;
use belvedere::{Mesh, Result};

/// How [`MeshRays`] answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshRaysParams {
    /// A triangle blocks only if it lies farther than this from the target, metres, 0 or more. Default 0.001: targets are
    /// f32, which is off by 0.1 mm within a kilometre of the origin, and a target computed to lie on a triangle must not be
    /// hidden by it.
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
    /// Local corners, in the order of the index.
    triangles: Vec<[[f64; 3]; 3]>,
    index: RayIndex,
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
        let boxes: Vec<_> = triangles.iter().map(bounding_box).collect();
        let index = RayIndex::new(&boxes)?;
        let triangles = index.order().iter().map(|&i| triangles[i as usize]).collect();
        Ok(Self { triangles, index, params: *params, left_out })
    }

    /// Number of triangles left out because a corner is missing or not finite.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// Whether a triangle lies within the ranges of `ray`.
    #[must_use]
    pub fn blocks(&self, ray: &Ray) -> bool {
        let crossing = Crossing::new(ray);
        let within = |range: f64| ray.ranges[0] <= range && range <= ray.ranges[1];
        self.index.any(ray, |row| crossing.range(&self.triangles[row]).is_some_and(within))
    }

    /// The range at which `ray` meets a triangle first within its ranges, and the corners of that triangle.
    #[must_use]
    pub fn first(&self, ray: &Ray) -> Option<(f64, [[f64; 3]; 3])> {
        let crossing = Crossing::new(ray);
        let in_reach = |row: usize| crossing.range(&self.triangles[row]).filter(|&range| range >= ray.ranges[0]);
        self.index.nearest(ray, in_reach).map(|(row, range)| (range, self.triangles[row]))
    }

    /// Lowest and highest local corner of all triangles, or `None` without any.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let first = *self.triangles.first()?.first()?;
        Some(self.triangles.as_flattened().iter().fold([first; 2], |[low, high], corner| {
            [std::array::from_fn(|i| low[i].min(corner[i])), std::array::from_fn(|i| high[i].max(corner[i]))]
        }))
    }
}

impl Visibility for MeshRays {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        sight(viewer, self.params.clearance, |ray| self.blocks(ray))
    }
}

fn bounding_box([a, b, c]: &[[f64; 3]; 3]) -> [[f32; 3]; 2] {
    let low = std::array::from_fn(|i| a[i].min(b[i]).min(c[i]));
    let high = std::array::from_fn(|i| a[i].max(b[i]).max(c[i]));
    [box_corner(low, -1.0), box_corner(high, 1.0)]
}

/// A ray in the space where it runs along the third axis, in which a triangle is met where its shadow on the first two
/// axes holds the origin.
///
/// # Source
/// Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection": it gives the barycentric coordinates
/// of Möller & Trumbore 1997, but two triangles compute the side of a shared edge from the same numbers, so that no ray slips
/// between them. All in f64, hence without the paper's fallback.
struct Crossing {
    origin: [f64; 3],
    axes: [usize; 3],
    shear: [f64; 3],
}

impl Crossing {
    fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let longest = |a: usize, b: usize| if d[b].abs() > d[a].abs() { b } else { a };
        let z = longest(longest(0, 1), 2);
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        Self { origin: ray.origin, axes: [x, y, z], shear: [d[x] / d[z], d[y] / d[z], 1.0 / d[z]] }
    }

    /// Range at which the line of the ray crosses a triangle, negative behind its origin; `None` where it passes by or runs
    /// within its plane.
    fn range(&self, corners: &[[f64; 3]; 3]) -> Option<f64> {
        let [x, y, z] = self.axes;
        let [shear_x, shear_y, scale_z] = self.shear;
        let [a, b, c] = corners.map(|corner| {
            let p = sub(corner, self.origin);
            [p[x] - shear_x * p[z], p[y] - shear_y * p[z], p[z]]
        });
        let side = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (side(b, c), side(c, a), side(a, b));
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let sum = u + v + w;
        (sum != 0.0).then(|| (u * a[2] + v * b[2] + w * c[2]) * scale_z / sum)
    }
}
