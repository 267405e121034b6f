//! Heat stress of people.

use crate::cloud::PyInput;
use crate::errors::{exception, wrong};
use crate::scene::PyScene;
use crate::sky::DaysKeywords;
use crate::sun::SiteKeywords;
use crate::targets::{RequestedTargets, TargetResults, put_to_scene};
use crate::trees::Through;
use belvedere::apps::ask;
use belvedere::apps::heat::{Body, GroundCover, SurfaceParams};
use belvedere::io::read_weather;
use pyo3::prelude::*;
use std::sync::Arc;

/// Weather, body and surfaces; missing keywords have the library's defaults.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct HeatKeywords {
    weather: PyInput,
    between: Option<[f64; 2]>,
    body: String,
    ground_cover: String,
    ground_warming: Option<f64>,
    wind_factor: Option<f64>,
    parts: Option<usize>,
    by_hour: bool,
    pet: bool,
}

impl HeatKeywords {
    fn body(&self) -> PyResult<Body> {
        match self.body.as_str() {
            "standing" => Ok(Body::Standing),
            "sitting" => Ok(Body::Sitting),
            "round" => Ok(Body::Round),
            other => Err(wrong("body", &format!("'{other}'"), "use 'standing', 'sitting' or 'round'")),
        }
    }

    fn cover(&self) -> PyResult<GroundCover> {
        match self.ground_cover.as_str() {
            "paved" => Ok(GroundCover::Paved),
            "asphalt" => Ok(GroundCover::Asphalt),
            "grass" => Ok(GroundCover::Grass),
            "soil" => Ok(GroundCover::Soil),
            other => Err(wrong("ground_cover", &format!("'{other}'"), "use 'paved', 'asphalt', 'grass' or 'soil'")),
        }
    }

    fn question(&self, days: &DaysKeywords, place: &SiteKeywords, trees: &Through) -> PyResult<ask::HeatQuestion> {
        let usual = ask::HeatQuestion::default();
        Ok(ask::HeatQuestion {
            file: self.weather.name().display().to_string(),
            weather: Some(Arc::new(read_weather(self.weather.source()).map_err(exception)?)),
            days: days.chosen(),
            hours: self.between,
            place: place.chosen()?,
            body: self.body()?,
            surfaces: SurfaceParams {
                ground: self.cover()?,
                warming: self.ground_warming.unwrap_or(usual.surfaces.warming),
            },
            trees: trees.chosen()?,
            parts: self.parts.unwrap_or(usual.parts),
            wind_factor: self.wind_factor.unwrap_or(usual.wind_factor),
            by_hour: self.by_hour,
            pet: self.pet,
        })
    }
}

#[pymethods]
impl PyScene {
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn heat<'py>(
        &self,
        py: Python<'py>,
        given: HeatKeywords,
        days: DaysKeywords,
        place: SiteKeywords,
        targets: RequestedTargets<'py>,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<TargetResults<'py>> {
        let question = given.question(&days, &place, &trees)?;
        let scene = Arc::clone(&self.0);
        let chosen = targets.chosen(py, &scene)?;
        let places = chosen.places.clone();
        let answers = put_to_scene(py, progress, scene, question, places)?;
        chosen.results(py, &answers.found.targets, answers.measures, &answers.remarks)
    }
}
