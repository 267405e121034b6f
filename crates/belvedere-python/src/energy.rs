//! The energy of sun and sky.

use crate::arrays::to_1d;
use crate::errors::{exception, wrong};
use crate::scene::{Inner, Scene};
use crate::targets::{Results, Wanted, ground_cloud, ground_points};
use crate::trees::Through;
use crate::work::run;
use belvedere::apps::irradiance::{
    BirdParams, CLEAR_SKY_YEAR, ClearSky, Grouping, IrradianceParams, PARTS, RadiationSource, SkyModel, Surroundings,
    irradiation_measures, look_count, period_seasons, roof_columns, roof_irradiation, season_irradiation,
};
use belvedere::apps::roof_planes::{GROUND_CELL, RoofPlaneParams, roof_planes, roof_points};
use belvedere::apps::rows::Obstacles;
use belvedere::apps::sun::Site;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::io::read_weather;
use belvedere::query::UnprovenAs;
use belvedere::weather::Weather;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// Where radiation comes from and how it is summed; what is not given is the library's default.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Radiation {
    weather: Option<PathBuf>,
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
}

/// A source that owns what it is made of.
enum Source {
    Weather(Box<Weather>, usize),
    ClearSky(ClearSky, i16),
}

impl Radiation {
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

    fn source(&self, params: &IrradianceParams) -> PyResult<Source> {
        if self.linke.is_some() && self.clear_sky.as_deref() != Some("ineichen") {
            return Err(wrong("linke", "given", "it needs clear_sky='ineichen'"));
        }
        match (&self.weather, self.clear_sky.as_deref()) {
            (Some(path), None) => {
                let weather = read_weather(path).map_err(exception)?;
                Ok(Source::Weather(Box::new(weather), self.parts.unwrap_or(PARTS)))
            }
            (None, Some(name)) => {
                let sky = match name {
                    "ineichen" => self.linke.map_or_else(ClearSky::default, |linke| ClearSky::Ineichen { linke }),
                    "haurwitz" => ClearSky::Haurwitz,
                    "bird" => ClearSky::Bird(BirdParams { albedo: params.albedo, ..BirdParams::default() }),
                    _ => {
                        let advice = "use 'ineichen', 'haurwitz' or 'bird'";
                        return Err(wrong("clear_sky", &format!("'{name}'"), advice));
                    }
                };
                Ok(Source::ClearSky(sky, self.year.unwrap_or(CLEAR_SKY_YEAR)))
            }
            (Some(_), Some(_)) => Err(wrong("weather and clear_sky", "given together", "give one of them")),
            (None, None) => Err(wrong("radiation", "missing", "give weather='file.epw' or clear_sky='ineichen'")),
        }
    }

    /// The place on earth: as given, or as the scene or the weather has it.
    fn site(&self, source: &Source, inner: &Inner) -> PyResult<Site> {
        let given = self.location.map(|place| place.map(f64::to_radians));
        let station = match source {
            Source::Weather(weather, _) => Some([weather.latitude, weather.longitude]),
            Source::ClearSky(..) => None,
        };
        let found = Site::of_scene(inner.frame(), &inner.model.bounds(), given, station);
        Ok(found
            .map_err(|error| match error {
                belvedere::Error::MissingAttribute { attribute, needed_for, .. } => {
                    exception(belvedere::Error::MissingAttribute {
                        attribute,
                        needed_for,
                        advice: "give location=(latitude, longitude), or crs='EPSG:CODE' when reading the cloud",
                    })
                }
                other => exception(other),
            })?
            .0)
    }
}

impl Source {
    fn radiation(&self) -> RadiationSource<'_> {
        match self {
            Self::Weather(weather, parts) => RadiationSource::Weather { weather, parts: *parts },
            Self::ClearSky(clear_sky, year) => RadiationSource::ClearSky { clear_sky: *clear_sky, year: *year },
        }
    }
}

/// Names and values, and the number of cells of each plane.
type RoofColumns<'py> = (Vec<(&'static str, Bound<'py, PyAny>)>, Vec<usize>);

#[pymethods]
impl Scene {
    /// The columns of the planes of roofs, with the middle of each first, and the number of cells of each.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn roof_planes<'py>(
        &self,
        py: Python<'py>,
        radiation: Radiation,
        min_area: Option<f64>,
        panel: Option<f64>,
        ground: Option<&str>,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<RoofColumns<'py>> {
        let params = radiation.params()?;
        let source = py.detach(|| radiation.source(&params))?;
        let inner = Arc::clone(&self.0);
        let site = radiation.site(&source, &inner)?;
        let usual = RoofPlaneParams::default();
        let of_planes =
            usual.with_least_area(min_area.unwrap_or(usual.least_area)).with_cell(panel.unwrap_or(usual.cell));
        let points = ground_points(ground)?;
        let (columns, cells) = run(py, progress, move |control| {
            let cloud = ground_cloud(&inner)?;
            let (low, high) = inner.model.bounds().on_map();
            let origin = inner.frame().origin;
            let grid = MapGrid::covering(low, high, GROUND_CELL, [origin[0], origin[1]])?;
            let of_ground = GroundParams { points, ..GroundParams::default() };
            let (ground, _) =
                control.stage("computing ground", 0, || Ground::of_cloud(cloud, grid, &of_ground, control))?;
            let (rows, _) = roof_points(cloud, &ground)?;
            let places: Vec<[f32; 3]> =
                rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
            let planes = control.stage("detecting roof planes", 0, || roof_planes(&places, &of_planes, control))?;
            let trees = trees.of(&inner, control)?;
            let (seasons, _) = control.stage("computing radiation", 0, || {
                period_seasons(&source.radiation(), &site, trees.as_ref().map(|trees| trees.crowns), &params, control)
            })?;
            let scene = inner.blockers(UnprovenAs::Visible, control)?;
            let obstacles = Obstacles { scene: &scene, trees: trees.as_ref() };
            let energies = control.stage("testing sun and sky", planes.len(), || {
                roof_irradiation(obstacles, &planes, &seasons, control)
            })?;
            let cells: Vec<usize> = energies.iter().map(|energy| energy.cell_count).collect();
            Ok((roof_columns(&planes, &energies, inner.frame(), &site), cells))
        })?;
        Ok((columns.into_iter().map(|column| (column.name, to_1d(py, column.values).into_any())).collect(), cells))
    }

    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        radiation: Radiation,
        targets: Wanted<'py>,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Results<'py>, String)> {
        let params = radiation.params()?;
        let source = py.detach(|| radiation.source(&params))?;
        let inner = Arc::clone(&self.0);
        let site = radiation.site(&source, &inner)?;
        let asked = targets.owned(py, &inner)?;
        let (measures, found, report) = run(py, progress, move |control| {
            let trees = trees.of(&inner, control)?;
            let (seasons, report) = control.stage("computing radiation", 0, || {
                period_seasons(&source.radiation(), &site, trees.as_ref().map(|trees| trees.crowns), &params, control)
            })?;
            let found = asked.targets(&inner, control)?;
            let targets = &found.targets;
            let scene = inner.blockers(UnprovenAs::Visible, control)?;
            let obstacles = Obstacles { scene: &scene, trees: trees.as_ref() };
            let looks = targets.len() * look_count(&obstacles, &seasons);
            let sums = control
                .stage("testing sun and sky", looks, || season_irradiation(obstacles, targets, &seasons, control))?;
            let groups = seasons.first().map_or(1, |season| season.radiation.group_count());
            Ok((irradiation_measures(&sums, groups), found, report))
        })?;
        let report = serde_json::json!({
            "global_kwh_m2": report.ghi,
            "direct_normal_kwh_m2": report.dni,
            "diffuse_kwh_m2": report.dhi,
            "sun_directions": report.sun_direction_count,
            "night_hours": report.night_hours,
            "is_doubtful": report.is_doubtful(),
        });
        Ok((found.results(py, measures)?, report.to_string()))
    }
}
