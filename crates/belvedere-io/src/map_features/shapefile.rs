//! Shapefile: points, lines and polygons, with the attributes of the table beside them.

use crate::files::source::{Source, SystemBeside};
use crate::map_features::features::{FeatureShape, MapFeature};
use belvedere_data::{Error, Result};
use serde_json::{Map, Value};
use shapefile::dbase::{CodePageMark, FieldValue, ReaderBuilder, Record};
use shapefile::record::polygon::{GenericPolygon, PolygonRing};
use shapefile::{NO_DATA, Shape, ShapeReader};
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

/// Bytes of the header of a table, and which of them names its code page.
const HEADER_LENGTH: usize = 32;
const MARK_IN_HEADER: usize = 29;

/// Reads the shapes of a file, of any coordinates, and the well-known text of their system from the file `.prj`.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for a file that is no Shapefile, for surfaces in space, and without a file
/// on this machine: its table and system lie beside it.
pub(crate) fn read(source: &Source<'_>) -> Result<(Vec<MapFeature>, Option<SystemBeside>)> {
    let path = source.name();
    let wrong = |error: shapefile::Error| Error::malformed(path, format!("is no Shapefile: {error}"));
    if !source.is_on_disk() {
        let what = "a Shapefile is read from a folder on this machine, since its table lies beside it";
        return Err(Error::malformed(path, what));
    }
    let mut reader = ShapeReader::from_path(path).map_err(|error| match error {
        shapefile::Error::IoError(error) => Error::io(path)(error),
        other => wrong(other),
    })?;
    let shapes = reader.iter_shapes().collect::<std::result::Result<Vec<Shape>, _>>().map_err(wrong)?;
    let records = records_beside(path)?;
    // a deleted row is in the table no more, and its shape still there: all that follow would be another's
    if let Some(records) = &records
        && records.len() != shapes.len()
    {
        let what = format!(
            "its table has {} rows for {} shapes; write it again, such as by ogr2ogr one.gpkg {}",
            records.len(),
            shapes.len(),
            path.display()
        );
        return Err(Error::malformed(path, what));
    }
    let mut records = records.unwrap_or_default().into_iter();
    let mut features = Vec::new();
    for (number, shape) in shapes.into_iter().enumerate() {
        let properties = records.next().unwrap_or_default();
        for shape in shapes_of(shape, path)? {
            features.push(MapFeature { shape, properties: properties.clone(), number });
        }
    }
    Ok((features, source.system_beside()))
}

/// Rows of the table beside a file, if there is one.
fn records_beside(path: &Path) -> Result<Option<Vec<Map<String, Value>>>> {
    let beside = ["dbf", "DBF"].map(|extension| path.with_extension(extension));
    let Some(table) = beside.iter().find(|table| table.is_file()) else { return Ok(None) };
    let wrong = |error: shapefile::dbase::Error| Error::malformed(table, format!("is no table of dBASE: {error}"));
    let mut opened = ReaderBuilder::new();
    if let Some(encoding) = code_page(table)?.and_then(CodePageMark::to_encoding) {
        opened = opened.with_encoding(encoding);
    }
    let mut reader = opened.open(table).map_err(wrong)?;
    let rows = reader.iter_records().map(|record| Ok(properties_of(record.map_err(wrong)?)));
    rows.collect::<Result<Vec<_>>>().map(Some)
}

/// Returns the code page of the text of a table: by the file `.cpg`, or Western European where its header has none, as
/// GDAL does; `None` for that of the header.
fn code_page(table: &Path) -> Result<Option<CodePageMark>> {
    let beside = ["cpg", "CPG"].map(|extension| table.with_extension(extension));
    let Some(beside) = beside.iter().find(|file| file.is_file()) else {
        let mut header = [0; HEADER_LENGTH];
        let read = File::open(table).and_then(|mut file| file.read_exact(&mut header));
        return Ok((read.is_ok() && header[MARK_IN_HEADER] == 0).then_some(CodePageMark::CP1252));
    };
    let text = fs::read_to_string(beside).map_err(Error::io(beside))?;
    let name = text.trim().to_ascii_uppercase();
    let digits: String = name.chars().filter(char::is_ascii_digit).collect();
    Ok(Some(match digits.as_str() {
        _ if name.starts_with("UTF") => CodePageMark::Utf8,
        "65001" => CodePageMark::Utf8,
        _ if name.starts_with("LATIN1") => CodePageMark::CP1252,
        "1252" | "88591" => CodePageMark::CP1252,
        "1250" => CodePageMark::CP1250,
        "1251" => CodePageMark::CP1251,
        "1253" => CodePageMark::CP1253,
        "1254" => CodePageMark::CP1254,
        "1255" => CodePageMark::CP1255,
        "1256" => CodePageMark::CP1256,
        "437" => CodePageMark::CP437,
        "850" => CodePageMark::CP850,
        "852" => CodePageMark::CP852,
        "866" => CodePageMark::CP866,
        _ => {
            let what = format!("names an encoding that is not known, {}; save the table as UTF-8", text.trim());
            return Err(Error::malformed(beside, what));
        }
    }))
}

fn properties_of(record: Record) -> Map<String, Value> {
    let value = |value: FieldValue| -> Option<Value> {
        Some(match value {
            FieldValue::Character(text) => text?.trim().to_owned().into(),
            FieldValue::Memo(text) => text.into(),
            FieldValue::Numeric(number) => number?.into(),
            FieldValue::Float(number) => f64::from(number?).into(),
            FieldValue::Double(number) | FieldValue::Currency(number) => number.into(),
            FieldValue::Integer(number) => number.into(),
            FieldValue::Logical(is) => is?.into(),
            FieldValue::Date(date) => {
                let date = date?;
                format!("{:04}-{:02}-{:02}", date.year(), date.month(), date.day()).into()
            }
            _ => return None,
        })
    };
    record.into_iter().filter_map(|(name, field)| Some((name, value(field)?))).collect()
}

fn shapes_of(shape: Shape, path: &Path) -> Result<Vec<FeatureShape>> {
    let flat = |x: f64, y: f64| [x, y, f64::NAN];
    // no height is a number below all
    let high = |x: f64, y: f64, z: f64| [x, y, if z > NO_DATA { z } else { f64::NAN }];
    let points = |points: Vec<[f64; 3]>| points.into_iter().map(FeatureShape::Point).collect();
    Ok(match shape {
        Shape::NullShape => Vec::new(),
        Shape::Point(p) => points(vec![flat(p.x, p.y)]),
        Shape::PointM(p) => points(vec![flat(p.x, p.y)]),
        Shape::PointZ(p) => points(vec![high(p.x, p.y, p.z)]),
        Shape::Multipoint(all) => points(all.points().iter().map(|p| flat(p.x, p.y)).collect()),
        Shape::MultipointM(all) => points(all.points().iter().map(|p| flat(p.x, p.y)).collect()),
        Shape::MultipointZ(all) => points(all.points().iter().map(|p| high(p.x, p.y, p.z)).collect()),
        Shape::Polyline(lines) => of_lines(lines.parts(), |p| flat(p.x, p.y)),
        Shape::PolylineM(lines) => of_lines(lines.parts(), |p| flat(p.x, p.y)),
        Shape::PolylineZ(lines) => of_lines(lines.parts(), |p| high(p.x, p.y, p.z)),
        Shape::Polygon(polygon) => of_polygon(&polygon, |p| flat(p.x, p.y)),
        Shape::PolygonM(polygon) => of_polygon(&polygon, |p| flat(p.x, p.y)),
        Shape::PolygonZ(polygon) => of_polygon(&polygon, |p| high(p.x, p.y, p.z)),
        Shape::Multipatch(_) => {
            return Err(Error::malformed(path, "has surfaces in space; write it as points, lines or polygons"));
        }
    })
}

fn of_lines<P>(lines: &[Vec<P>], place: impl Fn(&P) -> [f64; 3]) -> Vec<FeatureShape> {
    lines.iter().map(|line| FeatureShape::Line(line.iter().map(&place).collect())).collect()
}

/// Polygons of outer rings, each with the inner rings that follow it.
fn of_polygon<P>(polygon: &GenericPolygon<P>, place: impl Fn(&P) -> [f64; 3]) -> Vec<FeatureShape> {
    let mut found: Vec<Vec<Vec<[f64; 3]>>> = Vec::new();
    for ring in polygon.rings() {
        let (points, is_inner) = match ring {
            PolygonRing::Outer(points) => (points, false),
            PolygonRing::Inner(points) => (points, true),
        };
        let corners: Vec<[f64; 3]> = points.iter().map(&place).collect();
        match found.last_mut().filter(|_| is_inner) {
            Some(last) => last.push(corners),
            None => found.push(vec![corners]),
        }
    }
    found.into_iter().map(FeatureShape::Polygon).collect()
}
