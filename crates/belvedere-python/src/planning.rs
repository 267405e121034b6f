//! Sun on walks and windows, and how high one may build.

use crate::arrays::{to_1d, to_2d};
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::{PyScene, local_ring};
use crate::targets::{Grid, PyColumn, grid_of};
use crate::windows::{WindowRow, given};
use belvedere::Frame;
use belvedere::apps::ask::{self, GivenWindows, Places, Protected, ProtectedShape, RoutesOrWindows};
use belvedere::apps::targets::Route;
use belvedere::ground::GroundPoints;
use pyo3::prelude::*;
use pyo3::types::PyDict;

fn local(corners: &[[f64; 3]], frame: &Frame) -> Vec<[f64; 3]> {
    corners.iter().map(|&corner| frame.local_from_file(corner)).collect()
}

/// Columns by name, and remarks.
pub(crate) type PyTable<'py> = (Bound<'py, PyDict>, Remarks<'py>);

#[pymethods]
impl PyScene {
    /// Columns of the places of routes, or of windows. The corners of routes are in the coordinates of the file; z is
    /// NaN where it follows from the ground.
    fn comfort<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::ComfortQuestion>,
        routes: Vec<Vec<[f64; 3]>>,
        windows: Vec<WindowRow>,
        ground: Data<GroundPoints>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyTable<'py>> {
        let frame = self.0.frame();
        let along = match &windows[..] {
            [] => RoutesOrWindows::Routes(routes.iter().map(|corners| local(corners, frame)).collect()),
            windows => RoutesOrWindows::Windows(GivenWindows::Each(given(windows, frame))),
        };
        let question = ask::ComfortQuestion { along, ground: ground.0, ..question.0 };
        let answers = self.ask(py, progress, question, Places::Scene)?;
        let found = &answers.found;
        let dict = PyDict::new(py);
        let places: Vec<[f64; 3]> = match &windows[..] {
            [] => found.routes.iter().flat_map(|route| &route.places).map(|&p| frame.file_from_local(p)).collect(),
            windows => windows.iter().map(|&[x, y, z, ..]| [x, y, z]).collect(),
        };
        dict.set_item("place", to_2d(py, &places)?)?;
        if windows.is_empty() {
            let groups = found.targets.groups.iter().zip(1_u32..);
            let routes = groups.flat_map(|(group, number)| group.clone().map(move |_| number)).collect();
            dict.set_item("route", to_1d(py, routes))?;
            let distances: Vec<f64> = found.routes.iter().flat_map(Route::distances).collect();
            dict.set_item("distance_m", to_1d(py, distances))?;
            for measure in answers.measures {
                dict.set_item(measure.name, to_1d(py, measure.values))?;
            }
        } else {
            for (number, measure) in answers.measures.iter().enumerate() {
                dict.set_item(&measure.name, to_1d(py, found.exposure.of_groups(number, &found.targets)))?;
            }
        }
        Ok((dict, remarks_of(py, &answers.remarks)?))
    }

    /// Heights of the solar envelope above the ground, their grid, and remarks. Rings of the parcel and protected lines
    /// are in the coordinates of the file.
    fn envelope<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::EnvelopeQuestion>,
        parcel: Vec<Vec<[f64; 2]>>,
        protect: Vec<Vec<[f64; 3]>>,
        ground: Data<GroundPoints>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(PyColumn<'py>, Grid, Remarks<'py>)> {
        let protected = |(number, line): (usize, &Vec<[f64; 3]>)| {
            let corners = local(line, self.0.frame());
            let shape = match corners[..] {
                [place] => ProtectedShape::Point(place),
                _ => ProtectedShape::Lines(vec![corners]),
            };
            Protected { name: format!("protected line {number}"), shape }
        };
        let question = ask::EnvelopeQuestion {
            ground: ground.0,
            parcel: parcel.iter().map(|ring| local_ring(&self.0, ring)).collect(),
            protect: (1..).zip(&protect).map(protected).collect(),
            ..question.0
        };
        let answers = self.ask(py, progress, question, Places::Scene)?;
        let envelope = &answers.found.envelope;
        let what = answers.measures.first().map_or("", |height| height.description);
        let heights = to_1d(py, envelope.heights().values().to_vec()).into_any();
        let column = ("height".to_owned(), what, heights);
        Ok((column, grid_of(&envelope.grid, self.0.frame()), remarks_of(py, &answers.remarks)?))
    }
}
