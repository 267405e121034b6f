//! Points, lines and polygons from GeoJSON.

use std::path::Path;

use serde_json::{Map, Value};

use super::source::Source;

use belvedere_data::crs::{Crs, CrsKind, GeographicProjection};
use belvedere_data::{Error, Result};

/// Deepest nesting of geometry collections.
const MOST_NESTING: usize = 8;

/// What stands at a feature's place: absolute metres in the system of the cloud, height NaN where the file has none.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A point.
    Point([f64; 3]),
    /// A line through corners.
    Line(Vec<[f64; 3]>),
    /// Rim and holes.
    Polygon(Vec<Vec<[f64; 3]>>),
}

/// A shape with what the file says of it. Features of several shapes give one for each.
#[derive(Clone, Debug, PartialEq)]
pub struct GeojsonFeature {
    /// Its place.
    pub shape: Shape,
    /// Its properties.
    pub properties: Map<String, Value>,
}

/// Reads the shapes of a GeoJSON file and brings them into the system `crs` of the cloud.
///
/// Coordinates are longitude and latitude of WGS 84 (RFC 7946) unless the file names a system in the older member `crs`. Then, or
/// where `crs` gives no longitude and latitude, or where a coordinate can be neither, they are taken as those of the cloud's
/// file. Heights are in the unit of the cloud's heights. Features without geometry are passed over.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for what is no GeoJSON and for coordinates that are not finite; [`Error::UnusableCrs`] where the
/// file names another system than the cloud's.
pub fn read_geojson<'a>(source: impl Into<Source<'a>>, crs: &Crs) -> Result<Vec<GeojsonFeature>> {
    let (name, bytes) = source.into().read_all()?;
    let path = name.as_path();
    let file: Value = serde_json::from_slice(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes))
        .map_err(|e| Error::malformed(path, format!("is no JSON: {e}")))?;
    let mut raw = Vec::new();
    let no_properties = Map::new();
    match file.get("type").and_then(Value::as_str) {
        Some("FeatureCollection") => {
            let features = file.get("features").and_then(Value::as_array);
            for feature in features.ok_or_else(|| Error::malformed(path, "the collection has no features"))? {
                of_feature(feature, path, &mut raw)?;
            }
        }
        Some("Feature") => of_feature(&file, path, &mut raw)?,
        Some(_) => of_geometry(&file, &no_properties, path, 0, &mut raw)?,
        None => return Err(Error::malformed(path, "is not GeoJSON: it has no member `type`")),
    }
    let placing = Placing::new(&file, &raw, path, crs)?;
    for feature in &mut raw {
        match &mut feature.shape {
            Shape::Point(p) => *p = placing.place(*p, path)?,
            Shape::Line(corners) => place_all(corners, &placing, path)?,
            Shape::Polygon(rings) => {
                for ring in rings {
                    place_all(ring, &placing, path)?;
                }
            }
        }
    }
    Ok(raw)
}

fn place_all(corners: &mut [[f64; 3]], placing: &Placing, path: &Path) -> Result<()> {
    for corner in corners {
        *corner = placing.place(*corner, path)?;
    }
    Ok(())
}

fn of_feature(feature: &Value, path: &Path, found: &mut Vec<GeojsonFeature>) -> Result<()> {
    let empty = Map::new();
    let properties = feature.get("properties").and_then(Value::as_object).unwrap_or(&empty);
    match feature.get("geometry") {
        None | Some(Value::Null) => Ok(()),
        Some(geometry) => of_geometry(geometry, properties, path, 0, found),
    }
}

fn of_geometry(
    geometry: &Value,
    properties: &Map<String, Value>,
    path: &Path,
    depth: usize,
    found: &mut Vec<GeojsonFeature>,
) -> Result<()> {
    let kind = geometry.get("type").and_then(Value::as_str).unwrap_or_default();
    let coordinates = geometry.get("coordinates").unwrap_or(&Value::Null);
    let mut push = |shape| found.push(GeojsonFeature { shape, properties: properties.clone() });
    match kind {
        "Point" => push(Shape::Point(position(coordinates, path)?)),
        "MultiPoint" => positions(coordinates, path)?.into_iter().for_each(|p| push(Shape::Point(p))),
        "LineString" => push(Shape::Line(positions(coordinates, path)?)),
        "MultiLineString" => rings(coordinates, path)?.into_iter().for_each(|line| push(Shape::Line(line))),
        "Polygon" => push(Shape::Polygon(rings(coordinates, path)?)),
        "MultiPolygon" => {
            for polygon in list(coordinates, path)? {
                push(Shape::Polygon(rings(polygon, path)?));
            }
        }
        "GeometryCollection" if depth < MOST_NESTING => {
            for member in list(geometry.get("geometries").unwrap_or(&Value::Null), path)? {
                of_geometry(member, properties, path, depth + 1, found)?;
            }
        }
        _ => return Err(Error::malformed(path, format!("\"{kind}\" is no GeoJSON geometry"))),
    }
    Ok(())
}

fn list<'a>(value: &'a Value, path: &Path) -> Result<&'a Vec<Value>> {
    value.as_array().ok_or_else(|| Error::malformed(path, "a geometry has no list of coordinates"))
}

fn rings(value: &Value, path: &Path) -> Result<Vec<Vec<[f64; 3]>>> {
    list(value, path)?.iter().map(|ring| positions(ring, path)).collect()
}

fn positions(value: &Value, path: &Path) -> Result<Vec<[f64; 3]>> {
    list(value, path)?.iter().map(|p| position(p, path)).collect()
}

fn position(value: &Value, path: &Path) -> Result<[f64; 3]> {
    let numbers: Vec<f64> = list(value, path)?.iter().filter_map(Value::as_f64).collect();
    match numbers[..] {
        [x, y] => Ok([x, y, f64::NAN]),
        [x, y, z, ..] => Ok([x, y, z]),
        _ => Err(Error::malformed(path, "a position needs two or three numbers")),
    }
}

/// How coordinates of the file become metres of the cloud's system.
struct Placing {
    projection: Option<GeographicProjection>,
    scale: [f64; 3],
}

impl Placing {
    fn new(file: &Value, features: &[GeojsonFeature], path: &Path, crs: &Crs) -> Result<Self> {
        let scale = crs.metres_per_unit_xyz();
        let named = file.pointer("/crs/properties/name").and_then(Value::as_str);
        if let Some(name) = named.filter(|name| !name.ends_with("CRS84")) {
            let code = name.rsplit(':').next().unwrap_or(name);
            let given = Crs::parse(&format!("EPSG:{code}")).map_err(|_| Error::UnusableCrs {
                path: path.to_owned(),
                what: format!(
                    "its reference system \"{name}\" is unknown; write the file in WGS 84, as RFC 7946 requires"
                ),
            })?;
            if given.kind != CrsKind::Geographic {
                if crs.kind != CrsKind::Unknown && !given.same_system(crs) {
                    let what = format!(
                        "is in {}, but the cloud is in {}; write the file in WGS 84, as RFC 7946 requires",
                        given.describe(),
                        crs.describe()
                    );
                    return Err(Error::UnusableCrs { path: path.to_owned(), what });
                }
                return Ok(Self { projection: None, scale });
            }
        }
        let all = features.iter().flat_map(|feature| match &feature.shape {
            Shape::Point(p) => vec![*p],
            Shape::Line(corners) => corners.clone(),
            Shape::Polygon(rings) => rings.concat(),
        });
        let is_degrees = all.into_iter().all(|[x, y, _]| x.abs() <= 360.0 && y.abs() <= 90.0);
        let projection = if is_degrees { crs.geographic_projection().ok() } else { None };
        Ok(Self { projection, scale })
    }

    fn place(&self, [x, y, z]: [f64; 3], path: &Path) -> Result<[f64; 3]> {
        let [x, y] = match &self.projection {
            None => [x * self.scale[0], y * self.scale[1]],
            Some(projection) => projection
                .project(y.to_radians(), x.to_radians())
                .map_err(|e| Error::malformed(path, format!("longitude {x}, latitude {y}: {e}")))?,
        };
        Ok([x, y, z * self.scale[2]])
    }
}
