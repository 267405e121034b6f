//! Entwine point tiles (EPT): a folder, here or on a web server, with a LAZ file for each node of an octree.
//!
//! The hierarchy is JSON, in pages of which only those are read whose nodes meet a box. A node becomes a LAZ file among
//! others, so that tiles, windows and addresses need nothing of their own.
//!
//! # Source
//! Entwine Point Tile specification 1.1.0 (entwine.io/en/latest/entwine-point-tile.html).

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::octree::OctreeCube;
use super::read_options::FileBox;
use super::source::{Input, Source, SystemBeside, folder_and_query, place_beside, web_address};
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// Name of the file that describes the points.
pub(super) const NAME: &str = "ept.json";
/// Folder of the nodes.
const NODES: &str = "ept-data";
/// Largest page of a hierarchy that is read, bytes: some million nodes.
const MAX_BYTES: u64 = 1 << 28;
/// How far points may lie outside the cell of their node, in steps of the coordinates, and the step of files that do
/// not say it.
const ROOM_STEPS: f64 = 10.0;
const USUAL_STEP: f64 = 0.01;

/// The description at `path`, where that is one, or is a folder with one.
pub(super) fn description(source: &Source<'_>) -> Option<PathBuf> {
    if let Some(folder) = source.folder() {
        return Some(folder.join(NAME)).filter(|file| file.is_file());
    }
    is_description(source.name()).then(|| source.name().to_owned())
}

fn is_description(path: &Path) -> bool {
    let path = web_address(path).and_then(|text| text.split(['?', '#']).next()).map_or(path, Path::new);
    path.file_name().is_some_and(|name| name == NAME)
}

/// What `ept.json` says of the points.
struct EptDescription {
    cube: OctreeCube,
    room: [f64; 3],
    system: Option<SystemBeside>,
}

/// The LAZ files of the nodes that may have points in `wanted`, level by level; of all nodes without a box. Each has
/// the system of the description, where it names none itself.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for what is no description or no hierarchy, and for nodes that are not LAZ.
pub(super) fn files_within(path: &Path, wanted: Option<&FileBox>) -> Result<Vec<Source<'static>>> {
    let description = describe(path)?;
    let folder = folder_and_query(path);
    let mut pages = vec![String::from("0-0-0-0")];
    let mut seen: HashSet<String> = pages.iter().cloned().collect();
    let mut nodes: BTreeMap<[i32; 4], String> = BTreeMap::new();
    while let Some(page) = pages.pop() {
        let file = place_beside(&folder, &format!("ept-hierarchy/{page}.json"));
        let damaged = |what: String| Error::malformed(&file, format!("has a damaged EPT hierarchy: {what}"));
        let entries = json(&file)?;
        let entries = entries.as_object().ok_or_else(|| damaged("it is no list of nodes".to_owned()))?;
        for (name, count) in entries {
            let key = key(name).ok_or_else(|| damaged(format!("node {name}")))?;
            let count = count.as_i64().ok_or_else(|| damaged(format!("node {name} has {count} points")))?;
            let meets = description.cube.node_meets(key, description.room, wanted);
            if !meets.ok_or_else(|| damaged(format!("node {name}")))? {
                continue;
            }
            match count {
                0 => {}
                1.. => drop(nodes.insert(key, name.clone())),
                -1 if seen.insert(name.clone()) => pages.push(name.clone()),
                // a page begins with the node that the page above names
                -1 if *name == page => {}
                _ => return Err(damaged(format!("node {name} with {count} points"))),
            }
        }
    }
    let source = |name: &String| {
        let mut source = Source::path(place_beside(&folder, &format!("{NODES}/{name}.laz")));
        source.system = description.system.clone();
        source
    };
    Ok(nodes.values().map(source).collect())
}

/// The system that the description above a node gives, where `path` is that of a node.
pub(super) fn system_of_node(path: &Path) -> Option<SystemBeside> {
    let (folder, query) = folder_and_query(path);
    let above = folder.parent().filter(|_| folder.file_name().is_some_and(|name| name == NODES))?;
    describe(&place_beside(&(above.to_owned(), query), NAME)).ok()?.system
}

fn describe(path: &Path) -> Result<EptDescription> {
    let content = json(path)?;
    let damaged = |what: &str| Error::malformed(path, format!("is no description of entwine point tiles: {what}"));
    let kind = content.get("dataType").and_then(Value::as_str).ok_or_else(|| damaged("it has no `dataType`"))?;
    if kind != "laszip" {
        let what =
            format!("has its points as {kind}; only laszip is read: make it again, for example with Untwine as COPC");
        return Err(Error::malformed(path, what));
    }
    let bounds: Option<Vec<f64>> =
        content.get("bounds").and_then(Value::as_array).and_then(|list| list.iter().map(Value::as_f64).collect());
    let Some([x, y, z, east, ..]) = bounds.as_deref().filter(|bounds| bounds.len() == 6) else {
        return Err(damaged("its `bounds` are not six numbers"));
    };
    let cube = OctreeCube { low: [*x, *y, *z], side: east - x };
    if !(cube.side > 0.0 && cube.side.is_finite() && cube.low.iter().all(|v| v.is_finite())) {
        return Err(damaged("its `bounds` hold nothing"));
    }
    let schema = content.get("schema").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let step = |axis: &str| {
        let own = schema.iter().find(|column| column.get("name").and_then(Value::as_str) == Some(axis));
        own.and_then(|column| column.get("scale")?.as_f64()).filter(|step| step.is_finite()).unwrap_or(USUAL_STEP)
    };
    let room = ["X", "Y", "Z"].map(|axis| ROOM_STEPS * step(axis).abs());
    Ok(EptDescription { cube, room, system: content.get("srs").and_then(system) })
}

/// The system of a description: a code with its authority, or well-known text.
fn system(srs: &Value) -> Option<SystemBeside> {
    let text = |key: &str| srs.get(key).and_then(Value::as_str).map(str::trim).filter(|text| !text.is_empty());
    let vertical = text("vertical").map_or(String::new(), |code| format!("+{code}"));
    let code = text("horizontal").filter(|_| text("authority").is_none_or(|name| name.eq_ignore_ascii_case("EPSG")));
    let code = code.map(|code| format!("EPSG:{code}{vertical}"));
    let found_in = NAME.to_owned();
    let mut names = text("wkt").into_iter().chain(code.as_deref()).peekable();
    names.peek()?;
    match names.find_map(|name| Crs::parse(name).ok()) {
        Some(crs) => Some(SystemBeside::Known { crs, found_in }),
        None => Some(SystemBeside::Unreadable { found_in }),
    }
}

/// Level, and number along x, y and z, of the node named so.
fn key(name: &str) -> Option<[i32; 4]> {
    let numbers: Vec<i32> = name.split('-').map(|number| number.parse().ok()).collect::<Option<_>>()?;
    <[i32; 4]>::try_from(numbers).ok().filter(|key| *name == key.map(|number| number.to_string()).join("-"))
}

fn json(path: &Path) -> Result<Value> {
    let Input { name, reader, size } = Source::path(path).open()?;
    if size > MAX_BYTES {
        return Err(Error::malformed(&name, format!("has {size} bytes, more than any part of entwine point tiles")));
    }
    serde_json::from_reader(reader).map_err(|e| Error::malformed(&name, format!("is not readable JSON: {e}")))
}
