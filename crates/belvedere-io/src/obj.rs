//! Wavefront OBJ meshes.

use super::polygons::{MeshBuilder, MeshReport};
use super::source::Input;
use belvedere_data::{Error, Mesh, Result};
use std::io::{BufRead, Seek};

/// Name the parser gives to faces that come before any `o` or `g` line.
const UNNAMED: &str = "unnamed_object";

/// The line, from 1, of the first face with an index of a vertex that is not there, the index, and the number of
/// vertices of the file.
fn bad_face(reader: &mut (impl BufRead + Seek)) -> Option<(usize, i64, i64)> {
    reader.rewind().ok()?;
    let (mut count, mut faces) = (0_i64, Vec::new());
    for (number, line) in (1..).zip(reader.lines()) {
        let line = line.ok()?;
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => count += 1,
            Some("f") => {
                let indices = words.filter_map(|word| word.split('/').next()?.parse::<i64>().ok());
                // negative indices count from the last vertex before the face
                faces.extend(indices.map(|index| (number, index, if index < 0 { count + 1 + index } else { index })));
            }
            _ => {}
        }
    }
    let (line, index, _) = faces.into_iter().find(|(_, _, vertex)| !(1..=count).contains(vertex))?;
    Some((line, index, count))
}

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
        .map_err(|error| (error, bad_face(&mut reader)))
        .map_err(|(error, bad)| match bad {
            Some((line, index, count)) => {
                let what = format!("line {line}: a face refers to vertex {index}, but there are only {count} vertices");
                Error::malformed(path, what)
            }
            None => Error::malformed(path, format!("not a readable OBJ file: {error}")),
        })?;
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
