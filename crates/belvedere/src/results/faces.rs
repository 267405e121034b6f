//! Measures of the faces of a mesh as files.

use crate::apps::targets::{FaceMeans, Measure, object_areas};
use crate::io::{Cells, write_mesh_values};
use crate::query::SurfacePieces;
use crate::{Frame, Mesh, Result};
use std::path::Path;

/// The mesh coloured by the mean of a measure over each face.
pub(super) fn write_colored(
    path: &Path,
    mesh: &Mesh,
    surface: &SurfacePieces,
    frame: &Frame,
    measure: &Measure,
) -> Result<()> {
    let values = surface.face_means(&measure.values);
    write_mesh_values(path, mesh, frame.crs.metres_per_unit_xyz(), &measure.name, &values, measure.span(&values))
}

/// A row for each object, without a face, then one for each face; a row for all faces together where the mesh knows no objects.
pub(super) fn write_table(path: &Path, mesh: &Mesh, surface: &SurfacePieces, measures: &[Measure]) -> Result<()> {
    let areas = surface.face_areas();
    let of_objects = object_areas(mesh, surface);
    let object_count = of_objects.len();
    let mut columns: Vec<(&str, Vec<f64>, usize)> = vec![("area_m2", [of_objects, areas.clone()].concat(), 4)];
    for measure in measures {
        let means = FaceMeans::new(mesh, surface, &measure.values);
        columns.push((&measure.name, [means.objects, means.faces].concat(), measure.decimals));
    }
    let name_of = |object: Option<usize>| object.and_then(|object| mesh.object_names.get(object));
    let of_face = |face: usize| mesh.objects.get(face).map(|&object| object as usize);
    let objects = (0..object_count).map(Some).chain((0..areas.len()).map(of_face));
    let words: Vec<&str> = objects.map(|object| name_of(object).map_or("", String::as_str)).collect();
    let faces = (0_u64..).take(areas.len()).map(Some);
    let numbers: Vec<Option<u64>> = std::iter::repeat_n(None, object_count).chain(faces).collect();
    let mut cells = vec![("object", Cells::Words(&words)), ("face", Cells::Whole(&numbers))];
    cells.extend(columns.iter().map(|(name, values, decimals)| (*name, Cells::Real(values, *decimals))));
    crate::io::write_table(path, &cells)
}
