//! Planes of roofs as files.

use super::hours;
use crate::arguments::{IrradianceArguments, PvArguments};
use crate::outputs::formats::{check_outputs, check_parent, extension};
use crate::outputs::text::write_lines;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{IrradianceResults, Remark, RoofsResults, Scene};
use belvedere::apps::horizon::{HorizonParams, horizons};
use belvedere::apps::irradiance::{building_columns, horizon_places, roof_columns};
use belvedere::apps::result_columns::ResultColumn;
use belvedere::apps::sun::Site;
use belvedere::io::{PolygonArea, atomic, outlines, row_properties, write_areas, write_table};
use belvedere::query::SkylinePoint;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

/// Azimuths of a horizon: steps of 7.5 degrees, as PVGIS has them.
const AZIMUTHS: usize = 48;

pub(super) fn check(arguments: &IrradianceArguments) -> Result<()> {
    check_outputs("--planes", &arguments.planes, &["csv", "geojson", "gpkg"])?;
    check_outputs("--buildings", &arguments.photovoltaics.buildings, &["csv"])?;
    for folder in [&arguments.horizons, &arguments.photovoltaics.hourly].into_iter().flatten() {
        check_parent(folder)?;
    }
    Ok(())
}

/// Writes the energy of all planes.
pub(super) fn write(
    arguments: &IrradianceArguments,
    roofs: &RoofsResults,
    found: &IrradianceResults,
    scene: &Scene,
    run: &mut CommandContext,
) -> Result<()> {
    run.summary.add("planes", Summary::of(&roofs.report));
    let (frame, site) = (scene.frame(), &found.site);
    for output in &arguments.planes {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "csv" => write_rows(output, roofs, frame, site),
            _ => write_outlines(output, roofs, frame, site),
        })?;
    }
    run.summary.add_paths("planes_written", &arguments.planes);
    let PvArguments { buildings, hourly, .. } = &arguments.photovoltaics;
    if let Some(output) = buildings {
        run.stage("writing", 0, |_| write_table(output, &building_columns(roofs.as_rows())))?;
        run.summary.add("buildings_written", output.display().to_string());
    }
    if let Some(folder) = hourly {
        hours::write(folder, roofs, run)?;
        run.summary.add("hourly_written", folder.display().to_string());
    }
    if let Some(folder) = &arguments.horizons {
        let enclosed = write_horizons(folder, roofs, found, run)?;
        run.summary.add("horizons_written", folder.display().to_string());
        run.summary.add("horizons_inside_obstacles", enclosed);
        let so = "have something above all of their cells, so that their horizon is 90 degrees all around";
        run.summary.remarks(Remark::of_share("horizons-inside-obstacles", enclosed, roofs.planes.len(), "planes", so));
    }
    Ok(())
}

fn write_rows(output: &Path, roofs: &RoofsResults, frame: &Frame, site: &Site) -> Result<()> {
    let mut columns = vec![ResultColumn::whole("plane", 1..=roofs.planes.len())];
    columns.extend(roof_columns(roofs.as_rows(), frame, site));
    Ok(write_table(output, &columns)?)
}

/// Writes two areas for each plane: its extent, and the cells that panels would lie on, which say so in `kind`.
fn write_outlines(output: &Path, roofs: &RoofsResults, frame: &Frame, site: &Site) -> Result<()> {
    let mut columns = roof_columns(roofs.as_rows(), frame, site);
    // an area has its place in its corners
    columns.retain(|column| !["x", "y", "z", "cells"].contains(&&column.name[..]));
    let mut areas = Vec::with_capacity(2 * roofs.planes.len());
    let kinds = roofs.planes.iter().enumerate().flat_map(|(number, plane)| {
        [("roof", &plane.extent), ("panels", &plane.cells)].map(|(kind, cells)| (number, kind, cells))
    });
    for (number, kind, cells) in kinds {
        let mut area = PolygonArea::default();
        area.properties.insert("kind".to_owned(), kind.into());
        area.properties.insert("plane".to_owned(), (number + 1).into());
        area.properties.extend(row_properties(&columns, number));
        let corner = |corner: &[usize; 2]| {
            let place = cells.place(corner.map(|v| v as f64));
            [place[0] + frame.origin[0], place[1] + frame.origin[1]]
        };
        for polygon in outlines(&cells.filled) {
            let rings = std::iter::once(&polygon.exterior).chain(&polygon.holes);
            // rows run up the slope here, not down a picture, so that rings come out the other way round
            area.polygons.push(rings.map(|ring| ring.iter().rev().map(corner).collect()).collect());
        }
        areas.push(area);
    }
    write_areas(output, &areas, &frame.crs)?;
    Ok(())
}

/// Writes the horizon of each plane, and gives how many are measured inside or below an obstacle, for want of a better
/// place.
fn write_horizons(
    folder: &Path,
    roofs: &RoofsResults,
    found: &IrradianceResults,
    run: &CommandContext,
) -> Result<usize> {
    atomic::make_folder(folder)?;
    let places = horizon_places(&roofs.planes, &roofs.blockers);
    let eyes: Vec<[f64; 3]> = places.iter().map(|(place, _)| place.map(f64::from)).collect();
    let params = HorizonParams::default().with_azimuth_count(AZIMUTHS).with_turn(found.site.convergence);
    let skylines =
        run.stage("computing ranges", eyes.len(), |control| horizons(&roofs.blockers, &eyes, &params, control))?;
    for (number, skyline) in skylines.iter().enumerate() {
        let path = folder.join(format!("plane_{}.txt", number + 1));
        write_lines(&path, skyline.iter().map(|point| format!("{:.2}", point.elevation.to_degrees().max(0.0))))?;
    }
    let is_closed = |skyline: &[SkylinePoint]| skyline.iter().all(|point| point.elevation >= FRAC_PI_2);
    let is_enclosed = |((_, is_open), skyline): (&([f32; 3], bool), &Vec<SkylinePoint>)| !is_open || is_closed(skyline);
    Ok(places.iter().zip(&skylines).filter(|&pair| is_enclosed(pair)).count())
}
