//! Simulated towns and their scans.

use crate::arrays::to_1d;
use crate::errors::wrong;
use crate::work::run;
use belvedere_scenes::{AirborneParams, DENSITY, EXTENT, Preset, scan_airborne, town};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Sides of a town that can be built, metres.
const SIDES: std::ops::RangeInclusive<f64> = 60.0..=5000.0;
/// Pulses of a square metre that a scan can have.
const DENSITIES: std::ops::RangeInclusive<f64> = 0.1..=200.0;

/// The columns of an airborne scan of a town.
#[pyfunction]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    preset: &str,
    extent: Option<f64>,
    density: Option<f64>,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let Some(preset) = Preset::ALL.into_iter().find(|known| known.name() == preset) else {
        let names = Preset::ALL.map(Preset::name).join(", ");
        return Err(wrong("town", &format!("'{preset}'"), &format!("use one of {names}")));
    };
    let (extent, density) = (extent.unwrap_or(EXTENT), density.unwrap_or(DENSITY));
    if !SIDES.contains(&extent) {
        return Err(wrong("extent", &extent.to_string(), "give 60 to 5000 metres"));
    }
    if !DENSITIES.contains(&density) {
        return Err(wrong("density", &density.to_string(), "give 0.1 to 200 pulses per square metre"));
    }
    let scan = run(py, None, move |_| {
        let scene = town(&preset.params(extent, seed));
        Ok(scan_airborne(&scene, &AirborneParams { seed, ..AirborneParams::covering(&scene, density) }))
    })?;
    let dict = PyDict::new(py);
    dict.set_item("x", to_1d(py, scan.x))?;
    dict.set_item("y", to_1d(py, scan.y))?;
    dict.set_item("z", to_1d(py, scan.z))?;
    dict.set_item("classification", to_1d(py, scan.classification))?;
    dict.set_item("gps_time", to_1d(py, scan.gps_time))?;
    dict.set_item("return_number", to_1d(py, scan.return_number))?;
    dict.set_item("return_count", to_1d(py, scan.return_count))?;
    dict.set_item("scan_angle", to_1d(py, scan.scan_angle_deg.iter().map(|a| a.to_radians()).collect()))?;
    dict.set_item("point_source_id", to_1d(py, scan.point_source_id))?;
    dict.set_item("intensity", to_1d(py, scan.intensity))?;
    Ok(dict)
}
