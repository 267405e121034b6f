//! Areas such as parcels with what was found of their cells, as tables and maps.

use crate::apps::result_columns::ResultColumn;
use crate::apps::targets::AreaMeans;
use crate::io::{FeatureShape, MapFeature, PolygonArea, write_areas, write_table};
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
    let words = |name: &&String| ResultColumn::words(*name, areas.iter().map(|area| text(area, name)));
    let mut columns: Vec<ResultColumn> = names.iter().map(words).collect();
    columns.push(ResultColumn::whole("cells", means.iter().map(|means| means.cells)));
    columns.extend(results.iter().enumerate().map(|(number, result)| {
        ResultColumn::real(&result.name, means.iter().map(|means| means.results[number].value), result.decimals)
    }));
    write_table(path, &columns)
}
