//! The energy of sun and sky.

use crate::arrays::to_1d;
use crate::cloud::PyInput;
use crate::errors::{exception, wrong};
use crate::remarks::remarks_of;
use crate::scene::PyScene;
use crate::targets::{RequestedTargets, TargetResults, ground_points, put_to_scene};
use crate::trees::Through;
use crate::work::run;
use belvedere::apps::ask::{self, Roofs, SunPlace};
use belvedere::apps::irradiance::{
    BirdParams, CLEAR_SKY_YEAR, ClearSky, Grouping, IrradianceParams, PARTS, SkyModel, Surroundings, roof_columns,
};
use belvedere::io::read_weather;
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

/// Names and values, the number of cells of each plane, and remarks.
type RoofColumns<'py> = (Vec<(&'static str, Bound<'py, PyAny>)>, Vec<usize>, Vec<Bound<'py, PyDict>>);

#[pymethods]
impl PyScene {
    /// The columns of the planes of roofs, with the middle of each first, and the number of cells of each.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn roof_planes<'py>(
        &self,
        py: Python<'py>,
        radiation: RadiationKeywords,
        min_area: Option<f64>,
        panel: Option<f64>,
        min_cells: Option<usize>,
        ground: Option<&str>,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<RoofColumns<'py>> {
        let roofs = Roofs { min_area, panel, min_cells, ground: ground_points(ground)? };
        let question = radiation.question(&trees, Some(roofs))?;
        let scene = Arc::clone(&self.0);
        let of_work = Arc::clone(&scene);
        let answers = run(py, progress, move |control| ask::ask(&of_work, &question, &ask::Places::Scene, control))?;
        let remarks = remarks_of(py, &answers.remarks)?;
        let Some(roofs) = &answers.found.roofs else { return Ok((Vec::new(), Vec::new(), remarks)) };
        let cells = roofs.energies.iter().map(|energy| energy.cell_count).collect();
        let columns = roof_columns(&roofs.planes, &roofs.energies, scene.frame(), &answers.found.site);
        let columns = columns.into_iter().map(|column| (column.name, to_1d(py, column.values).into_any()));
        Ok((columns.collect(), cells, remarks))
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
