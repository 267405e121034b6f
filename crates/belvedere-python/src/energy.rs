//! The energy of sun and sky.

use crate::cloud::PyInput;
use crate::errors::{exception, wrong};
use crate::remarks::remarks_of;
use crate::result_columns::{NamedColumns, to_python};
use crate::scene::PyScene;
use crate::targets::{RequestedTargets, TargetResults, ground_points, put_to_scene};
use crate::trees::Through;
use crate::work::run;
use belvedere::Frame;
use belvedere::apps::ask::{self, PvChoice, Roofs, SunPlace};
use belvedere::apps::irradiance::{
    BirdParams, CLEAR_SKY_YEAR, ClearSky, Grouping, IrradianceParams, PARTS, SkyModel, Surroundings, building_columns,
    roof_columns,
};
use belvedere::io::{read_footprints, read_weather};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Source and summation of radiation; missing keywords have the library's defaults.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct RadiationKeywords {
    /// A path, or the name and bytes of a file.
    weather: Option<PyInput>,
    clear_sky: Option<String>,
    linke: Option<f64>,
    year: Option<i16>,
    parts: Option<usize>,
    sky_model: Option<String>,
    patch_division: Option<usize>,
    albedo: Option<f64>,
    surroundings: Option<String>,
    sun_cell: Option<f64>,
    months: bool,
    location: Option<[f64; 2]>,
    interval: bool,
}

impl RadiationKeywords {
    fn params(&self) -> PyResult<IrradianceParams> {
        let usual = IrradianceParams::default();
        let sky = match self.sky_model.as_deref() {
            None => usual.sky,
            Some("isotropic") => SkyModel::Isotropic,
            Some("hay-davies") => SkyModel::HayDavies,
            Some("perez") => SkyModel::Perez,
            Some("patches") => SkyModel::Patches,
            Some(other) => {
                let advice = "use 'patches', 'perez', 'hay-davies' or 'isotropic'";
                return Err(wrong("sky_model", &format!("'{other}'"), advice));
            }
        };
        let surroundings = match self.surroundings.as_deref() {
            None => usual.surroundings,
            Some("dark") => Surroundings::Dark,
            Some("like-ground") => Surroundings::LikeGround,
            Some(other) => {
                return Err(wrong("surroundings", &format!("'{other}'"), "use 'dark' or 'like-ground'"));
            }
        };
        let params = usual
            .with_sky(sky)
            .with_patch_division(self.patch_division.unwrap_or(usual.patch_division))
            .with_sun_cell(self.sun_cell.map_or(usual.sun_cell, f64::to_radians))
            .with_albedo(self.albedo.unwrap_or(usual.albedo))
            .with_surroundings(surroundings)
            .with_grouping(if self.months { Grouping::Months } else { Grouping::Whole });
        params.validate().map_err(exception)?;
        Ok(params)
    }

    /// The question, with weather that is read.
    fn question(&self, trees: &Through, roofs: Option<Roofs>) -> PyResult<ask::IrradianceQuestion> {
        let params = self.params()?;
        let radiation = self.source(&params)?;
        let place = SunPlace { location: self.location, ..SunPlace::default() };
        Ok(ask::IrradianceQuestion { radiation, params, place, trees: trees.chosen()?, roofs, interval: self.interval })
    }

    fn source(&self, params: &IrradianceParams) -> PyResult<ask::Radiation> {
        if self.linke.is_some() && self.clear_sky.as_deref() != Some("ineichen") {
            return Err(wrong("linke", "given", "it needs clear_sky='ineichen'"));
        }
        match (&self.weather, self.clear_sky.as_deref()) {
            (Some(given), None) => Ok(ask::Radiation::Weather {
                file: given.name().display().to_string(),
                weather: Some(Arc::new(read_weather(given.source()).map_err(exception)?)),
                parts: self.parts.unwrap_or(PARTS),
            }),
            (None, Some(name)) => {
                let clear_sky = match name {
                    "ineichen" => self.linke.map_or_else(ClearSky::default, |linke| ClearSky::Ineichen { linke }),
                    "haurwitz" => ClearSky::Haurwitz,
                    "bird" => ClearSky::Bird(BirdParams { albedo: params.albedo, ..BirdParams::default() }),
                    _ => {
                        let advice = "use 'ineichen', 'haurwitz' or 'bird'";
                        return Err(wrong("clear_sky", &format!("'{name}'"), advice));
                    }
                };
                Ok(ask::Radiation::ClearSky { clear_sky, year: self.year.unwrap_or(CLEAR_SKY_YEAR) })
            }
            (Some(_), Some(_)) => Err(wrong("weather and clear_sky", "given together", "give one of them")),
            (None, None) => Err(wrong("radiation", "missing", "give weather='file.epw' or clear_sky='ineichen'")),
        }
    }
}

/// Planes of roofs, their buildings, and panels on them; missing keywords have the library's defaults.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct RoofKeywords {
    min_area: Option<f64>,
    panel: Option<f64>,
    min_cells: Option<usize>,
    ground: Option<String>,
    /// A path, or the name and bytes of a file.
    footprints: Option<PyInput>,
    module_efficiency: Option<f64>,
    temperature_coefficient: Option<f64>,
    system_losses: Option<f64>,
    inverter_efficiency: Option<f64>,
    dc_ac_ratio: Option<f64>,
    hourly: bool,
}

impl RoofKeywords {
    fn chosen(&self, frame: &Frame) -> PyResult<Roofs> {
        let system = PvChoice {
            module_efficiency: self.module_efficiency,
            temperature_coefficient: self.temperature_coefficient,
            system_losses: self.system_losses,
            inverter_efficiency: self.inverter_efficiency,
            dc_ac_ratio: self.dc_ac_ratio,
        };
        let footprints = self.footprints.as_ref().map(|file| read_footprints(file.source(), frame)).transpose();
        Ok(Roofs {
            min_area: self.min_area,
            panel: self.panel,
            min_cells: self.min_cells,
            system,
            footprints: footprints.map_err(exception)?.map(Arc::new),
            ground: ground_points(self.ground.as_deref())?,
        })
    }
}

/// Columns of planes and of buildings, those of the hours of each plane if they are wanted, and remarks.
type RoofColumns<'py> = (NamedColumns<'py>, NamedColumns<'py>, Vec<NamedColumns<'py>>, Vec<Bound<'py, PyDict>>);

#[pymethods]
impl PyScene {
    /// The columns of the planes of roofs, of their buildings and of their hours.
    fn roof_planes<'py>(
        &self,
        py: Python<'py>,
        radiation: RadiationKeywords,
        roofs: RoofKeywords,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<RoofColumns<'py>> {
        let scene = Arc::clone(&self.0);
        let question = radiation.question(&trees, Some(roofs.chosen(scene.frame())?))?;
        let of_work = Arc::clone(&scene);
        let is_hourly = roofs.hourly;
        let (answers, hours) = run(py, progress, move |control| {
            let answers = ask::ask(&of_work, &question, &ask::Places::Scene, control)?;
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
        let planes = roof_columns(found.as_rows(), scene.frame(), &answers.found.site);
        let buildings = building_columns(found.as_rows());
        let hours = hours.into_iter().map(|columns| to_python(py, columns)).collect::<PyResult<_>>()?;
        Ok((to_python(py, planes)?, to_python(py, buildings)?, hours, remarks))
    }

    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        radiation: RadiationKeywords,
        targets: RequestedTargets<'py>,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<TargetResults<'py>> {
        let question = radiation.question(&trees, None)?;
        let scene = Arc::clone(&self.0);
        let chosen = targets.chosen(py, &scene)?;
        let places = chosen.places.clone();
        let answers = put_to_scene(py, progress, scene, question, places)?;
        let Some(on) = &answers.found.on else {
            return Err(PyRuntimeError::new_err("there are no targets"));
        };
        chosen.results(py, &on.targets, answers.measures, &answers.remarks)
    }
}
