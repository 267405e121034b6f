//! Areas, places and lines as GeoJSON and GeoPackage.

use std::path::Path;

use geojson::{Feature, FeatureCollection, Geometry, Position};
use serde_json::{Map, Value};

use crate::files::output::Output;
use crate::map_features::antimeridian;
use belvedere_data::crs::{Crs, GeographicProjection};
use belvedere_data::report::rounded;
use belvedere_data::{Error, Result};

/// Decimals of a degree: a centimetre.
const DEGREE_DECIMALS: i32 = 7;
/// Decimals of file coordinates: a millimetre.
const METRE_DECIMALS: i32 = 3;

/// Polygons with properties in common.
#[derive(Clone, Debug, Default)]
pub struct PolygonArea {
    /// For each polygon its outer ring, counter-clockwise, and its holes, clockwise, each closed; easting and northing
    /// in metres.
    pub polygons: Vec<Vec<Vec<[f64; 2]>>>,
    /// Properties of the feature.
    pub properties: Map<String, Value>,
}

/// A point with properties.
#[derive(Clone, Debug, Default)]
pub struct Spot {
    /// Easting, northing and height, metres.
    pub place: [f64; 3],
    /// Properties of the feature.
    pub properties: Map<String, Value>,
}

/// A line with properties.
#[derive(Clone, Debug, Default)]
pub struct PathLine {
    /// Easting, northing and height of each corner, metres.
    pub places: Vec<[f64; 3]>,
    /// Properties of the feature.
    pub properties: Map<String, Value>,
}

/// Coordinates of a GeoJSON file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureCoordinates {
    /// Longitude and latitude of WGS 84, as RFC 7946 wants.
    Wgs84,
    /// Coordinates of the cloud's file: its system gives no longitude and latitude.
    OfTheFile,
}

/// Writes each of `areas` as a feature with a multipolygon (.geojson .gpkg), and returns the kind of its coordinates.
///
/// A GeoPackage has those of the cloud's file, and its system. In GeoJSON they are longitude and latitude if `crs`, the
/// system of the areas, gives these. Otherwise they are easting and northing in the unit of `crs`, with a member
/// `crs_note`. Polygons that cross 180 degrees are cut there.
///
/// # Errors
/// [`Error::Io`], and [`Error::UnusableCrs`] for places that have no longitude and latitude.
///
/// # Source
/// RFC 7946, sections 3.1.7, 3.1.9, 3.3 and 4.
pub fn write_areas<'a>(output: impl Into<Output<'a>>, areas: &[PolygonArea], crs: &Crs) -> Result<FeatureCoordinates> {
    let output = output.into();
    let projection = projection_for(&output, crs);
    let mut features = Vec::with_capacity(areas.len());
    for area in areas {
        let mut polygons = Vec::with_capacity(area.polygons.len());
        for polygon in &area.polygons {
            let ring = |ring: &Vec<[f64; 2]>| written_ring(ring, projection.as_ref(), crs, output.name());
            let rings = polygon.iter().map(ring).collect::<Result<Vec<_>>>()?;
            let parts = if projection.is_some() { antimeridian::cut(rings) } else { vec![rings] };
            let positions = |ring: Vec<[f64; 2]>| ring.into_iter().map(Position::from).collect::<Vec<_>>();
            polygons.extend(parts.into_iter().map(|part| part.into_iter().map(positions).collect::<Vec<_>>()));
        }
        features.push(feature(Geometry::new_multi_polygon(polygons), &area.properties));
    }
    write_features(output, features, projection.is_some(), crs)
}

/// Writes each of `spots` as a point and each of `lines` as a line, with heights in the unit of the heights of `crs`,
/// and otherwise as [`write_areas`] does.
///
/// # Errors
/// Those of [`write_areas`].
pub fn write_places<'a>(
    output: impl Into<Output<'a>>,
    spots: &[Spot],
    lines: &[PathLine],
    crs: &Crs,
) -> Result<FeatureCoordinates> {
    let output = output.into();
    let projection = projection_for(&output, crs);
    let position = |&[x, y, z]: &[f64; 3]| -> Result<Position> {
        let on_map = written_ring(&[[x, y]], projection.as_ref(), crs, output.name())?;
        let height = rounded(z / crs.metres_per_unit_xyz()[2], METRE_DECIMALS);
        Ok(Position::from(on_map.into_iter().flatten().chain([height]).collect::<Vec<_>>()))
    };
    let mut features = Vec::with_capacity(spots.len() + lines.len());
    for spot in spots {
        features.push(feature(Geometry::new_point(position(&spot.place)?), &spot.properties));
    }
    for line in lines {
        let positions = line.places.iter().map(position).collect::<Result<Vec<_>>>()?;
        features.push(feature(Geometry::new_line_string(positions), &line.properties));
    }
    write_features(output, features, projection.is_some(), crs)
}

/// The projection to longitude and latitude; `None` where coordinates stay those of the file.
fn projection_for(output: &Output<'_>, crs: &Crs) -> Option<GeographicProjection> {
    if output.extension() == "gpkg" { None } else { crs.geographic_projection().ok() }
}

fn feature(geometry: Geometry, properties: &Map<String, Value>) -> Feature {
    Feature { geometry: Some(geometry), properties: Some(properties.clone()), ..Feature::default() }
}

fn write_features(output: Output<'_>, features: Vec<Feature>, is_wgs84: bool, crs: &Crs) -> Result<FeatureCoordinates> {
    if output.extension() == "gpkg" {
        write_geopackage(output, &features, crs)?;
        return Ok(FeatureCoordinates::OfTheFile);
    }
    let mut collection = FeatureCollection { features, ..FeatureCollection::default() };
    let coordinates = if is_wgs84 { FeatureCoordinates::Wgs84 } else { FeatureCoordinates::OfTheFile };
    if coordinates == FeatureCoordinates::OfTheFile {
        let note = format!("coordinates are not WGS 84 but those of the cloud: {}", crs.describe());
        collection.foreign_members = Some(Map::from_iter([("crs_note".to_owned(), note.into())]));
    }
    output.write(|path, output| {
        serde_json::to_writer(&mut *output, &collection).map_err(|e| Error::io(path)(e.into()))?;
        writeln!(output).map_err(Error::io(path))
    })?;
    Ok(coordinates)
}

#[cfg(feature = "gpkg")]
fn write_geopackage(output: Output<'_>, features: &[Feature], crs: &Crs) -> Result<()> {
    let bytes = super::geopackage::written(output.name(), features, crs)?;
    output.write(|path, output| output.write_all(&bytes).map_err(Error::io(path)))
}

#[cfg(not(feature = "gpkg"))]
fn write_geopackage(output: Output<'_>, _: &[Feature], _: &Crs) -> Result<()> {
    Err(Error::missing_feature(output.name(), "gpkg"))
}

fn written_ring(
    ring: &[[f64; 2]],
    projection: Option<&GeographicProjection>,
    crs: &Crs,
    path: &Path,
) -> Result<Vec<[f64; 2]>> {
    let written = |&place: &[f64; 2]| {
        let (values, decimals) = match projection {
            Some(projection) => {
                let [latitude, longitude] = projection.unproject(place).map_err(|e| Error::UnusableCrs {
                    path: path.to_owned(),
                    what: format!("{e}; give the right system with --crs"),
                })?;
                // projections count on beyond 180 degrees
                let longitude = longitude.to_degrees();
                let longitude =
                    if longitude.abs() > 180.0 { (longitude + 180.0).rem_euclid(360.0) - 180.0 } else { longitude };
                ([longitude, latitude.to_degrees()], DEGREE_DECIMALS)
            }
            None => (place.map(|v| v / crs.metres_per_unit), METRE_DECIMALS),
        };
        Ok(values.map(|v| rounded(v, decimals)))
    };
    ring.iter().map(written).collect()
}
