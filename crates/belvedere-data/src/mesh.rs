//! Triangle meshes: city models to orient normals with, exact scenes, query objects.

use crate::crs::Crs;
use crate::vector::{cross, length, sub};

/// A triangle mesh in metres.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertices, (V, 3), metres (file coordinates times the unit of `crs`), f64 because there is no local origin.
    pub vertices: Vec<[f64; 3]>,
    /// Corners of each triangle, counter-clockwise seen from outside, (T, 3), indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// Object each triangle belongs to, (T), index into `object_names`; empty where the file knows no objects.
    pub objects: Vec<u32>,
    /// Name of each object.
    pub object_names: Vec<String>,
    /// Reference system of the file.
    pub crs: Crs,
}

impl Mesh {
    /// The mesh in metres, its vertices being in the unit of `crs`.
    #[must_use]
    pub fn scaled_to_metres(mut self, crs: &Crs) -> Self {
        let scale = crs.metres_per_unit_xyz();
        for vertex in &mut self.vertices {
            *vertex = std::array::from_fn(|i| vertex[i] * scale[i]);
        }
        self
    }

    /// The triangles of the objects of these names; vertices and names stay.
    #[must_use]
    pub fn of_objects(mut self, names: &[String]) -> Self {
        let is_named = |object: &u32| self.object_names.get(*object as usize).is_some_and(|name| names.contains(name));
        let kept = self.triangles.iter().zip(&self.objects).filter(|(_, object)| is_named(object));
        let (triangles, objects) = kept.map(|(&triangle, &object)| (triangle, object)).unzip();
        (self.triangles, self.objects) = (triangles, objects);
        self
    }

    /// Corners of triangle `index`, or `None` where it or one of its vertices does not exist.
    #[must_use]
    pub fn corners(&self, index: usize) -> Option<[[f64; 3]; 3]> {
        let [a, b, c] = *self.triangles.get(index)?;
        let vertex = |i: u32| self.vertices.get(i as usize).copied();
        Some([vertex(a)?, vertex(b)?, vertex(c)?])
    }

    /// Area of all triangles, m², those without all vertices left out.
    #[must_use]
    pub fn area(&self) -> f64 {
        let area = |[a, b, c]: [[f64; 3]; 3]| length(cross(sub(b, a), sub(c, a))) / 2.0;
        (0..self.triangles.len()).filter_map(|index| self.corners(index)).map(area).sum()
    }
}
