//! Where cameras cover most.

use crate::arrays::{to_1d, to_2d};
use crate::errors::{belvedere_error, exception, wrong};
use crate::observers::{skip, skipped};
use crate::scene::{Scene, unproven_as};
use crate::sights::earth;
use crate::sun::Place;
use crate::targets::{Cells, Grid, Wanted, grid_of, ground_cloud, ground_points};
use crate::work::run;
use belvedere::apps::ask;
use belvedere::apps::cameras::{
    CAMERA_HEIGHT, CAMERA_TARGET_HEIGHT, CoverageParams, CoverageTable, FREE_FRESNEL_SHARE, FresnelZone, Goal, Lens,
    Level, Motion, Mount, MountingParams, Placement, PlacementParams, Pose, ROOF_CAMERA_HEIGHT, counted_weights,
    coverage, ground_places, leave_out_private, place_cameras, roof_places,
};
use belvedere::apps::eyes::{EyesReport, skip_unfit_eyes};
use belvedere::apps::landmark::observer_cell_for;
use belvedere::apps::targets::{CellLevel, Targets, set_on_ground};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundPoints};
use belvedere::query::{EarthParams, MedialScene, RadioWave};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Pixels per metre, or the name of a level.
#[derive(FromPyObject)]
enum Density {
    Level(String),
    Number(f64),
}

/// Cameras to choose from, and what is wanted of them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Choice {
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
    density: Option<Density>,
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
}

/// What is checked before the work begins.
struct Params {
    mounting: MountingParams,
    coverage: CoverageParams,
    earth: EarthParams,
    goal: Goal,
}

impl Choice {
    fn params(&self) -> PyResult<Params> {
        let mut lens = Lens::default().with_height(self.vertical_fov.map(f64::to_radians));
        if let Some(fov) = self.fov {
            lens = lens.with_width(fov.to_radians());
        }
        if let Some(pixels) = self.pixels {
            lens = lens.with_pixels(pixels);
        }
        lens.validate().map_err(exception)?;
        let density = match &self.density {
            None => None,
            Some(Density::Number(density)) => Some(*density),
            Some(Density::Level(name)) if name == "none" => Some(0.0),
            Some(Density::Level(name)) => match Level::ALL.iter().find(|(own, _)| own == name) {
                Some((_, level)) => Some(level.pixels_per_metre()),
                None => {
                    let advice = "use a number, 'monitor', 'detect', 'observe', 'recognise', 'identify' or 'none'";
                    return Err(wrong("density", &format!("'{name}'"), advice));
                }
            },
        };
        let usual = MountingParams::default();
        let (headings, tilts) = (self.headings.unwrap_or(usual.headings), usual.tilts.clone());
        let distance = [self.min_distance.unwrap_or(usual.distance[0]), self.max_distance.unwrap_or(usual.distance[1])];
        let mounting = usual
            .with_lens(lens)
            .with_motion(if self.turning { Motion::Turning } else { Motion::Fixed })
            .with_headings(headings)
            .with_tilts(self.tilts.as_ref().map_or(tilts, |given| given.iter().map(|t| t.to_radians()).collect()))
            .with_distance(distance);
        let goal = match (self.count, self.coverage) {
            (Some(count), None) => Goal::Count(count),
            (None, Some(percent)) => Goal::Coverage(percent / 100.0),
            _ => return Err(wrong("count and coverage_percent", "not one of them", "give one of them")),
        };
        let earth = earth(self.curvature.as_deref(), self.refraction)?;
        let share = self.fresnel_percent.map_or(FREE_FRESNEL_SHARE, |percent| percent / 100.0);
        let zone =
            self.frequency.map(|ghz| RadioWave::of_frequency(ghz).and_then(|wave| FresnelZone::new(wave, share)));
        let coverage = CoverageParams::default()
            .with_density(lens.required_density(density).map_err(exception)?)
            .with_earth(earth)
            .with_zone(zone.transpose().map_err(exception)?);
        Ok(Params { mounting, coverage, earth, goal })
    }

    /// Candidates and cameras that stay, with those that cannot look left out or NaN, and what is said of these.
    fn poses(
        &self,
        inner: &ask::Scene,
        scene: &MedialScene,
        ground: &Ground,
        (mounting, north, points): (&MountingParams, f64, GroundPoints),
        control: &Control<'_>,
    ) -> belvedere::Result<Standing> {
        let height = self.camera_height;
        let placed = |places: &mut [[f64; 3]], height: f64| {
            places.iter_mut().for_each(|place| *place = inner.frame().local_from_file(*place));
            set_on_ground(places.iter_mut().map(|place| (place, height)), ground);
        };
        let (mut eyes, mut report) = (Vec::new(), None);
        match &self.candidates {
            Some(places) => {
                eyes.clone_from(places);
                placed(&mut eyes, height.unwrap_or(CAMERA_HEIGHT));
                report = Some(skip(scene, Some(ground), &mut eyes, control)?);
            }
            None => {
                let cells = Cells { side: Some(self.spacing), height: None, level: CellLevel::Ground, ground: points };
                let grid = cells.ground_within(inner, inner.model().bounds().on_map(), control)?;
                let cloud = ground_cloud(inner)?;
                eyes = match self.on_roofs {
                    true => roof_places(cloud, grid, height.unwrap_or(ROOF_CAMERA_HEIGHT), control)?,
                    false => ground_places(cloud, grid, height.unwrap_or(CAMERA_HEIGHT), control)?,
                };
                skip_unfit_eyes(scene, Some(ground), &mut eyes, control)?;
            }
        }
        let mut candidates = Vec::new();
        for &eye in eyes.iter().filter(|eye| eye[0].is_finite()) {
            candidates.extend(mounting.poses_at(&Mount { eye, ..Mount::default() })?);
        }
        let mut stay: Vec<[f64; 3]> = self.existing.iter().map(|&[x, y, z, ..]| [x, y, z]).collect();
        placed(&mut stay, height.unwrap_or(CAMERA_HEIGHT));
        let of_existing = skip(scene, Some(ground), &mut stay, control)?;
        let existing = stay.into_iter().zip(&self.existing).map(|(eye, &[.., heading, tilt])| {
            let given = |angle: f64| angle.is_finite().then(|| angle.to_radians());
            let heading = given(heading).map(|heading| heading - north);
            mounting.existing_at(&Mount { eye, heading, tilt: given(tilt), ..Mount::default() })
        });
        Ok(Standing { candidates, existing: existing.collect::<belvedere::Result<_>>()?, report, of_existing })
    }

    fn private(&self, inner: &ask::Scene, ground: &Ground, height: f64) -> Targets {
        let mut places: Vec<[f64; 3]> =
            self.private.iter().map(|&place| inner.frame().local_from_file(place)).collect();
        set_on_ground(places.iter_mut().map(|place| (place, height)), ground);
        Targets::of_places(&places, inner.frame().clone())
    }
}

struct Standing {
    candidates: Vec<Pose>,
    existing: Vec<Pose>,
    /// Of candidates that were given.
    report: Option<EyesReport>,
    of_existing: EyesReport,
}

/// Everything that is answered.
struct Chosen {
    standing: Standing,
    /// Candidates without those that have a private place in their picture.
    allowed: usize,
    found: Option<(Vec<Pose>, CoverageTable, Placement)>,
    targets: Targets,
}

/// Columns of the cameras, numbers of the whole, cameras of each target, the grid of the targets, and what was skipped.
type Answer<'py> = (Bound<'py, PyDict>, Bound<'py, PyDict>, Bound<'py, PyArray1<u32>>, Option<Grid>, Vec<String>);

#[pymethods]
impl Scene {
    fn cameras<'py>(
        &self,
        py: Python<'py>,
        choice: Choice,
        targets: Wanted<'py>,
        place: Place,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Answer<'py>> {
        let unproven = unproven_as(unproven)?;
        let Params { mounting, coverage: seen_as, earth, goal } = choice.params()?;
        let seen_as = seen_as.with_unproven(unproven);
        let inner = Arc::clone(&self.0);
        let north = place.grid_north_of(&inner);
        let points = ground_points(targets.ground())?;
        let target_height = targets.height().unwrap_or(CAMERA_TARGET_HEIGHT);
        let (low, high) = inner.model().bounds().on_map();
        let side = Some(targets.cell().unwrap_or_else(|| observer_cell_for(low, high)));
        let cells = Cells { side, height: Some(target_height), level: CellLevel::Ground, ground: points };
        let places = match targets.chosen(py, &inner)?.places {
            ask::Places::Cells(usual) => {
                ask::Places::Cells(ask::Cells { cell: side, height: Some(target_height), ..usual })
            }
            others => others,
        };
        let of_work = Arc::clone(&inner);
        let given = choice.candidates.is_some();
        let chosen = run(py, progress, move |control| {
            let inner = of_work;
            let mut targets = Targets::clone(&*places.targets(&inner, &mut ask::Context::default(), control)?);
            if let Some(coverage) = inner.model().coverage() {
                targets.leave_out_outside(&coverage);
            }
            if let Some(weights) = &choice.weights {
                targets.weights.clone_from(weights);
            }
            let scene = inner.blockers(unproven, control)?;
            let ground = match targets.ground() {
                Some(ground) => ground.clone(),
                None => cells.ground_within(&inner, (low, high), control)?,
            };
            let standing = choice.poses(&inner, &scene, &ground, (&mounting, north, points), control)?;
            let mut candidates = standing.candidates.clone();
            if !choice.private.is_empty() {
                let private = choice.private(&inner, &ground, target_height);
                control.stage("testing private places", candidates.len(), || {
                    leave_out_private(&scene, &mut candidates, &private, &earth, control)
                })?;
            }
            let allowed = candidates.len();
            if allowed == 0 {
                return Ok(Chosen { standing, allowed, found: None, targets });
            }
            let poses: Vec<Pose> = standing.existing.iter().chain(&candidates).copied().collect();
            let cameras: Vec<_> = poses.iter().map(|pose| pose.camera).collect();
            let (table, _) = control.stage("testing lines of sight", cameras.len(), || {
                coverage(&scene, &cameras, &targets, &seen_as, control)
            })?;
            let params = PlacementParams::new(goal)
                .with_existing((0..standing.existing.len()).collect())
                .with_required(choice.per_target)
                .with_search_limit(choice.search_limit);
            let placed = control
                .stage("choosing cameras", 0, || place_cameras(&table, &counted_weights(&targets), &params, control))?;
            Ok(Chosen { standing, allowed, found: Some((poses, table, placed)), targets })
        })?;
        chosen.answer(py, &inner, given, north)
    }
}

impl Chosen {
    fn answer<'py>(&self, py: Python<'py>, inner: &ask::Scene, given: bool, north: f64) -> PyResult<Answer<'py>> {
        let mut sentences = skipped(inner, "existing camera", &self.standing.of_existing)?;
        if let Some(report) = &self.standing.report {
            sentences.extend(skipped(inner, "candidate", report)?);
        }
        let Some((poses, table, placed)) = &self.found else {
            let count = self.standing.candidates.len();
            let (value, advice) = match (count, given) {
                (0, _) => (
                    "without a place for a camera".to_owned(),
                    "all lie inside obstacles, below the ground or outside the cloud",
                ),
                _ => (
                    format!("{count} cameras with a private place in their picture"),
                    "give other candidates, or more headings",
                ),
            };
            return Err(belvedere_error(&format!("candidates are {value}: {advice}"), "candidates", &value, advice));
        };
        let existing = self.standing.existing.len();
        let rows: Vec<usize> = (0..existing).chain(placed.chosen.iter().copied()).collect();
        let frame = inner.frame();
        let of = |value: &dyn Fn(&Pose) -> f64| to_1d(py, rows.iter().map(|&row| value(&poses[row])).collect());
        let places: Vec<[f64; 3]> = rows.iter().map(|&row| frame.file_from_local(poses[row].camera.eye)).collect();
        let gains = placed.curve.windows(2).map(|pair| 100.0 * (pair[1] - pair[0]));
        let counts = |target: &usize| self.targets.weight(*target) > 0.0;
        let covered: Vec<Vec<usize>> = rows.iter().map(|&row| table.covered_by(row).filter(counts).collect()).collect();
        let cameras = PyDict::new(py);
        cameras.set_item("place", to_2d(py, &places)?)?;
        cameras.set_item("heading_deg", of(&|pose| (pose.heading + north).to_degrees().rem_euclid(360.0)))?;
        cameras.set_item("tilt_deg", of(&|pose| pose.tilt.to_degrees()))?;
        cameras.set_item("fov_deg", of(&|pose| pose.width.to_degrees()))?;
        cameras.set_item("is_existing", to_1d(py, (0..rows.len()).map(|number| number < existing).collect()))?;
        let added: Vec<f64> = std::iter::repeat_n(f64::NAN, existing).chain(gains).collect();
        cameras.set_item("added_percent", to_1d(py, added))?;
        let lengths = covered.iter().map(|targets| targets.len() as u64).collect();
        cameras.set_item("covered_targets", to_1d::<u64>(py, lengths))?;
        let whole = PyDict::new(py);
        whole.set_item("coverage_percent", 100.0 * placed.coverage())?;
        whole.set_item("best_possible_percent", 100.0 * placed.bound)?;
        whole.set_item("is_proven_optimum", placed.is_optimal())?;
        whole.set_item("all_candidates_percent", 100.0 * placed.reachable)?;
        whole.set_item("existing_only_percent", 100.0 * placed.curve.first().copied().unwrap_or(0.0))?;
        whole.set_item("least_possible_cameras", placed.least_count)?;
        whole.set_item("cameras_to_choose_from", self.allowed)?;
        let covered: Vec<_> = covered.into_iter().map(|targets| to_1d(py, targets)).collect();
        whole.set_item("covered", covered)?;
        let counts = (0..self.targets.len())
            .map(|row| if counts(&row) && self.targets.is_asked(row) { placed.counts[row] } else { u32::MAX });
        let grid = self.targets.ground().map(|ground| grid_of(&ground.grid, frame));
        Ok((cameras, whole, to_1d(py, counts.collect()), grid, sentences))
    }
}
