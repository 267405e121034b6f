//! Viewsheds as files.

use crate::arguments::Usage;
use crate::commands::extension;
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::viewshed::Viewshed;
use belvedere::figures::{MapLegend, MapMark, MapPicture, map_picture, ramp, write_png};
use belvedere::ground::{Ground, MapGrid, highest_points};
use belvedere::io::{
    Area, ExtraColumn, ExtraValues, WriteReport, outlines, write_cloud, write_geojson_areas, write_npy_u32_bands,
    write_tif_u8, write_tif_u16, write_tif_u32,
};
use belvedere::query::Answer;
use belvedere::raster::Raster;
use belvedere::results::georeference;
use std::path::Path;

/// Cells without an answer in a raster of answers.
const NODATA: u8 = 255;
/// No count.
const NO_COUNT: u16 = u16::MAX;

const SEEN_COLOR: [u8; 3] = [255, 176, 0];
const UNPROVEN_COLOR: [u8; 3] = [90, 150, 240];
const HIDDEN_COLOR: [u8; 3] = [38, 52, 96];

/// Writes what is seen of cells as a raster, a map or areas.
pub(super) fn on_cells(
    output: &Path,
    seen: &Viewshed,
    eyes: &[[f64; 3]],
    ground: &Ground,
    cloud: &PointCloud,
    is_reverse: bool,
) -> Result<()> {
    let grid = ground.grid;
    let one = seen.seen_counts.len() == 1;
    match extension(output).as_str() {
        "geojson" => write_areas(output, seen, &grid, cloud),
        "png" => {
            let title = match (is_reverse, one) {
                (true, _) => "Cells from which the target is visible",
                (false, true) => "Visible from the observer",
                (false, false) => "Number of observers that see the cell",
            };
            let mark_name = if is_reverse { "target" } else { "observer" };
            write_map(output, seen, eyes, ground, cloud, (title, mark_name))
        }
        _ if one => {
            let code = |answer: &Answer| match answer {
                Answer::OutsideView | Answer::OutsideCloud => NODATA,
                known => *known as u8,
            };
            let values = seen.answers.iter().map(code).collect();
            let raster = Raster::from_values(grid.width, grid.height, values)?;
            let what = "1 visible, 0 blocked, 2 unproven, 255 nodata";
            Ok(write_tif_u8(output, &raster, Some(&georeference(&grid, &cloud.frame)), Some(NODATA), Some(what))?)
        }
        _ => {
            let count = |(answer, &count): (&Answer, &u32)| match answer {
                Answer::OutsideView | Answer::OutsideCloud => NO_COUNT,
                _ => u16::try_from(count).unwrap_or(NO_COUNT).min(NO_COUNT - 1),
            };
            let values = seen.answers.iter().zip(&seen.counts).map(count).collect();
            let raster = Raster::from_values(grid.width, grid.height, values)?;
            let what = "number of observers that see the cell, 65535 nodata";
            Ok(write_tif_u16(output, &raster, Some(&georeference(&grid, &cloud.frame)), Some(NO_COUNT), Some(what))?)
        }
    }
}

/// Writes which observers see which cell.
pub(super) fn write_masks(output: &Path, seen: &Viewshed, ground: &Ground, cloud: &PointCloud) -> Result<()> {
    let grid = ground.grid;
    if extension(output) == "npy" {
        return Ok(write_npy_u32_bands(output, &seen.masks, grid.width, grid.height)?);
    }
    let [band] = &seen.masks[..] else {
        return Err(Usage("--masks: a .tif holds 32 observers; use .npy".to_owned()).into());
    };
    let raster = Raster::from_values(grid.width, grid.height, band.clone())?;
    let what = "bit i: observer i sees the cell";
    Ok(write_tif_u32(output, &raster, Some(&georeference(&grid, &cloud.frame)), None, Some(what))?)
}

/// Writes the points of the cloud with what is seen of them.
pub(super) fn on_points(output: &Path, seen: &Viewshed, cloud: &PointCloud) -> Result<WriteReport> {
    let codes: Vec<u8> = seen.answers.iter().map(|&answer| answer as u8).collect();
    let mut columns = vec![ExtraColumn {
        name: "answer",
        description: "0 no 1 yes 2 unproven 3 4 outside",
        values: ExtraValues::U8(&codes),
    }];
    if seen.seen_counts.len() > 1 {
        columns.push(ExtraColumn {
            name: "observers",
            description: "observers that see the point",
            values: ExtraValues::U32(&seen.counts),
        });
    }
    Ok(write_cloud(output, cloud, &columns)?)
}

fn write_areas(output: &Path, seen: &Viewshed, grid: &MapGrid, cloud: &PointCloud) -> Result<()> {
    let mut areas = Vec::new();
    for (answer, name) in [(Answer::Visible, "visible"), (Answer::Unproven, "unproven")] {
        let cells = Raster::from_values(grid.width, grid.height, seen.answers.iter().map(|&a| a == answer).collect())?;
        let polygons = outlines(&cells);
        if polygons.is_empty() {
            continue;
        }
        let cell_count: usize = polygons.iter().map(|polygon| polygon.cell_count).sum();
        let mut area = Area::default();
        area.properties.insert("answer".to_owned(), name.into());
        area.properties.insert("area_m2".to_owned(), (cell_count as f64 * grid.cell * grid.cell).into());
        let place = |corner: [usize; 2]| {
            let [x, y] = grid.corner_at(corner);
            [x + cloud.frame.origin[0], y + cloud.frame.origin[1]]
        };
        area.polygons = polygons.iter().map(|polygon| polygon.rings(place)).collect();
        areas.push(area);
    }
    write_geojson_areas(output, &areas, &cloud.frame.crs)?;
    Ok(())
}

fn write_map(
    output: &Path,
    seen: &Viewshed,
    eyes: &[[f64; 3]],
    ground: &Ground,
    cloud: &PointCloud,
    (title, mark_name): (&str, &str),
) -> Result<()> {
    let relief = highest_points(&cloud.positions, ground);
    let places = eyes.iter().filter_map(|eye| ground.grid.cell_position([eye[0], eye[1]]));
    let marks: Vec<MapMark> = places.map(|place| MapMark { place, ..MapMark::default() }).collect();
    // two at least: the legend of a range of two or more has whole numbers
    let most = f64::from(seen.counts.iter().copied().max().unwrap_or(0).max(2));
    let one = seen.seen_counts.len() == 1;
    let color = |(answer, &count): (&Answer, &u32)| match answer {
        Answer::Visible if one => Some(SEEN_COLOR),
        Answer::Blocked if one => Some(HIDDEN_COLOR),
        Answer::Visible | Answer::Blocked => Some(ramp(f64::from(count) / most)),
        Answer::Unproven => Some(UNPROVEN_COLOR),
        _ => None,
    };
    let colors: Vec<Option<[u8; 3]>> = seen.answers.iter().zip(&seen.counts).map(color).collect();
    let unproven = seen.answers.contains(&Answer::Unproven).then_some((UNPROVEN_COLOR, "unproven"));
    let unproven = unproven.as_slice();
    let classes = [&[(SEEN_COLOR, "visible")], unproven, &[(HIDDEN_COLOR, "blocked")]].concat();
    let legend = if one { MapLegend::Colors(&classes) } else { MapLegend::Ramp("observers", [0.0, most], unproven) };
    let cell = ground.grid.cell;
    let place = georeference(&ground.grid, &cloud.frame);
    let (relief, place, colors, marks) = (&relief, Some(&place), &colors[..], &marks[..]);
    let map = MapPicture { relief, cell, place, colors, marks, mark_name, title, legend };
    Ok(write_png(output, &map_picture(&map)?)?)
}
