//! `belvedere protected-view`.

use super::heights::write_heights;
use super::landmark::what;
use super::sights::{self, ground_cloud, proving_blockers};
use super::surroundings::{check_eyes, eyes};
use super::{check_output, extension};
use crate::arguments::{Global, ProtectedView, UnprovenChoice};
use crate::pipeline::{self, Points};
use crate::run::Run;
use crate::summary::{Summary, rounded, sections};
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::landmark::LandmarkParams;
use belvedere::apps::protected_view::{self, ViewpointReport};
use belvedere::apps::viewshed::cell_for;
use belvedere::figures::{MapLegend, MapMark, MapPicture, map_picture, ramp, write_png};
use belvedere::ground::{Ground, MapGrid, highest_points};
use belvedere::raster::Raster;
use belvedere::results::georeference;
use std::path::Path;

/// Colour of cells that no protected view crosses.
const NO_LIMIT_COLOR: [u8; 3] = [226; 3];
/// Most viewpoints that the summary lists one by one.
const MOST_LISTED: usize = 10;

pub(crate) fn run(arguments: &ProtectedView, global: &Global) -> Result<Summary> {
    for output in &arguments.output {
        check_output("-o", output, &["tif", "tiff", "npy", "png"])?;
    }
    if let Some(output) = &arguments.tops {
        check_output("--tops", output, &["tif", "tiff", "npy"])?;
    }
    let mut run = Run::new(global);
    let mut scene = pipeline::scene(&arguments.scene, Points::Keep, &mut run)?;
    let (object, _) = what::surface(&arguments.shape, &scene, &mut run)?;
    let mut places = run.aside(|run| eyes(&arguments.eyes, &mut scene, run)).0?;
    let (low, high) = scene.model.bounds().on_map();
    let cell = arguments.cell.unwrap_or_else(|| cell_for(low, high));
    let [x, y, _] = scene.cloud.frame.origin;
    let grid = MapGrid::covering(low, high, cell, [x, y])?;
    let (cloud, points) = ground_cloud(&arguments.eyes.ground, &mut scene, &mut run)?;
    let ground = sights::ground(&cloud, points, grid, &mut run)?;
    let profile = scene.profile;
    let (blockers, unproven) = proving_blockers(&scene, profile, &arguments.giving_way, &mut run)?;
    check_eyes(&blockers, &cloud.frame, &mut places, &mut run)?;
    let params = LandmarkParams::default()
        .with_unproven(unproven)
        .with_max_range(arguments.max_distance.unwrap_or(f64::INFINITY));
    let found = run.stage("computing limits", places.len(), |control| {
        protected_view::protected_view(&blockers, &object, &places, &ground.grid, &params, control)
    })?;
    let above = found.above_ground(&ground)?;
    let mut section = Summary::default();
    let sum = |of: fn(&ViewpointReport) -> usize| found.viewpoints.iter().map(of).sum::<usize>();
    let lines_protected = sum(|one| one.lines_protected);
    section.add("lines_protected", lines_protected);
    if arguments.giving_way.unproven.is_none_or(|choice| matches!(choice, UnprovenChoice::Report)) {
        section.add("lines_unproven", sum(|one| one.lines_unproven));
    }
    section.add("lines_blocked", sum(|one| one.lines_blocked)).add("lines_not_tested", sum(|one| one.lines_not_tested));
    let known: Vec<f64> = above.values().iter().filter(|v| v.is_finite()).map(|&v| f64::from(v)).collect();
    section
        .add("cells_limited", known.len())
        .add("area_limited_m2", rounded(known.len() as f64 * grid.cell * grid.cell, 2));
    if !known.is_empty() {
        section
            .add("lowest_limit_m", rounded(known.iter().copied().fold(f64::INFINITY, f64::min), 3))
            .add("mean_limit_m", rounded(known.iter().sum::<f64>() / known.len() as f64, 3));
    }
    if found.viewpoints.len() <= MOST_LISTED {
        section.add("viewpoint", sections(&found.viewpoints));
    }
    run.summary.add("protected_view", section);
    if lines_protected == 0 {
        run.summary.warn("nothing-protected", "no observer sees any part of the landmark today: nothing is protected");
    }
    for output in &arguments.output {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "png" => write_map(output, &above, &ground, &cloud, &places),
            _ => write_heights(output, &above, (&ground.grid, &cloud.frame), "maximum height above the ground"),
        })?;
    }
    if let Some(output) = &arguments.tops {
        let mut tops = found.limits.clone();
        for top in tops.values_mut() {
            #[expect(clippy::cast_possible_truncation, reason = "a height")]
            let of_file = cloud.frame.file_from_local([0.0, 0.0, f64::from(*top)])[2] as f32;
            *top = of_file;
        }
        run.stage("writing", 0, |_| write_heights(output, &tops, (&ground.grid, &cloud.frame), "maximum height"))?;
    }
    run.summary
        .headline("heights limited on <protected_view.area_limited_m2> m2 (<protected_view.cells_limited> cells)")
        .headline(
            "lowest limit <protected_view.lowest_limit_m> m above the ground, mean <protected_view.mean_limit_m> m",
        )
        .headline(
            "lines of sight: <protected_view.lines_protected> protected, <protected_view.lines_blocked> blocked today",
        );
    let written = arguments.output.iter().chain(&arguments.tops).map(|path| path.display().to_string());
    run.summary.add("written", written.collect::<Vec<_>>());
    Ok(run.finish())
}

fn write_map(
    output: &Path,
    above: &Raster<f32>,
    ground: &Ground,
    cloud: &PointCloud,
    places: &[[f64; 3]],
) -> Result<()> {
    let relief = highest_points(&cloud.positions, ground);
    let known = || above.values().iter().copied().filter(|v| v.is_finite());
    let most = known().fold(0.0, f32::max).max(1.0);
    // where no ground is known there is no answer; elsewhere a cell without a limit is one that no view crosses
    let color = |(&height, &ground): (&f32, &f32)| match height.is_finite() {
        true => Some(ramp(f64::from(height / most))),
        false => ground.is_finite().then_some(NO_LIMIT_COLOR),
    };
    let colors: Vec<Option<[u8; 3]>> = above.values().iter().zip(ground.heights.values()).map(color).collect();
    let mark = |place: &[f64; 3]| {
        let place = ground.grid.cell_position([place[0], place[1]])?;
        Some(MapMark { place, ..MapMark::default() })
    };
    let marks: Vec<MapMark> = places.iter().filter_map(mark).collect();
    let map = MapPicture {
        relief: &relief,
        cell: ground.grid.cell,
        place: Some(&georeference(&ground.grid, &cloud.frame)),
        colors: &colors,
        marks: &marks,
        mark_name: "observer",
        title: "Maximum height below the protected views",
        legend: MapLegend::Ramp("metres above the ground", [0.0, f64::from(most)], &[(NO_LIMIT_COLOR, "no limit")]),
    };
    Ok(write_png(output, &map_picture(&map)?)?)
}
