//! Points, lines and polygons from GeoJSON.

use std::path::Path;

use geojson::{GeoJson, Geometry, GeometryValue, Position};
use serde_json::{Map, Value};

use super::source::{Source, refuse_other_shapes};

use belvedere_data::crs::{Crs, CrsKind, GeographicProjection};
use belvedere_data::{Error, Result};

/// What stands at a feature's place: absolute metres in the system of the cloud, height NaN where the file has none.
#[derive(Clone, Debug, PartialEq)]
pub enum FeatureShape {
    /// A point.
    Point([f64; 3]),
    /// A line through corners.
    Line(Vec<[f64; 3]>),
    /// Outer ring and holes.
    Polygon(Vec<Vec<[f64; 3]>>),
}

/// A shape with what the file says of it. Features of several shapes give one for each.
#[derive(Clone, Debug, PartialEq)]
pub struct GeojsonFeature {
    /// Its place.
    pub shape: FeatureShape,
    /// Its properties.
    pub properties: Map<String, Value>,
}

/// Reads the shapes of a GeoJSON file and brings them into the system `crs` of the cloud.
///
/// Coordinates are longitude and latitude of WGS 84 (RFC 7946) unless the file names a system in the older member
/// `crs`. Then, or where `crs` gives no longitude and latitude, or where a coordinate can be neither, they are taken as
/// those of the cloud's file. Heights are in the unit of the cloud's heights. Features without geometry are passed
/// over.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for what is no GeoJSON and for coordinates that are not finite;
/// [`Error::UnusableCrs`] where the file names another system than the cloud's.
pub fn read_geojson<'a>(source: impl Into<Source<'a>>, crs: &Crs) -> Result<Vec<GeojsonFeature>> {
    let source = source.into();
    refuse_other_shapes(source.name())?;
    let (name, bytes) = source.read_text()?;
    let path = name.as_path();
    let file: GeoJson =
        serde_json::from_slice(&bytes).map_err(|e| Error::malformed(path, format!("is not GeoJSON: {e}")))?;
    let mut raw = Vec::new();
    let members = match file {
        GeoJson::FeatureCollection(collection) => {
            for feature in collection.features {
                let properties = feature.properties.unwrap_or_default();
                feature.geometry.map_or(Ok(()), |geometry| of_geometry(geometry, &properties, path, &mut raw))?;
            }
            collection.foreign_members
        }
        GeoJson::Feature(feature) => {
            let properties = feature.properties.unwrap_or_default();
            feature.geometry.map_or(Ok(()), |geometry| of_geometry(geometry, &properties, path, &mut raw))?;
            feature.foreign_members
        }
        GeoJson::Geometry(mut geometry) => {
            let members = geometry.foreign_members.take();
            of_geometry(geometry, &Map::new(), path, &mut raw)?;
            members
        }
    };
    let named = members.as_ref().and_then(|members| members.get("crs")?.pointer("/properties/name")?.as_str());
    let placing = Placing::new(named, &raw, path, crs)?;
    for feature in &mut raw {
        match &mut feature.shape {
            FeatureShape::Point(p) => *p = placing.place(*p, path)?,
            FeatureShape::Line(corners) => place_all(corners, &placing, path)?,
            FeatureShape::Polygon(rings) => {
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

fn of_geometry(
    geometry: Geometry,
    properties: &Map<String, Value>,
    path: &Path,
    found: &mut Vec<GeojsonFeature>,
) -> Result<()> {
    let mut push = |shape| found.push(GeojsonFeature { shape, properties: properties.clone() });
    match geometry.value {
        GeometryValue::Point { coordinates } => push(FeatureShape::Point(position(&coordinates, path)?)),
        GeometryValue::MultiPoint { coordinates } => {
            positions(&coordinates, path)?.into_iter().for_each(|p| push(FeatureShape::Point(p)));
        }
        GeometryValue::LineString { coordinates } => push(FeatureShape::Line(positions(&coordinates, path)?)),
        GeometryValue::MultiLineString { coordinates } => {
            rings(&coordinates, path)?.into_iter().for_each(|line| push(FeatureShape::Line(line)));
        }
        GeometryValue::Polygon { coordinates } => push(FeatureShape::Polygon(rings(&coordinates, path)?)),
        GeometryValue::MultiPolygon { coordinates } => {
            for polygon in coordinates {
                push(FeatureShape::Polygon(rings(&polygon, path)?));
            }
        }
        GeometryValue::GeometryCollection { geometries } => {
            for member in geometries {
                of_geometry(member, properties, path, found)?;
            }
        }
    }
    Ok(())
}

fn rings(rings: &[Vec<Position>], path: &Path) -> Result<Vec<Vec<[f64; 3]>>> {
    rings.iter().map(|ring| positions(ring, path)).collect()
}

fn positions(list: &[Position], path: &Path) -> Result<Vec<[f64; 3]>> {
    list.iter().map(|p| position(p, path)).collect()
}

fn position(numbers: &Position, path: &Path) -> Result<[f64; 3]> {
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
    fn new(named: Option<&str>, features: &[GeojsonFeature], path: &Path, crs: &Crs) -> Result<Self> {
        let scale = crs.metres_per_unit_xyz();
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
            FeatureShape::Point(p) => vec![*p],
            FeatureShape::Line(corners) => corners.clone(),
            FeatureShape::Polygon(rings) => rings.concat(),
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
