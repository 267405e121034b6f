//! Hours of sun, and how much of the sky is seen.

use crate::arrays::to_1d;
use crate::errors::wrong;
use crate::remarks::remarks_of;
use crate::scene::PyScene;
use crate::sun::SiteKeywords;
use crate::targets::{Grid, RequestedTargets, TargetResults, grid_of, put_to_scene};
use crate::trees::Through;
use crate::work::run;
use belvedere::apps::ask::{self, HourlySun, SkyParts};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
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

/// Name and values of each hour of each month, the grid of its cells, and remarks.
type HourBands<'py> = (Vec<(String, Bound<'py, PyArray1<u32>>)>, Option<Grid>, Vec<Bound<'py, PyDict>>);

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

    /// Name and values of each hour of each month at the cells of a grid, and the grid.
    fn hourly_sun<'py>(
        &self,
        py: Python<'py>,
        year: i16,
        days: DaysKeywords,
        place: SiteKeywords,
        targets: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<HourBands<'py>> {
        let place = place.chosen()?;
        let question = ask::SunHoursQuestion {
            days: days.chosen(),
            place,
            sun_tolerance_deg: days.tolerance,
            ..ask::SunHoursQuestion::default()
        };
        let scene = Arc::clone(&self.0);
        let places = targets.chosen(py, &scene)?.places;
        let (bands, grid, remarks) = run(py, progress, move |control| {
            let answers = question.hourly_sun(Some(year), &places, &scene, control)?;
            let sun = answers.found;
            let hours = (1..=12_i8).flat_map(|month| (0..HourlySun::HOURS).map(move |hour| (month, hour)));
            let bands = hours.map(|(month, hour)| (format!("{month:02}_{hour:02}"), sun.days(month, hour)));
            let grid = sun.targets.ground().map(|ground| grid_of(&ground.grid, &sun.targets.frame));
            Ok((bands.collect::<Vec<_>>(), grid, answers.remarks))
        })?;
        let bands = bands.into_iter().map(|(name, days)| (name, to_1d(py, days))).collect();
        Ok((bands, grid, remarks_of(py, &remarks)?))
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
