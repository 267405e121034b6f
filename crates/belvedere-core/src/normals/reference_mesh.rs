//! The sign of a normal from a mesh of the same place: nearest face, or which side of the point lies in the open.

use rayon::prelude::*;

use crate::ray_index::{Ray, RayIndex};
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::{cross, dot, sub, to_f32};
use belvedere_data::{Mesh, Result};

/// Maximum distance of a face whose normal decides about a point: generalised models leave out dormers and terraces of
/// that size.
const MAX_FACE_DISTANCE_M: f64 = 2.0;

/// Minimum |cosine| between the normals of point and face for the face to count as the point's own surface (60°).
const MIN_ALIGNMENT: f64 = 0.5;

/// Faces that are farther than the nearest by no more than this are candidates too: noise of laser points near an edge.
const EDGE_SLACK_M: f64 = 0.1;

/// Maximum distance of a point beside a face, along its plane, for the face to be its own surface, metres. Without this
/// limit the street in front of a house would take its sign from the edge of the floor of the house, if the model has
/// no street.
const MAX_LATERAL_M: f64 = 0.25;

/// Offsets along a normal at which the sides of a point are probed, metres, smallest first: beyond the noise of laser
/// points, below the thickness of buildings. The second is for points that lie off the surface of a generalised model.
const PROBE_OFFSETS_M: [f64; 2] = [0.25, 0.5];

/// Offset at which the sides of a face are probed: a mesh has no noise, but thin parts (eaves, chimneys).
const FACE_PROBE_M: f64 = 0.05;

/// Verdict of a mesh on the normal of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MeshVerdict {
    /// The nearest face is the point's own surface; positive where the normal points out, its size the confidence.
    Face(f64),
    /// One side of the point is enclosed and the other open; positive where the normal points to the open one.
    Parity(f64),
    /// The mesh says nothing.
    Silent,
}

struct MeshFace {
    corners: [[f64; 3]; 3],
    normal: [f64; 3],
    /// True if one side is enclosed and the other open, so that `normal` is known to point out.
    verified: bool,
}

impl MeshFace {
    fn distance_to(&self, point: [f64; 3]) -> f64 {
        let d = sub(nearest_on_triangle(point, self.corners), point);
        dot(d, d).sqrt()
    }

    fn bounds(&self) -> [[f32; 3]; 2] {
        let by = |pick: fn(f64, f64) -> f64| {
            std::array::from_fn(|i| {
                to_f32(self.corners.iter().map(|corner| corner[i]).reduce(pick).unwrap_or(f64::NAN))
            })
        };
        [by(f64::min), by(f64::max)]
    }
}

/// A mesh in the local coordinates of a cloud, ready for questions.
pub(super) struct ReferenceMesh {
    /// In the order of the index.
    faces: Vec<MeshFace>,
    index: RayIndex,
    top: f64,
}

impl ReferenceMesh {
    /// Faces of `mesh` relative to `origin` (metres); faces that are degenerate or refer to missing vertices are left
    /// out. `None` if none is left.
    ///
    /// Creates the mesh with oriented faces. Each face is probed on both sides and turned so that its normal points to
    /// the open one. Its turning sense is used only if that fails.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn new(mesh: &Mesh, origin: [f64; 3], control: &Control<'_>) -> Result<Option<Self>> {
        let stop = Stop::new(control);
        let faces: Vec<MeshFace> = (0..mesh.triangles.len())
            .filter_map(|index| {
                let corners = mesh.corners(index)?.map(|corner| sub(corner, origin));
                let normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
                let size = dot(normal, normal).sqrt();
                (size > 0.0 && size.is_finite()).then(|| MeshFace {
                    corners,
                    normal: normal.map(|v| v / size),
                    verified: false,
                })
            })
            .collect();
        let top = faces.iter().flat_map(|face| face.corners).map(|corner| corner[2]).fold(f64::NEG_INFINITY, f64::max);
        if faces.is_empty() {
            return Ok(None);
        }
        control.check()?;
        let index = RayIndex::new(&faces.iter().map(MeshFace::bounds).collect::<Vec<_>>())?;
        let mut unordered: Vec<Option<MeshFace>> = faces.into_iter().map(Some).collect();
        let faces = index.order().iter().filter_map(|&row| unordered.get_mut(row as usize)?.take()).collect();
        let mut reference = Self { faces, index, top };
        let probed: Vec<Option<bool>> = reference
            .faces
            .par_iter()
            .map(|face| {
                if stop.is_set() {
                    return None;
                }
                let [a, b, c] = face.corners;
                let middle = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0);
                reference.open_side(middle, face.normal, FACE_PROBE_M)
            })
            .collect();
        stop.check()?;
        for (face, open_along_normal) in reference.faces.iter_mut().zip(probed) {
            if let Some(along) = open_along_normal {
                face.verified = true;
                if !along {
                    face.normal = face.normal.map(|v| -v);
                }
            }
        }
        Ok(Some(reference))
    }

    /// Returns the verdict of the mesh on the unit `normal` of a local `position`.
    pub(super) fn verdict(&self, position: [f64; 3], normal: [f64; 3]) -> MeshVerdict {
        let mut unproven = None;
        if let Some((alignment, verified)) = self.own_face(position, normal) {
            if verified {
                return MeshVerdict::Face(alignment);
            }
            unproven = Some(MeshVerdict::Face(0.5 * alignment));
        }
        for offset in PROBE_OFFSETS_M {
            if let Some(along) = self.open_side(position, normal, offset) {
                // ground under a passage or in a court that the model filled lies near the floor of a solid, and what
                // is below a floor counts as open: parity gives no result for surfaces that would face down
                let outward_z = if along { normal[2] } else { -normal[2] };
                if outward_z >= -MIN_ALIGNMENT {
                    return MeshVerdict::Parity(if along { 0.5 } else { -0.5 });
                }
            }
        }
        unproven.unwrap_or(MeshVerdict::Silent)
    }

    /// Returns the signed |cosine| with the face that is the point's own surface, and true if that face is verified.
    /// `None` if there is none, or if faces about as near and about as well aligned disagree about the sign.
    fn own_face(&self, position: [f64; 3], normal: [f64; 3]) -> Option<(f64, bool)> {
        let reach = self.nearest_distance(position)? + EDGE_SLACK_M;
        let mut best: Option<(f64, bool)> = None;
        let mut against = 0.0_f64;
        let mut candidates = Vec::new();
        self.each_within(position, reach, |face, _| candidates.push(face));
        for face in candidates {
            let offset = sub(position, nearest_on_triangle(position, face.corners));
            let height = dot(offset, face.normal);
            if dot(offset, offset) - height * height > MAX_LATERAL_M * MAX_LATERAL_M {
                continue;
            }
            // what lies above the floor of a solid is a passage or a low roof that the model left out, not the floor's
            // underside
            if face.normal[2] < -MIN_ALIGNMENT && height < -EDGE_SLACK_M {
                continue;
            }
            let alignment = dot(normal, face.normal);
            let found = (alignment, face.verified);
            match best {
                Some(held) if held.0 * alignment < 0.0 => {
                    against = against.max(held.0.abs().min(alignment.abs()));
                    if alignment.abs() > held.0.abs() {
                        best = Some(found);
                    }
                }
                Some(held) if held.0.abs() > alignment.abs() => {}
                // of equally aligned faces the verified one counts, whichever the tree gives first
                Some(held) if held.0.abs() >= alignment.abs() && held.1 => {}
                _ => best = Some(found),
            }
        }
        best.filter(|found| found.0.abs() > MIN_ALIGNMENT && against <= MIN_ALIGNMENT)
    }

    /// Distance to the nearest face, if that is at most [`MAX_FACE_DISTANCE_M`].
    fn nearest_distance(&self, position: [f64; 3]) -> Option<f64> {
        // boxes that grow, so that a fine mesh is not searched metres around
        [0.125, 0.5, 1.0].into_iter().find_map(|share| {
            let reach = share * MAX_FACE_DISTANCE_M;
            let mut nearest = f64::INFINITY;
            self.each_within(position, reach, |_, distance| nearest = nearest.min(distance));
            (nearest <= reach).then_some(nearest)
        })
    }

    /// Calls `visit` for every face within `reach` of `position`, with its distance.
    fn each_within<'a>(&'a self, position: [f64; 3], reach: f64, mut visit: impl FnMut(&'a MeshFace, f64)) {
        self.index.visit_near(position.map(|v| v - reach), position.map(|v| v + reach), |row| {
            let Some(face) = self.faces.get(row) else { return };
            let distance = face.distance_to(position);
            if distance <= reach {
                visit(face, distance);
            }
        });
    }

    /// Returns true if the side that `normal` points to is open and the other enclosed, false for the reverse, and
    /// `None` if both are the same.
    fn open_side(&self, position: [f64; 3], normal: [f64; 3], offset: f64) -> Option<bool> {
        let shifted = |by: f64| std::array::from_fn(|i| position[i] + by * normal[i]);
        match (self.is_open(shifted(offset)), self.is_open(shifted(-offset))) {
            (true, false) => Some(true),
            (false, true) => Some(false),
            _ => None,
        }
    }

    /// Returns true if a ray straight up from `position` crosses an even number of faces. The sky is above every town,
    /// whereas solids, terrain sheets and missing floors below are unreliable. The turning sense of faces does not
    /// matter.
    fn is_open(&self, position: [f64; 3]) -> bool {
        let [x, y, z] = position;
        if z > self.top {
            return true;
        }
        let Some(up) = Ray::new(position, [0.0, 0.0, 1.0], [0.0, self.top - z]) else { return true };
        let mut is_open = true;
        self.index.each(&up, |row| {
            if self.faces.get(row).is_some_and(|face| covers(face.corners, x, y) && height_at(face, x, y) > z) {
                is_open = !is_open;
            }
        });
        is_open
    }
}

/// Returns true if (x, y) lies in the triangle in plan. Of triangles that share an edge exactly one covers a point on
/// it.
fn covers(corners: [[f64; 3]; 3], x: f64, y: f64) -> bool {
    let mut inside = false;
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        // always computed in the same order, so that both triangles of an edge round alike
        let (a, b) = if (a[1], a[0]) <= (b[1], b[0]) { (a, b) } else { (b, a) };
        if (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
            inside = !inside;
        }
    }
    inside
}

fn height_at(face: &MeshFace, x: f64, y: f64) -> f64 {
    let (a, n) = (face.corners[0], face.normal);
    // a vertical face is an edge from above and covers nothing but rounding
    if n[2].abs() < 1e-9 {
        return f64::NEG_INFINITY;
    }
    a[2] - (n[0] * (x - a[0]) + n[1] * (y - a[1])) / n[2]
}

/// Nearest point of a triangle.
///
/// # Source
/// Ericson 2005, Real-Time Collision Detection, section 5.1.5 (Voronoi regions of the triangle).
fn nearest_on_triangle(p: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let along = |start: [f64; 3], direction: [f64; 3], t: f64| std::array::from_fn(|i| start[i] + t * direction[i]);
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return along(a, ab, d1 / (d1 - d3));
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return along(a, ac, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return along(b, sub(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    std::array::from_fn(|i| a[i] + (ab[i] * vb + ac[i] * vc) / sum)
}
