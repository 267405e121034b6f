//! Outlines of buildings from GeoJSON and CityJSON.

use crate::files::source::Source;
use crate::map_features::{FeatureShape, read_features};
use crate::mesh::cityjson::{LevelOfDetail, read_cityjson};
use belvedere_data::polygon::Footprint;
use belvedere_data::{Error, Frame, Mesh, Result};
use std::collections::HashMap;
use std::path::Path;

/// Members of GeoJSON that name a building, the first of them that a feature has.
const NAMES: [&str; 4] = ["name", "identificatie", "identifier", "id"];

/// Type of a city model, which GeoJSON has nowhere.
const CITY_TYPE: &[u8] = b"\"CityJSON\"";

/// Reads the outlines of buildings, local metres of `frame`. Polygons of GeoJSON are brought into the system of the
/// frame as [`read_features`] does; polygons with the same name are one building. Objects of CityJSON cover what their
/// surfaces cover on the map. A building without a name is named after its number.
///
/// # Errors
/// Those of [`read_features`], [`read_cityjson`] and of a city model in another reference system;
/// [`Error::Malformed`] for a file without polygons.
pub fn read_footprints<'a>(source: impl Into<Source<'a>>, frame: &Frame) -> Result<Vec<Footprint>> {
    let source = source.into();
    if matches!(source.extension().as_str(), "gpkg" | "shp") {
        let path = source.name().to_owned();
        return some_of(of_features(source, frame)?, &path);
    }
    let (path, text) = source.read_text()?;
    // both are called .json
    let is_city = text.windows(CITY_TYPE.len()).any(|word| word == CITY_TYPE);
    let source = Source::bytes(&path, &text);
    let found = if is_city { of_city(source, frame)? } else { of_features(source, frame)? };
    some_of(found, &path)
}

/// Refuses a file without polygons.
fn some_of(found: Vec<Footprint>, path: &Path) -> Result<Vec<Footprint>> {
    match found.is_empty() {
        true => Err(Error::malformed(path, "there is no polygon; outlines of buildings are polygons")),
        false => Ok(found),
    }
}

fn of_features(source: Source<'_>, frame: &Frame) -> Result<Vec<Footprint>> {
    let from_origin = |corner: &[f64; 3]| [0, 1].map(|axis| corner[axis] - frame.origin[axis]);
    let mut found: Vec<Footprint> = Vec::new();
    let mut numbers: HashMap<String, usize> = HashMap::new();
    for feature in read_features(source, &frame.crs)? {
        let FeatureShape::Polygon(rings) = &feature.shape else { continue };
        let own = NAMES.iter().find_map(|name| feature.properties.get(*name)).filter(|value| !value.is_null());
        let name = own.map(|value| value.as_str().map_or_else(|| value.to_string(), str::to_owned));
        let rings = rings.iter().map(|ring| ring.iter().map(from_origin).collect()).collect();
        let Some(name) = name else {
            found.push(Footprint { name: (found.len() + 1).to_string(), polygons: vec![rings] });
            continue;
        };
        match numbers.get(&name) {
            Some(&same) => found[same].polygons.push(rings),
            None => {
                numbers.insert(name.clone(), found.len());
                found.push(Footprint { name, polygons: vec![rings] });
            }
        }
    }
    Ok(found)
}

fn of_city(source: Source<'_>, frame: &Frame) -> Result<Vec<Footprint>> {
    let path = source.name().to_owned();
    let (mesh, _) = read_cityjson(source, &LevelOfDetail::Highest)?;
    mesh.crs.check_for(&frame.crs, "footprints", &path)?;
    let Mesh { vertices, triangles, objects, object_names, .. } = mesh.scaled_to_metres(&frame.crs);
    let mut found: Vec<Footprint> =
        object_names.into_iter().map(|name| Footprint { name, polygons: Vec::new() }).collect();
    let on_map = |vertex: &u32| {
        let corner = vertices.get(*vertex as usize).copied().unwrap_or_default();
        [0, 1].map(|axis| corner[axis] - frame.origin[axis])
    };
    for (triangle, &object) in triangles.iter().zip(&objects) {
        let ring: Vec<[f64; 2]> = triangle.iter().map(on_map).collect();
        if let (Some(footprint), true) = (found.get_mut(object as usize), has_area(&ring)) {
            footprint.polygons.push(vec![ring]);
        }
    }
    found.retain(|footprint| !footprint.polygons.is_empty());
    Ok(found)
}

/// Returns true for a triangle that covers something: those of walls are lines on the map.
fn has_area(ring: &[[f64; 2]]) -> bool {
    let [a, b, c] = ring else { return false };
    ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs() > 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Frame {
        Frame { origin: [100.0, 200.0, 0.0], ..Frame::default() }
    }

    #[test]
    fn polygons_of_one_name_are_one_building() {
        let square = |x: f64| format!("[[[{x},200],[{},200],[{},204],[{x},204],[{x},200]]]", x + 4.0, x + 4.0);
        let feature = |properties: &str, x: f64| {
            let polygon = square(x);
            format!(
                r#"{{"type":"Feature","properties":{properties},"geometry":{{"type":"Polygon","coordinates":{polygon}}}}}"#
            )
        };
        let features = [
            feature(r#"{"name":"school"}"#, 100.0),
            feature("{}", 110.0),
            feature(r#"{"name":"school"}"#, 120.0),
            feature(r#"{"id":7}"#, 130.0),
        ]
        .join(",");
        let text = format!(r#"{{"type":"FeatureCollection","features":[{features}]}}"#);
        let path = Path::new("houses.geojson");
        let found = read_footprints(Source::bytes(path, text.as_bytes()), &frame()).unwrap();
        assert_eq!(found.iter().map(|one| &one.name[..]).collect::<Vec<_>>(), ["school", "2", "7"]);
        assert_eq!(found[0].bounds(), [[0.0, 0.0], [24.0, 4.0]]);
    }

    #[test]
    fn an_object_of_a_city_covers_what_its_surfaces_cover() {
        let text = r#"{"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[100,200,0]},
            "CityObjects":{"hall":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"1",
            "boundaries":[[[0,1,2,3]],[[0,1,5,4]]]}]}},
            "vertices":[[0,0,0],[6,0,0],[6,5,0],[0,5,0],[0,0,3],[6,0,3]]}"#;
        let path = Path::new("town.json");
        let found = read_footprints(Source::bytes(path, text.as_bytes()), &frame()).unwrap();
        assert_eq!((found.len(), &found[0].name[..], found[0].polygons.len()), (1, "hall", 2));
        assert_eq!(found[0].bounds(), [[0.0, 0.0], [6.0, 5.0]]);
    }
}
