//! Results of applications as files: measures of targets as rasters, columns of points, tables and meshes.
//!
//! | targets | `.tif` | `.laz` `.las` `.ply` `.csv` |
//! |---|---|---|
//! | cells of a grid | all measures as bands with their names | a point for each target, all measures as columns |
//! | points | | the points with their attributes, all measures as columns; `.csv` of a table: its rows |
//! | faces of a mesh | | `.csv`: a row for each object and face; `.ply`: the mesh coloured by the first measure |

mod by_area;
mod calendar;
#[cfg(feature = "figures")]
mod difference;
mod faces;
#[cfg(feature = "figures")]
mod map;
mod question;
mod raster;
#[cfg(feature = "figures")]
mod wirelines;

pub use by_area::{areas_of, write_area_means};
pub use calendar::write_calendar;
#[cfg(feature = "figures")]
pub use difference::{difference_map, relief_of};
pub use faces::FaceRows;
#[cfg(feature = "figures")]
pub use map::{measure_map, relief_of_cells};
#[cfg(feature = "tiff")]
pub use question::question_of_raster;
pub use question::{file_name, question_tags, read_question};
pub use raster::{ADDED_BAND, Pixels, ResultRaster, UNPROVEN_BAND};
#[cfg(feature = "figures")]
pub use wirelines::{wireline_files, write_wirelines};

pub use crate::apps::targets::ResultKind;

use crate::apps::sun_hours::CLOCK_MEASURES;
use crate::apps::targets::{Measure, TargetLayout, Targets};
use crate::ground::{Ground, MapGrid};
use crate::io::{
    ExtraColumn, ExtraValues, Georeference, MetadataTag, TextRows, WriteReport, write_cloud, write_text_rows,
};
use crate::{ElevationGrid, Error, Frame, Mesh, PointCloud, Result};
use std::path::Path;

/// Source of targets, if it is written along with their measures.
#[derive(Clone, Copy)]
pub enum TakenFrom<'a> {
    /// Targets alone are written: cells.
    Nothing,
    /// The points of a cloud, with their attributes.
    Cloud(&'a PointCloud),
    /// The rows of a table, which stay as they were given; for outputs that are tables too.
    Rows(&'a TextRows),
    /// The faces of a mesh.
    Mesh(&'a Mesh),
}

/// Returns the position of a grid in the reference system of a frame.
#[must_use]
pub fn georeference(grid: &MapGrid, frame: &Frame) -> Georeference {
    let unit = frame.crs.metres_per_unit;
    let upper_left = [0, 1].map(|i| (grid.corner[i] + frame.origin[i]) / unit);
    let step = grid.cell / unit;
    Georeference { upper_left, column_step: [step, 0.0], row_step: [0.0, -step], crs: frame.crs.clone() }
}

/// Returns the position of the cells around the nodes of a raster of terrain in the reference system of a frame.
#[must_use]
pub fn terrain_georeference(terrain: &ElevationGrid, frame: &Frame) -> Georeference {
    let unit = frame.crs.metres_per_unit;
    let ([west, north], [east, south]) = (terrain.north_west(), terrain.cell());
    let corner = [west - east / 2.0, north + south / 2.0];
    let upper_left = [0, 1].map(|i| (corner[i] + frame.origin[i]) / unit);
    let (column_step, row_step) = ([east / unit, 0.0], [0.0, -south / unit]);
    Georeference { upper_left, column_step, row_step, crs: frame.crs.clone() }
}

/// Writes the measures of `targets` in the format that the extension of `path` names. Rasters have `tags` as metadata.
///
/// # Errors
/// [`Error::UnsupportedTargets`] where such targets do not fit the format, [`Error::LengthMismatch`] where a measure
/// has not a value for each target, [`Error::NoPoints`] without a measure, and those of the writers.
pub fn write_measures(
    path: &Path,
    targets: &Targets,
    from: TakenFrom<'_>,
    measures: &[Measure],
    tags: &[MetadataTag],
) -> Result<WriteReport> {
    let Some(first) = measures.first() else {
        return Err(Error::NoPoints { what: "there is no measure to write".to_owned() });
    };
    let expected = targets.len();
    if let Some(found) = measures.iter().map(|measure| measure.values.len()).find(|&found| found != expected) {
        return Err(Error::LengthMismatch { what: "values of a measure", expected, found });
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let is_tiff = matches!(extension.as_str(), "tif" | "tiff");
    match (&targets.layout, from) {
        (TargetLayout::Cells(_), _) if is_tiff => {
            let measures: Vec<&Measure> = measures.iter().collect();
            write_raster(path, targets, &measures, tags).map(|()| WriteReport::default())
        }
        (TargetLayout::Surface(surface), TakenFrom::Mesh(mesh)) => {
            match extension.as_str() {
                "ply" => faces::write_colored(path, mesh, surface, &targets.frame, first),
                _ => FaceRows::of_measures(mesh, surface, measures).write(path),
            }?;
            Ok(WriteReport::default())
        }
        (_, TakenFrom::Rows(rows)) if !is_tiff => {
            write_text_rows(path, rows, &columns(path, measures)).map(|()| WriteReport::default())
        }
        (_, TakenFrom::Cloud(cloud)) if !is_tiff => write_points(path, cloud, measures),
        (TargetLayout::Cells(_) | TargetLayout::Points, TakenFrom::Nothing) if !is_tiff => {
            let rows: Vec<usize> = (0..expected).filter(|&row| targets.is_target(row)).collect();
            let positions = rows.iter().map(|&row| targets.positions[row]).collect();
            let cloud = PointCloud { frame: targets.frame.clone(), positions, ..PointCloud::default() };
            let pick = |measure: &Measure| Measure {
                values: rows.iter().map(|&row| measure.values[row]).collect(),
                ..measure.without_values()
            };
            write_points(path, &cloud, &measures.iter().map(pick).collect::<Vec<_>>())
        }
        _ => Err(Error::UnsupportedTargets {
            method: "this format",
            what: "rasters hold cells of a grid, tables and point formats all targets, meshes their faces",
        }),
    }
}

/// Writes measures of the cells of a grid as the bands of a raster, with the reference system of their frame. Their
/// kind decides the type of the pixels and their value for no data; measures of several kinds are numbers. Cells that
/// are no targets have no value in any band. `tags` are the metadata of the whole. Where cells stand on a mesh that was
/// added, a last band says which ([`ADDED_BAND`]).
///
/// # Errors
/// [`Error::UnsupportedTargets`] for targets that are no cells, [`Error::LengthMismatch`] unless there is a value for
/// each cell, and those of [`ResultRaster::write`].
pub fn write_raster(path: &Path, targets: &Targets, measures: &[&Measure], tags: &[MetadataTag]) -> Result<()> {
    let grid = cells(targets)?.grid;
    let place = georeference(&grid, &targets.frame);
    let mut bands: Vec<Measure> = measures.iter().map(|&measure| measure.clone()).collect();
    if let Some(first) = bands.first().filter(|_| !targets.on_added.is_empty()) {
        let values = targets.on_added.iter().map(|&is_added| f32::from(u8::from(is_added))).collect();
        bands.push(Measure::new(ADDED_BAND, values).with_kind(first.kind));
    }
    bands.iter_mut().for_each(|band| targets.clear_unasked(&mut band.values));
    ResultRaster::of_measures(&bands, [grid.width, grid.height])?.with_tags(tags).write(path, Some(&place))
}

fn cells(targets: &Targets) -> Result<&Ground> {
    targets
        .ground()
        .ok_or(Error::UnsupportedTargets { method: "a raster", what: "its targets are the cells of a grid" })
}

fn write_points(path: &Path, cloud: &PointCloud, measures: &[Measure]) -> Result<WriteReport> {
    write_cloud(path, cloud, &columns(path, measures))
}

/// Measures as columns. Tables (.csv) have hours on the clock as HH:MM, too.
fn columns<'a>(path: &Path, measures: &'a [Measure]) -> Vec<ExtraColumn<'a>> {
    let column = |measure: &'a Measure| ExtraColumn {
        name: &measure.name,
        description: measure.description,
        values: ExtraValues::F32(&measure.values),
    };
    let is_table = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    let clock = |measure: &'a Measure| {
        let (_, name) = CLOCK_MEASURES.into_iter().find(|(hours, _)| is_table && *hours == measure.name)?;
        Some(ExtraColumn { name, description: "time of the clock", values: ExtraValues::Clock(&measure.values) })
    };
    measures.iter().map(column).chain(measures.iter().filter_map(clock)).collect()
}
