//! Maps of shadow around the windows, areas and plan of a report.

use super::ReportParams;
use crate::Result;
use crate::apps::ask::{self, GridCells, Places, Scene, ShadowQuestion, SunCalendarResults};
use crate::apps::sun::{Date, sun_position_with};
use crate::apps::targets::{CellLevel, Measure};
use crate::control::Control;
use crate::ground::MapGrid;
use crate::query::UnprovenAs;
use crate::raster::Raster;
use crate::results::relief_of_cells;

/// Hours of the clock of maps, and that of many days.
const HOURS: [f64; 3] = [9.0, 12.0, 15.0];
const HOUR_OF_MANY_DAYS: [f64; 1] = [12.0];
/// Number of days up to which each has all hours.
const FEW_DAYS: usize = 3;
/// Lowest sun of a map, radians: 3 degrees.
const LOWEST_SUN: f64 = 0.052;
/// Cells along the longer side of a map.
const CELLS: f64 = 320.0;
/// Smallest side of a cell, metres.
const MIN_CELL: f64 = 0.5;
/// Room around windows, areas and plan, metres.
const MARGIN: f64 = 40.0;

/// Light of the cells of a map at several times.
pub(super) struct ShadowMaps {
    pub(super) grid: MapGrid,
    /// Heights of the highest points, metres.
    pub(super) relief: Raster<f32>,
    /// True for cells on a mesh that was added; empty where there is none.
    pub(super) is_plan: Vec<bool>,
    pub(super) lit: Vec<LitCells>,
}

/// Light of cells at one time.
pub(super) struct LitCells {
    pub(super) date: Date,
    /// Hour of the clock.
    pub(super) hour: f64,
    /// True for lit cells; `None` without an answer.
    pub(super) cells: Vec<Option<bool>>,
}

/// Box on the map around windows, areas and plan, within the scene, local metres.
pub(super) fn extent(present: &Scene, planned: Option<&Scene>, params: &ReportParams) -> ([f64; 2], [f64; 2]) {
    let windows = params.windows.iter().map(|window| [window.place[0], window.place[1]]);
    let areas = params.areas.iter().flat_map(|area| area.rings.iter().flatten().copied());
    let added = planned.and_then(|scene| scene.model().added());
    let plan = added.into_iter().flat_map(|added| added.triangles()).flat_map(|(corners, blocker)| {
        let is_mesh = blocker.mesh().is_some();
        corners.iter().filter(move |_| is_mesh).map(|corner| [corner[0], corner[1]].map(f64::from))
    });
    let places: Vec<[f64; 2]> = windows.chain(areas).chain(plan).collect();
    let (low, high) = present.model().bounds().on_map();
    let end = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| places.iter().map(|p| p[axis]).fold(start, pick);
    let lowest = [0, 1].map(|axis| (end(axis, f64::min, f64::INFINITY) - MARGIN).clamp(low[axis], high[axis]));
    let highest = [0, 1].map(|axis| (end(axis, f64::max, f64::NEG_INFINITY) + MARGIN).clamp(low[axis], high[axis]));
    match (0..2).all(|axis| highest[axis] - lowest[axis] > 4.0 * MIN_CELL) {
        true => (lowest, highest),
        // places beside the scene, which questions leave out
        false => (low, high),
    }
}

/// Computes the maps of the days in detail, at hours of the clock at which the sun stands high enough; `None` without
/// such an hour.
pub(super) fn shadow_maps(
    scene: &Scene,
    params: &ReportParams,
    calendar: &SunCalendarResults,
    (low, high): ([f64; 2], [f64; 2]),
    control: &Control<'_>,
) -> Result<Option<ShadowMaps>> {
    let mut times = Vec::new();
    let days = &calendar.schedule.days;
    let hours: &[f64] = if days.len() <= FEW_DAYS { &HOURS } else { &HOUR_OF_MANY_DAYS };
    for date in days.iter().map(|day| day.date) {
        for &hour in hours {
            let instant = calendar.zone.instant_of(date, hour)?;
            if sun_position_with(&calendar.site, instant, params.place.refraction)?.elevation > LOWEST_SUN {
                times.push((date, hour, calendar.zone.display(instant)));
            }
        }
    }
    if times.is_empty() {
        return Ok(None);
    }
    let cell = ((high[0] - low[0]).max(high[1] - low[1]) / CELLS).max(MIN_CELL);
    let cells = GridCells {
        cell: Some((cell * 10.0).ceil() / 10.0),
        level: CellLevel::Surface,
        bounds: Some((low, high)),
        ..GridCells::default()
    };
    let question = ShadowQuestion {
        place: params.place.clone(),
        unproven: Some(UnprovenAs::Visible),
        ..ShadowQuestion::of_times(times.iter().map(|(.., text)| text.clone()).collect())
    };
    let answers = ask::ask(scene, &question, &Places::Cells(cells), control)?;
    let targets = &answers.found.on.targets;
    let (Some(ground), Some(relief)) = (targets.ground(), relief_of_cells(targets, scene)) else { return Ok(None) };
    let of_time = |((date, hour, _), measure): (&(Date, f64, String), &Measure)| LitCells {
        date: *date,
        hour: *hour,
        cells: measure.values.iter().map(|&lit| lit.is_finite().then_some(lit > 0.5)).collect(),
    };
    let lit = times.iter().zip(&answers.measures).map(of_time).collect();
    Ok(Some(ShadowMaps { grid: ground.grid, relief, is_plan: targets.on_added.clone(), lit }))
}
