//! Views from windows.

use crate::arrays::{to_1d, to_2d};
use crate::errors::exception;
use crate::mesh::PyMesh;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::result_columns::{NamedColumns, to_python};
use crate::scene::PyScene;
use crate::targets::PyColumn;
use belvedere::Frame;
use belvedere::apps::ask::{self, GivenWindow, GivenWindows, SharedObject};
use belvedere::apps::targets::Window;
use belvedere::apps::window_views::named_columns;
use belvedere::vector::to_f32;
use numpy::PyArray2;
use pyo3::prelude::*;

/// x, y and z in the coordinates of the file, azimuth and tilt in degrees, width and height in metres (NaN where a
/// window has none).
pub(crate) type WindowRow = [f64; 7];

/// Windows as questions take them.
pub(crate) fn given(rows: &[WindowRow], frame: &Frame) -> Vec<GivenWindow> {
    let window = |&[x, y, z, azimuth_deg, tilt_deg, width, height]: &WindowRow| {
        let size = (width.is_finite() && height.is_finite()).then_some([width, height]);
        GivenWindow { place: frame.local_from_file([x, y, z]), azimuth_deg, tilt_deg, size }
    };
    rows.iter().map(window).collect()
}

/// Columns, places, names, columns of buildings with their names, and remarks.
type WindowsReply<'py> =
    (Vec<PyColumn<'py>>, Bound<'py, PyArray2<f64>>, Vec<String>, (Vec<String>, NamedColumns<'py>), Remarks<'py>);

#[pymethods]
impl PyScene {
    fn window_views<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::WindowViewsQuestion>,
        windows: Vec<WindowRow>,
        mesh: Option<Py<PyMesh>>,
        objects: Vec<String>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<WindowsReply<'py>> {
        let windows = match mesh {
            Some(mesh) => {
                let mesh = mesh.get().objects_in_metres(&objects, &self.0).map_err(exception)?;
                GivenWindows::Faces(SharedObject::new(mesh))
            }
            None => GivenWindows::Each(given(&windows, self.0.frame())),
        };
        let question = ask::WindowViewsQuestion { windows, ..question.0 };
        let answers = self.ask(py, progress, question, ask::Places::Scene)?;
        let found = answers.found;
        let floats = |values: Vec<f64>| to_1d(py, values.into_iter().map(to_f32).collect()).into_any();
        let of = |value: &dyn Fn(&Window) -> f64| floats(found.windows.iter().map(value).collect());
        let mut columns: Vec<PyColumn<'py>> = vec![
            ("azimuth".to_owned(), "azimuth, degrees", floats(found.azimuths_deg())),
            ("tilt".to_owned(), "tilt, degrees", of(&|window| window.tilt.to_degrees())),
        ];
        if found.windows.iter().all(|window| window.area.is_some()) {
            columns.push(("area_m2".to_owned(), "area", of(&|window| window.area.unwrap_or(f64::NAN))));
        }
        columns.extend(answers.measures.into_iter().map(|m| (m.name, m.description, to_1d(py, m.values).into_any())));
        let frame = self.0.frame();
        let places: Vec<[f64; 3]> = found.windows.iter().map(|w| frame.file_from_local(w.center)).collect();
        let buildings = found.by_name(&found.names);
        let counts = buildings.iter().map(|named| named.windows as u64).collect();
        let mut of_buildings = vec![("windows".to_owned(), to_1d::<u64>(py, counts).into_any())];
        of_buildings.extend(to_python(py, named_columns(&buildings))?);
        let of_names = buildings.into_iter().map(|named| named.name).collect();
        let remarks = remarks_of(py, &answers.remarks)?;
        Ok((columns, to_2d(py, &places)?, found.names, (of_names, of_buildings), remarks))
    }
}
