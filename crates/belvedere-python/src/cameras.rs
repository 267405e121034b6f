//! Placement of cameras for maximum coverage.

use crate::arrays::{to_1d, to_2d};
use crate::errors::wrong;
use crate::remarks::remarks_of;
use crate::scene::{PyScene, unproven_as};
use crate::sun::SiteKeywords;
use crate::targets::{Grid, RequestedTargets, grid_of, ground_points};
use crate::visibility::earth;
use crate::work::run;
use belvedere::Frame;
use belvedere::apps::ask::{
    self, CameraGoal, CameraLens, CamerasResults, Candidates, GivenCamera, North, PrivatePlaces, Standing,
};
use belvedere::apps::cameras::{CameraPose, Level};
use belvedere::query::UnprovenAs;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Pixels per metre, or the name of a level.
#[derive(FromPyObject)]
enum DensityKeyword {
    Level(String),
    Number(f64),
}

/// Cameras to choose from, and the goal of the choice.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct CameraKeywords {
    /// x, y and z in the coordinates of the file, z NaN where it follows from the ground; `None` for a grid.
    candidates: Option<Vec<[f64; 3]>>,
    on_roofs: bool,
    spacing: f64,
    camera_height: Option<f64>,
    /// x, y, z, heading and tilt in degrees, NaN where they do not matter.
    existing: Vec<[f64; 5]>,
    private: Vec<[f64; 3]>,
    weights: Option<Vec<f64>>,
    fov: Option<f64>,
    vertical_fov: Option<f64>,
    pixels: Option<f64>,
    density: Option<DensityKeyword>,
    headings: Option<usize>,
    tilts: Option<Vec<f64>>,
    turning: bool,
    min_distance: Option<f64>,
    max_distance: Option<f64>,
    count: Option<usize>,
    coverage: Option<f64>,
    per_target: u32,
    search_limit: Option<usize>,
    curvature: Option<String>,
    refraction: Option<f64>,
    frequency: Option<f64>,
    fresnel_percent: Option<f64>,
    certain: Option<f64>,
}

impl CameraKeywords {
    /// The question, with places as the native part has them.
    fn question(&self, scene: &ask::Scene, north: North, unproven: UnprovenAs) -> PyResult<ask::CamerasQuestion> {
        let goal = match (self.count, self.coverage) {
            (Some(count), None) => CameraGoal::Count(count),
            (None, Some(percent)) => CameraGoal::CoveragePercent(percent),
            _ => return Err(wrong("count and coverage_percent", "not one of them", "give one of them")),
        };
        let local = |place: [f64; 3]| scene.frame().local_from_file(place);
        let camera = |place: [f64; 3]| GivenCamera { place: local(place), ..GivenCamera::default() };
        let given = |angle: f64| angle.is_finite().then_some(angle);
        let stays = |&[x, y, z, heading, tilt]: &[f64; 5]| GivenCamera {
            heading_deg: given(heading),
            tilt_deg: given(tilt),
            ..camera([x, y, z])
        };
        let private = self.private.iter().map(|&place| Standing { place: local(place), height: None }).collect();
        Ok(ask::CamerasQuestion {
            goal,
            per_target: self.per_target,
            search_limit: self.search_limit,
            candidates: match &self.candidates {
                Some(places) => Candidates::Given(places.iter().map(|&place| camera(place)).collect()),
                None if self.on_roofs => Candidates::Roofs(self.spacing),
                None => Candidates::Ground(self.spacing),
            },
            existing: self.existing.iter().map(stays).collect(),
            camera_height: self.camera_height,
            lens: self.lens()?,
            targets: ask::CameraTargets {
                weights: self.weights.clone().unwrap_or_default(),
                private: if self.private.is_empty() { PrivatePlaces::Nowhere } else { PrivatePlaces::Points(private) },
                ..ask::CameraTargets::default()
            },
            north,
            earth: earth(self.curvature.as_deref(), self.refraction)?,
            frequency_ghz: self.frequency,
            fresnel_percent: self.fresnel_percent,
            unproven: (unproven != UnprovenAs::Reported).then_some(unproven),
            certain: self.certain,
        })
    }

    fn lens(&self) -> PyResult<CameraLens> {
        let density = match &self.density {
            None => None,
            Some(DensityKeyword::Number(density)) => Some(*density),
            Some(DensityKeyword::Level(name)) if name == "none" => Some(0.0),
            Some(DensityKeyword::Level(name)) => match Level::ALL.iter().find(|(own, _)| own == name) {
                Some((_, level)) => Some(level.pixels_per_metre()),
                None => {
                    let advice = "use a number, 'monitor', 'detect', 'observe', 'recognise', 'identify' or 'none'";
                    return Err(wrong("density", &format!("'{name}'"), advice));
                }
            },
        };
        Ok(CameraLens {
            fov_deg: self.fov,
            vertical_fov_deg: self.vertical_fov,
            pixels: self.pixels,
            density,
            headings: self.headings,
            tilts_deg: self.tilts.clone().unwrap_or_default(),
            is_turning: self.turning,
            min_distance: self.min_distance,
            max_distance: self.max_distance,
        })
    }
}

/// Columns of the cameras, numbers of the whole, cameras of each target, the grid of the targets, and remarks.
type CamerasReply<'py> =
    (Bound<'py, PyDict>, Bound<'py, PyDict>, Bound<'py, PyArray1<u32>>, Option<Grid>, Vec<Bound<'py, PyDict>>);

#[pymethods]
impl PyScene {
    fn cameras<'py>(
        &self,
        py: Python<'py>,
        choice: CameraKeywords,
        targets: RequestedTargets<'py>,
        place: SiteKeywords,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<CamerasReply<'py>> {
        let scene = Arc::clone(&self.0);
        let mut question = choice.question(&scene, place.north(), unproven_as(unproven)?)?;
        question.targets.height = targets.height().unwrap_or(question.targets.height);
        question.targets.ground = ground_points(targets.ground())?;
        let places = targets.chosen(py, &scene)?.places;
        let answers = run(py, progress, move |control| ask::ask(&scene, &question, &places, control))?;
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
