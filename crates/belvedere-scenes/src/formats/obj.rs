//! Wavefront OBJ text of a scene.

use std::fmt::Write as _;

use crate::scene::TriangleScene;

impl TriangleScene {
    /// Returns Wavefront OBJ text: vertices with millimetres in absolute coordinates, and one `o` group per object.
    /// Blanks in the name of an object become underscores. `usemtl` has the name of [`crate::Material::name`].
    #[must_use]
    pub fn to_obj(&self) -> String {
        let mut text = String::with_capacity(self.vertices.len() * 36 + self.triangles.len() * 24);
        text.push_str("# metres, x east, y north, z up\n");
        // Writing to a String cannot fail, so the results of write! carry nothing.
        for [x, y, z] in &self.vertices {
            let _ = writeln!(text, "v {x:.3} {y:.3} {z:.3}");
        }
        let (mut object_before, mut material_before) = (None, None);
        for ((corners, &object), &material) in self.triangles.iter().zip(&self.objects).zip(&self.materials) {
            if object_before != Some(object) {
                let name = self.object_names.get(object as usize).map_or("unnamed", String::as_str);
                let _ = writeln!(text, "o {}", name.replace(char::is_whitespace, "_"));
                object_before = Some(object);
                material_before = None;
            }
            if material_before != Some(material) {
                let _ = writeln!(text, "usemtl {}", material.name());
                material_before = Some(material);
            }
            let [a, b, c] = corners.map(|corner| u64::from(corner) + 1);
            let _ = writeln!(text, "f {a} {b} {c}");
        }
        text
    }
}
