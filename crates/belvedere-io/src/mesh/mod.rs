//! Meshes of any format, which the extension of the file gives.

pub(crate) mod cityjson;
pub(crate) mod footprints;
pub(crate) mod obj;
#[cfg(feature = "ply")]
pub(crate) mod ply;
pub(crate) mod polygons;
pub(crate) mod simple_faces;
pub(crate) mod write;

use crate::files::source::{Source, SystemBeside, unusable};
use crate::mesh::cityjson::{LevelOfDetail, read_cityjson};
use crate::mesh::polygons::MeshReport;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Mesh, Result};
use std::io::Read;

/// The mesh of a source (`.obj`, `.ply`, or CityJSON as `.city.json`, `.json`, `.cityjson`, `.jsonl`) and counts of the
/// parts left out. CityJSON is read at the highest level of detail of each object. A mesh that names no reference
/// system has that of the file `.prj` beside it, if there is one.
///
/// # Errors
/// [`belvedere_data::Error::UnknownFormat`] for other extensions, [`belvedere_data::Error::MissingFeature`];
/// [`belvedere_data::Error::Io`] where the source cannot be read; [`belvedere_data::Error::Malformed`] for syntax
/// errors, indices without a vertex, coordinates that are not finite, and files without a triangle.
pub fn read_mesh<'a>(source: impl Into<Source<'a>>) -> Result<(Mesh, MeshReport)> {
    let source = source.into();
    let beside = source.system_beside();
    let (mut mesh, report) = match source.extension().as_str() {
        "obj" => obj::read(source)?,
        #[cfg(feature = "ply")]
        "ply" => ply::read(source)?,
        "json" | "cityjson" | "jsonl" => read_cityjson(source, &LevelOfDetail::Highest)?,
        _ => return Err(unusable(source.name(), "mesh", ".obj, .ply, .city.json, .city.jsonl, .json or .cityjson")),
    };
    if let Some(SystemBeside::Known { crs, .. }) = beside.filter(|_| mesh.crs == Crs::default()) {
        mesh.crs = crs;
    }
    Ok((mesh, report))
}

/// The same for a scene in the reference system `crs`, in metres.
///
/// # Errors
/// Those of [`read_mesh`], and [`belvedere_data::Error::UnusableCrs`] for a mesh in another system, or in degrees.
pub fn read_mesh_in<'a>(source: impl Into<Source<'a>>, crs: &Crs) -> Result<(Mesh, MeshReport)> {
    let source = source.into();
    let path = source.name().to_owned();
    let (mesh, report) = read_mesh(source)?;
    mesh.crs.check_for(crs, "mesh", &path)?;
    if let Some(what) = mesh.vertices.first().and_then(|&vertex| mesh.crs.refusal(vertex)) {
        return Err(Error::UnusableCrs { path, what });
    }
    Ok((mesh.scaled_to_metres(crs), report))
}

/// Start of a file in which the header of a PLY file ends.
const START_BYTES: u64 = 1 << 16;

/// Returns true if a source holds a mesh and no cloud, by its extension; for `.ply` by its header, which has faces.
/// `false` also for an unreadable file.
pub fn is_mesh<'a>(source: impl Into<Source<'a>>) -> bool {
    let source = source.into();
    match source.extension().as_str() {
        "obj" | "json" | "jsonl" | "cityjson" => true,
        "ply" => {
            let mut start = Vec::new();
            let read = source.into_reader().map(|(file, _)| file.take(START_BYTES).read_to_end(&mut start));
            let text = String::from_utf8_lossy(&start);
            let header = text.split("end_header").next().unwrap_or_default();
            let count = header.lines().find_map(|line| line.trim().strip_prefix("element face "));
            matches!(read, Ok(Ok(_))) && count.is_some_and(|count| count.trim() != "0")
        }
        _ => false,
    }
}
