//! Measures of cells, summed up over areas such as parcels.

use crate::apps::targets::{Measure, Targets};
use crate::io::{FeatureShape, MapFeature, PolygonArea, TableCells, write_areas, write_table};
use crate::polygon::PolygonIndex;
use crate::{Error, Frame, Result};
use serde_json::{Map, Value};
use std::ops::Range;
use std::path::Path;

/// Digits of means beyond those of the values.
const FURTHER_DECIMALS: usize = 2;

/// An area of a map, with what was found of its cells.
#[derive(Clone, Debug, Default)]
pub struct AreaValues {
    /// Its polygons, as in the file: rings of easting and northing, metres.
    polygons: Vec<Vec<Vec<[f64; 2]>>>,
    properties: Map<String, Value>,
    /// Name, digits and value of each result; NaN without cells.
    results: Vec<(String, usize, f64)>,
    /// Cells of which the first measure has a value.
    pub cells: usize,
}

/// Returns the mean of each of `measures` over the cells whose middle lies in an area, and the least and greatest value
/// of the first. A shape of several polygons is one area. Cells without a value do not count.
///
/// # Errors
/// [`Error::UnsupportedTargets`] for targets that are no cells.
pub fn values_by_area(features: &[MapFeature], targets: &Targets, measures: &[Measure]) -> Result<Vec<AreaValues>> {
    let Some(ground) = targets.ground() else {
        return Err(Error::UnsupportedTargets { method: "areas", what: "they sum up the cells of a grid" });
    };
    let mut areas: Vec<(usize, AreaValues)> = Vec::new();
    for feature in features {
        let FeatureShape::Polygon(rings) = &feature.shape else { continue };
        let rings = rings.iter().map(|ring| ring.iter().map(|&[x, y, _]| [x, y]).collect()).collect();
        match areas.last_mut() {
            Some((number, area)) if *number == feature.number => area.polygons.push(rings),
            _ => {
                let properties = feature.properties.clone();
                let area = AreaValues { polygons: vec![rings], properties, ..AreaValues::default() };
                areas.push((feature.number, area));
            }
        }
    }
    let (grid, origin) = (ground.grid, targets.frame.origin);
    let mut found = Vec::with_capacity(areas.len());
    for (_, mut area) in areas {
        let local = |ring: &Vec<[f64; 2]>| ring.iter().map(|[x, y]| [x - origin[0], y - origin[1]]).collect();
        let polygons: Vec<Vec<Vec<[f64; 2]>>> =
            area.polygons.iter().map(|rings| rings.iter().map(local).collect()).collect();
        let index = PolygonIndex::of_polygons(polygons.iter().map(Vec::as_slice));
        let corners = || polygons.iter().flatten().flatten();
        let end = |axis: usize, pick: fn(f64, f64) -> f64| corners().map(|corner| corner[axis]).reduce(pick);
        let (Some(west), Some(east), Some(south), Some(north)) =
            (end(0, f64::min), end(0, f64::max), end(1, f64::min), end(1, f64::max))
        else {
            continue;
        };
        let columns = span([west - grid.corner[0], east - grid.corner[0]].map(|x| x / grid.cell), grid.width);
        let rows = span([grid.corner[1] - north, grid.corner[1] - south].map(|y| y / grid.cell), grid.height);
        let inside: Vec<usize> = rows
            .flat_map(|row| columns.clone().map(move |column| [column, row]))
            .filter(|&[column, row]| index.holds(grid.center(column, row)))
            .map(|[column, row]| row * grid.width + column)
            .filter(|&cell| targets.is_target(cell))
            .collect();
        for (number, measure) in measures.iter().enumerate() {
            let values = inside.iter().map(|&cell| f64::from(measure.values[cell])).filter(|value| !value.is_nan());
            let (mut count, mut sum, mut low, mut high) = (0_usize, 0.0, f64::INFINITY, f64::NEG_INFINITY);
            for value in values {
                (count, sum) = (count + 1, sum + value);
                (low, high) = (value.min(low), value.max(high));
            }
            let known = |value: f64| if count > 0 { value } else { f64::NAN };
            let decimals = measure.decimals;
            area.results.push((measure.name.clone(), decimals + FURTHER_DECIMALS, known(sum / count as f64)));
            if number == 0 {
                area.cells = count;
                area.results.push((format!("{}_min", measure.name), decimals, known(low)));
                area.results.push((format!("{}_max", measure.name), decimals, known(high)));
            }
        }
        found.push(area);
    }
    Ok(found)
}

/// Returns the columns or rows from `low` to `high`, of `count`.
fn span([low, high]: [f64; 2], count: usize) -> Range<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturated casts within a grid")]
    let [low, high] = [low.floor().max(0.0) as usize, high.ceil().max(0.0) as usize].map(|end| end.min(count));
    low..high
}

/// Writes areas with their properties and results as a table (.csv) or as polygons (.geojson .gpkg).
///
/// # Errors
/// Those of [`write_table`] and [`write_areas`].
pub fn write_area_values(path: &Path, areas: &[AreaValues], frame: &Frame) -> Result<()> {
    let Some(first) = areas.first() else { return write_table(path, &[]) };
    let is_table = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    if !is_table {
        let written = |area: &AreaValues| {
            let mut properties = area.properties.clone();
            properties.insert("cells".to_owned(), area.cells.into());
            for (name, decimals, value) in &area.results {
                let digits = i32::try_from(*decimals).unwrap_or(i32::MAX);
                let value = if value.is_nan() { Value::Null } else { crate::report::rounded(*value, digits).into() };
                properties.insert(name.clone(), value);
            }
            PolygonArea { polygons: area.polygons.clone(), properties }
        };
        let areas: Vec<PolygonArea> = areas.iter().map(written).collect();
        return write_areas(path, &areas, &frame.crs).map(|_| ());
    }
    let is_result = |name: &str| name == "cells" || first.results.iter().any(|(own, ..)| own == name);
    let mut names: Vec<&String> = Vec::new();
    for name in areas.iter().flat_map(|area| area.properties.keys()).filter(|name| !is_result(name)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let text = |area: &AreaValues, name: &str| match area.properties.get(name) {
        None | Some(Value::Null) => String::new(),
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
    };
    let words: Vec<Vec<String>> =
        names.iter().map(|name| areas.iter().map(|area| text(area, name)).collect()).collect();
    let words: Vec<Vec<&str>> = words.iter().map(|column| column.iter().map(String::as_str).collect()).collect();
    let numbers: Vec<Vec<f64>> =
        (0..first.results.len()).map(|number| areas.iter().map(|area| area.results[number].2).collect()).collect();
    let cells: Vec<Option<u64>> = areas.iter().map(|area| u64::try_from(area.cells).ok()).collect();
    let mut columns: Vec<(&str, TableCells<'_>)> =
        names.iter().zip(&words).map(|(name, column)| (name.as_str(), TableCells::Words(column))).collect();
    columns.push(("cells", TableCells::Whole(&cells)));
    let results = first.results.iter().zip(&numbers);
    columns.extend(results.map(|((name, decimals, _), values)| (name.as_str(), TableCells::Real(values, *decimals))));
    write_table(path, &columns)
}
