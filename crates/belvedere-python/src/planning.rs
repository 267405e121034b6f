//! Sun on walks and windows, and how high one may build.

use crate::arrays::{to_1d, to_2d};
use crate::errors::{exception, wrong};
use crate::landmark::local_ring;
use crate::scene::Scene;
use crate::sky::Days;
use crate::sun::Place;
use crate::targets::{Column, Grid, ground_cloud, ground_points};
use crate::windows::{WindowRow, windows_of};
use crate::work::run;
use belvedere::Error;
use belvedere::apps::ask;
use belvedere::apps::exposure::{ROUTE_STEP, ShadeAtEachSun, WALKER_HEIGHT, scene_exposure};
use belvedere::apps::sky_view::{SKY_DIRECTIONS, SkyDirections};
use belvedere::apps::solar_envelope::{
    EnvelopeParams, Parcel, ProtectedPiece, envelope_suns, existing_shade, protected_line, solar_envelope,
};
use belvedere::apps::sun::{Binning, Period, SunSchedule, sun_days};
use belvedere::apps::targets::{Route, Targets, grid_around, set_on_ground};
use belvedere::apps::viewshed::{CELL, cell_for, places_along};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, GroundPoints, MapGrid};
use belvedere::query::UnprovenAs;
use belvedere::view::to_sun;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Ground around what is protected, metres.
const MARGIN: f64 = 5.0;

/// What comfort is about.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Walks {
    /// Corners in the coordinates of the file; z is NaN where it follows from the ground.
    routes: Vec<Vec<[f64; 3]>>,
    windows: Vec<WindowRow>,
    step: Option<f64>,
    height: Option<f64>,
    directions: Option<usize>,
    ground: Option<String>,
}

/// What an envelope protects, and what it bounds.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Build {
    parcel: Vec<Vec<[f64; 2]>>,
    protect: Vec<Vec<[f64; 3]>>,
    /// Azimuths and elevations, degrees; empty for days.
    suns: Vec<[f64; 2]>,
    between: Option<[f64; 2]>,
    fence_height: Option<f64>,
    spacing: Option<f64>,
    max_height: Option<f64>,
    credit_shade: bool,
    cell: Option<f64>,
    ground: Option<String>,
}

fn ground_on(
    inner: &ask::Scene,
    grid: MapGrid,
    points: GroundPoints,
    control: &Control<'_>,
) -> belvedere::Result<Ground> {
    let params = GroundParams { points, ..GroundParams::default() };
    let cloud = ground_cloud(inner)?;
    Ok(control.stage("computing ground", 0, || Ground::of_cloud(cloud, grid, &params, control))?.0)
}

impl Walks {
    /// The targets, and for routes the way to each of them and its place.
    fn targets(
        &self,
        inner: &ask::Scene,
        north: f64,
        points: GroundPoints,
        control: &Control<'_>,
    ) -> belvedere::Result<(Targets, Vec<f64>, Vec<[f64; 3]>)> {
        let frame = inner.frame();
        if !self.windows.is_empty() {
            let windows = windows_of(&self.windows, frame, north);
            let targets = Targets::of_windows(&windows, frame.clone()).map_err(|(_, error)| error)?;
            let places = self.windows.iter().map(|&[x, y, z, ..]| [x, y, z]).collect();
            return Ok((targets, Vec::new(), places));
        }
        let mut routes = Vec::new();
        for corners in &self.routes {
            let corners: Vec<[f64; 3]> = corners.iter().map(|&corner| frame.local_from_file(corner)).collect();
            routes.push(Route { places: places_along(&corners, self.step.unwrap_or(ROUTE_STEP))? });
        }
        let all = || routes.iter().flat_map(|route| route.places.iter().copied());
        if let Some(grid) = grid_around(all(), frame.origin)? {
            let ground = ground_on(inner, grid, points, control)?;
            let height = self.height.unwrap_or(WALKER_HEIGHT);
            let count = all().count();
            let places = routes.iter_mut().flat_map(|route| &mut route.places).map(|place| (place, height));
            if set_on_ground(places, &ground).len() == count {
                return Err(Error::NoPoints {
                    what: "the ground below the route is unknown; is the route in the coordinates of the cloud?"
                        .to_owned(),
                });
            }
        }
        let distances = routes.iter().flat_map(Route::distances).collect();
        let places = routes.iter().flat_map(|route| &route.places).map(|&place| frame.file_from_local(place)).collect();
        Ok((Targets::along_routes(&routes, frame.clone()), distances, places))
    }
}

#[pymethods]
impl Scene {
    /// Columns of the places of routes, or of windows.
    fn comfort<'py>(
        &self,
        py: Python<'py>,
        walks: Walks,
        days: Days,
        place: Place,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let inner = Arc::clone(&self.0);
        let site = place.site(&inner)?;
        let zone = place.zone(&site, &days.times())?;
        let params = days.params(&place)?;
        let Some(period) = days.period(&place, &site, &zone)? else {
            return Err(wrong("period", "missing", "give date or period"));
        };
        let schedule = sun_days(&site, &zone, &period, &params).and_then(|days| SunSchedule::new(&days, Binning::Auto));
        let schedule = schedule.map_err(exception)?;
        let sky = SkyDirections::even(walks.directions.unwrap_or(SKY_DIRECTIONS)).map_err(exception)?;
        let points = ground_points(walks.ground.as_deref())?;
        let north = place.grid_north_of(&inner);
        let (found, targets, distances, places) = run(py, progress, move |control| {
            let (mut targets, distances, places) = walks.targets(&inner, north, points, control)?;
            if let Some(coverage) = inner.model().coverage() {
                targets.leave_out_outside(&coverage);
            }
            let scene = inner.blockers(UnprovenAs::Visible, control)?;
            let found = control.stage("testing sky and sun", 2 * targets.len(), || {
                scene_exposure(&scene, &targets, &sky, &schedule, ShadeAtEachSun::NotKept, control)
            })?;
            Ok((found, targets, distances, places))
        })?;
        let dict = PyDict::new(py);
        dict.set_item("place", to_2d(py, &places)?)?;
        if targets.normals.is_none() {
            let groups = targets.groups.iter().zip(1_u32..);
            let routes = groups.flat_map(|(group, number)| group.clone().map(move |_| number)).collect();
            dict.set_item("route", to_1d(py, routes))?;
            dict.set_item("distance_m", to_1d(py, distances))?;
            for (measure, _) in found.measures {
                dict.set_item(measure.name, to_1d(py, measure.values))?;
            }
        } else {
            for (number, (measure, _)) in found.measures.iter().enumerate() {
                dict.set_item(&measure.name, to_1d(py, found.of_groups(number, &targets)))?;
            }
        }
        Ok(dict)
    }

    /// Heights of the solar envelope above the ground, their grid, and the volume.
    fn envelope<'py>(
        &self,
        py: Python<'py>,
        build: Build,
        days: Days,
        place: Place,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Column<'py>, Grid, f64)> {
        let inner = Arc::clone(&self.0);
        let suns: Vec<[f64; 3]> = if build.suns.is_empty() {
            let site = place.site(&inner)?;
            let zone = place.zone(&site, &days.times())?;
            let Some(Period::Days(dates)) = days.period(&place, &site, &zone)? else {
                return Err(wrong("period", "missing", "give sun, date, or a period of days"));
            };
            let between = build.between.unwrap_or([0.0, 24.0]);
            let suns = envelope_suns(&site, &zone, &dates, between, &days.params(&place)?).map_err(exception)?;
            suns.0.into_iter().map(|sun| sun.direction).collect()
        } else {
            let north = place.grid_north_of(&inner);
            let sun = |[azimuth, elevation]: &[f64; 2]| to_sun(azimuth.to_radians() - north, elevation.to_radians());
            build.suns.iter().map(sun).collect()
        };
        let points = ground_points(build.ground.as_deref())?;
        let of_work = Arc::clone(&inner);
        let found = run(py, progress, move |control| {
            let inner = of_work;
            let frame = inner.frame();
            let rings: Vec<Vec<[f64; 2]>> = build.parcel.iter().map(|ring| local_ring(&inner, ring)).collect();
            let parcel = Parcel::new(&rings)?;
            let protect: Vec<Vec<[f64; 3]>> =
                build.protect.iter().map(|line| line.iter().map(|&c| frame.local_from_file(c)).collect()).collect();
            let cell = build.cell.unwrap_or(CELL);
            let [mut low, mut high] = parcel.bounds();
            let origin = [frame.origin[0], frame.origin[1]];
            let below = ground_on(&inner, MapGrid::covering(low, high, cell, origin)?, points, control)?;
            for corner in protect.iter().flatten() {
                for axis in 0..2 {
                    low[axis] = low[axis].min(corner[axis]);
                    high[axis] = high[axis].max(corner[axis]);
                }
            }
            let (low, high) = (low.map(|v| v - MARGIN), high.map(|v| v + MARGIN));
            let wide = MapGrid::covering(low, high, cell_for(low, high).max(cell), origin)?;
            let around = ground_on(&inner, wide, points, control)?;
            let fence = build.fence_height.unwrap_or(0.0);
            let mut pieces: Vec<ProtectedPiece> = Vec::new();
            for (line, source) in protect.iter().zip(0..) {
                match &line[..] {
                    &[[x, y, z]] => {
                        let height = if z.is_nan() { around.height_at([x, y]) } else { Some(z) };
                        pieces.extend(height.map(|z| ProtectedPiece::point([x, y, z + fence], source)));
                    }
                    line => {
                        let spacing = build.spacing.unwrap_or(CELL);
                        pieces.extend(protected_line(line, fence, spacing, &around, source)?.0);
                    }
                }
            }
            if pieces.is_empty() {
                return Err(Error::NoPoints {
                    what: "the ground below what is protected is unknown; is it in the coordinates of the cloud?"
                        .to_owned(),
                });
            }
            let free = if build.credit_shade {
                let scene = inner.blockers(UnprovenAs::Visible, control)?;
                Some(control.stage("testing existing shadow", pieces.len(), || {
                    existing_shade(&scene, &pieces, &suns, control)
                })?)
            } else {
                None
            };
            let params = EnvelopeParams::default().with_ceiling(build.max_height);
            control.stage("computing envelope", suns.len(), || {
                solar_envelope(&parcel, &below, &pieces, &suns, free.as_ref(), &params, control)
            })
        })?;
        let grid = crate::targets::grid_of(&found.grid, inner.frame());
        let heights = to_1d(py, found.heights().values().to_vec()).into_any();
        let what = "height of the solar envelope above the ground, metres";
        Ok((("height".to_owned(), what, heights), grid, found.volume()))
    }
}
