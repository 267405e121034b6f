//! Who looks: places of eyes, with or without their height.

use crate::errors::{belvedere_error, wrong};
use crate::targets::ground_cloud;
use belvedere::apps::ask::{self, Standing};
use belvedere::apps::eyes::{EyesReport, skip_unfit_eyes};
use belvedere::apps::targets::{grid_around, set_on_ground};
use belvedere::apps::viewshed::OBSERVER_HEIGHT;
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, GroundPoints};
use belvedere::query::MedialScene;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

/// Places of eyes in the coordinates of the file; z is NaN where it follows from the ground.
pub(crate) fn places(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 3]>> {
    let rows = crate::arrays::fixed_rows(array, "observers")?;
    if rows.is_empty() {
        return Err(wrong("observers", "empty", "give at least one"));
    }
    Ok(rows)
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

/// Where observers stand; at least one.
pub(crate) fn standing_observers(array: &PyReadonlyArray2<'_, f64>, scene: &ask::Scene) -> PyResult<Vec<Standing>> {
    let standing = standing(array, "observers", scene)?;
    if standing.is_empty() { Err(wrong("observers", "empty", "give at least one")) } else { Ok(standing) }
}

/// The places, local metres; z is NaN where it follows from the ground. `what` names the argument.
pub(crate) fn standing(array: &PyReadonlyArray2<'_, f64>, what: &str, scene: &ask::Scene) -> PyResult<Vec<Standing>> {
    let rows = crate::arrays::fixed_rows(array, what)?;
    let local = |row| Standing { place: scene.frame().local_from_file(row), height: None };
    Ok(rows.into_iter().map(local).collect())
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
