//! Areas such as parcels with what was found of their cells, as tables and maps.

use crate::apps::targets::AreaMeans;
use crate::io::{FeatureShape, MapFeature, PolygonArea, TableCells, write_areas, write_table};
use crate::report::rounded;
use crate::{Frame, Result};
use serde_json::Value;
use std::path::Path;

/// Returns the polygons of a file of features, easting and northing in metres, with their properties. A shape of
/// several polygons is one area.
#[must_use]
pub fn areas_of(features: &[MapFeature]) -> Vec<PolygonArea> {
    let mut areas: Vec<(usize, PolygonArea)> = Vec::new();
    for feature in features {
        let FeatureShape::Polygon(rings) = &feature.shape else { continue };
        let rings = rings.iter().map(|ring| ring.iter().map(|&[x, y, _]| [x, y]).collect()).collect();
        match areas.last_mut() {
            Some((number, area)) if *number == feature.number => area.polygons.push(rings),
            _ => {
                let area = PolygonArea { polygons: vec![rings], properties: feature.properties.clone() };
                areas.push((feature.number, area));
            }
        }
    }
    areas.into_iter().map(|(_, area)| area).collect()
}

/// Writes areas with their properties and means as a table (.csv) or as polygons (.geojson .gpkg).
///
/// # Errors
/// Those of [`write_table`] and [`write_areas`].
pub fn write_area_means(path: &Path, areas: &[PolygonArea], means: &[AreaMeans], frame: &Frame) -> Result<()> {
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv")) {
        return write_rows(path, areas, means);
    }
    let mut areas = areas.to_vec();
    for (area, means) in areas.iter_mut().zip(means) {
        area.properties.insert("cells".to_owned(), means.cells.into());
        for result in &means.results {
            let digits = i32::try_from(result.decimals).unwrap_or(i32::MAX);
            let value = if result.value.is_nan() { Value::Null } else { rounded(result.value, digits).into() };
            area.properties.insert(result.name.clone(), value);
        }
    }
    write_areas(path, &areas, &frame.crs).map(|_| ())
}

fn write_rows(path: &Path, areas: &[PolygonArea], means: &[AreaMeans]) -> Result<()> {
    let results = means.first().map_or(&[][..], |first| &first.results);
    let is_result = |name: &str| name == "cells" || results.iter().any(|result| result.name == name);
    let mut names: Vec<&String> = Vec::new();
    for name in areas.iter().flat_map(|area| area.properties.keys()).filter(|name| !is_result(name)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let text = |area: &PolygonArea, name: &str| match area.properties.get(name) {
        None | Some(Value::Null) => String::new(),
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
    };
    let texts: Vec<Vec<String>> =
        names.iter().map(|name| areas.iter().map(|area| text(area, name)).collect()).collect();
    let words: Vec<Vec<&str>> = texts.iter().map(|column| column.iter().map(String::as_str).collect()).collect();
    let cells: Vec<Option<u64>> = means.iter().map(|means| u64::try_from(means.cells).ok()).collect();
    let numbers: Vec<Vec<f64>> =
        (0..results.len()).map(|number| means.iter().map(|means| means.results[number].value).collect()).collect();
    let mut columns: Vec<(&str, TableCells<'_>)> =
        names.iter().zip(&words).map(|(name, column)| (name.as_str(), TableCells::Words(column))).collect();
    columns.push(("cells", TableCells::Whole(&cells)));
    let of_result = results.iter().zip(&numbers);
    columns.extend(of_result.map(|(result, values)| (&result.name[..], TableCells::Real(values, result.decimals))));
    write_table(path, &columns)
}
