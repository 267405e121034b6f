//! PLY files with faces.

use std::io::Cursor;

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

use crate::files::source::Source;
use crate::mesh::polygons::{MeshBuilder, MeshReport};
use crate::ply::read::scalar;
use belvedere_data::{Error, Mesh, Result};

/// A vertex or a face, whichever the element being read is.
#[derive(Default)]
struct Element {
    position: [Option<f64>; 3],
    corners: Vec<i64>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            "vertex_indices" | "vertex_index" => {
                return list(property).map_or(PropertyAccessResult::UnsupportedType, |corners| {
                    self.corners = corners;
                    PropertyAccessResult::Set
                });
            }
            _ => return PropertyAccessResult::Ignored,
        };
        scalar(&property).map_or(PropertyAccessResult::UnsupportedType, |value| {
            self.position[axis] = Some(value);
            PropertyAccessResult::Set
        })
    }
}

fn list(property: Property) -> Option<Vec<i64>> {
    Some(match property {
        Property::ListChar(v) => v.into_iter().map(Into::into).collect(),
        Property::ListUChar(v) => v.into_iter().map(Into::into).collect(),
        Property::ListShort(v) => v.into_iter().map(Into::into).collect(),
        Property::ListUShort(v) => v.into_iter().map(Into::into).collect(),
        Property::ListInt(v) => v.into_iter().map(Into::into).collect(),
        Property::ListUInt(v) => v.into_iter().map(Into::into).collect(),
        _ => return None,
    })
}

/// The triangles of a PLY file with `vertex` and `face` elements (text or either binary order), and counts of those
/// left out.
///
/// Polygons may be concave. Coordinates are taken as metres. The mesh has no objects.
///
/// # Errors
/// [`Error::Io`] where the file cannot be read, [`Error::Malformed`] for syntax errors, a file without faces, indices
/// without a vertex, and coordinates that are not finite.
pub(crate) fn read(source: Source<'_>) -> Result<(Mesh, MeshReport)> {
    let (name, bytes) = source.read_all()?;
    let path = name.as_path();
    let malformed = |e| Error::malformed(path, format!("not a readable PLY file: {e}"));
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(Cursor::new(bytes.as_slice()));
    let header = parser.read_header(&mut reader).map_err(malformed)?;
    for (name, element) in &header.elements {
        // every row takes at least a byte, so a larger count is a lie that would cost hours or all memory
        if element.count > bytes.len() || (element.properties.is_empty() && element.count > 0) {
            let what = format!("{} rows of element {name} do not fit into {} bytes", element.count, bytes.len());
            return Err(Error::malformed(path, what));
        }
    }
    let mut payload = parser.read_payload(&mut reader, &header).map_err(malformed)?;
    let vertices = payload.swap_remove("vertex").unwrap_or_default();
    let faces = payload.swap_remove("face").unwrap_or_default();
    if faces.is_empty() {
        return Err(Error::malformed(path, "no faces; a PLY file of points can be read as a point cloud only"));
    }
    let mut builder = MeshBuilder::new(path);
    for (row, vertex) in vertices.iter().enumerate() {
        let [Some(x), Some(y), Some(z)] = vertex.position else {
            return Err(Error::malformed(path, format!("vertex {row} lacks x, y or z")));
        };
        builder.push_vertex([x, y, z])?;
    }
    for (row, face) in faces.iter().enumerate() {
        let ring = face
            .corners
            .iter()
            .map(|&i| u32::try_from(i).map_err(|_| Error::malformed(path, format!("face {row} refers to vertex {i}"))))
            .collect::<Result<Vec<u32>>>()?;
        builder.push_polygon(&[ring], None)?;
    }
    builder.finish()
}
