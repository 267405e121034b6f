//! Scenes: from clouds and ball files.

use crate::cloud::{Cloud, PyInput, json};
use crate::device::backend;
use crate::errors::{belvedere_error, exception, wrong};
use crate::mesh::PyMesh;
use crate::remarks::{Remarks, remarks_of};
use crate::system::System;
use crate::work::run;
use belvedere::apps::ask;
use belvedere::apps::horizon::convergence;
use belvedere::apps::survey_reliability::ReliabilityParams;
use belvedere::cache::{SceneCache, scene_model};
use belvedere::clean::CleanParams;
use belvedere::crs::Crs;
use belvedere::io::{
    Output, is_ball_file, read_balls, read_horizon, read_mesh_in, read_stations, read_terrain, read_trajectory,
    write_balls,
};
use belvedere::medial::{CarvedParams, Rule, ShrinkMethod, ShrinkParams, Trees};
use belvedere::model::{BallParams, ClearedArea, ModelParams, OrientBy, SceneModel, StripHeights};
use belvedere::normals::estimate::Neighborhood;
use belvedere::strips::StripParams;
use belvedere::{Frame, PointCloud};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::borrow::Cow;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;

/// A scene: balls, pulses, and the cloud that they were made from.
#[pyclass(frozen, module = "belvedere._core", name = "Scene")]
pub(crate) struct PyScene(pub(crate) Arc<ask::Scene>);

/// The value of a library's type that has a name.
fn parse_name<T: Copy>(what: &'static str, name: &str, all: &[T], name_of: fn(T) -> &'static str) -> PyResult<T> {
    all.iter().copied().find(|&value| name_of(value) == name).ok_or_else(|| {
        let names: Vec<String> = all.iter().map(|&value| format!("'{}'", name_of(value))).collect();
        wrong(what, &format!("'{name}'"), &format!("use {}", names.join(", ")))
    })
}

/// Position of each station: a table, or the point source ids and positions in the coordinates of the file.
#[derive(FromPyObject)]
enum StationKeywords {
    Table(PathBuf),
    Places(Vec<(u16, [f64; 3])>),
}

impl StationKeywords {
    /// Ids and places, metres in the system of the cloud.
    fn read(&self, crs: &Crs) -> PyResult<Vec<(u16, [f64; 3])>> {
        let scale = crs.metres_per_unit_xyz();
        let metres = |place: &[f64; 3]| std::array::from_fn(|axis| place[axis] * scale[axis]);
        match self {
            Self::Table(path) => read_stations(path, crs).map_err(exception),
            Self::Places(places) => Ok(places.iter().map(|(id, place)| (*id, metres(place))).collect()),
        }
    }
}

/// Construction of balls; missing keywords have the library's defaults.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Choices {
    trees: Option<String>,
    orient: Option<String>,
    scanner: Option<[f64; 3]>,
    stations: Option<StationKeywords>,
    trajectory: Option<PathBuf>,
    mesh: Option<PathBuf>,
    method: Option<String>,
    without: Vec<String>,
    keep_noise: bool,
    keep_duplicates: bool,
    keep_isolated: bool,
    keep_strips: bool,
    neighbors: Option<usize>,
    initial_radius: Option<f32>,
    max_radius: Option<f32>,
    penetration: Option<f32>,
    cache: CacheKeyword,
}

/// Choice to keep scenes, and the folder.
#[derive(FromPyObject)]
enum CacheKeyword {
    Whether(bool),
    Folder(PathBuf),
}

impl CacheKeyword {
    fn cache(&self) -> Option<SceneCache> {
        match self {
            Self::Whether(false) => None,
            Self::Whether(true) => SceneCache::usual_folder(|name| std::env::var_os(name)).map(SceneCache::new),
            Self::Folder(folder) => Some(SceneCache::new(folder)),
        }
    }
}

impl Choices {
    fn clean(&self) -> CleanParams {
        let mut params = CleanParams::default();
        if self.keep_noise {
            params = params.keeping_noise();
        }
        if self.keep_duplicates {
            params = params.keeping_duplicates();
        }
        if self.keep_isolated {
            params = params.keeping_isolated();
        }
        params
    }

    fn strips(&self) -> StripHeights {
        if self.keep_strips { StripHeights::Kept(StripParams::default()) } else { StripHeights::default() }
    }

    fn orient(&self, frame: &Frame) -> PyResult<OrientBy> {
        if let Some(place) = self.scanner {
            return Ok(OrientBy::ScannerAt(place));
        }
        if let Some(stations) = &self.stations {
            return Ok(OrientBy::Stations(stations.read(&frame.crs)?));
        }
        if let Some(path) = &self.trajectory {
            return Ok(OrientBy::Trajectory(read_trajectory(path, &frame.crs).map_err(exception)?.0));
        }
        if let Some(path) = &self.mesh {
            return Ok(OrientBy::Mesh(read_mesh_in(path, &frame.crs).map_err(exception)?.0));
        }
        match self.orient.as_deref() {
            None | Some("auto") => Ok(OrientBy::Auto),
            Some("given") => Ok(OrientBy::Given),
            Some("up") => Ok(OrientBy::Up),
            Some("scanner") => Ok(OrientBy::Scanner),
            Some("pulses") => Ok(OrientBy::Pulses),
            Some(other) => {
                Err(wrong("orient", &format!("'{other}'"), "use 'auto', 'pulses', 'scanner', 'given' or 'up'"))
            }
        }
    }

    fn carved(&self) -> PyResult<CarvedParams> {
        let mut params = CarvedParams::default();
        params.penetration = self.penetration.unwrap_or(params.penetration);
        params.initial_radius = self.initial_radius.unwrap_or(params.initial_radius);
        params.max_radius = self.max_radius.unwrap_or(params.max_radius);
        if let Some(name) = self.trees.as_deref() {
            params = params.with_trees(parse_name("trees", name, &Trees::ALL, Trees::name)?);
        }
        for name in &self.without {
            params = params.without(parse_name("without", name, &Rule::ALL, Rule::name)?);
        }
        Ok(params)
    }

    fn shrunk(&self, mut params: ShrinkParams) -> ShrinkParams {
        params.initial_radius = self.initial_radius.unwrap_or(params.initial_radius);
        params.max_radius = self.max_radius.unwrap_or(params.max_radius);
        if let ShrinkMethod::Tau { penetration } = &mut params.method {
            *penetration = self.penetration.unwrap_or(*penetration);
        }
        params
    }

    fn balls(&self) -> PyResult<BallParams> {
        let is_plain = self.trees.is_none() && self.without.is_empty();
        let balls = match self.method.as_deref() {
            None => BallParams::CarvedIfPossible(self.carved()?, self.shrunk(ShrinkParams::tau_by_spacing())),
            Some("carved") => BallParams::Carved(self.carved()?),
            Some("tau") if is_plain => BallParams::Shrunk(self.shrunk(ShrinkParams::tau())),
            Some("angles") if is_plain => BallParams::Shrunk(self.shrunk(ShrinkParams::angles())),
            Some(method @ ("tau" | "angles")) => {
                return Err(wrong("method", &format!("'{method}'"), "trees and without need method 'carved'"));
            }
            Some(other) => return Err(wrong("method", &format!("'{other}'"), "use 'carved', 'tau' or 'angles'")),
        };
        balls.check().map_err(exception)?;
        Ok(balls)
    }

    fn params(&self, frame: &Frame) -> PyResult<ModelParams> {
        let neighborhood = self.neighbors.map_or_else(Neighborhood::default, |k| Neighborhood::Fixed { k });
        neighborhood.check().map_err(exception)?;
        let params = ModelParams::default().with_clean(self.clean()).with_neighborhood(neighborhood);
        let params = params.with_strips(self.strips());
        Ok(params.with_orient(self.orient(frame)?).with_balls(self.balls()?))
    }
}

#[pymethods]
impl PyScene {
    /// The scene of a cloud, the report on making it as JSON, and remarks.
    #[staticmethod]
    fn build<'py>(
        py: Python<'py>,
        cloud: &Cloud,
        choices: Choices,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Self, String, Remarks<'py>)> {
        let cloud = Arc::clone(&cloud.0);
        let params = py.detach(|| choices.params(&cloud.frame))?;
        let (given, cache) = (Arc::clone(&cloud), choices.cache.cache());
        let built = run(py, progress, {
            let cache = cache.clone();
            move |control| scene_model(Cow::Borrowed(&*given), &params, cache.as_ref(), control)
        })?;
        // the ground that is kept is that of lines fitted to each other
        let cache = cache.filter(|_| !choices.keep_strips);
        let store = cache.zip(built.cloud).map(|(cache, contents)| cache.ground_of(&contents));
        let mut report = built.report;
        report.insert("scene".to_owned(), built.origin.name().into());
        let remarks = remarks_of(py, &built.origin.remark())?;
        let scene = ask::Scene::new(built.model, cloud).with_ground_store(store);
        Ok((Self(Arc::new(scene)), json(&report)?, remarks))
    }

    /// Measures the reliability of answers on the survey of a cloud; returns JSON, and remarks.
    #[staticmethod]
    fn calibrate<'py>(
        py: Python<'py>,
        cloud: &Cloud,
        choices: Choices,
        share: f64,
        seed: u64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(String, Remarks<'py>)> {
        let cloud = Arc::clone(&cloud.0);
        let params = py.detach(|| choices.params(&cloud.frame))?;
        let kept_out = ReliabilityParams { share, seed };
        let answers = run(py, progress, move |control| ask::calibrate(&cloud, &params, &kept_out, control))?;
        Ok((json(&answers.found)?, remarks_of(py, &answers.remarks)?))
    }

    /// The scene of a ball file, with the cloud that shows its ground if there is one.
    #[staticmethod]
    fn load(py: Python<'_>, input: PyInput, cloud: Option<&Cloud>, progress: Option<Py<PyAny>>) -> PyResult<Self> {
        let cloud = cloud.map(|cloud| Arc::clone(&cloud.0));
        let (name, system) = (input.source().name().display().to_string(), cloud.as_ref().map(|c| c.frame.clone()));
        let model = run(py, progress, move |control| {
            if !is_ball_file(input.source())? {
                return Ok(None);
            }
            control.stage("reading balls", 0, || read_balls(input.source())).and_then(SceneModel::from_parts).map(Some)
        })?;
        let Some(model) = model else {
            let advice = "make a scene of a cloud: Scene(read(path))";
            return Err(belvedere_error(&format!("{name}: is no ball file; {advice}"), "ball file", &name, advice));
        };
        let frame = model.frame().clone();
        if let Some(given) = system.filter(|given| given.crs.contradicts(&frame.crs)) {
            let systems = format!("{}, but the scene is in {}", given.crs.describe(), frame.crs.describe());
            return Err(wrong("reference system of the cloud", &systems, "convert one of them"));
        }
        let cloud = match cloud {
            None => Arc::new(PointCloud::in_frame(frame)),
            Some(cloud) if cloud.frame == frame => cloud,
            Some(cloud) => Arc::new(PointCloud::clone(&cloud).moved_to(&frame)),
        };
        Ok(Self(Arc::new(ask::Scene::new(model, cloud))))
    }

    /// The same scene with meshes added.
    fn with_added(&self, py: Python<'_>, meshes: Vec<Py<PyMesh>>) -> PyResult<Self> {
        let inner = Arc::clone(&self.0);
        let model = run(py, None, move |_| {
            meshes.iter().map(Py::get).try_fold(inner.model().clone(), |model, mesh| {
                model.with_added(&mesh.in_metres(&inner)?, &mesh.name.display().to_string())
            })
        })?;
        Ok(Self(Arc::new(ask::Scene::of_fitted(model, Arc::clone(self.0.cloud())))))
    }

    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let inner = Arc::clone(&self.0);
        run(py, None, move |_| write_balls(&path, inner.model().parts()))
    }

    /// The bytes of an `.npz` ball file.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let inner = Arc::clone(&self.0);
        let bytes = run(py, None, move |_| {
            let mut bytes = Cursor::new(Vec::new());
            write_balls(Output::writer("scene.npz", &mut bytes), inner.model().parts())?;
            Ok(bytes.into_inner())
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The cloud, if the scene has its points.
    #[getter]
    fn cloud(&self) -> Option<Cloud> {
        (!self.0.cloud().is_empty()).then(|| Cloud(Arc::clone(self.0.cloud())))
    }

    #[getter]
    fn ball_count(&self) -> usize {
        self.0.model().balls().len()
    }

    /// The same scene without the objects in an area: rings of x and y in the coordinates of the file, or a class. With
    /// the report as JSON, and remarks.
    fn without<'py>(
        &self,
        py: Python<'py>,
        rings: Option<Vec<Vec<[f64; 2]>>>,
        class_: u8,
    ) -> PyResult<(Self, String, Remarks<'py>)> {
        let inner = Arc::clone(&self.0);
        let (model, cloud, report) = run(py, None, move |control| {
            let area = match rings {
                Some(rings) => ClearedArea::Polygon(rings.iter().map(|ring| local_ring(&inner, ring)).collect()),
                None => ClearedArea::Class(class_),
            };
            inner.model().clone().without(&area, inner.cloud(), control)
        })?;
        let remarks = remarks_of(py, &ask::remark_on_cleared(report.points_cleared))?;
        Ok((Self(Arc::new(ask::Scene::of_fitted(model, Arc::new(cloud)))), json(&report)?, remarks))
    }

    /// The same scene before the terrain of an elevation raster.
    fn with_terrain(&self, py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let inner = Arc::clone(&self.0);
        let model = run(py, None, move |_| {
            let terrain = read_terrain(&path, inner.frame())?;
            inner.model().clone().with_terrain(terrain, &path.display().to_string())
        })?;
        Ok(Self(Arc::new(ask::Scene::of_fitted(model, Arc::clone(self.0.cloud())))))
    }

    /// The same scene before the far terrain of a file.
    fn with_horizon(&self, py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let inner = Arc::clone(&self.0);
        let model = run(py, None, move |_| {
            let (low, high) = inner.model().bounds().corners();
            let frame = inner.frame();
            let middle = [0, 1].map(|i| f64::midpoint(low[i], high[i]) + frame.origin[i]);
            let of_grid = convergence(&frame.crs, middle).unwrap_or(0.0);
            Ok(inner.model().clone().with_horizon(read_horizon(&path)?.turned(-of_grid)))
        })?;
        Ok(Self(Arc::new(ask::Scene::of_fitted(model, Arc::clone(self.0.cloud())))))
    }

    /// The same scene, whose lines of sight a device decides.
    fn with_device(&self, py: Python<'_>, device: String) -> PyResult<Self> {
        let inner = Arc::clone(&self.0);
        let model = run(py, None, move |_| Ok(inner.model().clone().with_backend(backend(&device)?)))?;
        Ok(Self(Arc::new(ask::Scene::of_fitted(model, Arc::clone(self.0.cloud())))))
    }

    /// The name of the device that is ready for use, if any is.
    #[getter]
    fn device(&self) -> Option<String> {
        self.0.model().backend().and_then(|backend| backend.device())
    }

    /// Returns one line for each piece of work that fell to the processor, with the reason.
    #[getter]
    fn device_notes(&self) -> Vec<String> {
        self.0.model().backend().map_or_else(Vec::new, |backend| backend.notes())
    }

    #[getter]
    fn pulse_count(&self) -> Option<usize> {
        self.0.model().pulses().map(|pulses| pulses.starts.len())
    }

    #[getter]
    fn is_carved(&self) -> bool {
        self.0.model().is_carved()
    }

    #[getter]
    fn bounds(&self) -> [[f64; 3]; 2] {
        let bounds = self.0.model().bounds();
        [bounds.low, bounds.high].map(|corner| self.0.frame().to_file_coordinates(corner))
    }

    #[getter]
    fn crs(&self) -> System {
        System(self.0.frame().crs.clone())
    }

    #[getter]
    fn provenance(&self) -> Vec<(String, String)> {
        self.0.model().parts().provenance.iter().map(|(name, value)| (name.clone(), value.clone())).collect()
    }
}

/// A ring in local metres.
pub(crate) fn local_ring(inner: &ask::Scene, ring: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let local = |&[x, y]: &[f64; 2]| {
        let [x, y, _] = inner.frame().local_from_file([x, y, 0.0]);
        [x, y]
    };
    ring.iter().map(local).collect()
}
