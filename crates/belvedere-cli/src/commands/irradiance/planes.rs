//! Planes of roofs: found, asked, and written.

use super::super::sights::{ground, ground_cloud};
use super::super::{check_output, check_parent, extension};
use crate::arguments::{GroundChoice, Irradiance};
use crate::commands::horizon::write_lines;
use crate::pipeline::Scene;
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::horizon::{HorizonParams, horizons};
use belvedere::apps::irradiance::{
    RoofColumn, RoofIrradiation, RoofsReport, SeasonRadiation, horizon_places, roof_columns, roof_irradiation,
};
use belvedere::apps::roof_planes::{GROUND_CELL, RoofPlane, RoofPlaneParams, RoofsFrom, roof_planes, roof_points};
use belvedere::apps::rows::Obstacles;
use belvedere::apps::sun::Site;
use belvedere::ground::MapGrid;
use belvedere::io::{Area, Cells, atomic, outlines, write_geojson_areas, write_table};
use belvedere::query::MedialScene;

/// Azimuths of a horizon: steps of 7.5 degrees, as PVGIS has them.
const AZIMUTHS: usize = 48;

/// Roofs of the scene.
pub(super) struct Roofs {
    planes: Vec<RoofPlane>,
    /// Local frame and reference system.
    frame: PointCloud,
}

pub(super) fn check(arguments: &Irradiance) -> Result<()> {
    for output in &arguments.planes {
        check_output("--planes", output, &["csv", "geojson"])?;
    }
    if let Some(folder) = &arguments.horizons {
        check_parent(folder)?;
    }
    Ok(())
}

/// The planes of the scene's roofs, where they are wanted.
pub(super) fn find(arguments: &Irradiance, scene: &mut Scene, run: &mut Run) -> Result<Option<Roofs>> {
    if arguments.planes.is_empty() {
        return Ok(None);
    }
    let usual = RoofPlaneParams::default();
    let params = usual
        .with_least_area(arguments.least_area.unwrap_or(usual.least_area))
        .with_cell(arguments.panel.unwrap_or(usual.cell));
    let (low, high) = scene.model.bounds().on_map();
    let origin = [scene.cloud.frame.origin[0], scene.cloud.frame.origin[1]];
    let grid = MapGrid::covering(low, high, GROUND_CELL, origin)?;
    let (cloud, points) = ground_cloud(&arguments.places.ground, scene, run)?;
    let ground = run.aside(|run| ground(&cloud, points, grid, run)).0?;
    let frame = PointCloud::in_frame(cloud.frame.clone());
    let (rows, from) = roof_points(&cloud, &ground)?;
    let places: Vec<[f32; 3]> = rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
    let planes = run.stage("detecting roof planes", 0, |control| roof_planes(&places, &params, control));
    let planes = planes?;
    let mut section = Summary::default();
    let from = match from {
        RoofsFrom::Class => "class 6",
        RoofsFrom::Height => "height above the ground (no class 6)",
    };
    section
        .add("source", from)
        .add("points", places.len())
        .add("points_on_planes", planes.iter().map(|plane| plane.points.len()).sum::<usize>())
        .add("planes", planes.len())
        .add("area_m2", rounded(planes.iter().map(|plane| plane.area).sum(), 1));
    run.summary.add("roofs", section);
    // the cloud goes back to where it came from: cells and points may be asked about, too
    if matches!(arguments.places.ground, GroundChoice::OfScene(_)) {
        scene.cloud = cloud;
    }
    Ok(Some(Roofs { planes, frame }))
}

/// Asks for the energy of all planes and writes it.
pub(super) fn measure(
    arguments: &Irradiance,
    roofs: &Roofs,
    obstacles: Obstacles<'_>,
    seasons: &[SeasonRadiation],
    site: &Site,
    run: &mut Run,
) -> Result<()> {
    let rows = run.stage("computing horizons", roofs.planes.len(), |control| {
        roof_irradiation(obstacles, &roofs.planes, seasons, control)
    })?;
    run.summary.add("planes", Summary::of(&RoofsReport::new(&roofs.planes, &rows)));
    for output in &arguments.planes {
        run.stage("writing", 0, |_| match extension(output).as_str() {
            "csv" => write_rows(output, roofs, &rows, site),
            _ => write_outlines(output, roofs, &rows, site),
        })?;
    }
    run.summary
        .add("planes_written", arguments.planes.iter().map(|path| path.display().to_string()).collect::<Vec<_>>());
    if let Some(folder) = &arguments.horizons {
        let enclosed = write_horizons(folder, roofs, obstacles.scene, site, run)?;
        run.summary.add("horizons_written", folder.display().to_string());
        run.summary.add("horizons_inside_obstacles", enclosed);
    }
    Ok(())
}

fn columns(roofs: &Roofs, rows: &[RoofIrradiation], site: &Site) -> Vec<RoofColumn> {
    roof_columns(&roofs.planes, rows, &roofs.frame.frame, site)
}

fn write_rows(output: &std::path::Path, roofs: &Roofs, rows: &[RoofIrradiation], site: &Site) -> Result<()> {
    let numbers: Vec<Option<u64>> = (1..).take(rows.len()).map(Some).collect();
    let cells: Vec<Option<u64>> = rows.iter().map(|row| Some(row.cell_count as u64)).collect();
    let columns = columns(roofs, rows, site);
    let mut table = vec![("plane", Cells::Whole(&numbers)), ("cells", Cells::Whole(&cells))];
    table.extend(columns.iter().map(|column| (column.name, Cells::Real(&column.values, column.decimals))));
    Ok(write_table(output, &table)?)
}

fn write_outlines(output: &std::path::Path, roofs: &Roofs, rows: &[RoofIrradiation], site: &Site) -> Result<()> {
    let columns = columns(roofs, rows, site);
    let mut areas = Vec::with_capacity(rows.len());
    for (number, plane) in roofs.planes.iter().enumerate() {
        let mut area = Area::default();
        area.properties.insert("plane".to_owned(), (number + 1).into());
        for column in columns.iter().skip(3) {
            let digits = i32::try_from(column.decimals).unwrap_or(2);
            let value = column.values.get(number).copied().unwrap_or(f64::NAN);
            area.properties.insert(column.name.to_owned(), rounded(value, digits));
        }
        let corner = |corner: &[usize; 2]| {
            let place = plane.cells.place(corner.map(|v| v as f64));
            [place[0] + roofs.frame.frame.origin[0], place[1] + roofs.frame.frame.origin[1]]
        };
        for polygon in outlines(&plane.cells.filled) {
            let rings = std::iter::once(&polygon.rim).chain(&polygon.holes);
            // rows run up the slope here, not down a picture, so that rings come out the other way round
            area.polygons.push(rings.map(|ring| ring.iter().rev().map(corner).collect()).collect());
        }
        areas.push(area);
    }
    write_geojson_areas(output, &areas, &roofs.frame.frame.crs)?;
    Ok(())
}

/// Writes the horizon of each plane, and gives how many are measured inside an obstacle, for want of a better place.
fn write_horizons(
    folder: &std::path::Path,
    roofs: &Roofs,
    blockers: &MedialScene,
    site: &Site,
    run: &mut Run,
) -> Result<usize> {
    atomic::make_folder(folder)?;
    let places = horizon_places(&roofs.planes, blockers);
    let eyes: Vec<[f64; 3]> = places.iter().map(|(place, _)| place.map(f64::from)).collect();
    let params = HorizonParams::default().with_azimuth_count(AZIMUTHS).with_turn(site.convergence);
    let found = run.stage("computing ranges", eyes.len(), |control| horizons(blockers, &eyes, &params, control))?;
    for (number, skyline) in found.iter().enumerate() {
        let path = folder.join(format!("plane_{}.txt", number + 1));
        write_lines(&path, skyline.iter().map(|point| format!("{:.2}", point.elevation.to_degrees().max(0.0))))?;
    }
    Ok(places.iter().filter(|(_, is_open)| !is_open).count())
}
