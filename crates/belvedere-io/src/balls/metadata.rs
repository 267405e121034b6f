//! Metadata of ball files, as JSON.

use belvedere_data::vector::to_f32;
use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use super::FileBall;
use belvedere_data::balls::MedialBalls;
use belvedere_data::cloud::{centre_rounded, to_local};
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::model::ModelParts;
use belvedere_data::{Bounds, Frame, SurfacePatches};

/// Units of the numbers beside the metadata, in files that hold points.
pub(super) const FILE_UNITS: &str = "file units, radians; origin in metres, bounds in metres relative to it";

const FORMAT: &str = "belvedere balls 1";
/// Lengths of units in metres that occur, and many that do not.
const UNITS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Number of surface patches: a program that ignores unknown entries would drop them without a word.
const PATCHES: &str = "surface_patches";

const KINDS: [(CrsKind, &str); 5] = [
    (CrsKind::Unknown, "unknown"),
    (CrsKind::Projected, "projected"),
    (CrsKind::Geographic, "geographic"),
    (CrsKind::Geocentric, "geocentric"),
    (CrsKind::Local, "local"),
];

/// Origin, bounds, reference system and provenance of `balls`; `units` describes the units of the numbers beside it.
pub(super) fn to_json(parts: &ModelParts, units: &str) -> String {
    let crs = &parts.frame.crs;
    let provenance: Map<String, Value> =
        parts.provenance.iter().map(|(k, v)| (k.clone(), Value::String(v.clone()))).collect();
    let mut json = json!({
        "format": FORMAT,
        "units": units,
        "origin": parts.frame.origin,
        "bounds": [parts.bounds.low, parts.bounds.high],
        "crs": {
            "wkt": crs.wkt,
            "epsg": crs.epsg,
            "vertical_epsg": crs.vertical_epsg,
            "metres_per_unit": crs.metres_per_unit,
            "vertical_metres_per_unit": crs.vertical_metres_per_unit,
            "kind": KINDS.iter().find(|(kind, _)| *kind == crs.kind).map(|&(_, name)| name),
        },
        "provenance": provenance,
    });
    if !parts.patches.is_empty() {
        json[PATCHES] = parts.patches.len().into();
    }
    if let Some(doubt) = &crs.doubt {
        json["crs"]["doubt"] = doubt.as_str().into();
    }
    json.to_string()
}

/// Metadata in [`to_json`]; values missing in a file are `None` or the default.
#[derive(Default)]
pub(super) struct Metadata {
    pub(super) crs: Crs,
    provenance: BTreeMap<String, String>,
    /// Metres.
    pub(super) origin: Option<[f64; 3]>,
    /// Local metres.
    bounds: Option<Bounds>,
    /// Number of surface patches; 0 where the file has none.
    patch_count: u64,
}

/// Parses `text`, written by [`to_json`]; empty text, dropped by a program, gives the defaults. The error describes the
/// damage.
pub(super) fn from_json(text: &str) -> Result<Metadata, String> {
    if text.is_empty() {
        return Ok(Metadata::default());
    }
    let damaged = |what: &str| format!("its metadata is damaged ({what}); make the ball file again");
    let value: Value = serde_json::from_str(text).map_err(|e| damaged(&e.to_string()))?;
    if value["format"] != FORMAT {
        return Err(damaged("it names another format"));
    }
    let crs = &value["crs"];
    let code = |key: &str| crs[key].as_u64().and_then(|v| u32::try_from(v).ok());
    let unit = |key: &str| match crs[key].as_f64() {
        None => Ok(1.0),
        Some(metres) if UNITS.contains(&metres) => Ok(metres),
        Some(metres) => Err(damaged(&format!("a unit of {metres} metres"))),
    };
    let named = KINDS.iter().find(|(_, name)| crs["kind"] == *name).map(|&(kind, _)| kind);
    let is_known = crs["wkt"].is_string() || crs["epsg"].is_number();
    let provenance = value["provenance"].as_object().into_iter().flatten();
    let corner = |i: usize| three(&value["bounds"][i]).map(|corner| corner.map(to_f32));
    Ok(Metadata {
        crs: Crs {
            wkt: crs["wkt"].as_str().map(str::to_owned),
            epsg: code("epsg"),
            vertical_epsg: code("vertical_epsg"),
            metres_per_unit: unit("metres_per_unit")?,
            vertical_metres_per_unit: unit("vertical_metres_per_unit")?,
            // balls are only ever made in a plane
            kind: named.unwrap_or(if is_known { CrsKind::Projected } else { CrsKind::Unknown }),
            doubt: crs["doubt"].as_str().map(str::to_owned),
        },
        provenance: provenance.filter_map(|(k, v)| Some((k.clone(), v.as_str()?.to_owned()))).collect(),
        origin: three(&value["origin"]),
        bounds: corner(0).zip(corner(1)).map(|(low, high)| Bounds { low, high }),
        patch_count: value[PATCHES].as_u64().unwrap_or(0),
    })
}

fn three(value: &Value) -> Option<[f64; 3]> {
    match [0, 1, 2].map(|i| value[i].as_f64()) {
        [Some(x), Some(y), Some(z)] => Some([x, y, z]),
        _ => None,
    }
}

/// Returns the transmission of balls; empty if a file has it for none.
fn transmission(rows: &[FileBall]) -> Vec<f32> {
    let known = rows.iter().any(|row| !row.transmission.is_nan());
    if known { rows.iter().map(|row| row.transmission).collect() } else { Vec::new() }
}

impl Metadata {
    /// Returns a check of the number of surface patches against the announced one; its error describes the difference.
    pub(super) fn patch_check(&self) -> impl FnOnce(&SurfacePatches) -> Result<(), String> + use<> {
        let announced = self.patch_count;
        move |patches| match patches.len() as u64 {
            found if found == announced || announced == 0 => Ok(()),
            found => Err(format!(
                "holds {found} of {announced} surface patches: a program dropped the others; make the ball file again"
            )),
        }
    }

    /// Balls with these centres, local to `origin`, and no further columns yet. Bounds that the file lacks are those of
    /// the centres.
    pub(super) fn balls(self, origin: [f64; 3], centers: Vec<[f32; 3]>) -> ModelParts {
        let bounds = self.bounds.or_else(|| Bounds::around(centers.iter().copied())).unwrap_or_default();
        let frame = Frame { origin, crs: self.crs };
        let balls = MedialBalls { centers, ..MedialBalls::default() };
        ModelParts { frame, bounds, balls, provenance: self.provenance, ..ModelParts::default() }
    }

    /// Balls from rows in file coordinates. An origin that the file lacks is chosen near the middle of the centres.
    pub(super) fn fill(mut self, rows: &[FileBall]) -> ModelParts {
        let units = self.crs.metres_per_unit_xyz();
        let metres = |row: &FileBall| -> [f64; 3] { std::array::from_fn(|i| row.center[i] * units[i]) };
        let origin = self.origin.unwrap_or_else(|| {
            // bounds mean nothing without the origin they are relative to
            self.bounds = None;
            centre_rounded(rows.iter().map(metres))
        });
        let mut parts = self.balls(origin, rows.iter().map(|row| to_local(metres(row), origin)).collect());
        parts.balls.radii = rows.iter().map(|row| to_f32(row.radius * units[0])).collect();
        parts.balls.separation_angles = rows.iter().map(|row| row.separation_angle).collect();
        parts.balls.source = rows.iter().map(|row| row.source).collect();
        parts.balls.touch = rows.iter().map(|row| row.touch).collect();
        parts.transmission = transmission(rows);
        parts
    }
}
