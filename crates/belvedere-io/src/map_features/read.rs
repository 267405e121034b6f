//! Points, lines and polygons from GeoJSON, GeoPackage and Shapefile.

use std::path::Path;

use geojson::{GeoJson, Geometry, GeometryValue, Position};
use serde_json::{Map, Value};

use crate::files::source::{Source, refuse_other_shapes};
use crate::map_features::features::{FeatureShape, MapFeature};

use belvedere_data::crs::evidence::Comparison;
use belvedere_data::crs::{Crs, CrsKind, GeographicProjection};
use belvedere_data::{Error, Result};

/// Extensions of files of points, lines and polygons.
pub const FEATURE_EXTENSIONS: [&str; 4] = ["geojson", "json", "gpkg", "shp"];

/// Reads the shapes of a file (.geojson .json .gpkg .shp) and brings them into the system `crs` of the cloud.
///
/// A GeoPackage has one layer of features. A Shapefile has its attributes and its system in the files beside it. Both
/// are in the system of the cloud, or in longitude and latitude.
///
/// Coordinates of GeoJSON are longitude and latitude of WGS 84 (RFC 7946) unless the file names a system in the older
/// member `crs`. Longitude and latitude of another datum are converted to WGS 84; a plane must be that of the cloud.
/// In a file without that member, coordinates that cannot be longitude and latitude are taken as those of the cloud's
/// file. So are all if the cloud has no location on earth. Heights are in the unit of the cloud's heights. Features
/// without geometry are skipped.
///
/// # Errors
/// - [`Error::Io`].
/// - [`Error::Malformed`] for a file that is not of its format, a GeoPackage with several layers, and coordinates that
///   are not finite.
/// - [`Error::MissingFeature`] for a format that was not built in.
/// - [`Error::UnusableCrs`] if the file names another plane than the cloud's, a system that is not known, or degrees
///   that do not lead to the cloud.
pub fn read_features<'a>(source: impl Into<Source<'a>>, crs: &Crs) -> Result<Vec<MapFeature>> {
    let source = source.into();
    let name = source.name().to_owned();
    placed(raw_features(source)?, &name, crs)
}

/// Returns true if a file of features holds a polygon.
///
/// # Errors
/// Those of [`read_features`], but for places that lead nowhere.
pub fn holds_polygons<'a>(source: impl Into<Source<'a>>) -> Result<bool> {
    let raw = raw_features(source.into())?;
    Ok(raw.features.iter().any(|feature| matches!(feature.shape, FeatureShape::Polygon(_))))
}

/// Features as a file has them.
struct RawFeatures {
    features: Vec<MapFeature>,
    /// Their system, where the file names one.
    system: Option<Crs>,
    /// Advice where that leads nowhere.
    advice: &'static str,
}

fn raw_features(source: Source<'_>) -> Result<RawFeatures> {
    match source.extension().as_str() {
        "gpkg" => of_geopackage(source),
        "shp" => of_shapefile(&source),
        _ => of_geojson(source),
    }
}

#[cfg(feature = "gpkg")]
fn of_geopackage(source: Source<'_>) -> Result<RawFeatures> {
    let name = source.name().to_owned();
    let layer = super::geopackage::read(source)?;
    let mut features = Vec::new();
    for (number, (geometry, properties)) in layer.features.into_iter().enumerate() {
        of_geometry(geometry, (number, &properties), &name, &mut features)?;
    }
    let system = layer.system.as_deref().map(|text| system_of_text(text, &name)).transpose()?;
    Ok(RawFeatures { features, system, advice: OTHER_ADVICE })
}

#[cfg(not(feature = "gpkg"))]
fn of_geopackage(source: Source<'_>) -> Result<RawFeatures> {
    Err(Error::missing_feature(source.name(), "gpkg"))
}

#[cfg(feature = "shp")]
fn of_shapefile(source: &Source<'_>) -> Result<RawFeatures> {
    use crate::files::source::SystemBeside;
    let (features, beside) = super::shapefile::read(source)?;
    let system = match beside {
        Some(SystemBeside::Known { crs, .. }) => Some(crs),
        Some(SystemBeside::Unreadable { found_in }) => {
            let what = format!("its reference system, in {found_in}, cannot be read; {OTHER_ADVICE}");
            return Err(Error::UnusableCrs { path: source.name().to_owned(), what });
        }
        None => None,
    };
    Ok(RawFeatures { features, system, advice: OTHER_ADVICE })
}

#[cfg(not(feature = "shp"))]
fn of_shapefile(source: &Source<'_>) -> Result<RawFeatures> {
    Err(Error::missing_feature(source.name(), "shp"))
}

/// The system of a code, or of well-known text.
#[cfg(feature = "gpkg")]
fn system_of_text(text: &str, path: &Path) -> Result<Crs> {
    system_of_name(text).ok_or_else(|| Error::UnusableCrs {
        path: path.to_owned(),
        what: format!("its reference system is unknown; {OTHER_ADVICE}"),
    })
}

/// Advice for files in a system that leads nowhere.
const GEOJSON_ADVICE: &str = "write the file in WGS 84, as RFC 7946 requires";
#[cfg(any(feature = "gpkg", feature = "shp"))]
const OTHER_ADVICE: &str = "write the file in the system of the cloud, or in WGS 84";

fn of_geojson(source: Source<'_>) -> Result<RawFeatures> {
    refuse_other_shapes(source.name())?;
    let (name, bytes) = source.read_text()?;
    let path = name.as_path();
    let file: GeoJson =
        serde_json::from_slice(&bytes).map_err(|e| Error::malformed(path, format!("is not GeoJSON: {e}")))?;
    let mut raw = Vec::new();
    let members = match file {
        GeoJson::FeatureCollection(collection) => {
            for (number, feature) in collection.features.into_iter().enumerate() {
                let properties = feature.properties.unwrap_or_default();
                let of = (number, &properties);
                feature.geometry.map_or(Ok(()), |geometry| of_geometry(geometry, of, path, &mut raw))?;
            }
            collection.foreign_members
        }
        GeoJson::Feature(feature) => {
            let properties = feature.properties.unwrap_or_default();
            feature.geometry.map_or(Ok(()), |geometry| of_geometry(geometry, (0, &properties), path, &mut raw))?;
            feature.foreign_members
        }
        GeoJson::Geometry(mut geometry) => {
            let members = geometry.foreign_members.take();
            of_geometry(geometry, (0, &Map::new()), path, &mut raw)?;
            members
        }
    };
    let named = named_system(members.as_ref().and_then(|members| members.get("crs")), path)?;
    let given = named.as_deref().map(|name| {
        system_of_name(name).ok_or_else(|| Error::UnusableCrs {
            path: path.to_owned(),
            what: format!("its reference system \"{name}\" is unknown; {GEOJSON_ADVICE}"),
        })
    });
    Ok(RawFeatures { features: raw, system: given.transpose()?, advice: GEOJSON_ADVICE })
}

/// The features in the system `crs` of the cloud.
fn placed(raw: RawFeatures, path: &Path, crs: &Crs) -> Result<Vec<MapFeature>> {
    let RawFeatures { features: mut raw, system: given, advice } = raw;
    let is_known = |place: &[f64; 3]| place[0].is_finite() && place[1].is_finite();
    raw.retain(|feature| feature.shape.corners().next().is_some());
    if raw.iter().any(|feature| !feature.shape.corners().all(is_known)) {
        return Err(Error::malformed(path, "has coordinates that are not finite"));
    }
    let placing = Placing::new(given, &raw, advice, path, crs)?;
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

/// The system that the member `crs` names (GeoJSON 2008, section 3), by name or as the older drafts by code.
fn named_system(member: Option<&Value>, path: &Path) -> Result<Option<String>> {
    let Some(member) = member.filter(|member| !member.is_null()) else { return Ok(None) };
    let properties = member.get("properties");
    let name = properties.and_then(|properties| properties.get("name")).and_then(Value::as_str).map(str::to_owned);
    let code = || properties?.get("code")?.as_u64().map(|code| format!("EPSG:{code}"));
    match name.or_else(code) {
        Some(named) => Ok(Some(named)),
        None => Err(Error::UnusableCrs {
            path: path.to_owned(),
            what: format!("its reference system {member} has no name; write the file in WGS 84, as RFC 7946 requires"),
        }),
    }
}

fn place_all(corners: &mut [[f64; 3]], placing: &Placing, path: &Path) -> Result<()> {
    for corner in corners {
        *corner = placing.place(*corner, path)?;
    }
    Ok(())
}

fn of_geometry(
    geometry: Geometry,
    (number, properties): (usize, &Map<String, Value>),
    path: &Path,
    found: &mut Vec<MapFeature>,
) -> Result<()> {
    let mut push = |shape| found.push(MapFeature { shape, properties: properties.clone(), number });
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
                of_geometry(member, (number, properties), path, found)?;
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

/// The system of a name such as `urn:ogc:def:crs:EPSG::4258`, `EPSG:28992`, `urn:ogc:def:crs:OGC:1.3:CRS84` or the
/// address `http://www.opengis.net/def/crs/EPSG/0/4258`, or of well-known text. Longitude comes first whatever the authority says, as all
/// programs write it.
fn system_of_name(name: &str) -> Option<Crs> {
    let code = name.trim().rsplit([':', '/', '#']).next().unwrap_or(name);
    match code.to_ascii_uppercase().as_str() {
        "CRS84" | "CRS84H" | "84" => Some(Crs::wgs_84()),
        "CRS83" | "83" => Crs::from_epsg(4269),
        "CRS27" | "27" => Crs::from_epsg(4267),
        _ => Crs::parse(&format!("EPSG:{code}")).or_else(|_| Crs::parse(name)).ok(),
    }
}

/// Conversion of coordinates of the file to metres of the cloud's system.
struct Placing {
    projection: Option<GeographicProjection>,
    /// Conversion from longitude and latitude of another datum to those of WGS 84.
    datum: Option<GeographicProjection>,
    scale: [f64; 3],
}

impl Placing {
    fn new(given: Option<Crs>, features: &[MapFeature], advice: &str, path: &Path, crs: &Crs) -> Result<Self> {
        let scale = crs.metres_per_unit_xyz();
        let unusable = |what: String| Error::UnusableCrs { path: path.to_owned(), what };
        let all: Vec<[f64; 3]> = features.iter().flat_map(|feature| feature.shape.corners().copied()).collect();
        let no_degrees = all.iter().find(|[x, y, _]| !(x.abs() <= 360.0 && y.abs() <= 90.0));
        let Some(given) = given else {
            let projection = if no_degrees.is_none() { crs.geographic_projection().ok() } else { None };
            return Ok(Self { projection, datum: None, scale });
        };
        let own = given.describe();
        if given.kind != CrsKind::Geographic {
            let somewhere = all.first().map_or([f64::NAN; 2], |p| [p[0], p[1]]);
            let is_apart = matches!(given.compare(crs, somewhere), Comparison::Apart(_));
            if is_apart || (given.contradicts(crs) && given.compare(crs, somewhere) == Comparison::Unknown) {
                let cloud = crs.describe();
                return Err(unusable(format!("is in {own}, but the cloud is in {cloud}; {advice}")));
            }
            return Ok(Self { projection: None, datum: None, scale });
        }
        if let Some([x, y, _]) = no_degrees {
            return Err(unusable(format!(
                "names {own}, but {x}, {y} are no longitude and latitude; correct its member \"crs\""
            )));
        }
        let projection = crs.geographic_projection().map_err(|error| {
            unusable(format!("is in {own}, which cannot be brought into the system of the cloud: {error}"))
        })?;
        let datum = match given.is_wgs_84() {
            true => None,
            false => Some(given.geographic_projection().map_err(|_| {
                unusable(format!("is in {own}, whose step to WGS 84 is not known; write the file in WGS 84"))
            })?),
        };
        Ok(Self { projection: Some(projection), datum, scale })
    }

    fn place(&self, [x, y, z]: [f64; 3], path: &Path) -> Result<[f64; 3]> {
        let [x, y] = match &self.projection {
            None => [x * self.scale[0], y * self.scale[1]],
            Some(projection) => {
                let wrong = |e: Error| Error::malformed(path, format!("longitude {x}, latitude {y}: {e}"));
                let [latitude, longitude] = match &self.datum {
                    None => [y.to_radians(), x.to_radians()],
                    Some(datum) => datum.unproject([x, y]).map_err(wrong)?,
                };
                projection.project(latitude, longitude).map_err(wrong)?
            }
        };
        Ok([x, y, z * self.scale[2]])
    }
}
