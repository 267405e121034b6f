//! Observers: positions of eyes, with or without their height.

use crate::errors::{exception, wrong};
use belvedere::apps::ask::{self, Standing};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

/// Returns the positions of observers; at least one.
pub(crate) fn standing_observers(array: &PyReadonlyArray2<'_, f64>, scene: &ask::Scene) -> PyResult<Vec<Standing>> {
    let standing = standing(array, "observers", scene)?;
    if standing.is_empty() { Err(wrong("observers", "empty", "give at least one")) } else { Ok(standing) }
}

/// Returns pairs of observers and targets, row by row.
pub(crate) fn standing_pairs(
    observers: &PyReadonlyArray2<'_, f64>,
    targets: &PyReadonlyArray2<'_, f64>,
    scene: &ask::Scene,
) -> PyResult<ask::Places> {
    let [observers, targets] = [standing(observers, "observers", scene)?, standing(targets, "targets", scene)?];
    if observers.len() != targets.len() {
        let value = format!("an array of {} rows", targets.len());
        return Err(wrong("targets", &value, &format!("give a row for each of the {} observers", observers.len())));
    }
    Ok(ask::Places::Pairs(observers.into_iter().zip(targets).map(<[_; 2]>::from).collect()))
}

/// The places, local metres; z is NaN where it follows from the ground. `what` names the argument.
pub(crate) fn standing(array: &PyReadonlyArray2<'_, f64>, what: &str, scene: &ask::Scene) -> PyResult<Vec<Standing>> {
    let rows = crate::arrays::fixed_rows(array, what)?;
    let (frame, bounds) = (scene.frame(), scene.model().bounds());
    let local = |[x, y, z]: [f64; 3]| Standing::on_map([x, y], Some(z), frame, &bounds).map_err(exception);
    rows.into_iter().map(local).collect()
}
