//! Observers and paths from tables and GeoJSON.

use std::path::Path;

use serde_json::{Map, Value};

use crate::geojson_read::{FeatureShape, read_geojson};
use crate::source::{Source, refuse_other_shapes};
use crate::table::read_table;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// An observer, or a path of observers, as a file has it. What the file does not say is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObserverRow {
    /// One place, or the corners of a path, metres in the system of the cloud; a height of NaN is not given.
    pub corners: Vec<[f64; 3]>,
    /// Height above the ground, metres.
    pub height: Option<f64>,
    /// Least and greatest distance, metres.
    pub distance: [Option<f64>; 2],
    /// Azimuth from and to, degrees.
    pub azimuth_deg: [Option<f64>; 2],
    /// Least and greatest elevation, degrees.
    pub elevation_deg: [Option<f64>; 2],
    /// Azimuth that a camera looks to, degrees.
    pub heading_deg: Option<f64>,
    /// Angle below the horizon that a camera looks to, degrees.
    pub tilt_deg: Option<f64>,
    /// Horizontal field of view of a camera, degrees.
    pub fov_deg: Option<f64>,
    /// How much it counts as a target.
    pub weight: Option<f64>,
}

/// Names of the columns, and of the properties in GeoJSON, in the order of [`from_values`].
const NAMES: [&str; 11] = [
    "height",
    "min_distance",
    "max_distance",
    "azimuth_from",
    "azimuth_to",
    "elevation_from",
    "elevation_to",
    "heading",
    "tilt",
    "fov",
    "weight",
];

/// What the rows of a table are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowsAre {
    /// Observers, each for itself.
    Places,
    /// The corners of one path, which takes everything but its places from the first row.
    Corners,
}

/// Reads observers from a table (.csv .txt) or GeoJSON (.geojson .json).
///
/// A table has columns x and y in the coordinates of the cloud's file, and may have z (height of the eye; empty where
/// it follows from the ground), height (above the ground, metres), min_distance and max_distance (metres),
/// azimuth_from, azimuth_to, elevation_from, elevation_to, heading, tilt and fov (degrees) and weight. GeoJSON has
/// these as properties; points are observers, lines are paths, and the corners of polygons are walked around.
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Malformed`] for missing columns, text in place of numbers and files without
/// observers, and what [`read_table`] and [`read_geojson`] refuse.
pub fn read_observers<'a>(source: impl Into<Source<'a>>, crs: &Crs, rows_are: RowsAre) -> Result<Vec<ObserverRow>> {
    let source = source.into();
    let name = source.name().to_owned();
    let path = name.as_path();
    refuse_other_shapes(path)?;
    let rows = match source.extension().as_str() {
        "csv" | "txt" => of_table(source, path, crs, rows_are)?,
        "geojson" | "json" => of_geojson(source, path, crs)?,
        _ => {
            let supported = ".csv .txt .geojson .json";
            return Err(Error::UnknownFormat { path: path.to_owned(), kind: "observers", supported });
        }
    };
    if rows.is_empty() {
        return Err(Error::malformed(path, "has no places; give a row with x and y for each"));
    }
    Ok(rows)
}

fn of_table(source: Source<'_>, path: &Path, crs: &Crs, rows_are: RowsAre) -> Result<Vec<ObserverRow>> {
    let table = read_table(source)?;
    let scale = crs.metres_per_unit_xyz();
    let (x, y) = (table.full_column(path, "x")?, table.full_column(path, "y")?);
    let z = table.column(path, "z")?;
    let mut columns: [Option<&[f64]>; NAMES.len()] = [None; NAMES.len()];
    for (column, name) in columns.iter_mut().zip(NAMES) {
        *column = table.column(path, name)?;
    }
    let mut rows: Vec<ObserverRow> = Vec::new();
    for (i, (x, y)) in x.iter().zip(y).enumerate() {
        let z = z.and_then(|z| z.get(i)).copied().unwrap_or(f64::NAN);
        let corner = [x * scale[0], y * scale[1], z * scale[2]];
        if let (RowsAre::Corners, Some(path)) = (rows_are, rows.first_mut()) {
            path.corners.push(corner);
            continue;
        }
        let values = columns.map(|column| column?.get(i).copied());
        rows.push(from_values(vec![corner], values, path)?);
    }
    Ok(rows)
}

fn of_geojson(source: Source<'_>, path: &Path, crs: &Crs) -> Result<Vec<ObserverRow>> {
    let mut rows = Vec::new();
    for feature in read_geojson(source, crs)? {
        let corners = match feature.shape {
            FeatureShape::Point(place) => vec![place],
            FeatureShape::Line(corners) => corners,
            FeatureShape::Polygon(rings) => rings.into_iter().next().unwrap_or_default(),
        };
        if corners.is_empty() {
            continue;
        }
        let mut values = [None; NAMES.len()];
        for (value, name) in values.iter_mut().zip(NAMES) {
            *value = number(&feature.properties, name, path)?;
        }
        rows.push(from_values(corners, values, path)?);
    }
    Ok(rows)
}

fn number(properties: &Map<String, Value>, name: &str, path: &Path) -> Result<Option<f64>> {
    match properties.get(name) {
        None | Some(Value::Null) => Ok(None),
        Some(Value::Number(number)) => Ok(number.as_f64()),
        Some(Value::String(text)) if text.trim().is_empty() => Ok(None),
        Some(Value::String(text)) => match text.trim().parse() {
            Ok(value) => Ok(Some(value)),
            Err(_) => Err(Error::malformed(path, format!("property {name} is \"{text}\", which is not a number"))),
        },
        Some(other) => Err(Error::malformed(path, format!("property {name} is {other}, which is not a number"))),
    }
}

fn from_values(corners: Vec<[f64; 3]>, values: [Option<f64>; NAMES.len()], path: &Path) -> Result<ObserverRow> {
    if let Some(corner) = corners.iter().find(|c| !(c[0].is_finite() && c[1].is_finite())) {
        return Err(Error::malformed(path, format!("an observer has the position {corner:?}")));
    }
    let [height, min, max, azimuth_from, azimuth_to, elevation_from, elevation_to, heading, tilt, fov, weight] =
        values.map(|value| value.filter(|v| !v.is_nan()));
    if let Some(height) = height.filter(|height| !(*height >= 0.0 && height.is_finite())) {
        let what = format!("an observer has the height {height}; heights above the ground are 0 metres or more");
        return Err(Error::malformed(path, what));
    }
    Ok(ObserverRow {
        corners,
        height,
        distance: [min, max],
        azimuth_deg: [azimuth_from, azimuth_to],
        elevation_deg: [elevation_from, elevation_to],
        heading_deg: heading,
        tilt_deg: tilt,
        fov_deg: fov,
        weight,
    })
}
