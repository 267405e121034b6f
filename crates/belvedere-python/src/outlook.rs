//! What observers see around themselves: viewsheds, horizons, isovists.

use crate::arrays::{to_1d, to_2d};
use crate::errors::{exception, wrong};
use crate::observers::{eyes, places, skip, skipped};
use crate::scene::{Scene, unproven_as};
use crate::sights::earth;
use crate::sun::Place;
use crate::targets::{Cells, Grid, grid_at, grid_of, ground_points};
use crate::work::run;
use belvedere::apps::eyes::{EyesReport, fault_of_target, skip_unfit_far_eyes};
use belvedere::apps::horizon::{HorizonParams, azimuth_count, horizons};
use belvedere::apps::isovist::{Isovist, IsovistParams, isovist};
use belvedere::apps::targets::{CellLevel, CellParams, Targets, set_on_ground, set_on_terrain};
use belvedere::apps::viewshed::{
    OBSERVER_HEIGHT, Observer, SightLimits, TARGET_HEIGHT, ViewshedParams, box_within_reach, far_viewshed,
    terrain_within_reach, tested_height, viewshed,
};
use belvedere::query::{EarthParams, UnprovenAs};
use belvedere::results::{Pixels, ResultRaster, terrain_georeference};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// How observers look over cells.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Looking {
    pub(crate) observer_height: Option<f64>,
    target_height: Option<f64>,
    pub(crate) cell: Option<f64>,
    pub(crate) ground: Option<String>,
    /// Degrees from the north that `Place` says.
    azimuth_range: Option<[f64; 2]>,
    elevation_range: Option<[f64; 2]>,
    min_distance: Option<f64>,
    pub(crate) max_distance: Option<f64>,
    curvature: Option<String>,
    refraction: Option<f64>,
    /// The one place is a target, and who looks stands in the cells.
    is_reverse: bool,
    /// Cells are those of the terrain beyond the cloud.
    is_far: bool,
}

impl Looking {
    fn limits(&self, grid_north: f64) -> PyResult<SightLimits> {
        let usual = SightLimits::default();
        let limits = SightLimits {
            azimuth: self.azimuth_range.map(|range| range.map(|azimuth| azimuth.to_radians() - grid_north)),
            elevation: self.elevation_range.map(|range| range.map(f64::to_radians)),
            distance: [self.min_distance.unwrap_or(usual.distance[0]), self.max_distance.unwrap_or(usual.distance[1])],
        };
        limits.validate().map_err(exception)?;
        Ok(limits)
    }

    pub(crate) fn earth(&self) -> PyResult<EarthParams> {
        earth(self.curvature.as_deref(), self.refraction)
    }
}

/// The bands of cells with their names, what they hold and their value for no data, their grid, and what was skipped.
type Seen<'py> = (Vec<Bound<'py, PyAny>>, Vec<String>, (String, f64), Grid, Vec<String>);
/// An array of the columns of isovists, and what was skipped.
type Described<'py> = (Bound<'py, PyDict>, Vec<Bound<'py, PyAny>>, Vec<String>);

#[pymethods]
impl Scene {
    /// The bands of cells with their names, what they hold and their value for no data, their grid, and what was skipped.
    fn viewshed<'py>(
        &self,
        py: Python<'py>,
        observers: PyReadonlyArray2<'py, f64>,
        looking: Looking,
        place: Place,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Seen<'py>> {
        let unproven = unproven_as(unproven)?;
        let earth = looking.earth()?;
        let inner = Arc::clone(&self.0);
        let limits = looking.limits(place.grid_north_of(&inner))?;
        let places = places(&observers)?;
        let points = ground_points(looking.ground.as_deref())?;
        if looking.is_far && inner.model.far_terrain().grid().is_none() {
            return Err(wrong(
                "far",
                "True",
                "give the scene terrain first: scene.with_terrain('dtm.tif').viewshed(...)",
            ));
        }
        let of_work = Arc::clone(&inner);
        let (seen, grid, report) = run(py, progress, move |control| {
            let inner = of_work;
            let mut eyes: Vec<[f64; 3]> = places.iter().map(|&place| inner.frame().local_from_file(place)).collect();
            let reaches = eyes.iter().map(|eye| ([eye[0], eye[1]], limits.distance[1]));
            let area = box_within_reach(inner.model.bounds().on_map(), reaches);
            let cells = Cells { side: looking.cell, height: None, level: CellLevel::Ground, ground: points };
            let ground = cells.ground_within(&inner, area, control)?;
            let mut heights =
                [looking.observer_height.unwrap_or(OBSERVER_HEIGHT), looking.target_height.unwrap_or(TARGET_HEIGHT)];
            if looking.is_reverse {
                heights.reverse();
            }
            let [height, of_cells] = heights;
            set_on_ground(eyes.iter_mut().map(|eye| (eye, height)), &ground);
            set_on_terrain(eyes.iter_mut().map(|eye| (eye, height)), &inner.model);
            let scene = inner.blockers(unproven, control)?;
            let report = match &eyes[..] {
                &[target] if looking.is_reverse && fault_of_target(&scene, target).is_none() => {
                    EyesReport::none_skipped(1)
                }
                _ => control.stage("testing observers", eyes.len(), || {
                    skip_unfit_far_eyes(&scene, Some(&ground), &mut eyes, control)
                })?,
            };
            let observers: Vec<Observer> = eyes.into_iter().map(|eye| Observer { eye, limits }).collect();
            let params = ViewshedParams::default().with_earth(earth).with_unproven(unproven);
            if let Some(terrain) = inner.model.far_terrain().grid().filter(|_| looking.is_far) {
                let terrain = terrain_within_reach(terrain, &observers)?;
                let size = [terrain.heights().width(), terrain.heights().height()];
                let seen = control.stage("testing terrain", size[1], || {
                    far_viewshed(&scene, &observers, &terrain, of_cells, &params, control)
                })?;
                return Ok((seen, grid_at(size, &terrain_georeference(&terrain, inner.frame())), report));
            }
            let cells = CellParams::default().with_height(tested_height(of_cells));
            let grid = grid_of(&ground.grid, inner.frame());
            let seen = control.stage("testing cells", observers.len(), || {
                let (mut targets, _) = Targets::of_cells(&inner.cloud, ground, &cells, control)?;
                if let Some(added) = inner.model.added() {
                    targets.set_on_added(added, &cells);
                }
                viewshed(&scene, &observers, &targets.positions, &params, control)
            })?;
            Ok((seen, grid, report))
        })?;
        let skipped = skipped(&inner, "observer", &report)?;
        let raster = ResultRaster::of_viewshed(&seen, [grid.0, grid.1]).map_err(exception)?;
        let no_data = raster.pixels.kind().in_gdal().1;
        let bands = match &raster.pixels {
            Pixels::Answers(bands) => bands.iter().map(|band| to_1d(py, band.values().to_vec()).into_any()).collect(),
            Pixels::Counts(bands) => bands.iter().map(|band| to_1d(py, band.values().to_vec()).into_any()).collect(),
            Pixels::Numbers(bands) => bands.iter().map(|band| to_1d(py, band.values().to_vec()).into_any()).collect(),
        };
        Ok((bands, raster.names, (raster.description, no_data), grid, skipped))
    }

    /// Elevations of the horizon, degrees, a row for each observer and a column for each azimuth; NaN rows for those skipped.
    fn horizon<'py>(
        &self,
        py: Python<'py>,
        observers: PyReadonlyArray2<'py, f64>,
        angle_step: Option<f64>,
        looking: Looking,
        place: Place,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, usize, Vec<String>)> {
        let earth = looking.earth()?;
        let usual = HorizonParams::default();
        let count = match angle_step {
            Some(step) => azimuth_count(step.to_radians()).map_err(exception)?,
            None => usual.azimuth_count,
        };
        let places = places(&observers)?;
        let points = ground_points(looking.ground.as_deref())?;
        let inner = Arc::clone(&self.0);
        let of_work = Arc::clone(&inner);
        let (found, report) = run(py, progress, move |control| {
            let inner = of_work;
            let mut eyes = eyes(&inner, &places, looking.observer_height, points, control)?;
            let turn = eyes.first().map_or(0.0, |eye| place.grid_north(&inner, [eye[0], eye[1]]));
            let scene = inner.blockers(UnprovenAs::Visible, control)?;
            let report = skip(&scene, None, &mut eyes, control)?;
            let params = HorizonParams::default().with_azimuth_count(count).with_turn(turn).with_earth(earth);
            let found =
                control.stage("computing horizons", eyes.len(), || horizons(&scene, &eyes, &params, control))?;
            Ok((found, report))
        })?;
        let skipped = skipped(&inner, "observer", &report)?;
        let elevation = |skyline: &Vec<belvedere::query::SkylinePoint>, azimuth: usize| {
            skyline.get(azimuth).map_or(f64::NAN, |point| point.elevation.to_degrees())
        };
        let all: Vec<f64> =
            found.iter().flat_map(|skyline| (0..count).map(move |azimuth| elevation(skyline, azimuth))).collect();
        Ok((to_1d(py, all).into_any(), count, skipped))
    }

    /// Columns of numbers, the panorama of each observer, and what was skipped.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn isovist<'py>(
        &self,
        py: Python<'py>,
        observers: PyReadonlyArray2<'py, f64>,
        angle_step: Option<f64>,
        min_jump: Option<f64>,
        looking: Looking,
        place: Place,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Described<'py>> {
        let usual = IsovistParams::default();
        let params = IsovistParams::default()
            .with_step(angle_step.map_or(usual.step, f64::to_radians))
            .with_max_range(looking.max_distance.unwrap_or(usual.max_range))
            .with_jump(min_jump.unwrap_or(usual.jump));
        let places = places(&observers)?;
        let points = ground_points(looking.ground.as_deref())?;
        let inner = Arc::clone(&self.0);
        let of_work = Arc::clone(&inner);
        let (stand, isovists, report) = run(py, progress, move |control| {
            let inner = of_work;
            let mut eyes = eyes(&inner, &places, looking.observer_height, points, control)?;
            let stand = eyes.clone();
            let scene = inner.blockers(UnprovenAs::Visible, control)?;
            let report = skip(&scene, None, &mut eyes, control)?;
            let isovists = control.stage("computing ranges", eyes.len(), || {
                let look = |eye: &[f64; 3]| {
                    let found = eye[0].is_finite().then(|| isovist(&scene, *eye, &params, control)).transpose();
                    control.advance(1);
                    found
                };
                eyes.iter().map(look).collect::<belvedere::Result<Vec<Option<Isovist>>>>()
            })?;
            Ok((stand, isovists, report))
        })?;
        let skipped = skipped(&inner, "observer", &report)?;
        let north = place.grid_north_of(&inner);
        let dict = PyDict::new(py);
        let of_file: Vec<[f64; 3]> = stand.iter().map(|&eye| inner.frame().file_from_local(eye)).collect();
        dict.set_item("place", to_2d(py, &of_file)?)?;
        let Some(known) = isovists.iter().flatten().next() else { return Ok((dict, Vec::new(), skipped)) };
        let rows: Vec<Option<Vec<f64>>> = isovists
            .iter()
            .map(|found| Some(found.as_ref()?.figures(north).map(|figure| figure.value).collect()))
            .collect();
        for (i, figure) in known.figures(north).enumerate() {
            let column = rows.iter().map(|row| row.as_ref().and_then(|row| row.get(i)).copied().unwrap_or(f64::NAN));
            dict.set_item(figure.name, to_1d(py, column.collect()))?;
        }
        let panoramas = isovists.iter().flatten().map(|found| {
            let raster = &found.panorama;
            let array =
                numpy::ndarray::Array2::from_shape_vec((raster.height(), raster.width()), raster.values().to_vec());
            array.map(|array| numpy::PyArray2::from_owned_array(py, array).into_any())
        });
        let panoramas: Result<Vec<_>, _> = panoramas.collect();
        let panoramas = panoramas.map_err(|error| pyo3::exceptions::PyRuntimeError::new_err(error.to_string()))?;
        Ok((dict, panoramas, skipped))
    }
}
