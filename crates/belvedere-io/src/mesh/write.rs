//! Meshes: vertices that faces share, or a value and a colour for each face.

use crate::colors::ramp;
use crate::files::output::Output;
use crate::ply::write_ply::{header_start, plain};
use belvedere_data::crs::Crs;
use belvedere_data::crs::text::comment_lines;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Mesh, Parameter, Result};

/// Decimals of coordinates in text: a tenth of a millimetre.
const DECIMALS: usize = 4;
/// Colour of faces without a value.
const NO_VALUE: [u8; 3] = [128; 3];

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

/// Writes `mesh` as binary PLY in the unit of its file, which `metres_per_unit` (x, y, z) gives. Each of `values`, (T),
/// is the property `name` and has a colour: dark violet at the first of `range` over green to yellow at its second.
/// Values that are not finite are grey and NaN.
///
/// Every triangle has three vertices of its own, which bear its colour and value: many programs know neither of faces.
///
/// # Errors
/// [`Error::LengthMismatch`] unless there is a value for each triangle, [`Error::InvalidParameter`] for more than a
/// billion triangles, [`Error::Io`].
pub fn write_mesh_values<'a>(
    output: impl Into<Output<'a>>,
    mesh: &Mesh,
    metres_per_unit: [f64; 3],
    name: &str,
    values: &[f64],
    range: [f64; 2],
) -> Result<()> {
    if values.len() != mesh.triangles.len() {
        return Err(Error::LengthMismatch {
            what: "values of faces",
            expected: mesh.triangles.len(),
            found: values.len(),
        });
    }
    if mesh.triangles.len() > 1_000_000_000 {
        let value = mesh.triangles.len().to_string();
        return Err(Error::invalid(Parameter::Mesh, value, "a billion triangles at most"));
    }
    let faces: Vec<([[f64; 3]; 3], f64)> =
        values.iter().enumerate().filter_map(|(t, &value)| Some((mesh.corners(t)?, value))).collect();
    let header = header(&mesh.crs, name, faces.len());
    output.into().write(|path, output| {
        let mut write = |bytes: &[u8]| output.write_all(bytes).map_err(Error::io(path));
        write(header.as_bytes())?;
        for &(corners, value) in &faces {
            let color = if value.is_finite() { ramp((value - range[0]) / (range[1] - range[0])) } else { NO_VALUE };
            for corner in corners {
                for axis in 0..3 {
                    write(&(corner[axis] / metres_per_unit[axis]).to_le_bytes())?;
                }
                write(&color)?;
                write(&to_f32(value).to_le_bytes())?;
            }
        }
        for first in (0..).step_by(3).take(faces.len()) {
            write(&[3])?;
            for corner in 0..3_u32 {
                write(&(first + corner).to_le_bytes())?;
            }
        }
        Ok(())
    })
}

/// The header of a PLY file of `face_count` triangles with vertices of their own, whose values are called `name`.
fn header(crs: &Crs, name: &str, face_count: usize) -> String {
    format!(
        "{}property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float {name}\n\
         element face {face_count}\nproperty list uchar uint vertex_indices\nend_header\n",
        header_start(&comment_lines(crs), 3 * face_count)
    )
}
