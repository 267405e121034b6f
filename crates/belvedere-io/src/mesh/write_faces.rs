//! Bare meshes: vertices that faces share.

use crate::files::output::Output;
use crate::ply::write_ply::{header_start, plain};
use belvedere_data::crs::text::comment_lines;
use belvedere_data::{Error, Mesh, Result};

/// Decimals of coordinates in text: a tenth of a millimetre.
const DECIMALS: usize = 4;

/// Writes `mesh` in the unit of its file, which `metres_per_unit` (x, y, z) tells: Wavefront (.obj, coordinates to a
/// tenth of a millimetre) or binary PLY. Faces share their vertices, so that a closed mesh is closed in the file too.
///
/// # Errors
/// [`Error::UnknownFormat`] for another extension, [`Error::Io`].
pub fn write_mesh<'a>(output: impl Into<Output<'a>>, mesh: &Mesh, metres_per_unit: [f64; 3]) -> Result<()> {
    let output = output.into();
    let place = |vertex: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| vertex[i] / metres_per_unit[i]) };
    let comments = comment_lines(&mesh.crs);
    match output.extension().as_str() {
        "obj" => output.write(|path, output| {
            let mut text = String::from("# written by belvedere\n");
            comments.iter().for_each(|line| text.push_str(&format!("# {}\n", plain(line))));
            output.write_all(text.as_bytes()).map_err(Error::io(path))?;
            for vertex in &mesh.vertices {
                let [x, y, z] = place(vertex);
                writeln!(output, "v {x:.DECIMALS$} {y:.DECIMALS$} {z:.DECIMALS$}").map_err(Error::io(path))?;
            }
            for triangle in &mesh.triangles {
                // counted from 1
                let [a, b, c] = triangle.map(|corner| u64::from(corner) + 1);
                writeln!(output, "f {a} {b} {c}").map_err(Error::io(path))?;
            }
            Ok(())
        }),
        "ply" => output.write(|path, output| {
            let header = format!(
                "{}element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                header_start(&comments, mesh.vertices.len()),
                mesh.triangles.len()
            );
            let mut write = |bytes: &[u8]| output.write_all(bytes).map_err(Error::io(path));
            write(header.as_bytes())?;
            for value in mesh.vertices.iter().flat_map(place) {
                write(&value.to_le_bytes())?;
            }
            for triangle in &mesh.triangles {
                write(&[3])?;
                for corner in triangle {
                    write(&corner.to_le_bytes())?;
                }
            }
            Ok(())
        }),
        _ => Err(Error::UnknownFormat { path: output.name().to_owned(), kind: "mesh", supported: ".obj .ply" }),
    }
}
