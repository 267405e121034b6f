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

use crate::files::announced::{Announced, BoundsAre};
use crate::files::source::{Input, Source, SystemBeside, folder_and_query, place_beside, web_address};
use crate::las::octree::OctreeCube;
use crate::las::read_las_head;
use crate::points::read_options::FileBox;
use belvedere_data::contradiction::{FoundContradiction, HIERARCHY_POINTS};
use belvedere_data::control::Control;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// Name of the file that describes the points.
pub(crate) const NAME: &str = "ept.json";
/// Folder of the nodes.
const NODES: &str = "ept-data";
/// Largest page of a hierarchy that is read, bytes: some million nodes.
const MAX_BYTES: u64 = 1 << 28;
/// Maximum number of pages of a hierarchy that are read for one box. A country has some thousand, and each is a
/// request.
const MAX_PAGES: usize = 20_000;
/// Maximum distance of points outside the cell of their node, in steps of the coordinates, and the default step of
/// files.
const ROOM_STEPS: f64 = 10.0;
const USUAL_STEP: f64 = 0.01;

/// The description at `path`, where that is one, or is a folder with one.
pub(crate) fn description(source: &Source<'_>) -> Option<PathBuf> {
    if let Some(folder) = source.folder() {
        return Some(folder.join(NAME)).filter(|file| file.is_file());
    }
    is_description(source.name()).then(|| source.name().to_owned())
}

fn is_description(path: &Path) -> bool {
    let path = web_address(path).and_then(|text| text.split(['?', '#']).next()).map_or(path, Path::new);
    path.file_name().is_some_and(|name| name == NAME)
}

/// Description of the points in `ept.json`.
struct EptDescription {
    cube: OctreeCube,
    room: [f64; 3],
    system: Option<SystemBeside>,
    /// Number of points, where it is stated.
    points: Option<u64>,
}

/// The nodes of entwine point tiles that may have points in a box.
#[derive(Default)]
pub(crate) struct EptNodes {
    /// Their LAZ files.
    pub(crate) files: Vec<Source<'static>>,
    /// Contradictions in the hierarchy.
    pub(crate) contradictions: Vec<FoundContradiction>,
}

/// The LAZ files of the nodes that may have points in `wanted`, level by level; of all nodes without a box. Each has
/// the system of the description, where it names none itself.
///
/// # Errors
/// - [`Error::Io`].
/// - [`Error::Malformed`] for a file that is no description or no hierarchy, for a hierarchy without end, and for
///   bounds that do not hold the points if a box needs them. Also for nodes that are not LAZ.
/// - [`Error::Cancelled`].
pub(crate) fn files_within(path: &Path, wanted: Option<&FileBox>, control: &Control<'_>) -> Result<EptNodes> {
    let description = describe(path)?;
    let folder = folder_and_query(path);
    let mut walk = HierarchyWalk::default();
    let mut pages = vec![String::from(ROOT)];
    while let Some(page) = pages.pop() {
        control.check()?;
        let file = place_beside(&folder, &format!("ept-hierarchy/{page}.json"));
        let entries = json(&file)?;
        let found = walk.read_page(&page, &entries, &description, wanted);
        pages.extend(found.map_err(|what| Error::malformed(&file, format!("has a damaged EPT hierarchy: {what}")))?);
    }
    let place_of = |name: &str| place_beside(&folder, &format!("{NODES}/{name}.laz"));
    if let (Some(_), Some((key, first))) = (wanted, &walk.first)
        && let Ok(head) = read_las_head(place_of(first).as_path())
    {
        let [low, high] = head.bounds;
        let (own_low, own_high) = description.cube.node_bounds(*key, description.room);
        let is_beside = (0..3).any(|i| high[i] < own_low[i] || own_high[i] < low[i]);
        // headers of nodes may have the bounds of all points, and the root holds these
        let is_beyond = (0..3).any(|i| low[i] < own_low[i] || own_high[i] < high[i]);
        if is_beside || key[0] == 0 && is_beyond {
            let what = format!(
                "has `bounds` without its points: those of node {first} lie between {low:.2?} and {high:.2?}; correct them, or read all points and not a box"
            );
            return Err(Error::malformed(path, what));
        }
    }
    let source = |(key, (name, points)): (&[i32; 4], &(String, u64))| {
        let mut source = Source::path(place_of(name));
        source.system = description.system.clone();
        let bounds = Some(description.cube.node_bounds(*key, description.room));
        source.announced = Some(Announced {
            by: "the EPT hierarchy".to_owned(),
            points: Some(*points),
            bounds,
            bounds_are: BoundsAre::OfCell,
        });
        source
    };
    let contradictions = walk.lost_points(&description, path).into_iter().collect();
    Ok(EptNodes { files: walk.nodes.iter().map(source).collect(), contradictions })
}

/// Name of the node of all points.
const ROOT: &str = "0-0-0-0";

/// Result of the pages of a hierarchy so far.
#[derive(Default)]
struct HierarchyWalk {
    /// Names of pages.
    seen: HashSet<String>,
    /// Name and number of points of each node that is wanted.
    nodes: BTreeMap<[i32; 4], (String, u64)>,
    /// The node with points of the lowest level, wanted or not.
    first: Option<([i32; 4], String)>,
    /// Points of all nodes of these pages.
    points: u64,
    /// True if pages were skipped, since their nodes lie beside the box.
    is_partial: bool,
}

impl HierarchyWalk {
    /// Takes the nodes of a page, and gives the names of the pages below it; a message for a damaged page.
    fn read_page(
        &mut self,
        page: &str,
        entries: &Value,
        description: &EptDescription,
        wanted: Option<&FileBox>,
    ) -> std::result::Result<Vec<String>, String> {
        let entries = entries.as_object().ok_or_else(|| "it is no list of nodes".to_owned())?;
        let mut below = Vec::new();
        for (name, count) in entries {
            let key = key(name).ok_or_else(|| format!("node {name}"))?;
            let count = count.as_i64().ok_or_else(|| format!("node {name} has {count} points"))?;
            let meets = description.cube.node_meets(key, description.room, wanted);
            let meets = meets.ok_or_else(|| format!("node {name}"))?;
            match (count, u64::try_from(count)) {
                (0, _) => {}
                (-1, _) if !meets => self.is_partial = true,
                (-1, _) if self.seen.insert(name.clone()) => below.push(name.clone()),
                (_, Ok(points)) => {
                    self.points = self.points.saturating_add(points);
                    if self.first.as_ref().is_none_or(|(first, _)| key < *first) {
                        self.first = Some((key, name.clone()));
                    }
                    if meets {
                        self.nodes.insert(key, (name.clone(), points));
                    }
                }
                _ => return Err(format!("node {name} with {count} points")),
            }
        }
        // a page begins with the node that the page above names: one without points could go on without end
        let has_own = entries.get(page).and_then(Value::as_i64).is_some_and(|count| count > 0 || page == ROOT);
        if !has_own {
            return Err(format!("the page {page} has no points of node {page}"));
        }
        if description.points.is_some_and(|all| self.points > all) {
            let all = description.points.unwrap_or(0);
            return Err(format!("its nodes have more points than the {all} of {NAME}"));
        }
        if self.seen.len() > MAX_PAGES {
            return Err(format!("it has more than {MAX_PAGES} pages here; give a smaller box to read (--bounds)"));
        }
        Ok(below)
    }

    /// Returns the contradiction of a hierarchy with fewer points than the description. `None` if it is complete, and
    /// if only a part of it was read.
    fn lost_points(&self, description: &EptDescription, path: &Path) -> Option<FoundContradiction> {
        let all = description.points.filter(|&all| !self.is_partial && self.points < all)?;
        let (own, path) = (self.points, path.display());
        let text = format!(
            "{path}: {all} points are announced, but the nodes of the hierarchy have {own}: nodes are missing, so that points are; copy the folder again"
        );
        Some(HIERARCHY_POINTS.found(text).with("announced", all as f64).with("of_nodes", own as f64))
    }
}

/// The system that the description above a node gives, where `path` is that of a node.
pub(crate) fn system_of_node(path: &Path) -> Option<SystemBeside> {
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
    let points = content.get("points").and_then(Value::as_u64);
    Ok(EptDescription { cube, room, system: content.get("srs").and_then(system), points })
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
