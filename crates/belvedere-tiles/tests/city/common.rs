//! Files of a flown town, and plans of it.
#![expect(clippy::cast_possible_truncation, reason = "cells of a town are few")]

use belvedere::apps::shadow::ShadowSun;
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{read_tif, write_cloud};
use belvedere::{Attributes, Frame, GpsTimeKind, PointCloud};
use belvedere_scenes::{AirborneParams, TownParams, scan_airborne, town};
use belvedere_tiles::{Plan, PlanParams, RunParams, RunReport, Shard, Steps, TileQuestion, run};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Writes the scan of a town of `extent` metres as two files that adjoin along a line from south to north.
pub(crate) fn write_town(folder: &Path, extent: f64, pulses_per_m2: f64) -> Vec<PathBuf> {
    let scene = town(&TownParams { extent, seed: 5, ..TownParams::default() });
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2, ..AirborneParams::default() });
    let origin = [154_624.0, 462_848.0, 0.0];
    let middle = f64::midpoint(
        scan.x.iter().copied().fold(f64::INFINITY, f64::min),
        scan.x.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    );
    let cloud = PointCloud {
        frame: Frame { origin, crs: Crs::parse("EPSG:7415").unwrap() },
        positions: (0..scan.len()).map(|i| to_local([scan.x[i], scan.y[i], scan.z[i]], origin)).collect(),
        attributes: Attributes {
            classification: Some(scan.classification.clone()),
            gps_time: Some(scan.gps_time.clone()),
            gps_time_kind: GpsTimeKind::AdjustedStandard,
            return_number: Some(scan.return_number.clone()),
            return_count: Some(scan.return_count.clone()),
            scan_angle: Some(scan.scan_angle_deg.iter().map(|a| a.to_radians()).collect()),
            point_source_id: Some(scan.point_source_id.clone()),
            ..Attributes::default()
        },
        ..PointCloud::default()
    };
    let sides: [fn(f64, f64) -> bool; 2] = [|x, middle| x < middle, |x, middle| x >= middle];
    let file = |(number, is_in): (usize, &fn(f64, f64) -> bool)| {
        let rows: Vec<u32> = (0..).zip(&scan.x).filter(|(_, x)| is_in(**x, middle)).map(|(row, _)| row).collect();
        let path = folder.join(format!("half_{number}.laz"));
        write_cloud(&path, &cloud.select(&rows), &[]).unwrap();
        path
    };
    sides.iter().enumerate().map(file).collect()
}

/// Returns suns in the south-east at 5, 20 and 60 degrees.
pub(crate) fn suns() -> Vec<TileQuestion> {
    let sun = |elevation: f64| TileQuestion::Shadow {
        name: format!("shadow_{elevation}"),
        to_sun: ShadowSun::at(2.2, elevation.to_radians()).to_sun,
        season: None,
    };
    [5.0, 20.0, 60.0].map(sun).to_vec()
}

/// Plans a run and writes the plan into `folder`.
pub(crate) fn plan(clouds: &[PathBuf], folder: &Path, tile_size: f64, questions: Vec<TileQuestion>) -> Plan {
    let params = PlanParams { clouds: clouds.to_vec(), tile_size, ..PlanParams::default() };
    let plan = Plan::make(&params, &Control::none()).unwrap();
    plan.with_questions(questions, &Control::none()).unwrap().write(folder).unwrap();
    Plan::read(folder).unwrap()
}

pub(crate) fn run_all(plan: &Plan, folder: &Path) -> RunReport {
    run_with(plan, folder, None)
}

/// Runs a plan with at most `max_balls` balls at a time.
pub(crate) fn run_with(plan: &Plan, folder: &Path, max_balls: Option<usize>) -> RunReport {
    let params = RunParams { shard: Shard::default(), steps: Steps::All, max_balls, seconds: &|| 0.0 };
    run(plan, folder, &params, &Control::none()).unwrap()
}

/// Returns the values of all cells of 1 m of a merged raster by their place, metres, without cells of no data.
pub(crate) fn cells<T: Copy + PartialEq>(path: &Path, values: &[T], width: usize, none: T) -> BTreeMap<[i64; 2], T> {
    let corner = read_tif(path).unwrap().place.unwrap().upper_left.map(|v| v.round() as i64);
    let cell = |(number, &value): (usize, &T)| {
        let [column, row] = [number % width, number / width].map(|v| v as i64);
        (value != none).then_some(([corner[0] + column, corner[1] - row], value))
    };
    values.iter().enumerate().filter_map(cell).collect()
}
