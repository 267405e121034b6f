//! Sun on walks and windows, and how high one may build.

use crate::arrays::{to_1d, to_2d};
use crate::remarks::remarks_of;
use crate::scene::PyScene;
use crate::scene::local_ring;
use crate::sky::{DaysKeywords, sky_parts};
use crate::sun::SiteKeywords;
use crate::targets::{Grid, PyColumn, grid_of, ground_points};
use crate::windows::{WindowRow, given};
use crate::work::run;
use belvedere::Frame;
use belvedere::apps::ask::{self, Protected, ProtectedShape, ProtectedSuns, RoutesOrWindows};
use belvedere::apps::solar_envelope::EnvelopeParams;
use belvedere::apps::targets::Route;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Places of comfort.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Walks {
    /// Corners in the coordinates of the file; z is NaN where it follows from the ground.
    routes: Vec<Vec<[f64; 3]>>,
    windows: Vec<WindowRow>,
    step: Option<f64>,
    height: Option<f64>,
    directions: Option<usize>,
    ground: Option<String>,
}

/// Protected objects and bounds of an envelope.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct EnvelopeKeywords {
    parcel: Vec<Vec<[f64; 2]>>,
    protect: Vec<Vec<[f64; 3]>>,
    /// Azimuths and elevations, degrees; empty for days.
    suns: Vec<[f64; 2]>,
    between: Option<[f64; 2]>,
    fence_height: Option<f64>,
    spacing: Option<f64>,
    max_height: Option<f64>,
    credit_shade: bool,
    cell: Option<f64>,
    ground: Option<String>,
}

fn local(corners: &[[f64; 3]], frame: &Frame) -> Vec<[f64; 3]> {
    corners.iter().map(|&corner| frame.local_from_file(corner)).collect()
}

impl Walks {
    fn question(&self, days: &DaysKeywords, place: &SiteKeywords, frame: &Frame) -> PyResult<ask::ComfortQuestion> {
        let along = match &self.windows[..] {
            [] => RoutesOrWindows::Routes(self.routes.iter().map(|corners| local(corners, frame)).collect()),
            windows => RoutesOrWindows::Windows(given(windows, frame)),
        };
        Ok(ask::ComfortQuestion {
            days: days.chosen(),
            place: place.chosen()?,
            sky: sky_parts(self.directions, None)?,
            distance_step_m: self.step,
            target_height: self.height,
            ground: ground_points(self.ground.as_deref())?,
            along,
            ..ask::ComfortQuestion::default()
        })
    }
}

impl EnvelopeKeywords {
    fn question(
        &self,
        days: &DaysKeywords,
        place: &SiteKeywords,
        scene: &ask::Scene,
    ) -> PyResult<ask::EnvelopeQuestion> {
        let suns = match &self.suns[..] {
            [] => ProtectedSuns::Days { days: days.chosen(), hours: self.between },
            suns => ProtectedSuns::Directions(suns.to_vec()),
        };
        let protected = |(number, line): (usize, &Vec<[f64; 3]>)| {
            let corners = local(line, scene.frame());
            let shape = match corners[..] {
                [place] => ProtectedShape::Point(place),
                _ => ProtectedShape::Lines(vec![corners]),
            };
            Protected { name: format!("protected line {number}"), shape }
        };
        Ok(ask::EnvelopeQuestion {
            suns,
            place: place.chosen()?,
            fence_height: self.fence_height.unwrap_or(0.0),
            spacing: self.spacing,
            cell: self.cell,
            params: EnvelopeParams::default().with_ceiling(self.max_height),
            credit_shade: self.credit_shade,
            ground: ground_points(self.ground.as_deref())?,
            parcel: self.parcel.iter().map(|ring| local_ring(scene, ring)).collect(),
            protect: (1..).zip(&self.protect).map(protected).collect(),
            ..ask::EnvelopeQuestion::default()
        })
    }
}

/// Columns by name, and remarks.
type PyTable<'py> = (Bound<'py, PyDict>, Vec<Bound<'py, PyDict>>);

#[pymethods]
impl PyScene {
    /// Columns of the places of routes, or of windows.
    fn comfort<'py>(
        &self,
        py: Python<'py>,
        walks: Walks,
        days: DaysKeywords,
        place: SiteKeywords,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyTable<'py>> {
        let scene = Arc::clone(&self.0);
        let question = walks.question(&days, &place, scene.frame())?;
        let answers = run(py, progress, move |control| ask::ask(&scene, &question, &ask::Places::Scene, control))?;
        let (found, frame) = (&answers.found, self.0.frame());
        let dict = PyDict::new(py);
        let places: Vec<[f64; 3]> = match &walks.windows[..] {
            [] => found.routes.iter().flat_map(|route| &route.places).map(|&p| frame.file_from_local(p)).collect(),
            windows => windows.iter().map(|&[x, y, z, ..]| [x, y, z]).collect(),
        };
        dict.set_item("place", to_2d(py, &places)?)?;
        if walks.windows.is_empty() {
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

    /// Heights of the solar envelope above the ground, their grid, and remarks.
    fn envelope<'py>(
        &self,
        py: Python<'py>,
        build: EnvelopeKeywords,
        days: DaysKeywords,
        place: SiteKeywords,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(PyColumn<'py>, Grid, Vec<Bound<'py, PyDict>>)> {
        let scene = Arc::clone(&self.0);
        let question = build.question(&days, &place, &scene)?;
        let answers = run(py, progress, move |control| ask::ask(&scene, &question, &ask::Places::Scene, control))?;
        let envelope = &answers.found.envelope;
        let what = answers.measures.first().map_or("", |height| height.description);
        let heights = to_1d(py, envelope.heights().values().to_vec()).into_any();
        let column = ("height".to_owned(), what, heights);
        Ok((column, grid_of(&envelope.grid, self.0.frame()), remarks_of(py, &answers.remarks)?))
    }
}
