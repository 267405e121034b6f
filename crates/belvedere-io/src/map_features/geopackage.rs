//! GeoPackage: points, lines and polygons with their attributes, in a file of SQLite.
//!
//! # Source
//! OGC 12-128r19, GeoPackage 1.4.

use super::wkb;
use crate::files::source::Source;
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::{Error, Result};
use geojson::{Feature, Geometry, GeometryValue};
use rusqlite::types::{Value as Cell, ValueRef};
use rusqlite::{Connection, MAIN_DB, OptionalExtension, Row, params, params_from_iter};
use serde_json::{Map, Value};
use std::path::Path;

/// Version of the format that is written, 1.4.
const USER_VERSION: i32 = 10_400;
/// Application that files of SQLite name: "GPKG".
const APPLICATION_ID: i32 = 0x4750_4b47;
/// First bytes of a file of SQLite.
const HEAD: &[u8] = b"SQLite format 3\0";
/// Place in the head of a file of SQLite of the two bytes that say whether changes may lie in a second file.
const JOURNAL_BYTES: std::ops::Range<usize> = 18..20;
/// Bytes of the box of a geometry by the three bits of its flags.
const BOX_BYTES: [usize; 5] = [0, 32, 48, 48, 64];

/// Features as a file has them, and their system; `None` where that is undefined.
pub(crate) struct Layer {
    pub(crate) features: Vec<(Geometry, Map<String, Value>)>,
    pub(crate) system: Option<String>,
}

/// Reads the layer of features of a file.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for a file that is no GeoPackage, or has none or several such layers.
pub(crate) fn read(source: Source<'_>) -> Result<Layer> {
    refuse_unsaved(&source)?;
    let (name, mut bytes) = source.read_all()?;
    let path = name.as_path();
    let wrong = |error: rusqlite::Error| Error::malformed(path, format!("is no GeoPackage: {error}"));
    if !bytes.starts_with(HEAD) {
        return Err(Error::malformed(path, "is no GeoPackage"));
    }
    if let Some(journal) = bytes.get_mut(JOURNAL_BYTES) {
        journal.fill(1);
    }
    let mut base = Connection::open_in_memory().map_err(wrong)?;
    base.deserialize_read_exact(MAIN_DB, &bytes[..], bytes.len(), true).map_err(wrong)?;
    drop(bytes);
    base.pragma_update(None, "trusted_schema", false).map_err(wrong)?;
    let (table, column, system) = only_layer(&base, path)?;
    let Some(system) = system_of(&base, system).map_err(wrong)? else {
        let what = format!("its reference system {system} is not described in it");
        return Err(Error::UnusableCrs { path: path.to_owned(), what });
    };
    let names = columns_in(&base, &table).map_err(wrong)?;
    let mut statement = base.prepare(&format!("SELECT * FROM {}", quoted(&table))).map_err(wrong)?;
    let Some(geometry_column) = names.iter().position(|name| name.eq_ignore_ascii_case(&column)) else {
        return Err(Error::malformed(path, format!("its table {table} has no column {column}")));
    };
    let mut rows = statement.query([]).map_err(wrong)?;
    let mut features = Vec::new();
    while let Some(row) = rows.next().map_err(wrong)? {
        if let ValueRef::Blob(bytes) = row.get_ref(geometry_column).map_err(wrong)? {
            let what = "has a geometry that is no point, line or polygon, such as a curve, or that is damaged";
            let geometry = geometry_of(bytes).ok_or_else(|| Error::malformed(path, what))?;
            features.push((geometry, properties_of(row, &names).map_err(wrong)?));
        }
    }
    Ok(Layer { features, system })
}

/// Table, column of geometries, and number of the system of the one layer of features.
fn only_layer(base: &Connection, path: &Path) -> Result<(String, String, i64)> {
    let wrong = |error: rusqlite::Error| Error::malformed(path, format!("is no GeoPackage: {error}"));
    let sql = "SELECT c.table_name, g.column_name, g.srs_id FROM gpkg_contents c JOIN gpkg_geometry_columns g \
               ON g.table_name = c.table_name JOIN sqlite_schema s ON s.name = c.table_name \
               WHERE c.data_type = 'features' AND s.type = 'table' AND s.sql NOT LIKE 'CREATE VIRTUAL%' ORDER BY 1";
    let mut statement = base.prepare(sql).map_err(wrong)?;
    let row = |row: &Row<'_>| Ok((row.get(0)?, row.get(1)?, row.get(2)?));
    let layers = statement.query_map([], row).map_err(wrong)?.collect::<rusqlite::Result<Vec<_>>>();
    let mut layers: Vec<(String, String, i64)> = layers.map_err(wrong)?;
    match layers.pop() {
        Some(only) if layers.is_empty() => Ok(only),
        None => Err(Error::malformed(path, "has no table of points, lines or polygons")),
        Some((last, ..)) => {
            let names: Vec<&str> = layers.iter().map(|(table, ..)| table.as_str()).chain([last.as_str()]).collect();
            let what = format!(
                "has several layers ({}); write one into a file of its own: ogr2ogr one.gpkg {} {}",
                names.join(", "),
                path.display(),
                names[0]
            );
            Err(Error::malformed(path, what))
        }
    }
}

/// Names of the columns of a table. Those of a statement would end the program where they are no UTF-8.
fn columns_in(base: &Connection, table: &str) -> rusqlite::Result<Vec<String>> {
    let mut statement = base.prepare("SELECT name FROM pragma_table_xinfo(?1) WHERE hidden <> 1 ORDER BY cid")?;
    let name =
        |row: &Row<'_>| Ok(row.get_ref(0)?.as_bytes().map(String::from_utf8_lossy).unwrap_or_default().into_owned());
    statement.query_map([table], name)?.collect()
}

/// The numbers and texts of a row.
fn properties_of(row: &Row<'_>, names: &[String]) -> rusqlite::Result<Map<String, Value>> {
    let mut properties = Map::new();
    for (number, name) in names.iter().enumerate() {
        let value = match row.get_ref(number)? {
            ValueRef::Null | ValueRef::Blob(_) => continue,
            ValueRef::Integer(value) => value.into(),
            ValueRef::Real(value) => value.into(),
            ValueRef::Text(text) => String::from_utf8_lossy(text).into_owned().into(),
        };
        properties.insert(name.clone(), value);
    }
    Ok(properties)
}

/// The geometry after its head of two letters, a version, flags, a system and a box.
fn geometry_of(bytes: &[u8]) -> Option<Geometry> {
    let [b'G', b'P', _, flags, ..] = bytes else { return None };
    let box_bytes = BOX_BYTES.get(usize::from(flags >> 1 & 7))?;
    wkb::read(bytes.get(8 + box_bytes..)?)
}

/// Refuses a file with changes that lie in a second one: it is open in another program.
fn refuse_unsaved(source: &Source<'_>) -> Result<()> {
    let path = source.name();
    let mut beside = path.as_os_str().to_owned();
    beside.push("-wal");
    match source.is_on_disk() && Path::new(&beside).metadata().is_ok_and(|found| found.len() > 0) {
        true => Err(Error::malformed(path, "has changes that are not saved in it; close it in other programs first")),
        false => Ok(()),
    }
}

/// The system with a number of the file: its code, or its well-known text; `Some(None)` where it is undefined, and
/// `None` for a number that the file does not describe.
fn system_of(base: &Connection, number: i64) -> rusqlite::Result<Option<Option<String>>> {
    let sql = "SELECT organization, organization_coordsys_id, definition FROM gpkg_spatial_ref_sys WHERE srs_id = ?1";
    let found: Option<(String, i64, String)> =
        base.query_row(sql, [number], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?))).optional()?;
    Ok(found.map(|(organization, code, definition)| match organization.eq_ignore_ascii_case("epsg") {
        true => Some(format!("EPSG:{code}")),
        false => (number > 0 && !definition.eq_ignore_ascii_case("undefined")).then_some(definition),
    }))
}

/// The bytes of a file with the layer `name` of `features`, whose coordinates are in `crs`.
///
/// # Errors
/// [`Error::Malformed`] for geometries and columns that the format does not have.
pub(crate) fn written(path: &Path, features: &[Feature], crs: &Crs) -> Result<Vec<u8>> {
    let wrong = |error: rusqlite::Error| Error::malformed(path, format!("cannot be written: {error}"));
    let name = path.file_stem().map(|stem| stem.to_string_lossy().to_lowercase()).unwrap_or_default();
    let is_reserved = name.is_empty() || ["gpkg_", "sqlite_", "rtree_"].iter().any(|start| name.starts_with(start));
    let name = if is_reserved { format!("layer_{name}") } else { name };
    let mut base = Connection::open_in_memory().map_err(wrong)?;
    let transaction = base.transaction().map_err(wrong)?;
    write_tables(&transaction, &name, features, crs).map_err(wrong)?;
    transaction.commit().map_err(wrong)?;
    Ok(base.serialize(MAIN_DB).map_err(wrong)?.to_vec())
}

/// Tables that each file has, with the three systems that it must name.
const TABLES: &str = "
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
    organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
    description TEXT DEFAULT '', last_change DATETIME NOT NULL, min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE,
    srs_id INTEGER REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL,
    geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL REFERENCES gpkg_spatial_ref_sys(srs_id),
    z TINYINT NOT NULL, m TINYINT NOT NULL, PRIMARY KEY (table_name, column_name));
INSERT INTO gpkg_spatial_ref_sys VALUES
    ('Undefined Cartesian SRS', -1, 'NONE', -1, 'undefined', NULL),
    ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', NULL),
    ('WGS 84 geodetic', 4326, 'EPSG', 4326, 'GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",
    SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433],
    AUTHORITY[\"EPSG\",\"4326\"]]', NULL);";
/// Number of a system that has no code.
const OWN_SYSTEM: i64 = 100_000;
/// Time of the last change, which must be there: always the same, so that files with the same content are the same.
const NO_TIME: &str = "2000-01-01T00:00:00.000Z";

fn write_tables(base: &Connection, name: &str, features: &[Feature], crs: &Crs) -> rusqlite::Result<()> {
    base.pragma_update(None, "application_id", APPLICATION_ID)?;
    base.pragma_update(None, "user_version", USER_VERSION)?;
    base.execute_batch(TABLES)?;
    let system = add_system(base, crs)?;
    add_features(base, name, features, system)?;
    let geometries = || features.iter().filter_map(|feature| feature.geometry.as_ref());
    let extent = geometries().filter_map(wkb::bounds).reduce(wkb::joined);
    let [west, east, south, north] = extent.map_or([None; 4], |ends| ends.map(Some));
    base.execute(
        "INSERT INTO gpkg_contents VALUES (?1, 'features', ?1, '', ?2, ?3, ?4, ?5, ?6, ?7)",
        params![name, NO_TIME, west, south, east, north, system],
    )?;
    let kind = |geometry: &Geometry| match &geometry.value {
        GeometryValue::Point { .. } => "POINT",
        GeometryValue::LineString { .. } => "LINESTRING",
        GeometryValue::MultiPolygon { .. } => "MULTIPOLYGON",
        _ => "GEOMETRY",
    };
    let first = geometries().next().map_or("GEOMETRY", kind);
    let of_all = if geometries().all(|geometry| kind(geometry) == first) { first } else { "GEOMETRY" };
    // 2: there may be heights
    let heights = if geometries().any(wkb::has_heights) { 2 } else { 0 };
    base.execute(
        "INSERT INTO gpkg_geometry_columns VALUES (?1, 'geom', ?2, ?3, ?4, 0)",
        params![name, of_all, system, heights],
    )?;
    Ok(())
}

/// Adds the system of the features; returns its number.
fn add_system(base: &Connection, crs: &Crs) -> rusqlite::Result<i64> {
    Ok(match (crs.epsg, &crs.wkt) {
        (Some(code), definition) => {
            let row = params![crs.describe(), code, definition.as_deref().unwrap_or("undefined")];
            base.execute("INSERT OR IGNORE INTO gpkg_spatial_ref_sys VALUES (?1, ?2, 'EPSG', ?2, ?3, NULL)", row)?;
            i64::from(code)
        }
        (None, Some(definition)) => {
            let row = params![crs.describe(), OWN_SYSTEM, definition];
            base.execute("INSERT INTO gpkg_spatial_ref_sys VALUES (?1, ?2, 'NONE', ?2, ?3, NULL)", row)?;
            OWN_SYSTEM
        }
        (None, None) if crs.kind == CrsKind::Geographic => 0,
        (None, None) => -1,
    })
}

/// Adds the table of the features, with a column for each property.
fn add_features(base: &Connection, name: &str, features: &[Feature], system: i64) -> rusqlite::Result<()> {
    let columns = columns_of(features);
    let table = quoted(name);
    let listed = |text: &dyn Fn(usize, &Column) -> String| -> String {
        columns.iter().enumerate().map(|(number, column)| text(number, column)).collect()
    };
    base.execute_batch(&format!(
        "CREATE TABLE {table} (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom BLOB{})",
        listed(&|_, column| format!(", {} {}", quoted(&column.name), column.kind.unwrap_or("TEXT")))
    ))?;
    let mut insert = base.prepare(&format!(
        "INSERT INTO {table} (geom{}) VALUES (?1{})",
        listed(&|_, column| format!(", {}", quoted(&column.name))),
        listed(&|number, _| format!(", ?{}", number + 2))
    ))?;
    for feature in features {
        let Some(geometry) = &feature.geometry else { continue };
        let cell = |column: &Column| {
            cell_of(feature.properties.as_ref().and_then(|properties| properties.get(&column.property)))
        };
        let geometry = blob_of(geometry, system).map_or(Cell::Null, Cell::Blob);
        insert.execute(params_from_iter(std::iter::once(geometry).chain(columns.iter().map(cell))))?;
    }
    Ok(())
}

fn cell_of(value: Option<&Value>) -> Cell {
    match value {
        None | Some(Value::Null) => Cell::Null,
        Some(Value::Bool(is)) => Cell::Integer((*is).into()),
        Some(Value::String(text)) => Cell::Text(text.clone()),
        Some(Value::Number(number)) => match number.as_i64() {
            Some(whole) => Cell::Integer(whole),
            None => number.as_f64().map_or(Cell::Null, Cell::Real),
        },
        Some(other) => Cell::Text(other.to_string()),
    }
}

/// A column for a property.
struct Column {
    /// Name of the property.
    property: String,
    /// Name of the column, which differs where another has it but for upper and lower case.
    name: String,
    kind: Option<&'static str>,
}

/// Columns of all properties, in the order in which they come first.
fn columns_of(features: &[Feature]) -> Vec<Column> {
    let mut columns: Vec<Column> = Vec::new();
    for (property, value) in features.iter().filter_map(|feature| feature.properties.as_ref()).flatten() {
        let kind = match value {
            Value::Null => None,
            Value::Bool(_) => Some("BOOLEAN"),
            Value::Number(number) if number.is_i64() => Some("INTEGER"),
            Value::Number(_) => Some("DOUBLE"),
            _ => Some("TEXT"),
        };
        let Some(known) = columns.iter_mut().find(|column| column.property == *property) else {
            let is_taken = |name: &str| {
                let own = ["fid", "geom"].into_iter();
                own.chain(columns.iter().map(|column| column.name.as_str()))
                    .any(|other| other.eq_ignore_ascii_case(name))
            };
            let numbered = (1..).map(|number: u32| format!("{property}_{number}"));
            let name = std::iter::once(property.clone()).chain(numbered).find(|name| !is_taken(name));
            columns.push(Column { property: property.clone(), name: name.unwrap_or_default(), kind });
            continue;
        };
        known.kind = match (known.kind, kind) {
            (None, other) | (other, None) => other,
            (Some("INTEGER"), Some("DOUBLE")) | (Some("DOUBLE"), Some("INTEGER")) => Some("DOUBLE"),
            (Some(a), Some(b)) if a == b => Some(a),
            _ => Some("TEXT"),
        };
    }
    columns
}

/// A geometry behind its head.
fn blob_of(geometry: &Geometry, system: i64) -> Option<Vec<u8>> {
    let system = i32::try_from(system).ok()?;
    let mut blob = vec![b'G', b'P', 0, 0b11];
    blob.extend(system.to_le_bytes());
    wkb::bounds(geometry)?.iter().for_each(|end| blob.extend(end.to_le_bytes()));
    blob.extend(wkb::written(geometry)?);
    Some(blob)
}

fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}
