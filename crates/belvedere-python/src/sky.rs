//! Hours of sun, and how much of the sky is seen.

use crate::errors::wrong;
use crate::scene::PyScene;
use crate::sun::SiteKeywords;
use crate::targets::{RequestedTargets, TargetResults, put_to_scene};
use crate::trees::Through;
use belvedere::apps::ask::{self, SkyParts};
use pyo3::prelude::*;
use std::sync::Arc;

/// Days, as Python gives them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct DaysKeywords {
    dates: Vec<String>,
    /// First and last day, or two times.
    between: Option<[String; 2]>,
    year: Option<i16>,
    /// Minutes between suns.
    step: Option<f64>,
    /// Degrees.
    min_sun_elevation: Option<f64>,
    /// Maximum angle between a sun and its direction, degrees.
    tolerance: Option<f64>,
}

impl DaysKeywords {
    /// Converts the keywords for the layer of questions.
    pub(crate) fn chosen(&self) -> ask::Days {
        ask::Days {
            dates: self.dates.clone(),
            between: self.between.clone(),
            year: self.year,
            time_step_min: self.step,
            min_sun_elevation_deg: self.min_sun_elevation,
        }
    }
}

/// Returns the division of the sky from keywords.
pub(crate) fn sky_parts(directions: Option<usize>, patches: Option<&str>) -> PyResult<SkyParts> {
    match patches {
        None => Ok(directions.map_or_else(SkyParts::default, SkyParts::Even)),
        Some("tregenza") => Ok(SkyParts::Tregenza),
        Some("reinhart") => Ok(SkyParts::Reinhart),
        Some(other) => Err(wrong("patches", &format!("'{other}'"), "use 'tregenza' or 'reinhart'")),
    }
}

#[pymethods]
impl PyScene {
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn sun_hours<'py>(
        &self,
        py: Python<'py>,
        days: DaysKeywords,
        rules: Vec<String>,
        place: SiteKeywords,
        targets: RequestedTargets<'py>,
        trees: Through,
        interval: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<TargetResults<'py>> {
        let question = ask::SunHoursQuestion {
            days: days.chosen(),
            rules,
            place: place.chosen()?,
            sun_tolerance_deg: days.tolerance,
            trees: trees.chosen()?,
            interval,
        };
        let scene = Arc::clone(&self.0);
        let chosen = targets.chosen(py, &scene)?;
        let places = chosen.places.clone();
        let answers = put_to_scene(py, progress, scene, question, places)?;
        chosen.results(py, &answers.found.targets, answers.measures, &answers.remarks)
    }

    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn sky_view<'py>(
        &self,
        py: Python<'py>,
        directions: Option<usize>,
        patches: Option<&str>,
        targets: RequestedTargets<'py>,
        trees: Through,
        interval: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<TargetResults<'py>> {
        let question = ask::SkyViewQuestion { sky: sky_parts(directions, patches)?, trees: trees.chosen()?, interval };
        let scene = Arc::clone(&self.0);
        let chosen = targets.chosen(py, &scene)?;
        let places = chosen.places.clone();
        let answers = put_to_scene(py, progress, scene, question, places)?;
        chosen.results(py, &answers.found.targets, answers.measures, &answers.remarks)
    }
}
