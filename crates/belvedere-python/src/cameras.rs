//! Placement of cameras for maximum coverage.

use crate::arrays::{to_1d, to_2d};
use crate::errors::wrong;
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::PyScene;
use crate::targets::{Grid, RequestedTargets, grid_of};
use belvedere::Frame;
use belvedere::apps::ask::{self, CamerasResults, Candidates, GivenCamera, PrivatePlaces, Standing};
use belvedere::apps::cameras::{CameraPose, Level};
use belvedere::query::EarthParams;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Pixels per metre, or the name of a level.
#[derive(FromPyObject)]
enum DensityKeyword {
    Level(String),
    Number(f64),
}

impl DensityKeyword {
    fn pixels_per_metre(&self) -> PyResult<f64> {
        match self {
            Self::Number(density) => Ok(*density),
            Self::Level(name) if name == "none" => Ok(0.0),
            Self::Level(name) => match Level::ALL.iter().find(|(own, _)| own == name) {
                Some((_, level)) => Ok(level.pixels_per_metre()),
                None => {
                    let advice = "use a number, 'monitor', 'detect', 'observe', 'recognise', 'identify' or 'none'";
                    Err(wrong("density", &format!("'{name}'"), advice))
                }
            },
        }
    }
}

/// Cameras to choose from, and what they are to see, in the coordinates of the file.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct CameraKeywords {
    /// x, y and z, z NaN where it follows from the ground; `None` for those of the question.
    candidates: Option<Vec<[f64; 3]>>,
    /// x, y, z, heading and tilt in degrees, NaN where they do not matter.
    existing: Vec<[f64; 5]>,
    private: Vec<[f64; 3]>,
    weights: Vec<f64>,
    density: Option<DensityKeyword>,
}

impl CameraKeywords {
    /// Fills a question with the cameras and places.
    fn fill(self, question: &mut ask::CamerasQuestion, scene: &ask::Scene) -> PyResult<()> {
        let local = |place: [f64; 3]| scene.frame().local_from_file(place);
        let camera = |place: [f64; 3]| GivenCamera { place: local(place), ..GivenCamera::default() };
        let given = |angle: f64| angle.is_finite().then_some(angle);
        let stays = |[x, y, z, heading, tilt]: [f64; 5]| GivenCamera {
            heading_deg: given(heading),
            tilt_deg: given(tilt),
            ..camera([x, y, z])
        };
        if let Some(places) = self.candidates {
            question.candidates = Candidates::Given(places.into_iter().map(camera).collect());
        }
        question.existing = self.existing.into_iter().map(stays).collect();
        if let Some(density) = &self.density {
            question.lens.density = Some(density.pixels_per_metre()?);
        }
        question.targets.weights = self.weights;
        if !self.private.is_empty() {
            let standing = |place| Standing { place: local(place), height: None };
            question.targets.private = PrivatePlaces::Points(self.private.into_iter().map(standing).collect());
        }
        Ok(())
    }
}

/// Columns of the cameras, numbers of the whole, cameras of each target, the grid of the targets, and remarks.
type CamerasReply<'py> =
    (Bound<'py, PyDict>, Bound<'py, PyDict>, Bound<'py, PyArray1<u32>>, Option<Grid>, Remarks<'py>);

#[pymethods]
impl PyScene {
    fn cameras<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::CamerasQuestion>,
        earth: Data<EarthParams>,
        choice: CameraKeywords,
        targets: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<CamerasReply<'py>> {
        let mut question = question.0;
        choice.fill(&mut question, &self.0)?;
        (question.earth, question.targets.ground) = (earth.0, targets.ground.0);
        let places = targets.chosen(py, &self.0)?.places;
        let answers = self.ask(py, progress, question, places)?;
        let remarks = remarks_of(py, &answers.remarks)?;
        let found = &answers.found;
        let counts = (0..found.targets.len()).map(|row| found.count(row).unwrap_or(u32::MAX)).collect();
        let frame = self.0.frame();
        let grid = found.targets.ground().map(|ground| grid_of(&ground.grid, frame));
        Ok((columns(py, found, frame)?, whole(py, found)?, to_1d(py, counts), grid, remarks))
    }
}

/// A row for each camera.
fn columns<'py>(py: Python<'py>, found: &CamerasResults, frame: &Frame) -> PyResult<Bound<'py, PyDict>> {
    let of = |value: &dyn Fn(&CameraPose) -> f64| to_1d(py, found.cameras.iter().map(|one| value(&one.pose)).collect());
    let places: Vec<[f64; 3]> = found.cameras.iter().map(|one| frame.file_from_local(one.pose.camera.eye)).collect();
    let cameras = PyDict::new(py);
    cameras.set_item("place", to_2d(py, &places)?)?;
    cameras.set_item("heading_deg", of(&|pose| (pose.heading + found.grid_north).to_degrees().rem_euclid(360.0)))?;
    cameras.set_item("tilt_deg", of(&|pose| pose.tilt.to_degrees()))?;
    cameras.set_item("fov_deg", of(&|pose| pose.width.to_degrees()))?;
    cameras.set_item("is_existing", to_1d(py, found.cameras.iter().map(|one| !one.is_new).collect()))?;
    cameras.set_item("added_percent", to_1d(py, found.cameras.iter().map(|one| one.added_percent).collect()))?;
    let lengths = found.cameras.iter().map(|one| one.covered.len() as u64).collect();
    cameras.set_item("covered_targets", to_1d::<u64>(py, lengths))?;
    Ok(cameras)
}

/// Returns the proven properties of the selection.
fn whole<'py>(py: Python<'py>, found: &CamerasResults) -> PyResult<Bound<'py, PyDict>> {
    let placed = &found.placed;
    let whole = PyDict::new(py);
    whole.set_item("coverage_percent", 100.0 * placed.coverage())?;
    whole.set_item("best_possible_percent", 100.0 * placed.bound)?;
    whole.set_item("is_proven_optimum", placed.is_optimal())?;
    whole.set_item("all_candidates_percent", 100.0 * placed.reachable)?;
    whole.set_item("existing_only_percent", 100.0 * placed.curve.first().copied().unwrap_or(0.0))?;
    whole.set_item("least_possible_cameras", placed.min_count)?;
    whole.set_item("cameras_to_choose_from", found.candidates)?;
    let covered: Vec<_> = found.cameras.iter().map(|one| to_1d(py, one.covered.clone())).collect();
    whole.set_item("covered", covered)?;
    Ok(whole)
}
