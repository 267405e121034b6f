//! Observers and paths from tables and GeoJSON.

use std::ops::Range;
use std::path::Path;

use serde_json::{Map, Value};

use crate::files::source::{Source, refuse_other_shapes};
use crate::map_features::{FeatureShape, read_features};
use crate::text::table::read_table;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// An observer, or a path of observers, as in a file. Values missing from the file are `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObserverRow {
    /// One place, or the corners of a path, metres in the system of the cloud; a height of NaN is not given.
    pub corners: Vec<[f64; 3]>,
    /// Height above the ground, metres.
    pub height: Option<f64>,
    /// Minimum and maximum distance, metres.
    pub distance: [Option<f64>; 2],
    /// Azimuth from and to, degrees.
    pub azimuth_deg: [Option<f64>; 2],
    /// Minimum and maximum elevation, degrees.
    pub elevation_deg: [Option<f64>; 2],
    /// Azimuth that a camera looks to, degrees.
    pub heading_deg: Option<f64>,
    /// Angle below the horizon that a camera looks to, degrees.
    pub tilt_deg: Option<f64>,
    /// Horizontal field of view of a camera, degrees.
    pub fov_deg: Option<f64>,
    /// Weight as a target.
    pub weight: Option<f64>,
    /// Name, or else id; empty for none.
    pub name: String,
}

/// Meanings of columns of a table, or properties in GeoJSON, of observers, in the order of [`from_values`].
const MEANINGS: [Meaning; 13] = [
    Meaning { names: &["height", "observ_hgt", "offseta", "observer_height", "eye_height"], unit: Unit::Height },
    Meaning { names: &["min_distance", "radius1", "radius_in"], unit: Unit::Distance },
    Meaning { names: &["max_distance", "radius2", "radius"], unit: Unit::Distance },
    Meaning { names: &["azimuth_from", "azimuth1", "azim_1"], unit: Unit::None },
    Meaning { names: &["azimuth_to", "azimuth2", "azim_2"], unit: Unit::None },
    Meaning { names: &["elevation_from", "vert2", "angle_down"], unit: Unit::None },
    Meaning { names: &["elevation_to", "vert1", "angle_up"], unit: Unit::None },
    Meaning { names: &["heading"], unit: Unit::None },
    Meaning { names: &["tilt"], unit: Unit::None },
    Meaning { names: &["fov"], unit: Unit::None },
    Meaning { names: &["weight"], unit: Unit::None },
    Meaning { names: &["z"], unit: Unit::HeightOfFile },
    Meaning { names: &["spot"], unit: Unit::HeightOfFile },
];

/// Columns or properties of names.
const NAMES: [&str; 2] = ["name", "id"];

/// Indices of the meanings that limit distance and direction.
const LIMITS: Range<usize> = 1..10;

/// Names of one meaning, in lower case. The first is our own, in metres or degrees, and precedes the others. These are
/// the names of the visibility tools of QGIS and ArcGIS, in the unit of the file.
struct Meaning {
    names: &'static [&'static str],
    unit: Unit,
}

#[derive(Clone, Copy)]
enum Unit {
    None,
    Distance,
    Height,
    /// Under every name.
    HeightOfFile,
}

/// Parts of names that mention a direction or limit of a view. Columns with one of them but without a [`Meaning`] are
/// named as not used.
const TELLING: [&str; 15] = [
    "hgt", "height", "offset", "radius", "azim", "vert", "angle", "spot", "dist", "heading", "bearing", "tilt",
    "pitch", "fov", "elev",
];

/// Height above its place that an observer with `SPOT` alone has in ArcGIS, in the unit of the file.
const OFFSET_OF_SPOT: f64 = 1.0;

/// Observers and paths of a file, and the names of its columns that were not used.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObserverRows {
    /// One for each row or shape.
    pub rows: Vec<ObserverRow>,
    /// Names of columns or properties that look as if they said how somebody looks, and are not understood.
    pub unused: Vec<String>,
    /// Names of those that were understood and say how far and where somebody looks: a question that is about places
    /// does not use them.
    pub limits: Vec<String>,
}

/// Meaning of the rows of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowsAre {
    /// Observers, each for itself.
    Places,
    /// The corners of one path, which takes everything but its places from the first row.
    Corners,
}

/// Reads observers from a table (.csv .txt) or GeoJSON (.geojson .json).
///
/// A table has columns x and y in the coordinates of the cloud's file. It may have z (height of the eye, in the unit of
/// the file; empty if it follows from the ground) and height (above the ground, metres). Further columns are
/// min_distance and max_distance (metres), azimuth_from, azimuth_to, elevation_from, elevation_to, heading, tilt and
/// fov (degrees), weight, and name or id.
///
/// GeoJSON has these as properties; points are observers, lines are paths, and the corners of polygons are walked
/// around. A property z precedes the third coordinate. Upper and lower case are the same.
///
/// Names of other programs are understood, lengths in the unit of the file. QGIS has observ_hgt, radius, radius_in,
/// azim_1, azim_2, angle_down and angle_up. ArcGIS has OFFSETA, RADIUS1, RADIUS2, AZIMUTH1, AZIMUTH2, VERT1, VERT2 and
/// SPOT: the eye is OFFSETA above SPOT, or 1. A range with one end is completed by the end of all directions.
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Malformed`] for missing columns, text in place of numbers and files without
/// observers, and the errors of [`read_table`] and [`read_features`].
pub fn read_observers<'a>(source: impl Into<Source<'a>>, crs: &Crs, rows_are: RowsAre) -> Result<ObserverRows> {
    let source = source.into();
    let name = source.name().to_owned();
    let path = name.as_path();
    refuse_other_shapes(path)?;
    let rows = match source.extension().as_str() {
        "csv" | "txt" => of_table(source, path, crs, rows_are)?,
        "geojson" | "json" | "gpkg" | "shp" => of_geojson(source, path, crs)?,
        _ => {
            let supported = ".csv .txt .geojson .json .gpkg .shp";
            return Err(Error::UnknownFormat { path: path.to_owned(), kind: "observers", supported });
        }
    };
    if rows.rows.is_empty() {
        return Err(Error::malformed(path, "has no places; give a row with x and y for each"));
    }
    Ok(rows)
}

fn of_table(source: Source<'_>, path: &Path, crs: &Crs, rows_are: RowsAre) -> Result<ObserverRows> {
    let table = read_table(source)?;
    let scale = crs.metres_per_unit_xyz();
    let [x, y] = table.full_columns(path, ["x", "y"])?;
    let mut columns: [Option<(&[f64], usize)>; MEANINGS.len()] = [None; MEANINGS.len()];
    let mut used: Vec<(&str, usize)> = Vec::new();
    for (index, (column, meaning)) in columns.iter_mut().zip(&MEANINGS).enumerate() {
        for (number, name) in meaning.names.iter().enumerate() {
            if column.is_none()
                && let Some(values) = table.column(path, name)?
            {
                *column = Some((values, number));
                used.push((name, index));
            }
        }
    }
    let mut found = ObserverRows::of_names(table.names(), &used);
    let names: Vec<Vec<&str>> = NAMES.iter().filter_map(|name| table.words(name)).collect();
    for (i, (x, y)) in x.iter().zip(y).enumerate() {
        let value = |column: usize| {
            let (values, number) = columns[column]?;
            Some(MEANINGS[column].metres(number, *values.get(i)?, scale))
        };
        let values = std::array::from_fn(value);
        let mut row = from_values(vec![[x * scale[0], y * scale[1], f64::NAN]], values, scale[2], path)?;
        let own_names = names.iter().filter_map(|names| names.get(i)).map(|name| name.trim());
        row.name = own_names.into_iter().find(|name| !name.is_empty()).unwrap_or_default().to_owned();
        match (rows_are, found.rows.first_mut()) {
            (RowsAre::Corners, Some(path)) => path.corners.extend(row.corners),
            _ => found.rows.push(row),
        }
    }
    Ok(found)
}

fn of_geojson(source: Source<'_>, path: &Path, crs: &Crs) -> Result<ObserverRows> {
    let scale = crs.metres_per_unit_xyz();
    let (mut rows, mut names, mut used) = (Vec::new(), Vec::<String>::new(), Vec::new());
    for feature in read_features(source, crs)? {
        let corners = match feature.shape {
            FeatureShape::Point(place) => vec![place],
            FeatureShape::Line(corners) => corners,
            FeatureShape::Polygon(rings) => rings.into_iter().next().unwrap_or_default(),
        };
        if corners.is_empty() {
            continue;
        }
        let mut values = [None; MEANINGS.len()];
        for (index, (value, meaning)) in values.iter_mut().zip(&MEANINGS).enumerate() {
            for (number, name) in meaning.names.iter().enumerate() {
                let Some(own) = number_of(&feature.properties, name, path)?.filter(|_| value.is_none()) else {
                    continue;
                };
                *value = Some(meaning.metres(number, own, scale));
                used.push((*name, index));
            }
        }
        let others: Vec<String> = feature.properties.keys().filter(|name| !names.contains(name)).cloned().collect();
        names.extend(others);
        let own_names = NAMES.iter().map(|name| words_of(&feature.properties, name));
        let name = own_names.into_iter().find(|name| !name.is_empty()).unwrap_or_default();
        rows.push(ObserverRow { name, ..from_values(corners, values, scale[2], path)? });
    }
    Ok(ObserverRows { rows, ..ObserverRows::of_names(&names, &used) })
}

impl Meaning {
    /// Metres or degrees of a `value` of the file under the name with this number.
    fn metres(&self, number: usize, value: f64, scale: [f64; 3]) -> f64 {
        match self.unit {
            // ArcGIS marks distances along the line of sight by a minus
            Unit::Distance if number > 0 => value.abs() * scale[0],
            Unit::Height if number > 0 => value * scale[2],
            Unit::HeightOfFile => value * scale[2],
            _ => value,
        }
    }
}

impl ObserverRows {
    /// Returns the use of the `names` of a file; those in `used` had the meaning with that index.
    fn of_names(names: &[String], used: &[(&str, usize)]) -> Self {
        let mut found = Self::default();
        for name in names {
            let plain = name.trim().to_ascii_lowercase();
            match used.iter().find(|(own, _)| *own == plain) {
                Some((_, index)) if LIMITS.contains(index) => found.limits.push(name.clone()),
                None if TELLING.iter().any(|part| plain.contains(part)) => found.unused.push(name.clone()),
                _ => {}
            }
        }
        found
    }
}

/// The property of that name, in upper or lower case.
pub fn property<'a>(properties: &'a Map<String, Value>, name: &str) -> Option<&'a Value> {
    let any_case = || properties.iter().find(|(own, _)| own.trim().eq_ignore_ascii_case(name));
    properties.get(name).or_else(|| any_case().map(|(_, value)| value))
}

/// The property of that name as text; empty where there is none.
pub(crate) fn words_of(properties: &Map<String, Value>, name: &str) -> String {
    match property(properties, name) {
        Some(Value::String(text)) => text.trim().to_owned(),
        Some(Value::Null) | None => String::new(),
        Some(other) => other.to_string(),
    }
}

pub(crate) fn number_of(properties: &Map<String, Value>, name: &str, path: &Path) -> Result<Option<f64>> {
    match property(properties, name) {
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

/// An observer at `corners` with `values` in metres and degrees, where a unit of heights of the file has
/// `metres_per_height`.
fn from_values(
    mut corners: Vec<[f64; 3]>,
    values: [Option<f64>; MEANINGS.len()],
    metres_per_height: f64,
    path: &Path,
) -> Result<ObserverRow> {
    if let Some(corner) = corners.iter().find(|c| !(c[0].is_finite() && c[1].is_finite())) {
        return Err(Error::malformed(path, format!("an observer has the position {corner:?}")));
    }
    let [height, min, max, azimuth_from, azimuth_to, elevation_from, elevation_to, heading, tilt, fov, weight, z, spot] =
        values.map(|value| value.filter(|v| !v.is_nan()));
    if let Some(height) = height.filter(|height| !(*height >= 0.0 && height.is_finite())) {
        let what = format!("an observer has the height {height}; heights above the ground are 0 metres or more");
        return Err(Error::malformed(path, what));
    }
    let above_spot = spot.map(|spot| spot + height.unwrap_or(OFFSET_OF_SPOT * metres_per_height));
    if let Some(z) = z.or(above_spot) {
        corners.iter_mut().for_each(|corner| corner[2] = z);
    }
    Ok(ObserverRow {
        corners,
        height,
        distance: [min, max],
        azimuth_deg: whole_range([azimuth_from, azimuth_to], [0.0, 360.0]),
        elevation_deg: whole_range([elevation_from, elevation_to], [-90.0, 90.0]),
        heading_deg: heading,
        tilt_deg: tilt,
        fov_deg: fov,
        weight,
        name: String::new(),
    })
}

/// A range of which one end may be missing: then it is that of `all`.
fn whole_range(range: [Option<f64>; 2], all: [f64; 2]) -> [Option<f64>; 2] {
    match range {
        [None, None] => range,
        [from, to] => [from.or(Some(all[0])), to.or(Some(all[1]))],
    }
}
