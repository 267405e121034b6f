//! A closed surface between tetrahedra, which the scanner's lines of sight say to be outside or inside.

mod min_cut;
mod votes;

use crate::MethodInput;
use crate::delaunay::{Delaunay, MAX_POINTS, NONE};
use crate::lines_of_sight::{check_clearance, check_min, check_positive};
use crate::mesh_rays::{MeshRays, MeshRaysParams};
use belvedere::query::{Sight, Viewer, Visibility};
use belvedere::vector::{cross, dot, length, sub};
use belvedere::{Error, Parameter, Result};
use std::collections::HashSet;

use min_cut::{Graph, sink_side};
use votes::Votes;

/// How a [`GraphCut`] is made and traced.
///
/// Chosen on two simulated towns of 9 points/m² (seeds 7 and 77, not ones that are reported). The mean error is that of
/// both kinds over targets in the air, pedestrians, roofs and facades under suns, and of what observers above and in
/// streets see.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraphCutParams {
    /// Side of the cubes of which each keeps its first point, metres, above 0. Default 0.1: thins clouds of more than a
    /// hundred points/m² only. 0.3 changes the mean error by 0.1 points or less.
    pub cell: f64,
    /// Standard deviation of points across the surface, metres, above 0. Default 0.05; 0.02 to 0.2 change the mean
    /// error by 0.1 points or less.
    pub noise: f64,
    /// How far behind a first return a pulse says that space is solid, as a multiple of `noise`, 0 or more. Default 3,
    /// as in the source.
    pub depth_in_noises: f64,
    /// What the shape of triangles counts against one line of sight, 0 or more. Default 0.3: mean errors are 6.3 % at
    /// 0.2, 6.2 % at 0.3 and 7.2 % at 0.5. At 1 four of ten shaded pedestrians are called lit.
    pub quality: f64,
    /// A triangle blocks only if it lies farther than this from the target, metres, 0 or more. Default 0.5, as for
    /// splats; 0.3 changes the mean error by less than 0.1 points.
    pub clearance: f64,
}

impl Default for GraphCutParams {
    fn default() -> Self {
        Self { cell: 0.1, noise: 0.05, depth_in_noises: 3.0, quality: 0.3, clearance: 0.5 }
    }
}

/// The faces between outside and inside of the Delaunay tetrahedra of the points. They block from both sides.
///
/// Which tetrahedra are inside is the minimum of the lines of sight that a surface would cross and of the shape of its
/// triangles. Everything beyond the convex hull of the points is outside. All returns are corners; only first returns
/// have lines of sight, because a crown lets a part of the pulse through. Points whose scanner is not known are taken
/// to be seen from straight above.
///
/// # Source
/// Labatut, Pons & Keriven 2009, "Robust and efficient surface reconstruction from range data", sections 3 and 4 (soft
/// visibility, quality of triangles).
pub struct GraphCut {
    rays: MeshRays,
}

/// Parts of a line of sight that capacities are counted in.
const PARTS: f64 = 65_536.0;

impl GraphCut {
    /// Reconstructs the surface of the cloud of `survey`, whose scanner positions and return numbers it uses.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a parameter out of its range, for a position that is not finite and for more
    /// than 2^27 points, [`Error::LengthMismatch`] for a column of another length.
    pub fn new(survey: &MethodInput<'_>, params: &GraphCutParams) -> Result<Self> {
        check_positive("cell of the thinned cloud", params.cell)?;
        check_positive("noise", params.noise)?;
        check_min("depth behind a return in noises", params.depth_in_noises, 0.0, "finite and not negative")?;
        check_min("weight of the shape of triangles", params.quality, 0.0, "finite and not negative")?;
        check_clearance(params.clearance)?;
        survey.cloud.validate()?;
        let (expected, found) = (survey.cloud.len(), survey.scanner.len());
        if found != 0 && found != expected {
            return Err(Error::LengthMismatch { what: "scanner positions of the points", expected, found });
        }
        if expected > MAX_POINTS {
            let value = expected.to_string();
            return Err(Error::InvalidParameter { parameter: Parameter::PointCount, value, expected: "at most 2^27" });
        }
        let kept = first_per_cell(&survey.cloud.positions, params.cell);
        let points = kept.iter().map(|&row| survey.cloud.positions[row].map(f64::from)).collect();
        let delaunay = Delaunay::new(points);
        let inside = inside(&delaunay, survey, &kept, params);
        let triangles = boundary(&delaunay, &inside);
        let rays = MeshRays::from_local_triangles(triangles, &MeshRaysParams { clearance: params.clearance })?;
        Ok(Self { rays })
    }

    /// The triangles as something rays are traced against.
    #[must_use]
    pub fn rays(&self) -> &MeshRays {
        &self.rays
    }
}

impl Visibility for GraphCut {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        self.rays.seen_from(viewer)
    }
}

/// Rows of the first point of each cube.
fn first_per_cell(positions: &[[f32; 3]], cell: f64) -> Vec<usize> {
    let mut taken = HashSet::new();
    let mut is_first = |position: &[f32; 3]| {
        #[expect(clippy::cast_possible_truncation, reason = "saturates far beyond any place on Earth")]
        let key = position.map(|v| (f64::from(v) / cell).floor() as i64);
        taken.insert(key)
    };
    (0..positions.len()).filter(|&row| is_first(&positions[row])).collect()
}

/// Whether each tetrahedron is inside.
fn inside(delaunay: &Delaunay, survey: &MethodInput<'_>, kept: &[usize], params: &GraphCutParams) -> Vec<bool> {
    let votes = Votes::new(delaunay, survey, kept, params);
    let (mut capacity, mut terminal) = votes.into_capacities();
    let count = delaunay.tetrahedra.len();
    let spheres: Vec<Sphere> = (0..).take(count).map(|index| circumsphere(delaunay.corners(index))).collect();
    for (index, tetrahedron) in (0..).zip(&delaunay.tetrahedra) {
        let corners = delaunay.corners(index);
        let own = index as usize;
        for (i, &neighbor) in tetrahedron.neighbors.iter().enumerate() {
            let face = TetrahedronFace::opposite(&corners, i);
            // beyond the hull the sphere is a half-space, which meets its face at no angle
            let beyond = spheres.get(neighbor as usize).map_or(1.0, |sphere| -face.cosine(sphere));
            let quality = params.quality * (1.0 - face.cosine(&spheres[own]).min(beyond));
            #[expect(clippy::cast_possible_truncation, reason = "0 to 2 times the weight; saturates")]
            let quality = (quality * PARTS) as i64;
            if neighbor == NONE {
                // entered from outside, which is the source
                terminal[own] = terminal[own].saturating_add(capacity[own][i]).saturating_add(quality);
                capacity[own][i] = 0;
            } else {
                capacity[own][i] = capacity[own][i].saturating_add(quality);
            }
        }
    }
    let neighbors = delaunay.tetrahedra.iter().map(|tetrahedron| tetrahedron.neighbors).collect();
    sink_side(Graph { neighbors, capacity, terminal })
}

/// The faces between outside and inside, (T, 3, 3).
fn boundary(delaunay: &Delaunay, inside: &[bool]) -> Vec<[[f64; 3]; 3]> {
    let mut triangles = Vec::new();
    for (index, tetrahedron) in (0..).zip(&delaunay.tetrahedra) {
        if !inside[index as usize] {
            continue;
        }
        let corners = delaunay.corners(index);
        for (i, &neighbor) in tetrahedron.neighbors.iter().enumerate() {
            if inside.get(neighbor as usize).is_none_or(|&inside| !inside) {
                triangles.push(TetrahedronFace::opposite(&corners, i).corners);
            }
        }
    }
    triangles
}

struct Sphere {
    center: [f64; 3],
    radius: f64,
}

/// A face of a tetrahedron.
struct TetrahedronFace {
    corners: [[f64; 3]; 3],
    /// Towards the inside of the tetrahedron, unit length or zero.
    inward: [f64; 3],
}

impl TetrahedronFace {
    fn opposite(corners: &[[f64; 3]; 4], apex: usize) -> Self {
        let face: [[f64; 3]; 3] = std::array::from_fn(|k| corners[(apex + 1 + k) % 4]);
        let normal = cross(sub(face[1], face[0]), sub(face[2], face[0]));
        let side = dot(normal, sub(corners[apex], face[0]));
        let scale = if length(normal) > 0.0 { side.signum() / length(normal) } else { 0.0 };
        Self { corners: face, inward: normal.map(|v| scale * v) }
    }

    /// Cosine of the angle at which a sphere through the corners meets the plane: 1 where nearly all of it lies on the
    /// inward side.
    fn cosine(&self, sphere: &Sphere) -> f64 {
        let height = dot(self.inward, sub(sphere.center, self.corners[0]));
        if sphere.radius > 0.0 { (height / sphere.radius).clamp(-1.0, 1.0) } else { 1.0 }
    }
}

/// The sphere through four corners; of radius 0 where rounding leaves none.
fn circumsphere([a, b, c, d]: [[f64; 3]; 4]) -> Sphere {
    let [u, v, w] = [b, c, d].map(|corner| sub(corner, a));
    let [vw, wu, uv] = [cross(v, w), cross(w, u), cross(u, v)];
    let twice_volumes = 2.0 * dot(u, vw);
    let to_center: [f64; 3] =
        std::array::from_fn(|i| (dot(u, u) * vw[i] + dot(v, v) * wu[i] + dot(w, w) * uv[i]) / twice_volumes);
    let radius = length(to_center);
    if radius.is_finite() {
        Sphere { center: std::array::from_fn(|i| a[i] + to_center[i]), radius }
    } else {
        Sphere { center: a, radius: 0.0 }
    }
}
