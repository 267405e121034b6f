//! Views from windows.

use crate::arrays::{to_1d, to_2d};
use crate::errors::{exception, wrong};
use crate::mesh::PyMesh;
use crate::remarks::remarks_of;
use crate::result_columns::{NamedColumns, to_python};
use crate::scene::{PyScene, unproven_as};
use crate::sun::SiteKeywords;
use crate::targets::PyColumn;
use crate::work::run;
use belvedere::Frame;
use belvedere::apps::ask::{self, GivenWindow, GivenWindows, SharedObject};
use belvedere::apps::targets::Window;
use belvedere::apps::window_views::{SeenKind, named_columns};
use belvedere::query::UnprovenAs;
use belvedere::vector::to_f32;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// x, y and z in the coordinates of the file, azimuth and tilt in degrees, width and height in metres (NaN where a
/// window has none).
pub(crate) type WindowRow = [f64; 7];

/// Windows as questions take them.
pub(crate) fn given(rows: &[WindowRow], frame: &Frame) -> GivenWindows {
    let window = |&[x, y, z, azimuth_deg, tilt_deg, width, height]: &WindowRow| {
        let size = (width.is_finite() && height.is_finite()).then_some([width, height]);
        GivenWindow { place: frame.local_from_file([x, y, z]), azimuth_deg, tilt_deg, size }
    };
    GivenWindows::Each(rows.iter().map(window).collect())
}

/// Choice of windows, and meanings of the classes of points.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Facades {
    windows: Vec<WindowRow>,
    mesh: Option<Py<PyMesh>>,
    objects: Vec<String>,
    spacing: Option<f64>,
    seed: u64,
    directions: Option<usize>,
    classes: Vec<(u8, String)>,
}

impl Facades {
    fn question(
        &self,
        scene: &ask::Scene,
        place: &SiteKeywords,
        unproven: UnprovenAs,
    ) -> PyResult<ask::WindowViewsQuestion> {
        let meaning = |(class, name): &(u8, String)| {
            let advice = "use 'vegetation', 'water', 'building', 'ground' or 'other'";
            let seen = SeenKind::thing_called(name).ok_or_else(|| wrong("classes", &format!("'{name}'"), advice))?;
            Ok((*class, seen))
        };
        let windows = match &self.mesh {
            Some(mesh) => {
                let mesh = mesh.get().objects_in_metres(&self.objects, scene).map_err(exception)?;
                GivenWindows::Faces(SharedObject::new(mesh))
            }
            None => given(&self.windows, scene.frame()),
        };
        let usual = ask::WindowViewsQuestion::default();
        Ok(ask::WindowViewsQuestion {
            windows,
            north: place.north(),
            spacing: self.spacing.unwrap_or(usual.spacing),
            seed: self.seed,
            directions: self.directions.unwrap_or(usual.directions),
            classes: self.classes.iter().map(meaning).collect::<PyResult<_>>()?,
            unproven: (unproven != UnprovenAs::Reported).then_some(unproven),
        })
    }
}

/// Columns, places, names, columns of buildings with their names, and remarks.
type WindowsReply<'py> = (
    Vec<PyColumn<'py>>,
    Bound<'py, PyArray2<f64>>,
    Vec<String>,
    (Vec<String>, NamedColumns<'py>),
    Vec<Bound<'py, PyDict>>,
);

#[pymethods]
impl PyScene {
    fn window_views<'py>(
        &self,
        py: Python<'py>,
        facades: Facades,
        place: SiteKeywords,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<WindowsReply<'py>> {
        let question = facades.question(&self.0, &place, unproven_as(unproven)?)?;
        let scene = Arc::clone(&self.0);
        let answers = run(py, progress, move |control| ask::ask(&scene, &question, &ask::Places::Scene, control))?;
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
