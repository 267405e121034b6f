//! Who looks: places of eyes, with or without their height.

use crate::arrays::to_2d;
use crate::errors::{belvedere_error, wrong};
use crate::scene::Scene;
use crate::targets::{ground_cloud, ground_points};
use crate::work::run;
use belvedere::apps::ask;
use belvedere::apps::eyes::{EyesReport, skip_unfit_eyes};
use belvedere::apps::targets::{grid_around, set_on_ground, set_on_terrain};
use belvedere::apps::viewshed::{OBSERVER_HEIGHT, TARGET_HEIGHT};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, GroundPoints};
use belvedere::query::MedialScene;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use std::sync::Arc;

/// Places of eyes in the coordinates of the file; z is NaN where it follows from the ground.
pub(crate) fn places(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 3]>> {
    let rows = crate::arrays::fixed_rows(array, "observers")?;
    if rows.is_empty() {
        return Err(wrong("observers", "empty", "give at least one"));
    }
    Ok(rows)
}

/// Where observers stand, as the layer of questions takes it.
pub(crate) fn standing(scene: &ask::Scene, places: &[[f64; 3]]) -> Vec<ask::Standing> {
    places.iter().map(|&place| ask::Standing { place: scene.frame().local_from_file(place), height: None }).collect()
}

/// The eyes, local metres, those without a height that far above the ground.
pub(crate) fn eyes(
    inner: &ask::Scene,
    places: &[[f64; 3]],
    height: Option<f64>,
    points: GroundPoints,
    control: &Control<'_>,
) -> belvedere::Result<Vec<[f64; 3]>> {
    let mut eyes: Vec<[f64; 3]> = places.iter().map(|&place| inner.frame().local_from_file(place)).collect();
    let coverage = inner.model().coverage();
    let is_over = |place: &[f64; 3]| coverage.is_none_or(|coverage| coverage.holds_on_map(*place));
    if let Some(grid) = grid_around(eyes.iter().copied().filter(is_over), inner.frame().origin)? {
        let params = GroundParams { points, ..GroundParams::default() };
        let cloud = ground_cloud(inner)?;
        let (ground, _) = control.stage("computing ground", 0, || Ground::of_cloud(cloud, grid, &params, control))?;
        let height = height.unwrap_or(OBSERVER_HEIGHT);
        set_on_ground(eyes.iter_mut().map(|eye| (eye, height)), &ground);
    }
    Ok(eyes)
}

#[pymethods]
impl Scene {
    /// Places in the coordinates of the file, those without a height (NaN) as eyes or targets above the ground.
    fn on_ground<'py>(
        &self,
        py: Python<'py>,
        array: PyReadonlyArray2<'py, f64>,
        height: Option<f64>,
        is_target: bool,
        ground: Option<&str>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rows = places(&array)?;
        let points = ground_points(ground)?;
        let height = height.unwrap_or(if is_target { TARGET_HEIGHT } else { OBSERVER_HEIGHT });
        let inner = Arc::clone(&self.0);
        let placed = run(py, progress, move |control| {
            let mut placed = eyes(&inner, &rows, Some(height), points, control)?;
            set_on_terrain(placed.iter_mut().map(|place| (place, height)), inner.model());
            Ok(placed.into_iter().map(|place| inner.frame().file_from_local(place)).collect::<Vec<_>>())
        })?;
        Ok(to_2d(py, &placed)?.into_any())
    }
}

/// Makes eyes that cannot look NaN.
pub(crate) fn skip(
    scene: &MedialScene,
    ground: Option<&Ground>,
    eyes: &mut [[f64; 3]],
    control: &Control<'_>,
) -> belvedere::Result<EyesReport> {
    control.stage("testing observers", eyes.len(), || skip_unfit_eyes(scene, ground, eyes, control))
}

/// What is said of eyes that were skipped, one sentence each.
///
/// # Errors
/// Where none is left.
pub(crate) fn skipped(inner: &ask::Scene, who: &str, report: &EyesReport) -> PyResult<Vec<String>> {
    let sentences: Vec<String> = report
        .faults
        .iter()
        .map(|skipped| {
            let [x, y, _] = inner.frame().file_from_local(skipped.place);
            format!("{who} {} at {x:.3},{y:.3} is skipped: {}", skipped.row, skipped.fault)
        })
        .collect();
    match (sentences.first(), report.faults.first()) {
        (Some(first), Some(fault)) if report.skipped == report.count => {
            let message = format!("no {who} is left: {first}");
            Err(belvedere_error(&message, &format!("{who}s"), &format!("{:?}", fault.place), &fault.fault.to_string()))
        }
        _ => Ok(sentences),
    }
}
