//! Measures of the faces of a mesh as files.

use crate::apps::result_columns::ResultColumn;
use crate::apps::targets::{FaceMeans, Measure, object_areas};
use crate::io::write_mesh_values;
use crate::query::{SeenArea, SurfacePieces, seen_in_all, seen_objects};
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

/// A table of the faces of a mesh: a row for each object (one in all where the mesh knows no objects), then one for
/// each face.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceRows<'a> {
    /// Object of each row; empty where there is none.
    pub objects: Vec<&'a str>,
    /// Number of the first rows that are objects.
    pub object_count: usize,
    /// Its figures.
    pub columns: Vec<ResultColumn>,
}

impl<'a> FaceRows<'a> {
    /// Means of measures of the pieces of a mesh, by area.
    #[must_use]
    pub fn of_measures(mesh: &'a Mesh, surface: &SurfacePieces, measures: &[Measure]) -> Self {
        let areas = surface.face_areas();
        let of_objects = object_areas(mesh, surface);
        let object_count = of_objects.len();
        let objects = objects_of_rows(mesh, object_count, areas.len());
        let mut columns = vec![ResultColumn::real("area_m2", of_objects.into_iter().chain(areas), 4)];
        for measure in measures {
            let FaceMeans { objects, faces, .. } = FaceMeans::new(mesh, surface, &measure.values);
            columns.push(ResultColumn::real(&measure.name, objects.into_iter().chain(faces), measure.decimals));
        }
        Self { objects, object_count, columns }
    }

    /// Creates rows of the visible area of the faces of a mesh.
    #[must_use]
    pub fn of_seen(mesh: &'a Mesh, faces: &[SeenArea]) -> Self {
        let mut seen = match mesh.object_names.len() {
            0 => vec![seen_in_all(faces)],
            count => seen_objects(faces, &mesh.objects, count),
        };
        let object_count = seen.len();
        let objects = objects_of_rows(mesh, object_count, faces.len());
        seen.extend_from_slice(faces);
        let column = |name: &str, value: &dyn Fn(&SeenArea) -> f64| ResultColumn::real(name, seen.iter().map(value), 4);
        let columns = vec![
            column("area_m2", &|seen| seen.area),
            column("visible_m2", &|seen| seen.visible),
            column("visible_share", &SeenArea::visible_share),
            column("unproven_m2", &|seen| seen.unproven),
            column("standard_error_m2", &SeenArea::standard_error),
        ];
        Self { objects, object_count, columns }
    }

    /// Writes the rows as a table, with the number of the face where a row is one.
    ///
    /// # Errors
    /// Those of [`crate::io::write_table`].
    pub fn write(&self, path: &Path) -> Result<()> {
        let numbers = (0..self.objects.len()).map(|row| row.checked_sub(self.object_count));
        let rows = [ResultColumn::words("object", self.objects.iter().copied()), ResultColumn::whole("face", numbers)];
        crate::io::write_table(path, &[&rows, &self.columns[..]].concat())
    }
}

fn objects_of_rows(mesh: &Mesh, object_count: usize, face_count: usize) -> Vec<&str> {
    let of_face = |face: usize| mesh.objects.get(face).map(|&object| object as usize);
    let objects = (0..object_count).map(Some).chain((0..face_count).map(of_face));
    objects.map(|object| object.and_then(|object| mesh.object_names.get(object)).map_or("", String::as_str)).collect()
}
