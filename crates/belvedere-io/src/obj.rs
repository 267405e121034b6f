//! Wavefront OBJ meshes.

use super::polygons::{MeshBuilder, MeshReport};
use super::source::Input;
use belvedere_data::{Error, Mesh, Result};

/// Name the parser gives to faces that come before any `o` or `g` line.
const UNNAMED: &str = "unnamed_object";

/// The triangles of an OBJ file, one object per `o` or `g` line, and what was left out.
///
/// Polygons may be concave. Points, lines, materials and textures are passed over; a material library need not be
/// there. Coordinates are taken as metres.
///
/// # Errors
/// [`Error::Io`] where the file cannot be opened, [`Error::Malformed`] for syntax errors, indices without a vertex,
/// coordinates that are not finite, and files without a triangle.
pub(super) fn read(input: Input<'_>) -> Result<(Mesh, MeshReport)> {
    let Input { name, mut reader, .. } = input;
    let path = name.as_path();
    // the parser would cut polygons into fans, which is wrong for concave ones
    let options =
        tobj::LoadOptions { triangulate: false, ignore_points: true, ignore_lines: true, ..Default::default() };
    let (models, _materials) = tobj::load_obj_buf(&mut reader, &options, |_| Err(tobj::LoadError::GenericFailure))
        .map_err(|e| Error::malformed(path, format!("not a readable OBJ file: {e}")))?;
    let names_objects = models.iter().any(|model| model.name != UNNAMED);
    let mut builder = MeshBuilder::new(path);
    for model in &models {
        let object = names_objects.then(|| builder.push_object(&model.name));
        let offset = builder.mesh.vertices.len();
        for vertex in model.mesh.positions.chunks_exact(3) {
            builder.push_vertex([vertex[0], vertex[1], vertex[2]])?;
        }
        let offset = u32::try_from(offset).map_err(|_| Error::malformed(path, "too many vertices; split the file"))?;
        let mut rest = model.mesh.indices.as_slice();
        let mut arities = model.mesh.face_arities.iter();
        while !rest.is_empty() {
            let arity = arities.next().map_or(3, |&arity| arity as usize).clamp(1, rest.len());
            let (face, after) = rest.split_at(arity);
            rest = after;
            let ring = face.iter().map(|&i| i.saturating_add(offset)).collect();
            builder.push_polygon(&[ring], object)?;
        }
    }
    builder.finish()
}
