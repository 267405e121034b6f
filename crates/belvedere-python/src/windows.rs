//! Views from windows.

use crate::arrays::{to_1d, to_2d};
use crate::errors::wrong;
use crate::mesh::Mesh;
use crate::scene::{Scene, unproven_as};
use crate::sun::Place;
use crate::targets::Column;
use crate::work::run;
use belvedere::Frame;
use belvedere::apps::ask::{self, GivenWindow, GivenWindows};
use belvedere::apps::targets::{Targets, Window, objects_of_windows};
use belvedere::apps::window_views::{
    ClassMeanings, Kinds, Proving, Seen, VIEW_DIRECTIONS, VIEW_SPACING, are_made_from, balls_seen, leave_out_level,
    leave_out_walled_up, named_columns, view_directions, view_measures, views_by_name, window_views,
};
use numpy::PyArray2;
use pyo3::prelude::*;
use std::sync::Arc;

/// x, y and z in the coordinates of the file, azimuth and tilt in degrees, width and height in metres (NaN where a window has none).
pub(crate) type WindowRow = [f64; 7];

/// Windows in a frame, `north` being the azimuth of grid north, radians.
pub(crate) fn windows_of(rows: &[WindowRow], frame: &Frame, north: f64) -> Vec<Window> {
    let window = |&[x, y, z, azimuth, tilt, width, height]: &WindowRow| {
        let size = (width.is_finite() && height.is_finite()).then_some([width, height]);
        Window::new(frame.local_from_file([x, y, z]), azimuth.to_radians() - north, tilt.to_radians(), size)
    };
    rows.iter().map(window).collect()
}

/// Windows as questions take them.
pub(crate) fn given(rows: &[WindowRow], frame: &Frame) -> GivenWindows {
    let window = |&[x, y, z, azimuth_deg, tilt_deg, width, height]: &WindowRow| {
        let size = (width.is_finite() && height.is_finite()).then_some([width, height]);
        GivenWindow { place: frame.local_from_file([x, y, z]), azimuth_deg, tilt_deg, size }
    };
    GivenWindows::Each(rows.iter().map(window).collect())
}

/// Which windows, and what the classes of points mean.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Facades {
    windows: Vec<WindowRow>,
    mesh: Option<Py<Mesh>>,
    objects: Vec<String>,
    spacing: Option<f64>,
    seed: u64,
    directions: Option<usize>,
    classes: Vec<(u8, String)>,
}

/// Windows, and the names of their buildings where these are known.
struct Asked {
    targets: Targets,
    windows: Vec<Window>,
    names: Vec<String>,
}

impl Facades {
    fn meanings(&self) -> PyResult<ClassMeanings> {
        self.classes.iter().try_fold(ClassMeanings::default(), |all, (class, name)| {
            let seen = Seen::thing_called(name).ok_or_else(|| {
                let advice = "use 'vegetation', 'water', 'building', 'ground' or 'other'";
                wrong("classes", &format!("'{name}'"), advice)
            })?;
            Ok(all.with(*class, seen))
        })
    }

    fn asked(&self, inner: &ask::Scene, north: f64) -> belvedere::Result<Asked> {
        let frame = inner.frame();
        let Some(mesh) = &self.mesh else {
            let windows = windows_of(&self.windows, frame, north);
            let targets = Targets::of_windows(&windows, frame.clone()).map_err(|(_, error)| error)?;
            return Ok(Asked { targets, windows, names: Vec::new() });
        };
        let mesh = mesh.get().objects_in_metres(&self.objects, inner)?;
        let spacing = self.spacing.unwrap_or(VIEW_SPACING);
        let (mut targets, windows) = Targets::of_window_faces(&mesh, frame, spacing, self.seed)?;
        leave_out_level(&mut targets);
        let names = objects_of_windows(&windows, &mesh);
        Ok(Asked { targets, windows, names })
    }
}

/// Columns, places, names, columns of buildings with their names, and how many targets were left out: outside the cloud, in an obstacle, of how many; whether
/// classes are known.
type Views<'py> = (
    Vec<Column<'py>>,
    Bound<'py, PyArray2<f64>>,
    Vec<String>,
    (Vec<String>, Vec<(&'static str, Bound<'py, PyAny>)>),
    (usize, usize, usize, bool),
);

#[pymethods]
impl Scene {
    fn window_views<'py>(
        &self,
        py: Python<'py>,
        facades: Facades,
        place: Place,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Views<'py>> {
        let unproven = unproven_as(unproven)?;
        let meanings = facades.meanings()?;
        let inner = Arc::clone(&self.0);
        let north = place.grid_north_of(&inner);
        let of_work = Arc::clone(&inner);
        let (asked, views, left_out, proving) = run(py, progress, move |control| {
            let inner = of_work;
            let directions = view_directions(facades.directions.unwrap_or(VIEW_DIRECTIONS))?;
            let mut asked = facades.asked(&inner, north)?;
            let scene = inner.blockers(unproven, control)?;
            let count = asked.targets.asked_count();
            let outside = inner.model().coverage().map_or(0, |coverage| asked.targets.leave_out_outside(&coverage));
            let inside = leave_out_walled_up(&mut asked.targets, &scene, control)?;
            let (model, cloud) = (inner.model(), inner.cloud());
            let classes = cloud.attributes.classification.as_deref();
            let classes = classes.filter(|_| are_made_from(model.balls(), &cloud.positions));
            let kinds = balls_seen(model.balls(), classes, model.vegetation(), &meanings)?;
            let proving = if scene.proof().is_some() { Proving::Asked } else { Proving::NotAsked };
            let views = control.stage("testing views", asked.targets.len(), || {
                let kinds = Kinds { balls: &kinds, meshes: &[] };
                window_views(&scene, &asked.targets, kinds, &directions, control)
            })?;
            Ok((asked, views, (outside, inside, count, classes.is_some()), proving))
        })?;
        let Asked { windows, names, .. } = asked;
        #[expect(clippy::cast_possible_truncation, reason = "angles in degrees and square metres")]
        let of =
            |value: &dyn Fn(&Window) -> f64| to_1d(py, windows.iter().map(|w| value(w) as f32).collect()).into_any();
        let azimuth = of(&|window| (window.azimuth + north).to_degrees().rem_euclid(360.0));
        let mut columns: Vec<Column<'py>> = vec![
            ("azimuth".to_owned(), "azimuth, degrees", azimuth),
            ("tilt".to_owned(), "tilt, degrees", of(&|window| window.tilt.to_degrees())),
        ];
        if windows.iter().all(|window| window.area.is_some()) {
            columns.push(("area_m2".to_owned(), "area", of(&|window| window.area.unwrap_or(f64::NAN))));
        }
        let measures = view_measures(&views, proving);
        columns.extend(measures.into_iter().map(|m| (m.name, m.description, to_1d(py, m.values).into_any())));
        let places: Vec<[f64; 3]> = windows.iter().map(|w| inner.frame().file_from_local(w.center)).collect();
        let weights: Vec<f64> = windows.iter().map(|window| window.area.unwrap_or(1.0)).collect();
        let of_windows: Vec<&str> = names.iter().map(String::as_str).collect();
        let buildings = views_by_name(&views, &of_windows, &weights);
        let counts = buildings.iter().map(|named| named.windows as u64).collect();
        let mut of_buildings = vec![("windows", to_1d::<u64>(py, counts).into_any())];
        let columns_of_buildings = named_columns(&buildings).into_iter();
        of_buildings.extend(columns_of_buildings.map(|(name, values)| (name, to_1d(py, values).into_any())));
        let of_names = buildings.into_iter().map(|named| named.name).collect();
        Ok((columns, to_2d(py, &places)?, names, (of_names, of_buildings), left_out))
    }
}
