//! Meshes of any format, told apart by their extension.

use std::path::Path;

use super::cityjson::{LevelOfDetail, read_cityjson};
use super::mesh_ply::read_mesh_ply;
use super::obj::read_obj;
use super::polygons::MeshReport;
use belvedere_data::{Error, Mesh, Result};

/// The mesh in a file (`.obj`, `.ply`, or CityJSON as `.city.json`, `.json`, `.cityjson`) and what was left out of it.
/// CityJSON is read at the highest level of detail of each object.
///
/// # Errors
/// [`Error::UnknownFormat`] for other extensions; otherwise as `read_obj`, `read_mesh_ply` and [`read_cityjson`].
pub fn read_mesh(path: &Path) -> Result<(Mesh, MeshReport)> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match extension.as_str() {
        "obj" => read_obj(path),
        "ply" => read_mesh_ply(path),
        "json" | "cityjson" => read_cityjson(path, &LevelOfDetail::Highest),
        _ => Err(Error::UnknownFormat {
            path: path.to_owned(),
            kind: "mesh",
            supported: ".obj, .ply, .city.json, .json or .cityjson",
        }),
    }
}
