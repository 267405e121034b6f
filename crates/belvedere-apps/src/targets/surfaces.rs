//! Faces of a mesh as targets, and means of their pieces over faces and objects.

use super::{TargetLayout, Targets};
use belvedere_core::query::{MeshTargetParams, SurfacePieces};
use belvedere_data::frame::Frame;
use belvedere_data::{Mesh, Result};

/// Orientation of targets on a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// Square to the surface. Default.
    #[default]
    Normals,
    /// To the zenith.
    Level,
}

/// Conversion of the faces of a mesh into targets.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshParams {
    /// Longest side of a piece, metres, above 0. Default 0.5: the resolution of usual airborne surveys on a wall.
    pub spacing: f64,
    /// Seed of the place on each piece. Default 0.
    pub seed: u64,
    /// Orientation of the targets.
    pub facing: Facing,
    /// Distance of targets before their face, metres. Default: that of [`MeshTargetParams`].
    pub lift: f64,
}

belvedere_data::setters!(MeshParams {
    with_spacing(spacing: f64),
    with_seed(seed: u64),
    with_facing(facing: Facing),
    with_lift(lift: f64),
});

impl Default for MeshParams {
    fn default() -> Self {
        Self { spacing: 0.5, seed: 0, facing: Facing::Normals, lift: MeshTargetParams::default().lift }
    }
}

/// Means over the faces of a mesh and over its objects.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceMeans {
    /// Mean of each object by area, (objects); of all faces together, (1), where the mesh knows no objects.
    pub objects: Vec<f64>,
    /// Mean of each face, (faces); NaN for a face without a value.
    pub faces: Vec<f64>,
}

impl Targets {
    /// The faces of `mesh`, metres, cut into pieces. Each piece is a target that weighs its area; the pieces of a face
    /// are a group.
    ///
    /// # Errors
    /// Those of [`SurfacePieces::of_mesh`].
    pub fn of_mesh(mesh: &Mesh, frame: &Frame, params: &MeshParams) -> Result<Self> {
        let surface = SurfacePieces::of_mesh(mesh, frame.origin, params.spacing, params.seed)?;
        let positions = surface.pieces.iter().map(|piece| piece.lifted_along_normal(params.lift)).collect();
        let normals = match params.facing {
            Facing::Normals => Some(surface.pieces.iter().map(|piece| piece.normal).collect()),
            Facing::Level => None,
        };
        let weights = surface.pieces.iter().map(|piece| f64::from(piece.area)).collect();
        // pieces of a face follow each other
        let mut groups: Vec<std::ops::Range<usize>> = Vec::new();
        for run in surface.pieces.chunk_by(|a, b| a.face == b.face) {
            let start = groups.last().map_or(0, |last| last.end);
            groups.push(start..start + run.len());
        }
        let layout = TargetLayout::Surface(surface);
        Ok(Self { weights, groups, ..Self::at(frame.clone(), positions, normals, layout) })
    }

    /// The pieces of a surface; `None` where targets are none.
    #[must_use]
    pub fn surface(&self) -> Option<&SurfacePieces> {
        match &self.layout {
            TargetLayout::Surface(surface) => Some(surface),
            _ => None,
        }
    }
}

impl FaceMeans {
    /// The means of `values`, one for each piece of `surface`, over the faces of `mesh` and, by their area, over its
    /// objects. Pieces without a value do not count.
    #[must_use]
    pub fn new(mesh: &Mesh, surface: &SurfacePieces, values: &[f32]) -> Self {
        let areas = surface.face_areas();
        let faces = surface.face_means(values);
        let weighted: Vec<f64> = faces.iter().zip(&areas).map(|(mean, area)| mean * area).collect();
        let counted: Vec<f64> =
            weighted.iter().zip(&areas).map(|(w, area)| if w.is_finite() { *area } else { 0.0 }).collect();
        let sums = object_sums(mesh, &weighted);
        let objects = sums.into_iter().zip(object_sums(mesh, &counted)).map(|(sum, area)| sum / area).collect();
        Self { objects, faces }
    }
}

/// Sums of `values`, one for each face of `mesh`, over its objects; over all faces where it knows no objects. Values
/// that are not finite do not count.
pub(crate) fn object_sums(mesh: &Mesh, values: &[f64]) -> Vec<f64> {
    let is_whole = mesh.object_names.is_empty();
    let mut sums = vec![0.0; mesh.object_names.len().max(1)];
    for (face, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
        let row = if is_whole { Some(0) } else { mesh.objects.get(face).map(|&object| object as usize) };
        if let Some(sum) = row.and_then(|row| sums.get_mut(row)) {
            *sum += value;
        }
    }
    sums
}

/// Area of each object of `mesh`, m², as its pieces have it; of all faces together, (1), where it knows no objects.
#[must_use]
pub fn object_areas(mesh: &Mesh, surface: &SurfacePieces) -> Vec<f64> {
    object_sums(mesh, &surface.face_areas())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 2 m by 2 m of object 0, and one of 4 m by 1 m of object 1, two triangles each.
    fn mesh() -> Mesh {
        let square = |x: f64, width: f64, depth: f64| {
            [[x, 0.0, 0.0], [x + width, 0.0, 0.0], [x + width, depth, 0.0], [x, depth, 0.0]]
        };
        Mesh {
            vertices: [square(0.0, 2.0, 2.0), square(10.0, 4.0, 1.0)].concat(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            objects: vec![0, 0, 1, 1],
            object_names: vec!["a".to_owned(), "b".to_owned()],
            ..Mesh::default()
        }
    }

    #[test]
    fn faces_and_objects_have_means_by_area() {
        let mesh = mesh();
        let targets = Targets::of_mesh(&mesh, &Frame::default(), &MeshParams::default().with_spacing(0.3)).unwrap();
        assert_eq!(targets.groups.len(), 4);
        let areas = targets.group_weights();
        assert!(areas.iter().all(|area| (area - 2.0).abs() < 1e-5), "{areas:?}");
        let surface = targets.surface().unwrap();
        // the first face has no value, the others that of their number
        let values: Vec<f32> =
            surface.pieces.iter().map(|piece| if piece.face == 0 { f32::NAN } else { piece.face as f32 }).collect();
        let means = FaceMeans::new(&mesh, surface, &values);
        assert!(means.faces[0].is_nan());
        assert!(means.faces[1..].iter().zip([1.0, 2.0, 3.0]).all(|(mean, face)| (mean - face).abs() < 1e-6));
        assert!((means.objects[0] - 1.0).abs() < 1e-6 && (means.objects[1] - 2.5).abs() < 1e-6, "{means:?}");
        let whole = Mesh { object_names: Vec::new(), objects: Vec::new(), ..mesh };
        assert!((FaceMeans::new(&whole, surface, &values).objects[0] - 2.0).abs() < 1e-6);
        assert!((object_areas(&whole, surface)[0] - 8.0).abs() < 1e-5);
    }

    #[test]
    fn level_targets_have_no_normals_and_lifted_ones_lie_before_their_face() {
        let params = MeshParams::default().with_facing(Facing::Level).with_lift(0.25).with_seed(7);
        let targets = Targets::of_mesh(&mesh(), &Frame::default(), &params).unwrap();
        assert!(targets.normals.is_none());
        assert!(targets.positions.iter().all(|p| (p[2] - 0.25).abs() < 1e-6));
    }
}
