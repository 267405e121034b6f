//! The energy of sun and sky.

use crate::cloud::PyInput;
use crate::errors::{exception, wrong};
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::result_columns::{NamedColumns, to_python};
use crate::scene::PyScene;
use crate::targets::{RequestedTargets, TargetResults};
use crate::work::run;
use belvedere::apps::ask::{self, Roofs, SunPlace, ThroughTrees};
use belvedere::apps::irradiance::{
    BirdParams, CLEAR_SKY_YEAR, ClearSky, IrradianceParams, PARTS, building_columns, roof_columns,
};
use belvedere::ground::GroundPoints;
use belvedere::io::{read_footprints, read_weather};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Source of radiation; missing keywords have the library's defaults.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct RadiationKeywords {
    /// A path, or the name and bytes of a file.
    weather: Option<PyInput>,
    clear_sky: Option<String>,
    linke: Option<f64>,
    year: Option<i16>,
    parts: Option<usize>,
}

/// The fields of a question beside its source of radiation.
#[derive(Default, Deserialize, Serialize)]
#[serde(default)]
pub(crate) struct Summation {
    params: IrradianceParams,
    place: SunPlace,
    trees: ThroughTrees,
    roofs: Option<Roofs>,
    interval: bool,
}

impl RadiationKeywords {
    /// The question, with weather that is read.
    fn question(&self, summation: Summation) -> PyResult<ask::IrradianceQuestion> {
        let Summation { params, place, trees, roofs, interval } = summation;
        params.validate().map_err(exception)?;
        let radiation = self.source(params.albedo)?;
        Ok(ask::IrradianceQuestion { radiation, params, place, trees, roofs, interval })
    }

    fn source(&self, albedo: f64) -> PyResult<ask::Radiation> {
        let clear_sky = match (&self.weather, self.clear_sky.as_deref()) {
            (Some(given), _) => {
                return Ok(ask::Radiation::Weather {
                    file: given.name().display().to_string(),
                    weather: Some(Arc::new(read_weather(given.source()).map_err(exception)?)),
                    parts: self.parts.unwrap_or(PARTS),
                });
            }
            (None, Some("haurwitz")) => ClearSky::Haurwitz,
            (None, Some("bird")) => ClearSky::Bird(BirdParams { albedo, ..BirdParams::default() }),
            (None, Some("ineichen")) => self.linke.map_or_else(ClearSky::default, |linke| ClearSky::Ineichen { linke }),
            (None, name) => {
                let advice = "use 'ineichen', 'haurwitz' or 'bird'";
                return Err(wrong("clear_sky", &format!("'{}'", name.unwrap_or_default()), advice));
            }
        };
        Ok(ask::Radiation::ClearSky { clear_sky, year: self.year.unwrap_or(CLEAR_SKY_YEAR) })
    }
}

/// Columns of planes and of buildings, those of the hours of each plane if they are wanted, and remarks.
type RoofColumns<'py> = (NamedColumns<'py>, NamedColumns<'py>, Vec<NamedColumns<'py>>, Remarks<'py>);

#[pymethods]
impl PyScene {
    /// The columns of the planes of roofs, of their buildings and of their hours.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn roof_planes<'py>(
        &self,
        py: Python<'py>,
        radiation: RadiationKeywords,
        summation: Data<Summation>,
        footprints: Option<PyInput>,
        ground: Data<GroundPoints>,
        is_hourly: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<RoofColumns<'py>> {
        let scene = Arc::clone(&self.0);
        let mut question = radiation.question(summation.0)?;
        let footprints = footprints.map(|file| read_footprints(file.source(), scene.frame())).transpose();
        let roofs = question.roofs.get_or_insert_default();
        (roofs.footprints, roofs.ground) = (footprints.map_err(exception)?.map(Arc::new), ground.0);
        let (answers, hours) = run(py, progress, move |control| {
            let answers = ask::ask(&scene, &question, &ask::Places::Scene, control)?;
            let planes = answers
                .found
                .roofs
                .iter()
                .filter(|_| is_hourly)
                .flat_map(|found| (0..found.planes.len()).map(move |plane| Ok(found.hours(plane)?.1)));
            let hours = planes.collect::<belvedere::Result<Vec<_>>>()?;
            Ok((answers, hours))
        })?;
        let remarks = remarks_of(py, &answers.remarks)?;
        let Some(found) = &answers.found.roofs else { return Ok((Vec::new(), Vec::new(), Vec::new(), remarks)) };
        let planes = roof_columns(found.as_rows(), self.0.frame(), &answers.found.site);
        let buildings = building_columns(found.as_rows());
        let hours = hours.into_iter().map(|columns| to_python(py, columns)).collect::<PyResult<_>>()?;
        Ok((to_python(py, planes)?, to_python(py, buildings)?, hours, remarks))
    }

    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        radiation: RadiationKeywords,
        summation: Data<Summation>,
        targets: RequestedTargets<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<TargetResults<'py>> {
        let question = radiation.question(summation.0)?;
        let chosen = targets.chosen(py, &self.0)?;
        let answers = self.ask(py, progress, question, chosen.places.clone())?;
        let Some(on) = &answers.found.on else {
            return Err(PyRuntimeError::new_err("there are no targets"));
        };
        chosen.results(py, &on.targets, answers.measures, &answers.remarks)
    }
}
