//! Wirelines of towers as pictures and as a table.

use crate::apps::ask::TowerWirelines;
use crate::apps::result_columns::ResultColumn;
use crate::apps::wireline::{FRAME_COLUMNS, TowerOutline, Wireline, WirelineFrame};
use crate::figures::{DrawnTower, WirelinePlane, wireline_picture, write_png};
use crate::io::{atomic, write_table};
use crate::{Frame, Result};
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

/// Elevation of the lower and upper edge of a frame, degrees: together 18.2, as in the guidance of wind farms.
const EDGE_DEG: f64 = 9.1;
/// Degrees between azimuths and between elevations with a number.
const AZIMUTH_STEP_DEG: i32 = 5;
const ELEVATION_STEP_DEG: i32 = 2;
const LEGEND: &str = "Red: visible parts of towers, and of the areas that blades sweep. Orange: visible, but no pulse proves it. Dotted: hidden. Grey: buildings, trees and ground \
     of the cloud. Green to blue: terrain beyond it, near to far. From a distance equal to the width of the picture, \
     angles are as in nature.";

/// The files of wirelines from `count` places in `folder`: a table, and a picture for each place.
#[must_use]
pub fn wireline_files(folder: &Path, count: usize) -> Vec<PathBuf> {
    let pictures = (1..=count).map(|place| folder.join(format!("wireline_{place}.png")));
    std::iter::once(folder.join("wirelines.csv")).chain(pictures).collect()
}

/// Writes the picture of each wireline that has frames, and the table of all towers from all places, into `folder`,
/// which is made. Returns what was written.
///
/// # Errors
/// [`Error::Io`](crate::Error::Io).
pub fn write_wirelines(folder: &Path, found: &TowerWirelines, frame: &Frame) -> Result<Vec<PathBuf>> {
    atomic::make_folder(folder)?;
    let mut files = wireline_files(folder, found.views.len()).into_iter();
    let table = files.next().unwrap_or_default();
    write_rows(&table, found)?;
    let mut written = vec![table];
    for (number, (view, path)) in (1..).zip(found.views.iter().zip(files)) {
        if let Some(view) = view.as_ref().filter(|view| !view.frames.is_empty()) {
            let planes: Vec<WirelinePlane> = view.frames.iter().map(|frame| plane(view, frame, found)).collect();
            let title = title(number, view, frame, found);
            write_png(&path, &wireline_picture(&planes, &title, LEGEND))?;
            written.push(path);
        }
    }
    Ok(written)
}

fn title(number: usize, view: &Wireline, frame: &Frame, found: &TowerWirelines) -> String {
    let [x, y, z] = frame.file_from_local(view.eye);
    let seen = view.towers.iter().filter(|tower| !tower.visible.is_empty()).count();
    let from = if found.north.is_true() { "true" } else { "grid" };
    format!(
        "Place {number} at {x:.1}, {y:.1}, eye at {z:.1}: parts of {seen} of {} towers visible; azimuths from {from} north",
        view.towers.len()
    )
}

fn plane(view: &Wireline, frame: &WirelineFrame, found: &TowerWirelines) -> WirelinePlane {
    // rows above the level of the eye in a column
    let rows = |column: usize, elevation: f64| {
        let azimuth = WirelineFrame::azimuth_of(frame.azimuth, column);
        frame.on_plane(azimuth, elevation.clamp(-1.5, 1.5)).map_or(0.0, |[_, row]| row)
    };
    let of_column = |column: usize| {
        let pieces = frame.terrain[column].iter();
        pieces.map(|piece| [piece.elevations.map(|elevation| rows(column, elevation)), piece.distances]).collect()
    };
    let edge = WirelineFrame::plane_distance() * EDGE_DEG.to_radians().tan();
    let of_grid = found.north.of_grid;
    let degrees = |number: i32| (f64::from(number) * f64::from(AZIMUTH_STEP_DEG)).to_radians();
    let azimuths = (0..360 / AZIMUTH_STEP_DEG).filter_map(|number| {
        let [column, _] = frame.on_plane(degrees(number) - of_grid, 0.0)?;
        Some((column, format!("{}°", number * AZIMUTH_STEP_DEG)))
    });
    let elevations = (-90 / ELEVATION_STEP_DEG..90 / ELEVATION_STEP_DEG).filter_map(|number| {
        let elevation = number * ELEVATION_STEP_DEG;
        let [_, row] = frame.on_plane(frame.azimuth, f64::from(elevation).to_radians())?;
        Some((row, format!("{elevation}°")))
    });
    WirelinePlane {
        skyline: (0..FRAME_COLUMNS)
            .map(|column| [rows(column, frame.skyline[column][0]), frame.skyline[column][1]])
            .collect(),
        terrain: (0..FRAME_COLUMNS).map(of_column).collect(),
        towers: view.towers.iter().filter_map(|tower| drawn(tower, frame, found)).collect(),
        azimuths: azimuths.collect(),
        elevations: elevations.collect(),
        below: edge,
        above: edge,
    }
}

/// A tower on the plane of a frame; `None` beside it.
fn drawn(tower: &TowerOutline, frame: &WirelineFrame, found: &TowerWirelines) -> Option<DrawnTower> {
    let [column, _] =
        frame.on_plane(tower.azimuth, 0.0).filter(|[column, _]| column.abs() < FRAME_COLUMNS as f64 / 2.0)?;
    let row = |azimuth: f64, elevation: f64| frame.on_plane(azimuth, elevation).map_or(f64::NAN, |[_, row]| row);
    let spans = |azimuth: f64, spans: &[[f64; 2]]| -> Vec<[f64; 2]> {
        spans.iter().map(|span| span.map(|elevation| row(azimuth, elevation))).collect()
    };
    let disc = tower.rotor.iter().flat_map(|rotor| &rotor.lines).filter_map(|(azimuth, parts)| {
        let [column, _] = frame.on_plane(*azimuth, 0.0)?;
        Some((column, spans(*azimuth, parts)))
    });
    let along = ((tower.azimuth - frame.azimuth + PI).rem_euclid(TAU) - PI).cos();
    let disc_line = tower.rotor.as_ref().map_or(0.0, |rotor| rotor.line_width) * WirelineFrame::plane_distance();
    Some(DrawnTower {
        label: format!("{}, {:.1} km", found.names[tower.number], tower.distance / 1000.0),
        column,
        rows: tower.elevations.map(|elevation| row(tower.azimuth, elevation)),
        visible: spans(tower.azimuth, &tower.visible),
        disc: disc.collect(),
        disc_line: disc_line / (along * along),
        is_unproven: tower.is_unproven == Some(true),
    })
}

/// A row for each tower within the distance that counts, from each place.
fn write_rows(path: &Path, found: &TowerWirelines) -> Result<()> {
    let of_view = |(place, view): (usize, &Option<Wireline>)| {
        let mut towers: Vec<TowerOutline> = view.iter().flat_map(|view| view.towers.iter().cloned()).collect();
        towers.sort_by_key(|tower| tower.number);
        towers.into_iter().map(move |tower| (place, tower))
    };
    let rows: Vec<(usize, TowerOutline)> = (1..).zip(&found.views).flat_map(of_view).collect();
    let real = |name: &str, of: &dyn Fn(&TowerOutline) -> f64, decimals| {
        ResultColumn::real(name, rows.iter().map(|(_, tower)| of(tower)), decimals)
    };
    let optional = |of: Option<f64>| of.unwrap_or(f64::NAN);
    // what rounds to a whole turn is north
    let rounded = |degrees: f64| if degrees >= 359.995 { 0.0 } else { degrees };
    let azimuth = |tower: &TowerOutline| rounded((tower.azimuth + found.north.of_grid).rem_euclid(TAU).to_degrees());
    let share = |tower: &TowerOutline| optional(tower.rotor.as_ref().map(|rotor| rotor.visible_share));
    write_table(
        path,
        &[
            ResultColumn::whole("place", rows.iter().map(|(place, _)| *place)),
            ResultColumn::words("tower", rows.iter().map(|(_, tower)| &found.names[tower.number])),
            real("azimuth_deg", &azimuth, 2),
            real("distance_m", &|tower| tower.distance, 1),
            real("foot_deg", &|tower| tower.elevations[0].to_degrees(), 3),
            real("hub_deg", &|tower| optional(tower.hub).to_degrees(), 3),
            real("tip_deg", &|tower| tower.elevations[1].to_degrees(), 3),
            real("visible_m", &|tower| tower.visible_metres, 1),
            real("disc_visible_share", &share, 3),
            ResultColumn::whole("unproven", rows.iter().map(|(_, tower)| tower.is_unproven.map(usize::from))),
        ],
    )
}
